//! `nmt profile`

use super::scene::{SceneOptions, ViewOptions, load, refuse_outside};
use super::ui::{Ui, table};
use super::{Verdict, interrupt, keep_inputs};
use crate::features::MomentDepthKind;
use crate::model::mlp::name_for;
use crate::model::{Mlp, file, shipped};
use crate::numeric::file::{Replace, create_folder, may_write, write_atomically};
use crate::oit::neural::Skip;
use crate::profile::facts::Histogram;
use crate::profile::simplify::{Report, Simplified, simplify};
use crate::profile::specialise::{Attempt, Plan, SizeChoice, Specialised, specialise};
use crate::profile::{
    Facts, Networked, Recommendation, Scene, default_networks, facts, look_into, network, recommend, skip,
};
use anyhow::{Context as _, bail};
use clap::{Args, ValueEnum};
use serde_json::json;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Profile {
    /// Scene: a fragment list (.npz), a deep image (.exr), a scene file (.toml) or the name of a built-in scene.
    #[arg(long, value_name = "F.npz|SCENE")]
    fragments: OsString,
    /// Networks to look into; those that come with the program without it.
    #[arg(long, value_name = "MODEL.json", value_delimiter = ',', num_args = 1..)]
    model: Vec<PathBuf>,
    /// Error to keep: the image's mean squared error, or that of T where the list makes no image. Without it that of
    /// half a display step, or a fifth more than the best network's if that is greater; with --specialise the network's
    /// own.
    #[arg(long, value_name = "E")]
    target_error: Option<f64>,
    /// Retrain this network on the scene, and make it as small as the error allows.
    #[arg(long, value_name = "MODEL.json", requires = "out", conflicts_with_all = ["model", "simplify"])]
    specialise: Option<PathBuf>,
    /// Take out of this network what does nothing on the scene.
    #[arg(long, value_name = "MODEL.json", requires = "out", conflicts_with = "model")]
    simplify: Option<PathBuf>,
    /// With --specialise: retrain at the network's own size (keep), take the smallest size that keeps the error
    /// (smallest), or the size with the least error (best).
    #[arg(long, value_enum, default_value = "smallest", requires = "specialise")]
    network_size: SizeName,
    /// Folder for profile.json, profile.svg and a configuration; with --specialise or --simplify the model file to
    /// write.
    #[arg(long, value_name = "DIR|MODEL.json")]
    out: Option<PathBuf>,
    #[command(flatten)]
    options: SceneOptions,
    #[command(flatten)]
    view: ViewOptions,
    /// Repetitions of each timing; what is compared takes turns in each.
    #[arg(long, value_name = "N", default_value_t = 11)]
    repeat: usize,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

/// Which size a specialised network gets.
#[derive(Clone, Copy, ValueEnum)]
enum SizeName {
    Keep,
    Smallest,
    Best,
}

impl From<SizeName> for SizeChoice {
    fn from(name: SizeName) -> Self {
        match name {
            SizeName::Keep => Self::Keep,
            SizeName::Smallest => Self::Smallest,
            SizeName::Best => Self::Best,
        }
    }
}

impl Profile {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        let background = self.view.background()?;
        if let Some(target) = self.target_error.filter(|t| !(*t > 0.0 && t.is_finite())) {
            bail!("--target-error {target}: must be a number greater than 0");
        }
        if !(1..=10_000).contains(&self.repeat) {
            bail!("--repeat {}: must be from 1 to 10000", self.repeat);
        }
        if let (Some(model), Some(out)) = (self.specialise.as_ref().or(self.simplify.as_ref()), &self.out) {
            keep_inputs(&[model, Path::new(&self.fragments)], out)?;
            may_write(out, replace)?;
        } else if let Some(folder) = &self.out {
            for name in FILES {
                may_write(&folder.join(name), replace)?;
            }
        }
        let context = self.view.context()?;
        let list = load(ui, &self.fragments, &self.options)?;
        refuse_outside(&list, context.planes)?;
        let scene = Scene::new(&list, context, background);
        match (&self.specialise, &self.simplify) {
            (Some(model), _) => self.specialise(ui, &scene, model, replace),
            (None, Some(model)) => self.simplify(ui, &scene, model, replace),
            (None, None) => self.profile(ui, &scene, replace),
        }
    }

    fn profile(&self, ui: &Ui, scene: &Scene<'_>, replace: Replace) -> anyhow::Result<Verdict> {
        let planes = scene.context.planes_for(scene.list);
        let mut remarks = Vec::new();
        let models: Vec<Mlp> = if self.model.is_empty() {
            let (able, unable) = default_networks()
                .into_iter()
                .partition(|m| m.feature_set().moment_depth() != MomentDepthKind::Window || planes.is_some());
            let unable: Vec<Mlp> = unable;
            remarks.extend(unable.iter().map(|m| {
                format!(
                    "{} is left out: it needs the camera's planes, --near and --far",
                    m.name()
                )
            }));
            able
        } else {
            self.model
                .iter()
                .map(|path| shipped::open(path))
                .collect::<Result<_, _>>()?
        };
        let progress = ui.progress("profile", models.len() as u64 + 1 + self.repeat as u64);
        progress.set(0, "the scene");
        let facts = facts(scene)?;
        let mut networks = Vec::new();
        for (index, mlp) in models.iter().enumerate() {
            progress.set(index as u64 + 1, mlp.name());
            networks.push(look_into(scene, mlp)?);
        }
        let recommendation = recommend(&facts, &networks, self.target_error);
        let timed = &models[recommendation.index.unwrap_or(0)];
        let before = models.len() as u64 + 1;
        let skips = skip::measure(scene, timed, self.repeat, &|n| {
            progress.set(before + n, format!("skipping, {}", timed.name()))
        })?;
        progress.finish();
        let name = Path::new(&self.fragments)
            .file_stem()
            .unwrap_or(&self.fragments)
            .to_string_lossy();
        let result = json!({
            "scene": self.fragments.to_string_lossy(), "facts": facts, "networks": networks, "skipping": skips,
                "skipping_of": timed.name(), "recommendation": recommendation,
            "remarks": remarks,
        });
        if let Some(folder) = &self.out {
            create_folder(folder)?;
            let json = serde_json::to_string_pretty(&ui.report("profile", vec![result.clone()]))? + "\n";
            let drawing = facts.drawing(&format!("{name}: {} fragments", facts.fragments));
            for (file, text) in FILES.iter().zip([&json, &drawing, &recommendation.config]) {
                write_atomically(&folder.join(file), replace, |w| w.write_all(text.as_bytes()))?;
            }
        }
        if ui.json() {
            ui.print_json("profile", vec![result])?;
            return Ok(Verdict::Fine);
        }
        let mut text = summary(&name, &facts);
        text += &networks_table(&networks, scene.truth.image().is_ok());
        text += &skips_table(timed, &skips);
        text += &words(&recommendation);
        for remark in remarks {
            text += &format!("{remark}\n");
        }
        if let Some(folder) = &self.out {
            text += &format!("{}\n", folder.display());
        }
        ui.print(&text)?;
        Ok(Verdict::Fine)
    }

    fn specialise(&self, ui: &Ui, scene: &Scene<'_>, model: &Path, replace: Replace) -> anyhow::Result<Verdict> {
        let mlp = shipped::open(model)?;
        let plan = Plan {
            target_error: self.target_error,
            size: self.network_size.into(),
            ..Plan::default()
        };
        let progress = ui.progress("specialise", plan.attempts as u64);
        let made = interrupt::gracefully(|| {
            specialise(scene, &mlp, &plan, &interrupt::requested, &|n, network| {
                progress.set(n as u64, format!("sizes tried, now {network}"))
            })
        });
        progress.finish();
        let made = match made {
            Err(crate::profile::ProfileError::Interrupted) => {
                eprintln!("interrupted; nothing was written");
                return Ok(Verdict::Interrupted);
            }
            other => other.with_context(|| model.display().to_string())?,
        };
        let out = self.out.as_ref().expect("clap demands it");
        file::save(out, replace, &made.mlp.clone().renamed(name_for(out))?)?;
        let chosen = &made.attempts[made.chosen];
        if !chosen.kept {
            ui.warn(
                "warning: no size keeps the error on the whole scene and on what was held out; the network written \
                is the first one, retrained at its own size",
            );
        }
        if ui.json() {
            ui.print_json(
                "profile",
                vec![json!({
                    "scene": self.fragments.to_string_lossy(), "specialised": out, "from": model,
                        "target_error": made.target_error, "target_error_held_out": made.target_held_out,
                    "network_size": plan.size, "kept": chosen.kept, "before": made.before, "after": chosen,
                        "errors_before": made.errors_before, "errors_after": made.errors_after,
                    "attempts": made.attempts, "training_rows": made.rows[0], "held_out_rows": made.rows[1],
                        "seconds": made.seconds,
                })],
            )?;
        } else {
            ui.print(&specialised(&made, scene.truth.image().is_ok(), out))?;
        }
        Ok(Verdict::Fine)
    }

    fn simplify(&self, ui: &Ui, scene: &Scene<'_>, model: &Path, replace: Replace) -> anyhow::Result<Verdict> {
        let mlp = shipped::open(model)?;
        let rows = network::rows_of(scene, mlp.feature_set())?;
        let Simplified { mlp: left, report } = simplify(&mlp, &rows).with_context(|| model.display().to_string())?;
        if !report.identical_bits {
            bail!(
                "{}: without its silent units the network gives other bits, which is a fault of this program; nothing \
                    was written",
                model.display()
            );
        }
        let out = self.out.as_ref().expect("clap demands it");
        file::save(out, replace, &left.clone().renamed(name_for(out))?)?;
        if ui.json() {
            ui.print_json(
                "profile",
                vec![
                    json!({ "scene": self.fragments.to_string_lossy(), "simplified": out, "from": model,
                        "network": left.shape(), "report": report }),
                ],
            )?;
        } else {
            ui.print(&simplified(&mlp, &left, &report, out))?;
        }
        Ok(Verdict::Fine)
    }
}

