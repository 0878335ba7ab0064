//! Wavelet transparency: absorbance over the pixel's own depth range as Haar coefficients.

use super::capabilities::{COLOUR_BITS, Capabilities, Needs, RANGE_BITS, sums};
use super::moment_based::{ends, exact};
use super::registry::{Arguments, Entry, ParseError};
use super::shader::MethodShader;
use super::{Accumulated, Context, Method, MethodError, composite_with_total};
use crate::numeric::exact_sum::ExactSum;
use crate::numeric::quantise::round_f16;
use crate::pixel::{FragmentList, OfFilled, Pixel, absorbance};

/// The stem of its name on the command line.
pub const NAME: &str = "wavelet";

/// Greatest rank: 64 coefficients.
const MAX_RANK: usize = 5;

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "wavelet:RANK[:f16|f32][+own]",
    source: "Aizenshtein, Smal, McGuire, arXiv 2201.00094, 2022; +own is ours",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    [
        "2",
        "2+own",
        "3",
        "3+own",
        "3:f32",
        "3:f32+own",
        "3:f16",
        "3:f16+own",
        "4",
        "4+own",
    ]
    .iter()
    .map(|tail| format!("{head}:{tail}"))
    .collect()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    let wrong = || {
        arguments.wrong(format!(
            "expected a rank from 1 to {MAX_RANK}, with :f16, :f32 or nothing"
        ))
    };
    let (rank, storage) = match arguments.argument.map(|a| a.split_once(':').unwrap_or((a, ""))) {
        Some((rank, "")) => (rank, Coefficients::F64),
        Some((rank, "f32")) => (rank, Coefficients::F32),
        Some((rank, "f16")) => (rank, Coefficients::F16),
        _ => return Err(wrong()),
    };
    match rank.parse() {
        Ok(rank @ 1..=MAX_RANK) => Ok(Box::new(Wavelet {
            rank,
            storage,
            own: arguments.own,
        })),
        _ => Err(wrong()),
    }
}

/// What coefficients are blended in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coefficients {
    /// Not rounded.
    F64,
    /// Rounded to f32 with every fragment.
    F32,
    /// Rounded to f16 with every fragment.
    F16,
}

impl Coefficients {
    fn round(self, x: f64) -> f64 {
        match self {
            Self::F64 => x,
            Self::F32 => f64::from(x as f32),
            Self::F16 => round_f16(x),
        }
    }

    fn suffix(self) -> &'static str {
        match self {
            Self::F64 => "",
            Self::F32 => ":f32",
            Self::F16 => ":f16",
        }
    }
}

/// N = 2^(R+1) coefficients of the absorbance in front of a depth.
///
/// With x = d (N − 1)/N, d the depth between the pixel's nearest and farthest fragment, in \[0, 1\], a fragment of
/// absorbance A adds to one Haar coefficient a level p = 0..R, k = ⌊2^p x⌋, u = x − k/2^p: c\[2^p − 1 + k\] += A
/// 2^(p/2) min(u, 2^−p − u); and to the mean c\[N − 1\] += A (1 − x). The absorbance in front, averaged over cell j of
/// N, is F_j = c\[N − 1\] − Σ_p 2^(p/2) s_p c\[2^p − 1 + (j >> (R + 1 − p))\], s_p = 1 in the first half of the level's
/// interval and −1 in the second. Between cells it is interpolated, from the cell in front: T = exp(−lerp(F_{j−1}, F_j,
/// frac(N x))), F_{−1} = 0. No fragment reaches the last cell, so that F_{N−1} is the total.
///
/// A fragment's own event is taken out before it is answered, as published implementations do. d is linear; with `+own`
/// it is logarithmic, answers stay between e^−others and 1, and the ends of a pixel are exact.
///
/// It draws the geometry three times: depth range, coefficients, colour.
///
/// # Source
/// Aizenshtein, Smal, McGuire, *Wavelet Transparency*, arXiv 2201.00094, 2022.
#[derive(Debug, Clone, Copy)]
pub struct Wavelet {
    /// Rank R.
    pub rank: usize,
    /// What coefficients are blended in.
    pub storage: Coefficients,
    /// Logarithmic depth and exact ends.
    pub own: bool,
}

