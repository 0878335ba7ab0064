//! What the networks see that answer once a pixel, with a colour: those of the two rivals that do so.
//!
//! Neither source is at hand in full. What is known of both: two hidden layers of 32 and 16 units, three outputs, the
//! two nearest fragments kept exactly, ten inputs (DFA) and five (STAR-NT). The columns below are our reading, and a
//! generous one: each network sees what its pass 1 can keep, and whatever is known exactly is used exactly.

use crate::numeric::exact_sum::ExactSum;
use crate::pixel::{Pixel, absorbance};
use serde::{Deserialize, Serialize};

/// Fragments of a pixel that are kept one by one.
const NEAREST: usize = 2;

/// Share of a pixel's light below which a network's colour is not seen.
const UNSEEN: f64 = 1e-6;

/// What a network sees of a pixel. Its colour stands for what lies behind the two nearest fragments, the tail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ColourSet {
    /// Deep and fast approximate transparency: both nearest fragments and the sums of the tail.
    ///
    /// # Source
    /// Tsopouridis, Vasilakis, Fudos, *Deep and Fast Approximate Order Independent Transparency*, CGF 43(6) 2024.
    Dfa,
    /// STAR-NT: the sums of the tail alone.
    StarNt,
}

/// What pass 1 keeps of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Kept {
    /// Colour of the two nearest over black.
    pub front: [f64; 3],
    /// Absorbance of the two nearest.
    pub front_absorbance: f64,
    /// Σ a C over all other fragments, the tail.
    pub tail_color: [f64; 3],
    /// Σ a over the tail.
    pub tail_alpha: f64,
    /// Σ A over the tail.
    pub tail_absorbance: f64,
    /// Fragments of the tail.
    pub tail_count: usize,
}

impl Kept {
    /// What is kept of a pixel, the same to the bit in any order of its fragments but for ties of the nearest.
    ///
    /// # Panics
    /// If the pixel has fragments and no colours.
    pub fn of(pixel: Pixel<'_>) -> Self {
        let color = pixel.color.unwrap_or(&[]);
        assert_eq!(color.len(), pixel.len(), "a network of colours needs colours");
        let nearer = |a: &usize, b: &usize| pixel.view_z[*a].total_cmp(&pixel.view_z[*b]).then(a.cmp(b));
        let mut order: Vec<usize> = (0..pixel.len()).collect();
        if order.len() > NEAREST {
            order.select_nth_unstable_by(NEAREST - 1, nearer);
        }
        let (front, tail) = order.split_at_mut(NEAREST.min(pixel.len()));
        front.sort_unstable_by(nearer);
        let mut kept = Self {
            tail_count: tail.len(),
            ..Self::default()
        };
        for &i in &*front {
            let weight = f64::from(pixel.alpha[i]) * libm::exp(-kept.front_absorbance);
            for (sum, &c) in kept.front.iter_mut().zip(&color[i]) {
                *sum += weight * f64::from(c);
            }
            kept.front_absorbance += absorbance(pixel.alpha[i]);
        }
        let sum = |of: &dyn Fn(usize) -> f64| tail.iter().map(|&i| of(i)).collect::<ExactSum>().value();
        kept.tail_color = std::array::from_fn(|c| sum(&|i| f64::from(pixel.alpha[i]) * f64::from(color[i][c])));
        kept.tail_alpha = sum(&|i| pixel.alpha[i].into());
        kept.tail_absorbance = sum(&|i| absorbance(pixel.alpha[i]));
        kept
    }

    /// Share of the light that the two nearest let through.
    fn through_front(&self) -> f64 {
        libm::exp(-self.front_absorbance)
    }

    /// Share of the light that the tail lets through.
    fn through_tail(&self) -> f64 {
        libm::exp(-self.tail_absorbance)
    }

    /// What the network's colour is multiplied by in the pixel: what the tail adds behind the front.
    pub fn share(&self) -> f64 {
        self.through_front() * (1.0 - self.through_tail())
    }

    /// Whether a tail is seen; of a pixel without one everything is known.
    pub fn needs_network(&self) -> bool {
        self.share() > UNSEEN
    }

    /// Colour of a pixel from the network's colour N: front + e^−A_front (N (1 − e^−A_tail) + e^−A_tail C_bg); of
    /// pixels that have no tail to be seen, the exact one.
    pub fn composite(&self, answer: impl FnOnce() -> [f64; 3], background: [f64; 3]) -> [f64; 3] {
        let behind = self.through_front() * self.through_tail();
        let known = |c: usize| self.front[c] + behind * background[c];
        if !self.needs_network() {
            return std::array::from_fn(known);
        }
        let (share, answer) = (self.share(), answer());
        std::array::from_fn(|c| known(c) + share * answer[c])
    }

