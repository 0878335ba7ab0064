// What every pass of a frame knows.
struct Frame {
    clip_from_world: mat4x4<f32>,
    view_from_world: mat4x4<f32>,
    // Where the viewer stands; opacity multiplies absorbance.
    eye: vec3<f32>,
    opacity: f32,
    // View depths that every fragment lies between, for moment depth.
    range: vec2<f32>,
    // Columns and rows of the image.
    size: vec2<f32>,
    // Pixels that a unit length covers at view depth 1.
    focal: f32,
    // Strength of highlights.
    gloss: f32,
    // Width of a strand [scene units].
    strand_width: f32,
    // A power of two that takes every v below 1, for depth buffers.
    depth_scale: f32,
    // Linear colour of a plain backdrop; w is 1 where the backdrop is a studio instead.
    backdrop: vec4<f32>,
    // Half the side of the floor, first row of a band of lists, number of nodes that lists may take, 1 where one colour
    // paints all.
    floor: f32,
    first_row: u32,
    capacity: u32,
    one_color: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// A fragment of a transparent surface: distance along the view direction, linear colour, opacity. Opacity below 0:
// nothing is there.
struct Surface { v: f32, color: vec3<f32>, alpha: f32 }

// The slider multiplies absorbance.
fn with_opacity(v: f32, color: vec3<f32>, alpha: f32) -> Surface {
    let clear = pow(clamp(1.0 - alpha, 0.0, 1.0), frame.opacity);
    return Surface(v, select(color, vec3<f32>(0.8, 0.35, 0.1), frame.one_color > 0.5), 1.0 - clear);
}

// Light of a lamp and of the surroundings on a thin surface, which both sides let through.
fn light_on(normal: vec3<f32>) -> f32 {
    let lamp = vec3<f32>(-0.44653, 0.74421, 0.49614);
    let fill = vec3<f32>(0.79603, 0.0995, 0.59702);
    return 0.42 + 0.5 * abs(dot(normal, lamp)) + 0.12 * abs(dot(normal, fill));
}
