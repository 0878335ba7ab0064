//! What a distribution of random pixels is, as a configuration file says it.

use crate::pixel::CameraPlanes;
use serde::{Deserialize, Serialize};

/// Most fragments, and most clusters of them, that a pixel may be configured to have.
pub const MAX_FRAGMENTS: u32 = 1 << 16;

/// The greatest weight of one law.
pub const GREATEST_WEIGHT: f64 = 1e9;

/// Shape parameters of the beta law. Below, its draws underflow; above, they are a constant for all that f32 can tell.
pub const BETA_SHAPES: std::ops::RangeInclusive<f64> = 0.1..=1e3;

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

/// How one kind of pixel is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PixelLaw {
    /// The share of pixels that follow this law, relative to the weights of the others.
    #[serde(default = "one")]
    pub weight: f64,
    /// How many fragments.
    pub fragments: FragmentCount,
    /// Where they lie.
    pub depth: DepthLaw,
    /// How opaque they are.
    pub alpha: AlphaLaw,
    /// How much of the space between the planes the pixel fills: of the laws in moment depth, and of them alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<PixelRange>,
}

fn one() -> f64 {
    1.0
}

/// How many fragments a pixel has, ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FragmentCount {
    /// Least.
    pub min: u32,
    /// Greatest.
    pub max: u32,
    /// What is uniform between them.
    #[serde(default)]
    pub law: CountLaw,
}

/// What is uniform between the least and the greatest count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum CountLaw {
    /// The count.
    #[default]
    Uniform,
    /// Its logarithm: n is the whole part of a log-uniform number in [min, max + 1).
    LogUniform,
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

/// Where the fragments of a pixel lie.
///
/// [`Self::Window`] draws window depths. All others draw a shape, which [`PixelRange`] then puts between the camera's
/// planes in moment depth: the log warp from near to far, view_z = near (far/near)^((z + 1)/2). A shape lives in [0,
/// 1], and its lengths are shares of that.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum DepthLaw {
    /// Window depths uniform in a range.
    ///
    /// # Source
    /// NMT24 Sec. 3.2 gives "fragment depth ranges 0.3 to 1.0" and leaves open what it is a range of; [`DepthReading`]
    /// has the readings.
    Window {
        /// Least, in [0, 1].
        min: f64,
        /// Greatest, in [0, 1].
        max: f64,
        /// What the range is a range of.
        #[serde(default)]
        reading: DepthReading,
    },
    /// Uniform.
    // A unit variant would take any field without an error.
    Uniform {},
    /// Each fragment belongs to one of a few clusters and scatters about its centre, half of them by the normal and
    /// half by the uniform law; centres are uniform. Smoke, hair.
    Clustered {
        /// Number of clusters, uniform.
        clusters: CountRange,
        /// Standard deviation of a cluster, log-uniform, > 0.
        width: Range,
    },
    /// Thin closed surfaces: each has a front, uniform, and a back behind it. An odd last fragment is a front.
    Paired {
        /// Greatest distance from front to back, log-uniform, > 0; a pixel draws it once, and each of its surfaces is
        /// uniform in [0, gap].
        gap: Range,
    },
    /// The beta law, density proportional to x^(a − 1) (1 − x)^(b − 1): fragments crowd at one end, at both or in the
    /// middle.
    Beta {
        /// Exponent a, log-uniform, drawn once a pixel, in [`BETA_SHAPES`].
        a: Range,
        /// Exponent b, the same.
        b: Range,
    },
}

/// What the window depth range is a range of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum DepthReading {
    /// Each fragment's window depth is uniform in the range.
    #[default]
    PerFragment,
    /// A pixel's extent e = zmax − zmin is uniform in the range, its place uniform within [0, 1 − e]; one fragment lies
    /// at each end and the others are uniform between. A single fragment is uniform in [0, 1].
    PixelExtent,
}

/// How much of the space between the planes a pixel fills, in moment depth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PixelRange {
    /// Half the pixel's range, h: log-uniform, in (0, 1]. The centre c is uniform in [h − 1, 1 − h], and the drawn
    /// shape is stretched until its nearest fragment lies at c − h and its farthest at c + h. Fragments that all tie,
    /// or a single one, lie at c.
    pub half: Range,
}

