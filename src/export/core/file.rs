//! Files of a core, ready to be included: with a tail that is a beta law, or with the network that shares it out.

use super::{
    CoreBinding, LANGUAGES, MAX_SHADER_MOMENTS, calls_of_passes, codes, dialect, keep, weigh, weigh_by_network,
};
use crate::export::calls::write_resolve;
use crate::export::files::ShaderFile;
use crate::export::shader::{include_guard, source};
use crate::export::{ExportError, Format, Prefix, Target};
use crate::features::core::CoreSet;
use crate::model::Mlp;
use crate::numeric::file::{Replace, create_folder, may_write, write_atomically};
use crate::numeric::source::Source;
use std::path::{Path, PathBuf};

/// Moments of a core that is asked for by name: mean and spread need two.
const MOMENTS: usize = 2;

/// The core of a method's name, as `core:4`; none where the name is none.
pub fn named(name: &str) -> Option<CoreSet> {
    let heavy = name.strip_prefix("core:")?.parse::<usize>().ok()?;
    (heavy <= crate::features::core::code::MAX_HEAVY).then(|| CoreSet::new(heavy, MOMENTS))
}

/// Name of a core's file in a language.
pub fn file_name(set: CoreSet, language: Target) -> String {
    let suffix = Format::of(language).suffix();
    match set.moments {
        MOMENTS => format!("core-{}{suffix}", set.heavy),
        moments => format!("core-{}-{moments}{suffix}", set.heavy),
    }
}

/// The whole file in a language: how to use it, codes, insertion chain and weight.
pub fn text(set: CoreSet, language: Target) -> String {
    let (about, codes) = (about(set), codes(set, language));
    let keep = keep(set, language, CoreBinding::DEFAULT);
    let passes = calls_of_passes(set, language);
    format!("{about}\n{codes}\n{keep}{}{passes}", weigh(set, language))
}

/// How to use a core's file, as a comment.
fn about(set: CoreSet) -> String {
    let about = match set.is_blended() {
        true => include_str!("about-ends.txt"),
        false => include_str!("about.txt"),
    };
    let about = about
        .replace("CORE_HEAVY", &set.heavy.to_string())
        .replace("CORE_SLOTS", &set.stride().to_string())
        .replace("CORE_MOMENTS", &set.moments.to_string())
        .replace("CORE_VERSION", env!("CARGO_PKG_VERSION"));
    let line = |line: &str| format!("// {line}").trim_end().to_owned() + "\n";
    about.lines().map(line).collect()
}

/// What the names of files with a network and its core end with, before the ending of the language.
const CHAIN: &str = "chain";

/// Whether a network's core is written as a file: it has one, of no more moments than a vector holds.
pub fn has_chain(mlp: &Mlp) -> bool {
    let core = mlp.feature_set().spec().core;
    core.is_some_and(|set| set.moments <= MAX_SHADER_MOMENTS)
}

/// Name of the file of a network with its core in a language.
pub fn chain_name(mlp: &Mlp, language: Target) -> String {
    format!("{}.{CHAIN}{}", mlp.name(), Format::of(language).suffix())
}

/// The whole file of a network that shares out the tail of a core: how to use it, the network, codes, insertion chain
/// and weight. It is all that both passes include.
///
/// # Errors
/// As of the network's own export.
///
/// # Panics
/// If the network has no such core; see [`has_chain`].
pub fn chain(mlp: &Mlp, language: Target, prefix: Option<&Prefix>) -> Result<String, ExportError> {
    let set = set_of(mlp);
    let network = source(mlp, Format::of(language), None)?;
    let text = network + &calls(mlp, language, CoreBinding::DEFAULT);
    let text = match language {
        Target::Wgsl => text,
        // A second inclusion is none.
        _ => {
            let guard = include_guard(&format!("{}_{CHAIN}", mlp.name()));
            format!("#ifndef {guard}\n#define {guard}\n\n{text}\n#endif\n")
        }
    };
    let text = format!("{}\n{text}", about(set));
    Ok(match prefix {
        Some(prefix) => format!("// {}\n{}", prefix.line(), prefix.apply(&text)),
        None => text,
    })
}

/// What stands behind the export of a network that shares out the tail of a core: codes, insertion chain, weight and
/// `nmt_resolve`; of a core that blending keeps, its ends and the calls of both passes.
///
/// # Panics
/// If the network has no such core; see [`has_chain`].
pub fn calls(mlp: &Mlp, language: Target, place: CoreBinding) -> String {
    let set = set_of(mlp);
    let (codes, keep) = (codes(set, language), keep(set, language, place));
    let resolve = Source::new(dialect(language), "nmt");
    write_resolve(&resolve);
    let weigh = weigh_by_network(set, language, 0.0);
    let passes = calls_of_passes(set, language);
    format!("\n{codes}\n{keep}{weigh}{passes}{}", resolve.into_text())
}

fn set_of(mlp: &Mlp) -> CoreSet {
    mlp.feature_set().spec().core.expect("a network with a core")
}

/// The files of a network with its core, in some languages; none where it has no core for shaders.
///
/// # Errors
/// As [`chain`].
pub fn chain_files(mlp: &Mlp, languages: &[Target], prefix: Option<&Prefix>) -> Result<Vec<ShaderFile>, ExportError> {
    let languages = if has_chain(mlp) { languages } else { &[] };
    let file = |&language: &Target| {
        Ok(ShaderFile {
            path: chain_name(mlp, language),
            text: chain(mlp, language, prefix)?,
        })
    };
    languages.iter().map(file).collect()
}

/// Writes a core's files into a folder.
///
/// # Errors
/// [`ExportError`] where a file is there already and may not be replaced, or cannot be written.
pub fn write(set: CoreSet, folder: &Path, replace: Replace) -> Result<Vec<PathBuf>, ExportError> {
    let paths = LANGUAGES.map(|language| folder.join(file_name(set, language)));
    paths.iter().try_for_each(|path| may_write(path, replace))?;
    create_folder(folder)?;
    for (language, path) in LANGUAGES.into_iter().zip(&paths) {
        write_atomically(path, replace, |w| w.write_all(text(set, language).as_bytes()))?;
    }
    Ok(paths.to_vec())
}
