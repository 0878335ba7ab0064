//! The section of pictures: a contact sheet a scene, whose pictures a viewer puts side by side under a slider.
//!
//! Pictures are embedded once, in the contact sheet, which needs no script; the viewer borrows them.

use super::errors::{error_text, flip_text};
use super::find::Found;
use super::html::{base64, base64_length, bytes, escape, number};
use super::scenes::{Method, Scene};
use crate::evaluate::picture::file_stem;
use std::collections::BTreeMap;

/// Most pictures of a contact sheet that is open at first.
const MAX_OPEN: usize = 15;

/// Pictures of a scene by name in the folder.
struct Wanted {
    truth: String,
    /// Image and FLIP map of each method, in the scene's order.
    methods: Vec<[String; 2]>,
}

fn wanted(scene: &Scene) -> Wanted {
    let of = |m: &Method| {
        let stem = m.picture.clone().unwrap_or_else(|| file_stem(&m.name));
        [
            format!("{}{stem}.png", scene.prefix),
            format!("{}{stem}.flip.png", scene.prefix),
        ]
    };
    Wanted {
        truth: format!("{}truth.png", scene.prefix),
        methods: scene.methods.iter().map(of).collect(),
    }
}

/// A picture that was read: its size and its data URI.
struct Picture {
    width: u32,
    height: u32,
    uri: String,
}

/// The pictures that a page embeds.
#[derive(Default)]
struct Gallery {
    pictures: BTreeMap<String, Picture>,
    /// Names for which there was no room, and their size together \[bytes\].
    left_out: Vec<String>,
    left_out_bytes: u64,
}

/// The section, and what it embeds.
pub struct Images {
    /// HTML; none where there are no pictures.
    pub html: Option<String>,
    /// Number of pictures in the page.
    pub embedded: usize,
    /// Names of those for which there was no room.
    pub left_out: Vec<String>,
}

/// Checks that bytes are a whole PNG and tells its width and height.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let word = |at: usize| {
        bytes
            .get(at..at + 4)
            .map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]]))
    };
    let whole = bytes.starts_with(b"\x89PNG\r\n\x1a\n")
        && bytes.get(12..16) == Some(b"IHDR")
        && bytes.ends_with(b"\0\0\0\0IEND\xaeB\x60\x82");
    let size = (word(16)?, word(20)?);
    let sane = |v: u32| (1..=1 << 16).contains(&v);
    (whole && sane(size.0) && sane(size.1)).then_some(size)
}

/// Reads pictures, most wanted first: exact images, then images by rank, then FLIP maps by rank, so long as they fit.
fn gather(found: &mut Found, all: &[Wanted], most_bytes: u64) -> Gallery {
    let ranks = all.iter().map(|w| w.methods.len()).max().unwrap_or(0);
    let ranked =
        |kind: usize| (0..ranks).flat_map(move |r| all.iter().filter_map(move |w| w.methods.get(r).map(|m| &m[kind])));
    let order: Vec<&String> = all.iter().map(|w| &w.truth).chain(ranked(0)).chain(ranked(1)).collect();
    let mut gallery = Gallery::default();
    let mut left = most_bytes;
    for name in order {
        let Some((path, size)) = found.pictures.get(name).cloned() else {
            continue;
        };
        if gallery.pictures.contains_key(name) || gallery.left_out.contains(name) {
            continue;
        }
        if base64_length(size) > left {
            gallery.left_out.push(name.clone());
            gallery.left_out_bytes += size;
            continue;
        }
        let data = match std::fs::read(&path) {
            Ok(data) => data,
            Err(error) => {
                found.problem(name, format!("cannot be read: {error}"));
                continue;
            }
        };
        let (Some((width, height)), true) = (png_size(&data), data.len() as u64 == size) else {
            found.problem(name, "is no whole PNG; evaluate again with --force".to_owned());
            continue;
        };
        left -= base64_length(size);
        found.read.push(path);
        gallery.pictures.insert(
            name.clone(),
            Picture {
                width,
                height,
                uri: format!("data:image/png;base64,{}", base64(&data)),
            },
        );
    }
    gallery
}