/// How opaque the fragments of a pixel are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum AlphaLaw {
    /// Uniform.
    Uniform {
        /// Least, in [0, 1].
        min: f64,
        /// Greatest, in [0, 1].
        max: f64,
        /// Which fragments share a value.
        #[serde(default)]
        reading: AlphaReading,
    },
    /// Log-uniform.
    LogUniform {
        /// Least, in (0, 1].
        min: f64,
        /// Greatest, in (0, 1].
        max: f64,
        /// Which fragments share a value.
        #[serde(default)]
        reading: AlphaReading,
    },
    /// Each pixel draws a range of its own, both ends uniform in [min, max], and each fragment is uniform in that.
    Subrange {
        /// Least, in [0, 1].
        min: f64,
        /// Greatest, in [0, 1].
        max: f64,
    },
    /// Gaussian splats: each object draws a peak opacity, log-uniform, and a fragment of it is seen somewhere on the
    /// Gaussian's footprint down to where it has fallen to min: log-uniform in [min, peak]. Clusters are objects; under
    /// the other depth laws each fragment is one.
    Splats {
        /// Opacity at which a splat is cut off, in (0, 1].
        min: f64,
        /// Peak opacities, at least min.
        peak: Range,
    },
    /// Some fragments nearly opaque, uniform in [0.9, 1], the others faint, uniform in [0, low].
    NearOpaque {
        /// A fragment's probability of being nearly opaque, uniform, drawn once a pixel, in [0, 1].
        share: Range,
        /// Greatest opacity of the faint ones, log-uniform, drawn once a pixel, in (0, 1].
        low: Range,
    },
}

/// Which fragments of a pixel share one opacity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum AlphaReading {
    /// None: each draws its own.
    #[default]
    PerFragment,
    /// All of the pixel.
    PerPixel,
    /// Those of one object. The pixel draws one to four materials, and each object is made of one of them. Front and
    /// back of a paired surface are one object, as is a cluster; under the other depth laws each fragment is an object
    /// of its own.
    PerObject,
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
                depth: DepthLaw::Window {
                    min: 0.3,
                    max: 1.0,
                    reading: DepthReading::PerFragment,
                },
                alpha: AlphaLaw::Uniform {
                    min: 0.1,
                    max: 0.5,
                    reading: AlphaReading::PerFragment,
                },
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

impl PixelLaw {
    fn validate(&self, at: &str) -> Result<(), SynthError> {
        if !(self.weight > 0.0 && self.weight <= GREATEST_WEIGHT) {
            return Err(number(
                format!("{at}.weight"),
                self.weight,
                format!("be greater than 0 and at most {GREATEST_WEIGHT:e}"),
            ));
        }
        let FragmentCount { min, max, law: _ } = self.fragments;
        count(&format!("{at}.fragments"), CountRange { min, max })?;
        self.depth.validate(&format!("{at}.depth"))?;
        self.alpha.validate(&format!("{at}.alpha"))?;
        match (self.depth, self.range) {
            (DepthLaw::Window { .. }, None) => Ok(()),
            (DepthLaw::Window { .. }, Some(_)) => Err(SynthError::UnusedRange(at.to_owned())),
            (_, None) => Err(SynthError::MissingRange(at.to_owned())),
            (_, Some(PixelRange { half })) => above_zero(&format!("{at}.range.half"), half),
        }
    }
}

impl DepthLaw {
    fn validate(&self, at: &str) -> Result<(), SynthError> {
        match *self {
            Self::Window { min, max, reading: _ } => unit(at, Range { min, max }),
            Self::Uniform {} => Ok(()),
            Self::Clustered { clusters, width } => {
                count(&format!("{at}.clusters"), clusters)?;
                above_zero(&format!("{at}.width"), width)
            }
            Self::Paired { gap } => above_zero(&format!("{at}.gap"), gap),
            Self::Beta { a, b } => {
                let must = format!("lie in [{}, {}]", BETA_SHAPES.start(), BETA_SHAPES.end());
                [("a", a), ("b", b)]
                    .into_iter()
                    .try_for_each(|(name, r)| within(&format!("{at}.{name}"), r, |x| BETA_SHAPES.contains(&x), &must))
            }
        }
    }
}

impl AlphaLaw {
    fn validate(&self, at: &str) -> Result<(), SynthError> {
        match *self {
            Self::Uniform { min, max, reading: _ } | Self::Subrange { min, max } => unit(at, Range { min, max }),
            Self::LogUniform { min, max, reading: _ } => above_zero(at, Range { min, max }),
            Self::Splats { min, peak } => {
                above_zero(&format!("{at}.peak"), peak)?;
                above_zero(at, Range { min, max: peak.min })
            }
            Self::NearOpaque { share, low } => {
                unit(&format!("{at}.share"), share)?;
                above_zero(&format!("{at}.low"), low)
            }
        }
    }
}

fn number(field: String, value: f64, must: impl Into<String>) -> SynthError {
    SynthError::Number {
        field,
        value,
        must: must.into(),
    }
}

