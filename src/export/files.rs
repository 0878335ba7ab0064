//! The files of a shader folder: include files, and the three passes as whole files for every graphics API.

use super::calls::{channels, targets};
use super::prefix::Prefix;
use super::shader::{comment, include_guard, short_header};
use super::{ExportError, Format, Target, core, encode_as, translate};
use crate::features::core::CoreSet;
use crate::features::{FeatureSet, MomentDepthKind};
use crate::model::Mlp;
use crate::numeric::file::{Replace, create_folder, may_write, write_atomically};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// A graphics API that passes are written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Api {
    /// WebGPU: WGSL.
    WebGpu,
    /// OpenGL from 4.5: GLSL 4.50.
    OpenGl450,
    /// OpenGL 4.3: GLSL 4.30.
    OpenGl430,
    /// OpenGL ES 3.1: GLSL ES 3.10.
    OpenGlEs310,
    /// OpenGL ES 3.0 and WebGL 2: GLSL ES 3.00.
    OpenGlEs300,
    /// Vulkan: GLSL 4.50 with push constants.
    Vulkan,
    /// Direct3D 11 and 12: HLSL.
    Direct3d,
    /// Metal.
    Metal,
}

impl Api {
    /// Every API.
    pub const ALL: [Self; 8] = [
        Self::WebGpu,
        Self::OpenGl450,
        Self::OpenGl430,
        Self::OpenGlEs310,
        Self::OpenGlEs300,
        Self::Vulkan,
        Self::Direct3d,
        Self::Metal,
    ];

    /// Its folder.
    pub fn folder(self) -> &'static str {
        match self {
            Self::WebGpu => "webgpu",
            Self::OpenGl450 => "opengl-450",
            Self::OpenGl430 => "opengl-430",
            Self::OpenGlEs310 => "opengl-es-310",
            Self::OpenGlEs300 => "opengl-es-300",
            Self::Vulkan => "vulkan",
            Self::Direct3d => "direct3d",
            Self::Metal => "metal",
        }
    }

    /// The include file that its passes are made of.
    fn format(self) -> Format {
        match self {
            Self::WebGpu | Self::Metal => Format::WGSL,
            Self::Direct3d => Format::HLSL,
            _ => Format::GLSL,
        }
    }

    /// Names and templates of its files.
    fn templates(self) -> Vec<(&'static str, &'static str)> {
        match self {
            Self::WebGpu | Self::Metal => vec![
                ("pass1.wgsl", include_str!("files/webgpu/pass1.wgsl")),
                ("pass2.wgsl", include_str!("files/webgpu/pass2.wgsl")),
                ("resolve.wgsl", include_str!("files/webgpu/resolve.wgsl")),
            ],
            Self::Direct3d => vec![
                ("pass1.hlsl", include_str!("files/direct3d/pass1.hlsl")),
                ("pass2.hlsl", include_str!("files/direct3d/pass2.hlsl")),
                ("resolve.hlsl", include_str!("files/direct3d/resolve.hlsl")),
            ],
            Self::Vulkan => vec![
                ("pass1.frag", include_str!("files/vulkan/pass1.frag")),
                ("pass2.frag", include_str!("files/vulkan/pass2.frag")),
                ("resolve.frag", include_str!("files/vulkan/resolve.frag")),
                ("fullscreen.vert", include_str!("files/vulkan/fullscreen.vert")),
            ],
            _ => vec![
                ("pass1.frag", include_str!("files/opengl/pass1.frag")),
                ("pass2.frag", include_str!("files/opengl/pass2.frag")),
                ("resolve.frag", include_str!("files/opengl/resolve.frag")),
                ("fullscreen.vert", include_str!("files/opengl/fullscreen.vert")),
            ],
        }
    }

    /// Whether passes of a core are written for it: it has atomics in the fragment stage.
    fn has_cores(self) -> bool {
        self != Self::OpenGlEs300
    }

    /// Names and templates of its files where a core is kept; the resolve is that of all.
    fn core_templates(self) -> Vec<(&'static str, &'static str)> {
        let (names, texts) = match self {
            Self::WebGpu | Self::Metal => (
                ["pass1.wgsl", "pass2.wgsl"],
                [
                    include_str!("files/core/webgpu/pass1.wgsl"),
                    include_str!("files/core/webgpu/pass2.wgsl"),
                ],
            ),
            Self::Direct3d => (
                ["pass1.hlsl", "pass2.hlsl"],
                [
                    include_str!("files/core/direct3d/pass1.hlsl"),
                    include_str!("files/core/direct3d/pass2.hlsl"),
                ],
            ),
            Self::Vulkan => (
                ["pass1.frag", "pass2.frag"],
                [
                    include_str!("files/core/vulkan/pass1.frag"),
                    include_str!("files/core/vulkan/pass2.frag"),
                ],
            ),
            _ => (
                ["pass1.frag", "pass2.frag"],
                [
                    include_str!("files/core/opengl/pass1.frag"),
                    include_str!("files/core/opengl/pass2.frag"),
                ],
            ),
        };
        let of_all = self.templates().into_iter().skip(2);
        names.into_iter().zip(texts).chain(of_all).collect()
    }

    /// What its version of GLSL spells in its own way.
    fn glsl(self) -> Glsl {
        let glsl = |name, version, es, locations, bindings| Glsl {
            name,
            version,
            es,
            locations,
            bindings,
        };
        match self {
            Self::OpenGl430 => glsl("OpenGL 4.3", "430", false, true, true),
            Self::OpenGlEs310 => glsl("OpenGL ES 3.1", "310 es", true, true, true),
            Self::OpenGlEs300 => glsl("OpenGL ES 3.0 and WebGL 2", "300 es", true, false, false),
            _ => glsl("OpenGL 4.5", "450", false, true, true),
        }
    }
}

