//! What a distribution of random pixels is, as a configuration file says it.
//!
//! What its laws say of themselves stands in [`law`](super::law).

use super::law::alpha::{AlphaReading, Uniform};
use super::law::depth::{DepthReading, Window};
use super::law::{CountLaw, FragmentCount, PixelLaw};
use crate::pixel::CameraPlanes;
use serde::{Deserialize, Serialize};

/// Most fragments, and most clusters of them, that a pixel may be configured to have.
pub const MAX_FRAGMENTS: u32 = 1 << 16;

/// A distribution of random pixels: a mixture of laws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SynthConfig {
    /// Planes between which the fragments lie.
    pub camera: CameraPlanes,
    /// The laws; each pixel follows one of them.
    pub pixels: Vec<PixelLaw>,
}

/// A range of whole numbers, ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CountRange {
    /// Least.
    pub min: u32,
    /// Greatest.
    pub max: u32,
}

/// A range of numbers, ends included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// Least.
    pub min: f64,
    /// Greatest.
    pub max: f64,
}

/// What is wrong with a distribution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SynthError {
    /// There is no law to draw from.
    #[error("synth.pixels: must hold at least one table")]
    NoPixels,
    /// A number is out of its domain.
    #[error("{field} = {value}: must {must}")]
    Number {
        /// The field.
        field: String,
        /// Its value.
        value: f64,
        /// Its domain, in words.
        must: String,
    },
    /// min > max.
    #[error("{field}: min = {min} is greater than max = {max}; swap them")]
    Inverted {
        /// The range.
        field: String,
        /// Its lower end.
        min: f64,
        /// Its upper end.
        max: f64,
    },
    /// A law in moment depth has no range.
    #[error(
        "{0}.range: is missing, and this depth law needs it; add, say, range = {{ half = {{ min = 0.02, max = 1.0 }} }}"
    )]
    MissingRange(String),
    /// Window depths were given a range in moment depth.
    #[error(
        "{0}.range: does not apply to the depth law 'window', whose own min and max say where fragments lie; remove it"
    )]
    UnusedRange(String),
    /// The camera's planes are invalid.
    #[error("synth.camera: {0}")]
    Camera(crate::pixel::DepthError),
}

impl SynthConfig {
    /// NMT24's distribution in the default reading.
    ///
    /// # Source
    /// NMT24 Sec. 3.2: "2 to 32 fragments, fragment depth ranges 0.3 to 1.0, values 0.1 to 0.5".
    pub fn paper() -> Self {
        Self {
            camera: CameraPlanes::new(0.1, 100.0).expect("0 < near < far"),
            pixels: vec![PixelLaw {
                weight: 1.0,
                fragments: FragmentCount {
                    min: 2,
                    max: 32,
                    law: CountLaw::Uniform,
                },
                depth: Window {
                    min: 0.3,
                    max: 1.0,
                    reading: DepthReading::PerFragment,
                }
                .into(),
                alpha: Uniform {
                    min: 0.1,
                    max: 0.5,
                    reading: AlphaReading::PerFragment,
                }
                .into(),
                range: None,
            }],
        }
    }

    /// A wide distribution, for networks that are to serve scenes which nobody has seen yet: few and many fragments,
    /// thin closed surfaces, clusters and clouds, faint and nearly opaque, spread over the whole depth range or over
    /// very little of it.
    ///
    /// It is what `configs/recommended.toml` says, which names what each law stands for.
    pub fn wide() -> Self {
        #[derive(Deserialize)]
        struct Config {
            synth: SynthConfig,
        }
        let config: Config = toml::from_str(include_str!("../../configs/recommended.toml")).expect("a test reads it");
        config.synth
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`SynthError`] names the field.
    pub fn validate(&self) -> Result<(), SynthError> {
        if self.pixels.is_empty() {
            return Err(SynthError::NoPixels);
        }
        for (i, law) in self.pixels.iter().enumerate() {
            law.validate(&format!("synth.pixels[{i}]"))?;
        }
        self.camera.checked().map(drop).map_err(SynthError::Camera)
    }
}

/// A number that is out of its domain.
pub(super) fn number(field: String, value: f64, must: impl Into<String>) -> SynthError {
    SynthError::Number {
        field,
        value,
        must: must.into(),
    }
}