/// What a profile writes into its folder.
const FILES: [&str; 3] = ["profile.json", "profile.svg", "profile.toml"];

fn cells<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}

fn percent(x: f64) -> String {
    format!("{:.1} %", 100.0 * x)
}

fn bar(share: f64) -> String {
    let eighths = (share * 8.0 * 40.0).round() as usize;
    let rest = [
        '\u{258f}', '\u{258e}', '\u{258d}', '\u{258c}', '\u{258b}', '\u{258a}', '\u{2589}',
    ];
    let mut text = "\u{2588}".repeat(eighths / 8);
    if !eighths.is_multiple_of(8) {
        text.push(rest[eighths % 8 - 1]);
    }
    text
}

/// An edge of a bin.
fn edge(x: f64) -> String {
    if x == x.round() && x < 1e5 {
        format!("{x:.0}")
    } else if x >= 0.01 {
        format!("{x:.2}")
    } else {
        format!("{x:.0e}")
    }
}

fn histogram(h: &Histogram) -> String {
    let all = h.counts.iter().sum::<u64>().max(1) as f64;
    let most = h.counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    let first = h.counts.iter().position(|&n| n > 0).unwrap_or(0);
    let end = h.counts.iter().rposition(|&n| n > 0).map_or(0, |i| i + 1);
    let mut rows = vec![vec![h.quantity.to_owned(), format!("of {}", h.of), String::new()]];
    for i in first..end {
        let n = h.counts[i] as f64;
        // Whole numbers stand for themselves.
        let whole = h.quantity == "fragments";
        let label = match (h.edges[i], h.edges[i + 1]) {
            (a, b) if whole && b - a == 1.0 => edge(a),
            (a, b) if whole && b >= 1e6 => format!("{} and more", edge(a)),
            (a, b) if whole => format!("{} to {}", edge(a), edge(b - 1.0)),
            (a, b) => format!("{} to {}", edge(a), edge(b)),
        };
        rows.push(vec![label, percent(n / all), bar(n / most)]);
    }
    let quantiles = h.quantiles.map_or(String::new(), |q| {
        format!(
            "least {}, median {}, 95 % up to {}, greatest {}\n",
            edge(q.min),
            edge(q.median),
            edge(q.p95),
            edge(q.max)
        )
    });
    format!("{}{quantiles}\n", table(&rows))
}

