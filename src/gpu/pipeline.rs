//! Both passes and the resolve as a renderer makes them: render passes whose targets are blended into, in whatever
//! order the fragments come.
//!
//! [`crate::shader::passes`] has the text and says what the passes write; [`Pipeline`] puts a method before a fragment
//! list on the device, which is drawn as one point a fragment. `docs/integration.md` says what a renderer does
//! otherwise.

use super::device::{Gpu, GpuError, Stamps};
use super::upload::{self, Chunk, DeviceList, frame};
use crate::pixel::{CameraPlanes, FragmentList};
use crate::shader::MethodShader;
use crate::shader::passes::{Channel, Holds, Limits, Shaders, Target, TargetPrecision};
use wgpu::TextureFormat::{Depth32Float, R16Float, R32Float, Rg16Float, Rg32Float, Rgba16Float, Rgba32Float};

/// What stands in a clear pixel of the range or of both ends: below -v of any fragment, and below any code.
const NOTHING: f64 = -3.0e38;

/// What this device allows.
pub fn limits_of(gpu: &Gpu) -> Limits {
    let limits = gpu.device.limits();
    Limits {
        bytes_per_pixel: limits.max_color_attachment_bytes_per_sample,
        targets: limits.max_color_attachments,
    }
}

fn format_of(target: Target) -> wgpu::TextureFormat {
    match (target.channel, target.channels) {
        (Channel::Depth, _) => Depth32Float,
        (Channel::F16, 1) => R16Float,
        (Channel::F16, 2) => Rg16Float,
        (Channel::F16, _) => Rgba16Float,
        (Channel::F32, 1) => R32Float,
        (Channel::F32, 2) => Rg32Float,
        (Channel::F32, _) => Rgba32Float,
    }
}

fn blend_of(target: Target) -> wgpu::BlendState {
    let operation = match target.holds {
        Holds::Range | Holds::Ends => wgpu::BlendOperation::Max,
        _ => wgpu::BlendOperation::Add,
    };
    let both = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation,
    };
    wgpu::BlendState {
        color: both,
        alpha: both,
    }
}

fn clear_of(target: Target) -> wgpu::Color {
    match target.holds {
        Holds::Range | Holds::Ends => wgpu::Color {
            r: NOTHING,
            g: NOTHING,
            b: 0.0,
            a: 0.0,
        },
        _ => wgpu::Color::TRANSPARENT,
    }
}

/// Layouts of the bind groups, the same for every method with as many targets.
#[derive(Debug)]
struct Layouts {
    frame: wgpu::BindGroupLayout,
    /// Fragments in pass 1 and 2.
    fragments: wgpu::BindGroupLayout,
    /// What pass 2 left, in the resolve.
    weighted: wgpu::BindGroupLayout,
    /// What pass 1 left.
    state: wgpu::BindGroupLayout,
    /// Cores, written in pass 1 and read in pass 2, where the method keeps them.
    cores: Option<[wgpu::BindGroupLayout; 2]>,
}

impl Layouts {
    fn new(gpu: &Gpu, targets: &[Target], has_core: bool) -> Self {
        let layout = |label, visibility, types: &[wgpu::BindingType]| {
            let entry = |(binding, &ty): (u32, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility,
                ty,
                count: None,
            };
            let entries: Vec<_> = (0..).zip(types).map(entry).collect();
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &entries,
            })
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = |is_depth| wgpu::BindingType::Texture {
            sample_type: if is_depth {
                wgpu::TextureSampleType::Depth
            } else {
                wgpu::TextureSampleType::Float { filterable: false }
            },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let state: Vec<_> = targets.iter().map(|t| texture(t.is_depth())).collect();
        let core = |read_only| {
            let buffer = wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            };
            layout("cores", wgpu::ShaderStages::FRAGMENT, &[buffer])
        };
        Self {
            cores: has_core.then(|| [false, true].map(core)),
            frame: layout("frame", wgpu::ShaderStages::VERTEX_FRAGMENT, &[uniform]),
            fragments: fragments_layout(gpu),
            weighted: layout("weighted colour", wgpu::ShaderStages::FRAGMENT, &[texture(false)]),
            state: layout("what pass 1 left", wgpu::ShaderStages::FRAGMENT, &state),
        }
    }
}

fn fragments_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX,
        ty,
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("fragments"),
        entries: &[0, 1, 2, 3].map(entry),
    })
}

/// What v must lie below for its scale to be a normal f32.
const MAX_SCALED: f32 = 8.507_059e37;

/// The power of two that takes v to [1/2, 1); its inverse is an f32 too.
fn scale_below_1(v: f32) -> f32 {
    // v lies in [2^e, 2^(e + 1)).
    let e = (v.to_bits() >> 23) as i32 - 127;
    f32::from_bits(((127 - (e + 1)).clamp(1, 253) as u32) << 23)
}

