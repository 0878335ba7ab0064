//! `nmt evaluate`

mod chart;
mod frames;
mod methods;
mod shadows;
mod tables;
mod unfinished;

use super::Verdict;
use super::predict::SkipName;
use super::scene::{SceneOptions, ViewOptions, load, load_in_random_order, look_at, moving_scene, refuse_outside};
use super::ui::Ui;
use crate::evaluate::gpu::{self, GpuResult};
use crate::evaluate::judge::by_error;
use crate::evaluate::order::{fragment_orders, judge_in_orders};
use crate::evaluate::picture::{FLIP_TOP, Sheet, file_stem, write_flip, write_floats, write_image, write_method};
use crate::evaluate::{EvaluateError, Image, Judged, MethodResult, OrderedList, Shuffled, Tinted, TintedResult, Truth};
use crate::gpu::Gpu;
use crate::numeric::file::{Replace, may_write, read, write_atomically};
use crate::oit::neural::Skip;
use crate::oit::{Context, Method};
use crate::pixel::FragmentList;
use crate::scene::BUILT_IN;
use crate::shader::passes::TargetPrecision;
use anyhow::bail;
use clap::Args;
use methods::Requested;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use unfinished::Unfinished;

#[derive(Args)]
pub struct Evaluate {
    /// Scenes: fragment lists (.npz), deep images (.exr), scene files (.toml) or names of built-in scenes; "built-in"
    /// stands for all of those.
    #[arg(long, value_name = "F.npz|SCENE", required = true, value_delimiter = ',', num_args = 1..)]
    fragments: Vec<OsString>,
    /// Methods, by name; "all" stands for every classic one, and without the option there are those that tell the
    /// story.
    #[arg(long, value_delimiter = ',', num_args = 1..)]
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
    /// Random orders of fragments, and as many of whole objects where the scene is rendered here, for methods that
    /// depend on the order; errors are means over them. 0 takes fragments as they stand in the list.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u64).range(0..=100))]
    orders: u64,
    /// Evaluate them also on glass that is tinted in its own colour by this strength, from 0 to 1: with one
    /// transmittance, and with one a channel.
    #[arg(long, value_name = "S")]
    tint: Option<f64>,
    /// Evaluate shadows instead of images: how much light reaches points of a scene that has a light, against rays.
    #[arg(long, conflicts_with_all = ["gpu", "tint", "frames"])]
    shadows: bool,
    /// Points of surfaces that are asked for their light; of the floor under the scene there are about five times as
    /// many.
    #[arg(long, value_name = "N", requires = "shadows", default_value_t = 2000,
        value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    shadow_points: u32,
    /// Folder for images, contact sheets, comparison.md, comparison.svg and results.json.
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
    /// Angle of the camera between two frames, in degrees.
    #[arg(long, value_name = "D", requires = "frames", default_value_t = 0.6, value_parser = frames::turn,
        allow_negative_numbers = true)]
    degrees_per_frame: f64,
    /// Draw them on the GPU too, those that have a shader, and compare with the CPU's images.
    #[arg(long)]
    gpu: bool,
    /// How the GPU stores sums between render passes.
    #[arg(long, value_enum, requires = "gpu", default_value = "full")]
    gpu_storage: StorageName,
    /// Write every image also as numbers: beside NAME.png stands NAME.npy, f32 [height, width, 3] of linear colour,
    /// neither clamped nor encoded.
    #[arg(long, conflicts_with = "shadows")]
    float_images: bool,
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

/// The file that holds all numbers.
const RESULTS: &str = "results.json";

/// What is the same for every scene.
struct Session<'a> {
    options: &'a Evaluate,
    ui: &'a Ui,
    replace: Replace,
    context: Context,
    background: [f64; 3],
    methods: Vec<Requested>,
    gpu: Option<&'static Gpu>,
    /// What the files hold that say what is evaluated; see [`Evaluate::inputs`].
    inputs: Vec<Vec<u8>>,
}

/// A method's numbers on a scene, on the CPU and where it was drawn there on the GPU.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct Row {
    cpu: MethodResult,
    gpu: Option<GpuResult>,
    tinted: Option<TintedResult>,
    /// Whether it was asked for by its own name.
    demanded: bool,
}

