//! Orders in which fragments arrive: what a method that depends on it is judged in.

use super::{EvaluateError, Judged, MethodResult, Truth};
use crate::numeric::rng::stream;
use crate::oit::{Context, Method};
use crate::pixel::FragmentList;
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// What random orders of fragments are drawn for.
const PURPOSE: u64 = 0x0f3a;

/// What comes in a random order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shuffled {
    /// The fragments of every pixel.
    Fragments,
    /// Whole objects, as a renderer draws them that does not sort.
    Objects,
}

/// Errors of a method in one order; none and NaN as in [`MethodResult`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OrderResult {
    /// What comes in a random order.
    pub shuffled: Shuffled,
    /// Seed of the order.
    pub seed: u64,
    /// Mean squared error of T.
    pub transmittance_mse: Option<f64>,
    /// Mean squared error of the image.
    pub image_mse: Option<f64>,
    /// Mean of the FLIP map.
    pub flip_mean: Option<f64>,
}

/// A list in one order of its fragments.
pub struct OrderedList {
    /// What comes in a random order.
    pub shuffled: Shuffled,
    /// Seed of the order.
    pub seed: u64,
    /// The same pixels, their fragments in that order.
    pub list: FragmentList,
}

/// The same pixels, the fragments of each in a random order of its own.
pub fn shuffle_fragments(list: &FragmentList, seed: u64) -> FragmentList {
    let mut order: Vec<usize> = (0..list.len()).collect();
    for p in 0..list.pixels() {
        let mut rng = stream(seed, PURPOSE, p as u64);
        let own = &mut order[list.range(p)];
        for i in (1..own.len()).rev() {
            own.swap(i, (rng.random::<f64>() * (i + 1) as f64) as usize);
        }
    }
    list.reordered(&order)
}

/// A list in so many random orders of the fragments within their pixels.
pub fn fragment_orders(list: &FragmentList, count: u64) -> impl Iterator<Item = OrderedList> {
    (1..=count).map(|seed| OrderedList {
        shuffled: Shuffled::Fragments,
        seed,
        list: shuffle_fragments(list, seed),
    })
}

/// Judges methods that depend on the order in every one of some orders: the pictures are of the first, errors the means
/// over all. With no order at all there is no result.
///
/// # Errors
/// The first order that could not be made; beside that, [`EvaluateError`] of each method that cannot be applied.
pub fn judge_in_orders<E>(
    methods: &[&dyn Method],
    orders: impl IntoIterator<Item = Result<OrderedList, E>>,
    context: Context,
    background: [f64; 3],
) -> Result<Vec<Result<Judged, EvaluateError>>, E> {
    let mut judged: Vec<Result<(Judged, Vec<OrderResult>), EvaluateError>> = Vec::new();
    if methods.is_empty() {
        return Ok(Vec::new());
    }
    for order in orders {
        let order = order?;
        let truth = Truth::new(&order.list, background);
        let mut found = methods.iter().map(|method| truth.judge(*method, context));
        if judged.is_empty() {
            judged = found
                .map(|result| {
                    result.map(|judged| {
                        let of_order = of_order(&order, &judged.result);
                        (judged, vec![of_order])
                    })
                })
                .collect();
            continue;
        }
        for judged in &mut judged {
            let result = found.next().expect("as many as the first time");
            match (&mut *judged, result) {
                (Ok((_, results)), Ok(more)) => results.push(of_order(&order, &more.result)),
                (judged @ Ok(_), Err(why)) => *judged = Err(why),
                (Err(_), _) => {}
            }
        }
    }
    let mean = |(mut judged, orders): (Judged, Vec<OrderResult>)| {
        judged.result = over_orders(judged.result, orders);
        judged
    };
    Ok(judged.into_iter().map(|j| j.map(mean)).collect())
}

fn of_order(order: &OrderedList, result: &MethodResult) -> OrderResult {
    OrderResult {
        shuffled: order.shuffled,
        seed: order.seed,
        transmittance_mse: result.transmittance_mse,
        image_mse: result.image_mse,
        flip_mean: result.flip_mean,
    }
}

/// Mean of a figure over orders; none where it has none.
fn mean(orders: &[OrderResult], figure: impl Fn(&OrderResult) -> Option<f64>) -> Option<f64> {
    let figures: Option<Vec<f64>> = orders.iter().map(figure).collect();
    figures.map(|f| f.iter().sum::<f64>() / f.len() as f64)
}

/// The result of a method that was judged in several orders: means, and each order beside them.
fn over_orders(result: MethodResult, orders: Vec<OrderResult>) -> MethodResult {
    let image_mse = mean(&orders, |o| o.image_mse);
    MethodResult {
        transmittance_mse: mean(&orders, |o| o.transmittance_mse),
        image_mse,
        image_psnr_db: image_mse.map(|mse| -10.0 * libm::log10(mse)),
        flip_mean: mean(&orders, |o| o.flip_mean),
        orders: Some(orders),
        ..result
    }
}

