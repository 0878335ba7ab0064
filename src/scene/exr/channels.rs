//! Which channels hold depth, opacity and colour.

use super::bytes::{Bytes, Kind};
use crate::pixel::left_out::{LeftOut, note};
use crate::scene::SceneError;

/// Where opacity is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Alpha {
    /// In one channel.
    One(usize),
    /// In one for each of red, green and blue.
    PerColor([usize; 3]),
}

/// The channels that are used, by their places among all.
#[derive(Debug, Clone, Copy)]
pub(super) struct Used {
    pub z: usize,
    pub alpha: Alpha,
    pub color: Option<[usize; 3]>,
    pub z_back: Option<usize>,
}

/// What a channel is, whatever layer it belongs to and however its name is spelt.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Z,
    ZBack,
    Alpha,
    AlphaOf(usize),
    Color(usize),
}

fn role(base: &str) -> Option<Role> {
    Some(match base.to_ascii_lowercase().as_str() {
        "z" | "depth" => Role::Z,
        "zback" => Role::ZBack,
        "a" | "alpha" => Role::Alpha,
        "ra" | "ar" => Role::AlphaOf(0),
        "ga" | "ag" => Role::AlphaOf(1),
        "ba" | "ab" => Role::AlphaOf(2),
        "r" | "red" => Role::Color(0),
        "g" | "green" => Role::Color(1),
        "b" | "blue" => Role::Color(2),
        _ => return None,
    })
}

impl Used {
    /// Names what is not used, and what is but not as it stands.
    fn name_others(&self, channels: &[(String, Kind)], place: &str, left_out: &mut Vec<LeftOut>) {
        let mut used: Vec<usize> = vec![self.z];
        match self.alpha {
            Alpha::One(a) => used.push(a),
            Alpha::PerColor(a) => {
                used.extend(a);
                let what = "opacity for each colour (AR, AG, AB)";
                note(
                    left_out,
                    LeftOut::new(
                        what,
                        place,
                        1,
                        "opacity is their mean; what each sample adds to the image is kept",
                    ),
                );
            }
        }
        used.extend(self.color.into_iter().flatten().chain(self.z_back));
        let others: Vec<&str> = (0..channels.len())
            .filter(|i| !used.contains(i))
            .map(|i| channels[i].0.as_str())
            .collect();
        if !others.is_empty() {
            let what = format!("channels {}", others.join(", "));
            let remedy = "read are Z, ZBack, A and R, G, B, of one layer where there are several";
            note(left_out, LeftOut::new(what, place, others.len() as u64, remedy));
        }
    }
}

/// Finds the channels. Those without a layer's name come first, then the layer that has what is missing; what is used
/// of several layers need not be one's.
///
/// # Errors
/// [`SceneError::FileContent`] where there is no depth, no opacity, or a part of a colour, with the names of all
/// channels.
pub(super) fn used(
    bytes: &Bytes<'_>,
    channels: &[(String, Kind)],
    place: &str,
    left_out: &mut Vec<LeftOut>,
) -> Result<Used, SceneError> {
    let roles: Vec<(&str, Option<Role>)> = channels
        .iter()
        .map(|(name, _)| {
            let (layer, base) = name.rsplit_once('.').unwrap_or(("", name));
            (layer, role(base))
        })
        .collect();
    let mut layers: Vec<&str> = vec![""];
    for (layer, _) in &roles {
        if !layers.contains(layer) {
            layers.push(layer);
        }
    }
    let find = |layer: &str, role: Role| roles.iter().position(|r| *r == (layer, Some(role)));
    let three =
        |layer: &str, of: fn(usize) -> Role| Some([find(layer, of(0))?, find(layer, of(1))?, find(layer, of(2))?]);
    let names = || channels.iter().map(|c| c.0.as_str()).collect::<Vec<_>>().join(", ");
    let missing = |what: &str| {
        bytes.wrong(
            "channels",
            format!("there is no channel {what}; the file has {}", names()),
        )
    };
    let alpha_of = |layer: &str| {
        let one = find(layer, Role::Alpha).map(Alpha::One);
        one.or_else(|| three(layer, Role::AlphaOf).map(Alpha::PerColor))
    };
    let with_alpha = layers.iter().find_map(|&layer| Some((layer, alpha_of(layer)?)));
    let (layer, alpha) = with_alpha.ok_or_else(|| missing("A (alpha)"))?;
    // Of the layer itself, of no layer, of any.
    let order = || [layer, ""].into_iter().chain(layers.iter().copied());
    let z = order()
        .find_map(|l| find(l, Role::Z))
        .ok_or_else(|| missing("Z (depth)"))?;
    let color = order().find_map(|l| three(l, Role::Color));
    if color.is_none() && roles.iter().any(|r| matches!(r.1, Some(Role::Color(_)))) {
        let reason = format!("colour needs R, G and B, or none of them; the file has {}", names());
        return Err(bytes.wrong("channels", reason));
    }
    let z_back = order().find_map(|l| find(l, Role::ZBack));
    let found = Used {
        z,
        alpha,
        color,
        z_back,
    };
    found.name_others(channels, place, left_out);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn find(names: &[&str]) -> Result<(Used, Vec<LeftOut>), String> {
        let channels: Vec<(String, Kind)> = names.iter().map(|n| ((*n).to_owned(), Kind::Float)).collect();
        let bytes = Bytes {
            path: Path::new("a.exr"),
            data: &[],
            at: 0,
        };
        let mut left_out = Vec::new();
        let found = used(&bytes, &channels, "part 0", &mut left_out).map_err(|e| e.to_string())?;
        Ok((found, left_out))
    }

    #[test]
    fn channels_are_found_under_any_usual_name() {
        let (plain, rest) = find(&["A", "B", "G", "R", "Z"]).unwrap();
        assert_eq!(
            (plain.z, plain.alpha, plain.color, rest.len()),
            (4, Alpha::One(0), Some([3, 2, 1]), 0)
        );
        let (layered, _) = find(&["Z", "beauty.B", "beauty.G", "beauty.R", "beauty.alpha"]).unwrap();
        assert_eq!(
            (layered.z, layered.alpha, layered.color),
            (0, Alpha::One(4), Some([3, 2, 1]))
        );
        let (glass, rest) = find(&["AB", "AG", "AR", "B", "G", "R", "Z", "id"]).unwrap();
        assert_eq!(glass.alpha, Alpha::PerColor([2, 1, 0]));
        assert!(
            rest[0].what.contains("AR, AG, AB") && rest[1].what == "channels id",
            "{rest:?}"
        );
        let (two, rest) = find(&["A", "Z", "left.A", "left.Z"]).unwrap();
        assert_eq!((two.z, two.alpha), (1, Alpha::One(0)));
        assert_eq!((rest[0].what.as_str(), rest[0].count), ("channels left.A, left.Z", 2));
    }

    #[test]
    fn what_is_missing_is_named_beside_what_is_there() {
        for (names, part) in [
            (
                &["R", "G", "B", "Z"][..],
                "no channel A (alpha); the file has R, G, B, Z",
            ),
            (&["A"], "no channel Z (depth)"),
            (&["A", "Z", "R"], "colour needs R, G and B"),
        ] {
            let message = find(names).unwrap_err();
            assert!(message.contains(part), "{message}");
        }
    }
}
