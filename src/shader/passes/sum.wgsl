// Σ a w C + (1 - Σ a w) C_bg, of weighted = (Σ a w C, Σ a w).
fn oit_composite(weighted: vec4<f32>, b0: f32, n: f32, background: vec3<f32>) -> vec3<f32> {
    return weighted.rgb + (1.0 - weighted.a) * background;
}
