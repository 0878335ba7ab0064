//! The sections of `nmt evaluate`'s numbers: tables of errors, and errors against depth complexity and alpha.

use super::html::{Cell, Table, details, escape, number, thousands};
use super::scenes::{Bin, Method, Scene, chosen};
use crate::chart::{self, Axis, COLORS, Chart, Mark, Point, Scale, Series};

/// Tables of all methods, a scene each.
pub fn tables(scenes: &[Scene]) -> String {
    let mut out = String::new();
    for (i, scene) in scenes.iter().enumerate() {
        let mut size = String::new();
        if let (Some(fragments), Some(most)) = (scene.fragments, scene.depth_complexity) {
            size = format!(
                ": {} fragments, at most {} in a pixel",
                thousands(fragments as i64),
                thousands(most as i64)
            );
        }
        let head = [
            "method",
            "image MSE",
            "PSNR dB",
            "FLIP",
            "T-MSE",
            "worst error of T",
            "not finite",
            "bits/pixel",
            "pass 1 ms",
            "pass 2 ms",
        ];
        let mut table = Table::new(&format!("{}{size}; sorted by image MSE", scene.label), &head);
        for m in &scene.methods {
            let name = Cell::text(&m.name);
            let ms = |s: Option<f64>| Cell::shown(s, |s| number(1e3 * s));
            table.row(vec![
                if m.is_network() { name.classed("network") } else { name },
                Cell::shown(m.image_mse, error_text),
                Cell::shown(m.psnr, |x| if x.is_finite() { format!("{x:.1}") } else { number(x) }),
                Cell::shown(m.flip, flip_text),
                Cell::shown(m.t_mse, error_text),
                Cell::number(m.t_worst),
                Cell::number(Some(m.nonfinite)).classed(if m.nonfinite > 0.0 { "bad" } else { "" }),
                Cell::bits(m.bits),
                ms(m.seconds[0]),
                ms(m.seconds[1]),
            ]);
        }
        let mut html = if table.is_empty() { String::new() } else { table.html() };
        for (name, why) in &scene.refused {
            html += &format!(
                "<p class=\"note\">{} was not applied: {}</p>\n",
                escape(name),
                escape(why)
            );
        }
        out += &if i == 0 {
            html
        } else {
            details(&format!("{}{size}", scene.label), &html)
        };
    }
    out + "<p class=\"note\">Image MSE is the mean over all pixels and channels, unclamped, against the exact image; \
        T-MSE is over all fragments. \
        Times are of one run of the reference implementation in f64 (networks in f32); they compare no renderers.</p>\n"
}

/// A mean squared error, in one notation wherever one stands.
pub(super) fn error_text(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        number(x)
    } else {
        format!("{x:.2e}")
    }
}

/// A mean of a FLIP map.
pub(super) fn flip_text(x: f64) -> String {
    if x.is_nan() { number(x) } else { format!("{x:.4}") }
}

/// Charts of errors by fragments in a pixel and by alpha; none where no file has the numbers.
pub fn curves(scenes: &[Scene]) -> Option<String> {
    let binned = |m: &Method| !m.by_count.is_empty() || !m.by_alpha.is_empty();
    let scenes: Vec<&Scene> = scenes.iter().filter(|s| s.methods.iter().any(binned)).collect();
    if scenes.is_empty() {
        return None;
    }
    let all: Vec<Scene> = scenes
        .iter()
        .map(|s| Scene {
            methods: s.methods.clone(),
            ..Scene::default()
        })
        .collect();
    let names = chosen(&all, COLORS);
    let mut out = String::new();
    for (i, scene) in scenes.iter().enumerate() {
        let html = charts(scene, &names);
        out += &if i == 0 { html } else { details(&scene.label, &html) };
    }
    let total: std::collections::BTreeSet<&str> = scenes
        .iter()
        .flat_map(|s| s.methods.iter().map(|m| m.name.as_str()))
        .collect();
    Some(format!(
        "<p>Where a method errs: {} of {} methods, networks first, then the best of each kind over all scenes; exact \
            ones have no curve. Colours and marks \
         are the same in every chart; the lowest line holds all that is smaller, 0 too.</p>\n{out}",
        names.len(),
        total.len()
    ))
}

