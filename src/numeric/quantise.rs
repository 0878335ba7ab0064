//! What storage does to a number: half precision and 16-bit fixed point.

/// Nearest half-precision number, ties to even; ±∞ beyond 65520, NaN stays NaN.
pub fn round_f16(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    // Exponent of x, at least that of the least normal half; a half has 10 bits after the point.
    let exponent = (((x.to_bits() >> 52) & 0x7ff) as i32 - 1023).max(-14);
    let unit = f64::from_bits(((exponent - 10 + 1023) as u64) << 52);
    let rounded = (x / unit).round_ties_even() * unit;
    if rounded.abs() >= 65520.0 {
        f64::INFINITY.copysign(x)
    } else {
        rounded
    }
}

/// [`round_f16`] of an f32, without branches: for loops over lanes.
#[inline]
pub fn round_f16_of_f32(x: f32) -> f32 {
    let bits = x.to_bits();
    // A half has 13 bits less; half of the last place but one ulp is added, and that ulp where it makes the last place
    // even.
    let normal = f32::from_bits(bits.wrapping_add(0xfff + ((bits >> 13) & 1)) & !0x1fff);
    // Beside ½ an f32 has the spacing of the subnormal halves, 2^-24.
    let subnormal = ((x.abs() + 0.5) - 0.5).copysign(x);
    let a = x.abs();
    if a < 6.103_515_6e-5 {
        subnormal
    } else if a < 65520.0 {
        normal
    } else if a.is_nan() {
        x
    } else {
        f32::INFINITY.copysign(x)
    }
}

/// Nearest 16-bit fraction k/65535 of [0, 1]; numbers outside are clamped, NaN stays NaN.
pub fn round_unorm16(x: f64) -> f64 {
    (x.clamp(0.0, 1.0) * 65535.0).round() / 65535.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves() {
        // Exact, halfway to even, greatest, overflow, least subnormal, underflow.
        for (x, expected) in [
            (1.0, 1.0),
            (-0.1, -0.0999755859375),
            (2049.0, 2048.0),
            (2051.0, 2052.0),
            (65504.0, 65504.0),
            (65519.0, 65504.0),
            (65520.0, f64::INFINITY),
            (-1e9, f64::NEG_INFINITY),
            (2f64.powi(-24), 2f64.powi(-24)),
            (2f64.powi(-25), 0.0),
            (1e-300, 0.0),
            (0.0, 0.0),
        ] {
            assert_eq!(round_f16(x), expected, "{x}");
        }
        assert!(round_f16(f64::NAN).is_nan());
        for bits in 0..1u32 << 10 {
            let half = f64::from(1.0 + bits as f32 / 1024.0);
            assert_eq!(round_f16(half), half);
        }
    }

    /// The fast rounding is the other one's, for every exponent, for halves, what lies halfway between them, and their
    /// neighbours.
    #[test]
    fn halves_of_f32() {
        let compare = |x: f32| {
            assert_eq!(
                round_f16_of_f32(x).to_bits(),
                (round_f16(x.into()) as f32).to_bits(),
                "{x:e}"
            )
        };
        for high in 0..1u32 << 16 {
            for low in [
                0, 1, 0x7fff, 0x8000, 0x8001, 0xffff, 0x0fff, 0x1000, 0x1001, 0x3000, 0x2fff,
            ] {
                let x = f32::from_bits((high << 16) | low);
                if !x.is_nan() {
                    compare(x);
                }
            }
        }
        assert!(round_f16_of_f32(f32::NAN).is_nan());
    }

    #[test]
    fn fixed_point() {
        assert_eq!(
            (
                round_unorm16(-1.0),
                round_unorm16(0.0),
                round_unorm16(1.0),
                round_unorm16(7.0)
            ),
            (0.0, 0.0, 1.0, 1.0)
        );
        assert!((round_unorm16(0.3) - 0.3).abs() <= 0.5 / 65535.0 && round_unorm16(0.3) != 0.3);
        assert!(round_unorm16(f64::NAN).is_nan());
    }
}
