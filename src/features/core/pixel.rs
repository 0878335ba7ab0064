//! Both passes over one pixel on the CPU, in `f32` as a renderer has them.

use super::code::{Codes, CoreFragment, EMPTY, MAX_SLOTS, Slot};
use super::formulas::{
    absorbance_of, bounds, bounds_noise, described, fixed_features, normalised, place_noise, recentred, share_of_one,
    share_of_two, without,
};
use super::{CoreSet, FIXED};
use crate::numeric::lanes;
use crate::numeric::real::{Real, c};
use crate::pixel::{Pixel, absorbance};

/// A pixel after pass 1: N = M + 1 sums.
#[derive(Debug, Clone, Copy)]
pub struct Sums<const N: usize> {
    /// Slots of the core.
    pub slots: [u32; MAX_SLOTS],
    /// Number of fragments that absorb something.
    pub count: u32,
    /// b_0..b_M.
    pub b: [f32; N],
}

impl<const N: usize> Default for Sums<N> {
    fn default() -> Self {
        Self {
            slots: [EMPTY; MAX_SLOTS],
            count: 0,
            b: [0.0; N],
        }
    }
}

impl<const N: usize> Sums<N> {
    /// Pass 1: adds a fragment.
    #[inline(always)]
    pub fn add(&mut self, codes: &Codes, slots: usize, fragment: CoreFragment) {
        if fragment.absorbance_step == 0 {
            return;
        }
        codes.insert(&mut self.slots[..slots], fragment);
        self.count += 1;
        self.add_moments(
            codes.moment_depth(fragment.depth_step),
            codes.absorbance(fragment.absorbance_step),
        );
    }

    /// Adds the moments of a fragment.
    #[inline(always)]
    pub fn add_moments(&mut self, z: f32, absorbance: f32) {
        let mut term = absorbance;
        for b in &mut self.b {
            *b += term;
            term *= z;
        }
    }
}

/// What pass 2 knows of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Answer<const N: usize> {
    /// The optical depth in front of it, without a network.
    Depth(f32),
    /// A tail that must be shared out.
    Query(Query<N>),
}

/// A fragment and the tail that it sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Query<const N: usize, R = f32> {
    /// Absorbance of the core in front.
    pub front: R,
    /// Absorbance of the tail, b_0''.
    pub tail: R,
    /// x, count, ln_b0, lower, upper.
    pub fixed: [R; FIXED],
    /// By how much more the bounds err than the moments that they come from.
    pub gain: R,
    /// 1, then means and spreads.
    pub described: [R; N],
}

/// What pass 2 knows of fragments side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answers<const N: usize, R: Real> {
    /// Whether the optical depth in front is known without a network.
    pub is_known: R::Mask,
    /// The optical depth where it is.
    pub depth: R,
    /// The tail that must be shared out where it is not.
    pub query: Query<N, R>,
}

/// A pixel between the passes: the core in order of depth, and the tail's sums in the pixel's own range.
#[derive(Debug, Clone, Copy)]
pub struct Between<const N: usize> {
    core: [CoreFragment; MAX_SLOTS],
    /// Moment depth and absorbance of each.
    z: [f32; MAX_SLOTS],
    absorbance: [f32; MAX_SLOTS],
    len: usize,
    /// Fragments of the tail.
    count: u32,
    /// Moment depths of the nearest and the farthest.
    ends: [f32; 2],
    total: f32,
    tail: [f32; N],
    center: f32,
    per_h: f32,
    /// One depth step in the pixel's own range.
    step: f32,
}

impl<const N: usize> Between<N> {
    /// Takes the core out of the sums of a pixel.
    pub fn new(codes: &Codes, slots: usize, sums: &Sums<N>) -> Self {
        let mut core = [CoreFragment {
            depth_step: 0,
            absorbance_step: 0,
        }; MAX_SLOTS];
        let mut len = 0;
        let mut tail = sums.b;
        for (place, &code) in sums.slots[..slots].iter().enumerate() {
            if let Some(fragment) = codes.decode(Slot::at(place), code) {
                core[len] = fragment;
                len += 1;
                let z = codes.moment_depth(fragment.depth_step);
                tail = without(tail, codes.absorbance(fragment.absorbance_step), z);
            }
        }
        let (nearest, farthest) = (core[0].depth_step, core[usize::from(len > 1)].depth_step);
        let ends = [nearest, farthest].map(|step| codes.moment_depth(step));
        let step = codes.moment_depth(1) - codes.moment_depth(0);
        let h = (0.5 * (ends[1] - ends[0])).max(0.5 * step);
        let (center, per_h) = (0.5 * (ends[0] + ends[1]), 1.0 / h);
        core[..len].sort_unstable();
        Self {
            z: core.map(|fragment| codes.moment_depth(fragment.depth_step)),
            absorbance: core.map(|fragment| codes.absorbance(fragment.absorbance_step)),
            core,
            len,
            count: sums.count - len as u32,
            ends,
            total: sums.b[0],
            tail: recentred(tail, center, per_h),
            center,
            per_h,
            step: step * per_h,
        }
    }