/// A version of GLSL.
struct Glsl {
    name: &'static str,
    version: &'static str,
    /// Whether precisions must be said.
    es: bool,
    /// Whether inputs and uniforms have locations.
    locations: bool,
    /// Whether textures have units.
    bindings: bool,
}

/// A file of a shader folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShaderFile {
    /// Its path below the folder, with slashes.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// Every file of a network: the include files, and where its answer is a transmittance the passes of every API; of a
/// network with a core, the files of both passes ([`core::chain`]).
///
/// # Errors
/// [`ExportError`].
pub fn files(mlp: &Mlp, prefix: Option<&Prefix>) -> Result<Vec<ShaderFile>, ExportError> {
    let set = mlp.feature_set();
    let named = |text: String| prefix.map_or(text.clone(), |prefix| prefix.apply(&text));
    let mut out = Vec::new();
    for format in Target::all_of_text().map(Format::of) {
        let text = String::from_utf8(encode_as(mlp, format, prefix)?).expect("shader source is text");
        let path = format!("{}{}", mlp.name(), format.suffix());
        out.push(ShaderFile { path, text });
    }
    out.extend(core::chain_files(mlp, &core::LANGUAGES, prefix)?);
    // A core has no passes beyond the moments that fit into a vector.
    let blended = set.spec().has_blended_passes() && (set.spec().core.is_none() || core::has_chain(mlp));
    if blended {
        out.push(ShaderFile {
            path: format!("{}.unity.hlsl", mlp.name()),
            text: named(unity(mlp)),
        });
    }
    for api in Api::ALL {
        let templates = if blended {
            api.templates()
        } else if core::has_chain(mlp) && api.has_cores() {
            api.core_templates()
        } else {
            continue;
        };
        for (name, template) in templates {
            let text = named(pass(mlp, api, template)?);
            let (name, text) = match api {
                Api::Metal => {
                    let module = named(format!("nmt_{name}")).replace(".wgsl", "");
                    let metal = translate::metal_pass(&text).map_err(|reason| ExportError::Translate {
                        language: "MSL",
                        reason: format!("{module}: {reason}"),
                    })?;
                    (name.replace(".wgsl", ".metal"), metal)
                }
                _ => (name.to_owned(), text),
            };
            let path = format!("{}/{name}", api.folder());
            out.push(ShaderFile { path, text });
        }
    }
    Ok(out)
}

