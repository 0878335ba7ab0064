//! McGuire and Bavoil's weighted blended transparency: a fixed function of depth and opacity stands in for the
//! transmittance.

use super::capabilities::{Capabilities, sums};
use super::registry::{Arguments, Entry, ParseError};
use super::shader::{Composite, MethodShader};
use super::{Accumulated, Context, Method, MethodError, composite_normalised};
use crate::features::MomentDepthKind;
use crate::numeric::exact_sum::ExactSum;
use crate::pixel::{CameraPlanes, DepthError, FragmentList, ViewZ, abuffer};

/// Its name on the command line; `weighted-blended:WEIGHT` chooses a weight, by default that of [`Weight::default`].
pub const NAME: &str = "weighted-blended";

/// Weight functions w(z, a). MB13's were made for view depths from 0.1 to 500.
///
/// `a` is in them once more than in the composite, which multiplies by it too: that is how they are published.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weight {
    /// a · max(10^−2, min(3·10^3, 10/(10^−5 + (z/5)^2 + (z/200)^6))).
    ///
    /// MB13 Eq. 7, DWB22 Eq. 3.5.
    Mb13Eq7,
    /// a · max(10^−2, min(3·10^3, 10/(10^−5 + (z/10)^3 + (z/200)^6))).
    ///
    /// MB13 Eq. 8, DWB22 Eq. 3.6.
    Mb13Eq8,
    /// a · max(10^−2, min(3·10^3, 0.03/(10^−5 + (z/200)^4))).
    ///
    /// MB13 Eq. 9, DWB22 Eq. 3.7.
    #[default]
    Mb13Eq9,
    /// a · max(10^−2, 3·10^3 (1 − w)^3), w the window depth; the only one that needs camera planes.
    ///
    /// MB13 Eq. 10, DWB22 Eq. 3.8.
    Mb13Eq10,
    /// a · max(10^−2, min(8, 0.3·10^5 + (1 − z/200)^4)) as printed. The second term of `min` is never below 30000, so
    /// that the weight is the constant 8a, and is computed as that.
    ///
    /// DWB22 Eq. 3.10.
    Dwb22,
    /// a · max(10^−2, min(8, 0.3·10^−5 + (1 − z/200)^4)): the same with the exponent's sign, which seems lost in print.
    /// It falls with depth up to z = 200 and rises beyond.
    ///
    /// DWB22 Eq. 3.10, our reading.
    Dwb22Small,
    /// a · max(10^−2, min(1, 0.3/(10^−5 + ((1 − z)/200)^4))): what the shader computes, whose last clamp makes the 8
    /// ineffective. It is the constant a up to z = 149.
    ///
    /// DWB22 App. B.2.
    Dwb22Shader,
}

impl Weight {
    /// Every weight.
    pub const ALL: [Self; 7] = [
        Self::Mb13Eq7,
        Self::Mb13Eq8,
        Self::Mb13Eq9,
        Self::Mb13Eq10,
        Self::Dwb22,
        Self::Dwb22Small,
        Self::Dwb22Shader,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mb13Eq7 => "mb13-7",
            Self::Mb13Eq8 => "mb13-8",
            Self::Mb13Eq9 => "mb13-9",
            Self::Mb13Eq10 => "mb13-10",
            Self::Dwb22 => "dwb22",
            Self::Dwb22Small => "dwb22-small",
            Self::Dwb22Shader => "dwb22-shader",
        }
    }

    /// The weight of a fragment.
    ///
    /// # Domain
    /// view_z > 0 [scene units], alpha in [0, 1].
    ///
    /// # Errors
    /// [`DepthError::NoPlanes`] and [`DepthError::OutsidePlanes`], of [`Self::Mb13Eq10`] alone.
    pub fn of(self, view_z: f32, alpha: f32, planes: Option<CameraPlanes>) -> Result<f64, DepthError> {
        let z = f64::from(view_z);
        let square = |x: f64| x * x;
        let cube = |x: f64| x * x * x;
        let bounded = |x: f64| x.clamp(1e-2, 3e3);
        let factor = match self {
            Self::Mb13Eq7 => bounded(10.0 / (1e-5 + square(z / 5.0) + cube(square(z / 200.0)))),
            Self::Mb13Eq8 => bounded(10.0 / (1e-5 + cube(z / 10.0) + cube(square(z / 200.0)))),
            Self::Mb13Eq9 => bounded(0.03 / (1e-5 + square(square(z / 200.0)))),
            Self::Mb13Eq10 => (3e3 * cube(1.0 - planes.ok_or(DepthError::NoPlanes)?.window(ViewZ(z))?.0)).max(1e-2),
            Self::Dwb22 => 8.0,
            Self::Dwb22Small => (0.3e-5 + square(square(1.0 - z / 200.0))).clamp(1e-2, 8.0),
            Self::Dwb22Shader => (0.3 / (1e-5 + square(square((1.0 - z) / 200.0)))).clamp(1e-2, 1.0),
        };
        Ok(f64::from(alpha) * factor)
    }
}

