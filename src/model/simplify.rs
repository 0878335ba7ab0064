//! Networks without what does nothing: units that never fire are taken out, constant features become biases, and what
//! is left answers the same.
//!
//! Which units never fire is known in two ways. [`always_silent`] finds those that cannot, or that nothing listens to,
//! whatever the features are: taking them out is exact everywhere. [`activity`] counts on rows of features: what is
//! silent on all of them may be taken out exactly for these rows, and for every other row on which it stays silent;
//! [`fires`] tells.

use super::{Dense, Mlp, ShapeError};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Hidden units of a network, layer by layer: `units[l]` are indices into hidden layer l, ascending.
pub type Units = Vec<Vec<usize>>;

/// What was taken out of the network that was trained; part of the provenance of what is left.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pruned {
    /// Units of the trained network.
    pub units: Units,
    /// Rows of features on which none of them fired; 0 where they cannot fire, or nothing listens to them, whatever the
    /// features are.
    pub rows: u64,
    /// Multiply-adds before.
    pub of_multiply_adds: usize,
}

/// What cannot be taken out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimplifyError {
    /// There is no such unit.
    #[error("there is no unit {unit} in hidden layer {layer}")]
    NoUnit {
        /// The layer, from 1.
        layer: usize,
        /// The unit, from 0.
        unit: usize,
    },
    /// There is no such feature.
    #[error("there is no feature {0}")]
    NoFeature(usize),
    /// A bias overflows.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Text that names no units.
    #[error("'{0}' does not say which units were taken out")]
    Text(String),
}

impl Pruned {
    /// As one line of text: `layer 1 without 3, 17; layer 2 without 5; silent on 1000000 rows; 752 multiply-adds
    /// before`.
    pub fn to_text(&self) -> String {
        let layer = |(l, units): (usize, &Vec<usize>)| {
            let list: Vec<String> = units.iter().map(usize::to_string).collect();
            (!units.is_empty()).then(|| format!("layer {} without {}; ", l + 1, list.join(", ")))
        };
        let layers: String = self.units.iter().enumerate().filter_map(layer).collect();
        format!(
            "{layers}silent on {} rows; {} multiply-adds before",
            self.rows, self.of_multiply_adds
        )
    }

    /// What [`Self::to_text`] wrote.
    ///
    /// # Errors
    /// [`SimplifyError::Text`].
    pub fn from_text(text: &str) -> Result<Self, SimplifyError> {
        let read = || {
            let mut pruned = Self::default();
            for part in text.split("; ") {
                let words: Vec<&str> = part.splitn(4, ' ').collect();
                match words[..] {
                    ["layer", number, "without", list] => {
                        let layer: usize = number.parse().ok().filter(|n| (1..=64).contains(n))?;
                        pruned.units.resize(pruned.units.len().max(layer), Vec::new());
                        pruned.units[layer - 1] =
                            list.split(", ").map(|unit| unit.parse().ok()).collect::<Option<_>>()?;
                    }
                    ["silent", "on", rows, "rows"] => pruned.rows = rows.parse().ok()?,
                    [number, "multiply-adds", "before"] => pruned.of_multiply_adds = number.parse().ok()?,
                    _ => return None,
                }
            }
            Some(pruned)
        };
        read().ok_or_else(|| SimplifyError::Text(text.to_owned()))
    }

    /// Number of units.
    pub fn count(&self) -> usize {
        self.units.iter().map(Vec::len).sum()
    }
}

/// How often the hidden units of a network fire.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Activity {
    /// Rows that were looked at.
    pub rows: u64,
    /// For every unit of every hidden layer, on how many of them it gave more than 0.
    pub fired: Vec<Vec<u64>>,
}

impl Activity {
    /// Units that fired on no row; none where there was no row.
    pub fn silent(&self) -> Units {
        self.units(|fired| fired == 0)
    }

    /// Units that fired on every row; none where there was no row.
    pub fn always(&self) -> Units {
        self.units(|fired| fired == self.rows)
    }

    fn units(&self, which: impl Fn(u64) -> bool) -> Units {
        let of_layer = |fired: &Vec<u64>| (0..fired.len()).filter(|&u| self.rows > 0 && which(fired[u])).collect();
        self.fired.iter().map(of_layer).collect()
    }
}

