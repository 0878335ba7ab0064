//! Exports held against the network: what stands in a folder is read, parsed, compared bit for bit and executed.
//!
//! Every comparison comes with controls that must fail: a network with one perturbed weight, one with two features
//! swapped and one with a transposed layer must not pass in the network's place. Where a control passes, the check
//! reports itself as failed.

pub mod core;
pub mod graph;
pub mod half;
pub mod hlsl;
pub mod interpret;
pub mod onnx;
pub mod rows;
pub mod shader;
pub mod translated;

use crate::export::core::chain_languages;
use crate::export::shader::{ENTRY, PRUNED, half_bounds, half_limit, network_function};
use crate::export::target::Reader;
use crate::export::{Format, Precision, Prefix, onnx as onnx_export, translate};
use crate::features::FeatureSet;
use crate::gpu::{Gpu, compute};
use crate::model::simplify::{Pruned, fires, without_units};
use crate::model::{Dense, Mlp, file};
use crate::numeric::file::read;
use crate::numeric::tolerance::AbsoluteError;
use interpret::Interpreter;
use rows::{CheckRows, RowKind};
use std::cell::OnceCell;
use std::path::Path;

/// Greatest absolute error in distribution: raw features of the `paper` set reach logits of 20, where f32 sums lose
/// this much; features of the recentred sets are of the order of 1.
pub fn bar_in_distribution(set: FeatureSet) -> f64 {
    set.spec().tolerances.single
}

/// An export may be this many times as far from f64 as our own f32 forward pass is on the same rows: in the mean in
/// distribution, at worst beyond.
pub const BAR_FACTOR: f64 = 3.0;

/// Half a unit in the last place of 1: what rounding the answer itself costs, where our own pass happens to be exact.
const ROUNDING: f64 = 1.0 / (1u64 << 24) as f64;

/// How far a check goes.
#[derive(Debug, Clone, Copy)]
pub struct CheckOptions {
    /// Rows in distribution.
    pub rows: usize,
    /// Extreme rows.
    pub extreme_rows: usize,
    /// Rows in distribution that a GPU is given, and a tenth as many extreme ones.
    pub gpu_rows: usize,
}

impl Default for CheckOptions {
    fn default() -> Self {
        Self {
            rows: 100_000,
            extreme_rows: 20_000,
            gpu_rows: 1_000_000,
        }
    }
}

/// How one check of one export ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Status {
    /// It holds.
    Passed,
    /// It does not, or could not be told: why.
    Failed(String),
    /// What it needs is not here: what, and how to get it.
    Skipped(String),
}

/// Errors on rows of one kind.
#[derive(Debug, Clone, Copy)]
pub struct Numbers {
    /// Kind of rows.
    pub kind: RowKind,
    /// Error of the export against the f64 forward pass.
    pub export: AbsoluteError,
    /// Error of our own forward pass in the export's precision on the same rows; none where formulas are what the
    /// export is held to.
    pub reference: Option<AbsoluteError>,
    /// Greatest absolute error that passes.
    pub bar: f64,
    /// Greatest mean error that passes; no more than `bar` where nothing else is said.
    pub mean_bar: f64,
}

/// One check of one export.
#[derive(Debug, Clone)]
pub struct Finding {
    /// The export.
    pub format: Format,
    /// What did the checking: a name that `--require` knows where it is not built in.
    pub tool: &'static str,
    /// What was asked.
    pub question: &'static str,
    /// The answer.
    pub status: Status,
    /// Measured errors, where it is a question of numbers.
    pub numbers: Vec<Numbers>,
    /// What else is to be known of the answer.
    pub note: Option<String>,
}

impl Finding {
    fn new(format: Format, tool: &'static str, question: &'static str, result: Result<(), String>) -> Self {
        let status = match result {
            Ok(()) => Status::Passed,
            Err(why) => Status::Failed(why),
        };
        Self {
            format,
            tool,
            question,
            status,
            numbers: Vec::new(),
            note: None,
        }
    }

    fn skipped(format: Format, tool: &'static str, question: &'static str, why: String) -> Self {
        Self {
            format,
            tool,
            question,
            status: Status::Skipped(why),
            numbers: Vec::new(),
            note: None,
        }
    }

    /// Greatest absolute error in distribution, where one was measured.
    pub fn worst_in_distribution(&self) -> Option<f64> {
        self.numbers
            .iter()
            .find(|n| n.kind == RowKind::InDistribution)
            .map(|n| n.export.worst())
    }
}

/// Names of tools that need not be there and that `--require` makes a condition.
pub const OPTIONAL_TOOLS: [&str; 5] = ["onnxruntime", "glslangValidator", "slangc", "spirv-val", "gpu"];

/// What the rows should give, and what they must not.
struct Reference {
    /// The network that the export computes: the one that is checked, or what is left of it.
    network: Mlp,
    rows: Vec<CheckRows>,
    /// For each kind of rows.
    answers: Vec<Answers>,
    /// What is to be known of the rows.
    note: Option<String>,
}

