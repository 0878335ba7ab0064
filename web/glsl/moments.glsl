// Twins of src/moments/hamburger.wgsl (four moments) and src/numeric/roots.wgsl.
vec2 quadratic_roots(float half_b, float c) {
    float distance = sqrt(max(half_b * half_b - c, 0.0));
    float sum = half_b < 0.0 ? distance - half_b : -half_b - distance;
    float other = sum == 0.0 ? 0.0 : c / sum;
    return vec2(min(sum, other), max(sum, other));
}

float power_transmittance_4(float b0, vec4 b1234, float z, float overestimation) {
    float scale = (1.0 - 5e-7) / b0;
    float m1 = b1234.x * scale;
    float m2 = b1234.y * scale + 5e-7 * 0.375;
    float m3 = b1234.z * scale;
    float m4 = b1234.w * scale + 5e-7 * 0.375;
    float norm1 = m2 - m1 * m1;
    float row12 = m3 - m1 * m2;
    float row13 = m4 - m1 * m3;
    float per1 = 1.0 / norm1;
    float mean1 = row12 * per1 - m1;
    float per2 = 1.0 / (row13 - mean1 * row12 - norm1 * m2);
    float d0 = z - m1;
    float d1 = z - mean1;
    float p2 = d1 * d0 - norm1;
    float f1 = d0 * per1;
    float f2 = p2 * per2;
    float own = 1.0 / (1.0 + f1 * d0 + f2 * p2);
    vec2 s = quadratic_roots(0.5 * (f1 + f2 * (d0 + d1)) * own, f2 * own);
    float x = z + 1.0 / s.x;
    float u1 = x - m1;
    float u2 = (x - mean1) * u1 - norm1;
    float mass = 1.0 / (1.0 + u1 * u1 * per1 + u2 * u2 * per2);
    float lower = s.y < 0.0 ? 1.0 - own : (s.x < -1e-4 ? mass : 0.0);
    return exp(-b0 * (lower + overestimation * own));
}
