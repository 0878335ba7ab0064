//! Meshes from OBJ and glTF/GLB files.
//!
//! Only geometry and flat materials are read: textures, vertex normals, vertex colours, animations and skins are not. Surfaces are shaded by their
//! geometric normals, so a file without normals looks like any other. Triangles without area cover no sample and vanish by themselves.

use super::SceneError;
use super::camera::Vec3;
use crate::numeric::file::read;
use std::path::{Path, PathBuf};

/// Most triangles that a scene may have; a bound on memory against files whose instances multiply.
pub(super) const MAX_TRIANGLES: usize = 1 << 25;

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
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    /// The material's name, where it has one.
    pub material: Option<String>,
    /// Corners, three a triangle [scene units].
    pub corners: Vec<[f32; 3]>,
    /// Linear colour and alpha.
    pub rgba: [f32; 4],
}

/// Colour where a file names none.
const GREY: [f32; 3] = [0.8, 0.8, 0.8];

/// Reads a mesh by the ending of its name: `.obj`, `.gltf`, `.glb`. `material_needed` is false where the scene overrides both colour and alpha.
///
/// # Errors
/// [`SceneError`] names the file and the place in it.
pub(super) fn load(path: &Path, material_needed: bool) -> Result<Vec<Part>, SceneError> {
    let ending = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    match ending.as_str() {
        "obj" => obj(path, material_needed),
        "gltf" | "glb" => gltf_file(path),
        _ => Err(SceneError::file_content(
            path,
            "name",
            "this is no mesh; expected a name that ends in .obj, .gltf or .glb",
        )),
    }
}

/// The rgba of a material, checked.
fn rgba(path: &Path, name: &str, rgba: [f32; 4]) -> Result<[f32; 4], SceneError> {
    if rgba.iter().all(|c| (0.0..=1.0).contains(c)) {
        return Ok(rgba);
    }
    Err(SceneError::file_content(
        path,
        &format!("material '{name}'"),
        format!("colour and alpha {rgba:?}; each must lie in [0, 1]"),
    ))
}

fn finite(path: &Path, place: impl FnOnce() -> String, p: [f32; 3]) -> Result<[f32; 3], SceneError> {
    if p.iter().all(|x| x.is_finite()) {
        return Ok(p);
    }
    Err(SceneError::file_content(
        path,
        &place(),
        format!("position {p:?}; every coordinate must be a finite number"),
    ))
}

fn obj(path: &Path, material_needed: bool) -> Result<Vec<Part>, SceneError> {
    let bytes = read(path)?;
    let text = std::str::from_utf8(&bytes)
        .map_err(|e| SceneError::file_content(path, &format!("byte {}", e.valid_up_to()), "not a text file"))?;
    let mut vertex = 0;
    for (line, content) in text.lines().enumerate() {
        let mut words = content.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                vertex += 1;
                for word in words {
                    if !word.parse::<f32>().is_ok_and(f32::is_finite) {
                        let place = format!("vertex {vertex} (line {})", line + 1);
                        return Err(SceneError::file_content(
                            path,
                            &place,
                            format!("coordinate '{word}'; every coordinate must be a finite number"),
                        ));
                    }
                }
            }
            // The library multiplies indices before it looks whether they are in bounds.
            Some("f" | "l" | "p") => {
                if let Some(index) = words
                    .flat_map(|w| w.split('/'))
                    .find(|i| i.parse::<i64>().is_ok_and(|i| i32::try_from(i).is_err()))
                {
                    return Err(SceneError::file_content(
                        path,
                        &format!("line {}", line + 1),
                        format!("index {index} is out of bounds"),
                    ));
                }
            }
            _ => {}
        }
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    let library = |name: &Path| match std::fs::read(folder.join(name)) {
        // The library takes it for granted that a colour has three numbers.
        Ok(bytes) if !colors_are_whole(&bytes) => Err(tobj::LoadError::MaterialParseError),
        Ok(bytes) => tobj::load_mtl_buf(&mut bytes.as_slice()),
        Err(_) => Err(tobj::LoadError::OpenFileFailed),
    };
    let (models, materials) = tobj::load_obj_buf(&mut text.as_bytes(), &options, library)
        .map_err(|e| SceneError::file_content(path, "OBJ", format!("{e}")))?;
    let materials = match materials {
        Ok(materials) => materials,
        Err(_) if !material_needed => Vec::new(),
        Err(e) => {
            let reason = format!(
                "{e}; put the file that mtllib names beside the mesh, or give the mesh both color and alpha in the scene file"
            );
            return Err(SceneError::file_content(path, "material library", reason));
        }
    };
    let mut parts = Vec::with_capacity(models.len());
    for tobj::Model { mesh, name } in models {
        let at = |i: u32| -> Result<[f32; 3], SceneError> {
            match mesh.positions.get(i as usize * 3..i as usize * 3 + 3) {
                Some(p) => Ok([p[0], p[1], p[2]]),
                None => Err(SceneError::file_content(
                    path,
                    &format!("object '{name}'"),
                    format!("a face uses vertex {i}, which is not there"),
                )),
            }
        };
        let corners = mesh.indices.iter().map(|&i| at(i)).collect::<Result<Vec<_>, _>>()?;
        if corners.len() % 3 != 0 {
            return Err(SceneError::file_content(
                path,
                &format!("object '{name}'"),
                "a face has fewer than three corners",
            ));
        }
        let material = mesh.material_id.and_then(|i| materials.get(i));
        let look = match material {
            None => [GREY[0], GREY[1], GREY[2], 1.0],
            Some(m) => {
                let [r, g, b] = m.diffuse.unwrap_or(GREY);
                let transparency = m.unknown_param.get("Tr").and_then(|t| t.trim().parse::<f32>().ok());
                rgba(
                    path,
                    &m.name,
                    [r, g, b, m.dissolve.or(transparency.map(|t| 1.0 - t)).unwrap_or(1.0)],
                )?
            }
        };
        parts.push(Part {
            material: material.map(|m| m.name.clone()),
            corners,
            rgba: look,
        });
    }
    within_bounds(path, parts)
}

