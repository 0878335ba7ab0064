//! Scene files: what is to be seen, and from where, in TOML.

use super::camera::{Camera, Vec3, View, cross, dot, sub, unit};
use super::mesh::{self, Affine, IDENTITY, apply, compose};
use super::raster::{Geometry, Vertex, rasterise};
use super::{BUILT_IN, Options, SceneError, procedural};
use crate::numeric::file::read;
use crate::pixel::FragmentList;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A scene: one of the built-in ones or meshes, and the camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Name of a built-in scene, see [`BUILT_IN`]; none where there are meshes.
    pub built_in: Option<String>,
    /// Seed of a built-in scene; 1 where none is given.
    pub seed: Option<u64>,
    /// The camera; a built-in scene has one of its own where none is given.
    pub camera: Option<Camera>,
    /// A spot light, described as the camera that sees what it shines on; a built-in scene has one of its own where
    /// none is given.
    pub light: Option<Camera>,
    /// Meshes; none where a built-in scene is named.
    #[serde(default, rename = "mesh")]
    pub meshes: Vec<MeshEntry>,
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

/// Opacity and colour that take the place of a material's own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MaterialOverride {
    /// Opacity, in [0, 1].
    pub alpha: Option<f32>,
    /// Linear colour, each channel in [0, 1].
    pub color: Option<[f32; 3]>,
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] names the file, the line or the field, and what is expected there.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let bytes = read(path)?;
        let text = std::str::from_utf8(&bytes)
            .map_err(|e| SceneError::file_content(path, &format!("byte {}", e.valid_up_to()), "not a text file"))?;
        Self::parse(path, text)
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
            path: name.into(),
        })
    }

    fn validate(&self) -> Result<(), SceneError> {
        let wrong =
            |field: &str, found: String, expected: &str| Err(SceneError::field(&self.path, field, found, expected));
        match (&self.built_in, self.meshes.is_empty()) {
            (None, true) => return wrong("built_in, mesh", "neither is there".to_owned(), "one of them"),
            (Some(_), false) => return wrong("built_in, mesh", "both are there".to_owned(), "one of them"),
            (Some(name), true) if !BUILT_IN.contains(&name.as_str()) => {
                return wrong(
                    "built_in",
                    format!("'{name}'"),
                    &format!("one of {}", BUILT_IN.join(", ")),
                );
            }
            (None, false) if self.camera.is_none() => {
                return wrong("camera", "it is missing".to_owned(), "a [camera] for the meshes");
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
                if let Some(color) = material.color.filter(|c| c.iter().any(|x| !(0.0..=1.0).contains(x))) {
                    return wrong(
                        &format!("mesh[{i}]{place}.color"),
                        format!("{color:?}"),
                        "three numbers in [0, 1]",
                    );
                }
            }
            if let Some(scale) = mesh.scale.filter(|s| !(*s > 0.0 && *s <= 1e12)) {
                return wrong(
                    &format!("mesh[{i}].scale"),
                    scale.to_string(),
                    "a number greater than 0, 1e12 at most",
                );
            }
            for (field, v) in [("rotate", mesh.rotate), ("translate", mesh.translate)] {
                if let Some(v) = v.filter(|v| !v.iter().all(|x| x.abs() <= 1e12)) {
                    return wrong(
                        &format!("mesh[{i}].{field}"),
                        format!("{v:?}"),
                        "three finite numbers of size 1e12 at most",
                    );
                }
            }
        }
        Ok(())
    }

    /// The camera: the file's, or a built-in scene's own.
    ///
    /// # Errors
    /// [`SceneError::Field`] where there are meshes and no camera.
    pub fn camera(&self) -> Result<Camera, SceneError> {
        match (&self.camera, &self.built_in) {
            (Some(camera), _) => Ok(*camera),
            (None, Some(name)) => Ok(procedural::camera(name)),
            (None, None) => Err(SceneError::field(
                &self.path,
                "camera",
                "it is missing".to_owned(),
                "a [camera] for the meshes",
            )),
        }
    }

    /// The same scene seen by another camera.
    pub fn seen_by(&self, camera: Camera) -> Self {
        Self {
            camera: Some(camera),
            ..self.clone()
        }
    }

    /// What there is to see: surfaces and particles, for a renderer of one's own.
    ///
    /// # Errors
    /// [`SceneError`] for a mesh that cannot be read.
    pub fn geometry(&self) -> Result<Geometry, SceneError> {
        match &self.built_in {
            Some(name) => Ok(procedural::geometry(
                name,
                self.seed.unwrap_or(1),
                self.camera()?.position,
            )),
            None => self.mesh_geometry(),
        }
    }

    /// The fragments that the camera sees.
    ///
    /// # Errors
    /// [`SceneError`] for a mesh that cannot be read or a picture that would take too much memory.
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

    /// The fragments, objects drawn in their own order or in a random one.
    pub(super) fn build(&self, options: &Options, draw_order: Option<u64>) -> Result<FragmentList, SceneError> {
        let (geometry, view) = self.seen(options)?;
        let geometry = match draw_order {
            Some(seed) => geometry.in_random_order(seed),
            None => geometry,
        };
        rasterise(&geometry, &view)
    }

    /// The geometry and the camera's view of it.
    pub(super) fn seen(&self, options: &Options) -> Result<(Geometry, View), SceneError> {
        self.validate()?;
        let mut camera = self.camera()?;
        if let Some((width, height)) = options.size {
            (camera.width, camera.height) = (width, height);
        }
        let view = camera.view(&self.path)?;
        let geometry = match &self.built_in {
            Some(name) => procedural::geometry(name, options.seed.or(self.seed).unwrap_or(1), view.eye),
            None => self.mesh_geometry()?,
        };
        Ok((geometry, view))
    }

    fn mesh_geometry(&self) -> Result<Geometry, SceneError> {
        let folder = self.path.parent().unwrap_or(Path::new("."));
        let mut geometry = Geometry::default();
        for (i, entry) in self.meshes.iter().enumerate() {
            let file = folder.join(&entry.file);
            let parts = mesh::load(&file, entry.alpha.is_none() || entry.color.is_none())?;
            let unknown = entry
                .materials
                .keys()
                .find(|name| !parts.iter().any(|p| p.material.as_ref() == Some(name)));
            if let Some(name) = unknown {
                let mut known: Vec<&str> = parts.iter().filter_map(|p| p.material.as_deref()).collect();
                known.sort_unstable();
                known.dedup();
                let expected = format!(
                    "a material of {} ({})",
                    file.display(),
                    if known.is_empty() {
                        "it has none".to_owned()
                    } else {
                        known.join(", ")
                    }
                );
                return Err(SceneError::field(
                    &self.path,
                    &format!("mesh[{i}].materials.{name}"),
                    "no such material".to_owned(),
                    &expected,
                ));
            }
            let matrix = entry.matrix();
            for part in parts {
                let own = part.material.as_ref().and_then(|m| entry.materials.get(m));
                let [r, g, b, a] = part.rgba;
                let color = own.and_then(|l| l.color).or(entry.color).unwrap_or([r, g, b]);
                let alpha = own.and_then(|l| l.alpha).or(entry.alpha).unwrap_or(a);
                if geometry.triangles.len() + part.corners.len() / 3 > mesh::MAX_TRIANGLES {
                    let expected = format!("{} triangles in the whole scene at most", mesh::MAX_TRIANGLES);
                    return Err(SceneError::field(
                        &self.path,
                        &format!("mesh[{i}]"),
                        "too many triangles".to_owned(),
                        &expected,
                    ));
                }
                let far_off = |p: &&[f32; 3]| !apply(&matrix, p.map(f64::from)).iter().all(|x| x.abs() <= 1e18);
                if let Some(p) = part.corners.iter().find(far_off) {
                    let found = format!("the transforms take the point {p:?} of {} too far away", file.display());
                    return Err(SceneError::field(
                        &self.path,
                        &format!("mesh[{i}]"),
                        found,
                        "coordinates of size 1e18 at most",
                    ));
                }
                // A material that is not there at all leaves no fragment.
                if alpha > 0.0 {
                    geometry.triangles.extend(part.corners.chunks_exact(3).map(|c| {
                        let p = [c[0], c[1], c[2]].map(|p| apply(&matrix, p.map(f64::from)));
                        let normal = unit(cross(sub(p[1], p[0]), sub(p[2], p[0])));
                        let [r, g, b] = lit(color, normal);
                        p.map(|p| Vertex {
                            position: p.map(|x| x as f32),
                            rgba: [r, g, b, alpha],
                        })
                    }));
                }
            }
            geometry.end_object();
        }
        Ok(geometry)
    }
}

