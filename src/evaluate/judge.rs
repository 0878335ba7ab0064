//! Methods against the A-buffer on one fragment list.

use super::bins::{self, AlphaBin, CountBin};
use super::order::OrderResult;
use super::{EvaluateError, FlipMap, Image, OverTime, flip, image};
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::{self, Capabilities, Context, Method};
use crate::pixel::{FragmentList, abuffer};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::time::Instant;

/// What one method got right on one fragment list, and how long it took. In JSON, NaN becomes null; the counts say why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodResult {
    /// Name of the method.
    pub method: String,
    /// Memory, passes, needs, and whether the order of the fragments counts.
    #[serde(flatten)]
    pub capabilities: Capabilities,
    /// Mean squared error of T over all fragments; none for methods whose weights are not transmittances and lists
    /// without fragments, NaN where a weight is not finite.
    pub transmittance_mse: Option<f64>,
    /// Greatest absolute error of T over all fragments; none and NaN as for the mean.
    pub transmittance_worst_error: Option<f64>,
    /// Mean squared error of the image over all pixels and channels, unclamped; none where the list makes no image (no
    /// colours, no size, no pixels), NaN where a channel is not finite.
    pub image_mse: Option<f64>,
    /// Peak signal-to-noise ratio of the image for a peak of 1 \[dB\]; none and NaN as for the MSE, and infinite, null
    /// in JSON, where that is 0.
    pub image_psnr_db: Option<f64>,
    /// Mean of the FLIP map; none and NaN as for the MSE.
    pub flip_mean: Option<f64>,
    /// Number of weights that are not finite.
    pub nonfinite: u64,
    /// Number of channel values of the image that are not finite; none where the list makes no image.
    pub image_nonfinite: Option<u64>,
    /// Time of both passes, without the composite \[s\].
    pub seconds: f64,
    /// Time of pass 1, and of whatever else the method does for all pixels at once \[s\].
    pub seconds_accumulate: f64,
    /// Time of the weights of all fragments \[s\].
    pub seconds_weights: f64,
    /// Stem of the names of its picture files; none where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<String>,
    /// Errors in each random order of the fragments, of which the errors above are means; none where order changes
    /// nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orders: Option<Vec<OrderResult>>,
    /// Errors by the number of fragments in a pixel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_fragments_per_pixel: Option<Vec<CountBin>>,
    /// Errors of T by the fragment's alpha; none for methods whose weights are not transmittances and lists without
    /// fragments.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_alpha: Option<Vec<AlphaBin>>,
    /// Change from frame to frame; none where the camera stands still.
    #[serde(default, skip_serializing_if = "Option::is_none", flatten)]
    pub over_time: Option<OverTime>,
}

/// The exact answer for a fragment list, in f64.
#[derive(Debug)]
pub struct Truth<'a> {
    list: &'a FragmentList,
    background: [f64; 3],
    transmittance: Vec<f64>,
    image: Result<Image, EvaluateError>,
}

/// A method's results with the pictures that they are of.
#[derive(Debug, Clone)]
pub struct Judged {
    /// The numbers.
    pub result: MethodResult,
    /// The method's image and how far it looks from the truth; none where the list makes no image.
    pub picture: Option<(Image, FlipMap)>,
}

impl<'a> Truth<'a> {
    /// The exact answer for a list before a background of linear colour.
    pub fn new(list: &'a FragmentList, background: [f64; 3]) -> Self {
        Self {
            list,
            background,
            transmittance: abuffer::list_transmittance(list),
            image: image::ground_truth(list, background),
        }
    }

