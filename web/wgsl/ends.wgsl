// Nearest and farthest fragment by blending: max of (-v, v) keeps both.
@fragment
fn ends(f: Varying) -> @location(0) vec4<f32> {
    let found = surface(f);
    if (found.alpha < 0.0) {
        discard;
    }
    return vec4<f32>(-found.v, found.v, 0.0, 0.0);
}
