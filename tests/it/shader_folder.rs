//! `shaders/`: what `nmt export --passes` writes of the shipped networks, and compilers of every language that read it.

use nmt::check::hlsl::slangc;
use nmt::export::files::{ShaderFile, files};
use nmt::model::{Mlp, file};
use nmt::numeric::require::or_skip;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Every network of `models/`.
fn networks() -> Vec<String> {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let paths = std::fs::read_dir(models).unwrap().map(|entry| entry.unwrap().path());
    let networks = paths.filter(|path| path.extension().is_some_and(|e| e == "json"));
    let mut names: Vec<String> = networks
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    assert!(names.len() >= 5, "{names:?}");
    names
}

fn named(network: &str) -> Mlp {
    file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{network}.json"))).unwrap()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders")
}

fn expected(network: &str) -> Vec<ShaderFile> {
    files(&named(network), None).unwrap()
}

/// Files below a folder, by their paths with slashes.
fn below(folder: &Path) -> BTreeSet<String> {
    fn walk(folder: &Path, base: &Path, out: &mut BTreeSet<String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, base, out);
            } else {
                let relative = path.strip_prefix(base).unwrap();
                out.insert(relative.to_str().unwrap().replace('\\', "/"));
            }
        }
    }
    let mut out = BTreeSet::new();
    walk(folder, folder, &mut out);
    out
}

/// What differs between a folder and the files that should stand there.
fn differences(folder: &Path, expected: &[ShaderFile]) -> Vec<String> {
    let mut left = below(folder);
    let mut out = Vec::new();
    for file in expected {
        left.remove(&file.path);
        match std::fs::read_to_string(folder.join(&file.path)) {
            Ok(text) if text == file.text => {}
            Ok(_) => out.push(format!("{} has changed", file.path)),
            Err(error) => out.push(format!("{}: {error}", file.path)),
        }
    }
    out.extend(left.into_iter().map(|path| format!("{path} is no file of the network")));
    out
}

/// Controls: another network's files, and a file too many.
#[test]
fn the_folder_is_what_export_writes() {
    for network in &networks() {
        let files = expected(network);
        let found = differences(&root().join(network), &files);
        assert!(
            found.is_empty(),
            "{network}: {found:#?}\nscripts/shaders writes them again"
        );
        assert!(files.iter().any(|f| f.path == format!("{network}.wgsl")));
        let passes = network != "deep-weighted-blended";
        assert_eq!(files.len() > 10, passes, "{network}");
    }
    let mut fewer = expected("small");
    assert!(!differences(&root().join("recommended"), &fewer).is_empty());
    fewer.pop();
    assert_eq!(differences(&root().join("small"), &fewer).len(), 1);
    let folders: BTreeSet<String> = below(&root())
        .iter()
        .map(|p| p.split('/').next().unwrap().to_owned())
        .collect();
    let known: BTreeSet<String> = networks().into_iter().chain(["README.md".to_owned()]).collect();
    assert_eq!(folders, known);
}

/// A compiler on a file.
fn run(program: &Path, arguments: &[&str], file: &Path) -> std::io::Result<Result<(), String>> {
    let output = Command::new(program).args(arguments).arg(file).output()?;
    let said = || {
        let text = [output.stdout.as_slice(), &output.stderr].concat();
        String::from_utf8_lossy(&text).into_owned()
    };
    Ok(if output.status.success() { Ok(()) } else { Err(said()) })
}

/// Every file of a kind that a compiler reads; the control is a file that names a function that is not there.
fn compile(program: &Path, tool: &str, kinds: &dyn Fn(&str) -> Option<Vec<Vec<String>>>) {
    let scratch = tempfile::tempdir().unwrap();
    let mut compiled = 0;
    for network in &networks() {
        for path in below(&root().join(network)) {
            let name = format!("{network}/{path}");
            for arguments in kinds(&path).into_iter().flatten() {
                let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
                let Some(result) = or_skip(tool, run(program, &arguments, &root().join(&name))) else {
                    return;
                };
                result.unwrap_or_else(|why| panic!("{name} {arguments:?}: {why}"));
                compiled += 1;
                let text = std::fs::read_to_string(root().join(&name)).unwrap();
                if network == "small" && text.contains("nmt_absorbance(float") {
                    let broken = scratch.path().join(Path::new(&path).file_name().unwrap());
                    std::fs::write(&broken, text.replace("nmt_absorbance(float", "nmt_absent(float")).unwrap();
                    assert!(
                        run(program, &arguments, &broken).unwrap().is_err(),
                        "the control of {name}"
                    );
                }
            }
        }
    }
    assert!(compiled >= 12, "{compiled} files");
}

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

/// Passes in GLSL 4.50, 4.30, ES 3.10 and ES 3.00, and those of Vulkan with and without input attachments.
#[test]
fn glslang_compiles_every_glsl_file() {
    let spirv = tempfile::tempdir().unwrap();
    let out = spirv.path().join("out.spv").to_str().unwrap().to_owned();
    compile(Path::new("glslangValidator"), "glslangValidator", &|path| {
        let glsl = path.ends_with(".frag") || path.ends_with(".vert");
        match path.split('/').next()? {
            "vulkan" => Some(
                ["", "-DNMT_SUBPASS"]
                    .map(|define| words(&format!("-V {define} -o {out}")))
                    .to_vec(),
            ),
            _ if glsl => Some(vec![vec![]]),
            _ => None,
        }
    });
}

