//! Methods by their names on the command line.

use super::shader::Pass1;
use super::{
    Method, MethodShader, abuffer, adaptive, colour_network, core, deep_weighted_blended, depth_peeling,
    dual_depth_peeling, fourier_opacity, hybrid, low_resolution_moments, moment_power, moment_transparency,
    moment_trig, multi_layer_alpha, neural, stochastic, two_moment_passes, wavelet, weighted_average, weighted_blended,
    weighted_sum,
};
use crate::model::ModelError;
use crate::numeric::similar::suggestion;

/// What a name says after its head.
#[derive(Debug, Clone, Copy)]
pub struct Arguments<'a> {
    /// The whole name.
    pub name: &'a str,
    /// What stands after the first colon.
    pub argument: Option<&'a str>,
    /// Whether `+own` ends the name.
    pub own: bool,
}

impl Arguments<'_> {
    /// The error that says what the argument should be.
    pub fn wrong(&self, expected: impl Into<String>) -> ParseError {
        ParseError::Argument {
            name: self.name.to_owned(),
            found: self.argument.map_or("nothing".to_owned(), |a| format!("'{a}'")),
            expected: expected.into(),
        }
    }

    /// Checks that `+own` does not end the name.
    ///
    /// # Errors
    /// [`ParseError::Own`].
    pub fn no_own(&self) -> Result<(), ParseError> {
        if self.own {
            Err(ParseError::Own {
                name: self.name.to_owned(),
            })
        } else {
            Ok(())
        }
    }

    /// The number K that a method which is not of moments takes.
    ///
    /// # Errors
    /// [`ParseError`].
    pub fn layers(&self) -> Result<usize, ParseError> {
        self.no_own()?;
        match self.argument.map(str::parse) {
            Some(Ok(k @ 1..=MAX_LAYERS)) => Ok(k),
            _ => Err(self.wrong(format!("expected a whole number from 1 to {MAX_LAYERS}"))),
        }
    }

    /// What stands between the colons of a method of moments: storage, `bias=B`, `overestimation=O`, in any order.
    ///
    /// # Errors
    /// [`ParseError::Argument`] where a number is not from 0 to 1, or something stands there twice.
    pub fn of_moments(&self) -> Result<MomentArguments<'_>, ParseError> {
        let mut found = MomentArguments::default();
        for part in self.argument.into_iter().flat_map(|a| a.split(':')) {
            let (slot, text) = if let Some(text) = part.strip_prefix("bias=") {
                (&mut found.bias, text)
            } else if let Some(text) = part.strip_prefix("overestimation=") {
                (&mut found.overestimation, text)
            } else if found.storage.replace(part).is_none() {
                continue;
            } else {
                return Err(self.wrong("expected one storage"));
            };
            match text.parse::<f64>() {
                Ok(number) if (0.0..=1.0).contains(&number) && slot.is_none() => *slot = Some(number),
                _ => return Err(self.wrong("expected a bias and an overestimation from 0 to 1")),
            }
        }
        Ok(found)
    }

    /// Checks that nothing stands after the head but `+own`.
    ///
    /// # Errors
    /// [`ParseError::Argument`].
    pub fn no_argument(&self) -> Result<(), ParseError> {
        if self.argument.is_none() {
            Ok(())
        } else {
            Err(self.wrong("expected no argument"))
        }
    }
}

/// What a method of moments may be told in its name.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MomentArguments<'a> {
    /// What stands there but for the options.
    pub storage: Option<&'a str>,
    /// Moment bias in place of the published one.
    pub bias: Option<f64>,
    /// Overestimation in place of the usual one.
    pub overestimation: Option<f64>,
}

impl MomentArguments<'_> {
    /// The options as they stand in a name, bias first.
    pub fn suffix(bias: Option<f64>, overestimation: Option<f64>) -> String {
        let bias = bias.map_or_else(String::new, |bias| format!(":bias={bias:e}"));
        let overestimation = overestimation.map_or_else(String::new, |o| format!(":overestimation={o}"));
        format!("{bias}{overestimation}")
    }
}

/// Most layers, nodes or passes that a method may be asked for.
pub const MAX_LAYERS: usize = 1 << 16;

