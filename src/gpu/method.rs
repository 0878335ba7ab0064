//! A transparency method as WGSL: what pass 1 adds up, and the weight that pass 2 makes of it. One source serves
//! compute shaders and render passes.

use super::device::GpuError;
use crate::export::Format;
use crate::features::recentred::MAX_ABSORBANCE;
use crate::features::{FeatureSet, MomentDepthKind};
use crate::model::Mlp;
use crate::oit::neural::Skip;
use crate::pixel::{CameraPlanes, FragmentList};

/// How a pixel's colour is made of Σ a w C and Σ a w.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Composite {
    /// (1 − e^−b0)/Σ a w · Σ a w C + e^−b0 C_bg, b0 = sums\[0\].
    ///
    /// # Source
    /// NMT24 Eq. 7.
    Normalised,
    /// Σ a w C + (1 − Σ a w) C_bg; sums need not be kept.
    ///
    /// # Source
    /// Meshkin 2007, [`crate::oit::weighted_sum`].
    Sum,
    /// (1 − t)/Σ a w · Σ a w C + t C_bg with t = (1 − Σ a w/n)^n, n the number of fragments; C_bg alone where Σ a w is
    /// 0.
    ///
    /// # Source
    /// Bavoil, Myers 2008, [`crate::oit::weighted_average`].
    Average,
}

/// How pass 1 makes the numbers of a pixel from its fragments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pass1 {
    /// It adds up what `oit_accumulate` says of each fragment: by blending, or a thread a pixel.
    Added,
    /// It hands the numbers, zeros at first, from one fragment of the pixel to the next, with the pixel's nearest and
    /// farthest v, which a prepass has found: `fn oit_insert(sums: ptr<function, array<f32, K>>, f: OitFragment,
    /// nearest: f32, farthest: f32)`. A thread a pixel does it here; a renderer needs an interlock, or where the
    /// numbers are sums after all, blending and the prepass.
    Inserted,
}

/// A transparency method as WGSL.
///
/// # Contract
/// `source` defines, with `OitFragment` and `OitPixel` as `prelude.wgsl` has them and K = [`Self::sums`]:
/// - `fn oit_accumulate(f: OitFragment) -> array<f32, K>`: what pass 1 adds for a fragment; sums\[0\] is b0, the total
/// absorbance;
/// - `fn oit_weight(f: OitFragment, p: OitPixel) -> f32`: its weight in pass 2, transmittance in front of it;
/// - where there is a shorter way in pixels of up to four fragments, or of fragments at one depth, `fn
/// oit_short_weight`: there, the same numbers;
/// - with it `fn oit_end_weight`: the same number where a fragment is an end of its pixel or has next to nothing beside
/// it, else −1;
/// - where a network is spared what cannot be seen, `fn oit_visible_weight(f, p)`, `fn oit_faint_weight(f, p)`, `fn
/// oit_first_hidden_depth(p: OitPixel) -> f32` and `fn oit_hidden_weight(f, p)`, as
/// [`visible`](crate::features::visible) has them.
///
/// No name of it but these begins with `oit_`.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodShader {
    /// Name on the command line.
    pub name: String,
    /// Numbers that pass 1 adds up, K.
    pub sums: usize,
    /// Whether pass 2 looks at number and range of a pixel's fragments; where not, a renderer need not keep them.
    pub range: bool,
    /// How pass 1 makes them; where [`Pass1::Inserted`], the source defines `oit_insert` in place of `oit_accumulate`,
    /// and no sum need be b0.
    pub pass1: Pass1,
    /// Depth that `OitFragment.z` holds.
    pub depth: MomentDepthKind,
    /// How the colour is made.
    pub composite: Composite,
    /// WGSL.
    pub source: String,
}

