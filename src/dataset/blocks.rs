//! Rows side by side, sixteen to a block: the layout that training reads.

use super::{Row, Rows};
use crate::numeric::lanes::{LANES, Lanes};
use rayon::prelude::*;

/// Blocks that one task moves: enough to outweigh handing them over.
const TASK: usize = 512;

/// Rows in blocks of sixteen. A block holds W columns of features, a column of targets an output of the network, then
/// the weights; rows that fill up the last block weigh 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    width: usize,
    outputs: usize,
    rows: usize,
    data: Vec<Lanes>,
}

impl Blocks {
    /// `rows` rows of `width` features and so many targets, all of them zeros that weigh nothing.
    pub fn zeros(width: usize, outputs: usize, rows: usize) -> Self {
        Self {
            width,
            outputs,
            rows,
            data: vec![Lanes::ZERO; rows.div_ceil(LANES) * (width + outputs + 1)],
        }
    }

    /// Rows in the given order.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn of(rows: &Rows, order: &[u32]) -> Self {
        Self::from_fn(rows.feature_set.width(), 1, 0, order.len(), |at| {
            rows.row(order[at] as usize)
        })
    }

    /// `lead` rows that weigh nothing, then `rows` rows as `row` gives them for 0, 1, ..; on all cores.
    ///
    /// # Panics
    /// If a row is not `width` wide, or has not so many targets.
    pub fn from_fn<'a>(
        width: usize,
        outputs: usize,
        lead: usize,
        rows: usize,
        row: impl Fn(usize) -> Row<'a> + Sync,
    ) -> Self {
        let mut blocks = Self::zeros(width, outputs, lead + rows);
        let columns = blocks.columns();
        blocks
            .data
            .par_chunks_mut(TASK * columns)
            .enumerate()
            .for_each(|(task, data)| {
                for (index, block) in data.chunks_exact_mut(columns).enumerate() {
                    let start = (task * TASK + index) * LANES;
                    for at in start.max(lead)..(start + LANES).min(lead + rows) {
                        let Row {
                            features,
                            targets,
                            weight,
                        } = row(at - lead);
                        assert_eq!(features.len(), width, "rows of the same width");
                        assert_eq!(targets.len(), outputs, "a target an output");
                        let values = features.iter().chain(targets).chain([&weight]);
                        for (column, &value) in block.iter_mut().zip(values) {
                            column.0[at - start] = value;
                        }
                    }
                }
            });
        blocks
    }

    /// Overwrites the rows from `start` on with those of `other`, whose lead is as many rows as stand before `start` in
    /// its block.
    ///
    /// # Panics
    /// If the widths differ, or `other` reaches beyond the last row.
    pub fn splice(&mut self, start: usize, other: &Self) {
        let (lead, columns) = (start % LANES, self.columns());
        let end = start - lead + other.rows;
        assert!(
            (self.width, self.outputs) == (other.width, other.outputs) && end <= self.rows,
            "rows of the same width, in places of these blocks"
        );
        let data = &mut self.data[start / LANES * columns..][..other.data.len()];
        data.par_chunks_mut(TASK * columns)
            .zip(other.data.par_chunks(TASK * columns))
            .enumerate()
            .for_each(|(task, (data, other))| {
                for (index, (block, from)) in data
                    .chunks_exact_mut(columns)
                    .zip(other.chunks_exact(columns))
                    .enumerate()
                {
                    let first = start - lead + (task * TASK + index) * LANES;
                    let lanes = start.saturating_sub(first)..(end - first).min(LANES);
                    if lanes.len() == LANES {
                        block.copy_from_slice(from);
                    } else {
                        for (column, from) in block.iter_mut().zip(from) {
                            column.0[lanes.clone()].copy_from_slice(&from.0[lanes.clone()]);
                        }
                    }
                }
            });
    }

    /// Features of a row, W.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Targets of a row.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Columns of a block: the features, the targets, the weights.
    pub fn columns(&self) -> usize {
        self.width + self.outputs + 1
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

    /// Its rows one after the other: features `[batch, W]`, targets `[batch, outputs]` and weights `[batch]`.
    pub fn to_rows(self) -> (Vec<f32>, Vec<f32>, Vec<f32>) {
        let (mut features, mut targets, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        let (width, outputs) = (self.blocks.width(), self.blocks.outputs());
        for &index in self.order {
            let block = self.blocks.block(index as usize);
            for lane in 0..self.blocks.rows_of(index as usize) {
                features.extend(block[..width].iter().map(|c| c.0[lane]));
                targets.extend(block[width..width + outputs].iter().map(|c| c.0[lane]));
                weights.push(block[width + outputs].0[lane]);
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
        let batch = Batch {
            blocks: &blocks,
            order: &all,
        };
        let (features, targets, weights) = batch.to_rows();
        assert_eq!((batch.rows(), features.len()), (n, 7 * n));
        assert_eq!(features[..7], rows.features[7 * 36..]);
        assert!(targets.iter().rev().eq(&rows.targets));
        assert!(weights.iter().all(|&w| w == 1.0));
        // What fills the last block up weighs nothing.
        assert!(blocks.block(2)[8].0[5..].iter().all(|&w| w == 0.0));
        assert!(Blocks::of(&rows, &[]).is_empty());
    }

    /// Wherever rows are put: there they stand, and all others are what they were.
    #[test]
    fn spliced_rows_replace_those_that_stood_there() {
        let rows = |n: usize, from: usize| Rows {
            feature_set: FeatureSet::DeepWeightedBlended,
            features: (0..3 * n).map(|i| (3 * from + i) as f32).collect(),
            targets: (0..n).map(|i| (from + i) as f32).collect(),
            weights: (0..n).map(|i| 1.0 + (from + i) as f32).collect(),
            pixels: vec![0; n],
        };
        let n = 20_000;
        let order: Vec<u32> = (0..n as u32).collect();
        let old = rows(n, 0);
        for (start, count) in [
            (0, 16),
            (0, 5),
            (3, 4),
            (3, 13),
            (15, 2),
            (16, 16),
            (37, 12_345),
            (n - 1, 1),
            (0, n),
            (7, n - 7),
            (40, 0),
        ] {
            let fresh = rows(count, 50_000);
            let mut blocks = Blocks::of(&old, &order);
            blocks.splice(start, &Blocks::from_fn(3, 1, start % LANES, count, |i| fresh.row(i)));
            let mut expected = old.clone();
            expected.features[3 * start..3 * (start + count)].copy_from_slice(&fresh.features);
            expected.targets[start..start + count].copy_from_slice(&fresh.targets);
            expected.weights[start..start + count].copy_from_slice(&fresh.weights);
            assert!(blocks == Blocks::of(&expected, &order), "{count} rows from {start} on");
            assert_eq!(blocks == Blocks::of(&old, &order), count == 0);
        }
    }
}
