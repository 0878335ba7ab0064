//! The section of what `nmt check`, and `nmt run`, found in the exports.

use super::find::Found;
use super::html::{Cell, Table};
use super::value::{list, number, text};
use serde_json::Value;

/// The section; none where no file holds such results.
pub fn section(found: &Found) -> Option<String> {
    let mut out = String::new();
    let runs = found.of("run").map(|d| {
        (
            d,
            d.results().iter().flat_map(|r| list(r, "checks")).collect::<Vec<_>>(),
        )
    });
    let checks = found.of("check").map(|d| (d, d.results().iter().collect::<Vec<_>>()));
    for (document, findings) in runs.chain(checks) {
        let head = [
            "format",
            "checked by",
            "question",
            "rows",
            "worst error",
            "mean error",
            "own f32",
            "bar",
            "result",
        ];
        let mut table = Table::new(&document.name, &head);
        for finding in findings.into_iter().filter(|f| f.is_object()) {
            let word = |key: &str| Cell::text(text(finding, &[key]).unwrap_or("–"));
            let status = text(finding, &["status"]).unwrap_or("–");
            let result = Cell::text(status)
                .classed(match status {
                    "passed" => "good",
                    "failed" => "bad",
                    _ => "",
                })
                .titled(text(finding, &["reason"]).unwrap_or(""));
            let head = [word("format"), word("tool"), word("question")];
            let row = |n: &Value| -> Vec<Cell> {
                let rows = format!(
                    "{} {}",
                    number(n, &["count"]).map_or("–".to_owned(), super::html::number),
                    text(n, &["rows"]).unwrap_or("")
                );
                let numbers = ["worst_error", "mean_error", "reference_worst_error", "bar"]
                    .map(|key| Cell::number(number(n, &[key])));
                head.iter()
                    .cloned()
                    .chain([Cell::text(rows.trim())])
                    .chain(numbers)
                    .chain([result.clone()])
                    .collect()
            };
            let numbers = list(finding, "numbers");
            if numbers.is_empty() {
                table.row(row(&Value::Null));
            }
            numbers.iter().for_each(|n| table.row(row(n)));
        }
        if !table.is_empty() {
            out += &table.html();
        }
    }
    (!out.is_empty()).then(|| {
        format!("{out}<p class=\"note\">Why something was skipped or failed shows on hovering over the result.</p>\n")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::tests::found;
    use serde_json::json;

    #[test]
    fn findings_of_runs_and_checks() {
        let finding = json!({ "format": "wgsl", "tool": "naga", "question": "computes <it>", "status": "failed",
            "reason": "1 > 0",
            "numbers": [{ "rows": "in distribution", "count": 100000, "worst_error": 4.5e-6, "mean_error": 1e-8,
                "reference_worst_error": 2e-6, "bar": 5e-6 }] });
        let skipped = json!({ "format": "onnx", "tool": "onnxruntime", "status": "skipped", "numbers": [] });
        let html = section(&found(
            "run.json",
            json!({ "command": "run", "results": [{ "checks": [finding, skipped, 5] }] }),
        ))
        .unwrap();
        for part in [
            "computes &lt;it&gt;",
            "100,000 in distribution",
            "4.50e-6",
            "failed",
            "1 &gt; 0",
            "skipped",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        assert!(
            section(&found(
                "run.json",
                json!({ "command": "run", "results": [{ "name": "x" }] })
            ))
            .is_none()
        );
    }
}
