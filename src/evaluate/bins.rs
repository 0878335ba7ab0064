//! Errors apart by depth complexity and by opacity: where a method is good, and where it is not.

use super::Image;
use crate::numeric::tolerance::AbsoluteError;
use crate::pixel::FragmentList;
use serde::{Deserialize, Serialize};

/// Errors in those pixels that hold so many fragments. In JSON, NaN becomes null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CountBin {
    /// Least number of fragments of a pixel.
    pub least_fragments_per_pixel: u64,
    /// Greatest number of fragments of a pixel, included.
    pub most_fragments_per_pixel: u64,
    /// Number of such pixels in the list.
    pub pixels: u64,
    /// Number of their fragments.
    pub fragments: u64,
    /// Mean squared error of T over these fragments; none and NaN as for the whole list, and none in empty pixels.
    pub transmittance_mse: Option<f64>,
    /// Mean squared error of the image over these pixels and all channels; none and NaN as for the whole image.
    pub image_mse: Option<f64>,
}

/// Errors of those fragments that are so opaque. In JSON, NaN becomes null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AlphaBin {
    /// Least alpha.
    pub least_alpha: f32,
    /// Greatest alpha; included in the last bin alone.
    pub most_alpha: f32,
    /// Number of such fragments in the list.
    pub fragments: u64,
    /// Mean squared error of T over these fragments; NaN where a weight is not finite.
    pub transmittance_mse: Option<f64>,
}

/// Number of bins of alpha, equal in width.
const ALPHA_BINS: usize = 10;

/// The bin of a pixel with n fragments: 0, 1, 2, 3 and 4 have one each, then come 5 to 8, 9 to 16, and so on by powers
/// of two.
fn count_bin(n: usize) -> usize {
    if n <= 4 { n } else { (n - 1).ilog2() as usize + 3 }
}

/// Least and greatest number of fragments of a bin.
fn counts_of(bin: usize) -> (u64, u64) {
    if bin <= 4 {
        (bin as u64, bin as u64)
    } else {
        ((1 << (bin - 3)) + 1, 1 << (bin - 2))
    }
}

/// Lower end of a bin of alpha, and the upper end of the one before it.
fn alpha_edge(bin: usize) -> f32 {
    bin as f32 / ALPHA_BINS as f32
}

/// The bin of an alpha in [0, 1]. Edges belong to the bin above them, and are those f32 that 0.1, 0.2, … round to.
fn alpha_bin(alpha: f32) -> usize {
    (1..ALPHA_BINS).take_while(|&bin| alpha >= alpha_edge(bin)).count()
}

/// Errors by the number of fragments in a pixel; bins without a pixel are left out.
///
/// The mean of `transmittance_mse` weighted by `fragments` is the list's, that of `image_mse` weighted by `pixels` the
/// image's.
///
/// # Shapes
/// `weights: [F]` and `exact: [F]`, none where the weights are no transmittances; `images` is a method's and the exact
/// one.
///
/// # Panics
/// If the lengths do not fit the list.
pub fn by_count(
    list: &FragmentList,
    transmittances: Option<(&[f64], &[f64])>,
    images: Option<(&Image, &Image)>,
) -> Vec<CountBin> {
    let bins = count_bin(list.depth_complexity()) + 1;
    let mut pixels = vec![0u64; bins];
    let mut fragments = vec![0u64; bins];
    let mut of_t = vec![AbsoluteError::default(); bins];
    let mut of_image = vec![AbsoluteError::default(); bins];
    for p in 0..list.pixels() {
        let range = list.range(p);
        let bin = count_bin(range.len());
        pixels[bin] += 1;
        fragments[bin] += range.len() as u64;
        if let Some((weights, exact)) = transmittances {
            weights[range.clone()]
                .iter()
                .zip(&exact[range])
                .for_each(|(&w, &e)| of_t[bin].add(w, e));
        }
        if let Some((image, exact)) = images {
            image.pixels()[p]
                .iter()
                .zip(exact.pixels()[p])
                .for_each(|(&c, e)| of_image[bin].add(c, e));
        }
    }
    (0..bins)
        .filter(|&bin| pixels[bin] > 0)
        .map(|bin| {
            let (least, most) = counts_of(bin);
            CountBin {
                least_fragments_per_pixel: least,
                most_fragments_per_pixel: most,
                pixels: pixels[bin],
                fragments: fragments[bin],
                transmittance_mse: (transmittances.is_some() && fragments[bin] > 0).then(|| of_t[bin].mse()),
                image_mse: images.map(|_| of_image[bin].mse()),
            }
        })
        .collect()
}

