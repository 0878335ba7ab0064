//! Ground truth: all fragments of a pixel, sorted, in f64.

use super::{FragmentList, Pixel, absorbance};
use crate::numeric::exact_sum::ExactSum;
use std::convert::Infallible;

/// Transmittance in front of every fragment of a pixel, in the order of the input.
///
/// T_f = exp(−Σ A_i) over the fragments strictly nearer than f: fragments at one depth do not hide each other.
///
/// # Source
/// NMT24 Eq. 3–4, with the absorbance clamped as [`absorbance()`] does.
///
/// # Shapes
/// `out: [n]`, n = number of fragments of the pixel.
///
/// # Panics
/// If `out` is not as long as the pixel has fragments.
pub fn transmittance(pixel: Pixel<'_>, out: &mut [f64]) {
    assert_eq!(out.len(), pixel.len());
    let mut order = Vec::new();
    front_to_back(pixel, &mut order);
    let mut in_front = 0.0;
    let mut at_this_depth = 0.0;
    let mut depth = f32::NEG_INFINITY;
    for &i in &order {
        let i = i as usize;
        if pixel.view_z[i] > depth {
            in_front += at_this_depth;
            at_this_depth = 0.0;
            depth = pixel.view_z[i];
        }
        out[i] = libm::exp(-in_front);
        at_this_depth += absorbance(pixel.alpha[i]);
    }
}

/// [`transmittance`] of every fragment of a list, in its order, on all cores.
pub fn list_transmittance(list: &FragmentList) -> Vec<f64> {
    of_list(list, transmittance)
}

/// Factor by which blending from front to back has come down when it reaches a fragment, in the order of the input: Π
/// e^−A over the fragments before it in the order (view_z, input index).
///
/// It is the weight that [`composite`] gives to a fragment, and [`transmittance`] but for ties, which it breaks.
///
/// # Source
/// DWB22 Eq. 3.2–3.3 (Adst as a fragment meets it), with the absorbance clamped as [`absorbance()`] does.
///
/// # Shapes
/// `out: [n]`, n = number of fragments of the pixel.
///
/// # Panics
/// If `out` is not as long as the pixel has fragments.
pub fn front_to_back_factor(pixel: Pixel<'_>, out: &mut [f64]) {
    assert_eq!(out.len(), pixel.len());
    let mut order = Vec::new();
    front_to_back(pixel, &mut order);
    let mut in_front = 0.0;
    for &i in &order {
        let i = i as usize;
        out[i] = libm::exp(-in_front);
        in_front += absorbance(pixel.alpha[i]);
    }
}

/// [`front_to_back_factor`] of every fragment of a list, in its order, on all cores.
pub fn list_front_to_back_factor(list: &FragmentList) -> Vec<f64> {
    of_list(list, front_to_back_factor)
}

