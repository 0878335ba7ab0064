//! What a method costs and needs: the one source of every table that says so.

use serde::{Deserialize, Serialize};

/// What a method keeps of a pixel, how often it draws the geometry, and what it asks of a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Capabilities {
    /// What is kept of a pixel besides the colour accumulator: sums, ranges, layers, cores \[bits\]; none where it
    /// grows with the scene.
    ///
    /// Where the reference pipeline (`gpu::pipeline`) draws the method, it is what the targets of pass 1 take
    /// there ([`targets`]); elsewhere what the method's own source allocates.
    pub bits_per_pixel: Option<u32>,
    /// The target that weighted colours are added up in \[bits\]; 0 where colours lie in the layers themselves.
    pub colour_bits_per_pixel: u32,
    /// How often transparent geometry is drawn.
    pub geometry_passes: u32,
    /// What it asks of a device.
    pub needs: Needs,
    /// Whether the image depends on the order in which fragments arrive.
    pub order_dependent: bool,
}

/// What a method asks of a device or of the renderer around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Needs {
    /// Fragments of a pixel one after the other: rasteriser-ordered views, fragment shader interlock, raster order
    /// groups.
    pub interlock: bool,
    /// Atomic operations of fragment shaders on storage buffers.
    pub atomics: bool,
    /// A pass of its own over the geometry, before the sums, that finds each pixel's depth range.
    pub prepass: bool,
    /// Blending into f32 targets.
    pub f32_blending: bool,
    /// Several samples a pixel.
    pub multisampling: bool,
}

impl Needs {
    /// Nothing.
    pub const NONE: Self = Self {
        interlock: false,
        atomics: false,
        prepass: false,
        f32_blending: false,
        multisampling: false,
    };

    /// Fragments of a pixel one after the other.
    pub const INTERLOCK: Self = Self {
        interlock: true,
        ..Self::NONE
    };

    /// Blending into f32 targets.
    pub const F32_BLENDING: Self = Self {
        f32_blending: true,
        ..Self::NONE
    };

    /// The names of what is needed, for a column of a table; "-" where nothing is.
    pub fn list(&self) -> String {
        let all = [
            (self.interlock, "interlock"),
            (self.atomics, "atomics"),
            (self.prepass, "prepass"),
            (self.f32_blending, "f32 blending"),
            (self.multisampling, "samples"),
        ];
        let needed: Vec<&str> = all
            .into_iter()
            .filter(|(needed, _)| *needed)
            .map(|(_, name)| name)
            .collect();
        if needed.is_empty() {
            "-".to_owned()
        } else {
            needed.join(", ")
        }
    }
}

/// Colour accumulator of the reference pipeline, rgba32float \[bits\]; its storage `half-color` takes half of it.
pub const COLOUR_BITS: u32 = 128;

/// Nearest and farthest view depth in f32 \[bits\].
pub const RANGE_BITS: u32 = 64;

/// What the reference pipeline allocates for so many f32 sums: four to a texture, of which none has three \[bits\].
pub const fn sums(numbers: u32) -> u32 {
    let rest = match numbers % 4 {
        3 => 4,
        rest => rest,
    };
    128 * (numbers / 4) + 32 * rest
}

/// What the targets of pass 1 take in the reference pipeline: the sums; and where pass 2 looks at the pixel's range,
/// number of fragments and both ends \[bits\].
pub const fn targets(numbers: u32, range: bool) -> u32 {
    if range {
        sums(numbers + 1) + RANGE_BITS
    } else {
        sums(numbers)
    }
}

impl Capabilities {
    /// A method of additive sums in f32, as the reference pipeline draws it: one pass of sums and one of colour.
    pub const fn of_sums(numbers: u32, range: bool) -> Self {
        Self {
            bits_per_pixel: Some(targets(numbers, range)),
            colour_bits_per_pixel: COLOUR_BITS,
            geometry_passes: 2,
            needs: Needs::F32_BLENDING,
            order_dependent: false,
        }
    }

    /// A method of one pass that blends colours and what is left of the background.
    pub const fn of_blending(bits: u32) -> Self {
        Self {
            bits_per_pixel: Some(bits),
            colour_bits_per_pixel: COLOUR_BITS,
            geometry_passes: 1,
            needs: Needs::NONE,
            order_dependent: false,
        }
    }

    /// Bits of a pixel as a table shows them.
    pub fn bits_text(&self) -> String {
        self.bits_per_pixel
            .map_or_else(|| "unbounded".to_owned(), |bits| bits.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four to a texture, three in a texture of four; by hand.
    #[test]
    fn targets_by_hand() {
        assert_eq!([1, 2, 3, 4, 5, 7, 9].map(sums), [32, 64, 128, 128, 160, 256, 288]);
        // b0..b4 and n in a vec4 and a vec2, both ends in a vec2.
        assert_eq!(targets(5, true), 128 + 64 + 64);
        assert_eq!(targets(5, false), 160);
    }

    #[test]
    fn needs_are_named() {
        assert_eq!(Needs::NONE.list(), "-");
        let both = Needs {
            prepass: true,
            ..Needs::F32_BLENDING
        };
        assert_eq!(both.list(), "prepass, f32 blending");
    }
}
