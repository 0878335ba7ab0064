//! Scene files: what is to be seen, and from where, in TOML.

use super::camera::{Camera, Vec3, View, cross, dot, sub, unit};
use super::mesh::{self, Affine, IDENTITY, Overrides, Part, apply, compose};
use super::raster::{Geometry, TexturedTriangle, Triangle, Vertex, rasterise};
use super::splat::{Splat, file as splat_file};
use super::{BUILT_IN, Options, SceneError, procedural};
use crate::numeric::file::{read, without_mark};
use crate::pixel::{FragmentList, LeftOut};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A scene: one of the built-in ones, or meshes and splats, and the camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Name of a built-in scene, see [`BUILT_IN`]; none where there are meshes or splats.
    pub built_in: Option<String>,
    /// Seed of a built-in scene; 1 where none is given.
    pub seed: Option<u64>,
    /// The camera. Where none is given, a built-in scene has one of its own, and one is placed so that it sees all of a
    /// file's content.
    pub camera: Option<Camera>,
    /// A spot light, described as the camera that sees what it shines on; a built-in scene has one of its own where
    /// none is given.
    pub light: Option<Camera>,
    /// Meshes; none where a built-in scene is named.
    #[serde(default, rename = "mesh")]
    pub meshes: Vec<MeshEntry>,
    /// Files of Gaussian splats; none where a built-in scene is named.
    #[serde(default)]
    pub splats: Vec<SplatEntry>,
    /// The file that this was read from; messages and relative names refer to it.
    #[serde(skip)]
    path: PathBuf,
}

/// A mesh of a scene file. Its points are scaled, then rotated about x, y and z in this order, then translated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MeshEntry {
    /// An OBJ, glTF or GLB file; relative to the scene file's folder.
    pub file: PathBuf,
    /// Opacity of every material, in [0, 1]; as the file says where none is given.
    pub alpha: Option<f32>,
    /// Linear colour of every material; as the file says where none is given.
    pub color: Option<[f32; 3]>,
    /// Opacity and colour of single materials by name; they win over `alpha` and `color`.
    #[serde(default)]
    pub materials: BTreeMap<String, MaterialOverride>,
    /// Size factor, > 0.
    pub scale: Option<f64>,
    /// Angles about x, y and z \[degrees\].
    pub rotate: Option<Vec3>,
    /// Where the mesh's origin is put [scene units].
    pub translate: Option<Vec3>,
}

/// A file of Gaussian splats in a scene file, placed as a mesh is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SplatEntry {
    /// A .splat, .ply or .spz file; relative to the scene file's folder.
    pub file: PathBuf,
    /// Size factor, > 0.
    pub scale: Option<f64>,
    /// Angles about x, y and z \[degrees\].
    pub rotate: Option<Vec3>,
    /// Where the file's origin is put [scene units].
    pub translate: Option<Vec3>,
}

/// Opacity and colour that take the place of a material's own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MaterialOverride {
    /// Opacity, in [0, 1].
    pub alpha: Option<f32>,
    /// Linear colour, each channel 0 or more.
    pub color: Option<[f32; 3]>,
}

impl Overrides for MeshEntry {
    fn gives_alpha(&self, material: Option<&str>) -> bool {
        self.alpha_of(material).is_some()
    }

    fn gives_color(&self, material: Option<&str>) -> bool {
        self.color_of(material).is_some()
    }
}