/// Whether every colour of a material library has three words.
fn colors_are_whole(library: &[u8]) -> bool {
    String::from_utf8_lossy(library).lines().all(|line| {
        let mut words = line.split_whitespace();
        !words.next().is_some_and(|w| ["Ka", "Kd", "Ks", "Ke"].contains(&w)) || words.count() >= 3
    })
}

fn within_bounds(path: &Path, parts: Vec<Part>) -> Result<Vec<Part>, SceneError> {
    let triangles: usize = parts.iter().map(|p| p.corners.len() / 3).sum();
    if triangles > MAX_TRIANGLES {
        return Err(SceneError::file_content(
            path,
            "mesh",
            format!("{triangles} triangles; at most {MAX_TRIANGLES} are supported"),
        ));
    }
    Ok(parts)
}

/// The JSON and binary chunks of a GLB container.
fn glb_chunks<'a>(path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), SceneError> {
    let word = |at: usize| {
        bytes
            .get(at..at + 4)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    };
    let truncated = |at: usize| SceneError::file_content(path, &format!("byte {at}"), "the GLB container ends early");
    if word(4) != Some(2) {
        return Err(SceneError::file_content(
            path,
            "byte 4",
            "a GLB container of version 2 is expected",
        ));
    }
    let (mut at, mut json, mut binary) = (12, None, None);
    while at < bytes.len() {
        let (length, kind) = (
            word(at).ok_or_else(|| truncated(at))?,
            word(at + 4).ok_or_else(|| truncated(at))?,
        );
        let end = (at + 8).checked_add(length as usize).ok_or_else(|| truncated(at))?;
        let chunk = bytes.get(at + 8..end).ok_or_else(|| truncated(at))?;
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at = end;
    }
    Ok((json.ok_or_else(|| truncated(at))?, binary))
}

/// A glTF document that holds what the format demands.
fn document(path: &Path, json: &[u8]) -> Result<gltf::Document, SceneError> {
    let wrong = |e: gltf::Error| SceneError::file_content(path, "glTF", format!("{e}"));
    let document = gltf::Gltf::from_slice_without_validation(json).map_err(wrong)?.document;
    let root = document.as_json();
    // The library's own validation looks positions up without asking whether they are there.
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            if let Some(accessor) = primitive
                .attributes
                .values()
                .find(|a| a.value() >= root.accessors.len())
            {
                let reason = format!(
                    "an attribute names accessor {} of {}",
                    accessor.value(),
                    root.accessors.len()
                );
                return Err(SceneError::file_content(
                    path,
                    &format!("meshes[{m}].primitives[{p}]"),
                    reason,
                ));
            }
        }
    }
    gltf::Document::from_json(document.into_json()).map_err(wrong)
}

