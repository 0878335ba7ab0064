// What pass 1 left in a pixel.
fn oit_pixel(pixel: u32) -> OitPixel {
    OIT_LOAD
    return OitPixel(array<f32, OIT_SUMS>(OIT_PARTS), OIT_RANGE OIT_CORE_MEMBER);
}
