// Pass 1 of methods that store single fragments: the sums are blended, the fragments go into the slots of the pixel.
@group(1) @binding(9) var opaque_depth: texture_depth_2d;

@fragment
fn pass1(f: Varying) -> Sums {
    let found = surface(f);
    let at = vec2<u32>(f.position.xy);
    // A fragment that writes to memory does so whatever the depth test says, so that it must look itself.
    if (found.alpha < 0.0 || f.position.z > textureLoad(opaque_depth, at, 0)) {
        discard;
    }
    record(found, at.x + at.y * u32(frame.size.x));
    return accumulate(found, vec2<i32>(f.position.xy));
}
