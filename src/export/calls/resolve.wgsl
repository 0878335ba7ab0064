
// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>) -> vec4<f32> {
    let behind = exp(-sums0.x);
    let scale = select(0.0, (1.0 - behind) / max(weighted.w, 1e-37), weighted.w > 0.0);
    return vec4<f32>(scale * weighted.xyz, behind);
}
