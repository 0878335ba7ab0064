// Direct3D, pass 1: draw every transparent surface, in any order, without writing depth.
//
// IndependentBlendEnable; all factors ONE; D3D12_BLEND_OP_ADD, and D3D12_BLEND_OP_MAX for target 2.
// Target 0: DXGI_FORMAT_R32G32B32A32_FLOAT, cleared to 0.
// Target 1: DXGI_FORMAT_R32G32_FLOAT, cleared to 0.
// Target 2: DXGI_FORMAT_R32G32_FLOAT, cleared to -3e38.
//
// Neural moment transparency: network 'paper', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 1000, dataset 7efe7a15adf78c7d3c08d1766f86933c7206479e931a41fb0eb5cd099252fcd5.
// Measured on fresh pixels of the training distribution: mean squared error of T 5.094e-3, worst 0.657.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return (alpha < 0.03 ? faint : -log(max(1.0 - alpha, 4.539993e-5)));
}

// Pass 1: what a fragment at window depth w adds to b1..b4; to b0 it adds its absorbance.
float4 nmt_moments(float w, float absorbance) {
    float z = 2.0 * w - 1.0;
    float b1 = absorbance * z;
    float b2 = b1 * z;
    float b3 = b2 * z;
    float b4 = b3 * z;
    return float4(b1, b2, b3, b4);
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    float4 sums0;
    // (b4, number of fragments, 0, 0): blended by addition, cleared to 0.
    float4 sums1;
    // (-w, w, 0, 0): blended by max, cleared to -3e38, so that it holds -w_min and w_max. Two channels, f32 always.
    float4 range;
};

// Pass 1 in one call. w is window depth in [0, 1], the same bits in both passes.
NmtSums nmt_pass1(float w, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    float4 b = nmt_moments(w, absorbance);
    NmtSums result;
    result.sums0 = float4(absorbance, b.xyz);
    result.sums1 = float4(b.w, 1.0, 0.0, 0.0);
    result.range = float4(-w, w, 0.0, 0.0);
    return result;
}

struct Varying {
    float4 position : SV_Position;
    // Not premultiplied.
    float4 color : COLOR;
};

struct Targets {
    float4 sums0 : SV_Target0;
    float4 sums1 : SV_Target1;
    float4 range : SV_Target2;
};

Targets pass1(Varying input) {
    NmtSums sums = nmt_pass1(input.position.z, input.color.a);
    Targets targets;
    targets.sums0 = sums.sums0;
    targets.sums1 = sums.sums1;
    targets.range = sums.range;
    return targets;
}
