//! The core of every pixel on the GPU: the insertion chain against its CPU twin.

#[cfg(test)]
mod tests {
    use crate::check::core::without_atomics;
    use crate::check::hlsl;
    use crate::evaluate::{self, gpu::within_999};
    use crate::export::Target;
    use crate::export::core::weigh::{Entry, weigh_by_law, weigh_by_mlp};
    use crate::export::core::{CoreBinding, chain, codes, ends, insert, known_fragments, weigh};
    use crate::features::core::CoreSet;
    use crate::features::core::code::{CodeLayout, CoreFragment, EMPTY, Slot};
    use crate::gpu::compute::wgsl_of_glsl;
    use crate::gpu::device::{Dispatch, groups};
    use crate::gpu::list::Passes;
    use crate::gpu::pipeline::tests::{GREY, agree, built_in, image, model, shader, turned};
    use crate::gpu::tests::gpu;
    use crate::gpu::tiles::{self, TilePasses};
    use crate::gpu::{DeviceList, Gpu, GpuError, pipeline};
    use crate::numeric::rng::stream;
    use crate::oit::neural::{Neural, Skip};
    use crate::oit::{self, Context, Method};
    use crate::pixel::{FragmentList, absorbance};
    use crate::shader::MethodShader;
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
    fn expected(shape: CoreSet, fragments: &Fragments) -> Vec<u32> {
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

    const SET: CoreSet = CoreSet::new(4, 2);
    const PLACE: CoreBinding = CoreBinding { group: 0, binding: 4 };

    /// Methods of cores: beta laws by their K, and shipped networks by their names, on the CPU and as shaders.
    fn methods(laws: &[usize], networks: &[&str]) -> Vec<(Box<dyn Method>, MethodShader)> {
        let laws = laws.iter().map(|k| {
            let method = oit::parse(&format!("core:{k}")).unwrap();
            let shader = method.shader().unwrap();
            (method, shader)
        });
        let networks = networks.iter().map(|name| {
            let (mlp, shader) = (model(name), shader(&model(name)));
            (Box::new(Neural::new(mlp)) as Box<dyn Method>, shader)
        });
        laws.chain(networks).collect()
    }

    /// The networks with a core that are shipped.
    const NETWORKS: [&str; 4] = ["ends", "core-small", "core", "core-large"];

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

    /// Both passes in GLSL, a thread a pixel.
    const GLSL: &str = "
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Parameters { float parameters[]; };
layout(std430, binding = 1) readonly buffer Offsets { uint offsets[]; };
layout(std430, binding = 2) readonly buffer Depths { float view_z[]; };
layout(std430, binding = 3) readonly buffer Absorbances { float absorbance[]; };
layout(std430, binding = 5) buffer Weights { float weights[]; };

uvec2 slots(uint at) {
    return uvec2(nmt_core[at], nmt_core[at + 1u]);
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    NmtCodes codes = nmt_core_codes(parameters[0], parameters[1]);
    if (pixel >= uint(parameters[2])) {
        return;
    }
    float n = 0.0;
    float b0 = 0.0;
    vec4 moments = vec4(0.0);
    for (uint i = offsets[pixel]; i < offsets[pixel + 1u]; i++) {
        uvec2 steps = nmt_core_steps(view_z[i], absorbance[i], codes);
        nmt_core_insert(pixel, steps, codes);
        n += steps.y > 0u ? 1.0 : 0.0;
        b0 += nmt_core_absorbance(steps);
        moments += nmt_core_moments(steps);
    }
    for (uint j = offsets[pixel]; j < offsets[pixel + 1u]; j++) {
        uvec2 own = nmt_core_steps(view_z[j], absorbance[j], codes);
        uint first = NMT_SLOTS * pixel;
        uvec4 core0 = uvec4(slots(first), slots(first + 2u));
        uvec4 core1 = uvec4(slots(first + 4u), 0u, 0u);
        weights[j] = nmt_core_transmittance(own, codes, core0, core1, n, b0, moments);
    }
}
";

    /// The same in HLSL.
    fn hlsl_shader() -> String {
        let body = GLSL
            .split("uvec2 slots")
            .nth(1)
            .unwrap()
            .replace("vec4(0.0)", "float4(0.0, 0.0, 0.0, 0.0)");
        let body = body
            .replace("uvec2", "uint2")
            .replace("uvec4", "uint4")
            .replace(" vec4 ", " float4 ");
        let body = body.replace("gl_GlobalInvocationID.x", "id.x").replace(
            "void main() {",
            "[numthreads(64, 1, 1)]\nvoid main(uint3 id : SV_DispatchThreadID) {",
        );
        let buffers = "
StructuredBuffer<float> parameters : register(t0);
StructuredBuffer<uint> offsets : register(t1);
StructuredBuffer<float> view_z : register(t2);
StructuredBuffer<float> absorbance : register(t3);
RWStructuredBuffer<float> weights : register(u5);
";
        format!("{buffers}\nuint2 slots{body}")
    }

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

    fn run(gpu: &Gpu, source: &str, shape: CoreSet, fragments: &Fragments) -> Result<Vec<u32>, GpuError> {
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
        let of = |layout, heavy| CoreSet {
            layout,
            ..CoreSet::new(heavy, 2)
        };
        let cases = [
            (SET, 16_384, 300, (2.5, 5.6)),
            (of(layout(16, 11, 10.0), 6), 2048, 100, (1e-3, 1e3)),
            (of(layout(20, 7, 10.0), 2), 2048, 60, (2.5, 5.6)),
            (of(layout(12, 12, 4.5), 8), 1024, 60, (1.0, 1.001)),
            (of(layout(16, 11, 6.0), 0), 1024, 30, (0.5, 40.0)),
            (of(layout(16, 11, 6.0), 1), 1024, 30, (1.0, 1.0)),
        ];
        for (shape, pixels, most, range) in cases {
            let fragments = fragments(pixels, most, range, 7);
            let source = codes(shape, Target::Wgsl) + &insert(Target::Wgsl, PLACE) + WGSL;
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

    /// Pass 1 and pass 2 as exported in GLSL and HLSL, executed as the WGSL that naga and slangc make of them: every
    /// slot is the CPU's, and every transmittance of f32 sums within 1e-4 of the CPU's formula on f32. Control: another
    /// fragment's transmittances.
    #[test]
    fn glsl_and_hlsl_make_the_same_of_a_pixel() {
        let Some(gpu) = gpu() else { return };
        let mut fragments = fragments(1024, 60, (2.5, 5.6), 8);
        let mut order: Vec<usize> = (0..fragments.view_z.len()).collect();
        order.sort_by_key(|&i| fragments.pixel_of[i]);
        let pick = |values: &[f32]| order.iter().map(|&i| values[i]).collect::<Vec<_>>();
        (fragments.view_z, fragments.absorbance) = (pick(&fragments.view_z), pick(&fragments.absorbance));
        fragments.pixel_of.sort();
        let offsets: Vec<u32> = (0..=fragments.pixels as u32)
            .map(|p| fragments.pixel_of.partition_point(|&q| q < p) as u32)
            .collect();
        let expected_slots = expected(SET, &fragments);
        let law = |language| codes(SET, language) + &insert(language, PLACE) + &weigh(SET, language);
        both_passes(
            "law",
            gpu,
            &fragments,
            &offsets,
            &expected_slots,
            &law,
            &|own, core, n, b| weigh_by_law(own, core, n, [b[0], b[1], b[2]], SET.layout.depth_bits),
        );
        // The shipped network of as many slots, by the file that is pasted.
        let mlp = model("core");
        assert_eq!(mlp.feature_set().spec().core, Some(CoreSet::new(4, 4)));
        let chain = |language| {
            let (from, to) = (insert(language, CoreBinding::DEFAULT), insert(language, PLACE));
            chain(&mlp, language, None).unwrap().replace(&from, &to)
        };
        both_passes(
            "network",
            gpu,
            &fragments,
            &offsets,
            &expected_slots,
            &chain,
            &|own, core, n, b| weigh_by_mlp(own, core, n, b, SET.layout.depth_bits, &mlp),
        );
    }

    /// A fragment's transmittance of itself, its pixel's core, n, and b_0..b_4.
    type Weigh<'a> = dyn Fn(Entry<f32>, &[Entry<f32>], f32, [f32; 5]) -> f32 + 'a;

    /// Runs both passes of a file in GLSL and HLSL, and compares slots and transmittances.
    fn both_passes(
        name: &str,
        gpu: &Gpu,
        fragments: &Fragments,
        offsets: &[u32],
        expected_slots: &[u32],
        text: &dyn Fn(Target) -> String,
        weigh: &Weigh<'_>,
    ) {
        let plain = |language| without_atomics(&text(language), language).unwrap();
        let glsl = plain(Target::Glsl);
        let mut sources = vec![("GLSL", wgsl_of_glsl(&format!("#version 450\n{glsl}{GLSL}")).unwrap())];
        match hlsl::slangc() {
            Ok(slangc) => {
                let hlsl = plain(Target::Hlsl);
                let shader = format!("{hlsl}{}", hlsl_shader());
                sources.push(("HLSL", hlsl::to_wgsl(&slangc, &shader, "main").unwrap()));
            }
            Err(why) => println!("HLSL is skipped: {why}"),
        }
        let expected = expected_weights(fragments, offsets, expected_slots, weigh);
        for (language, source) in sources {
            let pipeline = gpu.compute(language, &source, "main").unwrap();
            let parameters = [fragments.range.0, fragments.range.1, fragments.pixels as f32, 0.0];
            let core = gpu.zeros("core", 4 * expected_slots.len() as u64).unwrap();
            let weights = gpu.zeros("weights", 4 * fragments.view_z.len() as u64).unwrap();
            let buffers = [
                &gpu.upload("parameters", &parameters).unwrap(),
                &gpu.upload("offsets", offsets).unwrap(),
                &gpu.upload("view_z", &fragments.view_z).unwrap(),
                &gpu.upload("absorbance", &fragments.absorbance).unwrap(),
                &core,
                &weights,
            ];
            let dispatch = Dispatch {
                pipeline: &pipeline,
                buffers: &buffers,
                groups: groups(fragments.pixels as u64),
            };
            gpu.run(language, &[dispatch]).unwrap();
            let slots: Vec<u32> = gpu.download(&core, expected_slots.len()).unwrap();
            assert!(
                slots == expected_slots,
                "{language}: {}",
                differing(&slots, expected_slots)
            );
            let found: Vec<f32> = gpu.download(&weights, expected.len()).unwrap();
            let off = |shift: usize| {
                let pairs = found.iter().skip(shift).zip(&expected);
                let mut off: Vec<f32> = pairs.map(|(a, b)| (a - b).abs()).collect();
                off.sort_by(f32::total_cmp);
                off[off.len() * 999 / 1000]
            };
            println!(
                "{name}, {language}: 99.9 % within {:.1e}, another's {:.1e}",
                off(0),
                off(1)
            );
            assert!(
                off(0) <= 1e-4 && off(1) > 0.1,
                "{name}, {language}: {} {}",
                off(0),
                off(1)
            );
        }
    }

    /// Transmittances by the CPU's formula in f32, sums in the order of the list.
    fn expected_weights(fragments: &Fragments, offsets: &[u32], slots: &[u32], weigh: &Weigh<'_>) -> Vec<f32> {
        let codes = SET.layout.codes(fragments.range.0, fragments.range.1);
        let entry = |f: CoreFragment| Entry {
            z: codes.moment_depth(f.depth_step),
            absorbance: codes.absorbance(f.absorbance_step),
        };
        let empty = Entry {
            z: 0.0,
            absorbance: 0.0,
        };
        let mut weights = Vec::new();
        for p in 0..fragments.pixels {
            let range = offsets[p] as usize..offsets[p + 1] as usize;
            let own: Vec<CoreFragment> = range
                .map(|i| codes.fragment(fragments.view_z[i], fragments.absorbance[i]))
                .collect();
            let (mut n, mut b) = (0.0f32, [0.0f32; 5]);
            for f in own.iter().filter(|f| f.absorbance_step > 0) {
                let Entry { z, absorbance } = entry(*f);
                n += 1.0;
                let mut term = absorbance;
                for b in &mut b {
                    *b += term;
                    term *= z;
                }
            }
            let core: Vec<Entry<f32>> = slots[p * SET.stride()..][..SET.slots()]
                .iter()
                .enumerate()
                .map(|(place, &code)| codes.decode(Slot::at(place), code).map_or(empty, entry))
                .collect();
            weights.extend(own.iter().map(|&f| weigh(entry(f), &core, n, b)));
        }
        weights
    }

    /// glslangValidator takes the fragment stage in GLSL 4.30, GLSL ES 3.10 and HLSL. Control: without the codes it
    /// takes none.
    #[test]
    fn glslang_takes_the_fragment_stage() {
        let set = CoreSet::new(4, 4);
        let glsl = "
layout(early_fragment_tests) in;
layout(location = 0) in vec2 f;
layout(location = 0) out vec4 color;
void main() {
    NmtCodes codes = nmt_core_codes(1.0, 2.0);
    uvec2 steps = nmt_core_steps(f.x, f.y, codes);
    nmt_core_insert(uint(gl_FragCoord.x), steps, codes);
    uvec4 none = uvec4(0u);
    color = vec4(nmt_core_transmittance(steps, codes, none, none, 1.0, f.y, nmt_core_moments(steps)));
}
";
        let text = |language, with_codes: bool| {
            let codes = if with_codes {
                codes(SET, language)
            } else {
                String::new()
            };
            codes + &insert(language, PLACE) + &weigh(set, language)
        };
        for version in [
            "#version 430\n",
            "#version 310 es\nprecision highp float;\nprecision highp int;\n",
        ] {
            let run = |with_codes| glslang(&format!("{version}{}{glsl}", text(Target::Glsl, with_codes)), &[]);
            let Some(taken) = run(true) else { return };
            assert!(taken && run(false) == Some(false), "{version}");
        }
        let hlsl = "
float4 main(float4 place : SV_Position, float2 f : TEXCOORD) : SV_Target {
    NmtCodes codes = nmt_core_codes(1.0, 2.0);
    uint2 steps = nmt_core_steps(f.x, f.y, codes);
    nmt_core_insert(uint(place.x), steps, codes);
    uint4 none = uint4(0u, 0u, 0u, 0u);
    return nmt_core_transmittance(steps, codes, none, none, 1.0, f.y, nmt_core_moments(steps));
}
";
        let run = |with_codes| {
            let source = format!("{}{hlsl}", text(Target::Hlsl, with_codes));
            glslang(&source, &["-D", "-V", "-e", "main"])
        };
        assert!(run(true) == Some(true) && run(false) == Some(false));
    }

    /// Whether glslangValidator takes a fragment shader; none, said aloud, where it is not installed.
    fn glslang(source: &str, arguments: &[&str]) -> Option<bool> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("core.frag");
        std::fs::write(&file, source).unwrap();
        let run = std::process::Command::new("glslangValidator")
            .current_dir(&folder)
            .args(arguments)
            .arg(&file)
            .output();
        match run {
            Ok(output) => {
                println!("{}", String::from_utf8_lossy(&output.stdout));
                Some(output.status.success())
            }
            Err(why) => {
                println!("skipped: glslangValidator: {why}");
                None
            }
        }
    }

    /// Compute passes over a list against the CPU: 99.9 % of the transmittances within 2e-3, f32 logarithms making
    /// another step of few fragments. Control: the list with depths turned round.
    #[test]
    fn compute_passes_are_the_cpus() {
        let Some(gpu) = gpu() else { return };
        for scene in ["sphere-cluster", "foliage", "hair"] {
            let list = built_in(scene, 48);
            for (method, shader) in methods(&[0, 4, 6], &NETWORKS) {
                let name = method.name();
                let weights = |list: &FragmentList| {
                    let accumulated = method.accumulate(list, Context::default()).unwrap();
                    oit::weights(list, &*accumulated)
                };
                let on_device = DeviceList::new(gpu, &list).unwrap();
                let range = shader.depth_range(&list, None, None).unwrap();
                let passes = Passes::new(gpu, &on_device, &shader, range).unwrap();
                passes.run(gpu).unwrap();
                let found = passes.weights(gpu).unwrap();
                let off =
                    |expected: &[f64]| within_999(found.iter().zip(expected).map(|(&a, b)| (f64::from(a) - b).abs()));
                let (right, wrong) = (off(&weights(&list)), off(&weights(&turned(&list))));
                println!("{scene}, {name}: 99.9 % within {right:.1e}, turned round {wrong:.1e}");
                assert!(right <= 2e-3 && wrong > 0.1, "{scene}, {name}: {right:e} {wrong:e}");
            }
        }
    }

    /// Render passes, whose fragment stage keeps the core, and compute passes that shade pixels, against the CPU's
    /// image: as networks are. Control: depths turned round.
    #[test]
    fn images_are_the_cpus() {
        let Some(gpu) = gpu() else { return };
        for scene in ["sphere-cluster", "glass-stacks"] {
            let list = built_in(scene, 64);
            for (method, shader) in methods(&[0, 2, 6], &NETWORKS) {
                let name = method.name();
                let image_of = |list: &FragmentList| {
                    let accumulated = method.accumulate(list, Context::default()).unwrap();
                    let weights = oit::weights(list, &*accumulated);
                    evaluate::image::of_method(list, &*accumulated, &weights, GREY.map(f64::from)).unwrap()
                };
                let cpu = image_of(&list);
                let drawn = pipeline::render(gpu, &shader, &list, None, None, GREY).unwrap();
                let computed = tiles::render(gpu, &shader, &list, None, None, GREY).unwrap();
                for rendered in [drawn, computed] {
                    let found = image(&list, &rendered.pixels);
                    assert!(agree(&found, &cpu), "{scene}, {name}");
                    assert!(
                        !agree(&found, &image_of(&turned(&list))),
                        "{scene}, {name}: turned round"
                    );
                }
            }
        }
    }

    /// Pixels that need no network are told apart without another bit in the image: those whose core holds all
    /// fragments that absorb, but one, or but two with three moments or more. Control: a network that answers otherwise
    /// changes the others, and only them.
    #[test]
    fn known_pixels_need_no_network() {
        let Some(gpu) = gpu() else { return };
        for (scene, size) in [("sphere-cluster", 60), ("foliage", 41)] {
            let list = built_in(scene, size);
            for network in NETWORKS {
                let method = shader(&model(network));
                let set = method.core.unwrap();
                let range = method.depth_range(&list, None, None).unwrap();
                let on_device = DeviceList::new(gpu, &list).unwrap();
                let image = |method: &MethodShader, skip| {
                    let passes = TilePasses::new(gpu, &on_device, method, range, GREY).unwrap();
                    passes.run(gpu, skip).unwrap();
                    let bits = |c: &[f32; 3]| c.map(f32::to_bits);
                    let image: Vec<_> = passes.image(gpu).unwrap().iter().map(bits).collect();
                    (image, passes.counts(gpu).unwrap())
                };
                let (plain, (apart, counts)) = (image(&method, Skip::None).0, image(&method, Skip::Exact));
                let codes = set.layout.codes(range[0], range[1]);
                let absorbs = |(&v, &a): (&f32, &f32)| codes.fragment(v, absorbance(a) as f32).absorbance_step > 0;
                let many = |p: &usize| {
                    let pixel = list.pixel(*p);
                    pixel.view_z.iter().zip(pixel.alpha).filter(|&f| absorbs(f)).count() > known_fragments(set)
                };
                let listed: Vec<usize> = (0..list.pixels()).filter(many).collect();
                let expected = listed.len();
                println!("{scene}, {network}: {counts:?}");
                assert!(plain == apart, "{scene}, {network}");
                assert_eq!(counts.network as usize, expected, "{scene}, {network}");
                assert!(expected > 0 && counts.known > 0);
                let source = method.source.replace("min(-logit, 80.0)", "min(2.0 - logit, 80.0)");
                assert_ne!(source, method.source);
                let other = image(&MethodShader { source, ..method }, Skip::Exact).0;
                let differ: Vec<usize> = (0..list.pixels()).filter(|&p| other[p] != plain[p]).collect();
                assert!(differ.len() * 2 > expected, "{scene}, {network}: the control");
                assert!(differ.iter().all(|p| listed.contains(p)), "{scene}, {network}");
            }
        }
    }

    /// Both ends in channels that blending compares: numbers rise as codes do, are normal, between −4 and 4, and give
    /// their codes back, what a channel is cleared to that of the empty slot. Control: the bits of the codes themselves
    /// are subnormal or no numbers in places.
    #[test]
    fn numbers_of_ends_rise_as_codes_do() {
        let Some(gpu) = gpu() else { return };
        let set = CoreSet::new(0, 4);
        let steps = [0, 1, 2, 1000, set.layout.last_absorbance_step()];
        let all = (0..=65_535u32).step_by(5).flat_map(|q| steps.map(|a| q << 16 | a));
        let all: Vec<u32> = all.collect();
        let source = codes(set, Target::Wgsl)
            + &ends::values(set, Target::Wgsl)
            + "
@group(0) @binding(0) var<storage, read> all: array<u32>;
@group(0) @binding(1) var<storage, read_write> numbers: array<f32>;
@group(0) @binding(2) var<storage, read_write> back: array<u32>;

@compute @workgroup_size(64)
fn there_and_back(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = id.x + id.y * groups.x * 64u;
    if (i < arrayLength(&all)) {
        numbers[i] = nmt_core_end_value(all[i]);
        back[i] = nmt_core_end_code(select(numbers[i], -3.0e38, all[i] == 0u));
    }
}
";
        let pipeline = gpu.compute("ends", &source, "there_and_back").unwrap();
        let [numbers, back] = ["numbers", "back"].map(|label| gpu.zeros(label, 4 * all.len() as u64).unwrap());
        let dispatch = Dispatch {
            pipeline: &pipeline,
            buffers: &[&gpu.upload("codes", &all).unwrap(), &numbers, &back],
            groups: groups(all.len() as u64),
        };
        gpu.run("ends", &[dispatch]).unwrap();
        let back: Vec<u32> = gpu.download(&back, all.len()).unwrap();
        assert_eq!(back, all);
        let numbers: Vec<f32> = gpu.download(&numbers, all.len()).unwrap();
        assert!(numbers.iter().all(|x| x.is_normal() && x.abs() < 4.0));
        assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(all.iter().filter(|&&code| !f32::from_bits(code).is_normal()).count() > 100);
    }

    /// What the bounds of the tail leave open by less than a display step needs no network: answers differ from the
    /// network's by no more than that step, where it lies within the bounds, and are those of the CPU. Control: without
    /// the switch nothing differs.
    #[test]
    fn what_cannot_be_seen_needs_no_network() {
        let Some(gpu) = gpu() else { return };
        for network in NETWORKS {
            let list = built_in("foliage", 40);
            let answers = |skip: Skip| {
                let method = shader(&model(network)).with_skip(skip);
                let on_device = DeviceList::new(gpu, &list).unwrap();
                let range = method.depth_range(&list, None, None).unwrap();
                let passes = Passes::new(gpu, &on_device, &method, range).unwrap();
                passes.run(gpu).unwrap();
                passes.weights(gpu).unwrap()
            };
            let (network_alone, exact, visible) = (answers(Skip::None), answers(Skip::Exact), answers(Skip::Visible));
            assert_eq!(network_alone, exact);
            let off =
                |one: &[f32], other: &[f64]| within_999(one.iter().zip(other).map(|(&a, b)| (f64::from(a) - b).abs()));
            let cpu = Neural::new(model(network)).with_skip(Skip::Visible);
            let accumulated = cpu.accumulate(&list, Context::default()).unwrap();
            let right = off(&visible, &oit::weights(&list, &*accumulated));
            let differ = visible.iter().zip(&exact).filter(|(a, b)| a != b).count();
            println!(
                "{network}: {differ} of {} answers differ, 99.9 % within {right:.1e} of the CPU's",
                exact.len()
            );
            assert!(right <= 2e-3, "{network}: {right:e}");
            assert!(20 * differ > exact.len(), "{network}: {differ}");
            let exact: Vec<f64> = exact.iter().map(|&t| t.into()).collect();
            assert!(off(&visible, &exact) <= 1.0 / 256.0 + 2e-3, "{network}");
        }
    }

    /// Order in which fragments are drawn: the core is the same, so that only the rounding of the sums is left, 1e-3 in
    /// 99.9 % of the pixels.
    #[test]
    fn any_order_will_do() {
        let Some(gpu) = gpu() else { return };
        let list = built_in("sphere-cluster", 64);
        let order: Vec<usize> = (0..list.pixels()).flat_map(|p| list.range(p).rev()).collect();
        let pick = |values: &[f32]| order.iter().map(|&i| values[i]).collect::<Vec<_>>();
        let color = order.iter().map(|&i| list.color().unwrap()[i]).collect();
        let (view_z, alpha) = (pick(list.view_z()), pick(list.alpha()));
        let other = FragmentList::new(list.offsets().to_vec(), view_z, alpha, Some(color)).unwrap();
        let other = other.with_size(64, 64).unwrap();
        let shader = oit::parse("core:4").unwrap().shader().unwrap();
        let draw = |list| {
            image(
                list,
                &pipeline::render(gpu, &shader, list, None, None, GREY).unwrap().pixels,
            )
        };
        assert!(agree(&draw(&other), &draw(&list)));
    }

    /// Hard pixels in all passes: fragments of equal depths, of one depth step, far planes 1e6 times the near one, a
    /// thousand fragments, all alphas 0 or 1, and a scene that moves through the depth range. Every weight is finite
    /// and in [0, 1], and 99 % of them are within 0.01 of the CPU's; one and two fragments are exact to 1e-3.
    #[test]
    fn hard_pixels_are_the_cpus() {
        let Some(gpu) = gpu() else { return };
        let mut rng = stream(5, 132, 0);
        let mut pixels: Vec<(&str, Vec<(f32, f32)>)> = Vec::new();
        for _ in 0..40 {
            let mut alpha = || rng.random_range(0.0f32..1.0);
            pixels.push(("equal depths", (0..12).map(|_| (3.0, alpha())).collect()));
            pixels.push(("two depths", (0..12).map(|i| ([2.0, 3.0][i % 2], alpha())).collect()));
            let close = |i: usize| 3.0 + 1e-5 * i as f32;
            pixels.push(("steps of depth", (0..12).map(|i| (close(i), alpha())).collect()));
            pixels.push((
                "opaque",
                (0..20).map(|i| (1.0 + i as f32, [1.0, 0.0, alpha()][i % 3])).collect(),
            ));
            pixels.push(("one", vec![(1000.0 * alpha() + 0.001, alpha())]));
            pixels.push(("two", vec![(2.0, alpha()), (50.0, alpha())]));
        }
        for _ in 0..4 {
            let mut all = |v0: f32, v1: f32, n: usize| -> Vec<(f32, f32)> {
                let depth = |share: f32| v0 * (v1 / v0).powf(share);
                (0..n)
                    .map(|_| (depth(rng.random_range(0.0..1.0)), rng.random_range(0.0f32..0.3)))
                    .collect()
            };
            pixels.push(("far/near 1e6", all(1e-3, 1e3, 60)));
            pixels.push(("a thousand", all(1.0, 9.0, 1000)));
            for i in 0..16 {
                let near = 1e-3 * 2.5f32.powi(i);
                pixels.push(("moving", all(near, 1.3 * near, 24)));
            }
        }
        let mut offsets = vec![0u64];
        for (_, pixel) in &pixels {
            offsets.push(offsets.last().unwrap() + pixel.len() as u64);
        }
        let (view_z, alpha) = pixels.iter().flat_map(|p| p.1.iter().copied()).unzip();
        let list = FragmentList::new(offsets, view_z, alpha, None).unwrap();
        let range = Some((1e-3, 1e3));
        for (method, shader) in methods(&[0, 4, 6], &NETWORKS) {
            let name = method.name();
            let context = Context {
                depth_range: range,
                ..Context::default()
            };
            let accumulated = method.accumulate(&list, context).unwrap();
            let cpu = oit::weights(&list, &*accumulated);
            let on_device = DeviceList::new(gpu, &list).unwrap();
            let measured = shader.depth_range(&list, None, range).unwrap();
            let passes = Passes::new(gpu, &on_device, &shader, measured).unwrap();
            passes.run(gpu).unwrap();
            let found = passes.weights(gpu).unwrap();
            assert!(found.iter().all(|t| (0.0..=1.0).contains(t)), "{name}");
            let mut off = Vec::new();
            for (p, (kind, pixel)) in pixels.iter().enumerate() {
                for i in list.range(p) {
                    let difference = (f64::from(found[i]) - cpu[i]).abs();
                    assert!(
                        pixel.len() > 2 || difference <= 1e-3,
                        "{name}, {kind}: {} {}",
                        found[i],
                        cpu[i]
                    );
                    off.push(difference);
                }
            }
            off.sort_by(f64::total_cmp);
            let most = off[off.len() * 99 / 100];
            println!("{name}: 99 % within {most:.1e}, all within {:.1e}", off[off.len() - 1]);
            assert!(most <= 0.01, "{name}: {most:e}");
        }
    }

    /// The chain in a render pass, whose fragment stage has the atomics: every slot is the CPU's.
    #[test]
    fn the_fragment_stage_keeps_the_same_slots() {
        let Some(gpu) = gpu() else { return };
        let width = 48;
        let fragments = fragments(width * width, 120, (2.5, 5.6), 9);
        let bindings = WGSL.split("\n@compute").next().unwrap();
        let source = codes(SET, Target::Wgsl) + &insert(Target::Wgsl, PLACE) + bindings + RENDER;
        let parameters = [fragments.range.0, fragments.range.1, width as f32, 0.0];
        let core = gpu.zeros("core", 4 * (SET.stride() * fragments.pixels) as u64).unwrap();
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
        let found: Vec<u32> = gpu.download(&core, SET.stride() * fragments.pixels).unwrap();
        let expected = expected(SET, &fragments);
        assert!(found == expected, "{} differ", differing(&found, &expected));
    }
}
