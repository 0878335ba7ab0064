//! `nmt export`

use super::Verdict;
use super::ui::Ui;
use crate::check::rows;
use crate::export::shader::Precision;
use crate::export::{self, Format};
use crate::model::{Mlp, shipped, simplify};
use crate::numeric::file::Replace;
use anyhow::bail;
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::PathBuf;

#[derive(Args)]
pub struct Export {
    /// Model file.
    model: PathBuf,
    /// Folder for the exports.
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    formats: FormatArguments,
    /// Take out hidden units that never fire on so many random rows of the training distribution (--prune alone: 1000000). Fewer multiply-adds; where such a unit
    /// would fire after all, answers are off. The header says which were taken out, and 'nmt check' holds the exports to the whole network.
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
    /// Formats. A language's plain name is its faster form, weights in 4 x 4 blocks; "-plain" are unrolled scalars. Without it: all but the plain ones.
    #[arg(long, value_enum, value_delimiter = ',', num_args = 1..)]
    format: Vec<FormatName>,
    /// What weights and activations of the hidden layers are kept in. f16 is offered for wgsl, hlsl, metal and spirv.
    #[arg(long, value_enum, default_value = "f32")]
    precision: PrecisionName,
}

/// A format as it is named on the command line.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq)]
pub enum FormatName {
    Wgsl,
    WgslPlain,
    Glsl,
    GlslPlain,
    Hlsl,
    HlslPlain,
    Metal,
    Spirv,
    Json,
    Onnx,
}

/// A precision as it is named on the command line.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq)]
pub enum PrecisionName {
    F32,
    F16,
}

impl FormatName {
    fn format(self) -> Format {
        match self {
            Self::Wgsl => Format::Wgsl,
            Self::WgslPlain => Format::WgslPlain,
            Self::Glsl => Format::Glsl,
            Self::GlslPlain => Format::GlslPlain,
            Self::Hlsl => Format::Hlsl,
            Self::HlslPlain => Format::HlslPlain,
            Self::Metal => Format::Metal,
            Self::Spirv => Format::Spirv,
            Self::Json => Format::Json,
            Self::Onnx => Format::Onnx,
        }
    }
}

impl FormatArguments {
    /// The exports that are meant, each once.
    ///
    /// # Errors
    /// Where a format that is named has no such precision.
    pub fn formats(&self) -> anyhow::Result<Vec<Format>> {
        let precision = match self.precision {
            PrecisionName::F32 => Precision::F32,
            PrecisionName::F16 => Precision::F16,
        };
        let mut formats = Vec::new();
        if self.format.is_empty() {
            formats.extend(Format::DEFAULT.into_iter().filter_map(|f| f.with_precision(precision)));
        }
        for name in &self.format {
            match name.format().with_precision(precision) {
                Some(format) => formats.push(format),
                None => bail!(
                    "{} has no f16 form; --precision f16 is offered for wgsl, wgsl-plain, hlsl, hlsl-plain, metal and spirv",
                    name.format().name()
                ),
            }
        }
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
        let whole = shipped::open(&self.model)?;
        let mlp = match self.prune {
            None => whole.clone(),
            Some(0) => bail!("--prune=0: no row says that no unit fires; take 1000000"),
            Some(rows) => {
                let rows = rows::sampled(&whole, rows, PRUNE_SEED).map_err(anyhow::Error::msg)?;
                simplify::pruned(&whole, &rows)?
            }
        };
        let formats = self.formats.formats()?;
        let paths = export::write(
            &mlp,
            &self.out,
            &formats,
            if self.force { Replace::Yes } else { Replace::No },
        )?;
        if ui.json() {
            let result = |(f, path): (&Format, &PathBuf)| {
                json!({
                    "format": f.name(), "network": mlp.shape(), "file": path, "multiply_adds": mlp.multiply_adds(),
                    "multiply_adds_before": whole.multiply_adds(), "pruned_units": mlp.provenance.pruned.as_ref().map(|p| p.count()),
                })
            };
            let results = formats.iter().zip(&paths).map(result).collect();
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
