//! glTF and GLB meshes.
//!
//! The JSON is read once as plain values, in which extensions and what is left out are looked up, and once by the crate
//! `gltf`, which sees only what is used here: a valid file is never refused over a part that nothing here depends on.

use super::{Affine, IDENTITY, MAX_TRIANGLES, Overrides, Part, apply, compose, position, rgba, text};
use crate::numeric::file::read as read_file;
use crate::pixel::left_out::{LeftOut, note};
use crate::scene::SceneError;
use crate::scene::texture::{Image, Texture, TexturedMaterial, UNMOVED, Wrap};
use gltf::Semantic;
use gltf::accessor::{DataType, Dimensions};
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use serde_json::Value;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Extensions that are read, that are named as left out where they occur, or that touch nothing that is read.
const HARMLESS: [&str; 27] = [
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_materials_unlit",
    "KHR_materials_clearcoat",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_variants",
    "KHR_lights_punctual",
    "KHR_animation_pointer",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "KHR_node_visibility",
    "KHR_techniques_webgl",
    "EXT_lights_image_based",
    "EXT_lights_ies",
    "EXT_mesh_manifold",
    "MSFT_lod",
];

/// Beginnings of extensions of single programs that say nothing about shape or opacity.
const HARMLESS_VENDORS: [&str; 10] = [
    "ADOBE_", "AGI_", "CESIUM_", "FB_", "GOOGLE_", "MPEG_", "NV_", "VRM", "MOZ_", "OMI_",
];

/// What to do about opacity that alphaMode OPAQUE makes nothing of.
const UNDER_OPAQUE: &str =
    "alphaMode is OPAQUE, under which glTF ignores alpha; set alphaMode to BLEND, or alpha in the scene file";

/// Extensions of materials that make them let light through in ways other than alpha.
const OF_GLASS: [&str; 4] = [
    "KHR_materials_transmission",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
];

/// Everything about the file that is at hand while it is read.
struct File<'a> {
    path: &'a Path,
    /// The JSON as it stands.
    json: Value,
    document: Arc<gltf::Document>,
    buffers: Vec<Vec<u8>>,
    images: HashMap<usize, Arc<Image>>,
    left_out: &'a mut Vec<LeftOut>,
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

/// A valid list of an object's field, empty where there is none.
fn list<'v>(value: &'v Value, field: &str) -> &'v [Value] {
    value[field].as_array().map_or(&[], Vec::as_slice)
}

/// The value of an extension of an object.
fn extension<'v>(value: &'v Value, name: &str) -> Option<&'v Value> {
    value.get("extensions")?.get(name)
}

/// Refuses extensions that are required and would change what is read.
fn check_required(path: &Path, json: &Value) -> Result<(), SceneError> {
    for name in list(json, "extensionsRequired").iter().filter_map(Value::as_str) {
        let harmless = HARMLESS.contains(&name) || HARMLESS_VENDORS.iter().any(|v| name.starts_with(v));
        // Textures of other kinds matter only where one is used.
        let of_texture = name.contains("_texture_");
        if !harmless && !of_texture {
            let reason =
                format!("the extension {name}, which the file requires, is not supported: export the mesh without it");
            return Err(SceneError::file_content(path, "extensionsRequired", reason));
        }
    }
    Ok(())
}

/// The document without all that is not read, so that no demand on those parts can fail.
fn document(path: &Path, json: &Value) -> Result<gltf::Document, SceneError> {
    let wrong = |e: String| SceneError::file_content(path, "glTF", e);
    let mut used = json.clone();
    remove_unread(&mut used);
    complete_accessors(&mut used, !list(json, "bufferViews").is_empty());
    let root: gltf::json::Root = serde_json::from_value(used).map_err(|e| wrong(e.to_string()))?;
    // The library's own validation looks positions up without asking whether they are there.
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let mut accessors = primitive.attributes.values().map(|a| a.value());
            if let Some(accessor) = accessors.find(|&a| a >= root.accessors.len()) {
                let reason = format!("an attribute names accessor {accessor} of {}", root.accessors.len());
                let place = format!("meshes[{m}].primitives[{p}]");
                return Err(SceneError::file_content(path, &place, reason));
            }
        }
    }
    gltf::Document::from_json(root).map_err(|e| wrong(e.to_string()))
}

/// The members of an array, which may not be there.
fn members<'a>(value: &'a mut Value, field: &str) -> impl Iterator<Item = &'a mut Value> {
    let array = value.get_mut(field).and_then(Value::as_array_mut);
    array.into_iter().flatten()
}

