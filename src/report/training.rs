//! The section of training: what each network is, and its losses epoch by epoch.

use super::find::{Document, Found};
use super::html::{definitions, escape, number, thousands};
use super::value::{number as number_of, text};
use crate::chart::{self, Axis, Chart, Mark, Point, Scale, Series};
use serde_json::Value;
use std::collections::BTreeSet;

/// Epochs and losses of a training.
struct Losses {
    rows: Vec<[f64; 3]>,
    /// Lines that are not such.
    bad: usize,
}

impl Losses {
    /// Reads what `nmt train` writes; columns are found by name.
    fn of(csv: &str) -> Option<Self> {
        let mut lines = csv.lines();
        let head: Vec<&str> = lines.next()?.split(',').map(str::trim).collect();
        let column = |name: &str| head.iter().position(|h| *h == name);
        let columns = [column("epoch")?, column("training_loss")?, column("validation_loss")?];
        let mut losses = Self {
            rows: Vec::new(),
            bad: 0,
        };
        for line in lines.filter(|l| !l.trim().is_empty()) {
            let cells: Vec<&str> = line.split(',').collect();
            let row = columns.map(|c| cells.get(c).and_then(|t| t.trim().parse::<f64>().ok()));
            match row {
                [Some(epoch), Some(training), Some(validation)] if epoch.is_finite() => {
                    losses.rows.push([epoch, training, validation])
                }
                _ => losses.bad += 1,
            }
        }
        Some(losses)
    }
}

/// Names under which a model stands in the folder, the one with losses beside it first.
fn names<'a>(found: &'a Found, model: &'a Document) -> (&'a str, Option<(&'a str, &'a str)>) {
    let copies = found
        .copies
        .iter()
        .filter(|(_, first)| *first == model.name)
        .map(|(copy, _)| copy.as_str());
    for name in std::iter::once(model.name.as_str()).chain(copies) {
        let beside = format!("{}.losses.csv", name.strip_suffix(".json").unwrap_or(name));
        if let Some((losses, csv)) = found.losses.get_key_value(&beside) {
            return (name, Some((losses, csv)));
        }
    }
    (&model.name, None)
}

/// The section; none where there is neither a model nor losses. What is wrong in a file goes to `problems`.
pub fn section(found: &Found, problems: &mut Vec<(String, String)>) -> Option<String> {
    let mut out = String::new();
    let mut used = BTreeSet::new();
    for model in found.documents.iter().filter(|d| d.is_model()) {
        let (name, losses) = names(found, model);
        let p = model.value.get("provenance").unwrap_or(&Value::Null);
        out += &format!(
            "<article class=\"card\"><h3>{}</h3>\n",
            escape(text(&model.value, &["name"]).unwrap_or(name))
        );
        out += &definitions(&facts(model, p, name));
        if let Some((file, csv)) = losses {
            used.insert(file);
            out += &curves(file, csv, number_of(p, &["best_epoch"]), problems);
        }
        out += "</article>\n";
    }
    for (file, csv) in found.losses.iter().filter(|(file, _)| !used.contains(file.as_str())) {
        let curves = curves(file, csv, None, problems);
        if !curves.is_empty() {
            out += &format!(
                "<article class=\"card\"><h3>{}</h3>\n{curves}</article>\n",
                escape(file)
            );
        }
    }
    (!out.is_empty()).then_some(out)
}

/// What is known of a model.
fn facts(model: &Document, p: &Value, name: &str) -> Vec<(&'static str, String)> {
    let mut facts = vec![("file", name.to_owned())];
    let sizes = super::value::numbers(&model.value, &["layer_sizes"]);
    if !sizes.is_empty() {
        facts.push((
            "network",
            sizes.iter().map(|s| format!("{s:.0}")).collect::<Vec<_>>().join("-"),
        ));
    }
    facts.extend(text(&model.value, &["feature_set"]).map(|t| ("features", t.to_owned())));
    for (label, key) in [
        ("T-MSE on fresh pixels", "transmittance_mse"),
        ("worst error of T there", "transmittance_worst_error"),
        ("validation loss", "validation_loss"),
        ("training loss", "training_loss"),
    ] {
        facts.extend(number_of(p, &[key]).map(|x| (label, number(x))));
    }
    if let (Some(best), Some(epochs)) = (number_of(p, &["best_epoch"]), number_of(p, &["epochs"])) {
        facts.push((
            "best epoch",
            format!("{} of {}", thousands(best as i64), thousands(epochs as i64)),
        ));
    }
    facts.extend(text(p, &["backend"]).map(|t| ("trained by", t.to_owned())));
    facts
}