impl Wavelet {
    /// Coefficients, N.
    fn count(&self) -> usize {
        2 << self.rank
    }

    /// Place of a fragment in [0, (N − 1)/N]; 0 where the pixel has one depth.
    fn place(&self, view_z: f32, (nearest, farthest): (f32, f32)) -> f64 {
        let (v, v0, v1) = (f64::from(view_z), f64::from(nearest), f64::from(farthest));
        if v1 <= v0 {
            return 0.0;
        }
        let d = if self.own {
            libm::log(v / v0) / libm::log(v1 / v0)
        } else {
            (v - v0) / (v1 - v0)
        };
        d.clamp(0.0, 1.0) * (1.0 - 1.0 / self.count() as f64)
    }

    /// What a fragment at x adds, one coefficient a level and the mean: calls `add(index, term)`.
    fn terms(&self, x: f64, absorbance: f64, mut add: impl FnMut(usize, f64)) {
        for p in 0..=self.rank {
            let intervals = (1u64 << p) as f64;
            let k = (intervals * x).floor();
            let u = x - k / intervals;
            let term = absorbance * libm::sqrt(intervals) * u.min(1.0 / intervals - u);
            add((1 << p) - 1 + k as usize, term);
        }
        add(self.count() - 1, absorbance * (1.0 - x));
    }

    /// Adds up a pixel's coefficients.
    fn accumulate_pixel(&self, pixel: Pixel<'_>, out: &mut [f64]) {
        let ends = ends(pixel);
        let samples = || pixel.view_z.iter().zip(pixel.alpha);
        if self.storage == Coefficients::F64 {
            let mut exact = vec![ExactSum::default(); out.len()];
            for (&v, &alpha) in samples() {
                self.terms(self.place(v, ends), absorbance(alpha), |i, term| exact[i].add(term));
            }
            out.iter_mut().zip(exact).for_each(|(out, sum)| *out = sum.value());
            return;
        }
        for (&v, &alpha) in samples() {
            self.terms(self.place(v, ends), absorbance(alpha), |i, term| {
                out[i] = self.storage.round(out[i] + self.storage.round(term));
            });
        }
    }

    /// F_j, the mean over cell j of the absorbance in front.
    fn cell(&self, c: &[f64], j: usize) -> f64 {
        let mut f = c[self.count() - 1];
        for p in 0..=self.rank {
            let interval = j >> (self.rank + 1 - p);
            let second_half = j >> (self.rank - p) & 1 == 1;
            let term = libm::sqrt((1u64 << p) as f64) * c[(1 << p) - 1 + interval];
            f += if second_half { term } else { -term };
        }
        f
    }

    /// Absorbance in front of x.
    fn in_front(&self, c: &[f64], x: f64) -> f64 {
        let n = self.count();
        let at = n as f64 * x;
        let j = (at.floor() as usize).min(n - 1);
        let behind = self.cell(c, j);
        let before = if j == 0 { 0.0 } else { self.cell(c, j - 1) };
        before + (behind - before) * (at - j as f64)
    }
}

impl Method for Wavelet {
    fn name(&self) -> String {
        format!(
            "{NAME}:{}{}{}",
            self.rank,
            self.storage.suffix(),
            if self.own { "+own" } else { "" }
        )
    }

    /// N coefficients and both ends of the range.
    fn capabilities(&self) -> Capabilities {
        let n = self.count() as u32;
        let half = self.storage == Coefficients::F16;
        Capabilities {
            bits_per_pixel: Some(if half { 16 * n } else { sums(n) } + RANGE_BITS),
            colour_bits_per_pixel: COLOUR_BITS,
            geometry_passes: 3,
            needs: Needs {
                prepass: true,
                f32_blending: !half,
                ..Needs::NONE
            },
            order_dependent: false,
        }
    }

