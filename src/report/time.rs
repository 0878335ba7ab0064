//! The section of run time against error: a scatter for each adapter and scene, with the Pareto front.

use super::find::{Document, Found};
use super::html::{Cell, Table, number};
use super::scenes::Scene;
use super::value::{bits as bits_of, number as number_of, numbers, text};
use crate::chart::{self, Tradeoff};
use serde_json::Value;

/// A method's time and error.
#[derive(Debug, Clone)]
struct Timed {
    method: String,
    /// Time of pass 2 and its extremes \[ms\].
    pass_2: f64,
    spread: Option<(f64, f64)>,
    pass_1: Option<f64>,
    nanoseconds: Option<f64>,
    image_mse: Option<f64>,
    t_mse: Option<f64>,
    flip: Option<f64>,
    bits: Option<f64>,
}

/// What may be compared: one adapter, one list.
struct Group {
    adapter: String,
    scene: String,
    rows: Vec<Timed>,
}

/// Whether a result is of `nmt bench methods`.
pub fn is_timed(result: &Value) -> bool {
    text(result, &["benchmark"]).map_or(text(result, &["method"]).is_some(), |b| b == "methods")
}

fn of(result: &Value) -> Option<Timed> {
    let ms = |keys: &[&str]| number_of(result, keys).map(|s| 1e3 * s);
    let nanoseconds = number_of(
        result,
        &[
            "nanoseconds_per_fragment_weights",
            "weights_nanoseconds_per_fragment",
            "nanoseconds_per_fragment_pass_2",
            "nanoseconds_per_fragment",
        ],
    );
    let raw = numbers(
        result,
        &[
            "raw_seconds_weights",
            "raw_weights_seconds",
            "raw_seconds_pass_2",
            "raw_seconds",
        ],
    );
    let ends = raw.iter().fold(None, |ends: Option<(f64, f64)>, &s| {
        Some(ends.map_or((s, s), |(a, b)| (a.min(s), b.max(s))))
    });
    let fragments = number_of(result, &["fragments"]);
    let pass_2 = ms(&["seconds_weights", "seconds_pass_2", "seconds_pass2", "seconds"])
        .or(nanoseconds.zip(fragments).map(|(ns, n)| 1e-6 * ns * n))?;
    Some(Timed {
        method: text(result, &["method"])?.to_owned(),
        pass_2,
        spread: ends.map(|(a, b)| (1e3 * a, 1e3 * b)),
        pass_1: ms(&["seconds_accumulate", "seconds_pass_1", "seconds_pass1"]),
        nanoseconds: nanoseconds.or(fragments.filter(|n| *n > 0.0).map(|n| 1e6 * pass_2 / n)),
        image_mse: number_of(result, &["image_mse"]),
        t_mse: number_of(result, &["transmittance_mse"]),
        flip: number_of(result, &["flip_mean"]),
        bits: bits_of(result),
    })
}

fn groups(documents: &[&Document]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for document in documents {
        let cpu = document
            .value
            .get("machine")
            .and_then(|m| text(m, &["cpu"]))
            .unwrap_or("CPU");
        for result in document.results().iter().filter(|r| is_timed(r)) {
            let Some(timed) = of(result) else { continue };
            let adapter = text(result, &["adapter", "backend"]).unwrap_or(cpu);
            let scene = text(result, &["scene", "fragments_file", "list"]).unwrap_or("");
            let scene = if documents.len() > 1 {
                format!("{}{scene}", document.folder())
            } else {
                scene.to_owned()
            };
            match groups.iter_mut().find(|g| g.adapter == adapter && g.scene == scene) {
                Some(group) => group.rows.push(timed),
                None => groups.push(Group {
                    adapter: adapter.to_owned(),
                    scene,
                    rows: vec![timed],
                }),
            }
        }
    }
    groups
}

/// Places of those rows that no other beats in both: faster and no worse, or better and no slower.
fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len())
        .filter(|&i| points[i].0.is_finite() && points[i].1.is_finite())
        .collect();
    order.sort_by(|&a, &b| {
        points[a]
            .0
            .total_cmp(&points[b].0)
            .then(points[a].1.total_cmp(&points[b].1))
    });
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i].1 < best;
        best = best.min(points[i].1);
        better
    });
    order
}

/// The section. Where nothing was benchmarked, the times of `nmt evaluate` stand in, and it says so.
pub fn section(found: &Found, scenes: &[Scene]) -> Option<String> {
    let documents: Vec<&Document> = found.of("bench").filter(|d| d.results().iter().any(is_timed)).collect();
    let measured = groups(&documents);
    let benchmarked = !measured.is_empty();
    let groups = if benchmarked {
        measured
    } else {
        scenes.iter().map(of_scene).filter(|g| !g.rows.is_empty()).collect()
    };
    let mut out = String::new();
    for group in &groups {
        out += &format!("<div>{}</div>\n", group.html());
    }
    if out.is_empty() {
        return None;
    }
    let note = if benchmarked {
        "Medians; only rows of one adapter and one fragment list may be compared."
    } else {
        "Times of nmt evaluate: one run of the reference implementation on the CPU, classic methods in f64 and \
            networks in f32. For figures that hold, measure \
         with nmt bench methods."
    };
    Some(format!(
        "<p>{note} Filled marks and the thin line are the Pareto front: nothing else is both faster and better.</p>\n\
            <div class=\"plots\">{out}</div>"
    ))
}

