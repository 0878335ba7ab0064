//! One HTML page of what the other commands measured, out of the files that they wrote.
//!
//! The page stands alone: styles, script and pictures are in it, and it asks no network for anything. Files are read as
//! what they are, texts of strangers: all are escaped, any may be broken or of other types than expected, and the page
//! says which were. A content security policy lets the page's own script run and no other. The same files make the same
//! bytes.

mod checks;
mod errors;
mod find;
mod html;
mod images;
mod left_out;
mod profile;
mod provenance;
mod scenes;
mod speed;
mod stress;
mod summary;
mod time;
mod training;
mod value;

pub use find::Problem;

use crate::chart::palette;
use crate::numeric::digest::sha256_hex;
use crate::numeric::file::FileError;
use find::Found;
use html::{base64, escape};
use std::path::{Path, PathBuf};

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The folder could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// There is nothing to report on.
    #[error(
        "{}: holds nothing that nmt measured{problems}; name a folder that 'nmt run', 'nmt evaluate --out' or another \
            command has written to",
        path.display()
    )]
    Nothing {
        /// The folder.
        path: PathBuf,
        /// What stood there and could not be used.
        problems: String,
    },
}

/// What may be chosen about a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Most bytes that pictures may take in the page.
    pub most_picture_bytes: u64,
}

impl Default for Options {
    /// 64 MiB.
    fn default() -> Self {
        Self {
            most_picture_bytes: 64 << 20,
        }
    }
}

/// A page, and what is to be said of it.
#[derive(Debug)]
pub struct Page {
    /// The page.
    pub html: String,
    /// Titles of its sections.
    pub sections: Vec<&'static str>,
    /// What the folder has no files of, each with the command that writes them.
    pub missing: Vec<Missing>,
    /// What stood in the folder and could not be used.
    pub problems: Vec<Problem>,
    /// Number of pictures in the page.
    pub pictures: usize,
    /// Names of pictures for which there was no room.
    pub pictures_left_out: Vec<String>,
    /// Every file that was read.
    pub read: Vec<PathBuf>,
}

/// Something that the folder has no files of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Missing {
    /// What it would show.
    pub what: &'static str,
    /// The command that makes it.
    pub command: &'static str,
}

struct Section {
    id: &'static str,
    title: &'static str,
    html: Option<String>,
    /// What a page without it lacks.
    missing: Missing,
}

const SCRIPT: &str = include_str!("page.js");
const STYLE: &str = include_str!("page.css");

/// The style of the page, with the colours of series in their light and dark form.
fn style() -> String {
    STYLE
        .replace("SERIES_LIGHT", &palette::variables(&palette::LIGHT))
        .replace("SERIES_DARK", &palette::variables(&palette::DARK))
}

