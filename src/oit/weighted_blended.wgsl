// Weights of weighted blended transparency at view depth v, window depth w and opacity alpha; twin of weighted_blended.rs.

fn square(x: f32) -> f32 {
    return x * x;
}

fn cube(x: f32) -> f32 {
    return x * x * x;
}

fn weight_mb13_7(v: f32, w: f32, alpha: f32) -> f32 {
    return alpha * clamp(10.0 / (1e-5 + square(v * 0.2) + cube(square(v * 0.005))), 1e-2, 3e3);
}

fn weight_mb13_8(v: f32, w: f32, alpha: f32) -> f32 {
    return alpha * clamp(10.0 / (1e-5 + cube(v * 0.1) + cube(square(v * 0.005))), 1e-2, 3e3);
}

fn weight_mb13_9(v: f32, w: f32, alpha: f32) -> f32 {
    return alpha * clamp(0.03 / (1e-5 + square(square(v * 0.005))), 1e-2, 3e3);
}

fn weight_mb13_10(v: f32, w: f32, alpha: f32) -> f32 {
    return alpha * max(3e3 * cube(1.0 - w), 1e-2);
}

fn weight_dwb22(v: f32, w: f32, alpha: f32) -> f32 {
    return alpha * 8.0;
}

fn weight_dwb22_small(v: f32, w: f32, alpha: f32) -> f32 {
    return alpha * clamp(0.3e-5 + square(square(1.0 - v * 0.005)), 1e-2, 8.0);
}

fn weight_dwb22_shader(v: f32, w: f32, alpha: f32) -> f32 {
    return alpha * clamp(0.3 / (1e-5 + square(square((1.0 - v) * 0.005))), 1e-2, 1.0);
}
