//! Sharpe's two moment passes: the first estimates what each fragment adds to the second.

use super::Method;
use super::capabilities::Capabilities;
use super::moment_based::{MomentBased, PerPixel, Sample};
use super::moment_power::add;
use super::moment_transparency::{BIAS, unit, unit_depth};
use super::registry::{Arguments, Entry, ParseError};
use crate::moments::hamburger::PowerCurve;
use crate::pixel::MomentDepth;

/// Name on the command line.
pub const ENTRY: Entry = Entry {
    head: "two-moment-passes",
    pattern: "two-moment-passes[+own]",
    source: "Sharpe, HPG 2018",
    names: |head| vec![head.to_owned(), format!("{head}+own")],
    build,
};

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_argument()?;
    Ok(Box::new(PerPixel {
        family: TwoMomentPasses,
        own: arguments.own,
    }))
}

/// Two sets of four moments. In the second each absorbance is weighted by the transmittance in front of it as the first
/// set tells it; the second set gives the fraction of absorbance in front of a depth, the first the total that it is a
/// fraction of.
///
/// # Source
/// Sha18 Sec. 4.4. The paper leaves the formula to a supplement that is not at hand; this reading shows what its Fig. 2
/// shows, too much shadow with two fragments.
struct TwoMomentPasses;

/// Both sets, b_0..b_4 each.
#[derive(Debug, Clone, Copy)]
struct Sets {
    first: [f64; 5],
    second: [f64; 5],
}

/// What a fragment adds to the second set.
fn dimmed(first: &PowerCurve<f64, 2>, sample: Sample) -> Sample {
    Sample {
        absorbance: sample.absorbance * first.transmittance(sample.z, 0.0),
        ..sample
    }
}

impl MomentBased for TwoMomentPasses {
    type Moments = Sets;
    /// Total of the first set, total and curve of the second.
    type Curve = (f64, f64, PowerCurve<f64, 2>);

    fn name(&self) -> String {
        "two-moment-passes".to_owned()
    }

    /// Two sets of moments, each in a pass over the geometry of its own.
    fn capabilities(&self, own: bool) -> Capabilities {
        Capabilities {
            geometry_passes: 3,
            ..Capabilities::of_sums(10, own)
        }
    }

    fn accumulate(&self, samples: &[Sample]) -> Sets {
        let mut sets = Sets {
            first: [0.0; 5],
            second: [0.0; 5],
        };
        for &sample in samples {
            add(&mut sets.first, unit(sample));
        }
        if sets.first[0] > 0.0 {
            let curve = PowerCurve::new(&sets.first, &BIAS);
            for &sample in samples {
                add(&mut sets.second, dimmed(&curve, unit(sample)));
            }
        }
        sets
    }

    fn total(&self, sets: &Sets) -> f64 {
        sets.first[0]
    }

    fn without(&self, sets: &Sets, own: Sample) -> Sets {
        let mut others = *sets;
        let own = unit(own);
        let remove = |set: &mut [f64; 5], sample: Sample| {
            add(
                set,
                Sample {
                    absorbance: -sample.absorbance,
                    ..sample
                },
            )
        };
        remove(&mut others.first, own);
        remove(&mut others.second, dimmed(&PowerCurve::new(&sets.first, &BIAS), own));
        others
    }

    fn curve(&self, sets: &Sets) -> Self::Curve {
        (sets.first[0], sets.second[0], PowerCurve::new(&sets.second, &BIAS))
    }

    fn transmittance(&self, (total, second, curve): &Self::Curve, z: MomentDepth) -> f64 {
        libm::exp(-total * curve.bounds(unit_depth(z)).lower / second)
    }
}
