// Unity: functions for Shader Graph's Custom Function nodes, by their names without the suffix. Keep this file beside
// {include}.
#ifndef {guard}_UNITY
#define {guard}_UNITY

#include "{include}"

// Pass 1: the values of the render targets.
%log void NmtPass1_float(float V, float2 VRange, float Alpha, {out}, out float4 Range) {
%log     NmtSums sums = nmt_pass1(V, VRange.x, VRange.y, Alpha);
%window void NmtPass1_float(float W, float Alpha, {out}, out float4 Range) {
%window     NmtSums sums = nmt_pass1(W, Alpha);
%sums     Sums{i} = sums.sums{i};
    Range = sums.range;
}

// Pass 2: transmittance T in front of the fragment, of what pass 1 left in its pixel. Write (Alpha T Color, Alpha T), blended by
// addition.
%log void NmtPass2_float(float V, float2 VRange, float Alpha, {in}, float4 Range, out float T) {
%log     T = nmt_pass2(V, VRange.x, VRange.y, Alpha, {arguments}, Range);
%window void NmtPass2_float(float W, {in}, float4 Range, out float T) {
%window     T = nmt_pass2(W, {arguments}, Range);
}

// Resolve: what lies over the background, and in alpha how much of the background shows through.
void NmtResolve_float(float4 Weighted, float4 Sums0, out float4 Result) {
    Result = nmt_resolve(Weighted, Sums0);
}

// The same under the graph's precision Half: sums need all of f32 in any case.
%log void NmtPass1_half(float V, float2 VRange, float Alpha, {out}, out float4 Range) {
%log     NmtPass1_float(V, VRange, Alpha, {arguments}, Range);
%window void NmtPass1_half(float W, float Alpha, {out}, out float4 Range) {
%window     NmtPass1_float(W, Alpha, {arguments}, Range);
}

%log void NmtPass2_half(float V, float2 VRange, float Alpha, {in}, float4 Range, out float T) {
%log     NmtPass2_float(V, VRange, Alpha, {arguments}, Range, T);
%window void NmtPass2_half(float W, {in}, float4 Range, out float T) {
%window     NmtPass2_float(W, {arguments}, Range, T);
}

void NmtResolve_half(float4 Weighted, float4 Sums0, out float4 Result) {
    NmtResolve_float(Weighted, Sums0, Result);
}

#endif
