//! What a network does on a scene: which units fire, which features move, what it costs and how far it is off.

use super::{ProfileError, Scene};
use crate::features::{Extractor, FeatureSet, SumPrecision};
use crate::model::Mlp;
use crate::model::simplify::activity;
use crate::oit::neural::Neural;
use serde::Serialize;

/// A network on a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Networked {
    /// Its name.
    pub model: String,
    /// Its sizes: "7-32-16-1".
    pub network: String,
    /// Its feature set.
    pub features: &'static str,
    /// Multiply-adds of one evaluation.
    pub multiply_adds: u64,
    /// Evaluations under `exact`, as a share of all fragments.
    pub evaluated: f64,
    /// Mean squared error of the image; none where the list makes none.
    pub image_mse: Option<f64>,
    /// Mean squared error of transmittance over all fragments; none where it answers something else.
    pub transmittance_mse: Option<f64>,
    /// Moments that pass 1 adds up besides b_0.
    pub moments: u64,
    /// Memory of pass 1 and the composite, moments in f32 \[bits\].
    pub bits_per_pixel: u32,
    /// Image error (or that of transmittance) with moments stored as RGBA16F and as RGBA16; none where the features
    /// leave no choice.
    pub stored: Vec<Stored>,
    /// Units, layer by layer.
    pub layers: Vec<Layer>,
    /// Features, column by column.
    pub columns: Vec<Feature>,
}

/// The same network on moments in another precision.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Stored {
    /// How moments are stored.
    pub storage: SumPrecision,
    /// Memory of pass 1 and the composite \[bits\].
    pub bits_per_pixel: u32,
    /// Error, of the kind that [`Networked::error`] is.
    pub error: f64,
}

/// A hidden layer on a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Layer {
    /// All units.
    pub units: u64,
    /// Units that never fire.
    pub never: Vec<usize>,
    /// Units that fire on every row.
    pub always: Vec<usize>,
}

/// A feature on a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Feature {
    /// Its name.
    pub name: &'static str,
    /// Least value.
    pub min: f32,
    /// Greatest value.
    pub max: f32,
}

impl Feature {
    /// Whether it has one value on every row.
    pub fn is_constant(&self) -> bool {
        self.min == self.max
    }
}

impl Networked {
    /// What it is judged by: the image's error, or else that of transmittance.
    pub fn error(&self) -> Option<f64> {
        self.image_mse.or(self.transmittance_mse)
    }

    /// Multiply-adds of the network a fragment, on average.
    pub fn multiply_adds_per_fragment(&self) -> f64 {
        self.evaluated * self.multiply_adds as f64
    }
}

/// Rows of features that a network is evaluated for on a scene, `[Q, W]`.
///
/// # Errors
/// [`ProfileError::Depth`] where the features need planes or a range of depth that are not known.
pub fn rows_of(scene: &Scene<'_>, set: FeatureSet) -> Result<Vec<f32>, ProfileError> {
    let extractor = Extractor::for_list(set, scene.list, scene.context.planes, scene.context.depth_range)?;
    Ok(extractor.list(scene.list, 0..scene.list.pixels())?.features)
}

/// Looks into a network.
///
/// # Errors
/// [`ProfileError`] where it cannot be applied to the list.
pub fn look_into(scene: &Scene<'_>, mlp: &Mlp) -> Result<Networked, ProfileError> {
    let set = mlp.feature_set();
    let rows = rows_of(scene, set)?;
    let method = Neural::new(mlp.clone());
    let answered = method.answers(scene.list, scene.context, &|_| {})?;
    let errors = scene.errors(&answered.transmittance)?;
    let is_transmittance = set.target() == crate::features::Target::Transmittance;
    let bits_per_pixel = method.bits_per_pixel();
    let mut stored = Vec::new();
    if set.spec().sums.has_precisions {
        for storage in [SumPrecision::F16, SumPrecision::Unorm16] {
            let answers =
                Neural::new(mlp.clone())
                    .with_precision(storage)
                    .transmittance(scene.list, scene.context, &|_| {})?;
            let errors = scene.errors(&answers)?;
            let error = errors.image_mse.unwrap_or(errors.transmittance_mse);
            stored.push(Stored {
                storage,
                bits_per_pixel: bits_per_pixel - 16 * set.moments() as u32,
                error,
            });
        }
    }
    let width = set.width();
    let columns = set.columns().iter().enumerate().map(|(c, name)| {
        let of = rows.iter().skip(c).step_by(width);
        let (min, max) = of.fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), &x| {
            (lo.min(x), hi.max(x))
        });
        Feature { name, min, max }
    });
    let fired = activity(mlp, &rows).fired;
    let n = (rows.len() / width) as u64;
    let layers = fired.iter().map(|fired| Layer {
        units: fired.len() as u64,
        never: (0..fired.len()).filter(|&u| fired[u] == 0).collect(),
        always: (0..fired.len()).filter(|&u| n > 0 && fired[u] == n).collect(),
    });
    Ok(Networked {
        model: mlp.name().to_owned(),
        network: mlp.shape(),
        features: set.name(),
        multiply_adds: mlp.multiply_adds() as u64,
        evaluated: answered.tally.rows as f64 / scene.list.len().max(1) as f64,
        image_mse: errors.image_mse,
        transmittance_mse: is_transmittance.then_some(errors.transmittance_mse),
        moments: set.moments() as u64,
        bits_per_pixel,
        stored,
        layers: layers.collect(),
        columns: columns.collect(),
    })
}
