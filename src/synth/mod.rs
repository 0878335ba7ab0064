//! Random pixels: distributions in, fragment lists out.

pub mod config;
pub mod law;

use crate::numeric::rng::{Stream, stream};
use crate::pixel::{FragmentList, Pixel};
pub use config::{SynthConfig, SynthError};
use law::{Camera, Prepared, Scratch};
use rayon::prelude::*;

/// Pixels that one task draws: enough to pay for the task, few enough that their fragments stay in the cache.
const TASK: usize = 256;

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
    camera: Camera,
    laws: Vec<Prepared>,
    /// Shares of the laws, added up: the last is 1.
    shares: Vec<f64>,
}

/// Memory that pixels are drawn in, one after the other.
#[derive(Default)]
pub struct Sketch {
    scratch: Scratch,
    view_z: Vec<f32>,
    alpha: Vec<f32>,
}

/// Fragments of some pixels.
#[derive(Default)]
struct Part {
    counts: Vec<u32>,
    view_z: Vec<f32>,
    alpha: Vec<f32>,
}

impl Synth {
    /// A source of pixels.
    ///
    /// # Errors
    /// As [`SynthConfig::validate`].
    pub fn new(config: SynthConfig, seed: u64) -> Result<Self, SynthError> {
        config.validate()?;
        let total: f64 = config.pixels.iter().map(|law| law.weight).sum();
        let mut sum = 0.0;
        let mut share = |weight: f64| {
            sum += weight;
            sum / total
        };
        Ok(Self {
            seed,
            camera: Camera::new(config.camera),
            laws: config.pixels.iter().map(Prepared::new).collect(),
            shares: config.pixels.iter().map(|law| share(law.weight)).collect(),
            config,
        })
    }

    /// The distribution.
    pub fn config(&self) -> &SynthConfig {
        &self.config
    }

    /// Pixels `first..first + count` of a purpose, as a fragment list with the configured camera planes.
    ///
    /// Pixel i depends on (seed, purpose, i) alone: any range gives the same pixels as any other range that holds them,
    /// on any number of threads.
    pub fn pixels(&self, purpose: Purpose, first: u64, count: usize) -> FragmentList {
        let parts: Vec<Part> = (0..count.div_ceil(TASK))
            .into_par_iter()
            .map_init(Scratch::default, |scratch, task| {
                let start = task * TASK;
                self.part(purpose, first + start as u64, TASK.min(count - start), scratch)
            })
            .collect();
        let fragments = parts.iter().map(|part| part.view_z.len()).sum();
        let mut offsets = Vec::with_capacity(count + 1);
        let mut view_z = Vec::with_capacity(fragments);
        let mut alpha = Vec::with_capacity(fragments);
        let mut end = 0;
        offsets.push(end);
        for part in parts {
            offsets.extend(part.counts.iter().map(|&n| {
                end += u64::from(n);
                end
            }));
            view_z.extend_from_slice(&part.view_z);
            alpha.extend_from_slice(&part.alpha);
        }
        FragmentList::new(offsets, view_z, alpha, None)
            .expect("a validated distribution gives valid fragments")
            .with_planes(self.config.camera)
    }

