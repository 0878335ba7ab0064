//! Pixels that methods break on, each kind with its exact answer.

use crate::numeric::rng::{Stream, stream};
use crate::oit::Context;
use crate::pixel::{
    CameraPlanes, FragmentError, FragmentList, LogWarp, MomentDepth, Pixel, ViewZ, absorbance, abuffer,
};
use rand::RngExt;

/// Keeps these random numbers apart from those of training and of checks.
const PURPOSE: u64 = 0x5352;
const SEED: u64 = 0x6e6d74;

/// View depths that moment depth −1 and 1 stand for, and the planes of the camera, in all cases but those that say
/// otherwise [scene units].
pub const SCENE: (f32, f32) = (0.1, 100.0);

/// Fragments as a renderer feeds them: nothing is validated.
#[derive(Debug, Clone)]
pub struct Fragments {
    /// Pixel p holds fragments `offsets[p]..offsets[p + 1]`.
    pub offsets: Vec<u64>,
    /// View depths.
    pub view_z: Vec<f32>,
    /// Opacities.
    pub alpha: Vec<f32>,
    /// Planes and the range of depths.
    pub context: Context,
}

impl Fragments {
    /// None, in a scene between these view depths.
    pub fn none(scene: (f32, f32)) -> Self {
        let planes = CameraPlanes::new(scene.0, scene.1).ok();
        Self {
            offsets: vec![0],
            view_z: vec![],
            alpha: vec![],
            context: Context {
                planes,
                depth_range: Some(scene),
            },
        }
    }

    /// Those of a list, in a context.
    pub fn of_list(list: &FragmentList, context: Context) -> Self {
        Self {
            offsets: list.offsets().to_vec(),
            view_z: list.view_z().to_vec(),
            alpha: list.alpha().to_vec(),
            context,
        }
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of fragments.
    pub fn len(&self) -> usize {
        self.view_z.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.view_z.is_empty()
    }

    /// Where pixel p's fragments stand.
    pub fn range(&self, p: usize) -> std::ops::Range<usize> {
        self.offsets[p] as usize..self.offsets[p + 1] as usize
    }

    /// The fragments of pixel p.
    pub fn pixel(&self, p: usize) -> Pixel<'_> {
        let range = self.range(p);
        Pixel {
            view_z: &self.view_z[range.clone()],
            alpha: &self.alpha[range],
            color: None,
        }
    }

    /// As a list, which is valid.
    ///
    /// # Errors
    /// [`FragmentError`] names the first number that is out of its domain.
    pub fn list(&self) -> Result<FragmentList, FragmentError> {
        let list = FragmentList::new(self.offsets.clone(), self.view_z.clone(), self.alpha.clone(), None)?;
        Ok(match self.context.planes {
            Some(planes) => list.with_planes(planes),
            None => list,
        })
    }

    /// Appends a pixel.
    pub fn push(&mut self, fragments: impl IntoIterator<Item = (f32, f32)>) {
        for (v, a) in fragments {
            self.view_z.push(v);
            self.alpha.push(a);
        }
        self.offsets.push(self.view_z.len() as u64);
    }

    /// The same pixels, the fragments of each in another order, and for every new place the old one.
    pub fn shuffled(&self, rng: &mut Stream) -> (Self, Vec<usize>) {
        let mut order: Vec<usize> = (0..self.len()).collect();
        for p in 0..self.pixels() {
            let part = &mut order[self.range(p)];
            for i in (1..part.len()).rev() {
                part.swap(i, rng.random_range(0..=i));
            }
        }
        let take = |values: &[f32]| order.iter().map(|&i| values[i]).collect();
        (
            Self {
                view_z: take(&self.view_z),
                alpha: take(&self.alpha),
                ..self.clone()
            },
            order,
        )
    }
}

/// A kind of pixel and the exact answer for every fragment.
#[derive(Debug, Clone)]
pub struct Case {
    /// Its name.
    pub name: &'static str,
    /// What it is, in words.
    pub what: &'static str,
    /// The fragments.
    pub fragments: Fragments,
    /// Transmittance in front of every fragment; NaN where a fragment's pixel holds a number that is none.
    pub exact: Vec<f64>,
}

/// Random numbers of one case.
struct Source {
    rng: Stream,
    warp: LogWarp,
    scene: (f32, f32),
}

