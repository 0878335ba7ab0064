//! The files in Metal's language, which Apple's compiler alone reads in earnest: a C++ compiler reads them with as much
//! of the standard library as they use (`metal/metal_stdlib`), and runs their functions.

use nmt::check::interpret::{Interpreter, Value};
use nmt::export::{Format, encode_as};
use nmt::model::{Mlp, file};
use nmt::numeric::require::or_skip;
use nmt::numeric::rng::stream;
use nmt::oit::Context;
use nmt::oit::neural::Neural;
use nmt::pixel::FragmentList;
use rand::RngExt;
use std::path::PathBuf;
use std::process::{Command, Stdio};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The C++ compiler, ready to read Metal's language; none, reported as skipped, where there is none.
fn compiler() -> Option<impl Fn() -> Command> {
    let found = Command::new("c++").arg("--version").output();
    or_skip("c++", found.map_err(|e| format!("no C++ compiler (Debian: g++): {e}")))?;
    Some(|| {
        let mut command = Command::new("c++");
        command
            .args([
                "-x",
                "c++",
                "-std=c++17",
                "-fsingle-precision-constant",
                "-ffp-contract=off",
                "-Wno-attributes",
            ])
            .arg("-I")
            .arg(root().join("tests/it/metal"));
        command
    })
}

fn verdict(command: &mut Command) -> Result<(), String> {
    let output = command.output().map_err(|e| e.to_string())?;
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() { Ok(()) } else { Err(words) }
}

/// All files below `shaders/` that end in .metal.
fn files() -> Vec<PathBuf> {
    let mut found = crate::sources::files(&root().join("shaders"), &["metal"]);
    found.sort();
    found
}

/// Every file is a program of declared names and fitting types. Control: one with a function less is none.
#[test]
fn metal_files_are_read_by_a_cpp_compiler() {
    let Some(compiler) = compiler() else { return };
    let files = files();
    assert!(files.len() >= 25, "{} files", files.len());
    for path in &files {
        verdict(compiler().arg("-fsyntax-only").arg(path)).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    }
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(root().join("shaders/small/metal/pass2.metal")).unwrap();
    for (from, to) in [
        ("float nmt_share(", "float nmt_shares("),
        ("metal::float2x4 f\n", "metal::float4 f\n"),
    ] {
        assert!(text.contains(from));
        let broken = folder.path().join("broken.metal");
        std::fs::write(&broken, text.replace(from, to)).unwrap();
        assert!(verdict(compiler().arg("-fsyntax-only").arg(&broken)).is_err(), "{to}");
    }
}

/// Two networks with prefixes of their own fit one program; control: without, they do not.
#[test]
fn two_networks_fit_one_metal_program() {
    let Some(compiler) = compiler() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("both.metal");
    let both = |prefixes: [Option<&str>; 2]| {
        let texts = [("small", prefixes[0]), ("recommended", prefixes[1])].map(|(network, prefix)| {
            let prefix = prefix.map(|p| p.parse().unwrap());
            let bytes = encode_as(&named(network), Format::METAL, prefix.as_ref()).unwrap();
            String::from_utf8(bytes).unwrap()
        });
        std::fs::write(&path, texts.concat()).unwrap();
        verdict(compiler().arg("-fsyntax-only").arg(&path))
    };
    both([Some("glass"), Some("smoke_2")]).unwrap();
    both([Some("glass"), None]).unwrap();
    assert!(both([None, None]).is_err());
}

/// What a program around an include file answers to rows of numbers.
fn run(compiler: &impl Fn() -> Command, network: &str, call: &str, rows: &[f32], width: usize) -> Vec<f32> {
    let text = format!(
        "#include \"{network}.metal\"\n#include <cstdio>\nint main() {{\n    float r[{width}];\n    while \
            (std::fread(r, 4, {width}, stdin) == {width}) {{\n        float answer = {call};\n        \
            std::fwrite(&answer, 4, 1, stdout);\n    }}\n}}\n"
    );
    run_text(compiler, network, &text, rows)
}

