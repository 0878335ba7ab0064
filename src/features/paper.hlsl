// e^x - 1 for 0 <= x <= 1, without the cancellation of exp(x) - 1 near 0; relative error below 1e-7.
float nmt_expm1(float x) {
    return x * (1.0 + x * (0.5 + x * (0.16666667 + x * (0.041666668 + x * (0.008333334 + x * (0.0013888889
        + x * (0.0001984127 + x * (0.000024801588 + x * 0.0000027557319))))))));
}

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return alpha < 0.03 ? faint : -log(max(1.0 - alpha, 0.000045399931));
}

// Pass 1: what a fragment at window depth w adds to b1..b4; to b0 it adds its absorbance.
float4 nmt_moments(float w, float absorbance) {
    float z = 2.0 * w - 1.0;
    float zz = z * z;
    return absorbance * float4(z, zz, zz * z, zz * zz);
}

// Pass 2: the features of a fragment at window depth w, from what pass 1 left in its pixel: least and greatest window depth,
// number of fragments, total absorbance b0 and moments b1..b4.
void nmt_features(float w, float w_min, float w_max, float n, float b0, float4 b1234, out float f[7]) {
    float range = nmt_expm1(w_max - w_min);
    float d = w_max > w_min ? nmt_expm1(w - w_min) / max(range, 1e-30) : 0.0;
    f[0] = d;
    f[1] = n;
    f[2] = b0;
    f[3] = b1234.x;
    f[4] = b1234.y;
    f[5] = b1234.z;
    f[6] = b1234.w;
}
