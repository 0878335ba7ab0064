// Pass 1 for one end of the range by a depth test, where f32 targets cannot be blended into. A power of two takes no
// bit from v.

@fragment
fn oit_pass1(f: OitVarying) -> @builtin(frag_depth) f32 {
    return f.v * oit_frame.scale.x;
}
