//! OBJ meshes and their material libraries.

use super::{Overrides, Part, polygon, position, rgba, text};
use crate::numeric::file::read as read_file;
use crate::pixel::left_out::{LeftOut, note};
use crate::scene::SceneError;
use crate::scene::texture::{Channel, Image, Texture, TexturedMaterial, UNMOVED, Wrap};
use earcut::Earcut;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Colour where a file names none.
const GREY: [f32; 3] = [0.8, 0.8, 0.8];

/// Statements of OBJ that say how shapes are grouped, smoothed or displayed, and nothing about what they are.
const WITHOUT_SHAPE: [&str; 15] = [
    "g",
    "s",
    "o",
    "mg",
    "vp",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "usemap",
    "maplib",
];

/// Statements of MTL that say how a surface is lit, which all surfaces here are in one way.
const OF_LIGHTING: [&str; 25] = [
    "Ka",
    "Ks",
    "Ns",
    "Ni",
    "sharpness",
    "illum",
    "map_Ka",
    "map_Ks",
    "map_Ns",
    "map_bump",
    "map_Bump",
    "bump",
    "norm",
    "map_Kn",
    "disp",
    "refl",
    "map_refl",
    "Pr",
    "Pm",
    "Ps",
    "Pc",
    "Pcr",
    "aniso",
    "anisor",
    "decal",
];

/// Where the lines of a file are, for messages.
struct Source<'a> {
    path: &'a Path,
    left_out: &'a mut Vec<LeftOut>,
}

impl Source<'_> {
    fn wrong(&self, line: usize, reason: impl Into<String>) -> SceneError {
        SceneError::file_content(self.path, &format!("line {line}"), reason)
    }

    fn leave_out(&mut self, what: impl Into<String>, remedy: &str) {
        note(
            self.left_out,
            LeftOut::new(what, self.path.display().to_string(), 1, remedy),
        );
    }
}

/// Lines with their numbers, comments dropped, those that end in a backslash joined with the next.
fn lines(text: &str) -> Vec<(usize, Cow<'_, str>)> {
    let mut out: Vec<(usize, Cow<'_, str>)> = Vec::new();
    let mut open = false;
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        let (line, goes_on) = match line.strip_suffix('\\') {
            Some(line) if !line.starts_with('#') => (line, true),
            _ => (line, false),
        };
        match out.last_mut().filter(|_| open) {
            Some((_, whole)) => *whole = format!("{whole} {line}").into(),
            None if line.is_empty() && !goes_on || line.starts_with('#') => {}
            None => out.push((i + 1, line.into())),
        }
        open = goes_on;
    }
    out
}

/// The first word of a line and all that follows it.
fn statement(line: &str) -> (&str, &str) {
    let line = line.trim();
    line.split_once(char::is_whitespace)
        .map_or((line, ""), |(word, rest)| (word, rest.trim()))
}

fn numbers(rest: &str) -> Option<Vec<f32>> {
    rest.split_whitespace()
        .map(|w| w.parse::<f32>().ok().filter(|x| x.is_finite()))
        .collect()
}

/// A material of a library.
#[derive(Debug, Clone, Default)]
struct Material {
    color: Option<[f32; 3]>,
    dissolve: Option<f32>,
    transparency: Option<f32>,
    color_map: Option<(usize, String)>,
    opacity_map: Option<(usize, String)>,
    library: PathBuf,
}

impl Material {
    fn alpha(&self) -> f32 {
        self.dissolve.or(self.transparency.map(|t| 1.0 - t)).unwrap_or(1.0)
    }

