//! Methods as WGSL: networks by their exports, and what passes put before any method.

use super::{MethodShader, ShaderError, absorbance, log_ratio};
use crate::export::core::MAX_SHADER_MOMENTS;
use crate::export::dialect::Wgsl;
use crate::export::{Format, Target};
use crate::features::recentred::MAX_ABSORBANCE;
use crate::features::{FeatureSet, MomentDepthKind};
use crate::infer;
use crate::model::Mlp;
use crate::numeric::source::{Dialect, component};
use crate::oit::neural::Skip;
use crate::oit::shader::{Composite, Offers, Pass1, WEIGHT};
use crate::pixel::{CameraPlanes, FragmentList};

/// The function of a method that is spared what cannot be seen.
const VISIBLE_WEIGHT: &str = "oit_visible_weight";

impl MethodShader {
    /// A network, by the shader source that `format` exports.
    ///
    /// # Errors
    /// [`ShaderError`] where the format is no WGSL, the network does not fit into f16, or its answer is no
    /// transmittance.
    pub fn neural(mlp: &Mlp, format: Format) -> Result<Self, ShaderError> {
        let name = format!("neural:{}", mlp.name());
        let refused = |reason: String| ShaderError {
            label: name.clone(),
            reason,
        };
        if format.target() != Target::Wgsl {
            return Err(refused(format!("{} is not WGSL", format.name())));
        }
        let export = crate::export::encode(mlp, format).map_err(|e| refused(e.to_string()))?;
        let export = String::from_utf8(export).expect("shader source is text");
        let set = mlp.feature_set();
        if let Some(core) = set.spec().core {
            if core.moments > MAX_SHADER_MOMENTS {
                return Err(refused(format!(
                    "a core in shaders has {MAX_SHADER_MOMENTS} moments at most, and this one {}",
                    core.moments
                )));
            }
            let offers = Offers {
                short_weight: true,
                visibility: false,
            };
            return Ok(Self {
                source: export,
                offers,
                ..Self::of_core(name, core)
            });
        }
        let (glue, offers) = match set {
            FeatureSet::Recentred | FeatureSet::Recentred6 | FeatureSet::Recentred8 => {
                let offers = Offers {
                    short_weight: true,
                    visibility: true,
                };
                (recentred(set), offers)
            }
            FeatureSet::Paper => (include_str!("neural/paper.wgsl").to_owned(), Offers::default()),
            FeatureSet::DeepWeightedBlended => {
                return Err(refused(
                    "its answer is a blending weight, and has no place in these passes".to_owned(),
                ));
            }
            _ => unreachable!("what keeps a core is above"),
        };
        Ok(Self {
            sums: set.moments() + 1,
            range: true,
            depth: set.moment_depth(),
            composite: Composite::Normalised,
            pass1: Pass1::Added,
            core: None,
            offers,
            weight: WEIGHT,
            open: 0.0,
            source: format!("{export}{glue}"),
            name,
        })
    }

    /// No method: every weight is 1, once a fragment's depth and absorbance and its pixel's total are there, as every
    /// method has them.
    pub fn empty(name: &str) -> Self {
        let weight = include_str!("empty.wgsl");
        Self::of_total(name.to_owned(), MomentDepthKind::Log, Composite::Normalised, weight)
    }

    /// The same method for passes that look at one fragment at a time. With [`Skip::Visible`] a network is spared what
    /// cannot be seen; `None` and `Exact` are one text, whose branches the device takes or does not. A method that has
    /// no network keeps its weight.
    pub fn with_skip(self, skip: Skip) -> Self {
        let weight = if skip == Skip::Visible && self.offers.visibility {
            VISIBLE_WEIGHT
        } else {
            self.weight
        };
        let open = match skip {
            Skip::Visible if self.core.is_some() && self.offers.short_weight => 2.0 * infer::core::VISIBLE,
            _ => 0.0,
        };
        Self { weight, open, ..self }
    }

    /// Prelude and method, ready for a pass to stand behind it. Directives of the method's source, such as `enable
    /// f16;`, come first.
    pub fn module(&self) -> String {
        if let Some(set) = self.core {
            return super::core::module(set, &self.source, self.open);
        }
        let (directives, rest): (Vec<&str>, Vec<&str>) =
            self.source.lines().partition(|line| line.starts_with("enable "));
        let depth = match self.depth {
            MomentDepthKind::Log => log_ratio() + include_str!("depth_log.wgsl"),
            MomentDepthKind::Window | MomentDepthKind::None => include_str!("depth_window.wgsl").to_owned(),
        };
        format!(
            "{}\nconst OIT_SUMS = {}u;\n{}{}{depth}{}\n",
            directives.join("\n"),
            self.sums,
            include_str!("prelude.wgsl"),
            absorbance(),
            rest.join("\n")
        )
    }

    /// What `oit_depth` measures depths by: of the extremes v0, v1 of the scene v0 and 2/ln(v1/v0), 0 where they are
    /// one; or the camera's planes; or v0 and v1, where there is a core.
    ///
    /// # Errors
    /// [`ShaderError`] where planes are needed and unknown.
    pub fn depth_range(
        &self,
        list: &FragmentList,
        planes: Option<CameraPlanes>,
        depth_range: Option<(f32, f32)>,
    ) -> Result<[f32; 2], ShaderError> {
        if self.core.is_some() {
            let (v0, v1) = depth_range.or(list.depth_range()).unwrap_or((1.0, 1.0));
            return match v0 > 0.0 && v0 <= v1 && v1.is_finite() {
                true => Ok([v0, v1]),
                false => Err(ShaderError {
                    label: self.name.clone(),
                    reason: format!("depth range [{v0}, {v1}]; expected 0 < V0 <= V1, both finite"),
                }),
            };
        }
        match self.depth {
            MomentDepthKind::Window => {
                let planes = planes.or(list.planes()).ok_or_else(|| ShaderError {
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

/// What stands between a recentred network and the passes.
fn recentred(set: FeatureSet) -> String {
    let k = set.moments();
    let sums: Vec<String> = (1..=k).map(|i| format!("p.sums[{i}]")).collect();
    let moments: Vec<String> = (0..k).map(|i| component("m", k, i)).collect();
    let arguments =
        "f.v, f.z, f.absorbance, p.nearest, p.farthest, p.z_nearest, p.z_farthest, p.n, p.sums[0], OIT_PIXEL_MOMENTS";
    include_str!("neural/recentred.wgsl")
        .replace("OIT_ARGUMENTS", arguments)
        .replace("OIT_PIXEL_MOMENTS", &Wgsl.numbers(&sums))
        .replace("OIT_MOMENTS", &moments.join(", "))
        .replace("OIT_RECENTRED", &component("known", set.width() + 1, set.width()))
        .replace("OIT_MAX_ABSORBANCE", &format!("{:?}", MAX_ABSORBANCE as f32))
}
