//! Moment-based transparency with power moments.

use super::Method;
use super::capabilities::{Capabilities, Needs, RANGE_BITS, sums};
use super::moment_based::{MomentBased, MomentShader, OTHERS_OVERESTIMATION, PerPixel, Sample};
use super::registry::{Arguments, Entry, MomentArguments, ParseError};
use crate::moments::hamburger::{Bias, OVERESTIMATION, PowerCurve};
use crate::moments::storage::{MomentStorage, through_nlqm, through_unorm16};
use crate::numeric::quantise::round_f16;
use crate::pixel::MomentDepth;

/// Names on the command line.
pub const ENTRIES: [Entry; 3] = [
    Entry {
        head: "moment-power-4",
        pattern: "moment-power-4[:f32|unorm16][:bias=B][:overestimation=O][+own], moment-power-4:nlqm",
        source: "Münstermann, Krumpen, Klein, Peters, PACMCGIT 1(1) 2018",
        names,
        build: build::<2, 5>,
    },
    Entry {
        head: "moment-power-6",
        pattern: "moment-power-6[:f32|unorm16][:bias=B][:overestimation=O][+own], moment-power-6:nlqm",
        source: "Münstermann, Krumpen, Klein, Peters, PACMCGIT 1(1) 2018",
        names,
        build: build::<3, 7>,
    },
    Entry {
        head: "moment-power-8",
        pattern: "moment-power-8[:f32|unorm16][:bias=B][:overestimation=O][+own], moment-power-8:nlqm",
        source: "Münstermann, Krumpen, Klein, Peters, PACMCGIT 1(1) 2018",
        names,
        build: build::<4, 9>,
    },
];

fn names(head: &str) -> Vec<String> {
    let linear = ["", ":f32", ":unorm16"]
        .iter()
        .flat_map(|s| [format!("{head}{s}"), format!("{head}{s}+own")]);
    linear.chain([format!("{head}:nlqm")]).collect()
}

fn build<const N: usize, const M: usize>(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    let told = arguments.of_moments()?;
    let storage = match told.storage {
        None => MomentStorage::F64,
        Some("f32") => MomentStorage::F32,
        Some("unorm16") => MomentStorage::Unorm16,
        // Its quantities are no sums: one fragment cannot be taken out of them.
        Some("nlqm") if arguments.own => return Err(arguments.wrong("expected f32 or unorm16 before +own")),
        Some("nlqm") => MomentStorage::Nlqm,
        Some(_) => return Err(arguments.wrong("expected f32, unorm16 or nlqm")),
    };
    Ok(Box::new(PerPixel {
        family: Power::<N, M> {
            storage,
            strength: told.bias,
            overestimation: told.overestimation,
        },
        own: arguments.own,
    }))
}

/// M − 1 = 2N power moments.
///
/// # Source
/// MKKP18 Sec. 3 and 4.
struct Power<const N: usize, const M: usize> {
    storage: MomentStorage,
    /// Strength of the bias in place of the published one.
    strength: Option<f64>,
    /// Overestimation in place of the usual ones.
    overestimation: Option<f64>,
}

impl<const N: usize, const M: usize> Power<N, M> {
    fn bias(&self) -> Bias {
        let published = match self.storage {
            MomentStorage::Unorm16 => Bias::sixteen_bits(2 * N),
            MomentStorage::F64 | MomentStorage::F32 | MomentStorage::Nlqm => Bias::single_precision(2 * N),
        };
        Bias {
            strength: self.strength.unwrap_or(published.strength),
            ..published
        }
    }
}

/// Adds a fragment to moments in any order of storage: Σ A z^k.
pub(super) fn add<const M: usize>(b: &mut [f64; M], sample: Sample) {
    let mut term = sample.absorbance;
    for b in b {
        *b += term;
        term *= sample.z.0;
    }
}

impl<const N: usize, const M: usize> MomentBased for Power<N, M> {
    /// b_0..b_2N, not normalised, whatever they were rounded to.
    type Moments = [f64; M];
    type Curve = PowerCurve<f64, N>;

    fn name(&self) -> String {
        format!(
            "moment-power-{}{}{}",
            2 * N,
            self.storage.suffix(),
            MomentArguments::suffix(self.strength, self.overestimation)
        )
    }