/// The section of all scenes. `most_bytes` bounds the pictures as they stand in the page.
pub fn section(found: &mut Found, scenes: &[Scene], most_bytes: u64) -> Images {
    let all: Vec<Wanted> = scenes.iter().map(wanted).collect();
    let gallery = gather(found, &all, most_bytes);
    let mut sheets = String::new();
    let mut usable = false;
    for (i, (scene, wanted)) in scenes.iter().zip(&all).enumerate() {
        let mut figures = String::new();
        if let Some(truth) = gallery.pictures.get(&wanted.truth) {
            figures += &figure(i, "exact image", "A-buffer in f64", &scene.label, truth, None);
        }
        for (method, names) in scene.methods.iter().zip(&wanted.methods) {
            if let Some(image) = gallery.pictures.get(&names[0]) {
                figures += &figure(
                    i,
                    &method.name,
                    &stats(method),
                    &scene.label,
                    image,
                    gallery.pictures.get(&names[1]),
                );
                usable = true;
            }
        }
        if !figures.is_empty() {
            // Long sheets wait to be asked for; the viewer shows their pictures meanwhile.
            let open = if sheets.is_empty() && figures.matches("<figure").count() <= MAX_OPEN {
                " open"
            } else {
                ""
            };
            sheets += &format!(
                "<details class=\"sheet\"{open}><summary>{}</summary><div class=\"shots\" data-scene=\"{i}\" \
                    data-label=\"{}\">\n{figures}</div></details>\n",
                escape(&scene.label),
                escape(&scene.label)
            );
        }
    }
    let mut html = String::new();
    if usable {
        html += VIEWER;
    }
    html += &sheets;
    if !gallery.left_out.is_empty() {
        html += &format!(
            "<p class=\"note warning\">{} pictures of {} together are left out, because those in the page take at most \
                {}; --embed-mib allows more.</p>\n",
            gallery.left_out.len(),
            bytes(gallery.left_out_bytes),
            bytes(most_bytes)
        );
    }
    Images {
        html: (!html.is_empty()).then_some(html),
        embedded: gallery.pictures.len(),
        left_out: gallery.left_out,
    }
}

/// The numbers below a picture.
fn stats(method: &Method) -> String {
    let parts: Vec<String> = [
        ("image MSE", method.image_mse.map(error_text)),
        ("FLIP", method.flip.map(flip_text)),
        ("T-MSE", method.t_mse.map(error_text)),
    ]
    .into_iter()
    .filter_map(|(name, text)| Some(format!("{name} {}", text?)))
    .collect();
    let bad = if method.nonfinite > 0.0 {
        format!(", {} values not finite", number(method.nonfinite))
    } else {
        String::new()
    };
    parts.join(", ") + &bad
}

fn figure(scene: usize, name: &str, stats: &str, label: &str, image: &Picture, flip: Option<&Picture>) -> String {
    let (name, stats, label) = (escape(name), escape(stats), escape(label));
    let img = |class: &str, p: &Picture, alt: String| {
        format!(
            "<img class=\"{class}\" alt=\"{alt}\" width=\"{}\" height=\"{}\" loading=\"lazy\" decoding=\"async\" \
                src=\"{}\">",
            p.width, p.height, p.uri
        )
    };
    let picture = img("image", image, format!("{label}, {name}"));
    let map = flip.map_or(String::new(), |f| {
        img("flip", f, format!("FLIP map of {label}, {name}"))
    });
    format!(
        "<figure class=\"shot\" data-scene=\"{scene}\" data-name=\"{name}\" data-stats=\"{stats}\">\
         <button type=\"button\" class=\"pick\" aria-label=\"Show {name} in the viewer\">{picture}{map}</button>\
         <figcaption><b>{name}</b><br>{stats}</figcaption></figure>\n"
    )
}

