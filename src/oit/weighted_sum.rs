//! Meshkin's weighted sum: the over operator with every product of opacities left out.

use super::capabilities::Capabilities;
use super::layered::composite_over;
use super::registry::{Arguments, Entry, ParseError};
use super::shader::{Composite, MethodShader};
use super::{Accumulated, Context, Method, MethodError};
use crate::numeric::exact_sum::ExactSum;
use crate::pixel::{FragmentList, Pixel};

/// Its name on the command line.
pub const NAME: &str = "weighted-sum";

/// C = Σ a C + (1 − Σ a) C_bg: exact for one fragment, and out of range (light taken from the background that was never
/// there) once Σ a exceeds 1.
///
/// # Source
/// Meshkin, *Sort-Independent Alpha Blending*, GDC 2007; as MB13 Sec. 2 restates it.
#[derive(Debug, Clone, Copy, Default)]
pub struct WeightedSum;

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: NAME,
    source: "Meshkin, GDC 2007",
    names: |head| vec![head.to_owned()],
    build,
};

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    arguments.no_argument()?;
    Ok(Box::new(WeightedSum))
}

impl Method for WeightedSum {
    fn name(&self) -> String {
        NAME.to_owned()
    }

    /// Σ a lies in the colour's fourth channel. The reference pipeline draws it in one pass.
    fn capabilities(&self) -> Capabilities {
        Capabilities::of_blending(0)
    }

    /// They are 1.
    fn weights_are_transmittance(&self) -> bool {
        false
    }

    fn shader(&self) -> Option<MethodShader> {
        Some(MethodShader::alike(NAME, Composite::Sum))
    }

    fn accumulate<'a>(&'a self, _: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Sum))
    }
}

struct Sum;

impl Accumulated for Sum {
    fn weights(&self, _: usize, out: &mut [f64]) {
        out.fill(1.0);
    }

    fn composite(&self, pixel: Pixel<'_>, _: usize, weights: &[f64], background: [f64; 3]) -> [f64; 3] {
        let alphas = pixel.alpha.iter().map(|&a| f64::from(a)).collect::<ExactSum>().value();
        composite_over(pixel, weights, 1.0 - alphas, background)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        assert_close(&image(&WeightedSum, &one())[0], &[0.625, 0.5, 0.5]);
        assert_close(&image(&WeightedSum, &two())[0], &[0.5, 0.5, 0.0]);
        // Σ a = 1.5 takes half of the background away that is not there.
        assert_close(&image(&WeightedSum, &three())[0], &[0.0, 0.0, 0.0]);
        let black = pixel(&[1.0, 2.0], &[1.0, 1.0], &[[0.0; 3]; 2]);
        assert_close(&image(&WeightedSum, &black)[0], &[-1.0; 3]);
    }

    #[test]
    fn order_never_matters_and_invisible_pixels_show_the_background() {
        assert!(!order_matters(&WeightedSum, &scene(2)));
        assert_eq!(image(&WeightedSum, &pixel(&[], &[], &[]))[0], WHITE);
        assert_eq!(image(&WeightedSum, &pixel(&[1.0], &[0.0], &[[0.5; 3]]))[0], WHITE);
        assert!(parse("weighted-sum").is_ok() && parse("weighted-sum:2").is_err() && parse("weighted").is_err());
    }
}