/// Least and greatest image error over the orders that a method was judged in, or of T where there is no image; none
/// where order changes nothing.
pub fn spread(result: &MethodResult) -> Option<(f64, f64)> {
    let figures: Vec<f64> = result
        .orders
        .as_ref()?
        .iter()
        .filter_map(|o| o.image_mse.or(o.transmittance_mse))
        .collect();
    let least = figures.iter().copied().min_by(f64::total_cmp)?;
    let greatest = figures.iter().copied().max_by(f64::total_cmp)?;
    Some((least, greatest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::judge::tests::colored_list;
    use crate::oit;
    use crate::scene;

    fn glass() -> FragmentList {
        let options = scene::Options {
            size: Some((48, 48)),
            seed: None,
        };
        scene::build(&scene::open("glass-stacks").unwrap(), &options).unwrap()
    }

    /// A shuffled list holds the same fragments in the same pixels; the same seed gives the same list, another another.
    #[test]
    fn shuffling_moves_and_changes_nothing_else() {
        let list = glass();
        let shuffled = shuffle_fragments(&list, 1);
        assert_eq!(
            (list.size(), list.planes(), list.offsets()),
            (shuffled.size(), shuffled.planes(), shuffled.offsets())
        );
        assert!(list != shuffled && shuffled == shuffle_fragments(&list, 1) && shuffled != shuffle_fragments(&list, 2));
        for p in 0..list.pixels() {
            let sorted = |list: &FragmentList| {
                let pixel = list.pixel(p);
                let mut v: Vec<_> = (0..pixel.len())
                    .map(|i| {
                        (
                            pixel.view_z[i].to_bits(),
                            pixel.alpha[i].to_bits(),
                            pixel.color.unwrap()[i].map(f32::to_bits),
                        )
                    })
                    .collect();
                v.sort_unstable();
                v
            };
            assert_eq!(sorted(&list), sorted(&shuffled));
        }
        let none = FragmentList::new(vec![0, 0], vec![], vec![], None).unwrap();
        assert_eq!(shuffle_fragments(&none, 1), none);
    }

    /// The bug that this module is for: `glass-stacks` comes nearly sorted from the rasteriser, where multi-layer alpha
    /// blending looks faultless; in random orders it is at least ten times worse. The mean lies within the spread, and
    /// enough layers need no order.
    #[test]
    fn list_order_flatters() {
        let list = glass();
        let truth = Truth::new(&list, [1.0; 3]);
        let judged = |name: &str| {
            let method = oit::parse(name).unwrap();
            let orders = fragment_orders(&list, 3).map(Ok::<_, EvaluateError>);
            let found = judge_in_orders(&[&*method], orders, Context::default(), [1.0; 3]).unwrap();
            let listed = truth
                .judge(&*method, Context::default())
                .unwrap()
                .result
                .image_mse
                .unwrap();
            (listed, found.into_iter().next().unwrap().unwrap().result)
        };
        let (listed, result) = judged("multi-layer-alpha:4");
        let (least, greatest) = spread(&result).unwrap();
        let mean = result.image_mse.unwrap();
        assert!(mean > 10.0 * listed, "{mean:e} {listed:e}");
        assert!(
            least > 0.0 && least <= mean && mean <= greatest && greatest < 2.0 * least,
            "{least:e} {mean:e} {greatest:e}"
        );
        assert_eq!(result.orders.as_ref().unwrap().len(), 3);
        let (_, result) = judged("multi-layer-alpha:64");
        assert!(result.image_mse.unwrap() < 1e-30);
    }

    /// Every method that does not say that it depends on the order gives the same bits in any: weights, and colours of
    /// pixels without ties. What is stored in f32 or 16 bits rounds with every fragment, and changes by no more than
    /// that. Control: those that do say so do change.
    #[test]
    fn order_changes_no_bit_in_f64() {
        let list = colored_list(24, 20);
        let list = list.with_planes(crate::pixel::CameraPlanes::new(0.5, 100.0).unwrap());
        let deep = glass();
        for list in [&list, &deep] {
            let shuffled = shuffle_fragments(list, 5);
            for name in oit::all_names() {
                let method = oit::parse(&name).unwrap();
                // A network's answers and the core's sums are f32.
                if name == "deep-weighted-blended" || name.starts_with("core:") {
                    continue;
                }
                let images = [list, &shuffled].map(|list| {
                    let accumulated = method.accumulate(list, Context::default()).unwrap();
                    let weights = oit::weights(list, &*accumulated);
                    crate::evaluate::image::of_method(list, &*accumulated, &weights, [1.0; 3]).unwrap()
                });
                let differences = images[0].pixels().iter().zip(images[1].pixels()).map(|(a, b)| {
                    let channels = a.iter().zip(b);
                    channels
                        .map(|(a, b)| if a.to_bits() == b.to_bits() { 0.0 } else { (a - b).abs() })
                        .fold(0.0, f64::max)
                });
                let worst = differences.fold(0.0, f64::max);
                let rounds = [":f32", ":unorm16", ":f16"].iter().any(|s| name.contains(s));
                if method.capabilities().order_dependent {
                    assert!(
                        worst > 1e-6 || list.depth_complexity() <= 4 || name.contains(":16"),
                        "{name}: {worst:e}"
                    );
                } else if !rounds {
                    assert!(worst == 0.0, "{name}: {worst:e}");
                }
            }
        }
    }
}
