//! Hybrid transparency: the nearest fragments of a pixel exactly, the others averaged.

use super::capabilities::{COLOUR_BITS, Capabilities, Needs};
use super::layered::Layered;
use super::registry::{Arguments, Entry, ParseError};
use super::shader::MethodShader;
use super::{Accumulated, Context, Method, MethodError};
use crate::numeric::exact_sum::ExactSum;
use crate::pixel::{FragmentList, absorbance, abuffer};

/// The stem of its name on the command line, `hybrid:K`.
pub const NAME: &str = "hybrid";

/// The K nearest fragments, the core, are blended from front to back; all others, the tail, take on their mean colour Σ
/// a C/Σ a and let through what they all let through, e^−Σ A. The tail lies behind the core and before the background.
///
/// The composite is linear in the colours, and a fragment's weight is what it multiplies a C by: T in the core, T_core
/// (1 − t)/Σ a in the tail, t what the tail lets through. Which of tied fragments is the nearer is decided by the
/// input, as in the A-buffer's image.
///
/// Pass 1 keeps depth and opacity of the core; pass 2 adds up colours of core and tail apart.
///
/// # Source
/// Maule, Comba, Torchelsen, Bastos, *Hybrid Transparency*, I3D 2013.
#[derive(Debug, Clone, Copy)]
pub struct Hybrid {
    /// Fragments of the core, K.
    pub core: usize,
}

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "hybrid:K",
    source: "Maule, Comba, Torchelsen, Bastos, I3D 2013",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    [4, 6, 8].map(|k| format!("{head}:{k}")).to_vec()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.layers().map(|core| Box::new(Hybrid { core }) as _)
}

impl Method for Hybrid {
    fn name(&self) -> String {
        format!("{NAME}:{}", self.core)
    }

    /// A core fragment is a depth of 24 bits and an opacity of 8; b0 and Σ a are sums. Colours of core and tail are two
    /// accumulators.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: Some((32 * self.core as u32).saturating_add(64)),
            colour_bits_per_pixel: 2 * COLOUR_BITS,
            geometry_passes: 2,
            needs: Needs {
                f32_blending: true,
                ..Needs::INTERLOCK
            },
            order_dependent: false,
        }
    }

    fn shader(&self) -> Option<MethodShader> {
        if self.core > 8 {
            return None;
        }
        let source = format!("\nconst HYBRID_CORE = {}u;\n{}", self.core, include_str!("hybrid.wgsl"));
        Some(MethodShader::inserted(self.name(), 3 * self.core + 3, source))
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Layered::of(list, |order: &mut Vec<u32>, pixel, out| {
            abuffer::front_to_back(pixel, order);
            let (core, tail) = order.split_at(self.core.min(order.len()));
            let mut in_front = 0.0;
            for &i in core {
                out[i as usize] = libm::exp(-in_front);
                in_front += absorbance(pixel.alpha[i as usize]);
            }
            let behind_core = libm::exp(-in_front);
            let sum = |f: &dyn Fn(f32) -> f64| {
                let terms = tail.iter().map(|&i| f(pixel.alpha[i as usize]));
                terms.collect::<ExactSum>().value()
            };
            let (alphas, absorbed) = (sum(&f64::from), sum(&absorbance));
            let through = libm::exp(-absorbed);
            let weight = if alphas > 0.0 {
                behind_core * (1.0 - through) / alphas
            } else {
                behind_core
            };
            tail.iter().for_each(|&i| out[i as usize] = weight);
            behind_core * through
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
        let of = |core, list: &FragmentList| image(&Hybrid { core }, list)[0];
        assert_close(&of(1, &one()), &[0.625, 0.5, 0.5]);
        assert_close(&of(1, &two()), &[0.75, 0.5, 0.25]);
        // Red before the mean of green and blue, which let 1/4 through: (0, 1/2, 1/2) · 1/2 · 3/4, and 1/8 of white.
        assert_close(&of(1, &three()), &[0.5 + 0.125, 0.1875 + 0.125, 0.1875 + 0.125]);
        assert_close(&weights(&Hybrid { core: 1 }, &three()), &[0.375, 1.0, 0.375]);
        assert_close(&of(2, &three()), &exact_image(&three())[0]);
        // A tail of which nothing is seen.
        let clear = pixel(&[1.0, 2.0, 3.0], &[0.5, 0.0, 0.0], &[[1.0, 0.0, 0.0]; 3]);
        assert_close(&weights(&Hybrid { core: 1 }, &clear), &[1.0, 0.5, 0.5]);
    }

    #[test]
    fn enough_layers_give_the_a_buffer() {
        assert_converges(|core| Box::new(Hybrid { core }));
    }

    /// One colour stays, and what the pixel lets through is exact, whatever the tail; order matters for ties alone.
    #[test]
    fn one_colour_stays_and_order_matters_for_ties_only() {
        let clear = pixel(&[3.0, 1.0, 2.0], &[0.25, 0.5, 0.75], &[[1.0; 3]; 3]);
        assert_close(&image(&Hybrid { core: 1 }, &clear)[0], &[1.0; 3]);
        for core in [1, 3, 30] {
            assert!(!order_matters(&Hybrid { core }, &untied(2)));
            assert!(order_matters(&Hybrid { core }, &scene(2)));
        }
    }

    #[test]
    fn names() {
        assert_eq!(parse("hybrid:6").unwrap().name(), "hybrid:6");
        assert_eq!(parse("hybrid:6").unwrap().capabilities().bits_per_pixel, Some(256));
        assert!(parse("hybrid").is_err() && parse("hybrid:0").is_err() && parse("hybrid:6+own").is_err());
    }
}
