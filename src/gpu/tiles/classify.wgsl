// A workgroup a tile of 8 x 8 pixels: does one of them need the network? Two lists of tiles are compacted with atomic counters: those that do, and the others.

@group(0) @binding(1) var<storage, read> oit_ranges: array<vec4<f32>>;
// Lengths of both lists, the tiles that need the network, and after room for all tiles the others.
@group(0) @binding(2) var<storage, read_write> oit_tiles: array<atomic<u32>>;

var<workgroup> oit_needed: atomic<u32>;

@compute @workgroup_size(8, 8)
fn oit_classify(
    @builtin(global_invocation_id) at: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if (all(at.xy < oit_frame.size)) {
        let ends = oit_ranges[at.y * oit_frame.size.x + at.x];
        // ends holds number of fragments, nearest and farthest v.
        if (OIT_NEEDS_NETWORK) {
            atomicOr(&oit_needed, 1u);
        }
    }
    workgroupBarrier();
    if (local == 0u) {
        let tile = group.y * groups.x + group.x;
        if (atomicLoad(&oit_needed) != 0u) {
            atomicStore(&oit_tiles[2u + atomicAdd(&oit_tiles[0], 1u)], tile);
        } else {
            atomicStore(&oit_tiles[2u + groups.x * groups.y + atomicAdd(&oit_tiles[1], 1u)], tile);
        }
    }
}