    fn shader(&self) -> Option<MethodShader> {
        if self.storage == Coefficients::F16 || self.rank > 4 {
            return None;
        }
        let source = format!(
            "\nconst WAVELET_RANK = {}u;\nconst WAVELET_LOG = {};\n{}",
            self.rank,
            self.own,
            include_str!("wavelet.wgsl")
        );
        Some(MethodShader::inserted(self.name(), self.count(), source))
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let coefficients = OfFilled::of(list, |p| {
            let mut out = vec![0.0; self.count()];
            self.accumulate_pixel(list.pixel(p), &mut out);
            out
        });
        Ok(Box::new(Summed {
            method: self,
            list,
            coefficients,
        }))
    }
}

struct Summed<'a> {
    method: &'a Wavelet,
    list: &'a FragmentList,
    /// N a pixel.
    coefficients: OfFilled<Vec<f64>>,
}

impl Summed<'_> {
    /// F_{N−1}: what is kept of a pixel's absorbance.
    fn total(&self, coefficients: &[f64]) -> f64 {
        self.method.cell(coefficients, self.method.count() - 1).max(0.0)
    }
}

impl Accumulated for Summed<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        let (pixel, method) = (self.list.pixel(p), self.method);
        let Some(coefficients) = self.coefficients.get(p) else {
            return;
        };
        let (ends, total) = (ends(pixel), self.total(coefficients));
        let mut others = vec![0.0; method.count()];
        for ((out, &v), &alpha) in out.iter_mut().zip(pixel.view_z).zip(pixel.alpha) {
            let (x, own) = (method.place(v, ends), absorbance(alpha));
            let rest = (total - own).max(0.0);
            if method.own
                && let Some(known) = exact(v, ends, own, total)
            {
                *out = known;
                continue;
            }
            others.copy_from_slice(coefficients);
            method.terms(x, own, |i, term| others[i] -= term);
            let t = libm::exp(-method.in_front(&others, x));
            let least = if method.own { libm::exp(-rest) } else { 0.0 };
            *out = t.clamp(least, 1.0);
        }
    }

    fn composite(&self, pixel: Pixel<'_>, p: usize, weights: &[f64], background: [f64; 3]) -> [f64; 3] {
        let total = self.coefficients.get(p).map_or(0.0, |kept| self.total(kept));
        composite_with_total(pixel, weights, total, background)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::tolerance::AbsoluteError;
    use crate::oit::parse;
    use crate::oit::testing::*;
    use crate::pixel::abuffer;

    fn wavelet(rank: usize, own: bool) -> Wavelet {
        Wavelet {
            rank,
            storage: Coefficients::F64,
            own,
        }
    }

    /// The mean over [a, b] of the absorbance in front of x, from the fragments themselves.
    fn mean(events: &[(f64, f64)], a: f64, b: f64) -> f64 {
        events
            .iter()
            .map(|&(x, absorbance)| absorbance * (b - x.clamp(a, b)) / (b - a))
            .sum()
    }

    /// F_j is the mean of the step function over cell j, and the last one the total: both to 1e-12. Control: one
    /// coefficient wrong by 1e-6.
    #[test]
    fn cells_are_means_of_the_step_function() {
        for rank in 1..=MAX_RANK {
            let method = wavelet(rank, false);
            let n = method.count();
            let list = untied(7);
            for p in [3, 24, 49, 399] {
                let pixel = list.pixel(p);
                let ends = ends(pixel);
                let events: Vec<(f64, f64)> = pixel
                    .view_z
                    .iter()
                    .zip(pixel.alpha)
                    .map(|(&v, &a)| (method.place(v, ends), absorbance(a)))
                    .collect();
                let mut c = vec![0.0; n];
                method.accumulate_pixel(pixel, &mut c);
                let off = |c: &[f64]| {
                    (0..n)
                        .map(|j| {
                            (method.cell(c, j) - mean(&events, j as f64 / n as f64, (j + 1) as f64 / n as f64)).abs()
                        })
                        .fold(0.0, f64::max)
                };
                assert!(off(&c) < 1e-12, "rank {rank}, pixel {p}: {:e}", off(&c));
                let total = abuffer::total_absorbance(pixel);
                assert!((method.cell(&c, n - 1) - total).abs() < 1e-12 * (1.0 + total));
                c[n / 2] += 1e-6;
                assert!(off(&c) > 1e-7);
            }
        }
    }

    /// By hand, rank 1 (cells of a quarter): fragments at d = 0, 1/2, 1 lie at x = 0, 3/8, 3/4. In front of the middle
    /// one, without itself, stands the first alone; the farthest, without itself, has F_2 in front, which both have
    /// entered entirely.
    #[test]
    fn three_fragments_by_hand() {
        let list = pixel(&[1.0, 2.0, 3.0], &[0.5; 3], &[[0.0; 3]; 3]);
        assert_close(&weights(&wavelet(1, false), &list), &[1.0, 0.5, 0.25]);
        // Two near the middle, x = 3/8 and 9/16: in front of the second lies lerp(F_1, F_2, 1/4) of the nearest's ln 2,
        // whole in both cells, and of the other's, half of cell 1 and all of cell 2: 1/2 + 1/8.
        let list = pixel(&[1.0, 2.0, 2.5, 3.0], &[0.5; 4], &[[0.0; 3]; 4]);
        let found = weights(&wavelet(1, false), &list);
        assert_close(&[found[2]], &[0.5f64.powf(1.0 + 0.5 + 0.125)]);
        // Behind: the third's share of cell 1 is none and of cell 2 is 3/4, so that it does not hide the second.
        assert_close(&[found[1]], &[0.5]);
    }

    /// One fragment and pixels of one depth show what the A-buffer shows; an empty one the background.
    #[test]
    fn lone_fragments_are_exact() {
        for own in [false, true] {
            assert_close(&image(&wavelet(3, own), &one())[0], &[0.625, 0.5, 0.5]);
            assert_close(&image(&wavelet(3, own), &two())[0], &[0.75, 0.5, 0.25]);
            let tied = pixel(&[2.0, 2.0], &[0.5, 0.75], &[[0.0; 3]; 2]);
            assert_close(&weights(&wavelet(3, own), &tied), &[1.0, 1.0]);
            assert_eq!(image(&wavelet(3, own), &pixel(&[], &[], &[]))[0], WHITE);
        }
    }

    /// The more coefficients, the smaller the error; f32 changes little, f16 more. The control of order: coefficients
    /// in f16 round with it.
    #[test]
    fn rank_and_storage() {
        let list = untied(3);
        let exact = abuffer::list_transmittance(&list);
        let mse = |method: &Wavelet| AbsoluteError::of(&weights(method, &list), &exact).mse();
        for own in [false, true] {
            let errors = [1, 2, 3, 4, 5].map(|rank| mse(&wavelet(rank, own)));
            assert!(errors.windows(2).all(|e| e[1] < e[0]), "{errors:?}");
            let stored = |storage| {
                mse(&Wavelet {
                    storage,
                    ..wavelet(3, own)
                })
            };
            let (f32, f16) = (stored(Coefficients::F32), stored(Coefficients::F16));
            assert!(
                (f32 / errors[2] - 1.0).abs() < 1e-3 && (f16 / errors[2] - 1.0).abs() < 0.2,
                "{f32:e} {f16:e} {errors:?}"
            );
            assert!(f16 != f32);
        }
    }

    #[test]
    fn names() {
        for name in super::names(NAME) {
            assert_eq!(parse(&name).unwrap().name(), name);
        }
        for (name, part) in [
            ("wavelet", "found nothing"),
            ("wavelet:9", "from 1 to 5"),
            ("wavelet:3:f64", "found '3:f64'"),
        ] {
            let message = parse(name).map(drop).unwrap_err().to_string();
            assert!(message.contains(part), "{name}: {message}");
        }
        let bits = |name: &str| parse(name).unwrap().capabilities().bits_per_pixel;
        assert_eq!([bits("wavelet:3:f16"), bits("wavelet:3")], [Some(320), Some(576)]);
    }
}
