//! `nmt evaluate`

use super::Verdict;
use super::predict::SkipName;
use super::scene::{SceneOptions, ViewOptions, load, moving_scene, refuse_outside};
use super::ui::{Ui, table};
use crate::evaluate::gpu::{self, GpuResult};
use crate::evaluate::judge::by_error;
use crate::evaluate::picture::{Sheet, file_stem, write_flip, write_image, write_method};
use crate::evaluate::{MethodResult, OverTime, Truth, over_time};
use crate::export::Format;
use crate::features::MomentFrame;
use crate::gpu::{Gpu, MethodShader};
use crate::model::shipped;
use crate::numeric::file::{Replace, may_write, write_atomically};
use crate::oit::neural::{Neural, Skip};
use crate::oit::{Context, Method, all_names, parse, shader_of};
use crate::pixel::FragmentList;
use crate::scene::CameraPath;
use crate::shader::ShaderError;
use crate::shader::passes::TargetPrecision;
use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Evaluate {
    /// Scenes: fragment lists (.npz), deep images (.exr), scene files (.toml) or names of built-in scenes.
    #[arg(long, value_name = "F.npz|SCENE", required = true, value_delimiter = ',', num_args = 1..)]
    fragments: Vec<String>,
    /// Methods, by name; "all" stands for every classic one.
    #[arg(long, value_delimiter = ',', num_args = 1.., default_value = "all")]
    methods: Vec<String>,
    /// Networks to evaluate beside them.
    #[arg(long, value_name = "MODEL.json", value_delimiter = ',', num_args = 1..)]
    model: Vec<PathBuf>,
    /// Which fragments to run those networks for.
    #[arg(long, value_enum, default_value = "exact")]
    skip: SkipName,
    /// Evaluate those networks also on moments between each pixel's own nearest and farthest fragment, which a prepass
    /// has found.
    #[arg(long, requires = "model")]
    prepass: bool,
    /// Folder for images, contact sheets and results.json.
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    options: SceneOptions,
    #[command(flatten)]
    view: ViewOptions,
    /// Turn the camera about the scene for so many frames, and compare how images change from frame to frame; for
    /// scenes that are rendered, not for lists.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=10_000))]
    frames: Option<u32>,
    /// Angle of the camera between two frames [degrees].
    #[arg(long, value_name = "D", requires = "frames", default_value_t = 0.6, value_parser = turn, allow_negative_numbers = true)]
    degrees_per_frame: f64,
    /// Draw them on the GPU too, those that have a shader, and compare with the CPU's images.
    #[arg(long)]
    gpu: bool,
    /// How the GPU stores sums between render passes.
    #[arg(long, value_enum, requires = "gpu", default_value = "full")]
    gpu_storage: StorageName,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum StorageName {
    /// f32; blending needs the adapter's feature float32-blendable, and without it compute passes step in.
    Full,
    /// Colour as f16, moments as f32.
    HalfColor,
    /// f16, and the range in depth buffers; for networks.
    Half,
}

impl From<StorageName> for TargetPrecision {
    fn from(name: StorageName) -> Self {
        match name {
            StorageName::Full => Self::Full,
            StorageName::HalfColor => Self::HalfColor,
            StorageName::Half => Self::Half,
        }
    }
}

/// An angle that turns a camera.
fn turn(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if degrees != 0.0 && degrees.abs() <= 180.0 => Ok(degrees),
        _ => Err("expected an angle from -180 to 180 degrees, not 0".to_owned()),
    }
}

/// A method that was asked for.
struct Asked {
    method: Box<dyn Method>,
    /// Whether it was asked for by its own name.
    demanded: bool,
    /// Whether `--skip` is for it: a network of `--model`.
    skips: bool,
    /// What the GPU runs; none where there is no shader for it.
    shader: Option<Result<MethodShader, ShaderError>>,
}

/// The file that holds all numbers.
const RESULTS: &str = "results.json";

impl Evaluate {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        may_write(&self.out.join(RESULTS), replace)?;
        let context = self.view.context()?;
        let background = self.view.background()?;
        let methods = self.methods()?;
        let gpu = if self.gpu { Some(Gpu::shared()?) } else { None };