impl Source {
    fn new(case: u64) -> Self {
        let warp = LogWarp::new(ViewZ(SCENE.0.into()), ViewZ(SCENE.1.into())).expect("0 < v0 < v1");
        Self {
            rng: stream(SEED, PURPOSE, case),
            warp,
            scene: SCENE,
        }
    }

    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        self.rng.random_range(low..=high)
    }

    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.uniform(libm::log(low), libm::log(high))).clamp(low, high)
    }

    /// A whole number whose logarithm is uniform.
    fn count(&mut self, low: usize, high: usize) -> usize {
        (self.log_uniform(low as f64, high as f64 + 1.0) as usize).clamp(low, high)
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.rng.random_range(0..of.len())]
    }

    /// The single-precision view depth nearest to a moment depth.
    fn view(&self, z: f64) -> f32 {
        (self.warp.view_z(MomentDepth(z)).0 as f32).clamp(self.scene.0, self.scene.1)
    }

    /// n moment depths within half of a centre, the ends among them.
    fn depths(&mut self, n: usize, centre: f64, half: f64) -> Vec<f64> {
        (0..n)
            .map(|i| {
                let x = if i < 2 {
                    2.0 * i as f64 - 1.0
                } else {
                    self.uniform(-1.0, 1.0)
                };
                (centre + half * x).clamp(-1.0, 1.0)
            })
            .collect()
    }

    /// n fragments between −1 and 1 about a centre, their opacities from a law.
    fn pixel(&mut self, n: usize, centre: f64, half: f64, mut alpha: impl FnMut(&mut Self) -> f64) -> Vec<(f32, f32)> {
        let mut fragments: Vec<(f32, f32)> = self
            .depths(n, centre, half)
            .into_iter()
            .map(|z| (self.view(z), alpha(self) as f32))
            .collect();
        // The ends come anywhere.
        for i in (1..n).rev() {
            let j = self.rng.random_range(0..=i);
            fragments.swap(i, j);
        }
        fragments
    }

    /// Opacities as scenes have them: uniform or log-uniform, whichever the coin says.
    fn alpha(&mut self) -> f64 {
        if self.rng.random::<bool>() {
            self.uniform(0.02, 0.95)
        } else {
            self.log_uniform(1e-3, 0.5)
        }
    }
}

/// Opacities at the ends of their range: none, hardly any, all but 1e-7, all.
const EXTREME_ALPHAS: [f32; 4] = [0.0, 1e-8, 1.0 - 1e-7, 1.0];

impl Case {
    /// With the answer of the A-buffer.
    fn sorted(name: &'static str, what: &'static str, fragments: Fragments) -> Self {
        let mut exact = vec![0.0; fragments.len()];
        for p in 0..fragments.pixels() {
            abuffer::transmittance(fragments.pixel(p), &mut exact[fragments.range(p)]);
        }
        Self {
            name,
            what,
            fragments,
            exact,
        }
    }

