
// Pass 2 from all moments; where nothing absorbs anything, T is 1.
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    return select(OIT_CURVE(p.sums, f.z, OIT_OVERESTIMATION), 1.0, p.sums[0] == 0.0);
}