/// Hidden layers' values for a row, in f32, in the order of the reference forward pass, with `visit(layer, values)`
/// after each.
pub fn walk(mlp: &Mlp, row: &[f32], mut visit: impl FnMut(usize, &[f32])) {
    let mut x = row.to_vec();
    let hidden = &mlp.layers()[..mlp.layers().len() - 1];
    for (index, dense) in hidden.iter().enumerate() {
        let mut y = dense.biases.clone();
        for (x, weights) in x.iter().zip(dense.weights.chunks_exact(dense.outputs())) {
            y.iter_mut().zip(weights).for_each(|(y, w)| *y += w * x);
        }
        y.iter_mut().for_each(|y| *y = y.max(0.0));
        visit(index, &y);
        x = y;
    }
}

/// Counts on how many rows of features each hidden unit fires, on all cores.
///
/// # Shapes
/// `rows: [N, W]`, row by row.
///
/// # Panics
/// If the length of `rows` is not a multiple of W.
pub fn activity(mlp: &Mlp, rows: &[f32]) -> Activity {
    let width = mlp.feature_set().width();
    assert_eq!(rows.len() % width, 0, "whole rows of {width} features");
    let sizes = mlp.sizes();
    let none = || {
        sizes[1..sizes.len() - 1]
            .iter()
            .map(|&n| vec![0u64; n])
            .collect::<Vec<_>>()
    };
    let add = |mut a: Vec<Vec<u64>>, b: Vec<Vec<u64>>| {
        a.iter_mut()
            .flatten()
            .zip(b.into_iter().flatten())
            .for_each(|(a, b)| *a += b);
        a
    };
    let count = |mut fired: Vec<Vec<u64>>, row: &[f32]| {
        walk(mlp, row, |layer, values| {
            fired[layer]
                .iter_mut()
                .zip(values)
                .for_each(|(n, &v)| *n += u64::from(v > 0.0))
        });
        fired
    };
    let fired = rows.par_chunks(width).fold(none, count).reduce(none, add);
    Activity {
        rows: (rows.len() / width) as u64,
        fired,
    }
}

/// Whether one of these units fires for a row of features: where not, a network without them gives the same bits.
pub fn fires(mlp: &Mlp, units: &Units, row: &[f32]) -> bool {
    let mut any = false;
    walk(mlp, row, |layer, values| {
        any |= units
            .get(layer)
            .is_some_and(|units| units.iter().any(|&u| values[u] > 0.0))
    });
    any
}

/// Units that cannot fire, or that nothing listens to, whatever the features are: incoming weights that are 0, or
/// negative from units that are never negative, with a bias that is not positive; outgoing weights that are all 0. What
/// only listens to such units, or is heard by them alone, is one too.
pub fn always_silent(mlp: &Mlp) -> Units {
    let layers = mlp.layers();
    let hidden = layers.len() - 1;
    let mut silent: Vec<Vec<bool>> = layers[..hidden].iter().map(|l| vec![false; l.outputs()]).collect();
    loop {
        let before = silent.clone();
        for l in 0..hidden {
            for u in 0..layers[l].outputs() {
                let adds = |i: usize| match l {
                    0 => layers[0].weight(i, u) != 0.0,
                    _ => layers[l].weight(i, u) > 0.0 && !before[l - 1][i],
                };
                let cannot = layers[l].biases[u] <= 0.0 && !(0..layers[l].inputs()).any(adds);
                let next = &layers[l + 1];
                let listens = |o: usize| next.weight(u, o) != 0.0 && !(l + 1 < hidden && before[l + 1][o]);
                silent[l][u] = before[l][u] || cannot || !(0..next.outputs()).any(listens);
            }
        }
        if silent == before {
            break silent
                .into_iter()
                .map(|s| (0..s.len()).filter(|&u| s[u]).collect())
                .collect();
        }
    }
}

/// Units that are in either list.
pub fn union(a: &Units, b: &Units) -> Units {
    let of = |units: &Units, l: usize| units.get(l).cloned().unwrap_or_default();
    let both = |l: usize| {
        let mut all = [of(a, l), of(b, l)].concat();
        all.sort_unstable();
        all.dedup();
        all
    };
    (0..a.len().max(b.len())).map(both).collect()
}

