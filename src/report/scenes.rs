//! What `nmt evaluate` found, scene by scene.

use super::find::Found;
use super::value::{bits, list, number, number_or_nan, text};
use serde_json::Value;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Results of a scene in one file.
#[derive(Debug, Default)]
pub struct Scene {
    /// Its name; with the folder's before it where several files hold scenes.
    pub label: String,
    /// Names of pictures start with this.
    pub prefix: String,
    /// Number of fragments.
    pub fragments: Option<f64>,
    /// Greatest number of fragments in a pixel.
    pub depth_complexity: Option<f64>,
    /// Methods, the least error first.
    pub methods: Vec<Method>,
    /// Methods that could not be applied, and why.
    pub refused: Vec<(String, String)>,
}

/// What a method made of a scene.
#[derive(Debug, Default, Clone)]
pub struct Method {
    /// Its name.
    pub name: String,
    /// Stem of its pictures.
    pub picture: Option<String>,
    /// Mean squared error of the image.
    pub image_mse: Option<f64>,
    /// Its peak signal-to-noise ratio \[dB\].
    pub psnr: Option<f64>,
    /// Mean of the FLIP map.
    pub flip: Option<f64>,
    /// Mean squared error of T.
    pub t_mse: Option<f64>,
    /// Greatest error of T.
    pub t_worst: Option<f64>,
    /// Answers and channel values that are not finite.
    pub nonfinite: f64,
    /// Memory of pass 1 \[bits\], infinite where it grows with the scene.
    pub bits: Option<f64>,
    /// Time of pass 1 and of pass 2 \[s\].
    pub seconds: [Option<f64>; 2],
    /// Errors by fragments in a pixel.
    pub by_count: Vec<Bin>,
    /// Errors by alpha.
    pub by_alpha: Vec<Bin>,
}

/// Errors in a bin.
#[derive(Debug, Clone, PartialEq)]
pub struct Bin {
    /// Lower and upper end.
    pub ends: (f64, f64),
    /// Fragments in it.
    pub fragments: Option<f64>,
    /// Mean squared error of T, NaN where an answer is not finite.
    pub t_mse: Option<f64>,
    /// Mean squared error of the image, NaN where a channel is not finite.
    pub image_mse: Option<f64>,
}

impl Method {
    fn of(value: &Value) -> Option<Self> {
        let name = text(value, &["method"])?.to_owned();
        let count = |key: &str| number(value, &[key]).unwrap_or(0.0);
        let (t_bad, image_bad) = (count("nonfinite") > 0.0, count("image_nonfinite") > 0.0);
        let nan_or = |key: &str, bad: bool| number_or_nan(value, key, bad);
        let image_mse = nan_or("image_mse", image_bad);
        let bins = |key: &str, ends: [&str; 2]| -> Vec<Bin> {
            let of = |b: &Value| {
                Some(Bin {
                    ends: (number(b, &ends[..1])?, number(b, &ends[1..])?),
                    fragments: number(b, &["fragments"]),
                    t_mse: number_or_nan(
                        b,
                        "transmittance_mse",
                        t_bad && number(b, &["fragments"]).is_some_and(|n| n > 0.0),
                    ),
                    image_mse: number_or_nan(b, "image_mse", image_bad),
                })
            };
            list(value, key).iter().filter_map(of).collect()
        };
        Some(Self {
            name,
            picture: text(value, &["picture"]).map(str::to_owned),
            image_mse,
            psnr: if image_mse == Some(0.0) {
                Some(f64::INFINITY)
            } else {
                nan_or("image_psnr_db", image_bad)
            },
            flip: nan_or("flip_mean", image_bad),
            t_mse: nan_or("transmittance_mse", t_bad),
            t_worst: nan_or("transmittance_worst_error", t_bad),
            nonfinite: count("nonfinite") + count("image_nonfinite"),
            bits: bits(value),
            seconds: [
                number(value, &["seconds_accumulate"]),
                number(value, &["seconds_weights"]),
            ],
            by_count: bins(
                "by_fragments_per_pixel",
                ["least_fragments_per_pixel", "most_fragments_per_pixel"],
            ),
            by_alpha: bins("by_alpha", ["least_alpha", "most_alpha"]),
        })
    }