/// What a program answers that includes files of a network's folder.
fn run_text(compiler: &impl Fn() -> Command, network: &str, text: &str, rows: &[f32]) -> Vec<f32> {
    let folder = tempfile::tempdir().unwrap();
    let (source, program) = (folder.path().join("main.cpp"), folder.path().join("main"));
    std::fs::write(&source, text).unwrap();
    let include = root().join("shaders").join(network);
    verdict(compiler().arg("-I").arg(include).arg("-o").arg(&program).arg(&source)).unwrap();
    let input = folder.path().join("rows");
    std::fs::write(&input, rows.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let output = Command::new(&program)
        .stdin(Stdio::from(std::fs::File::open(&input).unwrap()))
        .output()
        .unwrap();
    assert!(output.status.success());
    let numbers = output.stdout.chunks_exact(4);
    numbers.map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
}

/// The numbers of a row as vectors of four, the last filled up with 0.
fn vectors(first: usize, n: usize) -> Vec<String> {
    let lane = |i: usize| {
        if i < n {
            format!("r[{}]", first + i)
        } else {
            "0".to_owned()
        }
    };
    let vector = |i: usize| {
        format!(
            "metal::float4({})",
            (4 * i..4 * i + 4).map(lane).collect::<Vec<_>>().join(", ")
        )
    };
    (0..n.div_ceil(4)).map(vector).collect()
}

fn named(network: &str) -> Mlp {
    file::load(&root().join(format!("models/{network}.json"))).unwrap()
}

/// How far answers are off at most; what is no number is off by all.
fn worst(found: &[f32], expected: &[f32]) -> f32 {
    assert!(!found.is_empty() && found.len() == expected.len());
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    off.map(|d| if d.is_nan() { 1.0 } else { d }).fold(0.0, f32::max)
}

/// `nmt_transmittance` in Metal's text against the reference forward pass on 2,000 random rows, to 3e-5: sums of blocks
/// are added in another order, and logits reach 20. Control: the answers to the row before.
#[test]
fn metal_networks_compute_the_reference() {
    let Some(compiler) = compiler() else { return };
    for network in [
        "recommended",
        "small",
        "moments-6",
        "paper",
        "ends",
        "core",
        "core-small",
        "core-large",
    ] {
        let mlp = named(network);
        let width = mlp.feature_set().width();
        let mut rng = stream(11, 3, 0);
        let rows: Vec<f32> = (0..2000 * width).map(|_| rng.random_range(-1.5f32..1.5)).collect();
        let columns = vectors(0, width);
        let value = match columns.len() {
            1 => columns[0].clone(),
            n => format!("metal::float{n}x4({})", columns.join(", ")),
        };
        let found = run(&compiler, network, &format!("nmt_transmittance({value})"), &rows, width);
        let mut expected = mlp.forward_batch::<f32>(&rows);
        let off = worst(&found, &expected);
        println!("{network}: {off:.1e}");
        assert!(off <= 3e-5, "{network}: {off}");
        expected.rotate_left(1);
        assert!(worst(&found, &expected) > 1e-2, "{network}: the control passed");
    }
}

/// `nmt_pass2` in Metal's text against the same function of the WGSL, as the interpreter runs it, on 1,000 fragments of
/// random pixels: to 1e-5 on average, and to 1e-2 at worst, since an ulp of a logarithm or of a moment grows where a
/// pixel is thin. Control: sums of another pixel.
#[test]
fn metal_passes_answer_as_wgsl_does() {
    let Some(compiler) = compiler() else { return };
    for network in ["recommended", "small", "moments-6"] {
        let k = named(network).feature_set().moments();
        let text = std::fs::read_to_string(root().join(format!("shaders/{network}/{network}.wgsl"))).unwrap();
        let module = naga::front::wgsl::parse_str(&text).unwrap();
        let interpreter = Interpreter::new(&module);
        let mut rng = stream(12, 3, k as u64);
        // v, v0, v1, alpha; sums; range.
        let rows: Vec<f32> = (0..1000)
            .flat_map(|round| {
                let n = 1 + round % 9;
                let fragments: Vec<[f32; 2]> = (0..n)
                    .map(|_| [rng.random_range(2.0f32..9.0), rng.random_range(0.05f32..0.9)])
                    .collect();
                let mut sums = [0.0f32; 8];
                let mut range = [-3e38f32; 2];
                for &[v, alpha] in &fragments {
                    let (z, a) = (2.0 * (v / 1.5).ln() / (10.0f32 / 1.5).ln() - 1.0, -(1.0 - alpha).ln());
                    (0..=k).for_each(|i| sums[i] += a * z.powi(i as i32));
                    sums[k + 1] += 1.0;
                    range = [range[0].max(-v), range[1].max(v)];
                }
                let [v, alpha] = fragments[n / 2];
                [&[v, 1.5, 10.0, alpha][..], &sums, &[range[0], range[1], 0.0, 0.0]].concat()
            })
            .collect();
        let arguments = [vectors(4, 4), vectors(8, 4), vectors(12, 4)].concat().join(", ");
        let call = format!("nmt_pass2(r[0], r[1], r[2], r[3], {arguments})");
        let found = run(&compiler, network, &call, &rows, 16);
        let mut expected: Vec<f32> = rows
            .chunks_exact(16)
            .map(|row| {
                let scalars = row[..4].iter().map(|&x| Value::<1>::Uniform(x));
                let arguments = scalars.chain(row[4..].chunks_exact(4).map(Value::numbers)).collect();
                interpreter.call("nmt_pass2", arguments).unwrap().flatten().unwrap()[0]
            })
            .collect();
        let off = worst(&found, &expected);
        let mean = |expected: &[f32]| {
            let sum: f32 = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).sum();
            sum / found.len() as f32
        };
        println!("{network}: {:.1e} on average, {off:.1e} at worst", mean(&expected));
        assert!(
            found.len() == 1000 && mean(&expected) <= 1e-5,
            "{network}: {}",
            mean(&expected)
        );
        assert!(off <= 1e-2, "{network}: {off}");
        expected.rotate_left(1);
        assert!(mean(&expected) > 1e-2, "{network}: the control passed");
    }
}

