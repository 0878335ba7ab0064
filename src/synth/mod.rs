//! Random pixels: distributions in, fragment lists out.

use crate::numeric::rng::{Stream, stream};
use crate::pixel::{CameraPlanes, FragmentList, WindowDepth};
use rand_distr::{Distribution, Uniform};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Most fragments that a pixel may be configured to have.
pub const MOST_FRAGMENTS: u32 = 1 << 16;

/// A random pixel's distribution.
///
/// NMT24 Sec. 3.2 gives the ranges ("2 to 32 fragments, fragment depth ranges 0.3 to 1.0, values 0.1 to 0.5") and leaves open what they are
/// ranges *of*; [`DepthReading`] and [`AlphaReading`] are the readings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SynthConfig {
    /// Fragments of a pixel: a whole number, uniform in [min, max].
    pub fragments: CountRange,
    /// Window depths.
    pub depth: DepthConfig,
    /// Opacities.
    pub alpha: AlphaConfig,
    /// Planes that take window depth to the view depth that a fragment list carries.
    pub camera: CameraPlanes,
}

/// A range of whole numbers, ends included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CountRange {
    /// Least.
    pub min: u32,
    /// Greatest.
    pub max: u32,
}

/// How window depths are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthConfig {
    /// Least, in [0, 1].
    pub min: f64,
    /// Greatest, in [0, 1].
    pub max: f64,
    /// What the range is a range of.
    #[serde(default)]
    pub reading: DepthReading,
}

/// What the depth range is a range of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DepthReading {
    /// Each fragment's window depth is uniform in the range.
    #[default]
    PerFragment,
    /// A pixel's extent e = zmax − zmin is uniform in the range, its place uniform within [0, 1 − e]; one fragment lies at each end and the
    /// others are uniform between. A single fragment is uniform in [0, 1].
    PixelExtent,
}

/// How opacities are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlphaConfig {
    /// Least, in [0, 1].
    pub min: f64,
    /// Greatest, in [0, 1].
    pub max: f64,
    /// Whether fragments of a pixel share one value.
    #[serde(default)]
    pub reading: AlphaReading,
}

/// Whether the fragments of a pixel share one opacity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AlphaReading {
    /// Each fragment draws its own.
    #[default]
    PerFragment,
    /// One draw serves the whole pixel.
    PerPixel,
}

/// What is wrong with a distribution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SynthError {
    /// The least count is below 1.
    #[error("synth.fragments.min = {0}: a pixel needs at least 1 fragment")]
    NoFragments(u32),
    /// The greatest count is absurd.
    #[error("synth.fragments.max = {0}: at most {MOST_FRAGMENTS} fragments a pixel are supported")]
    TooManyFragments(u32),
    /// min > max.
    #[error("synth.{field}: min = {min} is greater than max = {max}; swap them")]
    Inverted {
        /// The range.
        field: &'static str,
        /// Its lower end.
        min: f64,
        /// Its upper end.
        max: f64,
    },
    /// An end of a range is outside [0, 1] or NaN.
    #[error("synth.{field}.{end} = {value}: must lie in [0, 1]")]
    OutsideUnit {
        /// The range.
        field: &'static str,
        /// Which end.
        end: &'static str,
        /// Its value.
        value: f64,
    },
    /// The camera's planes are invalid.
    #[error("synth.camera: {0}")]
    Camera(crate::pixel::DepthError),
}

impl SynthConfig {
    /// NMT24's distribution in the default reading.
    pub fn paper() -> Self {
        Self {
            fragments: CountRange { min: 2, max: 32 },
            depth: DepthConfig { min: 0.3, max: 1.0, reading: DepthReading::PerFragment },
            alpha: AlphaConfig { min: 0.1, max: 0.5, reading: AlphaReading::PerFragment },
            camera: CameraPlanes::new(0.1, 100.0).expect("0 < near < far"),
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`SynthError`] names the field.
    pub fn validate(&self) -> Result<(), SynthError> {
        let CountRange { min, max } = self.fragments;
        if min < 1 {
            return Err(SynthError::NoFragments(min));
        }
        if min > max {
            return Err(SynthError::Inverted { field: "fragments", min: min.into(), max: max.into() });
        }
        if max > MOST_FRAGMENTS {
            return Err(SynthError::TooManyFragments(max));
        }
        for (field, min, max) in [("depth", self.depth.min, self.depth.max), ("alpha", self.alpha.min, self.alpha.max)] {
            for (end, value) in [("min", min), ("max", max)] {
                if !(0.0..=1.0).contains(&value) {
                    return Err(SynthError::OutsideUnit { field, end, value });
                }
            }
            if min > max {
                return Err(SynthError::Inverted { field, min, max });
            }
        }
        self.camera.checked().map(drop).map_err(SynthError::Camera)
    }
}

/// What random pixels are for: pixels of different purposes are independent though they share a seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// To fit weights to.
    Training = 0,
    /// To choose the best weights by.
    Validation = 1,
    /// To state an error on: never seen by training.
    Evaluation = 2,
}

