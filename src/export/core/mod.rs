//! Pass 1 of feature sets with a core, as shader source: the codes of [`crate::features::core::code`] and the insertion
//! chain, in WGSL, GLSL and HLSL.
//!
//! The text stands in files beside this one, a pair a language; words that begin with `CORE_` are filled in.
//! `nmt_core_insert` needs atomics on a storage buffer in the fragment stage: WebGPU, Vulkan, Metal, Direct3D 11, GLSL
//! 4.30, and GLSL ES 3.10 where `GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS` is not 0.

#[cfg(test)]
mod interleaving;
pub mod shape;

use shape::CoreShape;

/// A language that the core is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CoreLanguage {
    /// WGSL.
    Wgsl,
    /// GLSL 4.30 and GLSL ES 3.10.
    Glsl,
    /// HLSL, shader model 5.
    Hlsl,
}

/// Where a shader finds the buffer of slots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoreBinding {
    /// Bind group; WGSL alone has one.
    pub group: u32,
    /// Binding, or the number of the register.
    pub binding: u32,
}

impl CoreShape {
    /// Codes of fragments: constants, `NmtCodes`, `nmt_core_codes`, `nmt_core_steps`, and codes of every kind of slot
    /// with their inverses.
    pub fn codes(&self, language: CoreLanguage) -> String {
        let text = match language {
            CoreLanguage::Wgsl => include_str!("codes.wgsl"),
            CoreLanguage::Glsl => include_str!("codes.glsl"),
            CoreLanguage::Hlsl => include_str!("codes.hlsl"),
        };
        text.replace("CORE_DEPTH_BITS", &self.layout.depth_bits.to_string())
            .replace("CORE_OCTAVE_BITS", &self.layout.octave_bits.to_string())
            .replace("CORE_HEAVY", &self.heavy.to_string())
            .replace("CORE_SLOTS", &self.stride().to_string())
            .replace("CORE_KEY_SCALE", &format!("{:?}", self.layout.key_scale()))
            .replace("CORE_LAST_ABSORBANCE", &self.layout.last_absorbance_step().to_string())
    }

    /// The insertion chain, which stands behind [`Self::codes`]: `nmt_core_insert`, and the buffer that it fills.
    pub fn insert(&self, language: CoreLanguage, place: CoreBinding) -> String {
        let text = match language {
            CoreLanguage::Wgsl => include_str!("insert.wgsl"),
            CoreLanguage::Glsl => include_str!("insert.glsl"),
            CoreLanguage::Hlsl => include_str!("insert.hlsl"),
        };
        text.replace("CORE_GROUP", &place.group.to_string())
            .replace("CORE_BINDING", &place.binding.to_string())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::features::core::code::{CodeLayout, MAX_HEAVY};

    /// A usual core of 16 + 16 bits.
    pub const SHAPE: CoreShape = CoreShape {
        layout: CodeLayout {
            depth_bits: 16,
            octave_bits: 11,
            key_exponent: 6.0,
        },
        heavy: 4,
    };

    const PLACE: CoreBinding = CoreBinding { group: 3, binding: 0 };

    #[test]
    fn text_of_the_core() {
        for language in [CoreLanguage::Wgsl, CoreLanguage::Glsl, CoreLanguage::Hlsl] {
            let text = SHAPE.codes(language) + "\n" + &SHAPE.insert(language, PLACE);
            assert!(!text.contains("CORE_") && text.lines().all(|line| line.len() <= 120));
            insta::assert_snapshot!(format!("core_{language:?}").to_lowercase(), text);
        }
    }

    /// WGSL is valid for naga at every K; control: a chain without its codes is not.
    #[test]
    fn the_chain_is_valid_wgsl() {
        let validate = |source: &str| {
            let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
            naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
                .validate(&module)
                .map(drop)
                .map_err(|e| e.emit_to_string(source))
        };
        for heavy in 0..=MAX_HEAVY {
            let shape = CoreShape::new(SHAPE.layout, heavy);
            let insert = shape.insert(CoreLanguage::Wgsl, PLACE);
            validate(&(shape.codes(CoreLanguage::Wgsl) + &insert)).unwrap();
            assert!(validate(&insert).is_err());
        }
    }
}
