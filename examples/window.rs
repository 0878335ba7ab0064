//! A window that draws a built-in scene with the passes of `shaders/recommended/webgpu`, as they stand there.
//!
//! ```sh
//! cargo run --release --example window -- foliage
//! # drag to turn, wheel to come nearer, 1 to 7 for other scenes
//! cargo run --release --example window -- spheres --picture spheres.png      # the same without a window
//! ```
//!
//! What is the renderer's own is short: [`VERTEX`] hands v on, [`Renderer`] makes three targets for pass 1 and one for
//! pass 2, and draws the transparent triangles twice between the opaque ones and the resolve.

use nmt::scene::{self, BUILT_IN, Geometry};
use std::sync::Arc;
use std::time::Instant;
use wgpu::util::DeviceExt;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::Key;
use winit::window::{Window, WindowId};

const PASS1: &str = include_str!("../shaders/recommended/webgpu/pass1.wgsl");
const PASS2: &str = include_str!("../shaders/recommended/webgpu/pass2.wgsl");
const RESOLVE: &str = include_str!("../shaders/recommended/webgpu/resolve.wgsl");

/// The vertex stage of both passes; `Varying` is that of the files.
const VERTEX: &str = "
struct Camera { view: mat4x4<f32>, projection: mat4x4<f32> }
@group(0) @binding(1) var<uniform> camera: Camera;

@vertex
fn surface(@location(0) place: vec3<f32>, @location(1) offset: vec2<f32>, @location(2) color: vec4<f32>) -> Varying {
    // Particles face the camera: their corners are offsets in view space.
    let in_view = camera.view * vec4<f32>(place, 1.0) + vec4<f32>(offset, 0.0, 0.0);
    return Varying(camera.projection * in_view, -in_view.z, color);
}
";

/// Opaque surfaces, with the same vertex stage.
const OPAQUE: &str = "
struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) v: f32,
    @location(1) color: vec4<f32>,
}

@fragment
fn opaque_surface(in: Varying) -> @location(0) vec4<f32> {
    return vec4<f32>(in.color.rgb, 1.0);
}
";

const SUMS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
const PAIR: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
const WEIGHTED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const NEAR: f32 = 0.05;
const BACKGROUND: wgpu::Color = wgpu::Color {
    r: 0.75,
    g: 0.8,
    b: 0.88,
    a: 1.0,
};

/// A corner of a triangle: place, offset in view space, colour that is not premultiplied, alpha.
type Corner = [f32; 9];

/// A scene as triangles, the opaque ones first.
struct Scene {
    name: &'static str,
    corners: Vec<Corner>,
    /// Corners of opaque triangles.
    opaque: u32,
    center: [f32; 3],
    radius: f32,
}

