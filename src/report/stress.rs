//! The section of `nmt stress`: cases by methods, and errors along what is swept.

use super::find::Found;
use super::html::{Cell, Table, escape};
use super::value::{number as number_of, text, words};
use crate::chart::{self, Axis, COLORS, Chart, Mark, Point, Scale, Series};
use serde_json::Value;

/// Most methods that are columns.
const MAX_COLUMNS: usize = 80;
/// Errors from this on are coloured, faintest at this one and strongest at 1.
const MIN_COLORED: f64 = 1e-7;

/// A result as it is, or the object within it that names a method.
fn inner(result: &Value) -> &Value {
    if result.get("method").is_some() {
        return result;
    }
    result
        .as_object()
        .and_then(|o| o.values().find(|v| v.get("method").is_some()))
        .unwrap_or(result)
}

/// The section; none where no file holds such results.
pub fn section(found: &Found) -> Option<String> {
    let mut out = String::new();
    for document in found.of("stress") {
        let rows: Vec<&Value> = document.results().iter().map(inner).collect();
        out += &cases(&document.name, &rows);
        out += &sweeps(&rows);
    }
    (!out.is_empty()).then_some(out)
}

fn in_order<'a>(rows: &[&'a Value], key: &str) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for name in rows.iter().filter_map(|r| text(r, &[key])) {
        if seen.insert(name) {
            names.push(name);
        }
    }
    names
}

fn cases(file: &str, rows: &[&Value]) -> String {
    let rows: Vec<&Value> = rows
        .iter()
        .copied()
        .filter(|r| text(r, &["case"]).is_some() && text(r, &["method"]).is_some())
        // Rows of features alone are no cases, and the formats of weights no methods.
        .filter(|r| text(r, &["kind"]).is_none_or(|kind| kind == "case"))
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let (cases, methods) = (in_order(&rows, "case"), in_order(&rows, "method"));
    let shown = &methods[..methods.len().min(MAX_COLUMNS)];
    let head: Vec<&str> = std::iter::once("case").chain(shown.iter().copied()).collect();
    let mut table = Table::new(&format!("{file}: root mean square error of T, cases by methods"), &head).upright();
    let mut by_place = std::collections::HashMap::new();
    for row in &rows {
        by_place
            .entry((text(row, &["case"]), text(row, &["method"])))
            .or_insert(*row);
    }
    for case in &cases {
        let cells = shown.iter().map(|method| {
            by_place
                .get(&(Some(*case), Some(*method)))
                .map_or(Cell::number(None), |row| cell(row))
        });
        table.row(std::iter::once(Cell::text(case)).chain(cells).collect());
    }
    let mut out = table.html();
    if methods.len() > shown.len() {
        out += &format!(
            "<p class=\"note\">{} more methods are left out.</p>\n",
            methods.len() - shown.len()
        );
    }
    out + "<p class=\"note\">Colour runs with the logarithm of the error, from 1e-7 to 1. <b>✕</b>: answers that are \
        not \
        finite; <b>↕</b>: answers outside [0, 1]. The worst error and more show on hovering.</p>\n"
}

/// The root mean square error, or the worst where the file has no other, with marks for what is worse than an error.
fn cell(row: &Value) -> Cell {
    if let Some(why) = text(row, &["refused", "error"]) {
        return Cell::text("–").titled(why);
    }
    let count = |keys: &[&str]| number_of(row, keys).unwrap_or(0.0);
    let (bad, outside) = (count(&["nonfinite"]), count(&["out_of_range"]));
    let rms = number_of(row, &["mse"]).map(f64::sqrt);
    let error = rms.or_else(|| number_of(row, &["worst_error", "worst"]));
    let marks = [if bad > 0.0 { " ✕" } else { "" }, if outside > 0.0 { " ↕" } else { "" }].concat();
    let form = |x: f64| match x {
        0.0 => "0".to_owned(),
        x if x >= 0.0095 => format!("{x:.2}"),
        x => format!("{x:.0e}"),
    };
    let number = error.map_or("–".to_owned(), form);
    let lines: Vec<String> = [
        "fragments",
        "worst_error",
        "p999_error",
        "mse",
        "worst_rounding",
        "nonfinite",
        "out_of_range",
        "nearest_not_one",
        "single_not_one",
        "rises",
        "non_monotone",
        "order_spread",
    ]
    .iter()
    .filter_map(|key| {
        Some(format!(
            "{}: {}",
            words(key),
            super::html::number(number_of(row, &[key])?)
        ))
    })
    .collect();
    let share = error.map_or(0.0, |x| {
        ((x / MIN_COLORED).max(1.0).log10() / -MIN_COLORED.log10()).clamp(0.0, 1.0)
    });
    let style = if share > 0.0 {
        format!("--heat:{:.0}%", 70.0 * share)
    } else {
        String::new()
    };
    Cell::shown(Some(error.unwrap_or(f64::NAN)), |_| format!("{number}{marks}"))
        .classed(if bad > 0.0 { "heat bad" } else { "heat" })
        .styled(style)
        .titled(&lines.join("\n"))
}