impl MethodShader {
    /// A network, by the shader source that `format` exports.
    ///
    /// # Errors
    /// [`GpuError::Source`] where the format is no WGSL, the network does not fit into f16, or its answer is no
    /// transmittance.
    pub fn neural(mlp: &Mlp, format: Format) -> Result<Self, GpuError> {
        let label = || format!("neural:{}", mlp.name());
        let set = mlp.feature_set();
        if !matches!(
            format,
            Format::Wgsl | Format::WgslPlain | Format::WgslF16 | Format::WgslPlainF16
        ) {
            return Err(GpuError::Source {
                label: label(),
                reason: format!("{} is not WGSL", format.name()),
            });
        }
        let export = crate::export::encode(mlp, format).map_err(|e| GpuError::Source {
            label: label(),
            reason: e.to_string(),
        })?;
        let export = String::from_utf8(export).expect("shader source is text");
        let k = set.moments();
        let moments = |base: &str, from: usize| {
            (0..k)
                .map(|i| format!("{base}[{}]", i + from))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let glue = match set {
            FeatureSet::Recentred | FeatureSet::Recentred6 | FeatureSet::Recentred8 => format!(
                "
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {{
    let m = nmt_moments(f.z, f.absorbance);
    return array<f32, OIT_SUMS>(f.absorbance, {});
}}

fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {{
    return nmt_fragment_transmittance({look});
}}

fn oit_short_weight(f: OitFragment, p: OitPixel) -> f32 {{
    return nmt_recentred({look})[{width}];
}}

fn oit_end_weight(f: OitFragment, p: OitPixel) -> f32 {{
    let others = clamp(p.sums[0] - f.absorbance, 0.0, {most:?});
    let first = f.v == p.nearest || !(others > 1e-6 * p.sums[0]);
    return select(-1.0, min(exp(-select(others, 0.0, first)), 1.0), first || f.v == p.farthest);
}}

fn oit_faint_weight(f: OitFragment, p: OitPixel) -> f32 {{
    let end = oit_end_weight(f, p);
    return select(exp(-0.5 * clamp(p.sums[0] - f.absorbance, 0.0, {most:?})), end, end >= 0.0);
}}

fn oit_visible_weight(f: OitFragment, p: OitPixel) -> f32 {{
    return nmt_visible_transmittance({look});
}}

fn oit_first_hidden_depth(p: OitPixel) -> f32 {{
    return nmt_first_hidden_depth(p.sums[0], p.sums[1], p.sums[2]);
}}

fn oit_hidden_weight(f: OitFragment, p: OitPixel) -> f32 {{
    return nmt_hidden_weight(f.z, f.absorbance, p.z_nearest, p.z_farthest, p.n, p.sums[0], array<f32, {k}>({sums}));
}}
",
                moments("m", 0),
                sums = moments("p.sums", 1),
                look = format_args!(
                    "f.v, f.z, f.absorbance, p.nearest, p.farthest, p.z_nearest, p.z_farthest, p.n, p.sums[0], array<f32, {k}>({})",
                    moments("p.sums", 1)
                ),
                width = set.width(),
                most = MAX_ABSORBANCE as f32
            ),
            FeatureSet::Paper => "
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    let m = nmt_moments(f.z, f.absorbance);
    return array<f32, OIT_SUMS>(f.absorbance, m.x, m.y, m.z, m.w);
}

fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    return nmt_transmittance(nmt_features(f.z, p.z_nearest, p.z_farthest, p.n, p.sums[0], vec4<f32>(p.sums[1], p.sums[2], p.sums[3], p.sums[4])));
}
"
            .to_owned(),
            FeatureSet::DeepWeightedBlended => {
                return Err(GpuError::Source {
                    label: label(),
                    reason: "its answer is a blending weight, and has no place in these passes".to_owned(),
                });
            }
            _ => {
                return Err(GpuError::Source {
                    label: label(),
                    reason: "its core needs a buffer of slots, which these passes do not have".to_owned(),
                });
            }
        };
        let source = format!("{export}{glue}");
        Ok(Self {
            name: label(),
            sums: k + 1,
            range: true,
            pass1: Pass1::Added,
            depth: set.moment_depth(),
            composite: Composite::Normalised,
            source,
        })
    }

    /// The same method for passes that look at one fragment at a time. With [`Skip::Visible`] a network is spared what
    /// cannot be seen; `None` and `Exact` are one text, whose branches the device takes or does not. A method that has
    /// no network keeps its weight.
    pub fn with_skip(self, skip: Skip) -> Self {
        if skip != Skip::Visible || !self.tells_visible() {
            return self;
        }
        let source = self
            .source
            .replace("fn oit_weight(", "fn oit_exact_weight(")
            .replace("fn oit_visible_weight(", "fn oit_weight(");
        Self { source, ..self }
    }

    /// Whether the source can tell what cannot be seen.
    pub fn tells_visible(&self) -> bool {
        self.source.contains("fn oit_hidden_weight(")
    }

    /// Whether the source has a short form of the weight.
    pub fn has_short_weight(&self) -> bool {
        self.source.contains("fn oit_short_weight(")
    }

    /// Prelude and method, ready for a pass to stand behind it. Directives of the method's source, such as `enable
    /// f16;`, come first.
    pub fn module(&self) -> String {
        let (directives, rest): (Vec<&str>, Vec<&str>) =
            self.source.lines().partition(|line| line.starts_with("enable "));
        let depth = match self.depth {
            MomentDepthKind::Log => {
                "
// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
fn oit_log_ratio(a: f32, b: f32) -> f32 {
    let s = (a - b) / (a + b);
    let q = s * s;
    return select(log(a * (1.0 / b)), (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111)))), abs(s) < 0.2);
}

