//! The section of `nmt profile`: what a scene needs in sentences, its drawing, and behind a click all that was
//! measured, whatever it is.

use super::find::Found;
use super::html::{Cell, Table, base64, definitions, details, escape};
use super::value::{list, number, numbers, scalar, text, words};
use crate::chart::histogram::{self, Panel};
use serde_json::{Map, Value};

/// Levels of objects that are followed.
const MAX_LEVELS: usize = 4;
/// Keys whose values are drawn as bars.
const BARS: [&str; 5] = ["share", "count", "pixels", "fragments", "evaluations"];
/// Most entries of an object or tables of a level.
const MAX_ENTRIES: usize = 60;
/// Most bins of a histogram that is drawn.
const MAX_BINS: usize = 200;

/// The section; none where no file holds such results.
pub fn section(found: &Found) -> Option<String> {
    let mut out = String::new();
    for document in found.of("profile") {
        for result in document.results().iter().take(MAX_ENTRIES) {
            if let Some(object) = result.as_object() {
                let title = ["scene", "model", "name"]
                    .iter()
                    .find_map(|k| object.get(*k)?.as_str())
                    .unwrap_or(&document.name);
                out += &format!(
                    "<article class=\"card\"><h3>{}</h3>\n{}{}{}</article>\n",
                    escape(title),
                    sentences(result),
                    drawing(title, result).unwrap_or_default(),
                    details("All numbers", &of_object(object, 0))
                );
            }
        }
    }
    (!out.is_empty()).then_some(out)
}

/// What to run on the scene, in the words of the recommendation.
fn sentences(result: &Value) -> String {
    let words = result.get("recommendation").map_or(&[][..], |r| list(r, "words"));
    let lines = words.iter().filter_map(Value::as_str).take(MAX_ENTRIES);
    let items: String = lines.map(|line| format!("<li>{}</li>\n", escape(line))).collect();
    if items.is_empty() {
        items
    } else {
        format!("<ul>{items}</ul>\n")
    }
}

/// The histograms and classes of the scene as a picture; none where a file holds none, or others than it should.
fn drawing(title: &str, result: &Value) -> Option<String> {
    let facts = result.get("facts")?;
    let name = |value: &Value, key: &str| Some(text(value, &[key])?.chars().take(80).collect::<String>());
    let panel = |h: &Value| {
        let (edges, counts) = (numbers(h, &["edges"]), list(h, "counts"));
        let counts: Vec<u64> = counts.iter().filter_map(Value::as_u64).collect();
        let whole = edges.len() == counts.len() + 1 && !counts.is_empty() && counts.len() <= MAX_BINS;
        // Sums of counts must not overflow.
        let small = counts.iter().all(|&n| n < 1 << 48);
        (whole && small && edges.iter().all(|e| e.is_finite())).then_some(Panel {
            title: format!("{}, % of {}", name(h, "quantity")?, name(h, "of")?),
            edges,
            counts,
        })
    };
    let share = |class: &Value| {
        let share = number(class, &["share"]).filter(|s| (0.0..=1.0).contains(s))?;
        let (class, answer) = (name(class, "class")?, name(class, "answer")?);
        Some(histogram::Share {
            label: format!("{class}: {:.1} % ({answer})", 100.0 * share),
            share,
        })
    };
    let panels: Vec<Panel> = list(facts, "histograms")
        .iter()
        .take(8)
        .map(panel)
        .collect::<Option<_>>()?;
    let shares: Vec<histogram::Share> = list(facts, "classes")
        .iter()
        .take(20)
        .map(share)
        .collect::<Option<_>>()?;
    if panels.is_empty() {
        return None;
    }
    let svg = histogram::svg(title, &panels, "How every fragment is answered", &shares);
    Some(format!(
        "<img class=\"drawing\" alt=\"Histograms of {}\" src=\"data:image/svg+xml;base64,{}\">\n",
        escape(title),
        base64(svg.as_bytes())
    ))
}

fn of_object(object: &Map<String, Value>, level: usize) -> String {
    let plain: Vec<(String, String)> = object
        .iter()
        .filter_map(|(k, v)| Some((words(k), scalar(v)?)))
        .take(MAX_ENTRIES)
        .collect();
    let mut out = if plain.is_empty() {
        String::new()
    } else {
        definitions(&plain.iter().map(|(k, v)| (k.as_str(), v.clone())).collect::<Vec<_>>())
    };
    for (key, value) in object.iter().filter(|(_, v)| scalar(v).is_none()).take(MAX_ENTRIES) {
        match value {
            Value::Array(rows) if !rows.is_empty() => out += &of_rows(&words(key), rows),
            Value::Object(inner) if level < MAX_LEVELS => {
                out += &format!("<h4>{}</h4>\n{}", escape(&words(key)), of_object(inner, level + 1))
            }
            _ => {}
        }
    }
    out
}

