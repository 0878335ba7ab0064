//! Meshes from OBJ and glTF/GLB files.
//!
//! Geometry, colours and opacities are read, textures of both included; surfaces are shaded by their geometric normals,
//! so a file without normals looks like any other. What else a file holds is named as left out. Triangles without area
//! cover no sample and vanish by themselves.

mod gltf;
mod obj;
mod polygon;

use super::SceneError;
use super::camera::Vec3;
use super::texture::TexturedMaterial;
use crate::pixel::LeftOut;
use std::path::Path;

/// Endings of the files that are read.
pub(super) const ENDINGS: [&str; 3] = ["obj", "gltf", "glb"];

/// Most triangles that a scene may have; a bound on memory against files whose instances multiply.
pub(super) const MAX_TRIANGLES: usize = 1 << 25;

/// Greatest size of a coordinate; beyond it, cutting at the near plane folds triangles [scene units].
pub(super) const MAX_COORDINATE: f64 = 1e15;

/// A rigid or affine map of points: rows of a 3 x 4 matrix.
pub(super) type Affine = [[f64; 4]; 3];

/// The map that changes nothing.
pub(super) const IDENTITY: Affine = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// The map "first `b`, then `a`".
pub(super) fn compose(a: &Affine, b: &Affine) -> Affine {
    std::array::from_fn(|r| {
        std::array::from_fn(|c| (0..3).map(|k| a[r][k] * b[k][c]).sum::<f64>() + if c == 3 { a[r][3] } else { 0.0 })
    })
}

/// A mapped point.
pub(super) fn apply(m: &Affine, p: Vec3) -> Vec3 {
    std::array::from_fn(|r| m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3])
}

/// Triangles of one material.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Part {
    /// The material's name, where it has one.
    pub material: Option<String>,
    /// Corners, three a triangle [scene units].
    pub corners: Vec<[f32; 3]>,
    /// The material's linear colour and alpha.
    pub rgba: [f32; 4],
    /// What multiplies them at each corner; empty where nothing does.
    pub vertex_rgba: Vec<[f32; 4]>,
    /// Texture coordinates of each corner, v downwards; empty where there are no textures.
    pub uv: Vec<[f32; 2]>,
    /// Textures of the material, and its cutoff.
    pub textures: Option<TexturedMaterial>,
}

/// What the scene file says about materials, so that what it replaces need not be there.
pub(super) trait Overrides {
    /// Whether it gives the opacity of a material.
    fn gives_alpha(&self, material: Option<&str>) -> bool;
    /// Whether it gives the colour of a material.
    fn gives_color(&self, material: Option<&str>) -> bool;
}

/// Reads a mesh by the ending of its name: `.obj`, `.gltf`, `.glb`.
///
/// # Errors
/// [`SceneError`] names the file and the place in it.
pub(super) fn load(path: &Path, scene: &dyn Overrides, left_out: &mut Vec<LeftOut>) -> Result<Vec<Part>, SceneError> {
    let ending = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    let parts = match ending.as_str() {
        "obj" => obj::read(path, scene, left_out)?,
        "gltf" | "glb" => gltf::read(path, scene, left_out)?,
        _ => {
            let reason = "this is no mesh; expected a name that ends in .obj, .gltf or .glb";
            return Err(SceneError::file_content(path, "name", reason));
        }
    };
    let triangles: usize = parts.iter().map(|p| p.corners.len() / 3).sum();
    if triangles > MAX_TRIANGLES {
        let reason = format!("{triangles} triangles; at most {MAX_TRIANGLES} are supported");
        return Err(SceneError::file_content(path, "mesh", reason));
    }
    Ok(parts)
}

/// The rgba of a material, checked.
fn rgba(path: &Path, name: &str, rgba: [f32; 4]) -> Result<[f32; 4], SceneError> {
    let [r, g, b, a] = rgba;
    if (0.0..=1.0).contains(&a) && [r, g, b].iter().all(|c| (0.0..f32::INFINITY).contains(c)) {
        return Ok(rgba);
    }
    Err(SceneError::file_content(
        path,
        &format!("material '{name}'"),
        format!("colour and alpha {rgba:?}; colours must be 0 or more, alpha must lie in [0, 1]"),
    ))
}

/// A position that can be drawn.
fn position(path: &Path, place: impl FnOnce() -> String, p: [f32; 3]) -> Result<[f32; 3], SceneError> {
    if p.iter().all(|x| f64::from(x.abs()) <= MAX_COORDINATE) {
        return Ok(p);
    }
    let reason = format!("position {p:?}; every coordinate must be a finite number of size {MAX_COORDINATE:e} at most");
    Err(SceneError::file_content(path, &place(), reason))
}

/// Text of a file that may begin with a byte order mark, and whose bytes may be Latin-1 where they are not UTF-8.
fn text(bytes: &[u8]) -> String {
    let pairs = |bytes: &[u8], of: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|b| of([b[0], b[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes {
        [0xff, 0xfe, rest @ ..] => pairs(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => pairs(rest, u16::from_be_bytes),
        _ => {
            let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            match std::str::from_utf8(bytes) {
                Ok(text) => text.to_owned(),
                Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::text;

    #[test]
    fn text_is_read_in_any_usual_encoding() {
        for bytes in [
            &b"gr\xc3\xbcn"[..],
            b"\xef\xbb\xbfgr\xc3\xbcn",
            b"gr\xfcn",
            b"\xff\xfeg\0r\0\xfc\0n\0",
            b"\xfe\xff\0g\0r\0\xfc\0n",
        ] {
            assert_eq!(text(bytes), "gr\u{fc}n");
        }
    }
}
