// What is seen: an image, two side by side, their difference, or the number of fragments.
struct View {
    // 0: image, 1: split at x, 2: difference, 3: fragments.
    mode: u32,
    split: f32,
    // What difference or number the end of the colour scale stands for.
    scale: f32,
    columns: u32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(2) var truth: texture_2d<f32>;
@group(0) @binding(3) var<storage, read> pixels: array<array<u32, 2>>;

@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

fn encode(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055, 12.92 * c, c < vec3<f32>(0.0031308));
}

// From near black over violet and orange to pale yellow, lightness rising evenly.
fn heat(t: f32) -> vec3<f32> {
    let x = clamp(t, 0.0, 1.0) * 5.0;
    let k = u32(min(x, 4.0));
    var stops = array<vec3<f32>, 6>(
        vec3<f32>(0.02, 0.02, 0.06), vec3<f32>(0.24, 0.06, 0.40), vec3<f32>(0.55, 0.14, 0.42),
        vec3<f32>(0.86, 0.30, 0.24), vec3<f32>(0.98, 0.62, 0.16), vec3<f32>(0.98, 0.98, 0.70),
    );
    return mix(stops[k], stops[k + 1u], x - f32(k));
}

@fragment
fn present(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<u32>(position.xy);
    let color = textureLoad(image, at, 0).rgb;
    if (view.mode == 0u || (view.mode == 1u && position.x >= view.split)) {
        return vec4<f32>(encode(color), 1.0);
    }
    if (view.mode == 3u) {
        let n = f32(pixels[at.x + at.y * view.columns][1]);
        return vec4<f32>(heat(log2(1.0 + n) / log2(1.0 + view.scale)), 1.0);
    }
    let exact = textureLoad(truth, at, 0).rgb;
    if (view.mode == 1u) {
        return vec4<f32>(encode(exact), 1.0);
    }
    let d = abs(color - exact);
    return vec4<f32>(heat(max(d.x, max(d.y, d.z)) / view.scale), 1.0);
}
