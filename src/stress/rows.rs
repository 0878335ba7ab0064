//! Features that networks are fed: as in training, at its edges, beyond them, and numbers that are none.

use super::subject::Weights;
use super::{Errors, Promise, Report};
use crate::check::rows::{extreme, in_distribution};
use crate::model::{Mlp, ShapeError};
use crate::numeric::rng::stream;
use rand::RngExt;

/// Rows of each kind.
const ROWS: usize = 20_000;

/// Kinds of rows, with what they are in words.
pub const KINDS: [(&str, &str); 4] = [
    (
        "features-inside",
        "features of random pixels as the network was trained on",
    ),
    (
        "features-edges",
        "every feature at its least or greatest value of training, or as much again beyond",
    ),
    ("features-extreme", "zeros, subnormal numbers, 1e4 and mixtures"),
    ("features-not-numbers", "features of which some are NaN or infinite"),
];

/// Rows of one kind, `[N, W]`.
///
/// # Errors
/// In words, where the network's provenance holds a distribution that cannot be used.
fn rows(mlp: &Mlp, kind: &str) -> Result<Vec<f32>, String> {
    let width = mlp.feature_set().width();
    if kind == "features-extreme" {
        return Ok(extreme(width, ROWS).features);
    }
    let mut features = in_distribution(mlp, ROWS)?.features;
    let mut rng = stream(1, 0x5355, 0);
    match kind {
        "features-edges" => {
            let ends: Vec<(f32, f32)> = (0..width)
                .map(|c| {
                    let column = || features.iter().skip(c).step_by(width).copied();
                    (
                        column().fold(f32::INFINITY, f32::min),
                        column().fold(f32::NEG_INFINITY, f32::max),
                    )
                })
                .collect();
            for row in features.chunks_exact_mut(width) {
                for (x, (low, high)) in row.iter_mut().zip(&ends) {
                    let beyond = if rng.random::<bool>() { high - low } else { 0.0 };
                    *x = if rng.random::<bool>() {
                        low - beyond
                    } else {
                        high + beyond
                    };
                }
            }
        }
        "features-not-numbers" => {
            for row in features.chunks_exact_mut(width) {
                row[rng.random_range(0..width)] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][rng.random_range(0..3)];
            }
        }
        _ => {}
    }
    Ok(features)
}

/// Answers to feature rows, with weights in every format, against the network in double precision.
///
/// Errors are differences from that; there is no exact answer to features alone.
///
/// # Errors
/// [`ShapeError`] where weights become infinite; in words, where the network's provenance holds a distribution that
/// cannot be used.
pub fn reports(mlp: &Mlp) -> Result<Vec<Report>, RowsError> {
    let mut reports = Vec::new();
    for (kind, _) in KINDS {
        let features = rows(mlp, kind).map_err(RowsError::Distribution)?;
        let double: Vec<f64> = mlp.forward_batch(&features);
        for weights in [Weights::F32, Weights::F16, Weights::Bf16, Weights::Int8] {
            let found: Vec<f64> = weights.of(mlp)?.predict(&features).into_iter().map(f64::from).collect();
            let mut report = Report::empty(
                &format!("neural:{}{}", mlp.name(), weights.suffix()),
                kind,
                Promise::Range,
            );
            report.fragments = found.len() as u64;
            report.nonfinite = found.iter().filter(|t| !t.is_finite()).count() as u64;
            report.out_of_range = found
                .iter()
                .filter(|t| t.is_finite() && !(0.0..=1.0).contains(*t))
                .count() as u64;
            if kind != "features-not-numbers"
                && let Some(e) = Errors::of(&found, &double)
            {
                (report.worst_rounding, report.rounding_mse) = (Some(e.worst), Some(e.mse));
            }
            reports.push(report);
        }
    }
    Ok(reports)
}

/// Why a network could not be asked.
#[derive(Debug, thiserror::Error)]
pub enum RowsError {
    /// Weights do not survive a format.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// There are no rows.
    #[error("{0}")]
    Distribution(String),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::file;
    use std::path::Path;

    /// The recommended network: finite and in range on every kind of rows and with every format of weights; in single
    /// precision within 5e-6 of double inside its training, with half-precision weights within 0.02. Controls: 8-bit
    /// weights are farther off than half-precision ones, and edges farther from training than its inside.
    #[test]
    fn rows_are_answered_in_range() {
        let mlp = file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("models/recommended.json")).unwrap();
        let reports = reports(&mlp).unwrap();
        assert_eq!(reports.len(), 16);
        assert!(
            reports
                .iter()
                .all(|r| r.fragments == ROWS as u64 && r.broken().is_empty())
        );
        let worst = |kind: usize, format: usize| reports[4 * kind + format].worst_rounding.unwrap();
        assert!(
            worst(0, 0) <= 5e-6 && worst(0, 1) <= 0.02,
            "{:e} {:e}",
            worst(0, 0),
            worst(0, 1)
        );
        assert!(worst(0, 3) > worst(0, 1) && worst(0, 1) > 10.0 * worst(0, 0));
        let edges = rows(&mlp, "features-edges").unwrap();
        let inside = rows(&mlp, "features-inside").unwrap();
        let greatest = |rows: &[f32]| rows.iter().copied().fold(0.0f32, |m, x| m.max(x.abs()));
        assert!(greatest(&edges) > 1.5 * greatest(&inside));
    }
}