/// Those that are objects.
fn objects<'a>(value: &'a mut Value, field: &str) -> impl Iterator<Item = &'a mut serde_json::Map<String, Value>> {
    members(value, field).filter_map(Value::as_object_mut)
}

/// Removes all that is not read.
fn remove_unread(document: &mut Value) {
    const OF_ROOT: [&str; 7] = [
        "extensionsRequired",
        "extensionsUsed",
        "extensions",
        "animations",
        "cameras",
        "skins",
        "extras",
    ];
    const OF_OBJECTS: [(&str, &[&str]); 8] = [
        ("nodes", &["skin", "camera", "weights", "extensions", "extras"]),
        (
            "materials",
            &[
                "extensions",
                "extras",
                "normalTexture",
                "occlusionTexture",
                "emissiveTexture",
                "emissiveFactor",
            ],
        ),
        ("textures", &["extensions", "extras"]),
        ("meshes", &["weights", "extensions", "extras"]),
        ("images", &["extensions", "extras"]),
        ("bufferViews", &["extensions", "extras", "target"]),
        ("buffers", &["extensions", "extras"]),
        ("accessors", &["extensions", "extras"]),
    ];
    if let Some(root) = document.as_object_mut() {
        OF_ROOT.iter().for_each(|name| drop(root.remove(*name)));
    }
    for (field, unread) in OF_OBJECTS {
        for object in objects(document, field) {
            unread.iter().for_each(|name| drop(object.remove(*name)));
        }
    }
    for mesh in members(document, "meshes") {
        for primitive in objects(mesh, "primitives") {
            for name in ["targets", "extensions", "extras"] {
                primitive.remove(name);
            }
            if let Some(attributes) = primitive.get_mut("attributes").and_then(Value::as_object_mut) {
                let read = |name: &str| ["POSITION", "COLOR_0"].contains(&name) || name.starts_with("TEXCOORD_");
                attributes.retain(|name, _| read(name));
            }
        }
    }
}

/// Adds what the library demands of accessors and the format does not: bounds of positions, and a buffer view. Where
/// there is no view, none is looked at.
fn complete_accessors(document: &mut Value, has_views: bool) {
    for accessor in objects(document, "accessors") {
        if has_views && accessor.get("sparse").is_none() {
            accessor.entry("bufferView").or_insert_with(|| 0.into());
        }
        for bound in ["min", "max"] {
            accessor.insert(bound.to_owned(), Value::Array(vec![0.into(), 0.into(), 0.into()]));
        }
    }
}

/// Reads a glTF or GLB mesh.
///
/// # Errors
/// [`SceneError`] names the file, the object in it, and what is wrong there.
pub(super) fn read(path: &Path, scene: &dyn Overrides, left_out: &mut Vec<LeftOut>) -> Result<Vec<Part>, SceneError> {
    let bytes = read_file(path)?;
    let (json, binary) = if bytes.starts_with(b"glTF") {
        glb_chunks(path, &bytes)?
    } else {
        (bytes.as_slice(), None)
    };
    if json.starts_with(b"glTF") {
        return Err(SceneError::file_content(path, "JSON", "a container within a container"));
    }
    let json: Value = serde_json::from_str(&text(json))
        .map_err(|e| SceneError::file_content(path, "glTF", format!("its JSON is damaged: {e}")))?;
    check_required(path, &json)?;
    let document = document(path, &json)?;
    let buffers = buffers(path, &json, &document, binary)?;
    let mut file = File {
        path,
        json,
        document: Arc::new(document),
        buffers,
        images: HashMap::new(),
        left_out,
    };
    file.name_what_is_left_out();
    file.parts(scene)
}

/// The bytes of every buffer. One that only a compression's fallback needs may be missing; what uses it says so.
fn buffers(
    path: &Path,
    json: &Value,
    document: &gltf::Document,
    binary: Option<&[u8]>,
) -> Result<Vec<Vec<u8>>, SceneError> {
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let place = format!("buffers[{}]", buffer.index());
        let fallback = list(json, "buffers").get(buffer.index()).is_some_and(|b| {
            ["EXT_meshopt_compression", "KHR_meshopt_compression"]
                .iter()
                .any(|name| extension(b, name).is_some())
        });
        let data = match buffer.source() {
            gltf::buffer::Source::Bin if fallback && buffer.index() > 0 => Vec::new(),
            gltf::buffer::Source::Bin => binary
                .map(<[u8]>::to_vec)
                .ok_or_else(|| SceneError::file_content(path, &place, "the GLB has no binary chunk"))?,
            gltf::buffer::Source::Uri(uri) => external(path, &place, uri)?,
        };
        if data.len() < buffer.length() && !(fallback && data.is_empty()) {
            let reason = format!("{} bytes where {} are declared", data.len(), buffer.length());
            return Err(SceneError::file_content(path, &place, reason));
        }
        buffers.push(data);
    }
    Ok(buffers)
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

