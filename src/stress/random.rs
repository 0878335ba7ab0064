//! A great many random pixels of every kind at once, in search of an answer that breaks a promise.

use super::cases::{Fragments, SCENE};
use crate::features::MomentFrame;
use crate::model::Mlp;
use crate::numeric::rng::{Stream, stream};
use crate::oit::MethodError;
use crate::oit::neural::Neural;
use crate::pixel::{LogWarp, MomentDepth, ViewZ};
use rand::RngExt;
use rayon::prelude::*;
use serde::Serialize;

const PURPOSE: u64 = 0x5354;

/// Fragments that are drawn from one stream of random numbers.
const BLOCK: usize = 1 << 14;

/// Blocks that are answered together.
const TOGETHER: usize = 32;

/// Most fragments of a pixel.
const MAX_FRAGMENTS: f64 = 300.0;

/// What a network made of many random fragments.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Fragments answered.
    pub fragments: u64,
    /// Pixels that they were in.
    pub pixels: u64,
    /// Fragments that the network was asked about; the others are known without it.
    pub evaluated: u64,
    /// Answers that are NaN or infinite.
    pub nonfinite: u64,
    /// Answers below 0 or above 1.
    pub out_of_range: u64,
    /// Nearest fragments whose answer is not exactly 1; networks that promise no such thing have these too.
    pub nearest_not_one: u64,
    /// Fragments alone in their pixel whose answer is not exactly 1.
    pub single_not_one: u64,
}

impl Counts {
    /// Counts one pixel's answers.
    fn add(&mut self, view_z: &[f32], answers: &[f32]) {
        let nearest = view_z.iter().copied().fold(f32::INFINITY, f32::min);
        self.fragments += view_z.len() as u64;
        self.pixels += 1;
        for (&v, &t) in view_z.iter().zip(answers) {
            self.nonfinite += u64::from(!t.is_finite());
            self.out_of_range += u64::from(t.is_finite() && !(0.0..=1.0).contains(&t));
            if v == nearest && t != 1.0 {
                self.nearest_not_one += 1;
                self.single_not_one += u64::from(view_z.len() == 1);
            }
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            fragments: self.fragments + other.fragments,
            pixels: self.pixels + other.pixels,
            evaluated: self.evaluated + other.evaluated,
            nonfinite: self.nonfinite + other.nonfinite,
            out_of_range: self.out_of_range + other.out_of_range,
            nearest_not_one: self.nearest_not_one + other.nearest_not_one,
            single_not_one: self.single_not_one + other.single_not_one,
        }
    }
}

