//! `nmt export`

use super::Verdict;
use super::ui::Ui;
use crate::check::rows;
use crate::export::{self, Format, Precision, Prefix, Target};
use crate::model::{Mlp, shipped, simplify};
use crate::numeric::file::Replace;
use anyhow::bail;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::PathBuf;

#[derive(Args)]
pub struct Export {
    /// Model file, or the name of a shipped network: recommended, small, moments-6, paper, deep-weighted-blended; or
    /// core:K, the method without a network, in WGSL, GLSL and HLSL. Of a network with a core, NAME.chain.wgsl, .glsl
    /// and .hlsl hold both passes, the network among them.
    model: PathBuf,
    /// Folder for the exports.
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    formats: FormatArguments,
    /// What shader names begin with instead of nmt, so that several networks fit one module: functions glass_...,
    /// constants GLASS_..., types Glass...
    #[arg(long, value_name = "NAME")]
    prefix: Option<Prefix>,
    #[arg(long, conflicts_with_all = ["format", "precision"], help = about_passes())]
    passes: bool,
    /// Take out hidden units that never fire on so many random rows of the training distribution (--prune alone:
    /// 1000000). Fewer multiply-adds; where such a unit would fire after all, answers are off. The header says which
    /// were taken out, and 'nmt check' holds the exports to the whole network.
    #[arg(long, value_name = "ROWS", num_args = 0..=1, require_equals = true, default_missing_value = "1000000")]
    prune: Option<usize>,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

/// Keeps the pixels that say which units are silent apart from those that exports are checked on.
const PRUNE_SEED: u64 = 0x0070_7275_6e65;

/// Options that say which exports are meant.
#[derive(Args)]
pub struct FormatArguments {
    /// Formats. A language's plain name is its faster form, weights in 4 x 4 blocks; "-plain" are unrolled scalars,
    /// "-f16" has hidden layers in f16. Without it: all but the plain ones.
    #[arg(long, value_parser = format(), value_delimiter = ',', num_args = 1..)]
    format: Vec<Format>,
    #[arg(long, value_enum, default_value = "f32", help = about_precision())]
    precision: PrecisionName,
}

/// A precision as it is named on the command line.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq)]
pub enum PrecisionName {
    F32,
    F16,
}

/// Reads a format's name, and lists all of them in the help.
fn format() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::all().map(Format::name)).try_map(|name| name.parse::<Format>())
}

/// Words as a sentence lists them: "a, b and c".
fn listed(words: impl Iterator<Item = &'static str>) -> String {
    let words: Vec<&str> = words.collect();
    match words.as_slice() {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        few => few.concat(),
    }
}

/// What the command does.
pub fn about() -> String {
    let titles = listed(Target::ALL.into_iter().map(Target::title));
    format!("Export a network as {titles}")
}

/// What `--passes` does.
fn about_passes() -> String {
    let titles = listed(Target::all_of_text().map(Target::title));
    format!(
        "Write a shader folder instead: include files in {titles}, and the three passes as whole files for WebGPU, \
         OpenGL, OpenGL ES, Vulkan, Direct3D and Metal"
    )
}

/// What `--precision` does.
fn about_precision() -> String {
    let packed = Target::ALL.into_iter().map(Format::of);
    let half = packed.filter(|format| format.with_precision(Precision::F16).is_ok());
    format!(
        "What weights and activations of the hidden layers are kept in, where a format does not say it. f16 is \
         offered for {}",
        listed(half.map(Format::name))
    )
}

impl FormatArguments {
    /// The exports that are meant, each once.
    ///
    /// # Errors
    /// Where a format that is named has no such precision.
    pub fn formats(&self) -> anyhow::Result<Vec<Format>> {
        let precise = |format: Format| match self.precision {
            PrecisionName::F32 => Ok(format),
            PrecisionName::F16 => format.with_precision(Precision::F16),
        };
        let mut formats: Vec<Format> = if self.format.is_empty() {
            Format::DEFAULT.into_iter().filter_map(|f| precise(f).ok()).collect()
        } else {
            self.format.iter().map(|&f| precise(f)).collect::<Result<_, _>>()?
        };
        formats.sort();
        formats.dedup();
        Ok(formats)
    }
}

/// Number of hidden units.
fn hidden(mlp: &Mlp) -> usize {
    let sizes = mlp.sizes();
    sizes[1..sizes.len() - 1].iter().sum()
}

impl Export {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        if let Some(set) = self.model.to_str().and_then(export::core::named) {
            if self.passes || self.prefix.is_some() || self.prune.is_some() {
                bail!("core:K is written as one file a language; --passes, --prefix and --prune are for networks");
            }
            let replace = if self.force { Replace::Yes } else { Replace::No };
            let paths = export::core::write(set, &self.out, replace)?;
            if ui.json() {
                ui.print_json("export", paths.iter().map(|path| json!({ "file": path })).collect())?;
            } else {
                let lines: String = paths.iter().map(|path| format!("{}\n", path.display())).collect();
                ui.print(&lines)?;
            }
            return Ok(Verdict::Fine);
        }
        let whole = shipped::open(&self.model)?;
        let formats = self.formats.formats()?;
        let replace = if self.force { Replace::Yes } else { Replace::No };
        // A shader folder has the include file of WGSL, too.
        let early = if self.passes { &[Format::WGSL] } else { &formats[..] };
        export::may_write_to(&whole, &self.out, early, replace)?;
        let mlp = match self.prune {
            None => whole.clone(),
            Some(0) => bail!("--prune=0: no row says that no unit fires; take 1000000"),
            Some(rows) => {
                let rows = rows::sampled(&whole, rows, PRUNE_SEED).map_err(anyhow::Error::msg)?;
                simplify::pruned(&whole, &rows)?
            }
        };
        let prefix = self.prefix.as_ref();
        if self.passes {
            let paths = export::files::write(&mlp, &self.out, prefix, replace)?;
            if ui.json() {
                let result = |path: &PathBuf| json!({ "network": mlp.shape(), "file": path });
                ui.print_json("export", paths.iter().map(result).collect())?;
            } else {
                let lines: String = paths.iter().map(|path| format!("{}\n", path.display())).collect();
                ui.print(&lines)?;
            }
            return Ok(Verdict::Fine);
        }
        let paths = export::write(&mlp, &self.out, &formats, prefix, replace)?;
        if ui.json() {
            let result = |(f, path): (&Format, &PathBuf)| {
                json!({
                    "format": f.name(), "network": mlp.shape(), "file": path, "multiply_adds": mlp.multiply_adds(),
                    "multiply_adds_before": whole.multiply_adds(),
                        "pruned_units": mlp.provenance.pruned.as_ref().map(|p| p.count()),
                })
            };
            let mut results: Vec<_> = formats.iter().zip(&paths).map(result).collect();
            let chains = paths[formats.len()..].iter();
            results.extend(chains.map(|path| json!({ "network": mlp.shape(), "file": path })));
            ui.print_json("export", results)?;
        } else {
            for path in paths {
                ui.print(&format!("{}\n", path.display()))?;
            }
            if let Some(pruned) = &mlp.provenance.pruned {
                let (before, after) = (whole.multiply_adds(), mlp.multiply_adds());
                ui.warn(&format!(
                    "{} of {} hidden units were taken out: {after} of {before} multiply-adds are left",
                    pruned.count(),
                    hidden(&whole)
                ));
            }
        }
        Ok(Verdict::Fine)
    }
}