fn of_list(list: &FragmentList, f: fn(Pixel<'_>, &mut [f64])) -> Vec<f64> {
    let mut out = vec![0.0; list.len()];
    let Ok(()) = list.par_pixels(
        0..list.pixels(),
        &mut out,
        1,
        |_, pixel, out| -> Result<(), Infallible> {
            f(pixel, out);
            Ok(())
        },
    );
    out
}

/// Total absorbance b0 = Σ A_i of a pixel, the same to the bit in any order of the fragments.
pub fn total_absorbance(pixel: Pixel<'_>) -> f64 {
    pixel.alpha.iter().map(|&a| absorbance(a)).collect::<ExactSum>().value()
}

/// Colour of a pixel under the over operator: C = Σ a_i C_i T_i + e^−b0 C_bg.
///
/// Fragments are taken in the order (view_z, input index) and each is weighted by T in *that order*, so that of two
/// tied fragments the one that came first lies in front. This is the one place where a tie is broken; [`transmittance`]
/// breaks none.
///
/// # Source
/// NMT24 Eq. 1–2.
///
/// # Panics
/// If the pixel has fragments and no colours.
pub fn composite(pixel: Pixel<'_>, background: [f64; 3]) -> [f64; 3] {
    let color = match pixel.color {
        Some(color) => color,
        None if pixel.is_empty() => &[],
        None => panic!("compositing needs colours"),
    };
    let mut sum = [0.0; 3];
    let mut in_front = 0.0;
    let mut order = Vec::new();
    front_to_back(pixel, &mut order);
    for &i in &order {
        let i = i as usize;
        let weight = f64::from(pixel.alpha[i]) * libm::exp(-in_front);
        for (s, &c) in sum.iter_mut().zip(&color[i]) {
            *s += weight * f64::from(c);
        }
        in_front += absorbance(pixel.alpha[i]);
    }
    let behind = libm::exp(-in_front);
    std::array::from_fn(|c| sum[c] + behind * background[c])
}

/// Input indices in the order (view_z, input index); what `order` held is dropped.
pub fn front_to_back(pixel: Pixel<'_>, order: &mut Vec<u32>) {
    order.clear();
    order.extend(0..pixel.len() as u32);
    order.sort_unstable_by(|&a, &b| {
        pixel.view_z[a as usize]
            .total_cmp(&pixel.view_z[b as usize])
            .then(a.cmp(&b))
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn truth(view_z: &[f32], alpha: &[f32]) -> Vec<f64> {
        let mut out = vec![f64::NAN; view_z.len()];
        transmittance(
            Pixel {
                view_z,
                alpha,
                color: None,
            },
            &mut out,
        );
        out
    }

    /// Equal alphas: T_k = (1 − a)^k for the k-th nearest, however the input is ordered.
    #[test]
    fn equal_alphas_give_powers() {
        for a in [0.1f32, 0.25, 0.5, 0.9] {
            let n = 9;
            let view_z: Vec<f32> = (0..n).map(|i| 1.0 + ((i * 4) % n) as f32).collect();
            let t = truth(&view_z, &vec![a; n]);
            for (v, t) in view_z.iter().zip(t) {
                let expected = (1.0 - f64::from(a)).powi((v - 1.0) as i32);
                assert!((t - expected).abs() < 1e-15, "a {a} depth {v}: {t} against {expected}");
            }
        }
    }

    #[test]
    fn ties_do_not_hide_each_other() {
        let t = truth(&[2.0, 1.0, 2.0, 3.0], &[0.5, 0.5, 0.5, 0.5]);
        let expected = [0.5, 1.0, 0.5, 0.125];
        assert!(t.iter().zip(expected).all(|(t, e)| (t - e).abs() < 1e-15), "{t:?}");
    }

    /// The front-to-back factor breaks ties as the composite does, and is T where there are none.
    #[test]
    fn front_to_back_factors_break_ties() {
        let pixel = Pixel {
            view_z: &[2.0, 1.0, 2.0, 3.0],
            alpha: &[0.5; 4],
            color: None,
        };
        let mut factor = [f64::NAN; 4];
        front_to_back_factor(pixel, &mut factor);
        let expected = [0.5, 1.0, 0.25, 0.125];
        assert!(
            factor.iter().zip(expected).all(|(t, e)| (t - e).abs() < 1e-15),
            "{factor:?}"
        );
        let list = FragmentList::new(vec![0, 0, 4], pixel.view_z.to_vec(), pixel.alpha.to_vec(), None).unwrap();
        assert_eq!(list_front_to_back_factor(&list), factor);
        assert_ne!(list_transmittance(&list), factor);
    }

    #[test]
    fn alpha_one_leaves_e_to_the_minus_ten_and_alpha_zero_all() {
        let t = truth(&[1.0, 2.0, 3.0], &[1.0, 0.0, 0.5]);
        assert_eq!(t[0], 1.0);
        assert!((t[1] - (-10.0f64).exp()).abs() < 1e-18 && t[1] == t[2]);
    }

    #[test]
    fn empty_and_single() {
        assert!(truth(&[], &[]).is_empty());
        assert_eq!(truth(&[5.0], &[0.7]), [1.0]);
        let empty = Pixel {
            view_z: &[],
            alpha: &[],
            color: None,
        };
        assert_eq!(composite(empty, [0.1, 0.2, 0.3]), [0.1, 0.2, 0.3]);
    }

    /// Half-opaque red in front of half-opaque green in front of white, and tied: the first of the input is in front.
    #[test]
    fn over_operator() {
        let color = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
        let behind = Pixel {
            view_z: &[2.0, 1.0],
            alpha: &[0.5, 0.5],
            color: Some(&color),
        };
        assert_close(composite(behind, [1.0; 3]), [0.75, 0.5, 0.25]);
        let tied = Pixel {
            view_z: &[1.0, 1.0],
            alpha: &[0.5, 0.5],
            color: Some(&color),
        };
        assert_close(composite(tied, [1.0; 3]), [0.5, 0.75, 0.25]);
    }

    fn assert_close(a: [f64; 3], b: [f64; 3]) {
        assert!(
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15),
            "{a:?} against {b:?}"
        );
    }

    proptest! {
        /// T against the product Π (1 − a_j) over strictly nearer j, taken without sorting, on alphas below the clamp.
        /// Tolerance 1e-12 relative.
        #[test]
        fn agrees_with_the_unsorted_product(pairs in prop::collection::vec((0.5f32..8.0, 0.0f32..0.99), 0..40)) {
            let (view_z, alpha): (Vec<f32>, Vec<f32>) = pairs.into_iter().map(|(v, a)| ((v * 4.0).round() / 4.0,
                a)).unzip();
            for (i, t) in truth(&view_z, &alpha).into_iter().enumerate() {
                let nearer = (0..alpha.len()).filter(|&j| view_z[j] < view_z[i]);
                let product: f64 = nearer.map(|j| 1.0 - f64::from(alpha[j])).product();
                prop_assert!((t - product).abs() <= 1e-12 * product, "{t} against {product}");
            }
        }
    }
}
