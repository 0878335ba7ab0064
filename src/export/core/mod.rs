//! Pass 1 of feature sets with a core, as shader source: the codes of [`crate::features::core::code`] and the insertion
//! chain, in WGSL, GLSL and HLSL.
//!
//! The text stands in files beside this one, a pair a language; words that begin with `CORE_` are filled in.
//! A core of both ends alone is kept by blending ([`ends`]). With heavy fragments
//! `nmt_core_insert` needs atomics on a storage buffer in the fragment stage: WebGPU, Vulkan, Metal, Direct3D 11, GLSL
//! 4.30, and GLSL ES 3.10 where `GL_MAX_FRAGMENT_ATOMIC_COUNTERS` and
//! `GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS` are not 0.

pub mod ends;
mod file;
#[cfg(test)]
mod interleaving;
pub mod weigh;

pub use file::{calls, chain, chain_files, chain_name, file_name, has_chain, named, text, write};
pub use weigh::{MAX_SHADER_MOMENTS, known_fragments, weigh, weigh_by_network};

use crate::export::{Format, Target};
use crate::features::core::CoreSet;
use crate::numeric::source::{Dialect, Type};

/// The languages that a core is written in: WGSL, GLSL 4.30 and ES 3.10, HLSL of shader model 5.
pub const LANGUAGES: [Target; 3] = [Target::Wgsl, Target::Glsl, Target::Hlsl];

/// What the pieces of a core say in GLSL, and in HLSL.
const HLSL_FOR_GLSL: [(&str, &str); 11] = [
    (
        "layout(std430, binding = CORE_BINDING) coherent buffer NmtCore { uint nmt_core[]; };",
        "globallycoherent RWStructuredBuffer<uint> nmt_core : register(uCORE_BINDING);",
    ),
    (
        "declare `layout(early_fragment_tests) in;`",
        "declare `[earlydepthstencil]`",
    ),
    (
        "uint old = atomicMax(nmt_core[slot], code);",
        "uint old;\n    InterlockedMax(nmt_core[slot], code, old);",
    ),
    ("\nconst ", "\nstatic const "),
    ("floatBitsToInt", "asint"),
    ("floatBitsToUint", "asuint"),
    ("uintBitsToFloat", "asfloat"),
    ("uvec2", "uint2"),
    ("uvec4", "uint4"),
    ("vec2", "float2"),
    ("vec4", "float4"),
];

/// A piece of a core: WGSL has a text of its own, HLSL is GLSL in other words.
fn piece(language: Target, wgsl: &str, glsl: &str) -> String {
    match language {
        Target::Wgsl => wgsl.to_owned(),
        Target::Glsl => glsl.to_owned(),
        Target::Hlsl => HLSL_FOR_GLSL
            .iter()
            .fold(glsl.to_owned(), |text, (glsl, hlsl)| text.replace(glsl, hlsl)),
        _ => unreachable!("no core is written in {language:?}"),
    }
}

/// How a language spells numbers and vectors.
pub(super) fn dialect(language: Target) -> &'static dyn Dialect {
    language.language().expect("a shading language").dialect()
}

/// Languages among formats, in which a network's core is written beside it.
pub fn chain_languages(formats: &[Format]) -> Vec<Target> {
    let wanted = |&language: &Target| formats.contains(&Format::of(language));
    LANGUAGES.into_iter().filter(wanted).collect()
}

/// Where a shader finds the buffer of slots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoreBinding {
    /// Bind group; WGSL alone has one.
    pub group: u32,
    /// Binding, or the number of the register.
    pub binding: u32,
}

impl CoreBinding {
    /// Where exports declare it; to be changed by hand where a renderer has something else there.
    pub const DEFAULT: Self = Self { group: 3, binding: 0 };
}

/// Vectors of four slots that `nmt_core_transmittance` takes.
pub fn vectors(set: CoreSet) -> usize {
    set.slots().div_ceil(4)
}

