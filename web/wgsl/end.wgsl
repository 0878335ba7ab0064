// Nearest or farthest fragment by a depth test, where f32 targets cannot be blended into. The scale is a power of two,
// which takes no bit.
@group(1) @binding(9) var opaque_depth: texture_depth_2d;

@fragment
fn end(f: Varying) -> @builtin(frag_depth) f32 {
    let found = surface(f);
    if (found.alpha < 0.0 || f.position.z > textureLoad(opaque_depth, vec2<u32>(f.position.xy), 0)) {
        discard;
    }
    return found.v * frame.depth_scale;
}
