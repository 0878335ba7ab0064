//! Bavoil and Myers' weighted average: all fragments of a pixel take on its mean colour and its mean opacity.

use super::capabilities::{Capabilities, sums};
use super::registry::{Arguments, Entry, ParseError};
use super::shader::{Composite, MethodShader};
use super::{Accumulated, Context, Method, MethodError, weighted_sums};
use crate::pixel::{FragmentList, Pixel};

/// Its name on the command line.
pub const NAME: &str = "weighted-average";

/// C = Σ a C/Σ a · (1 − (1 − ā)^n) + (1 − ā)^n C_bg with ā = Σ a/n; the background alone where Σ a is 0.
///
/// Exact for one fragment and for fragments of one colour and one opacity. Opacities are taken as they are, without the
/// clamp of the absorbance.
///
/// # Source
/// Bavoil, Myers, *Order Independent Transparency with Dual Depth Peeling*, NVIDIA 2008; as MB13 Sec. 2 restates it.
#[derive(Debug, Clone, Copy, Default)]
pub struct WeightedAverage;

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: NAME,
    source: "Bavoil, Myers, NVIDIA 2008",
    names: |head| vec![head.to_owned()],
    build,
};

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    arguments.no_argument()?;
    Ok(Box::new(WeightedAverage))
}

impl Method for WeightedAverage {
    fn name(&self) -> String {
        NAME.to_owned()
    }

    /// The number of fragments; Σ a lies in the colour's fourth channel.
    fn capabilities(&self) -> Capabilities {
        Capabilities::of_blending(sums(1))
    }

    /// They are 1.
    fn weights_are_transmittance(&self) -> bool {
        false
    }

    fn shader(&self) -> Option<MethodShader> {
        Some(MethodShader::alike(NAME, Composite::Average))
    }

    fn accumulate<'a>(&'a self, _: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Average))
    }
}

struct Average;

impl Accumulated for Average {
    fn weights(&self, _: usize, out: &mut [f64]) {
        out.fill(1.0);
    }

    fn composite(&self, pixel: Pixel<'_>, _: usize, weights: &[f64], background: [f64; 3]) -> [f64; 3] {
        let (sum, alphas) = weighted_sums(pixel, weights);
        if alphas == 0.0 {
            return background;
        }
        let n = pixel.len() as f64;
        // The mean of numbers up to 1 may round to just above 1.
        let behind = libm::pow((1.0 - alphas / n).max(0.0), n);
        std::array::from_fn(|c| (1.0 - behind) / alphas * sum[c] + behind * background[c])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        assert_close(&image(&WeightedAverage, &one())[0], &[0.625, 0.5, 0.5]);
        // (1 − 1/4) · (1/2, 1/2, 0) + 1/4
        assert_close(&image(&WeightedAverage, &two())[0], &[0.625, 0.625, 0.25]);
        // (1 − 1/8) · (1/3, 1/3, 1/3) + 1/8
        assert_close(&image(&WeightedAverage, &three())[0], &[5.0 / 12.0; 3]);
        // Unequal: ā = 1/2, colour (1/4 red + 3/4 green)/1
        let unequal = pixel(&[1.0, 2.0], &[0.25, 0.75], &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_close(
            &image(&WeightedAverage, &unequal)[0],
            &[0.1875 + 0.25, 0.5625 + 0.25, 0.25],
        );
    }

    /// Exact where all opacities of a pixel are equal and its colours too; the control has unequal ones.
    #[test]
    fn exact_for_equal_fragments() {
        let equal = pixel(&[3.0, 1.0, 2.0], &[0.25; 3], &[[0.2, 0.4, 0.6]; 3]);
        assert_close(&image(&WeightedAverage, &equal)[0], &exact_image(&equal)[0]);
        let unequal = pixel(&[3.0, 1.0, 2.0], &[0.25, 0.5, 0.75], &[[0.2, 0.4, 0.6]; 3]);
        assert!(!agree(&image(&WeightedAverage, &unequal)[0], &exact_image(&unequal)[0]));
    }

    #[test]
    fn order_never_matters_and_one_colour_stays() {
        assert!(!order_matters(&WeightedAverage, &scene(2)));
        // White on white stays white.
        let white = image(&WeightedAverage, &painted(&scene(2), [1.0; 3]));
        assert_close(white.as_flattened(), &vec![1.0; 3 * white.len()]);
        assert_eq!(image(&WeightedAverage, &pixel(&[], &[], &[]))[0], WHITE);
        assert_eq!(image(&WeightedAverage, &pixel(&[1.0], &[0.0], &[[0.5; 3]]))[0], WHITE);
        assert_close(
            &image(&WeightedAverage, &pixel(&[1.0, 2.0], &[1.0; 2], &[[0.5; 3]; 2]))[0],
            &[0.5; 3],
        );
        assert!(parse("weighted-average").is_ok() && parse("weighted-average:2").is_err());
    }
}
