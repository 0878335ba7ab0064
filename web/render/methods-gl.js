// The methods of WebGL 2: what methods.js says of them, in GLSL ES 3.00. `ends` says that pass 2 looks at nearest and
// farthest fragment, `writtenEnds` what a fragment writes of itself where that is not -v and v.

// Absorbance and moment depth, of methods whose own files have none, are those of a network's file.
const COMMON = "shaders/small/small.glsl";
const DEPTH = "nmt_moment_depth(s.v, frame.range.x, frame.range.y)";

const FIRST_IS_TOTAL = `
float total(ivec2 at) {
    return texelFetch(target0, at, 0).x;
}
`;

function network(name, file = `${name}.glsl`) {
  return {
    rounds: true,
    functions: [`shaders/${name}/${file}`],
    formats: ["rgba32f", "rg32f"],
    half: ["rgba16f", "rg16f"],
    ends: true,
    accumulate: `
layout(location = 0) out vec4 out0;
layout(location = 1) out vec4 out1;
void accumulate(Surface s, ivec2 at) {
    NmtSums sums = nmt_pass1(s.v, frame.range.x, frame.range.y, s.alpha);
    out0 = sums.sums0;
    out1 = sums.sums1;
}
`,
    weight: `
float weight(Surface s, ivec2 at) {
    vec2 ends = ends_of(at);
    return nmt_pass2(
        s.v, frame.range.x, frame.range.y, s.alpha,
        texelFetch(target0, at, 0), texelFetch(target1, at, 0), vec4(-ends.x, ends.y, 0.0, 0.0));
}
`,
    total: FIRST_IS_TOTAL,
  };
}

/** The same where the ends are codes of fragments. */
function ends(name) {
  return {
    ...network(name, `${name}.chain.glsl`),
    half: undefined,
    writtenEnds: `
vec2 written_ends(Surface s) {
    return nmt_pass1(s.v, frame.range.x, frame.range.y, s.alpha).range.xy;
}
`,
  };
}

export const GL_METHODS = {
  exact: {},
  sorted: {},
  "weighted-blended": {
    functions: [COMMON],
    formats: ["r32f"],
    half: ["r16f"],
    accumulate: `
layout(location = 0) out vec4 out0;
void accumulate(Surface s, ivec2 at) {
    out0 = vec4(nmt_absorbance(s.alpha), 0.0, 0.0, 0.0);
}
`,
    // McGuire and Bavoil 2013, Eq. 9; twin of weight_mb13_9 in src/oit/weighted_blended.wgsl.
    weight: `
float weight(Surface s, ivec2 at) {
    float near = s.v * 0.005;
    return s.alpha * clamp(0.03 / (1e-5 + near * near * near * near), 1e-2, 3e3);
}
`,
    total: FIRST_IS_TOTAL,
  },
  "moment-power-4": {
    functions: [COMMON, "web/glsl/moments.glsl"],
    formats: ["rgba32f", "r32f"],
    accumulate: `
layout(location = 0) out vec4 out0;
layout(location = 1) out vec4 out1;
void accumulate(Surface s, ivec2 at) {
    float a = nmt_absorbance(s.alpha);
    float z = ${DEPTH};
    out0 = a * vec4(1.0, z, z * z, z * z * z);
    out1 = vec4(a * z * z * z * z, 0.0, 0.0, 0.0);
}
`,
    weight: `
float weight(Surface s, ivec2 at) {
    vec4 b0123 = texelFetch(target0, at, 0);
    vec4 b1234 = vec4(b0123.yzw, texelFetch(target1, at, 0).x);
    return b0123.x == 0.0 ? 1.0 : power_transmittance_4(b0123.x, b1234, ${DEPTH}, 0.25);
}
`,
    total: FIRST_IS_TOTAL,
  },
  wavelet: {
    functions: [COMMON, "web/glsl/wavelet.glsl"],
    formats: ["rgba16f", "rgba16f", "rgba16f", "rgba16f"],
    half: ["rgba16f", "rgba16f", "rgba16f", "rgba16f"],
    ends: true,
    prepass: true,
    accumulate: `
layout(location = 0) out vec4 out0;
layout(location = 1) out vec4 out1;
layout(location = 2) out vec4 out2;
layout(location = 3) out vec4 out3;
void accumulate(Surface s, ivec2 at) {
    vec4 c[4];
    wavelet_terms(wavelet_place(s.v, ends_of(at)), nmt_absorbance(s.alpha), c);
    out0 = c[0];
    out1 = c[1];
    out2 = c[2];
    out3 = c[3];
}
`,
    weight: `
float weight(Surface s, ivec2 at) {
    float x = wavelet_place(s.v, ends_of(at));
    vec4 own[4];
    wavelet_terms(x, nmt_absorbance(s.alpha), own);
    vec4 others[4] = vec4[4](
        texelFetch(target0, at, 0) - own[0], texelFetch(target1, at, 0) - own[1],
        texelFetch(target2, at, 0) - own[2], texelFetch(target3, at, 0) - own[3]);
    return wavelet_transmittance(others, x);
}
`,
    total: `
float total(ivec2 at) {
    return max(wavelet_value(vec4[4](
        texelFetch(target0, at, 0), texelFetch(target1, at, 0),
        texelFetch(target2, at, 0), texelFetch(target3, at, 0)), 15), 0.0);
}
`,
  },
  small: network("small"),
  recommended: network("recommended"),
  ends: ends("ends"),
};
