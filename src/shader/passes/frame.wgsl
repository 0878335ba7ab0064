// What every pass of a frame knows.
struct OitFrame {
    // What oit_depth measures by.
    range: vec2<f32>,
    // Columns and rows of the image.
    size: vec2<u32>,
    // Linear colour behind everything.
    background: vec4<f32>,
    // A power of two that takes every v below 1, and its inverse; for depth buffers.
    scale: vec2<f32>,
    // Numbers that make codes of fragments, where a core is kept: the first as integers.
    codes: vec4<i32>,
    more_codes: vec4<u32>,
}

@group(0) @binding(0) var<uniform> oit_frame: OitFrame;