    /// With an answer in closed form, a number for every fragment.
    fn closed(
        name: &'static str,
        what: &'static str,
        fragments: Fragments,
        of: impl Fn(Pixel<'_>) -> Vec<f64>,
    ) -> Self {
        let exact = (0..fragments.pixels())
            .flat_map(|p| of(fragments.pixel(p)))
            .collect::<Vec<_>>();
        assert_eq!(exact.len(), fragments.len(), "{name}: one answer a fragment");
        Self {
            name,
            what,
            fragments,
            exact,
        }
    }

    /// Every case. The same fragments on every machine.
    pub fn all() -> Vec<Self> {
        let cases: [fn(Source) -> Self; 21] = [
            single,
            pair,
            coincident,
            coincident_between,
            thin,
            far_from_origin,
            extreme_alpha,
            extreme_absorbance,
            many_faint,
            opaque_in_front,
            opaque_behind,
            opaque_amid,
            flat_scene,
            permutations,
            beyond_training,
            subnormal,
            not_numbers,
            log_depth,
            linear_depth,
            window_depth,
            usual,
        ];
        // The three depths show the same pixels.
        let number = |i: usize| if (17..20).contains(&i) { 17 } else { i as u64 };
        cases
            .into_iter()
            .enumerate()
            .map(|(i, make)| make(Source::new(number(i))))
            .collect()
    }
}

fn ones(pixel: Pixel<'_>) -> Vec<f64> {
    vec![1.0; pixel.len()]
}

fn single(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    let pixels = 8192;
    for i in 0..pixels {
        let alpha = match i % 4 {
            0 => s.pick(&EXTREME_ALPHAS),
            1 => s.log_uniform(1e-6, 1.0) as f32,
            _ => s.uniform(0.0, 1.0) as f32,
        };
        f.push([(s.view(2.0 * f64::from(i) / f64::from(pixels - 1) - 1.0), alpha)]);
    }
    Case::closed("single", "one fragment alone, at every depth", f, ones)
}

fn pair(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for _ in 0..8192 {
        let half = 0.5 * s.log_uniform(1e-7, 0.4);
        let centre = s.uniform(half - 1.0, 1.0 - half);
        let p = s.pixel(2, centre, half, Source::alpha);
        f.push(p);
    }
    // The farther one sees what the nearer one leaves.
    Case::closed("pair", "two fragments, 1e-7 to 0.4 of moment depth apart", f, |p| {
        let nearest = p.view_z[0].min(p.view_z[1]);
        (0..2)
            .map(|i| {
                if p.view_z[i] > nearest {
                    libm::exp(-absorbance(p.alpha[1 - i]))
                } else {
                    1.0
                }
            })
            .collect()
    })
}

fn coincident(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for n in [2, 3, 4, 5, 8, 16, 31, 64, 128, 256, 512, 1024] {
        for _ in 0..6 {
            let z = s.uniform(-1.0, 1.0);
            let v = s.view(z);
            let p: Vec<_> = (0..n).map(|_| (v, s.alpha() as f32)).collect();
            f.push(p);
        }
    }
    Case::closed("coincident", "2 to 1024 fragments at one depth", f, ones)
}

fn coincident_between(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for n in [2, 3, 5, 16, 64, 256, 1024] {
        for _ in 0..8 {
            let half = s.log_uniform(1e-3, 0.5);
            let centre = s.uniform(half - 1.0, 1.0 - half);
            let x = s.uniform(-0.9, 0.9);
            let v = s.view(centre + half * x);
            let tied = s.log_uniform(1e-3, 0.5) as f32;
            let ends = [centre - half, centre + half].map(|z| (s.view(z), s.alpha() as f32));
            f.push((0..n).map(|_| (v, tied)).chain(ends));
        }
    }
    Case::closed(
        "coincident-between",
        "2 to 1024 fragments at one depth, one in front of them and one behind",
        f,
        |p| {
            let n = p.len() - 2;
            let (tied, near) = (absorbance(p.alpha[0]), absorbance(p.alpha[n]));
            (0..n)
                .map(|_| libm::exp(-near))
                .chain([1.0, libm::exp(-near - n as f64 * tied)])
                .collect()
        },
    )
}

fn thin(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for _ in 0..1500 {
        let (n, centre) = (s.count(3, 64), s.uniform(-0.999, 0.999));
        let p = s.pixel(n, centre, 1e-6, Source::alpha);
        f.push(p);
    }
    Case::sorted("thin", "all fragments within 1e-6 of the scene's moment depth", f)
}

fn far_from_origin(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for _ in 0..2500 {
        let (n, sign) = (s.count(3, 64), s.pick(&[-1.0, 1.0]));
        let ratio = s.log_uniform(1e-8, 1.0);
        let centre = sign * s.uniform(0.3, 0.95) / (1.0 + ratio);
        let p = s.pixel(n, centre, ratio * f64::abs(centre), Source::alpha);
        f.push(p);
    }
    Case::sorted(
        "far-from-origin",
        "half-range 1 to 1e-8 of the distance from the origin of moment depth",
        f,
    )
}

fn extreme_alpha(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for _ in 0..1500 {
        let (n, half) = (s.count(2, 64), s.log_uniform(1e-3, 1.0));
        let (centre, share) = (s.uniform(half - 1.0, 1.0 - half), s.pick(&[0.2, 0.8, 1.0]));
        let p = s.pixel(n, centre, half, |s| {
            if s.uniform(0.0, 1.0) <= share {
                s.pick(&EXTREME_ALPHAS).into()
            } else {
                s.alpha()
            }
        });
        f.push(p);
    }
    Case::sorted(
        "extreme-alpha",
        "alpha 0, 1e-8, 1 - 1e-7 and 1, alone and among others",
        f,
    )
}

fn extreme_absorbance(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for _ in 0..1500 {
        let (n, half) = (s.count(2, 64), s.log_uniform(1e-3, 1.0));
        let (centre, total) = (s.uniform(half - 1.0, 1.0 - half), s.log_uniform(1e-12, 10.0 * n as f64));
        let p = s.pixel(n, centre, half, |s| {
            -libm::expm1(-total / n as f64 * s.uniform(0.1, 1.9))
        });
        f.push(p);
    }
    Case::sorted(
        "extreme-absorbance",
        "total absorbance from 1e-12 to the clamp of every fragment",
        f,
    )
}

fn many_faint(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for i in 0..6 {
        let half = [1.0, 0.3, 0.05][i % 3];
        let (centre, alpha) = (s.uniform(half - 1.0, 1.0 - half), s.log_uniform(1e-4, 5e-3));
        let p = s.pixel(4096, centre, half, |s| alpha * s.uniform(0.5, 1.5));
        f.push(p);
    }
    Case::sorted("many-faint", "4096 faint fragments", f)
}

/// One opaque fragment among faint ones: −1 in front of them, 0 amid them, 1 behind them.
fn opaque(s: &mut Source, place: i32) -> Fragments {
    let mut f = Fragments::none(SCENE);
    for _ in 0..600 {
        let (n, half) = (s.count(3, 400), s.log_uniform(0.01, 0.5));
        let centre = s.uniform(half - 1.0, 1.0 - half);
        let alpha = s.log_uniform(1e-3, 0.1);
        let mut p = s.pixel(n, centre, half, |s| alpha * s.uniform(0.5, 1.5));
        let x = match place {
            0 => s.uniform(-0.9, 0.9),
            end => f64::from(end),
        };
        // Strictly outside the others, or anywhere among them.
        let reach = if place == 0 { half } else { 1.1 * half + 1e-5 };
        p.insert(n / 2, (s.view((centre + reach * x).clamp(-1.0, 1.0)), 1.0));
        f.push(p);
    }
    f
}

fn opaque_in_front(mut s: Source) -> Case {
    Case::sorted(
        "opaque-in-front",
        "one opaque fragment in front of many faint ones",
        opaque(&mut s, -1),
    )
}

fn opaque_behind(mut s: Source) -> Case {
    Case::sorted(
        "opaque-behind",
        "one opaque fragment behind many faint ones",
        opaque(&mut s, 1),
    )
}

fn opaque_amid(mut s: Source) -> Case {
    Case::sorted(
        "opaque-amid",
        "one opaque fragment amid many faint ones",
        opaque(&mut s, 0),
    )
}

fn flat_scene(mut s: Source) -> Case {
    let v = 3.0;
    let mut f = Fragments::none((v, v));
    f.context.planes = CameraPlanes::new(0.1, 100.0).ok();
    for n in [1, 2, 3, 4, 7, 30, 300] {
        for _ in 0..8 {
            let p: Vec<_> = (0..n).map(|_| (v, s.alpha() as f32)).collect();
            f.push(p);
        }
    }
    Case::closed("flat-scene", "the whole scene at one depth: v0 = v1", f, ones)
}

fn permutations(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for _ in 0..30 {
        let (n, half) = (s.count(3, 200), s.log_uniform(1e-3, 1.0));
        let centre = s.uniform(half - 1.0, 1.0 - half);
        let mut p = s.pixel(n, centre, half, Source::alpha);
        for _ in 0..16 {
            f.push(p.clone());
            for i in (1..n).rev() {
                let j = s.rng.random_range(0..=i);
                p.swap(i, j);
            }
        }
    }
    Case::sorted("permutations", "the same fragments in 16 orders", f)
}

fn beyond_training(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    for _ in 0..24 {
        let (n, half) = (s.count(257, 4096), s.log_uniform(1e-6, 1.0));
        let (centre, low) = (s.uniform(half - 1.0, 1.0 - half), s.log_uniform(1e-6, 1.0));
        let p = s.pixel(n, centre, half, |s| s.uniform(0.0, low));
        f.push(p);
    }
    Case::sorted(
        "beyond-training",
        "257 to 4096 fragments of any opacity, half-range 1 to 1e-6: more than networks were trained on",
        f,
    )
}

fn subnormal(mut s: Source) -> Case {
    // Planes that far away are none that window depth could be computed with: the camera's are left out.
    let scene = (1e-37, 1e-30);
    s.warp = LogWarp::new(ViewZ(f64::from(scene.0)), ViewZ(f64::from(scene.1))).expect("0 < v0 < v1");
    s.scene = scene;
    let mut f = Fragments::none(scene);
    for i in 0..1000 {
        let (n, half) = (s.count(1, 32), s.log_uniform(1e-3, 1.0));
        let centre = s.uniform(half - 1.0, 1.0 - half);
        let p = s.pixel(n, centre, half, |s| match i % 3 {
            0 => s.log_uniform(1e-45, 1e-37),
            1 if s.rng.random::<bool>() => s.log_uniform(1e-45, 1e-37),
            _ => s.alpha(),
        });
        f.push(p);
    }
    Case::sorted(
        "subnormal",
        "opacities and differences of depth that single precision only holds as subnormal numbers",
        f,
    )
}

fn not_numbers(mut s: Source) -> Case {
    let mut f = Fragments::none(SCENE);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 7.0, f32::MAX, -0.0];
    let mut clean = Vec::new();
    for i in 0..1200 {
        let n = s.count(1, 32);
        let mut p = s.pixel(n, 0.0, 0.5, Source::alpha);
        let poisoned = i % 2 == 0;
        if poisoned {
            let (at, what) = (s.rng.random_range(0..n), s.pick(&bad));
            if s.rng.random::<bool>() {
                p[at].0 = what
            } else {
                p[at].1 = what
            }
        }
        clean.extend((0..n).map(|_| !poisoned));
        f.push(p);
    }
    let mut case = Case::sorted(
        "not-numbers",
        "NaN, infinity and numbers out of their domain as depth or opacity, in every other pixel",
        f,
    );
    for (exact, clean) in case.exact.iter_mut().zip(clean) {
        if !clean {
            *exact = f64::NAN;
        }
    }
    case
}