/// Answers to rows of one kind.
struct Answers {
    /// Of the f64 forward pass.
    exact: Vec<f64>,
    /// Error of our f32 passes, of the one that is further off.
    ours: AbsoluteError,
    /// Of the controls, in f64.
    controls: Vec<(&'static str, Vec<f64>)>,
    /// The same for networks in f16, made when the first of them asks.
    half: OnceCell<Result<Half, String>>,
}

/// What f16 costs.
struct Half {
    /// Error of our own pass with hidden layers in f16.
    ours: AbsoluteError,
    /// Of the controls, in f64: further off than those of f32.
    controls: Vec<(&'static str, Vec<f64>)>,
}

/// What an export may and may not do.
struct Bars<'a> {
    /// Greatest absolute error.
    bar: f64,
    /// Greatest mean error.
    mean_bar: f64,
    /// Error of our own pass.
    ours: AbsoluteError,
    /// Answers that must not pass.
    controls: &'a [(&'static str, Vec<f64>)],
}

impl Bars<'_> {
    fn hold(&self, error: &AbsoluteError) -> bool {
        error.within(self.bar) && error.mean() <= self.mean_bar
    }
}

/// By how much a weight of a control is perturbed.
const PERTURBATION: f32 = 1.0 / 64.0;
/// The same where hidden layers are in f16.
const HALF_PERTURBATION: f32 = 1.0 / 8.0;

impl Reference {
    /// What `whole` answers. Where units were taken out, rows in distribution are held to the whole network all the
    /// same; extreme ones, on which such units may fire, to what is left, which is the same network wherever they do
    /// not.
    fn new(whole: &Mlp, left: Option<(&Mlp, &Pruned)>, in_distribution: usize, extreme: usize) -> Result<Self, String> {
        let network = left.map_or(whole, |(left, _)| left);
        let rows = vec![
            rows::in_distribution(whole, in_distribution)?,
            rows::extreme(whole.feature_set().width(), extreme),
        ];
        let controls = controls(whole, PERTURBATION);
        let answers = rows
            .iter()
            .map(|rows| {
                let subject = if rows.kind == RowKind::InDistribution {
                    whole
                } else {
                    network
                };
                let exact = subject.forward_batch::<f64>(&rows.features);
                // Two f32 passes of ours, with and without fused multiply-adds: the one that is further off says what
                // f32 costs.
                let passes = [
                    subject.forward_batch::<f32>(&rows.features),
                    subject.predict(&rows.features),
                ];
                let [plain, fused] = passes.map(|pass| AbsoluteError::of(&widen(&pass), &exact));
                let ours = if fused.worst() > plain.worst() { fused } else { plain };
                let controls = controls
                    .iter()
                    .map(|(name, mlp)| (*name, mlp.forward_batch::<f64>(&rows.features)))
                    .collect();
                Answers {
                    exact,
                    ours,
                    controls,
                    half: OnceCell::new(),
                }
            })
            .collect();
        let note = left.map(|(_, pruned)| {
            let width = whole.feature_set().width();
            let firing: Vec<String> = rows
                .iter()
                .map(|r| {
                    let fired = r
                        .features
                        .chunks_exact(width)
                        .filter(|row| fires(whole, &pruned.units, row))
                        .count();
                    format!("{fired} of {} rows ({})", r.features.len() / width, r.kind.name())
                })
                .collect();
            format!(
                "a unit that was taken out would fire on {}; the first kind is held to the whole network, the second \
                    to what is left of it",
                firing.join(" and on ")
            )
        });
        Ok(Self {
            network: network.clone(),
            rows,
            answers,
            note,
        })
    }