/// Errors of T by the fragment's own alpha; bins without a fragment are left out.
///
/// The mean of `transmittance_mse` weighted by `fragments` is the list's.
///
/// # Shapes
/// `weights: [F]`, `exact: [F]`.
///
/// # Panics
/// If the lengths do not fit the list.
pub fn by_alpha(list: &FragmentList, weights: &[f64], exact: &[f64]) -> Vec<AlphaBin> {
    assert_eq!(
        (weights.len(), exact.len()),
        (list.len(), list.len()),
        "one weight a fragment"
    );
    let mut of_t = [AbsoluteError::default(); ALPHA_BINS];
    for ((&alpha, &w), &e) in list.alpha().iter().zip(weights).zip(exact) {
        of_t[alpha_bin(alpha)].add(w, e);
    }
    of_t.iter()
        .enumerate()
        .filter(|(_, error)| error.count() > 0)
        .map(|(bin, error)| AlphaBin {
            least_alpha: alpha_edge(bin),
            most_alpha: alpha_edge(bin + 1),
            fragments: error.count(),
            transmittance_mse: Some(error.mse()),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    #[test]
    fn counts_fall_into_their_bins() {
        let expected = [
            (0, 0),
            (1, 1),
            (2, 2),
            (3, 3),
            (4, 4),
            (5, 8),
            (9, 16),
            (17, 32),
            (33, 64),
            (65, 128),
        ];
        for (bin, &(least, most)) in expected.iter().enumerate() {
            assert_eq!(counts_of(bin), (least, most));
            assert_eq!((count_bin(least as usize), count_bin(most as usize)), (bin, bin));
        }
        // Every number has one bin, and it holds it.
        for n in 0..5000 {
            let (least, most) = counts_of(count_bin(n));
            assert!((least..=most).contains(&(n as u64)), "{n}");
        }
    }

    #[test]
    fn alphas_fall_into_their_bins() {
        let cases = [
            (0.0, 0),
            (0.0999, 0),
            (0.1, 1),
            (0.3, 3),
            (0.599_999_9, 5),
            (0.6, 6),
            (0.7, 7),
            (0.95, 9),
            (1.0, 9),
        ];
        for (alpha, bin) in cases {
            assert_eq!(alpha_bin(alpha), bin, "{alpha}");
        }
        assert_eq!((alpha_edge(0), alpha_edge(ALPHA_BINS)), (0.0, 1.0));
    }

    /// A list with pixels of 0 to 40 fragments, exact answers, answers that are off by up to 0.1, and two images.
    fn sample() -> (FragmentList, Vec<f64>, Vec<f64>, Image, Image) {
        let mut rng = stream(3, 0, 0);
        let mut offsets = vec![0u64];
        for p in 0..400u64 {
            let n = if p % 7 == 0 { 0 } else { rng.random_range(1..=40u64) };
            offsets.push(offsets[p as usize] + n);
        }
        let n = offsets[400] as usize;
        let alpha: Vec<f32> = (0..n)
            .map(|i| [0.0, 1.0, 0.5, rng.random_range(0.0..1.0)][i % 4])
            .collect();
        let list = FragmentList::new(offsets, vec![1.0; n], alpha, None)
            .unwrap()
            .with_size(20, 20)
            .unwrap();
        let exact: Vec<f64> = (0..n).map(|_| rng.random_range(0.0..1.0)).collect();
        let weights = exact.iter().map(|e| e + rng.random_range(-0.1..0.1)).collect();
        let mut image = || {
            Image::new(
                20,
                20,
                (0..400)
                    .map(|_| std::array::from_fn(|_| rng.random_range(0.0..1.0)))
                    .collect(),
            )
            .unwrap()
        };
        (list, weights, exact, image(), image())
    }

    /// Counts add up to the list's, weighted means of bins to the whole's within 1e-12 of it. Control: means that are
    /// not weighted do not.
    #[test]
    fn bins_make_the_whole() {
        let (list, weights, exact, image, truth) = sample();
        let whole = AbsoluteError::of(&weights, &exact).mse();
        let whole_image = image.error(&truth).unwrap().mse();
        let counts = by_count(&list, Some((&weights, &exact)), Some((&image, &truth)));
        let alphas = by_alpha(&list, &weights, &exact);
        assert!(counts.len() >= 6 && alphas.len() == ALPHA_BINS);
        assert_eq!(counts.iter().map(|b| b.pixels).sum::<u64>(), 400);
        assert_eq!(counts.iter().map(|b| b.fragments).sum::<u64>(), list.len() as u64);
        assert_eq!(alphas.iter().map(|b| b.fragments).sum::<u64>(), list.len() as u64);
        assert!(
            counts[0].most_fragments_per_pixel == 0 && counts[0].pixels == 58 && counts[0].transmittance_mse.is_none()
        );

        let off = |pairs: &[(u64, Option<f64>)], whole: f64| {
            let total: u64 = pairs.iter().map(|p| p.0).sum();
            let weighted = pairs.iter().filter_map(|&(n, e)| e.map(|e| n as f64 * e)).sum::<f64>() / total as f64;
            let plain =
                pairs.iter().filter_map(|p| p.1).sum::<f64>() / pairs.iter().filter(|p| p.1.is_some()).count() as f64;
            [weighted, plain].map(|mean| (mean / whole - 1.0).abs())
        };
        let cases = [
            off(
                &counts
                    .iter()
                    .map(|b| (b.fragments, b.transmittance_mse))
                    .collect::<Vec<_>>(),
                whole,
            ),
            off(
                &alphas
                    .iter()
                    .map(|b| (b.fragments, b.transmittance_mse))
                    .collect::<Vec<_>>(),
                whole,
            ),
            off(
                &counts.iter().map(|b| (b.pixels, b.image_mse)).collect::<Vec<_>>(),
                whole_image,
            ),
        ];
        for (i, [weighted, plain]) in cases.into_iter().enumerate() {
            assert!(weighted <= 1e-12, "{i}: {weighted}");
            assert!(plain > 1e-12, "{i}: the control passed");
        }
    }

    /// A weight that is not finite spoils its own bins, and no other.
    #[test]
    fn what_is_not_finite_stays_in_its_bin() {
        let list = FragmentList::new(vec![0, 1, 3], vec![1.0; 3], vec![0.05, 0.55, 0.95], None).unwrap();
        let exact = [1.0, 1.0, 0.5];
        let weights = [1.0, f64::NAN, 0.75];
        let counts = by_count(&list, Some((&weights, &exact)), None);
        assert_eq!(
            (counts.len(), counts[0].transmittance_mse, counts[0].image_mse),
            (2, Some(0.0), None)
        );
        assert!(counts[1].transmittance_mse.unwrap().is_nan());
        let alphas = by_alpha(&list, &weights, &exact);
        assert_eq!(alphas.iter().map(|b| b.fragments).collect::<Vec<_>>(), [1, 1, 1]);
        assert_eq!(
            (alphas[0].transmittance_mse, alphas[2].transmittance_mse),
            (Some(0.0), Some(0.0625))
        );
        assert!(alphas[1].transmittance_mse.unwrap().is_nan());
    }

    #[test]
    fn empty_lists_have_empty_bins() {
        let none = FragmentList::new(vec![0], vec![], vec![], None).unwrap();
        assert!(by_count(&none, Some((&[], &[])), None).is_empty() && by_alpha(&none, &[], &[]).is_empty());
        let background = FragmentList::new(vec![0; 4], vec![], vec![], None).unwrap();
        let bins = by_count(&background, Some((&[], &[])), None);
        assert_eq!((bins.len(), bins[0].pixels, bins[0].transmittance_mse), (1, 3, None));
    }
}
