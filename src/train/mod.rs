//! Training: the only place that knows burn.

pub mod adam;
#[cfg(feature = "burn")]
pub mod burn;
pub mod checkpoint;
mod engine;
pub mod feed;
pub mod fused;
pub mod initial;
pub mod scalar;
pub mod trainer;

pub use checkpoint::{Checkpoint, CheckpointError};
pub use engine::Engine;
pub use trainer::{EpochReport, Outcome, TrainError, train};

use crate::dataset::Batch;
use crate::dataset::build::is_default;
use crate::features::FeatureSet;
use crate::numeric::lanes::LANES;
use serde::{Deserialize, Serialize};

/// How a network is trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TrainConfig {
    /// Units of each hidden layer.
    pub hidden: Vec<usize>,
    /// Passes over the training rows.
    pub epochs: u64,
    /// Rows of one step, a multiple of sixteen; the last step of an epoch takes what is left.
    pub batch: usize,
    /// Adam's step size.
    pub learning_rate: f64,
    /// How the step size changes over the steps.
    #[serde(default, skip_serializing_if = "is_default")]
    pub schedule: Schedule,
    /// Steps over which the step size first rises from 0.
    #[serde(default, skip_serializing_if = "is_default")]
    pub warmup_steps: u64,
    /// Networks to train, from as many seeds; the one with the least validation loss is kept.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub seeds: u64,
    /// Adam's decay of the mean gradient.
    #[serde(default = "default_beta1")]
    pub beta1: f64,
    /// Adam's decay of the mean squared gradient.
    #[serde(default = "default_beta2")]
    pub beta2: f64,
    /// Adam's guard against division by zero.
    #[serde(default = "default_epsilon")]
    pub epsilon: f64,
    /// Epochs between two checkpoints.
    #[serde(default = "default_checkpoint_every")]
    pub checkpoint_every: u64,
}

/// How the step size changes over the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Schedule {
    /// Not at all.
    #[default]
    Constant,
    /// Along half a cosine down to 0 at the last step.
    Cosine,
}

fn one() -> u64 {
    1
}
fn is_one(n: &u64) -> bool {
    *n == 1
}
fn default_beta1() -> f64 {
    0.9
}
fn default_beta2() -> f64 {
    0.999
}
/// What Keras, which NMT24 used, takes by default.
fn default_epsilon() -> f64 {
    1e-7
}
fn default_checkpoint_every() -> u64 {
    50
}

/// What is wrong with a training configuration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("train.{field} = {value}: must be {expected}")]
pub struct TrainConfigError {
    field: &'static str,
    value: String,
    expected: &'static str,
}

impl TrainConfig {
    /// Checks every field.
    ///
    /// # Errors
    /// [`TrainConfigError`] names the field and what it must be.
    pub fn validate(&self) -> Result<(), TrainConfigError> {
        let most = crate::model::mlp::MAX_UNITS;
        let unit = |x: f64| (0.0..1.0).contains(&x);
        let checks = [
            (
                self.hidden.iter().all(|&h| (1..=most).contains(&h)) && self.hidden.len() <= 16,
                "hidden",
                format!("{:?}", self.hidden),
                "at most 16 layers of 1 to 4096 units",
            ),
            (self.epochs >= 1, "epochs", self.epochs.to_string(), "at least 1"),
            (
                self.batch >= 1 && self.batch.is_multiple_of(LANES),
                "batch",
                self.batch.to_string(),
                "a multiple of 16, at least 16",
            ),
            (
                (1..=1000).contains(&self.seeds),
                "seeds",
                self.seeds.to_string(),
                "from 1 to 1000",
            ),
            (
                self.learning_rate > 0.0 && self.learning_rate <= 1.0,
                "learning_rate",
                self.learning_rate.to_string(),
                "greater than 0 and at most 1",
            ),
            (unit(self.beta1), "beta1", self.beta1.to_string(), "from 0 to below 1"),
            (unit(self.beta2), "beta2", self.beta2.to_string(), "from 0 to below 1"),
            (
                self.epsilon > 0.0 && self.epsilon.is_finite(),
                "epsilon",
                self.epsilon.to_string(),
                "finite and greater than 0",
            ),
            (
                self.checkpoint_every >= 1,
                "checkpoint_every",
                self.checkpoint_every.to_string(),
                "at least 1",
            ),
        ];
        match checks.into_iter().find(|(ok, ..)| !ok) {
            Some((_, field, value, expected)) => Err(TrainConfigError { field, value, expected }),
            None => Ok(()),
        }
    }
}