/// What a camera sees, before it is drawn.
pub(super) struct Seen {
    /// Surfaces, particles and splats.
    pub geometry: Geometry,
    /// The camera, which is placed for the content where the scene file gives none.
    pub camera: Camera,
    /// Its view of the geometry.
    pub view: View,
    /// What was left out of the files.
    pub left_out: Vec<LeftOut>,
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] names the file, the line or the field, and what is expected there.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let bytes = read(path)?;
        let text = std::str::from_utf8(without_mark(&bytes)).map_err(|e| {
            let reason = "this byte is not UTF-8, which TOML is written in; save the file as UTF-8";
            SceneError::file_content(path, &format!("byte {}", e.valid_up_to()), reason)
        })?;
        Self::parse(path, text)
    }

    /// A scene of one mesh or one file of splats, by the ending of its name, seen by a camera that is placed for it;
    /// none for another name.
    pub fn of_file(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        let file: PathBuf = path.file_name()?.into();
        let mut scene = Self {
            built_in: None,
            seed: None,
            camera: None,
            light: None,
            meshes: Vec::new(),
            splats: Vec::new(),
            path: path.to_owned(),
        };
        if mesh::ENDINGS.contains(&ending.as_str()) {
            scene.meshes.push(MeshEntry {
                file,
                alpha: None,
                color: None,
                materials: BTreeMap::new(),
                scale: None,
                rotate: None,
                translate: None,
            });
        } else if splat_file::ENDINGS.contains(&ending.as_str()) {
            scene.splats.push(SplatEntry {
                file,
                scale: None,
                rotate: None,
                translate: None,
            });
        } else {
            return None;
        }
        Some(scene)
    }

    /// A scene file's content; `path` is what messages and relative names refer to.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, SceneError> {
        let mut scene: Self = toml::from_str(text).map_err(|e| SceneError::Toml {
            path: path.to_owned(),
            message: e.to_string(),
        })?;
        scene.path = path.to_owned();
        scene.validate()?;
        Ok(scene)
    }

    /// A built-in scene from its own camera.
    ///
    /// # Errors
    /// [`SceneError::UnknownBuiltIn`].
    pub fn built_in(name: &str) -> Result<Self, SceneError> {
        if !BUILT_IN.contains(&name) {
            return Err(SceneError::UnknownBuiltIn { name: name.to_owned() });
        }
        Ok(Self {
            built_in: Some(name.to_owned()),
            seed: None,
            camera: None,
            light: None,
            meshes: Vec::new(),
            splats: Vec::new(),
            path: name.into(),
        })
    }

    fn validate(&self) -> Result<(), SceneError> {
        let wrong =
            |field: &str, found: String, expected: &str| Err(SceneError::field(&self.path, field, found, expected));
        match (&self.built_in, self.meshes.is_empty() && self.splats.is_empty()) {
            (None, true) => return wrong("built_in, mesh, splats", "none is there".to_owned(), "one of them"),
            (Some(_), false) => {
                let expected = "a built-in scene alone, or meshes and splats";
                return wrong("built_in, mesh, splats", "more than one is there".to_owned(), expected);
            }
            (Some(name), true) if !BUILT_IN.contains(&name.as_str()) => {
                return wrong(
                    "built_in",
                    format!("'{name}'"),
                    &format!("one of {}", BUILT_IN.join(", ")),
                );
            }
            (None, false) if self.seed.is_some() => {
                return wrong(
                    "seed",
                    "there are meshes".to_owned(),
                    "no seed, which only built-in scenes have",
                );
            }
            _ => {}
        }
        if let Some(camera) = &self.camera {
            camera.view(&self.path)?;
        }
        for (i, mesh) in self.meshes.iter().enumerate() {
            let overall = (
                String::new(),
                MaterialOverride {
                    alpha: mesh.alpha,
                    color: mesh.color,
                },
            );
            let overrides = mesh
                .materials
                .iter()
                .map(|(name, material)| (format!(".materials.{name}"), *material));
            for (place, material) in std::iter::once(overall).chain(overrides) {
                if let Some(alpha) = material.alpha.filter(|a| !(0.0..=1.0).contains(a)) {
                    return wrong(
                        &format!("mesh[{i}]{place}.alpha"),
                        alpha.to_string(),
                        "a number in [0, 1]",
                    );
                }
                if let Some(color) = material
                    .color
                    .filter(|c| c.iter().any(|x| !(0.0..f32::INFINITY).contains(x)))
                {
                    return wrong(
                        &format!("mesh[{i}]{place}.color"),
                        format!("{color:?}"),
                        "three numbers of 0 or more",
                    );
                }
            }
            self.validate_place(&format!("mesh[{i}]"), mesh.scale, mesh.rotate, mesh.translate)?;
        }
        for (i, splats) in self.splats.iter().enumerate() {
            self.validate_place(&format!("splats[{i}]"), splats.scale, splats.rotate, splats.translate)?;
        }
        Ok(())
    }

    fn validate_place(
        &self,
        entry: &str,
        scale: Option<f64>,
        rotate: Option<Vec3>,
        translate: Option<Vec3>,
    ) -> Result<(), SceneError> {
        let wrong = |field: &str, found: String, expected: &str| {
            Err(SceneError::field(
                &self.path,
                &format!("{entry}.{field}"),
                found,
                expected,
            ))
        };
        if let Some(scale) = scale.filter(|s| !(*s > 0.0 && *s <= 1e12)) {
            return wrong("scale", scale.to_string(), "a number greater than 0, 1e12 at most");
        }
        for (field, v) in [("rotate", rotate), ("translate", translate)] {
            if let Some(v) = v.filter(|v| !v.iter().all(|x| x.abs() <= 1e12)) {
                return wrong(field, format!("{v:?}"), "three finite numbers of size 1e12 at most");
            }
        }
        Ok(())
    }

    /// The camera: the file's, a built-in scene's own, or one that is placed for what the files hold. What of them is
    /// left out is told by [`Self::geometry`] and by every list that is built.
    ///
    /// # Errors
    /// [`SceneError`] for files that cannot be read, where the camera is placed for them.
    pub fn camera(&self) -> Result<Camera, SceneError> {
        match (&self.camera, &self.built_in) {
            (Some(camera), _) => Ok(*camera),
            (None, Some(name)) => Ok(procedural::camera(name)),
            (None, None) => self.camera_for(&self.content(&mut Vec::new())?),
        }
    }

    /// The same scene seen by another camera.
    pub fn seen_by(&self, camera: Camera) -> Self {
        Self {
            camera: Some(camera),
            ..self.clone()
        }
    }

    /// What there is to see, surfaces and particles for a renderer of one's own, and what of the files is left out.
    ///
    /// # Errors
    /// [`SceneError`] for a mesh that cannot be read.
    pub fn geometry(&self) -> Result<(Geometry, Vec<LeftOut>), SceneError> {
        let mut left_out = Vec::new();
        let geometry = match &self.built_in {
            Some(name) => procedural::geometry(name, self.seed.unwrap_or(1), self.camera()?.position),
            None => self.content(&mut left_out)?,
        };
        Ok((geometry, left_out))
    }

    /// The file that this was read from.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The light, or that of a built-in scene.
    pub(super) fn light_camera(&self) -> Result<Camera, SceneError> {
        match (self.light, &self.built_in) {
            (Some(light), _) => Ok(light),
            (None, Some(name)) => Ok(procedural::light(name)),
            (None, None) => Err(SceneError::field(
                &self.path,
                "light",
                "it is missing".to_owned(),
                "a [light] with the fields of a camera",
            )),
        }
    }

    /// The fragments that the camera sees, and the camera; objects are drawn in their own order or in a random one.
    ///
    /// # Errors
    /// [`SceneError`] for a file that cannot be read or a picture that would take too much memory.
    pub(super) fn build(
        &self,
        options: &Options,
        draw_order: Option<u64>,
    ) -> Result<(FragmentList, Camera), SceneError> {
        let seen = self.seen(options)?;
        let geometry = match draw_order {
            Some(seed) => seen.geometry.in_random_order(seed),
            None => seen.geometry,
        };
        Ok((
            rasterise(&geometry, &seen.view)?.with_left_out(seen.left_out),
            seen.camera,
        ))
    }

    /// The geometry, and the camera's view of it.
    pub(super) fn seen(&self, options: &Options) -> Result<Seen, SceneError> {
        self.validate()?;
        let mut left_out = Vec::new();
        let content = match &self.built_in {
            Some(_) => None,
            None => Some(self.content(&mut left_out)?),
        };
        let mut camera = match (self.camera, &self.built_in, &content) {
            (Some(camera), ..) => camera,
            (None, Some(name), _) => procedural::camera(name),
            (None, None, content) => self.camera_for(content.as_ref().unwrap_or(&Geometry::default()))?,
        };
        if let Some((width, height)) = options.size {
            (camera.width, camera.height) = (width, height);
        }
        let view = camera.view(&self.path)?;
        let geometry = match (content, &self.built_in) {
            (None, Some(name)) => procedural::geometry(name, options.seed.or(self.seed).unwrap_or(1), view.eye),
            (content, _) => content.unwrap_or_default(),
        };
        Ok(Seen {
            geometry,
            camera,
            view,
            left_out,
        })
    }

    /// A camera that sees all there is but the outermost of it, from the front and above, a little to the side.
    ///
    /// In files of splats y points down and z away from the viewer, but for .spz, where as in meshes y points up and z
    /// towards the viewer.
    fn camera_for(&self, geometry: &Geometry) -> Result<Camera, SceneError> {
        let corners = geometry.triangles.iter().flatten().map(|v| v.position);
        let textured = geometry.textured.iter().flat_map(|t| t.corners.map(|v| v.position));
        let points: Vec<[f32; 3]> = corners
            .chain(textured)
            .chain(geometry.splats.iter().map(|s| s.position))
            .collect();
        if points.is_empty() {
            let found = "there is nothing to be seen".to_owned();
            return Err(SceneError::field(
                &self.path,
                "camera",
                found,
                "a [camera], or content that one can be placed for",
            ));
        }
        let ranges: Vec<(f64, f64)> = (0..3)
            .map(|k| {
                let mut along: Vec<f32> = points.iter().map(|p| p[k]).collect();
                along.sort_unstable_by(f32::total_cmp);
                // Captures have a few splats far out; meshes lose nothing by this that a margin does not give back.
                let off = along.len() / 100;
                (f64::from(along[off]), f64::from(along[along.len() - 1 - off]))
            })
            .collect();
        let center: Vec3 = std::array::from_fn(|k| (ranges[k].0 + ranges[k].1) / 2.0);
        let half: f64 = ranges.iter().map(|(lo, hi)| (hi - lo) * (hi - lo)).sum::<f64>().sqrt() / 2.0;
        let half = if half > 0.0 { half } else { 1.0 };
        let farthest = points.iter().map(|p| {
            let d = sub(p.map(f64::from), center);
            dot(d, d).sqrt()
        });
        let farthest = farthest.fold(half, f64::max);
        const VERTICAL_FOV: f64 = 38.0;
        let distance = 1.15 * half / libm::sin(VERTICAL_FOV.to_radians() / 2.0);
        let downwards = self.meshes.is_empty()
            && self
                .splats
                .iter()
                .all(|s| s.file.extension().is_none_or(|e| !e.eq_ignore_ascii_case("spz")));
        let sign = if downwards { -1.0 } else { 1.0 };
        let from = unit([0.35, 0.3 * sign, sign]);
        Ok(Camera {
            position: std::array::from_fn(|k| center[k] + distance * from[k]),
            look_at: center,
            up: [0.0, sign, 0.0],
            vertical_fov: VERTICAL_FOV,
            width: 512,
            height: 512,
            near: (distance - 1.1 * farthest).max(0.02 * distance) as f32,
            far: (distance + 1.1 * farthest) as f32,
        })
    }

    /// All meshes and splats, in their places.
    fn content(&self, left_out: &mut Vec<LeftOut>) -> Result<Geometry, SceneError> {
        let folder = self.path.parent().unwrap_or(Path::new("."));
        let mut geometry = Geometry::default();
        for (i, entry) in self.meshes.iter().enumerate() {
            self.mesh(
                &format!("mesh[{i}]"),
                &folder.join(&entry.file),
                entry,
                &mut geometry,
                left_out,
            )?;
        }
        for (i, entry) in self.splats.iter().enumerate() {
            let file = folder.join(&entry.file);
            let found = splat_file::read(&file)?;
            left_out.extend(found.left_out);
            let matrix = affine(entry.scale, entry.rotate, entry.translate);
            if matrix == IDENTITY && geometry.splats.is_empty() {
                geometry.splats = found.splats;
            } else {
                let turn = quaternion(entry.rotate);
                let size = entry.scale.unwrap_or(1.0);
                geometry
                    .splats
                    .extend(found.splats.into_iter().map(|s| placed(s, &matrix, turn, size)));
            }
            if let Some(s) = geometry
                .splats
                .iter()
                .find(|s| !s.position.iter().all(|x| f64::from(x.abs()) <= mesh::MAX_COORDINATE))
            {
                let found = format!("the transforms take a splat of {} to {:?}", file.display(), s.position);
                let expected = format!("coordinates of size {:e} at most", mesh::MAX_COORDINATE);
                return Err(SceneError::field(&self.path, &format!("splats[{i}]"), found, &expected));
            }
            geometry.end_object();
        }
        Ok(geometry)
    }

    /// Adds one mesh to the scene.
    fn mesh(
        &self,
        place: &str,
        file: &Path,
        entry: &MeshEntry,
        geometry: &mut Geometry,
        left_out: &mut Vec<LeftOut>,
    ) -> Result<(), SceneError> {
        let parts = mesh::load(file, entry, left_out)?;
        let unknown = entry
            .materials
            .keys()
            .find(|name| !parts.iter().any(|p| p.material.as_ref() == Some(name)));
        if let Some(name) = unknown {
            let mut known: Vec<&str> = parts.iter().filter_map(|p| p.material.as_deref()).collect();
            known.sort_unstable();
            known.dedup();
            let known = if known.is_empty() {
                "it has none".to_owned()
            } else {
                known.join(", ")
            };
            let expected = format!("a material of {} ({known})", file.display());
            let field = format!("{place}.materials.{name}");
            return Err(SceneError::field(
                &self.path,
                &field,
                "no such material".to_owned(),
                &expected,
            ));
        }
        let matrix = affine(entry.scale, entry.rotate, entry.translate);
        for part in parts {
            let triangles = geometry.triangles.len() + geometry.textured.len() + part.corners.len() / 3;
            if triangles > mesh::MAX_TRIANGLES {
                let expected = format!("{} triangles in the whole scene at most", mesh::MAX_TRIANGLES);
                return Err(SceneError::field(
                    &self.path,
                    place,
                    "too many triangles".to_owned(),
                    &expected,
                ));
            }
            let far_off = |p: &&[f32; 3]| {
                !apply(&matrix, p.map(f64::from))
                    .iter()
                    .all(|x| x.abs() <= mesh::MAX_COORDINATE)
            };
            if let Some(p) = part.corners.iter().find(far_off) {
                let found = format!("the transforms take the point {p:?} of {} too far away", file.display());
                let expected = format!("coordinates of size {:e} at most", mesh::MAX_COORDINATE);
                return Err(SceneError::field(&self.path, place, found, &expected));
            }
            place_part(part, &matrix, entry, geometry);
        }
        Ok(())
    }
}

