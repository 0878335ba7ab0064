//! The A-buffer: every fragment kept and sorted. What all other methods approximate.

use super::capabilities::{Capabilities, Needs};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::pixel::{FragmentList, Pixel, abuffer};

/// Its name on the command line.
pub const NAME: &str = "abuffer";

/// The exact method: weights are T, and pixels are composited by the over operator.
///
/// # Source
/// NMT24 Eq. 1–4; see [`abuffer`].
#[derive(Debug, Clone, Copy, Default)]
pub struct ABuffer;

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: NAME,
    source: "Carpenter 1984; every fragment kept and sorted",
    names: |head| vec![head.to_owned()],
    build,
};

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    arguments.no_argument()?;
    Ok(Box::new(ABuffer))
}

impl Method for ABuffer {
    fn name(&self) -> String {
        NAME.to_owned()
    }

    /// It keeps every fragment, so that no number of bits suffices for all pixels: a list of them, linked by atomics,
    /// drawn once.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: None,
            colour_bits_per_pixel: 0,
            geometry_passes: 1,
            needs: Needs {
                atomics: true,
                ..Needs::NONE
            },
            order_dependent: false,
        }
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Kept(list)))
    }
}

struct Kept<'a>(&'a FragmentList);

impl Accumulated for Kept<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        abuffer::transmittance(self.0.pixel(p), out);
    }

    /// By the over operator, which breaks ties; the weights do not.
    fn composite(&self, pixel: Pixel<'_>, _: usize, _: &[f64], background: [f64; 3]) -> [f64; 3] {
        abuffer::composite(pixel, background)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;

    #[test]
    fn it_is_the_truth() {
        let list = scene(1);
        assert_eq!(image(&ABuffer, &list), exact_image(&list));
        assert_eq!(weights(&ABuffer, &list), abuffer::list_transmittance(&list));
        assert!(parse("abuffer").is_ok() && parse("abuffer:1").is_err() && parse("abuffer+own").is_err());
    }

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        assert_close(&image(&ABuffer, &one())[0], &[0.625, 0.5, 0.5]);
        assert_close(&image(&ABuffer, &two())[0], &[0.75, 0.5, 0.25]);
        assert_close(&image(&ABuffer, &three())[0], &[0.625, 0.375, 0.25]);
        assert_close(&weights(&ABuffer, &three()), &[0.25, 1.0, 0.5]);
    }
}
