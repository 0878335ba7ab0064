//! Both passes of a method over a fragment list in compute shaders: the arithmetic of a method without a renderer
//! around it, each pass timed by itself.

use super::device::{Dispatch, Gpu, GpuError, groups};
use super::upload::{self, Chunk, DeviceList, frame};
use crate::pixel::{CameraPlanes, FragmentList};
use crate::shader::MethodShader;
use crate::shader::compute::{ACCUMULATE, ListShaders, WEIGH};

/// A method made ready for a list: pipelines and buffers.
#[derive(Debug)]
pub struct Passes<'a> {
    list: &'a DeviceList,
    chunk: &'a Chunk,
    name: String,
    accumulate: wgpu::ComputePipeline,
    weigh: wgpu::ComputePipeline,
    /// What pass 1 leaves.
    state: wgpu::Buffer,
    weights: wgpu::Buffer,
    /// Cores, where the method keeps them.
    core: Option<wgpu::Buffer>,
    frame: wgpu::Buffer,
}

/// Seconds of both passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassSeconds {
    /// Pass 1, a thread a pixel.
    pub accumulate: f64,
    /// Pass 2, a thread a fragment.
    pub weights: f64,
}

impl<'a> Passes<'a> {
    /// Makes a method ready. `range` is what its depths are measured by; see [`MethodShader::depth_range`].
    ///
    /// # Errors
    /// [`GpuError`]: the method's source is refused, or the list does not fit.
    pub fn new(gpu: &Gpu, list: &'a DeviceList, method: &MethodShader, range: [f32; 2]) -> Result<Self, GpuError> {
        let shaders = ListShaders::new(method);
        let name = |pass: u32| format!("{}, pass {pass}", method.name);
        Ok(Self {
            name: method.name.clone(),
            chunk: list.whole(gpu)?,
            accumulate: gpu.compute(&name(1), &shaders.accumulate, ACCUMULATE)?,
            weigh: gpu.compute(&name(2), &shaders.weigh, WEIGH)?,
            state: gpu.zeros("what pass 1 leaves", 16 * (shaders.vectors * list.pixels) as u64)?,
            weights: gpu.zeros("weights", 4 * list.fragments as u64)?,
            core: upload::core(gpu, method, list.pixels)?,
            frame: frame(gpu, method, range, (list.pixels as u32, 1), [0.0; 3], 1.0),
            list,
        })
    }

    /// Runs both passes, waits for them, and says how long each took; see [`Gpu::timed`].
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn run(&self, gpu: &Gpu) -> Result<PassSeconds, GpuError> {
        let (first, second) = (self.accumulate_buffers(), self.weigh_buffers());
        let seconds = gpu.run(
            &self.name,
            &[self.accumulate_dispatch(&first), self.weigh_dispatch(&second)],
        )?;
        Ok(PassSeconds {
            accumulate: seconds[0],
            weights: seconds[1],
        })
    }

    fn accumulate_buffers(&self) -> Vec<&wgpu::Buffer> {
        let Chunk { view_z, alpha, .. } = self.chunk;
        let buffers = [&self.frame, &self.list.offsets, view_z, alpha, &self.state];
        buffers.into_iter().chain(&self.core).collect()
    }

    fn weigh_buffers(&self) -> Vec<&wgpu::Buffer> {
        let Chunk {
            pixel_of,
            view_z,
            alpha,
            ..
        } = self.chunk;
        let buffers = [&self.frame, pixel_of, view_z, alpha, &self.state, &self.weights];
        buffers.into_iter().chain(&self.core).collect()
    }

    fn accumulate_dispatch<'b>(&'b self, buffers: &'b [&'b wgpu::Buffer]) -> Dispatch<'b> {
        Dispatch {
            pipeline: &self.accumulate,
            buffers,
            groups: groups(self.list.pixels as u64),
        }
    }

    fn weigh_dispatch<'b>(&'b self, buffers: &'b [&'b wgpu::Buffer]) -> Dispatch<'b> {
        Dispatch {
            pipeline: &self.weigh,
            buffers,
            groups: groups(self.list.fragments as u64),
        }
    }

    /// Weights of all fragments, in the order of the list.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn weights(&self, gpu: &Gpu) -> Result<Vec<f32>, GpuError> {
        gpu.download(&self.weights, self.list.fragments)
    }
}

/// Runs a method's passes over a list and returns the weights of its fragments.
///
/// # Errors
/// [`GpuError`].
pub fn weights(
    gpu: &Gpu,
    method: &MethodShader,
    list: &FragmentList,
    planes: Option<CameraPlanes>,
    depth_range: Option<(f32, f32)>,
) -> Result<Vec<f32>, GpuError> {
    let on_device = DeviceList::new(gpu, list)?;
    let passes = Passes::new(gpu, &on_device, method, method.depth_range(list, planes, depth_range)?)?;
    passes.run(gpu)?;
    passes.weights(gpu)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Format;
    use crate::gpu::tests::gpu;
    use crate::model::file;
    use crate::numeric::tolerance::AbsoluteError;
    use crate::oit::{Context, neural::Neural};
    use crate::scene;
    use std::path::Path;

    /// A shipped network over built-in scenes: GPU against the CPU's pass. Logarithms differ by some ulp, which thin
    /// pixels magnify; so the error against the exact answer is compared, and where nothing is magnified the answers:
    /// T-MSE within 2 %, 99 % of T within 3e-3. Control: another pixel's answers.
    #[test]
    fn a_network_answers_as_on_the_cpu() {
        let Some(gpu) = gpu() else { return };
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mlp = file::load(&root.join("models/recommended.json")).unwrap();
        for scene in ["teapots", "glass-stacks", "hair", "foliage"] {
            let options = scene::Options {
                size: Some((96, 96)),
                seed: None,
            };
            let list = scene::build(&scene::open(scene).unwrap(), &options).unwrap();
            let exact = crate::pixel::abuffer::list_transmittance(&list);
            let cpu = Neural::new(mlp.clone())
                .transmittance(&list, Context::default(), &|_| {})
                .unwrap();
            let error = |t: &[f32]| AbsoluteError::of(&t.iter().map(|&t| t.into()).collect::<Vec<f64>>(), &exact);
            for format in [Format::WGSL, Format::WGSL_PLAIN] {
                let method = MethodShader::neural(&mlp, format).unwrap();
                let found = weights(gpu, &method, &list, None, None).unwrap();
                // Greatest difference of the nearest 99 %.
                let off = |a: &[f32]| {
                    let mut d: Vec<f32> = a
                        .iter()
                        .zip(&cpu)
                        .map(|(a, b)| (a - b).abs())
                        .map(|d| if d.is_nan() { 9.0 } else { d })
                        .collect();
                    d.sort_by(f32::total_cmp);
                    d[(d.len() - 1) * 99 / 100]
                };
                let (ours, theirs) = (error(&found).mse(), error(&cpu).mse());
                println!(
                    "{scene} {}: 99 % within {:.1e}; T-MSE {ours:.4e} for {theirs:.4e}",
                    format.name(),
                    off(&found)
                );
                assert!(
                    found.len() > 1000 && off(&found) <= 3e-3 && (ours - theirs).abs() <= 0.02 * theirs,
                    "{scene}"
                );
                let shifted: Vec<f32> = found.iter().cycle().skip(5).take(found.len()).copied().collect();
                assert!(off(&shifted) > 1e-2, "the control of {scene}");
            }
        }
    }
}