/// An error against what it is grouped by.
struct Curve {
    error: &'static str,
    along: &'static str,
    pick: Pick,
    value: Value,
    text: Text,
}

const CURVES: [Curve; 3] = [
    Curve {
        error: "T-MSE",
        along: "fragments in the pixel",
        pick: |m| &m.by_count,
        value: |b| b.t_mse,
        text: count_text,
    },
    Curve {
        error: "image MSE",
        along: "fragments in the pixel",
        pick: |m| &m.by_count,
        value: |b| b.image_mse,
        text: count_text,
    },
    Curve {
        error: "T-MSE",
        along: "alpha of the fragment",
        pick: |m| &m.by_alpha,
        value: |b| b.t_mse,
        text: alpha_text,
    },
];

/// The charts of a scene, and the tables of all their numbers.
fn charts(scene: &Scene, names: &[String]) -> String {
    let (mut plots, mut tables) = (String::new(), String::new());
    for curve in &CURVES {
        let bins = all_bins(scene, curve.pick, curve.value);
        if bins.is_empty() {
            continue;
        }
        let labels: Vec<String> = bins.iter().map(|&ends| (curve.text)(ends)).collect();
        let caption = format!("{}: {} against {}", scene.label, curve.error, curve.along);
        let series = curve.series(scene, names, &bins, &labels);
        let chart = Chart {
            summary: format!(
                "{caption}; {} methods. The numbers stand in the table below.",
                series.len()
            ),
            x: Axis {
                label: curve.along.to_owned(),
                scale: Scale::Names(labels.clone()),
            },
            y: Axis {
                label: curve.error.to_owned(),
                scale: Scale::Log { decades: 7 },
            },
            series,
        };
        plots += &chart::figure(&chart, &caption).unwrap_or_default();
        tables += &curve.table(scene, &caption, &bins, &labels);
    }
    format!("<div class=\"plots\">{plots}</div>{}", details("All numbers", &tables))
}

impl Curve {
    /// The methods of these names that have a finite error, each in its name's colour.
    fn series(&self, scene: &Scene, names: &[String], bins: &[(f64, f64)], labels: &[String]) -> Vec<Series> {
        let mut series = Vec::new();
        for (color, name) in names.iter().enumerate() {
            let Some(method) = scene.methods.iter().find(|m| m.name == *name) else {
                continue;
            };
            let point = |(x, ends): (usize, &(f64, f64))| {
                let bin = (self.pick)(method).iter().find(|b| same(b.ends, *ends))?;
                let y = (self.value)(bin)?;
                let count = bin
                    .fragments
                    .map_or(String::new(), |n| format!(", {} fragments", thousands(n as i64)));
                Some(Point {
                    x: x as f64,
                    y,
                    spread: None,
                    title: format!("{name}, {}: {} {}{count}", labels[x], self.error, number(y)),
                })
            };
            let points: Vec<Point> = bins.iter().enumerate().filter_map(point).collect();
            if points.iter().any(|p| p.y.is_finite()) {
                series.push(Series {
                    name: name.clone(),
                    points,
                    mark: Mark::LineAndPoints,
                    color,
                });
            }
        }
        series
    }

    /// The errors of all methods that have any.
    fn table(&self, scene: &Scene, caption: &str, bins: &[(f64, f64)], labels: &[String]) -> String {
        let labels = labels.iter().map(String::as_str);
        let head: Vec<&str> = std::iter::once("method").chain(labels).collect();
        let mut table = Table::new(&format!("{caption}, all methods"), &head);
        for method in &scene.methods {
            let of = |ends: &(f64, f64)| {
                let bin = (self.pick)(method).iter().find(|b| same(b.ends, *ends));
                bin.and_then(self.value)
            };
            if bins.iter().any(|ends| of(ends).is_some()) {
                let cells = bins.iter().map(|ends| Cell::number(of(ends)));
                table.row(std::iter::once(Cell::text(&method.name)).chain(cells).collect());
            }
        }
        table.html()
    }
}