impl TrainConfig {
    /// Step size of a step, from 1, of so many.
    pub fn learning_rate_at(&self, step: u64, steps: u64) -> f64 {
        let warm = if self.warmup_steps == 0 {
            1.0
        } else {
            (step as f64 / self.warmup_steps as f64).min(1.0)
        };
        let decay = match self.schedule {
            Schedule::Constant => 1.0,
            Schedule::Cosine => 0.5 * (1.0 + libm::cos(std::f64::consts::PI * step as f64 / steps as f64)),
        };
        self.learning_rate * warm * decay
    }
}

/// What computes gradients and takes Adam's steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Backend {
    /// Our own kernel; see [`fused`].
    Fused,
    /// One of burn's.
    Burn(Engine),
}

/// Why a backend cannot be had.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BackendError {
    /// There is none of that name.
    #[error("backend '{0}': there is none of that name; there are {list}", list = Backend::NAMES.join(", "))]
    Unknown(String),
    /// It is left out of this program.
    #[error(
        "backend '{name}': this program was built without it; build it with 'cargo build --release --features {feature}', or choose fused"
    )]
    NotBuilt {
        /// The backend.
        name: &'static str,
        /// The cargo feature that it needs.
        feature: &'static str,
    },
    /// There is nothing to compute on.
    #[error("backend '{name}': {reason}; or choose fused, which needs no GPU")]
    NoDevice {
        /// The backend.
        name: &'static str,
        /// What it says.
        reason: String,
    },
    /// The GPU takes no step.
    #[error(
        "backend '{name}' on {adapter}: a trial step failed: {reason}; choose a smaller batch, another driver, or fused, which needs no GPU"
    )]
    Failed {
        /// The backend.
        name: &'static str,
        /// Name of the GPU.
        adapter: String,
        /// What was said against it.
        reason: String,
    },
}

impl Backend {
    /// Names of all backends, of those too that this program may have been built without.
    pub const NAMES: [&str; 5] = ["fused", "flex", "ndarray", "wgpu", "cuda"];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fused => "fused",
            Self::Burn(engine) => engine.name(),
        }
    }

    /// The backend of a name.
    ///
    /// # Errors
    /// [`BackendError::Unknown`]; [`BackendError::NotBuilt`] where the cargo feature of that name was off.
    pub fn named(name: &str) -> Result<Self, BackendError> {
        if name == "fused" {
            return Ok(Self::Fused);
        }
        match Engine::ALL.iter().find(|engine| engine.name() == name) {
            Some(&engine) => Ok(Self::Burn(engine)),
            None => Err(match Self::NAMES.into_iter().find(|known| *known == name) {
                Some(name) => BackendError::NotBuilt {
                    name,
                    feature: if name == "ndarray" { "burn" } else { name },
                },
                None => BackendError::Unknown(name.to_owned()),
            }),
        }
    }

    /// Name of the GPU that it computes on; none where that is the CPU.
    ///
    /// # Errors
    /// [`BackendError::NoDevice`] where the machine has nothing that it computes on.
    pub fn adapter(self) -> Result<Option<String>, BackendError> {
        match self {
            Self::Fused => Ok(None),
            Self::Burn(engine) => engine.adapter(),
        }
    }

    /// An optimiser of this kind, at the given weights and with fresh moments.
    ///
    /// # Errors
    /// [`BackendError::NoDevice`] where the machine has nothing that it computes on, [`BackendError::Failed`] where that takes no step.
    pub fn optimiser(
        self,
        set: FeatureSet,
        shapes: &[(usize, usize)],
        parameters: &[f32],
        config: &TrainConfig,
    ) -> Result<Box<dyn Optimiser>, BackendError> {
        Ok(match self {
            Self::Fused => Box::new(fused::Fused::new(set, shapes, parameters, config)),
            #[cfg(feature = "burn")]
            Self::Burn(engine) => Box::new(burn::BurnOptimiser::new(engine, set, shapes, parameters, config)?),
            #[cfg(not(feature = "burn"))]
            Self::Burn(engine) => match engine {},
        })
    }
}

impl TryFrom<String> for Backend {
    type Error = BackendError;

    fn try_from(name: String) -> Result<Self, BackendError> {
        Self::named(&name)
    }
}

impl From<Backend> for String {
    fn from(backend: Backend) -> Self {
        backend.name().to_owned()
    }
}

