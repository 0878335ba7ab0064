// Twin of wgsl/wavelet.wgsl.
float wavelet_place(float v, vec2 ends) {
    return clamp((v - ends.x) / max(ends.y - ends.x, 1e-30), 0.0, 1.0) * 0.9375;
}

float wavelet_term(float x, float j, float absorbance) {
    float t = fract(x * exp2(j));
    return -absorbance * exp2(-0.5 * j) * min(t, 1.0 - t);
}

vec4 wavelet_one(int at, float value) {
    return vec4(at == 0 ? value : 0.0, at == 1 ? value : 0.0, at == 2 ? value : 0.0, at == 3 ? value : 0.0);
}

void wavelet_terms(float x, float absorbance, out vec4 c[4]) {
    float first = wavelet_term(x, 1.0, absorbance);
    c[0] = vec4(absorbance * (1.0 - x), wavelet_term(x, 0.0, absorbance), x < 0.5 ? first : 0.0, x < 0.5 ? 0.0 : first);
    c[1] = wavelet_one(int(x * 4.0), wavelet_term(x, 2.0, absorbance));
    int third = int(x * 8.0);
    c[2] = wavelet_one(third, wavelet_term(x, 3.0, absorbance));
    c[3] = wavelet_one(third - 4, wavelet_term(x, 3.0, absorbance));
}

float wavelet_value(vec4 c[4], int i) {
    float value = c[0].x;
    for (int j = 0; j < 4; j++) {
        int index = (1 << j) + (i >> (4 - j));
        float sign_of = ((i >> (3 - j)) & 1) == 1 ? -1.0 : 1.0;
        value += sign_of * exp2(0.5 * float(j)) * c[index >> 2][index & 3];
    }
    return value;
}

float wavelet_transmittance(vec4 c[4], float place) {
    float x = place * 16.0;
    int i = int(x);
    float before = i > 0 ? wavelet_value(c, max(i, 1) - 1) : 0.0;
    return clamp(exp(-mix(before, wavelet_value(c, i), fract(x))), 0.0, 1.0);
}
