
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    return OIT_FUNCTION(f.v, f.z, f.alpha);
}