/// The moments of Adam, in the order of the parameters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdamMoments {
    /// Steps taken.
    pub steps: u64,
    /// Decayed mean of the gradient; empty before the first step.
    pub first: Vec<f32>,
    /// Decayed mean of the squared gradient; empty before the first step.
    pub second: Vec<f32>,
}

/// A network being fitted. Parameters are flat: layer by layer, weights `[in][out]`, then biases.
pub trait Optimiser: Send {
    /// One step of Adam on the weighted mean squared error of a batch; the error is of the weights before the step.
    fn step(&mut self, batch: Batch<'_>, learning_rate: f64) -> f64;

    /// Weighted mean squared error of a batch and its gradient.
    fn gradient(&mut self, batch: Batch<'_>) -> (f64, Vec<f32>);

    /// The weights as they stand.
    fn parameters(&self) -> Vec<f32>;

    /// Adam's moments as they stand.
    fn moments(&self) -> AdamMoments;

    /// Continues from elsewhere.
    fn restore(&mut self, parameters: &[f32], moments: &AdamMoments);
}

#[cfg(test)]
mod tests {
    use super::fused::{Fused, all_blocks};
    use super::*;
    use crate::dataset::{Blocks, Rows};
    use crate::model::{Mlp, Provenance};
    use crate::numeric::require::or_skip;
    use crate::numeric::rng::stream;
    use fearless_simd::Level;
    use rand::RngExt;

    type Shapes = Vec<(usize, usize)>;

    fn config() -> TrainConfig {
        toml::from_str("hidden = [8, 4]\nepochs = 1\nbatch = 64\nlearning_rate = 1e-3").unwrap()
    }

    /// burn's backends that can be had here. One without its device is reported as skipped (`gpu` for wgpu, `cuda`).
    fn engines() -> Vec<Engine> {
        let mut engines = Engine::ALL.to_vec();
        engines.retain(|engine| {
            let tool = if engine.name() == "cuda" { "cuda" } else { "gpu" };
            or_skip(tool, engine.adapter()).is_some()
        });
        #[cfg(feature = "burn")]
        assert!(engines.contains(&Engine::Ndarray));
        #[cfg(feature = "flex")]
        assert!(engines.contains(&Engine::Flex));
        engines
    }

    /// Every way to fit a network: burn's backends, the kernel at the best and at the least SIMD level, its scalar twin.
    fn optimisers(set: FeatureSet, shapes: &Shapes, parameters: &[f32]) -> Vec<(&'static str, Box<dyn Optimiser>)> {
        let fused = |level| Box::new(Fused::at_level(level, set, shapes, parameters, &config())) as Box<dyn Optimiser>;
        let mut all: Vec<(&'static str, Box<dyn Optimiser>)> = vec![
            (
                "scalar",
                Box::new(scalar::Scalar::new(set, shapes, parameters, &config())),
            ),
            ("fused", fused(Level::new())),
            ("fused, baseline", fused(Level::baseline())),
        ];
        for engine in engines() {
            all.push((
                engine.name(),
                Backend::Burn(engine)
                    .optimiser(set, shapes, parameters, &config())
                    .unwrap(),
            ));
        }
        all
    }

    /// Random rows; every fifth weighs 0, the others 0.5 to 1.5.
    fn blocks(set: FeatureSet, n: usize) -> Blocks {
        let mut rng = stream(1, 0, 0);
        let rows = Rows {
            feature_set: set,
            features: (0..set.width() * n).map(|_| rng.random_range(-1.0..1.0)).collect(),
            targets: (0..n).map(|_| rng.random_range(0.0..1.0)).collect(),
            weights: (0..n)
                .map(|i| if i % 5 == 0 { 0.0 } else { rng.random_range(0.5..1.5) })
                .collect(),
            pixels: vec![0; n],
        };
        Blocks::of(&rows, &(0..n as u32).collect::<Vec<_>>())
    }

    fn loss(set: FeatureSet, shapes: &Shapes, parameters: &[f32], batch: Batch<'_>) -> f64 {
        let (features, targets, weights) = batch.to_rows();
        let mlp = Mlp::new(
            "fd",
            set,
            initial::layers(shapes, parameters).unwrap(),
            Provenance::default(),
        )
        .unwrap();
        let errors = mlp
            .forward_batch::<f64>(&features)
            .into_iter()
            .zip(&targets)
            .map(|(o, &t)| (o - f64::from(t)).powi(2));
        errors.zip(&weights).map(|(e, &w)| e * f64::from(w)).sum::<f64>() / targets.len() as f64
    }

    /// Greatest difference as a share of the layer's largest gradient.
    fn off(shapes: &Shapes, found: &[f32], expected: &[f64]) -> f64 {
        assert!(!expected.is_empty() && found.len() == expected.len());
        let mut at = 0;
        let mut worst = 0.0f64;
        for &(i, o) in shapes {
            let layer = at..at + (i + 1) * o;
            let largest = expected[layer.clone()].iter().fold(0.0f64, |m, d| m.max(d.abs()));
            for (&f, e) in found[layer.clone()].iter().zip(&expected[layer]) {
                let e = (f64::from(f) - e).abs() / largest;
                worst = if e.is_nan() { f64::INFINITY } else { worst.max(e) };
            }
            at += (i + 1) * o;
        }
        worst
    }

    /// Gradients of every parameter against central differences of our own f64 forward pass. Tolerance: 2e-3 of the layer's largest gradient (the
    /// step of 2^−11 crosses a few ReLU kinks). Control: the gradients of half the batch are further off than that.
    #[test]
    fn gradients_agree_with_finite_differences() {
        for set in [FeatureSet::Paper, FeatureSet::Recentred] {
            let shapes = initial::shapes(7, &[8, 4]);
            let parameters = initial::glorot(&shapes, 5);
            let blocks = blocks(set, 90);
            let order = all_blocks(&blocks);
            let batch = Batch {
                blocks: &blocks,
                order: &order,
            };
            let differences: Vec<f64> = (0..parameters.len())
                .map(|i| {
                    let at = |h: f32| {
                        let mut moved = parameters.clone();
                        moved[i] += h;
                        (f64::from(moved[i]), loss(set, &shapes, &moved, batch))
                    };
                    let ((x1, l1), (x0, l0)) = (at(1.0 / 2048.0), at(-1.0 / 2048.0));
                    (l1 - l0) / (x1 - x0)
                })
                .collect();
            for (name, mut optimiser) in optimisers(set, &shapes, &parameters) {
                let (value, gradient) = optimiser.gradient(batch);
                assert!(
                    (value - loss(set, &shapes, &parameters, batch)).abs() < 1e-6,
                    "{name}: {value}"
                );
                assert!(
                    off(&shapes, &gradient, &differences) < 2e-3,
                    "{name}: {}",
                    off(&shapes, &gradient, &differences)
                );
                let (_, other) = optimiser.gradient(Batch {
                    order: &order[..3],
                    ..batch
                });
                assert!(off(&shapes, &other, &differences) > 2e-3, "{name}: the control passed");
            }
        }
    }

    /// The kernel, its scalar twin and burn's autodiff agree to 1e-5 of each layer's largest gradient, for compiled-in sizes, odd ones, none and many hidden
    /// layers, and batches that fill no tile. Control: another batch's gradient is further off.
    #[test]
    fn three_opinions_on_the_gradient() {
        let cases: [(FeatureSet, &[usize]); 7] = [
            (FeatureSet::Paper, &[32, 16]),
            (FeatureSet::Recentred, &[32, 16]),
            (FeatureSet::Recentred, &[16, 8]),
            (FeatureSet::Recentred6, &[32, 16]),
            (FeatureSet::Recentred8, &[5, 3, 9]),
            (FeatureSet::DeepWeightedBlended, &[10]),
            (FeatureSet::Recentred, &[]),
        ];
        for (set, hidden) in cases {
            let shapes = initial::shapes(set.width(), hidden);
            let parameters = initial::glorot(&shapes, 6);
            let blocks = blocks(set, 5000);
            let order = all_blocks(&blocks);
            let batch = Batch {
                blocks: &blocks,
                order: &order,
            };
            let mut opinions: Vec<_> = optimisers(set, &shapes, &parameters)
                .into_iter()
                .map(|(name, mut o)| (name, o.gradient(batch)))
                .collect();
            let (_, (error, exact)) = opinions.remove(0);
            let exact: Vec<f64> = exact.into_iter().map(f64::from).collect();
            for (name, (value, gradient)) in opinions {
                assert!(
                    (value / error - 1.0).abs() < 1e-5,
                    "{name} {hidden:?}: {value} for {error}"
                );
                assert!(
                    off(&shapes, &gradient, &exact) < 1e-5,
                    "{name} {hidden:?}: {}",
                    off(&shapes, &gradient, &exact)
                );
            }
            let half = Batch {
                order: &order[..150],
                ..batch
            };
            let (_, other) = Backend::Fused
                .optimiser(set, &shapes, &parameters, &config())
                .unwrap()
                .gradient(half);
            assert!(off(&shapes, &other, &exact) > 1e-5, "the control passed");
        }
    }

    /// The losses of the first 100 steps agree to 1e-4. Control: another step size does not.
    #[test]
    fn the_same_path_as_burns() {
        let shapes = initial::shapes(7, &[32, 16]);
        let parameters = initial::glorot(&shapes, 8);
        let blocks = blocks(FeatureSet::Recentred, 4096);
        let order = all_blocks(&blocks);
        let path = |backend: Backend, rate: f64| -> Vec<f64> {
            let mut optimiser = backend
                .optimiser(FeatureSet::Recentred, &shapes, &parameters, &config())
                .unwrap();
            (0..100)
                .map(|step| {
                    optimiser.step(
                        Batch {
                            blocks: &blocks,
                            order: &order[16 * (step % 16)..][..16],
                        },
                        rate,
                    )
                })
                .collect()
        };
        let far = |a: &[f64], b: &[f64]| {
            a.iter()
                .zip(b)
                .map(|(a, b)| (a / b - 1.0).abs())
                .fold(0.0, |m: f64, e| if e.is_nan() { f64::INFINITY } else { m.max(e) })
        };
        let ours = path(Backend::Fused, 1e-3);
        for engine in engines() {
            let [theirs, other] = [1e-3, 2e-3].map(|rate| path(Backend::Burn(engine), rate));
            assert!(far(&ours, &theirs) < 1e-4, "{}: {}", engine.name(), far(&ours, &theirs));
            assert!(far(&ours, &other) > 1e-4, "{}: the control passed", engine.name());
        }
    }

    /// A GPU has a name and takes its trial step, and what is no GPU has none; a trial that fails says whose it was.
    #[test]
    fn adapters_have_names() {
        assert_eq!(Backend::Fused.adapter(), Ok(None));
        for engine in engines() {
            let adapter = engine.adapter().unwrap();
            assert_eq!(
                adapter.is_none(),
                matches!(engine.name(), "flex" | "ndarray"),
                "{adapter:?}"
            );
            assert!(adapter.is_none_or(|name| !name.is_empty()), "{}", engine.name());
        }
        let error = BackendError::Failed {
            name: "wgpu",
            adapter: "llvmpipe".into(),
            reason: "no memory".into(),
        }
        .to_string();
        assert!(
            error.starts_with("backend 'wgpu' on llvmpipe: a trial step failed: no memory; "),
            "{error}"
        );
    }

    #[test]
    fn threads_change_no_bit() {
        let shapes = initial::shapes(7, &[32, 16]);
        let parameters = initial::glorot(&shapes, 9);
        let blocks = blocks(FeatureSet::Paper, 10_000);
        let order = all_blocks(&blocks);
        let [one, three] = [1, 3].map(|threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
                .install(|| {
                    let mut optimiser = Backend::Fused
                        .optimiser(FeatureSet::Paper, &shapes, &parameters, &config())
                        .unwrap();
                    for _ in 0..5 {
                        optimiser.step(
                            Batch {
                                blocks: &blocks,
                                order: &order,
                            },
                            1e-2,
                        );
                    }
                    optimiser.parameters()
                })
        });
        assert_eq!(one, three);
    }

    /// Answers that leave f32's range of normal numbers, rows without weight, weights that are zero: finite all the same.
    #[test]
    fn poison_stays_finite() {
        let set = FeatureSet::Recentred;
        let shapes = initial::shapes(7, &[32, 16]);
        for scale in [0.0f32, 1e-30, 1.0, 100.0] {
            let parameters: Vec<f32> = initial::glorot(&shapes, 10).into_iter().map(|p| p * scale).collect();
            let n = 300;
            let column = |c: usize| {
                move |i: usize| {
                    if c == 2 {
                        [-2.99, 0.0, 3.0, 8.0][i % 4]
                    } else {
                        [1.0, -1.0, 0.0, 1e-39][(i / 4) % 4]
                    }
                }
            };
            let rows = Rows {
                feature_set: set,
                features: (0..n).flat_map(|i| (0..7).map(move |c| column(c)(i))).collect(),
                targets: (0..n).map(|i| [0.0, 1.0, 1e-40][i % 3]).collect(),
                weights: vec![],
                pixels: vec![0; n],
            };
            let blocks = Blocks::of(&rows, &(0..n as u32).collect::<Vec<_>>());
            let order = all_blocks(&blocks);
            let mut optimiser = Backend::Fused.optimiser(set, &shapes, &parameters, &config()).unwrap();
            for _ in 0..50 {
                assert!(
                    optimiser
                        .step(
                            Batch {
                                blocks: &blocks,
                                order: &order
                            },
                            1e-2
                        )
                        .is_finite()
                );
            }
            assert!(optimiser.parameters().iter().all(|p| p.is_finite()));
        }
    }

    /// One step of Adam from fresh moments moves every parameter by lr · g/(|g| + ε·…): the closed form of its first step. Tolerance 3e-6.
    #[test]
    fn first_step_of_adam_has_its_closed_form() {
        let shapes = initial::shapes(7, &[8, 4]);
        let parameters = initial::glorot(&shapes, 6);
        let blocks = blocks(FeatureSet::Paper, 64);
        let order = all_blocks(&blocks);
        let batch = Batch {
            blocks: &blocks,
            order: &order,
        };
        for (name, mut optimiser) in optimisers(FeatureSet::Paper, &shapes, &parameters) {
            let (_, gradient) = optimiser.gradient(batch);
            optimiser.step(batch, 1e-3);
            for ((after, before), g) in optimiser.parameters().iter().zip(&parameters).zip(gradient) {
                if g.abs() > 1e-4 {
                    assert!(
                        (after - before + 1e-3 * g.signum()).abs() < 3e-6,
                        "{name}: {before} -> {after}, gradient {g}"
                    );
                }
            }
            assert_eq!(optimiser.moments().steps, 1);
        }
    }

    /// Steps after a restore are the steps without one, to the bit.
    #[test]
    fn restored_moments_continue_the_same_path() {
        let shapes = initial::shapes(7, &[8, 4]);
        let parameters = initial::glorot(&shapes, 7);
        let blocks = blocks(FeatureSet::Paper, 64);
        let order = all_blocks(&blocks);
        let batch = Batch {
            blocks: &blocks,
            order: &order,
        };
        let fresh = || optimisers(FeatureSet::Paper, &shapes, &parameters);
        for ((name, mut straight), (_, mut resumed)) in fresh().into_iter().zip(fresh()) {
            for _ in 0..3 {
                straight.step(batch, 1e-3);
            }
            resumed.restore(&straight.parameters(), &straight.moments());
            assert_eq!(resumed.step(batch, 1e-3), straight.step(batch, 1e-3), "{name}");
            assert_eq!(resumed.parameters(), straight.parameters(), "{name}");
            assert_eq!(resumed.moments(), straight.moments(), "{name}");
        }
    }

    /// Every name is known: of what is built in it gives the backend, which gives it back, in files too; of what is not, how to build it.
    #[test]
    fn names_of_backends() {
        for name in Backend::NAMES {
            match Backend::named(name) {
                Ok(backend) => {
                    assert_eq!((backend.name(), String::from(backend).as_str()), (name, name));
                    assert_eq!(
                        serde_json::from_value::<Backend>(serde_json::to_value(backend).unwrap()).unwrap(),
                        backend
                    );
                }
                Err(error) => {
                    assert!(
                        name == "wgpu" && !cfg!(feature = "wgpu") || name == "cuda" && !cfg!(feature = "cuda"),
                        "{name}"
                    );
                    assert!(error.to_string().contains(&format!("--features {name}")), "{error}");
                }
            }
        }
        assert!(
            Backend::named("jax")
                .unwrap_err()
                .to_string()
                .ends_with("there are fused, flex, ndarray, wgpu, cuda")
        );
    }

    #[test]
    fn step_sizes_rise_and_fall() {
        let config: TrainConfig = toml::from_str(
            "hidden = []\nepochs = 1\nbatch = 64\nlearning_rate = 0.5\nschedule = \"cosine\"\nwarmup_steps = 10",
        )
        .unwrap();
        assert!((config.learning_rate_at(1, 1000) - 0.05).abs() < 1e-6);
        assert!((config.learning_rate_at(500, 1000) - 0.25).abs() < 1e-9);
        assert!(config.learning_rate_at(1000, 1000).abs() < 1e-12);
    }
}
