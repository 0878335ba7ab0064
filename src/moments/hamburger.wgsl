// Transmittance in front of a depth, reconstructed from power moments in f32; twin of hamburger.rs and of numeric/orthogonal.rs.
//
// b = b_0 .. b_2N as pass 1 added them up, z the moment depth, overestimation the weight of the upper bound. Monic orthogonal polynomials pi_k of the
// normalised, biased moments follow from a factorisation L D L^T of their Hankel matrix (Chebyshev's algorithm): x pi_k = pi_{k+1} + mean_k pi_k + ratio_k pi_{k-1},
// D their squared norms. The kernel K(z, x) = sum pi_k(z) pi_k(x) / norm_k has the other atoms of the representation as its roots; they are found as
// s = 1/(x - z), so that an atom at infinity is the harmless s = 0 and the atoms in front are the negative roots. An atom at x has mass 1/K(x, x), and all
// masses add up to 1: of the atoms before and those behind z, the fewer are looked at.
//
// Where rounding leaves moments that no distribution has, the answer is what the arithmetic makes of it, NaN included.

// Beyond the distance 1/POWER_NEAR from z an atom has no mass.
const POWER_NEAR: f32 = 1e-4;

fn power_transmittance_4(b: array<f32, 5>, z: f32, overestimation: f32) -> f32 {
    // Normalised and biased: moment_bias 5e-7 towards (0, 0.375, 0, 0.375).
    let scale = (1.0 - 5e-7) / b[0];
    let m1 = b[1] * scale;
    let m2 = b[2] * scale + 5e-7 * 0.375;
    let m3 = b[3] * scale;
    let m4 = b[4] * scale + 5e-7 * 0.375;

    // Orthogonal polynomials.
    let norm1 = m2 - m1 * m1;
    let row12 = m3 - m1 * m2;
    let row13 = m4 - m1 * m3;
    let per1 = 1.0 / norm1;
    let mean1 = row12 * per1 - m1;
    let per2 = 1.0 / (row13 - mean1 * row12 - norm1 * m2);

    // The kernel about z: s^2 K(z, z) + s c1 + c0.
    let d0 = z - m1;
    let d1 = z - mean1;
    let p2 = d1 * d0 - norm1;
    let f1 = d0 * per1;
    let f2 = p2 * per2;
    let own = 1.0 / (1.0 + f1 * d0 + f2 * p2);
    let s = quadratic_roots(0.5 * (f1 + f2 * (d0 + d1)) * own, f2 * own);

    // The first atom, or both and nothing behind.
    let x = z + 1.0 / s.x;
    let u1 = x - m1;
    let u2 = (x - mean1) * u1 - norm1;
    let mass = 1.0 / (1.0 + u1 * u1 * per1 + u2 * u2 * per2);
    let lower = select(select(0.0, mass, s.x < -POWER_NEAR), 1.0 - own, s.y < 0.0);
    return exp(-b[0] * (lower + overestimation * own));
}

fn power_transmittance_6(b: array<f32, 7>, z: f32, overestimation: f32) -> f32 {
    // Normalised and biased: moment_bias 5e-6 towards (0, 0.48, 0, 0.451, 0, 0.45).
    let scale = (1.0 - 5e-6) / b[0];
    let m1 = b[1] * scale;
    let m2 = b[2] * scale + 5e-6 * 0.48;
    let m3 = b[3] * scale;
    let m4 = b[4] * scale + 5e-6 * 0.451;
    let m5 = b[5] * scale;
    let m6 = b[6] * scale + 5e-6 * 0.45;

    // Orthogonal polynomials.
    let norm1 = m2 - m1 * m1;
    let row12 = m3 - m1 * m2;
    let row13 = m4 - m1 * m3;
    let row14 = m5 - m1 * m4;
    let row15 = m6 - m1 * m5;
    let per1 = 1.0 / norm1;
    let slope1 = row12 * per1;
    let mean1 = slope1 - m1;
    let norm2 = row13 - mean1 * row12 - norm1 * m2;
    let row23 = row14 - mean1 * row13 - norm1 * m3;
    let row24 = row15 - mean1 * row14 - norm1 * m4;
    let per2 = 1.0 / norm2;
    let mean2 = row23 * per2 - slope1;
    let ratio2 = norm2 * per1;
    let per3 = 1.0 / (row24 - mean2 * row23 - ratio2 * row13);

    // The kernel about z: s^3 K(z, z) + s^2 c2 + s c1 + c0.
    let d0 = z - m1;
    let d1 = z - mean1;
    let d2 = z - mean2;
    let p20 = d1 * d0 - norm1;
    let p21 = d0 + d1;
    let p30 = d2 * p20 - ratio2 * d0;
    let p31 = d2 * p21 + p20 - ratio2;
    let f1 = d0 * per1;
    let f2 = p20 * per2;
    let f3 = p30 * per3;
    let own = 1.0 / (1.0 + f1 * d0 + f2 * p20 + f3 * p30);
    let c2 = (f1 + f2 * p21 + f3 * p31) * own;
    let c1 = (f2 + f3 * (d2 + p21)) * own;
    let c0 = f3 * own;

    // One atom, alone on its side of z: signs of the coefficients tell how many of the three are in front, and then it is the outermost root.
    let behind = select(!(c2 <= 0.0 && c1 >= 0.0), c2 > 0.0 && c1 > 0.0, c0 > 0.0);
    let side = select(-1.0, 1.0, behind);
    let t = side * cubic_greatest(side * c2, c1, side * c0);
    let x = z + 1.0 / t;
    let u1 = x - m1;
    let u2 = (x - mean1) * u1 - norm1;
    let u3 = (x - mean2) * u2 - ratio2 * u1;
    let kernel = 1.0 + u1 * u1 * per1 + u2 * u2 * per2 + u3 * u3 * per3;
    let mass = select(0.0, 1.0 / kernel, side * t > POWER_NEAR);
    let lower = select(mass, 1.0 - own - mass, behind);
    return exp(-b[0] * (lower + overestimation * own));
}

