
// Window depth of v; range holds the camera's near and far planes.
fn oit_depth(v: f32, range: vec2<f32>) -> f32 {
    return clamp(range.y * (v - range.x) / (v * (range.y - range.x)), 0.0, 1.0);
}
