//! What transparency methods cost against their error on one fragment list, on the CPU and on the GPU.

use super::{BenchError, Plan, Summary, calls_that_fill};
use crate::evaluate::order;
use crate::evaluate::{EvaluateError, Truth};
use crate::export::{Format, Precision};
use crate::features::FeatureSet;
use crate::gpu::list::Passes;
use crate::gpu::{DeviceList, Gpu, GpuError, MethodShader};
use crate::model::Mlp;
use crate::oit::neural::{Neural, Skip};
use crate::oit::shader::Composite;
use crate::oit::{self, Accumulated, Capabilities, Context, Method, MethodError};
use crate::pixel::{FragmentList, Pixel};
use std::hint::black_box;
use std::time::Instant;

/// The GPU's passes without a method: every weight is 1, once a fragment and its pixel's total are there. What it
/// costs, nearly every method costs.
pub const NONE: &str = "none";

/// Why costs could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum MethodsError {
    /// The plan is none.
    #[error(transparent)]
    Plan(#[from] BenchError),
    /// There is nothing to weigh.
    #[error("the fragment list has no fragments, so that nothing takes any time; choose another")]
    NoFragments,
    /// A method cannot be applied to the list, or its picture not be made.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// The GPU refused.
    #[error("{method}: {source}")]
    Gpu {
        /// The method.
        method: String,
        /// Why.
        source: GpuError,
    },
}

/// A method to measure.
pub enum Candidate {
    /// A method by its own.
    Method(Box<dyn Method>),
    /// A network, on the GPU in each of the forms that are asked for.
    Network(Box<Mlp>),
}

impl Candidate {
    /// Its name.
    pub fn name(&self) -> String {
        match self {
            Self::Method(method) => method.name(),
            Self::Network(mlp) => format!("neural:{}", mlp.name()),
        }
    }
}

/// Whose clock took the time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// Timestamps of the device.
    Device,
    /// The wall's, around work that is waited for.
    Wall,
}

impl Clock {
    /// As reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Device => "device timestamps",
            Self::Wall => "wall clock",
        }
    }
}

/// What one method costs on one adapter, and what it gets wrong there.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// Name of the method.
    pub method: String,
    /// "7-32-16-1", of networks.
    pub network: Option<String>,
    /// Form of the exported shader, of networks on the GPU.
    pub format: Option<&'static str>,
    /// What computed.
    pub adapter: String,
    /// Its arithmetic in pass 2: "f64", "f32 SIMD", "f32", "f16 and f32".
    pub arithmetic: &'static str,
    /// Whose clock took the time.
    pub clock: Clock,
    /// Fragments of the list.
    pub fragments: usize,
    /// Memory, passes, needs, and whether the order of the fragments counts.
    pub capabilities: Capabilities,
    /// Mean squared error of T; none where weights are no transmittances, NaN where one is not finite.
    pub transmittance_mse: Option<f64>,
    /// Mean squared error of the image; none where the list makes none, NaN where a channel is not finite.
    pub image_mse: Option<f64>,
    /// Mean of the FLIP map; as the image's error.
    pub flip_mean: Option<f64>,
    /// Number of weights that are not finite.
    pub nonfinite: u64,
    /// Number of channel values of the image that are not finite.
    pub image_nonfinite: Option<u64>,
    /// Calls of one repetition.
    pub calls: u64,
    /// Seconds of both passes, the mean over a repetition's calls; one number a repetition.
    pub both: Vec<f64>,
    /// Seconds of either pass likewise; none where they are not apart, as in networks on the CPU.
    pub passes: Option<Passed>,
    /// Whether no other method of the adapter is at once no slower and no worse, and one of both better; see
    /// [`Table::time`].
    pub on_front: bool,
}

/// Raw samples of either pass \[s\].
#[derive(Debug, Clone, PartialEq)]
pub struct Passed {
    /// Pass 1.
    pub accumulate: Vec<f64>,
    /// Pass 2.
    pub weights: Vec<f64>,
}

impl Cost {
    /// The error that the front is about: the image's where there is one, else that of T.
    pub fn error(&self) -> Option<f64> {
        self.image_mse.or(self.transmittance_mse)
    }
}

/// What the methods of a table ran on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Processor {
    /// The CPU.
    Cpu,
    /// A GPU, in compute passes.
    Gpu,
}

