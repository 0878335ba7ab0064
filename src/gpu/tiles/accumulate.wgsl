// Pass 1 without blending: a thread a pixel goes over its list.

@group(0) @binding(1) var<storage, read> oit_offsets: array<u32>;
@group(0) @binding(2) var<storage, read> oit_view_z: array<f32>;
@group(0) @binding(3) var<storage, read> oit_alpha: array<f32>;
@group(0) @binding(4) var<storage, read_write> oit_sums: array<f32>;
@group(0) @binding(5) var<storage, read_write> oit_ranges: array<vec4<f32>>;

@compute @workgroup_size(8, 8)
fn oit_accumulate_tiles(@builtin(global_invocation_id) at: vec3<u32>) {
    if (any(at.xy >= oit_frame.size)) {
        return;
    }
    let pixel = at.y * oit_frame.size.x + at.x;
    var sums: array<f32, OIT_SUMS>;
    var nearest = 3.0e38;
    var farthest = 0.0;
    for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let v = oit_view_z[i];
        let alpha = oit_alpha[i];
        let term = oit_accumulate(OitFragment(v, oit_depth(v, oit_frame.range), alpha, oit_absorbance(alpha)));
        OIT_ADD
        nearest = min(nearest, v);
        farthest = max(farthest, v);
    }
    OIT_STORE
    oit_ranges[pixel] = vec4<f32>(f32(oit_offsets[pixel + 1u] - oit_offsets[pixel]), nearest, farthest, 0.0);
}