/// What was found on a scene.
struct SceneResults {
    name: String,
    pixels: usize,
    fragments: usize,
    depth_complexity: usize,
    /// Least error first.
    rows: Vec<Row>,
    /// Methods that could not be applied, and why; whether they were asked for by name.
    refused: Vec<(String, String, bool)>,
    /// What a reader should know besides, a line each.
    remarks: String,
}

impl SceneResults {
    /// Of a scene, before any method is applied.
    fn new(name: &str, list: &FragmentList) -> Self {
        Self {
            name: name.to_owned(),
            pixels: list.pixels(),
            fragments: list.len(),
            depth_complexity: list.depth_complexity(),
            rows: Vec::new(),
            refused: Vec::new(),
            remarks: String::new(),
        }
    }
}

impl Evaluate {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let scenes = self.scenes();
        scenes.iter().try_for_each(|scene| look_at(scene))?;
        let mut session = self.session(ui)?;
        let names = scene_names(&scenes);
        if self.shadows {
            let named: Vec<(OsString, String)> = scenes.into_iter().zip(names).collect();
            if session.shadows(&named)? {
                bail!("a method could not be applied; see above");
            }
            return Ok(Verdict::Fine);
        }
        Unfinished::may_begin(&self.out, &session.inputs, session.replace, &names)?;
        let lists = session.lists(&scenes)?;
        let unfinished;
        (unfinished, session.replace) = Unfinished::begin(&self.out, &names, &session.inputs, session.replace)?;
        let mut results = Vec::new();
        for ((scene, name), list) in scenes.iter().zip(&names).zip(lists) {
            let found = match unfinished.restore(name, &list) {
                Some(found) => found,
                None => {
                    let found = session.scene(scene, name, &list)?;
                    unfinished.keep(&found, &list)?;
                    found
                }
            };
            if !ui.json() {
                ui.print(&session.text(&found))?;
            }
            results.push(found);
        }
        session.finish(&results)?;
        unfinished.end(&results)?;
        let refused = results
            .iter()
            .flat_map(|r| &r.refused)
            .any(|(_, _, demanded)| *demanded);
        if refused {
            bail!("a method that was asked for by name could not be applied; see above");
        }
        Ok(Verdict::Fine)
    }

    /// The model files that methods name, behind a colon, and those of `--model`; and scene files, which say more than
    /// the fragments of the first frame do.
    fn inputs(&self) -> anyhow::Result<Vec<Vec<u8>>> {
        let named = self.methods.iter().filter_map(|name| Some(name.split_once(':')?.1));
        let scenes = self.fragments.iter().map(PathBuf::from);
        let scenes = scenes.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
        let paths = self.model.iter().cloned().chain(named.map(PathBuf::from)).chain(scenes);
        let files = paths.filter(|path| path.is_file());
        files.map(|path| Ok(read(&path)?)).collect()
    }

    /// Everything that can be refused before a scene is rendered.
    fn session<'a>(&'a self, ui: &'a Ui) -> anyhow::Result<Session<'a>> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        if let Some(wrong) = self.tint.filter(|s| !(0.0..=1.0).contains(s)) {
            bail!("--tint {wrong}: a strength lies from 0 to 1");
        }
        let methods = self.requested()?;
        let inputs = self.inputs()?;
        if !unfinished::is_left(&self.out, &inputs) {
            may_write(&self.out.join(RESULTS), replace)?;
        }
        Ok(Session {
            options: self,
            ui,
            replace,
            context: self.view.context()?,
            background: self.view.background()?,
            methods,
            gpu: if self.gpu { Some(Gpu::shared()?) } else { None },
            inputs,
        })
    }

    fn scenes(&self) -> Vec<OsString> {
        let all = || BUILT_IN.iter().map(OsString::from).collect();
        let of = |name: &OsString| if name == "built-in" { all() } else { vec![name.clone()] };
        self.fragments.iter().flat_map(of).collect()
    }
}

