//! Lossy specialisation: a network is retrained on one scene's own rows and made smaller for as long as an error is
//! kept.
//!
//! Some of the scene's tiles are held out: no row of theirs is trained on, and a smaller network is accepted only if it
//! keeps the error on them as well as on the whole. They are of the same scene all the same, so that what comes out is
//! for that scene and those like it.

use super::{Errors, ProfileError, Scene};
use crate::dataset::{Batch, Blocks, Rows};
use crate::features::{Extractor, Known, Target};
use crate::model::simplify::walk;
use crate::model::{Dense, Mlp};
use crate::numeric::rng::stream;
use crate::oit::neural::Neural;
use crate::train::{Backend, TrainConfig};
use rand::RngExt;
use rand::seq::SliceRandom;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;

/// Keeps the random numbers of holding out and of shuffling apart from all others.
const PURPOSE: u64 = 0x1008;

/// Sides of the tiles that are held out together \[pixels\]: neighbours look alike.
const TILE: usize = super::facts::TILE as usize;

/// Transmittance of the core in front below which a fragment is not fitted to: the tail does not show.
const MIN_FRONT: f32 = 1e-4;

/// Fewest rows worth fitting to.
pub const MIN_ROWS: usize = 1000;

/// How a network is fitted to a scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Plan {
    /// The error that must be kept: of the image, or of transmittance where there is none; the network's own where
    /// none.
    pub target_error: Option<f64>,
    /// Share of the tiles that are held out.
    pub held_out: f64,
    /// Rows that each size learns from, counted as often as they are visited.
    pub visits: u64,
    /// Most passes over the rows for one size.
    pub epochs: u64,
    /// Most sizes that are tried.
    pub attempts: usize,
    /// Which of the sizes that were tried is taken.
    pub size: SizeChoice,
    /// Seed of everything random.
    pub seed: u64,
}

/// Which of the sizes that were tried is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SizeChoice {
    /// The network's own: it is retrained, and no other size is tried.
    Keep,
    /// The smallest that keeps the error.
    #[default]
    Smallest,
    /// The one with the least error on the whole scene.
    Best,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            target_error: None,
            held_out: 0.2,
            visits: 60_000_000,
            epochs: 400,
            attempts: 10,
            size: SizeChoice::default(),
            seed: 1,
        }
    }
}

/// A size that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Attempt {
    /// Its sizes: "7-32-16-1".
    pub network: String,
    /// Multiply-adds of one evaluation.
    pub multiply_adds: u64,
    /// Error on the whole scene.
    pub error: f64,
    /// Error on what was held out.
    pub error_held_out: f64,
    /// Whether it keeps the error.
    pub kept: bool,
    /// Whether no other size that was tried is both as small and as good.
    pub on_front: bool,
    /// Time of fitting it \[s\].
    pub seconds: f64,
}

/// A network fitted to a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Specialised {
    /// The size that the plan asks for; the first network, retrained at its own size, where none keeps the error.
    pub mlp: Mlp,
    /// What was to be kept on the whole scene.
    pub target_error: f64,
    /// What was to be kept on what was held out: as much better or worse than the first network there as on the whole.
    pub target_held_out: f64,
    /// The network that it began with.
    pub before: Attempt,
    /// Both errors of that network.
    pub errors_before: Errors,
    /// Every size that was tried, in that order.
    pub attempts: Vec<Attempt>,
    /// The attempt that was chosen.
    pub chosen: usize,
    /// Both errors of it.
    pub errors_after: Errors,
    /// Rows of features that were trained on, and that were held out.
    pub rows: [usize; 2],
    /// All of it \[s\].
    pub seconds: f64,
}

/// The scene as its network sees it.
struct Task<'a> {
    scene: &'a Scene<'a>,
    /// Answers that need no network, and what the network's are multiplied by.
    base: Vec<f32>,
    /// Fragments that the network answers.
    evaluated: Vec<usize>,
    features: Vec<f32>,
    /// Whether each pixel is held out.
    held_out: Vec<bool>,
}

