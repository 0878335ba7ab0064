//! Errors of methods against the exact answer.

use crate::numeric::tolerance::AbsoluteError;

/// Error of transmittances, fragment by fragment: mean square, worst, number of non-finite ones.
///
/// # Shapes
/// Both `[F]`.
///
/// # Panics
/// If the lengths differ.
pub fn transmittance_error(transmittances: &[f32], exact: &[f64]) -> AbsoluteError {
    assert_eq!(transmittances.len(), exact.len(), "one exact value a fragment");
    let mut error = AbsoluteError::default();
    for (&t, &e) in transmittances.iter().zip(exact) {
        error.add(t.into(), e);
    }
    error
}
