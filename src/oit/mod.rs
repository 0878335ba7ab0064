//! Transparency methods: each adds something up per pixel, weights each fragment by it, and composites.

pub mod abuffer;
pub mod adaptive;
pub mod capabilities;
pub mod colour_network;
pub mod core;
pub mod deep_weighted_blended;
pub mod depth_peeling;
pub mod dual_depth_peeling;
pub mod fourier_opacity;
pub mod hybrid;
mod layered;
pub mod low_resolution_moments;
mod moment_based;
pub mod moment_power;
pub mod moment_transparency;
pub mod moment_trig;
pub mod multi_layer_alpha;
pub mod neural;
pub mod registry;
pub mod shader;
pub mod stochastic;
#[cfg(test)]
mod testing;
pub mod two_moment_passes;
pub mod wavelet;
pub mod weighted_average;
pub mod weighted_blended;
pub mod weighted_sum;

pub use capabilities::{Capabilities, Needs};
pub use registry::{ParseError, all_names, names_with_shader, parse, shader_of, source};
pub use shader::MethodShader;

use crate::numeric::exact_sum::ExactSum;
use crate::pixel::{self, CameraPlanes, DepthError, FragmentList, Pixel};
use std::convert::Infallible;

/// What a method must know besides the fragments.
#[derive(Debug, Clone, Copy, Default)]
pub struct Context {
    /// Planes of the camera; those of the fragment list where none.
    pub planes: Option<CameraPlanes>,
    /// View depths that moment depth −1 and 1 stand for [scene units]; the extremes of the list where none.
    pub depth_range: Option<(f32, f32)>,
}

impl Context {
    /// The camera's planes for a list: those given here, or else its own.
    pub fn planes_for(&self, list: &FragmentList) -> Option<CameraPlanes> {
        self.planes.or(list.planes())
    }
}

/// Why a method cannot be applied to a list.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MethodError {
    /// A depth does not fit what the method needs.
    #[error("{method}: {source}")]
    Depth {
        /// The method.
        method: String,
        /// What is wrong.
        source: DepthError,
    },
    /// The list is no image, and the method looks at neighbouring pixels.
    #[error(
        "{method} looks at neighbouring pixels, and the fragment list has no width and height; write both into its file"
    )]
    NoSize {
        /// The method.
        method: String,
    },
}

/// A transparency method as a renderer runs it.
pub trait Method: Send + Sync {
    /// Its name on the command line.
    fn name(&self) -> String;

    /// What it keeps of a pixel, how often it draws the geometry, and what it needs.
    fn capabilities(&self) -> Capabilities;

    /// Whether its weights are transmittances, so that an error of T can be stated.
    fn weights_are_transmittance(&self) -> bool {
        true
    }

    /// Its twin on a GPU, where it has one.
    ///
    /// Moments are f32 there, so that a storage of `:f32` changes nothing; the other storages have no twin. Unlike the
    /// CPU's, which are f64 after pass 1, all arithmetic is f32.
    ///
    /// # Accuracy
    /// Against the CPU's method on the same f32 moments: `gpu::twins::twins_answer_as_on_the_cpu`.
    fn shader(&self) -> Option<MethodShader> {
        None
    }

    /// Pass 1: goes over all fragments of a list, in the order in which they stand there.
    ///
    /// # Errors
    /// [`MethodError`] where the list lacks what the method needs.
    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError>;
}

/// A method after pass 1.
pub trait Accumulated: Send + Sync {
    /// Pass 2: weight of every fragment of pixel p, in the order of its fragments.
    ///
    /// # Shapes
    /// `out: [n]`, n = number of fragments of pixel p.
    fn weights(&self, p: usize, out: &mut [f64]);

    /// Colour of a pixel from its weights; unless a method has its own rule, [`composite_normalised`].
    fn composite(&self, pixel: Pixel<'_>, p: usize, weights: &[f64], background: [f64; 3]) -> [f64; 3] {
        let _ = p;
        composite_normalised(pixel, weights, background)
    }
}