impl<'a> Task<'a> {
    fn new(scene: &'a Scene<'a>, mlp: &Mlp, plan: &Plan) -> Result<Self, ProfileError> {
        let list = scene.list;
        let extractor = Extractor::for_list(mlp.feature_set(), list, scene.context.planes, scene.context.depth_range)?;
        let extracted = extractor.list(list, 0..list.pixels())?;
        let needs_network = |i: &usize| matches!(extracted.known[*i], Known::Front(_));
        let evaluated = (0..list.len()).filter(needs_network).collect();
        // Tiles of an image; of another list runs of as many pixels.
        let width = list.size().map_or(list.pixels(), |s| s.0 as usize).max(1);
        let tile_of = |p: usize| {
            if list.size().is_some() {
                (p / width / TILE, p % width / TILE)
            } else {
                (0, p / (TILE * TILE))
            }
        };
        let out = |p: usize| {
            let (y, x) = tile_of(p);
            stream(plan.seed, PURPOSE, ((y as u64) << 32) | x as u64).random_range(0.0..1.0) < plan.held_out
        };
        let held_out = (0..list.pixels()).into_par_iter().map(out).collect();
        Ok(Self {
            scene,
            base: extracted.known.iter().map(Known::factor).collect(),
            evaluated,
            features: extracted.features,
            held_out,
        })
    }

    /// Rows to train on, weighted by what an error of each does to the image, and the number of those held out.
    fn rows(&self, mlp: &Mlp) -> (Rows, usize) {
        let list = self.scene.list;
        let width = mlp.feature_set().width();
        let mut rows = Rows {
            feature_set: mlp.feature_set(),
            features: Vec::new(),
            targets: Vec::new(),
            weights: Vec::new(),
            pixels: Vec::new(),
        };
        let (mut p, mut held_out) = (0, 0);
        for (row, &i) in self.features.chunks_exact(width).zip(&self.evaluated) {
            while list.offsets()[p + 1] <= i as u64 {
                p += 1;
            }
            if self.held_out[p] || self.base[i] < MIN_FRONT {
                held_out += usize::from(self.held_out[p]);
                continue;
            }
            rows.features.extend_from_slice(row);
            // An error of the tail's transmittance is one of T times that of the core in front.
            let front = self.base[i];
            rows.targets
                .push((self.scene.transmittance[i] / f64::from(front)).min(1.0) as f32);
            rows.weights.push(front * front * self.weight(p, i));
            rows.pixels.push(p as u32);
        }
        // Nothing is left out altogether: another light may fall on it. The mean weight becomes 1.
        let total: f64 = rows.weights.iter().map(|&w| f64::from(w)).sum();
        let mean = if total > 0.0 {
            total / rows.weights.len() as f64
        } else {
            1.0
        };
        let weight = |w: f32| 0.9 * (f64::from(w) / mean) as f32 + 0.1;
        rows.weights.iter_mut().for_each(|w| *w = weight(*w));
        (rows, held_out)
    }

    /// Square of the image's derivative by the answer to a fragment: a_i |C_i − m| (1 − e^−b_0)/Σ a T, m the pixel's
    /// own colour.
    fn weight(&self, p: usize, i: usize) -> f32 {
        let list = self.scene.list;
        let a = f64::from(list.alpha()[i]);
        let Some(color) = list.color() else {
            return (a * a) as f32;
        };
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for j in list.range(p) {
            let w = f64::from(list.alpha()[j]) * self.scene.transmittance[j];
            total += w;
            sum.iter_mut().zip(color[j]).for_each(|(s, c)| *s += w * f64::from(c));
        }
        let distance: f64 = (0..3)
            .map(|c| (f64::from(color[i][c]) - sum[c] / total.max(1e-9)).powi(2))
            .sum();
        // Errors of a pixel's fragments go together, so that likeness of colour does not take all weight away.
        (a * a * (distance + 0.02)) as f32
    }