/// The viewer; hidden where no script fills it.
const VIEWER: &str = r#"<div class="viewer" id="viewer" hidden>
<div class="controls">
<label>Scene <select id="v-scene"></select></label>
<label>Left <select id="v-left"></select></label>
<label>Right <select id="v-right"></select></label>
<label>Zoom <select id="v-zoom"><option value="1">fit</option><option value="2">2×</option>
<option value="4">4×</option><option value="8">8×</option></select></label>
<label class="check"><input type="checkbox" id="v-flip"> FLIP map on the left</label>
</div>
<div class="pan" tabindex="0" role="region" aria-label="The two images; scrolls when enlarged">
<div class="stage" id="v-stage"><img id="v-b" alt=""><img id="v-a" alt="">
<span class="divider" aria-hidden="true"></span></div></div>
<label class="range">Divider <input type="range" id="v-cut" min="0" max="100" step="0.5" value="50"
aria-label="Divider: share of the width that shows the left image"></label>
<p class="sides" id="v-text" aria-live="polite"></p>
</div>
<p class="note"><label class="check"><input type="checkbox" id="g-flip"> FLIP maps in the contact sheets</label><br>
FLIP maps run from near black (no difference) to pale yellow (0.2 and more); magenta is not finite.</p>
<noscript><p class="note">The slider needs scripts; the contact sheets below do not.</p></noscript>
"#;

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::chart::raster::Raster;
    use crate::report::scenes::{scenes, tests::found};
    use serde_json::json;

    /// A PNG of one colour.
    pub fn png(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = Vec::new();
        Raster::new(width, height, [200, 30, 90]).write_png(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn the_scale_of_maps_is_that_of_their_files() {
        let end = format!("pale yellow ({} and more)", crate::evaluate::picture::FLIP_TOP);
        assert!(VIEWER.contains(&end), "{end}");
    }

    #[test]
    fn whole_pictures_tell_their_size() {
        let whole = png(3, 2);
        assert_eq!(png_size(&whole), Some((3, 2)));
        for n in 0..whole.len() {
            assert_eq!(png_size(&whole[..n]), None);
        }
        let mut zero = whole.clone();
        zero[16..20].fill(0);
        assert_eq!(png_size(&zero), None);
    }

    fn folder() -> (tempfile::TempDir, Found) {
        let folder = tempfile::tempdir().unwrap();
        let row = |m: &str, mse: f64| {
            json!({ "scene": "s", "method": m, "image_mse": mse, "flip_mean": 0.5,
            "transmittance_mse": null, "nonfinite": 0 })
        };
        let mut rows = vec![
            row("a", 1e-3),
            row("neural:<b>", 2e-3),
            row("c", 3e-3),
            row("../up", 4e-3),
        ];
        rows[1]["picture"] = json!("b-file");
        rows[3]["picture"] = json!("../../secret");
        let mut found = found("results.json", json!({ "command": "evaluate", "results": rows }));
        for (name, bytes) in [
            ("truth", png(4, 3)),
            ("a", png(4, 3)),
            ("a.flip", png(4, 3)),
            ("b-file", png(4, 3)),
            ("c", png(4, 3)[..40].to_vec()),
        ] {
            let path = folder.path().join(format!("{name}.png"));
            std::fs::write(&path, &bytes).unwrap();
            found
                .pictures
                .insert(format!("s/{name}.png"), (path, bytes.len() as u64));
        }
        std::fs::write(folder.path().join("secret.png"), png(1, 1)).unwrap();
        (folder, found)
    }

    /// Every picture stands in the page once; names from files choose no file outside the folder, and damaged pictures
    /// are named.
    #[test]
    fn pictures_are_embedded_once() {
        let (_folder, mut found) = folder();
        let scenes = scenes(&found);
        let images = section(&mut found, &scenes, 1 << 20);
        let html = images.html.unwrap();
        assert_eq!(
            (
                images.embedded,
                html.matches("data:image/png;base64,").count(),
                images.left_out.len()
            ),
            (4, 4, 0)
        );
        assert!(
            html.contains("alt=\"FLIP map of s, a\"")
                && html.contains("data-name=\"neural:&lt;b&gt;\"")
                && html.contains("width=\"4\" height=\"3\"")
        );
        assert_eq!(
            found.problems.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(),
            ["s/c.png"]
        );
        assert_eq!(found.read.len(), 4);
    }

    /// The exact image comes first, then images, FLIP maps last; what has no room is counted aloud.
    #[test]
    fn the_cap_keeps_the_most_wanted() {
        let (_folder, mut found) = folder();
        let scenes = scenes(&found);
        let one = base64_length(png(4, 3).len() as u64);
        let images = section(&mut found, &scenes, 2 * one);
        assert_eq!(images.embedded, 2);
        assert_eq!(images.left_out, ["s/b-file.png", "s/c.png", "s/a.flip.png"]);
        assert!(images.html.unwrap().contains("3 pictures of"));
        let none = section(&mut found, &scenes, 0);
        assert!(none.embedded == 0 && none.html.unwrap().contains("left out"));
        assert!(section(&mut Found::default(), &[], 1).html.is_none());
    }
}