/// All methods of one adapter; figures of two adapters are not to be compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Name of the adapter.
    pub adapter: String,
    /// Whose clock took the times.
    pub clock: Clock,
    /// What they ran on.
    pub processor: Processor,
    /// Rows, the fastest first.
    pub costs: Vec<Cost>,
    /// What was not measured.
    pub left_out: Vec<LeftOut>,
}

/// A method that was not measured.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// Its name.
    pub method: String,
    /// Why.
    pub why: String,
    /// Whether nothing is wrong with what was asked: it has no shader, or the adapter no f16.
    pub harmless: bool,
}

impl LeftOut {
    fn new(method: impl Into<String>, why: impl ToString, harmless: bool) -> Self {
        Self {
            method: method.into(),
            why: why.to_string(),
            harmless,
        }
    }
}

impl Table {
    /// The time of a row that the front is about, against [`Cost::error`]: both passes, since what one method keeps in
    /// pass 1 another computes in pass 2 \[s\].
    pub fn time(&self, cost: &Cost) -> f64 {
        Summary::of(&cost.both).median
    }

    fn finish(mut self) -> Self {
        let points: Vec<Option<(f64, f64)>> = self
            .costs
            .iter()
            .map(|c| {
                c.error()
                    .filter(|_| c.method != NONE)
                    .map(|error| (self.time(c), error))
            })
            .collect();
        for (cost, on) in self.costs.iter_mut().zip(front(&points)) {
            cost.on_front = on;
        }
        let times: Vec<f64> = self.costs.iter().map(|c| self.time(c)).collect();
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|&a, &b| times[a].total_cmp(&times[b]));
        self.costs = order.into_iter().map(|i| self.costs[i].clone()).collect();
        self
    }
}

/// Which points (time, error) no other one dominates: none is at most as great in both and less in one. What has no
/// error, or NaN, is on no front.
pub fn front(points: &[Option<(f64, f64)>]) -> Vec<bool> {
    let usable = |p: &Option<(f64, f64)>| p.filter(|(t, e)| !t.is_nan() && !e.is_nan());
    let dominates = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    points
        .iter()
        .map(|p| usable(p).is_some_and(|p| !points.iter().filter_map(usable).any(|q| dominates(q, p))))
        .collect()
}

/// The list, the answer, and how to measure.
pub struct Setting<'a> {
    /// The exact answer for the list.
    pub truth: &'a Truth<'a>,
    /// Planes and depth range.
    pub context: Context,
    /// How often.
    pub plan: Plan,
    /// Which fragments networks are run for.
    pub skip: Skip,
}

/// Runs a method once and says how long both passes took together, and each where they are apart \[s\].
type Timed<'a> = Box<dyn FnMut() -> Result<(f64, Option<[f64; 2]>), MethodsError> + 'a>;

/// A row whose times are yet to be taken.
struct TimedCandidate<'a> {
    cost: Cost,
    timed: Timed<'a>,
}