    /// Answers of a network to the whole scene.
    fn answers(&self, mlp: &Mlp) -> Vec<f32> {
        let mut all = self.base.clone();
        for (&i, t) in self.evaluated.iter().zip(mlp.predict(&self.features)) {
            all[i] *= t;
        }
        all
    }

    /// Error on the whole scene, and on what was held out.
    fn errors(&self, mlp: &Mlp) -> Result<[f64; 2], ProfileError> {
        let (scene, answers) = (self.scene, self.answers(mlp));
        let list = scene.list;
        let (mut sums, mut counts) = ([0.0; 2], [0.0; 2]);
        let mut add = |p: usize, sum: f64, count: f64| {
            for (k, counts_here) in [true, self.held_out[p]].into_iter().enumerate() {
                if counts_here {
                    sums[k] += sum;
                    counts[k] += count;
                }
            }
        };
        if let Ok(truth) = scene.truth.image() {
            let squares = |p: usize| -> f64 {
                scene
                    .color_of(p, &answers)
                    .iter()
                    .zip(truth.pixels()[p])
                    .map(|(a, b)| (a - b).powi(2))
                    .sum()
            };
            let squares: Vec<f64> = (0..list.pixels())
                .into_par_iter()
                .with_min_len(256)
                .map(squares)
                .collect();
            squares.into_iter().enumerate().for_each(|(p, s)| add(p, s, 3.0));
        } else {
            for p in 0..list.pixels() {
                let of = list.range(p);
                add(
                    p,
                    of.clone()
                        .map(|i| (f64::from(answers[i]) - scene.transmittance[i]).powi(2))
                        .sum(),
                    of.len() as f64,
                );
            }
        }
        Ok([0, 1].map(|k| sums[k] / f64::max(counts[k], 1.0)))
    }
}

fn flat(mlp: &Mlp) -> Vec<f32> {
    mlp.layers()
        .iter()
        .flat_map(|l| l.weights.iter().chain(&l.biases))
        .copied()
        .collect()
}

fn shapes(mlp: &Mlp) -> Vec<(usize, usize)> {
    mlp.layers().iter().map(|l| (l.inputs(), l.outputs())).collect()
}

fn with_parameters(mlp: &Mlp, parameters: &[f32]) -> Result<Mlp, ProfileError> {
    let mut rest = parameters;
    let mut layers = Vec::new();
    for (i, o) in shapes(mlp) {
        let (weights, after) = rest.split_at(i * o);
        let (biases, after) = after.split_at(o);
        rest = after;
        layers.push(Dense::new(i, o, weights.to_vec(), biases.to_vec())?);
    }
    Ok(Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone())?)
}

/// Retrains a network from its own weights.
fn fit(mlp: &Mlp, rows: &Rows, plan: &Plan, round: u64, stop: &dyn Fn() -> bool) -> Result<Mlp, ProfileError> {
    const BATCH: usize = 4096;
    const RATE: f64 = 6e-3;
    const WARM_UP: f64 = 100.0;
    let config = TrainConfig {
        hidden: mlp.sizes()[1..mlp.sizes().len() - 1].to_vec(),
        epochs: 1,
        batch: BATCH,
        learning_rate: RATE,
        schedule: Default::default(),
        warmup_steps: 0,
        seeds: 1,
        beta1: 0.9,
        beta2: 0.999,
        epsilon: 1e-7,
        checkpoint_every: 1,
    };
    let mut fitted = Backend::Fused
        .optimiser(mlp.feature_set(), &shapes(mlp), &flat(mlp), &config)
        .expect("our own backend is always there");
    let mut order: Vec<u32> = (0..rows.len() as u32).collect();
    order.shuffle(&mut stream(plan.seed, PURPOSE, 1 << 60));
    let blocks = Blocks::of(rows, &order);
    let mut order: Vec<u32> = (0..blocks.len() as u32).collect();
    let epochs = (plan.visits / rows.len() as u64).clamp(1, plan.epochs);
    let steps = epochs * order.chunks(BATCH / 16).len() as u64;
    let mut step = 0;
    for epoch in 0..epochs {
        order.shuffle(&mut stream(plan.seed, PURPOSE, (1 << 61) | round << 32 | epoch));
        for batch in order.chunks(BATCH / 16) {
            if stop() {
                return Err(ProfileError::Interrupted);
            }
            let along = step as f64 / steps as f64;
            let rate = RATE * (step as f64 / WARM_UP).min(1.0) * 0.5 * (1.0 + libm::cos(std::f64::consts::PI * along));
            step += 1;
            fitted.step(
                Batch {
                    blocks: &blocks,
                    order: batch,
                },
                rate,
            );
        }
    }
    let parameters = fitted.parameters();
    if parameters.iter().any(|p| !p.is_finite()) {
        return Err(ProfileError::Diverged);
    }
    with_parameters(mlp, &parameters)
}