    /// What f16 costs on rows of one kind.
    fn half<'a>(&self, rows: &CheckRows, answers: &'a Answers) -> Result<&'a Half, String> {
        let made = || {
            let limit = half_limit(&self.network).map_err(|e| e.to_string())?;
            let ours = AbsoluteError::of(
                &widen(&half::forward_batch(&self.network, limit, &rows.features)),
                &answers.exact,
            );
            let controls = controls(&self.network, HALF_PERTURBATION);
            let controls = controls
                .iter()
                .map(|(name, mlp)| (*name, mlp.forward_batch::<f64>(&rows.features)))
                .collect();
            Ok(Half { ours, controls })
        };
        answers.half.get_or_init(made).as_ref().map_err(Clone::clone)
    }

    /// What an export in some precision may and may not do on rows of one kind.
    fn bars<'a>(&self, precision: Precision, rows: &CheckRows, answers: &'a Answers) -> Result<Bars<'a>, String> {
        let set = self.network.feature_set();
        let (ours, controls, most, mean) = match precision {
            Precision::F32 => (answers.ours, &answers.controls, bar_in_distribution(set), None),
            Precision::F16 => {
                let half = self.half(rows, answers)?;
                let (most, mean) = half_bounds(set);
                (half.ours, &half.controls, most, Some(mean))
            }
        };
        let mut bar = BAR_FACTOR * ours.worst().max(ROUNDING);
        let mut mean_bar = bar;
        let in_distribution = rows.kind == RowKind::InDistribution;
        match (precision, mean) {
            // The worst of many rows is chance, and another order of summation is no error: what is held to our own
            // passes is the mean, and all but the coarse logarithms and exponentials of devices with it.
            (Precision::F32, _) if in_distribution => {
                bar = most;
                mean_bar = (BAR_FACTOR * ours.mean()).max(0.05 * most);
            }
            (Precision::F16, Some(mean)) if in_distribution => {
                bar = bar.max(0.01 * most).min(most);
                mean_bar = (BAR_FACTOR * ours.mean()).max(0.01 * mean).min(mean);
            }
            // Far out, f16 may say anything in [0, 1], but not NaN.
            (Precision::F16, _) => (bar, mean_bar) = (bar.min(1.0), 1.0),
            _ => {}
        }
        Ok(Bars {
            bar,
            mean_bar,
            ours,
            controls,
        })
    }

    /// Runs an export on all rows and compares.
    fn compare(&self, format: Format, tool: &'static str, run: impl Fn(&[f32]) -> Result<Vec<f32>, String>) -> Finding {
        let precision = format.precision();
        let mut numbers = Vec::new();
        let mut problems = Vec::new();
        for (rows, answers) in self.rows.iter().zip(&self.answers) {
            let exact = &answers.exact;
            let out = match run(&rows.features) {
                Ok(out) if out.len() == exact.len() => widen(&out),
                Ok(out) => {
                    problems.push(format!("{} answers to {} rows", out.len(), exact.len()));
                    continue;
                }
                Err(why) => {
                    problems.push(why);
                    continue;
                }
            };
            let bars = match self.bars(precision, rows, answers) {
                Ok(bars) => bars,
                Err(why) => {
                    problems.push(why);
                    continue;
                }
            };
            let export = AbsoluteError::of(&out, exact);
            let Bars {
                bar,
                mean_bar,
                ours,
                controls,
            } = bars;
            if !bars.hold(&export) {
                problems.push(format!(
                    "{}: worst error {:.2e}, mean {:.2e} against f64, {} non-finite; at most {bar:.2e} and \
                        {mean_bar:.2e} are allowed (our own pass: {:.2e}, {:.2e})",
                    rows.kind.name(),
                    export.worst(),
                    export.mean(),
                    export.nonfinite(),
                    ours.worst(),
                    ours.mean()
                ));
            }
            if out.iter().any(|t| !(0.0..=1.0).contains(t)) {
                problems.push(format!("{}: an answer lies outside [0, 1]", rows.kind.name()));
            }
            if rows.kind == RowKind::InDistribution {
                let passed = controls
                    .iter()
                    .filter(|(_, control)| bars.hold(&AbsoluteError::of(&out, control)))
                    .map(|(name, _)| *name);
                problems.extend(
                    passed.map(|name| format!("the check is blind: a network with {name} would have passed too")),
                );
            }
            numbers.push(Numbers {
                kind: rows.kind,
                export,
                reference: Some(ours),
                bar,
                mean_bar,
            });
        }
        let result = if problems.is_empty() {
            Ok(())
        } else {
            Err(problems.join("; "))
        };
        Finding {
            numbers,
            note: self.note.clone(),
            ..Finding::new(format, tool, "computes the reference", result)
        }
    }
}

fn widen(values: &[f32]) -> Vec<f64> {
    values.iter().map(|&v| v.into()).collect()
}

/// Networks that must not pass in another's place.
fn controls(mlp: &Mlp, perturbation: f32) -> Vec<(&'static str, Mlp)> {
    let rebuilt = |layers: Vec<Dense>| {
        Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone()).expect("shapes are unchanged")
    };
    let mut perturbed = mlp.layers().to_vec();
    let last = perturbed.last_mut().expect("at least one layer");
    let greatest = (0..last.weights.len())
        .max_by(|&a, &b| last.weights[a].abs().total_cmp(&last.weights[b].abs()))
        .unwrap_or(0);
    last.weights[greatest] += perturbation;
    last.biases[0] += perturbation;

    // The two features that the first layer treats most differently.
    let first = &mlp.layers()[0];
    let difference = |i: usize, j: usize| -> f32 {
        (0..first.outputs())
            .map(|o| (first.weight(i, o) - first.weight(j, o)).abs())
            .sum()
    };
    let pairs = (0..first.inputs()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let (i, j) = pairs
        .max_by(|&a, &b| difference(a.0, a.1).total_cmp(&difference(b.0, b.1)))
        .unwrap_or((0, 0));
    let mut swapped = mlp.layers().to_vec();
    let outputs = first.outputs();
    for o in 0..outputs {
        swapped[0].weights.swap(i * outputs + o, j * outputs + o);
    }
    let mut controls = vec![
        ("one weight perturbed", rebuilt(perturbed)),
        ("two features swapped", rebuilt(swapped)),
    ];

    // A layer with one input or one output is its own transpose.
    if let Some(index) = mlp.layers().iter().position(|l| l.inputs() > 1 && l.outputs() > 1) {
        let mut transposed = mlp.layers().to_vec();
        let (inputs, outputs) = (transposed[index].inputs(), transposed[index].outputs());
        for i in 0..inputs {
            for o in 0..outputs {
                transposed[index].weights[i * outputs + o] = mlp.layers()[index].weights[o * inputs + i];
            }
        }
        controls.push(("a layer transposed", rebuilt(transposed)));
    }
    controls
}

