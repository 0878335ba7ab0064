// Pass 1 without blending: a thread a pixel goes over its list.

@group(0) @binding(1) var<storage, read> oit_offsets: array<u32>;
@group(0) @binding(2) var<storage, read> oit_view_z: array<f32>;
@group(0) @binding(3) var<storage, read> oit_alpha: array<f32>;
@group(0) @binding(4) var<storage, read_write> oit_state: array<vec4<f32>>;

@compute @workgroup_size(64)
fn oit_accumulate_list(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = id.x + id.y * groups.x * 64u;
    if (pixel >= oit_frame.size.x * oit_frame.size.y) {
        return;
    }
    var sums: array<f32, OIT_SUMS>;
    OIT_CORE_VARIABLE
    var nearest = 3.0e38;
    var farthest = 0.0;
    OIT_PREPASS
    for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let v = oit_view_z[i];
        let alpha = oit_alpha[i];
        let f = oit_fragment_at(v, alpha);
        OIT_ADD
        OIT_INSERT
        nearest = min(nearest, v);
        farthest = max(farthest, v);
    }
    OIT_STORE
}