/// A kind of method: its head, how its name is written, the names that stand for it in a list of all methods, and how
/// to make one.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// What stands before the colon.
    pub head: &'static str,
    /// The whole name with its options, for messages.
    pub pattern: &'static str,
    /// Who published it.
    pub source: &'static str,
    /// Names for `all`, from the head.
    pub names: fn(&str) -> Vec<String>,
    /// Makes the method.
    pub build: fn(&Arguments<'_>) -> Result<Box<dyn Method>, ParseError>,
}

/// Every kind of method: one line a file.
const ENTRIES: &[&[Entry]] = &[
    &[abuffer::ENTRY],
    &[weighted_sum::ENTRY],
    &[weighted_average::ENTRY],
    &[weighted_blended::ENTRY],
    &[deep_weighted_blended::ENTRY],
    &moment_power::ENTRIES,
    &moment_trig::ENTRIES,
    &[moment_transparency::ENTRY],
    &[two_moment_passes::ENTRY],
    &[low_resolution_moments::ENTRY],
    &[fourier_opacity::ENTRY],
    &[wavelet::ENTRY],
    &[hybrid::ENTRY],
    &[stochastic::ENTRY],
    &[depth_peeling::ENTRY],
    &[dual_depth_peeling::ENTRY],
    &[multi_layer_alpha::ENTRY],
    &[adaptive::ENTRY],
    &colour_network::ENTRIES,
    &[core::ENTRY],
    &[neural::ENTRY],
];

/// Why a name is not a method's.
#[derive(Debug, thiserror::Error)]
pub enum ParseError {
    /// No method has this name.
    #[error("there is no method '{name}'; known are {known}{suggestion}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// Patterns of all names.
        known: String,
        /// The name that was probably meant.
        suggestion: String,
    },
    /// The part after the colon is wrong.
    #[error("{name}: {expected} after the colon, found {found}")]
    Argument {
        /// The whole name.
        name: String,
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: String,
    },
    /// The method has no moments to take the own fragment out of.
    #[error("{name}: '+own' goes with moment-based methods only")]
    Own {
        /// The whole name.
        name: String,
    },
    /// Its network cannot be used.
    #[error("{name}: {source}")]
    Model {
        /// The whole name.
        name: String,
        /// Why.
        source: ModelError,
    },
    /// Its network has other features.
    #[error(transparent)]
    Features(#[from] deep_weighted_blended::WrongFeatures),
}

fn entries() -> impl Iterator<Item = &'static Entry> {
    ENTRIES.iter().copied().flatten()
}

/// The method of a name.
///
/// # Errors
/// [`ParseError`]; it lists the names there are.
pub fn parse(name: &str) -> Result<Box<dyn Method>, ParseError> {
    let (plain, own) = match name.strip_suffix("+own") {
        Some(plain) => (plain, true),
        None => (name, false),
    };
    let (head, argument) = match plain.split_once(':') {
        Some((head, argument)) => (head, Some(argument)),
        None => (plain, None),
    };
    match entries().find(|e| e.head == head) {
        Some(entry) => (entry.build)(&Arguments { name, argument, own }),
        None => Err(ParseError::Unknown {
            name: name.to_owned(),
            known: entries().map(|e| e.pattern).collect::<Vec<_>>().join(", "),
            suggestion: suggestion(name, all_names().iter().map(String::as_str)),
        }),
    }
}

/// Who published the method of a name; none of a name that no method has.
pub fn source(name: &str) -> Option<&'static str> {
    let head = name.split(['+', ':']).next().unwrap_or_default();
    entries().find(|e| e.head == head).map(|e| e.source)
}

/// The names that stand for all methods, every one of which [`parse`] takes.
pub fn all_names() -> Vec<String> {
    entries().flat_map(|e| (e.names)(e.head)).collect()
}

/// The GPU twin of a method by its name; none where the name is no method's, or the method has no twin.
pub fn shader_of(name: &str) -> Option<MethodShader> {
    parse(name).ok()?.shader()
}

