// Transmittance in front of a depth, reconstructed from trigonometric moments in f32; twin of trigonometric.rs and of numeric/unit_circle.rs.
//
// b = b_0, Re b_1, Im b_1, .. as pass 1 added them up, z the moment depth, overestimation the share of the atom at z itself.
//
// All is turned so that the fragment's own point of the circle is 1. Monic Szego polynomials phi_{k+1} = x phi_k - r_k phi*_k of the moments follow from Levinson's
// algorithm, E_k their squared norms. Their kernel K(1, x) = sum conj(phi_k(1)) phi_k(x) / E_k has the other atoms as its roots, all on the circle. With
// x = -(1 + i s)/(1 - i s) the circle without 1 becomes the real line and the kernel a real polynomial in s, which grows with the angle. An atom at x has
// mass 1/K(x, x), and all masses add up to 1: of the atoms before and those behind z, the fewer are looked at.
//
// The coefficients q of K(1, x) are conjugate to one another from both ends. Where moments are nearly those of few atoms, phi(1) is a small number that rounding
// changes, and either end alone is off by as much; their mean vanishes where it should.

// Half of the arc 2 pi - theta that depths map to, theta = pi/10 the wrapping zone.
const TRIGONOMETRIC_HALF_ARC: f32 = 2.984513;
// cos and sin of theta/2.
const TRIGONOMETRIC_ZONE: vec2<f32> = vec2<f32>(0.98768836, 0.15643448);
// re + im at the end of the arc, and 1/(1 - that): the ramp across the zone.
const TRIGONOMETRIC_RAMP: vec2<f32> = vec2<f32>(0.6420395, 2.7936045);

