//! `nmt stress`

use super::Verdict;
use super::ui::{Ui, table};
use crate::model::{Mlp, file};
use crate::oit::{all_names, parse};
use crate::stress::{Case, Classic, Execution, Report, Subject, measure};
use clap::Args;
use serde_json::json;
use std::collections::HashSet;
use std::path::PathBuf;

#[derive(Args)]
pub struct Stress {
    /// Networks, each run in every arithmetic, storage and format of weights.
    #[arg(long, value_name = "MODEL.json", num_args = 1..)]
    model: Vec<PathBuf>,
    /// Methods, by name; "all" stands for every classic one.
    #[arg(long, value_delimiter = ',', default_values = DEFAULT_METHODS)]
    methods: Vec<String>,
    /// Cases, by name, instead of all.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    cases: Vec<String>,
}

/// What networks are put beside.
const DEFAULT_METHODS: [&str; 9] = [
    "moment-power-4:f32",
    "moment-power-8:f32",
    "moment-trig-4:f32",
    "moment-power-4:unorm16",
    "moment-power-8:unorm16",
    "moment-trig-4:unorm16",
    "moment-power-4:f32+own",
    "moment-trig-4:f32+own",
    "moment-power-4:unorm16+own",
];

/// Columns of a terminal that tables stay within where they can.
const WIDTH: usize = 130;

impl Stress {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let mlps: Vec<Mlp> = self.model.iter().map(|path| file::load(path)).collect::<Result<_, _>>()?;
        let subjects = self.subjects(&mlps)?;
        let mut cases = Case::all();
        if !self.cases.is_empty() {
            let names: Vec<&str> = cases.iter().map(|c| c.name).collect();
            if let Some(unknown) = self.cases.iter().find(|name| !names.contains(&name.as_str())) {
                anyhow::bail!("--cases '{unknown}': there is no such case; there are {}", names.join(", "));
            }
            cases.retain(|c| self.cases.iter().any(|name| name == c.name));
        }
        let progress = ui.progress("stress", (cases.len() * subjects.len()) as u64);
        let mut reports = Vec::new();
        for subject in &subjects {
            for case in &cases {
                progress.set(reports.len() as u64, format!("{}: {}", subject.name, case.name));
                reports.push(measure(case, subject));
            }
        }
        progress.finish();
        let broken: Vec<String> = reports.iter().flat_map(Report::broken).collect();
        if ui.json() {
            let results = reports.iter().map(|r| json!({ "kind": "case", "report": r })).collect();
            ui.print_json("stress", results)?;
        } else {
            ui.print(&tables(&reports, &cases, subjects.len()))?;
            for line in &broken {
                ui.print(&format!("BROKEN {line}\n"))?;
            }
        }
        Ok(if broken.is_empty() { Verdict::Fine } else { Verdict::CheckFailed })
    }

    fn subjects(&self, mlps: &[Mlp]) -> anyhow::Result<Vec<Subject<'static>>> {
        let mut subjects = Vec::new();
        for mlp in mlps {
            for execution in Execution::all(mlp.feature_set()) {
                subjects.push(Subject::network(mlp, execution)?);
            }
        }
        let mut seen = HashSet::new();
        for name in &self.methods {
            let names = if name == "all" { all_names() } else { vec![name.clone()] };
            for name in names {
                if seen.insert(name.clone()) {
                    let plain = [":f32", ":unorm16", ":nlqm"].iter().fold(name.clone(), |name, suffix| name.replace(suffix, ""));
                    let double = (plain != name).then(|| parse(&plain)).transpose()?;
                    subjects.push(Subject::method(parse(&name)?, double));
                }
            }
        }
        subjects.extend(Classic::ALL.map(Classic::subject));
        Ok(subjects)
    }
}

/// Worst error, and a mark for what is not finite or out of range.
fn cell(report: &Report) -> String {
    if report.refused.is_some() {
        return "refused".to_owned();
    }
    let mut text = match report.worst_error {
        Some(e) if e >= 0.0095 => format!("{e:.2}"),
        Some(0.0) => "0".to_owned(),
        Some(e) => format!("{e:.0e}"),
        None => "-".to_owned(),
    };
    let share = |count: u64| {
        let percent = 100.0 * count as f64 / report.fragments.max(1) as f64;
        if percent < 0.1 { "<0.1%".to_owned() } else { format!("{percent:.1}%") }
    };
    if report.nonfinite > 0 {
        text += &format!(" NaN {}", share(report.nonfinite));
    }
    if report.out_of_range > 0 {
        text += &format!(" out {}", share(report.out_of_range));
    }
    text
}

/// Cases by methods, as many methods side by side as fit.
fn tables(reports: &[Report], cases: &[Case], subjects: usize) -> String {
    let mut columns: Vec<Vec<String>> = vec![std::iter::once("case".to_owned()).chain(cases.iter().map(|c| c.name.to_owned())).collect()];
    for of_subject in reports.chunks(cases.len()).take(subjects) {
        columns.push(std::iter::once(of_subject[0].method.clone()).chain(of_subject.iter().map(cell)).collect());
    }
    let width = |column: &Vec<String>| column.iter().map(|t| t.chars().count()).max().unwrap_or(0) + 2;
    let mut text = String::new();
    let mut next = 1;
    while next < columns.len() {
        let mut end = next + 1;
        let mut taken = width(&columns[0]) + width(&columns[next]);
        while end < columns.len() && taken + width(&columns[end]) <= WIDTH {
            taken += width(&columns[end]);
            end += 1;
        }
        let block: Vec<&Vec<String>> = std::iter::once(&columns[0]).chain(&columns[next..end]).collect();
        let rows: Vec<Vec<String>> = (0..=cases.len()).map(|i| block.iter().map(|c| c[i].clone()).collect()).collect();
        text += &table(&rows);
        text += "\n";
        next = end;
    }
    text
}
