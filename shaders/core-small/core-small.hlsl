// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// HLSL, shader model 5 and later.
//
// Features, set 'core-2-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^10, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail; lower and upper =
// least and greatest share of the tail in front of x that m_1..m_4 allow (of fewer moments, m_1 and m_2, or m_1
// alone): Markov's bounds. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 4cb0c11bc9538ca61a2ffd6e935d976f36720f667fe3b7ae3813684c758f300e.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.533e-3, worst 1.000.

#ifndef NMT_INCLUDED_CORE_SMALL
#define NMT_INCLUDED_CORE_SMALL

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
float3x4 nmt_features(float x, float count, float ln_b0, float lower, float upper, float4 tail) {
    return float3x4(float4(x, count, ln_b0, lower), float4(upper, tail.xyz), float4(tail.w, 0.0, 0.0, 0.0));
}

static const float4x4 NMT_W1[12] = {
    float4x4(float4(4.8778276f, -0.7319692f, 3.6530824f, -1.6481752f), float4(-0.24516319f, -0.27494642f, -0.023510791f, 0.11400228f), float4(0.228575f, 0.25520048f, 0.13499178f, -0.10372328f), float4(-0.5467422f, 2.6183908f, 8.650195f, -1.3826258f)),
    float4x4(float4(-5.8551807f, -1.0576799f, 2.7924774f, -8.082505f), float4(-2.5652757f, 2.1842368f, -0.101185136f, 0.8496825f), float4(0.11754783f, 1.1701148f, 0.4261731f, 1.0241573f), float4(-0.5958086f, 0.81029135f, -0.8975072f, -1.8926371f)),
    float4x4(float4(1.3035642f, -0.14273503f, -0.14144559f, 2.2584605f), float4(5.9671373f, 1.4847919f, 3.1871316f, 1.8420736f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.098758f, 2.3643606f, 1.9390315f, -0.025061242f), float4(0.013713428f, 0.24798474f, -0.17473f, 0.1092438f), float4(-0.016801622f, -0.1513876f, 0.054045714f, -0.00874805f), float4(14.739972f, -164.7957f, 7.3871503f, -26.957058f)),
    float4x4(float4(-8.423298f, -16.265095f, -6.763347f, -3.6461272f), float4(5.1973667f, -6.2610235f, -5.804388f, -0.79259384f), float4(-5.0187683f, -2.1178577f, -0.1445185f, -0.47444504f), float4(-5.852785f, 4.4160266f, 4.6112943f, -0.07370595f)),
    float4x4(float4(0.495891f, 6.758663f, -0.74108994f, -2.9599438f), float4(-0.9314051f, 1.3079683f, 2.440642f, 4.655624f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-7.4299335f, -0.2297995f, -3.6704452f, 3.7584605f), float4(-0.10068613f, 0.116125256f, -0.20114587f, 0.06323509f), float4(0.11217993f, -0.048117194f, 0.16280521f, 0.034884017f), float4(1.0506787f, 10.068197f, 13.049514f, -17.764614f)),
    float4x4(float4(-1.1598299f, 6.9126554f, -11.887382f, -10.6937065f), float4(-0.5063457f, 1.4594547f, 2.707645f, -0.41473576f), float4(0.3520074f, -0.93157744f, -5.942758f, 7.43136f), float4(0.032555133f, -0.83957905f, 0.4354543f, -3.0254202f)),
    float4x4(float4(-0.03307929f, 0.2872462f, 0.307582f, -20.961397f), float4(-6.8072767f, -1.608604f, -0.09493034f, 3.3601375f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.1927843f, -0.7596912f, 0.0f, 0.0f), float4(-0.16797958f, -0.28360534f, 0.0f, 0.0f), float4(0.097345725f, 0.1268056f, 0.0f, 0.0f), float4(1.7302861f, 0.53903437f, 0.0f, 0.0f)),
    float4x4(float4(0.5574605f, -7.9472857f, 0.0f, 0.0f), float4(-2.2368462f, 6.9823356f, 0.0f, 0.0f), float4(-3.3104074f, -10.6633005f, 0.0f, 0.0f), float4(4.8967834f, -6.983885f, 0.0f, 0.0f)),
    float4x4(float4(5.501963f, 0.5043578f, 0.0f, 0.0f), float4(-4.593644f, 1.2066915f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[8] = {
    float4x4(float4(1.7685847f, -1.2965266f, 0.53486013f, -0.29221267f), float4(0.5022446f, -0.57678044f, 2.8619845f, 1.1610198f), float4(-1.510298f, 1.0492433f, -2.4719512f, 0.69602823f), float4(0.4245065f, -0.021788223f, -2.2097266f, 0.45277822f)),
    float4x4(float4(-1.9844544f, -4.284621f, -2.0162687f, 0.80677956f), float4(-0.08269256f, 0.83371484f, 1.4538207f, -0.3430089f), float4(0.33549848f, 1.315723f, -2.6486657f, -0.9424922f), float4(0.6682035f, 0.7352949f, 0.77444446f, 1.5549136f)),
    float4x4(float4(-3.7106292f, 1.4094218f, -3.0866914f, 6.321356f), float4(2.9056916f, -1.6683085f, 2.5197487f, -0.12306516f), float4(1.8786901f, 2.9980502f, 0.53554356f, 0.6986177f), float4(-1.4987996f, 0.16394545f, -11.833226f, -0.9698973f)),
    float4x4(float4(0.105152994f, -2.629642f, -0.26539943f, 0.97390944f), float4(0.20291848f, -4.665007f, -3.2223794f, -1.1747206f), float4(-3.0591586f, 2.422517f, -0.3822718f, -1.1229484f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.5065336f, 1.2751687f, -3.1727622f, 2.6094267f), float4(-0.34650132f, -0.58315194f, -2.036526f, -0.97464854f), float4(3.4674072f, 1.1141264f, -2.0562246f, -1.5358669f), float4(-0.8401374f, 1.7635139f, 0.88128996f, 1.1690073f)),
    float4x4(float4(0.62812424f, -0.6253937f, 0.07006818f, -0.3447436f), float4(4.757243f, 4.1627517f, -0.32235038f, 1.8340607f), float4(0.95672405f, -0.06239507f, -0.2886359f, -0.745714f), float4(-2.170308f, -2.8018155f, 0.12480712f, -2.8756857f)),
    float4x4(float4(-0.46313936f, -0.42326838f, 13.634587f, -0.8679801f), float4(-3.8175569f, 0.6408508f, 0.8411556f, 1.3615565f), float4(0.9755631f, 0.9696179f, 0.1144694f, 1.0314378f), float4(1.4169557f, -0.5175313f, -0.8745645f, -0.68139124f)),
    float4x4(float4(-0.31971556f, 0.8106935f, 0.48868963f, -0.17111878f), float4(0.9139772f, -0.97476697f, -7.719652f, -1.006329f), float4(4.2278967f, -1.388446f, -2.153287f, 4.008335f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4 NMT_W3[2] = {
    float4(-0.2411506f, 0.1824429f, 0.16963111f, -0.3715353f),
    float4(-0.2563782f, 0.3967364f, -1.0420152f, -0.3345766f)
};
static const float NMT_B3 = 0.17377278f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(float3x4 f) {
    float4 h0_0 = f[0];
    float4 h0_1 = f[1];
    float4 h0_2 = float4(f[2].x, 1.0f, 0.0f, 0.0f);
    float4 h1_0 = max(mul(h0_0, NMT_W1[0]) + mul(h0_1, NMT_W1[1]) + mul(h0_2, NMT_W1[2]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_1 = max(mul(h0_0, NMT_W1[3]) + mul(h0_1, NMT_W1[4]) + mul(h0_2, NMT_W1[5]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_2 = max(mul(h0_0, NMT_W1[6]) + mul(h0_1, NMT_W1[7]) + mul(h0_2, NMT_W1[8]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_3 = max(mul(h0_0, NMT_W1[9]) + mul(h0_1, NMT_W1[10]) + mul(h0_2, NMT_W1[11]), float4(0.0f, 0.0f, 0.0f, 0.0f)) + float4(0.0f, 0.0f, 1.0f, 0.0f);
    float4 h2_0 = max(mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]) + mul(h1_3, NMT_W2[3]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(mul(h1_0, NMT_W2[4]) + mul(h1_1, NMT_W2[5]) + mul(h1_2, NMT_W2[6]) + mul(h1_3, NMT_W2[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float3x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

#endif