// Moment depth of v; range holds v0 and 2/ln(v1/v0), v0 and v1 the scene's least and greatest v, or 0 where they are
// one.
fn oit_depth(v: f32, range: vec2<f32>) -> f32 {
    return select(0.0, clamp(oit_log_ratio(v, range.x) * range.y - 1.0, -1.0, 1.0), range.y > 0.0);
}
"
            }
            MomentDepthKind::Window | MomentDepthKind::None => {
                "
// Window depth of v; range holds the camera's near and far planes.
fn oit_depth(v: f32, range: vec2<f32>) -> f32 {
    return clamp(range.y * (v - range.x) / (v * (range.y - range.x)), 0.0, 1.0);
}
"
            }
        };
        format!(
            "{}\nconst OIT_SUMS = {}u;\n{}{depth}{}\n",
            directives.join("\n"),
            self.sums,
            include_str!("prelude.wgsl"),
            rest.join("\n")
        )
    }

    /// What `oit_depth` measures depths by: of the extremes v0, v1 of the scene v0 and 2/ln(v1/v0), 0 where they are
    /// one; or the camera's planes.
    ///
    /// # Errors
    /// [`GpuError::Source`] where planes are needed and unknown.
    pub fn depth_range(
        &self,
        list: &FragmentList,
        planes: Option<CameraPlanes>,
        depth_range: Option<(f32, f32)>,
    ) -> Result<[f32; 2], GpuError> {
        match self.depth {
            MomentDepthKind::Window => {
                let planes = planes.or(list.planes()).ok_or_else(|| GpuError::Source {
                    label: self.name.clone(),
                    reason: crate::pixel::DepthError::NoPlanes.to_string(),
                })?;
                Ok([planes.near(), planes.far()])
            }
            MomentDepthKind::Log | MomentDepthKind::None => {
                let (v0, v1) = depth_range.or(list.depth_range()).unwrap_or((1.0, 1.0));
                let scale = if v1 > v0 {
                    2.0 / libm::log(f64::from(v1) / f64::from(v0))
                } else {
                    0.0
                };
                Ok([v0, scale as f32])
            }
        }
    }
}
