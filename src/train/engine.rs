//! The backends of burn that this program was built with; none where the cargo feature `burn` was off.

use super::BackendError;

/// burn's backends that this program was built with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    /// burn-flex, on the CPU.
    #[cfg(feature = "flex")]
    Flex,
    /// burn-ndarray, on the CPU.
    #[cfg(feature = "burn")]
    Ndarray,
    /// burn-wgpu, on the GPU that it likes best; `CUBECL_WGPU_DEFAULT_DEVICE` names another.
    #[cfg(feature = "wgpu")]
    Wgpu,
    /// burn-cuda, on the first CUDA device.
    #[cfg(feature = "cuda")]
    Cuda,
}

impl Engine {
    /// All of them.
    pub const ALL: &'static [Self] = &[
        #[cfg(feature = "flex")]
        Self::Flex,
        #[cfg(feature = "burn")]
        Self::Ndarray,
        #[cfg(feature = "wgpu")]
        Self::Wgpu,
        #[cfg(feature = "cuda")]
        Self::Cuda,
    ];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            #[cfg(feature = "flex")]
            Self::Flex => "flex",
            #[cfg(feature = "burn")]
            Self::Ndarray => "ndarray",
            #[cfg(feature = "wgpu")]
            Self::Wgpu => "wgpu",
            #[cfg(feature = "cuda")]
            Self::Cuda => "cuda",
        }
    }

    /// Name of the GPU that it computes on; none where that is the CPU.
    ///
    /// # Errors
    /// [`BackendError::NoDevice`].
    pub fn adapter(self) -> Result<Option<String>, BackendError> {
        #[cfg(feature = "burn")]
        return super::burn::adapter(self);
        #[cfg(not(feature = "burn"))]
        match self {}
    }
}
