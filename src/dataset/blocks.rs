//! Rows side by side, sixteen to a block: the layout that training reads.

use super::Rows;
use crate::numeric::lanes::{LANES, Lanes};

/// Rows in blocks of sixteen. A block holds W columns of features, then the targets, then the weights; rows that fill up the last block weigh 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    width: usize,
    rows: usize,
    data: Vec<Lanes>,
}

impl Blocks {
    /// `rows` rows of `width` features, all of them zeros that weigh nothing.
    pub fn zeros(width: usize, rows: usize) -> Self {
        Self { width, rows, data: vec![Lanes::ZERO; rows.div_ceil(LANES) * (width + 2)] }
    }

    /// Rows in the given order.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn of(rows: &Rows, order: &[u32]) -> Self {
        let mut blocks = Self::zeros(rows.feature_set.width(), order.len());
        for (at, &row) in order.iter().enumerate() {
            blocks.set(at, rows, row as usize);
        }
        blocks
    }

    /// Puts a row in a place.
    ///
    /// # Panics
    /// If either is out of range or the widths differ.
    pub fn set(&mut self, at: usize, rows: &Rows, row: usize) {
        assert!(at < self.rows && self.width == rows.feature_set.width(), "a place of these blocks, rows of the same width");
        let columns = self.columns();
        let (block, lane) = (&mut self.data[at / LANES * columns..][..columns], at % LANES);
        for (column, &feature) in block.iter_mut().zip(&rows.features[row * self.width..][..self.width]) {
            column.0[lane] = feature;
        }
        block[self.width].0[lane] = rows.targets[row];
        block[self.width + 1].0[lane] = rows.weights.get(row).copied().unwrap_or(1.0);
    }

    /// Features of a row, W.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Columns of a block: the features, the targets, the weights.
    pub fn columns(&self) -> usize {
        self.width + 2
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.data.len() / self.columns()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// The columns of a block.
    #[inline(always)]
    pub fn block(&self, index: usize) -> &[Lanes] {
        let columns = self.columns();
        &self.data[index * columns..][..columns]
    }

    /// Number of rows in a block: sixteen, but for the last.
    pub fn rows_of(&self, index: usize) -> usize {
        (self.rows - index * LANES).min(LANES)
    }
}

/// Some blocks, in the order in which a step takes them.
#[derive(Debug, Clone, Copy)]
pub struct Batch<'a> {
    /// Where they stand.
    pub blocks: &'a Blocks,
    /// Which.
    pub order: &'a [u32],
}

impl Batch<'_> {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.order.iter().map(|&b| self.blocks.rows_of(b as usize)).sum()
    }

    /// Its rows one after the other: features `[batch, W]`, targets and weights `[batch]`.
    pub fn to_rows(self) -> (Vec<f32>, Vec<f32>, Vec<f32>) {
        let (mut features, mut targets, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        let width = self.blocks.width();
        for &index in self.order {
            let block = self.blocks.block(index as usize);
            for lane in 0..self.blocks.rows_of(index as usize) {
                features.extend(block[..width].iter().map(|c| c.0[lane]));
                targets.push(block[width].0[lane]);
                weights.push(block[width + 1].0[lane]);
            }
        }
        (features, targets, weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::FeatureSet;

    #[test]
    fn rows_come_back_in_order() {
        let n = 37;
        let rows = Rows {
            feature_set: FeatureSet::Paper,
            features: (0..7 * n).map(|i| i as f32).collect(),
            targets: (0..n).map(|i| 0.01 * i as f32).collect(),
            weights: Vec::new(),
            pixels: vec![0; n],
        };
        let order: Vec<u32> = (0..n as u32).rev().collect();
        let blocks = Blocks::of(&rows, &order);
        assert_eq!((blocks.len(), blocks.rows(), blocks.columns()), (3, n, 9));
        let all: Vec<u32> = (0..3).collect();
        let batch = Batch { blocks: &blocks, order: &all };
        let (features, targets, weights) = batch.to_rows();
        assert_eq!((batch.rows(), features.len()), (n, 7 * n));
        assert_eq!(features[..7], rows.features[7 * 36..]);
        assert!(targets.iter().rev().eq(&rows.targets));
        assert!(weights.iter().all(|&w| w == 1.0));
        // What fills the last block up weighs nothing.
        assert!(blocks.block(2)[8].0[5..].iter().all(|&w| w == 0.0));
        assert!(Blocks::of(&rows, &[]).is_empty());
    }
}
