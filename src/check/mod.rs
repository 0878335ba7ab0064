//! Exports held against the network: what stands in a folder is read, parsed, compared bit for bit and executed.
//!
//! Every comparison comes with controls that must fail: a network with one perturbed weight, one with two features swapped and one with a
//! transposed layer must not pass in the network's place. Where a control passes, the check reports itself as failed.

pub mod half;
pub mod hlsl;
pub mod interpret;
pub mod onnx;
pub mod rows;
pub mod shader;

use crate::export::Format;
use crate::features::FeatureSet;
use crate::gpu::{Gpu, compute};
use crate::model::{Dense, Mlp, file};
use crate::numeric::file::read;
use crate::numeric::tolerance::AbsoluteError;
use interpret::Interpreter;
use rows::{CheckRows, RowKind};
use std::cell::LazyCell;
use std::path::Path;

/// Greatest absolute error in distribution: raw features of the `paper` set reach logits of 20, where f32 sums lose this much; features of the recentred sets are of
/// the order of 1.
pub fn bar_in_distribution(set: FeatureSet) -> f64 {
    match set {
        FeatureSet::Paper | FeatureSet::DeepWeightedBlended => 3e-5,
        FeatureSet::Recentred | FeatureSet::Recentred6 | FeatureSet::Recentred8 => 5e-6,
    }
}

/// An export may be this many times as far from f64 as our own f32 forward pass is on the same rows.
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
        Self { rows: 100_000, extreme_rows: 20_000, gpu_rows: 1_000_000 }
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
    /// Error of our f32 forward pass on the same rows.
    pub reference: AbsoluteError,
    /// Greatest absolute error that passes.
    pub bar: f64,
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
}

impl Finding {
    fn new(format: Format, tool: &'static str, question: &'static str, result: Result<(), String>) -> Self {
        let status = match result {
            Ok(()) => Status::Passed,
            Err(why) => Status::Failed(why),
        };
        Self { format, tool, question, status, numbers: Vec::new() }
    }

    fn skipped(format: Format, tool: &'static str, question: &'static str, why: String) -> Self {
        Self { format, tool, question, status: Status::Skipped(why), numbers: Vec::new() }
    }

    /// Greatest absolute error in distribution, where one was measured.
    pub fn worst_in_distribution(&self) -> Option<f64> {
        self.numbers.iter().find(|n| n.kind == RowKind::InDistribution).map(|n| n.export.worst())
    }
}

/// Names of tools that need not be there and that `--require` makes a condition.
pub const OPTIONAL_TOOLS: [&str; 3] = ["onnxruntime", "glslangValidator", "gpu"];

/// What the rows should give, and what they must not.
struct Reference {
    rows: Vec<CheckRows>,
    /// For each kind of rows.
    answers: Vec<Answers>,
    /// Greatest absolute error in distribution.
    bar_in_distribution: f64,
}

/// Answers to rows of one kind.
struct Answers {
    /// Of the f64 forward pass.
    exact: Vec<f64>,
    /// Error of our f32 passes, of the one that is further off.
    ours: AbsoluteError,
    /// Of the controls, in f64.
    controls: Vec<(&'static str, Vec<f64>)>,
}

impl Reference {
    fn new(mlp: &Mlp, in_distribution: usize, extreme: usize) -> Result<Self, String> {
        let rows = vec![rows::in_distribution(mlp, in_distribution)?, rows::extreme(mlp.feature_set().width(), extreme)];
        let controls = controls(mlp);
        let answers = rows
            .iter()
            .map(|rows| {
                let exact = mlp.forward_batch::<f64>(&rows.features);
                // Two f32 passes of ours, with and without fused multiply-adds: the one that is further off says what f32 costs.
                let passes = [mlp.forward_batch::<f32>(&rows.features), mlp.predict(&rows.features)];
                let [plain, fused] = passes.map(|pass| AbsoluteError::of(&widen(&pass), &exact));
                let ours = if fused.worst() > plain.worst() { fused } else { plain };
                let controls = controls.iter().map(|(name, mlp)| (*name, mlp.forward_batch::<f64>(&rows.features))).collect();
                Answers { exact, ours, controls }
            })
            .collect();
        Ok(Self { rows, answers, bar_in_distribution: bar_in_distribution(mlp.feature_set()) })
    }

