
// The network for every fragment.
@compute @workgroup_size(8, 8)
fn oit_every_pixel(@builtin(global_invocation_id) at: vec3<u32>) {
    if (any(at.xy >= oit_frame.size)) {
        return;
    }
    let pixel = at.y * oit_frame.size.x + at.x;
    let state = oit_pixel(pixel);
    var weighted = vec4<f32>(0.0);
    for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let f = oit_fragment(i);
        weighted += oit_weighted(i, f.alpha * oit_weight(f, state));
    }
    oit_finish(pixel, state, weighted, state.n);
}
