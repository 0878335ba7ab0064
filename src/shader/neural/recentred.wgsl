
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    let m = nmt_moments(f.z, f.absorbance);
    return array<f32, OIT_SUMS>(f.absorbance, OIT_MOMENTS);
}

fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    return nmt_fragment_transmittance(OIT_ARGUMENTS);
}

fn oit_short_weight(f: OitFragment, p: OitPixel) -> f32 {
    let known = nmt_recentred(OIT_ARGUMENTS);
    return OIT_RECENTRED;
}

fn oit_end_weight(f: OitFragment, p: OitPixel) -> f32 {
    let others = clamp(p.sums[0] - f.absorbance, 0.0, OIT_MAX_ABSORBANCE);
    let first = f.v == p.nearest || !(others > 1e-6 * p.sums[0]);
    return select(-1.0, min(exp(-select(others, 0.0, first)), 1.0), first || f.v == p.farthest);
}

fn oit_faint_weight(f: OitFragment, p: OitPixel) -> f32 {
    let end = oit_end_weight(f, p);
    return select(exp(-0.5 * clamp(p.sums[0] - f.absorbance, 0.0, OIT_MAX_ABSORBANCE)), end, end >= 0.0);
}

fn oit_visible_weight(f: OitFragment, p: OitPixel) -> f32 {
    return nmt_visible_transmittance(OIT_ARGUMENTS);
}

fn oit_first_hidden_depth(p: OitPixel) -> f32 {
    return nmt_first_hidden_depth(p.sums[0], p.sums[1], p.sums[2]);
}

fn oit_hidden_weight(f: OitFragment, p: OitPixel) -> f32 {
    return nmt_hidden_weight(f.z, f.absorbance, p.z_nearest, p.z_farthest, p.n, p.sums[0], OIT_PIXEL_MOMENTS);
}
