//! Datasets: pixels turned into (features, target) rows, and their files.

pub mod blocks;
pub mod build;
pub mod colour;
pub mod file;
pub mod stream;

pub use blocks::{Batch, Blocks};
pub use build::{DatasetConfig, DatasetError, build, build_from_lists, pixels_of};
pub use stream::RowStream;

use crate::features::FeatureSet;

/// Rows of features with their exact answers, pixel by pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// The feature set of the columns.
    pub feature_set: FeatureSet,
    /// `[N, W]`, row by row.
    pub features: Vec<f32>,
    /// The exact answers, `[N]`; of what, [`FeatureSet::target`] says.
    pub targets: Vec<f32>,
    /// How much each row counts in the loss, `[N]`; empty where all count 1.
    pub weights: Vec<f32>,
    /// Which pixel each row is of, `[N]`, counted from 0 within these rows.
    pub pixels: Vec<u32>,
}

/// One row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row<'a> {
    /// `[W]`.
    pub features: &'a [f32],
    /// The exact answers, one an output of the network.
    pub targets: &'a [f32],
    /// How much it counts in the loss.
    pub weight: f32,
}

impl Rows {
    /// No rows.
    pub fn none(feature_set: FeatureSet) -> Self {
        Self {
            feature_set,
            features: Vec::new(),
            targets: Vec::new(),
            weights: Vec::new(),
            pixels: Vec::new(),
        }
    }

    /// One of the rows.
    ///
    /// # Panics
    /// If there are not as many.
    #[inline]
    pub fn row(&self, index: usize) -> Row<'_> {
        let width = self.feature_set.width();
        let weight = if self.weights.is_empty() {
            1.0
        } else {
            self.weights[index]
        };
        Row {
            features: &self.features[index * width..][..width],
            targets: &self.targets[index..=index],
            weight,
        }
    }

    /// Number of rows, N.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }
}

/// Training and validation rows of one configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Dataset {
    /// To fit weights to.
    pub training: Rows,
    /// To choose the best weights by; of pixels that training does not hold.
    pub validation: Rows,
    /// Where it comes from.
    pub manifest: file::Manifest,
}
