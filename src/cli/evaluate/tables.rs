//! Results as text: a table a scene, and one over all scenes.

use super::{Row, SceneResults};
use crate::cli::ui::table;
use crate::evaluate::gpu;
use crate::evaluate::order::spread;
use crate::evaluate::{MethodResult, Shuffled};
use crate::gpu::Gpu;
use crate::oit::Capabilities;
use crate::shader::passes::TargetPrecision;

/// What marks a method whose image depends on the order of the fragments.
const ORDER_MARK: &str = "†";

fn cells<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

fn number(x: Option<f64>, text: impl Fn(f64) -> String) -> String {
    match x {
        None => "-".to_owned(),
        Some(x) if x.is_nan() => "NaN".to_owned(),
        Some(x) => text(x),
    }
}

/// The name, marked where order counts.
fn name(method: &str, capabilities: &Capabilities) -> String {
    let mark = if capabilities.order_dependent { ORDER_MARK } else { "" };
    format!("{method}{mark}")
}

/// Whether two results are the same to the bit, in all that the table shows.
fn equal(a: &MethodResult, b: &MethodResult) -> bool {
    let bits = |r: &MethodResult| {
        [
            r.image_mse,
            r.flip_mean,
            r.transmittance_mse,
            r.transmittance_worst_error,
        ]
        .map(|x| x.map(f64::to_bits))
    };
    bits(a) == bits(b) && bits(a).iter().any(Option::is_some) && a.capabilities == b.capabilities
}

/// Results in the order in which they stand. A method that was not asked for by its own name and equals one above it is
/// named in its row.
pub(super) fn rows(results: &[Row]) -> String {
    let mut lines = vec![cells([
        "method",
        "image MSE",
        "PSNR dB",
        "FLIP",
        "T-MSE",
        "worst T",
        "non-finite",
        "bits/pixel",
        "colour",
        "passes",
        "needs",
    ])];
    let moving = results.iter().any(|r| r.cpu.over_time.is_some());
    if moving {
        lines[0].extend(cells(["frame change", "worst change"]));
    }
    let mut shown: Vec<&MethodResult> = Vec::new();
    let mut notes = String::new();
    for row in results {
        let r = &row.cpu;
        if let Some(same) = shown.iter().find(|s| !row.demanded && equal(s, r)) {
            notes += &format!("{} equals {} here\n", r.method, same.method);
            continue;
        }
        shown.push(r);
        let mut line = vec![
            name(&r.method, &r.capabilities),
            number(r.image_mse, |x| format!("{x:.2e}")),
            number(r.image_psnr_db, |x| format!("{x:.1}")),
            number(r.flip_mean, |x| format!("{x:.4}")),
            number(r.transmittance_mse, |x| format!("{x:.2e}")),
            number(r.transmittance_worst_error, |x| format!("{x:.3}")),
            r.nonfinite.to_string(),
            r.capabilities.bits_text(),
            r.capabilities.colour_bits_per_pixel.to_string(),
            r.capabilities.geometry_passes.to_string(),
            r.capabilities.needs.list(),
        ];
        if moving {
            let change = r.over_time;
            line.push(number(change.and_then(|c| c.frame_change_mse), |x| {
                format!("{:.4}", x * 1e6)
            }));
            line.push(number(change.and_then(|c| c.frame_change_worst), |x| format!("{x:.4}")));
        }
        lines.push(line);
    }
    for r in shown {
        notes += &order_note(r);
    }
    format!("{}{notes}", table(&lines))
}

/// What a method's errors are means of, where order counts.
fn order_note(result: &MethodResult) -> String {
    let (Some((least, greatest)), Some(orders)) = (spread(result), &result.orders) else {
        return String::new();
    };
    let count = |kind| orders.iter().filter(|o| o.shuffled == kind).count();
    let (fragments, objects) = (count(Shuffled::Fragments), count(Shuffled::Objects));
    let of_objects = if objects > 0 {
        format!(" and {objects} of whole objects")
    } else {
        String::new()
    };
    let what = if result.image_mse.is_some() {
        "image MSE"
    } else {
        "T-MSE"
    };
    format!(
        "{ORDER_MARK} {} depends on the order: mean of {fragments} random orders of fragments{of_objects}, {what} from \
            {least:.2e} to {greatest:.2e}\n",
        result.method
    )
}