/// What view depths are multiplied by before a weight function takes them, which was made for depths from 0.1 to 500.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum DepthScale {
    /// 1: the scene's own units.
    #[default]
    Units,
    /// The power of √2, from 2^−12 to 2^12, whose image comes nearest to the A-buffer's over at most 4096 pixels of the
    /// list: no renderer can know it, and no fixed choice does better by more than the step.
    Best,
}

/// Weighted blended transparency: C = Σ w a C/Σ w a · (1 − e^−b0) + e^−b0 C_bg.
///
/// # Source
/// MB13 Eq. 6.
#[derive(Debug, Clone, Copy, Default)]
pub struct WeightedBlended {
    /// Its weight function.
    pub weight: Weight,
    /// What depths are multiplied by.
    pub scale: DepthScale,
}

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "weighted-blended[:WEIGHT][:best-scale]",
    source: "McGuire, Bavoil, JCGT 2(2) 2013; Papakostas, MSc thesis, Ioannina 2022",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    let in_units = Weight::ALL.map(|w| format!("{head}:{}", w.name()));
    let scaled = SCALED.map(|w| format!("{head}:{}{BEST_SCALE}", w.name()));
    in_units.into_iter().chain(scaled).collect()
}

/// The end of a name that asks for [`DepthScale::Best`].
const BEST_SCALE: &str = ":best-scale";

/// Weights whose depth scale is worth a search: those of MB13 that take view depth.
const SCALED: [Weight; 3] = [Weight::Mb13Eq7, Weight::Mb13Eq8, Weight::Mb13Eq9];

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    let (name, scale) = match arguments.argument {
        None => (Weight::default().name(), DepthScale::Units),
        Some(text) => match text.strip_suffix(BEST_SCALE) {
            Some(name) => (name, DepthScale::Best),
            None => (text, DepthScale::Units),
        },
    };
    let weight = Weight::ALL.into_iter().find(|w| w.name() == name);
    match weight {
        Some(weight) if scale == DepthScale::Units || SCALED.contains(&weight) => {
            Ok(Box::new(WeightedBlended { weight, scale }))
        }
        Some(_) => Err(arguments.wrong(format!(
            "best-scale goes with {} only; expected one of them",
            SCALED.map(Weight::name).join(", ")
        ))),
        None => Err(arguments.wrong(format!("expected one of {}", Weight::ALL.map(Weight::name).join(", ")))),
    }
}

impl Method for WeightedBlended {
    fn name(&self) -> String {
        let scale = if self.scale == DepthScale::Best { BEST_SCALE } else { "" };
        format!("{NAME}:{}{scale}", self.weight.name())
    }

    /// b0, or what is left of the background; Σ w a lies in the colour's fourth channel.
    fn capabilities(&self) -> Capabilities {
        Capabilities::of_blending(sums(1))
    }

    /// They only fall with depth as transmittance does.
    fn weights_are_transmittance(&self) -> bool {
        false
    }

    fn shader(&self) -> Option<MethodShader> {
        if self.scale == DepthScale::Best {
            return None;
        }
        let depth = match self.weight {
            Weight::Mb13Eq10 => MomentDepthKind::Window,
            _ => MomentDepthKind::None,
        };
        let function = format!("weight_{}", self.weight.name().replace('-', "_"));
        let weight = include_str!("weighted_blended_weight.wgsl").replace("OIT_FUNCTION", &function);
        let source = format!("{}{weight}", include_str!("weighted_blended.wgsl"));
        Some(MethodShader::of_total(
            self.name(),
            depth,
            Composite::Normalised,
            &source,
        ))
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let planes = context.planes_for(list);
        let scale = match self.scale {
            DepthScale::Units => 1.0,
            DepthScale::Best => self.best_scale(list),
        };
        let mut weights = vec![0.0; list.len()];
        list.par_pixels(0..list.pixels(), &mut weights, 1, |_, pixel, out| {
            for ((out, &v), &a) in out.iter_mut().zip(pixel.view_z).zip(pixel.alpha) {
                *out = self.weight.of(scale * v, a, planes)?;
            }
            Ok(())
        })
        .map_err(|source| MethodError::Depth {
            method: self.name(),
            source,
        })?;
        Ok(Box::new(Weighted { list, weights }))
    }
}

