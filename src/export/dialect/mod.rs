//! The shading languages, a file each: how one spells what formulas are made of.

mod glsl;
mod hlsl;
mod wgsl;

pub use glsl::Glsl;
pub use hlsl::Hlsl;
pub use wgsl::Wgsl;