/// A network with fewer units in its hidden layers: those stay that do most, the mean of what the others did goes into
/// biases.
///
/// What a unit does is measured by the spread of its value over rows, times the length of its outgoing weights.
fn shrink(mlp: &Mlp, rows: &[f32], hidden: &[usize]) -> Result<Mlp, ProfileError> {
    let width = mlp.feature_set().width();
    let sizes = mlp.sizes();
    let stride = (rows.len() / width / 20_000).max(1);
    let mut sums: Vec<Vec<[f64; 2]>> = sizes[1..sizes.len() - 1].iter().map(|&n| vec![[0.0; 2]; n]).collect();
    let mut count = 0.0;
    for row in rows.chunks_exact(width).step_by(stride) {
        count += 1.0;
        walk(mlp, row, |layer, values| {
            for (sum, &v) in sums[layer].iter_mut().zip(values) {
                sum[0] += f64::from(v);
                sum[1] += f64::from(v) * f64::from(v);
            }
        });
    }
    let layers = mlp.layers();
    let mut kept: Vec<Vec<usize>> = vec![(0..width).collect()];
    let mut means = Vec::new();
    for (l, sums) in sums.iter().enumerate() {
        let mean: Vec<f64> = sums.iter().map(|s| s[0] / count).collect();
        let out = |u: usize| {
            (0..layers[l + 1].outputs())
                .map(|o| f64::from(layers[l + 1].weight(u, o)).powi(2))
                .sum::<f64>()
        };
        let use_of = |u: usize| (sums[u][1] / count - mean[u] * mean[u]).max(0.0) * out(u);
        let mut units: Vec<usize> = (0..sums.len()).collect();
        units.sort_by(|&a, &b| use_of(b).total_cmp(&use_of(a)).then(a.cmp(&b)));
        units.truncate(hidden[l]);
        units.sort_unstable();
        kept.push(units);
        means.push(mean);
    }
    kept.push(vec![0]);
    let mut made = Vec::new();
    for (l, dense) in layers.iter().enumerate() {
        let weights = kept[l]
            .iter()
            .flat_map(|&i| kept[l + 1].iter().map(move |&o| dense.weight(i, o)))
            .collect();
        let lost = |o: usize| match l {
            0 => 0.0,
            _ => (0..dense.inputs())
                .filter(|i| !kept[l].contains(i))
                .map(|i| means[l - 1][i] * f64::from(dense.weight(i, o)))
                .sum(),
        };
        let biases = kept[l + 1]
            .iter()
            .map(|&o| (f64::from(dense.biases[o]) + lost(o)) as f32)
            .collect();
        made.push(Dense::new(kept[l].len(), kept[l + 1].len(), weights, biases)?);
    }
    Ok(Mlp::new(mlp.name(), mlp.feature_set(), made, mlp.provenance.clone())?)
}

fn multiply_adds(width: usize, hidden: &[usize]) -> usize {
    let sizes: Vec<usize> = std::iter::once(width)
        .chain(hidden.iter().copied())
        .chain([1])
        .collect();
    sizes.windows(2).map(|s| s[0] * s[1]).sum()
}

