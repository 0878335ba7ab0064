// Optical depth in front of a depth as 16 Haar coefficients: index 0 the mean, then 2^j wavelets of level j, j = 0 to
// 3. A fragment is a step; nothing lies in the last sixteenth of [0, 1), so that the last value is the pixel's total.
fn wavelet_place(v: f32, ends: vec2<f32>) -> f32 {
    return clamp((v - ends.x) / max(ends.y - ends.x, 1e-30), 0.0, 1.0) * 0.9375;
}

// What a fragment adds to the coefficient of level j that its depth x lies in: the integral of the wavelet behind x.
fn wavelet_term(x: f32, j: u32, absorbance: f32) -> f32 {
    let t = fract(x * exp2(f32(j)));
    return -absorbance * exp2(-0.5 * f32(j)) * min(t, 1.0 - t);
}

// The coefficients of a fragment, four levels of one coefficient each, and the mean.
fn wavelet_terms(x: f32, absorbance: f32) -> array<vec4<f32>, 4> {
    var c: array<vec4<f32>, 4>;
    c[0].x = absorbance * (1.0 - x);
    c[0].y = wavelet_term(x, 0u, absorbance);
    let k1 = u32(x * 2.0);
    c[0].z = select(0.0, wavelet_term(x, 1u, absorbance), k1 == 0u);
    c[0].w = select(0.0, wavelet_term(x, 1u, absorbance), k1 == 1u);
    let k2 = u32(x * 4.0);
    let second = vec4<f32>(wavelet_term(x, 2u, absorbance));
    c[1] = select(vec4<f32>(0.0), second, vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(k2));
    let k3 = u32(x * 8.0);
    let third = vec4<f32>(wavelet_term(x, 3u, absorbance));
    c[2] = select(vec4<f32>(0.0), third, vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(k3));
    c[3] = select(vec4<f32>(0.0), third, vec4<u32>(4u, 5u, 6u, 7u) == vec4<u32>(k3));
    return c;
}

// The mean of optical depth over sixteenth i.
fn wavelet_value(c: array<vec4<f32>, 4>, i: u32) -> f32 {
    var coefficients = c;
    var value = coefficients[0].x;
    for (var j = 0u; j < 4u; j += 1u) {
        let index = (1u << j) + (i >> (4u - j));
        let sign = select(1.0, -1.0, ((i >> (3u - j)) & 1u) == 1u);
        value += sign * exp2(0.5 * f32(j)) * coefficients[index >> 2u][index & 3u];
    }
    return value;
}

// Transmittance in front of a place, from the coefficients of all other fragments.
fn wavelet_transmittance(c: array<vec4<f32>, 4>, place: f32) -> f32 {
    let x = place * 16.0;
    let i = u32(x);
    let before = select(0.0, wavelet_value(c, max(i, 1u) - 1u), i > 0u);
    return clamp(exp(-mix(before, wavelet_value(c, i), fract(x))), 0.0, 1.0);
}