/// What the GPU drew, as a table under its name.
pub(super) fn gpu_rows(gpu: &Gpu, storage: TargetPrecision, results: &[Row]) -> String {
    if results.iter().all(|r| r.gpu.is_none()) {
        return String::new();
    }
    let milliseconds = |s: f64| format!("{:.2}", s * 1e3);
    let mut lines = vec![cells([
        "method",
        "99.9 % within",
        "worst",
        "FLIP to CPU",
        "image MSE",
        "FLIP",
        "non-finite",
        "pass 1 ms",
        "pass 2 ms",
        "resolve ms",
    ])];
    for r in results.iter().filter_map(|r| r.gpu.as_ref()) {
        lines.push(vec![
            r.method.clone(),
            format!("{:.1e}", r.channel_difference_999),
            format!("{:.1e}", r.channel_difference_worst),
            format!("{:.1e}", r.flip_mean_to_cpu),
            format!("{:.2e}", r.image_mse),
            format!("{:.4}", r.flip_mean),
            r.image_nonfinite.to_string(),
            milliseconds(r.seconds_accumulate),
            milliseconds(r.seconds_weights),
            milliseconds(r.seconds_resolve),
        ]);
    }
    let how = if gpu::is_drawn(gpu, storage) {
        format!("render passes, storage {}", storage.name())
    } else {
        "compute passes, since it cannot blend into f32 targets".to_owned()
    };
    format!("\n{}, {how}, against the images above:\n{}", gpu.name(), table(&lines))
}

/// Errors on tinted glass, the least with three channels first; nothing where none was asked for.
pub(super) fn tinted_rows(results: &[Row]) -> String {
    let mut rows: Vec<_> = results
        .iter()
        .filter_map(|r| Some((&r.cpu.method, r.tinted.as_ref()?)))
        .collect();
    let Some((_, first)) = rows.first() else {
        return String::new();
    };
    let heading = format!("\nglass tinted by {}, image MSE:\n", first.strength);
    rows.sort_by(|a, b| a.1.three_channel_image_mse.total_cmp(&b.1.three_channel_image_mse));
    let mut lines = vec![cells([
        "method",
        "one transmittance",
        "one a channel",
        "bits/pixel of three",
    ])];
    for (method, tinted) in rows {
        lines.push(vec![
            method.clone(),
            number(Some(tinted.scalar_image_mse), |x| format!("{x:.2e}")),
            number(Some(tinted.three_channel_image_mse), |x| format!("{x:.2e}")),
            tinted
                .three_channel_bits_per_pixel
                .map_or("unbounded".to_owned(), |bits| bits.to_string()),
        ]);
    }
    format!("{heading}{}", table(&lines))
}

/// Mean square of an error that nobody sees, a sixteenth of a step of an 8-bit display: what a geometric mean takes for
/// exact.
const INVISIBLE: f64 = (1.0 / (16.0 * 255.0)) * (1.0 / (16.0 * 255.0));

/// A method over all scenes.
pub(super) struct Compared<'a> {
    pub method: &'a str,
    pub capabilities: Capabilities,
    /// Image MSE of each scene, in their order; none where the scene makes no image.
    pub errors: Vec<Option<f64>>,
    /// Geometric mean of the image MSE over the scenes, errors below [`INVISIBLE`] counted as that; none unless every
    /// scene has one that is a number.
    pub mean: Option<f64>,
}

/// Every method that was applied to every scene, the least geometric mean first, what has none last.
pub(super) fn compare(scenes: &[SceneResults]) -> Vec<Compared<'_>> {
    let Some(first) = scenes.first() else { return Vec::new() };
    let of = |row: &'_ Row| -> Option<Vec<Option<f64>>> {
        scenes
            .iter()
            .map(|s| {
                s.rows
                    .iter()
                    .find(|r| r.cpu.method == row.cpu.method)
                    .map(|r| r.cpu.image_mse)
            })
            .collect()
    };
    let mut compared: Vec<Compared<'_>> = first
        .rows
        .iter()
        .filter_map(|row| {
            let errors = of(row)?;
            let logs: Option<Vec<f64>> = errors
                .iter()
                .map(|e| e.map(|e| e.max(INVISIBLE).ln() + 0.0 * e))
                .collect();
            let mean = logs.map(|logs| (logs.iter().sum::<f64>() / logs.len() as f64).exp());
            Some(Compared {
                method: &row.cpu.method,
                capabilities: row.cpu.capabilities,
                errors,
                mean: mean.filter(|m| m.is_finite()),
            })
        })
        .collect();
    compared.sort_by(|a, b| {
        a.mean
            .unwrap_or(f64::INFINITY)
            .total_cmp(&b.mean.unwrap_or(f64::INFINITY))
    });
    compared
}