/// Hidden sizes in the proportions of `hidden` with at most so many multiply-adds; none where no unit can go.
fn smaller(width: usize, hidden: &[usize], most: usize) -> Option<Vec<usize>> {
    (1..=400)
        .rev()
        .map(|s| hidden.iter().map(|&h| (h * s / 400).max(1)).collect::<Vec<_>>())
        .find(|h| multiply_adds(width, h) <= most)
}

impl Attempt {
    fn of(mlp: &Mlp, [error, error_held_out]: [f64; 2], kept: bool, seconds: f64) -> Self {
        Self {
            network: mlp.shape(),
            multiply_adds: mlp.multiply_adds() as u64,
            error,
            error_held_out,
            kept,
            on_front: false,
            seconds,
        }
    }
}

/// Marks the sizes that no other is both as small and as good as.
fn mark_front(attempts: &mut [Attempt]) {
    let beats = |a: &Attempt, b: &Attempt| {
        a.multiply_adds <= b.multiply_adds
            && a.error <= b.error
            && (a.multiply_adds < b.multiply_adds || a.error < b.error)
    };
    for i in 0..attempts.len() {
        attempts[i].on_front = !attempts.iter().any(|other| beats(other, &attempts[i]));
    }
}

/// The attempt to take; the first, at the network's own size, where none keeps the error.
fn choose(attempts: &[&Attempt], size: SizeChoice) -> usize {
    let kept = (0..attempts.len()).filter(|&i| attempts[i].kept);
    let found = match size {
        SizeChoice::Keep => None,
        SizeChoice::Smallest => kept.min_by_key(|&i| attempts[i].multiply_adds),
        SizeChoice::Best => kept.min_by(|&a, &b| attempts[a].error.total_cmp(&attempts[b].error)),
    };
    found.unwrap_or(0)
}

/// Retrains the network at its own size, then smaller and smaller ones for as long as the error is kept, and then
/// between what is enough and what is too few.
fn search(
    task: &Task<'_>,
    mlp: &Mlp,
    rows: &Rows,
    plan: &Plan,
    keeps: &dyn Fn([f64; 2]) -> bool,
    stop: &dyn Fn() -> bool,
    progress: &dyn Fn(usize, &str),
) -> Result<Vec<(Attempt, Mlp)>, ProfileError> {
    let most = if plan.size == SizeChoice::Keep {
        1
    } else {
        plan.attempts
    };
    let mut tried: Vec<(Attempt, Mlp)> = Vec::new();
    // The network that shrinking goes on from, and the multiply-adds that are known to be too few.
    let (mut from, mut too_few) = (mlp.clone(), 0);
    let mut next: Option<Vec<usize>> = None;
    while tried.len() < most {
        let begun = std::time::Instant::now();
        let start = match &next {
            None => from.clone(),
            Some(hidden) => shrink(&from, &rows.features, hidden)?,
        };
        progress(tried.len(), &start.shape());
        let fitted = fit(&start, rows, plan, tried.len() as u64, stop)?;
        let errors = task.errors(&fitted)?;
        let kept = keeps(errors);
        let attempt = Attempt::of(&fitted, errors, kept, begun.elapsed().as_secs_f64());
        tried.push((attempt, fitted.clone()));
        if kept {
            from = fitted;
        } else if tried.len() == 1 {
            // Retrained at its own size it is still not good enough: smaller ones will not be.
            break;
        } else {
            too_few = fitted.multiply_adds();
        }
        next = next_size(&from, too_few);
        if next.is_none() {
            break;
        }
    }
    Ok(tried)
}

/// Hidden sizes to try next: three quarters of what is enough for as long as the error is kept, then the middle of what
/// is too few and what is enough; none where both are near.
fn next_size(enough: &Mlp, too_few: usize) -> Option<Vec<usize>> {
    let (most, sizes) = (enough.multiply_adds(), enough.sizes());
    if too_few > 0 && (most - too_few) * 12 < most {
        return None;
    }
    let at_most = if too_few == 0 {
        most * 3 / 4
    } else {
        (most + too_few) / 2
    };
    let hidden = smaller(sizes[0], &sizes[1..sizes.len() - 1], at_most)?;
    let size = multiply_adds(sizes[0], &hidden);
    (!hidden.is_empty() && size > too_few && size < most).then_some(hidden)
}