    /// The list.
    pub fn list(&self) -> &'a FragmentList {
        self.list
    }

    /// Linear colour behind everything.
    pub fn background(&self) -> [f64; 3] {
        self.background
    }

    /// The exact image.
    ///
    /// # Errors
    /// Why the list makes none: no size, no colours, no pixels.
    pub fn image(&self) -> Result<&Image, &EvaluateError> {
        self.image.as_ref()
    }

    /// Runs a method and compares it with the exact answer.
    ///
    /// # Errors
    /// [`EvaluateError::Method`] where the method cannot be applied to the list.
    pub fn judge(&self, method: &dyn Method, context: Context) -> Result<Judged, EvaluateError> {
        let start = Instant::now();
        let accumulated = method.accumulate(self.list, context)?;
        let seconds_accumulate = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let weights = oit::weights(self.list, &*accumulated);
        let seconds_weights = start.elapsed().as_secs_f64();

        let transmittance = AbsoluteError::of(&weights, &self.transmittance);
        let stated = method.weights_are_transmittance() && transmittance.count() > 0;
        let picture = match &self.image {
            Err(_) => None,
            Ok(exact) => {
                let image = image::of_method(self.list, &*accumulated, &weights, self.background)?;
                drop(accumulated);
                let (error, map) = (image.error(exact)?, flip(exact, &image)?);
                Some((error, image, map))
            }
        };
        let error = picture.as_ref().map(|(error, ..)| error);
        let pair = stated.then_some((&weights[..], &self.transmittance[..]));
        let images = picture
            .as_ref()
            .zip(self.image.as_ref().ok())
            .map(|((_, image, _), exact)| (image, exact));
        let result = MethodResult {
            method: method.name(),
            capabilities: method.capabilities(),
            transmittance_mse: stated.then(|| transmittance.mse()),
            transmittance_worst_error: stated.then(|| transmittance.worst()),
            image_mse: error.map(image::ImageError::mse),
            image_psnr_db: error.map(image::ImageError::psnr),
            flip_mean: picture.as_ref().map(|(.., map)| map.mean()),
            nonfinite: transmittance.nonfinite(),
            image_nonfinite: error.map(image::ImageError::nonfinite),
            seconds: seconds_accumulate + seconds_weights,
            seconds_accumulate,
            seconds_weights,
            picture: None,
            orders: None,
            by_fragments_per_pixel: Some(bins::by_count(self.list, pair, images)),
            by_alpha: pair.map(|(weights, exact)| bins::by_alpha(self.list, weights, exact)),
            over_time: None,
        };
        Ok(Judged {
            result,
            picture: picture.map(|(_, image, map)| (image, map)),
        })
    }
}

/// Results of all methods on a list, the least error first.
///
/// A list without colours or size still gives errors of T; what concerns images is then none.
///
/// # Errors
/// [`EvaluateError::Method`] of the first method that cannot be applied to the list; [`Truth::judge`] goes on past it.
pub fn evaluate(
    list: &FragmentList,
    methods: &[Box<dyn Method>],
    context: Context,
    background: [f64; 3],
) -> Result<Vec<MethodResult>, EvaluateError> {
    let truth = Truth::new(list, background);
    let mut results = Vec::with_capacity(methods.len());
    for method in methods {
        results.push(truth.judge(&**method, context)?.result);
    }
    sort_by_error(&mut results);
    Ok(results)
}

/// Sorts by image MSE, or by the MSE of T where there is no image; what is NaN comes last but for what has no number at
/// all, equals by name.
pub fn sort_by_error(results: &mut [MethodResult]) {
    results.sort_by(by_error);
}