impl Scene {
    fn new(name: &'static str) -> Self {
        let seen = scene::open(name).and_then(|s| s.geometry());
        let (geometry, _) = seen.expect("a built-in scene, of which nothing is left out");
        let Geometry {
            triangles, particles, ..
        } = geometry;
        let (mut opaque, mut clear): (Vec<Corner>, Vec<Corner>) = (Vec::new(), Vec::new());
        for triangle in &triangles {
            let corners = triangle.map(|corner| {
                let ([x, y, z], [r, g, b, a]) = (corner.position, corner.rgba);
                [x, y, z, 0.0, 0.0, r, g, b, a]
            });
            let list = if corners.iter().all(|c| c[8] >= 1.0) {
                &mut opaque
            } else {
                &mut clear
            };
            list.extend(corners);
        }
        // A particle is a disk of rings, alpha a (1 - r^2/R^2)^2 at their corners.
        const RINGS: usize = 4;
        const SIDES: usize = 12;
        for p in &particles {
            let corner = |ring: usize, side: usize| -> Corner {
                let (r, angle) = (
                    ring as f32 / RINGS as f32,
                    side as f32 / SIDES as f32 * std::f32::consts::TAU,
                );
                let ([x, y, z], [red, green, blue, a]) = (p.position, p.rgba);
                let alpha = a * (1.0 - r * r) * (1.0 - r * r);
                let (up, right) = angle.sin_cos();
                [
                    x,
                    y,
                    z,
                    p.radius * r * right,
                    p.radius * r * up,
                    red,
                    green,
                    blue,
                    alpha,
                ]
            };
            for ring in 0..RINGS {
                for side in 0..SIDES {
                    let [a, b] = [corner(ring, side), corner(ring, side + 1)];
                    let [c, d] = [corner(ring + 1, side), corner(ring + 1, side + 1)];
                    clear.extend([a, c, d]);
                    if ring > 0 {
                        clear.extend([a, d, b]);
                    }
                }
            }
        }
        // The floor may be wide: what is looked at is what is transparent.
        let mut ends = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        for c in &clear {
            for axis in 0..3 {
                ends[0][axis] = ends[0][axis].min(c[axis] - reach(c));
                ends[1][axis] = ends[1][axis].max(c[axis] + reach(c));
            }
        }
        let center = [0, 1, 2].map(|i| 0.5 * (ends[0][i] + ends[1][i]));
        let radius = (0..3).map(|i| (ends[1][i] - center[i]).powi(2)).sum::<f32>().sqrt();
        let count = opaque.len() as u32;
        opaque.extend(clear);
        Self {
            name,
            corners: opaque,
            opaque: count,
            center,
            radius,
        }
    }
}

/// How far a corner reaches from its place.
fn reach(corner: &Corner) -> f32 {
    corner[3].hypot(corner[4])
}

/// A camera that looks at the middle of a scene.
#[derive(Clone, Copy)]
struct Orbit {
    /// About the vertical axis, and above the horizon [radians].
    angles: [f32; 2],
    /// Distance from the middle, in radii of the scene.
    distance: f32,
}

impl Orbit {
    const START: Self = Self {
        angles: [0.4, 0.35],
        distance: 2.6,
    };

    /// View and projection matrix, column by column, and the least and greatest v of the scene.
    fn matrices(self, scene: &Scene, aspect: f32) -> ([[[f32; 4]; 4]; 2], [f32; 2]) {
        let ((s, c), (up_s, up_c)) = (self.angles[0].sin_cos(), self.angles[1].sin_cos());
        let far = self.distance * scene.radius;
        let (right, up, back) = ([c, 0.0, -s], [-s * up_s, up_c, -c * up_s], [s * up_c, up_s, c * up_c]);
        let dot = |a: [f32; 3]| -(0..3).map(|i| a[i] * scene.center[i]).sum::<f32>();
        let column = |i: usize| [right[i], up[i], back[i], 0.0];
        let view = [
            column(0),
            column(1),
            column(2),
            [dot(right), dot(up), dot(back) - far, 1.0],
        ];
        let focal = 1.0 / (0.5 * 40f32.to_radians()).tan();
        let end = far + 20.0 * scene.radius;
        let (a, b) = (end / (NEAR - end), NEAR * end / (NEAR - end));
        let projection = [
            [focal / aspect, 0.0, 0.0, 0.0],
            [0.0, focal, 0.0, 0.0],
            [0.0, 0.0, a, -1.0],
            [0.0, 0.0, b, 0.0],
        ];
        ([view, projection], [(far - scene.radius).max(NEAR), far + scene.radius])
    }
}

/// Targets of the size of the image.
struct Targets {
    depth: wgpu::TextureView,
    sums: [wgpu::TextureView; 3],
    weighted: wgpu::TextureView,
    /// What pass 2 and the resolve read.
    read_by_pass2: wgpu::BindGroup,
    read_by_resolve: wgpu::BindGroup,
}

struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: String,
    opaque: wgpu::RenderPipeline,
    pass1: wgpu::RenderPipeline,
    pass2: wgpu::RenderPipeline,
    resolve: wgpu::RenderPipeline,
    frame: wgpu::Buffer,
    camera: wgpu::Buffer,
    uniforms: wgpu::BindGroup,
    textures: [wgpu::BindGroupLayout; 2],
    targets: Option<((u32, u32), Targets)>,
    vertices: Option<(&'static str, wgpu::Buffer)>,
}

