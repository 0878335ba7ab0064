struct Sums { @location(0) b012: vec4<f32> }

fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    return Sums(vec4<f32>(core_moments(core_steps(s)), 1.0));
}

fn record(s: Surface, pixel: u32) {
    nmt_core_insert(pixel, core_steps(s), nmt_core_codes(frame.range.x, frame.range.y));
}
