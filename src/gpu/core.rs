//! The core of every pixel on the GPU: the insertion chain against its CPU twin.

#[cfg(test)]
mod tests {
    use crate::export::core::shape::CoreShape;
    use crate::export::core::tests::SHAPE;
    use crate::export::core::{CoreBinding, CoreLanguage};
    use crate::features::core::code::{CodeLayout, EMPTY};
    use crate::gpu::device::{Dispatch, groups};
    use crate::gpu::tests::gpu;
    use crate::gpu::{Gpu, GpuError};
    use crate::numeric::rng::stream;
    use rand::RngExt;
    use rand::seq::SliceRandom;

    /// Fragments of many pixels, in no order.
    struct Fragments {
        pixels: usize,
        range: (f32, f32),
        pixel_of: Vec<u32>,
        view_z: Vec<f32>,
        absorbance: Vec<f32>,
    }

    /// Pixels of 0 to `most` fragments; a third of the depths and absorbances come from a few, so that ties, doubles
    /// and fragments that absorb nothing or everything are common.
    fn fragments(pixels: usize, most: u32, range: (f32, f32), seed: u64) -> Fragments {
        let mut rng = stream(seed, 130, 0);
        let mut all: Vec<(u32, f32, f32)> = Vec::new();
        for p in 0..pixels as u32 {
            for _ in 0..rng.random_range(0..=most) {
                let share: f32 = if rng.random_range(0..3) == 0 {
                    rng.random_range(0..4) as f32 / 3.0
                } else {
                    rng.random_range(-0.05..1.05)
                };
                let view_z = range.0 * (range.1 / range.0).powf(share);
                let absorbance = match rng.random_range(0..6) {
                    0 => [0.0, 1e-8, 0.5, 10.0][rng.random_range(0..4)],
                    _ => 0.002f32 * 4000f32.powf(rng.random_range(0.0..1.0)),
                };
                all.push((p, view_z, absorbance));
            }
        }
        all.shuffle(&mut rng);
        Fragments {
            pixels,
            range,
            pixel_of: all.iter().map(|f| f.0).collect(),
            view_z: all.iter().map(|f| f.1).collect(),
            absorbance: all.iter().map(|f| f.2).collect(),
        }
    }

    /// Every slot as the CPU has it, padded as in the buffer.
    fn expected(shape: CoreShape, fragments: &Fragments) -> Vec<u32> {
        let codes = shape.layout.codes(fragments.range.0, fragments.range.1);
        let mut slots = vec![EMPTY; shape.stride() * fragments.pixels];
        for ((&p, &v), &a) in fragments
            .pixel_of
            .iter()
            .zip(&fragments.view_z)
            .zip(&fragments.absorbance)
        {
            let first = p as usize * shape.stride();
            codes.insert(&mut slots[first..first + shape.slots()], codes.fragment(v, a));
        }
        slots
    }

    const PLACE: CoreBinding = CoreBinding { group: 0, binding: 4 };

    /// A thread a fragment, the chain written in WGSL.
    const WGSL: &str = "
@group(0) @binding(0) var<storage, read> parameters: array<f32>;
@group(0) @binding(1) var<storage, read> pixel_of: array<u32>;
@group(0) @binding(2) var<storage, read> view_z: array<f32>;
@group(0) @binding(3) var<storage, read> absorbance: array<f32>;

@compute @workgroup_size(64)
fn insert_all(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = id.x + id.y * groups.x * 64u;
    if (i < arrayLength(&view_z)) {
        let codes = nmt_core_codes(parameters[0], parameters[1]);
        nmt_core_insert(pixel_of[i], nmt_core_steps(view_z[i], absorbance[i], codes), codes);
    }
}
";

    /// The fragment stage: a point a fragment, all of a pixel on one place of the target.
    const RENDER: &str = "
struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) pixel: u32,
    @location(1) @interpolate(flat) v: f32,
    @location(2) @interpolate(flat) absorbance: f32,
}