impl Session<'_> {
    /// The fragments of all scenes, so that whatever is wrong with the last is said before the first is judged.
    fn lists(&self, scenes: &[OsString]) -> anyhow::Result<Vec<FragmentList>> {
        if self.options.frames.is_some() {
            scenes.iter().try_for_each(|scene| moving_scene(scene).map(drop))?;
        }
        let list = |scene: &OsString| {
            let list = load(self.ui, scene, &self.options.options)?;
            refuse_outside(&list, self.context.planes)?;
            Ok(list)
        };
        scenes.iter().map(list).collect()
    }

    /// Judges all methods on a scene and writes its pictures.
    fn scene(&self, scene: &OsStr, name: &str, list: &FragmentList) -> anyhow::Result<SceneResults> {
        let truth = Truth::new(list, self.background);
        let mut remarks = String::new();
        let mut sheet = self.sheet(name, &truth, &mut remarks)?;
        let progress = self.ui.progress("evaluate", self.methods.len() as u64);
        progress.set(0, format!("{name}: random orders"));
        let mut in_orders = self.judge_in_orders(scene, &truth)?;
        let tinted = match self.options.tint {
            Some(strength) if truth.image().is_ok() => Some((Tinted::new(list, strength, self.background)?, strength)),
            _ => None,
        };
        let mut refused = Vec::new();
        let mut rows: Vec<Row> = Vec::new();
        let mut stems = HashSet::from(["truth".to_owned(), "sheet".to_owned()]);
        // One method's images after the other's, so that large scenes fit.
        for (index, requested) in self.methods.iter().enumerate() {
            let method = &*requested.method;
            progress.set(index as u64, format!("{name}: {}", method.name()));
            let judged = match self.is_in_orders(method) {
                true => in_orders.next().expect("one result a method"),
                false => truth.judge(method, self.context),
            };
            let mut judged = match judged {
                Ok(judged) => judged,
                Err(why) => {
                    remarks += &format!("not applied, {why}\n");
                    refused.push((method.name(), why.to_string(), requested.demanded));
                    continue;
                }
            };
            let stem = free_stem(&method.name(), &mut stems);
            write_method(&self.folder(name), &stem, self.replace, &judged)?;
            if let Some((image, _)) = &judged.picture {
                self.write_floats(name, &stem, image)?;
            }
            let drawn = self.draw(name, &stem, &truth, requested, &judged, &mut remarks)?;
            judged.result.picture = judged.picture.is_some().then_some(stem);
            if let Some(sheet) = &mut sheet {
                sheet.add(&judged)?;
            }
            rows.push(Row {
                cpu: judged.result,
                gpu: drawn,
                tinted: match &tinted {
                    Some((glass, s)) => Some(glass.judge(method, self.context, *s, self.background)?),
                    None => None,
                },
                demanded: requested.demanded,
            });
        }
        progress.finish();
        self.add_changes(scene, &mut rows)?;
        rows.sort_by(|a, b| by_error(&a.cpu, &b.cpu));
        if let Some(sheet) = sheet.filter(|_| !rows.is_empty()) {
            sheet.write(&self.folder(name).join("sheet.png"), self.replace)?;
        }
        Ok(SceneResults {
            rows,
            refused,
            remarks,
            ..SceneResults::new(name, list)
        })
    }

    fn folder(&self, scene: &str) -> PathBuf {
        self.options.out.join(scene)
    }

    /// Writes an image as numbers where that was asked for.
    fn write_floats(&self, scene: &str, stem: &str, image: &Image) -> anyhow::Result<()> {
        if self.options.float_images {
            write_floats(&self.folder(scene).join(format!("{stem}.npy")), self.replace, image)?;
        }
        Ok(())
    }

    /// Writes the exact image and begins the contact sheet; errors of T need neither.
    fn sheet(&self, name: &str, truth: &Truth<'_>, remarks: &mut String) -> anyhow::Result<Option<Sheet>> {
        match truth.image() {
            Ok(image) => {
                write_image(&self.folder(name).join("truth.png"), self.replace, image)?;
                self.write_floats(name, "truth", image)?;
                Ok(Some(Sheet::new(name, truth.list(), image)))
            }
            Err(why) => {
                *remarks += &format!("no pictures, {why}\n");
                Ok(None)
            }
        }
    }

    /// Whether a method is judged in random orders: it depends on the order, and some are asked for.
    fn is_in_orders(&self, method: &dyn Method) -> bool {
        self.options.orders > 0 && method.capabilities().order_dependent
    }

    /// Results of the methods that are judged in random orders, in their order.
    fn judge_in_orders(
        &self,
        scene: &OsStr,
        truth: &Truth<'_>,
    ) -> anyhow::Result<impl Iterator<Item = Result<Judged, EvaluateError>> + use<>> {
        let methods = self.methods.iter().map(|r| &*r.method);
        let dependent: Vec<&dyn Method> = methods.filter(|m| self.is_in_orders(*m)).collect();
        let orders = self.orders(scene, truth.list());
        Ok(judge_in_orders(&dependent, orders, self.context, self.background)?.into_iter())
    }

    /// Random orders of fragments, then of whole objects where the scene is rendered here.
    fn orders<'b>(
        &'b self,
        scene: &'b OsStr,
        list: &'b FragmentList,
    ) -> impl Iterator<Item = anyhow::Result<OrderedList>> + 'b {
        let objects = (1..=self.options.orders).filter_map(move |seed| {
            let list = load_in_random_order(scene, &self.options.options, seed).transpose()?;
            Some(list.map(|list| OrderedList {
                shuffled: Shuffled::Objects,
                seed,
                list,
            }))
        });
        fragment_orders(list, self.options.orders).map(Ok).chain(objects)
    }

    /// Draws a method on the GPU where that was asked for and there is a shader; why not is a remark.
    fn draw(
        &self,
        scene: &str,
        stem: &str,
        truth: &Truth<'_>,
        requested: &Requested,
        judged: &Judged,
        remarks: &mut String,
    ) -> anyhow::Result<Option<GpuResult>> {
        let (Some(gpu), Some((image, _))) = (self.gpu, &judged.picture) else {
            return Ok(None);
        };
        let drawn = match &requested.shader {
            Some(Ok(shader)) => {
                let skip = if requested.skips {
                    self.options.skip.into()
                } else {
                    Skip::Exact
                };
                let storage = self.options.gpu_storage.into();
                gpu::judge(gpu, shader, truth, self.context, storage, skip, image).map_err(|e| e.to_string())
            }
            Some(Err(why)) => Err(why.to_string()),
            None => Err(format!("{} has no shader", requested.method.name())),
        };
        match drawn {
            Ok(drawn) => {
                let folder = self.folder(scene);
                write_image(&folder.join(format!("{stem}.gpu.png")), self.replace, &drawn.image)?;
                write_flip(&folder.join(format!("{stem}.gpu.flip.png")), self.replace, &drawn.map)?;
                self.write_floats(scene, &format!("{stem}.gpu"), &drawn.image)?;
                Ok(Some(drawn.result))
            }
            Err(why) => {
                *remarks += &format!("not on the GPU, {why}\n");
                Ok(None)
            }
        }
    }

    /// What a person reads about a scene.
    fn text(&self, found: &SceneResults) -> String {
        let heading = format!(
            "{}: {} fragments, at most {} in a pixel{}\n",
            found.name,
            found.fragments,
            found.depth_complexity,
            self.moving(&found.rows)
        );
        let on_gpu = self.gpu.map_or_else(String::new, |gpu| {
            tables::gpu_rows(gpu, self.options.gpu_storage.into(), &found.rows)
        });
        let tinted = tables::tinted_rows(&found.rows);
        format!(
            "{heading}{}{on_gpu}{tinted}{}\n",
            tables::rows(&found.rows),
            found.remarks
        )
    }

    /// Writes the numbers of all scenes, and of several scenes a table and a chart.
    fn finish(&self, scenes: &[SceneResults]) -> anyhow::Result<()> {
        let write = |name: &str, text: &str| {
            write_atomically(&self.options.out.join(name), self.replace, |w| {
                w.write_all(text.as_bytes())
            })
        };
        let report = self
            .ui
            .report("evaluate", scenes.iter().flat_map(|s| self.json(s)).collect());
        let json = serde_json::to_string_pretty(&report)? + "\n";
        write(RESULTS, &json)?;
        let mut comparison = String::new();
        if scenes.len() > 1 {
            comparison = tables::comparison(scenes);
            write("comparison.md", &comparison)?;
            if let Some(chart) = chart::chart(scenes) {
                write("comparison.svg", &chart)?;
            }
        }
        if self.ui.json() {
            return self.ui.print(&json);
        }
        let gap = if comparison.is_empty() { "" } else { "\n" };
        self.ui.print(&format!("{comparison}{gap}{}", self.places(scenes)))
    }

    /// Where a reader finds what was written; the folder stands last.
    fn places(&self, scenes: &[SceneResults]) -> String {
        let out = &self.options.out;
        let pictured = |scene: &&SceneResults| scene.rows.iter().any(|row| row.cpu.picture.is_some());
        let mut text = String::new();
        for scene in scenes.iter().filter(pictured) {
            text += &format!(
                "contact sheet  {}\n",
                self.folder(&scene.name).join("sheet.png").display()
            );
        }
        if !text.is_empty() {
            text += &format!("FLIP maps beside it run from near black, 0, to pale yellow, {FLIP_TOP} and more\n");
        }
        text += &format!("numbers        {}\n", out.join(RESULTS).display());
        text + &format!("one page       nmt report {0}\n{0}\n", out.display())
    }

    /// One object a method, those that could not be applied first.
    fn json(&self, scene: &SceneResults) -> Vec<Value> {
        let refused = scene
            .refused
            .iter()
            .map(|(method, why, _)| json!({ "scene": scene.name, "method": method, "error": why }));
        let found = scene.rows.iter().map(|row| with_scene(row, scene));
        let with_skip: HashSet<String> = self
            .methods
            .iter()
            .filter(|requested| requested.skips)
            .map(|requested| requested.method.name())
            .collect();
        let skip = Skip::from(self.options.skip);
        let mut results: Vec<Value> = refused.chain(found).collect();
        for result in results.iter_mut().filter_map(Value::as_object_mut) {
            let method = result.get("method").and_then(Value::as_str);
            if method.is_some_and(|name| with_skip.contains(name)) {
                result.insert("skip".to_owned(), json!(skip));
            }
        }
        results
    }
}

