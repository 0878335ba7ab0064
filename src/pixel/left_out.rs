//! What a source holds and a fragment list does not: said to the user, never dropped without a word.

use serde::Serialize;
use std::fmt;

/// One kind of content that was left out, or read as something else, where a fragment list was made of a file or a
/// scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// What it is, in the words of its format.
    pub what: String,
    /// The file, and the place in it.
    #[serde(rename = "where")]
    pub place: String,
    /// How many there are.
    pub count: u64,
    /// What to do about it, or why nothing need be done.
    pub remedy: String,
}

impl LeftOut {
    /// `count` pieces of `what` at `place`.
    pub fn new(what: impl Into<String>, place: impl Into<String>, count: u64, remedy: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            place: place.into(),
            count,
            remedy: remedy.into(),
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "left out: {} ({}), {}: {}",
            self.what, self.count, self.place, self.remedy
        )
    }
}

/// Adds what was left out, together with the same at the same place.
pub fn note(all: &mut Vec<LeftOut>, new: LeftOut) {
    if new.count == 0 {
        return;
    }
    match all
        .iter_mut()
        .find(|old| old.what == new.what && old.place == new.place)
    {
        Some(old) => old.count += new.count,
        None => all.push(new),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_at_one_place_is_counted_together() {
        let mut all = Vec::new();
        for count in [0, 2, 3] {
            note(&mut all, LeftOut::new("lines", "a.obj", count, "faces are read"));
        }
        note(&mut all, LeftOut::new("lines", "b.obj", 1, "faces are read"));
        assert_eq!(all.iter().map(|l| l.count).collect::<Vec<_>>(), [5, 1]);
        assert_eq!(all[0].to_string(), "left out: lines (5), a.obj: faces are read");
        let json = serde_json::to_string(&all[1]).unwrap();
        assert_eq!(
            json,
            r#"{"what":"lines","where":"b.obj","count":1,"remedy":"faces are read"}"#
        );
    }
}