@vertex
fn point(@builtin(vertex_index) i: u32) -> Varying {
    let width = u32(parameters[2]);
    let pixel = pixel_of[i];
    let at = (vec2<f32>(vec2<u32>(pixel % width, pixel / width)) + 0.5) / f32(width);
    return Varying(vec4<f32>(2.0 * at - 1.0, 0.5, 1.0), pixel, view_z[i], absorbance[i]);
}

@fragment
fn insert_fragment(f: Varying) -> @location(0) vec4<f32> {
    let codes = nmt_core_codes(parameters[0], parameters[1]);
    nmt_core_insert(f.pixel, nmt_core_steps(f.v, f.absorbance, codes), codes);
    return vec4<f32>(1.0);
}
";

    fn run(gpu: &Gpu, source: &str, shape: CoreShape, fragments: &Fragments) -> Result<Vec<u32>, GpuError> {
        let pipeline = gpu.compute("core", source, "insert_all")?;
        let groups = groups(fragments.view_z.len() as u64);
        let parameters = [fragments.range.0, fragments.range.1, (groups[0] * 64) as f32, 0.0];
        let core = gpu.zeros("core", 4 * (shape.stride() * fragments.pixels) as u64)?;
        let buffers = [
            &gpu.upload("parameters", &parameters)?,
            &gpu.upload("pixels", &fragments.pixel_of)?,
            &gpu.upload("view_z", &fragments.view_z)?,
            &gpu.upload("absorbance", &fragments.absorbance)?,
            &core,
        ];
        let dispatch = Dispatch {
            pipeline: &pipeline,
            buffers: &buffers,
            groups,
        };
        gpu.run("core", &[dispatch])?;
        gpu.download(&core, shape.stride() * fragments.pixels)
    }

    /// 16,384 pixels of up to 300 fragments in random order, a thread a fragment: every slot of every pixel is the
    /// CPU's, over layouts, K, and scenes that are a point, thin, and 1e6 deep. Control: a chain whose losers go no
    /// farther.
    #[test]
    fn every_slot_is_that_of_the_cpu() {
        let Some(gpu) = gpu() else { return };
        let layout = |depth_bits, octave_bits, key_exponent| CodeLayout {
            depth_bits,
            octave_bits,
            key_exponent,
        };
        let cases = [
            (SHAPE, 16_384, 300, (2.5, 5.6)),
            (CoreShape::new(layout(16, 11, 10.0), 6), 2048, 100, (1e-3, 1e3)),
            (CoreShape::new(layout(20, 7, 10.0), 2), 2048, 60, (2.5, 5.6)),
            (CoreShape::new(layout(12, 12, 4.5), 8), 1024, 60, (1.0, 1.001)),
            (CoreShape::new(layout(16, 11, 6.0), 0), 1024, 30, (0.5, 40.0)),
            (CoreShape::new(layout(16, 11, 6.0), 1), 1024, 30, (1.0, 1.0)),
        ];
        for (shape, pixels, most, range) in cases {
            let fragments = fragments(pixels, most, range, 7);
            let source = shape.codes(CoreLanguage::Wgsl) + &shape.insert(CoreLanguage::Wgsl, PLACE) + WGSL;
            let expected = expected(shape, &fragments);
            let found = run(gpu, &source, shape, &fragments).unwrap();
            assert!(
                found == expected,
                "{shape:?} {range:?}: {} differ",
                differing(&found, &expected)
            );
            let wrong = source.replace(
                "min(atomicMax(&nmt_core[slot], code), code)",
                "min(atomicMax(&nmt_core[slot], code), code) * u32(code < 0x40000000u)",
            );
            assert_ne!(wrong, source);
            let wrong = run(gpu, &wrong, shape, &fragments).unwrap();
            assert!(most < 60 || differing(&wrong, &expected) > pixels / 4, "{shape:?}");
        }
    }

    fn differing(found: &[u32], expected: &[u32]) -> usize {
        found.iter().zip(expected).filter(|(a, b)| a != b).count()
    }

    /// glslangValidator takes the chain in GLSL 4.30, GLSL ES 3.10 and HLSL. Control: without the codes it takes none.
    #[test]
    fn glslang_takes_the_chain() {
        let glsl = "
layout(early_fragment_tests) in;
layout(location = 0) in vec2 f;
layout(location = 0) out vec4 color;
void main() {
    NmtCodes codes = nmt_core_codes(1.0, 2.0);
    nmt_core_insert(uint(gl_FragCoord.x), nmt_core_steps(f.x, f.y, codes), codes);
    color = vec4(1.0);
}
";
        let text = |language, with_codes: bool| {
            let codes = if with_codes {
                SHAPE.codes(language)
            } else {
                String::new()
            };
            codes + &SHAPE.insert(language, PLACE)
        };
        for version in [
            "#version 430\n",
            "#version 310 es\nprecision highp float;\nprecision highp int;\n",
        ] {
            let run = |with_codes| glslang(&format!("{version}{}{glsl}", text(CoreLanguage::Glsl, with_codes)), &[]);
            let Some(taken) = run(true) else { return };
            assert!(taken && run(false) == Some(false), "{version}");
        }
        let hlsl = "
[earlydepthstencil]
float4 main(float4 place : SV_Position, float2 f : TEXCOORD) : SV_Target {
    NmtCodes codes = nmt_core_codes(1.0, 2.0);
    nmt_core_insert(uint(place.x), nmt_core_steps(f.x, f.y, codes), codes);
    return float4(1.0, 1.0, 1.0, 1.0);
}
";
        let run = |with_codes| {
            let source = format!("{}{hlsl}", text(CoreLanguage::Hlsl, with_codes));
            glslang(&source, &["-D", "-V", "-e", "main"])
        };
        assert!(run(true) == Some(true) && run(false) == Some(false));
    }

    /// Whether glslangValidator takes a fragment shader; none, reported as skipped, where it is not installed.
    fn glslang(source: &str, arguments: &[&str]) -> Option<bool> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("core.frag");
        std::fs::write(&file, source).unwrap();
        let run = std::process::Command::new("glslangValidator")
            .current_dir(&folder)
            .args(arguments)
            .arg(&file)
            .output();
        let output = crate::numeric::require::or_skip("glslangValidator", run)?;
        println!("{}", String::from_utf8_lossy(&output.stdout));
        Some(output.status.success())
    }

    /// The chain in a render pass, whose fragment stage has the atomics: every slot is the CPU's.
    #[test]
    fn the_fragment_stage_keeps_the_same_slots() {
        let Some(gpu) = gpu() else { return };
        let width = 48;
        let fragments = fragments(width * width, 120, (2.5, 5.6), 9);
        let bindings = WGSL.split("\n@compute").next().unwrap();
        let source = SHAPE.codes(CoreLanguage::Wgsl) + &SHAPE.insert(CoreLanguage::Wgsl, PLACE) + bindings + RENDER;
        let parameters = [fragments.range.0, fragments.range.1, width as f32, 0.0];
        let core = gpu
            .zeros("core", 4 * (SHAPE.stride() * fragments.pixels) as u64)
            .unwrap();
        let buffers = [
            &gpu.upload("parameters", &parameters).unwrap(),
            &gpu.upload("pixels", &fragments.pixel_of).unwrap(),
            &gpu.upload("view_z", &fragments.view_z).unwrap(),
            &gpu.upload("absorbance", &fragments.absorbance).unwrap(),
            &core,
        ];
        gpu.checked("core in the fragment stage", || {
            let device = &gpu.device;
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let format = wgpu::TextureFormat::R8Unorm;
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: None,
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("point"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::PointList,
                    ..Default::default()
                },
                depth_stencil: None,
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("insert_fragment"),
                    compilation_options: Default::default(),
                    targets: &[Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            });
            let entries: Vec<_> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let target = device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: width as u32,
                    height: width as u32,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            let view = target.create_view(&Default::default());
            let mut encoder = device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: Default::default(),
                })],
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..fragments.view_z.len() as u32, 0..1);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        })
        .unwrap();
        let found: Vec<u32> = gpu.download(&core, SHAPE.stride() * fragments.pixels).unwrap();
        let expected = expected(SHAPE, &fragments);
        assert!(found == expected, "{} differ", differing(&found, &expected));
    }
}