/// What exports are held to: a network, or what is left of it where its exports say that units were taken out.
struct Subject<'a> {
    pruned: Option<Pruned>,
    /// The network that stands in the export.
    network: Mlp,
    reference: Reference,
    on_gpu: OnceCell<Result<OnGpu, String>>,
    whole: &'a Mlp,
    options: CheckOptions,
}

impl<'a> Subject<'a> {
    fn new(whole: &'a Mlp, pruned: Option<Pruned>, options: CheckOptions) -> Result<Self, String> {
        let network = match &pruned {
            None => whole.clone(),
            Some(pruned) => {
                without_units(whole, &pruned.units).map_err(|e| format!("it was taken out of another network: {e}"))?
            }
        };
        let left = pruned.as_ref().map(|pruned| (&network, pruned));
        let reference = Reference::new(whole, left, options.rows, options.extreme_rows)?;
        Ok(Self {
            pruned,
            network,
            reference,
            on_gpu: OnceCell::new(),
            whole,
            options,
        })
    }

    /// A GPU is quick, and gets more rows; they are made when the first export asks for them.
    fn on_gpu(&self) -> &Result<OnGpu, String> {
        self.on_gpu.get_or_init(|| {
            let gpu = Gpu::shared().map_err(|why| why.to_string())?;
            let left = self.pruned.as_ref().map(|pruned| (&self.network, pruned));
            Ok(OnGpu {
                gpu,
                reference: Reference::new(self.whole, left, self.options.gpu_rows, self.options.gpu_rows / 10),
            })
        })
    }

    /// Runs source on the GPU; a visible skip where there is none, or where it lacks f16.
    fn run_on_gpu(&self, format: Format, source: compute::Source<'_>, function: &str) -> Finding {
        const TOOL: &str = "gpu";
        const QUESTION: &str = "computes the reference";
        let on_gpu = match self.on_gpu() {
            Ok(on_gpu) => on_gpu,
            Err(why) => return Finding::skipped(format, TOOL, QUESTION, why.clone()),
        };
        let gpu = on_gpu.gpu;
        if format.precision() == Precision::F16 && !gpu.has_f16() {
            return Finding::skipped(format, TOOL, QUESTION, format!("{} has no f16 in shaders", gpu.name()));
        }
        let width = self.network.feature_set().width();
        match &on_gpu.reference {
            Err(why) => Finding::new(format, TOOL, QUESTION, Err(why.clone())),
            Ok(reference) => reference.compare(format, TOOL, |rows| {
                compute::run_rows(gpu, source, function, rows, width).map_err(|e| format!("{}: {e}", gpu.name()))
            }),
        }
    }
}

/// A device, and what an export must compute there.
struct OnGpu {
    gpu: &'static Gpu,
    reference: Result<Reference, String>,
}

/// Shader source with the names that an export without a prefix has.
fn without_prefix(format: Format, bytes: Vec<u8>) -> Vec<u8> {
    if format.target().comment().is_none() {
        return bytes;
    }
    let text = std::str::from_utf8(&bytes).ok();
    match text.and_then(|text| Prefix::of_source(text).map(|prefix| prefix.undo(text))) {
        Some(text) => text.into_bytes(),
        None => bytes,
    }
}

/// What an export says was taken out of the network.
fn pruned(format: Format, bytes: &[u8]) -> Result<Option<Pruned>, String> {
    let line = match format.target().reader() {
        Reader::Model => {
            // What is no model file is found further down.
            let mlp = file::from_json(bytes, Path::new("the export"));
            return Ok(mlp.ok().and_then(|mlp| mlp.provenance.pruned));
        }
        Reader::Onnx => {
            let properties = onnx_export::decode(bytes)
                .map(|model| model.metadata_props)
                .unwrap_or_default();
            properties
                .into_iter()
                .find(|p| p.key == onnx_export::PRUNED)
                .map(|p| p.value)
        }
        _ => {
            // SPIR-V has its header in a string of its own.
            let (text, mark) = match format.target().comment() {
                None => (translate::string_of(bytes).unwrap_or_default(), PRUNED.to_owned()),
                Some(comment) => (
                    String::from_utf8_lossy(bytes).into_owned(),
                    format!("{comment} {PRUNED}"),
                ),
            };
            text.lines()
                .find_map(|line| line.strip_prefix(&mark))
                .map(|line| line.trim_end_matches('.').to_owned())
        }
    };
    line.map(|line| Pruned::from_text(&line).map_err(|e| e.to_string()))
        .transpose()
}

