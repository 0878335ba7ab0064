// Direct3D, pass 1: draw every transparent surface, in any order, without writing depth.
//
// IndependentBlendEnable; all factors ONE; D3D12_BLEND_OP_ADD, and D3D12_BLEND_OP_MAX for target 2.
// Target 0: DXGI_FORMAT_R32G32B32A32_FLOAT, cleared to 0.
// Target 1: DXGI_FORMAT_R32G32_FLOAT, cleared to 0.
// Target 2: DXGI_FORMAT_R32G32_FLOAT, cleared to -3e38.
//
// Neural moment transparency: network 'recommended', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 3 x 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.438e-3, worst 0.994.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return (alpha < 0.03 ? faint : -log(max(1.0 - alpha, 4.539993e-5)));
}

// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
float nmt_log_ratio(float a, float b) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (abs(s) < 0.2 ? (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111))))
        : log(a / b));
}

// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the
// pixel's own nearest and farthest view depth, these may be v0 and v1 in both passes: then no pixel is too thin for its
// moments.
float nmt_moment_depth(float v, float v0, float v1) {
    return (v1 > v0 ? clamp(2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0, -1.0, 1.0) : 0.0);
}

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
float4 nmt_moments(float z, float absorbance) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    return float4(moment1, moment2, moment3, moment4);
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    float4 sums0;
    // (b4, number of fragments, 0, 0): blended by addition, cleared to 0.
    float4 sums1;
    // (-v, v, 0, 0): blended by max, cleared to -3e38, so that it holds -nearest and farthest. Two channels, f32
    // always.
    float4 range;
};

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
NmtSums nmt_pass1(float v, float v0, float v1, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    float4 b = nmt_moments(nmt_moment_depth(v, v0, v1), absorbance);
    NmtSums result;
    result.sums0 = float4(absorbance, b.xyz);
    result.sums1 = float4(b.w, 1.0, 0.0, 0.0);
    result.range = float4(-v, v, 0.0, 0.0);
    return result;
}

cbuffer Frame : register(b0) {
    // Least and greatest distance along the view direction of what is transparent.
    float2 v_range;
};

struct Varying {
    float4 position : SV_Position;
    // Distance along the view direction.
    float v : DEPTH;
    // Not premultiplied.
    float4 color : COLOR;
};

struct Targets {
    float4 sums0 : SV_Target0;
    float4 sums1 : SV_Target1;
    float4 range : SV_Target2;
};

Targets pass1(Varying input) {
    NmtSums sums = nmt_pass1(input.v, v_range.x, v_range.y, input.color.a);
    Targets targets;
    targets.sums0 = sums.sums0;
    targets.sums1 = sums.sums1;
    targets.range = sums.range;
    return targets;
}