    /// Runs an export on all rows and compares.
    fn compare(&self, format: Format, tool: &'static str, run: impl Fn(&[f32]) -> Result<Vec<f32>, String>) -> Finding {
        let mut numbers = Vec::new();
        let mut problems = Vec::new();
        for (rows, Answers { exact, ours, controls }) in self.rows.iter().zip(&self.answers) {
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
            let export = AbsoluteError::of(&out, exact);
            let mut bar = BAR_FACTOR * ours.worst().max(ROUNDING);
            if rows.kind == RowKind::InDistribution {
                // Another order of summation is no error, even where our own orders happen to agree well.
                bar = bar.max(0.5 * self.bar_in_distribution).min(self.bar_in_distribution);
            }
            if !export.within(bar) {
                problems.push(format!(
                    "{}: worst error {:.2e} against f64, {} non-finite; at most {bar:.2e} is allowed (our own f32: {:.2e})",
                    rows.kind.name(),
                    export.worst(),
                    export.nonfinite(),
                    ours.worst()
                ));
            }
            if out.iter().any(|t| !(0.0..=1.0).contains(t)) {
                problems.push(format!("{}: an answer lies outside [0, 1]", rows.kind.name()));
            }
            if rows.kind == RowKind::InDistribution {
                let passed = controls.iter().filter(|(_, control)| AbsoluteError::of(&out, control).within(bar)).map(|(name, _)| *name);
                problems.extend(passed.map(|name| format!("the check is blind: a network with {name} would have passed too")));
            }
            numbers.push(Numbers { kind: rows.kind, export, reference: *ours, bar });
        }
        let result = if problems.is_empty() { Ok(()) } else { Err(problems.join("; ")) };
        Finding { numbers, ..Finding::new(format, tool, "computes the reference", result) }
    }
}

fn widen(values: &[f32]) -> Vec<f64> {
    values.iter().map(|&v| v.into()).collect()
}

/// Networks that must not pass in another's place.
fn controls(mlp: &Mlp) -> Vec<(&'static str, Mlp)> {
    let rebuilt = |layers: Vec<Dense>| Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone()).expect("shapes are unchanged");
    let mut perturbed = mlp.layers().to_vec();
    let last = perturbed.last_mut().expect("at least one layer");
    let greatest = (0..last.weights.len()).max_by(|&a, &b| last.weights[a].abs().total_cmp(&last.weights[b].abs())).unwrap_or(0);
    last.weights[greatest] += 1.0 / 64.0;
    last.biases[0] += 1.0 / 64.0;

    // The two features that the first layer treats most differently.
    let first = &mlp.layers()[0];
    let difference = |i: usize, j: usize| -> f32 { (0..first.outputs()).map(|o| (first.weight(i, o) - first.weight(j, o)).abs()).sum() };
    let pairs = (0..first.inputs()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let (i, j) = pairs.max_by(|&a, &b| difference(a.0, a.1).total_cmp(&difference(b.0, b.1))).unwrap_or((0, 0));
    let mut swapped = mlp.layers().to_vec();
    let outputs = first.outputs();
    for o in 0..outputs {
        swapped[0].weights.swap(i * outputs + o, j * outputs + o);
    }
    let mut controls = vec![("one weight perturbed", rebuilt(perturbed)), ("two features swapped", rebuilt(swapped))];

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

/// Checks every export of a network that stands in a folder; nothing is written.
///
/// A format that is not there is a failed finding that names the file.
pub fn check(mlp: &Mlp, folder: &Path, formats: &[Format], options: CheckOptions, progress: &dyn Fn(&'static str)) -> Vec<Finding> {
    progress("reference");
    let reference = match Reference::new(mlp, options.rows, options.extreme_rows) {
        Ok(reference) => reference,
        Err(why) => return formats.iter().map(|&f| Finding::new(f, "nmt", "computes the reference", Err(why.clone()))).collect(),
    };
    // A GPU is quick, and gets more rows; they are made when the first export asks for them.
    let on_gpu: LazyGpu<'_> = LazyCell::new(Box::new(|| {
        let gpu = Gpu::shared().map_err(|why| why.to_string())?;
        Ok(OnGpu { gpu, reference: Reference::new(mlp, options.gpu_rows, options.gpu_rows / 10) })
    }));
    let mut findings = Vec::new();
    for &format in formats {
        progress(format.name());
        let path = format.path(folder, mlp);
        let bytes = match read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                findings.push(Finding::new(format, "nmt", "is there", Err(format!("{error}; 'nmt export' writes it"))));
                continue;
            }
        };
        match format {
            Format::Json => check_json(mlp, &path, &bytes, &reference, &mut findings),
            Format::Onnx => check_onnx(mlp, &bytes, &reference, &mut findings),
            _ => check_shader(mlp, format, &bytes, &reference, &on_gpu, &mut findings),
        }
    }
    findings
}