/// A page of everything in a folder and those below it.
///
/// # Errors
/// [`ReportError`] where the folder cannot be read, or holds nothing to report on.
pub fn build(folder: &Path, options: &Options) -> Result<Page, ReportError> {
    let mut found = Found::search(folder)?;
    let scenes = scenes::scenes(&found);
    let mut wrong = Vec::new();
    let training = training::section(&found, &mut wrong);
    wrong
        .into_iter()
        .for_each(|(name, reason)| found.problem(&name, reason));
    let images = images::section(&mut found, &scenes, options.most_picture_bytes);
    let time = time::section(&found, &scenes);

    let sections = sections(&found, &scenes, [images.html, time, training]);
    let missing: Vec<Missing> = sections
        .iter()
        .filter(|s| s.html.is_none())
        .map(|s| s.missing)
        .collect();
    if sections.iter().all(|s| s.html.is_none()) {
        let problems: String = found.problems.iter().take(5).map(|p| format!("; {p}")).collect();
        return Err(ReportError::Nothing {
            path: folder.to_owned(),
            problems,
        });
    }
    let mut present: Vec<(&str, &'static str, &str)> = sections
        .iter()
        .filter_map(|s| Some((s.id, s.title, s.html.as_deref()?)))
        .collect();
    let left_out = left_out::section(&found);
    if let Some(html) = &left_out {
        present.push(("left-out", "What is left out", html));
    }
    let html = page(folder, &present, &missing, &found, &summary::section(&found, &scenes));
    Ok(Page {
        html,
        sections: present.iter().map(|p| p.1).collect(),
        missing,
        problems: found.problems,
        pictures: images.embedded,
        pictures_left_out: images.left_out,
        read: found.read,
    })
}

/// All sections in their order, and what each takes; some are made beforehand.
fn sections(found: &Found, scenes: &[scenes::Scene], [images, time, training]: [Option<String>; 3]) -> [Section; 9] {
    let section = |id, title, html, what, command| Section {
        id,
        title,
        html,
        missing: Missing { what, command },
    };
    let evaluate = "nmt evaluate --fragments SCENE --model MODEL.json --out DIR";
    [
        section("images", "Images", images, "images beside the exact one", evaluate),
        section(
            "errors",
            "Errors",
            (!scenes.is_empty()).then(|| errors::tables(scenes)),
            "errors of methods on scenes",
            evaluate,
        ),
        section(
            "time",
            "Run time against error",
            time,
            "run time against error",
            "nmt bench methods --fragments SCENE --out DIR",
        ),
        section(
            "curves",
            "Error against depth complexity and alpha",
            errors::curves(scenes),
            "errors by depth complexity and alpha",
            evaluate,
        ),
        section(
            "training",
            "Training",
            training,
            "networks and their training curves",
            "nmt run CONFIG --out DIR",
        ),
        section(
            "stress",
            "Numerical stability",
            stress::section(found),
            "numerical stability",
            "nmt stress --model MODEL.json --out DIR",
        ),
        section(
            "speed",
            "Speed of training, inference and generation",
            speed::section(found),
            "speed of training, inference and generation",
            "nmt bench train --out DIR",
        ),
        section(
            "profile",
            "What scenes need",
            profile::section(found),
            "what scenes need",
            "nmt profile --fragments SCENE --out DIR",
        ),
        section(
            "checks",
            "Exports",
            checks::section(found),
            "checks of exports",
            "nmt check MODEL.json --exports EXPORTS --json > DIR/check.json",
        ),
    ]
}

/// Hash of a script as a content security policy names it.
fn script_hash(script: &str) -> String {
    let hex = sha256_hex([script.as_bytes()]);
    let bytes: Vec<u8> = (0..hex.len() / 2)
        .map(|i| u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).expect("hexadecimal digits"))
        .collect();
    format!("sha256-{}", base64(&bytes))
}