    /// Takes in a statement of the library under the material's name.
    fn read(
        &mut self,
        source: &mut Source<'_>,
        name: &str,
        number: usize,
        word: &str,
        rest: &str,
    ) -> Result<(), SceneError> {
        let path = source.path;
        let one = |rest: &str| {
            rest.parse::<f32>().ok().filter(|x| x.is_finite()).ok_or_else(|| {
                SceneError::file_content(
                    path,
                    &format!("line {number}"),
                    format!("{word} '{rest}': a number is expected"),
                )
            })
        };
        match word {
            "Kd" => {
                self.color = match numbers(rest).as_deref() {
                    Some([grey]) => Some([*grey; 3]),
                    Some([r, g, b, ..]) => Some([*r, *g, *b]),
                    _ => {
                        let reason = format!(
                            "Kd '{rest}': one or three numbers are expected; spectral and xyz colours are not supported"
                        );
                        return Err(source.wrong(number, reason));
                    }
                }
            }
            "d" => match rest.strip_prefix("-halo").map(str::trim) {
                Some(rest) => {
                    self.dissolve = Some(one(rest)?);
                    let remedy = "opacity is that of a surface seen face on, at every angle";
                    source.leave_out(format!("the halo of d -halo in material '{name}'"), remedy);
                }
                None => self.dissolve = Some(one(rest)?),
            },
            "Tr" => self.transparency = Some(one(rest)?),
            "map_Kd" => self.color_map = Some((number, rest.to_owned())),
            "map_d" => self.opacity_map = Some((number, rest.to_owned())),
            "Tf" => {
                if numbers(rest).is_none_or(|v| v.iter().any(|x| *x != 1.0)) {
                    let remedy = "set alpha and color of the material in the scene file";
                    source.leave_out(format!("the transmission filter Tf of material '{name}'"), remedy);
                }
            }
            "Ke" | "map_Ke" => {
                if word == "map_Ke" || numbers(rest).is_none_or(|v| v.iter().any(|x| *x != 0.0)) {
                    source.leave_out(
                        format!("emission ({word}) of material '{name}'"),
                        "surfaces are matt and lit",
                    );
                }
            }
            _ if OF_LIGHTING.contains(&word) => {
                if word == "illum" && ["4", "6", "7", "9"].contains(&rest) {
                    let remedy = format!(
                        "it means glass, and opacity is that of d and Tr alone; set materials.'{name}'.alpha in the \
                            scene file if it is not meant"
                    );
                    source.leave_out(format!("illum {rest} of material '{name}'"), &remedy);
                }
            }
            _ => source.leave_out(format!("'{word}' of material '{name}'"), "nothing here depends on it"),
        }
        Ok(())
    }
}

/// Reads a library into `materials`; a name that is there already stays as it was.
fn library(
    path: &Path,
    materials: &mut HashMap<String, Material>,
    left_out: &mut Vec<LeftOut>,
) -> Result<(), SceneError> {
    let content = text(&read_file(path)?);
    let mut source = Source { path, left_out };
    let mut current: Option<String> = None;
    let mut own: HashMap<String, Material> = HashMap::new();
    for (number, line) in lines(&content) {
        let (word, rest) = statement(&line);
        if word == "newmtl" {
            current = Some(rest.to_owned());
            let fresh = Material {
                library: path.to_owned(),
                ..Material::default()
            };
            if own.insert(rest.to_owned(), fresh).is_some() {
                source.leave_out(
                    format!("an earlier material '{rest}'"),
                    "the last of a name counts; rename one of them",
                );
            }
            continue;
        }
        let Some(name) = &current else {
            if !OF_LIGHTING.contains(&word) {
                source.leave_out(format!("'{word}' before the first newmtl"), "it belongs to no material");
            }
            continue;
        };
        let material = own.get_mut(name).expect("it was put there");
        material.read(&mut source, name, number, word, rest)?;
    }
    for (name, material) in own {
        if let (Some(d), Some(t)) = (material.dissolve, material.transparency)
            && (d - (1.0 - t)).abs() > 1e-3
        {
            source.leave_out(
                format!("Tr {t} of material '{name}', which contradicts its d {d}"),
                "d counts; set alpha in the scene file if it is wrong",
            );
        }
        materials.entry(name).or_insert(material);
    }
    Ok(())
}

/// A file that another names: as it is written, with the slashes of this system, and by its last part beside the one
/// that names it.
fn beside(folder: &Path, name: &str) -> Result<PathBuf, Vec<PathBuf>> {
    let name = name.trim().trim_matches('"');
    let slashes = name.replace('\\', "/");
    let last = slashes.rsplit('/').next().unwrap_or(&slashes).to_owned();
    let mut tried = Vec::new();
    for candidate in [name.to_owned(), slashes, last] {
        let path = folder.join(candidate.strip_prefix("./").unwrap_or(&candidate));
        if path.is_file() {
            return Ok(path);
        }
        if !tried.contains(&path) {
            tried.push(path);
        }
    }
    Err(tried)
}

fn listed(paths: &[PathBuf]) -> String {
    paths
        .iter()
        .map(|p| p.display().to_string())
        .collect::<Vec<_>>()
        .join(", ")
}

