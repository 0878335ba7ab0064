
// Moment depth of v; range holds v0 and 2/ln(v1/v0), v0 and v1 the scene's least and greatest v, or 0 where they are
// one.
fn oit_depth(v: f32, range: vec2<f32>) -> f32 {
    return select(0.0, clamp(oit_log_ratio(v, range.x) * range.y - 1.0, -1.0, 1.0), range.y > 0.0);
}
