// Pass 2, blended by addition: Σ a w C and Σ a w.

fn oit_pixel(at: vec2<i32>) -> OitPixel {
    OIT_RANGE
    let pixel = u32(at.y) * oit_frame.size.x + u32(at.x);
    let z_nearest = oit_depth(nearest, oit_frame.range);
    let z_farthest = oit_depth(farthest, oit_frame.range);
    return OitPixel(oit_sums(at), oit_count(at), nearest, farthest, z_nearest, z_farthest OIT_CORE_MEMBER);
}

@fragment
fn oit_pass2(f: OitVarying) -> @location(0) vec4<f32> {
    let seen = oit_seen(f);
    let weight = seen.alpha * OIT_WEIGHT(seen, oit_pixel(vec2<i32>(f.position.xy)));
    return vec4<f32>(weight * f.color.rgb, weight);
}