fn summary(name: &str, facts: &Facts) -> String {
    let mut text = format!(
        "{name}: {} fragments in {} pixels, {} of them empty, at most {} in one\n\n",
        facts.fragments,
        facts.pixels,
        percent(facts.empty_pixels),
        facts.depth_complexity
    );
    text.extend(facts.histograms.iter().map(histogram));
    let mut rows = vec![cells(["fragments", "share", "answer", ""])];
    rows.extend(
        facts
            .classes
            .iter()
            .map(|c| vec![c.class.to_owned(), percent(c.share), c.answer.to_owned(), bar(c.share)]),
    );
    text += &table(&rows);
    text += &format!(
        "behind opaque: {}; below 1/1024 of transmittance: {}\n",
        percent(facts.behind_opaque),
        percent(facts.unseen)
    );
    if let Some(t) = &facts.tiles {
        text += &format!(
            "tiles of 8 x 8 without work for the network: {} under none, {} under exact, {} under visible\n",
            percent(t.saved(Skip::None)),
            percent(t.saved(Skip::Exact)),
            percent(t.saved(Skip::Visible))
        );
    }
    text + "\n"
}

fn number(x: Option<f64>) -> String {
    x.map_or("-".to_owned(), |x| format!("{x:.3e}"))
}

fn networks_table(networks: &[Networked], image: bool) -> String {
    let kind = if image { "image MSE" } else { "T-MSE" };
    let f16 = format!("{kind}, f16");
    let unorm = format!("{kind}, unorm16");
    let mut rows = vec![cells([
        "network",
        "sizes",
        kind,
        &f16,
        &unorm,
        "bits/pixel",
        "multiply-adds",
        "a fragment",
        "silent units",
        "always on",
        "constant features",
    ])];
    for n in networks {
        let units = |of: &dyn Fn(&network::Layer) -> usize| {
            n.layers
                .iter()
                .map(|l| format!("{}/{}", of(l), l.units))
                .collect::<Vec<_>>()
                .join(" ")
        };
        let constant: Vec<&str> = n.columns.iter().filter(|c| c.is_constant()).map(|c| c.name).collect();
        let stored = |i: usize| number(n.stored.get(i).map(|s| s.error));
        rows.push(vec![
            n.model.clone(),
            n.network.clone(),
            number(n.error()),
            stored(0),
            stored(1),
            n.bits_per_pixel.to_string(),
            n.multiply_adds.to_string(),
            format!("{:.0}", n.multiply_adds_per_fragment()),
            units(&|l| l.never.len()),
            units(&|l| l.always.len()),
            if constant.is_empty() {
                "-".to_owned()
            } else {
                constant.join(" ")
            },
        ]);
    }
    table(&rows) + "\n"
}