fn gltf_file(path: &Path) -> Result<Vec<Part>, SceneError> {
    let bytes = read(path)?;
    let (json, binary) = if bytes.starts_with(b"glTF") {
        glb_chunks(path, &bytes)?
    } else {
        (bytes.as_slice(), None)
    };
    let document = match json.starts_with(b"glTF") {
        true => return Err(SceneError::file_content(path, "JSON", "a container within a container")),
        false => document(path, json)?,
    };
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let place = format!("buffers[{}]", buffer.index());
        let data = match buffer.source() {
            gltf::buffer::Source::Bin => binary
                .map(<[u8]>::to_vec)
                .ok_or_else(|| SceneError::file_content(path, &place, "the GLB has no binary chunk"))?,
            gltf::buffer::Source::Uri(uri) => external(path, &place, uri)?,
        };
        if data.len() < buffer.length() {
            return Err(SceneError::file_content(
                path,
                &place,
                format!("{} bytes where {} are declared", data.len(), buffer.length()),
            ));
        }
        buffers.push(data);
    }
    let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
        return Err(SceneError::file_content(path, "scenes", "there is no scene"));
    };
    let nodes: Vec<gltf::Node<'_>> = document.nodes().collect();
    let mut seen = vec![false; nodes.len()];
    let mut stack: Vec<(usize, Affine)> = scene.nodes().map(|n| (n.index(), IDENTITY)).collect();
    stack.reverse();
    let (mut parts, mut triangles) = (Vec::new(), 0);
    while let Some((index, parent)) = stack.pop() {
        let node = &nodes[index];
        if std::mem::replace(&mut seen[index], true) {
            let reason = "it is reached twice: the nodes form a cycle or share a child, where a tree is needed";
            return Err(SceneError::file_content(path, &format!("nodes[{index}]"), reason));
        }
        let columns = node.transform().matrix();
        let own: Affine = std::array::from_fn(|r| std::array::from_fn(|c| f64::from(columns[c][r])));
        let matrix = compose(&parent, &own);
        if let Some(mesh) = node.mesh() {
            for primitive in mesh.primitives() {
                let part = gltf_part(path, &mesh, &primitive, &buffers, &matrix)?;
                triangles += part.corners.len() / 3;
                if triangles > MAX_TRIANGLES {
                    let reason = format!("more than the {MAX_TRIANGLES} triangles that are supported");
                    return Err(SceneError::file_content(path, &format!("nodes[{index}]"), reason));
                }
                parts.push(part);
            }
        }
        let children: Vec<_> = node.children().map(|n| (n.index(), matrix)).collect();
        stack.extend(children.into_iter().rev());
    }
    Ok(parts)
}

/// Bytes of a buffer outside the document: a file beside it, or a base64 data URI.
fn external(path: &Path, place: &str, uri: &str) -> Result<Vec<u8>, SceneError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, e)| e);
        return encoded
            .and_then(base64)
            .ok_or_else(|| SceneError::file_content(path, place, "its data URI is not valid base64"));
    }
    if uri.contains(':') {
        return Err(SceneError::file_content(
            path,
            place,
            format!("its URI '{uri}' is neither a file beside the mesh nor embedded data"),
        ));
    }
    let file: PathBuf = path.parent().unwrap_or(Path::new(".")).join(percent_decoded(uri));
    std::fs::read(&file)
        .map_err(|e| SceneError::file_content(path, place, format!("its file {} cannot be read: {e}", file.display())))
}

fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let hex = (bytes[i] == b'%')
            .then(|| uri.get(i + 1..i + 3))
            .flatten()
            .and_then(|h| u8::from_str_radix(h, 16).ok());
        out.push(hex.unwrap_or(bytes[i]));
        i += if hex.is_some() { 3 } else { 1 };
    }
    String::from_utf8_lossy(&out).into_owned()
}

/// Standard base64; none where a character does not belong to it.
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0u32, 0);
    for c in text.trim_end_matches('=').bytes() {
        let value = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            out.push((bits >> held) as u8);
            bits &= (1 << held) - 1;
        }
    }
    Some(out)
}

