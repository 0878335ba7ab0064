
// Pass 1: absorbance times powers of depth.
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    let b0 = f.absorbance;
    OIT_POWERS
    return array<f32, OIT_SUMS>(OIT_MOMENTS);
}
