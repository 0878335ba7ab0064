//! What a shell and a reader of manuals need: completions, man pages, and schemas of the files that people write.

use super::ui::Ui;
use super::{Cli, Verdict};
use crate::numeric::file::{Replace, create_folder, write_atomically};
use clap::{Args, CommandFactory, ValueEnum};
use clap_complete::Shell;
use std::path::{Path, PathBuf};

/// `nmt completions`
#[derive(Args)]
pub struct Completions {
    /// The shell to complete for.
    shell: Shell,
}

impl Completions {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "nmt", &mut text);
        ui.print(&String::from_utf8_lossy(&text))?;
        Ok(Verdict::Fine)
    }
}

/// `nmt man`
#[derive(Args)]
pub struct Man {
    /// Folder for the pages: nmt.1, nmt-run.1, and one for every other command.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

impl Man {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        create_folder(&self.out)?;
        let mut command = Cli::command();
        command.build();
        for path in pages(&command, &self.out, replace)? {
            ui.print(&format!("{}\n", path.display()))?;
        }
        Ok(Verdict::Fine)
    }
}

/// Writes the page of a command and those of its subcommands.
fn pages(command: &clap::Command, folder: &Path, replace: Replace) -> anyhow::Result<Vec<PathBuf>> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    let path = folder.join(format!("{name}.1"));
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut text)?;
    write_atomically(&path, replace, |w| w.write_all(&text))?;
    let mut paths = vec![path];
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        paths.extend(pages(sub, folder, replace)?);
    }
    Ok(paths)
}

/// `nmt schema`
#[derive(Args)]
pub struct Schema {
    /// The kind of file.
    kind: Kind,
}

#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// Configurations of `nmt run`, `generate` and `train`.
    Config,
    /// Scene files of `nmt scene` and of `--fragments`.
    Scene,
}

/// The schemas, which a test makes from the types that read the files.
pub const CONFIG_SCHEMA: &str = include_str!("../../configs/schema/config.schema.json");
pub const SCENE_SCHEMA: &str = include_str!("../../configs/schema/scene.schema.json");

impl Schema {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        ui.print(match self.kind {
            Kind::Config => CONFIG_SCHEMA,
            Kind::Scene => SCENE_SCHEMA,
        })?;
        Ok(Verdict::Fine)
    }
}
