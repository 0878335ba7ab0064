//! Dual depth peeling: the nearest and the farthest layers exactly, and nothing of what lies between them.

use super::capabilities::{COLOUR_BITS, Capabilities, Needs};
use super::layered::{Layered, blend};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::pixel::{FragmentList, abuffer};

/// The stem of its name on the command line, `dual-depth-peeling:K`.
pub const NAME: &str = "dual-depth-peeling";

/// K passes, each of which peels the nearest and the farthest fragment that are left; after K passes what lies between
/// is dropped. Front layers are blended from front to back, back layers from back to front, and the former over the
/// latter over the background. Of tied fragments the first of the input counts as the nearer.
///
/// Weights are the transmittance through the peeled layers, 0 for what is dropped. The pass that finds the first depth
/// range peels nothing and is not counted.
///
/// # Source
/// Bavoil, Myers, *Order Independent Transparency with Dual Depth Peeling*, NVIDIA 2008; DWB22 Sec. 3.1.
#[derive(Debug, Clone, Copy)]
pub struct DualDepthPeeling {
    /// Passes, K.
    pub passes: usize,
}

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "dual-depth-peeling:K",
    source: "Bavoil, Myers, NVIDIA 2008",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    [4, 8].map(|k| format!("{head}:{k}")).to_vec()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments
        .layers()
        .map(|passes| Box::new(DualDepthPeeling { passes }) as _)
}

impl Method for DualDepthPeeling {
    fn name(&self) -> String {
        format!("{NAME}:{}", self.passes)
    }

    /// Two depth ranges in RG32F, two targets of front colours and one of back colours, however many passes; one pass
    /// more finds the first range.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: Some(128),
            colour_bits_per_pixel: 3 * COLOUR_BITS,
            geometry_passes: self.passes as u32 + 1,
            needs: Needs::F32_BLENDING,
            order_dependent: false,
        }
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Layered::of(list, |order: &mut Vec<u32>, pixel, out| {
            abuffer::front_to_back(pixel, order);
            // A fragment that is both the nearest and the farthest is peeled once.
            let front = self.passes.min(order.len());
            let back = order.len().saturating_sub(self.passes).max(front);
            blend(pixel, order[..front].iter().chain(&order[back..]), out)
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
        let of = |passes, list: &FragmentList| image(&DualDepthPeeling { passes }, list)[0];
        assert_close(&of(1, &one()), &[0.625, 0.5, 0.5]);
        assert_close(&of(1, &two()), &[0.75, 0.5, 0.25]);
        // Red over blue; green, between them, is missing.
        assert_close(&of(1, &three()), &[0.75, 0.25, 0.5]);
        assert_close(&of(2, &three()), &[0.625, 0.375, 0.25]);
        assert_close(&weights(&DualDepthPeeling { passes: 1 }, &three()), &[0.5, 1.0, 0.0]);
    }

    #[test]
    fn enough_passes_give_the_a_buffer() {
        // Half as many passes as there are fragments do.
        assert_converges(|k| Box::new(DualDepthPeeling { passes: k.div_ceil(2) }));
    }

    #[test]
    fn order_matters_for_ties_only() {
        for passes in [1, 3, 30] {
            assert!(!order_matters(&DualDepthPeeling { passes }, &untied(2)));
            assert!(order_matters(&DualDepthPeeling { passes }, &scene(2)));
        }
    }

    #[test]
    fn names() {
        assert_eq!(parse("dual-depth-peeling:8").unwrap().name(), "dual-depth-peeling:8");
        assert!(parse("dual-depth-peeling:0").is_err());
    }
}
