//! What to run on a scene: the smallest network that keeps an error, in words and as a configuration.

use super::facts::{Facts, Kind};
use super::network::Networked;
use crate::features::SumPrecision;
use serde::Serialize;

/// What to run on a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Recommendation {
    /// The network; none where nothing needs one.
    pub model: Option<String>,
    /// Its place among those that were looked into.
    #[serde(skip)]
    pub index: Option<usize>,
    /// The error that was to be kept: of the image, or of transmittance where there is none.
    pub target_error: f64,
    /// Whether some network keeps it.
    pub kept: bool,
    /// Moments besides b_0.
    pub moments: u64,
    /// How moments are to be stored.
    pub storage: SumPrecision,
    /// Memory of pass 1 and the composite \[bits\].
    pub bits_per_pixel: u32,
    /// Multiply-adds of the network a fragment, on average over the scene, under `exact` and under `visible`.
    pub multiply_adds_per_fragment: [f64; 2],
    /// All of it in sentences.
    pub words: Vec<String>,
    /// A configuration that trains a network for scenes like this one.
    pub config: String,
}

fn percent(x: f64) -> String {
    format!("{:.1} %", 100.0 * x)
}

/// Mean squared error of which nobody sees anything: that of half a display step in every channel, 1/512.
const UNSEEN_ERROR: f64 = 1.0 / (512.0 * 512.0);

/// Chooses among networks. Where no `target_error` is given it is half a display step, squared, or a fifth more than
/// the least error of any if that is greater.
pub fn recommend(facts: &Facts, networks: &[Networked], target_error: Option<f64>) -> Recommendation {
    let judged: Vec<(usize, f64)> = networks
        .iter()
        .enumerate()
        .filter_map(|(i, n)| n.error().map(|e| (i, e)))
        .filter(|(_, e)| e.is_finite())
        .collect();
    let least = judged.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
    let target = target_error.unwrap_or_else(|| UNSEEN_ERROR.max(1.2 * least.map_or(0.0, |l| l.1)));
    let cost = |i: usize| (networks[i].multiply_adds, networks[i].bits_per_pixel);
    let keeping = judged
        .iter()
        .copied()
        .filter(|&(_, e)| e <= target)
        .min_by_key(|&(i, _)| cost(i));
    let chosen = keeping.or(least);
    let evaluated = evaluated(facts);
    let mut words = scene_in_words(facts);
    let (mut storage, mut bits, mut moments) = (SumPrecision::F32, 0, 0);
    let mut per_fragment = [0.0; 2];
    match chosen {
        None => words.push("No network was judged on this scene.".to_owned()),
        Some((i, error)) => {
            let n = &networks[i];
            words.push(choice_in_words(n, error, target, keeping.is_some(), judged.len()));
            (bits, moments) = (n.bits_per_pixel, n.moments);
            if let Some((stored, text)) = storage_in_words(n, target.max(error)) {
                (storage, bits) = stored.unwrap_or((storage, bits));
                words.push(text);
            }
            per_fragment = evaluated.map(|share| share * n.multiply_adds as f64);
            words.push(format!(
                "It costs {:.0} multiply-adds a fragment on average under exact, {:.0} under visible, {} without \
                    skipping.",
                per_fragment[0], per_fragment[1], n.multiply_adds
            ));
            words.extend(idle_in_words(n));
        }
    }
    words.extend(tiles_in_words(facts));
    let hidden_sizes = chosen.map_or(vec![16, 8], |(i, _)| {
        networks[i]
            .network
            .split('-')
            .filter_map(|s| s.parse().ok())
            .collect::<Vec<usize>>()
    });
    let hidden_sizes = if hidden_sizes.len() > 2 {
        hidden_sizes[1..hidden_sizes.len() - 1].to_vec()
    } else {
        vec![16, 8]
    };
    let features = chosen.map_or("recentred", |(i, _)| networks[i].features);
    Recommendation {
        model: chosen.map(|(i, _)| networks[i].model.clone()),
        index: chosen.map(|(i, _)| i),
        target_error: target,
        kept: keeping.is_some(),
        moments,
        storage,
        bits_per_pixel: bits,
        multiply_adds_per_fragment: per_fragment,
        words,
        config: config(facts, features, &hidden_sizes, storage),
    }
}

/// Whether moments may be stored in 16 bits within an error, as which and in how many bits a pixel then, and a sentence
/// on it; none where no such storage was tried.
fn storage_in_words(n: &Networked, error: f64) -> Option<(Option<(SumPrecision, u32)>, String)> {
    let best = n.stored.iter().min_by(|a, b| a.error.total_cmp(&b.error))?;
    let name = name_of(best.storage);
    Some(if best.error <= error {
        let text = format!(
            "Moments may be stored in 16 bits ({name}): the error becomes {:.2e}, and a pixel takes {} bits instead of \
                {}.",
            best.error, best.bits_per_pixel, n.bits_per_pixel
        );
        (Some((best.storage, best.bits_per_pixel)), text)
    } else {
        let text = format!(
            "Keep moments in f32: in 16 bits the error would be {:.2e} at best ({name}).",
            best.error
        );
        (None, text)
    })
}

/// Shares of the fragments that the network answers, under `exact` and under `visible`.
fn evaluated(facts: &Facts) -> [f64; 2] {
    let network = facts.share(Kind::Network);
    [network + facts.share(Kind::Faint) + facts.share(Kind::Hidden), network]
}

