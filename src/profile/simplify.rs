//! Exact simplification: what does nothing on a scene's rows is taken out of a network, and that this is so is proved
//! on every one of them.
//!
//! - A unit that never fires adds 0: without it all answers keep their bits, on every row on which it stays silent.
//! - A unit of which all outgoing weights are 0 adds 0 whatever it says.
//! - A feature that has one value goes into the biases, and its weights become 0, which unrolled exports leave out.
//! - Units that always fire are linear. k of them between I inputs and O outputs act through a matrix of rank min(I, O)
//!   at most: where k is more, so many units do the same, shifted such that they too always fire.
//!
//! The last two change rounding. They are kept only if the f32 answers stay within 1.5 times the first network's own
//! f32 error, against its f64 answers on the same rows.

use super::ProfileError;
use crate::model::simplify::{Activity, Units, activity, walk, with_constant_features, without_units};
use crate::model::{Dense, Mlp};
use serde::Serialize;
use serde_json::json;

/// Most that merging and folding may multiply the f32 error by.
pub const MAX_ERROR: f64 = 1.5;

/// A unit that was taken out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Removed {
    /// Hidden layer of the first network, from 0.
    pub layer: usize,
    /// Unit, from 0.
    pub unit: usize,
    /// Whether it stays silent in all of the box around the rows, by interval arithmetic; else on the rows themselves.
    pub in_all_of_the_box: bool,
    /// Whether nothing listens to it, so that it may go wherever one is.
    pub unheard: bool,
}

/// Units that became fewer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Merged {
    /// Hidden layer, from 0.
    pub layer: usize,
    /// Units of the first network.
    pub units: Vec<usize>,
    /// How many do their work now.
    pub into: usize,
}

/// A feature that has one value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Constant {
    /// Column.
    pub column: usize,
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f32,
}

/// Distance of f32 answers from the first network's in f64.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Rounding {
    /// Root of the mean square.
    pub rms: f64,
    /// Greatest.
    pub worst: f64,
}

/// What was done, and where it holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Rows on which all of it was proved.
    pub rows: u64,
    /// Multiply-adds before.
    pub multiply_adds_before: u64,
    /// Those of the network that is left.
    pub multiply_adds: u64,
    /// Those of them whose weight is not 0, which is what unrolled code does.
    pub multiply_adds_not_zero: u64,
    /// Units that are gone.
    pub removed: Vec<Removed>,
    /// Units that became fewer.
    pub merged: Vec<Merged>,
    /// Features that went into biases.
    pub constants: Vec<Constant>,
    /// Whether the network without silent units gave the same bits on every row, in f32 and in f64; anything else is a
    /// fault of this program.
    pub identical_bits: bool,
    /// f32 error of the first network.
    pub rounding_before: Rounding,
    /// f32 error of what is left.
    pub rounding: Rounding,
    /// Least and greatest value of every feature over the rows.
    pub box_of_rows: Vec<[f32; 2]>,
    /// Where it holds, in words.
    pub region: String,
}

/// A network without what does nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Simplified {
    /// What is left.
    pub mlp: Mlp,
    /// What was done.
    pub report: Report,
}

/// A layer under construction, in f64.
#[derive(Debug, Clone)]
struct Wide {
    inputs: usize,
    outputs: usize,
    weights: Vec<f64>,
    biases: Vec<f64>,
}

impl Wide {
    fn of(dense: &Dense) -> Self {
        let wide = |v: &[f32]| v.iter().map(|&x| x.into()).collect();
        Self {
            inputs: dense.inputs(),
            outputs: dense.outputs(),
            weights: wide(&dense.weights),
            biases: wide(&dense.biases),
        }
    }

    fn weight(&self, i: usize, o: usize) -> f64 {
        self.weights[i * self.outputs + o]
    }

    /// Some of its inputs and outputs.
    fn only(&self, inputs: &[usize], outputs: &[usize]) -> Self {
        Self {
            inputs: inputs.len(),
            outputs: outputs.len(),
            weights: inputs
                .iter()
                .flat_map(|&i| outputs.iter().map(move |&o| self.weight(i, o)))
                .collect(),
            biases: outputs.iter().map(|&o| self.biases[o]).collect(),
        }
    }

