
// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
NmtSums nmt_pass1(float v, float v0, float v1, float alpha) {
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), nmt_core_codes(v0, v1));
    float absorbance = nmt_core_absorbance(steps);
    vec4 b = nmt_core_moments(steps);
    float n = steps.y > 0u ? 1.0 : 0.0;
    NmtSums sums;
    CORE_TERMS
    sums.range = vec4(nmt_core_end_values(steps), 0.0, 0.0);
    return sums;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, CORE_SUMS, vec4 range) {
    NmtCodes codes = nmt_core_codes(v0, v1);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes);
    uvec4 core = uvec4(nmt_core_ends(range.xy), 0u, 0u);
    return nmt_core_transmittance(steps, codes, core, CORE_COUNT, CORE_TOTAL, vec4(CORE_MOMENTS));
}
