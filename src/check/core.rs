//! Exports of a core, whose tail is a beta law or a network's: what stands in a folder is read, compiled, and executed
//! beside the formulas.

use super::interpret::{Interpreter, Value};
use super::{Finding, hlsl, pruned, rows::RowKind, without_prefix};
use crate::check::Numbers;
use crate::export::core::weigh::{Entry, weigh_by_law, weigh_by_mlp};
use crate::export::core::{CoreBinding, LANGUAGES, calls_of_passes, chain_name, codes, file_name, keep, vectors};
use crate::export::{Format, Target};
use crate::features::core::CoreSet;
use crate::model::Mlp;
use crate::model::simplify::without_units;
use crate::numeric::file::read;
use crate::numeric::rng::stream;
use crate::numeric::tolerance::AbsoluteError;
use rand::RngExt;
use std::path::Path;
use std::process::Command;

/// Greatest error of T: what f32 makes of sums that a core of opaque fragments is taken out of.
const BAR: f64 = 1e-4;

/// Pixels that are drawn.
const PIXELS: usize = 400;

/// What a random pixel gives to pass 2, and the answer.
struct Row {
    own: Entry<f32>,
    core: Vec<Entry<f32>>,
    n: f32,
    b: [f32; 5],
    expected: f32,
}

/// Whose files are checked.
#[derive(Clone, Copy)]
enum Subject<'a> {
    Law(CoreSet),
    Network(CoreSet, &'a Mlp),
}

impl Subject<'_> {
    fn set(self) -> CoreSet {
        let (Self::Law(set) | Self::Network(set, _)) = self;
        set
    }

    fn file_name(self, language: Target) -> String {
        match self {
            Self::Law(set) => file_name(set, language),
            Self::Network(_, mlp) => chain_name(mlp, language),
        }
    }

    fn weigh<const N: usize>(self, own: Entry<f32>, core: &[Entry<f32>], n: f32, b: [f32; N]) -> f32 {
        let bits = self.set().layout.depth_bits;
        match self {
            Self::Law(_) => weigh_by_law(own, core, n, b, bits),
            Self::Network(_, mlp) => weigh_by_mlp(own, core, n, b, bits, mlp),
        }
    }

    /// The file with another constant: the slope of the normal law's log-odds, or the network's last bias.
    fn control(self, text: &str) -> String {
        match self {
            Self::Law(_) => text.replace("1.5976", "1.2"),
            Self::Network(..) => text.replace("min(-logit, 80.0)", "min(0.5 - logit, 80.0)"),
        }
    }
}

/// Fragments of random pixels, the core the nearest, the farthest and the next ones.
fn rows(subject: Subject<'_>) -> Vec<Row> {
    let set = subject.set();
    let mut rng = stream(17, 0x0063_6f72, 0);
    let mut rows = Vec::new();
    for _ in 0..PIXELS {
        let n = rng.random_range(1..=set.slots() + 8);
        let mut fragments: Vec<Entry<f32>> = (0..n)
            .map(|_| Entry {
                z: (2 * rng.random_range(0..=65_535u32) + 1) as f32 / 65_536.0 - 1.0,
                absorbance: 0.01 * 500f32.powf(rng.random_range(0.0..1.0)),
            })
            .collect();
        fragments.sort_by(|a, b| a.z.total_cmp(&b.z));
        fragments[1..].rotate_right(usize::from(n > 1));
        let mut b = [0.0; 5];
        for f in &fragments {
            let mut term = f.absorbance;
            for b in &mut b {
                *b += term;
                term *= f.z;
            }
        }
        let empty = Entry {
            z: 0.0,
            absorbance: 0.0,
        };
        let core: Vec<_> = (0..set.slots())
            .map(|i| fragments.get(i).copied().unwrap_or(empty))
            .collect();
        for &own in &fragments {
            let n = n as f32;
            let expected = match set.moments {
                1 => subject.weigh(own, &core, n, [b[0], b[1]]),
                2 => subject.weigh(own, &core, n, [b[0], b[1], b[2]]),
                3 => subject.weigh(own, &core, n, [b[0], b[1], b[2], b[3]]),
                _ => subject.weigh(own, &core, n, b),
            };
            let core = core.clone();
            rows.push(Row {
                own,
                core,
                n,
                b,
                expected,
            });
        }
    }
    rows
}