fn complex_times(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

// conj(a) b
fn complex_conjugate_times(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(a.x * b.x + a.y * b.y, a.x * b.y - a.y * b.x);
}

fn complex_conjugate(a: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(a.x, -a.y);
}

// cos and sin of half the angle that stands for depth z. Both passes must take the same point for a depth, and it must lie on the circle, to all digits: the angle's
// own are worth less. A Newton step towards length 1 makes up for what the device's functions leave.
fn half_circle_point(z: f32) -> vec2<f32> {
    let angle = TRIGONOMETRIC_HALF_ARC * (0.5 + 0.5 * z);
    let point = vec2<f32>(cos(angle), sin(angle));
    return point * (1.5 - 0.5 * dot(point, point));
}

// The point of the circle itself: x^2 of a point x.
fn complex_square(x: vec2<f32>) -> vec2<f32> {
    return vec2<f32>((x.x - x.y) * (x.x + x.y), 2.0 * x.x * x.y);
}

// Angles of the circle as values of s: where atoms cease to be behind z, and where they begin to be in front.
struct TrigonometricEnds { behind: f32, front: f32 }

fn trigonometric_ends(half: vec2<f32>) -> TrigonometricEnds {
    let zone = TRIGONOMETRIC_ZONE;
    let to_end = complex_times(half, zone);
    // At the ends of the arc a sine is 0, or what rounding makes of it.
    return TrigonometricEnds(to_end.x / max(to_end.y, 1e-12), half.x / max(half.y, 1e-12));
}

// Places on the circle, conjugate and turned back by z: x = -(1 + i s)/(1 - i s).
fn conjugate_of_s(s: f32) -> vec2<f32> {
    let scale = 1.0 / (1.0 + s * s);
    return vec2<f32>((s * s - 1.0) * scale, 2.0 * s * scale);
}

// Share of an atom that counts as in front.
fn trigonometric_share(s: f32, conjugate: vec2<f32>, here: vec2<f32>, ends: TrigonometricEnds) -> f32 {
    let x = complex_conjugate_times(conjugate, here);
    let ramp = clamp((x.x + x.y - TRIGONOMETRIC_RAMP.x) * TRIGONOMETRIC_RAMP.y, 0.0, 1.0);
    return select(select(0.0, ramp, s > ends.behind), 1.0, s > ends.front);
}

fn trigonometric_transmittance_2(b: array<f32, 5>, z: f32, overestimation: f32) -> f32 {
    let half = half_circle_point(z);
    let here = complex_square(half);
    let ends = trigonometric_ends(half);

    // Normalised, biased by moment_bias 4e-7, and turned.
    let scale = (1.0 - 4e-7) / b[0];
    let m1 = complex_conjugate_times(here, vec2<f32>(b[1], b[2])) * scale;
    let m2 = complex_conjugate_times(complex_square(here), vec2<f32>(b[3], b[4])) * scale;

    // Szego polynomials, their values u at 1 and the reciprocals of their norms.
    let u1 = vec2<f32>(1.0, 0.0) - m1;
    let e1 = 1.0 - dot(m1, m1);
    let per1 = 1.0 / e1;
    let r1 = (m2 - complex_square(m1)) * per1;
    let u2 = u1 - complex_times(r1, complex_conjugate(u1));
    let per2 = 1.0 / (e1 * (1.0 - dot(r1, r1)));
    let p21 = complex_conjugate_times(m1, r1) - m1;

    // The kernel: q1 (real) and q2, then its polynomial in s.
    let f1 = complex_conjugate(u1) * per1;
    let f2 = complex_conjugate(u2) * per2;
    let q0 = vec2<f32>(1.0, 0.0) - complex_times(f1, m1) - complex_times(f2, r1);
    let q1 = dot(f2, complex_conjugate(p21)) + f1.x;
    let q2 = 0.5 * (f2 + complex_conjugate(q0));
    let own = 1.0 / (q1 + 2.0 * q2.x);
    let s = quadratic_roots(2.0 * q2.y * own, (q1 - 2.0 * q2.x) * own);

    // One atom: the last, or, where the first is not behind z, that one.
    let all = s.x <= ends.behind;
    let t = select(s.x, s.y, all);
    let x = conjugate_of_s(t);
    let share = trigonometric_share(t, x, here, ends);
    let v1 = vec2<f32>(1.0, 0.0) - complex_times(m1, x);
    let v2 = v1 - complex_times(complex_times(r1, complex_square(x)), complex_conjugate(v1));
    let mass = select(1.0 - share, share, all) / (1.0 + dot(v1, v1) * per1 + dot(v2, v2) * per2);
    let front = select(1.0 - own - mass, mass, all);
    return exp(-b[0] * (front + overestimation * own));
}

fn trigonometric_transmittance_3(b: array<f32, 7>, z: f32, overestimation: f32) -> f32 {
    let half = half_circle_point(z);
    let here = complex_square(half);
    let ends = trigonometric_ends(half);

    // Normalised, biased by moment_bias 8e-7, and turned.
    let scale = (1.0 - 8e-7) / b[0];
    let here2 = complex_square(here);
    let m1 = complex_conjugate_times(here, vec2<f32>(b[1], b[2])) * scale;
    let m2 = complex_conjugate_times(here2, vec2<f32>(b[3], b[4])) * scale;
    let m3 = complex_conjugate_times(complex_times(here2, here), vec2<f32>(b[5], b[6])) * scale;

    // Szego polynomials, their values u at 1 and the reciprocals of their norms.
    let u1 = vec2<f32>(1.0, 0.0) - m1;
    let e1 = 1.0 - dot(m1, m1);
    let per1 = 1.0 / e1;
    let r1 = (m2 - complex_square(m1)) * per1;
    let p21 = complex_conjugate_times(m1, r1) - m1;
    let u2 = u1 - complex_times(r1, complex_conjugate(u1));
    let e2 = e1 * (1.0 - dot(r1, r1));
    let per2 = 1.0 / e2;
    let r2 = (m3 + complex_times(p21, m2) - complex_times(r1, m1)) * per2;
    let minus_p31 = complex_times(r2, complex_conjugate(p21)) + r1;
    let p32 = p21 + complex_conjugate_times(r1, r2);
    let u3 = u2 - complex_times(r2, complex_conjugate(u2));
    let per3 = 1.0 / (e2 * (1.0 - dot(r2, r2)));

    // The kernel: q2 and q3, then its polynomial in s.
    let f1 = complex_conjugate(u1) * per1;
    let f2 = complex_conjugate(u2) * per2;
    let f3 = complex_conjugate(u3) * per3;
    let q0 = vec2<f32>(1.0, 0.0) - complex_times(f1, m1) - complex_times(f2, r1) - complex_times(f3, r2);
    let q1 = f1 + complex_times(f2, p21) - complex_times(f3, minus_p31);
    let q2 = 0.5 * (f2 + complex_times(f3, p32) + complex_conjugate(q1));
    let q3 = 0.5 * (f3 + complex_conjugate(q0));
    let lead = 1.0 / (q2.x + q3.x);
    let own = 0.5 * lead;
    let s = cubic_roots((q2.y + 3.0 * q3.y) * lead, (q2.x - 3.0 * q3.x) * lead, (q2.y - q3.y) * lead);

    // Two atoms: the last and the middle one, or, where that is not behind z, the first and the middle one.
    let all = s.y <= ends.behind;
    let ta = select(s.x, s.z, all);
    let xa = conjugate_of_s(ta);
    let xb = conjugate_of_s(s.y);
    let share_a = trigonometric_share(ta, xa, here, ends);
    let share_b = trigonometric_share(s.y, xb, here, ends);
    let mass_a = select(1.0 - share_a, share_a, all) / trigonometric_kernel_3(xa, m1, r1, r2, vec3<f32>(per1, per2, per3));
    let mass_b = select(1.0 - share_b, 0.0, all) / trigonometric_kernel_3(xb, m1, r1, r2, vec3<f32>(per1, per2, per3));
    let mass = mass_a + mass_b;
    let front = select(1.0 - own - mass, mass, all);
    return exp(-b[0] * (front + overestimation * own));
}

// K(x, x) of a point whose conjugate is x: on the circle v_k = conj(x)^k phi_k follows from v_{k+1} = v_k - r_k conj(x)^{k+1} conj(v_k).
fn trigonometric_kernel_3(x: vec2<f32>, r0: vec2<f32>, r1: vec2<f32>, r2: vec2<f32>, per: vec3<f32>) -> f32 {
    let x2 = complex_square(x);
    let v1 = vec2<f32>(1.0, 0.0) - complex_times(r0, x);
    let v2 = v1 - complex_times(complex_times(r1, x2), complex_conjugate(v1));
    let v3 = v2 - complex_times(complex_times(r2, complex_times(x2, x)), complex_conjugate(v2));
    return 1.0 + dot(v1, v1) * per.x + dot(v2, v2) * per.y + dot(v3, v3) * per.z;
}

fn trigonometric_transmittance_4(b: array<f32, 9>, z: f32, overestimation: f32) -> f32 {
    let half = half_circle_point(z);
    let here = complex_square(half);
    let ends = trigonometric_ends(half);

    // Normalised, biased by moment_bias 1.5e-6, and turned.
    let scale = (1.0 - 1.5e-6) / b[0];
    let here2 = complex_square(here);
    let m1 = complex_conjugate_times(here, vec2<f32>(b[1], b[2])) * scale;
    let m2 = complex_conjugate_times(here2, vec2<f32>(b[3], b[4])) * scale;
    let m3 = complex_conjugate_times(complex_times(here2, here), vec2<f32>(b[5], b[6])) * scale;
    let m4 = complex_conjugate_times(complex_square(here2), vec2<f32>(b[7], b[8])) * scale;

    // Szego polynomials, their values u at 1 and the reciprocals of their norms.
    let u1 = vec2<f32>(1.0, 0.0) - m1;
    let e1 = 1.0 - dot(m1, m1);
    let per1 = 1.0 / e1;
    let r1 = (m2 - complex_square(m1)) * per1;
    let p21 = complex_conjugate_times(m1, r1) - m1;
    let u2 = u1 - complex_times(r1, complex_conjugate(u1));
    let e2 = e1 * (1.0 - dot(r1, r1));
    let per2 = 1.0 / e2;
    let r2 = (m3 + complex_times(p21, m2) - complex_times(r1, m1)) * per2;
    let minus_p31 = complex_times(r2, complex_conjugate(p21)) + r1;
    let p32 = p21 + complex_conjugate_times(r1, r2);
    let u3 = u2 - complex_times(r2, complex_conjugate(u2));
    let e3 = e2 * (1.0 - dot(r2, r2));
    let per3 = 1.0 / e3;
    let r3 = (m4 + complex_times(p32, m3) - complex_times(minus_p31, m2) - complex_times(r2, m1)) * per3;
    let minus_p41 = complex_times(r3, complex_conjugate(p32)) + r2;
    let p42 = complex_times(r3, complex_conjugate(minus_p31)) - minus_p31;
    let p43 = p32 + complex_conjugate_times(r2, r3);
    let u4 = u3 - complex_times(r3, complex_conjugate(u3));
    let per4 = 1.0 / (e3 * (1.0 - dot(r3, r3)));

    // The kernel: q2 (real), q3 and q4, then its polynomial in s.
    let f1 = complex_conjugate(u1) * per1;
    let f2 = complex_conjugate(u2) * per2;
    let f3 = complex_conjugate(u3) * per3;
    let f4 = complex_conjugate(u4) * per4;
    let q0 = vec2<f32>(1.0, 0.0) - complex_times(f1, m1) - complex_times(f2, r1) - complex_times(f3, r2) - complex_times(f4, r3);
    let q1 = f1 + complex_times(f2, p21) - complex_times(f3, minus_p31) - complex_times(f4, minus_p41);
    let q2 = f2.x + dot(f3, complex_conjugate(p32)) + dot(f4, complex_conjugate(p42));
    let q3 = 0.5 * (f3 + complex_times(f4, p43) + complex_conjugate(q1));
    let q4 = 0.5 * (f4 + complex_conjugate(q0));
    let ends_sum = q2 + 2.0 * q4.x;
    let own = 1.0 / (ends_sum + 2.0 * q3.x);
    let s = quartic_roots(
        (4.0 * q3.y + 8.0 * q4.y) * own,
        (2.0 * q2 - 12.0 * q4.x) * own,
        (4.0 * q3.y - 8.0 * q4.y) * own,
        (ends_sum - 2.0 * q3.x) * own
    );

    // Two atoms: the last ones, or, where the second is not behind z, the first ones.
    let all = s.y <= ends.behind;
    let t = select(s.xy, s.zw, all);
    let xa = conjugate_of_s(t.x);
    let xb = conjugate_of_s(t.y);
    let share = vec2<f32>(trigonometric_share(t.x, xa, here, ends), trigonometric_share(t.y, xb, here, ends));
    let counts = select(1.0 - share, share, all);
    let per = vec4<f32>(per1, per2, per3, per4);
    let mass = counts.x / trigonometric_kernel_4(xa, m1, r1, r2, r3, per) + counts.y / trigonometric_kernel_4(xb, m1, r1, r2, r3, per);
    let front = select(1.0 - own - mass, mass, all);
    return exp(-b[0] * (front + overestimation * own));
}

fn trigonometric_kernel_4(x: vec2<f32>, r0: vec2<f32>, r1: vec2<f32>, r2: vec2<f32>, r3: vec2<f32>, per: vec4<f32>) -> f32 {
    let x2 = complex_square(x);
    let v1 = vec2<f32>(1.0, 0.0) - complex_times(r0, x);
    let v2 = v1 - complex_times(complex_times(r1, x2), complex_conjugate(v1));
    let v3 = v2 - complex_times(complex_times(r2, complex_times(x2, x)), complex_conjugate(v2));
    let v4 = v3 - complex_times(complex_times(r3, complex_square(x2)), complex_conjugate(v3));
    return 1.0 + dot(v1, v1) * per.x + dot(v2, v2) * per.y + dot(v3, v3) * per.z + dot(v4, v4) * per.w;
}
