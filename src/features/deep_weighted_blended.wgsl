// The features of a fragment at view depth view_z, from what pass 1 left in its pixel (sum of alpha, number of fragments) and the least and
// greatest view depth of the scene.
fn nmt_features(view_z: f32, v_min: f32, v_max: f32, alpha_sum: f32, n: f32) -> array<f32, 3> {
    let depth = select(0.0, clamp((view_z - v_min) / max(v_max - v_min, 1e-30), 0.0, 1.0), v_max > v_min);
    return array<f32, 3>(depth, alpha_sum, n);
}