fn skips_table(timed: &Mlp, skips: &[skip::Skipped]) -> String {
    let mut rows = vec![cells([
        "skip",
        "avoided",
        "pass 2 ms",
        "against none",
        "greatest change",
        "added error",
        "FLIP",
        "image MSE",
    ])];
    for s in skips {
        let of = |f: &dyn Fn(&skip::ImageChange) -> f64| {
            s.image.as_ref().map_or("-".to_owned(), |i| format!("{:.2e}", f(i)))
        };
        rows.push(vec![
            s.skip.to_owned(),
            percent(s.avoided),
            format!("{:.2}", 1e3 * s.seconds),
            format!("{:.2} x", s.speedup),
            of(&|i| i.greatest_change),
            of(&|i| i.greatest_added_error),
            of(&|i| i.flip_change),
            of(&|i| i.image_mse),
        ]);
    }
    let repeat = skips.first().map_or(0, |s| s.raw_seconds_pass_2.len());
    format!(
        "{}{} on {} threads, medians of {repeat} repetitions by turns; changes are of a channel, against exact (bound \
            1/512 = {:.2e})\n\n",
        table(&rows),
        timed.name(),
        rayon::current_num_threads(),
        1.0 / 512.0
    )
}

fn words(r: &Recommendation) -> String {
    r.words.iter().map(|w| format!("{w}\n")).collect()
}