fn check_json(mlp: &Mlp, path: &Path, bytes: &[u8], reference: &Reference, findings: &mut Vec<Finding>) {
    const FORMAT: Format = Format::Json;
    match file::from_json(bytes, path) {
        Err(error) => findings.push(Finding::new(FORMAT, "nmt", "parses", Err(error.to_string()))),
        Ok(back) => {
            let bits = |m: &Mlp| -> Vec<u32> { m.layers().iter().flat_map(|l| l.weights.iter().chain(&l.biases)).map(|w| w.to_bits()).collect() };
            let same = back.sizes() == mlp.sizes() && back.feature_set() == mlp.feature_set() && bits(&back) == bits(mlp);
            let result = same.then_some(()).ok_or_else(|| "its weights are not the network's".to_owned());
            findings.push(Finding::new(FORMAT, "nmt", "weights bit for bit", result));
            findings.push(reference.compare(FORMAT, "nmt", |rows| {
                if back.feature_set() == mlp.feature_set() {
                    Ok(back.forward_batch::<f32>(rows))
                } else {
                    Err("it has another feature set".to_owned())
                }
            }));
        }
    }
}

/// A device, and what an export must compute there.
struct OnGpu {
    gpu: &'static Gpu,
    reference: Result<Reference, String>,
}

impl OnGpu {
    fn compare(&self, format: Format, text: &str, width: usize) -> Finding {
        const TOOL: &str = "gpu";
        let source = match format {
            Format::Glsl | Format::GlslPlain => compute::Source::Glsl(text),
            _ => compute::Source::Wgsl(text),
        };
        match &self.reference {
            Err(why) => Finding::new(format, TOOL, "computes the reference", Err(why.clone())),
            Ok(reference) => reference.compare(format, TOOL, |rows| {
                compute::run_rows(self.gpu, source, crate::export::shader::ENTRY, rows, width).map_err(|e| format!("{}: {e}", self.gpu.name()))
            }),
        }
    }
}

/// Made when the first export asks for it; why not, where there is no adapter.
type LazyGpu<'a> = LazyCell<Result<OnGpu, String>, Box<dyn FnOnce() -> Result<OnGpu, String> + 'a>>;

fn check_shader(mlp: &Mlp, format: Format, bytes: &[u8], reference: &Reference, on_gpu: &LazyGpu<'_>, findings: &mut Vec<Finding>) {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => return findings.push(Finding::new(format, "naga", "parses and validates", Err(error.to_string()))),
    };
    let module = match shader::parse(format, text) {
        Ok(module) => module,
        Err(why) => return findings.push(Finding::new(format, "naga", "parses and validates", Err(why))),
    };
    findings.push(Finding::new(format, "naga", "parses and validates", Ok(())));
    if matches!(format, Format::Glsl | Format::GlslPlain) {
        const TOOL: &str = "glslangValidator";
        findings.push(match shader::glslang(text) {
            Some(result) => Finding::new(format, TOOL, "compiles", result),
            None => Finding::skipped(format, TOOL, "compiles", "not installed (Debian: glslang-tools)".to_owned()),
        });
    }
    findings.push(Finding::new(
        format,
        "naga",
        "weights bit for bit",
        shader::constants(&module).and_then(|c| shader::weights(format.kind().expect("a shader"), &c, mlp)),
    ));
    findings.push(Finding::new(format, "naga", "literal indices only", shader::literal_indices(&module)));
    let interpreter = Interpreter::new(&module);
    let width = mlp.feature_set().width();
    findings.push(
        reference.compare(format, "interpreter", |rows| interpreter.call_rows(crate::export::shader::ENTRY, rows, width).map_err(|e| e.to_string())),
    );
    findings.push(match &**on_gpu {
        Ok(on_gpu) => on_gpu.compare(format, text, width),
        Err(why) => Finding::skipped(format, "gpu", "computes the reference", why.clone()),
    });
}