        let with_skip: HashSet<String> = methods
            .iter()
            .filter(|asked| asked.skips)
            .map(|asked| asked.method.name())
            .collect();
        let names = scene_names(&self.fragments);
        if self.frames.is_some() {
            for scene in &self.fragments {
                moving_scene(scene)?;
            }
        }
        let mut results = Vec::new();
        let mut refused = false;
        for (scene, name) in self.fragments.iter().zip(&names) {
            let list = load(ui, scene, &self.options)?;
            refuse_outside(&list, context.planes)?;
            let truth = Truth::new(&list, background);
            let mut remarks = String::new();
            let folder = self.out.join(name);
            let mut sheet = match truth.image() {
                Ok(image) => {
                    write_image(&folder.join("truth.png"), replace, image)?;
                    Some(Sheet::new(name, &list, image))
                }
                // Errors of T need no image.
                Err(why) => {
                    remarks += &format!("no pictures, {why}\n");
                    None
                }
            };
            let progress = ui.progress("evaluate", methods.len() as u64);
            let mut found: Vec<(MethodResult, Option<GpuResult>)> = Vec::new();
            let mut applied: Vec<&dyn Method> = Vec::new();
            let mut stems = HashSet::from(["truth".to_owned(), "sheet".to_owned()]);
            for (
                index,
                Asked {
                    method,
                    demanded,
                    shader,
                    skips,
                },
            ) in methods.iter().enumerate()
            {
                progress.set(index as u64, format!("{name}: {}", method.name()));
                let mut judged = match truth.judge(&**method, context) {
                    Ok(judged) => judged,
                    Err(why) => {
                        refused |= *demanded;
                        remarks += &format!("not applied, {why}\n");
                        results.push(json!({ "scene": name, "method": method.name(), "error": why.to_string() }));
                        continue;
                    }
                };
                let stem = (1..).map(|n| {
                    if n == 1 {
                        file_stem(&method.name())
                    } else {
                        format!("{}-{n}", file_stem(&method.name()))
                    }
                });
                let stem = stem
                    .into_iter()
                    .find(|s| !stems.contains(s))
                    .expect("there are more numbers than methods");
                write_method(&folder, &stem, replace, &judged)?;
                let mut drawn = None;
                if let (Some(gpu), Some((image, _))) = (gpu, &judged.picture) {
                    let judged = match shader {
                        Some(Ok(shader)) => {
                            let skip = if *skips { self.skip.into() } else { Skip::Exact };
                            gpu::judge(gpu, shader, &truth, context, self.gpu_storage.into(), skip, image)
                                .map_err(|e| e.to_string())
                        }
                        Some(Err(why)) => Err(why.to_string()),
                        None => Err(format!("{} has no shader", method.name())),
                    };
                    match judged {
                        Ok(judged) => {
                            write_image(&folder.join(format!("{stem}.gpu.png")), replace, &judged.image)?;
                            write_flip(&folder.join(format!("{stem}.gpu.flip.png")), replace, &judged.map)?;
                            drawn = Some(judged.result);
                        }
                        Err(why) => remarks += &format!("not on the GPU, {why}\n"),
                    }
                }
                stems.insert(stem.clone());
                judged.result.picture = judged.picture.is_some().then_some(stem);
                if let Some(sheet) = &mut sheet {
                    sheet.add(&judged)?;
                }
                found.push((judged.result, drawn));
                applied.push(&**method);
            }
            progress.finish();
            if let Some(path) = self.path() {
                let changes = changes(scene, &self.options, path, &applied, (context, background), ui)?;
                for ((result, _), change) in found.iter_mut().zip(changes) {
                    result.over_time = change;
                }
            }
            found.sort_by(|a, b| by_error(&a.0, &b.0));
            if let Some(sheet) = sheet.filter(|_| !found.is_empty()) {
                sheet.write(&folder.join("sheet.png"), replace)?;
            }
            let heading = format!(
                "{name}: {} fragments, at most {} in a pixel{}\n",
                list.len(),
                list.depth_complexity(),
                moving(self.path(), &found)
            );
            if !ui.json() {
                let on_gpu = gpu.map_or_else(String::new, |gpu| gpu_rows(gpu, self.gpu_storage.into(), &found));
                ui.print(&format!("{heading}{}{on_gpu}{remarks}\n", rows(&found)))?;
            }
            results.extend(
                found
                    .iter()
                    .map(|(cpu, gpu)| with_scene(cpu, name, &list, gpu.as_ref())),
            );
        }
        let skip = Skip::from(self.skip);
        for result in results.iter_mut().filter_map(Value::as_object_mut) {
            let method = result.get("method").and_then(Value::as_str);
            if method.is_some_and(|name| with_skip.contains(name)) {
                result.insert("skip".to_owned(), json!(skip));
            }
        }
        let report = ui.report("evaluate", results);
        let json = serde_json::to_string_pretty(&report)? + "\n";
        write_atomically(&self.out.join(RESULTS), replace, |w| w.write_all(json.as_bytes()))?;
        if ui.json() {
            ui.print(&json)?;
        } else {
            ui.print(&format!("{}\n", self.out.display()))?;
        }
        if refused {
            bail!("a method that was asked for by name could not be applied; see above");
        }
        Ok(Verdict::Fine)
    }

    /// The way of the camera, where it moves.
    fn path(&self) -> Option<CameraPath> {
        self.frames.map(|frames| CameraPath {
            frames,
            degrees_per_frame: self.degrees_per_frame,
        })
    }

    fn methods(&self) -> anyhow::Result<Vec<Asked>> {
        let mut methods = Vec::new();
        let mut seen = HashSet::new();
        let shader = |path: &Path| shipped::open(path).map(|mlp| MethodShader::neural(&mlp, Format::WGSL));
        for name in &self.methods {
            let (names, demanded) = if name == "all" {
                (all_names(), false)
            } else {
                (vec![name.clone()], true)
            };
            for name in names {
                if seen.insert(name.clone()) {
                    let method = parse(&name)?;
                    let shader = match name.strip_prefix("neural:") {
                        _ if !self.gpu => None,
                        Some(path) => Some(shader(Path::new(path))?),
                        None => shader_of(&name).map(Ok),
                    };
                    methods.push(Asked {
                        method,
                        demanded,
                        skips: false,
                        shader,
                    });
                }
            }
        }
        for path in &self.model {
            let method = Box::new(Neural::new(shipped::open(path)?).with_skip(self.skip.into()));
            methods.push(Asked {
                method,
                demanded: true,
                skips: true,
                shader: self.gpu.then(|| shader(path)).transpose()?,
            });
            let after = Neural::new(shipped::open(path)?)
                .with_skip(self.skip.into())
                .with_frame(MomentFrame::Pixel);
            // A network whose moments are not of logarithmic depth has no other frame.
            if self.prepass && after.frame() == MomentFrame::Pixel {
                methods.push(Asked {
                    method: Box::new(after),
                    demanded: true,
                    skips: true,
                    shader: None,
                });
            }
        }
        Ok(methods)
    }
}