/// Numbers that an accessor holds: rows of as many as its type has, integers as they are or normalised.
struct Rows {
    width: usize,
    values: Vec<f32>,
    /// For indices, which f32 would not hold.
    whole: Vec<u32>,
}

impl File<'_> {
    fn wrong(&self, place: &str, reason: impl Into<String>) -> SceneError {
        SceneError::file_content(self.path, place, reason)
    }

    fn leave_out(&mut self, what: impl Into<String>, count: usize, remedy: &str) {
        let place = self.path.display().to_string();
        note(self.left_out, LeftOut::new(what, place, count as u64, remedy));
    }

    /// What the whole file holds besides meshes.
    fn name_what_is_left_out(&mut self) {
        let count = |field: &str| list(&self.json, field).len();
        let with = |field: &str, part: &str| list(&self.json, field).iter().filter(|o| o.get(part).is_some()).count();
        let primitives = || list(&self.json, "meshes").iter().flat_map(|m| list(m, "primitives"));
        let lights = extension(&self.json, "KHR_lights_punctual").map_or(0, |l| list(l, "lights").len());
        let instances = list(&self.json, "nodes")
            .iter()
            .filter(|n| extension(n, "EXT_mesh_gpu_instancing").is_some())
            .count();
        let hidden = list(&self.json, "nodes").iter();
        let hidden =
            hidden.filter(|n| extension(n, "KHR_node_visibility").is_some_and(|v| v["visible"] == Value::Bool(false)));
        let hidden = hidden.count();
        let maps = list(&self.json, "materials").iter();
        let maps = maps
            .filter(|m| m.get("normalTexture").is_some() || m.get("occlusionTexture").is_some())
            .count();
        let emits = |m: &&Value| {
            m.get("emissiveTexture").is_some()
                || list(m, "emissiveFactor")
                    .iter()
                    .any(|x| x.as_f64().is_some_and(|x| x > 0.0))
        };
        let emits = list(&self.json, "materials").iter().filter(emits).count();
        let unlit = |m: &&Value| extension(m, "KHR_materials_unlit").is_some();
        let unlit = list(&self.json, "materials").iter().filter(unlit).count();
        let found = [
            (
                "animations",
                count("animations"),
                "the mesh stands as its nodes say; export the pose that is meant",
            ),
            (
                "skins of nodes",
                with("nodes", "skin"),
                "the mesh keeps its bind pose; apply the armature before export",
            ),
            (
                "primitives' morph targets",
                primitives().filter(|p| p.get("targets").is_some()).count(),
                "the mesh keeps its base shape; apply the shape keys before export",
            ),
            ("cameras", count("cameras"), "the camera is that of the scene file"),
            ("lights", lights, "every surface is lit in one way"),
            (
                "instances (EXT_mesh_gpu_instancing) of nodes",
                instances,
                "one of each is drawn; export them as nodes",
            ),
            (
                "nodes' invisibility (KHR_node_visibility)",
                hidden,
                "they are drawn; remove them before export",
            ),
            ("emission of materials", emits, "surfaces are matt and lit"),
            (
                "materials' being unlit (KHR_materials_unlit)",
                unlit,
                "every surface is lit in one way",
            ),
            (
                "normal and occlusion maps of materials",
                maps,
                "surfaces are matt and shaded by their geometry",
            ),
            (
                "scenes besides the first or the default one",
                count("scenes").saturating_sub(1),
                "export the one that is meant",
            ),
        ];
        for (what, count, remedy) in found {
            self.leave_out(what, count, remedy);
        }
    }

    /// The parts of the default scene, or else of the first.
    fn parts(&mut self, scene_file: &dyn Overrides) -> Result<Vec<Part>, SceneError> {
        let document = Arc::clone(&self.document);
        let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
            return Err(self.wrong("scenes", "there is no scene; export one with the nodes that are meant"));
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
                return Err(self.wrong(&format!("nodes[{index}]"), reason));
            }
            let columns = node.transform().matrix();
            let own: Affine = std::array::from_fn(|r| std::array::from_fn(|c| f64::from(columns[c][r])));
            let matrix = compose(&parent, &own);
            if let Some(mesh) = node.mesh() {
                for primitive in mesh.primitives() {
                    let part = self.part(&mesh, &primitive, &matrix, scene_file)?;
                    triangles += part.corners.len() / 3;
                    if triangles > MAX_TRIANGLES {
                        let reason = format!("more than the {MAX_TRIANGLES} triangles that are supported");
                        return Err(self.wrong(&format!("nodes[{index}]"), reason));
                    }
                    parts.push(part);
                }
            }
            let children: Vec<_> = node.children().map(|n| (n.index(), matrix)).collect();
            stack.extend(children.into_iter().rev());
        }
        Ok(parts)
    }

    fn part(
        &mut self,
        mesh: &gltf::Mesh<'_>,
        primitive: &gltf::Primitive<'_>,
        matrix: &Affine,
        scene: &dyn Overrides,
    ) -> Result<Part, SceneError> {
        let place = format!("meshes[{}].primitives[{}]", mesh.index(), primitive.index());
        let json = &list(&self.json["meshes"][mesh.index()], "primitives")[primitive.index()];
        let positions = primitive.get(&Semantic::Positions);
        if extension(json, "KHR_draco_mesh_compression").is_some()
            && positions.as_ref().is_none_or(|a| !self.has_view(a))
        {
            let reason = "its geometry is compressed (KHR_draco_mesh_compression), which is not supported: export the \
                mesh without it";
            return Err(self.wrong(&place, reason));
        }
        let name = primitive.material().name().map(str::to_owned);
        let Some(positions) = positions else {
            self.leave_out("primitives without POSITION", 1, "there is nothing to draw in them");
            return Ok(Part {
                material: name,
                ..Part::default()
            });
        };
        if let Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip = primitive.mode() {
            let what = if primitive.mode() == Mode::Points {
                "primitives of points"
            } else {
                "primitives of lines"
            };
            self.leave_out(what, 1, "only triangles are drawn; give them a width as triangles");
            return Ok(Part {
                material: name,
                ..Part::default()
            });
        }
        if positions.dimensions() != Dimensions::Vec3 {
            return Err(self.wrong(&place, "POSITION must hold three numbers a vertex"));
        }
        if positions.data_type() == DataType::U32 {
            return Err(self.wrong(&place, "POSITION holds 32-bit integers, which glTF does not allow"));
        }
        let mut points = Vec::new();
        for (i, p) in self.rows(&positions)?.values.chunks_exact(3).enumerate() {
            let p = position(self.path, || format!("{place}, vertex {i}"), [p[0], p[1], p[2]])?;
            let world = apply(matrix, p.map(f64::from)).map(|x| x as f32);
            points.push(position(
                self.path,
                || format!("{place}, vertex {i} after the transforms of its nodes"),
                world,
            )?);
        }
        let corners = self.corners(&place, primitive, points.len())?;
        let mut part = Part {
            corners: corners.iter().map(|&i| points[i as usize]).collect(),
            material: name,
            ..Part::default()
        };
        self.material(&place, primitive, &corners, points.len(), scene, &mut part)?;
        Ok(part)
    }

    /// The vertices of a primitive's triangles, three each.
    fn corners(&self, place: &str, primitive: &gltf::Primitive<'_>, vertices: usize) -> Result<Vec<u32>, SceneError> {
        let indices = match primitive.indices() {
            None => (0..vertices as u32).collect(),
            Some(accessor) => {
                if accessor.dimensions() != Dimensions::Scalar {
                    return Err(self.wrong(place, "its indices are not single numbers"));
                }
                if !matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32) {
                    return Err(self.wrong(place, "its indices are not unsigned integers"));
                }
                self.rows(&accessor)?.whole
            }
        };
        if let Some(&i) = indices.iter().find(|&&i| i as usize >= vertices) {
            return Err(self.wrong(place, format!("an index names vertex {i} of {vertices}")));
        }
        Ok(match primitive.mode() {
            Mode::TriangleStrip => indices.windows(3).flatten().copied().collect(),
            Mode::TriangleFan => indices
                .windows(2)
                .skip(1)
                .flat_map(|w| [indices[0], w[0], w[1]])
                .collect(),
            _ => indices.chunks_exact(3).flatten().copied().collect(),
        })
    }

    /// One row a vertex of an attribute; none where it is not there.
    fn attribute(
        &self,
        place: &str,
        primitive: &gltf::Primitive<'_>,
        semantic: &Semantic,
        name: &str,
        vertices: usize,
    ) -> Result<Option<Rows>, SceneError> {
        let Some(accessor) = primitive.get(semantic) else {
            return Ok(None);
        };
        let rows = self.rows(&accessor)?;
        if rows.values.len() / rows.width != vertices {
            let reason = format!(
                "{name} has {} rows for {vertices} vertices",
                rows.values.len() / rows.width
            );
            return Err(self.wrong(place, reason));
        }
        Ok(Some(rows))
    }

    /// Colour, opacity and textures of a primitive.
    fn material(
        &mut self,
        place: &str,
        primitive: &gltf::Primitive<'_>,
        corners: &[u32],
        vertices: usize,
        scene: &dyn Overrides,
        part: &mut Part,
    ) -> Result<(), SceneError> {
        let material = primitive.material();
        let name = part.material.clone();
        let shown = name.clone().unwrap_or_else(|| "(unnamed)".to_owned());
        let (alpha_given, color_given) = (scene.gives_alpha(name.as_deref()), scene.gives_color(name.as_deref()));
        let json = material
            .index()
            .map_or(Value::Null, |i| self.json["materials"][i].clone());
        let (base, texture) = self.base(&material, &json, &shown);
        part.rgba = rgba(self.path, &shown, base)?;
        let mode = material.alpha_mode();
        if !alpha_given {
            let alpha = if mode == AlphaMode::Opaque { 1.0 } else { part.rgba[3] };
            self.name_glass(&json, &shown, alpha);
        }
        let ignored = mode == AlphaMode::Opaque && !alpha_given;
        if ignored && part.rgba[3] < 1.0 {
            self.leave_out(format!("alpha {} of material '{shown}'", part.rgba[3]), 1, UNDER_OPAQUE);
        }
        if mode == AlphaMode::Opaque {
            part.rgba[3] = 1.0;
        }
        part.vertex_rgba = self.vertex_colors(place, primitive, corners, vertices, (&shown, ignored))?;
        let cutoff = (mode == AlphaMode::Mask).then(|| (material.alpha_cutoff().unwrap_or(0.5), 1.0));
        let mut textures = TexturedMaterial {
            color_counts: true,
            alpha_counts: mode != AlphaMode::Opaque,
            cutoff,
            ..TexturedMaterial::default()
        };
        if let Some(info) = texture.filter(|_| !color_given || !alpha_given) {
            match self.texture(&info, vertices, place, primitive) {
                Ok((found, coordinates)) => {
                    if ignored && found.image.has_alpha() {
                        self.leave_out(format!("alpha of the texture of material '{shown}'"), 1, UNDER_OPAQUE);
                    }
                    textures.color = Some(found);
                    part.uv = corners
                        .iter()
                        .map(|&i| [coordinates[i as usize * 2], coordinates[i as usize * 2 + 1]])
                        .collect();
                }
                // Where opacity does not hang on it, a surface is drawn without it.
                Err(error) if mode == AlphaMode::Opaque || alpha_given => {
                    let colour = if color_given {
                        "the scene file's"
                    } else {
                        "its factor alone"
                    };
                    let remedy = format!("its colour is {colour} ({error})");
                    self.leave_out(format!("the texture of material '{shown}'"), 1, &remedy);
                }
                Err(error) => return Err(error),
            }
        }
        if textures.color.is_some() || cutoff.is_some() {
            if part.uv.is_empty() {
                part.uv = vec![[0.0; 2]; corners.len()];
            }
            part.textures = Some(textures);
        }
        Ok(())
    }

    /// Colour with opacity, and the texture of both.
    fn base(&mut self, material: &gltf::Material<'_>, json: &Value, shown: &str) -> ([f32; 4], Option<Value>) {
        let Some(other) = extension(json, "KHR_materials_pbrSpecularGlossiness") else {
            let texture = json["pbrMetallicRoughness"].get("baseColorTexture");
            return (material.pbr_metallic_roughness().base_color_factor(), texture.cloned());
        };
        self.leave_out(
            format!("specular and glossiness of material '{shown}' (KHR_materials_pbrSpecularGlossiness)"),
            1,
            "colour and opacity are its diffuse ones",
        );
        let factor = list(other, "diffuseFactor");
        let base = std::array::from_fn(|k| factor.get(k).and_then(Value::as_f64).unwrap_or(1.0) as f32);
        (base, other.get("diffuseTexture").cloned())
    }

    /// Names what of a material is glass: `alpha` does not say how much of it is seen through.
    fn name_glass(&mut self, json: &Value, shown: &str, alpha: f32) {
        for glass in OF_GLASS {
            if let Some(value) = extension(json, glass) {
                let factor = value
                    .get("transmissionFactor")
                    .or(value.get("diffuseTransmissionFactor"));
                let factor = factor
                    .and_then(Value::as_f64)
                    .map_or(String::new(), |f| format!(" {f}"));
                let remedy = format!(
                    "alpha stays {}; set it in the scene file: materials.'{shown}'.alpha = 0.3, or alpha of the whole \
                        mesh",
                    alpha
                );
                self.leave_out(format!("{glass}{factor} of material '{shown}'"), 1, &remedy);
            }
        }
    }

    /// Linear colour and opacity of the corners from `COLOR_0`, none where the primitive has none. `material` is the
    /// name to show, and whether an opacity below 1 is ignored and must be named.
    fn vertex_colors(
        &mut self,
        place: &str,
        primitive: &gltf::Primitive<'_>,
        corners: &[u32],
        vertices: usize,
        (shown, ignored): (&str, bool),
    ) -> Result<Vec<[f32; 4]>, SceneError> {
        let Some(colors) = self.attribute(place, primitive, &Semantic::Colors(0), "COLOR_0", vertices)? else {
            return Ok(Vec::new());
        };
        if !(3..=4).contains(&colors.width) {
            return Err(self.wrong(place, "COLOR_0 must hold three or four numbers a vertex"));
        }
        let faint = match colors.width {
            4 => colors.values.chunks_exact(4).filter(|row| row[3] < 1.0).count(),
            _ => 0,
        };
        if ignored && faint > 0 {
            self.leave_out(
                format!("alpha of COLOR_0 under material '{shown}'"),
                faint,
                UNDER_OPAQUE,
            );
        }
        let row = |i: u32| {
            let row = &colors.values[i as usize * colors.width..][..colors.width];
            let alpha = if primitive.material().alpha_mode() == AlphaMode::Opaque {
                1.0
            } else {
                row.get(3).copied().unwrap_or(1.0)
            };
            [row[0].max(0.0), row[1].max(0.0), row[2].max(0.0), alpha.clamp(0.0, 1.0)]
        };
        let rgba: Vec<[f32; 4]> = corners.iter().map(|&i| row(i)).collect();
        if rgba.iter().flatten().any(|x| !x.is_finite()) {
            return Err(self.wrong(place, "COLOR_0 holds a number that is not finite"));
        }
        Ok(rgba)
    }

    /// A texture by what a material says of it, and the coordinates of the primitive's vertices in it.
    fn texture(
        &mut self,
        info: &Value,
        vertices: usize,
        place: &str,
        primitive: &gltf::Primitive<'_>,
    ) -> Result<(Texture, Vec<f32>), SceneError> {
        let number = |v: Option<&Value>| v.and_then(Value::as_u64).and_then(|v| usize::try_from(v).ok());
        let document = Arc::clone(&self.document);
        let index = number(info.get("index")).unwrap_or(usize::MAX);
        let Some(texture) = document.textures().nth(index) else {
            return Err(self.wrong(
                place,
                format!("its material names texture {index} of {}", document.textures().len()),
            ));
        };
        let Some(source) = texture.source() else {
            let kind = list(&self.json, "textures")[index]
                .get("extensions")
                .and_then(Value::as_object);
            let kinds: Vec<&str> = kind.into_iter().flat_map(|o| o.keys().map(String::as_str)).collect();
            let reason = format!(
                "its image is of a kind that is not supported ({}): export textures as PNG or JPEG",
                if kinds.is_empty() {
                    "it names none".to_owned()
                } else {
                    kinds.join(", ")
                }
            );
            return Err(self.wrong(&format!("textures[{index}]"), reason));
        };
        let image = self.image(&source)?;
        let mut found = Texture::new(image);
        let wrap = |w: gltf::texture::WrappingMode| match w {
            gltf::texture::WrappingMode::ClampToEdge => Wrap::Clamp,
            gltf::texture::WrappingMode::MirroredRepeat => Wrap::Mirror,
            gltf::texture::WrappingMode::Repeat => Wrap::Repeat,
        };
        let sampler = texture.sampler();
        found.wrap = [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())];
        found.nearest = sampler.mag_filter() == Some(gltf::texture::MagFilter::Nearest);
        let mut set = number(info.get("texCoord")).unwrap_or(0);
        if let Some(transform) = extension(info, "KHR_texture_transform") {
            found.transform = transform_of(transform);
            set = number(transform.get("texCoord")).unwrap_or(set);
        }
        let name = format!("TEXCOORD_{set}");
        let set = u32::try_from(set).unwrap_or(u32::MAX);
        let coordinates = self.attribute(place, primitive, &Semantic::TexCoords(set), &name, vertices)?;
        match coordinates {
            Some(rows) if rows.width == 2 => Ok((found, rows.values)),
            Some(_) => Err(self.wrong(place, format!("{name} must hold two numbers a vertex"))),
            None => Err(self.wrong(
                place,
                format!("its material has a texture, and there is no {name} to place it by"),
            )),
        }
    }

    fn image(&mut self, image: &gltf::Image<'_>) -> Result<Arc<Image>, SceneError> {
        if let Some(known) = self.images.get(&image.index()) {
            return Ok(Arc::clone(known));
        }
        let place = format!("images[{}]", image.index());
        let bytes = match image.source() {
            gltf::image::Source::Uri { uri, .. } => external(self.path, &place, uri)?,
            gltf::image::Source::View { view, .. } => self.view(&view, &place)?.to_vec(),
        };
        let decoded = Arc::new(Image::decode(self.path, &place, &bytes)?);
        self.images.insert(image.index(), Arc::clone(&decoded));
        Ok(decoded)
    }

    /// Whether the file gives an accessor a buffer view.
    fn has_view(&self, accessor: &gltf::Accessor<'_>) -> bool {
        let json = list(&self.json, "accessors").get(accessor.index());
        json.is_some_and(|a| a.get("bufferView").is_some())
    }

    /// The bytes of a buffer view.
    fn view(&self, view: &gltf::buffer::View<'_>, place: &str) -> Result<&[u8], SceneError> {
        let json = &list(&self.json, "bufferViews")[view.index()];
        let data = &self.buffers[view.buffer().index()];
        let compressed = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
        if data.is_empty()
            && let Some(name) = compressed.iter().find(|name| extension(json, name).is_some())
        {
            let reason = format!("its data is compressed ({name}), which is not supported: export the mesh without it");
            return Err(self.wrong(place, reason));
        }
        view.offset()
            .checked_add(view.length())
            .and_then(|end| data.get(view.offset()..end))
            .ok_or_else(|| self.wrong(place, "it reaches beyond the end of its buffer view or buffer"))
    }

    /// All numbers of an accessor, sparse ones put in their places, zeros where there is no buffer view.
    fn rows(&self, accessor: &gltf::Accessor<'_>) -> Result<Rows, SceneError> {
        let place = format!("accessors[{}]", accessor.index());
        let (width, count, kind) = (
            accessor.dimensions().multiplicity(),
            accessor.count(),
            accessor.data_type(),
        );
        let size = accessor.size();
        let mut bytes = match accessor.view().filter(|_| self.has_view(accessor)) {
            Some(view) => {
                let data = self.view(&view, &place)?;
                let stride = view.stride().unwrap_or(size);
                packed(data, accessor.offset(), stride, size, count)
                    .ok_or_else(|| self.wrong(&place, "it reaches beyond the end of its buffer view or buffer"))?
            }
            None => {
                // The declared number is believed only as far as the sparse entries reach.
                let believable = accessor.sparse().is_some() && count <= MAX_TRIANGLES;
                if !believable {
                    return Err(self.wrong(
                        &place,
                        "it has no buffer view, so that all its numbers are 0: there is nothing to draw",
                    ));
                }
                vec![0; count * size]
            }
        };
        if let Some(sparse) = accessor.sparse() {
            self.put_sparse(&place, &sparse, size, &mut bytes)?;
        }
        Ok(numbers_of(&bytes, width, kind, accessor.normalized()))
    }

    /// Puts the entries of a sparse accessor in their places among rows of `size` bytes.
    fn put_sparse(
        &self,
        place: &str,
        sparse: &gltf::accessor::sparse::Sparse<'_>,
        size: usize,
        bytes: &mut [u8],
    ) -> Result<(), SceneError> {
        let count = bytes.len() / size;
        let (entries, indices, values) = (sparse.count(), sparse.indices(), sparse.values());
        let index_size = match indices.index_type() {
            gltf::accessor::sparse::IndexType::U8 => 1,
            gltf::accessor::sparse::IndexType::U16 => 2,
            gltf::accessor::sparse::IndexType::U32 => 4,
        };
        let beyond = || self.wrong(place, "its sparse entries reach beyond the end of their buffer view");
        let index = packed(
            self.view(&indices.view(), place)?,
            indices.offset(),
            index_size,
            index_size,
            entries,
        )
        .ok_or_else(beyond)?;
        let value =
            packed(self.view(&values.view(), place)?, values.offset(), size, size, entries).ok_or_else(beyond)?;
        for (i, v) in index.chunks_exact(index_size).zip(value.chunks_exact(size)) {
            let mut whole = [0; 4];
            whole[..index_size].copy_from_slice(i);
            let at = u32::from_le_bytes(whole) as usize;
            let Some(target) = bytes.get_mut(at.saturating_mul(size)..at.saturating_mul(size).saturating_add(size))
            else {
                return Err(self.wrong(place, format!("a sparse entry names row {at} of {count}")));
            };
            target.copy_from_slice(v);
        }
        Ok(())
    }
}