/// Writes every file of a network below a folder, and returns their paths.
///
/// # Errors
/// [`FileError::Exists`](crate::numeric::file::FileError::Exists) before anything is written where one of them is there
/// and may not be replaced; otherwise [`ExportError`], with no file half-written.
pub fn write(mlp: &Mlp, folder: &Path, prefix: Option<&Prefix>, replace: Replace) -> Result<Vec<PathBuf>, ExportError> {
    let files = files(mlp, prefix)?;
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(&file.path)).collect();
    paths.iter().try_for_each(|path| may_write(path, replace))?;
    for (file, path) in files.iter().zip(&paths) {
        create_folder(path.parent().unwrap_or(folder))?;
        write_atomically(path, replace, |w| w.write_all(file.text.as_bytes()))?;
    }
    Ok(paths)
}

/// A pass of an API by its template.
///
/// Of a line that begins with a word behind `%` the rest stands in the file: `%log` and `%window` where moments are of
/// such depth, `%es` where GLSL has precisions, `%webgpu` and `%metal` for these two, `%sums` once a target of sums;
/// `%include NAME ...` are functions with all that they use.
fn pass(mlp: &Mlp, api: Api, template: &str) -> Result<String, ExportError> {
    let (set, glsl) = (mlp.feature_set(), api.glsl());
    let last = targets(set);
    let mut include = String::from_utf8(encode_as(mlp, api.format(), None)?).expect("shader source is text");
    if core::has_chain(mlp) {
        // Direct3D 11 counts buffers that are written among the targets; Vulkan's and Metal's stand where pass 2 has
        // them, behind its textures and its uniforms.
        let binding = match api {
            Api::Direct3d | Api::Vulkan | Api::Metal => last as u32,
            _ => 0,
        };
        let place = core::CoreBinding { group: 3, binding };
        include += &core::calls(mlp, api.format().target(), place);
    }
    let mut text = String::new();
    for line in template.lines() {
        let (kind, rest) = match line.strip_prefix('%') {
            None => ("", line),
            Some(marked) => marked.split_once(' ').unwrap_or((marked, "")),
        };
        match kind {
            "" => text += line,
            "include" => {
                text += comment(api.format(), &short_header(mlp)).trim_end();
                text += &reachable(&include, rest);
            }
            "sums" => text += &each_target(set, rest),
            "log" if set.moment_depth() == MomentDepthKind::Log => text += rest,
            "window" if set.moment_depth() == MomentDepthKind::Window => text += rest,
            "es" if glsl.es => text += rest,
            "webgpu" if api == Api::WebGpu => text += rest,
            "metal" if api == Api::Metal => text += rest,
            _ => continue,
        }
        text.push('\n');
    }
    if let Some(core) = set.spec().core {
        text = of_core(&text, core, api.format().target());
    }
    let sums: Vec<String> = (0..last).map(|i| format!("sums.sums{i}")).collect();
    let location = |i: usize| match glsl.locations {
        true => format!("layout(location = {i}) "),
        false => String::new(),
    };
    let binding = |i: usize| match glsl.bindings {
        true => format!("layout(binding = {i}) "),
        false => String::new(),
    };
    text = text.replace("{binding{range}}", &binding(last));
    for i in 0..=last {
        text = text
            .replace(&format!("{{in{i}}}"), &location(i))
            .replace(&format!("{{uniform{i}}}"), &location(i))
            .replace(&format!("{{binding{i}}}"), &binding(i));
    }
    Ok(text
        .replace("{version}", glsl.version)
        .replace("{api}", glsl.name)
        .replace("{sums}", &sums.join(", "))
        .replace("{range}", &last.to_string()))
}

/// What passes of a core are filled in with beside what all are.
fn of_core(text: &str, set: CoreSet, language: Target) -> String {
    let all = core::ends::terms(set, language);
    let words = set.stride();
    let pair = |i: usize| match i {
        0 => "core[first]".to_owned(),
        _ => format!("core[first + {i}u]"),
    };
    let mut text = text.to_owned();
    for (i, terms) in all.iter().enumerate() {
        text = text.replace(&format!("{{terms{i}}}"), terms);
    }
    text.replace("{terms}", &all.join(", "))
        .replace("{moments}", &core::ends::moments(set))
        .replace("{slots}", &core::gathered(set, language, &pair))
        .replace("{words}", &words.to_string())
        .replace("{pairs}", &(words / 2).to_string())
        .replace("{n}", &core::ends::sum(set.moments + 1))
        .replace("{b0}", &core::ends::sum(0))
}