/// Asks a network about at least so many random fragments, on all cores, a few megabytes at a time. The same fragments
/// whatever the number of threads.
///
/// `progress` is told how many are done.
///
/// # Errors
/// [`MethodError`] where the network's features cannot be had of any pixel.
pub fn hunt(
    mlp: &Mlp,
    frame: MomentFrame,
    fragments: u64,
    seed: u64,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Counts, MethodError> {
    let method = Neural::new(mlp.clone()).with_frame(frame);
    // A block ends with the pixel that fills it.
    let blocks = fragments.div_ceil(BLOCK as u64);
    let mut counts = Counts::default();
    for first in (0..blocks).step_by(TOGETHER) {
        let parts: Vec<Fragments> = (first..blocks.min(first + TOGETHER as u64))
            .into_par_iter()
            .map(|block| block_of(seed, block))
            .collect();
        let mut whole = Fragments::none(SCENE);
        for part in &parts {
            let start = whole.len() as u64;
            whole.offsets.extend(part.offsets[1..].iter().map(|o| start + o));
            whole.view_z.extend_from_slice(&part.view_z);
            whole.alpha.extend_from_slice(&part.alpha);
        }
        let list = whole.list().expect("depths and opacities are within their domains");
        let answered = method.answers(&list, whole.context, &|_| {})?;
        let seen = (0..list.pixels())
            .into_par_iter()
            .with_min_len(256)
            .fold(Counts::default, |mut counts, p| {
                counts.add(list.pixel(p).view_z, &answered.transmittance[list.range(p)]);
                counts
            });
        let seen = seen.reduce(Counts::default, Counts::and);
        counts = counts.and(Counts {
            evaluated: answered.tally.rows,
            ..seen
        });
        progress(counts.fragments);
    }
    Ok(counts)
}

/// Pixels of one block: one fragment to 300, alone or tied, spread over the scene or over a billionth of it, clear,
/// faint, opaque and everything between.
fn block_of(seed: u64, block: u64) -> Fragments {
    let mut rng = stream(seed, PURPOSE, block);
    let warp = LogWarp::new(ViewZ(SCENE.0.into()), ViewZ(SCENE.1.into())).expect("0 < v0 < v1");
    let mut list = Fragments::none(SCENE);
    while list.len() < BLOCK {
        let n = (libm::exp(rng.random_range(0.0..libm::log(MAX_FRAGMENTS))) as usize).max(1);
        let half = libm::exp(rng.random_range(libm::log(1e-9)..0.0));
        let centre = rng.random_range(-1.0..=1.0) * (1.0 - half);
        // Some pixels hold few different depths, some one.
        let levels = match rng.random_range(0..8) {
            0 => Some(1),
            1 => Some(rng.random_range(2..6)),
            _ => None,
        };
        let law = rng.random_range(0..6);
        let scale = libm::exp(rng.random_range(libm::log(1e-8)..0.0));
        for _ in 0..n {
            let u = match levels {
                None => rng.random_range(-1.0..=1.0),
                Some(1) => 0.0,
                Some(levels) => 2.0 * f64::from(rng.random_range(0..levels)) / f64::from(levels - 1) - 1.0,
            };
            let v = (warp.view_z(MomentDepth(centre + half * u)).0 as f32).clamp(SCENE.0, SCENE.1);
            list.view_z.push(v);
            list.alpha.push(alpha(law, scale, &mut rng));
        }
        list.offsets.push(list.view_z.len() as u64);
    }
    list
}

fn alpha(law: u32, scale: f64, rng: &mut Stream) -> f32 {
    const ENDS: [f32; 8] = [0.0, 1e-45, 1e-39, 1e-8, 0.5, 0.9999, 1.0 - 1e-7, 1.0];
    let u: f64 = rng.random();
    match law {
        0 => u as f32,
        1 => scale as f32,
        2 => (scale * u) as f32,
        3 => libm::exp(u * libm::log(1e-12)) as f32,
        4 if u < 0.5 => 1.0 - (0.1 * u) as f32,
        4 => (0.1 * scale * u) as f32,
        _ => ENDS[rng.random_range(0..ENDS.len())],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::FeatureSet;
    use crate::model::{Provenance, file, mlp::tests::random_mlp};
    use std::path::Path;

    /// Shipped networks and one of random weights: half a million fragments, no promise broken. The long run is `nmt
    /// stress --random 100000000`.
    #[test]
    fn no_promise_is_broken() {
        let shipped = ["recommended", "small", "moments-6"].map(|name| {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.json"));
            file::load(&path).unwrap()
        });
        let random = Mlp::new(
            "random",
            FeatureSet::Recentred,
            random_mlp(&[8, 4], 3).layers().to_vec(),
            Provenance::default(),
        )
        .unwrap();
        for mlp in shipped.iter().chain([&random]) {
            for frame in [MomentFrame::Scene, MomentFrame::Pixel] {
                let found = hunt(mlp, frame, 250_000, 1, &|_| {}).unwrap();
                assert!(
                    found.fragments >= 250_000 && found.evaluated > 100_000 && found.pixels > 3000,
                    "{found:?}"
                );
                let broken = (
                    found.nonfinite,
                    found.out_of_range,
                    found.nearest_not_one,
                    found.single_not_one,
                );
                assert_eq!(broken, (0, 0, 0, 0), "{} {frame:?}", mlp.name());
            }
        }
        // Control: a network that knows no exact rule breaks them.
        let found = hunt(&random_mlp(&[8, 4], 3), MomentFrame::Scene, 20_000, 1, &|_| {}).unwrap();
        assert!(found.nearest_not_one > 500 && found.single_not_one > 5 && found.nonfinite == 0);
    }

    #[test]
    fn faults_are_counted() {
        let mut counts = Counts::default();
        counts.add(&[1.0, 2.0, 1.0, 3.0], &[1.0, f32::NAN, 0.5, 1.5]);
        counts.add(&[7.0], &[0.999]);
        let expected = Counts {
            fragments: 5,
            pixels: 2,
            evaluated: 0,
            nonfinite: 1,
            out_of_range: 1,
            nearest_not_one: 2,
            single_not_one: 1,
        };
        assert_eq!(counts, expected);
    }

    #[test]
    fn threads_change_nothing() {
        let mlp = Mlp::new(
            "random",
            FeatureSet::Recentred,
            random_mlp(&[4], 3).layers().to_vec(),
            Provenance::default(),
        )
        .unwrap();
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| hunt(&mlp, MomentFrame::Scene, 100_000, 1, &|_| {}))
                .unwrap()
        };
        assert_eq!(run(1), run(3));
        assert_eq!(block_of(1, 7).view_z, block_of(1, 7).view_z);
        assert_ne!(block_of(1, 7).view_z, block_of(2, 7).view_z);
    }
}
