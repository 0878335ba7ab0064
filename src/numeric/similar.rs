//! Names that were probably meant.

/// The known name that is most like another; none where none is near.
///
/// # Accuracy
/// Likeness is Jaro and Winkler's, from 0 to 1; below 0.8 nothing is suggested.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    known
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&name, &candidate.to_lowercase()), candidate))
        .filter(|(likeness, _)| *likeness >= 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// The end of an error message: "; did you mean 'hair'?", or nothing.
pub fn suggestion<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(name, known).map_or_else(String::new, |near| format!("; did you mean '{near}'?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slips of the finger are understood. Control: another word is not.
    #[test]
    fn slips_are_understood() {
        let known = ["glass-stacks", "smoke", "hair", "teapots", "recommended"];
        for (typed, meant) in [
            ("glas-stacks", "glass-stacks"),
            ("teapot", "teapots"),
            ("Recomended", "recommended"),
        ] {
            assert_eq!(nearest(typed, known), Some(meant));
        }
        assert_eq!(suggestion("castle", known), "");
        assert_eq!(suggestion("hiar", known), "; did you mean 'hair'?");
    }
}
