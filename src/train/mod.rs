//! Training: the only place that knows burn.

pub mod adam;
pub mod backend;
#[cfg(feature = "burn")]
pub mod burn;
pub mod checkpoint;
pub mod colour;
pub mod config;
mod engine;
pub mod feed;
pub mod fused;
pub mod initial;
pub mod scalar;
pub mod trainer;

pub use backend::{Backend, BackendError};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use config::{Schedule, TrainConfig, TrainConfigError};
pub use engine::Engine;
pub use trainer::{EpochReport, Outcome, Subject, TrainError, train};

use crate::dataset::Batch;
use serde::{Deserialize, Serialize};

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
    /// One step of Adam on the weighted mean squared error of a batch over its rows and outputs; the error is of the
    /// weights before the step.
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
    use crate::features::FeatureSet;
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

    /// Every way to fit a network: burn's backends, the kernel at the best and at the least SIMD level, its scalar
    /// twin.
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

    /// Gradients of every parameter against central differences of our own f64 forward pass. Tolerance: 2e-3 of the
    /// layer's largest gradient (the step of 2^−11 crosses a few ReLU kinks). Control: the gradients of half the batch
    /// are further off than that.
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

    /// The kernel, its scalar twin and burn's autodiff agree to 1e-5 of each layer's largest gradient, for compiled-in
    /// sizes, odd ones, none and many hidden layers, and batches that fill no tile. Control: another batch's gradient
    /// is further off.
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

    /// Three outputs: the kernel at both levels, its scalar twin and burn's autodiff agree to 1e-5 of each layer's
    /// largest gradient, with hidden layers of any size and without; there the scalar twin agrees with central
    /// differences of its own error to 2e-3. Control: another batch's gradient is further off.
    #[test]
    fn opinions_on_three_outputs() {
        for (inputs, hidden) in [(10, &[32, 16][..]), (5, &[7, 3]), (7, &[32, 16]), (4, &[])] {
            let shapes = initial::shapes_to(inputs, hidden, 3);
            let parameters = initial::glorot(&shapes, 7);
            let mut rng = stream(2, 0, 0);
            let rows = 700;
            let mut random = |n: usize| -> Vec<f32> { (0..n).map(|_| rng.random_range(0.0..1.0)).collect() };
            let (features, targets, weights) = (random(inputs * rows), random(3 * rows), random(rows));
            let blocks = Blocks::from_fn(inputs, 3, 0, rows, |at| crate::dataset::Row {
                features: &features[at * inputs..][..inputs],
                targets: &targets[at * 3..][..3],
                weight: weights[at],
            });
            let order = all_blocks(&blocks);
            let batch = Batch {
                blocks: &blocks,
                order: &order,
            };
            let sigmoid = crate::features::Answer::Sigmoid;
            let mut twin = scalar::Scalar::new(sigmoid, &shapes, &parameters, &config());
            let (error, exact) = twin.gradient(batch);
            let exact: Vec<f64> = exact.into_iter().map(f64::from).collect();
            // Without hidden layers nothing has a kink.
            if hidden.is_empty() {
                let differences: Vec<f64> = (0..parameters.len())
                    .map(|i| {
                        let mut at = |h: f32| {
                            let mut moved = parameters.clone();
                            moved[i] += h;
                            twin.restore(&moved, &AdamMoments::default());
                            (f64::from(moved[i]), twin.gradient(batch).0)
                        };
                        let ((x1, l1), (x0, l0)) = (at(1.0 / 2048.0), at(-1.0 / 2048.0));
                        (l1 - l0) / (x1 - x0)
                    })
                    .collect();
                let gradient: Vec<f32> = exact.iter().map(|&g| g as f32).collect();
                assert!(off(&shapes, &gradient, &differences) < 2e-3, "{hidden:?}");
            }
            let fused = |level| Fused::at_level(level, sigmoid, &shapes, &parameters, &config());
            let mut opinions: Vec<(&str, Box<dyn Optimiser>)> = vec![
                ("fused", Box::new(fused(Level::new()))),
                ("fused, baseline", Box::new(fused(Level::baseline()))),
            ];
            for engine in engines() {
                let burn = Backend::Burn(engine).optimiser(sigmoid, &shapes, &parameters, &config());
                opinions.push((engine.name(), burn.unwrap()));
            }
            for (name, mut optimiser) in opinions {
                let (value, gradient) = optimiser.gradient(batch);
                assert!(
                    (value / error - 1.0).abs() < 1e-5,
                    "{name} {hidden:?}: {value} for {error}"
                );
                let found = off(&shapes, &gradient, &exact);
                assert!(found < 1e-5, "{name} {hidden:?}: {found}");
                let half = Batch {
                    order: &order[..20],
                    ..batch
                };
                let (_, other) = optimiser.gradient(half);
                assert!(off(&shapes, &other, &exact) > 1e-5, "{name}: the control passed");
            }
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

    /// Answers that leave f32's range of normal numbers, rows without weight, weights that are zero: finite all the
    /// same.
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

    /// One step of Adam from fresh moments moves every parameter by lr · g/(|g| + ε·…): the closed form of its first
    /// step. Tolerance 3e-6.
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

    /// Every name is known: of what is built in it gives the backend, which gives it back, in files too; of what is
    /// not, how to build it.
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