/// The table over all scenes, in Markdown: image MSE and what each method costs.
pub(super) fn comparison(scenes: &[SceneResults]) -> String {
    let compared = compare(scenes);
    let names: Vec<&str> = scenes.iter().map(|s| s.name.as_str()).collect();
    let mut text = format!(
        "| method | bits/pixel | colour | passes | needs | {} | geometric mean |\n|---|---|---|---|---|{}---|\n",
        names.join(" | "),
        "---|".repeat(names.len())
    );
    let shown = |x: Option<f64>| number(x, |x| format!("{x:.2e}"));
    for c in &compared {
        let errors: Vec<String> = c.errors.iter().map(|&e| shown(e)).collect();
        text += &format!(
            "| `{}`{} | {} | {} | {} | {} | {} | {} |\n",
            c.method,
            if c.capabilities.order_dependent { " †" } else { "" },
            c.capabilities.bits_text(),
            c.capabilities.colour_bits_per_pixel,
            c.capabilities.geometry_passes,
            c.capabilities.needs.list(),
            errors.join(" | "),
            shown(c.mean)
        );
    }
    text + "\nImage MSE, lower is better. Bits a pixel: sums, ranges, layers and cores; the colour accumulator stands \
        apart. \
        In the geometric mean an error that nobody sees, below a sixteenth of an 8-bit step, counts as that. \
        † depends on the order of the fragments: means over random orders of fragments and of whole objects.\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Truth;
    use crate::oit::{Context, parse};
    use crate::pixel::FragmentList;

    fn scene(name: &str, alpha: f32) -> SceneResults {
        let list = FragmentList::new(
            vec![0, 3],
            vec![3.0, 1.0, 2.0],
            vec![alpha; 3],
            Some(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        )
        .unwrap()
        .with_size(1, 1)
        .unwrap();
        let truth = Truth::new(&list, [1.0; 3]);
        let row = |method: &str| Row {
            cpu: truth
                .judge(&*parse(method).unwrap(), Context::default())
                .unwrap()
                .result,
            gpu: None,
            tinted: None,
            demanded: method != "weighted-blended:dwb22-shader",
        };
        let rows = [
            "abuffer",
            "weighted-blended:dwb22",
            "weighted-blended:dwb22-shader",
            "multi-layer-alpha:1",
        ];
        SceneResults {
            rows: rows.map(row).into_iter().collect(),
            ..SceneResults::new(name, &list)
        }
    }

    /// Methods that do the same stand once; whoever asked for them by name sees both.
    #[test]
    fn equal_methods_stand_once() {
        let mut found = scene("a", 0.5);
        let text = rows(&found.rows);
        assert!(
            text.contains("weighted-blended:dwb22-shader equals weighted-blended:dwb22 here"),
            "{text}"
        );
        found.rows[2].demanded = true;
        assert!(!rows(&found.rows).contains("equals"));
        assert!(text.contains("multi-layer-alpha:1†") && text.contains("unbounded") && text.contains("interlock"));
    }

    /// The geometric mean by hand; what is exact has that of an error that nobody sees, and stands first; NaN has none,
    /// and stands last.
    #[test]
    fn means_are_geometric() {
        let mut scenes = [scene("a", 0.5), scene("b", 0.25)];
        let compared = compare(&scenes);
        let blended = compared.iter().find(|c| c.method == "weighted-blended:dwb22").unwrap();
        let expected = (blended.errors[0].unwrap() * blended.errors[1].unwrap()).sqrt();
        assert!((blended.mean.unwrap() / expected - 1.0).abs() < 1e-12);
        let exact = compared.first().unwrap();
        assert!(exact.method == "abuffer" && (exact.mean.unwrap() / INVISIBLE - 1.0).abs() < 1e-9);
        let text = comparison(&scenes);
        assert!(
            text.starts_with("| method | bits/pixel | colour | passes | needs | a | b | geometric mean |"),
            "{text}"
        );
        assert_eq!(text.lines().filter(|l| l.starts_with("| `")).count(), 4);
        scenes[1].rows[0].cpu.image_mse = Some(f64::NAN);
        let compared = compare(&scenes);
        assert!(compared.last().unwrap().method == "abuffer" && compared.last().unwrap().mean.is_none());
    }
}