fn specialised(made: &Specialised, image: bool, out: &Path) -> String {
    let kind = if image { "image MSE" } else { "T-MSE" };
    let head = [
        "",
        "network",
        "multiply-adds",
        kind,
        "held out",
        "keeps the error",
        "seconds",
    ];
    let mut rows = vec![cells(head)];
    let row = |mark: &str, a: &Attempt, kept: &str| {
        vec![
            mark.to_owned(),
            a.network.clone(),
            a.multiply_adds.to_string(),
            format!("{:.3e}", a.error),
            format!("{:.3e}", a.error_held_out),
            kept.to_owned(),
            format!("{:.1}", a.seconds),
        ]
    };
    rows.push(row("", &made.before, "(before)"));
    for (i, a) in made.attempts.iter().enumerate() {
        let mark = match (i == made.chosen, a.on_front) {
            (true, true) => "> *",
            (true, false) => ">",
            (false, true) => "  *",
            (false, false) => "",
        };
        rows.push(row(mark, a, if a.kept { "yes" } else { "no" }));
    }
    let (chosen, before) = (&made.attempts[made.chosen], &made.before);
    format!(
        "{}>: written; *: no other size is both as small and as good (Pareto front)\n\
         to keep: {:.3e}, and {:.3e} on what was held out ({} rows trained on, {} held out in tiles of 8 x 8)\n\
         {} -> {}: {:.2} times the multiply-adds, {:.2} times the error; T-MSE {:.2e} -> {:.2e}; {:.1} s\n\
         The result is for this scene and those like it; elsewhere use the network that it came from.\n{}\n",
        table(&rows),
        made.target_error,
        made.target_held_out,
        made.rows[0],
        made.rows[1],
        before.network,
        chosen.network,
        chosen.multiply_adds as f64 / before.multiply_adds as f64,
        chosen.error / before.error,
        made.errors_before.transmittance_mse,
        made.errors_after.transmittance_mse,
        made.seconds,
        out.display()
    )
}

fn simplified(mlp: &Mlp, left: &Mlp, report: &Report, out: &Path) -> String {
    let mut text = format!(
        "{} -> {}: {} multiply-adds of {}, {} of them with a weight that is not 0\n",
        mlp.shape(),
        left.shape(),
        report.multiply_adds,
        report.multiply_adds_before,
        report.multiply_adds_not_zero
    );
    for layer in 0..mlp.layers().len() - 1 {
        let units: Vec<String> = report
            .removed
            .iter()
            .filter(|r| r.layer == layer)
            .map(|r| r.unit.to_string())
            .collect();
        if !units.is_empty() {
            text += &format!(
                "hidden layer {}: {} units taken out ({})\n",
                layer + 1,
                units.len(),
                units.join(", ")
            );
        }
    }
    for m in &report.merged {
        text += &format!(
            "hidden layer {}: {} units that always fire became {}\n",
            m.layer + 1,
            m.units.len(),
            m.into
        );
    }
    for c in &report.constants {
        text += &format!("{} is always {}: folded into the biases\n", c.name, c.value);
    }
    text + &format!(
        "without silent units: identical bits on {} rows; f32 error of all of it {:.2e} (worst {:.2e}), before {:.2e} \
            (worst {:.2e})\n{}\n{}\n",
        report.rows,
        report.rounding.rms,
        report.rounding.worst,
        report.rounding_before.rms,
        report.rounding_before.worst,
        report.region,
        out.display()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::config::Config;

    #[test]
    fn bars_are_as_long_as_they_say() {
        assert_eq!(
            (bar(0.0), bar(1.0).chars().count(), bar(0.5).chars().count()),
            (String::new(), 40, 20)
        );
        assert_eq!(bar(1.0 / 320.0), "\u{258f}");
    }

    /// What is recommended as a configuration is one.
    #[test]
    fn the_configuration_is_read() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["teapots", "smoke"] {
            let options = crate::scene::Options {
                size: Some((48, 48)),
                seed: None,
            };
            let list = crate::scene::build(&crate::scene::open(name).unwrap(), &options).unwrap();
            let scene = Scene::new(&list, crate::oit::Context::default(), [1.0; 3]);
            let facts = facts(&scene).unwrap();
            let networks: Vec<_> = default_networks()
                .iter()
                .take(2)
                .map(|m| look_into(&scene, m).unwrap())
                .collect();
            let recommendation = recommend(&facts, &networks, None);
            assert!(recommendation.kept && recommendation.model.is_some());
            let path = folder.path().join("profile.toml");
            std::fs::write(&path, &recommendation.config).unwrap();
            let config = Config::load(&path).unwrap();
            assert_eq!(config.synth.pixels.len(), 3);
            let text = summary(name, &facts) + &networks_table(&networks, true) + &words(&recommendation);
            assert!(!text.contains("NaN"), "{text}");
        }
    }
}