/// Changes of methods from frame to frame, as the camera moves about a scene.
fn changes(
    name: &str,
    options: &SceneOptions,
    path: CameraPath,
    methods: &[&dyn Method],
    (context, background): (Context, [f64; 3]),
    ui: &Ui,
) -> anyhow::Result<Vec<Option<OverTime>>> {
    let scene = moving_scene(name)?;
    let options = options.for_scene();
    let progress = ui.progress("frames", path.frames.into());
    let frame = |i: u32| {
        progress.set(i.into(), name);
        Ok::<_, anyhow::Error>(path.build(&scene, &options, i)?)
    };
    let changes = over_time::measure(path.frames, frame, methods, context, background)?;
    progress.finish();
    Ok(changes)
}

/// What the heading of a table says of frames.
fn moving(path: Option<CameraPath>, found: &[(MethodResult, Option<GpuResult>)]) -> String {
    let truth = found.iter().find_map(|(r, _)| r.over_time?.truth_change_mse);
    match (path, truth) {
        (Some(path), Some(truth)) => format!(
            "; {} frames, {} degrees a frame, the truth itself changes by {:.2e} (mean square)",
            path.frames, path.degrees_per_frame, truth
        ),
        _ => String::new(),
    }
}

/// A name for each scene: its file's stem, told apart by numbers where two have one.
fn scene_names(fragments: &[String]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for scene in fragments {
        let stem = Path::new(scene)
            .file_stem()
            .map_or_else(|| scene.clone(), |s| s.to_string_lossy().into_owned());
        let stem = file_stem(&stem);
        let free = (2..).map(|n| format!("{stem}-{n}")).find(|n| !names.contains(n));
        names.push(if names.contains(&stem) {
            free.expect("there are more numbers than scenes")
        } else {
            stem
        });
    }
    names
}

