//! Pass 1, pass 2 and the resolve in one call each, with a vector for every render target: what stands behind the
//! functions of an export.

use super::shader::Language;
use crate::features::{FeatureSet, MomentDepthKind};

/// Render targets of four numbers that hold sums and the number of fragments; the target of the range comes behind
/// them.
pub fn targets(set: FeatureSet) -> usize {
    (set.moments() + 2).div_ceil(4)
}

/// Numbers that a target of sums holds: four, or what is left for the last.
pub fn channels(set: FeatureSet, target: usize) -> usize {
    (set.moments() + 2 - 4 * target).min(4)
}

/// Where a number stands among the targets: b_0 first, then moments, then the number of fragments.
fn place(number: usize) -> String {
    format!("sums{}.{}", number / 4, ["x", "y", "z", "w"][number % 4])
}

/// What a channel of the targets is called in comments.
fn channel_name(set: FeatureSet, number: usize) -> String {
    match number.cmp(&(set.moments() + 1)) {
        std::cmp::Ordering::Less => format!("b{number}"),
        std::cmp::Ordering::Equal => "number of fragments".to_owned(),
        std::cmp::Ordering::Greater => "0".to_owned(),
    }
}

/// Whether a set's answer is a transmittance that pass 2 makes of blended sums alone.
pub fn has_passes(set: FeatureSet) -> bool {
    matches!(
        set,
        FeatureSet::Paper | FeatureSet::Recentred | FeatureSet::Recentred6 | FeatureSet::Recentred8
    )
}

/// Source of `nmt_resolve`, the same for all that composite by Eq. 7 of NMT24.
pub fn resolve(language: Language) -> &'static str {
    match language {
        Language::Wgsl => include_str!("calls/resolve.wgsl"),
        Language::Glsl => include_str!("calls/resolve.glsl"),
        Language::Hlsl => include_str!("calls/resolve.hlsl"),
    }
}

/// Source of the calls of a feature set; none where it has no such passes.
pub fn source(language: Language, set: FeatureSet) -> String {
    if !has_passes(set) {
        return String::new();
    }
    let text = match (language, set.moment_depth()) {
        (Language::Wgsl, MomentDepthKind::Log) => include_str!("calls/recentred.wgsl"),
        (Language::Glsl, MomentDepthKind::Log) => include_str!("calls/recentred.glsl"),
        (Language::Hlsl, MomentDepthKind::Log) => include_str!("calls/recentred.hlsl"),
        (Language::Wgsl, MomentDepthKind::Window) => include_str!("calls/paper.wgsl"),
        (Language::Glsl, MomentDepthKind::Window) => include_str!("calls/paper.glsl"),
        (Language::Hlsl, MomentDepthKind::Window) => include_str!("calls/paper.hlsl"),
        (_, MomentDepthKind::None) => return String::new(),
    };
    let (k, targets) = (set.moments(), targets(set));
    let vector = ["vec4<f32>", "vec4", "float4"][language as usize];
    let declared = |target: usize| match language {
        Language::Wgsl => format!("sums{target}: {vector}"),
        Language::Glsl | Language::Hlsl => format!("{vector} sums{target}"),
    };
    let field = |target: usize| {
        let names: Vec<String> = (4 * target..4 * target + 4).map(|n| channel_name(set, n)).collect();
        let end = if language == Language::Wgsl { "," } else { ";" };
        format!(
            "    // ({}): blended by addition, cleared to 0.\n    {}{end}",
            names.join(", "),
            declared(target)
        )
    };
    let terms = |target: usize| {
        let term = |number: usize| match number {
            0 => "absorbance".to_owned(),
            n if n <= k => format!("b[{}]", n - 1),
            n if n == k + 1 => "1.0".to_owned(),
            _ => "0.0".to_owned(),
        };
        let terms: Vec<String> = (4 * target..4 * target + 4).map(term).collect();
        let vector = format!("{vector}({})", terms.join(", "));
        match language {
            Language::Wgsl | Language::Glsl => vector,
            Language::Hlsl => format!("    sums.sums{target} = {vector};"),
        }
    };
    let each = |f: &dyn Fn(usize) -> String, between: &str| (0..targets).map(f).collect::<Vec<_>>().join(between);
    let moments = (1..=k).map(place).collect::<Vec<_>>().join(", ");
    let (array, array_statement) = match language {
        Language::Wgsl => (format!("array<f32, {k}>({moments})"), String::new()),
        Language::Glsl => (format!("float[{k}]({moments})"), String::new()),
        Language::Hlsl => (String::new(), format!("    float b[{k}] = {{ {moments} }};")),
    };
    let moments_of = match language {
        Language::Wgsl | Language::Glsl => format!("float b[{k}] = nmt_moments(NMT_ARGUMENTS);"),
        Language::Hlsl => format!("float b[{k}];\n    nmt_moments(NMT_ARGUMENTS, b);"),
    };
    let arguments = "nmt_moment_depth(v, v0, v1), absorbance";
    text.replace("NMT_FIELDS", &each(&field, "\n"))
        .replace(
            "NMT_TERMS",
            &each(&terms, if language == Language::Hlsl { "\n" } else { ", " }),
        )
        .replace("NMT_PARAMETERS", &each(&declared, ", "))
        .replace("NMT_N", &place(k + 1))
        .replace("NMT_MOMENTS_ARRAY", &array_statement)
        .replace(
            &format!("NMT_MOMENTS_OF({arguments})"),
            &moments_of.replace("NMT_ARGUMENTS", arguments),
        )
        .replace("NMT_MOMENTS", &array)
        + resolve(language)
}
