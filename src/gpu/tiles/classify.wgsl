
// Which pixels need the network? Those that do not are shaded here and now. The others go to lists, so that threads that work together all have work: one for each kind
// of pixel and each range of fragment counts.

// Workgroups in x, y and z of two indirect dispatches, one a kind; then how many workgroups these are, one a kind; then how many pixels each list holds. The
// lists come behind: each has room for all pixels, of which one kind fills it from the front and one from the back.
@group(0) @binding(8) var<storage, read_write> oit_lists: array<atomic<u32>>;

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
    let state = oit_state(pixel);
    OIT_KINDS
    if (!(known || faint)) {
        let list = min(u32(OIT_BUCKET), OIT_BUCKETS - 1u);
        let index = atomicAdd(&oit_lists[8u + kind * OIT_BUCKETS + list], 1u);
        let pixels = oit_frame.size.x * oit_frame.size.y;
        let place = select(index, pixels - 1u - index, kind == 1u);
        atomicStore(&oit_lists[8u + 2u * OIT_BUCKETS + list * pixels + place], pixel);
        // A device dispatches at most 65535 workgroups in a direction, so that long lists take several rows.
        if (index % 64u == 0u) {
            let groups = atomicAdd(&oit_lists[6u + kind], 1u);
            atomicMax(&oit_lists[3u * kind], min(groups + 1u, OIT_ROW));
            atomicMax(&oit_lists[3u * kind + 1u], groups / OIT_ROW + 1u);
        }
        return;
    }
    var weighted = vec4<f32>(0.0);
    for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let f = oit_fragment(i);
        weighted += oit_weighted(i, f.alpha * OIT_KNOWN);
    }
    oit_finish(pixel, state, weighted, 0.0);
}