/// What to do about an export that is not there: to write it, or to check what is.
fn remedy(mlp: &Mlp, folder: &Path, missing: Format) -> String {
    let name = missing.name();
    let there: Vec<&str> = Format::all()
        .filter(|format| format.path(folder, mlp).is_file())
        .map(Format::name)
        .collect();
    if there.is_empty() {
        return format!(
            "the folder holds no export of '{}'; 'nmt export' writes them",
            mlp.name()
        );
    }
    format!(
        "'nmt export --format {name}' writes it, and 'nmt check --format {}' checks what is there",
        there.join(",")
    )
}

/// Checks every export of a network that stands in a folder; nothing is written.
///
/// A format that is not there is a failed finding that names the file. An export that says that units were taken out
/// must hold what is then left of the network, and is held to the whole network's answers in distribution.
pub fn check(
    mlp: &Mlp,
    folder: &Path,
    formats: &[Format],
    options: CheckOptions,
    progress: &dyn Fn(&'static str),
) -> Vec<Finding> {
    progress("reference");
    let mut subjects: Vec<Subject<'_>> = Vec::new();
    let mut findings = Vec::new();
    for &format in formats {
        progress(format.name());
        let path = format.path(folder, mlp);
        let bytes = match read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let why = format!("{error}; {}", remedy(mlp, folder, format));
                findings.push(Finding::new(format, "nmt", "is there", Err(why)));
                continue;
            }
        };
        let bytes = without_prefix(format, bytes);
        let made = pruned(format, &bytes).and_then(|pruned| match subjects.iter().position(|s| s.pruned == pruned) {
            Some(at) => Ok(at),
            None => Subject::new(mlp, pruned, options).map(|subject| {
                subjects.push(subject);
                subjects.len() - 1
            }),
        });
        let subject = match made {
            Ok(at) => &subjects[at],
            Err(why) => {
                findings.push(Finding::new(format, "nmt", "computes the reference", Err(why)));
                continue;
            }
        };
        match format.target().reader() {
            Reader::Model => check_json(subject, &path, &bytes, &mut findings),
            Reader::Onnx => check_onnx(subject, &bytes, &mut findings),
            Reader::Metal => check_metal(subject, format, &bytes, &mut findings),
            Reader::Spirv => check_spirv(subject, format, &bytes, &mut findings),
            Reader::Hlsl => check_hlsl(subject, format, &bytes, &mut findings),
            Reader::Wgsl | Reader::Glsl => check_shader(subject, format, &bytes, &mut findings),
        }
    }
    findings.extend(core::check_network(mlp, folder, &chain_languages(formats)));
    findings
}

fn check_json(subject: &Subject<'_>, path: &Path, bytes: &[u8], findings: &mut Vec<Finding>) {
    const FORMAT: Format = Format::JSON;
    let mlp = &subject.network;
    match file::from_json(bytes, path) {
        Err(error) => findings.push(Finding::new(FORMAT, "nmt", "parses", Err(error.to_string()))),
        Ok(back) => {
            let bits = |m: &Mlp| -> Vec<u32> {
                m.layers()
                    .iter()
                    .flat_map(|l| l.weights.iter().chain(&l.biases))
                    .map(|w| w.to_bits())
                    .collect()
            };
            let same =
                back.sizes() == mlp.sizes() && back.feature_set() == mlp.feature_set() && bits(&back) == bits(mlp);
            let result = same
                .then_some(())
                .ok_or_else(|| "its weights are not the network's".to_owned());
            findings.push(Finding::new(FORMAT, "nmt", "weights bit for bit", result));
            findings.push(subject.reference.compare(FORMAT, "nmt", |rows| {
                if back.feature_set() == mlp.feature_set() {
                    Ok(back.forward_batch::<f32>(rows))
                } else {
                    Err("it has another feature set".to_owned())
                }
            }));
        }
    }
}

/// Compares the weights that were read with those of the network that should stand there.
fn weights(subject: &Subject<'_>, format: Format, constants: Result<shader::Constants, String>) -> Result<(), String> {
    shader::weights(format, &constants?, &subject.network)
}

/// The text of a shader export, or a finding that it is none.
fn text_of<'a>(format: Format, tool: &'static str, bytes: &'a [u8], findings: &mut Vec<Finding>) -> Option<&'a str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Some(text),
        Err(error) => {
            findings.push(Finding::new(
                format,
                tool,
                "parses and validates",
                Err(error.to_string()),
            ));
            None
        }
    }
}