type Pick = fn(&Method) -> &Vec<Bin>;
type Value = fn(&Bin) -> Option<f64>;
type Text = fn((f64, f64)) -> String;

fn same(a: (f64, f64), b: (f64, f64)) -> bool {
    a.0 == b.0 && a.1 == b.1
}

/// Most bins that are shown.
const MAX_BINS: usize = 40;

/// The bins of all methods, in order.
fn all_bins(scene: &Scene, pick: Pick, value: Value) -> Vec<(f64, f64)> {
    let mut bins: Vec<(f64, f64)> = Vec::new();
    for bin in scene.methods.iter().flat_map(pick).filter(|b| value(b).is_some()) {
        if !bins.iter().any(|&b| same(b, bin.ends)) && bins.len() < MAX_BINS {
            bins.push(bin.ends);
        }
    }
    bins.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    bins
}

fn count_text((low, high): (f64, f64)) -> String {
    if low == high {
        format!("{low:.0}")
    } else {
        format!("{low:.0}–{high:.0}")
    }
}

fn alpha_text((low, high): (f64, f64)) -> String {
    format!("{low:.1}–{high:.1}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::{scenes, tests::found};
    use serde_json::json;

    fn sample() -> Vec<Scene> {
        let bin = |least: u64, most: u64, t: f64| {
            json!({ "least_fragments_per_pixel": least,
            "most_fragments_per_pixel": most, "pixels": 3, "fragments": 9, "transmittance_mse": t, "image_mse": 1e-3 })
        };
        let row = |method: &str, t: f64| {
            json!({ "scene": "s", "method": method, "image_mse": t, "image_psnr_db": 30.5, "flip_mean": 0.0123,
                "transmittance_mse": t, "nonfinite": 0,
                "bits_per_pixel": null, "seconds_accumulate": 0.001, "seconds_weights": 0.25, "fragments": 12345,
                    "depth_complexity": 8,
                "by_fragments_per_pixel": [bin(1, 1, 0.0), bin(5, 8, t)], "by_alpha": [{ "least_alpha": 0.1,
                    "most_alpha": 0.2, "fragments": 9, "transmittance_mse": t }] })
        };
        scenes(&found(
            "results.json",
            json!({ "command": "evaluate", "results": [row("b<", 2.5e-3), row("neural:a", 1e-3)] }),
        ))
    }

    #[test]
    fn numbers_stand_in_the_table() {
        let html = tables(&sample());
        assert!(html.contains("12,345 fragments, at most 8 in a pixel"));
        for part in [
            "1.00e-3",
            "30.5",
            "0.0123",
            "2.50e-3",
            "unbounded",
            ">250<",
            "neural:a",
            "b&lt;",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        assert!(html.find("neural:a").unwrap() < html.find("b&lt;").unwrap());
    }

    #[test]
    fn curves_have_a_point_a_bin_and_all_numbers_beside_them() {
        let html = curves(&sample()).unwrap();
        assert_eq!(html.matches("<svg class=\"chart\"").count(), 3);
        for part in [
            "b&lt;, 5–8: T-MSE 2.50e-3, 9 fragments",
            "0.1–0.2",
            "≤1e-",
            "All numbers",
            "2 of 2 methods",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        // Results of an older version have no bins.
        let old = found(
            "results.json",
            json!({ "command": "evaluate", "results": [{ "scene": "s", "method": "m", "image_mse": 0.5 }] }),
        );
        assert!(curves(&scenes(&old)).is_none() && curves(&[]).is_none());
    }
}
