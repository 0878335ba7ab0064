//! Fragment lists from scenes: meshes, Gaussian splats and built-in scenes seen through a camera, and files of other
//! renderers.
//!
//! What a file holds is read, refused with an error, or named in [`FragmentList::left_out`].

pub mod camera;
pub mod exr;
pub mod file;
mod mesh;
pub mod npz;
pub mod path;
mod procedural;
mod raster;
pub mod shadow;
pub mod splat;
mod texture;

pub use camera::Camera;
pub use file::{MaterialOverride, MeshEntry, SceneFile, SplatEntry};
pub use path::CameraPath;
pub use raster::{Geometry, Particle, Triangle, Vertex};

use crate::numeric::file::{FileError, Replace};
use crate::numeric::npy::NpyError;
use crate::numeric::similar::suggestion;
use crate::pixel::{FragmentError, FragmentList};
use std::path::{Path, PathBuf};

/// The scenes that need no files.
pub const BUILT_IN: [&str; 9] = [
    "glass-stacks",
    "smoke",
    "hair",
    "foliage",
    "spheres",
    "sphere-cluster",
    "teapots",
    "splats",
    "curtains",
];

/// Most fragments of a rendered scene; with colour they take 20 bytes each, so 20 GiB.
pub const MAX_FRAGMENTS: u64 = 1 << 30;

/// What a caller may change about a scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Options {
    /// Columns and rows in place of the camera's \[pixels\].
    pub size: Option<(u32, u32)>,
    /// Seed of a built-in scene in place of the scene file's.
    pub seed: Option<u64>,
}

/// Why there is no fragment list.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file or one of its arrays is unreadable.
    #[error(transparent)]
    Array(#[from] NpyError),
    /// The file is unreadable or cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The arrays do not make a valid list.
    #[error("{}: {source}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: FragmentError,
    },
    /// A mesh or image file is damaged or uses what is not supported.
    #[error("{}: {place}: {reason}", path.display())]
    FileContent {
        /// The file.
        path: PathBuf,
        /// The place in it.
        place: String,
        /// What is wrong, and what to do.
        reason: String,
    },
    /// A scene file is no TOML, or has fields that are not known.
    #[error("{}: {message}", path.display())]
    Toml {
        /// The file.
        path: PathBuf,
        /// What is wrong, with its line.
        message: String,
    },
    /// A field of a scene file makes no picture.
    #[error("{}: {field}: {found}; expected {expected}", path.display())]
    Field {
        /// The scene file, or the name of the built-in scene.
        path: PathBuf,
        /// The field.
        field: String,
        /// What it holds.
        found: String,
        /// What it should hold.
        expected: String,
    },
    /// There is no built-in scene of this name.
    #[error("there is no built-in scene '{name}'; choose one of {}, or pass a scene file that ends in .toml{}",
        BUILT_IN.join(", "), suggestion(name, BUILT_IN))]
    UnknownBuiltIn {
        /// The name.
        name: String,
    },
    /// The machine has no memory for the picture.
    #[error(
        "the scene has {fragments} fragments, 20 bytes each, and the machine has no memory for them, so lower the \
            width and height or use fewer layers"
    )]
    OutOfMemory {
        /// Number of fragments.
        fragments: u64,
    },
    /// The picture would take too much memory.
    #[error(
        "the scene has {fragments} fragments in {pixels} pixels; at most {MAX_FRAGMENTS} are supported, so lower the \
            width and height or use fewer layers"
    )]
    TooManyFragments {
        /// Number of fragments.
        fragments: u64,
        /// Number of pixels.
        pixels: u64,
    },
    /// The file's name tells no format.
    #[error("{}: a fragment list ends in .npz or .exr", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
}

impl SceneError {
    fn field(path: &Path, field: &str, found: String, expected: &str) -> Self {
        Self::Field {
            path: path.to_owned(),
            field: field.to_owned(),
            found,
            expected: expected.to_owned(),
        }
    }

    fn file_content(path: &Path, place: &str, reason: impl Into<String>) -> Self {
        Self::FileContent {
            path: path.to_owned(),
            place: place.to_owned(),
            reason: reason.into(),
        }
    }
}

/// A scene by its name: a built-in one, or else the path of a scene file, of a mesh or of a file of splats.
///
/// # Errors
/// [`SceneError`] names what is wrong, and where; for a name that is neither, the built-in scenes.
pub fn open(name: &str) -> Result<SceneFile, SceneError> {
    if BUILT_IN.contains(&name) {
        return SceneFile::built_in(name);
    }
    let path = Path::new(name);
    if path.extension().is_none() && !path.exists() {
        return Err(SceneError::UnknownBuiltIn { name: name.to_owned() });
    }
    match SceneFile::of_file(path) {
        Some(scene) => Ok(scene),
        None => SceneFile::read(path),
    }
}

