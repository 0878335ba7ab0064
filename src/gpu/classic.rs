//! The classic methods as WGSL: twins of `crate::oit`, the files beside the Rust that they are twins of.

use super::method::{Composite, MethodShader, Pass1};
use crate::features::MomentDepthKind;
use crate::moments::hamburger::OVERESTIMATION;
use crate::oit::weighted_blended::Weight;
use crate::oit::{hybrid, wavelet, weighted_average, weighted_blended, weighted_sum};

const ROOTS: &str = include_str!("../numeric/roots.wgsl");
const HAMBURGER: &str = include_str!("../moments/hamburger.wgsl");
const TRIGONOMETRIC: &str = include_str!("../moments/trigonometric.wgsl");
const WAVELET: &str = include_str!("../oit/wavelet.wgsl");
const HYBRID: &str = include_str!("../oit/hybrid.wgsl");
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

/// Names of twins whose pass 1 is [`Pass1::Inserted`], which only passes over lists run.
pub const INSERTED: [&str; 7] = [
    "wavelet:2",
    "wavelet:3",
    "wavelet:3+own",
    "wavelet:4+own",
    "hybrid:2",
    "hybrid:4",
    "hybrid:6",
];

/// Pass 1 of 2N power moments.
fn power_moments(k: usize) -> String {
    let lines: String = (1..k)
        .map(|i| {
            format!(
                "    let b{i} = {} * f.z;\n",
                if i == 1 { "b0".to_owned() } else { format!("b{}", i - 1) }
            )
        })
        .collect();
    let items: Vec<String> = (0..k).map(|i| format!("b{i}")).collect();
    format!(
        "\nfn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {{\n    let b0 = f.absorbance;\n{lines}    return array<f32, OIT_SUMS>({});\n}}\n",
        items.join(", ")
    )
}

