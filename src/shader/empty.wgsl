
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    // No finite input makes it 0, but no compiler knows that.
    return select(1.0, 0.0, f.z + f.absorbance + p.sums[0] > 1e30);
}
