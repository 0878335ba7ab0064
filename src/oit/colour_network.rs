//! The two rivals whose network answers once a pixel, with a colour: DFA and STAR-NT.

use super::capabilities::{COLOUR_BITS, Capabilities, Needs};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::features::colour::{ColourSet, Kept};
use crate::model::{ColourNetwork, ModelError};
use crate::pixel::{FragmentList, Pixel};
use std::path::Path;

/// A pixel's colour from the two nearest fragments, the sums of all others, and one answer of a network.
///
/// What the network sees is our reading of what is public of both methods; see [`crate::features::colour`]. The weights
/// are of our own training, on the pixels of `configs/recommended.toml` with random colours.
///
/// Fragments have no weights of their own: what the A-buffer would call transmittance is nowhere computed.
///
/// # Source
/// Tsopouridis, Vasilakis, Fudos, *Deep and Fast Approximate Order Independent Transparency*, CGF 43(6) 2024; STAR-NT,
/// 2026.
pub struct ColourMethod {
    /// Its name on the command line.
    name: String,
    network: ColourNetwork,
}

/// The methods by their names, with the networks that are shipped.
pub const ENTRIES: [Entry; 2] = [
    Entry {
        head: "dfa",
        pattern: "dfa[:MODEL.json]",
        source: "Tsopouridis, Vasilakis, Fudos, CGF 43(6) 2024; features and weights are ours",
        names,
        build: |arguments| build(arguments, ColourSet::Dfa, DFA),
    },
    Entry {
        head: "star-nt",
        pattern: "star-nt[:MODEL.json]",
        source: "STAR-NT, 2026; features and weights are ours",
        names,
        build: |arguments| build(arguments, ColourSet::StarNt, STAR_NT),
    },
];

/// Networks that configs/rivals/dfa.toml and configs/rivals/star-nt.toml train.
const DFA: &[u8] = include_bytes!("../../models/rivals/dfa.json");
const STAR_NT: &[u8] = include_bytes!("../../models/rivals/star-nt.json");

/// The model files that come with the program.
pub const SHIPPED: [&[u8]; 2] = [DFA, STAR_NT];

fn names(head: &str) -> Vec<String> {
    vec![head.to_owned()]
}

fn build(arguments: &Arguments<'_>, set: ColourSet, shipped: &[u8]) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    let network = match arguments.argument {
        None => ColourNetwork::from_json(shipped, Path::new(arguments.name)),
        Some(path) => ColourNetwork::load(Path::new(path)).and_then(|network| {
            let found = network.set();
            if found == set {
                return Ok(network);
            }
            Err(ModelError::Content {
                path: path.into(),
                reason: format!("a network of {}, not of {}", found.name(), set.name()),
            })
        }),
    };
    let network = network.map_err(|source| ParseError::Model {
        name: arguments.name.to_owned(),
        source,
    })?;
    Ok(Box::new(ColourMethod {
        name: arguments.name.to_owned(),
        network,
    }))
}

impl Method for ColourMethod {
    fn name(&self) -> String {
        self.name.clone()
    }

    /// One pass that keeps the two nearest under an interlock, and sums: b0 and n, and of the two nearest depth,
    /// opacity and colour. With the accumulated colour DFA has the 352 bits that NMT24 Sec. 4 states for it; STAR-NT's
    /// layers are counted as two colours of 8 bits a channel and two depths.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: Some(match self.network.set() {
                ColourSet::Dfa => 224,
                ColourSet::StarNt => 192,
            }),
            colour_bits_per_pixel: COLOUR_BITS,
            geometry_passes: 1,
            needs: Needs {
                f32_blending: true,
                ..Needs::INTERLOCK
            },
            order_dependent: false,
        }
    }

    fn weights_are_transmittance(&self) -> bool {
        false
    }

    fn accumulate<'a>(&'a self, _: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Answers(&self.network)))
    }
}

/// The answers of a network, made when a pixel is composited.
struct Answers<'a>(&'a ColourNetwork);

impl Accumulated for Answers<'_> {
    /// Fragments have none; 1 stands for all of them.
    fn weights(&self, _: usize, out: &mut [f64]) {
        out.fill(1.0);
    }

    fn composite(&self, pixel: Pixel<'_>, _: usize, _: &[f64], background: [f64; 3]) -> [f64; 3] {
        let (set, kept) = (self.0.set(), Kept::of(pixel));
        let answer = || {
            let mut row = Vec::new();
            set.features(&kept, &mut row);
            self.0.forward(&row)
        };
        kept.composite(answer, background)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;

    /// Up to two fragments are exact, whatever the network says; three are near. Control: with the colours of the last
    /// two exchanged they are not.
    #[test]
    fn two_fragments_are_exact_and_three_are_near() {
        for name in ["dfa", "star-nt"] {
            let method = parse(name).unwrap();
            assert_close(&image(&*method, &one())[0], &[0.625, 0.5, 0.5]);
            assert_close(&image(&*method, &two())[0], &exact_image(&two())[0]);
            let (found, exact) = (image(&*method, &three())[0], exact_image(&three())[0]);
            let off = |exact: [f64; 3]| found.iter().zip(exact).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
            assert!(off(exact) < 0.06, "{name}: {found:?} for {exact:?}");
            assert!(off([exact[0], exact[2], exact[1]]) > 0.06, "{name}: the control passed");
        }
    }

    /// Order counts for ties alone, and both beat the mean of all colours on random pixels.
    #[test]
    fn order_counts_for_ties_alone_and_a_mean_is_beaten() {
        let list = scene(3);
        let mean = image_mse(&*parse("weighted-average").unwrap(), &list);
        for name in ["dfa", "star-nt"] {
            let method = parse(name).unwrap();
            assert!(!order_matters(&*method, &untied(2)));
            let ours = image_mse(&*method, &list);
            assert!(ours < 0.5 * mean, "{name}: {ours:e} against {mean:e}");
        }
    }

    #[test]
    fn other_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.json");
        std::fs::write(&path, STAR_NT).unwrap();
        let path = path.to_str().unwrap();
        assert!(parse(&format!("star-nt:{path}")).is_ok());
        let message = parse(&format!("dfa:{path}")).map(drop).unwrap_err().to_string();
        assert!(message.contains("a network of star-nt, not of dfa"), "{message}");
        assert!(parse("dfa:nowhere.json").is_err() && parse("dfa+own").is_err());
    }
}
