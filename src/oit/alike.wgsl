
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    return 1.0;
}
