//! The networks that come with the program, by name.

use super::{Mlp, ModelError, file};
use crate::numeric::similar::suggestion;
use std::path::Path;

/// Names and model files.
const FILES: [(&str, &str); 9] = [
    ("recommended", include_str!("../../models/recommended.json")),
    ("small", include_str!("../../models/small.json")),
    ("moments-6", include_str!("../../models/moments-6.json")),
    ("ends", include_str!("../../models/ends.json")),
    ("core", include_str!("../../models/core.json")),
    ("core-small", include_str!("../../models/core-small.json")),
    ("core-large", include_str!("../../models/core-large.json")),
    ("paper", include_str!("../../models/paper.json")),
    (
        "deep-weighted-blended",
        include_str!("../../models/deep-weighted-blended.json"),
    ),
];

/// Their names, the one to use first.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

/// Their model files.
pub fn files() -> impl Iterator<Item = &'static [u8]> {
    FILES.iter().map(|(_, text)| text.as_bytes())
}

/// The network of that name; none where no network that comes with the program has it.
///
/// # Panics
/// Where its file is damaged, which a test rules out.
pub fn named(name: &str) -> Option<Mlp> {
    let (name, text) = FILES.iter().find(|(known, _)| *known == name)?;
    Some(file::from_json(text.as_bytes(), Path::new(name)).expect("shipped networks are whole"))
}

/// A network by the path of its file, or by the name of one that comes with the program. A file wins over a name.
///
/// # Errors
/// [`ModelError`]; for a word that is neither, it lists the names.
pub fn open(model: &Path) -> Result<Mlp, ModelError> {
    let word = model.to_str().filter(|text| !text.contains(['/', '\\', '.']));
    match word.filter(|_| !model.is_file()) {
        None => file::load(model),
        Some(name) => named(name).ok_or_else(|| ModelError::Unknown {
            name: name.to_owned(),
            known: names().collect::<Vec<_>>().join(", "),
            suggestion: suggestion(name, names()),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shipped_networks_are_whole() {
        for name in names() {
            assert_eq!(named(name).unwrap().name(), name);
            assert!(open(Path::new(name)).is_ok());
        }
    }

    /// Control: a word that is no name is refused with what was probably meant, and a path is read as a file.
    #[test]
    fn other_words_are_refused() {
        let message = open(Path::new("recomended")).unwrap_err().to_string();
        assert!(
            message.contains("did you mean 'recommended'?") && message.contains("moments-6"),
            "{message}"
        );
        assert!(matches!(open(Path::new("./small")), Err(ModelError::File(_))));
        assert!(matches!(open(Path::new("none.json")), Err(ModelError::File(_))));
    }
}