/// Puts a part's triangles in their places, with the colours and opacities that the scene file gives.
fn place_part(part: Part, matrix: &Affine, entry: &MeshEntry, geometry: &mut Geometry) {
    let name = part.material.as_deref();
    let (alpha, color) = (entry.alpha_of(name), entry.color_of(name));
    let [r, g, b, own_alpha] = part.rgba;
    let base = color.unwrap_or([r, g, b]);
    let mut textures = part.textures;
    if let Some(t) = &mut textures {
        t.color_counts &= color.is_none();
        // A cutoff decides where there is a surface; what is given is how opaque the surface is.
        match (alpha, t.cutoff) {
            (Some(alpha), Some((cutoff, _))) => t.cutoff = Some((cutoff, alpha)),
            (Some(_), None) => {
                t.alpha_counts = false;
                t.opacity = None;
            }
            (None, _) => {}
        }
    }
    let cut = textures.as_ref().is_some_and(|t| t.cutoff.is_some());
    let base_alpha = if cut { own_alpha } else { alpha.unwrap_or(own_alpha) };
    // A material that is not there at all leaves no fragment.
    if base_alpha <= 0.0 || alpha == Some(0.0) {
        return;
    }
    let material = textures.map(|t| {
        geometry.materials.push(t);
        geometry.materials.len() as u32 - 1
    });
    for (t, c) in part.corners.chunks_exact(3).enumerate() {
        let p = [c[0], c[1], c[2]].map(|p| apply(matrix, p.map(f64::from)));
        let normal = unit(cross(sub(p[1], p[0]), sub(p[2], p[0])));
        let triangle: Triangle = std::array::from_fn(|k| {
            let own = part.vertex_rgba.get(3 * t + k).copied().unwrap_or([1.0; 4]);
            let tint = if color.is_some() {
                [1.0; 3]
            } else {
                [own[0], own[1], own[2]]
            };
            let [r, g, b] = lit(std::array::from_fn(|k| base[k] * tint[k]), normal);
            let own_alpha = if alpha.is_some() && !cut { 1.0 } else { own[3] };
            Vertex {
                position: p[k].map(|x| x as f32),
                rgba: [r, g, b, base_alpha * own_alpha],
            }
        });
        match material {
            None if triangle.iter().all(|v| v.rgba[3] <= 0.0) => {}
            None => geometry.triangles.push(triangle),
            Some(material) => geometry.textured.push(TexturedTriangle {
                corners: triangle,
                uv: std::array::from_fn(|k| part.uv.get(3 * t + k).copied().unwrap_or([0.0; 2])),
                material,
            }),
        }
    }
}