/// Entry points of a file in HLSL with the stages that they are for.
fn hlsl_entries(path: &str) -> Option<Vec<(&'static str, &'static str)>> {
    match path.strip_prefix("direct3d/")? {
        "pass1.hlsl" => Some(vec![("pass1", "fragment")]),
        "pass2.hlsl" => Some(vec![("pass2", "fragment")]),
        "resolve.hlsl" => Some(vec![("resolve", "fragment"), ("everywhere", "vertex")]),
        _ => None,
    }
}

#[test]
fn glslang_compiles_every_hlsl_pass() {
    let spirv = tempfile::tempdir().unwrap();
    let out = spirv.path().join("out.spv").to_str().unwrap().to_owned();
    compile(Path::new("glslangValidator"), "glslangValidator", &|path| {
        let arguments = |(entry, stage): (&str, &str)| {
            let stage = if stage == "vertex" { "vert" } else { "frag" };
            words(&format!("-D -S {stage} -e {entry} -V -o {out}"))
        };
        Some(hlsl_entries(path)?.into_iter().map(arguments).collect())
    });
}

/// Passes, include files, and Unity's functions with them.
#[test]
fn slangc_compiles_every_hlsl_file() {
    let Some(program) = or_skip("slangc", slangc()) else {
        return;
    };
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out.hlsl").to_str().unwrap().to_owned();
    compile(&program, "slangc", &|path| match hlsl_entries(path) {
        Some(entries) => {
            let arguments = |(entry, stage): (&str, &str)| {
                words(&format!(
                    "-lang hlsl -target hlsl -profile sm_5_0 -entry {entry} -stage {stage} -o {out}"
                ))
            };
            Some(entries.into_iter().map(arguments).collect())
        }
        // No entry point: parsed and checked.
        None if path.ends_with(".hlsl") => Some(vec![words("-lang hlsl -no-codegen")]),
        None => None,
    });
}

/// The passes of WebGPU and the include files, by naga. Control: one without the network.
#[test]
fn naga_reads_every_wgsl_file() {
    let read = |source: &str| nmt::export::translate::parse_wgsl(source).map(drop);
    let mut count = 0;
    for network in &networks() {
        for path in below(&root().join(network))
            .into_iter()
            .filter(|p| p.ends_with(".wgsl"))
        {
            let text = std::fs::read_to_string(root().join(network).join(&path)).unwrap();
            read(&text).unwrap_or_else(|why| panic!("{network}/{path}: {why}"));
            count += 1;
            if path == "webgpu/pass2.wgsl" && network != "paper" {
                assert!(read(&text.replace("fn nmt_share(", "fn nmt_shares(")).is_err());
            }
        }
    }
    assert!(count > 12, "{count}");
}

/// Two networks under prefixes of their own fit one module, in every language; without, their names collide.
#[test]
fn two_networks_fit_one_module() {
    let both = |prefixes: [Option<&str>; 2], extension: &str| -> String {
        let texts = [("small", prefixes[0]), ("recommended", prefixes[1])].map(|(network, prefix)| {
            let prefix = prefix.map(|p| p.parse().unwrap());
            let files = files(&named(network), prefix.as_ref()).unwrap();
            files
                .into_iter()
                .find(|f| f.path == format!("{network}.{extension}"))
                .unwrap()
                .text
        });
        texts.concat()
    };
    let wgsl = |source: &str| nmt::export::translate::parse_wgsl(source).map(drop);
    wgsl(&both([Some("glass"), Some("smoke_2")], "wgsl")).unwrap();
    wgsl(&both([Some("glass"), None], "wgsl")).unwrap();
    assert!(wgsl(&both([None, None], "wgsl")).is_err());

    let folder = tempfile::tempdir().unwrap();
    if let Some(program) = or_skip("slangc", slangc()) {
        let path = folder.path().join("both.hlsl");
        let hlsl = |source: String| {
            std::fs::write(&path, source).unwrap();
            run(&program, &["-lang", "hlsl", "-no-codegen"], &path).unwrap()
        };
        hlsl(both([Some("glass"), Some("smoke_2")], "hlsl")).unwrap();
        assert!(hlsl(both([None, None], "hlsl")).is_err());
    }
    let path = folder.path().join("both.frag");
    let glsl = |source: String| {
        let text =
            format!("#version 450\n{source}\nlayout(location = 0) out vec4 x;\nvoid main() {{ x = vec4(1.0); }}\n");
        std::fs::write(&path, text).unwrap();
        run(Path::new("glslangValidator"), &[], &path)
    };
    let two = glsl(both([Some("glass"), Some("smoke_2")], "glsl"));
    let Some(result) = or_skip("glslangValidator", two) else {
        return;
    };
    result.unwrap();
    assert!(glsl(both([None, None], "glsl")).unwrap().is_err());
    // A second inclusion of one network is none.
    let twice = both([None, Some("smoke_2")], "glsl").repeat(2);
    glsl(twice).unwrap().unwrap();
}
