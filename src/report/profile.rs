//! The section of `nmt profile`, whatever it wrote: names and values, and a table with bars of every list of counts.

use super::find::Found;
use super::html::{Cell, Table, definitions, escape};
use super::value::{scalar, words};
use serde_json::{Map, Value};

/// Levels of objects that are followed.
const MAX_LEVELS: usize = 4;
/// Keys whose values are drawn as bars.
const BARS: [&str; 5] = ["share", "count", "pixels", "fragments", "evaluations"];
/// Most entries of an object or tables of a level.
const MAX_ENTRIES: usize = 60;

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
                    "<article class=\"card\"><h3>{}</h3>\n{}</article>\n",
                    escape(title),
                    of_object(object, 0)
                );
            }
        }
    }
    (!out.is_empty()).then_some(out)
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
        let result = json!({ "scene": "teapots <x>", "fragments": 41000, "classes": [{ "class": "empty", "share": 0.5 }, { "class": "one", "share": 0.25 }],
            "network": { "units_that_never_fire": 14, "layers": [7, 32] }, "nothing": [], "deep": { "a": { "b": { "c": { "d": { "e": 1 } } } } } });
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
}
