//! Both passes of a method over a fragment list in compute shaders: the arithmetic of a method without a renderer
//! around it, each pass timed by itself.

use super::device::{Dispatch, Gpu, GpuError, groups};
use super::method::{MethodShader, Pass1};
use crate::pixel::{CameraPlanes, FragmentList};

/// A fragment list on the device.
#[derive(Debug)]
pub struct DeviceList {
    /// Pixels.
    pub pixels: usize,
    /// Fragments.
    pub fragments: usize,
    offsets: wgpu::Buffer,
    view_z: wgpu::Buffer,
    alpha: wgpu::Buffer,
    /// Pixel of every fragment.
    pixel_of: wgpu::Buffer,
}

impl DeviceList {
    /// Uploads a list.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn new(gpu: &Gpu, list: &FragmentList) -> Result<Self, GpuError> {
        let offsets: Vec<u32> = list.offsets().iter().map(|&o| o as u32).collect();
        let mut pixel_of = Vec::with_capacity(list.len());
        for p in 0..list.pixels() {
            pixel_of.extend(list.range(p).map(|_| p as u32));
        }
        Ok(Self {
            pixels: list.pixels(),
            fragments: list.len(),
            offsets: gpu.upload("offsets", &offsets)?,
            view_z: gpu.upload("view_z", list.view_z())?,
            alpha: gpu.upload("alpha", list.alpha())?,
            pixel_of: gpu.upload("pixels of fragments", &pixel_of)?,
        })
    }
}

/// A method made ready for a list: pipelines and buffers.
#[derive(Debug)]
pub struct Passes<'a> {
    list: &'a DeviceList,
    name: String,
    accumulate: wgpu::ComputePipeline,
    weigh: wgpu::ComputePipeline,
    /// What pass 1 leaves.
    state: wgpu::Buffer,
    weights: wgpu::Buffer,
    parameters: wgpu::Buffer,
}

/// Seconds of both passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassSeconds {
    /// Pass 1, a thread a pixel.
    pub accumulate: f64,
    /// Pass 2, a thread a fragment.
    pub weights: f64,
}

/// Pass 1 for compute, a thread a pixel. What stands in capitals is filled in for a method.
const ACCUMULATE: &str = "
@group(0) @binding(0) var<storage, read> oit_offsets: array<u32>;
@group(0) @binding(1) var<storage, read> oit_view_z: array<f32>;
@group(0) @binding(2) var<storage, read> oit_alpha: array<f32>;
@group(0) @binding(3) var<storage, read> oit_parameters: array<f32>;
@group(0) @binding(4) var<storage, read_write> oit_state: array<vec4<f32>>;

@compute @workgroup_size(64)
fn oit_accumulate_list(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = id.x + id.y * groups.x * 64u;
    if (pixel + 1u >= arrayLength(&oit_offsets) || pixel >= bitcast<u32>(oit_parameters[2])) {
        return;
    }
    let range = vec2<f32>(oit_parameters[0], oit_parameters[1]);
    var sums: array<f32, OIT_SUMS>;
    var nearest = 3.0e38;
    var farthest = 0.0;
    OIT_PREPASS
    for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let v = oit_view_z[i];
        let alpha = oit_alpha[i];
        let f = OitFragment(v, oit_depth(v, range), alpha, oit_absorbance(alpha));
        OIT_ADD
        nearest = min(nearest, v);
        farthest = max(farthest, v);
    }
    OIT_STORE
}
";

/// The prepass of methods that need it.
const PREPASS: &str = "for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        nearest = min(nearest, oit_view_z[i]);
        farthest = max(farthest, oit_view_z[i]);
    }
    let ends = vec2<f32>(nearest, farthest);";

/// Pass 2 for compute, a thread a fragment.
const WEIGH: &str = "
@group(0) @binding(0) var<storage, read> oit_pixel_of: array<u32>;
@group(0) @binding(1) var<storage, read> oit_view_z: array<f32>;
@group(0) @binding(2) var<storage, read> oit_alpha: array<f32>;
@group(0) @binding(3) var<storage, read> oit_parameters: array<f32>;
@group(0) @binding(4) var<storage, read> oit_state: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> oit_weights: array<f32>;

