
// Pass 2 from the moments of the others: exact rules first, in this order; then their curve in the middle of its bounds; where rounding makes that no
// transmittance, half of what is known to be there.
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    let others = max(p.sums[0] - f.absorbance, 0.0);
    if (f.v == p.nearest || others <= 1e-6 * p.sums[0]) {
        return 1.0;
    }
    if (f.v == p.farthest) {
        return min(exp(-others), 1.0);
    }
    let own = oit_accumulate(f);
    let among_others = OIT_CURVE(array<f32, OIT_SUMS>(OIT_OTHERS), f.z, OIT_OVERESTIMATION);
    // Whatever rounding makes of it, between none and all of the others lie in front. NaN compares with nothing.
    return clamp(select(exp(-0.5 * others), among_others, among_others < 1.001), min(exp(-others), 1.0), 1.0);
}
