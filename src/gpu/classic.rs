//! The classic methods as WGSL: twins of `crate::oit`, the files beside the Rust that they are twins of.

use super::method::{Composite, MethodShader};
use crate::features::MomentDepthKind;
use crate::moments::hamburger::OVERESTIMATION;
use crate::oit::weighted_blended::Weight;
use crate::oit::{weighted_average, weighted_blended, weighted_sum};

const ROOTS: &str = include_str!("../numeric/roots.wgsl");
const HAMBURGER: &str = include_str!("../moments/hamburger.wgsl");
const TRIGONOMETRIC: &str = include_str!("../moments/trigonometric.wgsl");
const WEIGHTED_BLENDED: &str = include_str!("../oit/weighted_blended.wgsl");

/// Names that [`MethodShader::classic`] knows, for a list of all; weighted blending with its default weight.
pub const NAMES: [&str; 15] = [
    "weighted-sum",
    "weighted-average",
    "weighted-blended",
    "moment-power-4",
    "moment-power-6",
    "moment-power-8",
    "moment-trig-2",
    "moment-trig-3",
    "moment-trig-4",
    "moment-power-4+own",
    "moment-power-6+own",
    "moment-power-8+own",
    "moment-trig-2+own",
    "moment-trig-3+own",
    "moment-trig-4+own",
];

/// Pass 1 of 2N power moments.
fn power_moments(k: usize) -> String {
    let lines: String = (1..k).map(|i| format!("    let b{i} = {} * f.z;\n", if i == 1 { "b0".to_owned() } else { format!("b{}", i - 1) })).collect();
    let items: Vec<String> = (0..k).map(|i| format!("b{i}")).collect();
    format!(
        "\nfn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {{\n    let b0 = f.absorbance;\n{lines}    return array<f32, OIT_SUMS>({});\n}}\n",
        items.join(", ")
    )
}

/// Pass 1 of M trigonometric moments.
fn trigonometric_moments(m: usize) -> String {
    let lines: String = (2..=m).map(|i| format!("    let b{i} = complex_times(b{}, x);\n", i - 1)).collect();
    let items: Vec<String> = (1..=m).map(|i| format!("b{i}.x, b{i}.y")).collect();
    format!(
        "\nfn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {{\n    let x = complex_square(half_circle_point(f.z));\n    let b1 = x * f.absorbance;\n{lines}    \
         return array<f32, OIT_SUMS>(f.absorbance, {});\n}}\n",
        items.join(", ")
    )
}

/// Pass 2 from all moments; where nothing absorbs anything, T is 1.
fn with_own(curve: &str) -> String {
    format!(
        "
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {{
    return select({curve}(p.sums, f.z, {OVERESTIMATION}), 1.0, p.sums[0] == 0.0);
}}
"
    )
}

/// Pass 2 from the moments of the others: exact rules first, in this order; then their curve in the middle of its bounds; where rounding makes that no
/// transmittance, the curve of all; failing that, half of what is known to be there.
fn without_own(curve: &str, k: usize) -> String {
    let others: Vec<String> = (0..k).map(|i| format!("p.sums[{i}] - own[{i}]")).collect();
    format!(
        "
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {{
    let others = max(p.sums[0] - f.absorbance, 0.0);
    if (f.v == p.nearest || others <= 1e-6 * p.sums[0]) {{
        return 1.0;
    }}
    if (f.v == p.farthest) {{
        return exp(-others);
    }}
    let own = oit_accumulate(f);
    let among_others = {curve}(array<f32, OIT_SUMS>({}), f.z, 0.5);
    // NaN compares with nothing.
    if (among_others < 1.001) {{
        return among_others;
    }}
    let among_all = {curve}(p.sums, f.z, {OVERESTIMATION});
    return select(exp(-0.5 * others), among_all, among_all < 1.001);
}}
",
        others.join(", ")
    )
}

/// Pass 1 of methods that look at opacity alone: b0.
const TOTAL: &str = "
fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    return array<f32, OIT_SUMS>(f.absorbance);
}
";

/// Pass 2 of methods that weigh all fragments alike.
const ALIKE: &str = "
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    return 1.0;
}
";