/// A validated distribution, ready to draw pixels from.
#[derive(Debug, Clone)]
pub struct Synth {
    config: SynthConfig,
    seed: u64,
    count: Uniform<u32>,
    depth: Uniform<f64>,
    alpha: Uniform<f64>,
}

impl Synth {
    /// A source of pixels.
    ///
    /// # Errors
    /// As [`SynthConfig::validate`].
    pub fn new(config: SynthConfig, seed: u64) -> Result<Self, SynthError> {
        config.validate()?;
        let range = |min: f64, max: f64| Uniform::new_inclusive(min, max).expect("validated: min <= max, both finite");
        Ok(Self {
            seed,
            count: Uniform::new_inclusive(config.fragments.min, config.fragments.max).expect("validated: min <= max"),
            depth: range(config.depth.min, config.depth.max),
            alpha: range(config.alpha.min, config.alpha.max),
            config,
        })
    }

    /// The distribution.
    pub fn config(&self) -> &SynthConfig {
        &self.config
    }

    /// Pixels `first..first + count` of a purpose, as a fragment list with the configured camera planes.
    ///
    /// Pixel i depends on (seed, purpose, i) alone: any range gives the same pixels as any other range that holds them, on any number of threads.
    pub fn pixels(&self, purpose: Purpose, first: u64, count: usize) -> FragmentList {
        let pixels: Vec<_> = (0..count).into_par_iter().with_min_len(64).map(|i| self.pixel(purpose, first + i as u64)).collect();
        let fragments = pixels.iter().map(|(view_z, _)| view_z.len()).sum();
        let mut offsets = Vec::with_capacity(count + 1);
        let mut view_z = Vec::with_capacity(fragments);
        let mut alpha = Vec::with_capacity(fragments);
        offsets.push(0);
        for (v, a) in pixels {
            view_z.extend(v);
            alpha.extend(a);
            offsets.push(view_z.len() as u64);
        }
        FragmentList::new(offsets, view_z, alpha, None).expect("a validated distribution gives valid fragments").with_planes(self.config.camera)
    }

    /// View depths and opacities of one pixel.
    fn pixel(&self, purpose: Purpose, index: u64) -> (Vec<f32>, Vec<f32>) {
        let mut rng = stream(self.seed, purpose as u64, index);
        let n = self.count.sample(&mut rng) as usize;
        let window = self.window_depths(&mut rng, n);
        let (near, far) = (self.config.camera.near(), self.config.camera.far());
        let view_z = window.into_iter().map(|w| (self.config.camera.view_z(w).0 as f32).clamp(near, far)).collect();
        let mut draw = || (self.alpha.sample(&mut rng) as f32).clamp(0.0, 1.0);
        let alpha = match self.config.alpha.reading {
            AlphaReading::PerFragment => (0..n).map(|_| draw()).collect(),
            AlphaReading::PerPixel => vec![draw(); n],
        };
        (view_z, alpha)
    }

    fn window_depths(&self, rng: &mut Stream, n: usize) -> Vec<WindowDepth> {
        let unit = Uniform::new_inclusive(0.0, 1.0).expect("0 <= 1");
        match self.config.depth.reading {
            DepthReading::PerFragment => (0..n).map(|_| WindowDepth(self.depth.sample(rng))).collect(),
            DepthReading::PixelExtent if n == 1 => vec![WindowDepth(unit.sample(rng))],
            DepthReading::PixelExtent => {
                let extent = self.depth.sample(rng);
                let start = unit.sample(rng) * (1.0 - extent);
                let place = |u: f64| WindowDepth((start + u * extent).clamp(0.0, 1.0));
                [0.0, 1.0].into_iter().chain((2..n).map(|_| unit.sample(rng))).map(place).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn synth(change: impl FnOnce(&mut SynthConfig)) -> Synth {
        let mut config = SynthConfig::paper();
        change(&mut config);
        Synth::new(config, 7).unwrap()
    }

    fn windows(list: &FragmentList, p: usize) -> Vec<f64> {
        let planes = list.planes().unwrap();
        list.pixel(p).view_z.iter().map(|&v| planes.window(crate::pixel::ViewZ(v.into())).unwrap().0).collect()
    }

    #[test]
    fn any_pixel_can_be_made_alone_and_threads_change_nothing() {
        let synth = synth(|_| {});
        let all = synth.pixels(Purpose::Training, 0, 1000);
        for p in [0, 1, 499, 999] {
            let alone = synth.pixels(Purpose::Training, p as u64, 1);
            assert_eq!(alone.view_z(), all.pixel(p).view_z);
            assert_eq!(alone.alpha(), all.pixel(p).alpha);
        }
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| synth.pixels(Purpose::Training, 0, 1000)), all);
        }
        assert_ne!(synth.pixels(Purpose::Validation, 0, 10), synth.pixels(Purpose::Training, 0, 10));
        assert_ne!(synth.pixels(Purpose::Evaluation, 0, 10), synth.pixels(Purpose::Training, 0, 10));
    }

