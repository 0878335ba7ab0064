//! What a frame's passes take on the device: drawn and blended, in compute shaders over all tiles, and with the network only in the tiles that need it.

use crate::gpu::pipeline::{ColorStorage, Drawing, Pipeline};
use crate::gpu::tiles::{Skip, TileCounts, TilePasses, TileSeconds};
use crate::gpu::{Gpu, GpuError, MethodShader};
use crate::pixel::FragmentList;

/// How a frame is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Render passes that blend.
    Drawn,
    /// Compute passes, one dispatch over all tiles.
    EveryTile,
    /// Compute passes, the network where it is needed.
    TilesApart,
}

impl Way {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drawn => "render",
            Self::EveryTile => "compute",
            Self::TilesApart => "compute-tiles",
        }
    }
}

/// Seconds of one way to make a frame, one number a repetition.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameSamples {
    /// The way.
    pub way: Way,
    /// Pass 1.
    pub accumulate: Vec<f64>,
    /// Pass 2 and the resolve, and telling the tiles apart where they are.
    pub weights: Vec<f64>,
}

/// All ways to make a frame of a list with a method.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    /// Name of the method.
    pub method: String,
    /// Name of the adapter and its backend.
    pub adapter: String,
    /// How many tiles there are of each kind.
    pub tiles: TileCounts,
    /// Render passes where the adapter blends into f32 targets, then compute passes without and with tiles told apart.
    pub samples: Vec<FrameSamples>,
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
    repeat: usize,
    progress: &dyn Fn(u64),
) -> Result<Frames, GpuError> {
    let background = [1.0; 3];
    let drawing = if gpu.blends_f32() { Some(Drawing::new(gpu, list)?) } else { None };
    let drawn = drawing.as_ref().map(|drawing| Pipeline::new(gpu, drawing, method, range, background, ColorStorage::F32)).transpose()?;
    let tiles = TilePasses::new(gpu, list, method, range, background)?;
    let ways = [Way::Drawn, Way::EveryTile, Way::TilesApart].into_iter().filter(|way| *way != Way::Drawn || drawn.is_some());
    let mut samples: Vec<FrameSamples> = ways.map(|way| FrameSamples { way, accumulate: Vec::new(), weights: Vec::new() }).collect();
    for repetition in 0..=repeat {
        for way in &mut samples {
            let compute = |s: TileSeconds| (s.accumulate, s.weights());
            let (accumulate, weights) = match (way.way, &drawn) {
                (Way::Drawn, Some(drawn)) => {
                    let s = drawn.run(gpu)?;
                    (s.accumulate, s.weights + s.resolve)
                }
                (Way::TilesApart, _) => compute(tiles.run(gpu, Skip::Tiles)?),
                _ => compute(tiles.run(gpu, Skip::None)?),
            };
            if repetition > 0 {
                way.accumulate.push(accumulate);
                way.weights.push(weights);
            }
        }
        progress(repetition as u64);
    }
    Ok(Frames { method: method.name.clone(), adapter: gpu.name(), tiles: tiles.counts(gpu)?, samples })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Format;
    use crate::gpu::tests::gpu;
    use crate::model::file;
    use crate::scene;
    use std::path::Path;

    /// Each way has a sample a repetition, and the tiles are all there.
    #[test]
    fn every_way_is_measured() {
        let Some(gpu) = gpu() else { return };
        let mlp = file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("models/small.json")).unwrap();
        let list = scene::build(&scene::open("teapots").unwrap(), &scene::Options { size: Some((40, 30)), seed: None }).unwrap();
        let method = MethodShader::neural(&mlp, Format::Wgsl).unwrap();
        let range = method.depth_range(&list, None, None).unwrap();
        let found = frames(gpu, &list, &method, range, 2, &|_| {}).unwrap();
        assert_eq!(found.tiles.network + found.tiles.exact, 5 * 4);
        assert_eq!(found.samples.len(), if gpu.blends_f32() { 3 } else { 2 });
        for way in &found.samples {
            assert_eq!((way.accumulate.len(), way.weights.len()), (2, 2));
            assert!(way.weights.iter().all(|s| *s > 0.0), "{way:?}");
        }
    }
}
