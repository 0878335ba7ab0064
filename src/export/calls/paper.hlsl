
// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
NMT_FIELDS
    // (-w, w, 0, 0): blended by max, cleared to -3e38, so that it holds -w_min and w_max. Two channels, f32 always.
    float4 range;
};

// Pass 1 in one call. w is window depth in [0, 1], the same bits in both passes.
NmtSums nmt_pass1(float w, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    float4 b = nmt_moments(w, absorbance);
    NmtSums sums;
NMT_TERMS
    sums.range = float4(-w, w, 0.0, 0.0);
    return sums;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
float nmt_pass2(float w, NMT_PARAMETERS, float4 range) {
    float4 b = float4(sums0.y, sums0.z, sums0.w, sums1.x);
    float f[7];
    nmt_features(w, -range.x, range.y, NMT_N, sums0.x, b, f);
    return nmt_transmittance(f);
}