/// Error of `nmt_core_weigh` in WGSL, executed.
fn error_of(wgsl: &str, set: CoreSet, rows: &[Row]) -> Result<AbsoluteError, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| e.emit_to_string(wgsl))?;
    let interpreter = Interpreter::new(&module);
    let name = interpreter.function_like("nmt_core_weigh").map_err(|e| e.to_string())?;
    let mut error = AbsoluteError::default();
    for row in rows {
        let mut arguments = vec![Value::<1>::Uniform(row.own.z), Value::Uniform(row.own.absorbance)];
        for i in 0..vectors(set) {
            let four = |f: &dyn Fn(&Entry<f32>) -> f32| -> Vec<f32> {
                (4 * i..4 * i + 4).map(|at| row.core.get(at).map_or(0.0, f)).collect()
            };
            arguments.push(Value::numbers(&four(&|e| e.z)));
            arguments.push(Value::numbers(&four(&|e| e.absorbance)));
        }
        arguments.extend([
            Value::Uniform(row.n),
            Value::Uniform(row.b[0]),
            Value::numbers(&row.b[1..]),
        ]);
        let answer = interpreter.call(name, arguments).and_then(|v| v.flatten());
        error.add(answer.map_err(|e| e.to_string())?[0].into(), row.expected.into());
    }
    Ok(error)
}

/// Exported GLSL or HLSL whose atomic step is an ordinary one: naga reads no GLSL with atomics, and slangc writes none
/// as WGSL.
///
/// # Errors
/// Where the chain does not stand there as it is exported.
pub fn without_atomics(text: &str, language: Target) -> Result<String, String> {
    let step = match language {
        Target::Hlsl => "uint old;\n    InterlockedMax(nmt_core[slot], code, old);\n    return min(old, code);",
        _ => "uint old = atomicMax(nmt_core[slot], code);\n    return min(old, code);",
    };
    if !text.contains(step) {
        return Err("the atomic step of the insertion chain is not there".to_owned());
    }
    let plain = "uint old = nmt_core[slot];\n    nmt_core[slot] = max(old, code);\n    return min(old, code);";
    Ok(text
        .replace("coherent buffer", "buffer")
        .replace("globallycoherent ", "")
        .replace(step, plain))
}

/// A file that naga and slangc make WGSL of.
fn executable(text: &str, language: Target, set: CoreSet) -> Result<String, String> {
    match set.is_blended() {
        true => Ok(text.to_owned()),
        false => without_atomics(text, language),
    }
}

/// The file as WGSL whose functions can be executed; none where a tool for it is missing, which is named.
fn as_wgsl(text: &str, language: Target, set: CoreSet) -> Result<Result<String, String>, String> {
    match language {
        Target::Wgsl => Ok(Ok(text.to_owned())),
        Target::Glsl => {
            let shader = format!("#version 450\n{}\nvoid main() {{}}\n", executable(text, language, set)?);
            let options = naga::front::glsl::Options::from(naga::ShaderStage::Compute);
            let shader = shader.replace("void main", "layout(local_size_x = 1) in;\nvoid main");
            let module = naga::front::glsl::Frontend::default()
                .parse(&options, &shader)
                .map_err(|e| e.emit_to_string(&shader))?;
            let info =
                naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
                    .validate(&module)
                    .map_err(|e| e.emit_to_string(&shader))?;
            let flags = naga::back::wgsl::WriterFlags::empty();
            naga::back::wgsl::write_string(&module, &info, flags)
                .map(Ok)
                .map_err(|e| e.to_string())
        }
        _ => {
            let slangc = match hlsl::slangc() {
                Ok(slangc) => slangc,
                Err(missing) => return Ok(Err(missing)),
            };
            let vectors = (0..2 * vectors(set)).map(|_| "a, ").collect::<String>();
            let shader = format!(
                "{}\nRWStructuredBuffer<float4> rows : register(u1);\n\n[numthreads(1, 1, 1)]\nvoid main(uint3 id : \
                 SV_DispatchThreadID) {{\n    float4 a = rows[id.x];\n    rows[id.x] = nmt_core_weigh(a.x, a.y, \
                 {vectors}a.z, a.w, a);\n}}\n",
                executable(text, language, set)?
            );
            hlsl::to_wgsl(&slangc, &shader, "main").map(Ok)
        }
    }
}