/// Fragments of a pixel in the test below.
const FRAGMENTS: usize = 12;

/// Both passes of cores, entry points and all, over pixels of twelve fragments: pass 1 fragment by fragment into slots
/// and sums, then pass 2.
const CORE_PASSES: &str = r#"
#include <metal_stdlib>
#include <simd/simd.h>
#include <cstdio>
namespace one {
#include "metal/pass1.metal"
}
namespace two {
#include "metal/pass2.metal"
}
int main() {
    constexpr int N = 12;
    const metal::float4 place(0.5, 0.5, 0, 1);
    const one::Frame frame1{1.5, 10.0, 1};
    const two::Frame frame2{1.5, 10.0, 1};
    float r[N][2];
    while (std::fread(r, 8, N, stdin) == N) {
        metal::atomic_uint slots[8] = {};
        metal::float4 sums0(0), sums1(0);
        for (auto &f : r) {
            auto &words = *reinterpret_cast<metal::atomic_uint(*)[1]>(slots);
            auto terms = one::pass1({f[0], metal::float4(0, 0, 0, f[1])}, place, words, frame1);
            sums0 = sums0 + terms.sums0;
            sums1 = sums1 + terms.sums1;
        }
        auto &core = *reinterpret_cast<metal::uint2(*)[1]>(slots);
        for (auto &f : r) {
            auto out = two::pass2({f[0], metal::float4(0, 0, 0, f[1])}, place, frame2, {sums0}, {sums1}, core);
            float T = out.member.w / f[1];
            std::fwrite(&T, 4, 1, stdout);
        }
    }
}
"#;

/// The same where blending keeps both ends.
const ENDS_PASSES: &str = r#"
#include <metal_stdlib>
#include <simd/simd.h>
#include <cstdio>
namespace one {
#include "metal/pass1.metal"
}
namespace two {
#include "metal/pass2.metal"
}
int main() {
    constexpr int N = 12;
    const metal::float4 place(0.5, 0.5, 0, 1);
    const one::Frame frame1{1.5, 10.0};
    const two::Frame frame2{1.5, 10.0};
    float r[N][2];
    while (std::fread(r, 8, N, stdin) == N) {
        metal::float4 sums0(0), sums1(0), range(-3e38f);
        for (auto &f : r) {
            auto terms = one::pass1({f[0], metal::float4(0, 0, 0, f[1])}, place, frame1);
            sums0 = sums0 + terms.sums0;
            sums1 = sums1 + terms.sums1;
            range.x = range.x < terms.range.x ? terms.range.x : range.x;
            range.y = range.y < terms.range.y ? terms.range.y : range.y;
        }
        for (auto &f : r) {
            auto out = two::pass2({f[0], metal::float4(0, 0, 0, f[1])}, place, frame2, {sums0}, {sums1}, {range});
            float T = out.member.w / f[1];
            std::fwrite(&T, 4, 1, stdout);
        }
    }
}
"#;

/// Whole passes of cores in Metal's text against what lists of the same fragments are answered with: to 1e-5 on
/// average, and to 1e-2 at worst, as above. Control: answers to the fragment beside.
#[test]
fn metal_passes_of_cores_answer_as_lists_are_answered() {
    let Some(compiler) = compiler() else { return };
    let of_cores = ["core-small", "core", "core-large"].map(|network| (network, CORE_PASSES));
    for (network, program) in of_cores.into_iter().chain([("ends", ENDS_PASSES)]) {
        let mut rng = stream(13, 3, network.len() as u64);
        let pixels = 200;
        let rows: Vec<f32> = (0..pixels * FRAGMENTS)
            .flat_map(|_| [rng.random_range(2.0f32..9.0), rng.random_range(0.05f32..0.9)])
            .collect();
        let found = run_text(&compiler, network, program, &rows);
        let offsets = (0..=pixels).map(|p| (p * FRAGMENTS) as u64).collect();
        let column = |k: usize| rows.iter().skip(k).step_by(2).copied().collect();
        let list = FragmentList::new(offsets, column(0), column(1), None).unwrap();
        let context = Context {
            depth_range: Some((1.5, 10.0)),
            ..Context::default()
        };
        let mut expected = Neural::new(named(network))
            .transmittance(&list, context, &|_| {})
            .unwrap();
        let mean = |expected: &[f32]| {
            let sum: f32 = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).sum();
            sum / found.len() as f32
        };
        let off = worst(&found, &expected);
        println!("{network}: {:.1e} on average, {off:.1e} at worst", mean(&expected));
        assert!(mean(&expected) <= 1e-5 && off <= 1e-2, "{network}: {off}");
        expected.rotate_left(1);
        assert!(mean(&expected) > 1e-2, "{network}: the control passed");
    }
}
