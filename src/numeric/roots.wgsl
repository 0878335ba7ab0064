// Roots of polynomials that have only real ones, in closed form; twin of roots.rs. Leading coefficients are 1. Square roots of what rounding alone makes
// negative are 0.

// cos(acos(x)/3), the largest root g of 4 g^3 - 3 g = x, for x in [-1, 1].
//
// With y = cos(acos(x)/2) it is cos(2 acos(y)/3), which is analytic on [0, 1]: a polynomial of degree 6 is within 2.1e-7 of it, rounding included.
fn cosine_of_third(x: f32) -> f32 {
    let y = sqrt(0.5 + 0.5 * clamp(x, -1.0, 1.0));
    return 0.50000018 + y * (0.57733345 + y * (-0.110823043 + y * (0.051547911 + y * (-0.0265382174 + y * (0.0106230499 - 0.00214344822 * y)))));
}

// Both roots of s^2 + 2 half s + c, the lesser first.
fn quadratic_roots(half: f32, c: f32) -> vec2<f32> {
    let distance = sqrt(max(half * half - c, 0.0));
    // The root without cancellation, and the other from their product.
    let sum = select(-half - distance, distance - half, half < 0.0);
    let other = select(c / sum, 0.0, sum == 0.0);
    return vec2<f32>(min(sum, other), max(sum, other));
}

// The parts of s^3 + a s^2 + b s + c about the mean of its roots: mean, twice the radius r of the circle that their places are projected from, and
// cos(3 phi), so that the roots are mean + 2 r cos(phi + k 2 pi/3).
fn cubic_circle(a: f32, b: f32, c: f32) -> vec3<f32> {
    let mean = -0.33333334 * a;
    let square = max(mean * mean - 0.33333334 * b, 1e-20);
    let per_radius = inverseSqrt(square);
    let at_mean = c + mean * (b + mean * (a + mean));
    return vec3<f32>(mean, 2.0 * square * per_radius, -0.5 * at_mean * per_radius * per_radius * per_radius);
}

// The root of s^3 + a s^2 + b s + c with the greatest value.
fn cubic_greatest(a: f32, b: f32, c: f32) -> f32 {
    let circle = cubic_circle(a, b, c);
    return circle.x + circle.y * cosine_of_third(circle.z);
}

// All roots of s^3 + a s^2 + b s + c in ascending order.
fn cubic_roots(a: f32, b: f32, c: f32) -> vec3<f32> {
    let circle = cubic_circle(a, b, c);
    let high = circle.y * cosine_of_third(circle.z);
    let low = -circle.y * cosine_of_third(-circle.z);
    return vec3<f32>(circle.x + low, circle.x - low - high, circle.x + high);
}

// All roots of s^4 + a s^3 + b s^2 + c s + d in ascending order.
//
// About their mean the two lower ones add up to -w and the two upper ones to w, w^2 the greatest root of the resolvent cubic.
fn quartic_roots(a: f32, b: f32, c: f32, d: f32) -> vec4<f32> {
    // t^4 + p t^2 + q t + r, t = s - mean.
    let mean = -0.25 * a;
    let a1 = a + mean;
    let b1 = b + mean * a1;
    let c1 = c + mean * b1;
    let a2 = a1 + mean;
    let b2 = b1 + mean * a2;
    let p = b2 + mean * (a2 + mean);
    let q = c1 + mean * b2;
    let r = d + mean * c1;
    let square = max(cubic_greatest(2.0 * p, p * p - 4.0 * r, -q * q), 1e-20);
    let per_w = inverseSqrt(square);
    let half_w = 0.5 * square * per_w;
    // Products of either pair.
    let middle = 0.5 * (p + square);
    let apart = 0.5 * q * per_w;
    let lower = sqrt(max(half_w * half_w - (middle - apart), 0.0));
    let upper = sqrt(max(half_w * half_w - (middle + apart), 0.0));
    let below = mean - half_w;
    let above = mean + half_w;
    return vec4<f32>(below - lower, below + lower, above - upper, above + upper);
}
