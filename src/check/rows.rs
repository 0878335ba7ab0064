//! Feature rows that exports are checked on: as the network was trained on, and far beyond.

use crate::dataset::build::pixels_holding;
use crate::features::{Extractor, MomentDepthKind};
use crate::model::Mlp;
use crate::numeric::rng::stream;
use crate::synth::{Purpose, Synth};
use rand::RngExt;

/// Keeps these random numbers apart from those of training.
const PURPOSE: u64 = 0x1003;
const SEED: u64 = 0x6e6d74;

/// Rows of one kind.
#[derive(Debug, Clone)]
pub struct CheckRows {
    /// What they are, in words.
    pub kind: RowKind,
    /// `[N, W]`, row by row.
    pub features: Vec<f32>,
}

/// Kinds of rows, which have bars of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RowKind {
    /// Features of random pixels as the network was trained on.
    InDistribution,
    /// Zeros, denormals, 1e4 and magnitudes between, of either sign, alone and mixed.
    Extreme,
}

impl RowKind {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::InDistribution => "in distribution",
            Self::Extreme => "extreme",
        }
    }
}

/// `count` rows from the distribution that the network's provenance names, or its feature set's usual one, pixels that
/// no training has seen.
///
/// # Errors
/// In words, where the provenance holds a configuration that cannot be used.
pub fn in_distribution(mlp: &Mlp, count: usize) -> Result<CheckRows, String> {
    Ok(CheckRows {
        kind: RowKind::InDistribution,
        features: sampled(mlp, count, SEED)?,
    })
}

/// Features of `count` rows as [`in_distribution`] has them, of the random pixels of a seed; those of the check have
/// another seed than a caller may choose.
///
/// # Errors
/// As [`in_distribution`].
pub fn sampled(mlp: &Mlp, count: usize, seed: u64) -> Result<Vec<f32>, String> {
    let synth = match mlp.provenance.config.as_ref().and_then(|c| c.get("synth")) {
        Some(synth) => serde_json::from_value(synth.clone()).map_err(|e| format!("provenance.config.synth: {e}"))?,
        None => (mlp.feature_set().spec().default_pixels)(),
    };
    let camera = synth.camera;
    // Moment depth of random pixels is that of their camera, as it was in training.
    let depth_range = (mlp.feature_set().moment_depth() == MomentDepthKind::Log).then(|| (camera.near(), camera.far()));
    let source = Synth::new(synth, seed).map_err(|e| format!("provenance.config: {e}"))?;
    // Some fragments need no network, and give no row.
    let mut fragments = count as u64;
    let mut features = loop {
        let list = pixels_holding(&source, Purpose::Evaluation, fragments, &|_| {});
        let extractor =
            Extractor::for_list(mlp.feature_set(), &list, Some(camera), depth_range).map_err(|e| e.to_string())?;
        let features = extractor
            .list(&list, 0..list.pixels())
            .map_err(|e| e.to_string())?
            .features;
        if features.len() >= count * mlp.feature_set().width() {
            break features;
        }
        if fragments > 64 * count as u64 {
            return Err(format!(
                "of {fragments} random fragments hardly any needs the network; there is nothing to check it on"
            ));
        }
        fragments *= 2;
    };
    features.truncate(count * mlp.feature_set().width());
    Ok(features)
}

/// `count` rows that no renderer should ever feed, and some will.
pub fn extreme(width: usize, count: usize) -> CheckRows {
    let special = [
        0.0f32,
        -0.0,
        1.0,
        -1.0,
        1e4,
        -1e4,
        1e-10,
        f32::MIN_POSITIVE,
        1e-39,
        -1e-39,
        f32::from_bits(1),
        0.5,
        32.0,
        1000.0,
    ];
    let mut rng = stream(SEED, PURPOSE, 0);
    let mut features = Vec::with_capacity(count * width);
    for row in 0..count {
        for column in 0..width {
            features.push(match row {
                // Each special value in every column at once, then alone in each column.
                _ if row < special.len() => special[row],
                _ if row < special.len() * (1 + width) => match (row / special.len() - 1) == column {
                    true => special[row % special.len()],
                    false => 0.5,
                },
                // Any mixture of them, and magnitudes log-uniform from the denormals to 1e4.
                _ if row % 2 == 0 => special[rng.random_range(0..special.len())],
                _ => {
                    libm::pow(10.0, rng.random_range(-42.0..4.0)) as f32 * if rng.random::<bool>() { 1.0 } else { -1.0 }
                }
            });
        }
    }
    CheckRows {
        kind: RowKind::Extreme,
        features,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mlp::tests::random_mlp;

    #[test]
    fn shapes_and_contents() {
        let rows = in_distribution(&random_mlp(&[4], 1), 1000).unwrap();
        assert_eq!(rows.features.len(), 7000);
        assert!(
            rows.features
                .chunks_exact(7)
                .all(|r| (0.0..=1.0).contains(&r[0]) && r[1] >= 2.0)
        );
        let rows = extreme(7, 5000).features;
        assert_eq!(rows.len(), 35_000);
        assert!(rows.iter().all(|x| x.is_finite()));
        assert!(rows.contains(&1e4) && rows.iter().any(|x| x.is_subnormal()) && rows[..7].iter().all(|&x| x == 0.0));
    }
}