/// A result with what it is of.
fn with_scene(result: &MethodResult, scene: &str, list: &FragmentList, gpu: Option<&GpuResult>) -> Value {
    let mut value = serde_json::to_value(result).expect("results are plain data");
    if let Some(object) = value.as_object_mut() {
        object.insert("scene".to_owned(), scene.into());
        object.insert("pixels".to_owned(), list.pixels().into());
        object.insert("fragments".to_owned(), list.len().into());
        object.insert("depth_complexity".to_owned(), list.depth_complexity().into());
        if let Some(gpu) = gpu {
            object.insert(
                "gpu".to_owned(),
                serde_json::to_value(gpu).expect("results are plain data"),
            );
        }
    }
    value
}

/// Results as a table, in the order in which they stand.
fn rows(results: &[(MethodResult, Option<GpuResult>)]) -> String {
    let number = |x: Option<f64>, text: &dyn Fn(f64) -> String| match x {
        None => "-".to_owned(),
        Some(x) if x.is_nan() => "NaN".to_owned(),
        Some(x) => text(x),
    };
    let head = [
        "method",
        "image MSE",
        "PSNR dB",
        "FLIP",
        "T-MSE",
        "worst T",
        "non-finite",
        "bits/pixel",
        "seconds",
    ];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    let moving = results.iter().any(|(r, _)| r.over_time.is_some());
    if moving {
        lines[0].extend(["frame change", "worst change"].map(str::to_owned));
    }
    for (r, _) in results {
        let mut line = vec![
            r.method.clone(),
            number(r.image_mse, &|x| format!("{x:.2e}")),
            number(r.image_psnr_db, &|x| format!("{x:.1}")),
            number(r.flip_mean, &|x| format!("{x:.4}")),
            number(r.transmittance_mse, &|x| format!("{x:.2e}")),
            number(r.transmittance_worst_error, &|x| format!("{x:.3}")),
            r.nonfinite.to_string(),
            if r.bits_per_pixel == u32::MAX {
                "unbounded".to_owned()
            } else {
                r.bits_per_pixel.to_string()
            },
            format!("{:.3}", r.seconds),
        ];
        if moving {
            let change = r.over_time;
            line.push(number(change.and_then(|c| c.frame_change_mse), &|x| format!("{x:.2e}")));
            line.push(number(change.and_then(|c| c.frame_change_worst), &|x| {
                format!("{x:.4}")
            }));
        }
        lines.push(line);
    }
    table(&lines)
}

/// What the GPU drew, as a table under its name.
fn gpu_rows(gpu: &Gpu, storage: TargetPrecision, results: &[(MethodResult, Option<GpuResult>)]) -> String {
    if results.iter().all(|r| r.1.is_none()) {
        return String::new();
    }
    let milliseconds = |s: f64| format!("{:.2}", s * 1e3);
    let head = [
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
    ];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    for r in results.iter().filter_map(|r| r.1.as_ref()) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_one_name_are_told_apart() {
        let names = scene_names(&["a/x.npz", "b/x.npz", "smoke", "x"].map(str::to_owned));
        assert_eq!(names, ["x", "x-2", "smoke", "x-3"]);
    }
}