impl Renderer {
    async fn new(adapter: &wgpu::Adapter, format: wgpu::TextureFormat) -> Result<Self, String> {
        let name = adapter.get_info().name;
        if !adapter.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
            return Err(format!(
                "{name} cannot blend into f32 targets; docs/integration.md says what to do then"
            ));
        }
        let descriptor = wgpu::DeviceDescriptor {
            required_features: wgpu::Features::FLOAT32_BLENDABLE,
            ..Default::default()
        };
        let (device, queue) = adapter.request_device(&descriptor).await.map_err(|e| e.to_string())?;

        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty,
            count: None,
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let layout = |entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries })
        };
        let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
        let uniforms = layout(&[entry(0, fragment, uniform), entry(1, vertex, uniform)]);
        let sums = layout(&[0, 1, 2].map(|i| entry(i, fragment, texture)));
        let both = layout(&[0, 1].map(|i| entry(i, fragment, texture)));

        let add = |format| blended(format, wgpu::BlendOperation::Add, wgpu::BlendFactor::One);
        let mut over = blended(format, wgpu::BlendOperation::Add, wgpu::BlendFactor::SrcAlpha);
        if let Some(blend) = over.as_mut().and_then(|target| target.blend.as_mut()) {
            // The image keeps its own alpha.
            (blend.alpha.src_factor, blend.alpha.dst_factor) = (wgpu::BlendFactor::Zero, wgpu::BlendFactor::One);
        }
        let plain = Some(wgpu::ColorTargetState {
            format,
            blend: None,
            write_mask: wgpu::ColorWrites::ALL,
        });
        let range = blended(PAIR, wgpu::BlendOperation::Max, wgpu::BlendFactor::One);
        let make = |source: &str, entries, layouts: &[_], depth, targets: &[_]| {
            pipeline(&device, source, entries, layouts, depth, targets)
        };
        let surfaces = |source: &str| format!("{source}{VERTEX}");
        let (write, test) = (Some(true), Some(false));
        let opaque = make(
            &surfaces(OPAQUE),
            ["surface", "opaque_surface"],
            &[Some(&uniforms)],
            write,
            &[plain],
        );
        let pass1_targets = [add(SUMS), add(PAIR), range];
        let pass1 = make(
            &surfaces(PASS1),
            ["surface", "pass1"],
            &[Some(&uniforms)],
            test,
            &pass1_targets,
        );
        let pass2_layouts = [Some(&uniforms), Some(&sums)];
        let pass2 = make(
            &surfaces(PASS2),
            ["surface", "pass2"],
            &pass2_layouts,
            test,
            &[add(WEIGHTED)],
        );
        let resolve = make(RESOLVE, ["everywhere", "resolve"], &[Some(&both)], None, &[over]);

        let buffer = |size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let (frame, camera) = (buffer(16), buffer(128));
        let bindings = [(0, frame.as_entire_binding()), (1, camera.as_entire_binding())];
        let group = group(&device, &uniforms, bindings);
        Ok(Self {
            adapter: name,
            opaque,
            pass1,
            pass2,
            resolve,
            frame,
            camera,
            uniforms: group,
            textures: [sums, both],
            targets: None,
            vertices: None,
            device,
            queue,
        })
    }

    /// Targets for an image of this size, kept until the size changes.
    fn prepare(&mut self, size: (u32, u32), scene: &Scene) {
        if self.targets.as_ref().is_none_or(|(made_for, _)| *made_for != size) {
            let texture = |format| {
                let descriptor = wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d {
                        width: size.0,
                        height: size.1,
                        depth_or_array_layers: 1,
                    },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                    view_formats: &[],
                };
                self.device.create_texture(&descriptor).create_view(&Default::default())
            };
            let (sums, weighted) = ([SUMS, PAIR, PAIR].map(texture), texture(WEIGHTED));
            let read = wgpu::BindingResource::TextureView;
            let of_pass1 = [(0, read(&sums[0])), (1, read(&sums[1])), (2, read(&sums[2]))];
            let of_both = [(0, read(&sums[0])), (1, read(&weighted))];
            let targets = Targets {
                depth: texture(DEPTH),
                read_by_pass2: group(&self.device, &self.textures[0], of_pass1),
                read_by_resolve: group(&self.device, &self.textures[1], of_both),
                sums,
                weighted,
            };
            self.targets = Some((size, targets));
        }
        if self.vertices.as_ref().is_none_or(|(name, _)| *name != scene.name) {
            let buffer = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytemuck::cast_slice(scene.corners.as_flattened()),
                usage: wgpu::BufferUsages::VERTEX,
            });
            self.vertices = Some((scene.name, buffer));
        }
    }

    /// Draws a frame into an image.
    fn draw(&mut self, scene: &Scene, orbit: Orbit, size: (u32, u32), image: &wgpu::TextureView) {
        self.prepare(size, scene);
        let (Some((_, targets)), Some((_, vertices))) = (&self.targets, &self.vertices) else {
            return;
        };
        let (matrices, v_range) = orbit.matrices(scene, size.0 as f32 / size.1 as f32);
        self.queue.write_buffer(
            &self.camera,
            0,
            bytemuck::cast_slice(matrices.as_flattened().as_flattened()),
        );
        self.queue.write_buffer(&self.frame, 0, bytemuck::cast_slice(&v_range));

        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass =
            |pipeline, colors: &[_], depth: Option<wgpu::LoadOp<f32>>, read, corners: std::ops::Range<u32>| {
                let depth_stencil_attachment = depth.map(|load| wgpu::RenderPassDepthStencilAttachment {
                    view: &targets.depth,
                    depth_ops: Some(wgpu::Operations {
                        load,
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                });
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    color_attachments: colors,
                    depth_stencil_attachment,
                    ..Default::default()
                });
                pass.set_pipeline(pipeline);
                for (index, group) in read {
                    pass.set_bind_group(index, group, &[]);
                }
                pass.set_vertex_buffer(0, vertices.slice(..));
                pass.draw(corners, 0..1);
            };
        use wgpu::LoadOp::{Clear, Load};
        let nothing = wgpu::Color {
            r: -3e38,
            g: -3e38,
            b: 0.0,
            a: 0.0,
        };
        let zero = Clear(wgpu::Color::TRANSPARENT);
        let [sums0, sums1, range] = &targets.sums;
        let (opaque, clear) = (0..scene.opaque, scene.opaque..scene.corners.len() as u32);
        let of_pass1 = [
            attachment(sums0, zero),
            attachment(sums1, zero),
            attachment(range, Clear(nothing)),
        ];
        let uniforms = (0, &self.uniforms);
        pass(
            &self.opaque,
            &[attachment(image, Clear(BACKGROUND))],
            Some(Clear(1.0)),
            vec![uniforms],
            opaque,
        );
        pass(&self.pass1, &of_pass1, Some(Load), vec![uniforms], clear.clone());
        let read = vec![uniforms, (1, &targets.read_by_pass2)];
        pass(
            &self.pass2,
            &[attachment(&targets.weighted, zero)],
            Some(Load),
            read,
            clear,
        );
        pass(
            &self.resolve,
            &[attachment(image, Load)],
            None,
            vec![(0, &targets.read_by_resolve)],
            0..3,
        );
        self.queue.submit([encoder.finish()]);
    }
}

fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        },
    })
}

fn group<const N: usize>(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    bindings: [(u32, wgpu::BindingResource<'_>); N],
) -> wgpu::BindGroup {
    let entries = bindings.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}

/// A target that is blended into: source factor one, and this operation and destination factor.
fn blended(
    format: wgpu::TextureFormat,
    operation: wgpu::BlendOperation,
    dst_factor: wgpu::BlendFactor,
) -> Option<wgpu::ColorTargetState> {
    let component = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor,
        operation,
    };
    let blend = Some(wgpu::BlendState {
        color: component,
        alpha: component,
    });
    Some(wgpu::ColorTargetState {
        format,
        blend,
        write_mask: wgpu::ColorWrites::ALL,
    })
}

/// A pipeline that draws triangles; `depth` says whether depth is written, or neither tested nor written.
fn pipeline(
    device: &wgpu::Device,
    source: &str,
    [vertex, fragment]: [&str; 2],
    layouts: &[Option<&wgpu::BindGroupLayout>],
    depth: Option<bool>,
    targets: &[Option<wgpu::ColorTargetState>],
) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(source.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: layouts,
        ..Default::default()
    });
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x2, 2 => Float32x4];
    let corners = [Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<Corner>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &attributes,
    })];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: if depth.is_some() { &corners } else { &[] },
        },
        primitive: Default::default(),
        depth_stencil: depth.map(|write| wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(write),
            depth_compare: Some(wgpu::CompareFunction::LessEqual),
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

/// A frame without a window, as a PNG.
fn picture(scene: &Scene, path: &str) -> Result<(), String> {
    let (width, height) = (768, 512);
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle().with_env());
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| e.to_string())?;
    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    let mut renderer = pollster::block_on(Renderer::new(&adapter, format))?;
    let size = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let texture = renderer.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    renderer.draw(
        scene,
        Orbit::START,
        (width, height),
        &texture.create_view(&Default::default()),
    );
    // Rows of a copy are multiples of 256 bytes, and so are 768 pixels.
    let buffer = renderer.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * width * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = renderer.device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * width),
        rows_per_image: None,
    };
    let to = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout,
    };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, size);
    renderer.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("the buffer is mapped"));
    renderer
        .device
        .poll(wgpu::PollType::wait_indefinitely())
        .map_err(|e| e.to_string())?;
    let bytes = buffer.get_mapped_range(..).map_err(|e| e.to_string())?.to_vec();
    let failed = |e: &dyn std::fmt::Display| format!("{path}: {e}");
    let file = std::fs::File::create(path).map_err(|e| failed(&e))?;
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(|e| failed(&e))?;
    writer.write_image_data(&bytes).map_err(|e| failed(&e))?;
    println!("{path}: {} on {}", scene.name, renderer.adapter);
    Ok(())
}

