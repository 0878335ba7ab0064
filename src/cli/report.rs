//! `nmt report`

use super::ui::Ui;
use super::{Verdict, keep_inputs};
use crate::numeric::file::{Replace, may_write, write_atomically};
use crate::report::{Options, build};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Report {
    /// Folder that other commands wrote to; folders in it are searched too.
    folder: PathBuf,
    /// Page to write, instead of report.html in the folder.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Most room that pictures may take in the page \[MiB\].
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u64).range(..=4096))]
    embed_mib: u64,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

impl Report {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        let out = self.out.unwrap_or_else(|| self.folder.join("report.html"));
        may_write(&out, replace)?;
        let page = build(
            &self.folder,
            &Options {
                most_picture_bytes: self.embed_mib << 20,
            },
        )?;
        keep_inputs(&page.read.iter().map(PathBuf::as_path).collect::<Vec<&Path>>(), &out)?;
        write_atomically(&out, replace, |w| w.write_all(page.html.as_bytes()))?;
        for problem in &page.problems {
            ui.warn(&format!("warning: {problem}"));
        }
        if !page.pictures_left_out.is_empty() {
            let count = page.pictures_left_out.len();
            ui.warn(&format!(
                "warning: {count} pictures are left out, beyond {} MiB; --embed-mib allows more",
                self.embed_mib
            ));
        }
        if ui.json() {
            let missing: Vec<_> = page
                .missing
                .iter()
                .map(|m| json!({ "what": m.what, "command": m.command }))
                .collect();
            let problems: Vec<String> = page.problems.iter().map(ToString::to_string).collect();
            ui.print_json(
                "report",
                vec![json!({
                    "file": out, "bytes": page.html.len(), "sections": page.sections, "missing": missing,
                        "problems": problems, "pictures": page.pictures,
                    "pictures_left_out": page.pictures_left_out,
                })],
            )?;
        } else {
            let mut text = format!("found: {}; {} pictures\n", page.sections.join("; "), page.pictures);
            for m in &page.missing {
                text += &format!("not there: {} ({})\n", m.what, m.command);
            }
            ui.print(&format!("{text}{}\n", out.display()))?;
        }
        Ok(Verdict::Fine)
    }
}
