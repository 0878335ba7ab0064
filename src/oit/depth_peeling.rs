//! Depth peeling: the nearest layers exactly, and nothing of what lies behind them.

use super::capabilities::{COLOUR_BITS, Capabilities, Needs};
use super::layered::{Layered, blend};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::pixel::{FragmentList, abuffer};

/// The stem of its name on the command line, `depth-peeling:K`.
pub const NAME: &str = "depth-peeling";

/// K passes, each of which peels the nearest fragment that is left and blends it from front to back; the rest is
/// dropped, and the background shows through the peeled layers alone. Of tied fragments the first of the input is
/// peeled first, and none is lost.
///
/// Weights are the transmittance through the peeled layers, 0 for what is dropped.
///
/// # Source
/// Everitt, *Interactive Order-Independent Transparency*, NVIDIA 2001; blending from front to back as DWB22 Eq.
/// 3.2–3.3.
#[derive(Debug, Clone, Copy)]
pub struct DepthPeeling {
    /// Passes, K.
    pub passes: usize,
}

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "depth-peeling:K",
    source: "Everitt, NVIDIA 2001",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    [4, 8].map(|k| format!("{head}:{k}")).to_vec()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.layers().map(|passes| Box::new(DepthPeeling { passes }) as _)
}

impl Method for DepthPeeling {
    fn name(&self) -> String {
        format!("{NAME}:{}", self.passes)
    }

    /// Two f32 depth buffers, however many passes; layers are blended into one target.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: Some(64),
            colour_bits_per_pixel: COLOUR_BITS,
            geometry_passes: self.passes as u32,
            needs: Needs::NONE,
            order_dependent: false,
        }
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Layered::of(list, |order: &mut Vec<u32>, pixel, out| {
            abuffer::front_to_back(pixel, order);
            blend(pixel, order.iter().take(self.passes), out)
        })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        let of = |passes, list: &FragmentList| image(&DepthPeeling { passes }, list)[0];
        assert_close(&of(1, &one()), &[0.625, 0.5, 0.5]);
        // Red alone over white.
        assert_close(&of(1, &two()), &[1.0, 0.5, 0.5]);
        assert_close(&of(2, &two()), &[0.75, 0.5, 0.25]);
        // Blue, the farthest, is missing.
        assert_close(&of(2, &three()), &[0.75, 0.5, 0.25]);
        assert_close(&of(3, &three()), &[0.625, 0.375, 0.25]);
        assert_close(&weights(&DepthPeeling { passes: 2 }, &three()), &[0.0, 1.0, 0.5]);
    }

    #[test]
    fn enough_passes_give_the_a_buffer() {
        assert_converges(|passes| Box::new(DepthPeeling { passes }));
    }

    #[test]
    fn order_matters_for_ties_only() {
        for passes in [1, 3, 30] {
            assert!(!order_matters(&DepthPeeling { passes }, &untied(2)));
            assert!(order_matters(&DepthPeeling { passes }, &scene(2)));
        }
    }

    #[test]
    fn names() {
        assert_eq!(parse("depth-peeling:8").unwrap().name(), "depth-peeling:8");
        assert!(parse("depth-peeling").is_err());
    }
}
