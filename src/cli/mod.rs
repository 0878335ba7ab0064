//! The command line: the only place that parses arguments, shows progress and prints.

mod bench;
mod bench_tiles;
mod check;
mod config;
mod evaluate;
mod export;
mod generate;
mod import;
mod interrupt;
mod methods;
mod predict;
mod profile;
mod report;
mod run;
mod scene;
mod stress;
mod train;
mod ui;

use clap::{Args, Parser, Subcommand};
use std::process::ExitCode;
use ui::Ui;

/// Train, export and check tiny networks for order-independent transparency.
#[derive(Parser)]
#[command(name = "nmt", version, max_term_width = 100)]
struct Cli {
    #[command(flatten)]
    global: Global,
    #[command(subcommand)]
    command: Command,
}

/// Options of every subcommand.
#[derive(Args)]
struct Global {
    /// Show no progress and no warnings.
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Print one JSON object instead of text.
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Subcommand)]
enum Command {
    /// The main job: generate, train, evaluate, export and check in one go.
    Run(run::Run),
    /// Generate a dataset of random pixels: features, targets, manifest.
    Generate(generate::Generate),
    /// Train a network.
    Train(train::Train),
    /// Export a network as WGSL, GLSL, HLSL, MSL, SPIR-V, JSON and ONNX.
    Export(export::Export),
    /// Check exports against the network.
    Check(check::Check),
    /// Answer the fragments of a file: transmittance of each.
    Predict(predict::Predict),
    /// Compare transparency methods on scenes: errors, images, contact sheets.
    Evaluate(evaluate::Evaluate),
    /// List transparency methods: memory, passes, needs and sources.
    Methods(methods::Methods),
    /// Render a scene, or convert a deep image, to a fragment list.
    Scene(scene::Scene),
    /// Measure how fast training, generation, inference and transparency methods are.
    Bench(bench::Bench),
    /// Find out where methods break: numerical stability of each, case by case.
    Stress(stress::Stress),
    /// What a scene needs of a network: classes of fragments, time saved by skipping, the smallest network that will do.
    Profile(profile::Profile),
    /// Make one self-contained HTML page of what the other commands measured.
    Report(report::Report),
    /// Make a model file from the weights of another program.
    Import(import::Import),
}

/// How a command that did its work ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Fine,
    CheckFailed,
    Interrupted,
}

/// An error with its causes, each said once: many messages hold their cause already.
fn explain(error: &anyhow::Error) -> String {
    error.chain().skip(1).fold(error.to_string(), |text, cause| {
        let cause = cause.to_string();
        if text.contains(&cause) {
            text
        } else {
            format!("{text}: {cause}")
        }
    })
}

/// Refuses to write over a file that the same command reads.
///
/// # Errors
/// Where `out` is one of `inputs`.
fn keep_inputs(inputs: &[&std::path::Path], out: &std::path::Path) -> anyhow::Result<()> {
    let place = |path: &std::path::Path| path.canonicalize().ok();
    match place(out) {
        Some(there) if inputs.iter().any(|input| place(input).as_ref() == Some(&there)) => {
            anyhow::bail!("{}: is read by this very command; choose another output", out.display())
        }
        _ => Ok(()),
    }
}

/// Parses the arguments, runs the command, and returns 0 where all is fine, 1 where a check failed, 2 for wrong usage or input, 130 where
/// it was interrupted.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    interrupt::install();
    let ui = Ui::new(cli.global.quiet, cli.global.json);
    let done = match cli.command {
        Command::Run(c) => c.execute(&ui),
        Command::Generate(c) => c.execute(&ui),
        Command::Train(c) => c.execute(&ui),
        Command::Export(c) => c.execute(&ui),
        Command::Check(c) => c.execute(&ui),
        Command::Predict(c) => c.execute(&ui),
        Command::Evaluate(c) => c.execute(&ui),
        Command::Methods(c) => c.execute(&ui),
        Command::Scene(c) => c.execute(&ui),
        Command::Bench(c) => c.execute(&ui),
        Command::Stress(c) => c.execute(&ui),
        Command::Profile(c) => c.execute(&ui),
        Command::Report(c) => c.execute(&ui),
        Command::Import(c) => c.execute(&ui),
    };
    match done {
        Ok(Verdict::Fine) => ExitCode::SUCCESS,
        Ok(Verdict::CheckFailed) => ExitCode::from(1),
        Ok(Verdict::Interrupted) => ExitCode::from(interrupt::EXIT_CODE),
        Err(error) => {
            eprintln!("error: {}", explain(&error));
            ExitCode::from(2)
        }
    }
}