fn curves(file: &str, csv: &str, best: Option<f64>, problems: &mut Vec<(String, String)>) -> String {
    let Some(losses) = Losses::of(csv) else {
        problems.push((
            file.to_owned(),
            "has no columns epoch, training_loss, validation_loss; train again to write it anew".to_owned(),
        ));
        return String::new();
    };
    if losses.bad > 0 {
        problems.push((
            file.to_owned(),
            format!("{} lines are no losses and left out", losses.bad),
        ));
    }
    let series = |name: &str, column: usize, color: usize| {
        let points = losses
            .rows
            .iter()
            .map(|r| Point {
                x: r[0],
                y: r[column],
                spread: None,
                title: String::new(),
            })
            .collect();
        Series {
            name: name.to_owned(),
            points,
            mark: Mark::Line,
            color,
        }
    };
    let mut all = vec![series("training", 1, 4), series("validation", 2, 0)];
    let row = best.and_then(|best| losses.rows.iter().find(|r| r[0] == best));
    if let Some(&[epoch, _, loss]) = row {
        let title = format!("best epoch {epoch:.0}: validation loss {}", number(loss));
        all.push(Series {
            name: format!("best: {}", number(loss)),
            points: vec![Point {
                x: epoch,
                y: loss,
                spread: None,
                title,
            }],
            mark: Mark::Filled,
            color: 0,
        });
    }
    let last = losses.rows.last().map_or(String::new(), |r| {
        format!("; at the end {} and {}", number(r[1]), number(r[2]))
    });
    let chart = Chart {
        summary: format!(
            "Training and validation loss over {} epochs{last}.",
            thousands(losses.rows.len() as i64)
        ),
        x: Axis {
            label: "epoch".to_owned(),
            scale: Scale::Linear,
        },
        y: Axis {
            label: "mean squared error".to_owned(),
            scale: Scale::Log { decades: 8 },
        },
        series: all,
    };
    chart::figure(
        &chart,
        &format!("{file}: losses over {} epochs", thousands(losses.rows.len() as i64)),
    )
    .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scenes::tests::found;
    use serde_json::json;

    #[test]
    fn a_model_finds_its_losses_and_its_best_epoch() {
        let model = json!({ "format": "nmt-model", "name": "tiny", "feature_set": "paper", "layer_sizes": [7, 8, 1],
            "provenance": { "epochs": 3, "best_epoch": 2, "transmittance_mse": 5.25e-3, "backend": "fused" } });
        let mut found = found("exports/tiny.json", model);
        found
            .copies
            .push(("model.json".to_owned(), "exports/tiny.json".to_owned()));
        found.losses.insert(
            "model.losses.csv".to_owned(),
            "epoch,training_loss,validation_loss\n1,1e-2,2e-2\n2,5e-3,6e-3\n3,4e-3,7e-3\n".to_owned(),
        );
        found.losses.insert(
            "other.losses.csv".to_owned(),
            "epoch,lr,training_loss,validation_loss\n1,9,nan,2e-2\nx\n".to_owned(),
        );
        found
            .losses
            .insert("wrong.losses.csv".to_owned(), "a,b\n1,2\n".to_owned());
        let mut problems = Vec::new();
        let html = section(&found, &mut problems).unwrap();
        for part in [
            "<h3>tiny</h3>",
            "model.json",
            "7-8-1",
            "5.25e-3",
            "2 of 3",
            "best epoch 2: validation loss 6.00e-3",
            "at the end 4.00e-3 and 7.00e-3",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        assert_eq!(
            html.matches("<svg class=\"chart\"").count(),
            2,
            "NaN is left out, the rest drawn"
        );
        assert_eq!(
            problems.iter().map(|p| p.0.as_str()).collect::<Vec<_>>(),
            ["other.losses.csv", "wrong.losses.csv"]
        );
        assert!(section(&Found::default(), &mut problems).is_none());
    }

    #[test]
    fn models_of_odd_types_make_no_panic() {
        let odd = json!({ "format": "nmt-model", "name": 5, "layer_sizes": "x", "provenance": [1, 2] });
        assert!(
            section(&found("m.json", odd), &mut Vec::new())
                .unwrap()
                .contains("m.json")
        );
    }
}