/// min and max in a domain, and in order.
fn within(at: &str, Range { min, max }: Range, domain: impl Fn(f64) -> bool, must: &str) -> Result<(), SynthError> {
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

fn unit(at: &str, range: Range) -> Result<(), SynthError> {
    within(at, range, |x| (0.0..=1.0).contains(&x), "lie in [0, 1]")
}

/// Of log-uniform numbers: 0 has no logarithm.
fn above_zero(at: &str, range: Range) -> Result<(), SynthError> {
    within(at, range, |x| x > 0.0 && x <= 1.0, "be greater than 0 and at most 1")
}

fn count(at: &str, CountRange { min, max }: CountRange) -> Result<(), SynthError> {
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

    fn law(depth: &str, alpha: &str) -> PixelLaw {
        let config = parse(&[
            ("depth", depth),
            ("alpha", alpha),
            ("range", "range = { half = { min = 0.1, max = 0.9 } }"),
        ])
        .unwrap();
        config.validate().unwrap();
        config.pixels[0]
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
    fn every_law_in_a_file_and_back() {
        let range = |min, max| Range { min, max };
        let depths = [
            ("depth = { law = 'uniform' }", DepthLaw::Uniform {}),
            (
                "depth = { law = 'clustered', clusters = { min = 1, max = 6 }, width = { min = 1e-3, max = 0.3 } }",
                DepthLaw::Clustered {
                    clusters: CountRange { min: 1, max: 6 },
                    width: range(1e-3, 0.3),
                },
            ),
            (
                "depth = { law = 'paired', gap = { min = 1e-3, max = 1 } }",
                DepthLaw::Paired { gap: range(1e-3, 1.0) },
            ),
            (
                "depth = { law = 'beta', a = { min = 0.3, max = 5 }, b = { min = 1, max = 2 } }",
                DepthLaw::Beta {
                    a: range(0.3, 5.0),
                    b: range(1.0, 2.0),
                },
            ),
        ];
        let alphas = [
            (
                "alpha = { law = 'uniform', min = 0, max = 1, reading = 'per-pixel' }",
                AlphaLaw::Uniform {
                    min: 0.0,
                    max: 1.0,
                    reading: AlphaReading::PerPixel,
                },
            ),
            (
                "alpha = { law = 'log-uniform', min = 0.01, max = 1, reading = 'per-object' }",
                AlphaLaw::LogUniform {
                    min: 0.01,
                    max: 1.0,
                    reading: AlphaReading::PerObject,
                },
            ),
            (
                "alpha = { law = 'subrange', min = 0, max = 1 }",
                AlphaLaw::Subrange { min: 0.0, max: 1.0 },
            ),
            (
                "alpha = { law = 'near-opaque', share = { min = 0, max = 0.5 }, low = { min = 0.01, max = 0.5 } }",
                AlphaLaw::NearOpaque {
                    share: range(0.0, 0.5),
                    low: range(0.01, 0.5),
                },
            ),
        ];
        for ((depth_text, depth), (alpha_text, alpha)) in depths.into_iter().zip(alphas) {
            let law = law(depth_text, alpha_text);
            assert_eq!(
                (law.depth, law.alpha, law.range),
                (depth, alpha, Some(PixelRange { half: range(0.1, 0.9) }))
            );
        }
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
        let range = |min, max| Range { min, max };
        let error = |change: &dyn Fn(&mut PixelLaw)| {
            let mut config = SynthConfig::wide();
            change(&mut config.pixels[2]);
            config.validate().unwrap_err().to_string()
        };
        let window = |min, max| DepthLaw::Window {
            min,
            max,
            reading: DepthReading::PerFragment,
        };
        let uniform = |min, max| AlphaLaw::Uniform {
            min,
            max,
            reading: AlphaReading::PerFragment,
        };
        let log_uniform = |min, max| AlphaLaw::LogUniform {
            min,
            max,
            reading: AlphaReading::PerFragment,
        };
        let clustered = |min, max, width| DepthLaw::Clustered {
            clusters: CountRange { min, max },
            width,
        };
        let near_opaque = |share, low| AlphaLaw::NearOpaque { share, low };
        let beta = |a, b| DepthLaw::Beta { a, b };
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
                error(&|law| law.depth = DepthLaw::Paired { gap: range(0.0, 1.0) }),
                error(&|law| law.depth = DepthLaw::Paired { gap: range(0.2, 0.1) }),
                error(&|law| law.depth = DepthLaw::Paired {
                    gap: range(0.2, f64::INFINITY)
                }),
                error(&|law| law.depth = beta(range(0.01, 1.0), range(1.0, 1.0))),
                error(&|law| law.depth = beta(range(1.0, 1.0), range(1.0, f64::NAN))),
                error(&|law| law.range = None),
                error(&|law| law.range = Some(PixelRange { half: range(0.0, 1.0) })),
                error(&|law| law.range = Some(PixelRange { half: range(0.5, 1.1) })),
                error(&|law| law.alpha = uniform(f64::NAN, 0.5)),
                error(&|law| law.alpha = uniform(0.1, -0.1)),
                error(&|law| law.alpha = uniform(0.5, 0.1)),
                error(&|law| law.alpha = log_uniform(0.0, 0.1)),
                error(&|law| law.alpha = AlphaLaw::Subrange { min: 0.0, max: 1.1 }),
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