impl Setting<'_> {
    fn list(&self) -> &FragmentList {
        self.truth.list()
    }

    fn check(&self) -> Result<(), MethodsError> {
        self.plan.validate()?;
        if self.list().is_empty() {
            Err(MethodsError::NoFragments)
        } else {
            Ok(())
        }
    }

    /// A row without times, from how a method did; where the order of the fragments counts, in a random one.
    fn cost(&self, method: &dyn Method, adapter: &str, clock: Clock) -> Result<Cost, MethodsError> {
        let result = if method.capabilities().order_dependent {
            let shuffled = order::shuffle_fragments(self.list(), 1);
            let truth = Truth::new(&shuffled, self.truth.background());
            truth.judge(method, self.context)?.result
        } else {
            self.truth.judge(method, self.context)?.result
        };
        Ok(Cost {
            method: result.method,
            network: None,
            format: None,
            adapter: adapter.to_owned(),
            arithmetic: "f64",
            clock,
            fragments: self.list().len(),
            capabilities: result.capabilities,
            transmittance_mse: result.transmittance_mse,
            image_mse: result.image_mse,
            flip_mean: result.flip_mean,
            nonfinite: result.nonfinite,
            image_nonfinite: result.image_nonfinite,
            calls: 0,
            both: Vec::new(),
            passes: None,
            on_front: false,
        })
    }

    /// What methods cost on this machine's CPU, named `adapter`: classic ones as the f64 reference that they are here,
    /// networks with f32 SIMD.
    ///
    /// A method that cannot be applied to the list is left out, with the reason.
    ///
    /// # Errors
    /// [`MethodsError`] where the plan is none or the list empty.
    pub fn on_cpu(
        &self,
        adapter: &str,
        candidates: &[Candidate],
        progress: &dyn Fn(u64),
    ) -> Result<Table, MethodsError> {
        self.check()?;
        let networks: Vec<Option<Neural>> = candidates
            .iter()
            .map(|c| match c {
                Candidate::Network(mlp) => Some(Neural::new((**mlp).clone()).with_skip(self.skip)),
                Candidate::Method(_) => None,
            })
            .collect();
        let mut left_out = Vec::new();
        let mut timed_candidates = Vec::new();
        for (candidate, neural) in candidates.iter().zip(&networks) {
            let method: &dyn Method = match (candidate, neural) {
                (Candidate::Method(method), _) => &**method,
                (_, Some(neural)) => neural,
                (Candidate::Network(_), None) => continue,
            };
            let mut cost = match self.cost(method, adapter, Clock::Wall) {
                Ok(cost) => cost,
                Err(why) => {
                    left_out.push(LeftOut::new(method.name(), why, false));
                    continue;
                }
            };
            let network = match candidate {
                Candidate::Network(mlp) => Some(mlp),
                Candidate::Method(_) => None,
            };
            if let Some(mlp) = network {
                cost.network = Some(mlp.shape());
                cost.arithmetic = "f32 SIMD";
            }
            let apart = network.is_none();
            let timed = move || {
                let start = Instant::now();
                let accumulated = method
                    .accumulate(self.list(), self.context)
                    .map_err(EvaluateError::from)?;
                let accumulate = start.elapsed().as_secs_f64();
                black_box(oit::weights(self.list(), &*accumulated));
                let both = start.elapsed().as_secs_f64();
                Ok((both, apart.then_some([accumulate, both - accumulate])))
            };
            timed_candidates.push(TimedCandidate {
                cost,
                timed: Box::new(timed),
            });
        }
        let costs = self.run_interleaved(timed_candidates, progress)?;
        Ok(Table {
            adapter: adapter.to_owned(),
            clock: Clock::Wall,
            processor: Processor::Cpu,
            costs,
            left_out,
        }
        .finish())
    }

    /// What methods cost on a GPU in compute passes over the list: pass 1 a thread a pixel, pass 2 a thread a fragment.
    /// Errors are those of the GPU's own weights. Pipelines are made, and run once, outside of what is timed.
    ///
    /// A method that has no twin, or cannot be applied to the list, is left out, with the reason.
    ///
    /// # Errors
    /// [`MethodsError`].
    pub fn on_gpu(
        &self,
        gpu: &Gpu,
        candidates: &[Candidate],
        formats: &[Format],
        progress: &dyn Fn(u64),
    ) -> Result<Table, MethodsError> {
        self.check()?;
        let adapter = gpu.name();
        let clock = if gpu.stamps() { Clock::Device } else { Clock::Wall };
        let refused = |method: &str| {
            let method = method.to_owned();
            move |source| MethodsError::Gpu { method, source }
        };
        let list = DeviceList::new(gpu, self.list()).map_err(refused("fragment list"))?;
        let mut left_out = Vec::new();
        let mut timed_candidates = Vec::new();
        for (shader, about) in self.shaders(candidates, formats, gpu.has_f16(), &mut left_out) {
            let range = match shader.depth_range(self.list(), self.context.planes, self.context.depth_range) {
                Ok(range) => range,
                Err(why) => {
                    left_out.push(LeftOut::new(shader.name, why, false));
                    continue;
                }
            };
            let passes = Passes::new(gpu, &list, &shader, range).map_err(refused(&shader.name))?;
            passes.run(gpu).map_err(refused(&shader.name))?;
            let weights = passes.weights(gpu).map_err(refused(&shader.name))?;
            let given = Given {
                name: shader.name.clone(),
                capabilities: about.capabilities,
                transmittance: about.transmittance,
                composite: shader.composite,
                weights: weights.into_iter().map(f64::from).collect(),
            };
            let mut cost = self.cost(&given, &adapter, clock)?;
            (cost.network, cost.format, cost.arithmetic) = (about.network, about.format, about.arithmetic);
            let timed = move || {
                let s = passes.run(gpu).map_err(refused(&shader.name))?;
                Ok((s.accumulate + s.weights, Some([s.accumulate, s.weights])))
            };
            timed_candidates.push(TimedCandidate {
                cost,
                timed: Box::new(timed),
            });
        }
        let costs = self.run_interleaved(timed_candidates, progress)?;
        Ok(Table {
            adapter,
            clock,
            processor: Processor::Gpu,
            costs,
            left_out,
        }
        .finish())
    }

    /// Shaders of all candidates that have one, the empty one first.
    fn shaders(
        &self,
        candidates: &[Candidate],
        formats: &[Format],
        half: bool,
        left_out: &mut Vec<LeftOut>,
    ) -> Vec<(MethodShader, About)> {
        // b0 in f32.
        let none = About {
            capabilities: Capabilities::of_sums(1, false),
            transmittance: true,
            network: None,
            format: None,
            arithmetic: "f32",
        };
        let mut shaders = vec![(MethodShader::empty(NONE), none)];
        for candidate in candidates {
            match candidate {
                Candidate::Method(method) => match method.shader() {
                    Some(shader) => {
                        let (capabilities, transmittance) = (method.capabilities(), method.weights_are_transmittance());
                        shaders.push((
                            shader,
                            About {
                                capabilities,
                                transmittance,
                                network: None,
                                format: None,
                                arithmetic: "f32",
                            },
                        ));
                    }
                    None => left_out.push(LeftOut::new(method.name(), "has no shader", true)),
                },
                Candidate::Network(mlp) => {
                    let neural = Neural::new((**mlp).clone());
                    for &format in formats {
                        if !half && is_half(format) {
                            left_out.push(LeftOut::new(
                                candidate.name(),
                                format!("{}: the adapter has no f16", format.name()),
                                true,
                            ));
                            continue;
                        }
                        match MethodShader::neural(mlp, format).map(|shader| shader.with_skip(self.skip)) {
                            Ok(shader) => {
                                let about = About {
                                    capabilities: neural.capabilities(),
                                    transmittance: mlp.feature_set() != FeatureSet::DeepWeightedBlended,
                                    network: Some(mlp.shape()),
                                    format: Some(format.name()),
                                    arithmetic: if is_half(format) { "f16 and f32" } else { "f32" },
                                };
                                shaders.push((shader, about));
                            }
                            Err(why) => left_out.push(LeftOut::new(candidate.name(), why, false)),
                        }
                    }
                }
            }
        }
        shaders
    }

    /// Every repetition takes each row once, with as many calls as fill a sample.
    fn run_interleaved(
        &self,
        timed_candidates: Vec<TimedCandidate<'_>>,
        progress: &dyn Fn(u64),
    ) -> Result<Vec<Cost>, MethodsError> {
        let mut timed_candidates = timed_candidates;
        for TimedCandidate { cost, timed } in &mut timed_candidates {
            timed()?;
            let mut failed = None;
            let calls = calls_that_fill(self.plan.sample_seconds, |calls| {
                let start = Instant::now();
                for _ in 0..calls {
                    if let Err(error) = timed() {
                        failed = Some(error);
                        break;
                    }
                }
                // A failure fills the sample, so that no more calls are made.
                Ok(if failed.is_some() {
                    self.plan.sample_seconds
                } else {
                    start.elapsed().as_secs_f64().max(1e-9)
                })
            })?;
            if let Some(error) = failed {
                return Err(error);
            }
            cost.calls = calls;
        }
        for repetition in 1..=self.plan.repeat {
            for TimedCandidate { cost, timed } in &mut timed_candidates {
                let mean = 1.0 / cost.calls as f64;
                let (mut both, mut passes) = (0.0, None);
                for _ in 0..cost.calls {
                    let (seconds, apart) = timed()?;
                    both += seconds * mean;
                    if let Some([accumulate, weights]) = apart {
                        let sum = passes.get_or_insert([0.0, 0.0]);
                        sum[0] += accumulate * mean;
                        sum[1] += weights * mean;
                    }
                }
                // A clock that stood still has counted less than its own step.
                cost.both.push(both.max(1e-9));
                if let Some([accumulate, weights]) = passes {
                    let samples = cost.passes.get_or_insert(Passed {
                        accumulate: Vec::new(),
                        weights: Vec::new(),
                    });
                    samples.accumulate.push(accumulate.max(1e-9));
                    samples.weights.push(weights.max(1e-9));
                }
            }
            progress(repetition as u64);
        }
        Ok(timed_candidates.into_iter().map(|e| e.cost).collect())
    }
}