/// A splat in its place.
fn placed(splat: Splat, matrix: &Affine, turn: [f64; 4], size: f64) -> Splat {
    Splat {
        position: apply(matrix, splat.position.map(f64::from)).map(|x| x as f32),
        scale: splat.scale.map(|s| (f64::from(s) * size) as f32),
        rotation: product(turn, splat.rotation.map(f64::from)).map(|x| x as f32),
        rgba: splat.rgba,
    }
}

/// The quaternion a b of two quaternions w, x, y, z: first b, then a.
fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// The quaternion of turns about x, y and z, in this order \[degrees\].
fn quaternion(rotate: Option<Vec3>) -> [f64; 4] {
    let mut all = [1.0, 0.0, 0.0, 0.0];
    for (axis, degrees) in rotate.unwrap_or([0.0; 3]).into_iter().enumerate() {
        let half = degrees.to_radians() / 2.0;
        let mut turn = [libm::cos(half), 0.0, 0.0, 0.0];
        turn[axis + 1] = libm::sin(half);
        all = product(turn, all);
    }
    all
}

/// Colour of a matt surface under a lamp above and to the left of the usual viewer; both sides of a surface are lit
/// alike.
pub(super) fn lit(color: [f32; 3], normal: Vec3) -> [f32; 3] {
    /// Share of the light that comes from everywhere.
    const AMBIENT: f64 = 0.35;
    let lamp = unit([-0.45, 0.75, 0.5]);
    let fill = unit([0.8, 0.1, 0.6]);
    let light = AMBIENT + 0.55 * dot(normal, lamp).abs() + 0.1 * dot(normal, fill).abs();
    color.map(|c| (c * light as f32).max(0.0))
}