/// What glslangValidator says.
fn by_glslang(format: Format, result: Option<Result<(), String>>) -> Finding {
    const TOOL: &str = "glslangValidator";
    match result {
        Some(result) => Finding::new(format, TOOL, "compiles", result),
        None => Finding::skipped(
            format,
            TOOL,
            "compiles",
            "not installed (Debian: glslang-tools)".to_owned(),
        ),
    }
}

fn check_shader(subject: &Subject<'_>, format: Format, bytes: &[u8], findings: &mut Vec<Finding>) {
    let Some(text) = text_of(format, "naga", bytes, findings) else {
        return;
    };
    let module = match shader::parse(format, text) {
        Ok(module) => module,
        Err(why) => return findings.push(Finding::new(format, "naga", "parses and validates", Err(why))),
    };
    let glsl = format.target().reader() == Reader::Glsl;
    findings.push(Finding::new(format, "naga", "parses and validates", Ok(())));
    if glsl {
        findings.push(by_glslang(format, shader::glslang(text)));
    }
    findings.push(Finding::new(
        format,
        "naga",
        "weights bit for bit",
        weights(subject, format, shader::constants(&module)),
    ));
    findings.push(Finding::new(
        format,
        "naga",
        "literal indices only",
        shader::literal_indices(&module),
    ));
    let interpreter = Interpreter::new(&module);
    let width = subject.network.feature_set().width();
    findings.push(subject.reference.compare(format, "interpreter", |rows| {
        interpreter.call_rows(ENTRY, rows, width).map_err(|e| e.to_string())
    }));
    findings.push(subject.run_on_gpu(
        format,
        if glsl {
            compute::Source::Glsl(text)
        } else {
            compute::Source::Wgsl(text)
        },
        ENTRY,
    ));
}

fn check_hlsl(subject: &Subject<'_>, format: Format, bytes: &[u8], findings: &mut Vec<Finding>) {
    const SLANGC: &str = "slangc";
    const QUESTION: &str = "computes the reference";
    let Some(text) = text_of(format, "nmt", bytes, findings) else {
        return;
    };
    findings.push(Finding::new(
        format,
        "nmt",
        "weights bit for bit",
        weights(subject, format, hlsl::constants(text)),
    ));
    findings.push(Finding::new(
        format,
        "nmt",
        "literal indices only",
        hlsl::literal_indices(text),
    ));
    let width = subject.network.feature_set().width();
    let whole = hlsl::with_rows(text, width);
    findings.push(by_glslang(format, hlsl::glslang(&whole)));
    let slangc = match hlsl::slangc() {
        Ok(slangc) => slangc,
        Err(why) => {
            findings.push(Finding::skipped(format, SLANGC, "compiles", why.clone()));
            return findings.push(Finding::skipped(
                format,
                SLANGC,
                QUESTION,
                format!("on the CPU and on a GPU: {why}"),
            ));
        }
    };
    let wgsl = match hlsl::to_wgsl(&slangc, &whole, hlsl::ROWS) {
        Ok(wgsl) => wgsl,
        Err(why) => return findings.push(Finding::new(format, SLANGC, "compiles", Err(why))),
    };
    findings.push(Finding::new(format, SLANGC, "compiles", Ok(())));
    // What slangc made is run as WGSL is: by the interpreter, and on the GPU.
    let module = match translate::parse_wgsl(&wgsl) {
        Ok((module, _)) => module,
        Err(why) => {
            return findings.push(Finding::new(
                format,
                SLANGC,
                QUESTION,
                Err(format!("naga does not read slangc's WGSL: {why}")),
            ));
        }
    };
    let interpreter = Interpreter::new(&module);
    let function = match interpreter.function_like(ENTRY) {
        Ok(function) => function,
        Err(why) => return findings.push(Finding::new(format, SLANGC, QUESTION, Err(why.to_string()))),
    };
    findings.push(subject.reference.compare(format, SLANGC, |rows| {
        interpreter.call_rows(function, rows, width).map_err(|e| e.to_string())
    }));
    findings.push(subject.run_on_gpu(format, compute::Source::Wgsl(&wgsl), function));
}

fn check_metal(subject: &Subject<'_>, format: Format, bytes: &[u8], findings: &mut Vec<Finding>) {
    let Some(text) = text_of(format, "nmt", bytes, findings) else {
        return;
    };
    let constants = translated::metal_constants(text);
    let used = constants.clone().and_then(|constants| {
        translated::metal_uses(
            text,
            &constants,
            network_function(subject.reference.network.feature_set()),
        )
    });
    findings.push(Finding::new(
        format,
        "nmt",
        "weights bit for bit",
        weights(subject, format, constants),
    ));
    findings.push(Finding::new(format, "nmt", "weights are used as they stand", used));
    let why =
        "Apple's compiler alone could tell; naga validated the module that it wrote this text of, and the WGSL of the \
            same network runs"
            .to_owned();
    findings.push(Finding::skipped(
        format,
        "metal",
        "compiles and computes the reference",
        why,
    ));
}