/// What the scene's fragments need.
fn scene_in_words(facts: &Facts) -> Vec<String> {
    let [exact, visible] = evaluated(facts);
    let closed = facts.share(Kind::OneOfThree) + facts.share(Kind::OneOfFour);
    let mut words = vec![format!(
        "{} of the pixels are empty. Of the fragments {} need no network: {} are nearest, farthest or one of two, {} \
            follow \
         in closed form.",
        percent(facts.empty_pixels),
        percent(1.0 - exact),
        percent(1.0 - exact - closed),
        percent(closed),
    )];
    let unseen = percent(exact - visible);
    words.push(if exact - visible > 0.005 {
        format!("{unseen} more cannot be seen: use --skip visible.")
    } else {
        format!("Hardly anything ({unseen}) is provably invisible: --skip exact is enough.")
    });
    if facts.unseen > 0.05 {
        words.push(format!(
            "{} of the fragments lie where less than 1/1024 of the light passes; order-independent bounds find {} of \
                all. \
             What lies behind opaque surfaces is best never rasterised: draw those first.",
            percent(facts.unseen),
            percent(facts.share(Kind::Hidden))
        ));
    }
    words
}

/// Which network, and why.
fn choice_in_words(n: &Networked, error: f64, target: f64, keeps: bool, judged: usize) -> String {
    let kind = if n.image_mse.is_some() { "image MSE" } else { "T-MSE" };
    let found = format!(
        "{} ({}, {} multiply-adds, {} moments) has an {kind} of {error:.2e}",
        n.model, n.network, n.multiply_adds, n.moments
    );
    if keeps {
        format!("{found}: the smallest of {judged} that stays within {target:.2e}.")
    } else {
        format!("{found}: the least of {judged}, and more than the {target:.2e} that was to be kept.")
    }
}

/// What of the network does nothing on this scene.
fn idle_in_words(n: &Networked) -> Vec<String> {
    let mut words = Vec::new();
    let silent: usize = n.layers.iter().map(|l| l.never.len()).sum();
    if silent > 0 {
        words.push(format!(
            "{silent} of its units never fire on this scene: nmt profile --simplify takes them out."
        ));
    }
    let constant: Vec<&str> = n.columns.iter().filter(|c| c.is_constant()).map(|c| c.name).collect();
    if !constant.is_empty() {
        words.push(format!(
            "Its features {} are constant on this scene.",
            constant.join(", ")
        ));
    }
    words
}

/// Tiles that an indirect dispatch would leave out.
fn tiles_in_words(facts: &Facts) -> Option<String> {
    let tiles = facts.tiles.as_ref()?;
    let share = |n: u64| percent(n as f64 / tiles.tiles.max(1) as f64);
    Some(format!(
        "{} of the {} tiles of 8 x 8 pixels need no network ({} are empty, {} hold only what is known): an indirect \
            dispatch \
         would leave them out.",
        percent(tiles.saved(crate::oit::neural::Skip::Exact)),
        tiles.tiles,
        share(tiles.empty),
        share(tiles.known)
    ))
}

fn name_of(storage: SumPrecision) -> &'static str {
    match storage {
        SumPrecision::F32 => "f32",
        SumPrecision::F16 => "f16",
        SumPrecision::Unorm16 => "unorm16",
    }
}

/// A configuration whose random pixels have the ranges of this scene.
fn config(facts: &Facts, features: &str, hidden: &[usize], storage: SumPrecision) -> String {
    let quantiles = |i: usize| facts.histograms[i].quantiles;
    let fragments = quantiles(0).map_or((3, 32), |q| ((q.min as u32).max(3), (q.max as u32).max(4)));
    let alpha = quantiles(1).map_or((0.05, 0.95), |q| (q.min.max(1e-3), q.max.min(1.0)));
    let alpha = if alpha.1 > alpha.0 {
        alpha
    } else {
        (0.9 * alpha.1, alpha.1)
    };
    let half = quantiles(3).map_or((0.02, 1.0), |q| (q.p5.clamp(1e-4, 0.9), q.max.clamp(1e-3, 1.0)));
    let half = if half.1 > half.0 { half } else { (0.5 * half.1, half.1) };
    let (near, far) = facts.depth_range.filter(|r| r.0 < r.1).unwrap_or((0.1, 100.0));
    let features = if features.starts_with("recentred") {
        features
    } else {
        "recentred"
    };
    let law = |depth: &str, alpha_law: &str| {
        format!(
            "[[synth.pixels]]\nweight = 1\nfragments = {{ min = {}, max = {}, law = \"log-uniform\" }}\ndepth = \
                {depth}\n\
             alpha = {{ law = \"{alpha_law}\", min = {:e}, max = {:e} }}\nrange = {{ half = {{ min = {:e}, max = {:e} \
             }} }}\n\n",
            fragments.0, fragments.1, alpha.0, alpha.1, half.0, half.1
        )
    };
    format!(
        "# Random pixels with the ranges of the scene that was profiled: {} fragments, at most {} in a pixel.\n\
         name = \"profiled\"\nseed = 1\n\n[synth]\ncamera = {{ near = {near:e}, far = {far:e} }}\n\n{}{}{}\
         [dataset]\nfeatures = \"{features}\"\ntraining_pairs = 500000\nvalidation_pairs = 50000\nrefresh = 0.05\n\
         rows_per_pixel = 8\n{}\n\
         [train]\nhidden = {hidden:?}\nepochs = 200\nbatch = 8192\nlearning_rate = 2e-2\nwarmup_steps = 200\n\
         schedule = \"cosine\"\n\n\
         [evaluate]\npairs = 200000\n",
        facts.fragments,
        facts.depth_complexity,
        law("{ law = \"paired\", gap = { min = 1e-3, max = 1.0 } }", "uniform"),
        law("{ law = \"uniform\" }", "subrange"),
        law("{ law = \"uniform\" }", "log-uniform"),
        if storage == SumPrecision::F32 {
            String::new()
        } else {
            format!("storage = \"{}\"\n", name_of(storage))
        },
    )
}