/// The network without these hidden units. A layer keeps its first unit where all of them are listed.
///
/// # Accuracy
/// Identical bits, for [`Mlp::forward`] in either precision and the plain export, for every row on which none of them
/// fires.
///
/// # Errors
/// [`SimplifyError::NoUnit`].
pub fn without_units(mlp: &Mlp, units: &Units) -> Result<Mlp, SimplifyError> {
    let hidden = mlp.layers().len() - 1;
    let mut kept: Vec<Vec<usize>> = vec![(0..mlp.layers()[0].inputs()).collect()];
    for (l, dense) in mlp.layers().iter().enumerate() {
        let out: &[usize] = units.get(l).map_or(&[], Vec::as_slice);
        let most = if l < hidden { dense.outputs() } else { 0 };
        if let Some(&unit) = out.iter().find(|&&u| u >= most) {
            return Err(SimplifyError::NoUnit { layer: l + 1, unit });
        }
        let mut left: Vec<usize> = (0..dense.outputs()).filter(|u| !out.contains(u)).collect();
        if left.is_empty() {
            left.push(0);
        }
        kept.push(left);
    }
    if let Some(l) = (hidden..units.len()).find(|&l| !units[l].is_empty()) {
        return Err(SimplifyError::NoUnit {
            layer: l + 1,
            unit: units[l][0],
        });
    }
    let layers = mlp.layers().iter().zip(kept.windows(2)).map(|(dense, kept)| {
        let weights = kept[0]
            .iter()
            .flat_map(|&i| kept[1].iter().map(move |&o| dense.weight(i, o)))
            .collect();
        let biases = kept[1].iter().map(|&o| dense.biases[o]).collect();
        Dense::new(kept[0].len(), kept[1].len(), weights, biases)
    });
    let layers = layers.collect::<Result<Vec<_>, _>>()?;
    Ok(Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone())?)
}

/// The network with features that always have the same value folded into the biases of its first layer; their weights
/// become 0, and the columns stay.
///
/// # Accuracy
/// Biases are summed in f64 and rounded once: the answers differ from the whole network's by the rounding of f32 sums.
///
/// # Errors
/// [`SimplifyError::NoFeature`]; [`SimplifyError::Shape`] where a bias overflows.
pub fn with_constant_features(mlp: &Mlp, constants: &[(usize, f32)]) -> Result<Mlp, SimplifyError> {
    let mut layers = mlp.layers().to_vec();
    let first = &mut layers[0];
    let (inputs, outputs) = (first.inputs(), first.outputs());
    let mut biases: Vec<f64> = first.biases.iter().map(|&b| b.into()).collect();
    for &(feature, value) in constants {
        if feature >= inputs {
            return Err(SimplifyError::NoFeature(feature));
        }
        for (bias, w) in biases
            .iter_mut()
            .zip(&mut first.weights[feature * outputs..][..outputs])
        {
            *bias += f64::from(std::mem::take(w)) * f64::from(value);
        }
    }
    first.biases = biases.into_iter().map(|b| b as f32).collect();
    Ok(Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone())?)
}