fn check_spirv(subject: &Subject<'_>, format: Format, bytes: &[u8], findings: &mut Vec<Finding>) {
    const TOOL: &str = "spirv-val";
    findings.push(Finding::new(
        format,
        "nmt",
        "weights bit for bit",
        weights(subject, format, translated::spirv_constants(bytes)),
    ));
    findings.push(match translated::spirv_val(bytes) {
        Some(result) => Finding::new(format, TOOL, "is valid", result),
        None => Finding::skipped(
            format,
            TOOL,
            "is valid",
            "not installed (Debian: spirv-tools)".to_owned(),
        ),
    });
    let why = "WebGPU takes no SPIR-V; naga validated the module that it wrote this of, and the WGSL of the same \
        network runs"
        .to_owned();
    findings.push(Finding::skipped(format, "vulkan", "computes the reference", why));
}

fn check_onnx(subject: &Subject<'_>, bytes: &[u8], findings: &mut Vec<Finding>) {
    const FORMAT: Format = Format::ONNX;
    let width = subject.network.feature_set().width();
    findings.push(Finding::new(
        FORMAT,
        "nmt",
        "weights bit for bit",
        onnx::weights(bytes, &subject.network),
    ));
    findings.push(
        subject
            .reference
            .compare(FORMAT, "interpreter", |rows| graph::run(bytes, rows, width)),
    );
    #[cfg(feature = "rten")]
    findings.push(
        subject
            .reference
            .compare(FORMAT, "rten", |rows| onnx::rten(bytes, rows, width)),
    );
    findings.push(match onnx::library() {
        Ok(library) => subject.reference.compare(FORMAT, "onnxruntime", |rows| {
            onnx::onnxruntime(&library, bytes, rows, width)
        }),
        Err(why) => Finding::skipped(FORMAT, "onnxruntime", "computes the reference", why),
    });
}