/// The window, once there is one.
struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    renderer: Renderer,
}

struct Application {
    scene: Scene,
    orbit: Orbit,
    shown: Option<Shown>,
    /// Where the pointer was, while its button is down.
    dragged: Option<[f64; 2]>,
    pointer: [f64; 2],
    /// Frames to draw before the program ends; none to go on.
    frames: Option<u32>,
    /// Frames since the title was written, and when that was.
    since: (u32, Instant),
}

impl Application {
    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<Shown, String> {
        let attributes = Window::default_attributes().with_inner_size(PhysicalSize::new(960, 640));
        let window = Arc::new(event_loop.create_window(attributes).map_err(|e| e.to_string())?);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle().with_env());
        let surface = instance.create_surface(window.clone()).map_err(|e| e.to_string())?;
        let options = wgpu::RequestAdapterOptions {
            compatible_surface: Some(&surface),
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| e.to_string())?;
        let size = window.inner_size();
        let mut configuration = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or("the adapter cannot draw into the window")?;
        // Colours are linear: the surface's format turns them into sRGB.
        let formats = surface.get_capabilities(&adapter).formats;
        configuration.format = formats
            .iter()
            .copied()
            .find(|f| f.is_srgb())
            .unwrap_or(configuration.format);
        let renderer = pollster::block_on(Renderer::new(&adapter, configuration.format))?;
        surface.configure(&renderer.device, &configuration);
        Ok(Shown {
            window,
            surface,
            configuration,
            renderer,
        })
    }

    fn frame(&mut self, event_loop: &ActiveEventLoop) {
        let Some(Shown {
            window,
            surface,
            configuration,
            renderer,
        }) = &mut self.shown
        else {
            return;
        };
        let texture = match surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(texture) | wgpu::CurrentSurfaceTexture::Suboptimal(texture) => texture,
            _ => return surface.configure(&renderer.device, configuration),
        };
        let size = (configuration.width, configuration.height);
        renderer.draw(
            &self.scene,
            self.orbit,
            size,
            &texture.texture.create_view(&Default::default()),
        );
        window.pre_present_notify();
        renderer.queue.present(texture);
        if self.dragged.is_none() {
            self.orbit.angles[0] += 0.005;
        }
        let (count, since) = &mut self.since;
        *count += 1;
        if since.elapsed().as_secs_f32() > 1.0 {
            let rate = *count as f32 / since.elapsed().as_secs_f32();
            let name = self.scene.name;
            window.set_title(&format!("{name}: {rate:.0} frames a second on {}", renderer.adapter));
            (*count, *since) = (0, Instant::now());
        }
        if let Some(frames) = &mut self.frames {
            *frames = frames.saturating_sub(1);
            if *frames == 0 {
                event_loop.exit();
            }
        }
        window.request_redraw();
    }
}

