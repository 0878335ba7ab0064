// What both passes know of a fragment: distance along the view direction v, depth z of the method's kind, opacity,
// absorbance min(-ln(1 - alpha), 10).
struct OitFragment { v: f32, z: f32, alpha: f32, absorbance: f32 }

// What pass 1 left in a pixel: the method's sums, number of fragments, least and greatest v, and their depths of the
// method's kind.
struct OitPixel { sums: array<f32, OIT_SUMS>, n: f32, nearest: f32, farthest: f32, z_nearest: f32, z_farthest: f32 }

fn oit_fragment_at(v: f32, alpha: f32) -> OitFragment {
    return OitFragment(v, oit_depth(v, oit_frame.range), alpha, oit_absorbance(alpha));
}