/// Numbers of an accessor from their bytes, those that stand for shares of one scaled.
fn numbers_of(bytes: &[u8], width: usize, kind: DataType, normalized: bool) -> Rows {
    let scaled = |x: f32, most: f32| if normalized { (x / most).max(-1.0) } else { x };
    let mut rows = Rows {
        width,
        values: Vec::new(),
        whole: Vec::new(),
    };
    match kind {
        DataType::U8 if width == 1 => rows.whole = bytes.iter().map(|&b| b.into()).collect(),
        DataType::U16 if width == 1 => {
            rows.whole = bytes
                .chunks_exact(2)
                .map(|b| u16::from_le_bytes([b[0], b[1]]).into())
                .collect();
        }
        DataType::U32 => {
            rows.whole = bytes
                .chunks_exact(4)
                .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .collect();
        }
        DataType::I8 => rows.values = bytes.iter().map(|&b| scaled(f32::from(b as i8), 127.0)).collect(),
        DataType::U8 => rows.values = bytes.iter().map(|&b| scaled(f32::from(b), 255.0)).collect(),
        DataType::I16 => {
            let all = bytes.chunks_exact(2).map(|b| i16::from_le_bytes([b[0], b[1]]));
            rows.values = all.map(|x| scaled(f32::from(x), 32767.0)).collect();
        }
        DataType::U16 => {
            let all = bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]]));
            rows.values = all.map(|x| scaled(f32::from(x), 65535.0)).collect();
        }
        DataType::F32 => {
            rows.values = bytes
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .collect();
        }
    }
    rows
}

