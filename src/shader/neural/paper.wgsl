
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    let m = nmt_moments(f.z, f.absorbance);
    return array<f32, OIT_SUMS>(f.absorbance, m.x, m.y, m.z, m.w);
}

fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    let b = vec4<f32>(p.sums[1], p.sums[2], p.sums[3], p.sums[4]);
    return nmt_transmittance(nmt_features(f.z, p.z_nearest, p.z_farthest, p.n, p.sums[0], b));
}