/// The order of [`sort_by_error`].
pub fn by_error(a: &MethodResult, b: &MethodResult) -> Ordering {
    let key = |r: &MethodResult| {
        let error = r.image_mse.or(r.transmittance_mse);
        // 0 for numbers, 1 for NaN, 2 for none.
        (error.map_or(2, |e| u8::from(e.is_nan())), error.unwrap_or(0.0).abs())
    };
    let (a_key, b_key) = (key(a), key(b));
    a_key
        .0
        .cmp(&b_key.0)
        .then(a_key.1.total_cmp(&b_key.1))
        .then_with(|| a.method.cmp(&b.method))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::model::mlp::tests::random_mlp;
    use crate::oit::neural::Neural;
    use crate::oit::{Accumulated, MethodError};
    use crate::pixel::CameraPlanes;

    /// Answers exactly, plus an offset; NaN makes every weight NaN.
    pub struct Shifted(pub f64);

    struct Answers<'a>(&'a FragmentList, f64);

    impl Method for Shifted {
        fn name(&self) -> String {
            format!("shifted:{}", self.0)
        }

        fn capabilities(&self) -> Capabilities {
            Capabilities::of_sums(1, false)
        }

        fn accumulate<'a>(
            &'a self,
            list: &'a FragmentList,
            _: Context,
        ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
            Ok(Box::new(Answers(list, self.0)))
        }
    }

    impl Accumulated for Answers<'_> {
        fn weights(&self, p: usize, out: &mut [f64]) {
            abuffer::transmittance(self.0.pixel(p), out);
            out.iter_mut().for_each(|t| *t += self.1);
        }
    }

    /// Weighs all fragments alike, which is not a transmittance.
    struct Alike;

    impl Method for Alike {
        fn name(&self) -> String {
            "alike".to_owned()
        }

        fn capabilities(&self) -> Capabilities {
            Capabilities::of_blending(32)
        }

        fn weights_are_transmittance(&self) -> bool {
            false
        }

        fn accumulate<'a>(&'a self, _: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
            Ok(Box::new(Ones))
        }
    }

    struct Ones;

    impl Accumulated for Ones {
        fn weights(&self, _: usize, out: &mut [f64]) {
            out.fill(1.0);
        }
    }

    /// Three overlapping discs of different colour, opacity and depth, in no order; no two depths of a pixel tie.
    pub fn colored_list(width: u32, height: u32) -> FragmentList {
        let discs: [(f64, f64, f32, f32, [f32; 3]); 3] = [
            (0.40, 0.40, 3.0, 0.4, [0.9, 0.2, 0.1]),
            (0.60, 0.45, 2.0, 0.7, [0.1, 0.7, 0.2]),
            (0.50, 0.65, 4.0, 0.9, [0.1, 0.2, 0.9]),
        ];
        let (mut offsets, mut view_z, mut alpha, mut color) = (vec![0], vec![], vec![], vec![]);
        for p in 0..width * height {
            let (x, y) = (
                f64::from(p % width) / f64::from(width),
                f64::from(p / width) / f64::from(height),
            );
            for (cx, cy, z, a, c) in discs {
                if (x - cx).hypot(y - cy) < 0.3 {
                    view_z.push(z);
                    alpha.push(a);
                    color.push(c);
                }
            }
            offsets.push(view_z.len() as u64);
        }
        FragmentList::new(offsets, view_z, alpha, Some(color))
            .unwrap()
            .with_size(width, height)
            .unwrap()
    }

    fn methods(offsets: &[f64]) -> Vec<Box<dyn Method>> {
        offsets
            .iter()
            .map(|&o| Box::new(Shifted(o)) as Box<dyn Method>)
            .collect()
    }

    /// An offset of 0.1 is a T-MSE of 0.01 and a worst error of 0.1 (to 1e-15); the rows come sorted, NaN last.
    #[test]
    fn errors_and_their_order() {
        let list = colored_list(20, 15);
        let results = evaluate(
            &list,
            &methods(&[f64::NAN, 0.1, 0.0, 0.01]),
            Context::default(),
            [1.0; 3],
        )
        .unwrap();
        let names: Vec<_> = results.iter().map(|r| r.method.as_str()).collect();
        assert_eq!(names, ["shifted:0", "shifted:0.01", "shifted:0.1", "shifted:NaN"]);
        let [exact, _, off, nan] = &results[..] else { panic!() };
        assert_eq!(
            (exact.transmittance_mse, exact.flip_mean, exact.nonfinite),
            (Some(0.0), Some(0.0), 0)
        );
        assert!(
            (off.transmittance_mse.unwrap() - 0.01).abs() < 1e-15
                && (off.transmittance_worst_error.unwrap() - 0.1).abs() < 1e-15
        );
        assert!(off.flip_mean.unwrap() > 1e-3 && off.image_psnr_db.unwrap() < 60.0);
        assert_eq!(nan.nonfinite, list.len() as u64);
        assert!(nan.transmittance_mse.unwrap().is_nan() && nan.transmittance_worst_error.unwrap().is_nan());
        assert!(nan.image_mse.unwrap().is_nan() && nan.flip_mean.unwrap().is_nan() && nan.image_nonfinite.unwrap() > 0);
    }

    /// The bins of a method are of the list's own pixels and fragments; their weighted means are the whole's errors, to
    /// 1e-12 of them.
    #[test]
    fn bins_are_of_the_whole_list() {
        let list = colored_list(20, 15);
        let results = evaluate(&list, &methods(&[0.1]), Context::default(), [1.0; 3]).unwrap();
        let [
            MethodResult {
                transmittance_mse: Some(t),
                image_mse: Some(i),
                by_fragments_per_pixel: Some(counts),
                by_alpha: Some(alphas),
                ..
            },
        ] = &results[..]
        else {
            panic!()
        };
        let n = list.len() as f64;
        let of_counts: f64 = counts
            .iter()
            .map(|b| b.fragments as f64 * b.transmittance_mse.unwrap_or(0.0))
            .sum::<f64>()
            / n;
        let of_alphas: f64 = alphas
            .iter()
            .map(|b| b.fragments as f64 * b.transmittance_mse.unwrap())
            .sum::<f64>()
            / n;
        let of_image: f64 = counts
            .iter()
            .map(|b| b.pixels as f64 * b.image_mse.unwrap())
            .sum::<f64>()
            / list.pixels() as f64;
        for (found, whole) in [(of_counts, t), (of_alphas, t), (of_image, i)] {
            assert!(
                *whole > 1e-6 && (found / whole - 1.0).abs() <= 1e-12,
                "{found} for {whole}"
            );
        }
        // Discs of alpha 0.4, 0.7 and 0.9, up to three in a pixel.
        assert_eq!(
            alphas.iter().map(|b| b.least_alpha).collect::<Vec<_>>(),
            [0.4, 0.7, 0.9]
        );
        assert_eq!(
            counts.iter().map(|b| b.most_fragments_per_pixel).collect::<Vec<_>>(),
            [0, 1, 2, 3]
        );
        // Weights that are no transmittances have errors of the image alone.
        let alike = Truth::new(&list, [1.0; 3])
            .judge(&Alike, Context::default())
            .unwrap()
            .result;
        assert!(
            alike.by_alpha.is_none()
                && alike
                    .by_fragments_per_pixel
                    .unwrap()
                    .iter()
                    .all(|b| b.transmittance_mse.is_none() && b.image_mse.is_some())
        );
    }

    /// A network with random weights is judged like any method; control: exact weights are far better.
    #[test]
    fn a_network_is_judged() {
        let list = colored_list(20, 15).with_planes(CameraPlanes::new(1.0, 8.0).unwrap());
        let neural = Neural::new(random_mlp(&[8], 3));
        let exact: Box<dyn Method> = Box::new(Shifted(0.0));
        let results = evaluate(&list, &[Box::new(neural), exact], Context::default(), [1.0; 3]).unwrap();
        assert!(
            results[1].method.starts_with("neural:") && results[1].transmittance_mse.unwrap() > 1e-4,
            "{results:?}"
        );
        assert!(
            results
                .iter()
                .all(|r| r.nonfinite == 0 && r.seconds == r.seconds_accumulate + r.seconds_weights)
        );
    }

    #[test]
    fn weights_that_are_no_transmittance_have_no_error_of_t() {
        let judged = Truth::new(&colored_list(20, 15), [1.0; 3])
            .judge(&Alike, Context::default())
            .unwrap();
        assert_eq!(
            (judged.result.transmittance_mse, judged.result.transmittance_worst_error),
            (None, None)
        );
        assert!(judged.result.image_mse.unwrap() > 1e-5);
    }

    #[test]
    fn lists_without_colors_or_size_have_errors_of_t_alone() {
        let full = colored_list(4, 5);
        let bare = FragmentList::new(
            full.offsets().to_vec(),
            full.view_z().to_vec(),
            full.alpha().to_vec(),
            None,
        )
        .unwrap();
        let unsized_list = FragmentList::new(
            full.offsets().to_vec(),
            full.view_z().to_vec(),
            full.alpha().to_vec(),
            full.color().map(<[[f32; 3]]>::to_vec),
        );
        for list in [bare.clone(), bare.with_size(4, 5).unwrap(), unsized_list.unwrap()] {
            let truth = Truth::new(&list, [1.0; 3]);
            assert!(truth.image().is_err());
            let judged = truth.judge(&Shifted(0.1), Context::default()).unwrap();
            assert!(judged.picture.is_none() && judged.result.image_mse.is_none() && judged.result.flip_mean.is_none());
            assert!((judged.result.transmittance_mse.unwrap() - 0.01).abs() < 1e-15);
        }
        let none = FragmentList::new(vec![0; 3], vec![], vec![], None)
            .unwrap()
            .with_size(2, 1)
            .unwrap();
        let result = Truth::new(&none, [1.0; 3])
            .judge(&Shifted(0.1), Context::default())
            .unwrap()
            .result;
        assert_eq!(
            (result.transmittance_mse, result.image_mse, result.flip_mean),
            (None, Some(0.0), Some(0.0))
        );
    }

    #[test]
    fn a_method_that_cannot_be_applied_is_named() {
        let neural: Box<dyn Method> = Box::new(Neural::new(random_mlp(&[8], 3)));
        let error = evaluate(&colored_list(4, 4), &[neural], Context::default(), [1.0; 3])
            .unwrap_err()
            .to_string();
        assert!(error.contains("neural:") && error.contains("--near"), "{error}");
    }

    #[test]
    fn json_has_units_in_its_keys_and_null_for_nan() {
        let result = MethodResult {
            method: "neural:m".to_owned(),
            capabilities: Capabilities::of_sums(5, true),
            transmittance_mse: Some(0.25),
            transmittance_worst_error: Some(f64::NAN),
            image_mse: Some(0.5),
            image_psnr_db: Some(f64::INFINITY),
            flip_mean: None,
            nonfinite: 1,
            image_nonfinite: Some(0),
            seconds: 0.75,
            seconds_accumulate: 0.5,
            seconds_weights: 0.25,
            picture: Some("neural-m".to_owned()),
            orders: Some(vec![OrderResult {
                shuffled: crate::evaluate::Shuffled::Objects,
                seed: 3,
                transmittance_mse: Some(0.25),
                image_mse: Some(0.5),
                flip_mean: None,
            }]),
            by_fragments_per_pixel: Some(vec![CountBin {
                least_fragments_per_pixel: 5,
                most_fragments_per_pixel: 8,
                pixels: 2,
                fragments: 11,
                transmittance_mse: Some(0.25),
                image_mse: Some(f64::NAN),
            }]),
            by_alpha: Some(vec![AlphaBin {
                least_alpha: 0.1,
                most_alpha: 0.2,
                fragments: 11,
                transmittance_mse: Some(0.25),
            }]),
            over_time: None,
        };
        let text = serde_json::to_string_pretty(&result).unwrap();
        insta::assert_snapshot!(text);
        let back: MethodResult = serde_json::from_str(&text).unwrap();
        let by_fragments_per_pixel = result.by_fragments_per_pixel.clone().map(|bins| {
            vec![CountBin {
                image_mse: None,
                ..bins[0].clone()
            }]
        });
        assert_eq!(
            back,
            MethodResult {
                transmittance_worst_error: None,
                image_psnr_db: None,
                by_fragments_per_pixel,
                ..result
            }
        );
    }
}
