//! The GPU: a headless device, exported functions run in compute shaders, and the two passes as a renderer makes them.
//!
//! Any adapter will do, Mesa's lavapipe included. Where there is none, [`Gpu::shared`] says so, and whoever asked skips
//! visibly or fails.

pub mod compute;
#[cfg(test)]
mod core;
pub mod device;
pub mod list;
pub mod pipeline;
pub mod tiles;
#[cfg(test)]
mod twins;
pub mod upload;

pub use crate::shader::MethodShader;
pub use device::{Gpu, GpuError};
pub use upload::DeviceList;

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::numeric::require::or_skip;

    /// The device that tests run on; none, reported as skipped, where there is no adapter.
    pub fn gpu() -> Option<&'static Gpu> {
        or_skip("gpu", Gpu::shared())
    }
}