    /// The first pixels of seed 7 as they are on every machine: a change here breaks every published seed.
    #[test]
    fn bytes_of_a_seed_are_pinned() {
        let list = synth(|_| {}).pixels(Purpose::Training, 0, 256);
        let bytes: Vec<u8> = list.view_z().iter().chain(list.alpha()).flat_map(|v| v.to_le_bytes()).collect();
        insta::assert_snapshot!(crate::numeric::digest::sha256_hex([bytes.as_slice()]));
    }

    /// Means and ranges of the default reading. Tolerances are 5 standard errors over 20 000 pixels.
    #[test]
    fn default_reading_has_the_moments_of_its_uniform_laws() {
        let list = synth(|_| {}).pixels(Purpose::Training, 0, 20_000);
        let counts: Vec<f64> = list.offsets().windows(2).map(|w| (w[1] - w[0]) as f64).collect();
        assert!(counts.iter().all(|&n| (2.0..=32.0).contains(&n)));
        assert!(counts.contains(&2.0) && counts.contains(&32.0));
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        // Standard deviation of the uniform law on 2..=32 is sqrt((31² − 1)/12) = 8.94.
        assert!((mean(&counts) - 17.0).abs() < 5.0 * 8.94 / 20_000f64.sqrt());
        let w: Vec<f64> = (0..list.pixels()).flat_map(|p| windows(&list, p)).collect();
        assert!(w.iter().all(|w| (0.3 - 1e-7..=1.0).contains(w)));
        assert!((mean(&w) - 0.65).abs() < 5.0 * 0.7 / 12f64.sqrt() / (w.len() as f64).sqrt());
        let a: Vec<f64> = list.alpha().iter().map(|&a| a.into()).collect();
        assert!(a.iter().all(|a| (0.1 - 1e-8..=0.5 + 1e-8).contains(a)));
        assert!((mean(&a) - 0.3).abs() < 5.0 * 0.4 / 12f64.sqrt() / (a.len() as f64).sqrt());
    }

    #[test]
    fn the_other_readings() {
        let extent = synth(|c| c.depth.reading = DepthReading::PixelExtent).pixels(Purpose::Training, 0, 500);
        for p in 0..extent.pixels() {
            let w = windows(&extent, p);
            let (lo, hi) = w.iter().fold((1.0f64, 0.0f64), |(lo, hi), &w| (lo.min(w), hi.max(w)));
            assert!((0.3 - 1e-6..=1.0).contains(&(hi - lo)), "extent {}", hi - lo);
        }
        let shared = synth(|c| c.alpha.reading = AlphaReading::PerPixel).pixels(Purpose::Training, 0, 500);
        assert!((0..shared.pixels()).all(|p| shared.pixel(p).alpha.iter().all(|&a| a == shared.pixel(p).alpha[0])));
        let single = synth(|c| {
            c.fragments = CountRange { min: 1, max: 1 };
            c.depth.reading = DepthReading::PixelExtent;
        });
        assert_eq!(single.pixels(Purpose::Training, 0, 100).depth_complexity(), 1);
    }

    #[test]
    fn degenerate_ranges_are_valid() {
        let constant = synth(|c| {
            c.depth = DepthConfig { min: 0.5, max: 0.5, ..c.depth };
            c.alpha = AlphaConfig { min: 1.0, max: 1.0, ..c.alpha };
        });
        let list = constant.pixels(Purpose::Training, 0, 10);
        assert!(list.alpha().iter().all(|&a| a == 1.0) && list.view_z().iter().all(|&v| v == list.view_z()[0]));
    }

    #[test]
    fn errors_name_the_field() {
        let error = |change: &dyn Fn(&mut SynthConfig)| {
            let mut config = SynthConfig::paper();
            change(&mut config);
            config.validate().unwrap_err().to_string()
        };
        insta::assert_snapshot!(
            [
                error(&|c| c.fragments.min = 0),
                error(&|c| c.fragments.min = 40),
                error(&|c| c.fragments.max = u32::MAX),
                error(&|c| (c.depth.min, c.depth.max) = (0.9, 0.2)),
                error(&|c| c.depth.max = 1.5),
                error(&|c| c.alpha.min = f64::NAN),
                error(&|c| c.alpha.max = -0.1),
            ]
            .join("\n")
        );
    }
}