/// A stem for a method's files that no other method has, which is then taken.
fn free_stem(method: &str, taken: &mut HashSet<String>) -> String {
    let stem = file_stem(method);
    let numbered = (2..).map(|n| format!("{stem}-{n}"));
    let free = std::iter::once(stem.clone())
        .chain(numbered)
        .find(|s| !taken.contains(s));
    let free = free.expect("there are more numbers than methods");
    taken.insert(free.clone());
    free
}

/// A name for each scene: its file's stem; where two have one, as much of the paths before it as tells them apart; and
/// numbers where one scene is named twice.
fn scene_names(fragments: &[OsString]) -> Vec<String> {
    // What a path ends with: of so many components, the last without its ending.
    let suffix = |scene: &OsString, length: usize| {
        let path = Path::new(scene).with_extension("");
        let parts: Vec<_> = path.iter().map(OsStr::to_string_lossy).collect();
        file_stem(&parts[parts.len().saturating_sub(length)..].join("-"))
    };
    let name = |scene: &OsString| {
        let others = || fragments.iter().filter(|&other| other != scene);
        let length = (1..Path::new(scene).iter().count().max(1))
            .find(|&length| others().all(|other| suffix(other, length) != suffix(scene, length)))
            .unwrap_or_else(|| Path::new(scene).iter().count());
        suffix(scene, length)
    };
    let mut names: Vec<String> = Vec::new();
    for scene in fragments {
        let name = name(scene);
        let numbered = (2..).map(|n| format!("{name}-{n}"));
        let free = std::iter::once(name.clone())
            .chain(numbered)
            .find(|n| !names.contains(n));
        names.push(free.expect("there are more numbers than scenes"));
    }
    names
}

/// A result with what it is of.
fn with_scene(row: &Row, scene: &SceneResults) -> Value {
    let mut value = serde_json::to_value(&row.cpu).expect("results are plain data");
    if let Some(object) = value.as_object_mut() {
        object.insert("scene".to_owned(), scene.name.clone().into());
        object.insert("pixels".to_owned(), scene.pixels.into());
        object.insert("fragments".to_owned(), scene.fragments.into());
        object.insert("depth_complexity".to_owned(), scene.depth_complexity.into());
        if let Some(tinted) = &row.tinted {
            object.insert("tinted".to_owned(), json!(tinted));
        }
        if let Some(gpu) = &row.gpu {
            object.insert(
                "gpu".to_owned(),
                serde_json::to_value(gpu).expect("results are plain data"),
            );
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_one_name_are_told_apart() {
        let names = scene_names(&["a/x.npz", "b/x.npz", "smoke", "x", "c/y.npz", "x"].map(OsString::from));
        assert_eq!(names, ["a-x", "b-x", "smoke", "x", "y", "x-2"]);
    }
}