    /// One of the pixels that [`Self::pixels`] makes lists of.
    pub fn pixel<'a>(&self, purpose: Purpose, index: u64, sketch: &'a mut Sketch) -> Pixel<'a> {
        let Sketch { scratch, view_z, alpha } = sketch;
        view_z.clear();
        alpha.clear();
        self.draw(purpose, index, scratch, view_z, alpha);
        Pixel {
            view_z,
            alpha,
            color: None,
        }
    }

    /// Appends one pixel.
    fn draw(&self, purpose: Purpose, index: u64, scratch: &mut Scratch, view_z: &mut Vec<f32>, alpha: &mut Vec<f32>) {
        let mut rng = stream(self.seed, purpose as u64, index);
        self.law(&mut rng).draw(&mut rng, &self.camera, scratch, view_z, alpha);
    }

    fn part(&self, purpose: Purpose, first: u64, count: usize, scratch: &mut Scratch) -> Part {
        let mut part = Part {
            counts: Vec::with_capacity(count),
            ..Part::default()
        };
        for index in first..first + count as u64 {
            let before = part.view_z.len();
            self.draw(purpose, index, scratch, &mut part.view_z, &mut part.alpha);
            part.counts.push((part.view_z.len() - before) as u32);
        }
        part
    }

    /// The law of a pixel. Where there is only one, no number is drawn for it.
    fn law(&self, rng: &mut Stream) -> &Prepared {
        match self.laws.as_slice() {
            [only] => only,
            laws => {
                let u = rng.unit();
                &laws[self
                    .shares
                    .iter()
                    .position(|&share| u < share)
                    .expect("u < 1, the last share")]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::law::alpha::{AlphaReading, Uniform};
    use super::law::depth::{DepthReading, Window};
    use super::law::{CountLaw, DepthLaw, FragmentCount, PixelLaw};
    use super::*;

    /// The paper's distribution, changed.
    fn synth(change: impl FnOnce(&mut PixelLaw)) -> Synth {
        let mut config = SynthConfig::paper();
        change(&mut config.pixels[0]);
        Synth::new(config, 7).unwrap()
    }

    fn window(min: f64, max: f64, reading: DepthReading) -> DepthLaw {
        Window { min, max, reading }.into()
    }

    fn windows(list: &FragmentList, p: usize) -> Vec<f64> {
        let planes = list.planes().unwrap();
        list.pixel(p)
            .view_z
            .iter()
            .map(|&v| planes.window(crate::pixel::ViewZ(v.into())).unwrap().0)
            .collect()
    }

    fn sha256(list: &FragmentList) -> String {
        let bytes: Vec<u8> = list
            .view_z()
            .iter()
            .chain(list.alpha())
            .flat_map(|v| v.to_le_bytes())
            .collect();
        crate::numeric::digest::sha256_hex([bytes.as_slice()])
    }

    #[test]
    fn any_pixel_can_be_made_alone_and_threads_change_nothing() {
        for config in [SynthConfig::paper(), SynthConfig::wide()] {
            let synth = Synth::new(config, 7).unwrap();
            let all = synth.pixels(Purpose::Training, 0, 1000);
            assert_eq!(all.pixels(), 1000);
            for p in [0, 1, 255, 256, 499, 999] {
                let alone = synth.pixels(Purpose::Training, p as u64, 1);
                assert_eq!(alone.view_z(), all.pixel(p).view_z);
                assert_eq!(alone.alpha(), all.pixel(p).alpha);
            }
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                assert_eq!(pool.install(|| synth.pixels(Purpose::Training, 0, 1000)), all);
            }
            assert_ne!(
                synth.pixels(Purpose::Validation, 0, 10),
                synth.pixels(Purpose::Training, 0, 10)
            );
            assert_ne!(
                synth.pixels(Purpose::Evaluation, 0, 10),
                synth.pixels(Purpose::Training, 0, 10)
            );
            assert_eq!(synth.pixels(Purpose::Training, 5, 0).pixels(), 0);
        }
    }

    /// The first pixels of seed 7 as they are on every machine: a change here breaks every published seed.
    #[test]
    fn bytes_of_a_seed_are_pinned() {
        insta::assert_snapshot!(sha256(&synth(|_| {}).pixels(Purpose::Training, 0, 256)));
    }

    /// The same of all laws at once.
    #[test]
    fn bytes_of_a_wide_seed_are_pinned() {
        insta::assert_snapshot!(sha256(&Synth::new(SynthConfig::wide(), 7).unwrap().pixels(
            Purpose::Training,
            0,
            1024
        )));
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
        let extent =
            synth(|law| law.depth = window(0.3, 1.0, DepthReading::PixelExtent)).pixels(Purpose::Training, 0, 500);
        for p in 0..extent.pixels() {
            let w = windows(&extent, p);
            let (lo, hi) = w.iter().fold((1.0f64, 0.0f64), |(lo, hi), &w| (lo.min(w), hi.max(w)));
            assert!((0.3 - 1e-6..=1.0).contains(&(hi - lo)), "extent {}", hi - lo);
        }
        let per_pixel = Uniform {
            min: 0.1,
            max: 0.5,
            reading: AlphaReading::PerPixel,
        };
        let shared = synth(|law| law.alpha = per_pixel.into()).pixels(Purpose::Training, 0, 500);
        assert!((0..shared.pixels()).all(|p| shared.pixel(p).alpha.iter().all(|&a| a == shared.pixel(p).alpha[0])));
        let single = synth(|law| {
            law.fragments = FragmentCount {
                min: 1,
                max: 1,
                law: CountLaw::Uniform,
            };
            law.depth = window(0.3, 1.0, DepthReading::PixelExtent);
        });
        assert_eq!(single.pixels(Purpose::Training, 0, 100).depth_complexity(), 1);
    }

    /// Three laws that a pixel's fragment count tells apart. Tolerance: 5 standard errors of a share.
    #[test]
    fn laws_are_as_frequent_as_their_weights_say() {
        let mut config = SynthConfig::paper();
        let law = |n, weight| PixelLaw {
            weight,
            fragments: FragmentCount {
                min: n,
                max: n,
                law: CountLaw::Uniform,
            },
            ..config.pixels[0]
        };
        config.pixels = vec![law(1, 0.5), law(2, 3.0), law(3, 1.5)];
        let pixels = 20_000;
        let list = Synth::new(config, 7).unwrap().pixels(Purpose::Training, 0, pixels);
        for (n, share) in [(1, 0.1), (2, 0.6), (3, 0.3)] {
            let found = (0..pixels).filter(|&p| list.pixel(p).len() == n).count() as f64 / pixels as f64;
            assert!(
                (found - share).abs() < 5.0 * (share * (1.0 - share) / pixels as f64).sqrt(),
                "{n} fragments: {found}"
            );
        }
    }

    /// No law of the wide distribution leaves the camera's planes, [0, 1] or its own counts; each of them occurs.
    #[test]
    fn the_wide_distribution_is_within_its_ranges() {
        let config = SynthConfig::wide();
        for law in &config.pixels {
            let list = Synth::new(
                SynthConfig {
                    pixels: vec![*law],
                    ..config.clone()
                },
                7,
            )
            .unwrap()
            .pixels(Purpose::Training, 0, 300);
            assert!(list.view_z().iter().all(|v| (0.1..=100.0).contains(v)), "{law:?}");
            assert!(list.alpha().iter().all(|a| (0.0..=1.0).contains(a)), "{law:?}");
            assert!(
                (0..list.pixels())
                    .all(|p| (law.fragments.min as usize..=law.fragments.max as usize).contains(&list.pixel(p).len())),
                "{law:?}"
            );
        }
        let list = Synth::new(config, 7).unwrap().pixels(Purpose::Training, 0, 20_000);
        assert_eq!((0..list.pixels()).map(|p| list.pixel(p).len()).min(), Some(3));
        assert!(list.depth_complexity() > 250);
    }
}
