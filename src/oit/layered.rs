//! What methods have in common that blend layers from front to back and let a known part of the background through.

use super::Accumulated;
use crate::numeric::exact_sum::ExactSum;
use crate::pixel::{FragmentList, Pixel, absorbance};
use rayon::prelude::*;

/// Weights of all fragments, and what every pixel lets through of the background.
pub struct Layered<'a> {
    list: &'a FragmentList,
    weights: Vec<f64>,
    behind: Vec<f64>,
}

impl<'a> Layered<'a> {
    /// Runs `f` for every non-empty pixel on all cores: it fills in the weights of the pixel's fragments and returns
    /// what the pixel lets through of the background. `S` is memory that it may use again from pixel to pixel.
    pub fn of<S: Default>(
        list: &'a FragmentList,
        f: impl Fn(&mut S, Pixel<'_>, &mut [f64]) -> f64 + Send + Sync,
    ) -> Self {
        let mut weights = vec![0.0; list.len()];
        let mut behind = vec![1.0; list.pixels()];
        let mut rest = weights.as_mut_slice();
        let mut jobs = Vec::with_capacity(list.pixels());
        for (p, behind) in behind.iter_mut().enumerate() {
            let (own, others) = rest.split_at_mut(list.range(p).len());
            rest = others;
            if !own.is_empty() {
                jobs.push((p, own, behind));
            }
        }
        jobs.into_par_iter()
            .with_min_len(64)
            .for_each_init(S::default, |memory, (p, own, behind)| {
                *behind = f(memory, list.pixel(p), own)
            });
        Self { list, weights, behind }
    }
}

impl Accumulated for Layered<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        out.copy_from_slice(&self.weights[self.list.range(p)]);
    }

    fn composite(&self, pixel: Pixel<'_>, p: usize, weights: &[f64], background: [f64; 3]) -> [f64; 3] {
        composite_over(pixel, weights, self.behind[p], background)
    }
}

/// Colour of a pixel whose weights are taken as they are: C = Σ a w C + t C_bg, t what the pixel lets through of the
/// background.
///
/// # Panics
/// If the pixel has fragments and no colours.
pub fn composite_over(pixel: Pixel<'_>, weights: &[f64], behind: f64, background: [f64; 3]) -> [f64; 3] {
    let color = pixel.color.unwrap_or(&[]);
    assert_eq!(color.len(), pixel.len(), "compositing needs colours");
    let mut sum = [ExactSum::default(); 3];
    for ((&a, c), &w) in pixel.alpha.iter().zip(color).zip(weights) {
        for (s, &c) in sum.iter_mut().zip(c) {
            s.add(f64::from(a) * w * f64::from(c));
        }
    }
    std::array::from_fn(|c| behind * background[c] + sum[c].value())
}

/// Blends some fragments of a pixel from front to back as if there were no others, which get weight 0; returns what
/// they let through.
pub fn blend<'i>(pixel: Pixel<'_>, front_to_back: impl IntoIterator<Item = &'i u32>, out: &mut [f64]) -> f64 {
    out.fill(0.0);
    let mut in_front = 0.0;
    for &i in front_to_back {
        out[i as usize] = libm::exp(-in_front);
        in_front += absorbance(pixel.alpha[i as usize]);
    }
    libm::exp(-in_front)
}
