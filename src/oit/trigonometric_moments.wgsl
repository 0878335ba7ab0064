
// Pass 1: absorbance times powers of a point of the unit circle.
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    let x = complex_square(half_circle_point(f.z));
    let b1 = x * f.absorbance;
    OIT_POWERS
    return array<f32, OIT_SUMS>(f.absorbance, OIT_MOMENTS);
}