/// Pass 1 of M trigonometric moments.
fn trigonometric_moments(m: usize) -> String {
    let lines: String = (2..=m)
        .map(|i| format!("    let b{i} = complex_times(b{}, x);\n", i - 1))
        .collect();
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

/// Pass 2 from the moments of the others: exact rules first, in this order; then their curve in the middle of its
/// bounds; where rounding makes that no transmittance, half of what is known to be there. (The CPU's tries all moments
/// before that, which 16-bit storage needs; in f32 it would double the work of devices that run both sides of a branch,
/// for what `classic::tests::hard_pixels` meets in one answer of thousands.)
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
        return min(exp(-others), 1.0);
    }}
    let own = oit_accumulate(f);
    let among_others = {curve}(array<f32, OIT_SUMS>({}), f.z, 0.5);
    // Whatever rounding makes of it, between none and all of the others lie in front. NaN compares with nothing.
    return clamp(select(exp(-0.5 * others), among_others, among_others < 1.001), min(exp(-others), 1.0), 1.0);
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
    /// Moments are f32, so that a storage of `:f32` changes nothing; the other storages have no twin. Unlike the CPU's,
    /// which are f64 after pass 1, all arithmetic is f32.
    ///
    /// # Accuracy
    /// Against the CPU's method on the same f32 moments: `classic::tests::twins_answer_as_on_the_cpu`.
    pub fn classic(name: &str) -> Option<Self> {
        let (plain, own) = name.strip_suffix("+own").map_or((name, false), |plain| (plain, true));
        let (head, argument) = plain
            .split_once(':')
            .map_or((plain, None), |(head, argument)| (head, Some(argument)));
        let of_moments = |source: &str, accumulate: String, curve: String, k: usize| {
            let weight = if own { without_own(&curve, k) } else { with_own(&curve) };
            let source = format!("{ROOTS}\n{source}{accumulate}{weight}");
            Self {
                name: name.to_owned(),
                sums: k,
                range: own,
                depth: MomentDepthKind::Log,
                pass1: Pass1::Added,
                composite: Composite::Normalised,
                source,
            }
        };
        let moments = |head: &str| head.rsplit_once('-').and_then(|(_, count)| count.parse::<usize>().ok());
        match (head, argument) {
            ("moment-power-4" | "moment-power-6" | "moment-power-8", None | Some("f32")) => {
                let m = moments(head)?;
                Some(of_moments(
                    HAMBURGER,
                    power_moments(m + 1),
                    format!("power_transmittance_{m}"),
                    m + 1,
                ))
            }
            ("moment-trig-2" | "moment-trig-3" | "moment-trig-4", None | Some("f32")) => {
                let m = moments(head)?;
                Some(of_moments(
                    TRIGONOMETRIC,
                    trigonometric_moments(m),
                    format!("trigonometric_transmittance_{m}"),
                    2 * m + 1,
                ))
            }
            (wavelet::NAME, Some(argument)) => {
                Self::wavelet(name, argument.strip_suffix(":f32").unwrap_or(argument), own)
            }
            _ if own => None,
            (hybrid::NAME, Some(argument)) => Self::hybrid(name, argument),
            (weighted_sum::NAME, None) => Some(Self::alike(name, Composite::Sum)),
            (weighted_average::NAME, None) => Some(Self::alike(name, Composite::Average)),
            (weighted_blended::NAME, argument) => {
                let weight = match argument {
                    None => Weight::default(),
                    Some(text) => Weight::ALL.into_iter().find(|w| w.name() == text)?,
                };
                let depth = if weight == Weight::Mb13Eq10 {
                    MomentDepthKind::Window
                } else {
                    MomentDepthKind::None
                };
                let call = format!(
                    "\nfn oit_weight(f: OitFragment, p: OitPixel) -> f32 {{\n    return weight_{}(f.v, f.z, f.alpha);\n}}\n",
                    weight.name().replace('-', "_")
                );
                Some(Self {
                    name: format!("{head}:{}", weight.name()),
                    sums: 1,
                    range: false,
                    pass1: Pass1::Added,
                    depth,
                    composite: Composite::Normalised,
                    source: format!("{WEIGHTED_BLENDED}{TOTAL}{call}"),
                })
            }
            _ => None,
        }
    }

    /// Wavelet transparency of a rank from 1 to 4, which keeps at most 32 numbers a pixel.
    fn wavelet(name: &str, rank: &str, own: bool) -> Option<Self> {
        let rank = rank.parse::<usize>().ok().filter(|rank| (1..=4).contains(rank))?;
        let source = format!("\nconst WAVELET_RANK = {rank}u;\nconst WAVELET_LOG = {own};\n{WAVELET}");
        Some(Self::inserted(name, 2 << rank, source))
    }

    /// Hybrid transparency with a core of 1 to 8.
    fn hybrid(name: &str, core: &str) -> Option<Self> {
        let core = core.parse::<usize>().ok().filter(|core| (1..=8).contains(core))?;
        Some(Self::inserted(
            name,
            3 * core + 3,
            format!("\nconst HYBRID_CORE = {core}u;\n{HYBRID}"),
        ))
    }

    fn inserted(name: &str, sums: usize, source: String) -> Self {
        Self {
            name: name.to_owned(),
            sums,
            range: true,
            pass1: Pass1::Inserted,
            depth: MomentDepthKind::None,
            composite: Composite::Normalised,
            source,
        }
    }

    /// No method: every weight is 1, once a fragment's depth and absorbance and its pixel's total are there, as every
    /// method has them.
    pub fn empty(name: &str) -> Self {
        let weight = "
fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    // No finite input makes it 0, but no compiler knows that.
    return select(1.0, 0.0, f.z + f.absorbance + p.sums[0] > 1e30);
}
";
        let source = format!("{TOTAL}{weight}");
        Self {
            name: name.to_owned(),
            sums: 1,
            range: false,
            depth: MomentDepthKind::Log,
            pass1: Pass1::Added,
            composite: Composite::Normalised,
            source,
        }
    }

    /// A method that weighs all fragments alike.
    fn alike(name: &str, composite: Composite) -> Self {
        let source = format!("{TOTAL}{ALIKE}");
        Self {
            name: name.to_owned(),
            sums: 1,
            range: composite == Composite::Average,
            depth: MomentDepthKind::None,
            pass1: Pass1::Added,
            composite,
            source,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Gpu;
    use crate::gpu::compute::{Source, run_rows};
    use crate::gpu::list::weights;
    use crate::gpu::tests::gpu;
    use crate::numeric::rng::stream;
    use crate::numeric::roots::real_roots;
    use crate::numeric::tolerance::AbsoluteError;
    use crate::oit::{self, Context};
    use crate::pixel::{FragmentList, abuffer};
    use crate::synth::{Purpose, Synth, SynthConfig};
    use rand::RngExt;

    /// Random pixels of the paper's distribution; moments are of logarithmic depth.
    fn random(pixels: usize) -> FragmentList {
        Synth::new(SynthConfig::paper(), 5)
            .unwrap()
            .pixels(Purpose::Evaluation, 0, pixels)
    }

    /// How far answers are apart, least first, relative to `scale`; what is not finite counts as 9.
    fn apart(a: &[f64], b: &[f64], scale: impl Fn(f64) -> f64) -> Vec<f64> {
        assert!(a.len() == b.len() && a.len() > 100);
        let difference = |(a, b): (&f64, &f64)| (a - b).abs() / scale(*b);
        let mut d: Vec<f64> = a
            .iter()
            .zip(b)
            .map(difference)
            .map(|d| if d.is_finite() { d } else { 9.0 })
            .collect();
        d.sort_by(f64::total_cmp);
        d
    }

    fn on_gpu(gpu: &Gpu, name: &str, list: &FragmentList) -> Vec<f64> {
        let method = MethodShader::classic(name).unwrap();
        weights(gpu, &method, list, None, None)
            .unwrap()
            .into_iter()
            .map(f64::from)
            .collect()
    }

    fn on_cpu(name: &str, list: &FragmentList) -> Vec<f64> {
        oit::weights(
            list,
            &*oit::parse(name).unwrap().accumulate(list, Context::default()).unwrap(),
        )
    }

    /// The CPU's method with moments that are stored as the GPU stores them.
    fn single(name: &str) -> String {
        match name.strip_suffix("+own") {
            Some(plain) => format!("{plain}:f32+own"),
            None => format!("{name}:f32"),
        }
    }

    /// T of the twins of moment-based methods: 99 % within 1e-3 of the CPU's on the same f32 moments, all finite, and
    /// the same T-MSE to 1 %. What lies further apart are fragments where the moments are nearly those of fewer atoms,
    /// which rounding decides. Control: the answers of another number of moments.
    #[test]
    fn twins_answer_as_on_the_cpu() {
        let Some(gpu) = gpu() else { return };
        let list = random(3000);
        let exact = abuffer::list_transmittance(&list);
        let mut before = None;
        for name in NAMES.into_iter().filter(|n| n.starts_with("moment")) {
            let (found, reference) = (on_gpu(gpu, name, &list), on_cpu(&single(name), &list));
            let d = apart(&found, &reference, |_| 1.0);
            let (most, worst) = (d[d.len() * 99 / 100], d[d.len() - 1]);
            let [ours, theirs] = [&found, &reference].map(|t| AbsoluteError::of(t, &exact).mse());
            println!("{name}: 99 % within {most:.1e}, all within {worst:.1e}, T-MSE {ours:.4e} against {theirs:.4e}");
            assert!(most <= 1e-3 && worst < 1.0, "{name}: {most:e} {worst:e}");
            assert!((ours / theirs - 1.0).abs() <= 0.01, "{name}: {ours:e} {theirs:e}");
            if let Some(before) = before.replace(reference) {
                let d = apart(&found, &before, |_| 1.0);
                assert!(d[d.len() * 99 / 100] > 1e-2, "{name} as the method before it");
            }
        }
    }

    /// Twins whose pass 1 is no sum: 99.9 % of T within 1e-4 of the CPU's f64, all within 1e-2, where a fragment lies
    /// beside the border of a cell. Control: the answers of the twin before it.
    #[test]
    fn inserted_twins_answer_as_on_the_cpu() {
        let Some(gpu) = gpu() else { return };
        let list = random(3000);
        let mut before: Option<Vec<f64>> = None;
        for name in INSERTED {
            let (found, reference) = (on_gpu(gpu, name, &list), on_cpu(name, &list));
            let d = apart(&found, &reference, |_| 1.0);
            let (most, worst) = (d[d.len() * 999 / 1000], d[d.len() - 1]);
            println!("{name}: 99.9 % within {most:.1e}, all within {worst:.1e}");
            assert!(most <= 1e-4 && worst <= 1e-2, "{name}: {most:e} {worst:e}");
            if let Some(before) = before.replace(reference) {
                let d = apart(&found, &before, |_| 1.0);
                assert!(d[d.len() / 2] > 1e-4, "{name} as the method before it");
            }
        }
    }

    /// Weights of the other twins within 5e-6 relative; within 1e-4 where 1 − w cancels, w the window depth. Control:
    /// the weights of the function before it.
    #[test]
    fn blending_weights_are_those_of_the_cpu() {
        let Some(gpu) = gpu() else { return };
        let list = random(300);
        let mut before = None;
        for name in ["weighted-sum".to_owned(), "weighted-average".to_owned()]
            .into_iter()
            .chain(Weight::ALL.map(|w| format!("weighted-blended:{}", w.name())))
        {
            let (found, reference) = (on_gpu(gpu, &name, &list), on_cpu(&name, &list));
            let d = apart(&found, &reference, f64::abs);
            let tolerance = if name.ends_with("mb13-10") { 1e-4 } else { 5e-6 };
            assert!(d[d.len() - 1] <= tolerance, "{name}: {:e}", d[d.len() - 1]);
            if let Some(before) = before.replace(reference).filter(|_| name != "weighted-average") {
                assert!(
                    apart(&found, &before, f64::abs)[d.len() - 1] > tolerance,
                    "{name} as the method before it"
                );
            }
        }
        assert_eq!(
            MethodShader::classic("weighted-blended").unwrap().name,
            "weighted-blended:mb13-9"
        );
    }

    /// Pixels that are hard: empty, of one fragment, of two next to each other, of ties, faint and opaque.
    fn hard() -> FragmentList {
        let mut rng = stream(3, 79, 0);
        let mut offsets = vec![0];
        let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
        for p in 0..4000 {
            let v = 0.1 * 1000f32.powf(rng.random());
            for i in 0..p % 4 {
                view_z.push(match p % 5 {
                    0 => v,
                    1 => v * (1.0 + 1e-6 * i as f32),
                    2 => v * (1.0 + 1e-3 * i as f32),
                    _ => 0.1 * 1000f32.powf(rng.random()),
                });
                alpha.push(match rng.random_range(0..6) {
                    0 => 0.0,
                    1 => 1.0,
                    2 => 1e-6,
                    _ => rng.random_range(0.0f32..1.0),
                });
            }
            offsets.push(view_z.len() as u64);
        }
        FragmentList::new(offsets, view_z, alpha, None).unwrap()
    }

    /// Where all fragments of a pixel are next to each other, published methods lose rank: at most 2 % of such answers
    /// may fail to be finite or be above 1, and are counted; of `+own` none may, and it answers the nearest fragment,
    /// and pixels without absorbance, by 1 exactly. Control: without `+own` the nearest is not 1.
    #[test]
    fn hard_pixels() {
        let Some(gpu) = gpu() else { return };
        let list = hard();
        let nearest: Vec<f32> = (0..list.pixels())
            .flat_map(|p| {
                let pixel = list.pixel(p);
                let least = pixel.view_z.iter().copied().fold(f32::INFINITY, f32::min);
                pixel
                    .view_z
                    .iter()
                    .map(move |&v| if v == least { 1.0 } else { 0.0 })
                    .collect::<Vec<_>>()
            })
            .collect();
        for name in NAMES.into_iter().filter(|n| n.starts_with("moment")) {
            let found = on_gpu(gpu, name, &list);
            let bad = found.iter().filter(|t| !(0.0..=1.001).contains(*t)).count();
            println!("{name}: {bad} of {} answers are no transmittance", found.len());
            let front = found.iter().zip(&nearest).filter(|(_, n)| **n == 1.0);
            if name.ends_with("+own") {
                assert_eq!(bad, 0, "{name}");
                assert!(
                    front.clone().count() > 1000 && front.clone().all(|(t, _)| *t == 1.0),
                    "{name}"
                );
            } else {
                assert!(bad * 50 <= found.len(), "{name}: {bad}");
                assert!(front.clone().any(|(t, _)| *t < 0.99), "{name}");
            }
        }
        let clear = FragmentList::new(
            vec![0, 200],
            (1..=200).map(|v| v as f32).collect(),
            vec![0.0; 200],
            None,
        )
        .unwrap();
        for name in NAMES.into_iter().filter(|n| n.starts_with("moment")) {
            assert!(on_gpu(gpu, name, &clear).iter().all(|&t| t == 1.0), "{name}");
        }
    }

    /// Closed forms against the CPU's iteration in f64: cos(acos(x)/3) within 4e-7, roots of random polynomials, at
    /// least 0.2 apart in [−3, 3], within 1e-3. Control: the roots of other polynomials.
    #[test]
    fn roots_are_those_of_the_cpu() {
        let Some(gpu) = gpu() else { return };
        let x: Vec<f32> = (0..=10_000).map(|i| i as f32 / 5000.0 - 1.0).collect();
        let call = format!("{ROOTS}\nfn third(f: array<f32, 1>) -> f32 {{ return cosine_of_third(f[0]); }}");
        let found = run_rows(gpu, Source::Wgsl(&call), "third", &x, 1).unwrap();
        // Near −1 the argument's own rounding counts, half an ulp of 1 + x through a square root.
        let worst = x
            .iter()
            .zip(&found)
            .map(|(&x, &g)| (f64::from(g) - libm::cos(libm::acos(x.into()) / 3.0)).abs())
            .fold(0.0, f64::max);
        assert!(worst <= 4e-7, "{worst:e}");

        let mut rng = stream(9, 80, 0);
        for (degree, roots) in [
            (2, "quadratic_roots(0.5 * f[1], f[0])"),
            (3, "cubic_roots(f[2], f[1], f[0])"),
            (4, "quartic_roots(f[3], f[2], f[1], f[0])"),
        ] {
            let mut rows = Vec::new();
            for _ in 0..1000 {
                let mut at = -3.0 + rng.random_range(0.0..1.0f64);
                let mut c = vec![1.0];
                for _ in 0..degree {
                    c.push(0.0);
                    for k in (0..c.len()).rev() {
                        c[k] = if k > 0 { c[k - 1] } else { 0.0 } - at * c[k];
                    }
                    at += rng.random_range(0.2..1.4);
                }
                rows.extend(c[..degree].iter().map(|&c| c as f32));
            }
            for index in 0..degree {
                let call = format!("{ROOTS}\nfn nth(f: array<f32, {degree}>) -> f32 {{ return {roots}[{index}]; }}");
                let found: Vec<f64> = run_rows(gpu, Source::Wgsl(&call), "nth", &rows, degree)
                    .unwrap()
                    .into_iter()
                    .map(f64::from)
                    .collect();
                let expected: Vec<f64> = rows
                    .chunks(degree)
                    .map(|c| real_roots(&c.iter().map(|&c| f64::from(c)).chain([1.0]).collect::<Vec<_>>())[index])
                    .collect();
                let worst = *apart(&found, &expected, |_| 1.0).last().unwrap();
                println!("degree {degree}, root {index}: {worst:.1e}");
                assert!(worst <= 1e-3, "{degree} {index}: {worst:e}");
                let turned: Vec<f64> = expected[1..].iter().chain(&expected[..1]).copied().collect();
                assert!(apart(&found, &turned, |_| 1.0)[500] > 1e-3);
            }
        }
    }

    #[test]
    fn what_has_no_twin() {
        for name in [
            "abuffer",
            "moment-power-5",
            "moment-power-4:unorm16",
            "weighted-sum+own",
            "weighted-blended:mb13",
            "moment-trig-4:nlqm+own",
            "weighted-sum:2",
            "wavelet:3:f16",
            "wavelet:5",
            "hybrid:9",
        ] {
            assert_eq!(MethodShader::classic(name), None, "{name}");
        }
        // Every twin is known to the CPU, by the same name.
        for name in NAMES.into_iter().chain(INSERTED) {
            assert_eq!(
                oit::parse(name).unwrap().name(),
                MethodShader::classic(name).unwrap().name
            );
        }
    }
}