/// The fragments of a scene, with colours, image size and camera planes.
///
/// The result depends on the scene and the options alone, not on the number of threads.
/// An opaque fragment (alpha 1) is kept as a fragment, and what lies strictly behind the nearest opaque one of its
/// pixel is left out.
///
/// # Errors
/// [`SceneError`] for a mesh that cannot be read, and for a picture that would take too much memory.
pub fn build(scene: &SceneFile, options: &Options) -> Result<FragmentList, SceneError> {
    Ok(scene.build(options, None)?.0)
}

/// As [`build`], with the camera that saw them, which is placed for the content where the scene file gives none.
///
/// # Errors
/// As [`build`].
pub fn build_with_camera(scene: &SceneFile, options: &Options) -> Result<(FragmentList, Camera), SceneError> {
    scene.build(options, None)
}

/// The same fragments as [`build`] makes, the objects drawn in a random order: within a pixel fragments stand in the
/// order in which a renderer that does not sort would shade them. Objects are the meshes of a scene file, and the
/// panes, locks, leaves, pots, spheres, particles and splats of built-in scenes.
///
/// # Errors
/// As [`build`].
pub fn build_in_random_order(scene: &SceneFile, options: &Options, seed: u64) -> Result<FragmentList, SceneError> {
    Ok(scene.build(options, Some(seed))?.0)
}

/// A kind of file that holds fragments.
pub struct ListFormat {
    /// What its name ends in, after the dot.
    ending: &'static str,
    /// Reads a file, of those that have parts the part of this name or number.
    read: fn(&Path, Option<&str>) -> Result<FragmentList, SceneError>,
    /// Writes a file.
    write: fn(&Path, Replace, &FragmentList) -> Result<(), SceneError>,
}

/// Every kind of file that holds fragments.
const LIST_FORMATS: [ListFormat; 2] = [npz::FORMAT, exr::FORMAT];

impl ListFormat {
    /// The format of a file, by the ending of its name.
    ///
    /// # Errors
    /// [`SceneError::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Self, SceneError> {
        let ending = path.extension().unwrap_or_default();
        let format = LIST_FORMATS.into_iter().find(|f| ending.eq_ignore_ascii_case(f.ending));
        format.ok_or_else(|| SceneError::UnknownFormat { path: path.to_owned() })
    }

    /// Writes a fragment list.
    ///
    /// # Errors
    /// [`SceneError`] names the file.
    pub fn write(&self, path: &Path, replace: Replace, list: &FragmentList) -> Result<(), SceneError> {
        (self.write)(path, replace, list)
    }
}

/// A fragment list from a file, by the ending of its name: `.npz`, or `.exr` for a deep image, of which the first deep
/// part is read.
///
/// # Errors
/// [`SceneError`] names the file, the place in it and what is expected there.
pub fn read(path: &Path) -> Result<FragmentList, SceneError> {
    read_part(path, None)
}

