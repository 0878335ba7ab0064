//! Files of a core whose tail is a beta law, ready to be included.

use super::{CoreBinding, CoreLanguage, codes, insert, weigh, weigh_by_network};
use crate::export::ExportError;
use crate::features::core::CoreSet;
use crate::numeric::file::{Replace, create_folder, may_write, write_atomically};
use std::path::{Path, PathBuf};

/// Moments of a core that is asked for by name: mean and spread need two.
const MOMENTS: usize = 2;

/// The core of a method's name, as `core:4`; none where the name is none.
pub fn named(name: &str) -> Option<CoreSet> {
    let heavy = name.strip_prefix("core:")?.parse::<usize>().ok()?;
    (heavy <= crate::features::core::code::MAX_HEAVY).then(|| CoreSet::new(heavy, MOMENTS))
}

/// Name of a core's file in a language.
pub fn file_name(set: CoreSet, language: CoreLanguage) -> String {
    let ending = match language {
        CoreLanguage::Wgsl => "wgsl",
        CoreLanguage::Glsl => "glsl",
        CoreLanguage::Hlsl => "hlsl",
    };
    match set.moments {
        MOMENTS => format!("core-{}.{ending}", set.heavy),
        moments => format!("core-{}-{moments}.{ending}", set.heavy),
    }
}

/// The whole file in a language: how to use it, codes, insertion chain and weight.
pub fn text(set: CoreSet, language: CoreLanguage) -> String {
    let insert = insert(language, CoreBinding::DEFAULT);
    format!(
        "{}\n{}\n{insert}{}",
        about(set),
        codes(set, language),
        weigh(set, language)
    )
}

/// The whole file of a core whose tail a network shares out, around the export of that network.
///
/// # Panics
/// As [`weigh_by_network`].
pub fn text_with_network(set: CoreSet, language: CoreLanguage, network: &str) -> String {
    let insert = insert(language, CoreBinding::DEFAULT);
    let weigh = weigh_by_network(set, language);
    format!("{}\n{network}\n{}\n{insert}{weigh}", about(set), codes(set, language))
}

/// How to use such a file, as a comment.
fn about(set: CoreSet) -> String {
    let about = include_str!("about.txt")
        .replace("CORE_HEAVY", &set.heavy.to_string())
        .replace("CORE_SLOTS", &super::stride(set).to_string())
        .replace("CORE_MOMENTS", &set.moments.to_string())
        .replace("CORE_VERSION", env!("CARGO_PKG_VERSION"));
    about
        .lines()
        .map(|line| format!("// {line}").trim_end().to_owned() + "\n")
        .collect()
}

/// Writes a core's files into a folder.
///
/// # Errors
/// [`ExportError`] where a file is there already and may not be replaced, or cannot be written.
pub fn write(set: CoreSet, folder: &Path, replace: Replace) -> Result<Vec<PathBuf>, ExportError> {
    let languages = [CoreLanguage::Wgsl, CoreLanguage::Glsl, CoreLanguage::Hlsl];
    let paths = languages.map(|language| folder.join(file_name(set, language)));
    paths.iter().try_for_each(|path| may_write(path, replace))?;
    create_folder(folder)?;
    for (language, path) in languages.into_iter().zip(&paths) {
        write_atomically(path, replace, |w| w.write_all(text(set, language).as_bytes()))?;
    }
    Ok(paths.to_vec())
}