/// Refuses what the device cannot draw.
fn refuse(gpu: &Gpu, list: &DeviceList, method: &MethodShader, precision: TargetPrecision) -> Result<(), GpuError> {
    let lacks = |feature| GpuError::Lacks {
        adapter: gpu.name(),
        feature,
    };
    if precision.blends_f32() && !gpu.blends_f32() {
        return Err(lacks(BLENDING));
    }
    if precision == TargetPrecision::Half && list.greatest >= MAX_SCALED {
        return Err(GpuError::NoImage(format!(
            "view_z {:e} is too far away for a depth buffer, take a smaller unit",
            list.greatest
        )));
    }
    if method.needs_atomics() && !gpu.has_fragment_atomics() {
        return Err(lacks(ATOMICS));
    }
    if method.core.is_some() && precision == TargetPrecision::Half {
        return Err(GpuError::Source {
            label: method.name.clone(),
            reason: "a core is taken out of its pixel's sums again, which f16 is too coarse for".to_owned(),
        });
    }
    Ok(())
}

fn texture(
    gpu: &Gpu,
    label: &str,
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
        view_formats: &[],
    })
}

/// Resources at the bindings from 0 on.
fn group(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: Vec<wgpu::BindingResource<'_>>,
) -> wgpu::BindGroup {
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
    let entries: Vec<_> = (0..).zip(resources).map(entry).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// What pass 2 writes: weighted colours and their weights, added up.
fn weighted_target(precision: TargetPrecision) -> Target {
    let full = precision == TargetPrecision::Full;
    Target {
        channels: 4,
        channel: if full { Channel::F32 } else { Channel::F16 },
        holds: Holds::Added { first: 0, count: 4 },
    }
}

/// The passes of a method, compiled.
struct Pipelines {
    /// Draws of pass 1, and the targets that each writes.
    pass1: Vec<(wgpu::RenderPipeline, Vec<usize>)>,
    pass2: wgpu::RenderPipeline,
    resolve: wgpu::RenderPipeline,
}

impl Pipelines {
    fn new(gpu: &Gpu, shaders: &Shaders, layouts: &Layouts, precision: TargetPrecision) -> Self {
        let targets = &shaders.targets;
        let state = |format, blend| {
            Some(wgpu::ColorTargetState {
                format,
                blend,
                write_mask: wgpu::ColorWrites::ALL,
            })
        };
        let blended = |target: Target| state(format_of(target), Some(blend_of(target)));
        let points = wgpu::PrimitiveTopology::PointList;
        let (frame, fragments) = (Some(&layouts.frame), Some(&layouts.fragments));
        let pass1 = shaders.pass1.iter().map(|(source, draw)| {
            let colors = draw.iter().map(|&i| targets[i]).filter(|target| !target.is_depth());
            let depth = match targets[draw[0]].holds {
                Holds::Nearest => Some(wgpu::CompareFunction::Less),
                Holds::Farthest => Some(wgpu::CompareFunction::Greater),
                _ => None,
            };
            // The first draw alone keeps the core.
            let core = layouts.cores.as_ref().filter(|_| draw[0] == 0);
            let layout = [frame, fragments, None, core.map(|[written, _]| written)];
            let bound = if core.is_some() { 4 } else { 2 };
            let written: Vec<_> = colors.map(blended).collect();
            let entries = ["oit_point", "oit_pass1"];
            let pipeline = render_pipeline(
                gpu,
                "pass 1",
                source,
                entries,
                &layout[..bound],
                points,
                depth,
                &written,
            );
            (pipeline, draw.clone())
        });
        let core = layouts.cores.as_ref().map(|[_, read]| read);
        let all = [frame, fragments, Some(&layouts.state), core];
        let all = &all[..if core.is_some() { 4 } else { 3 }];
        let last = [frame, Some(&layouts.weighted), Some(&layouts.state)];
        Self {
            pass1: pass1.collect(),
            pass2: render_pipeline(
                gpu,
                "pass 2",
                &shaders.pass2,
                ["oit_point", "oit_pass2"],
                all,
                points,
                None,
                &[blended(weighted_target(precision))],
            ),
            resolve: render_pipeline(
                gpu,
                "resolve",
                &shaders.resolve,
                ["oit_everywhere", "oit_resolve"],
                &last,
                wgpu::PrimitiveTopology::TriangleList,
                None,
                &[state(Rgba32Float, None)],
            ),
        }
    }
}

/// A method made ready to draw a list: shaders, render targets, background.
#[derive(Debug)]
pub struct Pipeline {
    name: String,
    width: u32,
    height: u32,
    /// Numbers of fragments and their buffers, a chunk each.
    chunks: Vec<(u32, wgpu::BindGroup)>,
    targets: Vec<(Target, wgpu::TextureView)>,
    weighted: wgpu::TextureView,
    image: wgpu::Texture,
    pass1: Vec<(wgpu::RenderPipeline, Vec<usize>)>,
    pass2: wgpu::RenderPipeline,
    resolve: wgpu::RenderPipeline,
    frame: wgpu::BindGroup,
    state: wgpu::BindGroup,
    result: wgpu::BindGroup,
    /// Cores, where the method keeps them, and their bind groups in pass 1 and pass 2.
    core: Option<(wgpu::Buffer, [wgpu::BindGroup; 2])>,
}

/// Seconds of a frame's passes; see [`Gpu::timed`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameSeconds {
    /// Pass 1, all its draws.
    pub accumulate: f64,
    /// Pass 2.
    pub weights: f64,
    /// Resolve; 0 where pass 2 makes the colour itself.
    pub resolve: f64,
}

