
@compute @workgroup_size(8, 8)
fn oit_every_tile(@builtin(global_invocation_id) at: vec3<u32>) {
    oit_shade(at.xy);
}