/// min and max in a domain, and in order.
pub(super) fn within(
    at: &str,
    Range { min, max }: Range,
    domain: impl Fn(f64) -> bool,
    must: &str,
) -> Result<(), SynthError> {
    for (end, value) in [("min", min), ("max", max)] {
        if !domain(value) {
            return Err(number(format!("{at}.{end}"), value, must));
        }
    }
    if min > max {
        return Err(SynthError::Inverted {
            field: at.to_owned(),
            min,
            max,
        });
    }
    Ok(())
}

/// Of numbers in [0, 1].
pub(super) fn unit(at: &str, range: Range) -> Result<(), SynthError> {
    within(at, range, |x| (0.0..=1.0).contains(&x), "lie in [0, 1]")
}

/// Of log-uniform numbers: 0 has no logarithm.
pub(super) fn above_zero(at: &str, range: Range) -> Result<(), SynthError> {
    within(at, range, |x| x > 0.0 && x <= 1.0, "be greater than 0 and at most 1")
}

/// Of counts of fragments, or of clusters of them.
pub(super) fn count(at: &str, CountRange { min, max }: CountRange) -> Result<(), SynthError> {
    let must = format!("be from 1 to {MAX_FRAGMENTS}");
    within(
        at,
        Range {
            min: min.into(),
            max: max.into(),
        },
        |x| (1.0..=f64::from(MAX_FRAGMENTS)).contains(&x),
        &must,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::law::PixelRange;
    use crate::synth::law::alpha::{LogUniform, NearOpaque, Subrange};
    use crate::synth::law::depth::{Beta, Clustered, Paired};
    use crate::synth::law::testing::range;

    /// A file with one law, some of its lines replaced.
    fn parse(changes: &[(&str, &str)]) -> Result<SynthConfig, String> {
        let mut text = "camera = { near = 0.1, far = 100.0 }\n[[pixels]]\nfragments = { min = 2, max = 32 }\n\
            depth = { law = \"window\", min = 0.3, max = 1.0 }\nalpha = { law = \"uniform\", min = 0.1, max = 0.5 }\n"
            .to_owned();
        for (key, line) in changes {
            let start = text.find(&format!("{key} = ")).unwrap_or(text.len());
            let end = text[start..].find('\n').map_or(text.len(), |end| start + end);
            text.replace_range(start..end, line);
        }
        toml::from_str(&text).map_err(|e| e.message().to_owned())
    }

    #[test]
    fn the_paper_in_a_file() {
        assert_eq!(parse(&[]), Ok(SynthConfig::paper()));
    }

    #[test]
    fn the_wide_distribution_is_valid() {
        let wide = SynthConfig::wide();
        wide.validate().unwrap();
        assert!(wide.pixels.len() > 10);
    }

    #[test]
    fn distributions_in_a_file_and_back() {
        for config in [SynthConfig::paper(), SynthConfig::wide()] {
            assert_eq!(
                serde_json::from_value::<SynthConfig>(serde_json::to_value(&config).unwrap()).unwrap(),
                config
            );
            assert_eq!(
                toml::from_str::<SynthConfig>(&toml::to_string(&config).unwrap()).unwrap(),
                config
            );
        }
    }

    /// In every table, a field that means nothing there is an error, not ignored.
    #[test]
    fn unknown_fields_are_refused() {
        let messages = [
            ("camera", "camera = { near = 0.1, far = 100.0, up = 1 }"),
            (
                "camera",
                "camera = { near = 0.1, far = 100.0 }\nfragments = { min = 1, max = 2 }",
            ),
            ("fragments", "colour = 1\nfragments = { min = 2, max = 32 }"),
            ("fragments", "fragments = { min = 2, max = 32, mean = 8 }"),
            ("depth", "depth = { min = 0.3, max = 1.0 }"),
            ("depth", "depth = { law = 'normal' }"),
            ("depth", "depth = { law = 'window', min = 0.3, max = 1.0, gap = 1 }"),
            ("depth", "depth = { law = 'uniform', min = 0.3, max = 1.0 }"),
            (
                "depth",
                "depth = { law = 'paired', gap = { min = 0.3, max = 1.0, law = 'uniform' } }",
            ),
            (
                "alpha",
                "alpha = { law = 'subrange', min = 0.3, max = 1.0, reading = 'per-pixel' }",
            ),
            (
                "alpha",
                "alpha = { law = 'uniform', min = 0.3, max = 1.0, reading = 'per-cluster' }",
            ),
            ("range", "range = { half = { min = 0.3, max = 1.0 }, centre = 0 }"),
        ]
        .map(|change| parse(&[change]).unwrap_err());
        insta::assert_snapshot!(messages.join("\n"));
    }

    #[test]
    fn errors_name_the_field() {
        let error = |change: &dyn Fn(&mut PixelLaw)| {
            let mut config = SynthConfig::wide();
            change(&mut config.pixels[2]);
            config.validate().unwrap_err().to_string()
        };
        let window = |min, max| {
            let reading = DepthReading::PerFragment;
            Window { min, max, reading }.into()
        };
        let uniform = |min, max| {
            let reading = AlphaReading::PerFragment;
            Uniform { min, max, reading }.into()
        };
        let log_uniform = |min, max| {
            let reading = AlphaReading::PerFragment;
            LogUniform { min, max, reading }.into()
        };
        let clustered = |min, max, width| {
            let clusters = CountRange { min, max };
            Clustered { clusters, width }.into()
        };
        let near_opaque = |share, low| NearOpaque { share, low }.into();
        let beta = |a, b| Beta { a, b }.into();
        let paired = |min, max| {
            let gap = range(min, max);
            Paired { gap }.into()
        };
        insta::assert_snapshot!(
            [
                SynthConfig {
                    pixels: vec![],
                    ..SynthConfig::wide()
                }
                .validate()
                .unwrap_err()
                .to_string(),
                error(&|law| law.weight = 0.0),
                error(&|law| law.weight = -1.0),
                error(&|law| law.weight = f64::NAN),
                error(&|law| law.weight = f64::INFINITY),
                error(&|law| law.fragments.min = 0),
                error(&|law| law.fragments.min = 400),
                error(&|law| law.fragments.max = u32::MAX),
                error(&|law| law.depth = window(0.3, 1.0)),
                error(&|law| law.depth = window(0.9, 0.2)),
                error(&|law| law.depth = window(0.9, 1.5)),
                error(&|law| law.depth = window(f64::NAN, 1.0)),
                error(&|law| law.depth = clustered(0, 4, range(0.1, 0.1))),
                error(&|law| law.depth = clustered(5, 4, range(0.1, 0.1))),
                error(&|law| law.depth = clustered(1, 100_000, range(0.1, 0.1))),
                error(&|law| law.depth = clustered(1, 4, range(0.0, 0.1))),
                error(&|law| law.depth = paired(0.0, 1.0)),
                error(&|law| law.depth = paired(0.2, 0.1)),
                error(&|law| law.depth = paired(0.2, f64::INFINITY)),
                error(&|law| law.depth = beta(range(0.01, 1.0), range(1.0, 1.0))),
                error(&|law| law.depth = beta(range(1.0, 1.0), range(1.0, f64::NAN))),
                error(&|law| law.range = None),
                error(&|law| law.range = Some(PixelRange { half: range(0.0, 1.0) })),
                error(&|law| law.range = Some(PixelRange { half: range(0.5, 1.1) })),
                error(&|law| law.alpha = uniform(f64::NAN, 0.5)),
                error(&|law| law.alpha = uniform(0.1, -0.1)),
                error(&|law| law.alpha = uniform(0.5, 0.1)),
                error(&|law| law.alpha = log_uniform(0.0, 0.1)),
                error(&|law| law.alpha = Subrange { min: 0.0, max: 1.1 }.into()),
                error(&|law| law.alpha = near_opaque(range(0.0, 2.0), range(0.1, 0.2))),
                error(&|law| law.alpha = near_opaque(range(0.0, 0.5), range(-0.1, 0.2))),
                SynthConfig {
                    camera: serde_json::from_str(r#"{"near": 2, "far": 1}"#).unwrap(),
                    ..SynthConfig::wide()
                }
                .validate()
                .unwrap_err()
                .to_string(),
            ]
            .join("\n")
        );
    }
}
