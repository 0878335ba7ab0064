
// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
NMT_FIELDS
    // (-v, v, 0, 0): blended by max, cleared to -3e38, so that it holds -nearest and farthest. Two channels, f32
    // always.
    float4 range;
};

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
NmtSums nmt_pass1(float v, float v0, float v1, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    NMT_MOMENTS_OF(nmt_moment_depth(v, v0, v1), absorbance)
    NmtSums sums;
NMT_TERMS
    sums.range = float4(-v, v, 0.0, 0.0);
    return sums;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, NMT_PARAMETERS, float4 range) {
NMT_MOMENTS_ARRAY
    float nearest = -range.x;
    float farthest = range.y;
    return nmt_fragment_transmittance(
        v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha),
        nearest, farthest, nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(farthest, v0, v1),
        NMT_N, sums0.x, b
    );
}

// As nmt_pass2, without the network for what cannot be seen; see nmt_visible_transmittance.
float nmt_visible_pass2(float v, float v0, float v1, float alpha, NMT_PARAMETERS, float4 range) {
NMT_MOMENTS_ARRAY
    float nearest = -range.x;
    float farthest = range.y;
    return nmt_visible_transmittance(
        v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha),
        nearest, farthest, nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(farthest, v0, v1),
        NMT_N, sums0.x, b
    );
}