/// The files that a mtllib line names: one whose name may hold spaces, or several; quotes hold a name together.
fn library_files(folder: &Path, rest: &str) -> Result<Vec<PathBuf>, Vec<PathBuf>> {
    let whole = beside(folder, rest);
    if whole.is_ok() {
        return whole.map(|path| vec![path]);
    }
    let mut names: Vec<String> = Vec::new();
    let (mut quoted, mut fresh) = (false, true);
    for c in rest.chars() {
        match c {
            '"' => quoted = !quoted,
            c if c.is_whitespace() && !quoted => fresh = true,
            c => {
                if std::mem::take(&mut fresh) {
                    names.push(String::new());
                }
                if let Some(name) = names.last_mut() {
                    name.push(c);
                }
            }
        }
    }
    if names.len() < 2 {
        return whole.map(|path| vec![path]);
    }
    names.iter().map(|name| beside(folder, name)).collect()
}

/// A texture's file name behind its options, and those options that matter.
struct MapOptions<'a> {
    file: &'a str,
    transform: [[f32; 3]; 2],
    clamp: bool,
    channel: Option<Channel>,
    /// Options that change values and are not followed.
    unknown: Vec<&'a str>,
}

fn map_options(rest: &str) -> MapOptions<'_> {
    let mut out = MapOptions {
        file: rest,
        transform: UNMOVED,
        clamp: false,
        channel: None,
        unknown: Vec::new(),
    };
    /// The first word, and what follows it.
    fn word(text: &str) -> (&str, &str) {
        let text = text.trim_start();
        text.split_at(text.find(char::is_whitespace).unwrap_or(text.len()))
    }
    while let (option, mut after) = word(out.file)
        && option.starts_with('-')
        && option.len() > 1
    {
        let most = match option {
            "-o" | "-s" | "-t" => 3,
            "-mm" => 2,
            _ => 1,
        };
        let mut values = Vec::new();
        while values.len() < most {
            let (value, rest) = word(after);
            // Up to three numbers may follow; a file's name is none.
            if value.is_empty() || (most > 1 && value.parse::<f32>().is_err()) {
                break;
            }
            values.push(value);
            after = rest;
        }
        let number = |k: usize, otherwise: f32| values.get(k).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
        match option {
            "-o" => (0..2).for_each(|k| out.transform[k][2] = number(k, 0.0)),
            "-s" => (0..2).for_each(|k| out.transform[k][k] = number(k, 1.0)),
            "-clamp" => out.clamp = values == ["on"],
            "-imfchan" => {
                out.channel = match values[..] {
                    ["r"] => Some(Channel::One(0)),
                    ["g"] => Some(Channel::One(1)),
                    ["b"] => Some(Channel::One(2)),
                    ["m"] => Some(Channel::One(3)),
                    _ => Some(Channel::Luminance),
                }
            }
            "-mm" | "-t" | "-cc" => out.unknown.push(option),
            _ => {}
        }
        out.file = after;
    }
    out.file = out.file.trim().trim_matches('"');
    out
}

/// A texture that a material names.
fn texture(
    material: &Material,
    name: &str,
    (line, rest): &(usize, String),
    images: &mut HashMap<PathBuf, Arc<Image>>,
    left_out: &mut Vec<LeftOut>,
) -> Result<(Texture, Option<Channel>), SceneError> {
    let options = map_options(rest);
    let place = format!("line {line}, material '{name}'");
    let path = beside(material.library.parent().unwrap_or(Path::new(".")), options.file).map_err(|tried| {
        let reason = format!(
            "the texture '{}' is not there; looked for {}",
            options.file,
            listed(&tried)
        );
        SceneError::file_content(&material.library, &place, reason)
    })?;
    let image = match images.get(&path) {
        Some(image) => Arc::clone(image),
        None => {
            let decoded = Arc::new(Image::decode(&path, "image", &read_file(&path)?)?);
            images.insert(path, Arc::clone(&decoded));
            decoded
        }
    };
    for option in options.unknown {
        let what = format!("the texture option {option} of material '{name}'");
        let library = material.library.display().to_string();
        note(
            left_out,
            LeftOut::new(what, library, 1, "the texture is read as if it were not there"),
        );
    }
    let mut texture = Texture::new(image);
    // v runs upwards in OBJ: what is scaled and moved upwards is so downwards by the negative.
    let [u, v] = options.transform;
    texture.transform = [u, [0.0, v[1], 1.0 - v[1] - v[2]]];
    if options.clamp {
        texture.wrap = [Wrap::Clamp; 2];
    }
    Ok((texture, options.channel))
}

