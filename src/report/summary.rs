//! The top of the page: when and where it was measured, and what came out best.

use super::find::Found;
use super::html::{Cell, Table, definitions, escape, number, thousands};
use super::scenes::{Method, Scene};
use super::value::text;
use std::time::{SystemTime, UNIX_EPOCH};

/// The summary.
pub fn section(found: &Found, scenes: &[Scene]) -> String {
    let mut facts = vec![("measured", dates(found))];
    let machines = machines(found);
    if !machines.is_empty() {
        facts.push(("machine", machines.join("; ")));
    }
    let count = scenes.iter().map(|s| s.methods.len()).max().unwrap_or(0);
    if count > 0 {
        let names: Vec<&str> = scenes.iter().map(|s| s.label.as_str()).collect();
        facts.push(("scenes", names.join(", ")));
        facts.push(("methods and networks", thousands(count as i64)));
    }
    let mut out = definitions(&facts);
    let best: String = scenes.iter().filter_map(sentence).collect();
    if !best.is_empty() {
        out += &format!("<ul>{best}</ul>\n{}", front(scenes));
    }
    out
}

/// The day of the oldest and of the newest file, in UTC.
fn dates(found: &Found) -> String {
    let times = found
        .read
        .iter()
        .filter_map(|path| path.metadata().ok()?.modified().ok());
    let mut days: Vec<String> = times.map(day).collect();
    days.sort();
    match (days.first(), days.last()) {
        (Some(first), Some(last)) if first == last => first.clone(),
        (Some(first), Some(last)) => format!("{first} to {last}"),
        _ => "–".to_owned(),
    }
}

/// A date as ISO 8601 writes it.
///
/// # Source
/// The civil calendar from days since 1970-01-01, after H. Hinnant, *chrono-Compatible Low-Level Date Algorithms*.
fn day(time: SystemTime) -> String {
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let days = (seconds / 86_400) as i64 + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * of_year + 2) / 153;
    let (month, day) = ((shifted + 2) % 12 + 1, of_year - (153 * shifted + 2) / 5 + 1);
    let year = year_of_era + 400 * era + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Every machine that something was measured on, once.
fn machines(found: &Found) -> Vec<String> {
    let mut machines: Vec<String> = Vec::new();
    for machine in found.documents.iter().filter_map(|d| d.value.get("machine")) {
        let cpu = text(machine, &["cpu"]).unwrap_or("unknown CPU");
        let threads = super::value::number(machine, &["threads"]);
        let name = match threads {
            Some(n) => format!("{cpu}, {n:.0} threads"),
            None => cpu.to_owned(),
        };
        if !machines.contains(&name) && machines.len() < 8 {
            machines.push(name);
        }
    }
    machines
}

/// The image's error, or that of T where there is none.
fn error(method: &Method) -> Option<f64> {
    method.image_mse.or(method.t_mse).filter(|e| e.is_finite())
}

/// Memory that is bounded \[bits a pixel\].
fn bits(method: &Method) -> Option<f64> {
    method.bits.filter(|b| *b > 0.0 && b.is_finite())
}

/// The best of a scene in a sentence.
fn sentence(scene: &Scene) -> Option<String> {
    let ranked: Vec<&Method> = scene
        .methods
        .iter()
        .filter(|m| error(m).is_some() && bits(m).is_some())
        .collect();
    let best = ranked
        .iter()
        .min_by(|a, b| error(a).unwrap().total_cmp(&error(b).unwrap()))?;
    let kind = if best.image_mse.is_some() { "image MSE" } else { "T-MSE" };
    let mut words = format!(
        "<b>{}</b>: {} has the least {kind} of {} methods of bounded memory, {} at {} bits a pixel",
        escape(&scene.label),
        escape(&best.name),
        ranked.len(),
        number(error(best)?),
        number(bits(best)?)
    );
    let network = |m: &&&Method| m.name.starts_with("neural:");
    let other = if network(&best) {
        ranked
            .iter()
            .filter(|m| !network(m))
            .min_by(|a, b| error(a).unwrap().total_cmp(&error(b).unwrap()))
    } else {
        ranked
            .iter()
            .filter(network)
            .min_by(|a, b| error(a).unwrap().total_cmp(&error(b).unwrap()))
    };
    if let Some(other) = other {
        let kind = if network(&best) { "classic method" } else { "network" };
        words += &format!(
            "; the best {kind} is {} with {}",
            escape(&other.name),
            number(error(other)?)
        );
    }
    Some(format!("<li>{words}.</li>\n"))
}

/// Methods than which nothing has both less memory and less error, scene by scene.
fn front(scenes: &[Scene]) -> String {
    let mut table = Table::new(
        "Best trade-offs: no other method has both less memory and less error",
        &["scene", "method", "bits a pixel", "error"],
    );
    for scene in scenes {
        let points: Vec<(f64, f64, &Method)> = scene
            .methods
            .iter()
            .filter_map(|m| Some((bits(m)?, error(m)?, m)))
            .collect();
        let beaten = |a: &(f64, f64, &Method)| {
            points
                .iter()
                .any(|b| b.0 <= a.0 && b.1 <= a.1 && (b.0 < a.0 || b.1 < a.1))
        };
        let mut best: Vec<&(f64, f64, &Method)> = points.iter().filter(|p| !beaten(p)).collect();
        best.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (bits, error, method) in best {
            table.row(vec![
                Cell::text(&scene.label),
                Cell::text(&method.name),
                Cell::number(Some(*bits)),
                Cell::number(Some(*error)),
            ]);
        }
    }
    table.html()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn days_are_those_of_the_calendar() {
        let at = |seconds| day(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "1970-01-01");
        // The leap day of 2000, and the last second of a year.
        assert_eq!(
            (at(951_782_400), at(1_767_225_599)),
            ("2000-02-29".to_owned(), "2025-12-31".to_owned())
        );
    }

    /// The front by hand. Control: a method that another beats in both is not on it, nor is one of unbounded memory.
    #[test]
    fn trade_offs_by_hand() {
        let method = |name: &str, bits: f64, error: f64| Method {
            name: name.to_owned(),
            bits: Some(bits),
            image_mse: Some(error),
            ..Method::default()
        };
        let scene = Scene {
            label: "hair".to_owned(),
            methods: vec![
                method("abuffer", f64::INFINITY, 0.0),
                method("neural:a", 300.0, 1e-5),
                method("moment", 200.0, 1e-4),
                method("worse", 320.0, 2e-5),
            ],
            ..Scene::default()
        };
        let html = front(std::slice::from_ref(&scene));
        assert!(html.contains("neural:a") && html.contains("moment"));
        assert!(!html.contains("worse") && !html.contains("abuffer"));
        let words = sentence(&scene).unwrap();
        assert!(
            words.contains("neural:a has the least image MSE of 3 methods")
                && words.contains("classic method is worse with 2.00e-5")
        );
    }
}