/// Fits a network to a scene and makes it as small as the error allows; `progress` is told what is tried.
///
/// # Errors
/// [`ProfileError`] where the network is evaluated for too little, or does not answer with transmittances.
pub fn specialise(
    scene: &Scene<'_>,
    mlp: &Mlp,
    plan: &Plan,
    stop: &dyn Fn() -> bool,
    progress: &dyn Fn(usize, &str),
) -> Result<Specialised, ProfileError> {
    let start = std::time::Instant::now();
    if mlp.feature_set().target() != Target::Transmittance {
        return Err(ProfileError::NoTransmittance {
            model: mlp.name().to_owned(),
        });
    }
    if let Some(target) = plan.target_error
        && !(target > 0.0 && target.is_finite())
    {
        return Err(ProfileError::TargetError(target));
    }
    let task = Task::new(scene, mlp, plan)?;
    let (rows, held_out) = task.rows(mlp);
    if rows.len() < MIN_ROWS {
        return Err(ProfileError::TooFew {
            rows: task.evaluated.len(),
            least: MIN_ROWS,
            what: "fit a network to them",
        });
    }
    let first = task.errors(mlp)?;
    let target_error = plan.target_error.unwrap_or(first[0]);
    let target_held_out = target_error * first[1] / first[0].max(f64::MIN_POSITIVE);
    let keeps = |errors: [f64; 2]| errors[0] <= target_error && errors[1] <= target_held_out;
    let before = Attempt::of(mlp, first, keeps(first), 0.0);
    let mut tried = search(&task, mlp, &rows, plan, &keeps, stop, progress)?;
    let chosen = choose(&tried.iter().map(|t| &t.0).collect::<Vec<_>>(), plan.size);
    let mut mlp_after = tried[chosen].1.clone();
    let mut attempts: Vec<Attempt> = tried.drain(..).map(|t| t.0).collect();
    mark_front(&mut attempts);
    let errors_before = scene.errors(&Neural::new(mlp.clone()).transmittance(scene.list, scene.context, &|_| {})?)?;
    let errors_after =
        scene.errors(&Neural::new(mlp_after.clone()).transmittance(scene.list, scene.context, &|_| {})?)?;
    let chosen_attempt = &attempts[chosen];
    mlp_after.provenance.derived = Some(json!({
        "how": "specialised: retrained on the fragments of one scene and made smaller while an error was kept; for \
            that scene and those like it",
        "from": mlp.name(),
        "from_network": mlp.shape(),
        "plan": plan,
        "fragments": scene.list.len(),
        "training_rows": rows.len(),
        "held_out_rows": held_out,
        "target_error": target_error,
        "error": chosen_attempt.error,
        "error_held_out": chosen_attempt.error_held_out,
        "error_before": before.error,
        "error_before_held_out": before.error_held_out,
    }));
    // What was said of the first network's errors does not hold of this one.
    let provenance = &mut mlp_after.provenance;
    (provenance.training_loss, provenance.validation_loss) = (None, None);
    (provenance.transmittance_mse, provenance.transmittance_worst_error) = (None, None);
    (provenance.epochs, provenance.best_epoch) = (None, None);
    provenance.source = format!(
        "nmt {}, retrained on one scene from '{}'",
        env!("CARGO_PKG_VERSION"),
        mlp.name()
    );
    provenance.seed = Some(plan.seed);
    Ok(Specialised {
        mlp: mlp_after,
        target_error,
        target_held_out,
        before,
        errors_before,
        attempts,
        chosen,
        errors_after,
        rows: [rows.len(), held_out],
        seconds: start.elapsed().as_secs_f64(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::Context;
    use crate::pixel::FragmentList;
    use crate::scene::{BUILT_IN, Options, build, open};

    fn scene(name: &str, size: u32) -> FragmentList {
        assert!(BUILT_IN.contains(&name));
        build(
            &open(name).unwrap(),
            &Options {
                size: Some((size, size)),
                seed: None,
            },
        )
        .unwrap()
    }

    fn small() -> Mlp {
        super::super::default_networks().swap_remove(1)
    }

    const QUICK: Plan = Plan {
        target_error: None,
        held_out: 0.25,
        visits: 2_000_000,
        epochs: 400,
        attempts: 3,
        size: SizeChoice::Smallest,
        seed: 1,
    };

    /// By hand: the smallest and the best of those that keep the error, and the front of all.
    #[test]
    fn sizes_are_chosen() {
        let attempt = |multiply_adds, error, kept| Attempt {
            network: String::new(),
            multiply_adds,
            error,
            error_held_out: error,
            kept,
            on_front: false,
            seconds: 0.0,
        };
        let mut attempts = [
            attempt(752, 1.4e-5, true),
            attempt(560, 2.0e-5, true),
            attempt(420, 9.5e-5, true),
            attempt(430, 9.9e-5, true),
            attempt(100, 5e-4, false),
        ];
        let chosen = |size| choose(&attempts.iter().collect::<Vec<_>>(), size);
        let all = [SizeChoice::Keep, SizeChoice::Smallest, SizeChoice::Best].map(chosen);
        assert_eq!(all, [0, 2, 0]);
        mark_front(&mut attempts);
        assert_eq!(attempts.map(|a| a.on_front), [true, true, true, false, true]);
        // Control: where nothing keeps the error, the first is taken whatever is asked for.
        let none = [attempt(752, 1.0, false), attempt(560, 0.5, false)];
        assert_eq!(choose(&none.iter().collect::<Vec<_>>(), SizeChoice::Best), 0);
    }

    /// Retrained on the scene the network errs less there, on what was held out too, and a smaller one errs no more
    /// than the first did; the same bytes on one thread. Control: an error that nothing can keep is not kept.
    #[test]
    fn a_scene_needs_less_than_all_scenes() {
        let list = scene("hair", 72);
        let scene = Scene::new(&list, Context::default(), [1.0; 3]);
        let made = specialise(&scene, &small(), &QUICK, &|| false, &|_, _| {}).unwrap();
        let first = &made.attempts[0];
        assert!(
            first.kept && first.error < 0.95 * made.before.error && first.error_held_out < made.before.error_held_out,
            "{made:?}"
        );
        let chosen = &made.attempts[made.chosen];
        assert!(
            chosen.kept && chosen.multiply_adds < made.before.multiply_adds,
            "{made:?}"
        );
        assert!(chosen.error <= made.target_error && chosen.error_held_out <= made.target_held_out);
        assert_eq!(made.mlp.multiply_adds() as u64, chosen.multiply_adds);
        // The errors that were decided by are those of the method, to the rounding of features made otherwise.
        assert!((made.errors_after.image_mse.unwrap() / chosen.error - 1.0).abs() < 0.02);
        assert!((made.errors_before.image_mse.unwrap() / made.before.error - 1.0).abs() < 0.02);
        assert!(made.rows[1] * 10 > made.rows[0] && made.rows[1] < made.rows[0]);
        assert_eq!(made.mlp.provenance.derived.as_ref().unwrap()["from"], "small");
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again = one.install(|| specialise(&scene, &small(), &QUICK, &|| false, &|_, _| {}).unwrap());
        assert_eq!(again.mlp.layers(), made.mlp.layers());

        // A network behind a core answers for the tail alone; what is judged is the whole transmittance all the same.
        let core = crate::model::shipped::named("core-small").unwrap();
        let plan = Plan {
            size: SizeChoice::Keep,
            ..QUICK
        };
        let made = specialise(&scene, &core, &plan, &|| false, &|_, _| {}).unwrap();
        assert!((made.errors_before.image_mse.unwrap() / made.before.error - 1.0).abs() < 0.02);
        assert!((made.errors_after.image_mse.unwrap() / made.attempts[0].error - 1.0).abs() < 0.02);
        assert!(made.attempts[0].error < 0.95 * made.before.error, "{made:?}");

        let never = Plan {
            target_error: Some(1e-12),
            attempts: 2,
            visits: 100_000,
            ..QUICK
        };
        let made = specialise(&scene, &small(), &never, &|| false, &|_, _| {}).unwrap();
        assert!(!made.attempts[made.chosen].kept && made.mlp.sizes() == small().sizes());
    }

    #[test]
    fn what_cannot_be_fitted_is_said() {
        let list = scene("teapots", 48);
        let of = Scene::new(&list, Context::default(), [1.0; 3]);
        let error = |plan: &Plan| {
            specialise(&of, &small(), plan, &|| false, &|_, _| {})
                .unwrap_err()
                .to_string()
        };
        assert!(error(&QUICK).contains("at least 1000"));
        assert!(
            error(&Plan {
                target_error: Some(f64::NAN),
                ..QUICK
            })
            .contains("--target-error NaN")
        );
        let list = scene("hair", 48);
        let of = Scene::new(&list, Context::default(), [1.0; 3]);
        assert!(matches!(
            specialise(&of, &small(), &QUICK, &|| true, &|_, _| {}),
            Err(ProfileError::Interrupted)
        ));
    }

    /// A list without colours is judged by transmittance; runs of pixels are held out.
    #[test]
    fn a_list_without_an_image_will_do() {
        let full = scene("smoke", 40);
        let bare = FragmentList::new(
            full.offsets().to_vec(),
            full.view_z().to_vec(),
            full.alpha().to_vec(),
            None,
        )
        .unwrap();
        let of = Scene::new(&bare, Context::default(), [1.0; 3]);
        let made = specialise(
            &of,
            &small(),
            &Plan {
                attempts: 1,
                visits: 500_000,
                ..QUICK
            },
            &|| false,
            &|_, _| {},
        )
        .unwrap();
        assert!(
            made.errors_after.image_mse.is_none()
                && made.errors_after.transmittance_mse < made.errors_before.transmittance_mse
        );
    }

    #[test]
    fn sizes_keep_their_proportions() {
        assert_eq!(smaller(7, &[32, 16], 752 * 3 / 4), Some(vec![27, 13]));
        assert_eq!(
            (smaller(7, &[2, 1], 16), smaller(7, &[1, 1], 8)),
            (Some(vec![1, 1]), None)
        );
        assert_eq!(multiply_adds(7, &[32, 16]), 752);
    }

    /// Units that do nothing go first, and the mean of what went stays in the biases: the answers of a network with a
    /// unit that always says the same do not change.
    #[test]
    fn shrinking_keeps_what_matters() {
        let mut layers = small().layers().to_vec();
        let width = layers[0].inputs();
        for unit in [3, 9] {
            (0..width).for_each(|i| layers[0].weights[i * 16 + unit] = 0.0);
            layers[0].biases[unit] = 0.7;
        }
        let mlp = Mlp::new("s", small().feature_set(), layers, Default::default()).unwrap();
        let mut rng = stream(1, 96, 0);
        let rows: Vec<f32> = (0..7 * 4000).map(|_| rng.random_range(-1.0f32..1.0)).collect();
        let less = shrink(&mlp, &rows, &[14, 8]).unwrap();
        assert_eq!(less.shape(), "7-14-8-1");
        let worst = |a: &Mlp| {
            a.forward_batch::<f64>(&rows)
                .iter()
                .zip(mlp.forward_batch::<f64>(&rows))
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max)
        };
        assert!(worst(&less) < 1e-5, "{}", worst(&less));
        assert!(worst(&shrink(&mlp, &rows, &[8, 8]).unwrap()) > 1e-3);
    }
}
