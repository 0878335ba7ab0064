//! The GPU: a headless device, exported functions run in compute shaders, and the two passes as a renderer makes them.
//!
//! Any adapter will do, Mesa's lavapipe included. Where there is none, [`Gpu::shared`] says so, and whoever asked skips visibly or fails.

pub mod classic;
pub mod compute;
pub mod device;
pub mod list;
pub mod method;
pub mod pipeline;
pub mod tiles;

pub use device::{Gpu, GpuError};
pub use method::{MethodShader, Pass1};

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The device that tests run on; none, said aloud, where there is no adapter, and a failure where `NMT_REQUIRE` names `gpu`.
    pub fn gpu() -> Option<&'static Gpu> {
        match Gpu::shared() {
            Ok(gpu) => Some(gpu),
            Err(why) => {
                let required = std::env::var("NMT_REQUIRE").unwrap_or_default();
                assert!(
                    !required.split(',').any(|tool| tool.trim() == "gpu"),
                    "a GPU is required: {why}"
                );
                println!("skipped: {why}");
                None
            }
        }
    }
}