fn sweeps(rows: &[&Value]) -> String {
    let rows: Vec<&Value> = rows
        .iter()
        .copied()
        .filter(|r| text(r, &["sweep"]).is_some() && number_of(r, &["x"]).is_some())
        .collect();
    let mut out = String::new();
    for sweep in in_order(&rows, "sweep") {
        let of_sweep: Vec<&Value> = rows
            .iter()
            .copied()
            .filter(|r| text(r, &["sweep"]) == Some(sweep))
            .collect();
        let methods = in_order(&of_sweep, "method");
        let series = methods.iter().enumerate().map(|(color, method)| {
            let mut points: Vec<Point> = of_sweep
                .iter()
                .filter(|r| text(r, &["method"]) == Some(method))
                .filter_map(|r| {
                    let (x, y) = (number_of(r, &["x"])?, number_of(r, &["mse", "worst_error"])?);
                    Some(Point {
                        x,
                        y,
                        spread: None,
                        title: format!("{method}: {} at {}", super::html::number(y), super::html::number(x)),
                    })
                })
                .collect();
            points.sort_by(|a, b| a.x.total_cmp(&b.x));
            Series {
                name: (*method).to_owned(),
                points,
                // Colours come again after the eighth.
                mark: if color < COLORS {
                    Mark::LineAndPoints
                } else {
                    Mark::Dashed
                },
                color,
            }
        });
        let caption = format!("T-MSE against {}", words(sweep));
        let chart = Chart {
            summary: format!("{caption}; {} methods.", methods.len()),
            x: Axis {
                label: words(sweep),
                scale: Scale::Log { decades: 12 },
            },
            y: Axis {
                label: "T-MSE".to_owned(),
                scale: Scale::Log { decades: 9 },
            },
            series: series.collect(),
        };
        out += &chart::figure(&chart, &caption).unwrap_or_default();
    }
    if out.is_empty() {
        out
    } else {
        format!("<h3>{}</h3><div class=\"plots\">{out}</div>\n", escape("Sweeps"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::tests::found;
    use serde_json::json;

    #[test]
    fn cases_by_methods_with_marks() {
        let row = |method: &str, case: &str, worst: Value, bad: u64, out: u64| {
            json!({ "kind": "case", "report": { "method": method, "case": case, "worst_error": worst, "nonfinite": bad,
                "out_of_range": out, "p999_error": 0.5 } })
        };
        let rows = json!([row("a", "single <1>", json!(0.0), 0, 0), row("b", "single <1>", json!(0.25), 3, 1),
            row("a", "tied", json!(3e-5), 0, 0),
            { "method": "b", "case": "tied", "worst_error": null, "refused": "no \"planes\"" },
            // The root mean square goes before the worst; formats of weights on rows of features are no methods.
            { "kind": "case", "method": "a", "case": "thin", "mse": 1e-4, "worst_error": 0.9 },
            { "kind": "features", "method": "a @ int8", "case": "rows", "mse": 1e-4 },
            { "case": "no method" }, [1]]);
        let html = section(&found(
            "s/results.json",
            json!({ "command": "stress", "results": rows }),
        ))
        .unwrap();
        assert_eq!(
            (html.matches("<tr>").count(), html.matches("scope=\"col\"").count()),
            (4, 3)
        );
        for part in [
            "single &lt;1&gt;",
            "0.25 ✕ ↕",
            "3e-5",
            "no &quot;planes&quot;",
            "p999 error: 0.500",
            "--heat:64%",
            ">0.01</td>",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        assert!(!html.contains("<svg"));
        assert!(section(&Found::default()).is_none());
    }

    #[test]
    fn sweeps_are_drawn() {
        let point = |method: &str, x: f64, mse: f64| {
            json!({ "kind": "sweep", "point": { "method": method,
            "sweep": "half_range", "x": x, "mse": mse } })
        };
        let rows = json!([point("a", 0.5, 1e-4), point("a", 1e-3, 1e-6), point("b", 0.5, 1e-5),
            { "sweep": "half_range", "x": "wide" }]);
        let html = section(&found("results.json", json!({ "command": "stress", "results": rows }))).unwrap();
        assert!(
            html.matches("<svg class=\"chart\"").count() == 1
                && html.contains("T-MSE against half range")
                && html.contains("; 2 methods.")
        );
    }
}