/// `count` pieces of `size` bytes, `stride` apart, one after the other; none where they reach beyond the end.
fn packed(data: &[u8], offset: usize, stride: usize, size: usize, count: usize) -> Option<Vec<u8>> {
    let data = data.get(offset..)?;
    let needed = match count.checked_sub(1) {
        None => 0,
        Some(n) => n.checked_mul(stride)?.checked_add(size)?,
    };
    if stride < size || needed > data.len() {
        return None;
    }
    let mut out = Vec::with_capacity(count * size);
    (0..count).for_each(|i| out.extend_from_slice(&data[i * stride..i * stride + size]));
    Some(out)
}

/// The matrix of KHR_texture_transform: scaled, then turned, then moved.
fn transform_of(value: &Value) -> [[f32; 3]; 2] {
    let pair = |name: &str, otherwise: f64| {
        let found = list(value, name);
        [0, 1].map(|k| found.get(k).and_then(Value::as_f64).unwrap_or(otherwise))
    };
    let ([sx, sy], [ox, oy]) = (pair("scale", 1.0), pair("offset", 0.0));
    let angle = value.get("rotation").and_then(Value::as_f64).unwrap_or(0.0);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let rows = [[cos * sx, sin * sy, ox], [-sin * sx, cos * sy, oy]];
    if rows.iter().flatten().all(|x| x.is_finite()) {
        rows.map(|row| row.map(|x| x as f32))
    } else {
        UNMOVED
    }
}
