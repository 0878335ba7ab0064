//! How opaque the fragments of a pixel are: one law a file.

mod log_uniform;
mod near_opaque;
mod reading;
mod splats;
mod subrange;
mod uniform;

use super::laws;
use crate::numeric::rng::Stream;
use crate::synth::config::SynthError;
pub use reading::AlphaReading;
use serde::{Deserialize, Serialize};

laws! {
    /// How opaque the fragments of a pixel are.
    AlphaLaw draws (object: &[u32], out: &mut Vec<f32>)
    uniform::Uniform,
    log_uniform::LogUniform,
    subrange::Subrange,
    splats::Splats,
    near_opaque::NearOpaque,
}

/// The configuration of a law.
trait Law {
    /// The law with all that its pixels share worked out.
    type Prepared: Draw
    where
        Self: Sized;

    /// Checks every range; `at` is where the law stands in the configuration.
    fn validate(&self, at: &str) -> Result<(), SynthError>;

    /// Of a validated configuration.
    fn prepare(&self) -> Self::Prepared
    where
        Self: Sized;
}

/// How a law is drawn.
trait Draw {
    /// Memory that its pixels share.
    type Scratch: Default;

    /// Appends the opacities of fragments that are of these objects.
    fn draw(&self, rng: &mut Stream, object: &[u32], scratch: &mut Self::Scratch, out: &mut Vec<f32>);
}

impl AlphaLaw {
    pub(super) fn validate(&self, at: &str) -> Result<(), SynthError> {
        self.law().validate(at)
    }
}

#[inline]
fn opacity(alpha: f64) -> f32 {
    (alpha as f32).clamp(0.0, 1.0)
}

/// Opacities of pixels whose fragments 0 and 1 are one object, 2 and 3 the next, and so on.
#[cfg(test)]
fn alphas(law: &impl Law, n: usize, count: usize) -> Vec<Vec<f32>> {
    let law = law.prepare();
    let (mut rng, mut scratch) = (super::testing::rng(), Default::default());
    let object: Vec<u32> = (0..n as u32).map(|i| i / 2).collect();
    (0..count)
        .map(|_| {
            let mut out = Vec::new();
            law.draw(&mut rng, &object, &mut scratch, &mut out);
            out
        })
        .collect()
}
