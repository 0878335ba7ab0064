
// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
fn oit_log_ratio(a: f32, b: f32) -> f32 {
    let s = (a - b) / (a + b);
    let q = s * s;
    let series = (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111))));
    return select(log(a * (1.0 / b)), series, abs(s) < 0.2);
}

// Moment depth of v; range holds v0 and 2/ln(v1/v0), v0 and v1 the scene's least and greatest v, or 0 where they are
// one.
fn oit_depth(v: f32, range: vec2<f32>) -> f32 {
    return select(0.0, clamp(oit_log_ratio(v, range.x) * range.y - 1.0, -1.0, 1.0), range.y > 0.0);
}
