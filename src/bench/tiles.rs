//! What a frame's passes take on the device: drawn and blended, and in compute shaders with the network for every
//! fragment, for those whose answer is used, and for those that can be seen.

use crate::evaluate::gpu::channel_differences;
use crate::evaluate::{EvaluateError, Image, flip};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::tiles::{PixelCounts, TilePasses};
use crate::gpu::{DeviceList, Gpu, MethodShader};
use crate::oit::neural::Skip;
use crate::pixel::FragmentList;
use crate::shader::passes::TargetPrecision;

/// How a frame is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Render passes that blend.
    Drawn,
    /// Compute passes, the network for these fragments.
    Compute(Skip),
}

impl Way {
    /// The name of its passes in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drawn => "render",
            Self::Compute(_) => "compute",
        }
    }

    /// What it skips.
    pub fn skip(self) -> Skip {
        match self {
            Self::Drawn => Skip::Exact,
            Self::Compute(skip) => skip,
        }
    }
}

/// What compute passes did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Work {
    /// Fragments that the network was run for.
    pub evaluated: u64,
    /// Pixels told apart; none where they are not.
    pub pixels: Option<PixelCounts>,
    /// Greatest difference of a channel from the image of compute passes that skip nothing.
    pub greatest_change: f64,
    /// Mean of the FLIP map against that image.
    pub flip_change: f64,
}

/// One way to make a frame, with seconds of each repetition.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameSamples {
    /// The way.
    pub way: Way,
    /// Pass 1.
    pub accumulate: Vec<f64>,
    /// Pass 2 and the resolve, and telling pixels apart where they are.
    pub weights: Vec<f64>,
    /// What it did; none of render passes.
    pub work: Option<Work>,
}

/// All ways to make a frame of a list with a method.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    /// Name of the method.
    pub method: String,
    /// Name of the adapter and its backend.
    pub adapter: String,
    /// Fragments of the list.
    pub fragments: u64,
    /// Render passes where the adapter blends into f32 targets, then compute passes.
    pub samples: Vec<FrameSamples>,
}

impl Frames {
    /// Time of pass 2 in compute passes that skip nothing, as a multiple of that of a way: the median over the
    /// repetitions.
    pub fn speedup(&self, of: &FrameSamples) -> Option<f64> {
        let none = self.samples.iter().find(|s| s.way == Way::Compute(Skip::None))?;
        let ratios: Vec<f64> = none
            .weights
            .iter()
            .zip(&of.weights)
            .map(|(none, own)| none / own)
            .collect();
        Some(super::Summary::of(&ratios).median)
    }
}

/// Measures by turns, after a frame of each that is not counted; times as [`Gpu::timed`] takes them.
///
/// # Errors
/// What the passes refuse.
pub fn frames(
    gpu: &Gpu,
    list: &FragmentList,
    method: &MethodShader,
    range: [f32; 2],
    skips: &[Skip],
    repeat: usize,
    progress: &dyn Fn(u64),
) -> Result<Frames, EvaluateError> {
    let background = [1.0; 3];
    let on_device = DeviceList::new(gpu, list)?;
    let drawn = gpu
        .blends_f32()
        .then(|| Pipeline::new(gpu, &on_device, method, range, background, TargetPrecision::Full))
        .transpose()?;
    let passes = TilePasses::new(gpu, &on_device, method, range, background)?;
    let image = || {
        let (width, height) = list.size().expect("the passes have asked");
        Image::new(
            width,
            height,
            passes.image(gpu)?.iter().map(|p| p.map(f64::from)).collect(),
        )
    };
    let ways = drawn
        .iter()
        .map(|_| Way::Drawn)
        .chain(skips.iter().map(|&skip| Way::Compute(skip)));
    let mut samples: Vec<FrameSamples> = ways
        .map(|way| FrameSamples {
            way,
            accumulate: Vec::new(),
            weights: Vec::new(),
            work: None,
        })
        .collect();
    passes.run(gpu, Skip::None)?;
    let reference = image()?;
    for repetition in 0..=repeat {
        for s in &mut samples {
            let (accumulate, weights) = match (s.way, &drawn) {
                (Way::Drawn, Some(drawn)) => {
                    let s = drawn.run(gpu)?;
                    (s.accumulate, s.weights + s.resolve)
                }
                (way, _) => {
                    let s = passes.run(gpu, way.skip())?;
                    (s.accumulate, s.weights())
                }
            };
            if repetition > 0 {
                s.accumulate.push(accumulate);
                s.weights.push(weights);
            } else if let Way::Compute(skip) = s.way {
                let found = image()?;
                s.work = Some(Work {
                    evaluated: passes.evaluated(gpu)?,
                    pixels: (skip != Skip::None).then(|| passes.counts(gpu)).transpose()?,
                    greatest_change: channel_differences(&found, &reference)?.into_iter().fold(0.0, f64::max),
                    flip_change: flip(&reference, &found)?.mean(),
                });
            }
        }
        progress(repetition as u64);
    }
    Ok(Frames {
        method: method.name.clone(),
        adapter: gpu.name(),
        fragments: list.len() as u64,
        samples,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Format;
    use crate::gpu::tests::gpu;
    use crate::model::file;
    use crate::scene;
    use std::path::Path;

    /// Each way has a sample a repetition, and the pixels are all there.
    #[test]
    fn every_way_is_measured() {
        let Some(gpu) = gpu() else { return };
        let mlp = file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("models/small.json")).unwrap();
        let list = scene::build(
            &scene::open("teapots").unwrap(),
            &scene::Options {
                size: Some((40, 30)),
                seed: None,
            },
        )
        .unwrap();
        let method = MethodShader::neural(&mlp, Format::WGSL).unwrap();
        let range = method.depth_range(&list, None, None).unwrap();
        let found = frames(
            gpu,
            &list,
            &method,
            range,
            &[Skip::None, Skip::Exact, Skip::Visible],
            2,
            &|_| {},
        )
        .unwrap();
        assert_eq!(found.samples.len(), if gpu.blends_f32() { 4 } else { 3 });
        let work: Vec<Work> = found.samples.iter().filter_map(|s| s.work).collect();
        assert_eq!(
            (work.len(), work[0].evaluated, work[0].pixels),
            (3, list.len() as u64, None)
        );
        assert_eq!((work[0].greatest_change, work[1].greatest_change), (0.0, 0.0));
        assert!(
            work[1].evaluated < work[0].evaluated
                && work[2].evaluated <= work[1].evaluated
                && work[2].greatest_change <= 1.0 / 512.0,
            "{work:?}"
        );
        assert!(
            work[1..]
                .iter()
                .all(|w| w.pixels.is_some_and(|p| p.network + p.known == 40 * 30))
        );
        for way in &found.samples {
            assert_eq!((way.accumulate.len(), way.weights.len()), (2, 2));
            assert!(way.weights.iter().all(|s| *s > 0.0), "{way:?}");
            assert!(
                found
                    .speedup(way)
                    .is_some_and(|s| s > 0.0 && (s == 1.0) == (way.way == Way::Compute(Skip::None)))
            );
        }
    }
}
