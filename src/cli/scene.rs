//! `nmt scene`

use super::ui::Ui;
use super::{Verdict, keep_inputs, shown};
use crate::numeric::file::{FileError, Replace, may_write};
use crate::oit::Context;
use crate::pixel::{CameraPlanes, DepthWarning, FragmentList};
use crate::scene::{self, BUILT_IN, Camera, ListFormat, Options, SceneError, SceneFile};
use anyhow::{Context as _, bail};
use clap::Args;
use serde_json::json;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Scene {
    /// glass-stacks, smoke, hair, foliage, spheres, sphere-cluster, teapots, splats; or a scene file (.toml), a mesh
    /// (.obj, .gltf, .glb), Gaussian splats (.splat, .ply, .spz), a fragment list (.npz) or a deep image (.exr).
    scene: OsString,
    /// Fragment list to write: .npz, or .exr for a deep image.
    #[arg(long, value_name = "F.npz")]
    out: PathBuf,
    #[command(flatten)]
    options: SceneOptions,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

/// How a scene is rendered.
#[derive(Args, Clone, Default)]
pub struct SceneOptions {
    /// Size of the image instead of the scene's own, as 1024x768.
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Seed of a built-in scene.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Part of a deep image, instead of the first deep one.
    #[arg(long, value_name = "NAME|N")]
    part: Option<String>,
}

/// How fragments are looked at: the camera that saw them, the range of depth, and what lies behind.
#[derive(Args)]
pub struct ViewOptions {
    /// Near plane of the camera, instead of the list's own [scene units].
    #[arg(long, requires = "far")]
    near: Option<f32>,
    /// Far plane of the camera, instead of the list's own [scene units].
    #[arg(long, requires = "near")]
    far: Option<f32>,
    /// View depths that moment depth -1 and 1 stand for, instead of the list's extremes [scene units].
    #[arg(long, num_args = 2, value_names = ["V0", "V1"])]
    depth_range: Option<Vec<f32>>,
    /// Linear colour behind everything.
    #[arg(long, num_args = 3, value_names = ["R", "G", "B"], default_values_t = [1.0, 1.0, 1.0])]
    background: Vec<f64>,
}

impl ViewOptions {
    /// What methods must know besides the fragments.
    pub fn context(&self) -> anyhow::Result<Context> {
        let planes = self
            .near
            .zip(self.far)
            .map(|(near, far)| CameraPlanes::new(near, far))
            .transpose()?;
        Ok(Context {
            planes,
            depth_range: self.depth_range.as_deref().map(|r| (r[0], r[1])),
        })
    }

    /// The colour, every channel of which is 0 or more.
    pub fn background(&self) -> anyhow::Result<[f64; 3]> {
        let background = [self.background[0], self.background[1], self.background[2]];
        match background.iter().find(|c| !(0.0..f64::INFINITY).contains(*c)) {
            Some(wrong) => bail!("--background {wrong}: every channel must be 0 or more, and finite"),
            None => Ok(background),
        }
    }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let (width, height) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, as 1024x768")?;
    match (width.parse(), height.parse()) {
        (Ok(width), Ok(height)) => Ok((width, height)),
        _ => Err("expected two whole numbers, as 1024x768".to_owned()),
    }
}

impl SceneOptions {
    /// What they change about a scene that is rendered.
    pub fn for_scene(&self) -> Options {
        Options {
            size: self.size,
            seed: self.seed,
        }
    }
}

/// Whether a name is that of a file which holds fragments, and no scene.
fn is_list(name: &OsStr) -> bool {
    ListFormat::of(Path::new(name)).is_ok() && !is_built_in(name)
}

fn is_built_in(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| BUILT_IN.contains(&name))
}

/// Refuses what can be told to be none of a list or a scene before any is read or rendered, which may take long: a file
/// that is not there, a name that no scene has, a scene file that is wrong.
pub fn look_at(name: &OsStr) -> anyhow::Result<()> {
    let path = Path::new(name);
    if is_list(name) || SceneFile::of_file(path).is_some() {
        std::fs::File::open(path).map_err(FileError::io(path, "cannot read"))?;
        return Ok(());
    }
    open(name)?;
    Ok(())
}

/// A scene whose camera can move.
pub fn moving_scene(name: &OsStr) -> anyhow::Result<SceneFile> {
    if is_list(name) {
        bail!(
            "{}: --frames moves the camera, and a fragment list has none; pass the scene file or a built-in scene",
            Path::new(name).display()
        );
    }
    Ok(open(name)?)
}

