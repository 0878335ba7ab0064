// Workgroups in x, y and z of both indirect dispatches. A device dispatches at most 65535 in a direction, so that long lists take several rows.

@group(0) @binding(0) var<storage, read> oit_tiles: array<u32>;
@group(0) @binding(1) var<storage, read_write> oit_dispatches: array<u32>;

@compute @workgroup_size(2)
fn oit_arrange(@builtin(local_invocation_index) list: u32) {
    let count = oit_tiles[list];
    oit_dispatches[3u * list] = min(count, OIT_ROW);
    oit_dispatches[3u * list + 1u] = (count + OIT_ROW - 1u) / OIT_ROW;
    oit_dispatches[3u * list + 2u] = 1u;
}
