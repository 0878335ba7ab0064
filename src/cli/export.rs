//! `nmt export`

use super::Verdict;
use super::ui::Ui;
use crate::export::{self, Format};
use crate::model::file;
use crate::numeric::file::Replace;
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
    /// Formats; "wgsl" and "glsl" stand for their plain and packed forms.
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = FormatName::ALL)]
    format: Vec<FormatName>,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

/// A format as it is named on the command line.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq)]
pub enum FormatName {
    Wgsl,
    Glsl,
    Json,
    Onnx,
}

impl FormatName {
    pub const ALL: [Self; 4] = [Self::Wgsl, Self::Glsl, Self::Json, Self::Onnx];

    /// The files that a name stands for.
    fn formats(self) -> &'static [Format] {
        match self {
            Self::Wgsl => &[Format::Wgsl, Format::WgslPacked],
            Self::Glsl => &[Format::Glsl, Format::GlslPacked],
            Self::Json => &[Format::Json],
            Self::Onnx => &[Format::Onnx],
        }
    }
}

/// The files that names stand for, each once.
pub fn formats(names: &[FormatName]) -> Vec<Format> {
    let mut formats: Vec<Format> = names.iter().flat_map(|n| n.formats()).copied().collect();
    formats.sort();
    formats.dedup();
    formats
}

impl Export {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let mlp = file::load(&self.model)?;
        let formats = formats(&self.format);
        let paths = export::write(&mlp, &self.out, &formats, if self.force { Replace::Yes } else { Replace::No })?;
        if ui.json() {
            let results = formats.iter().zip(&paths).map(|(f, path)| json!({ "format": f.name(), "network": mlp.shape(), "file": path })).collect();
            ui.print_json("export", results)?;
        } else {
            for path in paths {
                ui.print(&format!("{}\n", path.display()))?;
            }
        }
        Ok(Verdict::Fine)
    }
}
