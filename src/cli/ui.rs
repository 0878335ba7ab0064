//! What a person or a script sees: results on stdout, progress and warnings on stderr.

use crate::pixel::{DepthWarning, FragmentList, LeftOut};
use anyhow::Context;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::io::{IsTerminal, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How to talk to the user.
pub struct Ui {
    quiet: bool,
    json: bool,
    notes: Arc<Mutex<Notes>>,
}

/// What was said about the input, for the report at the end.
#[derive(Default)]
struct Notes {
    left_out: Vec<LeftOut>,
    warnings: Vec<Value>,
}

impl Ui {
    pub fn new(quiet: bool, json: bool) -> Self {
        Self {
            quiet,
            json,
            notes: Arc::default(),
        }
    }

    /// Whether results are wanted as JSON.
    pub fn json(&self) -> bool {
        self.json
    }

    /// The same, without results on stdout: for stages of a larger command.
    pub fn stage(&self) -> Self {
        Self {
            quiet: self.quiet,
            json: false,
            notes: Arc::clone(&self.notes),
        }
    }

    /// Says what the source of a list holds and the list does not.
    pub fn left_out(&self, list: &FragmentList) {
        let mut notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        for left_out in list
            .left_out()
            .iter()
            .filter(|l| !notes.left_out.contains(l))
            .cloned()
            .collect::<Vec<_>>()
        {
            self.warn(&left_out.to_string());
            notes.left_out.push(left_out);
        }
    }

    /// Says what makes no sense about the depths of a list.
    pub fn depth_warning(&self, name: &str, warning: &DepthWarning) {
        self.warn(&format!("warning: {name}: {warning}"));
        let mut value = serde_json::to_value(warning).expect("a warning is plain data");
        if let Some(object) = value.as_object_mut() {
            object.insert("where".to_owned(), name.into());
            object.insert("message".to_owned(), warning.to_string().into());
        }
        self.notes
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .warnings
            .push(value);
    }

    /// The object that `--json` prints.
    pub fn report(&self, command: &str, results: Vec<Value>) -> Value {
        let notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        json!({
            "command": command, "version": env!("CARGO_PKG_VERSION"), "machine": machine(),
            "left_out": notes.left_out, "warnings": notes.warnings, "results": results,
        })
    }

    /// Prints an error as JSON, where that is how results are wanted.
    pub fn print_error(&self, command: &str, message: &str) {
        if !self.json {
            return;
        }
        let mut report = self.report(command, Vec::new());
        if let Some(object) = report.as_object_mut() {
            object.insert("error".to_owned(), message.into());
        }
        // Where this fails too, standard error has the message.
        drop(self.print(&format!("{report:#}\n")));
    }

    /// A warning or a note on stderr; nothing under `--quiet`.
    pub fn warn(&self, text: &str) {
        if !self.quiet {
            eprintln!("{text}");
        }
    }

    /// Progress over `length` units: a bar on a terminal, a line now and then elsewhere, nothing under `--quiet`.
    pub fn progress(&self, name: &'static str, length: u64) -> Progress {
        let terminal = std::io::stderr().is_terminal();
        let target = if self.quiet || !terminal {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(length), target);
        let style = ProgressStyle::with_template("{prefix:<10} [{bar:32}] {pos}/{len} {msg} (ETA {eta})")
            .expect("a valid template");
        bar.set_style(style.progress_chars("=> "));
        bar.set_prefix(name);
        Progress {
            bar,
            name,
            lines: !self.quiet && !terminal,
            last_line: Mutex::new(Instant::now()),
        }
    }

    /// Prints the one JSON object of a command.
    pub fn print_json(&self, command: &str, results: Vec<Value>) -> anyhow::Result<()> {
        self.print(&format!(
            "{}\n",
            serde_json::to_string_pretty(&self.report(command, results))?
        ))
    }

    /// Prints results.
    pub fn print(&self, text: &str) -> anyhow::Result<()> {
        match std::io::stdout().write_all(text.as_bytes()) {
            // A reader that has seen enough, as `head` does, is no error.
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
            other => other.context("cannot write to standard output"),
        }
    }
}

/// Progress of one piece of work.
pub struct Progress {
    bar: ProgressBar,
    name: &'static str,
    lines: bool,
    last_line: Mutex<Instant>,
}

impl Progress {
    /// So much is done; `message` is what else is known.
    pub fn set(&self, position: u64, message: impl Into<String>) {
        self.bar.set_position(position);
        let message = message.into();
        let mut last_line = self.last_line.lock().unwrap_or_else(PoisonError::into_inner);
        if self.lines && last_line.elapsed() > Duration::from_secs(10) {
            eprintln!("{}: {position}/{} {message}", self.name, self.bar.length().unwrap_or(0));
            *last_line = Instant::now();
        }
        self.bar.set_message(message);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The machine, as far as it matters for a measurement.
pub fn machine() -> Value {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        text.lines()
            .find_map(|l| l.strip_prefix("model name"))
            .map(|l| l.trim_start_matches([' ', '\t', ':']).to_owned())
    });
    json!({
        "cpu": cpu,
        "threads": std::thread::available_parallelism().map_or(1, usize::from),
        "os": std::env::consts::OS,
        "arch": std::env::consts::ARCH,
    })
}

/// Columns of the terminal; without end where standard output is none, so that what reads it finds each row on one
/// line.
fn columns() -> usize {
    terminal_size::terminal_size_of(std::io::stdout()).map_or(usize::MAX, |(width, _)| usize::from(width.0).max(80))
}

/// Rows as text in aligned columns; the first row is the head. Columns that do not fit the terminal follow below,
/// behind the first once more; where that does not tell rows apart, behind their numbers too.
pub fn table(rows: &[Vec<String>]) -> String {
    table_within(rows, columns())
}

/// Whether no two rows have the same first cells.
fn told_apart(rows: &[Vec<String>], cells: usize) -> bool {
    let mut seen = HashSet::new();
    rows.iter().all(|row| seen.insert(&row[..cells.min(row.len())]))
}

/// Rows with their numbers in front.
fn numbered(rows: &[Vec<String>]) -> Vec<Vec<String>> {
    let number = |index: usize| if index == 0 { "#".to_owned() } else { index.to_string() };
    let rows = rows.iter().enumerate();
    rows.map(|(index, row)| std::iter::once(number(index)).chain(row.iter().cloned()).collect())
        .collect()
}

fn table_within(rows: &[Vec<String>], most: usize) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let cell = |row: &Vec<String>, c: usize| row.get(c).cloned().unwrap_or_default();
    let widths: Vec<usize> = (0..count)
        .map(|c| rows.iter().map(|r| cell(r, c).chars().count()).max().unwrap_or(0))
        .collect();
    // A column of marks goes with the name beside it.
    let fixed = if widths.first().is_some_and(|&w| w <= 3) { 2 } else { 1 }.min(count);
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for c in fixed..count {
        let width = |block: &Vec<usize>| block.iter().map(|&c| widths[c] + 2).sum::<usize>() + widths[c];
        match blocks.last_mut().filter(|block| width(block) <= most) {
            Some(block) => block.push(c),
            None => blocks.push((0..fixed).chain([c]).collect()),
        }
    }
    if blocks.is_empty() {
        blocks.push((0..count).collect());
    }
    if blocks.len() > 1 && !told_apart(rows, fixed) {
        return table_within(&numbered(rows), most);
    }
    let lines = |block: &Vec<usize>| {
        let line = |text: &dyn Fn(usize) -> String| {
            let cells: Vec<String> = block
                .iter()
                .map(|&c| format!("{:<w$}", text(c), w = widths[c]))
                .collect();
            format!("{}\n", cells.join("  ").trim_end())
        };
        let mut text = String::new();
        for (index, row) in rows.iter().enumerate() {
            text += &line(&|c| cell(row, c));
            if index == 0 {
                text += &line(&|c| "-".repeat(widths[c]));
            }
        }
        text
    };
    blocks.iter().map(lines).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let rows = [["format", "error"], ["wgsl", "1e-7"]].map(|r| r.map(str::to_owned).to_vec());
        assert_eq!(table(&rows), "format  error\n------  -----\nwgsl    1e-7\n");
    }

    /// Wide tables go on below, and no line is longer than the terminal. Control: with room they stay whole.
    #[test]
    fn wide_tables_go_on_below() {
        let rows = [
            ["*", "method", "image MSE", "FLIP", "seconds"],
            ["", "hair", "1e-5", "0.01", "2"],
        ];
        let rows = rows.map(|r| r.map(str::to_owned).to_vec());
        let narrow = table_within(&rows, 24);
        assert!(narrow.lines().all(|line| line.len() <= 24), "{narrow}");
        assert_eq!((narrow.matches("hair").count(), narrow.matches("FLIP").count()), (2, 1));
        assert_eq!(table_within(&rows, 80).matches("hair").count(), 1);
    }

    /// Rows that begin alike are numbered where they are cut, so that their parts can be put together again. Control:
    /// rows that are whole, and those that their first cell tells apart, are not.
    #[test]
    fn rows_that_are_cut_can_be_put_together() {
        let rows = |second: &str| {
            let rows = [
                ["format", "question", "worst error", "result"],
                ["wgsl", "parses", "", "ok"],
                [second, "computes", "1e-7", "FAILED"],
            ];
            rows.map(|r| r.map(str::to_owned).to_vec())
        };
        let cut = table_within(&rows("wgsl"), 30);
        let of_second: Vec<&str> = cut.lines().filter(|line| line.starts_with("2  wgsl")).collect();
        assert!(
            of_second.len() > 1 && of_second.last().unwrap().ends_with("FAILED"),
            "{cut}"
        );
        assert_eq!(
            cut.lines().filter(|line| line.starts_with("#  format")).count(),
            of_second.len()
        );
        assert!(!table_within(&rows("wgsl"), 80).contains('#') && !table_within(&rows("glsl"), 30).contains('#'));
        let whole = table_within(&rows("wgsl"), usize::MAX);
        assert!(
            whole
                .lines()
                .any(|line| line.starts_with("wgsl    computes") && line.ends_with("FAILED"))
        );
    }
}