impl ApplicationHandler for Application {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        match self.open(event_loop) {
            Ok(shown) => {
                shown.window.request_redraw();
                self.shown = Some(shown);
            }
            Err(why) => {
                eprintln!("{why}");
                std::process::exit(2);
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => {
                if let Some(Shown {
                    surface,
                    configuration,
                    renderer,
                    ..
                }) = &mut self.shown
                {
                    (configuration.width, configuration.height) = (size.width.max(1), size.height.max(1));
                    surface.configure(&renderer.device, configuration);
                }
            }
            WindowEvent::RedrawRequested => self.frame(event_loop),
            WindowEvent::MouseInput { state, .. } => {
                self.dragged = (state == ElementState::Pressed).then_some(self.pointer);
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.pointer = [position.x, position.y];
                if let Some(from) = self.dragged.replace(self.pointer).filter(|_| self.dragged.is_some()) {
                    let moved = [0, 1].map(|i| (self.pointer[i] - from[i]) as f32 * 0.008);
                    self.orbit.angles[0] -= moved[0];
                    self.orbit.angles[1] = (self.orbit.angles[1] + moved[1]).clamp(-1.5, 1.5);
                }
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let lines = match delta {
                    MouseScrollDelta::LineDelta(_, y) => y,
                    MouseScrollDelta::PixelDelta(p) => p.y as f32 / 40.0,
                };
                self.orbit.distance = (self.orbit.distance * 0.9f32.powf(lines)).clamp(0.3, 20.0);
            }
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                let Key::Character(text) = &event.logical_key else {
                    return;
                };
                if let Some(name) = text.parse::<usize>().ok().and_then(|n| BUILT_IN.get(n.wrapping_sub(1))) {
                    (self.scene, self.orbit) = (Scene::new(name), Orbit::START);
                }
            }
            _ => {}
        }
    }
}

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| {
        arguments
            .iter()
            .position(|a| a == name)
            .and_then(|at| arguments.get(at + 1))
    };
    let named = arguments
        .first()
        .filter(|a| !a.starts_with("--"))
        .map_or(BUILT_IN[0], String::as_str);
    let name = BUILT_IN.into_iter().find(|name| *name == named);
    let scene = Scene::new(name.ok_or(format!(
        "there is no scene '{named}'; known are {}",
        BUILT_IN.join(", ")
    ))?);
    if let Some(path) = option("--picture") {
        return picture(&scene, path);
    }
    let frames = match option("--frames") {
        Some(text) => Some(
            text.parse()
                .map_err(|_| format!("--frames {text}: a number is expected"))?,
        ),
        None => None,
    };
    let mut application = Application {
        scene,
        orbit: Orbit::START,
        shown: None,
        dragged: None,
        pointer: [0.0; 2],
        frames,
        since: (0, Instant::now()),
    };
    let event_loop =
        EventLoop::new().map_err(|e| format!("there is no display: {e}; --picture FILE.png needs none"))?;
    event_loop.run_app(&mut application).map_err(|e| e.to_string())
}
