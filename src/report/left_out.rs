//! What the input of the measurements holds and their results do not, and depths that made no sense.

use super::find::Found;
use super::html::{Cell, Table};
use super::value::{list, number, text};
use serde_json::Value;

/// Most rows of a table.
const MAX_ROWS: usize = 200;

/// The section; none where everything was read and nothing was strange.
pub fn section(found: &Found) -> Option<String> {
    let mut left_out = Table::new("Left out of the input", &["what", "where", "count", "what to do"]);
    let mut warnings = Table::new("Warnings about the input", &["where", "what"]);
    let said = |value: &Value, key: &str| Cell::text(text(value, &[key]).unwrap_or("-"));
    let mut seen: Vec<&Value> = Vec::new();
    for document in &found.documents {
        for value in list(&document.value, "left_out").iter().take(MAX_ROWS) {
            if !seen.contains(&value) {
                seen.push(value);
                let count = Cell::number(number(value, &["count"]));
                left_out.row(vec![
                    said(value, "what"),
                    said(value, "where"),
                    count,
                    said(value, "remedy"),
                ]);
            }
        }
        for value in list(&document.value, "warnings").iter().take(MAX_ROWS) {
            if !seen.contains(&value) {
                seen.push(value);
                warnings.row(vec![said(value, "where"), said(value, "message")]);
            }
        }
    }
    let html: String = [left_out, warnings]
        .iter()
        .filter(|t| !t.is_empty())
        .map(Table::html)
        .collect();
    (!html.is_empty()).then_some(html)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::find::Document;
    use serde_json::json;

    #[test]
    fn everything_that_was_said_is_in_the_page_once() {
        let document = |name: &str| Document {
            name: name.to_owned(),
            value: json!({
                "command": "evaluate", "results": [],
                "left_out": [{ "what": "skins <x>", "where": "a.glb", "count": 2, "remedy": "apply the armature" }],
                "warnings": [{ "kind": "all-equal", "where": "b.npz", "message": "all depths are 1" }],
            }),
        };
        let found = Found {
            documents: vec![document("a.json"), document("b.json")],
            ..Found::default()
        };
        let html = section(&found).unwrap();
        for part in ["skins &lt;x&gt;", "a.glb", "apply the armature", "all depths are 1"] {
            assert_eq!(html.matches(part).count(), 1, "{part} in {html}");
        }
        assert!(section(&Found::default()).is_none());
    }
}