/// The kinds of depth that moments may be taken of.
#[derive(Clone, Copy)]
enum Depth {
    Log,
    Linear,
    Window,
}

/// Objects seen by cameras of far/near from 2 to 1e6, with this kind of depth in place of view depth: fragments carry a
/// number that the log warp takes to the moment depth in question, rounded to single precision as a depth buffer would.
fn of_depth(s: &mut Source, kind: Depth) -> (Fragments, Vec<f64>) {
    let mut f = Fragments::none(SCENE);
    let mut exact = Vec::new();
    for _ in 0..2500 {
        let ratio = s.log_uniform(2.0, 1e6);
        let (n, extent) = (s.count(3, 64), s.log_uniform(0.01, 1.0));
        // An object somewhere between near = 1 and far = ratio, its extent a share of its distance.
        let start = s.log_uniform(1.0, ratio);
        let extent = extent.min(ratio / start - 1.0).max(1e-6);
        let view: Vec<f32> = (0..n)
            .map(|_| (start * (1.0 + extent * s.uniform(0.0, 1.0))).clamp(1.0, ratio) as f32)
            .collect();
        let alpha: Vec<f32> = (0..n).map(|_| s.alpha() as f32).collect();
        let mut t = vec![0.0; n];
        abuffer::transmittance(
            Pixel {
                view_z: &view,
                alpha: &alpha,
                color: None,
            },
            &mut t,
        );
        exact.extend(t);
        let z = |v: f32| {
            let v = f64::from(v);
            let z = match kind {
                Depth::Log => 2.0 * libm::log(v) / libm::log(ratio) - 1.0,
                Depth::Linear => 2.0 * (v - 1.0) / (ratio - 1.0) - 1.0,
                Depth::Window => 2.0 * f64::from((ratio * (v - 1.0) / (v * (ratio - 1.0))) as f32) - 1.0,
            };
            z.clamp(-1.0, 1.0)
        };
        f.push(view.iter().map(|&v| s.view(z(v))).zip(alpha));
    }
    (f, exact)
}