    /// What methods are sorted by: the error of the image, or that of T; numbers first, NaN after them, nothing last.
    fn key(&self) -> (u8, f64) {
        let error = self.image_mse.or(self.t_mse);
        (
            error.map_or(2, |e| u8::from(e.is_nan())),
            error.filter(|e| !e.is_nan()).unwrap_or(0.0),
        )
    }

    /// Whether it is a network.
    pub fn is_network(&self) -> bool {
        self.name.starts_with("neural:")
    }
}

fn by_error(a: &Method, b: &Method) -> Ordering {
    let (a_key, b_key) = (a.key(), b.key());
    a_key
        .0
        .cmp(&b_key.0)
        .then(a_key.1.total_cmp(&b_key.1))
        .then_with(|| a.name.cmp(&b.name))
}

/// All scenes of all files, in their order.
pub fn scenes(found: &Found) -> Vec<Scene> {
    let several = found.of("evaluate").count() > 1;
    let mut scenes: Vec<Scene> = Vec::new();
    for document in found.of("evaluate") {
        let first = scenes.len();
        for result in document.results() {
            let name = text(result, &["scene"]).unwrap_or("unnamed");
            let label = if several {
                format!("{}{name}", document.folder())
            } else {
                name.to_owned()
            };
            let at = match scenes[first..].iter().position(|s| s.label == label) {
                Some(at) => first + at,
                None => {
                    scenes.push(Scene {
                        label,
                        prefix: format!("{}{name}/", document.folder()),
                        ..Scene::default()
                    });
                    scenes.len() - 1
                }
            };
            let scene = &mut scenes[at];
            scene.fragments = scene.fragments.or(number(result, &["fragments"]));
            scene.depth_complexity = scene.depth_complexity.or(number(result, &["depth_complexity"]));
            match (text(result, &["error"]), Method::of(result)) {
                (Some(why), _) => scene.refused.push((
                    text(result, &["method"]).unwrap_or("unnamed").to_owned(),
                    why.to_owned(),
                )),
                (None, Some(method)) => scene.methods.push(method),
                (None, None) => {}
            }
        }
    }
    scenes.iter_mut().for_each(|s| s.methods.sort_by(by_error));
    scenes.retain(|s| !s.methods.is_empty() || !s.refused.is_empty());
    scenes
}

/// The methods that charts show, at most so many: networks, then the best of each kind over all scenes; those that are
/// exact everywhere have no curve.
pub fn chosen(scenes: &[Scene], most: usize) -> Vec<String> {
    // Place from the best to the last, over all scenes.
    let mut places: BTreeMap<&str, (f64, f64, bool, bool)> = BTreeMap::new();
    for scene in scenes {
        for (place, method) in scene.methods.iter().enumerate() {
            let error = [method.t_mse, method.image_mse]
                .into_iter()
                .flatten()
                .fold(0.0, f64::max);
            let entry = places.entry(&method.name).or_insert((0.0, 0.0, false, false));
            entry.0 += place as f64 / scene.methods.len() as f64;
            entry.1 += 1.0;
            entry.2 |= error > 1e-18 || method.nonfinite > 0.0;
            entry.3 = method.is_network();
        }
    }
    let mut ranked: Vec<(&str, f64, bool)> = places
        .into_iter()
        .filter(|(_, e)| e.2)
        .map(|(name, (sum, n, _, network))| (name, sum / n, network))
        .collect();
    ranked.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(b.0)));
    let networks = ranked.iter().filter(|r| r.2).take(most / 2);
    let names: Vec<&str> = networks.map(|r| r.0).collect();
    let mut kinds = std::collections::HashSet::new();
    let others = ranked.iter().filter(|r| !r.2 && kinds.insert(kind(r.0))).map(|r| r.0);
    names
        .iter()
        .copied()
        .chain(others)
        .take(most)
        .map(str::to_owned)
        .collect()
}

