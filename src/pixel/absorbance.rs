//! Absorbance: the additive form of opacity.

/// Greatest absorbance of one fragment \[dimensionless\]; an opaque fragment leaves e^−10 of the light (the usual clamp of shipped renderers).
pub const ABSORBANCE_MAX: f64 = 10.0;

/// Absorbance of a fragment: A = min(−ln(1 − alpha), 10).
///
/// # Source
/// MKKP18 Sec. 3.1, NMT24 Eq. 4.
///
/// # Domain
/// alpha in [0, 1]; the result is in [0, 10].
///
/// # Accuracy
/// Within 1 ULP of f64 for every alpha, tiny ones included (`log1p`).
pub fn absorbance(alpha: f32) -> f64 {
    (-libm::log1p(-f64::from(alpha))).min(ABSORBANCE_MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_small_values_and_the_clamp() {
        assert_eq!(absorbance(0.0), 0.0);
        assert_eq!(absorbance(1.0), ABSORBANCE_MAX);
        assert_eq!(absorbance(0.5), std::f64::consts::LN_2);
        // −ln(1 − a) = a + a²/2 + O(a³)
        let a = 1e-8f32;
        let expected = f64::from(a) + f64::from(a) * f64::from(a) / 2.0;
        assert!((absorbance(a) - expected).abs() <= 1e-22);
        // 1 − e^−10 = 0.9999546: beyond it the clamp holds
        assert_eq!(absorbance(0.99999), ABSORBANCE_MAX);
        assert!(absorbance(0.9999) < ABSORBANCE_MAX);
    }
}
