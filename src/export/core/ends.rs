//! Both ends of a pixel in render targets that are blended into, for cores without heavy fragments: how their codes
//! become numbers of which blending keeps the greater, and both passes in one call each.
//!
//! The chain hands the farthest slot what is left of the nearest; blending offers every fragment to both. The slots are
//! the same but in pixels of one depth step, where no fragment is in front of another and every T is 1.

use super::weigh::LANES;
use super::{dialect, piece};
use crate::export::Target;
use crate::export::calls::{names, structure, targets_of};
use crate::features::core::CoreSet;
use crate::numeric::source::{Source, Type};

/// What pass 1 adds to each target of sums: vectors of `absorbance`, the moments `b` and `n`.
pub fn terms(set: CoreSet, language: Target) -> Vec<String> {
    let vector = dialect(language).type_name(Type::Vec4);
    let term = |number: usize| match number {
        0 => "absorbance".to_owned(),
        k if k <= set.moments => format!("b.{}", LANES[k - 1]),
        k if k == set.moments + 1 => "n".to_owned(),
        _ => "0.0".to_owned(),
    };
    let of_target = |target: usize| {
        let terms: Vec<String> = (4 * target..4 * target + 4).map(term).collect();
        format!("{vector}({})", terms.join(", "))
    };
    (0..targets_of(set.moments)).map(of_target).collect()
}

/// Where pass 2 finds a number of the targets: b_0 first, then the moments, then the number of fragments.
pub fn sum(number: usize) -> String {
    format!("sums{}.{}", number / 4, LANES[number % 4])
}

/// The four moments that `nmt_core_transmittance` takes, from the targets.
pub fn moments(set: CoreSet) -> String {
    let moment = |k: usize| if k <= set.moments { sum(k) } else { "0.0".to_owned() };
    (1..=4).map(moment).collect::<Vec<_>>().join(", ")
}

/// Codes of both ends as numbers that blending compares: `nmt_core_end_values` and `nmt_core_ends`, which stand behind
/// the codes.
///
/// # Panics
/// If the layout leaves no bit of the ends' codes unused.
pub fn values(set: CoreSet, language: Target) -> String {
    let unused = 31 - set.layout.depth_bits;
    assert!(set.layout.last_absorbance_step() < 1 << unused, "{:?}", set.layout);
    piece(language, include_str!("ends.wgsl"), include_str!("ends.glsl"))
}

/// `NmtSums`, `nmt_pass1` and `nmt_pass2`, which stand behind codes, [`values`] and weight.
pub fn passes(set: CoreSet, language: Target) -> String {
    let names = names(set.moments);
    let source = Source::new(dialect(language), "nmt");
    let range = "(nearest, farthest, 0, 0) as nmt_core_end_values has them: blended by max, cleared to -3e38. Two \
                 channels, f32 always.";
    structure(&source, set.moments, "number of fragments that absorb", range);
    let spelled = dialect(language);
    let parameter = |name: &String| spelled.parameter(&spelled.type_name(Type::Vec4), name);
    let parameters: Vec<String> = names.iter().map(parameter).collect();
    let terms = terms(set, language);
    let assigned = names
        .iter()
        .zip(&terms)
        .map(|(name, terms)| format!("sums.{name} = {terms};"));
    let calls = piece(language, include_str!("calls.wgsl"), include_str!("calls.glsl"))
        .replace("CORE_TERMS", &assigned.collect::<Vec<_>>().join("\n    "))
        .replace("CORE_SUMS", &parameters.join(", "))
        .replace("CORE_COUNT", &sum(set.moments + 1))
        .replace("CORE_TOTAL", &sum(0))
        .replace("CORE_MOMENTS", &moments(set));
    source.into_text() + &calls
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::core::{MAX_SHADER_MOMENTS, codes, weigh};

    /// WGSL is valid for naga at every number of moments that shaders have.
    #[test]
    fn calls_are_valid_wgsl() {
        for moments in 1..=MAX_SHADER_MOMENTS {
            let set = CoreSet::new(0, moments);
            let language = Target::Wgsl;
            let text = codes(set, language) + &values(set, language) + &weigh(set, language) + &passes(set, language);
            let module = naga::front::wgsl::parse_str(&text)
                .map_err(|e| e.emit_to_string(&text))
                .unwrap();
            let flags = naga::valid::ValidationFlags::all();
            naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
                .validate(&module)
                .unwrap();
        }
    }
}