/// An image as the GPU made it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear colours, row by row from the top, neither clamped nor checked.
    pub pixels: Vec<[f32; 3]>,
    /// How long its passes took.
    pub seconds: FrameSeconds,
}

/// What [`crate::gpu::GpuError::Lacks`] says where f32 targets cannot be blended into.
const BLENDING: &str = "float32-blendable, blending into f32 render targets. Store sums as f16 \
    (pipeline::TargetPrecision::Half, for networks), let compute passes \
    add them up (gpu::tiles, which needs no blending), or choose another adapter with WGPU_ADAPTER_NAME";

/// What it says where the fragment stage has no atomics on buffers.
const ATOMICS: &str = "atomic operations on storage buffers in the fragment stage, by which a core is kept. Let \
    compute \
    passes keep it (gpu::tiles), or choose another adapter with WGPU_ADAPTER_NAME";

impl Pipeline {
    /// Makes a method ready. `range` is what its depths are measured by; see [`MethodShader::depth_range`].
    ///
    /// # Errors
    /// [`GpuError::Lacks`] where the device cannot blend into f32 targets, and [`GpuError::Refused`].
    pub fn new(
        gpu: &Gpu,
        list: &DeviceList,
        method: &MethodShader,
        range: [f32; 2],
        background: [f32; 3],
        precision: TargetPrecision,
    ) -> Result<Self, GpuError> {
        Self::within(gpu, list, method, range, background, precision, limits_of(gpu))
    }

    fn within(
        gpu: &Gpu,
        list: &DeviceList,
        method: &MethodShader,
        range: [f32; 2],
        background: [f32; 3],
        precision: TargetPrecision,
        limits: Limits,
    ) -> Result<Self, GpuError> {
        refuse(gpu, list, method, precision)?;
        let (width, height) = list.image_size()?;
        let core = match method.needs_atomics() {
            true => upload::core(gpu, method, list.pixels)?,
            false => None,
        };
        let shaders = Shaders::new(method, precision, limits);
        gpu.checked(&method.name, || {
            let layouts = Layouts::new(gpu, &shaders.targets, method.needs_atomics());
            let read = wgpu::TextureUsages::TEXTURE_BINDING;
            let texture = |label, format, usage| texture(gpu, label, (width, height), format, usage);
            let view = |label, format| texture(label, format, read).create_view(&Default::default());
            let view_of = |target: &Target| view("pass 1", format_of(*target));
            let views: Vec<_> = shaders.targets.iter().map(view_of).collect();
            let weighted = view("pass 2", format_of(weighted_target(precision)));

            let chunk = |chunk: &Chunk| {
                let buffers = [&chunk.pixel_of, &chunk.view_z, &chunk.alpha, &chunk.color];
                let resources = buffers.map(wgpu::Buffer::as_entire_binding).to_vec();
                (chunk.fragments, group(gpu, "fragments", &layouts.fragments, resources))
            };
            let scale = scale_below_1(list.greatest);
            let frame = frame(gpu, method, range, (width, height), background, scale);
            let state = views.iter().map(wgpu::BindingResource::TextureView).collect();
            let result = vec![wgpu::BindingResource::TextureView(&weighted)];
            let Pipelines { pass1, pass2, resolve } = Pipelines::new(gpu, &shaders, &layouts, precision);
            Self {
                name: method.name.clone(),
                width,
                height,
                chunks: list.chunks.iter().filter(|c| c.fragments > 0).map(chunk).collect(),
                pass1,
                pass2,
                resolve,
                frame: group(gpu, "frame", &layouts.frame, vec![frame.as_entire_binding()]),
                state: group(gpu, "what pass 1 left", &layouts.state, state),
                result: group(gpu, "weighted colour", &layouts.weighted, result),
                core: core.zip(layouts.cores.as_ref()).map(|(buffer, layouts)| {
                    let bound = |layout| group(gpu, "cores", layout, vec![buffer.as_entire_binding()]);
                    let groups = layouts.each_ref().map(bound);
                    (buffer, groups)
                }),
                image: texture("image", Rgba32Float, wgpu::TextureUsages::COPY_SRC),
                targets: shaders.targets.into_iter().zip(views).collect(),
                weighted,
            }
        })
    }