fn of_scene(scene: &Scene) -> Group {
    let rows = scene.methods.iter().filter_map(|m| {
        let pass_2 = 1e3 * m.seconds[1]?;
        let nanoseconds = scene.fragments.filter(|n| *n > 0.0).map(|n| 1e6 * pass_2 / n);
        Some(Timed {
            method: m.name.clone(),
            pass_2,
            spread: None,
            pass_1: m.seconds[0].map(|s| 1e3 * s),
            nanoseconds,
            image_mse: m.image_mse,
            t_mse: m.t_mse,
            flip: m.flip,
            bits: m.bits,
        })
    });
    Group {
        adapter: "CPU, reference implementation".to_owned(),
        scene: scene.label.clone(),
        rows: rows.collect(),
    }
}

impl Group {
    fn html(&self) -> String {
        let by_image = self.rows.iter().any(|r| r.image_mse.is_some_and(f64::is_finite));
        let (error, name): (fn(&Timed) -> Option<f64>, &str) = if by_image {
            (|r| r.image_mse, "image MSE")
        } else {
            (|r| r.t_mse, "T-MSE")
        };
        let points: Vec<(f64, f64)> = self
            .rows
            .iter()
            .map(|r| (r.pass_2, error(r).unwrap_or(f64::NAN)))
            .collect();
        let front = front(&points);
        let place = if self.scene.is_empty() {
            self.adapter.clone()
        } else {
            format!("{}, {}", self.scene, self.adapter)
        };
        let caption = format!("{place}: time of pass 2 against {name}");

        let methods: Vec<Tradeoff> = self
            .rows
            .iter()
            .enumerate()
            .map(|(i, r)| Tradeoff {
                name: r.method.clone(),
                cost: r.pass_2,
                spread: r.spread,
                error: points[i].1,
                on_front: front.contains(&i),
                network: r.method.starts_with("neural:"),
                title: format!("{}: {} ms, {name} {}", r.method, number(r.pass_2), number(points[i].1)),
            })
            .collect();
        let names = self.names(&front);
        let summary = format!("{caption}, {} methods; on the Pareto front: {names}.", self.rows.len());
        let chart = chart::tradeoffs(summary, "time of pass 2 [ms]", name, &methods);
        let head = [
            "method",
            "pass 2 ms",
            "ns/fragment",
            "pass 1 ms",
            "bits/pixel",
            "image MSE",
            "FLIP",
            "T-MSE",
            "Pareto front",
        ];
        let mut table = Table::new(&format!("{place}: numbers"), &head);
        for (i, r) in self.rows.iter().enumerate() {
            table.row(vec![
                Cell::text(&r.method),
                Cell::number(Some(r.pass_2)),
                Cell::number(r.nanoseconds),
                Cell::number(r.pass_1),
                Cell::bits(r.bits),
                Cell::number(r.image_mse),
                Cell::number(r.flip),
                Cell::number(r.t_mse),
                Cell::text(if front.contains(&i) { "yes" } else { "" }),
            ]);
        }
        chart::figure(&chart, &caption).unwrap_or_default()
            + &super::html::details(&format!("{place}: numbers"), &table.html())
    }

    fn names(&self, rows: &[usize]) -> String {
        rows.iter()
            .map(|&i| self.rows[i].method.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::{scenes, tests::found};
    use serde_json::json;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [
            (1.0, 5.0),
            (2.0, 3.0),
            (2.0, 4.0),
            (3.0, 3.0),
            (4.0, 1.0),
            (5.0, 1.0),
            (0.5, f64::NAN),
            (f64::NAN, 0.0),
        ];
        assert_eq!(front(&points), [0, 1, 4]);
        assert!(front(&[]).is_empty());
        // Control: a point that is slower and worse is never on it.
        assert!(!front(&points).contains(&3));
    }

    #[test]
    fn adapters_and_scenes_stand_apart() {
        let row = |method: &str, adapter: &str, s: f64, e: Value| {
            json!({ "benchmark": "methods", "method": method, "adapter": adapter, "scene": "hair",
                "seconds_weights": s, "raw_seconds_weights": [s, 2.0 * s, "x"],
                "image_mse": e, "bits_per_pixel": 368, "fragments": 1000 })
        };
        let rows = json!([row("neural:small", "gpu <0>", 1e-3, json!(1e-5)), row("moment-power-8", "gpu <0>", 2e-3,
            json!(2e-5)), row("m", "cpu", 1.0, json!(null)),
            row("n", "cpu", 2.0, json!(1e-4)), { "benchmark": "train", "method": "x" }, { "benchmark": "methods" }, 3]);
        let found = found("b/results.json", json!({ "command": "bench", "results": rows }));
        let html = section(&found, &[]).unwrap();
        assert!(
            !html.contains("Times of nmt evaluate") && html.matches("<svg class=\"chart\"").count() == 2,
            "{html}"
        );
        assert!(html.contains("hair, gpu &lt;0&gt;: time of pass 2 against image MSE"));
        assert!(
            html.contains("on the Pareto front: neural:small.")
                && html.contains("neural:small: 1 ms, image MSE 1.00e-5")
        );
        // 1 ms for 1000 fragments are 1000 ns each.
        assert!(html.contains(">1,000<"));
    }

    #[test]
    fn evaluations_stand_in_and_say_so() {
        let row = json!({ "scene": "s", "method": "m", "image_mse": 1e-3, "seconds_weights": 0.5, "fragments": 10 });
        let found = found("results.json", json!({ "command": "evaluate", "results": [row] }));
        let html = section(&found, &scenes(&found)).unwrap();
        assert!(html.contains("Times of nmt evaluate"));
        assert!(section(&Found::default(), &[]).is_none());
    }
}
