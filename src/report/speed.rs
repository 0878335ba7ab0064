//! The section of `nmt bench train|generate|infer`: medians, spreads and the raw samples.

use super::find::Found;
use super::html::{Cell, Table, number};
use super::time::is_timed;
use super::value::{number as number_of, numbers, text};
use serde_json::Value;

/// The section; none where no file holds such results.
pub fn section(found: &Found) -> Option<String> {
    let mut out = String::new();
    for document in found.of("bench") {
        let rows: Vec<&Value> = document
            .results()
            .iter()
            .filter(|r| !is_timed(r) && r.is_object())
            .collect();
        if rows.is_empty() {
            continue;
        }
        let head = [
            "benchmark",
            "what",
            "backend",
            "batch",
            "per second",
            "median ms",
            "least",
            "greatest",
            "MAD",
            "of peak",
            "raw samples",
        ];
        let mut table = Table::new(&document.name, &head);
        for row in rows {
            let ms = |key: &str| Cell::number(number_of(row, &[key]).map(|s| 1e3 * s));
            table.row(vec![
                Cell::text(text(row, &["benchmark"]).unwrap_or("–")),
                Cell::text(text(row, &["network", "config", "name"]).unwrap_or("–")),
                Cell::text(text(row, &["backend", "features"]).unwrap_or("–")),
                Cell::number(number_of(row, &["batch", "pairs_per_call"])),
                rate(row),
                ms("seconds"),
                ms("min_seconds"),
                ms("max_seconds"),
                ms("mad_seconds"),
                Cell::shown(number_of(row, &["share_of_peak"]), |s| format!("{:.1} %", 100.0 * s)),
                strip(&numbers(row, &["raw_seconds"])),
            ]);
        }
        out += &table.html();
    }
    (!out.is_empty()).then(|| {
        format!(
            "{out}<p class=\"note\">Raw samples run from 0 at the left to the row's slowest repetition at \
            the right.</p>\n"
        )
    })
}

/// The first rate of a row, with its unit.
fn rate(row: &Value) -> Cell {
    let keys = [
        "samples_per_second",
        "pairs_per_second",
        "fragments_per_second",
        "rows_per_second",
    ];
    let found = keys
        .iter()
        .find_map(|key| Some((number_of(row, &[key])?, key.strip_suffix("_per_second")?)));
    match found {
        None => Cell::number(None),
        Some((x, unit)) if x >= 1e6 => Cell::shown(Some(x), |x| format!("{} M {unit}", number(x / 1e6))),
        Some((x, unit)) => Cell::shown(Some(x), |x| format!("{} {unit}", number(x))),
    }
}

/// Most samples that are drawn.
const MAX_SAMPLES: usize = 200;

/// Samples as short strokes along a line.
fn strip(samples: &[f64]) -> Cell {
    let greatest = samples.iter().copied().fold(0.0, f64::max);
    if samples.is_empty() || !(greatest > 0.0 && greatest.is_finite()) {
        return Cell::number(None);
    }
    let strokes: String = samples
        .iter()
        .take(MAX_SAMPLES)
        .map(|s| format!("M{:.1} 3V13", 2.0 + 116.0 * (s / greatest).clamp(0.0, 1.0)))
        .collect();
    let label = format!("{} samples", samples.len());
    Cell::svg(&format!(
        "<svg class=\"strip\" viewBox=\"0 0 120 16\" width=\"120\" height=\"16\" role=\"img\" \
            aria-label=\"{label}\"><path d=\"{strokes}\"/></svg>"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::tests::found;
    use serde_json::json;

    #[test]
    fn medians_spreads_and_samples() {
        let rows = json!([
            { "benchmark": "train", "network": "7-32-16-1", "backend": "fused", "batch": 8192,
                "samples_per_second": 32.5e6, "seconds": 2.5e-4, "min_seconds": 2e-4,
              "max_seconds": 5e-4, "mad_seconds": 1e-5, "share_of_peak": 0.321, "raw_seconds": [2e-4, 2.5e-4, 5e-4,
                  null] },
            { "benchmark": "generate", "config": "<paper>", "pairs_per_second": 900.0, "raw_seconds": "none" },
            { "benchmark": "methods", "method": "elsewhere" }, "junk",
        ]);
        let html = section(&found("train.json", json!({ "command": "bench", "results": rows }))).unwrap();
        for part in [
            "7-32-16-1",
            "8,192",
            "32.5 M samples",
            "0.250",
            "32.1 %",
            "3 samples",
            "M48.4 3V13",
            "&lt;paper&gt;",
            "900 pairs",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        assert!(!html.contains("elsewhere") && html.matches("<tr>").count() == 3);
        assert!(section(&Found::default()).is_none());
    }
}
