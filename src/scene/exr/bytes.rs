//! Bytes of a file with a place, and the number types that they hold.

use crate::scene::SceneError;
use std::path::Path;

/// Bytes with a place, so that an error can say where.
pub(super) struct Bytes<'a> {
    pub path: &'a Path,
    pub data: &'a [u8],
    pub at: usize,
}

impl<'a> Bytes<'a> {
    pub fn wrong(&self, place: &str, reason: impl Into<String>) -> SceneError {
        SceneError::file_content(self.path, place, reason)
    }

    pub fn take(&mut self, n: u64, what: &str) -> Result<&'a [u8], SceneError> {
        let end = usize::try_from(n)
            .ok()
            .and_then(|n| self.at.checked_add(n))
            .filter(|&end| end <= self.data.len());
        let Some(end) = end else {
            return Err(self.wrong(
                &format!("byte {}", self.at),
                format!("the file ends within {what}; it is truncated or damaged"),
            ));
        };
        let out = &self.data[self.at..end];
        self.at = end;
        Ok(out)
    }

    pub fn u32(&mut self, what: &str) -> Result<u32, SceneError> {
        let b = self.take(4, what)?;
        Ok(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    }

    pub fn i32(&mut self, what: &str) -> Result<i32, SceneError> {
        Ok(self.u32(what)? as i32)
    }

    pub fn u64(&mut self, what: &str) -> Result<u64, SceneError> {
        Ok(u64::from(self.u32(what)?) | u64::from(self.u32(what)?) << 32)
    }

    /// A zero-terminated name of at most 255 bytes.
    pub fn name(&mut self, what: &str) -> Result<String, SceneError> {
        let rest = &self.data[self.at.min(self.data.len())..];
        match rest.iter().take(256).position(|&b| b == 0) {
            Some(n) => {
                self.at += n + 1;
                Ok(String::from_utf8_lossy(&rest[..n]).into_owned())
            }
            None => Err(self.wrong(
                &format!("byte {}", self.at),
                format!("{what} does not end; the file is truncated or damaged"),
            )),
        }
    }
}

/// Number type of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Uint,
    Half,
    Float,
}

impl Kind {
    pub fn bytes(self) -> usize {
        if self == Self::Half { 2 } else { 4 }
    }

    pub fn value(self, b: &[u8]) -> f32 {
        match self {
            Self::Uint => u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
            Self::Half => half(u16::from_le_bytes([b[0], b[1]])),
            Self::Float => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        }
    }
}

/// A 16-bit float, exactly.
pub(super) fn half(bits: u16) -> f32 {
    let sign = u32::from(bits >> 15) << 31;
    let (exponent, fraction) = (u32::from(bits >> 10 & 31), u32::from(bits & 1023));
    match exponent {
        // Subnormal: fraction 2^−24
        0 => f32::from_bits(sign | (fraction as f32 * (1.0 / 16_777_216.0)).to_bits()),
        31 => f32::from_bits(sign | 0x7f80_0000 | fraction << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}
