//! The classic methods on the GPU beside their twins on the CPU.

use super::Gpu;
use crate::gpu::compute::{Source, run_rows};
use crate::gpu::list::weights;
use crate::gpu::tests::gpu;
use crate::numeric::rng::stream;
use crate::numeric::roots::real_roots;
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::weighted_blended::Weight;
use crate::oit::{self, Context, names_with_shader, shader_of};
use crate::pixel::{FragmentList, abuffer};
use crate::synth::{Purpose, Synth, SynthConfig};
use rand::RngExt;

const ROOTS: &str = include_str!("../numeric/roots.wgsl");

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
    let method = shader_of(name).unwrap();
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

/// Twins whose pass 1 is no sum: 99.9 % of T within 1e-4 of the CPU's f64, all within 1e-2, where a fragment lies
/// beside the border of a cell. Control: the answers of the twin before it.
#[test]
fn inserted_twins_answer_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let list = random(3000);
    let mut before: Option<Vec<f64>> = None;
    for name in [
        "wavelet:2",
        "wavelet:3",
        "wavelet:3+own",
        "wavelet:4+own",
        "hybrid:2",
        "hybrid:4",
        "hybrid:6",
    ] {
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

/// T of the twins of moment-based methods: 99 % within 1e-3 of the CPU's on the same f32 moments, all finite, and the
/// same T-MSE to 1 %. What lies further apart are fragments where the moments are nearly those of fewer atoms, which
/// rounding decides. Control: the answers of another number of moments.
#[test]
fn twins_answer_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let list = random(3000);
    let exact = abuffer::list_transmittance(&list);
    let mut before = None;
    for name in names_with_shader().into_iter().filter(|n| n.starts_with("moment")) {
        let (found, reference) = (on_gpu(gpu, &name, &list), on_cpu(&single(&name), &list));
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

/// Weights of the other twins within 5e-6 relative; within 1e-4 where 1 − w cancels, w the window depth. Control: the
/// weights of the function before it.
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
    assert_eq!(shader_of("weighted-blended").unwrap().name, "weighted-blended:mb13-9");
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

/// Where all fragments of a pixel are next to each other, published methods lose rank: at most 2 % of such answers may
/// fail to be finite or be above 1, and are counted; of `+own` none may, and it answers the nearest fragment, and
/// pixels without absorbance, by 1 exactly. Control: without `+own` the nearest is not 1.
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
    for name in names_with_shader().into_iter().filter(|n| n.starts_with("moment")) {
        let found = on_gpu(gpu, &name, &list);
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
    for name in names_with_shader().into_iter().filter(|n| n.starts_with("moment")) {
        assert!(on_gpu(gpu, &name, &clear).iter().all(|&t| t == 1.0), "{name}");
    }
}

/// Closed forms against the CPU's iteration in f64: cos(acos(x)/3) within 4e-7, roots of random polynomials, at least
/// 0.2 apart in [−3, 3], within 1e-3. Control: the roots of other polynomials.
#[test]
fn roots_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let x: Vec<f32> = (0..=10_000).map(|i| i as f32 / 5000.0 - 1.0).collect();
    let call = format!("{ROOTS}\nfn third(f: f32) -> f32 {{ return cosine_of_third(f); }}");
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
            let call = format!("{ROOTS}\nfn nth(f: vec{degree}<f32>) -> f32 {{ return {roots}[{index}]; }}");
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
    ] {
        assert_eq!(shader_of(name), None, "{name}");
    }
    // Every twin is known to the CPU, by the same name.
    for name in names_with_shader() {
        assert_eq!(oit::parse(&name).unwrap().name(), shader_of(&name).unwrap().name);
    }
}