    /// b_0..b_2N in f32 where nothing is rounded to 16 bits. Quantised moments are no sums that could be blended; one
    /// fragment after the other is added to them (MKKP18 Sec. 4.3), or beside single precision sums (Sha18 Table 1).
    fn capabilities(&self, own: bool) -> Capabilities {
        let m = M as u32;
        let of_sums = Capabilities::of_sums(m, own);
        let range = if own { RANGE_BITS } else { 0 };
        match self.storage {
            MomentStorage::F64 | MomentStorage::F32 => of_sums,
            MomentStorage::Unorm16 => Capabilities {
                bits_per_pixel: Some(16 * m + range),
                needs: Needs::INTERLOCK,
                ..of_sums
            },
            MomentStorage::Nlqm => Capabilities {
                bits_per_pixel: Some(sums(m) + 16 * m),
                ..of_sums
            },
        }
    }

    fn rounds_sums(&self) -> bool {
        matches!(self.storage, MomentStorage::F32 | MomentStorage::Unorm16)
    }

    fn shader(&self) -> Option<MomentShader> {
        let f32s = matches!(self.storage, MomentStorage::F64 | MomentStorage::F32)
            && self.strength.is_none()
            && self.overestimation.is_none();
        let powers: Vec<String> = (1..M).map(|i| format!("let b{i} = b{} * f.z;", i - 1)).collect();
        let moments: Vec<String> = (0..M).map(|i| format!("b{i}")).collect();
        f32s.then(|| MomentShader {
            sums: M,
            curve_source: include_str!("../moments/hamburger.wgsl"),
            curve: format!("power_transmittance_{}", 2 * N),
            accumulate: include_str!("power_moments.wgsl")
                .replace("OIT_POWERS", &powers.join("\n    "))
                .replace("OIT_MOMENTS", &moments.join(", ")),
        })
    }

    fn accumulate(&self, samples: &[Sample]) -> [f64; M] {
        let mut b = [0.0; M];
        for &sample in samples {
            match self.storage {
                MomentStorage::F64 | MomentStorage::Nlqm => add(&mut b, sample),
                MomentStorage::F32 => {
                    let (z, mut term) = (sample.z.0 as f32, sample.absorbance as f32);
                    for b in &mut b {
                        *b = f64::from(*b as f32 + term);
                        term *= z;
                    }
                }
                MomentStorage::Unorm16 => {
                    add(&mut b, sample);
                    if b[0] > 0.0 {
                        let normalised = through_unorm16(b.map(|x| x / b[0]));
                        let total = round_f16(b[0]);
                        b = std::array::from_fn(|k| if k == 0 { total } else { total * normalised[k] });
                    }
                }
            }
        }
        if self.storage == MomentStorage::Nlqm {
            b = scaled(b, round_f16(b[0]));
        }
        b
    }

    fn total(&self, b: &[f64; M]) -> f64 {
        b[0]
    }

    fn without(&self, b: &[f64; M], own: Sample) -> [f64; M] {
        let mut others = *b;
        add(
            &mut others,
            Sample {
                absorbance: -own.absorbance,
                ..own
            },
        );
        others
    }

    fn curve(&self, b: &[f64; M]) -> PowerCurve<f64, N> {
        let bias = self.bias();
        match self.storage {
            MomentStorage::Nlqm => PowerCurve::from_parts(b[0], through_nlqm::<N, M>(&bias.apply(b.map(|x| x / b[0])))),
            _ => PowerCurve::new(b, &bias),
        }
    }

    fn transmittance(&self, curve: &PowerCurve<f64, N>, z: MomentDepth) -> f64 {
        curve.transmittance(z, self.overestimation.unwrap_or(OVERESTIMATION))
    }

    fn transmittance_of_others(&self, curve: &PowerCurve<f64, N>, z: MomentDepth) -> f64 {
        curve.transmittance(z, self.overestimation.unwrap_or(OTHERS_OVERESTIMATION))
    }
}

/// The same distribution with another total.
fn scaled<const M: usize>(b: [f64; M], total: f64) -> [f64; M] {
    if b[0] > 0.0 {
        std::array::from_fn(|k| if k == 0 { total } else { b[k] / b[0] * total })
    } else {
        b
    }
}
