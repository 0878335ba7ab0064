
@group(0) @binding(8) var<storage, read> oit_lists: array<u32>;

// Pixels of one kind, from the lists of those with most fragments on; all pixels of a workgroup are of one list.
@compute @workgroup_size(64)
fn oit_listed_pixels(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var rest = group.y * OIT_ROW + group.x;
    var list = OIT_BUCKETS;
    var count = 0u;
    while (list > 0u) {
        list--;
        count = oit_lists[8u + OIT_KIND * OIT_BUCKETS + list];
        let groups = (count + 63u) / 64u;
        if (rest < groups) {
            break;
        }
        rest -= groups;
        count = 0u;
    }
    let index = 64u * rest + local;
    if (index >= count) {
        return;
    }
    let pixels = oit_frame.size.x * oit_frame.size.y;
    let pixel = oit_lists[8u + 2u * OIT_BUCKETS + list * pixels + select(index, pixels - 1u - index, OIT_KIND == 1u)];
    let state = oit_state(pixel);
    let end = oit_offsets[pixel + 1u];
    var weighted = vec4<f32>(0.0);
    var asked = 0.0;
    OIT_BEFORE
    var i = oit_offsets[pixel];
    loop {
        // On to the next fragment that needs the network: then all threads have one, and run it together.
        for (; i < end; i++) {
            let f = oit_fragment(i);
            OIT_KNOWN
            if (known < 0.0) {
                break;
            }
            weighted += oit_weighted(i, f.alpha * known);
        }
        if (i >= end) {
            OIT_AFTER
            break;
        }
        let f = oit_fragment(i);
        weighted += oit_weighted(i, f.alpha * oit_weight(f, state));
        asked += 1.0;
        i++;
    }
    oit_finish(pixel, state, weighted, asked);
}
