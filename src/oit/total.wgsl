
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    return array<f32, OIT_SUMS>(f.absorbance);
}
