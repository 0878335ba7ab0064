// Pass 1: what a fragment adds to its pixel, blended.
@fragment
fn pass1(f: Varying) -> Sums {
    let found = surface(f);
    if (found.alpha < 0.0) {
        discard;
    }
    return accumulate(found, vec2<i32>(f.position.xy));
}