/// A line once a target of sums.
fn each_target(set: FeatureSet, line: &str) -> String {
    let format = |target: usize| {
        let names = |names: [&'static str; 2]| names[usize::from(channels(set, target) > 2)];
        line.replace("{format{i}}", names(["rg32float", "rgba32float"]))
            .replace("{glformat{i}}", names(["GL_RG32F", "GL_RGBA32F"]))
            .replace(
                "{vkformat{i}}",
                names(["VK_FORMAT_R32G32_SFLOAT", "VK_FORMAT_R32G32B32A32_SFLOAT"]),
            )
            .replace(
                "{dxformat{i}}",
                names(["DXGI_FORMAT_R32G32_FLOAT", "DXGI_FORMAT_R32G32B32A32_FLOAT"]),
            )
            .replace("{i}", &target.to_string())
    };
    (0..targets(set)).map(format).collect::<Vec<_>>().join("\n")
}

/// Functions for Unity's Shader Graph.
fn unity(mlp: &Mlp) -> String {
    let set = mlp.feature_set();
    let each = |f: &dyn Fn(usize) -> String| (0..targets(set)).map(f).collect::<Vec<_>>().join(", ");
    let mut text = String::new();
    for line in include_str!("files/unity.hlsl").lines() {
        let line = match line.strip_prefix('%').and_then(|marked| marked.split_once(' ')) {
            None => line.to_owned(),
            Some(("log", rest)) if set.moment_depth() == MomentDepthKind::Log => rest.to_owned(),
            Some(("window", rest)) if set.moment_depth() == MomentDepthKind::Window => rest.to_owned(),
            Some(("sums", rest)) => each_target(set, rest),
            Some(_) => continue,
        };
        text += &line;
        text.push('\n');
    }
    let include = match set.spec().core {
        Some(_) => core::chain_name(mlp, Target::Hlsl),
        None => format!("{}.hlsl", mlp.name()),
    };
    text.replace("{include}", &include)
        .replace("{guard}", &include_guard(mlp.name()))
        .replace("{out}", &each(&|i| format!("out float4 Sums{i}")))
        .replace("{in}", &each(&|i| format!("float4 Sums{i}")))
        .replace("{arguments}", &each(&|i| format!("Sums{i}")))
}

/// A line without the attributes in front of a declaration: `@group(0) @binding(0)`, `layout(binding = 0)`.
fn declared(line: &str) -> &str {
    match line.split_once(')') {
        Some((attribute, rest)) if attribute.starts_with('@') || attribute.starts_with("layout(") => {
            declared(rest.trim_start())
        }
        _ => line,
    }
}

/// Paragraphs of a source that functions use, and themselves; each begins with an empty line.
fn reachable(source: &str, functions: &str) -> String {
    // Names begin with nmt_, NMT_ or Nmt; a paragraph defines what its lines declare, and uses all other names in its
    // code.
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let code = |line: &str| line.split("//").next().unwrap_or_default().to_owned();
    let names = |line: &str| -> Vec<String> {
        let words = line.split(|c: char| !is_word(c)).map(str::to_owned);
        words.filter(|w| w.to_ascii_lowercase().starts_with("nmt")).collect()
    };
    let paragraphs: Vec<&str> = source
        .split("\n\n")
        .filter(|p| p.lines().any(|l| !code(l).trim().is_empty()))
        .collect();
    let mut defined: HashMap<String, usize> = HashMap::new();
    for (index, paragraph) in paragraphs.iter().enumerate() {
        for line in paragraph.lines().map(code) {
            // A declaration stands at the margin, and its name before brackets and values.
            let head = declared(&line).split(['(', '=']).next().unwrap_or_default();
            if let Some(name) = names(head).pop().filter(|_| !line.starts_with([' ', '#', '}', ')'])) {
                defined.entry(name).or_insert(index);
            }
        }
    }
    let mut used: HashSet<usize> = HashSet::new();
    let mut open: Vec<String> = functions.split_whitespace().map(str::to_owned).collect();
    while let Some(name) = open.pop() {
        if let Some(&index) = defined.get(&name)
            && used.insert(index)
        {
            open.extend(paragraphs[index].lines().map(code).flat_map(|line| names(&line)));
        }
    }
    let kept = paragraphs.iter().enumerate().filter(|(index, _)| used.contains(index));
    kept.map(|(_, p)| format!("\n\n{}", p.trim_matches('\n'))).collect()
}
