//! Moment-based transparency with trigonometric moments.

use super::Method;
use super::capabilities::{Capabilities, Needs, RANGE_BITS};
use super::moment_based::{MomentBased, MomentShader, OTHERS_OVERESTIMATION, PerPixel, Sample};
use super::registry::{Arguments, Entry, MomentArguments, ParseError};
use crate::moments::hamburger::OVERESTIMATION;
use crate::moments::storage::MomentStorage;
use crate::moments::trigonometric::{TrigonometricCurve, TrigonometricMoments, moment_bias};
use crate::numeric::complex::Complex;
use crate::numeric::quantise::{round_f16, round_unorm16};
use crate::pixel::MomentDepth;

/// Names on the command line.
pub const ENTRIES: [Entry; 3] = [
    Entry {
        head: "moment-trig-2",
        pattern: "moment-trig-2[:f32|unorm16][:bias=B][:overestimation=O][+own]",
        source: "Münstermann, Krumpen, Klein, Peters, PACMCGIT 1(1) 2018",
        names,
        build: build::<2>,
    },
    Entry {
        head: "moment-trig-3",
        pattern: "moment-trig-3[:f32|unorm16][:bias=B][:overestimation=O][+own]",
        source: "Münstermann, Krumpen, Klein, Peters, PACMCGIT 1(1) 2018",
        names,
        build: build::<3>,
    },
    Entry {
        head: "moment-trig-4",
        pattern: "moment-trig-4[:f32|unorm16][:bias=B][:overestimation=O][+own]",
        source: "Münstermann, Krumpen, Klein, Peters, PACMCGIT 1(1) 2018",
        names,
        build: build::<4>,
    },
];

fn names(head: &str) -> Vec<String> {
    ["", ":f32", ":unorm16"]
        .iter()
        .flat_map(|s| [format!("{head}{s}"), format!("{head}{s}+own")])
        .collect()
}

fn build<const M: usize>(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    let told = arguments.of_moments()?;
    let storage = match told.storage {
        None => MomentStorage::F64,
        Some("f32") => MomentStorage::F32,
        Some("unorm16") => MomentStorage::Unorm16,
        Some(_) => return Err(arguments.wrong("expected f32 or unorm16")),
    };
    Ok(Box::new(PerPixel {
        family: Trigonometric::<M> {
            storage,
            bias: told.bias,
            overestimation: told.overestimation,
        },
        own: arguments.own,
    }))
}

/// M trigonometric moments.
///
/// # Source
/// MKKP18 Sec. 5.
struct Trigonometric<const M: usize> {
    storage: MomentStorage,
    /// The bias in place of the published one.
    bias: Option<f64>,
    /// Overestimation in place of the usual ones.
    overestimation: Option<f64>,
}

impl<const M: usize> MomentBased for Trigonometric<M> {
    type Moments = TrigonometricMoments<f64, M>;
    type Curve = TrigonometricCurve<f64, M>;

    fn name(&self) -> String {
        format!(
            "moment-trig-{M}{}{}",
            self.storage.suffix(),
            MomentArguments::suffix(self.bias, self.overestimation)
        )
    }

    /// b_0 and M complex moments, in f32 where nothing is rounded to 16 bits (MKKP18 Table 1).
    fn capabilities(&self, own: bool) -> Capabilities {
        let numbers = 2 * M as u32 + 1;
        let of_sums = Capabilities::of_sums(numbers, own);
        if self.storage == MomentStorage::Unorm16 {
            return Capabilities {
                bits_per_pixel: Some(16 * numbers + if own { RANGE_BITS } else { 0 }),
                needs: Needs::INTERLOCK,
                ..of_sums
            };
        }
        of_sums
    }

    fn rounds_sums(&self) -> bool {
        matches!(self.storage, MomentStorage::F32 | MomentStorage::Unorm16)
    }

    fn shader(&self) -> Option<MomentShader> {
        let f32s = matches!(self.storage, MomentStorage::F64 | MomentStorage::F32)
            && self.bias.is_none()
            && self.overestimation.is_none();
        let power = |i| format!("let b{i} = complex_times(b{}, x);", i - 1);
        let powers: Vec<String> = (2..=M).map(power).collect();
        let moments: Vec<String> = (1..=M).map(|i| format!("b{i}.x, b{i}.y")).collect();
        f32s.then(|| MomentShader {
            sums: 2 * M + 1,
            curve_source: include_str!("../moments/trigonometric.wgsl"),
            curve: format!("trigonometric_transmittance_{M}"),
            accumulate: include_str!("trigonometric_moments.wgsl")
                .replace("OIT_POWERS", &powers.join("\n    "))
                .replace("OIT_MOMENTS", &moments.join(", ")),
        })
    }

    fn accumulate(&self, samples: &[Sample]) -> Self::Moments {
        let mut b = TrigonometricMoments::ZERO;
        if self.storage == MomentStorage::F32 {
            let mut single = TrigonometricMoments::<f32, M>::ZERO;
            for sample in samples {
                single.add(sample.z, sample.absorbance as f32);
            }
            return TrigonometricMoments {
                total: single.total.into(),
                b: single.b.map(|b| Complex::new(b.re.into(), b.im.into())),
            };
        }
        for sample in samples {
            b.add(sample.z, sample.absorbance);
            if self.storage == MomentStorage::Unorm16 && b.total > 0.0 {
                // MKKP18 Sec. 5.3: no transform but the shift to [0, 1].
                let (before, total) = (b.total, round_f16(b.total));
                let store = |v: f64| total * (2.0 * round_unorm16(0.5 * v / before + 0.5) - 1.0);
                b = TrigonometricMoments {
                    total,
                    b: b.b.map(|b| Complex::new(store(b.re), store(b.im))),
                };
            }
        }
        b
    }

    fn total(&self, b: &Self::Moments) -> f64 {
        b.total
    }

    fn without(&self, b: &Self::Moments, own: Sample) -> Self::Moments {
        let mut others = *b;
        others.add(own.z, -own.absorbance);
        others
    }

    fn curve(&self, b: &Self::Moments) -> Self::Curve {
        let published = moment_bias(M, self.storage == MomentStorage::Unorm16);
        TrigonometricCurve::new(b, self.bias.unwrap_or(published))
    }

    fn transmittance(&self, curve: &Self::Curve, z: MomentDepth) -> f64 {
        curve.transmittance(z, self.overestimation.unwrap_or(OVERESTIMATION))
    }

    fn transmittance_of_others(&self, curve: &Self::Curve, z: MomentDepth) -> f64 {
        curve.transmittance(z, self.overestimation.unwrap_or(OTHERS_OVERESTIMATION))
    }
}