/// Names of the methods that have a GPU twin. Where names differ in the CPU's storage alone, the shortest stands for
/// all.
pub fn names_with_shader() -> Vec<String> {
    let names = all_names().into_iter().filter(|name| !name.contains(":f32"));
    names
        .filter(|name| shader_of(name).is_some_and(|shader| shader.pass1 == Pass1::Added))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Context, MethodError, weights};
    use super::*;
    use crate::numeric::rng::stream;
    use crate::numeric::tolerance::AbsoluteError;
    use crate::pixel::{FragmentList, abuffer};
    use crate::synth::{Purpose, Synth, SynthConfig};
    use rand::RngExt;

    #[test]
    fn every_name_is_its_methods_name() {
        let names = all_names();
        assert!(names.len() > 40);
        for name in &names {
            let method = parse(name).unwrap();
            assert_eq!(&method.name(), name);
            let capabilities = method.capabilities();
            let bits = capabilities
                .bits_per_pixel
                .map(|bits| bits + capabilities.colour_bits_per_pixel);
            assert!(
                bits.is_none_or(|bits| bits >= 64) && capabilities.geometry_passes >= 1,
                "{name}"
            );
        }
    }

    /// A bias is part of the name and changes the answers; the published one, written out, does not.
    #[test]
    fn a_bias_may_be_given() {
        let list = image(64, 6);
        let of = |name: &str| {
            let method = parse(name).unwrap();
            assert_eq!(method.name(), name);
            weights(&list, &*method.accumulate(&list, Context::default()).unwrap())
        };
        assert_eq!(of("moment-power-4"), of("moment-power-4:bias=5e-7"));
        assert_ne!(of("moment-power-4"), of("moment-power-4:bias=1e-4"));
        assert_eq!(of("moment-trig-2:f32+own"), of("moment-trig-2:f32:bias=4e-7+own"));
        assert_ne!(of("moment-trig-2"), of("moment-trig-2:bias=1e-2"));
        assert_eq!(of("moment-power-6"), of("moment-power-6:overestimation=0.25"));
        assert_ne!(of("moment-trig-2"), of("moment-trig-2:overestimation=0.5"));
    }

    #[test]
    fn wrong_names_are_explained() {
        for (name, part) in [
            ("moment-power-4:bias=2", "a bias and an overestimation from 0 to 1"),
            ("moment-power-4:f32:f32", "expected one storage"),
            ("moment-power-5", "known are abuffer, "),
            ("", "there is no method ''"),
            (
                "moment-power-4:f16",
                "expected f32, unorm16 or nlqm after the colon, found 'f16'",
            ),
            ("moment-power-4:nlqm+own", "expected f32 or unorm16 before +own"),
            ("moment-trig-2:nlqm", "expected f32 or unorm16"),
            ("moment-transparency:2", "from 0 to 1"),
            ("two-moment-passes:1", "expected no argument"),
            ("low-resolution-moments", "found nothing"),
            ("fourier-opacity:0", "from 1 to"),
        ] {
            let message = parse(name).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(message.contains(part), "{name}: {message}");
        }
    }

    /// Sharpe's bias pulls towards atoms at depths 0 and 1: a pixel with fragments at the ends only stays singular, and
    /// NaN.
    fn published_singular(name: &str) -> bool {
        ["moment-transparency", "two-moment-passes", "low-resolution-moments"]
            .iter()
            .any(|head| name.starts_with(head))
    }

    fn image(pixels: usize, fragments: u32) -> FragmentList {
        let mut offsets = vec![0];
        let (mut view_z, mut alpha) = (vec![], vec![]);
        for p in 0..pixels {
            let mut rng = stream(3, 0, p as u64);
            for _ in 0..rng.random_range(0..=fragments) {
                view_z.push(rng.random_range(1.0f32..9.0));
                alpha.push(rng.random_range(0.05f32..0.95));
            }
            offsets.push(view_z.len() as u64);
        }
        FragmentList::new(offsets, view_z, alpha, None)
            .unwrap()
            .with_size(8, pixels as u32 / 8)
            .unwrap()
    }

    /// Methods that work on moment depth.
    fn takes_moments(name: &str) -> bool {
        ["moment-", "two-moment", "low-resolution", "fourier"]
            .iter()
            .any(|head| name.starts_with(head))
    }

    /// All methods on odd but valid lists: as many weights as fragments, finite and not negative where storage does not
    /// round, 1 where all is clear; and a depth range that is none is refused by those that need one.
    #[test]
    fn odd_lists_are_answered() {
        let planes = crate::pixel::CameraPlanes::new(0.5, 10.0).unwrap();
        let none = FragmentList::new(vec![0, 0, 0], vec![], vec![], None)
            .unwrap()
            .with_size(2, 1)
            .unwrap()
            .with_planes(planes);
        let one = FragmentList::new(vec![0, 1, 3], vec![2.0, 3.0, 3.0], vec![1.0, 0.0, 0.5], None)
            .unwrap()
            .with_size(2, 1)
            .unwrap()
            .with_planes(planes);
        let clear = FragmentList::new(vec![0, 2, 2], vec![2.0, 3.0], vec![0.0, 0.0], None)
            .unwrap()
            .with_size(2, 1)
            .unwrap()
            .with_planes(planes);
        for name in all_names() {
            let method = parse(&name).unwrap();
            for list in [&none, &one, &clear] {
                let w = weights(list, &*method.accumulate(list, Context::default()).unwrap());
                let rounds = name.contains(":f32") || name.contains(":unorm16") || published_singular(&name);
                let allowed = if method.weights_are_transmittance() {
                    1.0 + 1e-9
                } else {
                    f64::MAX
                };
                assert!(rounds || w.iter().all(|w| (0.0..=allowed).contains(w)), "{name}: {w:?}");
            }
            if !takes_moments(&name) {
                continue;
            }
            let clear = weights(&clear, &*method.accumulate(&clear, Context::default()).unwrap());
            assert_eq!(clear, [1.0, 1.0], "{name}");
            let bad = Context {
                depth_range: Some((2.0, 1.0)),
                ..Context::default()
            };
            assert!(
                matches!(method.accumulate(&one, bad), Err(MethodError::Depth { .. })),
                "{name}"
            );
        }
    }

    /// With the own fragment removed the ends of every pixel are exact, to 1e-12 where nothing rounds, and so are
    /// pixels of two.
    #[test]
    fn own_answers_the_ends_exactly() {
        let list = image(64, 6);
        let exact = abuffer::list_transmittance(&list);
        for name in all_names()
            .iter()
            .filter(|n| n.ends_with("+own") && !n.contains("16") && !n.contains(":f32"))
        {
            let found = weights(
                &list,
                &*parse(name).unwrap().accumulate(&list, Context::default()).unwrap(),
            );
            for p in 0..list.pixels() {
                let pixel = list.pixel(p);
                let range = list.range(p);
                let (lo, hi) = pixel
                    .view_z
                    .iter()
                    .fold((f32::MAX, 0.0f32), |(lo, hi), &v| (lo.min(v), hi.max(v)));
                for (i, &v) in range.clone().zip(pixel.view_z) {
                    if v == lo || v == hi {
                        assert!(
                            (found[i] - exact[i]).abs() < 1e-12,
                            "{name} pixel {p}: {} {}",
                            found[i],
                            exact[i]
                        );
                    }
                }
            }
        }
    }

    /// T-MSE of every method on random pixels stays below its bar; single-pixel methods only.
    #[test]
    fn errors_of_methods_on_random_pixels() {
        let list = Synth::new(SynthConfig::paper(), 5)
            .unwrap()
            .pixels(Purpose::Evaluation, 0, 3_000);
        let exact = abuffer::list_transmittance(&list);
        let mse = |name: &str| {
            let found = weights(
                &list,
                &*parse(name).unwrap().accumulate(&list, Context::default()).unwrap(),
            );
            let mse = AbsoluteError::of(&found, &exact).mse();
            println!("{name}: {mse:.3e}");
            mse
        };
        let stated =
            |name: &String| !name.starts_with("low-resolution") && parse(name).unwrap().weights_are_transmittance();
        for name in all_names().iter().filter(|n| stated(n)) {
            let bar = if name.starts_with("moment-power") || name.starts_with("moment-trig") {
                3e-2
            } else {
                0.3
            };
            let found = mse(name);
            // Storage that rounds may leave moments that are no measure's: NaN, as published, and never hidden.
            assert!(
                found < bar || (found.is_nan() && name.contains(':')),
                "{name}: {found:e}"
            );
        }
        assert!(mse("moment-power-4+own") < 0.7 * mse("moment-power-4"));
        assert!(mse("moment-power-8") < mse("moment-power-6") && mse("moment-power-6") < mse("moment-power-4"));
    }
}