/// Turns skips of required tools into failures.
pub fn require(findings: &mut [Finding], tools: &[String]) {
    for finding in findings {
        if let Status::Skipped(why) = &finding.status
            && tools.iter().any(|t| t == finding.tool)
        {
            finding.status = Status::Failed(format!("required, but {why}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export;
    use crate::model::mlp::tests::random_mlp;
    use crate::numeric::file::Replace;

    const FEW: CheckOptions = CheckOptions {
        rows: 2000,
        extreme_rows: 500,
        gpu_rows: 4000,
    };

    fn all() -> Vec<Format> {
        Format::all().collect()
    }

    fn failures(findings: &[Finding]) -> Vec<String> {
        let failed = findings.iter().filter_map(|f| match &f.status {
            Status::Failed(why) => Some(format!("{} {}: {why}", f.format.name(), f.tool)),
            _ => None,
        });
        failed.collect()
    }

    fn exported(mlp: &Mlp) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        export::write(mlp, folder.path(), &all(), None, Replace::No).unwrap();
        folder
    }

    #[test]
    fn fresh_exports_pass_and_another_networks_do_not() {
        let mlp = random_mlp(&[10, 8], 1);
        let folder = exported(&mlp);
        let findings = check(&mlp, folder.path(), &all(), FEW, &|_| {});
        assert_eq!(failures(&findings), Vec::<String>::new());
        assert!(findings.iter().filter(|f| !f.numbers.is_empty()).count() >= 8);
        // The control: exports of a network that differs in one weight only.
        let mut layers = mlp.layers().to_vec();
        layers[1].weights[3] += 0.25;
        let other = Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone()).unwrap();
        // Under a prefix the exports are the same to the check, which still sees the other network.
        let prefix = "glass".parse().unwrap();
        let glass = tempfile::tempdir().unwrap();
        export::write(&mlp, glass.path(), &all(), Some(&prefix), Replace::No).unwrap();
        let text = std::fs::read_to_string(glass.path().join("random.wgsl")).unwrap();
        assert!(text.contains("fn glass_transmittance(") && !text.contains("fn nmt_"));
        let findings = check(&mlp, glass.path(), &all(), FEW, &|_| {});
        assert_eq!(failures(&findings), Vec::<String>::new());
        assert!(!failures(&check(&other, glass.path(), &[Format::METAL], FEW, &|_| {})).is_empty());
        let failed = failures(&check(&other, folder.path(), &all(), FEW, &|_| {}));
        for format in all() {
            let of_format = failed
                .iter()
                .filter(|f| f.starts_with(&format!("{} ", format.name())))
                .count();
            // What nothing runs has its weights only, and f16 has no eye for so little.
            let reader = format.target().reader();
            let runs = !matches!(reader, Reader::Metal | Reader::Spirv) && format.precision() == Precision::F32;
            let runs = runs && (reader != Reader::Hlsl || hlsl::slangc().is_ok());
            assert!(of_format >= if runs { 2 } else { 1 }, "{}: {failed:#?}", format.name());
        }
    }

    /// Exports without silent units hold against the whole network, whatever their format. Controls: a unit taken out
    /// that fires, and a header that names another.
    #[test]
    fn pruned_exports_are_held_to_the_whole_network() {
        let mut layers = random_mlp(&[12, 9], 1).layers().to_vec();
        for (layer, unit) in [(0, 2), (0, 7), (1, 5)] {
            layers[layer].biases[unit] = -1e3;
        }
        let whole = Mlp::new("random", FeatureSet::Paper, layers, Default::default()).unwrap();
        let rows = rows::sampled(&whole, 5000, 77).unwrap();
        let left = crate::model::simplify::pruned(&whole, &rows).unwrap();
        assert!(left.multiply_adds() < whole.multiply_adds());
        let folder = exported(&left);
        let findings = check(&whole, folder.path(), &all(), FEW, &|_| {});
        assert_eq!(failures(&findings), Vec::<String>::new());
        let notes: Vec<&String> = findings.iter().filter_map(|f| f.note.as_ref()).collect();
        assert!(
            notes.len() >= 8
                && notes
                    .iter()
                    .all(|n| n.contains("would fire on 0 of 2000 rows (in distribution)")
                        || n.contains("would fire on 0 of 4000 rows (in distribution)")),
            "{notes:?}"
        );

        let active = (0..12)
            .find(|u| !left.provenance.pruned.as_ref().unwrap().units[0].contains(u))
            .unwrap();
        let units = vec![vec![active], vec![]];
        let mut wrong = without_units(&whole, &units).unwrap();
        wrong.provenance.pruned = Some(Pruned {
            units,
            rows: 5000,
            of_multiply_adds: whole.multiply_adds(),
        });
        let failed = failures(&check(
            &whole,
            exported(&wrong).path(),
            &[Format::WGSL, Format::ONNX, Format::JSON],
            FEW,
            &|_| {},
        ));
        assert!(
            ["wgsl interpreter", "onnx interpreter", "json nmt"]
                .iter()
                .all(|start| failed.iter().any(|f| f.starts_with(start))),
            "{failed:#?}"
        );

        let path = folder.path().join("random.wgsl");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(
            &path,
            text.replace("layer 1 without ", &format!("layer 1 without {active}, ")),
        )
        .unwrap();
        let failed = failures(&check(&whole, folder.path(), &[Format::WGSL], FEW, &|_| {}));
        assert!(failed.iter().any(|f| f.contains("NMT_W1")), "{failed:#?}");
        std::fs::write(&path, text.replace("layer 1 without ", "layer 9 without 1, ")).unwrap();
        let failed = failures(&check(&whole, folder.path(), &[Format::WGSL], FEW, &|_| {}));
        assert!(failed.iter().any(|f| f.contains("another network")), "{failed:#?}");
    }

    #[test]
    fn missing_and_damaged_files_are_named() {
        let mlp = random_mlp(&[4], 1);
        let folder = exported(&mlp);
        std::fs::remove_file(folder.path().join("random.onnx")).unwrap();
        std::fs::write(folder.path().join("random.wgsl"), [0xff, 0xfe]).unwrap();
        std::fs::write(folder.path().join("random.json"), "{").unwrap();
        let failed = failures(&check(&mlp, folder.path(), &Format::DEFAULT, FEW, &|_| {}));
        assert_eq!(failed.len(), 3, "{failed:#?}");
        assert!(
            failed
                .iter()
                .any(|f| f.contains("random.onnx") && f.contains("nmt export"))
        );
    }

    #[test]
    fn required_tools_may_not_be_skipped() {
        let mut findings = vec![Finding::skipped(
            Format::ONNX,
            "onnxruntime",
            "computes the reference",
            "not found".to_owned(),
        )];
        require(&mut findings, &["gpu".to_owned()]);
        assert!(matches!(findings[0].status, Status::Skipped(_)));
        require(&mut findings, &["onnxruntime".to_owned()]);
        assert!(matches!(findings[0].status, Status::Failed(_)));
    }

    /// A network that ignores its features cannot be told from one with two features swapped: the check must say so.
    #[test]
    fn a_blind_check_reports_itself() {
        let layers = vec![Dense::new(7, 1, vec![0.0; 7], vec![0.5]).unwrap()];
        let mlp = Mlp::new("random", crate::features::FeatureSet::Paper, layers, Default::default()).unwrap();
        let failed = failures(&check(&mlp, exported(&mlp).path(), &[Format::JSON], FEW, &|_| {}));
        assert!(failed.iter().any(|f| f.contains("blind")), "{failed:?}");
    }
}