/// A corner of a face: its vertex and its texture coordinates.
type Corner = (usize, Option<usize>);

/// How many there are of what a face may name.
#[derive(Debug, Clone, Copy)]
struct SoFar {
    vertices: usize,
    coordinates: usize,
    normals: usize,
}

/// The corners of a face; indices count from 1, or backwards from the last that is there.
fn corners(source: &Source<'_>, line: usize, rest: &str, so_far: SoFar) -> Result<Vec<Corner>, SceneError> {
    let index = |text: &str, n: usize, what: &str| -> Result<usize, SceneError> {
        let wrong = || {
            source.wrong(
                line,
                format!("index {text} is out of bounds: there are {n} {what} so far"),
            )
        };
        let i: i64 = text
            .parse()
            .map_err(|_| source.wrong(line, format!("'{text}' is no index")))?;
        let place = match i {
            0 => return Err(source.wrong(line, "index 0; indices count from 1")),
            1.. => i - 1,
            _ => i.checked_add(n as i64).ok_or_else(wrong)?,
        };
        usize::try_from(place).ok().filter(|p| *p < n).ok_or_else(wrong)
    };
    let corners: Vec<Corner> = rest
        .split_whitespace()
        .map(|word| {
            let mut parts = word.split('/');
            let vertex = index(parts.next().unwrap_or(""), so_far.vertices, "vertices")?;
            let mut optional = |n: usize, what: &str| match parts.next() {
                None | Some("") => Ok(None),
                Some(text) => index(text, n, what).map(Some),
            };
            let coordinate = optional(so_far.coordinates, "texture coordinates")?;
            optional(so_far.normals, "normals")?;
            Ok((vertex, coordinate))
        })
        .collect::<Result<_, SceneError>>()?;
    if corners.len() < 3 {
        return Err(source.wrong(line, format!("a face of {} corners; three are needed", corners.len())));
    }
    Ok(corners)
}

/// Triangles of one material as they are collected.
#[derive(Default)]
struct Group {
    corners: Vec<[f32; 3]>,
    uv: Vec<[f32; 2]>,
    /// Corners without texture coordinates.
    bare: bool,
    /// Line of the first face.
    line: usize,
}

/// Reads an OBJ mesh and the libraries that it names.
///
/// # Errors
/// [`SceneError`] names the file, the line, and what is wrong there.
pub(super) fn read(path: &Path, scene: &dyn Overrides, left_out: &mut Vec<LeftOut>) -> Result<Vec<Part>, SceneError> {
    let content = text(&read_file(path)?);
    let mut mesh = Mesh::default();
    let mut source = Source { path, left_out };
    for (number, line) in lines(&content) {
        let (word, rest) = statement(&line);
        mesh.take(&mut source, number, word, rest)?;
    }
    let mut images = HashMap::new();
    let groups = std::mem::take(&mut mesh.groups);
    let mut parts = Vec::with_capacity(groups.len());
    for (name, group) in groups {
        let known = mesh.material(&source, name.as_deref(), group.line, scene)?;
        parts.push(part(name, group, known, scene, &mut images, source.left_out)?);
    }
    Ok(parts)
}

/// What has been read of a mesh.
#[derive(Default)]
struct Mesh {
    vertices: Vec<[f32; 3]>,
    coordinates: Vec<[f32; 2]>,
    normals: usize,
    /// Faces by material, in the order in which materials were first used.
    groups: Vec<(Option<String>, Group)>,
    places: HashMap<Option<String>, usize>,
    /// The material of the faces to come, and the line that names it.
    current: (Option<String>, usize),
    materials: HashMap<String, Material>,
    libraries: Vec<PathBuf>,
    /// Libraries that are not there: the line, and where they were looked for.
    missing: Vec<(usize, Vec<PathBuf>)>,
    cutter: Earcut<f64>,
}