/// A list of objects as a table; a list of plain values as a line.
fn of_rows(title: &str, rows: &[Value]) -> String {
    let mut keys: Vec<&String> = Vec::new();
    for key in rows
        .iter()
        .filter_map(Value::as_object)
        .take(MAX_ENTRIES)
        .flat_map(Map::keys)
    {
        if !keys.contains(&key) && keys.len() < 12 {
            keys.push(key);
        }
    }
    if keys.is_empty() {
        let texts: Vec<String> = rows.iter().filter_map(scalar).take(MAX_ENTRIES).collect();
        return if texts.is_empty() {
            String::new()
        } else {
            definitions(&[(title, texts.join(", "))])
        };
    }
    let bar = BARS
        .iter()
        .find_map(|b| keys.iter().find(|k| k.as_str() == *b || k.ends_with(&format!("_{b}"))))
        .copied();
    // Names first, bars last.
    let named = |k: &String| rows.iter().any(|r| r.get(k).is_some_and(Value::is_string));
    keys.sort_by_key(|k| (!named(k), bar == Some(*k)));
    let numeric = |row: &Value, key: &String| row.get(key).and_then(Value::as_f64);
    let greatest = bar.map_or(0.0, |bar| {
        rows.iter().filter_map(|r| numeric(r, bar)).fold(0.0, f64::max)
    });
    let names: Vec<String> = keys.iter().map(|k| words(k)).collect();
    let mut table = Table::new(title, &names.iter().map(String::as_str).collect::<Vec<_>>());
    for row in rows.iter().filter(|r| r.is_object()) {
        let cell = |key: &&String| {
            let value = row.get(key.as_str());
            match value.and_then(Value::as_f64) {
                Some(x) if bar == Some(*key) && greatest > 0.0 => Cell::number(Some(x))
                    .classed("bar")
                    .styled(format!("--bar:{:.1}%", 100.0 * (x / greatest).clamp(0.0, 1.0))),
                Some(x) => Cell::number(Some(x)),
                None => Cell::text(&value.and_then(scalar).unwrap_or_else(|| "–".to_owned())),
            }
        };
        table.row(keys.iter().map(cell).collect());
    }
    table.html()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::tests::found;
    use serde_json::json;

    #[test]
    fn histograms_become_tables_with_bars() {
        let result = json!({ "scene": "teapots <x>", "fragments": 41000, "classes": [{ "class": "empty",
            "share": 0.5 }, { "class": "one", "share": 0.25 }],
            "network": { "units_that_never_fire": 14, "layers": [7, 32] }, "nothing": [],
                "deep": { "a": { "b": { "c": { "d": { "e": 1 } } } } } });
        let html = section(&found(
            "p/results.json",
            json!({ "command": "profile", "results": [result, 5] }),
        ))
        .unwrap();
        for part in [
            "teapots &lt;x&gt;",
            "41,000",
            "<caption><span>classes</span></caption>",
            "<th scope=\"row\">empty</th>",
            "--bar:50.0%",
            "units that never fire",
            "7, 32",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        assert!(section(&Found::default()).is_none());
    }

    /// The drawing shows what the file holds, and the sentences are those of the recommendation. Control: counts that
    /// do not fit their bins make no drawing.
    #[test]
    fn scenes_are_drawn_and_described() {
        let of = |counts: Value| {
            json!({ "scene": "hair",
                "facts": { "histograms": [{ "quantity": "alpha", "of": "fragments", "edges": [0.0, 0.5, 1.0],
                    "counts": counts }],
                    "classes": [{ "class": "nearest", "answer": "exact", "share": 0.25 }] },
                "recommendation": { "words": ["Use <this>."] } })
        };
        let html = |result: Value| {
            let found = found("p/profile.json", json!({ "command": "profile", "results": [result] }));
            section(&found).unwrap()
        };
        let whole = html(of(json!([3, 1])));
        assert!(whole.contains("data:image/svg+xml;base64,") && whole.contains("<li>Use &lt;this&gt;.</li>"));
        assert!(whole.contains("<details"));
        for wrong in [json!([3]), json!([3, -1]), json!(["x", 1]), json!([3, 1e300])] {
            assert!(!html(of(wrong)).contains("svg+xml"));
        }
    }
}
