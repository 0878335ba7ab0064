//! The tables that `nmt stress` prints.

use crate::cli::ui::table;
use crate::stress::bias::{self, BiasPoint, Kept};
use crate::stress::suite::RandomReport;
use crate::stress::sweep::Point;
use crate::stress::{Case, Report};

/// Columns of a terminal that tables stay within where they can.
const WIDTH: usize = 80;

/// A number of three digits: 0.031, 4e-7.
fn short(x: Option<f64>) -> String {
    match x {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(x) if (0.0095..100.0).contains(&x) => format!("{x:.2}"),
        Some(x) => format!("{x:.0e}"),
    }
}

fn percent(share: f64) -> String {
    if share < 1e-3 {
        "<0.1%".to_owned()
    } else {
        format!("{:.1}%", 100.0 * share)
    }
}

/// Root mean square and worst error, and a mark for what is not finite or out of range.
fn cell(report: &Report) -> String {
    if report.refused.is_some() {
        return "refused".to_owned();
    }
    let mut text = match (report.mse, report.worst_error) {
        (None, None) => "-".to_owned(),
        (mse, worst) => format!("{} {}", short(mse.map(f64::sqrt)), short(worst)),
    };
    let share = |count: u64| percent(count as f64 / report.fragments.max(1) as f64);
    if report.nonfinite > 0 {
        text += &format!(" NaN {}", share(report.nonfinite));
    }
    if report.out_of_range > 0 {
        text += &format!(" out {}", share(report.out_of_range));
    }
    text
}

/// Cases by methods, as many methods side by side as fit.
pub fn cases(cases: &[Case], reports: &[Vec<Report>]) -> String {
    let mut columns: Vec<Vec<String>> = vec![
        std::iter::once("case".to_owned())
            .chain(cases.iter().map(|c| c.name.to_owned()))
            .collect(),
    ];
    for of_subject in reports.iter().filter(|r| !r.is_empty()) {
        columns.push(
            std::iter::once(of_subject[0].method.clone())
                .chain(of_subject.iter().map(cell))
                .collect(),
        );
    }
    let width = |column: &Vec<String>| column.iter().map(|t| t.chars().count()).max().unwrap_or(0) + 2;
    let mut text =
        "error of T, root mean square and worst over the finite answers; NaN, out: shares of answers that are not \
            finite, outside [0, 1]\n\n"
            .to_owned();
    let mut next = 1;
    while next < columns.len() {
        let mut end = next + 1;
        let mut taken = width(&columns[0]) + width(&columns[next]);
        while end < columns.len() && taken + width(&columns[end]) <= WIDTH {
            taken += width(&columns[end]);
            end += 1;
        }
        let block: Vec<&Vec<String>> = std::iter::once(&columns[0]).chain(&columns[next..end]).collect();
        let rows: Vec<Vec<String>> = (0..=cases.len())
            .map(|i| block.iter().map(|c| c[i].clone()).collect())
            .collect();
        text += &table(&rows);
        text += "\n";
        next = end;
    }
    let what: Vec<Vec<String>> = std::iter::once(["case", "what it is"])
        .chain(cases.iter().map(|c| [c.name, c.what]))
        .map(cells)
        .collect();
    text + &table(&what) + "\n"
}

fn cells<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}

/// Feature rows by formats of weights.
pub fn features(reports: &[Report]) -> String {
    if reports.is_empty() {
        return String::new();
    }
    let mut rows = vec![cells([
        "features alone",
        "rows",
        "not finite",
        "out of range",
        "worst against f64",
        "rms against f64",
    ])];
    for r in reports {
        let counts = [r.fragments, r.nonfinite, r.out_of_range].map(|n| n.to_string());
        let errors = [short(r.worst_rounding), short(r.rounding_mse.map(f64::sqrt))];
        rows.push(
            [
                vec![format!("{}: {}", r.method, r.case)],
                counts.to_vec(),
                errors.to_vec(),
            ]
            .concat(),
        );
    }
    format!("{}\n", table(&rows))
}

/// Cases whose errors the ways of running a network are compared by.
const TELLING: [&str; 6] = [
    "usual",
    "thin",
    "far-from-origin",
    "many-faint",
    "extreme-absorbance",
    "window-depth",
];

/// Ways of running networks, a row each.
pub fn executions(reports: &[Vec<Report>]) -> String {
    let mut rows = vec![vec![
        "network".to_owned(),
        "not finite".to_owned(),
        "out of range".to_owned(),
        "pair, worst".to_owned(),
    ]];
    rows[0].extend(TELLING.map(str::to_owned));
    rows[0].extend(["order spread", "rises"].map(str::to_owned));
    for of_subject in reports.iter().filter(|r| !r.is_empty()) {
        let sum = |of: fn(&Report) -> u64| of_subject.iter().map(of).sum::<u64>();
        let case = |name: &str| of_subject.iter().find(|r| r.case == name && r.refused.is_none());
        let mut row = vec![
            of_subject[0].method.clone(),
            sum(|r| r.nonfinite).to_string(),
            sum(|r| r.out_of_range).to_string(),
        ];
        row.push(short(case("pair").and_then(|r| r.worst_error)));
        row.extend(TELLING.map(|name| {
            case(name).and_then(|r| r.mse).map_or("-".to_owned(), |mse| {
                if mse < 100.0 {
                    format!("{:.4}", mse.sqrt())
                } else {
                    short(Some(mse.sqrt()))
                }
            })
        }));
        row.push(short(of_subject.iter().map(|r| r.order_spread).reduce(f64::max)));
        row.push(percent(sum(|r| r.rises) as f64 / sum(|r| r.fragments).max(1) as f64));
        rows.push(row);
    }
    if rows.len() == 1 {
        return String::new();
    }
    format!(
        "ways of running a network: answers over all cases, then errors of T as root mean squares; order spread is the \
            greatest difference that another order makes, \
         rises the share of fragments with more light than one in front of them\n\n{}\n",
        table(&rows)
    )
}

