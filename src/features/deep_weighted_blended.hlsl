// The features of a fragment at view depth view_z, from what pass 1 left in its pixel (sum of alpha, number of fragments) and the least and
// greatest view depth of the scene.
void nmt_features(float view_z, float v_min, float v_max, float alpha_sum, float n, out float f[3]) {
    float depth = v_max > v_min ? clamp((view_z - v_min) / max(v_max - v_min, 1e-30), 0.0, 1.0) : 0.0;
    f[0] = depth;
    f[1] = alpha_sum;
    f[2] = n;
}
