//! The networks that are shipped, as they stand in `models/`, inside of the program.

/// Names and model files.
const NETWORKS: [(&str, &str); 5] = [
    ("recommended", include_str!("../../models/recommended.json")),
    ("small", include_str!("../../models/small.json")),
    ("moments-6", include_str!("../../models/moments-6.json")),
    ("paper", include_str!("../../models/paper.json")),
    (
        "deep-weighted-blended",
        include_str!("../../models/deep-weighted-blended.json"),
    ),
];

/// Names of all shipped networks.
pub fn names() -> impl Iterator<Item = &'static str> {
    NETWORKS.iter().map(|(name, _)| *name)
}

/// The model file of a shipped network; none where no network has the name.
pub fn json(name: &str) -> Option<&'static str> {
    NETWORKS.iter().find(|(n, _)| *n == name).map(|(_, json)| *json)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::file;
    use std::path::Path;

    /// Every model file is there by its name, the same in the program as in the folder; control: a name that is none.
    #[test]
    fn names_are_those_of_the_folder() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
        let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
        let mut stems: Vec<String> = files
            .filter(|path| path.extension().is_some_and(|e| e == "json"))
            .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
            .collect();
        stems.sort();
        let mut known: Vec<&str> = names().collect();
        known.sort();
        assert_eq!(stems, known);
        for name in names() {
            assert_eq!(
                std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap(),
                json(name).unwrap()
            );
            assert_eq!(file::load(Path::new(name)).unwrap().name(), name);
        }
        assert!(json("recommend").is_none() && file::load(Path::new("recommend")).is_err());
    }
}