/// Colour of a pixel from its fragments' transmittances: C = (1 − e^−b0)/Σ a T · Σ a C T + e^−b0 C_bg; the background
/// alone where Σ a T is 0.
///
/// # Source
/// NMT24 Eq. 7.
///
/// # Panics
/// If the pixel has fragments and no colours.
pub fn composite_normalised(pixel: Pixel<'_>, transmittances: &[f64], background: [f64; 3]) -> [f64; 3] {
    composite_with_total(
        pixel,
        transmittances,
        pixel::abuffer::total_absorbance(pixel),
        background,
    )
}

/// [`composite_normalised`] with the total absorbance b0 as a method has kept it.
///
/// # Panics
/// If the pixel has fragments and no colours.
pub fn composite_with_total(
    pixel: Pixel<'_>,
    transmittances: &[f64],
    total_absorbance: f64,
    background: [f64; 3],
) -> [f64; 3] {
    let behind = libm::exp(-total_absorbance);
    let (sum, total) = weighted_sums(pixel, transmittances);
    let scale = if total > 0.0 { (1.0 - behind) / total } else { 0.0 };
    std::array::from_fn(|c| scale * sum[c] + behind * background[c])
}

/// Σ a w C and Σ a w of a pixel, what an additive pass 2 leaves, the same to the bit in any order of the fragments.
///
/// # Panics
/// If the pixel has fragments and no colours.
fn weighted_sums(pixel: Pixel<'_>, weights: &[f64]) -> ([f64; 3], f64) {
    let color = pixel.color.unwrap_or(&[]);
    assert_eq!(color.len(), pixel.len(), "compositing needs colours");
    let mut total = ExactSum::default();
    let mut sum = [ExactSum::default(); 3];
    for ((&a, c), &w) in pixel.alpha.iter().zip(color).zip(weights) {
        let weight = f64::from(a) * w;
        total.add(weight);
        for (s, &c) in sum.iter_mut().zip(c) {
            s.add(weight * f64::from(c));
        }
    }
    (sum.map(|s| s.value()), total.value())
}

/// Weights of every fragment of a list, in the order of the list, on all cores.
pub fn weights(list: &FragmentList, accumulated: &dyn Accumulated) -> Vec<f64> {
    let mut out = vec![0.0; list.len()];
    let Ok(()) = list.par_pixels(0..list.pixels(), &mut out, 1, |p, _, out| -> Result<(), Infallible> {
        accumulated.weights(p, out);
        Ok(())
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::abuffer;

    /// With exact transmittances the normalised composite is the over operator.
    #[test]
    fn exact_transmittances_composite_to_the_over_operator() {
        let color = [[0.9, 0.1, 0.3], [0.2, 0.8, 0.4], [0.5, 0.5, 1.0]];
        let pixel = Pixel {
            view_z: &[3.0, 1.0, 2.0],
            alpha: &[0.3, 0.6, 0.9],
            color: Some(&color),
        };
        let mut t = [0.0; 3];
        abuffer::transmittance(pixel, &mut t);
        let (ours, truth) = (
            composite_normalised(pixel, &t, [1.0; 3]),
            abuffer::composite(pixel, [1.0; 3]),
        );
        assert!(
            ours.iter().zip(truth).all(|(a, b)| (a - b).abs() < 1e-14),
            "{ours:?} against {truth:?}"
        );
    }

    #[test]
    fn invisible_and_empty_pixels_show_the_background() {
        let color = [[1.0, 0.0, 0.0]];
        let clear = Pixel {
            view_z: &[1.0],
            alpha: &[0.0],
            color: Some(&color),
        };
        assert_eq!(composite_normalised(clear, &[1.0], [0.2; 3]), [0.2; 3]);
        let empty = Pixel {
            view_z: &[],
            alpha: &[],
            color: None,
        };
        assert_eq!(composite_normalised(empty, &[], [0.2; 3]), [0.2; 3]);
    }
}
