//! What a core keeps of a pixel, and how it lies in memory.

use crate::features::core::code::{CodeLayout, MAX_HEAVY};

/// What a core is: how its codes are made, and how many heavy fragments it keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoreShape {
    /// Codes.
    pub layout: CodeLayout,
    /// Heavy fragments, K.
    pub heavy: usize,
}

impl CoreShape {
    /// A core.
    ///
    /// # Panics
    /// If the layout is not valid or K greater than [`MAX_HEAVY`].
    pub fn new(layout: CodeLayout, heavy: usize) -> Self {
        assert!(layout.is_valid() && heavy <= MAX_HEAVY, "{layout:?}, {heavy} heavy");
        Self { layout, heavy }
    }

    /// Slots that are in use: both ends and the heavy ones.
    pub fn slots(&self) -> usize {
        self.heavy + 2
    }

    /// Slots of a pixel in a shader's buffer, so many that they can be read four at a time.
    pub fn stride(&self) -> usize {
        self.slots().next_multiple_of(4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_start_at_multiples_of_four_slots() {
        let layout = CodeLayout {
            depth_bits: 16,
            octave_bits: 11,
            key_exponent: 6.0,
        };
        let stride = |heavy| CoreShape::new(layout, heavy).stride();
        assert_eq!([0, 2, 3, 6, 8].map(stride), [4, 4, 8, 8, 12]);
    }
}