/// Most pixels that the best depth scale is looked for on.
const SCALE_PIXELS: usize = 4096;

impl WeightedBlended {
    /// The depth scale of the least image error over white, or of 1 where the list has no colours.
    fn best_scale(&self, list: &FragmentList) -> f32 {
        if list.color().is_none() {
            return 1.0;
        }
        let step = list.pixels().div_ceil(SCALE_PIXELS).max(1);
        let pixels = || (0..list.pixels()).step_by(step);
        let exact: Vec<[f64; 3]> = pixels().map(|p| abuffer::composite(list.pixel(p), [1.0; 3])).collect();
        let error = |scale: f32| -> f64 {
            let of_pixel = |(p, exact): (usize, &[f64; 3])| {
                let pixel = list.pixel(p);
                let weigh = |(&v, &a): (&f32, &f32)| self.weight.of(scale * v, a, None).unwrap_or(0.0);
                let weights: Vec<f64> = pixel.view_z.iter().zip(pixel.alpha).map(weigh).collect();
                let ours = composite_normalised(pixel, &weights, [1.0; 3]);
                ours.iter().zip(exact).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
            };
            pixels().zip(&exact).map(of_pixel).collect::<ExactSum>().value()
        };
        let scales = (-24..=24).map(|k| libm::exp2(0.5 * f64::from(k)) as f32);
        let errors = scales.map(|scale| (scale, error(scale)));
        errors
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(1.0, |(scale, _)| scale)
    }
}

struct Weighted<'a> {
    list: &'a FragmentList,
    weights: Vec<f64>,
}

