//! Stochastic transparency: samples of a pixel each keep a fragment in proportion to its opacity.

use super::capabilities::{COLOUR_BITS, Capabilities, Needs, sums};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::numeric::rng::stream;
use crate::pixel::{FragmentList, Pixel};
use rand::RngExt;
use rayon::prelude::*;

/// The stem of its name on the command line, `stochastic:S`.
pub const NAME: &str = "stochastic";

/// What random streams of pixels are drawn for.
const PURPOSE: u64 = 0x570c;

/// S samples a pixel. A fragment of opacity a covers ⌊a S + ξ⌋ samples, ξ uniform in [0, 1), chosen at random; a sample
/// keeps the nearest of the fragments that cover it. A fragment's visibility is the share of the samples whose kept
/// fragment does not lie in front of it: T on average, and never a wrong total, since colours are normalised by the
/// exact one.
///
/// The random numbers of a pixel belong to its fragments from front to back, so that the order of the input changes
/// nothing.
///
/// It draws the geometry three times: total opacity, samples, colour.
///
/// # Source
/// Enderton, Sintorn, Shirley, Luebke, *Stochastic Transparency*, IEEE TVCG 17(8), 2011: depth-based, with alpha
/// correction and stratified masks.
#[derive(Debug, Clone, Copy)]
pub struct Stochastic {
    /// Samples, S.
    pub samples: usize,
}

/// Most samples of a pixel.
const MAX_SAMPLES: usize = 1 << 12;

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "stochastic:SAMPLES",
    source: "Enderton, Sintorn, Shirley, Luebke, IEEE TVCG 17(8) 2011",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    [8, 16].map(|s| format!("{head}:{s}")).to_vec()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    let samples = arguments.layers()?;
    if samples > MAX_SAMPLES {
        return Err(arguments.wrong(format!("expected a whole number from 1 to {MAX_SAMPLES}")));
    }
    Ok(Box::new(Stochastic { samples }))
}

impl Method for Stochastic {
    fn name(&self) -> String {
        format!("{NAME}:{}", self.samples)
    }

    /// A depth in f32 a sample, and b0.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: Some(32 * self.samples as u32 + sums(1)),
            colour_bits_per_pixel: COLOUR_BITS,
            geometry_passes: 3,
            needs: Needs {
                multisampling: true,
                ..Needs::NONE
            },
            order_dependent: false,
        }
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let mut kept = vec![f32::INFINITY; self.samples * list.pixels()];
        kept.par_chunks_mut(self.samples)
            .with_min_len(64)
            .enumerate()
            .for_each_init(Vec::new, |order, (p, kept)| self.draw(p, list.pixel(p), order, kept));
        Ok(Box::new(Kept {
            list,
            samples: self.samples,
            kept,
        }))
    }
}

impl Stochastic {
    /// Depths that the samples of pixel p keep, in rising order.
    fn draw(&self, p: usize, pixel: Pixel<'_>, order: &mut Vec<u32>, kept: &mut [f32]) {
        let s = self.samples;
        order.clear();
        order.extend(0..pixel.len() as u32);
        let key = |i: u32| (pixel.view_z[i as usize], pixel.alpha[i as usize]);
        order.sort_unstable_by(|&a, &b| {
            let (a, b) = (key(a), key(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let mut rng = stream(0, PURPOSE, p as u64);
        let mut shuffled: Vec<usize> = (0..s).collect();
        for &i in &*order {
            let (view_z, alpha) = key(i);
            let covered = (f64::from(alpha) * s as f64 + rng.random::<f64>()).floor() as usize;
            // The first `covered` places of a shuffle.
            for place in 0..covered.min(s) {
                let other = place + (rng.random::<f64>() * (s - place) as f64) as usize;
                shuffled.swap(place, other.min(s - 1));
                let sample = &mut kept[shuffled[place]];
                *sample = sample.min(view_z);
            }
        }
        kept.sort_unstable_by(f32::total_cmp);
    }
}

struct Kept<'a> {
    list: &'a FragmentList,
    samples: usize,
    /// Depths, S a pixel, in rising order.
    kept: Vec<f32>,
}

impl Accumulated for Kept<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        let kept = &self.kept[self.samples * p..self.samples * (p + 1)];
        for (out, &v) in out.iter_mut().zip(self.list.pixel(p).view_z) {
            let in_front = kept.partition_point(|&depth| depth < v);
            *out = 1.0 - in_front as f64 / self.samples as f64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::tolerance::AbsoluteError;
    use crate::oit::parse;
    use crate::oit::testing::*;
    use crate::pixel::abuffer;

    /// Opacities that are whole numbers of samples cover exactly so many, so that one fragment in front needs no luck;
    /// an opaque one hides all.
    #[test]
    fn two_fragments_by_hand() {
        let method = Stochastic { samples: 8 };
        assert_close(&weights(&method, &two()), &[0.5, 1.0]);
        assert_close(&image(&method, &two())[0], &[0.75, 0.5, 0.25]);
        assert_close(&image(&method, &one())[0], &[0.625, 0.5, 0.5]);
        let opaque = pixel(&[2.0, 1.0], &[0.5, 1.0], &[[0.0; 3]; 2]);
        assert_eq!(weights(&method, &opaque), [0.0, 1.0]);
        assert_eq!(image(&method, &pixel(&[], &[], &[]))[0], WHITE);
    }

    /// Visibility is T on average: over 4000 pixels of the same three fragments the mean of the last is within four
    /// standard errors of 1/4 (S = 4: variance of two independent halves below 0.0625 each pixel). Control: it is not
    /// 1/2.
    #[test]
    fn visibility_is_transmittance_on_average() {
        let n = 4000u64;
        let list = FragmentList::new(
            (0..=n).map(|i| 3 * i).collect(),
            [1.0, 2.0, 3.0].repeat(n as usize),
            [0.5; 3].repeat(n as usize),
            None,
        )
        .unwrap();
        let w = weights(&Stochastic { samples: 3 }, &list);
        let mean = w.iter().skip(2).step_by(3).sum::<f64>() / n as f64;
        assert!((mean - 0.25).abs() < 4.0 * 0.25 / (n as f64).sqrt(), "{mean}");
        assert!((mean - 0.5).abs() > 0.1);
    }

    /// The error falls as samples are added, about as 1/S; the order of the input changes nothing.
    #[test]
    fn more_samples_less_noise() {
        let list = untied(4);
        let exact = abuffer::list_transmittance(&list);
        let mse = |samples| AbsoluteError::of(&weights(&Stochastic { samples }, &list), &exact).mse();
        let errors = [4, 16, 64, 256].map(mse);
        assert!(errors.windows(2).all(|e| e[1] < 0.5 * e[0]), "{errors:?}");
        assert!(!order_matters(&Stochastic { samples: 8 }, &scene(4)));
    }

    #[test]
    fn names() {
        assert_eq!(parse("stochastic:8").unwrap().name(), "stochastic:8");
        assert!(parse("stochastic").is_err() && parse("stochastic:99999").is_err());
    }
}
