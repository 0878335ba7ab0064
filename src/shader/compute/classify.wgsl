
// Which pixels need the network? Those that do not are shaded here and now. The others go to lists by their kind, so
// that threads that work together all have work.

// Workgroups in x, y and z of two indirect dispatches, one a kind; then how many pixels there are of each kind; then
// room for all pixels, which one kind fills from the front and one from the back.
@group(0) @binding(7) var<storage, read_write> oit_lists: array<atomic<u32>>;

@compute @workgroup_size(8, 8)
fn oit_classify(@builtin(global_invocation_id) at: vec3<u32>) {
    if (all(at.xy == vec2<u32>(0u))) {
        atomicStore(&oit_lists[2], 1u);
        atomicStore(&oit_lists[5], 1u);
    }
    if (any(at.xy >= oit_frame.size)) {
        return;
    }
    let pixel = at.y * oit_frame.size.x + at.x;
    let state = oit_pixel(pixel);
    let known = OIT_KNOWN;
    OIT_KINDS
    if (!(known || faint)) {
        let index = atomicAdd(&oit_lists[6u + kind], 1u);
        let place = select(index, oit_frame.size.x * oit_frame.size.y - 1u - index, kind == 1u);
        atomicStore(&oit_lists[8u + place], pixel);
        // A device dispatches at most 65535 workgroups in a direction, so that long lists take several rows.
        if (index % 64u == 0u) {
            atomicMax(&oit_lists[3u * kind], min(index / 64u + 1u, OIT_ROW));
            atomicMax(&oit_lists[3u * kind + 1u], index / 64u / OIT_ROW + 1u);
        }
        return;
    }
    var weighted = vec4<f32>(0.0);
    for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let f = oit_fragment(i);
        weighted += oit_weighted(i, f.alpha * OIT_WEIGHT);
    }
    oit_finish(pixel, state, weighted, 0.0);
}