    /// The core, in order of depth.
    pub fn core(&self) -> &[CoreFragment] {
        &self.core[..self.len]
    }

    /// Pass 2: what is known of a fragment that pass 1 has added.
    #[inline(always)]
    pub fn answer(&self, codes: &Codes, fragment: CoreFragment) -> Answer<N> {
        let z = codes.moment_depth(fragment.depth_step);
        let answers = self.answers(z, codes.absorbance(fragment.absorbance_step));
        if answers.is_known {
            Answer::Depth(answers.depth)
        } else {
            Answer::Query(answers.query)
        }
    }

    /// [`Self::answer`] for fragments side by side: their moment depths and absorbances as their steps have them.
    #[inline(always)]
    pub fn answers<R: Real>(&self, z: R, absorbance: R) -> Answers<N, R> {
        let number = |value: f32| z.like(value.into());
        let (zero, one) = (number(0.0), number(1.0));
        let (mut front, mut in_core) = (zero, zero);
        for (&core_z, &core_absorbance) in self.z[..self.len].iter().zip(&self.absorbance) {
            let (core_z, core_absorbance) = (number(core_z), number(core_absorbance));
            front += R::select(core_z.lt(z), core_absorbance, zero);
            in_core = R::select(core_z.eq(z) & core_absorbance.eq(absorbance), one, in_core);
        }
        if self.count == 0 {
            // All of them are in the core, or absorb nothing.
            return Answers {
                is_known: zero.eq(zero),
                depth: front,
                query: Query {
                    front,
                    tail: zero,
                    fixed: [zero; FIXED],
                    gain: zero,
                    described: [zero; N],
                },
            };
        }
        let removed = R::select(in_core.eq(zero), absorbance, zero);
        let count = number(self.count as f32) - R::select(removed.gt(zero), one, zero);
        let x = ((z - number(self.center)) * number(self.per_h)).clamp(c(-1.0), c(1.0));
        let tail = without(lanes::array(|k| number(self.tail[k])), removed, x);
        let absorbance = absorbance_of(tail);
        let m = normalised(tail);
        let (is_nearest, is_farthest) = (z.le(number(self.ends[0])), z.ge(number(self.ends[1])));
        let (mut is_known, mut share) = (is_nearest | is_farthest, zero);
        if self.count <= 3 {
            let noise = place_noise(number(self.total), absorbance, number(self.center), number(self.per_h));
            let step = number(self.step);
            share = share_of_one(x, m[1], step, noise);
            is_known = is_known | count.lt(c(1.5));
            if N > 3 {
                let two = share_of_two(x, [m[1], m[2], m[3.min(N - 1)]], step, noise);
                share = R::select(count.gt(c(1.5)), two, share);
                is_known = is_known | count.lt(c(2.5));
            }
        }
        share = R::select(is_farthest, one, share);
        let bounds = bounds(x, m);
        share = R::select(is_nearest | count.lt(c(0.5)), zero, share);
        Answers {
            is_known,
            depth: front + absorbance * share,
            query: Query {
                front,
                tail: absorbance,
                fixed: fixed_features(x, count, absorbance, bounds.share),
                gain: bounds.gain,
                described: described(m),
            },
        }
    }

    /// How far rounding of the sums has moved the bounds of a fragment's tail; see
    /// [`formulas::bounds_noise`](super::formulas::bounds_noise).
    #[inline(always)]
    pub fn bounds_noise<R: Real>(&self, query: &Query<N, R>) -> R {
        let number = |value: f32| query.tail.like(value.into());
        let range = [number(self.center), number(self.per_h)];
        bounds_noise::<R, N>(number(self.total), query.tail, range, query.gain)
    }
}

