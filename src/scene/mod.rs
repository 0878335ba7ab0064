//! Fragment lists from scenes: meshes and built-in scenes seen through a camera, and files of other renderers.

pub mod camera;
pub mod exr;
pub mod file;
mod mesh;
pub mod npz;
mod procedural;
mod raster;

pub use camera::Camera;
pub use file::{Look, MeshEntry, SceneFile};

use crate::numeric::file::FileError;
use crate::numeric::npy::NpyError;
use crate::pixel::{FragmentError, FragmentList};
use std::path::{Path, PathBuf};

/// The scenes that need no files.
pub const BUILT_IN: [&str; 6] = ["glass-stacks", "smoke", "hair", "foliage", "spheres", "teapots"];

/// Most fragments of a rendered scene; with colour they take 20 bytes each, so 5 GiB.
pub const MOST_FRAGMENTS: u64 = 1 << 28;

/// What a caller may change about a scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Options {
    /// Columns and rows in place of the camera's [pixels].
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
    #[error("there is no built-in scene '{name}'; choose one of {}, or pass a scene file that ends in .toml", BUILT_IN.join(", "))]
    UnknownBuiltIn {
        /// The name.
        name: String,
    },
    /// The picture would take too much memory.
    #[error(
        "the scene has {fragments} fragments in {pixels} pixels; at most {MOST_FRAGMENTS} are supported, so lower the width and height or use fewer layers"
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
        Self::Field { path: path.to_owned(), field: field.to_owned(), found, expected: expected.to_owned() }
    }

    fn file_content(path: &Path, place: &str, reason: impl Into<String>) -> Self {
        Self::FileContent { path: path.to_owned(), place: place.to_owned(), reason: reason.into() }
    }
}

/// A scene by its name: a built-in one, or else a scene file's path.
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
    SceneFile::read(path)
}

/// The fragments of a scene, with colours, image size and camera planes.
///
/// The result depends on the scene and the options alone, not on the number of threads.
/// An opaque fragment (alpha 1) is kept as a fragment, and what lies strictly behind the nearest opaque one of its pixel is left out.
///
/// # Errors
/// [`SceneError`] for a mesh that cannot be read, and for a picture that would take too much memory.
pub fn build(scene: &SceneFile, options: &Options) -> Result<FragmentList, SceneError> {
    scene.build(options)
}

/// A fragment list from a file, by the ending of its name: `.npz`, or `.exr` for a deep image.
///
/// # Errors
/// [`SceneError`] names the file, the place in it and what is expected there.
pub fn read(path: &Path) -> Result<FragmentList, SceneError> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("npz") => npz::read(path),
        Some("exr") => exr::read(path, &exr::ReadOptions::default()),
        _ => Err(SceneError::UnknownFormat { path: path.to_owned() }),
    }
}
