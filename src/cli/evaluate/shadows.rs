//! `nmt evaluate --shadows`

use super::{RESULTS, Requested, Session};
use crate::cli::scene::open;
use crate::cli::ui::table;
use crate::evaluate::Image;
use crate::evaluate::picture::{file_stem, write_image};
use crate::evaluate::shadow::{Filter, ShadowJudged, judge};
use crate::numeric::file::write_atomically;
use crate::scene::shadow::{ShadowOptions, Shadowed};
use serde_json::{Value, json};
use std::ffi::OsString;

/// Methods that a shadow is told by where none is named: moments with both overestimations, and the technique that they
/// replaced.
pub const STORY: [&str; 9] = [
    "moment-power-4:overestimation=0",
    "moment-power-4:overestimation=0.5",
    "moment-power-6:overestimation=0",
    "moment-power-6:overestimation=0.5",
    "moment-trig-3:overestimation=0.5",
    "moment-power-4+own",
    "fourier-opacity:3",
    "fourier-opacity:7",
    "wavelet:3+own",
];

/// Texels of the shadow map a side.
const MAP_SIZE: u32 = 512;

impl Session<'_> {
    /// Shadows of every scene, by every method, unfiltered and under the filter.
    pub(super) fn shadows(&self, scenes: &[(OsString, String)]) -> anyhow::Result<bool> {
        let mut results = Vec::new();
        let mut refused = false;
        for (scene, name) in scenes {
            let opened = open(scene)?;
            let asked = ShadowOptions {
                map_size: MAP_SIZE,
                on_surfaces: self.options.shadow_points as usize,
                floor_size: (4.6 * f64::from(self.options.shadow_points)).sqrt().ceil() as u32,
            };
            let shadowed = opened.shadowed(&self.options.options.for_scene(), &asked)?;
            let (judged, remarks) = self.shadows_of(name, &shadowed);
            refused |= !remarks.is_empty();
            self.write_shadows(name, &shadowed, &judged)?;
            if !self.ui.json() {
                self.ui
                    .print(&format!("{}{remarks}\n", text(name, &shadowed, &judged)))?;
            }
            results.extend(judged.iter().map(|j| with_scene(name, j)));
        }
        let report = self.ui.report("evaluate", results);
        let json = serde_json::to_string_pretty(&report)? + "\n";
        write_atomically(&self.options.out.join(RESULTS), self.replace, |w| {
            w.write_all(json.as_bytes())
        })?;
        if self.ui.json() {
            self.ui.print(&json)?;
        } else {
            self.ui.print(&format!("{}\n", self.options.out.display()))?;
        }
        Ok(refused)
    }

    /// Every method in both ways, and what could not be applied.
    fn shadows_of(&self, name: &str, shadowed: &Shadowed) -> (Vec<ShadowJudged>, String) {
        let (mut judged, mut remarks) = (Vec::new(), String::new());
        let progress = self.ui.progress("shadows", self.methods.len() as u64);
        for (index, Requested { method, .. }) in self.methods.iter().enumerate() {
            progress.set(index as u64, format!("{name}: {}", method.name()));
            if !method.weights_are_transmittance() {
                remarks += &format!("not applied, {}: its weights are no transmittances\n", method.name());
                continue;
            }
            // Numbers and ends of fragments are not what a filter makes of them: networks are asked unfiltered.
            let filters: &[Filter] = if method.name().starts_with("neural:") || method.name().starts_with("core:") {
                &[Filter::Nearest]
            } else {
                &[Filter::Nearest, Filter::Gaussian9x9]
            };
            for &filter in filters {
                match judge(shadowed, filter, &**method) {
                    Ok(found) => judged.push(found),
                    Err(why) => remarks += &format!("not applied, {why}\n"),
                }
            }
        }
        progress.finish();
        let error = |j: &ShadowJudged| j.result.surface_transmittance_mse;
        judged.sort_by(|a, b| error(a).total_cmp(&error(b)));
        (judged, remarks)
    }

    /// The floor's transmittance as pictures: the exact one, and every method's.
    fn write_shadows(&self, name: &str, shadowed: &Shadowed, judged: &[ShadowJudged]) -> anyhow::Result<()> {
        let folder = self.options.out.join(name);
        let exact: Vec<f64> = shadowed.floor.iter().flatten().map(|r| r.transmittance).collect();
        let picture = |values: &[f64]| -> anyhow::Result<Image> {
            let mut values = values.iter();
            let pixels = shadowed.floor.iter().map(|receiver| match receiver {
                Some(_) => [values.next().copied().unwrap_or(f64::NAN); 3],
                None => [0.0; 3],
            });
            Ok(Image::new(shadowed.floor_size, shadowed.floor_size, pixels.collect())?)
        };
        if shadowed.floor.is_empty() {
            return Ok(());
        }
        write_image(&folder.join("shadow.truth.png"), self.replace, &picture(&exact)?)?;
        for j in judged {
            let filtered = if j.result.filter == Filter::Nearest {
                ""
            } else {
                ".filtered"
            };
            let file = format!("shadow.{}{filtered}.png", file_stem(&j.result.method));
            write_image(&folder.join(file), self.replace, &picture(&j.floor)?)?;
        }
        Ok(())
    }
}

fn with_scene(name: &str, judged: &ShadowJudged) -> Value {
    let mut value = json!(judged.result);
    value["scene"] = name.into();
    value
}

fn text(name: &str, shadowed: &Shadowed, judged: &[ShadowJudged]) -> String {
    let head = [
        "method",
        "lookup",
        "surfaces T-MSE",
        "worst",
        "floor T-MSE",
        "worst",
        "bits/texel",
    ];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    for ShadowJudged { result: r, .. } in judged {
        lines.push(vec![
            r.method.clone(),
            if r.filter == Filter::Nearest { "nearest" } else { "9x9" }.to_owned(),
            format!("{:.2e}", r.surface_transmittance_mse),
            format!("{:.3}", r.surface_worst_error),
            format!("{:.2e}", r.floor_transmittance_mse),
            format!("{:.3}", r.floor_worst_error),
            r.capabilities.bits_text(),
        ]);
    }
    format!(
        "{name}: light of {} texels a side, {} fragments; {} points on surfaces, {} on the floor, against rays\n{}",
        MAP_SIZE,
        shadowed.map.len(),
        shadowed.on_surfaces.len(),
        shadowed.floor.iter().flatten().count(),
        table(&lines)
    )
}