fn power_transmittance_8(b: array<f32, 9>, z: f32, overestimation: f32) -> f32 {
    // Normalised and biased: moment_bias 5e-5 towards (0, 0.75, 0, 0.67666667, 0, 0.63, 0, 0.60030303).
    let scale = (1.0 - 5e-5) / b[0];
    let m1 = b[1] * scale;
    let m2 = b[2] * scale + 5e-5 * 0.75;
    let m3 = b[3] * scale;
    let m4 = b[4] * scale + 5e-5 * 0.67666667;
    let m5 = b[5] * scale;
    let m6 = b[6] * scale + 5e-5 * 0.63;
    let m7 = b[7] * scale;
    let m8 = b[8] * scale + 5e-5 * 0.60030303;

    // Orthogonal polynomials.
    let norm1 = m2 - m1 * m1;
    let row12 = m3 - m1 * m2;
    let row13 = m4 - m1 * m3;
    let row14 = m5 - m1 * m4;
    let row15 = m6 - m1 * m5;
    let row16 = m7 - m1 * m6;
    let row17 = m8 - m1 * m7;
    let per1 = 1.0 / norm1;
    let slope1 = row12 * per1;
    let mean1 = slope1 - m1;
    let norm2 = row13 - mean1 * row12 - norm1 * m2;
    let row23 = row14 - mean1 * row13 - norm1 * m3;
    let row24 = row15 - mean1 * row14 - norm1 * m4;
    let row25 = row16 - mean1 * row15 - norm1 * m5;
    let row26 = row17 - mean1 * row16 - norm1 * m6;
    let per2 = 1.0 / norm2;
    let slope2 = row23 * per2;
    let mean2 = slope2 - slope1;
    let ratio2 = norm2 * per1;
    let norm3 = row24 - mean2 * row23 - ratio2 * row13;
    let row34 = row25 - mean2 * row24 - ratio2 * row14;
    let row35 = row26 - mean2 * row25 - ratio2 * row15;
    let per3 = 1.0 / norm3;
    let mean3 = row34 * per3 - slope2;
    let ratio3 = norm3 * per2;
    let per4 = 1.0 / (row35 - mean3 * row34 - ratio3 * row24);

    // The kernel about z: s^4 K(z, z) + s^3 c3 + s^2 c2 + s c1 + c0.
    let d0 = z - m1;
    let d1 = z - mean1;
    let d2 = z - mean2;
    let d3 = z - mean3;
    let p20 = d1 * d0 - norm1;
    let p21 = d0 + d1;
    let p30 = d2 * p20 - ratio2 * d0;
    let p31 = d2 * p21 + p20 - ratio2;
    let p32 = d2 + p21;
    let p40 = d3 * p30 - ratio3 * p20;
    let p41 = d3 * p31 + p30 - ratio3 * p21;
    let p42 = d3 * p32 + p31 - ratio3;
    let f1 = d0 * per1;
    let f2 = p20 * per2;
    let f3 = p30 * per3;
    let f4 = p40 * per4;
    let own = 1.0 / (1.0 + f1 * d0 + f2 * p20 + f3 * p30 + f4 * p40);
    let c3 = (f1 + f2 * p21 + f3 * p31 + f4 * p41) * own;
    let c2 = (f2 + f3 * p32 + f4 * p42) * own;
    let c1 = (f3 + f4 * (d3 + p32)) * own;
    let s = quartic_roots(c3, c2, c1, f4 * own);

    // Two atoms: the lower pair, or where the third is in front too the upper one.
    let behind = s.z < 0.0;
    let t = select(s.xy, s.zw, behind);
    let x = z + 1.0 / t;
    let u1 = x - m1;
    let u2 = (x - mean1) * u1 - norm1;
    let u3 = (x - mean2) * u2 - ratio2 * u1;
    let u4 = (x - mean3) * u3 - ratio3 * u2;
    let kernel = 1.0 + u1 * u1 * per1 + u2 * u2 * per2 + u3 * u3 * per3 + u4 * u4 * per4;
    let masses = select(vec2<f32>(0.0), 1.0 / kernel, select(-t, t, behind) > vec2<f32>(POWER_NEAR));
    let mass = masses.x + masses.y;
    let lower = select(mass, 1.0 - own - mass, behind);
    return exp(-b[0] * (lower + overestimation * own));
}
