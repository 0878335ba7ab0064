
@group(0) @binding(7) var<storage, read> oit_lists: array<u32>;

// Pixels of one kind, 64 to a workgroup.
@compute @workgroup_size(64)
fn oit_listed_pixels(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = 64u * (group.y * OIT_ROW + group.x) + local;
    if (index >= oit_lists[6u + OIT_KIND]) {
        return;
    }
    let pixel = oit_lists[8u + select(index, oit_frame.size.x * oit_frame.size.y - 1u - index, OIT_KIND == 1u)];
    let state = oit_pixel(pixel);
    var weighted = vec4<f32>(0.0);
    OIT_LOOP
    oit_finish(pixel, state, weighted, evaluated);
}
