//! Sharpe's moment transparency: four moments of depths in [0, 1] and the lower bound.

use super::Method;
use super::capabilities::Capabilities;
use super::moment_based::{MomentBased, PerPixel, Sample};
use super::moment_power::add;
use super::registry::{Arguments, Entry, ParseError};
use crate::moments::hamburger::{Bias, PowerCurve};
use crate::pixel::MomentDepth;

/// Name on the command line.
pub const ENTRY: Entry = Entry {
    head: "moment-transparency",
    pattern: "moment-transparency[:OVERESTIMATION][+own]",
    source: "Sharpe, HPG 2018",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    ["", ":0.25"]
        .iter()
        .flat_map(|s| [format!("{head}{s}"), format!("{head}{s}+own")])
        .collect()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    let overestimation = match arguments.argument {
        None => 0.0,
        Some(text) => match text.parse::<f64>() {
            Ok(weight) if (0.0..=1.0).contains(&weight) => weight,
            _ => return Err(arguments.wrong("expected an overestimation from 0 to 1")),
        },
    };
    Ok(Box::new(PerPixel {
        family: MomentTransparency { overestimation },
        own: arguments.own,
    }))
}

/// Bias of moments of depths in [0, 1], in single precision.
///
/// # Source
/// Strength and target of moment shadow mapping (C. Peters, R. Klein, *Moment shadow mapping*, I3D 2015), on which
/// Sha18 builds; Sha18 prints none.
pub(super) const BIAS: Bias = Bias {
    strength: 3e-7,
    target: [0.5, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0],
};

/// Sha18's unit depth of a moment depth, as a depth to take moments of.
pub(super) fn unit(sample: Sample) -> Sample {
    Sample {
        z: unit_depth(sample.z),
        ..sample
    }
}

/// z′ = (z + 1)/2 in [0, 1] (Sha18 Eq. 6).
pub(super) fn unit_depth(MomentDepth(z): MomentDepth) -> MomentDepth {
    MomentDepth(0.5 * (z + 1.0))
}

/// Sharpe's method with the given overestimation.
///
/// # Source
/// Sha18 Sec. 3 (lower bound) and 4.3 (overestimation).
struct MomentTransparency {
    overestimation: f64,
}

impl MomentBased for MomentTransparency {
    type Moments = [f64; 5];
    type Curve = PowerCurve<f64, 2>;

    fn name(&self) -> String {
        if self.overestimation == 0.0 {
            "moment-transparency".to_owned()
        } else {
            format!("moment-transparency:{}", self.overestimation)
        }
    }

    fn capabilities(&self, own: bool) -> Capabilities {
        Capabilities::of_sums(5, own)
    }

    fn accumulate(&self, samples: &[Sample]) -> [f64; 5] {
        let mut b = [0.0; 5];
        for &sample in samples {
            add(&mut b, unit(sample));
        }
        b
    }

    fn total(&self, b: &[f64; 5]) -> f64 {
        b[0]
    }

    fn without(&self, b: &[f64; 5], own: Sample) -> [f64; 5] {
        let mut others = *b;
        add(
            &mut others,
            unit(Sample {
                absorbance: -own.absorbance,
                ..own
            }),
        );
        others
    }

    fn curve(&self, b: &[f64; 5]) -> PowerCurve<f64, 2> {
        PowerCurve::new(b, &BIAS)
    }

    fn transmittance(&self, curve: &PowerCurve<f64, 2>, z: MomentDepth) -> f64 {
        curve.transmittance(unit_depth(z), self.overestimation)
    }
}