fn log_depth(mut s: Source) -> Case {
    let (fragments, exact) = of_depth(&mut s, Depth::Log);
    Case {
        name: "log-depth",
        what: "far/near from 2 to 1e6, moments of logarithmic depth",
        fragments,
        exact,
    }
}

fn linear_depth(mut s: Source) -> Case {
    let (fragments, exact) = of_depth(&mut s, Depth::Linear);
    Case {
        name: "linear-depth",
        what: "far/near from 2 to 1e6, moments of linear depth",
        fragments,
        exact,
    }
}

fn window_depth(mut s: Source) -> Case {
    let (fragments, exact) = of_depth(&mut s, Depth::Window);
    Case {
        name: "window-depth",
        what: "far/near from 2 to 1e6, moments of window depth",
        fragments,
        exact,
    }
}

/// Nothing odd: what the others are to be compared with.
fn usual(_: Source) -> Case {
    use crate::synth::{Purpose, Synth, SynthConfig};
    let list = Synth::new(SynthConfig::wide(), SEED)
        .expect("a valid distribution")
        .pixels(Purpose::Evaluation, 0, 800);
    let planes = list.planes();
    let fragments = Fragments::of_list(
        &list,
        Context {
            planes,
            depth_range: planes.map(|p| (p.near(), p.far())),
        },
    );
    Case::sorted(
        "usual",
        "random pixels as networks were trained on: what the other cases are to be compared with",
        fragments,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_a_name_of_its_own_and_an_answer_for_every_fragment() {
        let cases = Case::all();
        let names: std::collections::HashSet<_> = cases.iter().map(|c| c.name).collect();
        assert_eq!(names.len(), cases.len());
        for case in &cases {
            let f = &case.fragments;
            assert!(
                f.len() > 300 && f.pixels() > 5 && case.exact.len() == f.len(),
                "{}",
                case.name
            );
            assert_eq!(f.list().is_err(), case.name == "not-numbers", "{}", case.name);
            if case.name != "not-numbers" {
                assert!(case.exact.iter().all(|t| (0.0..=1.0).contains(t)), "{}", case.name);
            }
        }
    }

    /// Closed forms against the A-buffer: 1e-12, for sums in another order. Control: the answers one fragment on.
    #[test]
    fn closed_forms_are_the_a_buffers() {
        for name in ["single", "pair", "coincident", "coincident-between", "flat-scene"] {
            let case = Case::all().into_iter().find(|c| c.name == name).unwrap();
            let sorted = Case::sorted("", "", case.fragments.clone());
            let off = |a: &[f64]| {
                a.iter()
                    .zip(&sorted.exact)
                    .any(|(a, b)| (a - b).abs().is_nan() || (a - b).abs() > 1e-12)
            };
            assert!(!off(&case.exact), "{name}");
            let mut wrong = case.exact.clone();
            wrong.rotate_left(1);
            assert!(off(&wrong) || case.exact.iter().all(|&t| t == 1.0), "{name}");
        }
    }

    /// What the names promise.
    #[test]
    fn cases_are_what_they_say() {
        let of = |name: &str| Case::all().into_iter().find(|c| c.name == name).unwrap();
        let half = |case: &Case, p: usize| {
            let warp = LogWarp::new(ViewZ(SCENE.0.into()), ViewZ(SCENE.1.into())).unwrap();
            let z: Vec<f64> = case
                .fragments
                .pixel(p)
                .view_z
                .iter()
                .map(|&v| warp.moment(ViewZ(v.into())).0)
                .collect();
            0.5 * (z.iter().copied().fold(-1.0, f64::max) - z.iter().copied().fold(1.0, f64::min))
        };
        let thin = of("thin");
        assert!((0..thin.fragments.pixels()).all(|p| half(&thin, p) <= 1.1e-6));
        let pair = of("pair");
        let halves: Vec<f64> = (0..pair.fragments.pixels()).map(|p| half(&pair, p)).collect();
        assert!(
            halves.iter().any(|&h| h < 1e-7) && halves.iter().any(|&h| h > 0.15) && halves.iter().all(|&h| h <= 0.21)
        );
        let opaque = of("opaque-in-front");
        for p in 0..opaque.fragments.pixels() {
            let pixel = opaque.fragments.pixel(p);
            let at = pixel.alpha.iter().position(|&a| a == 1.0).unwrap();
            assert!(
                pixel
                    .view_z
                    .iter()
                    .enumerate()
                    .all(|(i, &v)| i == at || v >= pixel.view_z[at])
            );
        }
        // Window depth of far objects ties where log depth does not; the answers are of view depth in both.
        assert_eq!(of("log-depth").exact, of("window-depth").exact);
        let distinct = |case: &Case| {
            (0..case.fragments.pixels())
                .map(|p| {
                    case.fragments
                        .pixel(p)
                        .view_z
                        .iter()
                        .map(|v| v.to_bits())
                        .collect::<std::collections::HashSet<_>>()
                        .len()
                })
                .sum::<usize>()
        };
        assert!(distinct(&of("window-depth")) < distinct(&of("log-depth")) * 99 / 100);
    }

    #[test]
    fn shuffled_pixels_hold_the_same_fragments() {
        let fragments = &Case::all()[5].fragments;
        let (other, order) = fragments.shuffled(&mut stream(1, 702, 0));
        assert_ne!(other.view_z, fragments.view_z);
        for (new, &old) in order.iter().enumerate() {
            assert_eq!(
                (other.view_z[new], other.alpha[new]),
                (fragments.view_z[old], fragments.alpha[old])
            );
        }
        assert!(
            (0..fragments.pixels()).all(|p| order[fragments.range(p)].iter().all(|i| fragments.range(p).contains(i)))
        );
    }
}