/// A classic method's name without numbers, storage and suffixes: "moment-power" of "moment-power-4:f32+own".
fn kind(name: &str) -> &str {
    name.split([':', '+'])
        .next()
        .unwrap_or(name)
        .trim_end_matches(|c: char| c.is_ascii_digit() || c == '-')
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::report::find::Document;
    use serde_json::json;

    /// What one file of JSON makes of a folder.
    pub fn found(name: &str, value: Value) -> Found {
        Found {
            documents: vec![Document {
                name: name.to_owned(),
                value,
            }],
            ..Found::default()
        }
    }

    #[test]
    fn methods_are_sorted_and_null_is_told_from_nan() {
        let row = |method: &str, mse: Value, bad: u64| {
            json!({ "scene": "s", "method": method, "image_mse": mse, "transmittance_mse": null, "nonfinite": bad,
                "image_nonfinite": bad,
                "by_fragments_per_pixel": [{ "least_fragments_per_pixel": 0, "most_fragments_per_pixel": 0,
                    "fragments": 0, "transmittance_mse": null, "image_mse": null }, "junk"] })
        };
        let rows = json!([row("b", json!(2e-3), 0), row("nan", json!(null), 4), row("a", json!(1e-3), 0), row("none",
            json!(null), 0), row("exact", json!(0.0), 0),
            { "scene": "s", "method": "r", "error": "no planes" }, { "scene": "s" }, 7]);
        let scenes = scenes(&found(
            "e/results.json",
            json!({ "command": "evaluate", "results": rows }),
        ));
        assert_eq!(
            (scenes.len(), scenes[0].label.as_str(), scenes[0].prefix.as_str()),
            (1, "s", "e/s/")
        );
        let names: Vec<&str> = scenes[0].methods.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["exact", "a", "b", "nan", "none"]);
        assert_eq!(scenes[0].refused, [("r".to_owned(), "no planes".to_owned())]);
        let [exact, .., nan, none] = &scenes[0].methods[..] else {
            panic!()
        };
        assert!(
            exact.psnr == Some(f64::INFINITY)
                && nan.image_mse.unwrap().is_nan()
                && nan.t_mse.unwrap().is_nan()
                && none.image_mse.is_none()
        );
        // An empty pixel has no T to be NaN.
        assert!(
            nan.by_count.len() == 1 && nan.by_count[0].t_mse.is_none() && nan.by_count[0].image_mse.unwrap().is_nan()
        );
    }

    #[test]
    fn charts_show_networks_and_the_best() {
        let row = |scene: &str, method: &str, mse: f64| json!({ "scene": scene, "method": method, "image_mse": mse });
        let names = ["a-4", "a-8+own", "b:2", "b:1", "c-6:f32", "d", "e"];
        let mut rows: Vec<Value> = names
            .iter()
            .zip(1..)
            .map(|(name, i)| row("s", name, 1e-3 * f64::from(i)))
            .collect();
        rows.extend([row("s", "abuffer", 0.0), row("s", "neural:x", 1.0), row("t", "e", 1e-9)]);
        let scenes = scenes(&found(
            "results.json",
            json!({ "command": "evaluate", "results": rows }),
        ));
        // In the middle of both scenes e does best but for a, although it comes last in the first of them.
        assert_eq!(chosen(&scenes, 5), ["neural:x", "a-4", "b:2", "e", "c-6:f32"]);
        assert_eq!(scenes.len(), 2);
        assert_eq!(
            ["moment-power-4:f32+own", "adaptive:8", "weighted-sum"].map(kind),
            ["moment-power", "adaptive", "weighted-sum"]
        );
    }
}