impl MeshEntry {
    /// Opacity that the scene file gives a material.
    fn alpha_of(&self, material: Option<&str>) -> Option<f32> {
        let own = material.and_then(|m| self.materials.get(m));
        own.and_then(|l| l.alpha).or(self.alpha)
    }

    /// Colour that the scene file gives a material.
    fn color_of(&self, material: Option<&str>) -> Option<[f32; 3]> {
        let own = material.and_then(|m| self.materials.get(m));
        own.and_then(|l| l.color).or(self.color)
    }
}

/// Scaled, then turned about x, y and z, then moved.
fn affine(scale: Option<f64>, rotate: Option<Vec3>, translate: Option<Vec3>) -> Affine {
    let s = scale.unwrap_or(1.0);
    let mut matrix = IDENTITY.map(|row| row.map(|x| x * s));
    for (axis, degrees) in rotate.unwrap_or([0.0; 3]).into_iter().enumerate() {
        let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut turn = IDENTITY;
        (turn[u][u], turn[u][v], turn[v][u], turn[v][v]) = (cos, -sin, sin, cos);
        matrix = compose(&turn, &matrix);
    }
    for (row, t) in matrix.iter_mut().zip(translate.unwrap_or([0.0; 3])) {
        row[3] += t;
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quaternion and matrix turn a vector alike, in the same order of axes.
    #[test]
    fn splats_turn_as_meshes_do() {
        let rotate = Some([30.0, -50.0, 110.0]);
        let (matrix, [w, x, y, z]) = (affine(None, rotate, None), quaternion(rotate));
        let v = [0.3, -1.2, 0.7];
        let turned = product(product([w, x, y, z], [0.0, v[0], v[1], v[2]]), [w, -x, -y, -z]);
        for (a, b) in apply(&matrix, v).iter().zip(&turned[1..]) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        let other = affine(None, Some([110.0, -50.0, 30.0]), None);
        assert!(
            apply(&other, v)
                .iter()
                .zip(&turned[1..])
                .any(|(a, b)| (a - b).abs() > 0.1)
        );
    }
}
