//! Where the fragments of a pixel lie: one law a file.

mod beta;
mod clustered;
mod paired;
mod range;
mod uniform;
mod window;

use super::camera::Camera;
use super::laws;
use super::numbers::{LogUniform, NumberLaw};
use crate::numeric::rng::Stream;
use crate::synth::config::SynthError;
pub use beta::BETA_SHAPES;
pub use range::PixelRange;
use serde::{Deserialize, Serialize};
pub use window::DepthReading;

laws! {
    /// Where the fragments of a pixel lie.
    ///
    /// [`Self::Window`] draws window depths. All others draw a shape, which [`PixelRange`] then puts between the
    /// camera's planes in moment depth: the log warp from near to far, view_z = near (far/near)^((z + 1)/2). A shape
    /// lives in [0, 1], and its lengths are shares of that.
    DepthLaw draws (n: usize, shape: &mut Shape)
    window::Window,
    uniform::Uniform,
    clustered::Clustered,
    paired::Paired,
    beta::Beta,
}

/// The configuration of a law.
trait Law {
    /// The law with all that its pixels share worked out.
    type Prepared: Draw
    where
        Self: Sized;

    /// What its depths are.
    fn space(&self) -> Space {
        Space::Shape
    }

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

    /// Draws depths and objects of n fragments in the place of those that are there.
    fn draw(&self, rng: &mut Stream, n: usize, scratch: &mut Self::Scratch, shape: &mut Shape);
}

/// What the depths of a law are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Space {
    /// Window depths.
    Window,
    /// A shape, which a [`PixelRange`] puts in its place.
    Shape,
}

/// The fragments of a pixel before the camera sees them.
#[derive(Default)]
pub(super) struct Shape {
    /// Depth of each fragment: as the law draws it, then where it lies.
    pub depth: Vec<f64>,
    /// Object of each fragment: whole numbers from 0.
    pub object: Vec<u32>,
}

impl Shape {
    /// Makes each of n fragments an object of its own.
    fn stand_alone(&mut self, n: usize) {
        self.object.clear();
        self.object.extend(0..n as u32);
    }
}

impl DepthLaw {
    pub(super) fn space(&self) -> Space {
        self.law().space()
    }

    pub(super) fn validate(&self, at: &str) -> Result<(), SynthError> {
        self.law().validate(at)
    }
}

/// A law, and where what it draws is put.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    law: Prepared,
    /// Half the pixel's range, of laws that draw a shape.
    half: Option<LogUniform>,
}

impl Placed {
    /// Of a validated configuration.
    pub(super) fn new(law: &DepthLaw, range: Option<PixelRange>) -> Self {
        Self {
            law: law.prepare(),
            half: range.map(|range| LogUniform::new(range.half)),
        }
    }

    /// Draws a shape of n fragments and appends their view depths.
    pub(super) fn draw(
        &self,
        rng: &mut Stream,
        n: usize,
        camera: &Camera,
        scratch: &mut Scratch,
        shape: &mut Shape,
        view_z: &mut Vec<f32>,
    ) {
        self.law.draw(rng, n, scratch, shape);
        match &self.half {
            None => camera.of_window(&mut shape.depth, view_z),
            Some(half) => {
                let half = half.draw(rng);
                let center = (2.0 * rng.unit() - 1.0) * (1.0 - half);
                range::stretch(&mut shape.depth, center, half);
                camera.of_moment(&mut shape.depth, view_z);
            }
        }
    }
}

/// Shapes of n fragments each: their depths and objects.
#[cfg(test)]
fn shapes(law: &impl Law, n: usize, count: usize) -> Vec<(Vec<f64>, Vec<u32>)> {
    let law = law.prepare();
    let (mut rng, mut scratch) = (super::testing::rng(), Default::default());
    (0..count)
        .map(|_| {
            let mut shape = Shape::default();
            law.draw(&mut rng, n, &mut scratch, &mut shape);
            (shape.depth, shape.object)
        })
        .collect()
}
