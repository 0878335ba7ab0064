//! Names of an export under another prefix, so that several networks fit one module.

use std::str::FromStr;

/// What names of functions begin with, in place of `nmt`; constants and types follow it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Prefix(String);

/// Why there is no such prefix.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "'{0}' is no prefix: it takes lower-case letters, digits and single underscores between them, begins with a \
        letter, and is not 'gl'"
)]
pub struct NoPrefix(String);

impl FromStr for Prefix {
    type Err = NoPrefix;

    fn from_str(text: &str) -> Result<Self, NoPrefix> {
        let fine = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
        let parts = text.split('_').all(|part| !part.is_empty() && part.chars().all(fine));
        if parts && text.starts_with(|c: char| c.is_ascii_lowercase()) && text != "gl" && text.len() <= 64 {
            Ok(Self(text.to_owned()))
        } else {
            Err(NoPrefix(text.to_owned()))
        }
    }
}

/// The prefix of every export that asks for none.
const OWN: &str = "nmt";

/// What the header's line that says the prefix begins with.
pub const LINE: &str = "Prefix: ";

/// What identifiers begin with: functions, constants, types.
fn heads(prefix: &str) -> [String; 3] {
    let word = |part: &str| part[..1].to_uppercase() + &part[1..];
    [
        format!("{prefix}_"),
        format!("{}_", prefix.to_uppercase()),
        prefix.split('_').map(word).collect(),
    ]
}

/// The text with every identifier that begins in one way beginning in another.
fn renamed(text: &str, from: &str, to: &str) -> String {
    let (from, to) = (heads(from), heads(to));
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(is_word) {
        let end = rest[at..].find(|c| !is_word(c)).map_or(rest.len(), |n| at + n);
        let (before, word) = (&rest[..at], &rest[at..end]);
        out += before;
        let head = from.iter().position(|head| {
            // A type goes on with a capital: Nmt alone is a word of its own.
            word.strip_prefix(head.as_str())
                .is_some_and(|tail| head.ends_with('_') || tail.starts_with(|c: char| c.is_ascii_uppercase()))
        });
        match head {
            Some(head) => {
                out += &to[head];
                out += &word[from[head].len()..];
            }
            None => out += word,
        }
        rest = &rest[end..];
    }
    out + rest
}

impl Prefix {
    /// Shader source under this prefix.
    pub fn apply(&self, text: &str) -> String {
        renamed(text, OWN, &self.0)
    }

    /// Shader source under this prefix, as it is without.
    pub fn undo(&self, text: &str) -> String {
        renamed(text, &self.0, OWN)
    }

    /// The header's line about it.
    pub fn line(&self) -> String {
        let [functions, constants, types] = heads(&self.0);
        format!(
            "{LINE}{}; functions begin with {functions}, constants with {constants}, types with {types}.",
            self.0
        )
    }

    /// The prefix that a comment of a source names, where there is one.
    pub fn of_source(text: &str) -> Option<Self> {
        let line = text
            .lines()
            .find_map(|line| line.strip_prefix("// ")?.strip_prefix(LINE))?;
        line.split(';').next()?.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_renamed_there_and_back() {
        let text =
            "// nmt 0.1.0\nstruct NmtSums {}\nfn nmt_pass1(my_nmt_v: f32) { NMT_W1 + nmt_x[nmt_pass2(Nmt)] } // é nmt_";
        let glass: Prefix = "glass_2".parse().unwrap();
        let under = glass.apply(text);
        assert_eq!(
            under,
            "// nmt 0.1.0\nstruct Glass2Sums {}\nfn glass_2_pass1(my_nmt_v: f32) { GLASS_2_W1 + \
                glass_2_x[glass_2_pass2(Nmt)] } // é glass_2_"
        );
        assert_eq!(glass.undo(&under), text);
        let source = format!("// {}\n{under}", glass.line());
        assert_eq!(Prefix::of_source(&source), Some(glass));
        assert_eq!(Prefix::of_source(text), None);
        for wrong in ["", "Glass", "_a", "a_", "a__b", "1a", "gl", "a-b", "é"] {
            assert!(wrong.parse::<Prefix>().is_err(), "{wrong}");
        }
    }
}
