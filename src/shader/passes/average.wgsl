// (1 - t)/(Σ a w) Σ a w C + t C_bg with t = (1 - (Σ a w)/n)^n, of weighted = (Σ a w C, Σ a w); the background alone
// where nothing was drawn.
fn oit_composite(weighted: vec4<f32>, b0: f32, n: f32, background: vec3<f32>) -> vec3<f32> {
    let clear = max(1.0 - weighted.a / max(n, 1.0), 0.0);
    let behind = select(0.0, pow(clear, n), clear > 0.0);
    let scale = select(0.0, (1.0 - behind) / max(weighted.a, 1e-37), weighted.a > 0.0);
    return scale * weighted.rgb + behind * background;
}