/// A pixel's slots as those vectors, from the expressions of its pairs of words.
pub fn gathered(set: CoreSet, language: Target, pair: &dyn Fn(usize) -> String) -> String {
    let vector = |i: usize| {
        let second = match 2 * i + 1 < set.stride() / 2 {
            true => pair(2 * i + 1),
            false => "0u, 0u".to_owned(),
        };
        format!(
            "{}({}, {second})",
            dialect(language).type_name(Type::Word4),
            pair(2 * i)
        )
    };
    (0..vectors(set)).map(vector).collect::<Vec<_>>().join(", ")
}

/// Codes of fragments: constants, `NmtCodes`, `nmt_core_codes`, `nmt_core_steps`, what steps stand for, and codes of
/// every kind of slot with their inverses.
pub fn codes(set: CoreSet, language: Target) -> String {
    piece(language, include_str!("codes.wgsl"), include_str!("codes.glsl"))
        .replace("CORE_DEPTH_BITS", &set.layout.depth_bits.to_string())
        .replace("CORE_OCTAVE_BITS", &set.layout.octave_bits.to_string())
        .replace("CORE_HEAVY", &set.heavy.to_string())
        .replace("CORE_SLOTS", &set.stride().to_string())
        .replace("CORE_KEY_SCALE", &format!("{:?}", set.layout.key_scale()))
        .replace("CORE_LAST_ABSORBANCE", &set.layout.last_absorbance_step().to_string())
}

/// The insertion chain, which stands behind [`codes`]: `nmt_core_insert`, and the buffer that it fills.
pub fn insert(language: Target, place: CoreBinding) -> String {
    piece(language, include_str!("insert.wgsl"), include_str!("insert.glsl"))
        .replace("CORE_GROUP", &place.group.to_string())
        .replace("CORE_BINDING", &place.binding.to_string())
}

/// How pass 1 keeps the core, behind [`codes`]: by blending ([`ends::values`]), or by [`insert`].
pub fn keep(set: CoreSet, language: Target, place: CoreBinding) -> String {
    match set.is_blended() {
        true => ends::values(set, language),
        false => insert(language, place),
    }
}

/// Both passes in one call each, behind all others; none where a core is kept by [`insert`].
pub fn calls_of_passes(set: CoreSet, language: Target) -> String {
    match set.is_blended() {
        true => ends::passes(set, language),
        false => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::core::code::MAX_HEAVY;

    const PLACE: CoreBinding = CoreBinding { group: 3, binding: 0 };

    #[test]
    fn text_of_the_core() {
        for language in LANGUAGES {
            let set = CoreSet::new(4, 2);
            let text = codes(set, language) + "\n" + &insert(language, PLACE) + &weigh(set, language);
            assert!(!text.contains("CORE_"));
            insta::assert_snapshot!(format!("core_{language:?}").to_lowercase(), text);
        }
    }

    #[test]
    fn slots_are_read_in_pairs_and_handed_on_in_fours() {
        let of = |f: fn(CoreSet) -> usize| [0, 2, 3, 4, 6, 8].map(|heavy| f(CoreSet::new(heavy, 2)));
        assert_eq!(of(|set| set.stride()), [2, 4, 6, 6, 8, 10]);
        assert_eq!(of(vectors), [1, 1, 2, 2, 2, 3]);
        let text = |heavy| gathered(CoreSet::new(heavy, 2), Target::Glsl, &|i| format!("p{i}"));
        assert_eq!(text(4), "uvec4(p0, p1), uvec4(p2, 0u, 0u)");
        assert_eq!(text(2), "uvec4(p0, p1)");
    }

    /// WGSL is valid for naga at every K and M; control: a chain without its codes is not.
    #[test]
    fn the_chain_is_valid_wgsl() {
        let validate = |source: &str| {
            let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
            naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
                .validate(&module)
                .map(drop)
                .map_err(|e| e.emit_to_string(source))
        };
        let insert = insert(Target::Wgsl, PLACE);
        assert!(validate(&insert).is_err());
        for heavy in 0..=MAX_HEAVY {
            for moments in 1..=4 {
                let set = CoreSet::new(heavy, moments);
                let text = codes(set, Target::Wgsl) + &insert + &weigh(set, Target::Wgsl);
                validate(&text).unwrap();
            }
        }
    }
}