    /// Draws the frame, waits for it, and says how long its passes took; see [`Gpu::timed`].
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn run(&self, gpu: &Gpu) -> Result<FrameSeconds, GpuError> {
        let draws = self.pass1.len();
        let seconds = gpu.timed(&self.name, draws + 2, |index, encoder, stamps| {
            match self.pass1.get(index) {
                Some((pipeline, written)) => {
                    let color = written
                        .iter()
                        .map(|&i| &self.targets[i])
                        .filter(|(target, _)| !target.is_depth());
                    let attachments: Vec<_> = color
                        .map(|(target, view)| attachment(view, clear_of(*target)))
                        .collect();
                    let (first, view) = &self.targets[written[0]];
                    let depth = first.is_depth().then(|| wgpu::RenderPassDepthStencilAttachment {
                        view,
                        // Of no fragment: behind all, and before all.
                        depth_ops: Some(wgpu::Operations {
                            load: wgpu::LoadOp::Clear(if first.holds == Holds::Nearest { 1.0 } else { 0.0 }),
                            store: wgpu::StoreOp::Store,
                        }),
                        stencil_ops: None,
                    });
                    let core = self.core.as_ref().filter(|_| index == 0);
                    if let Some((buffer, _)) = core {
                        encoder.clear_buffer(buffer, 0, None);
                    }
                    let mut pass = begin(encoder, "pass 1", &attachments, depth, stamps);
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(0, &self.frame, &[]);
                    if let Some((_, groups)) = core {
                        pass.set_bind_group(3, &groups[0], &[]);
                    }
                    self.draw(&mut pass);
                }
                None if index == draws => {
                    let mut pass = begin(
                        encoder,
                        "pass 2",
                        &[attachment(&self.weighted, wgpu::Color::TRANSPARENT)],
                        None,
                        stamps,
                    );
                    pass.set_pipeline(&self.pass2);
                    pass.set_bind_group(0, &self.frame, &[]);
                    pass.set_bind_group(2, &self.state, &[]);
                    if let Some((_, groups)) = &self.core {
                        pass.set_bind_group(3, &groups[1], &[]);
                    }
                    self.draw(&mut pass);
                }
                None => {
                    let view = self.image.create_view(&Default::default());
                    let mut pass = begin(
                        encoder,
                        "resolve",
                        &[attachment(&view, wgpu::Color::TRANSPARENT)],
                        None,
                        stamps,
                    );
                    pass.set_pipeline(&self.resolve);
                    pass.set_bind_group(0, &self.frame, &[]);
                    pass.set_bind_group(1, &self.result, &[]);
                    pass.set_bind_group(2, &self.state, &[]);
                    pass.draw(0..3, 0..1);
                }
            }
        })?;
        Ok(FrameSeconds {
            accumulate: seconds[..draws].iter().sum(),
            weights: seconds[draws],
            resolve: seconds[draws + 1],
        })
    }

    /// Draws the frame and fetches it.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn render(&self, gpu: &Gpu) -> Result<Rendered, GpuError> {
        let seconds = self.run(gpu)?;
        Ok(Rendered {
            width: self.width,
            height: self.height,
            pixels: self.image(gpu)?,
            seconds,
        })
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for (fragments, group) in &self.chunks {
            pass.set_bind_group(1, group, &[]);
            pass.draw(0..*fragments, 0..1);
        }
    }

    /// The image, once it is drawn.
    ///
    /// # Shapes
    /// `[height * width]`, row by row from the top.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn image(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>, GpuError> {
        // Rows of a copy start at multiples of 256 bytes. A few rows at a time keep the buffer small.
        let (width, height) = (self.width, self.height);
        let row = (16 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let band = (u32::pow(2, 26) / row).clamp(1, height);
        let buffer = gpu.zeros("image", u64::from(row) * u64::from(band))?;
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for first in (0..height).step_by(band as usize) {
            let rows = band.min(height - first);
            gpu.checked("image", || {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                encoder.copy_texture_to_buffer(
                    wgpu::TexelCopyTextureInfo {
                        texture: &self.image,
                        mip_level: 0,
                        origin: wgpu::Origin3d { x: 0, y: first, z: 0 },
                        aspect: wgpu::TextureAspect::All,
                    },
                    wgpu::TexelCopyBufferInfo {
                        buffer: &buffer,
                        layout: wgpu::TexelCopyBufferLayout {
                            offset: 0,
                            bytes_per_row: Some(row),
                            rows_per_image: None,
                        },
                    },
                    wgpu::Extent3d {
                        width,
                        height: rows,
                        depth_or_array_layers: 1,
                    },
                );
                gpu.queue.submit([encoder.finish()]);
            })?;
            let texels: Vec<[f32; 4]> = gpu.download(&buffer, (row / 16 * rows) as usize)?;
            pixels.extend(
                texels
                    .chunks_exact(row as usize / 16)
                    .flat_map(|row| &row[..width as usize])
                    .map(|&[r, g, b, _]| [r, g, b]),
            );
        }
        Ok(pixels)
    }
}

fn attachment(view: &wgpu::TextureView, clear: wgpu::Color) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let ops = wgpu::Operations {
        load: wgpu::LoadOp::Clear(clear),
        store: wgpu::StoreOp::Store,
    };
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops,
    })
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    attachments: &[Option<wgpu::RenderPassColorAttachment<'_>>],
    depth_stencil_attachment: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    stamps: Stamps<'_>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: attachments,
        depth_stencil_attachment,
        timestamp_writes: stamps.render(),
        ..Default::default()
    })
}

