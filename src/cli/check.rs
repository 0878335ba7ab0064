//! `nmt check`

use super::Verdict;
use super::export::FormatArguments;
use super::ui::{Ui, table};
use crate::check::{self, CheckOptions, Finding, OPTIONAL_TOOLS, Status};
use crate::export::{self, Format};
use crate::model::{Mlp, shipped};
use crate::numeric::require;
use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Check {
    /// Model file; or core:K, the method without a network.
    model: PathBuf,
    /// Folder of its exports.
    #[arg(long, value_name = "DIR")]
    exports: PathBuf,
    #[command(flatten)]
    formats: FormatArguments,
    #[command(flatten)]
    options: CheckArguments,
}

/// Options that `check` and `run` share.
#[derive(Args, Clone)]
pub struct CheckArguments {
    /// Tools whose absence is a failure: onnxruntime, glslangValidator, slangc, spirv-val, gpu. NMT_REQUIRE does the
    /// same.
    #[arg(long, value_delimiter = ',', num_args = 1.., value_name = "TOOLS")]
    require: Vec<String>,
}

impl CheckArguments {
    /// Tools that are required here or by the environment.
    fn required(&self) -> anyhow::Result<Vec<String>> {
        let known = |tools: &[&str], source: &str, names: &[String]| match names
            .iter()
            .find(|name| !tools.contains(&name.as_str()))
        {
            Some(unknown) => bail!("{source} names '{unknown}'; known are {}", tools.join(", ")),
            None => Ok(()),
        };
        let mut tools: Vec<String> = self.require.iter().flat_map(|list| require::names(list)).collect();
        known(&OPTIONAL_TOOLS, "--require", &tools)?;
        let variable = require::required();
        known(&require::TOOLS, require::VARIABLE, &variable)?;
        // The others are tools of the tests.
        tools.extend(
            variable
                .into_iter()
                .filter(|name| OPTIONAL_TOOLS.contains(&name.as_str())),
        );
        Ok(tools)
    }
}

impl Check {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        if let Some(set) = self.model.to_str().and_then(export::core::named) {
            let mut findings = check::core::check(set, &self.exports);
            check::require(&mut findings, &self.options.required()?);
            if ui.json() {
                ui.print_json("check", findings.iter().map(to_json).collect())?;
            } else {
                ui.print(&text(&findings))?;
            }
            return Ok(verdict(&findings));
        }
        let mlp = shipped::open(&self.model)?;
        let findings = findings(&mlp, &self.exports, &self.formats.formats()?, &self.options, ui)?;
        if ui.json() {
            ui.print_json("check", findings.iter().map(to_json).collect())?;
        } else {
            ui.print(&text(&findings))?;
        }
        Ok(verdict(&findings))
    }
}

/// Checks with progress on stderr.
pub fn findings(
    mlp: &Mlp,
    exports: &Path,
    formats: &[Format],
    arguments: &CheckArguments,
    ui: &Ui,
) -> anyhow::Result<Vec<Finding>> {
    let required = arguments.required()?;
    let progress = ui.progress("check", formats.len() as u64 + 1);
    let done = std::cell::Cell::new(0);
    let mut findings = check::check(mlp, exports, formats, CheckOptions::default(), &|name| {
        progress.set(done.get(), name);
        done.set(done.get() + 1);
    });
    progress.finish();
    check::require(&mut findings, &required);
    Ok(findings)
}

pub fn verdict(findings: &[Finding]) -> Verdict {
    if findings.iter().any(|f| matches!(f.status, Status::Failed(_))) {
        Verdict::CheckFailed
    } else {
        Verdict::Fine
    }
}

pub fn to_json(finding: &Finding) -> Value {
    let (status, reason) = match &finding.status {
        Status::Passed => ("passed", None),
        Status::Failed(why) => ("failed", Some(why)),
        Status::Skipped(why) => ("skipped", Some(why)),
    };
    let numbers: Vec<Value> = finding
        .numbers
        .iter()
        .map(|n| {
            json!({
                "rows": n.kind, "count": n.export.count(), "nonfinite": n.export.nonfinite(),
                    "worst_error": n.export.worst(),
                "mean_error": n.export.mean(), "reference_worst_error": n.reference.map(|r| r.worst()), "bar": n.bar,
                    "mean_bar": n.mean_bar,
            })
        })
        .collect();
    json!({ "format": finding.format.name(), "tool": finding.tool, "question": finding.question, "status": status,
        "reason": reason, "note": finding.note, "numbers": numbers })
}

/// A table of all findings, then the reasons of those that did not pass.
fn text(findings: &[Finding]) -> String {
    let mut rows = vec![
        [
            "format",
            "checked by",
            "question",
            "rows",
            "worst error",
            "mean error",
            "own pass",
            "bar",
            "result",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    let mut reasons = String::new();
    for f in findings {
        let result = match &f.status {
            Status::Passed => "ok",
            Status::Failed(why) => {
                reasons += &format!("FAILED {}, {}, {}: {why}\n", f.format.name(), f.tool, f.question);
                "FAILED"
            }
            Status::Skipped(why) => {
                reasons += &format!("skipped {}, {}, {}: {why}\n", f.format.name(), f.tool, f.question);
                "skipped"
            }
        };
        if let Some(note) = &f.note {
            let line = format!("{}: {note}\n", f.tool);
            if !reasons.contains(&line) {
                reasons += &line;
            }
        }
        let head = [f.format.name(), f.tool, f.question].map(str::to_owned);
        if f.numbers.is_empty() {
            rows.push(
                head.iter()
                    .cloned()
                    .chain(["", "", "", "", "", result].map(str::to_owned))
                    .collect(),
            );
        }
        for n in &f.numbers {
            let numbers = [
                format!("{} {}", n.export.count(), n.kind.name()),
                format!("{:.2e}", n.export.worst()),
                format!("{:.2e}", n.export.mean()),
                n.reference.map_or("-".to_owned(), |r| format!("{:.2e}", r.worst())),
                format!("{:.2e}", n.bar),
                result.to_owned(),
            ];
            rows.push(head.iter().cloned().chain(numbers).collect());
        }
    }
    table(&rows) + &reasons
}