fn page(
    folder: &Path,
    sections: &[(&str, &'static str, &str)],
    missing: &[Missing],
    found: &Found,
    summary: &str,
) -> String {
    // The folder's own name alone: a page may be given away, and other people's paths say nothing.
    let name = folder
        .canonicalize()
        .ok()
        .as_deref()
        .unwrap_or(folder)
        .file_name()
        .map_or("report".into(), |n| n.to_string_lossy().into_owned());
    let name = escape(&name);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src '{}'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{name}: nmt report</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        script_hash(SCRIPT),
        style()
    );
    out += &format!(
        "<header><h1>{name}</h1>\n<p class=\"note\">Made by nmt {} of {}.</p></header>\n",
        env!("CARGO_PKG_VERSION"),
        files(found)
    );
    out += "<nav aria-label=\"Sections\"><ul>";
    let ends = [("files", "Provenance")]
        .into_iter()
        .chain((!missing.is_empty()).then_some(("missing", "Not here")));
    for (id, title) in sections.iter().map(|s| (s.0, s.1)).chain(ends) {
        out += &format!("<li><a href=\"#{id}\">{title}</a></li>");
    }
    out += "</ul></nav>\n<main>\n";
    out += &format!("<section id=\"summary\" aria-label=\"Summary\">\n{summary}</section>\n");
    if !found.problems.is_empty() {
        out += "<section id=\"problems\"><h2>Files that could not be used</h2>\n<ul>";
        for problem in found.problems.iter().take(MAX_PROBLEMS) {
            out += &format!(
                "<li><code>{}</code>: {}</li>\n",
                escape(&problem.name),
                escape(&problem.reason)
            );
        }
        out += "</ul>\n";
        if found.problems.len() > MAX_PROBLEMS {
            out += &format!("<p>{} more are not listed.</p>\n", found.problems.len() - MAX_PROBLEMS);
        }
        out += "</section>\n";
    }
    for (id, title, html) in sections {
        out += &format!(
            "<section id=\"{id}\" aria-labelledby=\"{id}-title\"><h2 id=\"{id}-title\">{title}</h2>\n{html}</section>\n"
        );
    }
    out += &format!(
        "<section id=\"files\" aria-labelledby=\"files-title\"><h2 id=\"files-title\">Provenance</h2>\n{}</section>\n",
        provenance::section(found)
    );
    if !missing.is_empty() {
        out += "<section id=\"missing\" aria-labelledby=\"missing-title\"><h2 id=\"missing-title\">Not in this \
            folder</h2>\n<ul class=\"missing\">";
        for m in missing {
            out += &format!("<li>{}: <code>{}</code></li>\n", escape(m.what), escape(m.command));
        }
        out += "</ul></section>\n";
    }
    out + "</main>\n<script>" + SCRIPT + "</script>\n</body>\n</html>\n"
}

/// Most problems that are listed.
const MAX_PROBLEMS: usize = 50;

fn files(found: &Found) -> String {
    let n = found.read.len();
    format!(
        "{} {}",
        html::thousands(n as i64),
        if n == 1 { "file" } else { "files" }
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn write(folder: &Path, name: &str, content: impl AsRef<[u8]>) {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    }

    /// Every kind of file with hostile text in every place.
    fn hostile(folder: &Path) {
        let evil = "</title></script><script>alert(1)</script>\"'><img src=x onerror=alert(1)>";
        let row = json!({ "scene": evil, "method": evil, "image_mse": 1e300, "image_psnr_db": evil, "flip_mean": -1,
            "transmittance_mse": 5e-324, "picture": evil,
            "nonfinite": u64::MAX, "bits_per_pixel": -1.5, "seconds_accumulate": [], "seconds_weights": 1e-300,
                "fragments": 1e308, "depth_complexity": evil,
            "by_fragments_per_pixel": [{ "least_fragments_per_pixel": 1e300, "most_fragments_per_pixel": -1,
                "fragments": -5, "transmittance_mse": 1e-9 }],
            "by_alpha": [{ "least_alpha": 7, "most_alpha": 7, "transmittance_mse": 1e200 }, evil] });
        let refused = json!({ "scene": evil, "method": evil, "error": evil });
        let with = |command: &str, rows: serde_json::Value| {
            json!({ "command": command, "version": evil, "machine": { "cpu": evil }, "results": rows }).to_string()
        };
        write(
            folder,
            "e/results.json",
            with("evaluate", json!([row, refused, null, 5, [], evil])),
        );
        let methods = json!({ "benchmark": "methods", "method": evil, "adapter": evil, "scene": evil,
            "seconds_weights": 1e-9, "image_mse": 1e-9, "raw_seconds": [evil, 1e300] });
        let train =
            json!({ "benchmark": evil, "network": evil, "samples_per_second": 1e300, "raw_seconds": [1, -1, 1e300] });
        write(
            folder,
            "b.json",
            with(
                "bench",
                json!([methods, { "benchmark": "methods", "method": evil }, train, evil]),
            ),
        );
        let case = json!({ "report": { "case": evil, "method": evil, "worst_error": -1e300, "nonfinite": 1 } });
        let sweep = json!({ "sweep": evil, "method": evil, "x": -1, "mse": 0 });
        write(folder, "s.json", with("stress", json!([case, sweep, [case]])));
        write(
            folder,
            "p.json",
            with(
                "profile",
                json!([{ "scene": evil, evil: evil, "list": [{ evil: evil, "count": 1e300 }], "mixed": [1, evil,
                    null] }]),
            ),
        );
        write(
            folder,
            "c.json",
            with(
                "check",
                json!([{ "format": evil, "tool": 5, "status": evil, "reason": evil, "numbers": [{ "rows": evil,
                    "bar": 1e300 }, evil] }]),
            ),
        );
        let model = json!({ "format": "nmt-model", "version": 1e300, "name": evil, "layer_sizes": [1e300, evil],
            "provenance": { "config": { evil: evil }, "seed": -1, "best_epoch": 1e300, "epochs": 0 } });
        write(folder, "m/model.json", model.to_string());
        write(
            folder,
            "m/model.losses.csv",
            format!("epoch,training_loss,validation_loss\n{evil}\n1,1e999,nan\n2,-1,0\n"),
        );
        write(
            folder,
            "broken <b>.json",
            "{\"command\": \"evaluate\", \"results\": [NaN]}",
        );
    }

    /// Text from files is text: no tag, attribute or script comes of it, and nothing panics.
    #[test]
    fn hostile_files_are_shown_as_text() {
        let folder = tempfile::tempdir().unwrap();
        hostile(folder.path());
        let page = build(folder.path(), &Options::default()).unwrap();
        assert_eq!(page.sections.len(), 8, "all but images: {:?}", page.sections);
        for part in ["<img src=x", "<script>alert", "onerror=alert(1)>", "</title></script>"] {
            assert!(!page.html.contains(part), "{part}");
        }
        let count = |part: &str| page.html.matches(part).count();
        assert_eq!(
            (count("<script"), count("</script"), count("</title>")),
            (1, 1, count("<title>"))
        );
        let broken: Vec<&str> = page.problems.iter().map(|p| p.name.as_str()).collect();
        assert!(
            broken.contains(&"broken <b>.json") && page.html.contains("broken &lt;b&gt;.json"),
            "{broken:?}"
        );
    }

    /// Files cut off anywhere make a page, or an error that names the folder.
    #[test]
    fn truncated_files_make_no_panic() {
        let folder = tempfile::tempdir().unwrap();
        hostile(folder.path());
        let cut = tempfile::tempdir().unwrap();
        let names = [
            "e/results.json",
            "b.json",
            "s.json",
            "p.json",
            "c.json",
            "m/model.json",
            "m/model.losses.csv",
        ];
        for share in 0..12 {
            for name in names {
                let whole = std::fs::read(folder.path().join(name)).unwrap();
                write(cut.path(), name, &whole[..whole.len() * share / 12]);
            }
            match build(cut.path(), &Options::default()) {
                Ok(page) => assert!(page.problems.len() >= 6),
                Err(error) => assert!(error.to_string().contains("is not whole JSON"), "{error}"),
            }
        }
    }

    #[test]
    fn the_same_files_make_the_same_bytes_and_ask_for_no_network() {
        let folder = tempfile::tempdir().unwrap();
        hostile(folder.path());
        let [a, b] = [0, 1].map(|_| build(folder.path(), &Options::default()).unwrap().html);
        assert!(a == b);
        let lower = a.to_lowercase();
        for part in ["http:", "https:", "src=\"//", "@import", "url(", "<link", "<iframe"] {
            assert!(!lower.contains(part), "{part}");
        }
        assert!(a.contains("default-src 'none'; img-src data:") && a.contains(&script_hash(SCRIPT)));
        // A machine's paths stay on it.
        assert!(
            !a.contains(folder.path().parent().unwrap().to_str().unwrap())
                || folder.path().parent().unwrap().components().count() < 2
        );
    }

    #[test]
    fn what_is_missing_is_said_with_its_command() {
        let folder = tempfile::tempdir().unwrap();
        let nothing = build(folder.path(), &Options::default()).unwrap_err().to_string();
        assert!(
            nothing.contains("nmt run") && nothing.contains("nmt evaluate"),
            "{nothing}"
        );
        write(
            folder.path(),
            "model.json",
            json!({ "format": "nmt-model", "name": "m" }).to_string(),
        );
        let page = build(folder.path(), &Options::default()).unwrap();
        assert_eq!(page.sections, ["Training"]);
        assert_eq!(page.missing.len(), 8);
        for m in &page.missing {
            assert!(page.html.contains(&format!(
                "<li>{}: <code>{}</code></li>",
                escape(m.what),
                escape(m.command)
            )));
        }
        assert!(build(&folder.path().join("none"), &Options::default()).is_err());

        // Times of an evaluation stand in for a benchmark's: they are there, and say where better ones come from.
        let row = json!({ "scene": "s", "method": "m", "image_mse": 1e-3, "seconds_weights": 0.5, "fragments": 10 });
        let results = json!({ "command": "evaluate", "results": [row] });
        write(folder.path(), "results.json", results.to_string());
        let page = build(folder.path(), &Options::default()).unwrap();
        assert!(page.sections.contains(&"Run time against error") && page.html.contains("nmt bench methods"));
        let missing: Vec<&str> = page.missing.iter().map(|m| m.what).collect();
        assert!(!missing.contains(&"run time against error"), "{missing:?}");
        assert_eq!(page.sections.len() + missing.len(), 9);
    }

    /// The policy's hash is that of what stands between the tags, as a browser computes it. The known answer is RFC
    /// 6234's digest of "abc" in base64.
    #[test]
    fn the_policy_names_the_script() {
        assert_eq!(
            script_hash("abc"),
            "sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0="
        );
        assert!(!SCRIPT.contains("</script") && !SCRIPT.contains("innerHTML") && !STYLE.contains("</style"));
    }
}
