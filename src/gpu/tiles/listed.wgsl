
@group(0) @binding(8) var<storage, read> oit_tiles: array<u32>;

@compute @workgroup_size(8, 8)
fn oit_listed_tiles(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let index = group.y * OIT_ROW + group.x;
    if (index >= oit_tiles[OIT_LIST]) {
        return;
    }
    let across = (oit_frame.size.x + 7u) / 8u;
    let down = (oit_frame.size.y + 7u) / 8u;
    let tile = oit_tiles[2u + OIT_LIST * across * down + index];
    oit_shade(8u * vec2<u32>(tile % across, tile / across) + local.xy);
}
