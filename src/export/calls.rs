//! Pass 1, pass 2 and the resolve in one call each, with a vector for every render target: what stands behind the
//! functions of an export.

use super::dialect::Language;
use crate::features::FeatureSet;
use crate::numeric::source::Type;

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

/// Source of the calls of a feature set; none where it has no passes.
pub fn source(language: &dyn Language, set: FeatureSet) -> String {
    let Some(text) = language.calls(set.moment_depth()) else {
        return String::new();
    };
    let (k, targets) = (set.moments(), targets(set));
    let name = |target: usize| format!("sums{target}");
    let member = |target: usize| {
        let names: Vec<String> = (4 * target..4 * target + 4).map(|n| channel_name(set, n)).collect();
        format!(
            "    // ({}): blended by addition, cleared to 0.\n    {}",
            names.join(", "),
            language.member(&name(target), Type::Vec4)
        )
    };
    let term = |number: usize| match number {
        0 => "absorbance".to_owned(),
        n if n <= k => format!("b[{}]", n - 1),
        n if n == k + 1 => "1.0".to_owned(),
        _ => "0.0".to_owned(),
    };
    let terms = |target: usize| {
        let four: Vec<String> = (4 * target..4 * target + 4).map(term).collect();
        let vector = format!("{}({})", language.type_name(Type::Vec4), four.join(", "));
        (name(target), vector)
    };
    let members: Vec<String> = (0..targets).map(member).collect();
    let terms: Vec<_> = (0..targets).map(terms).collect();
    let parameters: Vec<String> = (0..targets).map(|t| language.declared(&name(t), Type::Vec4)).collect();
    let moments: Vec<String> = (1..=k).map(place).collect();
    let (statement, array) = language.array(Type::Reals(k), "b", &moments);
    let statement = statement.map_or(String::new(), |s| format!("    {s}"));
    let arguments = ["nmt_moment_depth(v, v0, v1)", "absorbance"].map(str::to_owned);
    let moments_of = language
        .call_array(Type::Reals(k), "b", "nmt_moments", &arguments)
        .join("\n    ");
    text.replace("NMT_FIELDS", &members.join("\n"))
        .replace("NMT_TERMS", &language.members("sums", &terms))
        .replace("NMT_PARAMETERS", &parameters.join(", "))
        .replace("NMT_N,", &format!("{},", place(k + 1)))
        .replace(
            "NMT_MOMENTS_ARRAY\n",
            &(statement.clone() + if statement.is_empty() { "" } else { "\n" }),
        )
        .replace(&format!("NMT_MOMENTS_OF({})", arguments.join(", ")), &moments_of)
        .replace("NMT_MOMENTS", &array)
        + language.resolve()
}