/// Both passes of one pixel.
#[derive(Debug, Clone, Default)]
pub struct Passes {
    /// Its fragments, as their codes have them.
    pub fragments: Vec<CoreFragment>,
}

impl Passes {
    /// Pass 1 over a pixel, in the order of its fragments, and what stands between the passes.
    pub fn first<const N: usize>(&mut self, set: &CoreSet, codes: &Codes, pixel: Pixel<'_>) -> Between<N> {
        assert_eq!(N, set.moments + 1, "one sum more than moments");
        let mut sums = Sums::<N>::default();
        self.fragments.clear();
        for (&view_z, &alpha) in pixel.view_z.iter().zip(pixel.alpha) {
            let fragment = codes.fragment(view_z, absorbance(alpha) as f32);
            sums.add(codes, set.slots(), fragment);
            self.fragments.push(fragment);
        }
        Between::new(codes, set.slots(), &sums)
    }
}

/// Runs a body with N = M + 1 as a constant.
macro_rules! with_sums {
    ($moments:expr, $n:ident => $body:expr) => {
        match $moments {
            1 => {
                const $n: usize = 2;
                $body
            }
            2 => {
                const $n: usize = 3;
                $body
            }
            3 => {
                const $n: usize = 4;
                $body
            }
            4 => {
                const $n: usize = 5;
                $body
            }
            5 => {
                const $n: usize = 6;
                $body
            }
            _ => {
                const $n: usize = 7;
                $body
            }
        }
    };
}
pub(crate) use with_sums;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::core::CoreSet;
    use crate::numeric::rng::{Stream, stream};
    use crate::pixel::abuffer;
    use rand::RngExt;

    fn random(rng: &mut Stream, n: usize, [v0, v1]: [f32; 2]) -> (Vec<f32>, Vec<f32>) {
        let view_z = (0..n).map(|_| rng.random_range(v0..v1)).collect();
        let alpha = (0..n)
            .map(|_| -libm::expm1f(-libm::expf(rng.random_range(-6.9..2.4))))
            .collect();
        (view_z, alpha)
    }

    /// Every answer of a pixel, and the exact transmittance of what its codes stand for.
    fn answers<const N: usize>(set: &CoreSet, view_z: &[f32], alpha: &[f32]) -> Vec<(Answer<N>, f64)> {
        let codes = set.layout.codes(1.0, 8.0);
        let pixel = Pixel {
            view_z,
            alpha,
            color: None,
        };
        let mut passes = Passes::default();
        let between = passes.first::<N>(set, &codes, pixel);
        let absorbed = |f: &CoreFragment| f64::from(codes.absorbance(f.absorbance_step));
        passes
            .fragments
            .iter()
            .map(|f| {
                let in_front = passes.fragments.iter().filter(|g| g.depth_step < f.depth_step);
                (
                    between.answer(&codes, *f),
                    libm::exp(-in_front.map(absorbed).sum::<f64>()),
                )
            })
            .collect()
    }

    fn worst<const N: usize>(heavy: usize, n: usize, rng: &mut Stream) -> f64 {
        let set = CoreSet::new(heavy, N - 1);
        let (view_z, alpha) = random(rng, n, [1.0, 8.0]);
        let error = |(answer, exact): (Answer<N>, f64)| match answer {
            Answer::Depth(depth) => (libm::exp(-f64::from(depth)) - exact).abs(),
            Answer::Query(_) => panic!("{n} fragments need no network beside {heavy} heavy ones"),
        };
        let errors = answers(&set, &view_z, &alpha).into_iter().map(error);
        errors.fold(0.0, |most, e| if e.is_nan() { f64::INFINITY } else { most.max(e) })
    }

    /// As many fragments as the core holds, near-opaque ones among them: exact but for rounding, 2e-6. One and two
    /// fragments of tail, with absorbances from 1e-3 beside up to 10: in the mean square. Control: a pixel's answers
    /// for the fragment beside.
    #[test]
    fn cores_and_short_tails_are_exact() {
        let mut rng = stream(1, 121, 0);
        for round in 0..4000 {
            let heavy = round % 9;
            let n = 1 + round % (heavy + 2);
            let found = worst::<3>(heavy, n, &mut rng);
            assert!(found <= 2e-6, "{n} fragments, {heavy} heavy: {found}");
        }
        let mut squares = [0.0, 0.0];
        for round in 0..8000 {
            let heavy = round % 5;
            let one = worst::<5>(heavy, heavy + 3, &mut rng);
            squares[0] += one * one / 8000.0;
            let two = worst::<5>(heavy, heavy + 4, &mut rng);
            squares[1] += two * two / 8000.0;
        }
        println!(
            "mean square of a pixel's worst error: one {:.1e}, two {:.1e}",
            squares[0], squares[1]
        );
        assert!(squares[0] <= 1e-7 && squares[1] <= 1e-4, "{squares:?}");
        let set = CoreSet::new(2, 2);
        let (view_z, alpha) = random(&mut rng, 5, [1.0, 8.0]);
        let all = answers::<3>(&set, &view_z, &alpha);
        let shifted = all
            .iter()
            .zip(all.iter().cycle().skip(1))
            .filter(|((answer, _), (_, exact))| match answer {
                Answer::Depth(depth) => (libm::exp(-f64::from(*depth)) - exact).abs() > 1e-3,
                Answer::Query(_) => false,
            });
        assert!(shifted.count() > 0);
    }

    /// What the codes stand for is what was given, to a step: T of few fragments within 1e-3 of the exact one.
    /// Fragments of
    /// alpha 0 see what is in front of them, wherever they are.
    #[test]
    fn codes_hardly_change_transmittances() {
        let mut rng = stream(2, 121, 0);
        let set = CoreSet::new(4, 2);
        for _ in 0..2000 {
            let (view_z, mut alpha) = random(&mut rng, 6, [1.0, 8.0]);
            alpha[rng.random_range(0..6usize)] = [0.0, 1.0][rng.random_range(0..2usize)];
            let mut exact = vec![0.0; 6];
            let pixel = Pixel {
                view_z: &view_z,
                alpha: &alpha,
                color: None,
            };
            abuffer::transmittance(pixel, &mut exact);
            for ((answer, _), t) in answers::<3>(&set, &view_z, &alpha).into_iter().zip(exact) {
                let Answer::Depth(depth) = answer else {
                    panic!("six fragments")
                };
                assert!((libm::exp(-f64::from(depth)) - t).abs() <= 1e-3, "{view_z:?} {alpha:?}");
            }
        }
    }

    /// Pixels of every kind: finite features in their ranges, and transmittances in [0, 1]; ties, doubles, opaque and
    /// empty
    /// fragments, pixels thinner than a depth step, depths outside of the range.
    #[test]
    fn every_pixel_stays_in_range() {
        fn check<const N: usize>(rng: &mut Stream) {
            let set = CoreSet::new(rng.random_range(0..=8), N - 1);
            let n = rng.random_range(0..60usize);
            let thin = [1e-7f32, 1e-4, 1e-2, 8.0][rng.random_range(0..4usize)];
            let (mut view_z, mut alpha) = random(rng, n, [2.0, 2.0 + 2.0 * thin]);
            for i in 0..n {
                match rng.random_range(0..12) {
                    0 => alpha[i] = 0.0,
                    1 => alpha[i] = 1.0,
                    2 => alpha[i] = 1e-6,
                    3 => view_z[i] = view_z[0],
                    4 => (view_z[i], alpha[i]) = (view_z[0], alpha[0]),
                    5 => view_z[i] = 0.01,
                    6 => view_z[i] = 1e6,
                    _ => {}
                }
            }
            for (answer, _) in answers::<N>(&set, &view_z, &alpha) {
                match answer {
                    Answer::Depth(depth) => assert!(depth >= 0.0 && depth.is_finite(), "{depth}"),
                    Answer::Query(Query {
                        front,
                        tail,
                        fixed: [x, count, ln_b0, lower, upper],
                        described,
                        ..
                    }) => {
                        assert!(front >= 0.0 && tail >= 0.0 && front.is_finite() && tail.is_finite());
                        assert!((-1.0..=1.0).contains(&x) && (-1.0..2.0).contains(&count), "{x} {count}");
                        assert!(ln_b0.is_finite() && 0.0 <= lower && lower <= upper && upper <= 1.000_001);
                        assert!(described.iter().all(|m| (-1.0..=1.0).contains(m)), "{described:?}");
                    }
                }
            }
        }
        let mut rng = stream(3, 121, 0);
        for _ in 0..3000 {
            check::<2>(&mut rng);
            check::<3>(&mut rng);
            check::<5>(&mut rng);
            check::<7>(&mut rng);
        }
    }
}