    fn dense(&self) -> Result<Dense, ProfileError> {
        let narrow = |v: &[f64]| v.iter().map(|&x| x as f32).collect();
        Ok(Dense::new(
            self.inputs,
            self.outputs,
            narrow(&self.weights),
            narrow(&self.biases),
        )?)
    }
}

fn made(mlp: &Mlp, layers: &[Wide]) -> Result<Mlp, ProfileError> {
    let layers = layers.iter().map(Wide::dense).collect::<Result<Vec<_>, _>>()?;
    Ok(Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone())?)
}

fn rounding(mlp: &Mlp, exact: &[f64], rows: &[f32]) -> Rounding {
    let (mut sum, mut worst) = (0.0, 0.0f64);
    for (f, e) in mlp.forward_batch::<f32>(rows).iter().zip(exact) {
        let off = (f64::from(*f) - e).abs();
        sum += off * off;
        worst = if off.is_nan() { f64::NAN } else { worst.max(off) };
    }
    Rounding {
        rms: (sum / exact.len().max(1) as f64).sqrt(),
        worst,
    }
}

/// Least and greatest value before ReLU of every hidden unit over a box of features.
fn intervals(mlp: &Mlp, features: &[[f32; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut x: Vec<[f64; 2]> = features.iter().map(|f| f.map(f64::from)).collect();
    let mut all = Vec::new();
    for dense in &mlp.layers()[..mlp.layers().len() - 1] {
        let unit = |o: usize| {
            let b = f64::from(dense.biases[o]);
            x.iter().enumerate().fold([b, b], |[lo, hi], (i, [a, z])| {
                let w = f64::from(dense.weight(i, o));
                let (p, q) = (w * a, w * z);
                [lo + p.min(q), hi + p.max(q)]
            })
        };
        let y: Vec<[f64; 2]> = (0..dense.outputs()).map(unit).collect();
        x = y.iter().map(|v| v.map(|v| v.max(0.0))).collect();
        all.push(y);
    }
    all
}

/// k units of layer `l` that always fire become r, where that is fewer; none where it is not.
fn merge(layers: &mut [Wide], l: usize, units: &[usize], rows_before: &[Vec<f64>]) -> Option<usize> {
    let (layer, next) = (layers[l].clone(), layers[l + 1].clone());
    let (inputs, outputs) = (layer.inputs, next.outputs);
    let into = inputs.min(outputs);
    if units.len() <= into {
        return None;
    }
    let rest: Vec<usize> = (0..layer.outputs).filter(|u| !units.contains(u)).collect();
    // The linear part from x to the next layer: M and what it adds to the biases.
    let matrix: Vec<Vec<f64>> = (0..inputs)
        .map(|i| {
            (0..outputs)
                .map(|o| units.iter().map(|&u| layer.weight(i, u) * next.weight(u, o)).sum())
                .collect()
        })
        .collect();
    let constant: Vec<f64> = (0..outputs)
        .map(|o| units.iter().map(|&u| layer.biases[u] * next.weight(u, o)).sum())
        .collect();
    // New units: value = direction · x, before their shifts; and what they weigh in the next layer.
    let by_output = outputs <= inputs;
    let direction = |r: usize, i: usize| {
        if by_output {
            matrix[i][r]
        } else {
            f64::from(u8::from(i == r))
        }
    };
    let onward = |r: usize, o: usize| {
        if by_output {
            f64::from(u8::from(o == r))
        } else {
            matrix[r][o]
        }
    };
    let shifts: Vec<f64> = (0..into)
        .map(|r| {
            let values = rows_before
                .iter()
                .map(|x| (0..inputs).map(|i| direction(r, i) * x[i]).sum::<f64>());
            let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
            // A tenth of the range to spare.
            0.1 * (hi - lo) + 1e-3 - lo
        })
        .collect();
    let mut merged = layer.only(&(0..inputs).collect::<Vec<_>>(), &rest);
    merged.weights = (0..inputs)
        .flat_map(|i| {
            rest.iter()
                .map(|&u| layer.weight(i, u))
                .chain((0..into).map(|r| direction(r, i)))
                .collect::<Vec<_>>()
        })
        .collect();
    merged.biases.extend(&shifts);
    merged.outputs = rest.len() + into;
    let mut after = next.only(&rest, &(0..outputs).collect::<Vec<_>>());
    after
        .weights
        .extend((0..into).flat_map(|r| (0..outputs).map(|o| onward(r, o)).collect::<Vec<_>>()));
    after.inputs = rest.len() + into;
    for (o, constant) in constant.into_iter().enumerate() {
        after.biases[o] += constant - (0..into).map(|r| shifts[r] * onward(r, o)).sum::<f64>();
    }
    (layers[l], layers[l + 1]) = (merged, after);
    Some(into)
}

/// A network without the units that do nothing on some rows.
struct PrunedNetwork {
    mlp: Mlp,
    removed: Vec<Removed>,
    /// Units that are left of every hidden layer, as the first network numbers them.
    kept: Units,
}

/// Takes out units that fire on no row, and those that nothing listens to. A layer keeps its first unit where none is
/// left.
fn prune(mlp: &Mlp, fired: &[Vec<u64>], bounds: &[Vec<[f64; 2]>]) -> Result<PrunedNetwork, ProfileError> {
    let mut removed = Vec::new();
    let mut kept = Units::new();
    for (layer, next) in mlp.layers()[1..].iter().enumerate() {
        let is_unheard = |unit: usize| (0..next.outputs()).all(|o| next.weight(unit, o) == 0.0);
        let (mut out, mut left): (Vec<usize>, Vec<usize>) =
            (0..next.inputs()).partition(|&unit| fired[layer][unit] == 0 || is_unheard(unit));
        if left.is_empty() {
            left.push(out.remove(0));
        }
        removed.extend(out.into_iter().map(|unit| Removed {
            layer,
            unit,
            in_all_of_the_box: bounds[layer][unit][1] <= 0.0,
            unheard: is_unheard(unit),
        }));
        kept.push(left);
    }
    let mut units = vec![Vec::new(); kept.len()];
    removed.iter().for_each(|r| units[r.layer].push(r.unit));
    Ok(PrunedNetwork {
        mlp: without_units(mlp, &units)?,
        removed,
        kept,
    })
}

/// Least and greatest value of every feature over rows.
fn box_of(rows: &[f32], width: usize) -> Vec<[f32; 2]> {
    let range = |c: usize| {
        let column = rows.iter().skip(c).step_by(width);
        column.fold([f32::INFINITY, f32::NEG_INFINITY], |[lo, hi], &x| {
            [lo.min(x), hi.max(x)]
        })
    };
    (0..width).map(range).collect()
}

/// Features of which the box is a single value.
fn constants_of(box_of_rows: &[[f32; 2]], names: &[&'static str]) -> Vec<Constant> {
    let columns = box_of_rows.iter().zip(names).enumerate();
    columns
        .filter(|(_, ([lo, hi], _))| lo == hi)
        .map(|(column, (&[value, _], &name))| Constant { column, name, value })
        .collect()
}

/// Merges what always fires, layer by layer.
fn merge_all(
    mlp: &Mlp,
    pruned: &PrunedNetwork,
    activity: &Activity,
    rows: &[f32],
) -> Result<(Mlp, Vec<Merged>), ProfileError> {
    let mut layers: Vec<Wide> = mlp.layers().iter().map(Wide::of).collect();
    let mut merged = Vec::new();
    for (l, kept) in pruned.kept.iter().enumerate() {
        let fires_always = |&at: &usize| activity.fired[l][kept[at]] == activity.rows;
        let always: Vec<usize> = (0..kept.len()).filter(fires_always).collect();
        // A layer behind one that was merged reads something else.
        if layers[l].inputs != mlp.layers()[l].inputs() {
            continue;
        }
        if let Some(into) = merge(&mut layers, l, &always, &inputs_of(mlp, rows, l)) {
            merged.push(Merged {
                layer: l,
                units: always.iter().map(|&at| kept[at]).collect(),
                into,
            });
        }
    }
    Ok((made(mlp, &layers)?, merged))
}

/// A simplified network, and what was done to it besides pruning.
struct Candidate {
    mlp: Mlp,
    merged: Vec<Merged>,
    constants: Vec<Constant>,
    rounding: Rounding,
}

/// The first of folding and merging, merging, and folding that leaves rounding as it must be; the pruned network where
/// none does.
fn fold_and_merge(
    pruned: &PrunedNetwork,
    constants: &[Constant],
    activity: &Activity,
    rows: &[f32],
    exact: &[f64],
    allowed: impl Fn(&Rounding) -> bool,
) -> Result<Candidate, ProfileError> {
    let values: Vec<(usize, f32)> = constants.iter().map(|c| (c.column, c.value)).collect();
    for (folding, merging) in [(true, true), (false, true), (true, false)] {
        let folded: &[Constant] = if folding { constants } else { &[] };
        let base = if folding {
            with_constant_features(&pruned.mlp, &values)?
        } else {
            pruned.mlp.clone()
        };
        let (mlp, merged) = if merging {
            merge_all(&base, pruned, activity, rows)?
        } else {
            (base, Vec::new())
        };
        if folded.is_empty() && merged.is_empty() {
            continue;
        }
        let rounding = rounding(&mlp, exact, rows);
        if allowed(&rounding) {
            return Ok(Candidate {
                mlp,
                merged,
                constants: folded.to_vec(),
                rounding,
            });
        }
    }
    Ok(Candidate {
        mlp: pruned.mlp.clone(),
        merged: Vec::new(),
        constants: Vec::new(),
        rounding: rounding(&pruned.mlp, exact, rows),
    })
}

/// Where a simplified network answers as the first one, in words.
fn region(count: usize, removed: &[Removed], candidate: &Candidate) -> String {
    let observed = removed.iter().filter(|r| !r.in_all_of_the_box && !r.unheard).count();
    let merged = if candidate.merged.is_empty() {
        ""
    } else {
        ", all of the merged ones do"
    };
    let constants = if candidate.constants.is_empty() {
        ""
    } else {
        ", and the constant features have their value"
    };
    format!(
        "exact on the {count} rows of features that it was made for, and on every row on which none of the removed \
         units fires{merged}{constants}; of these {} cannot in the whole box around the rows, {observed} were silent \
         on the rows alone",
        removed.len() - observed,
    )
}

/// Simplifies a network for rows of features.
///
/// # Shapes
/// `rows: [N, W]`, row by row.
///
/// # Errors
/// [`ProfileError::TooFew`] where there is no row; [`ProfileError::Shape`] where a merged weight overflows.
pub fn simplify(mlp: &Mlp, rows: &[f32]) -> Result<Simplified, ProfileError> {
    let set = mlp.feature_set();
    let count = rows.len() / set.width();
    if count == 0 {
        return Err(ProfileError::TooFew {
            rows: 0,
            least: 1,
            what: "say what the network does not need",
        });
    }
    let box_of_rows = box_of(rows, set.width());
    let activity = activity(mlp, rows);
    let pruned = prune(mlp, &activity.fired, &intervals(mlp, &box_of_rows))?;
    let exact = mlp.forward_batch::<f64>(rows);
    let same_bits = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
    let identical_bits = exact.iter().zip(&pruned.mlp.forward_batch::<f64>(rows)).all(same_bits)
        && bits(&mlp.forward_batch::<f32>(rows)) == bits(&pruned.mlp.forward_batch::<f32>(rows));
    let before = rounding(mlp, &exact, rows);
    let allowed = |r: &Rounding| r.rms <= MAX_ERROR * before.rms && r.worst <= MAX_ERROR * before.worst;
    let constants = constants_of(&box_of_rows, set.columns());
    let mut candidate = fold_and_merge(&pruned, &constants, &activity, rows, &exact, allowed)?;
    let weights = candidate.mlp.layers().iter().flat_map(|l| &l.weights);
    let report = Report {
        rows: count as u64,
        multiply_adds_before: mlp.multiply_adds() as u64,
        multiply_adds: candidate.mlp.multiply_adds() as u64,
        multiply_adds_not_zero: weights.filter(|w| **w != 0.0).count() as u64,
        region: region(count, &pruned.removed, &candidate),
        removed: pruned.removed,
        merged: candidate.merged,
        constants: candidate.constants,
        identical_bits,
        rounding_before: before,
        rounding: candidate.rounding,
        box_of_rows,
    };
    candidate.mlp.provenance.derived =
        Some(json!({ "how": "simplified", "from": mlp.name(), "from_network": mlp.shape(), "report": report }));
    Ok(Simplified {
        mlp: candidate.mlp,
        report,
    })
}

fn bits(answers: &[f32]) -> Vec<u32> {
    answers.iter().map(|t| t.to_bits()).collect()
}

/// What layer `l` reads on every row, in f64 of the f32 values.
fn inputs_of(mlp: &Mlp, rows: &[f32], l: usize) -> Vec<Vec<f64>> {
    let wide = |v: &[f32]| v.iter().map(|&x| f64::from(x)).collect::<Vec<f64>>();
    let of = |row: &[f32]| {
        let mut read = wide(row);
        if l > 0 {
            walk(mlp, row, |layer, values| {
                if layer + 1 == l {
                    read = wide(values);
                }
            });
        }
        read
    };
    rows.chunks_exact(mlp.feature_set().width()).map(of).collect()
}

impl Report {
    /// Whether a simplified network answers a row as the first one does: to the bit where nothing was merged or folded,
    /// to rounding else.
    ///
    /// # Panics
    /// If the row is not as wide as the feature set.
    pub fn holds(&self, first: &Mlp, row: &[f32]) -> bool {
        let mut holds = self.constants.iter().all(|c| row[c.column] == c.value);
        walk(first, row, |layer, values| {
            holds &= self
                .removed
                .iter()
                .all(|r| r.layer != layer || r.unheard || values[r.unit] <= 0.0);
            holds &= self
                .merged
                .iter()
                .all(|m| m.layer != layer || m.units.iter().all(|&u| values[u] > 0.0));
        });
        // Merged units were shifted for the rows; in their box they fire.
        holds
            && (self.merged.is_empty()
                || row
                    .iter()
                    .zip(&self.box_of_rows)
                    .all(|(x, [lo, hi])| (lo..=hi).contains(&x)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::FeatureSet;
    use crate::model::Provenance;
    use crate::model::mlp::tests::random_mlp;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    fn rows(seed: u64, n: usize, constant: Option<f32>) -> Vec<f32> {
        let mut rng = stream(seed, 95, 0);
        let mut rows: Vec<f32> = (0..7 * n).map(|_| rng.random_range(-1.0f32..1.0)).collect();
        if let Some(value) = constant {
            rows.iter_mut().skip(3).step_by(7).for_each(|x| *x = value);
        }
        rows
    }

    /// A network with dead units, units that nothing hears, and many that always fire.
    fn lazy() -> Mlp {
        let mut layers = random_mlp(&[24, 12], 7).layers().to_vec();
        for u in 0..24 {
            layers[0].biases[u] = [-100.0, 0.1, 20.0][u % 3];
        }
        for u in 0..12 {
            layers[1].biases[u] = [300.0, -0.5, -900.0][u % 3];
        }
        layers[1].weights[4 * 12..5 * 12].fill(0.0);
        // The sums stay where the sigmoid tells them apart.
        layers[2].weights.iter_mut().for_each(|w| *w *= 1e-3);
        Mlp::new("lazy", FeatureSet::Paper, layers, Provenance::default()).unwrap()
    }

    /// Dead and unheard units go without a changed bit, constants and linear units with an error within 1.5 times the
    /// network's own, on every row; multiply-adds fall. Controls: a unit that fires may not go, and a row outside the
    /// region is told.
    #[test]
    fn what_does_nothing_goes() {
        let (mlp, rows) = (lazy(), rows(1, 5000, Some(0.25)));
        let Simplified { mlp: left, report } = simplify(&mlp, &rows).unwrap();
        assert!(report.identical_bits && report.rows == 5000);
        assert_eq!(report.removed.iter().filter(|r| r.layer == 0).count(), 9);
        assert!(
            report
                .removed
                .iter()
                .any(|r| (r.layer, r.unit, r.unheard) == (0, 4, true))
        );
        assert!(
            report
                .removed
                .iter()
                .filter(|r| r.layer == 0 && !r.unheard)
                .all(|r| r.in_all_of_the_box)
        );
        assert_eq!(
            report.constants,
            [Constant {
                column: 3,
                name: "b1",
                value: 0.25
            }]
        );
        // Eight of the first layer always fire between seven inputs and what is left of the second layer.
        let left_of_second = 12 - report.removed.iter().filter(|r| r.layer == 1).count();
        assert_eq!(
            report
                .merged
                .iter()
                .map(|m| (m.layer, m.units.len(), m.into))
                .collect::<Vec<_>>(),
            [(0, 8, left_of_second.min(7))]
        );
        assert!(
            report.multiply_adds < report.multiply_adds_before / 2
                && report.multiply_adds_not_zero < report.multiply_adds
        );
        assert!(
            report.rounding.rms <= MAX_ERROR * report.rounding_before.rms
                && report.rounding.worst <= MAX_ERROR * report.rounding_before.worst
        );
        assert!(report.rounding.worst > 0.0);
        let exact = mlp.forward_batch::<f64>(&rows);
        assert!(
            left.forward_batch::<f64>(&rows)
                .iter()
                .zip(&exact)
                .all(|(a, b)| (a - b).abs() < 1e-4)
        );
        assert!(left.provenance.derived.is_some());
        assert!(rows.chunks_exact(7).take(200).all(|row| report.holds(&mlp, row)));
        let mut outside = rows[..7].to_vec();
        outside[3] = 0.5;
        assert!(!report.holds(&mlp, &outside));
        let far: Vec<f32> = rows[..7].iter().map(|x| 400.0 * x).collect();
        assert!(!report.holds(&mlp, &far));

        // Control: without a unit that fires the bits change.
        let mut wrong = mlp.layers().to_vec();
        wrong[1].weights[12..24].fill(0.0);
        let wrong = Mlp::new("wrong", FeatureSet::Paper, wrong, Provenance::default()).unwrap();
        assert!(wrong.forward_batch::<f32>(&rows) != mlp.forward_batch::<f32>(&rows));
    }

    #[test]
    fn a_network_that_needs_all_it_has_stays() {
        let mlp = random_mlp(&[6, 4], 3);
        let Simplified { mlp: left, report } = simplify(&mlp, &rows(2, 3000, None)).unwrap();
        if report.removed.is_empty() && report.merged.is_empty() {
            assert_eq!((left.layers(), report.multiply_adds), (mlp.layers(), 70));
        }
        assert!(report.identical_bits && report.constants.is_empty());
        assert!(matches!(simplify(&mlp, &[]), Err(ProfileError::TooFew { .. })));
    }

    /// A layer none of whose units fires keeps one.
    #[test]
    fn a_silent_layer_keeps_a_unit() {
        let mut layers = random_mlp(&[5, 3], 4).layers().to_vec();
        layers[0].biases.fill(-50.0);
        let mlp = Mlp::new("silent", FeatureSet::Paper, layers, Provenance::default()).unwrap();
        let rows = rows(3, 500, None);
        let Simplified { mlp: left, report } = simplify(&mlp, &rows).unwrap();
        assert!(report.identical_bits && left.sizes()[1] == 1, "{:?}", left.sizes());
    }
}