fn gltf_part(
    path: &Path,
    mesh: &gltf::Mesh<'_>,
    primitive: &gltf::Primitive<'_>,
    buffers: &[Vec<u8>],
    matrix: &Affine,
) -> Result<Part, SceneError> {
    let place = format!("meshes[{}].primitives[{}]", mesh.index(), primitive.index());
    let wrong = |reason: String| SceneError::file_content(path, &place, reason);
    let material = primitive.material();
    let name = material.name().map(str::to_owned);
    let base = material.pbr_metallic_roughness().base_color_factor();
    let look = rgba(path, name.as_deref().unwrap_or("(unnamed)"), base)?;
    let look = match material.alpha_mode() {
        gltf::material::AlphaMode::Opaque => [look[0], look[1], look[2], 1.0],
        gltf::material::AlphaMode::Blend => look,
        gltf::material::AlphaMode::Mask => {
            let kept = look[3] >= material.alpha_cutoff().unwrap_or(0.5);
            [look[0], look[1], look[2], f32::from(u8::from(kept))]
        }
    };
    if primitive.extension_is_draco() {
        return Err(wrong(
            "its geometry is compressed (KHR_draco_mesh_compression); export the mesh without compression".to_owned(),
        ));
    }
    let Some(positions) = primitive.get(&gltf::Semantic::Positions) else {
        return Err(wrong("it has no POSITION attribute".to_owned()));
    };
    let floats = (gltf::accessor::DataType::F32, gltf::accessor::Dimensions::Vec3);
    if (positions.data_type(), positions.dimensions()) != floats {
        return Err(wrong("POSITION must hold three 32-bit floats a vertex".to_owned()));
    }
    // The declared number is believed only once so many are there.
    let elements_of_positions = elements(path, &positions, buffers)?;
    let mut points = Vec::with_capacity(positions.count().min(MAX_TRIANGLES));
    for (i, bytes) in elements_of_positions.enumerate() {
        let p = [0, 4, 8].map(|k| f32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]));
        let p = finite(path, || format!("{place}, vertex {i}"), p)?;
        let world = apply(matrix, p.map(f64::from)).map(|x| x as f32);
        points.push(finite(
            path,
            || format!("{place}, vertex {i} after the transforms of its nodes"),
            world,
        )?);
    }
    let indices: Vec<u32> = match primitive.indices() {
        None => (0..points.len() as u32).collect(),
        Some(accessor) => {
            use gltf::accessor::DataType;
            if accessor.dimensions() != gltf::accessor::Dimensions::Scalar {
                return Err(wrong("its indices are not single numbers".to_owned()));
            }
            let read: fn(&[u8]) -> u32 = match accessor.data_type() {
                DataType::U8 => |b| b[0].into(),
                DataType::U16 => |b| u16::from_le_bytes([b[0], b[1]]).into(),
                DataType::U32 => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
                _ => return Err(wrong("its indices are not unsigned integers".to_owned())),
            };
            elements(path, &accessor, buffers)?.map(read).collect()
        }
    };
    if let Some(&i) = indices.iter().find(|&&i| i as usize >= points.len()) {
        return Err(wrong(format!("an index names vertex {i} of {}", points.len())));
    }
    use gltf::mesh::Mode;
    let triples: Vec<[u32; 3]> = match primitive.mode() {
        Mode::Triangles => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        Mode::TriangleStrip => indices.windows(3).map(|w| [w[0], w[1], w[2]]).collect(),
        Mode::TriangleFan => indices.windows(2).skip(1).map(|w| [indices[0], w[0], w[1]]).collect(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    };
    let corners = triples.into_iter().flatten().map(|i| points[i as usize]).collect();
    Ok(Part {
        material: name,
        corners,
        rgba: look,
    })
}

/// Whether a primitive holds Draco data instead of plain accessors.
trait Draco {
    fn extension_is_draco(&self) -> bool;
}

impl Draco for gltf::Primitive<'_> {
    /// Compressed accessors have no buffer view, which plain ones of positions always have.
    fn extension_is_draco(&self) -> bool {
        self.get(&gltf::Semantic::Positions)
            .is_some_and(|a| a.view().is_none() && a.sparse().is_none())
    }
}

/// The bytes of every element of an accessor, bounds checked.
fn elements<'a>(
    path: &Path,
    accessor: &gltf::Accessor<'_>,
    buffers: &'a [Vec<u8>],
) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, SceneError> {
    let wrong = |reason: &str| SceneError::file_content(path, &format!("accessors[{}]", accessor.index()), reason);
    if accessor.sparse().is_some() {
        return Err(wrong(
            "sparse accessors are not supported; export the mesh without them",
        ));
    }
    let view = accessor.view().ok_or_else(|| wrong("it has no buffer view"))?;
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size);
    let data = buffers
        .get(view.buffer().index())
        .ok_or_else(|| wrong("its buffer is not there"))?;
    let outside = || wrong("it reaches beyond the end of its buffer view or buffer");
    let bytes = view
        .offset()
        .checked_add(view.length())
        .and_then(|end| data.get(view.offset()..end))
        .ok_or_else(outside)?;
    let bytes = bytes.get(accessor.offset()..).ok_or_else(outside)?;
    let count = accessor.count();
    let needed = count
        .checked_sub(1)
        .map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size));
    if stride < size || needed.is_none_or(|n| n > bytes.len()) {
        return Err(outside());
    }
    Ok((0..count).map(move |i| &bytes[i * stride..i * stride + size]))
}