/// A scene by its name, or of a file, whose name need not be UTF-8.
pub fn open(name: &OsStr) -> Result<SceneFile, SceneError> {
    let path = Path::new(name);
    match name.to_str() {
        Some(name) => scene::open(name),
        None => SceneFile::of_file(path).map_or_else(|| SceneFile::read(path), Ok),
    }
}

/// The fragments of a scene by its name, or of a file; what is left out or makes no sense is said.
pub fn load(ui: &Ui, name: &(impl AsRef<OsStr> + ?Sized), options: &SceneOptions) -> anyhow::Result<FragmentList> {
    let name = name.as_ref();
    let path = Path::new(name);
    if is_list(name) {
        if options.size.is_some() || options.seed.is_some() {
            bail!(
                "{}: --size and --seed are for scenes that are rendered, not for fragment lists",
                path.display()
            );
        }
        return load_list(ui, path, options.part.as_deref());
    }
    if options.part.is_some() {
        bail!("{}: --part is for deep images (.exr)", path.display());
    }
    let scene = open(name)?;
    let (list, camera) = scene::build_with_camera(&scene, &options.for_scene())?;
    if scene.camera.is_none() && !is_built_in(name) {
        ui.warn(&placed(path, &camera));
    }
    ui.left_out(&list);
    Ok(list)
}

/// A fragment list from a file; what is left out or makes no sense is said.
pub fn load_list(ui: &Ui, path: &Path, part: Option<&str>) -> anyhow::Result<FragmentList> {
    let list = scene::read_part(path, part)?;
    ui.left_out(&list);
    for warning in list.depth_warnings(None) {
        // Against planes that the command line may replace, those that compute anything decide by themselves.
        if !matches!(warning, DepthWarning::OutsidePlanes { .. }) {
            ui.depth_warning(&shown(path), &warning);
        }
    }
    Ok(list)
}

/// Refuses a list whose fragments lie outside the camera planes: some methods could not order them, and none should.
pub fn refuse_outside(list: &FragmentList, planes: Option<CameraPlanes>) -> anyhow::Result<()> {
    let warnings = list.depth_warnings(planes);
    match warnings
        .iter()
        .find(|w| matches!(w, DepthWarning::OutsidePlanes { .. }))
    {
        Some(outside) => bail!("{outside}"),
        None => Ok(()),
    }
}

/// The camera that was chosen, as a scene file would give it.
fn placed(path: &Path, camera: &Camera) -> String {
    let Camera {
        position, look_at, up, ..
    } = camera;
    format!(
        "{}: no camera is given; it is seen by\n[camera]\nposition = {position:.4?}\nlook_at = {look_at:.4?}\nup = \
            {up:?}\nvertical_fov = {}\n\
         width = {}\nheight = {}\nnear = {}\nfar = {}",
        path.display(),
        camera.vertical_fov,
        camera.width,
        camera.height,
        camera.near,
        camera.far
    )
}

/// The fragments of a scene, its objects drawn in a random order; none of a list, whose objects are not known.
pub fn load_in_random_order(name: &OsStr, options: &SceneOptions, seed: u64) -> anyhow::Result<Option<FragmentList>> {
    if is_list(name) {
        return Ok(None);
    }
    let options = options.for_scene();
    Ok(Some(scene::build_in_random_order(&open(name)?, &options, seed)?))
}

impl Scene {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        keep_inputs(&[Path::new(&self.scene)], &self.out)?;
        let format = ListFormat::of(&self.out).context("--out")?;
        look_at(&self.scene)?;
        may_write(&self.out, replace)?;
        let start = Instant::now();
        let list = load(ui, &self.scene, &self.options)?;
        let seconds = start.elapsed().as_secs_f64();
        for warning in list
            .depth_warnings(None)
            .iter()
            .filter(|w| matches!(w, DepthWarning::OutsidePlanes { .. }))
        {
            ui.depth_warning(&shown(Path::new(&self.scene)), warning);
        }
        format.write(&self.out, replace, &list)?;
        if ui.json() {
            let (width, height) = list.size().unzip();
            ui.print_json(
                "scene",
                vec![json!({
                    "scene": shown(Path::new(&self.scene)), "file": shown(&self.out), "pixels": list.pixels(),
                        "width": width, "height": height, "fragments": list.len(),
                    "depth_complexity": list.depth_complexity(), "seconds": seconds,
                })],
            )?;
        } else {
            ui.print(&format!(
                "{} fragments in {} pixels (at most {} in one), {seconds:.2} s\n{}\n",
                list.len(),
                list.pixels(),
                list.depth_complexity(),
                self.out.display()
            ))?;
        }
        Ok(Verdict::Fine)
    }
}