fn is_half(format: Format) -> bool {
    format.precision() == Precision::F16
}

/// What a shader does not say of its method.
struct About {
    capabilities: Capabilities,
    transmittance: bool,
    network: Option<String>,
    format: Option<&'static str>,
    arithmetic: &'static str,
}

/// Weights that were computed elsewhere, as a method.
struct Given {
    name: String,
    capabilities: Capabilities,
    transmittance: bool,
    composite: Composite,
    weights: Vec<f64>,
}

impl Method for Given {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    fn weights_are_transmittance(&self) -> bool {
        self.transmittance
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let rule = match self.composite {
            Composite::Normalised => None,
            Composite::Sum => Some(oit::weighted_sum::WeightedSum.accumulate(list, context)?),
            Composite::Average => Some(oit::weighted_average::WeightedAverage.accumulate(list, context)?),
        };
        Ok(Box::new(GivenWeights {
            weights: &self.weights,
            list,
            rule,
        }))
    }
}

struct GivenWeights<'a> {
    weights: &'a [f64],
    list: &'a FragmentList,
    /// Whose composite it is, where it is not the usual one.
    rule: Option<Box<dyn Accumulated + 'a>>,
}

impl Accumulated for GivenWeights<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        out.copy_from_slice(&self.weights[self.list.range(p)]);
    }

    fn composite(&self, pixel: Pixel<'_>, p: usize, weights: &[f64], background: [f64; 3]) -> [f64; 3] {
        match &self.rule {
            Some(rule) => rule.composite(pixel, p, weights, background),
            None => oit::composite_normalised(pixel, weights, background),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Provenance;
    use crate::model::mlp::tests::random_mlp;

    const PLAN: Plan = Plan {
        repeat: 2,
        sample_seconds: 1e-4,
    };

    /// The front by hand: what is dominated, equal, NaN or without error.
    #[test]
    fn the_front_by_hand() {
        let points = [
            Some((1.0, 5.0)),
            Some((2.0, 3.0)),
            Some((2.5, 3.0)),
            Some((3.0, 4.0)),
            Some((4.0, 1.0)),
            Some((0.5, f64::NAN)),
            None,
            Some((1.0, 5.0)),
        ];
        assert_eq!(front(&points), [true, true, false, false, true, false, false, true]);
        assert_eq!(front(&[]), Vec::<bool>::new());
    }

    fn list() -> FragmentList {
        crate::scene::build(
            &crate::scene::open("spheres").unwrap(),
            &crate::scene::Options {
                size: Some((24, 24)),
                seed: None,
            },
        )
        .unwrap()
    }

    fn candidates() -> Vec<Candidate> {
        let mlp = Mlp::new(
            "r",
            FeatureSet::Recentred,
            random_mlp(&[4], 1).layers().to_vec(),
            Provenance::default(),
        )
        .unwrap();
        let mut all: Vec<Candidate> = ["moment-power-4", "weighted-average", "abuffer"]
            .map(|n| Candidate::Method(oit::parse(n).unwrap()))
            .into_iter()
            .collect();
        all.push(Candidate::Network(Box::new(mlp)));
        all
    }

    /// Every row has as many samples as there are repetitions, rows come fastest first, and errors are those of the
    /// evaluation.
    #[test]
    fn cpu_rows_are_complete() {
        let list = list();
        let truth = Truth::new(&list, [1.0; 3]);
        let setting = Setting {
            truth: &truth,
            context: Context::default(),
            plan: PLAN,
            skip: Skip::Exact,
        };
        let table = setting.on_cpu("this CPU", &candidates(), &|_| {}).unwrap();
        assert_eq!((table.costs.len(), table.left_out.len()), (4, 0));
        assert!(table.costs.windows(2).all(|c| table.time(&c[0]) <= table.time(&c[1])));
        for cost in &table.costs {
            assert!(
                cost.both.len() == 2
                    && cost.both.iter().all(|s| *s > 0.0)
                    && cost.adapter == "this CPU"
                    && cost.calls >= 1
            );
            assert_eq!(cost.passes.is_none(), cost.network.is_some());
        }
        let exact = table.costs.iter().find(|c| c.method == "abuffer").unwrap();
        assert!(exact.on_front && exact.image_mse == Some(0.0));
        let expected = truth
            .judge(&*oit::parse("moment-power-4").unwrap(), Context::default())
            .unwrap()
            .result;
        let found = table.costs.iter().find(|c| c.method == "moment-power-4").unwrap();
        assert_eq!(
            (found.image_mse, found.flip_mean),
            (expected.image_mse, expected.flip_mean)
        );
    }

    /// On the GPU errors come of its own weights: those of the f32 twin are near the CPU's, and not the same number.
    #[test]
    fn gpu_rows_are_complete() {
        let Some(gpu) = crate::gpu::tests::gpu() else { return };
        let list = list();
        let truth = Truth::new(&list, [1.0; 3]);
        let setting = Setting {
            truth: &truth,
            context: Context::default(),
            plan: PLAN,
            skip: Skip::Exact,
        };
        let table = setting
            .on_gpu(gpu, &candidates(), &[Format::WGSL, Format::WGSL_PLAIN], &|_| {})
            .unwrap();
        let names: Vec<&str> = table.costs.iter().map(|c| c.method.as_str()).collect();
        assert!(
            names.len() == 5 && names.contains(&NONE) && names.iter().filter(|n| **n == "neural:r").count() == 2,
            "{names:?}"
        );
        assert_eq!(table.left_out, [LeftOut::new("abuffer", "has no shader", true)]);
        assert!(table.costs.iter().all(|c| {
            c.passes
                .as_ref()
                .is_some_and(|p| p.weights.len() == 2 && p.accumulate.len() == 2)
        }));
        assert!(table.costs.iter().all(|c| c.method != NONE || !c.on_front) && table.costs.iter().any(|c| c.on_front));
        for name in ["moment-power-4", "weighted-average"] {
            let expected = truth
                .judge(&*oit::parse(name).unwrap(), Context::default())
                .unwrap()
                .result
                .image_mse
                .unwrap();
            let found = table
                .costs
                .iter()
                .find(|c| c.method == name)
                .unwrap()
                .image_mse
                .unwrap();
            assert!((found / expected - 1.0).abs() < 0.05, "{name}: {found:e} {expected:e}");
            if name == "moment-power-4" {
                assert_ne!(found, expected);
            }
        }
    }

    /// Weights of the GPU that are not finite are counted and make the error NaN.
    #[test]
    fn given_weights_hide_nothing() {
        let list = list();
        let truth = Truth::new(&list, [1.0; 3]);
        let mut weights = vec![1.0; list.len()];
        weights[3] = f64::NAN;
        let given = Given {
            name: "given".to_owned(),
            capabilities: Capabilities::of_sums(1, false),
            transmittance: true,
            composite: Composite::Normalised,
            weights,
        };
        let setting = Setting {
            truth: &truth,
            context: Context::default(),
            plan: PLAN,
            skip: Skip::Exact,
        };
        let cost = setting.cost(&given, "none", Clock::Wall).unwrap();
        assert!(cost.nonfinite == 1 && cost.image_mse.unwrap().is_nan() && cost.transmittance_mse.unwrap().is_nan());
    }

    #[test]
    fn errors_say_what_is_wrong() {
        let empty = FragmentList::new(vec![0, 0], vec![], vec![], None).unwrap();
        let truth = Truth::new(&empty, [1.0; 3]);
        let setting = Setting {
            truth: &truth,
            context: Context::default(),
            plan: PLAN,
            skip: Skip::Exact,
        };
        assert!(
            setting
                .on_cpu("", &[], &|_| {})
                .unwrap_err()
                .to_string()
                .contains("no fragments")
        );
        let no = Setting {
            plan: Plan { repeat: 0, ..PLAN },
            ..setting
        };
        assert!(
            no.on_cpu("", &[], &|_| {})
                .unwrap_err()
                .to_string()
                .contains("repetitions")
        );
        // Without planes one weight cannot be had; the others can.
        let list = FragmentList::new(vec![0, 2], vec![1.0, 2.0], vec![0.5, 0.5], None).unwrap();
        let truth = Truth::new(&list, [1.0; 3]);
        let setting = Setting {
            truth: &truth,
            context: Context::default(),
            plan: PLAN,
            skip: Skip::Exact,
        };
        let both = ["weighted-blended:mb13-10", "moment-power-4"].map(|n| Candidate::Method(oit::parse(n).unwrap()));
        let table = setting.on_cpu("", &both, &|_| {}).unwrap();
        assert!(
            table.costs.len() == 1
                && table.left_out.len() == 1
                && table.left_out[0].why.contains("--near")
                && !table.left_out[0].harmless,
            "{:?}",
            table.left_out
        );
    }
}
