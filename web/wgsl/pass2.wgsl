// Pass 2, blended by addition: sum of alpha T C and of alpha T.
@fragment
fn pass2(f: Varying) -> @location(0) vec4<f32> {
    let found = surface(f);
    if (found.alpha < 0.0) {
        discard;
    }
    let share = found.alpha * weight(found, vec2<i32>(f.position.xy));
    return vec4<f32>(share * found.color, share);
}