@compute @workgroup_size(64)
fn oit_weigh_list(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = id.x + id.y * groups.x * 64u;
    if (i >= bitcast<u32>(oit_parameters[3])) {
        return;
    }
    let range = vec2<f32>(oit_parameters[0], oit_parameters[1]);
    let pixel = oit_pixel_of[i];
    let v = oit_view_z[i];
    let alpha = oit_alpha[i];
    OIT_LOAD
    oit_weights[i] = oit_weight(OitFragment(v, oit_depth(v, range), alpha, oit_absorbance(alpha)), state);
}
";

impl<'a> Passes<'a> {
    /// Makes a method ready. `range` is what its depths are measured by; see [`MethodShader::depth_range`].
    ///
    /// # Errors
    /// [`GpuError`]: the method's source is refused, or the list does not fit.
    pub fn new(gpu: &Gpu, list: &'a DeviceList, method: &MethodShader, range: [f32; 2]) -> Result<Self, GpuError> {
        let k = method.sums;
        // What pass 2 reads of a pixel, four numbers to a vector: the sums, and where the method looks at them number
        // and range of its fragments, the range with its moment depths, so that no fragment warps the depths of others.
        let mut state: Vec<String> = (0..k).map(|i| format!("sums[{i}]")).collect();
        if method.range {
            let kept = [
                "f32(oit_offsets[pixel + 1u] - oit_offsets[pixel])",
                "nearest",
                "farthest",
                "oit_depth(nearest, range)",
                "oit_depth(farthest, range)",
            ];
            state.extend(kept.map(str::to_owned));
        }
        let vectors = state.len().div_ceil(4);
        state.resize(4 * vectors, "0.0".to_owned());
        let store: Vec<String> = (0..vectors)
            .map(|i| {
                format!(
                    "oit_state[pixel * {vectors}u + {i}u] = vec4<f32>({});",
                    state[4 * i..4 * i + 4].join(", ")
                )
            })
            .collect();
        let load: Vec<String> = (0..vectors)
            .map(|i| format!("let state{i} = oit_state[pixel * {vectors}u + {i}u];"))
            .collect();
        let number = |i: usize| format!("state{}[{}]", i / 4, i % 4);
        let sums: Vec<String> = (0..k).map(number).collect();
        let range_of: Vec<String> = if method.range {
            (k..k + 5).map(number).collect()
        } else {
            ["0.0", "1.0", "1.0", "0.0", "0.0"].map(str::to_owned).to_vec()
        };
        let (prepass, add) = match method.pass1 {
            Pass1::Added => {
                let add: Vec<String> = (0..k).map(|i| format!("sums[{i}] += term[{i}];")).collect();
                ("", format!("let term = oit_accumulate(f); {}", add.join(" ")))
            }
            Pass1::Inserted => (PREPASS, "oit_insert(&sums, f, ends.x, ends.y);".to_owned()),
        };
        let accumulate = ACCUMULATE
            .replace("OIT_PREPASS", prepass)
            .replace("OIT_ADD", &add)
            .replace("OIT_STORE", &store.join("\n    "));
        let load = format!(
            "{}\n    let state = OitPixel(array<f32, OIT_SUMS>({}), {});",
            load.join("\n    "),
            sums.join(", "),
            range_of.join(", ")
        );
        let weigh = WEIGH.replace("OIT_LOAD", &load);
        let module = method.module();
        let parameters = [
            range[0],
            range[1],
            f32::from_bits(list.pixels as u32),
            f32::from_bits(list.fragments as u32),
        ];
        Ok(Self {
            name: method.name.clone(),
            accumulate: gpu.compute(
                &format!("{}, pass 1", method.name),
                &format!("{module}{accumulate}"),
                "oit_accumulate_list",
            )?,
            weigh: gpu.compute(
                &format!("{}, pass 2", method.name),
                &format!("{module}{weigh}"),
                "oit_weigh_list",
            )?,
            state: gpu.zeros("what pass 1 leaves", 16 * (vectors * list.pixels) as u64)?,
            weights: gpu.zeros("weights", 4 * list.fragments as u64)?,
            parameters: gpu.upload("parameters", &parameters)?,
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
        let list = self.list;
        [&list.offsets, &list.view_z, &list.alpha, &self.parameters, &self.state].to_vec()
    }

    fn weigh_buffers(&self) -> Vec<&wgpu::Buffer> {
        let list = self.list;
        [
            &list.pixel_of,
            &list.view_z,
            &list.alpha,
            &self.parameters,
            &self.state,
            &self.weights,
        ]
        .to_vec()
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
            for format in [Format::Wgsl, Format::WgslPlain] {
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