#[allow(clippy::too_many_arguments)]
fn render_pipeline(
    gpu: &Gpu,
    label: &str,
    source: &str,
    [vertex, fragment]: [&str; 2],
    layout: &[Option<&wgpu::BindGroupLayout>],
    topology: wgpu::PrimitiveTopology,
    depth: Option<wgpu::CompareFunction>,
    targets: &[Option<wgpu::ColorTargetState>],
) -> wgpu::RenderPipeline {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: layout,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState {
            topology,
            ..Default::default()
        },
        depth_stencil: depth.map(|compare| wgpu::DepthStencilState {
            format: Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws a list with a method in render passes. The camera's planes and the depth range are the list's own where none
/// are given.
///
/// # Accuracy
/// Sums are f32, added in the order in which fragments are drawn. Against the CPU's image, whose features are f64, no
/// channel of 99.9 % of the pixels is off by more than 1e-3; test `the_image_is_the_cpu_evaluators`.
///
/// # Errors
/// [`GpuError::NoImage`] where the list makes none, [`GpuError::Lacks`] where the device cannot blend into f32 targets;
/// and other [`GpuError`].
pub fn render(
    gpu: &Gpu,
    method: &MethodShader,
    list: &FragmentList,
    planes: Option<CameraPlanes>,
    depth_range: Option<(f32, f32)>,
    background: [f32; 3],
) -> Result<Rendered, GpuError> {
    let range = method.depth_range(list, planes, depth_range)?;
    let list = DeviceList::new(gpu, list)?;
    Pipeline::new(gpu, &list, method, range, background, TargetPrecision::Full)?.render(gpu)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::evaluate::gpu::channel_differences;
    use crate::evaluate::{Image, flip, image};
    use crate::export::Format;
    use crate::gpu::tests::gpu;
    use crate::model::{Mlp, file};
    use crate::oit::neural::Skip;
    use crate::oit::{Context, Method, names_with_shader, neural::Neural, shader_of, weights};
    use crate::scene;
    use std::path::Path;

    pub const GREY: [f32; 3] = [0.25, 0.5, 0.75];

    pub fn model(name: &str) -> Mlp {
        file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.json"))).unwrap()
    }

    pub fn shader(mlp: &Mlp) -> MethodShader {
        MethodShader::neural(mlp, Format::WGSL).unwrap()
    }

    pub fn built_in(name: &str, size: u32) -> FragmentList {
        scene::build(
            &scene::open(name).unwrap(),
            &scene::Options {
                size: Some((size, size)),
                seed: None,
            },
        )
        .unwrap()
    }

    pub fn cpu(mlp: &Mlp, list: &FragmentList) -> Image {
        let method = Neural::new(mlp.clone());
        let accumulated = method.accumulate(list, Context::default()).unwrap();
        image::of_method(list, &*accumulated, &weights(list, &*accumulated), GREY.map(f64::from)).unwrap()
    }

    pub fn image(list: &FragmentList, pixels: &[[f32; 3]]) -> Image {
        let (width, height) = list.size().unwrap();
        Image::new(width, height, pixels.iter().map(|p| p.map(f64::from)).collect()).unwrap()
    }

    /// Greatest channel differences of pixels, in order; NaN is infinite.
    pub fn differences(a: &Image, b: &Image) -> Vec<f64> {
        let mut all = channel_differences(a, b).unwrap();
        all.sort_by(f64::total_cmp);
        all
    }

    pub fn agree(gpu_image: &Image, cpu: &Image) -> bool {
        let d = differences(gpu_image, cpu);
        let (most, visible) = (d[d.len() * 999 / 1000], flip(cpu, gpu_image).unwrap().mean());
        println!(
            "99.9 % within {most:.1e}, all within {:.1e}, FLIP {visible:.1e}",
            d[d.len() - 1]
        );
        d.len() > 1000 && most <= 1e-3 && visible <= 0.002
    }

    /// The same pixels with the order of depths turned round: v0 v1 / v, in f32.
    pub fn turned(list: &FragmentList) -> FragmentList {
        let (v0, v1) = list.depth_range().unwrap();
        let view_z = list.view_z().iter().map(|v| v0 / v * v1).collect();
        let (width, height) = list.size().unwrap();
        let color = list.color().map(<[_]>::to_vec);
        FragmentList::new(list.offsets().to_vec(), view_z, list.alpha().to_vec(), color)
            .unwrap()
            .with_size(width, height)
            .unwrap()
    }

    /// Built-in scenes and shipped networks, 1e-3 in 99.9 % of the pixels and FLIP 0.002; the control is the same
    /// scenes with depths turned round.
    ///
    /// In a pixel of `hair` up to 160 fragments lie within a thin range, and an ulp in their depths shows: two f32
    /// passes on the CPU, one of them with the logarithm in f32, are as far apart as CPU and GPU are, 1e-3 to 2e-3 by
    /// the size of the image. So it is not among the scenes.
    #[test]
    fn the_image_is_the_cpu_evaluators() {
        let Some(gpu) = gpu() else { return };
        for (name, networks) in [
            ("teapots", &["recommended", "small"][..]),
            ("foliage", &["recommended", "moments-6"]),
            ("glass-stacks", &["small", "paper"]),
        ] {
            let list = built_in(name, 96);
            for network in networks {
                let (mlp, planes) = (model(network), list.planes());
                let cpu = cpu(&mlp, &list);
                let found = render(gpu, &shader(&mlp), &list, planes, None, GREY).unwrap();
                print!("{name}, {network}: ");
                assert!(agree(&image(&list, &found.pixels), &cpu), "{name}, {network}");
                assert!(found.seconds.weights > 0.0);
                if *network != "paper" {
                    let found = render(gpu, &shader(&mlp), &turned(&list), None, None, GREY).unwrap();
                    assert!(
                        !agree(&image(&list, &found.pixels), &cpu),
                        "{name}, {network}: turned round"
                    );
                }
            }
        }
    }

    /// Render passes: what cannot be seen changes no channel by more than 1/512 and FLIP by at most 0.0005. Control: it
    /// changes something.
    #[test]
    fn drawn_frames_leave_out_what_cannot_be_seen() {
        let Some(gpu) = gpu() else { return };
        for name in ["foliage", "hair"] {
            let (list, method) = (built_in(name, 64), shader(&model("recommended")));
            let draw = |skip| {
                image(
                    &list,
                    &render(gpu, &method.clone().with_skip(skip), &list, None, None, GREY)
                        .unwrap()
                        .pixels,
                )
            };
            let [exact, visible] = [Skip::Exact, Skip::Visible].map(draw);
            let worst = differences(&visible, &exact)[list.pixels() - 1];
            println!("{name}: {worst:.1e}");
            assert!(
                worst <= 1.0 / 512.0 && worst > 0.0 && flip(&exact, &visible).unwrap().mean() <= 5e-4,
                "{name}: {worst}"
            );
        }
    }

    /// A list of few pixels, seen before [`GREY`].
    pub fn few(width: u32, pixels: &[&[(f32, f32)]]) -> FragmentList {
        let all = pixels.concat();
        let offsets = (0..=pixels.len())
            .map(|p| pixels[..p].iter().map(|p| p.len() as u64).sum())
            .collect();
        let color = (0..all.len())
            .map(|i| [i as f32 * 0.37 % 1.0, i as f32 * 0.71 % 1.0, 0.5])
            .collect();
        let (view_z, alpha) = all.into_iter().unzip();
        FragmentList::new(offsets, view_z, alpha, Some(color))
            .unwrap()
            .with_size(width, pixels.len() as u32 / width)
            .unwrap()
    }

    /// Pixels that are easily got wrong.
    pub fn odd() -> FragmentList {
        few(
            3,
            &[
                &[],
                &[(2.0, 0.5)],
                &[(2.0, 0.0)],
                &[(3.0, 1.0)],
                &[(2.0, 0.5), (2.0, 0.5), (2.0, 0.5), (2.0, 0.5)],
                &[(4.0, 0.5), (1.0, 1.0), (2.0, 0.25)],
                &[(1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (2.5, 0.0), (2.25, 0.0)],
                &[(1.0, 1.0), (2.0, 1.0), (3.0, 1.0)],
                &[(1.0, 1e-8), (2.0, 1e-8)],
                &[(1.0, 0.0), (5.0, 0.7)],
                &[(1.0, 0.3), (1.0, 0.6), (4.0, 0.9)],
                &[],
            ],
        )
    }

    /// Every pixel of [`odd`] follows from the exact rules, so that the CPU's image is met to 1e-6; control: another
    /// background.
    #[test]
    fn odd_pixels_are_exact() {
        let Some(gpu) = gpu() else { return };
        let (list, mlp) = (odd(), model("small"));
        let cpu = cpu(&mlp, &list);
        let worst = |background| {
            let found = render(gpu, &shader(&mlp), &list, None, None, background).unwrap();
            assert_eq!((found.width, found.height), (3, 4));
            differences(&image(&list, &found.pixels), &cpu)[11]
        };
        assert!(worst(GREY) <= 1e-6, "{:e}", worst(GREY));
        assert!(worst([0.25, 0.5, 0.7]) > 0.04);
        let nothing = few(2, &[&[], &[]]);
        assert_eq!(
            render(gpu, &shader(&mlp), &nothing, None, None, GREY).unwrap().pixels,
            [GREY; 2]
        );
    }

    fn drawn(
        gpu: &Gpu,
        method: &MethodShader,
        list: &FragmentList,
        limits: Limits,
        chunk: usize,
        precision: TargetPrecision,
    ) -> (usize, Vec<[f32; 3]>) {
        let on_device = DeviceList::in_chunks(gpu, list, chunk).unwrap();
        let range = method.depth_range(list, None, None).unwrap();
        let pipeline = Pipeline::within(gpu, &on_device, method, range, GREY, precision, limits).unwrap();
        pipeline.run(gpu).unwrap();
        (pipeline.pass1.len(), pipeline.image(gpu).unwrap())
    }

    /// Pass 1 split over draws, and a list split over buffers, give the same bits.
    #[test]
    fn limits_change_no_bit() {
        let Some(gpu) = gpu() else { return };
        let list = built_in("spheres", 48);
        for (network, default, narrow) in [("recommended", 1, 3), ("moments-6", 2, 3)] {
            let method = shader(&model(network));
            let f32s = TargetPrecision::Full;
            let whole = drawn(gpu, &method, &list, limits_of(gpu), usize::MAX, f32s);
            let split = drawn(gpu, &method, &list, Limits::WEBGPU, list.len() / 3, f32s);
            let least = drawn(
                gpu,
                &method,
                &list,
                Limits {
                    bytes_per_pixel: 16,
                    targets: 1,
                },
                1000,
                f32s,
            );
            assert_eq!((split.0, least.0), (default, narrow), "{network}");
            assert!(whole.1 == split.1 && whole.1 == least.1, "{network}");
        }
    }

    /// Order in which the fragments of a pixel are drawn: rounding alone, 1e-3 in 99.9 % of the pixels.
    #[test]
    fn any_order_will_do() {
        let Some(gpu) = gpu() else { return };
        let (list, method) = (built_in("spheres", 48), shader(&model("recommended")));
        let order: Vec<usize> = (0..list.pixels()).flat_map(|p| list.range(p).rev()).collect();
        let pick = |values: &[f32]| order.iter().map(|&i| values[i]).collect::<Vec<_>>();
        let color = order.iter().map(|&i| list.color().unwrap()[i]).collect();
        let other = FragmentList::new(
            list.offsets().to_vec(),
            pick(list.view_z()),
            pick(list.alpha()),
            Some(color),
        )
        .unwrap();
        let other = other.with_size(48, 48).unwrap();
        let draw = |list| image(list, &render(gpu, &method, list, None, None, GREY).unwrap().pixels);
        assert!(agree(&draw(&other), &draw(&list)));
    }

    /// 16-bit colour sums round to 11 bits a fragment: within 0.01 in 99.9 % of the pixels. Control: they do round.
    #[test]
    fn colour_sums_may_have_16_bits() {
        let Some(gpu) = gpu() else { return };
        let (list, method) = (built_in("spheres", 48), shader(&model("recommended")));
        let draw = |storage| {
            image(
                &list,
                &drawn(gpu, &method, &list, limits_of(gpu), usize::MAX, storage).1,
            )
        };
        let d = differences(&draw(TargetPrecision::HalfColor), &draw(TargetPrecision::Full));
        let most = d[d.len() * 999 / 1000];
        println!("99.9 % within {most:.1e}");
        assert!(most <= 0.01 && most > 1e-6, "{most:e}");
    }

    /// All sums as f16, on a device that does not blend f32: the range is exact, so that what is exact stays so to 16
    /// bits, and the image MSE of `foliage` grows by less than a third. Control: storage as f16 is not that of f32.
    #[test]
    fn half_storage_costs_little() {
        if gpu().is_none() {
            return;
        }
        let poor = Gpu::open_without(wgpu::Features::FLOAT32_BLENDABLE).unwrap();
        let (list, method) = (built_in("foliage", 96), shader(&model("recommended")));
        let exact = image::ground_truth(&list, GREY.map(f64::from)).unwrap();
        let mse = |pixels: &[[f32; 3]]| image(&list, pixels).error(&exact).unwrap().mse();
        let half = mse(&drawn(&poor, &method, &list, Limits::WEBGPU, usize::MAX, TargetPrecision::Half).1);
        let full = mse(&crate::gpu::tiles::render(&poor, &method, &list, None, None, GREY)
            .unwrap()
            .pixels);
        println!("image MSE {half:.3e} with f16, {full:.3e} with f32");
        assert!(half > full && half < 1.33 * full, "{half:e} {full:e}");
        let odd = odd();
        let d = differences(
            &image(
                &odd,
                &drawn(&poor, &method, &odd, Limits::WEBGPU, usize::MAX, TargetPrecision::Half).1,
            ),
            &cpu(&model("recommended"), &odd),
        );
        assert!(d[11] <= 4e-3, "{:e}", d[11]);
    }

    /// v below 1, and back, without losing a bit.
    #[test]
    fn depth_buffers_keep_every_bit() {
        for v in [
            1e-30f32,
            0.1,
            0.5,
            0.999_999_94,
            1.0,
            1.000_000_1,
            2.0,
            7.3,
            1e6,
            1e30,
            MAX_SCALED.next_down(),
        ] {
            let scale = scale_below_1(v);
            assert!((0.5..1.0).contains(&(v * scale)), "{v:e}");
            for v in [v, v * 0.37, v * 1e-3] {
                assert_eq!((v * scale * scale.recip()).to_bits(), v.to_bits(), "{v:e}");
            }
        }
    }

    /// The shaders of every shipped network and classic method are valid WGSL, device or none; control: a method
    /// without its weight is not.
    #[test]
    fn shaders_validate() {
        let validate = |source: &str| {
            let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
            let mut validator =
                naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
            validator
                .validate(&module)
                .map(drop)
                .map_err(|e| e.emit_to_string(source))
        };
        let networks = ["recommended", "small", "moments-6", "paper"].map(|name| shader(&model(name)));
        let classic = names_with_shader().into_iter().map(|name| shader_of(&name).unwrap());
        let skipping = [shader(&model("recommended")).with_skip(Skip::Visible)];
        for method in networks.into_iter().chain(classic).chain(skipping) {
            for limits in [
                Limits::WEBGPU,
                Limits {
                    bytes_per_pixel: 16,
                    targets: 1,
                },
                Limits {
                    bytes_per_pixel: 128,
                    targets: 8,
                },
            ] {
                for storage in TargetPrecision::ALL {
                    let shaders = Shaders::new(&method, storage, limits);
                    let sources = shaders
                        .pass1
                        .iter()
                        .map(|p| &p.0)
                        .chain([&shaders.pass2, &shaders.resolve]);
                    sources.for_each(|source| validate(source).unwrap());
                }
            }
            let whole = Shaders::new(&method, TargetPrecision::Full, Limits::WEBGPU).pass2;
            let broken = whole.replace(&format!("fn {}(", method.weight), "fn oit_wait(");
            assert!(broken != whole && validate(&broken).is_err(), "{}", method.name);
        }
    }

    /// Classic methods by their twins. Those that add up no moments are the CPU's to 1e-4 everywhere; of moments in
    /// f32, which the CPU has in f64, 99 % of the pixels are within 0.03: trigonometric ones feel the rounding.
    /// Control: the scene with depths turned round, for those that look at depth.
    #[test]
    fn classic_methods_are_drawn_too() {
        let Some(gpu) = gpu() else { return };
        let list = built_in("spheres", 64);
        let methods = [
            "weighted-sum",
            "weighted-average",
            "weighted-blended",
            "moment-power-4",
            "moment-trig-4",
            "moment-power-6+own",
        ];
        for name in methods {
            let method = crate::oit::parse(name).unwrap();
            let accumulated = method.accumulate(&list, Context::default()).unwrap();
            let cpu = image::of_method(
                &list,
                &*accumulated,
                &weights(&list, &*accumulated),
                GREY.map(f64::from),
            )
            .unwrap();
            let method = shader_of(name).unwrap();
            let off = |list: &FragmentList| {
                let d = differences(
                    &image(list, &render(gpu, &method, list, None, None, GREY).unwrap().pixels),
                    &cpu,
                );
                (d[d.len() * 99 / 100], d[d.len() - 1])
            };
            let (most, worst) = off(&list);
            println!("{name}: 99 % within {most:.1e}, all within {worst:.1e}");
            let (bar, all) = if name.starts_with("moment") {
                (0.03, f64::INFINITY)
            } else {
                (1e-4, 1e-4)
            };
            assert!(most <= bar && worst <= all, "{name}: {most:e} {worst:e}");
            assert!(
                name == "weighted-sum" || name == "weighted-average" || off(&turned(&list)).0 > bar,
                "{name}"
            );
        }
    }

    /// Four moments fit the limits of every device in one draw, six take two.
    #[test]
    fn targets_of_the_shipped_networks() {
        let formats = |network: &str| {
            Target::of(&shader(&model(network)), TargetPrecision::Full)
                .iter()
                .map(|&t| format_of(t))
                .collect::<Vec<_>>()
        };
        assert_eq!(formats("recommended"), [Rgba32Float, Rg32Float, Rg32Float]);
        assert_eq!(formats("moments-6"), [Rgba32Float, Rgba32Float, Rg32Float]);
        let bytes: u32 = Target::of(&shader(&model("recommended")), TargetPrecision::Full)
            .iter()
            .map(|t| t.bytes())
            .sum();
        assert_eq!(bytes, Limits::WEBGPU.bytes_per_pixel);
        let bare = MethodShader {
            sums: 1,
            range: false,
            ..shader(&model("small"))
        };
        assert_eq!(
            Target::of(&bare, TargetPrecision::Full),
            [Target {
                channels: 1,
                channel: Channel::F32,
                holds: Holds::Added { first: 0, count: 1 }
            }]
        );
    }

    /// Lists that make no image, and a device that does not blend.
    #[test]
    fn errors_say_what_is_missing() {
        let Some(gpu) = gpu() else { return };
        let bare = FragmentList::new(vec![0, 1], vec![1.0], vec![0.5], None).unwrap();
        let none = FragmentList::new(vec![0], vec![], vec![], None)
            .unwrap()
            .with_size(0, 3)
            .unwrap();
        let message = |list: &FragmentList| {
            DeviceList::new(gpu, list)
                .unwrap()
                .image_size()
                .unwrap_err()
                .to_string()
        };
        assert!(message(&bare).contains("width"), "{}", message(&bare));
        assert!(message(&bare.clone().with_size(1, 1).unwrap()).contains("color"));
        assert!(message(&none).contains("0 x 3"));
        let poor = Gpu::open_without(wgpu::Features::FLOAT32_BLENDABLE).unwrap();
        let error = render(&poor, &shader(&model("small")), &odd(), None, None, GREY)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("float32-blendable") && error.contains("gpu::tiles"),
            "{error}"
        );
    }
}