impl Accumulated for Weighted<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        out.copy_from_slice(&self.weights[self.list.range(p)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;

    fn blended(weight: Weight) -> WeightedBlended {
        WeightedBlended {
            weight,
            scale: DepthScale::Units,
        }
    }

    /// The same depths in another unit leave the best scale's image as it was, to the step of a factor √2; in fixed
    /// units they change it. And the best is never worse than any of the scales that are tried: here that of the units.
    #[test]
    fn the_best_scale_knows_no_units() {
        let list = untied(6);
        let of = |scale, factor: f32| {
            let view_z: Vec<f32> = list.view_z().iter().map(|v| v * factor).collect();
            let color = list.color().unwrap().to_vec();
            let list = FragmentList::new(list.offsets().to_vec(), view_z, list.alpha().to_vec(), Some(color)).unwrap();
            let weight = Weight::Mb13Eq9;
            image_mse(&WeightedBlended { weight, scale }, &list)
        };
        let best = of(DepthScale::Best, 1.0);
        assert!((of(DepthScale::Best, 64.0) / best - 1.0).abs() < 1e-9);
        assert!(best <= of(DepthScale::Units, 1.0) && best < 0.99 * of(DepthScale::Units, 1.0 / 64.0));
    }

    /// Each formula at a depth where its powers are plain numbers, and at both of its bounds.
    #[test]
    fn weights_by_hand() {
        let planes = CameraPlanes::new(0.5, 10.0).ok();
        let of = |weight: Weight, z| weight.of(z, 0.5, planes).unwrap();
        let far = |x: f64, power: i32| (x / 200.0).powi(power);
        for (weight, z, expected) in [
            (Weight::Mb13Eq7, 10.0, 0.5 * 10.0 / (1e-5 + 4.0 + far(10.0, 6))),
            (Weight::Mb13Eq7, 0.01, 1500.0),
            (Weight::Mb13Eq7, 2000.0, 0.005),
            (Weight::Mb13Eq8, 20.0, 0.5 * 10.0 / (1e-5 + 8.0 + far(20.0, 6))),
            (Weight::Mb13Eq8, 0.5, 1500.0),
            (Weight::Mb13Eq8, 2000.0, 0.005),
            (Weight::Mb13Eq9, 200.0, 0.5 * 0.03 / (1e-5 + 1.0)),
            (Weight::Mb13Eq9, 20.0, 0.5 * 0.03 / (1e-5 + 1e-4)),
            // 0.03/10^−5, the greatest it comes to, is the bound itself.
            (Weight::Mb13Eq9, 1e-3, 1500.0),
            (Weight::Mb13Eq9, 2000.0, 0.005),
            // w = 10 · 0.5/9.5
            (Weight::Mb13Eq10, 1.0, 0.5 * 3e3 * (4.5f64 / 9.5).powi(3)),
            (Weight::Mb13Eq10, 0.5, 1500.0),
            (Weight::Mb13Eq10, 10.0, 0.005),
            (Weight::Dwb22Small, 100.0, 0.5 * (0.3e-5 + 0.0625)),
            (Weight::Dwb22Small, 200.0, 0.005),
            (Weight::Dwb22Small, 600.0, 4.0),
            (Weight::Dwb22Shader, 10.0, 0.5),
            (Weight::Dwb22Shader, 201.0, 0.5 * 0.3 / (1e-5 + 1.0)),
            (Weight::Dwb22Shader, 2001.0, 0.005),
        ] {
            let z: f64 = z;
            assert!(
                (of(weight, z as f32) / expected - 1.0).abs() < 2e-7,
                "{weight:?} at {z}: {} against {expected}",
                of(weight, z as f32)
            );
        }
    }

    /// DWB22 Eq. 3.10 evaluated as it is printed.
    #[test]
    fn the_printed_weight_is_a_constant() {
        for z in [1e-3f32, 1.0, 100.0, 200.0, 1e4] {
            for a in [0.0f32, 0.3, 1.0] {
                let printed = f64::from(a) * (0.3e5 + (1.0 - f64::from(z) / 200.0).powi(4)).clamp(1e-2, 8.0);
                assert_eq!(Weight::Dwb22.of(z, a, None).unwrap(), printed);
            }
        }
    }

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        for weight in Weight::ALL {
            assert_close(&image(&blended(weight), &one())[0], &[0.625, 0.5, 0.5]);
            let w = |z| weight.of(z, 0.5, two().planes()).unwrap();
            let total = w(1.0) + w(2.0);
            assert_close(
                &image(&blended(weight), &two())[0],
                &[0.75 * w(1.0) / total + 0.25, 0.75 * w(2.0) / total + 0.25, 0.25],
            );
            let total = total + w(4.0);
            assert_close(
                &image(&blended(weight), &three())[0],
                &[1.0, 2.0, 4.0].map(|z| 0.875 * w(z) / total + 0.125),
            );
        }
        // A constant weight gives the mean.
        assert_close(&image(&blended(Weight::Dwb22), &two())[0], &[0.625, 0.625, 0.25]);
    }

    /// The composite is normalised: one colour stays, however wrong the weights; and what the pixel lets through is
    /// exact.
    #[test]
    fn one_colour_stays_and_order_never_matters() {
        let list = scene(3);
        let painted = painted(&list, [0.25, 0.5, 1.0]);
        for weight in Weight::ALL {
            let method = blended(weight);
            assert_close(
                image(&method, &painted).as_flattened(),
                normalised(&painted).as_flattened(),
            );
            assert!(!order_matters(&method, &list), "{weight:?}");
            assert!(
                !agree(image(&method, &list).as_flattened(), exact_image(&list).as_flattened()),
                "{weight:?} is no A-buffer"
            );
            assert!(!method.weights_are_transmittance());
        }
    }

    /// (1 − e^−b0) C + e^−b0 C_bg.
    fn normalised(painted: &FragmentList) -> Vec<[f64; 3]> {
        let behind = |p| (-crate::pixel::abuffer::total_absorbance(painted.pixel(p))).exp();
        (0..painted.pixels())
            .map(|p| [0.25, 0.5, 1.0].map(|c| (1.0 - behind(p)) * c + behind(p)))
            .collect()
    }

    #[test]
    fn planes_are_needed_by_one_weight_only() {
        let list = FragmentList::new(vec![0, 1], vec![1.0], vec![0.5], None).unwrap();
        for weight in Weight::ALL {
            let result = blended(weight).accumulate(&list, Context::default()).map(drop);
            assert_eq!(result.is_err(), weight == Weight::Mb13Eq10, "{weight:?}");
        }
        let outside = Context {
            planes: CameraPlanes::new(2.0, 3.0).ok(),
            ..Context::default()
        };
        let error = blended(Weight::Mb13Eq10)
            .accumulate(&list, outside)
            .map(drop)
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("weighted-blended:mb13-10: view_z = 1 lies outside"),
            "{error}"
        );
    }

    #[test]
    fn names() {
        assert_eq!(parse("weighted-blended").unwrap().name(), "weighted-blended:mb13-9");
        for weight in Weight::ALL {
            let name = blended(weight).name();
            assert_eq!(parse(&name).unwrap().name(), name);
        }
        assert_eq!(
            parse("weighted-blended:mb13-8:best-scale").unwrap().name(),
            "weighted-blended:mb13-8:best-scale"
        );
        assert!(parse("weighted-blended:dwb22:best-scale").is_err());
        let error = parse("weighted-blended:mb13").map(drop).unwrap_err().to_string();
        assert!(error.contains("expected one of mb13-7, "), "{error}");
    }
}