/// What glslangValidator says to a fragment shader that only includes the file; none where it is not installed.
fn glslang(text: &str, language: Target) -> Option<Result<(), String>> {
    let (source, arguments): (_, &[&str]) = match language {
        Target::Hlsl => (
            format!("{text}\nfloat4 main(float4 place : SV_Position) : SV_Target {{ return place; }}\n"),
            &["-D", "-V", "-e", "main"],
        ),
        _ => (format!("#version 430\n{text}\nvoid main() {{}}\n"), &[]),
    };
    let folder = tempfile::tempdir().ok()?;
    let file = folder.path().join("core.frag");
    std::fs::write(&file, source).ok()?;
    let run = Command::new("glslangValidator")
        .current_dir(&folder)
        .args(arguments)
        .arg(&file)
        .output();
    let output = run.ok()?;
    Some(if output.status.success() {
        Ok(())
    } else {
        Err(String::from_utf8_lossy(&output.stdout).into_owned())
    })
}

/// Checks the files of a core whose tail is a beta law in a folder; what is missing is named.
///
/// Each is read; codes and insertion chain must stand there as the program writes them; the weight is executed on
/// random pixels and held to the formulas. The control is a file with another constant, which must not pass.
pub fn check(set: CoreSet, folder: &Path) -> Vec<Finding> {
    files(Subject::Law(set), folder, &LANGUAGES)
}

/// [`check`] of the files in which a network with a core stands for both passes; none where it has none.
pub fn check_network(mlp: &Mlp, folder: &Path, languages: &[Target]) -> Vec<Finding> {
    match mlp.feature_set().spec().core {
        Some(set) if crate::export::core::has_chain(mlp) => files(Subject::Network(set, mlp), folder, languages),
        _ => Vec::new(),
    }
}

fn files(subject: Subject<'_>, folder: &Path, languages: &[Target]) -> Vec<Finding> {
    let set = subject.set();
    let mut findings = Vec::new();
    for &language in languages {
        let format = Format::of(language);
        let path = folder.join(subject.file_name(language));
        let text = read(&path).map_err(|e| format!("{e}; 'nmt export' writes it"));
        let text = text.map(|bytes| without_prefix(format, bytes));
        let text = text.and_then(|bytes| String::from_utf8(bytes).map_err(|e| format!("{}: {e}", path.display())));
        let text = match text {
            Ok(text) => text,
            Err(why) => {
                findings.push(Finding::new(format, "built in", "is the file there", Err(why)));
                continue;
            }
        };
        // A network whose units were taken out is held to what is left of it.
        let left = match subject {
            Subject::Law(_) => Ok(None),
            Subject::Network(_, mlp) => pruned(format, text.as_bytes()).and_then(|pruned| {
                let left = pruned.map(|pruned| without_units(mlp, &pruned.units));
                left.transpose().map_err(|e| e.to_string())
            }),
        };
        let subject = match &left {
            Ok(Some(left)) => Subject::Network(set, left),
            Ok(None) => subject,
            Err(why) => {
                findings.push(Finding::new(format, "nmt", "computes the reference", Err(why.clone())));
                continue;
            }
        };
        let rows = rows(subject);
        let place = CoreBinding::DEFAULT;
        let pieces = [
            codes(set, language),
            keep(set, language, place),
            calls_of_passes(set, language),
        ];
        let whole = pieces.iter().all(|piece| text.contains(piece));
        let result = if whole {
            Ok(())
        } else {
            Err("they differ from what this version writes; export again".to_owned())
        };
        findings.push(Finding::new(format, "built in", "codes and insertion chain", result));
        findings.push(numbers(format, &text, language, subject, &rows));
        if language != Target::Wgsl {
            let question = "is it valid";
            findings.push(match glslang(&text, language) {
                Some(result) => Finding::new(format, "glslangValidator", question, result),
                None => Finding::skipped(format, "glslangValidator", question, "it is not installed".to_owned()),
            });
        }
    }
    findings
}