fn check_onnx(mlp: &Mlp, bytes: &[u8], reference: &Reference, findings: &mut Vec<Finding>) {
    const FORMAT: Format = Format::Onnx;
    let width = mlp.feature_set().width();
    findings.push(Finding::new(FORMAT, "nmt", "weights bit for bit", onnx::weights(bytes, mlp)));
    findings.push(reference.compare(FORMAT, "rten", |rows| onnx::rten(bytes, rows, width)));
    findings.push(match onnx::library() {
        Ok(library) => reference.compare(FORMAT, "onnxruntime", |rows| onnx::onnxruntime(&library, bytes, rows, width)),
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

    const FEW: CheckOptions = CheckOptions { rows: 2000, extreme_rows: 500, gpu_rows: 4000 };

    fn failures(findings: &[Finding]) -> Vec<String> {
        let failed = findings.iter().filter_map(|f| match &f.status {
            Status::Failed(why) => Some(format!("{} {}: {why}", f.format.name(), f.tool)),
            _ => None,
        });
        failed.collect()
    }

    fn exported(mlp: &Mlp) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        export::write(mlp, folder.path(), &Format::ALL, Replace::No).unwrap();
        folder
    }

    #[test]
    fn fresh_exports_pass_and_another_networks_do_not() {
        let mlp = random_mlp(&[32, 16], 1);
        let folder = exported(&mlp);
        let findings = check(&mlp, folder.path(), &Format::ALL, FEW, &|_| {});
        assert_eq!(failures(&findings), Vec::<String>::new());
        assert!(findings.iter().filter(|f| !f.numbers.is_empty()).count() >= 6);
        // The control: exports of a network that differs in one weight only.
        let mut layers = mlp.layers().to_vec();
        layers[1].weights[3] += 0.25;
        let other = Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone()).unwrap();
        let failed = failures(&check(&other, folder.path(), &Format::ALL, FEW, &|_| {}));
        for format in Format::ALL {
            let of_format = failed.iter().filter(|f| f.starts_with(&format!("{} ", format.name()))).count();
            assert!(of_format >= 2, "{}: {failed:#?}", format.name());
        }
    }

    #[test]
    fn missing_and_damaged_files_are_named() {
        let mlp = random_mlp(&[4], 1);
        let folder = exported(&mlp);
        std::fs::remove_file(folder.path().join("random.onnx")).unwrap();
        std::fs::write(folder.path().join("random.wgsl"), [0xff, 0xfe]).unwrap();
        std::fs::write(folder.path().join("random.json"), "{").unwrap();
        let failed = failures(&check(&mlp, folder.path(), &Format::ALL, FEW, &|_| {}));
        assert_eq!(failed.len(), 3, "{failed:#?}");
        assert!(failed.iter().any(|f| f.contains("random.onnx") && f.contains("nmt export")));
    }

    #[test]
    fn required_tools_may_not_be_skipped() {
        let mut findings = vec![Finding::skipped(Format::Onnx, "onnxruntime", "computes the reference", "not found".to_owned())];
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
        let failed = failures(&check(&mlp, exported(&mlp).path(), &[Format::Json], FEW, &|_| {}));
        assert!(failed.iter().any(|f| f.contains("blind")), "{failed:?}");
    }
}
