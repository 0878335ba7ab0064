//! The command line: the only place that parses arguments, shows progress and prints.

mod bench;
mod check;
mod colour;
mod config;
mod evaluate;
mod examples;
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
#[cfg(test)]
mod schema;
mod shell;
mod stress;
mod train;
mod ui;

use clap::{Args, Parser, Subcommand};
use std::path::Path;
use std::process::ExitCode;
use ui::Ui;

/// The version, with the revision that the program was built from where that is known.
const VERSION: &str = env!("NMT_VERSION");

/// Train, export and check tiny networks for order-independent transparency.
#[derive(Parser)]
#[command(name = "nmt", version = VERSION, max_term_width = 100, after_help = examples::ALL)]
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
    #[command(after_help = examples::RUN)]
    Run(run::Run),
    /// Generate a dataset of random pixels: features, targets, manifest.
    #[command(after_help = examples::GENERATE)]
    Generate(generate::Generate),
    /// Train a network.
    #[command(after_help = examples::TRAIN)]
    Train(train::Train),
    #[command(about = export::about(), after_help = examples::EXPORT)]
    Export(export::Export),
    /// Check exports against the network.
    #[command(after_help = examples::CHECK)]
    Check(check::Check),
    /// Predict the transmittance of every fragment of a file.
    #[command(after_help = examples::PREDICT)]
    Predict(predict::Predict),
    /// Compare transparency methods on scenes: errors, images, contact sheets.
    #[command(after_help = examples::EVALUATE)]
    Evaluate(evaluate::Evaluate),
    /// List transparency methods: memory, passes, needs and sources.
    #[command(after_help = examples::METHODS)]
    Methods(methods::Methods),
    /// Render a scene, or convert a deep image, to a fragment list.
    #[command(after_help = examples::SCENE)]
    Scene(scene::Scene),
    /// Measure how fast training, generation, inference and transparency methods are.
    #[command(after_help = examples::BENCH)]
    Bench(bench::Bench),
    /// Find out where methods break: numerical stability of each, case by case.
    #[command(after_help = examples::STRESS)]
    Stress(stress::Stress),
    /// Find out what a scene needs: classes of fragments, time saved by skipping, the smallest network that will do.
    #[command(after_help = examples::PROFILE)]
    Profile(profile::Profile),
    /// Make one self-contained HTML page of what the other commands measured.
    #[command(after_help = examples::REPORT)]
    Report(report::Report),
    /// Make a model file from the weights of another program.
    #[command(after_help = examples::IMPORT)]
    Import(import::Import),
    /// Print the completions of a shell.
    #[command(after_help = examples::COMPLETIONS)]
    Completions(shell::Completions),
    /// Write man pages of every command.
    #[command(after_help = examples::MAN)]
    Man(shell::Man),
    /// Print the JSON Schema of configurations or of scene files.
    #[command(after_help = examples::SCHEMA)]
    Schema(shell::Schema),
}

/// How a command that did its work ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Fine,
    CheckFailed,
    Interrupted,
}

impl Command {
    /// Its name, as a user types it.
    fn name(&self) -> &'static str {
        match self {
            Self::Run(_) => "run",
            Self::Generate(_) => "generate",
            Self::Train(_) => "train",
            Self::Export(_) => "export",
            Self::Check(_) => "check",
            Self::Predict(_) => "predict",
            Self::Evaluate(_) => "evaluate",
            Self::Scene(_) => "scene",
            Self::Bench(_) => "bench",
            Self::Stress(_) => "stress",
            Self::Profile(_) => "profile",
            Self::Report(_) => "report",
            Self::Import(_) => "import",
            Self::Methods(_) => "methods",
            Self::Completions(_) => "completions",
            Self::Man(_) => "man",
            Self::Schema(_) => "schema",
        }
    }
}

/// A path as text, for results; names of files need not be UTF-8.
fn shown(path: &Path) -> String {
    path.display().to_string()
}

/// Gives the libraries of window systems a folder to look for a display in. Without one they print an error, though
/// nothing here opens a window.
fn settle_environment() {
    let usable =
        std::env::var_os("XDG_RUNTIME_DIR").is_some_and(|d| Path::new(&d).is_absolute() && Path::new(&d).is_dir());
    if cfg!(unix) && !usable {
        // SAFETY: this is the first thing that the process does; no other thread reads the environment yet.
        unsafe { std::env::set_var("XDG_RUNTIME_DIR", std::env::temp_dir()) };
    }
}

/// The arguments; what is wrong with them is printed, as JSON too where they ask for that.
fn arguments() -> Result<Cli, ExitCode> {
    Cli::try_parse().map_err(|error| {
        let usage = error.use_stderr();
        if usage && std::env::args_os().any(|a| a == "--json") {
            let command = std::env::args_os()
                .nth(1)
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            Ui::new(false, true).print_error(&command, error.to_string().trim_end());
        }
        // Where this fails, there is nobody to tell.
        drop(error.print());
        ExitCode::from(if usage { 2 } else { 0 })
    })
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

/// Parses the arguments, runs the command, and returns 0 where all is fine, 1 where a check failed, 2 for wrong usage
/// or input, 130 where it was interrupted.
pub fn main() -> ExitCode {
    settle_environment();
    let cli = match arguments() {
        Ok(cli) => cli,
        Err(code) => return code,
    };
    interrupt::install();
    let ui = Ui::new(cli.global.quiet, cli.global.json);
    let command = cli.command.name();
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
        Command::Completions(c) => c.execute(&ui),
        Command::Man(c) => c.execute(&ui),
        Command::Schema(c) => c.execute(&ui),
    };
    match done {
        Ok(Verdict::Fine) => ExitCode::SUCCESS,
        Ok(Verdict::CheckFailed) => ExitCode::from(1),
        Ok(Verdict::Interrupted) => ExitCode::from(interrupt::EXIT_CODE),
        Err(error) => {
            let message = explain(&error);
            ui.print_error(command, &message);
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}
