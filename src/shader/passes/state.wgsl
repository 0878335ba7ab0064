// What pass 1 left in a pixel.

OIT_TEXTURES

fn oit_sums(at: vec2<i32>) -> array<f32, OIT_SUMS> {
    OIT_LOADS
    return array<f32, OIT_SUMS>(OIT_PARTS);
}

// Number of fragments; 0 where the method does not count them.
fn oit_count(at: vec2<i32>) -> f32 {
    return OIT_COUNT;
}