/// The weight on random pixels, and the control.
fn numbers(format: Format, text: &str, language: Target, subject: Subject<'_>, rows: &[Row]) -> Finding {
    let set = subject.set();
    let question = "does it compute the formulas";
    let tool = if language == Target::Hlsl { "slangc" } else { "built in" };
    let measure = |text: &str| -> Result<Result<AbsoluteError, String>, String> {
        match as_wgsl(text, language, set)? {
            Ok(wgsl) => error_of(&wgsl, set, rows).map(Ok),
            Err(missing) => Ok(Err(missing)),
        }
    };
    let control = subject.control(text);
    let (error, wrong) = match (measure(text), measure(&control)) {
        (Ok(Ok(error)), Ok(Ok(wrong))) => (error, wrong),
        (Ok(Err(missing)), _) | (_, Ok(Err(missing))) => return Finding::skipped(format, tool, question, missing),
        (Err(why), _) | (_, Err(why)) => return Finding::new(format, tool, question, Err(why)),
    };
    let result = if !error.within(BAR) {
        Err(format!("T is off by up to {:.2e}", error.worst()))
    } else if wrong.within(BAR) {
        Err("the control, a file with another constant, passes too".to_owned())
    } else {
        Ok(())
    };
    let mut finding = Finding::new(format, tool, question, result);
    finding.numbers.push(Numbers {
        kind: RowKind::InDistribution,
        export: error,
        reference: None,
        bar: BAR,
        mean_bar: BAR,
    });
    finding
}

#[cfg(test)]
mod tests {
    use super::super::Status;
    use super::*;
    use crate::export::Prefix;
    use crate::export::core::{chain_files, write};
    use crate::model::shipped;
    use crate::numeric::file::Replace;

    /// Both passes of the shipped networks: what is written passes, under a prefix too. A file with another weight,
    /// one with another chain and one that is missing do not, nor does another network's.
    #[test]
    fn files_of_networks_with_a_core_are_checked() {
        let folder = tempfile::tempdir().unwrap();
        let failed = |mlp: &Mlp| -> Vec<String> {
            let findings = check_network(mlp, folder.path(), &LANGUAGES);
            assert!(findings.len() >= 3);
            let failed = findings.iter().filter(|f| matches!(f.status, Status::Failed(_)));
            failed
                .map(|f| format!("{} {} {:?}", f.format.name(), f.question, f.status))
                .collect()
        };
        let save = |mlp: &Mlp, prefix: Option<&Prefix>| {
            for file in chain_files(mlp, &LANGUAGES, prefix).unwrap() {
                std::fs::write(folder.path().join(file.path), file.text).unwrap();
            }
        };
        let core = shipped::open(Path::new("core")).unwrap();
        for name in ["ends", "core-small", "core-large", "core"] {
            let mlp = shipped::open(Path::new(name)).unwrap();
            save(&mlp, None);
            assert_eq!(failed(&mlp), Vec::<String>::new());
        }
        save(&core, Some(&"glass".parse().unwrap()));
        assert_eq!(failed(&core), Vec::<String>::new());
        save(&core, None);
        let path = folder.path().join(chain_name(&core, Target::Wgsl));
        let text = std::fs::read_to_string(&path).unwrap();
        let without = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
            assert_eq!(failed(&core).len(), 1, "{from}");
        };
        without("min(-logit, 80.0)", "min(-1.1 * logit, 80.0)");
        without("if (second == 0u)", "if (second == 1u)");
        std::fs::remove_file(&path).unwrap();
        assert_eq!(failed(&core).len(), 1);
        let other = shipped::open(Path::new("recommended")).unwrap();
        assert!(check_network(&other, folder.path(), &LANGUAGES).is_empty());
    }

    /// What is written passes; a file that lost its last function, one with a wrong constant and one that is missing do
    /// not.
    #[test]
    fn files_of_a_core_are_checked() {
        let folder = tempfile::tempdir().unwrap();
        for set in [CoreSet::new(0, 1), CoreSet::new(4, 2), CoreSet::new(8, 4)] {
            write(set, folder.path(), Replace::No).unwrap();
            let findings = check(set, folder.path());
            assert!(findings.len() >= 8);
            for f in &findings {
                let passed = !matches!(f.status, Status::Failed(_));
                assert!(passed, "{} {} {:?}", f.format.name(), f.question, f.status);
            }
        }
        let set = CoreSet::new(4, 2);
        let failed = || {
            check(set, folder.path())
                .iter()
                .filter(|f| matches!(f.status, Status::Failed(_)))
                .count()
        };
        let path = folder.path().join(file_name(set, Target::Wgsl));
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("1.5976", "1.61")).unwrap();
        assert!(failed() >= 1);
        std::fs::write(&path, text.replace("4095", "4096").replace("0x3a800000", "0x3a800001")).unwrap();
        assert!(failed() >= 1);
        std::fs::remove_file(&path).unwrap();
        assert!(failed() >= 1);
        std::fs::write(&path, &text).unwrap();
        assert_eq!(failed(), 0);
    }
}
