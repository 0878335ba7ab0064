//! What the names of methods have in common: a stem, and a parameter after a colon.

/// A name whose stem is known and whose parameter is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("method '{name}': {problem}; write {usage}")]
pub struct ParseProblem {
    name: String,
    problem: String,
    usage: String,
}

impl ParseProblem {
    /// What is wrong with a name, and how to write it.
    pub fn new(name: &str, problem: impl Into<String>, usage: impl Into<String>) -> Self {
        Self { name: name.to_owned(), problem: problem.into(), usage: usage.into() }
    }
}

/// Most layers, nodes or passes that a method may be asked for.
pub const MOST_LAYERS: usize = 1 << 16;

/// The parameter of a name of the form `stem` or `stem:parameter`; nothing where the stem is another.
pub fn parameter<'a>(name: &'a str, stem: &str) -> Option<Option<&'a str>> {
    match name.strip_prefix(stem)? {
        "" => Some(None),
        rest => rest.strip_prefix(':').map(Some),
    }
}

/// The parameter of a name that takes none.
pub fn bare(name: &str, stem: &str) -> Option<Result<(), ParseProblem>> {
    Some(match parameter(name, stem)? {
        None => Ok(()),
        Some(_) => Err(ParseProblem::new(name, "it takes no parameter", stem)),
    })
}

/// The number K of a name of the form `stem:K`.
pub fn layers(name: &str, stem: &str) -> Option<Result<usize, ParseProblem>> {
    let usage = || format!("{stem}:K with K a whole number from 1 to {MOST_LAYERS}");
    Some(match parameter(name, stem)? {
        None => Err(ParseProblem::new(name, "K is missing", usage())),
        Some(text) => match text.parse() {
            Ok(k @ 1..=MOST_LAYERS) => Ok(k),
            _ => Err(ParseProblem::new(name, format!("K = '{text}'"), usage())),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stems_and_parameters() {
        assert_eq!(layers("adaptive:4", "adaptive"), Some(Ok(4)));
        assert_eq!(layers("adaptive-2:4", "adaptive"), None);
        assert_eq!(layers("depth-peeling:4", "adaptive"), None);
        assert_eq!(bare("abuffer", "abuffer"), Some(Ok(())));
        let messages = ["adaptive", "adaptive:", "adaptive:0", "adaptive:-1", "adaptive:1e3", "adaptive:65537"]
            .map(|name| layers(name, "adaptive").unwrap().unwrap_err().to_string());
        assert_eq!(messages[0], "method 'adaptive': K is missing; write adaptive:K with K a whole number from 1 to 65536");
        assert_eq!(messages[2], "method 'adaptive:0': K = '0'; write adaptive:K with K a whole number from 1 to 65536");
        assert!(messages.iter().all(|m| m.contains("write adaptive:K")));
        assert!(bare("abuffer:2", "abuffer").unwrap().unwrap_err().to_string().contains("takes no parameter"));
    }
}