impl Mesh {
    /// Takes in a statement.
    fn take(&mut self, source: &mut Source<'_>, number: usize, word: &str, rest: &str) -> Result<(), SceneError> {
        match word {
            "v" => self.vertex(source, number, rest)?,
            "vt" => {
                let values = numbers(rest).filter(|v| !v.is_empty());
                let values =
                    values.ok_or_else(|| source.wrong(number, format!("vt '{rest}': numbers are expected")))?;
                let v = values.get(1).copied().unwrap_or(0.0);
                self.coordinates.push([values[0], 1.0 - v]);
            }
            "vn" => self.normals += 1,
            "f" | "fo" => self.face(source, number, rest)?,
            "usemtl" => self.current = (Some(rest.to_owned()), number),
            "mtllib" => match library_files(source.path.parent().unwrap_or(Path::new(".")), rest) {
                Ok(files) => {
                    for file in files {
                        library(&file, &mut self.materials, source.left_out)?;
                        self.libraries.push(file);
                    }
                }
                Err(tried) => self.missing.push((number, tried)),
            },
            "l" | "p" => {
                // Indices out of bounds are damage, whether the shape is drawn or not.
                if let Some(index) = rest
                    .split_whitespace()
                    .flat_map(|w| w.split('/'))
                    .find(|i| i.parse::<i64>().is_ok_and(|i| i32::try_from(i).is_err()))
                {
                    return Err(source.wrong(number, format!("index {index} is out of bounds")));
                }
                let what = if word == "l" { "lines" } else { "points" };
                source.leave_out(what, "only faces are drawn; give them a width as triangles");
            }
            _ if WITHOUT_SHAPE.contains(&word) => {}
            _ => source.leave_out(
                format!("statements '{word}'"),
                "only polygons are read; export the shape as a mesh",
            ),
        }
        Ok(())
    }

    fn vertex(&mut self, source: &mut Source<'_>, number: usize, rest: &str) -> Result<(), SceneError> {
        let place = || format!("vertex {} (line {number})", self.vertices.len() + 1);
        let values = numbers(rest).filter(|v| v.len() >= 3).ok_or_else(|| {
            let reason = format!("'{rest}': three coordinates are expected, each a finite number");
            SceneError::file_content(source.path, &place(), reason)
        })?;
        if values.len() > 4 {
            source.leave_out("colours of vertices", "give the material a colour, or export glTF");
        }
        let p = position(source.path, place, [values[0], values[1], values[2]])?;
        self.vertices.push(p);
        Ok(())
    }

    fn face(&mut self, source: &Source<'_>, number: usize, rest: &str) -> Result<(), SceneError> {
        let so_far = SoFar {
            vertices: self.vertices.len(),
            coordinates: self.coordinates.len(),
            normals: self.normals,
        };
        let face = corners(source, number, rest, so_far)?;
        let points: Vec<_> = face.iter().map(|c| self.vertices[c.0].map(f64::from)).collect();
        let (material, line_of_material) = &self.current;
        let place = *self.places.entry(material.clone()).or_insert_with(|| {
            self.groups.push((material.clone(), Group::default()));
            self.groups.len() - 1
        });
        let group = &mut self.groups[place].1;
        if group.line == 0 {
            group.line = if material.is_some() { *line_of_material } else { number };
        }
        for i in polygon::triangles(&points, &mut self.cutter).into_iter().flatten() {
            let (vertex, coordinate) = face[i as usize];
            group.corners.push(self.vertices[vertex]);
            group.uv.push(coordinate.map_or([0.0; 2], |c| self.coordinates[c]));
            group.bare |= coordinate.is_none();
        }
        Ok(())
    }

    /// The material of a name that faces use first in this line; none where they have none, or the scene file says all
    /// of it.
    fn material(
        &self,
        source: &Source<'_>,
        name: Option<&str>,
        line: usize,
        scene: &dyn Overrides,
    ) -> Result<Option<&Material>, SceneError> {
        let known = name.and_then(|n| self.materials.get(n));
        if known.is_some() || (scene.gives_alpha(name) && scene.gives_color(name)) {
            return Ok(known);
        }
        if let Some((line, tried)) = self.missing.first() {
            let reason = format!(
                "the material library is not there; looked for {}; put it there, or give the mesh both color and \
                    alpha in the scene file",
                listed(tried)
            );
            return Err(source.wrong(*line, reason));
        }
        let nameless = name.is_none_or(|n| ["", "None", "(null)"].contains(&n));
        if nameless {
            return Ok(None);
        }
        let mut names: Vec<&str> = self.materials.keys().map(String::as_str).collect();
        names.sort_unstable();
        let reason = format!(
            "there is no material '{}'; {} {}; correct the name, or give the mesh both color and alpha in the scene \
                file",
            name.unwrap_or(""),
            if self.libraries.is_empty() {
                "no mtllib line names a library".to_owned()
            } else {
                listed(&self.libraries)
            },
            if names.is_empty() {
                "with materials".to_owned()
            } else {
                format!("holds {}", names.join(", "))
            },
        );
        Err(source.wrong(line, reason))
    }
}

