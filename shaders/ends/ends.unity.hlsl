// Unity: functions for Shader Graph's Custom Function nodes, by their names without the suffix. Keep this file beside
// ends.chain.hlsl.
#ifndef NMT_INCLUDED_ENDS_UNITY
#define NMT_INCLUDED_ENDS_UNITY

#include "ends.chain.hlsl"

// Pass 1: the values of the render targets.
void NmtPass1_float(float V, float2 VRange, float Alpha, out float4 Sums0, out float4 Sums1, out float4 Range) {
    NmtSums sums = nmt_pass1(V, VRange.x, VRange.y, Alpha);
    Sums0 = sums.sums0;
    Sums1 = sums.sums1;
    Range = sums.range;
}

// Pass 2: transmittance T in front of the fragment, of what pass 1 left in its pixel. Write (Alpha T Color, Alpha T), blended by
// addition.
void NmtPass2_float(float V, float2 VRange, float Alpha, float4 Sums0, float4 Sums1, float4 Range, out float T) {
    T = nmt_pass2(V, VRange.x, VRange.y, Alpha, Sums0, Sums1, Range);
}

// Resolve: what lies over the background, and in alpha how much of the background shows through.
void NmtResolve_float(float4 Weighted, float4 Sums0, out float4 Result) {
    Result = nmt_resolve(Weighted, Sums0);
}

// The same under the graph's precision Half: sums need all of f32 in any case.
void NmtPass1_half(float V, float2 VRange, float Alpha, out float4 Sums0, out float4 Sums1, out float4 Range) {
    NmtPass1_float(V, VRange, Alpha, Sums0, Sums1, Range);
}

void NmtPass2_half(float V, float2 VRange, float Alpha, float4 Sums0, float4 Sums1, float4 Range, out float T) {
    NmtPass2_float(V, VRange, Alpha, Sums0, Sums1, Range, T);
}

void NmtResolve_half(float4 Weighted, float4 Sums0, out float4 Result) {
    NmtResolve_float(Weighted, Sums0, Result);
}

#endif