/// What rounding adds along the half-range.
pub fn ranges(points: &[Point]) -> String {
    let of_range: Vec<&Point> = points.iter().filter(|p| p.sweep == "half_range").collect();
    let Some(first) = of_range.first() else {
        return String::new();
    };
    let methods: Vec<&Point> = of_range.iter().copied().take_while(|p| p.x == first.x).collect();
    let mut rows = vec![
        std::iter::once("half-range".to_owned())
            .chain(methods.iter().map(|p| p.method.clone()))
            .collect::<Vec<_>>(),
    ];
    for line in of_range.chunks(methods.len()) {
        let cell = |p: &&Point| {
            let mse = p.mse.map_or("-".to_owned(), |mse| format!("{mse:.2e}"));
            let added = p
                .added()
                .map_or(String::new(), |added| format!(" {:+.0}%", 100.0 * added));
            let nan = if p.nonfinite > 0 {
                format!(" NaN {}", percent(p.nonfinite as f64 / p.fragments as f64))
            } else {
                String::new()
            };
            format!("{mse}{added}{nan}")
        };
        rows.push(
            std::iter::once(format!("{}", line[0].x))
                .chain(line.iter().map(cell))
                .collect(),
        );
    }
    // Methods in rows where they are many.
    let turned: Vec<Vec<String>> = (0..rows[0].len())
        .map(|i| rows.iter().step_by(3).map(|row| row[i].clone()).collect())
        .collect();
    format!(
        "T-MSE by half-range of the pixel in moment depth, and what rounding adds to it\n\n{}\n",
        table(&turned)
    )
}

pub fn random(found: &[RandomReport]) -> String {
    if found.is_empty() {
        return String::new();
    }
    let head = [
        "random fragments",
        "fragments",
        "evaluated",
        "not finite",
        "out of range",
        "nearest not 1",
        "single not 1",
        "M/s",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for f in found {
        let c = &f.counts;
        let counts = [
            c.fragments,
            c.evaluated,
            c.nonfinite,
            c.out_of_range,
            c.nearest_not_one,
            c.single_not_one,
        ]
        .map(|n| n.to_string());
        let rate = format!("{:.1}", c.fragments as f64 / f.seconds / 1e6);
        rows.push([vec![f.network.clone()], counts.to_vec(), vec![rate]].concat());
    }
    format!("{}\n", table(&rows))
}

/// Strengths in rows, number of moments and storage in columns.
pub fn biases(biases: &[BiasPoint]) -> String {
    if biases.is_empty() {
        return String::new();
    }
    let mut columns: Vec<(usize, Kept)> = Vec::new();
    let mut strengths: Vec<f64> = Vec::new();
    for p in biases {
        if !columns.contains(&(p.moments, p.storage)) {
            columns.push((p.moments, p.storage));
        }
        if !strengths.contains(&p.moment_bias) {
            strengths.push(p.moment_bias);
        }
    }
    strengths.sort_by(f64::total_cmp);
    let best = bias::recommended(biases);
    let head = columns
        .iter()
        .map(|(m, storage)| format!("moment-power-{m}:{}", storage.name()));
    let mut rows = vec![
        std::iter::once("moment_bias".to_owned())
            .chain(head)
            .collect::<Vec<_>>(),
    ];
    for strength in strengths {
        let cell = |&(moments, storage): &(usize, Kept)| {
            let Some(p) = biases
                .iter()
                .find(|p| (p.moments, p.storage, p.moment_bias) == (moments, storage, strength))
            else {
                return String::new();
            };
            let mut text = p.mse.map_or("-".to_owned(), |mse| format!("{mse:.2e}"));
            for (name, count, of) in [
                ("NaN", p.nonfinite, p.fragments),
                ("single", p.single_nonfinite, p.singles),
            ] {
                if count > 0 {
                    text += &format!(" {name} {}", percent(count as f64 / of as f64));
                }
            }
            text += if p.published { " p" } else { "" };
            text += if best.contains(p) { " *" } else { "" };
            text
        };
        rows.push(
            std::iter::once(format!("{strength:e}"))
                .chain(columns.iter().map(cell))
                .collect(),
        );
    }
    format!(
        "T-MSE of the finite answers by moment_bias; NaN, single: shares of answers without a number on random pixels, \
            on single fragments; p: published; *: least \
         error without NaN\n\n{}\n",
        table(&rows)
    )
}