/// The textures of a material that the scene file does not replace.
fn textures(
    material: &Material,
    name: &str,
    scene: &dyn Overrides,
    images: &mut HashMap<PathBuf, Arc<Image>>,
    left_out: &mut Vec<LeftOut>,
) -> Result<TexturedMaterial, SceneError> {
    let library = material.library.display().to_string();
    let mut textures = TexturedMaterial {
        color_counts: true,
        ..TexturedMaterial::default()
    };
    if let Some(map) = material.color_map.as_ref().filter(|_| !scene.gives_color(Some(name))) {
        match texture(material, name, map, images, left_out) {
            Ok((texture, _)) => {
                if texture.image.has_alpha() && material.opacity_map.is_none() && !scene.gives_alpha(Some(name)) {
                    let remedy =
                        "MTL takes opacity from map_d: name the same file there, or set alpha in the scene file";
                    note(
                        left_out,
                        LeftOut::new(format!("alpha of the map_Kd of material '{name}'"), &library, 1, remedy),
                    );
                }
                textures.color = Some(texture);
            }
            // Opacity does not hang on it.
            Err(error) => {
                let remedy = format!("its colour is Kd alone ({error})");
                note(
                    left_out,
                    LeftOut::new(format!("the texture of material '{name}'"), &library, 1, remedy),
                );
            }
        }
    }
    if let Some(map) = material.opacity_map.as_ref().filter(|_| !scene.gives_alpha(Some(name))) {
        let (texture, channel) = texture(material, name, map, images, left_out)?;
        let usual = if texture.image.has_alpha() {
            Channel::One(3)
        } else {
            Channel::Luminance
        };
        textures.opacity = Some((texture, channel.unwrap_or(usual)));
    }
    Ok(textures)
}

/// Triangles of one material with what it says of colour and opacity.
fn part(
    name: Option<String>,
    group: Group,
    material: Option<&Material>,
    scene: &dyn Overrides,
    images: &mut HashMap<PathBuf, Arc<Image>>,
    left_out: &mut Vec<LeftOut>,
) -> Result<Part, SceneError> {
    let mut part = Part {
        corners: group.corners,
        rgba: [GREY[0], GREY[1], GREY[2], 1.0],
        ..Part::default()
    };
    let (Some(material), Some(name)) = (material, &name) else {
        // A material that the scene file gives alone is still known by its name.
        part.material = name;
        return Ok(part);
    };
    let library = material.library.display().to_string();
    let [r, g, b] = material
        .color
        .unwrap_or(if material.color_map.is_some() { [1.0; 3] } else { GREY });
    part.rgba = rgba(&material.library, name, [r, g, b, material.alpha()])?;
    let textures = textures(material, name, scene, images, left_out)?;
    if textures.color.is_some() || textures.opacity.is_some() {
        if group.bare {
            if textures.opacity.is_some() {
                let reason = "its faces have no texture coordinates (vt), which map_d needs; add them, or set alpha in \
                    the scene file";
                return Err(SceneError::file_content(
                    &material.library,
                    &format!("material '{name}'"),
                    reason,
                ));
            }
            let remedy = "its faces have no texture coordinates (vt)";
            note(
                left_out,
                LeftOut::new(format!("the texture of material '{name}'"), &library, 1, remedy),
            );
        } else {
            part.uv = group.uv;
            part.textures = Some(textures);
        }
    }
    part.material = Some(name.clone());
    Ok(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn continued_lines_are_one_and_comments_end_where_they_do() {
        let text = "# a \\\nv 1 2 \\\n 3\n\nf 1 2 \\\r\n3\\\n 4\n#x\n";
        let found = lines(text);
        assert_eq!(found, [(2, "v 1 2  3".into()), (5, "f 1 2  3 4".into())]);
    }

    #[test]
    fn options_before_a_texture_are_told_from_its_name() {
        let options = map_options("-blendu on -s 2 3 -o 0.5 -mm 0 2 -imfchan m -clamp on my leaf.png");
        assert_eq!(options.file, "my leaf.png");
        assert_eq!(options.transform, [[2.0, 0.0, 0.5], [0.0, 3.0, 0.0]]);
        assert!(options.clamp && options.channel == Some(Channel::One(3)));
        assert_eq!(options.unknown, ["-mm"]);
        assert_eq!(map_options("\"a b.png\"").file, "a b.png");
        assert_eq!(map_options("-.png").file, "");
    }
}