    /// What the network should answer, from the exact colour of the pixel over black.
    pub fn target(&self, exact: [f64; 3]) -> [f32; 3] {
        std::array::from_fn(|c| ((exact[c] - self.front[c]) / self.share()) as f32)
    }
}

impl ColourSet {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Dfa, Self::StarNt];

    /// Its name in configurations, model files and methods.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dfa => "dfa",
            Self::StarNt => "star-nt",
        }
    }

    /// Names of the columns, in order.
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Dfa => &[
                "front_r",
                "front_g",
                "front_b",
                "front_opacity",
                "tail_mean_r",
                "tail_mean_g",
                "tail_mean_b",
                "tail_mean_alpha",
                "tail_opacity",
                "log_tail_count",
            ],
            Self::StarNt => &[
                "tail_mean_r",
                "tail_mean_g",
                "tail_mean_b",
                "tail_mean_alpha",
                "log_tail_count",
            ],
        }
    }

    /// Features of a pixel: colour of the front over black, 1 − e^−A of front and tail, Σ a C/Σ a, Σ a/n and
    /// log2(1 + n)/8 of the tail.
    ///
    /// # Shapes
    /// `[W]`, appended to `out`.
    pub fn features(self, kept: &Kept, out: &mut Vec<f32>) {
        let per = |sum: f64, count: f64| if count > 0.0 { (sum / count) as f32 } else { 0.0 };
        let count = kept.tail_count as f64;
        let mean = kept.tail_color.map(|sum| per(sum, kept.tail_alpha));
        let (mean_alpha, log_count) = (per(kept.tail_alpha, count), (libm::log2(1.0 + count) / 8.0) as f32);
        match self {
            Self::Dfa => {
                out.extend(kept.front.map(|c| c as f32));
                out.push((1.0 - kept.through_front()) as f32);
                out.extend(mean);
                out.extend([mean_alpha, (1.0 - kept.through_tail()) as f32, log_count]);
            }
            Self::StarNt => {
                out.extend(mean);
                out.extend([mean_alpha, log_count]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::abuffer;

    fn pixel(n: usize) -> (Vec<f32>, Vec<f32>, Vec<[f32; 3]>) {
        use rand::RngExt;
        let mut rng = crate::numeric::rng::stream(5, 93, n as u64);
        (
            (0..n).map(|_| rng.random_range(1.0..9.0)).collect(),
            (0..n).map(|_| rng.random_range(0.05..0.7)).collect(),
            (0..n).map(|_| [rng.random(), rng.random(), rng.random()]).collect(),
        )
    }

    /// With the colour that it should answer, a pixel of any number of fragments is the over operator's to 1e-6 (the
    /// answer is f32), and needs no answer up to two. Control: an answer that is off by 0.01 is not.
    #[test]
    fn the_right_answer_gives_the_exact_pixel() {
        let background = [0.3, 0.6, 0.9];
        for n in 0..30 {
            let (view_z, alpha, color) = pixel(n);
            let pixel = Pixel {
                view_z: &view_z,
                alpha: &alpha,
                color: Some(&color),
            };
            let kept = Kept::of(pixel);
            let (exact, black) = (
                abuffer::composite(pixel, background),
                abuffer::composite(pixel, [0.0; 3]),
            );
            assert_eq!(kept.needs_network(), n > 2);
            for set in ColourSet::ALL {
                let mut row = Vec::new();
                set.features(&kept, &mut row);
                assert_eq!(row.len(), set.columns().len());
                assert!(row.iter().all(|x| (0.0..=1.0).contains(x)), "{row:?}");
                let off_by = |error: f64| {
                    let answer = || kept.target(black).map(|t| f64::from(t) + error);
                    let found = kept.composite(answer, background);
                    found.iter().zip(exact).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max)
                };
                assert!(off_by(0.0) < 1e-6, "{set:?} of {n}: {:e}", off_by(0.0));
                assert_eq!(off_by(0.01) < 1e-6, n <= 2, "the control of {set:?}, {n}");
            }
        }
    }

    #[test]
    fn three_fragments_by_hand() {
        let color = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let kept = Kept::of(Pixel {
            view_z: &[4.0, 1.0, 2.0],
            alpha: &[0.5; 3],
            color: Some(&color),
        });
        let near = |a: f64, b: f64| (a - b).abs() < 1e-7;
        assert!(near(kept.front[0], 0.5) && near(kept.front[1], 0.25) && near(kept.front[2], 0.0));
        assert_eq!(
            (kept.tail_color, kept.tail_alpha, kept.tail_count),
            ([0.0, 0.0, 0.5], 0.5, 1)
        );
        assert!(near(kept.share(), 0.125));
        let mut row = Vec::new();
        ColourSet::StarNt.features(&kept, &mut row);
        assert_eq!(row, [0.0, 0.0, 1.0, 0.5, 0.125]);
    }
}
