//! The section of provenance: every file that the page is made of, and how each network came to be.

use super::find::Found;
use super::html::{Cell, Table, definitions, details, escape, escape_whole};
use super::value::{number, scalar, text, words};
use serde_json::Value;

/// Longest configuration that is shown \[bytes\].
const LONGEST_CONFIG: usize = 200_000;

/// The section.
pub fn section(found: &Found) -> String {
    let mut table = Table::new(
        "Files that this page is made of",
        &["file", "written by", "version", "machine", "results"],
    );
    for document in &found.documents {
        let (by, version) = match document.command() {
            Some(command) => (
                format!("nmt {command}"),
                text(&document.value, &["version"]).unwrap_or("–").to_owned(),
            ),
            None => (
                "model".to_owned(),
                number(&document.value, &["version"]).map_or("–".to_owned(), |v| format!("format {v:.0}")),
            ),
        };
        let machine = document.value.get("machine").map_or(String::new(), machine);
        let results = document.command().map(|_| document.results().len() as f64);
        table.row(vec![
            Cell::text(&document.name),
            Cell::text(&by),
            Cell::text(&version),
            Cell::text(&machine),
            Cell::number(results),
        ]);
    }
    for name in found.losses.keys() {
        table.row(vec![
            Cell::text(name),
            Cell::text("losses"),
            Cell::text("–"),
            Cell::text(""),
            Cell::number(None),
        ]);
    }
    let mut out = table.html();
    if !found.copies.is_empty() {
        let names: Vec<String> = found
            .copies
            .iter()
            .take(20)
            .map(|(copy, of)| format!("{copy} (as {of})"))
            .collect();
        let more = if found.copies.len() > 20 {
            format!(" and {} more", found.copies.len() - 20)
        } else {
            String::new()
        };
        out += &format!(
            "<p class=\"note\">Same content as another file, and left out: {}{more}.</p>\n",
            escape(&names.join(", "))
        );
    }
    for model in found.documents.iter().filter(|d| d.is_model()) {
        let Some(p) = model.value.get("provenance").and_then(Value::as_object) else {
            continue;
        };
        let name = text(&model.value, &["name"]).unwrap_or(&model.name);
        let plain: Vec<(String, String)> = p.iter().filter_map(|(k, v)| Some((words(k), raw(k, v)?))).collect();
        let mut html = definitions(&plain.iter().map(|(k, v)| (k.as_str(), v.clone())).collect::<Vec<_>>());
        if let Some(config) = p.get("config") {
            let config = serde_json::to_string_pretty(config).unwrap_or_default();
            let shown: String = config.chars().take(LONGEST_CONFIG).collect();
            html += &format!("<pre tabindex=\"0\">{}</pre>\n", escape_whole(&shown));
        }
        out += &details(&format!("{name}: provenance and configuration"), &html);
    }
    out
}

/// A plain value; seeds as they stand, without commas.
fn raw(key: &str, value: &Value) -> Option<String> {
    if key == "seed" && value.is_number() {
        Some(value.to_string())
    } else {
        scalar(value)
    }
}

fn machine(value: &Value) -> String {
    let parts = [
        text(value, &["cpu"]).map(str::to_owned),
        number(value, &["threads"]).map(|n| format!("{n:.0} threads")),
        text(value, &["os"]).map(str::to_owned),
        text(value, &["arch"]).map(str::to_owned),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::tests::found;
    use serde_json::json;

    #[test]
    fn files_machines_and_configurations() {
        let mut found = found(
            "e/results.json",
            json!({ "command": "evaluate", "version": "0.1.0", "machine": { "cpu": "C <1>", "threads": 2 },
                "results": [1, 2] }),
        );
        let model = json!({ "format": "nmt-model", "version": 1, "name": "m", "provenance": { "seed": 12345,
            "commit": "abc", "config": { "k": "<v>" } } });
        found.documents.push(crate::report::find::Document {
            name: "m.json".to_owned(),
            value: model,
        });
        found.copies.push(("x.json".to_owned(), "m.json".to_owned()));
        let html = section(&found);
        for part in [
            "nmt evaluate",
            "0.1.0",
            "C &lt;1&gt;, 2 threads",
            "format 1",
            "12345",
            "abc",
            "&quot;k&quot;: &quot;&lt;v&gt;&quot;",
            "x.json (as m.json)",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
    }
}
