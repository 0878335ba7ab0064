//! What computes gradients: our own kernel, or one of burn's engines.

#[cfg(feature = "burn")]
use super::burn;
use super::{Engine, Optimiser, TrainConfig, fused};
use crate::features::Answer;
use serde::{Deserialize, Serialize};

/// What computes gradients and takes Adam's steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Backend {
    /// Our own kernel; see [`fused`].
    Fused,
    /// One of burn's.
    Burn(Engine),
}

/// Why a backend cannot be had.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BackendError {
    /// There is none of that name.
    #[error("backend '{0}': there is none of that name; there are {list}", list = Backend::NAMES.join(", "))]
    Unknown(String),
    /// It is left out of this program.
    #[error(
        "backend '{name}': this program was built without it; build it with 'cargo build --release --features \
            {feature}', or choose fused"
    )]
    NotBuilt {
        /// The backend.
        name: &'static str,
        /// The cargo feature that it needs.
        feature: &'static str,
    },
    /// There is nothing to compute on.
    #[error("backend '{name}': {reason}; or choose fused, which needs no GPU")]
    NoDevice {
        /// The backend.
        name: &'static str,
        /// What it says.
        reason: String,
    },
    /// The GPU takes no step.
    #[error(
        "backend '{name}' on {adapter}: a trial step failed: {reason}; choose a smaller batch, another driver, or \
            fused, which needs no GPU"
    )]
    Failed {
        /// The backend.
        name: &'static str,
        /// Name of the GPU.
        adapter: String,
        /// What was said against it.
        reason: String,
    },
}

impl Backend {
    /// Names of all backends, of those too that this program may have been built without.
    pub const NAMES: [&str; 5] = ["fused", "flex", "ndarray", "wgpu", "cuda"];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fused => "fused",
            Self::Burn(engine) => engine.name(),
        }
    }

    /// The backend of a name.
    ///
    /// # Errors
    /// [`BackendError::Unknown`]; [`BackendError::NotBuilt`] where the cargo feature of that name was off.
    pub fn named(name: &str) -> Result<Self, BackendError> {
        if name == "fused" {
            return Ok(Self::Fused);
        }
        match Engine::ALL.iter().find(|engine| engine.name() == name) {
            Some(&engine) => Ok(Self::Burn(engine)),
            None => Err(match Self::NAMES.into_iter().find(|known| *known == name) {
                Some(name) => BackendError::NotBuilt {
                    name,
                    feature: if name == "ndarray" { "burn" } else { name },
                },
                None => BackendError::Unknown(name.to_owned()),
            }),
        }
    }

    /// Name of the GPU that it computes on; none where that is the CPU.
    ///
    /// # Errors
    /// [`BackendError::NoDevice`] where the machine has nothing that it computes on.
    pub fn adapter(self) -> Result<Option<String>, BackendError> {
        match self {
            Self::Fused => Ok(None),
            Self::Burn(engine) => engine.adapter(),
        }
    }

    /// An optimiser of this kind, at the given weights and with fresh moments; a feature set stands for its answer. The
    /// last of the shapes says how many outputs there are.
    ///
    /// # Errors
    /// [`BackendError::NoDevice`] where the machine has nothing that it computes on, [`BackendError::Failed`] where
    /// that takes no step.
    pub fn optimiser(
        self,
        answer: impl Into<Answer>,
        shapes: &[(usize, usize)],
        parameters: &[f32],
        config: &TrainConfig,
    ) -> Result<Box<dyn Optimiser>, BackendError> {
        Ok(match self {
            Self::Fused => Box::new(fused::Fused::new(answer, shapes, parameters, config)),
            #[cfg(feature = "burn")]
            Self::Burn(engine) => Box::new(burn::BurnOptimiser::new(engine, answer, shapes, parameters, config)?),
            #[cfg(not(feature = "burn"))]
            Self::Burn(engine) => match engine {},
        })
    }
}

impl TryFrom<String> for Backend {
    type Error = BackendError;

    fn try_from(name: String) -> Result<Self, BackendError> {
        Self::named(&name)
    }
}

impl From<Backend> for String {
    fn from(backend: Backend) -> Self {
        backend.name().to_owned()
    }
}