/// As [`read`], with the name or number of a deep image's part.
///
/// # Errors
/// As [`read`]; an archive has no parts.
pub fn read_part(path: &Path, part: Option<&str>) -> Result<FragmentList, SceneError> {
    (ListFormat::of(path)?.read)(path, part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small(name: &str, size: u32, seed: u64) -> FragmentList {
        build(
            &open(name).unwrap(),
            &Options {
                size: Some((size, size)),
                seed: Some(seed),
            },
        )
        .unwrap()
    }

    #[test]
    fn built_in_scenes_have_the_depth_they_promise() {
        for (name, least) in [
            ("glass-stacks", 20),
            ("smoke", 101),
            ("hair", 151),
            ("foliage", 10),
            ("spheres", 6),
            ("sphere-cluster", 16),
            ("teapots", 6),
            ("splats", 101),
            ("curtains", 20),
        ] {
            let list = small(name, 128, 1);
            assert!(list.depth_complexity() >= least, "{name}: {}", list.depth_complexity());
            let covered = (0..list.pixels()).filter(|&p| !list.range(p).is_empty()).count();
            assert!(
                covered * 10 > list.pixels(),
                "{name} covers {covered} of {} pixels",
                list.pixels()
            );
        }
    }

    /// A random draw order moves fragments within their pixels and changes none; objects stay whole. Control: it does
    /// move some.
    #[test]
    fn draw_orders_move_whole_objects() {
        let options = Options {
            size: Some((48, 48)),
            seed: Some(3),
        };
        for name in ["glass-stacks", "foliage", "smoke", "curtains"] {
            let scene = open(name).unwrap();
            let (listed, drawn) = (
                build(&scene, &options).unwrap(),
                build_in_random_order(&scene, &options, 1).unwrap(),
            );
            let sorted = |list: &FragmentList, p: usize| {
                let pixel = list.pixel(p);
                let mut all: Vec<_> = (0..pixel.len())
                    .map(|i| {
                        (
                            pixel.view_z[i].to_bits(),
                            pixel.alpha[i].to_bits(),
                            pixel.color.unwrap()[i].map(f32::to_bits),
                        )
                    })
                    .collect();
                all.sort_unstable();
                all
            };
            assert_eq!(listed.offsets(), drawn.offsets(), "{name}");
            assert!(
                (0..listed.pixels()).all(|p| sorted(&listed, p) == sorted(&drawn, p)),
                "{name}"
            );
            assert_ne!(listed, drawn, "{name}");
            assert_eq!(drawn, build_in_random_order(&scene, &options, 1).unwrap());
        }
    }

    #[test]
    fn threads_change_nothing_and_seeds_do() {
        for name in BUILT_IN {
            let one = rayon::ThreadPoolBuilder::new()
                .num_threads(1)
                .build()
                .unwrap()
                .install(|| small(name, 48, 3));
            let three = rayon::ThreadPoolBuilder::new()
                .num_threads(3)
                .build()
                .unwrap()
                .install(|| small(name, 48, 3));
            assert_eq!(one, three, "{name}");
        }
        assert_ne!(small("smoke", 48, 3), small("smoke", 48, 4));
    }

    #[test]
    fn example_scenes_build() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/scenes");
        for name in ["house.toml", "smoke.toml"] {
            let list = build(
                &SceneFile::read(&folder.join(name)).unwrap(),
                &Options {
                    size: Some((64, 64)),
                    seed: None,
                },
            )
            .unwrap();
            assert!(list.depth_complexity() >= 2, "{name}");
        }
    }

    #[test]
    fn bad_scene_files_name_the_field() {
        let camera = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvertical_fov = 40\nwidth = 8\nheight = \
            8\nnear = 0.1\nfar = 50\n";
        let error = |text: String| {
            SceneFile::parse(Path::new("a.toml"), &text)
                .map(|_| ())
                .unwrap_err()
                .to_string()
        };
        let cases = [
            (error(String::new()), "built_in, mesh, splats: none"),
            (error("built_in = \"moon\"".to_owned()), "one of glass-stacks"),
            (error("surprise = 1".to_owned()), "surprise"),
            (
                error(format!(
                    "built_in = \"smoke\"\n{}",
                    camera.replace("width = 8", "width = 4000000")
                )),
                "camera.width: 4000000",
            ),
            (
                error(format!(
                    "built_in = \"smoke\"\n{}",
                    camera.replace("near = 0.1", "near = nan")
                )),
                "camera.near, far",
            ),
            (
                error(format!(
                    "built_in = \"smoke\"\n{}",
                    camera.replace("look_at = [0, 0, 0]", "look_at = [0, 0, 5]")
                )),
                "camera.look_at",
            ),
            (
                error(format!("{camera}[[mesh]]\nfile = \"a.obj\"\nalpha = 1.5")),
                "mesh[0].alpha: 1.5",
            ),
            (
                error("[[splats]]\nfile = \"a.ply\"\nscale = 0".to_owned()),
                "splats[0].scale: 0",
            ),
        ];
        for (message, part) in cases {
            assert!(
                message.contains(part) && message.contains("a.toml"),
                "{message} / {part}"
            );
        }
    }

    #[test]
    fn bad_meshes_name_the_file_and_the_place() {
        let folder = tempfile::tempdir().unwrap();
        let gltf = |nodes: &str, buffers: &str| {
            format!(r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":{nodes}{buffers}}}"#)
        };
        let cases = [
            (
                "a.obj",
                "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n".to_owned(),
                "vertex 2 (line 2)",
            ),
            ("b.obj", "v 0 0 0\nf 1 2 3\n".to_owned(), "out of bounds"),
            (
                "c.obj",
                "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n".to_owned(),
                "material library",
            ),
            ("d.gltf", gltf(r#"[{"children":[1]},{"children":[0]}]"#, ""), "cycle"),
            (
                "j.obj",
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//6148914691236517206 2//1 3//1\n".to_owned(),
                "line 5: index 6148914691236517206",
            ),
            (
                "i.obj",
                "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n".to_owned(),
                "line 2: Kd '0.5 1'",
            ),
            (
                "h.gltf",
                gltf(
                    r#"[{"mesh":0}]"#,
                    r#","meshes":[{"primitives":[{"attributes":{"POSITION":9}}]}]"#,
                ),
                "meshes[0].primitives[0]: an attribute names accessor 9 of 0",
            ),
            (
                "e.gltf",
                gltf("[{}]", r#","buffers":[{"byteLength":12,"uri":"gone.bin"}]"#),
                "gone.bin",
            ),
            ("f.glb", "glTF\u{2}\0\0\0".to_owned(), "ends early"),
            ("g.stl", String::new(), ".obj, .gltf or .glb"),
        ];
        std::fs::write(folder.path().join("two.mtl"), "newmtl x\nKd 0.5 1\n").unwrap();
        for (name, content, part) in cases {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            let scene = SceneFile::of_file(&path)
                .unwrap_or_else(|| SceneFile::parse(&path, &format!("[[mesh]]\nfile = '{name}'")).unwrap());
            let message = build(&scene, &Options::default()).unwrap_err().to_string();
            let file = if name == "i.obj" { "two.mtl" } else { name };
            assert!(message.contains(part) && message.contains(file), "{message} / {part}");
        }
    }
}