impl MethodShader {
    /// The twin of a classic method by its name on the command line; none where it has no twin.
    ///
    /// Moments are f32, so that a storage of `:f32` changes nothing; the other storages have no twin. Unlike the CPU's, which are f64 after pass 1, all
    /// arithmetic is f32.
    ///
    /// # Accuracy
    /// Against the CPU's method on the same f32 moments: `classic::tests::twins_answer_as_on_the_cpu`.
    pub fn classic(name: &str) -> Option<Self> {
        let (plain, own) = name.strip_suffix("+own").map_or((name, false), |plain| (plain, true));
        let (head, argument) = plain.split_once(':').map_or((plain, None), |(head, argument)| (head, Some(argument)));
        let of_moments = |source: &str, accumulate: String, curve: String, k: usize| {
            let weight = if own { without_own(&curve, k) } else { with_own(&curve) };
            let source = format!("{ROOTS}\n{source}{accumulate}{weight}");
            Self { name: name.to_owned(), sums: k, range: own, depth: MomentDepthKind::Log, composite: Composite::Normalised, source }
        };
        let moments = |head: &str| head.rsplit_once('-').and_then(|(_, count)| count.parse::<usize>().ok());
        match (head, argument) {
            ("moment-power-4" | "moment-power-6" | "moment-power-8", None | Some("f32")) => {
                let m = moments(head)?;
                Some(of_moments(HAMBURGER, power_moments(m + 1), format!("power_transmittance_{m}"), m + 1))
            }
            ("moment-trig-2" | "moment-trig-3" | "moment-trig-4", None | Some("f32")) => {
                let m = moments(head)?;
                Some(of_moments(TRIGONOMETRIC, trigonometric_moments(m), format!("trigonometric_transmittance_{m}"), 2 * m + 1))
            }
            _ if own => None,
            (weighted_sum::NAME, None) => Some(Self::alike(name, Composite::Sum)),
            (weighted_average::NAME, None) => Some(Self::alike(name, Composite::Average)),
            (weighted_blended::NAME, argument) => {
                let weight = match argument {
                    None => Weight::default(),
                    Some(text) => Weight::ALL.into_iter().find(|w| w.name() == text)?,
                };
                let depth = if weight == Weight::Mb13Eq10 { MomentDepthKind::Window } else { MomentDepthKind::None };
                let call = format!(
                    "\nfn oit_weight(f: OitFragment, p: OitPixel) -> f32 {{\n    return weight_{}(f.v, f.z, f.alpha);\n}}\n",
                    weight.name().replace('-', "_")
                );
                Some(Self {
                    name: format!("{head}:{}", weight.name()),
                    sums: 1,
                    range: false,
                    depth,
                    composite: Composite::Normalised,
                    source: format!("{WEIGHTED_BLENDED}{TOTAL}{call}"),
                })
            }
            _ => None,
        }
    }

    /// A method that weighs all fragments alike.
    pub(crate) fn alike(name: &str, composite: Composite) -> Self {
        let source = format!("{TOTAL}{ALIKE}");
        Self { name: name.to_owned(), sums: 1, range: composite == Composite::Average, depth: MomentDepthKind::None, composite, source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::list::weights;
    use crate::gpu::tests::gpu;
    use crate::numeric::tolerance::AbsoluteError;
    use crate::oit::{self, Context};
    use crate::pixel::{CameraPlanes, FragmentList, abuffer};
    use crate::synth::{Purpose, Synth, SynthConfig};

    /// Random pixels of the paper's distribution; moments are of logarithmic depth.
    fn random(pixels: usize) -> FragmentList {
        Synth::new(SynthConfig::paper(), 5).unwrap().pixels(Purpose::Evaluation, 0, pixels)
    }

    /// How far answers are apart, least first; what is not finite counts as 9.
    fn apart(a: &[f32], b: &[f64]) -> Vec<f64> {
        assert_eq!(a.len(), b.len());
        let mut d: Vec<f64> = a.iter().zip(b).map(|(&a, b)| (f64::from(a) - b).abs()).map(|d| if d.is_finite() { d } else { 9.0 }).collect();
        d.sort_by(f64::total_cmp);
        d
    }

    fn cpu(name: &str, list: &FragmentList) -> Vec<f64> {
        oit::weights(list, &*oit::parse(name).unwrap().accumulate(list, Context::default()).unwrap())
    }

    #[test]
    fn probe() {
        let Some(gpu) = gpu() else { return };
        let list = random(3000);
        let exact = abuffer::list_transmittance(&list);
        for name in NAMES {
            let method = MethodShader::classic(name).unwrap();
            let found = weights(gpu, &method, &list, None, None).unwrap();
            let stored =
                name.starts_with("moment").then(|| name.replace("+own", ":f32+own")).map(|n| if n.contains(":f32") { n } else { format!("{n}:f32") });
            let reference = cpu(&stored.unwrap_or(name.to_owned()), &list);
            let d = apart(&found, &reference);
            let f: Vec<f64> = found.iter().map(|&x| x.into()).collect();
            let at = |q: f64| d[((d.len() - 1) as f64 * q) as usize];
            println!(
                "{name}: 50% {:.1e} 99% {:.1e} 99.9% {:.1e} worst {:.1e} mse {:.4e} cpu {:.4e} nonfinite {}",
                at(0.5),
                at(0.99),
                at(0.999),
                at(1.0),
                AbsoluteError::of(&f, &exact).mse(),
                AbsoluteError::of(&reference, &exact).mse(),
                f.iter().filter(|x| !x.is_finite()).count()
            );
        }
    }
}
