
// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
float4 nmt_resolve(float4 weighted, float4 sums0) {
    float behind = exp(-sums0.x);
    float scale = weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0;
    return float4(scale * weighted.xyz, behind);
}