/// Colour of a matt surface under a lamp above and to the left of the usual viewer; both sides of a surface are lit
/// alike.
pub(super) fn lit(color: [f32; 3], normal: Vec3) -> [f32; 3] {
    /// Share of the light that comes from everywhere.
    const AMBIENT: f64 = 0.35;
    let lamp = unit([-0.45, 0.75, 0.5]);
    let fill = unit([0.8, 0.1, 0.6]);
    let light = AMBIENT + 0.55 * dot(normal, lamp).abs() + 0.1 * dot(normal, fill).abs();
    color.map(|c| (c * light as f32).clamp(0.0, 1.0))
}

impl MeshEntry {
    fn matrix(&self) -> Affine {
        let s = self.scale.unwrap_or(1.0);
        let mut matrix = IDENTITY.map(|row| row.map(|x| x * s));
        for (axis, degrees) in self.rotate.unwrap_or([0.0; 3]).into_iter().enumerate() {
            let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut turn = IDENTITY;
            (turn[u][u], turn[u][v], turn[v][u], turn[v][v]) = (cos, -sin, sin, cos);
            matrix = compose(&turn, &matrix);
        }
        let t = self.translate.unwrap_or([0.0; 3]);
        for (row, t) in matrix.iter_mut().zip(t) {
            row[3] += t;
        }
        matrix
    }
}