/// The network without what never fires: what cannot, and where rows of features are given, what stays silent on all of
/// them. Its provenance says what was taken out.
///
/// # Accuracy
/// As [`without_units`].
///
/// # Errors
/// [`SimplifyError::Shape`], which no network that holds together causes.
pub fn pruned(mlp: &Mlp, rows: &[f32]) -> Result<Mlp, SimplifyError> {
    let exact = always_silent(mlp);
    let activity = activity(mlp, rows);
    let all = union(&exact, &activity.silent());
    // One unit of a layer stays.
    let stays = |(l, units): (usize, Vec<usize>)| {
        if units.len() == mlp.layers()[l].outputs() {
            units[1..].to_vec()
        } else {
            units
        }
    };
    let units: Units = all.into_iter().enumerate().map(stays).collect();
    let observed = units
        .iter()
        .enumerate()
        .any(|(l, units)| units.iter().any(|u| !exact[l].contains(u)));
    let mut left = without_units(mlp, &units)?;
    let rows = if observed { activity.rows } else { 0 };
    left.provenance.pruned = Some(Pruned {
        units,
        rows,
        of_multiply_adds: mlp.multiply_adds(),
    });
    Ok(left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::FeatureSet;
    use crate::model::Provenance;
    use crate::model::mlp::tests::random_mlp;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    fn rows(seed: u64, n: usize) -> Vec<f32> {
        let mut rng = stream(seed, 94, 0);
        (0..7 * n).map(|_| rng.random_range(-2.0f32..2.0)).collect()
    }

    /// A network of which some units never fire on rows in [-2, 2): their biases are far below zero.
    fn lazy() -> Mlp {
        let mlp = random_mlp(&[12, 9], 4);
        let mut layers = mlp.layers().to_vec();
        for (layer, unit) in [(0, 2), (0, 7), (0, 11), (1, 0), (1, 5)] {
            layers[layer].biases[unit] = -100.0;
        }
        Mlp::new("lazy", FeatureSet::Paper, layers, Provenance::default()).unwrap()
    }

    fn bits(mlp: &Mlp, rows: &[f32]) -> Vec<u64> {
        let single = mlp
            .forward_batch::<f32>(rows)
            .into_iter()
            .map(|t| u64::from(t.to_bits()));
        single
            .chain(mlp.forward_batch::<f64>(rows).into_iter().map(f64::to_bits))
            .collect()
    }

    /// Without silent units the answers keep their bits in both precisions. Controls: without a unit that fires they do
    /// not, and rows that make a silent unit fire are told apart.
    #[test]
    fn silent_units_can_go() {
        let (mlp, rows) = (lazy(), rows(1, 4000));
        let activity = activity(&mlp, &rows);
        assert_eq!(
            (activity.rows, activity.fired[0].len(), activity.fired[1].len()),
            (4000, 12, 9)
        );
        let silent = activity.silent();
        assert!([2, 7, 11].iter().all(|u| silent[0].contains(u)) && silent[1].contains(&0) && silent[1].contains(&5));
        let left = pruned(&mlp, &rows).unwrap();
        let note = left.provenance.pruned.clone().unwrap();
        assert_eq!(
            (&note.units, note.rows, note.of_multiply_adds),
            (&silent, 4000, mlp.multiply_adds())
        );
        assert_eq!(left.sizes()[1..3], [12 - silent[0].len(), 9 - silent[1].len()]);
        assert!(left.multiply_adds() < mlp.multiply_adds());
        assert_eq!(bits(&left, &rows), bits(&mlp, &rows));

        let fired = (0..12).find(|u| !silent[0].contains(u)).unwrap();
        let wrong = without_units(&mlp, &vec![vec![fired], vec![]]).unwrap();
        assert_ne!(bits(&wrong, &rows), bits(&mlp, &rows));

        // Far out they fire, and only there may the answers differ.
        let far: Vec<f32> = super::tests::rows(2, 2000).iter().map(|x| 80.0 * x).collect();
        let (mut outside, mut different) = (0, 0);
        for row in far.chunks_exact(7) {
            let same = bits(&left, row) == bits(&mlp, row);
            outside += usize::from(fires(&mlp, &silent, row));
            different += usize::from(!same);
            assert!(same || fires(&mlp, &silent, row));
        }
        assert!(
            outside > 500 && different > 100,
            "{outside} rows outside, {different} answers differ"
        );
        assert!(rows.chunks_exact(7).all(|row| !fires(&mlp, &silent, row)));
    }

    /// What can never fire, and what is never heard, with what follows from it; exact for every row, and no row is
    /// needed.
    #[test]
    fn units_that_can_never_matter() {
        let mlp = random_mlp(&[4, 3, 3], 5);
        let mut layers = mlp.layers().to_vec();
        // Unit 1 of layer 1 has no inputs and no positive bias.
        (0..7).for_each(|i| layers[0].weights[i * 4 + 1] = 0.0);
        layers[0].biases[1] = 0.0;
        // Unit 0 of layer 2 hears positive units with negative weights, and unit 1 of layer 1 with a positive one.
        (0..4).for_each(|i| layers[1].weights[i * 3] = if i == 1 { 5.0 } else { -1.0 });
        layers[1].biases[0] = -0.5;
        // Nothing hears unit 2 of layer 3; unit 1 of layer 2 is heard by it alone.
        layers[3].weights[2] = 0.0;
        (0..3).for_each(|o| layers[2].weights[3 + o] = if o == 2 { 1.0 } else { 0.0 });
        let mlp = Mlp::new("n", FeatureSet::Paper, layers, Provenance::default()).unwrap();
        assert_eq!(always_silent(&mlp), [vec![1], vec![0, 1], vec![2]]);
        let left = pruned(&mlp, &[]).unwrap();
        assert_eq!(
            (left.shape().as_str(), left.provenance.pruned.as_ref().unwrap().rows),
            ("7-3-1-2-1", 0)
        );
        let far: Vec<f32> = rows(3, 3000).iter().map(|x| 1e3 * x).collect();
        assert_eq!(bits(&left, &far), bits(&mlp, &far));
        assert_eq!(
            always_silent(&random_mlp(&[8, 4], 1)),
            [vec![], vec![]] as [Vec<usize>; 2]
        );
    }

    #[test]
    fn a_layer_keeps_one_unit() {
        let mlp = random_mlp(&[3], 6);
        let mut layers = mlp.layers().to_vec();
        layers[0].biases = vec![-1e3; 3];
        let mlp = Mlp::new("n", FeatureSet::Paper, layers, Provenance::default()).unwrap();
        let rows = rows(4, 100);
        let left = pruned(&mlp, &rows).unwrap();
        assert_eq!(
            (left.shape().as_str(), left.provenance.pruned.as_ref().unwrap().count()),
            ("7-1-1", 2)
        );
        assert_eq!(bits(&left, &rows), bits(&mlp, &rows));
        assert_eq!(without_units(&mlp, &vec![vec![0, 1, 2]]).unwrap().shape(), "7-1-1");
        assert_eq!(
            without_units(&mlp, &vec![vec![3]]),
            Err(SimplifyError::NoUnit { layer: 1, unit: 3 })
        );
        assert_eq!(
            without_units(&mlp, &vec![vec![], vec![0]]),
            Err(SimplifyError::NoUnit { layer: 2, unit: 0 })
        );
    }

    /// Constant features in the biases: within 1e-6 of the whole network. Control: another value.
    #[test]
    fn constant_features_become_biases() {
        let mlp = random_mlp(&[16, 8], 7);
        let mut rows = rows(5, 1000);
        rows.chunks_exact_mut(7).for_each(|row| (row[1], row[4]) = (3.0, -0.25));
        let worst = |folded: &Mlp| {
            let pairs = folded
                .forward_batch::<f64>(&rows)
                .into_iter()
                .zip(mlp.forward_batch::<f64>(&rows));
            pairs
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, |m: f64, e| if e.is_nan() { 9.0 } else { m.max(e) })
        };
        let folded = with_constant_features(&mlp, &[(1, 3.0), (4, -0.25)]).unwrap();
        assert!((0..16).all(|o| folded.layers()[0].weight(1, o) == 0.0 && folded.layers()[0].weight(4, o) == 0.0));
        assert!(worst(&folded) <= 1e-6);
        assert!(worst(&with_constant_features(&mlp, &[(1, 3.5), (4, -0.25)]).unwrap()) > 1e-3);
        assert_eq!(
            with_constant_features(&mlp, &[(7, 0.0)]),
            Err(SimplifyError::NoFeature(7))
        );
        let layer = Dense::new(7, 1, vec![1.0; 7], vec![0.0]).unwrap();
        let ones = Mlp::new("n", FeatureSet::Paper, vec![layer], Provenance::default()).unwrap();
        assert!(matches!(
            with_constant_features(&ones, &[(0, f32::MAX), (1, f32::MAX)]),
            Err(SimplifyError::Shape(_))
        ));
    }

    #[test]
    fn the_note_reads_back() {
        let note = Pruned {
            units: vec![vec![3, 17], vec![], vec![5]],
            rows: 1_000_000,
            of_multiply_adds: 752,
        };
        assert_eq!(
            note.to_text(),
            "layer 1 without 3, 17; layer 3 without 5; silent on 1000000 rows; 752 multiply-adds before"
        );
        assert_eq!(Pruned::from_text(&note.to_text()).unwrap(), note);
        for wrong in [
            "",
            "layer 0 without 1; silent on 1 rows",
            "layer 1 without x",
            "silent on many rows",
            "layer 1 without 1;silent",
        ] {
            assert!(Pruned::from_text(wrong).is_err(), "{wrong}");
        }
    }
}
