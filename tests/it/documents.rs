//! What the documents show: every command of README, docs/ and `--help` is run, on small sizes; links lead somewhere;
//! no line is too long.

use crate::common::{Workplace, command, nmt};
use crate::python::python;
use nmt::numeric::require::or_skip;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Files below a folder with one of these endings, sorted.
fn files(folder: &str, endings: &[&str]) -> Vec<PathBuf> {
    fn walk(folder: &Path, endings: &[&str], out: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, endings, out);
            } else if path
                .extension()
                .is_some_and(|e| endings.iter().any(|ending| e == *ending))
            {
                out.push(path);
            }
        }
    }
    let mut out = Vec::new();
    walk(&root().join(folder), endings, &mut out);
    out.sort();
    out
}

/// Commands in the shell blocks of a page, without comments, each whole.
fn commands(page: &str) -> Vec<String> {
    let blocks = page
        .split("```sh\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap());
    let joined = blocks
        .map(|block| block.replace("\\\n", " "))
        .collect::<Vec<_>>()
        .join("\n");
    let bare = |line: &str| line.split(" #").next().unwrap().trim().to_owned();
    joined
        .lines()
        .map(bare)
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .collect()
}

/// Commands at the end of a `--help`.
fn examples(name: &str) -> Vec<String> {
    let words: Vec<&str> = std::iter::once("help").chain(name.split(' ')).collect();
    let output = nmt(&words).success().get_output().stdout.clone();
    let text = String::from_utf8(output).unwrap();
    let (_, examples) = text
        .split_once("Examples:\n")
        .unwrap_or_else(|| panic!("nmt {name} shows no example"));
    examples
        .lines()
        .map(|line| line.trim().to_owned())
        .filter(|l| !l.is_empty())
        .collect()
}

/// A folder with what commands name: small configurations under their own names, networks, scenes, data.
fn workplace() -> Workplace {
    let at = Workplace::new();
    let copy = |from: &Path, change: &dyn Fn(String) -> String| {
        let to = at.path(from.strip_prefix(root()).unwrap().to_str().unwrap());
        std::fs::create_dir_all(Path::new(&to).parent().unwrap()).unwrap();
        match std::fs::read_to_string(from) {
            Ok(text) => std::fs::write(to, change(text)).unwrap(),
            Err(_) => drop(std::fs::copy(from, to).unwrap()),
        }
    };
    let small = |text: String| -> String {
        let shorter = |line: &str| match line.split_once(" = ") {
            Some((key, _)) if key.ends_with("_pairs") => format!("{key} = 600\n"),
            Some(("pairs", _)) => "pairs = 300\n".to_owned(),
            Some(("epochs", _)) => "epochs = 1\n".to_owned(),
            _ => format!("{line}\n"),
        };
        text.lines().map(shorter).collect()
    };
    for file in files("configs", &["toml"]) {
        copy(&file, &small);
    }
    for file in files("models", &["json"])
        .into_iter()
        .chain(files("data", &["npz", "obj", "mtl", "npy", "json"]))
    {
        copy(&file, &|text| text);
    }
    let row = "[0.5, -0.25],".repeat(6) + "[1, 2]";
    let layers = format!(r#"{{"weights": [{row}], "bias": [0, 1]}}, {{"weights": [[1], [1]], "bias": [0]}}"#);
    at.write(
        "weights.json",
        &format!(r#"{{"source": "elsewhere", "layers": [{layers}]}}"#),
    );
    at
}

/// Puts a value behind an option, in the place of what stands there.
fn set(words: &mut Vec<String>, option: &str, value: &str) {
    if let Some(at) = words.iter().position(|w| w == option) {
        let end = words[at + 1..]
            .iter()
            .position(|w| w.starts_with("--"))
            .map_or(words.len(), |n| at + 1 + n);
        words.drain(at..end);
    }
    words.extend([option, value].map(str::to_owned));
}

/// The same command on small sizes and few repetitions.
fn smaller(mut words: Vec<String>) -> Vec<String> {
    let has = |words: &[String], option: &str| words.iter().any(|w| w == option);
    let scenes = [
        "glass-stacks",
        "smoke",
        "hair",
        "foliage",
        "spheres",
        "sphere-cluster",
        "teapots",
        "curtains",
        "built-in",
    ];
    let renders = words
        .iter()
        .any(|w| scenes.contains(&w.as_str()) || w.starts_with("configs/scenes/"));
    let reads = words.iter().any(|w| w.ends_with(".npz") && !w.starts_with("target")) && words[0] != "scene";
    let specialises = has(&words, "--specialise");
    if renders
        && !reads
        && matches!(
            words[0].as_str(),
            "scene" | "evaluate" | "predict" | "profile" | "generate"
        )
    {
        let size = match words[0].as_str() {
            _ if specialises => "72x72",
            "generate" => "64x48",
            _ => "24x24",
        };
        set(&mut words, "--size", size);
    }
    match words[0].as_str() {
        "evaluate" if has(&words, "--shadows") => set(&mut words, "--shadow-points", "20"),
        "run" | "train" => set(&mut words, "--epochs", "1"),
        "profile" => set(&mut words, "--repeat", "1"),
        "stress" => {
            set(&mut words, "--pixels", "10");
            set(&mut words, "--cases", "single");
            if has(&words, "--random") {
                set(&mut words, "--random", "1000");
            }
        }
        "bench" => {
            set(&mut words, "--repeat", "1");
            match words[1].as_str() {
                "train" if !has(&words, "--stream") => set(&mut words, "--rows", "8192"),
                "generate" => set(&mut words, "--pairs", "200"),
                "methods" | "tiles" => set(&mut words, "--size", "24x24"),
                _ => {}
            }
            if words[1] != "tiles" {
                set(&mut words, "--sample-seconds", "0.001");
            }
        }
        _ => {}
    }
    if specialises {
        set(&mut words, "--network-size", "keep");
    }
    let writes = ["--out", "--resume"].map(|option| has(&words, option));
    if writes[0] && !writes[1] && !has(&words, "--force") {
        words.push("--force".to_owned());
    }
    words
}

/// Whether a command needs a GPU.
fn needs_gpu(words: &[String]) -> bool {
    words.iter().any(|w| w == "--gpu")
        || words.windows(2).any(|w| w[0] == "--device" && w[1] == "gpu")
        || words.get(1).is_some_and(|w| w == "tiles")
}

/// Runs a command, or checks that what it names is there where it builds or installs.
fn run(at: &Workplace, line: &str) {
    let line = line.split(" > ").next().unwrap();
    let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
    words.retain(|w| !w.starts_with("NMT_"));
    let after = |words: &[String], head: &[&str]| {
        (words.len() > head.len() && words.iter().zip(head).all(|(a, b)| a == b)).then(|| words[head.len()..].to_vec())
    };
    let ours = after(&words, &["nmt"]).or_else(|| after(&words, &["cargo", "run", "--release", "--"]));
    if let Some(words) = ours {
        let words = smaller(words);
        if needs_gpu(&words) && or_skip("gpu", nmt::gpu::Gpu::shared()).is_none() {
            return;
        }
        let arguments: Vec<&str> = words.iter().map(String::as_str).collect();
        let output = command(&arguments).current_dir(at.path("")).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}\n{}\n{error}", arguments.join(" "));
    } else if let Some(words) = after(&words, &["target/venv/bin/python"]) {
        assert!(root().join(&words[0]).is_file(), "{line}");
        // What compares with other programs needs them, and time.
        if let Some(python) = python().filter(|_| words[0].ends_with("nmt.py")) {
            let script = root().join(&words[0]);
            let mut process = std::process::Command::new(python);
            let output = process
                .arg(script)
                .args(&words[1..])
                .current_dir(at.path(""))
                .output()
                .unwrap();
            assert!(
                output.status.success(),
                "{line}\n{}",
                String::from_utf8_lossy(&output.stdout)
            );
        }
    } else if words[0] == "cargo" {
        let known = ["build", "install", "doc", "test", "run", "nextest", "fuzz", "add"];
        assert!(known.contains(&words[1].as_str()), "{line}");
        let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
        for (option, value) in words.windows(2).map(|w| (&w[0], &w[1])) {
            match option.as_str() {
                "--features" => value
                    .split(',')
                    .for_each(|f| assert!(manifest.contains(&format!("\n{f} = [")), "{line}")),
                "--example" => assert!(root().join(format!("examples/{value}.rs")).is_file(), "{line}"),
                _ => {}
            }
        }
    } else {
        // Tools of other ecosystems serve, build or clone; what lies here must be here.
        let elsewhere = ["git", "npm", "npx", "node", "python3", "cd"].contains(&words[0].as_str());
        let place = words.iter().find(|w| w.contains('/'));
        let exists = place.is_some_and(|place| root().join(place).exists());
        assert!(elsewhere || exists, "what is '{line}'?");
    }
}

/// Every document, one test each, so that they run side by side; and all of them are listed.
macro_rules! documents {
    ($($test:ident: $path:literal,)+) => {
        $(
            #[test]
            fn $test() {
                let Ok(page) = std::fs::read_to_string(root().join($path)) else { return };
                let at = workplace();
                commands(&page).iter().for_each(|line| run(&at, line));
            }
        )+

        #[test]
        fn every_document_is_run() {
            let listed = [$($path),+];
            for file in files("docs", &["md"]) {
                let name = format!("docs/{}", file.file_name().unwrap().to_str().unwrap());
                assert!(listed.contains(&name.as_str()), "{name} is not among the documents whose commands are run");
            }
        }
    };
}

documents! {
    readme: "README.md",
    docs_checks: "docs/checks.md",
    docs_cli: "docs/cli.md",
    docs_core: "docs/core.md",
    docs_configuration: "docs/configuration.md",
    docs_glossary: "docs/glossary.md",
    docs_input: "docs/input.md",
    docs_integration: "docs/integration.md",
    docs_methods: "docs/methods.md",
    the_comparison: "docs/comparison.md",
    the_index_of_examples: "examples/README.md",
    docs_over_time: "docs/over-time.md",
    docs_page: "docs/page.md",
    docs_performance: "docs/performance.md",
    docs_skip: "docs/skip.md",
    docs_stress: "docs/stress.md",
}

/// What `--help` shows, in an order in which each command finds what those before it made.
#[test]
fn examples_of_help_run() {
    let at = workplace();
    let names = [
        "generate",
        "train",
        "export",
        "check",
        "predict",
        "evaluate",
        "scene",
        "bench",
        "stress",
        "profile",
        "import",
        "methods",
        "completions",
        "man",
        "schema",
        "run",
        "report",
        "bench train",
        "bench generate",
        "bench infer",
        "bench methods",
        "bench tiles",
    ];
    for name in names {
        let lines = examples(name);
        assert!(
            !lines.is_empty() && lines.iter().all(|line| line.starts_with(&format!("nmt {name}"))),
            "{name}"
        );
        lines.iter().for_each(|line| run(&at, line));
    }
}

/// Control: a command that is not what it says fails.
#[test]
#[should_panic(expected = "nmt predict recommended --fragmnts")]
fn wrong_commands_are_found() {
    run(
        &Workplace::new(),
        "nmt predict recommended --fragmnts x.npz --out T.npy",
    );
}

/// Targets of links that lead nowhere: files, and headings of files.
fn broken_links(page: &str, folder: &Path) -> Vec<String> {
    let anchor = |heading: &str| -> String {
        let kept = heading.to_lowercase();
        let kept = kept
            .chars()
            .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    let headings = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|line| line.starts_with('#'));
        lines.map(|line| anchor(line.trim_start_matches('#').trim())).collect()
    };
    let targets = page.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
    targets
        .filter(|target| !target.contains("://") && !target.contains(' '))
        .filter(|target| {
            let (file, heading) = target.split_once('#').unwrap_or((target, ""));
            let path = folder.join(file);
            let text = || {
                if file.is_empty() {
                    page.to_owned()
                } else {
                    std::fs::read_to_string(&path).unwrap_or_default()
                }
            };
            !(file.is_empty() || path.exists())
                || !(heading.is_empty() || headings(&text()).iter().any(|h| h == heading))
        })
        .map(str::to_owned)
        .collect()
}

/// Files and headings that documents link to are there. Control: one of each that is not.
#[test]
fn links_of_documents_lead_somewhere() {
    let mut pages = files("docs", &["md"]);
    pages.extend(files("models", &["md"]));
    pages.extend(["README.md", "examples/README.md"].map(|page| root().join(page)));
    for file in pages {
        let page = std::fs::read_to_string(&file).unwrap();
        let broken = broken_links(&page, file.parent().unwrap());
        assert!(broken.is_empty(), "{}: {broken:?}", file.display());
    }
    let page = "# One\n[a](gone.md) [b](#one) [c](#two) [d](Cargo.toml) [e](https://example.org/x)";
    assert_eq!(broken_links(page, root()), ["gone.md", "#two"]);
}

/// The index of examples names every one with its command. Control: not one that is not there.
#[test]
fn every_example_is_listed() {
    let index = std::fs::read_to_string(root().join("examples/README.md")).unwrap();
    let listed = |name: &str, command: &str| {
        let link = format!("[{name}]({name})");
        let mut rows = index.lines().filter(|line| line.starts_with('|'));
        rows.any(|row| row.contains(&link) && row.contains(command))
    };
    let examples = files("examples", &["rs", "html"]);
    assert!(examples.len() >= 5, "{examples:?}");
    for file in examples {
        let name = file.file_name().unwrap().to_str().unwrap();
        let command = match name.strip_suffix(".rs") {
            Some(stem) => format!("cargo run --release --example {stem}"),
            None => format!("/examples/{name}"),
        };
        assert!(listed(name, &command), "{name}");
    }
    assert!(!listed("gone.rs", "cargo run"));
}

/// The Python in docs/cli.md runs on files of the commands above it, and the list that it writes makes an image.
/// Control: a list without colours makes none.
#[test]
fn the_python_of_the_command_line_runs() {
    let Some(python) = python() else { return };
    let page = std::fs::read_to_string(root().join("docs/cli.md")).unwrap();
    let (_, section) = page.split_once("## From Python\n").unwrap();
    let at = workplace();
    commands(section).iter().for_each(|line| run(&at, line));
    std::fs::create_dir(at.path("scripts")).unwrap();
    std::fs::copy(root().join("scripts/nmt.py"), at.path("scripts/nmt.py")).unwrap();
    let snippet = section
        .split("```python\n")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    let output = std::process::Command::new(python)
        .args(["-c", snippet])
        .current_dir(at.path(""))
        .output()
        .unwrap();
    let (text, error) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success() && text.contains("T-MSE"), "{text}\n{error}");
    let evaluate = |list: &str, out: &str| {
        let arguments = [
            "evaluate",
            "--fragments",
            list,
            "--methods",
            "moment-power-4",
            "--out",
            out,
        ];
        command(&arguments).current_dir(at.path("")).assert().success();
        std::path::Path::new(&at.path(out))
            .join(list)
            .with_extension("")
            .join("truth.png")
            .is_file()
    };
    std::fs::copy(at.path("target/numpy.npz"), at.path("numpy.npz")).unwrap();
    std::fs::copy(at.path("data/sample.npz"), at.path("sample.npz")).unwrap();
    assert!(evaluate("numpy.npz", "with") && !evaluate("sample.npz", "without"));
}

/// The shader code in README compiles behind the export. Control: with a function misspelt it does not.
#[test]
fn the_snippet_of_the_readme_compiles() {
    let page = std::fs::read_to_string(root().join("README.md")).unwrap();
    let snippet = page.split("```wgsl\n").nth(1).unwrap().split("```").next().unwrap();
    let network = nmt::model::shipped::named("recommended").unwrap();
    let export = String::from_utf8(nmt::export::encode(&network, nmt::export::Format::WGSL).unwrap()).unwrap();
    let around = |body: &str| {
        format!(
            "{export}\nfn snippet(v: f32, alpha: f32, v0: f32, v1: f32, sums0: vec4<f32>, sums1: vec4<f32>, \
             range: vec4<f32>, weighted: vec4<f32>) -> f32 {{\n{body}\nreturn T + sums.range.x + over.a;\n}}\n"
        )
    };
    let compiles = |source: &str| {
        let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .map(drop)
            .map_err(|e| e.emit_to_string(source))
    };
    compiles(&around(snippet)).unwrap();
    assert!(compiles(&around(&snippet.replace("nmt_pass2", "nmt_pass3"))).is_err());
}
