
// Pass 2 without a renderer around it: a thread a fragment gives its weight.

@group(0) @binding(1) var<storage, read> oit_pixel_of: array<u32>;
@group(0) @binding(2) var<storage, read> oit_view_z: array<f32>;
@group(0) @binding(3) var<storage, read> oit_alpha: array<f32>;
@group(0) @binding(4) var<storage, read> oit_state: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> oit_weights: array<f32>;

@compute @workgroup_size(64)
fn oit_weigh_list(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = id.x + id.y * groups.x * 64u;
    if (i >= arrayLength(&oit_weights)) {
        return;
    }
    let v = oit_view_z[i];
    let alpha = oit_alpha[i];
    let seen = oit_fragment_at(v, alpha);
    oit_weights[i] = OIT_WEIGHT(seen, oit_pixel(oit_pixel_of[i]));
}
