//! burn's autodiff and Adam, on any of its backends: the independent opinion on what our own kernel computes.

use super::fused::all_blocks;
use super::{AdamMoments, BackendError, Engine, Optimiser, TrainConfig, initial};
use crate::dataset::{Batch, Blocks};
use crate::features::{Answer, MAX_LOG_ABSORBANCE};
use burn::optim::{Adam, AdamConfig, AdamState, AdaptiveMomentumState, Optimizer as _};
use burn::tensor::{Device, Tensor, TensorData, activation};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A network being fitted by burn.
pub struct BurnOptimiser {
    answer: Answer,
    shapes: Vec<(usize, usize)>,
    device: Device,
    adam: Adam,
    /// Weights `[in, out]` and biases `[1, out]` by turns.
    tensors: Vec<Tensor<2>>,
    states: Vec<Option<AdamState<2>>>,
}

/// What an engine computes on.
#[derive(Debug, Clone)]
struct Opened {
    device: Device,
    /// Name of the GPU; none of the CPU.
    adapter: Option<String>,
}

/// Name of the GPU that an engine computes on; none where that is the CPU.
///
/// # Errors
/// [`BackendError::NoDevice`].
pub fn adapter(engine: Engine) -> Result<Option<String>, BackendError> {
    open(engine).map(|opened| opened.adapter)
}

/// Where it computes.
fn open(engine: Engine) -> Result<Opened, BackendError> {
    match engine {
        #[cfg(feature = "flex")]
        Engine::Flex => Ok(Opened {
            device: Device::flex(),
            adapter: None,
        }),
        // Deprecated by burn 0.22 in favour of flex; kept because it was asked for by name.
        #[allow(deprecated)]
        #[cfg(feature = "burn")]
        Engine::Ndarray => Ok(Opened {
            device: Device::ndarray(),
            adapter: None,
        }),
        #[cfg(feature = "wgpu")]
        Engine::Wgpu => {
            static OPENED: gpu::Once = gpu::Once::new();
            gpu::open(&OPENED, engine.name(), gpu::wgpu)
        }
        #[cfg(feature = "cuda")]
        Engine::Cuda => {
            static OPENED: gpu::Once = gpu::Once::new();
            gpu::open(&OPENED, engine.name(), gpu::cuda)
        }
    }
}

/// GPUs: whatever burn says against one, as an error or in a panic, is an error here.
#[cfg(any(feature = "wgpu", feature = "cuda"))]
mod gpu {
    use super::{BackendError, Device, Opened, caught};
    use std::sync::OnceLock;

    /// burn opens a device once in a process.
    pub type Once = OnceLock<Result<Opened, BackendError>>;

    /// What `device` gives, opened and with its name.
    pub fn open(
        once: &Once,
        name: &'static str,
        device: fn() -> Result<Device, String>,
    ) -> Result<Opened, BackendError> {
        once.get_or_init(|| {
            let opened = caught(|| -> Result<Opened, String> {
                let device = device()?;
                let identity = device.identity().ok_or("burn gives the device no name")?;
                Ok(Opened {
                    device,
                    adapter: Some(identity.name),
                })
            });
            opened
                .and_then(|opened| opened)
                .map_err(|reason| BackendError::NoDevice { name, reason })
        })
        .clone()
    }

    #[cfg(feature = "wgpu")]
    pub fn wgpu() -> Result<Device, String> {
        use burn::tensor::wgpu::{WgpuBackend, WgpuInitError};
        use wgpu::{Backend, Backends, Instance, InstanceDescriptor, PowerPreference, RequestAdapterOptions};

        // OpenGL only where there is nothing else: some drivers write to stderr when asked for it.
        let instance = Instance::new(InstanceDescriptor {
            backends: Backends::PRIMARY,
            ..InstanceDescriptor::new_without_display_handle()
        });
        let strong = RequestAdapterOptions {
            power_preference: PowerPreference::HighPerformance,
            ..Default::default()
        };
        let api = match pollster::block_on(instance.request_adapter(&strong)).map(|adapter| adapter.get_info().backend)
        {
            Ok(Backend::Vulkan) => WgpuBackend::Vulkan,
            Ok(Backend::Metal) => WgpuBackend::Metal,
            Ok(Backend::Dx12) => WgpuBackend::Dx12,
            _ => WgpuBackend::Auto,
        };
        let unavailable = || match std::env::var("CUBECL_WGPU_DEFAULT_DEVICE") {
            Ok(asked) => {
                let infos = pollster::block_on(instance.enumerate_adapters(Backends::PRIMARY))
                    .into_iter()
                    .map(|adapter| adapter.get_info());
                let there: Vec<String> = infos
                    .map(|info| format!("{:?} {}", info.device_type, info.name))
                    .collect();
                format!("CUBECL_WGPU_DEFAULT_DEVICE is '{asked}', and there are {there:?}")
            }
            Err(_) => {
                "no GPU adapter; install a Vulkan driver, or Mesa's lavapipe (Debian: mesa-vulkan-drivers libvulkan1)"
                    .to_owned()
            }
        };
        let (device, setup) =
            Device::wgpu_options()
                .graphics_api(api)
                .init_with_setup()
                .map_err(|error| match error {
                    WgpuInitError::AdapterUnavailable { .. } => unavailable(),
                    other => other.to_string(),
                })?;
        // What names the adapter everywhere else means nothing to burn.
        let adapter = setup.adapter.get_info().name;
        match std::env::var("WGPU_ADAPTER_NAME") {
            Ok(wanted) if !adapter.to_lowercase().contains(&wanted.to_lowercase()) => Err(format!(
                "burn took {adapter}, and WGPU_ADAPTER_NAME is '{wanted}'; set CUBECL_WGPU_DEFAULT_DEVICE to \
                    DiscreteGpu(0), IntegratedGpu(0), Cpu, .."
            )),
            _ => Ok(device),
        }
    }

    #[cfg(feature = "cuda")]
    pub fn cuda() -> Result<Device, String> {
        use burn::tensor::DeviceType;
        // Asks for the driver first; everything else of burn's would panic without it.
        Device::enumerate(DeviceType::Cuda)
            .into_iter()
            .next()
            .ok_or_else(|| "no CUDA device, or no NVIDIA driver that finds it".to_owned())
    }
}

/// The value, or the message of the panic that came in its place.
fn caught<T>(f: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(f)).map_err(|panic| match panic.downcast::<String>() {
        Ok(message) => *message,
        Err(panic) => panic
            .downcast_ref::<&str>()
            .copied()
            .unwrap_or("burn panicked")
            .to_owned(),
    })
}

/// Rows of a trial step, at most.
const MAX_TRIAL_ROWS: usize = 1 << 16;

impl BurnOptimiser {
    /// An optimiser at the given weights. On a GPU it takes a step on rows of zeros first: what the driver refuses is
    /// refused here.
    ///
    /// # Errors
    /// [`BackendError::NoDevice`] where the machine has nothing that the engine computes on, [`BackendError::Failed`]
    /// where the trial step fails.
    pub fn new(
        engine: Engine,
        answer: impl Into<Answer>,
        shapes: &[(usize, usize)],
        parameters: &[f32],
        config: &TrainConfig,
    ) -> Result<Self, BackendError> {
        let adam = AdamConfig::new()
            .with_beta_1(config.beta1 as f32)
            .with_beta_2(config.beta2 as f32)
            .with_epsilon(config.epsilon as f32)
            .build();
        let Opened { device, adapter } = open(engine)?;
        let mut optimiser = Self {
            answer: answer.into(),
            shapes: shapes.to_vec(),
            device,
            adam,
            tensors: Vec::new(),
            states: Vec::new(),
        };
        if let Some(adapter) = adapter {
            let failed = |reason| BackendError::Failed {
                name: engine.name(),
                adapter: adapter.clone(),
                reason,
            };
            caught(|| optimiser.trial(parameters, config.batch.min(MAX_TRIAL_ROWS)))
                .and_then(|done| done)
                .map_err(failed)?;
        }
        optimiser.restore(parameters, &AdamMoments::default());
        Ok(optimiser)
    }

    /// A step on rows that weigh nothing.
    fn trial(&mut self, parameters: &[f32], rows: usize) -> Result<(), String> {
        self.restore(parameters, &AdamMoments::default());
        let blocks = Blocks::zeros(self.shapes[0].0, self.outputs(), rows);
        let error = self.step(
            Batch {
                blocks: &blocks,
                order: &all_blocks(&blocks),
            },
            1e-3,
        );
        if error == 0.0 && self.parameters() == parameters {
            Ok(())
        } else {
            Err(format!(
                "rows that weigh nothing had an error of {error:e}, or moved the weights"
            ))
        }
    }

    /// Outputs of the network.
    fn outputs(&self) -> usize {
        self.shapes[self.shapes.len() - 1].1
    }

    /// `[rows, columns]` of every parameter tensor.
    fn tensor_shapes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.shapes.iter().flat_map(|&(i, o)| [[i, o], [1, o]])
    }

    fn tensors_of(&self, flat: &[f32]) -> Vec<Tensor<2>> {
        assert_eq!(flat.len(), initial::count(&self.shapes), "one number a parameter");
        let mut rest = flat;
        self.tensor_shapes()
            .map(|[rows, columns]| {
                let (head, tail) = rest.split_at(rows * columns);
                rest = tail;
                Tensor::from_data(TensorData::new(head.to_vec(), [rows, columns]), &self.device)
            })
            .collect()
    }

    /// Weighted mean squared error of a batch over rows and outputs, and the gradient of every parameter tensor.
    fn backward(&self, batch: Batch<'_>) -> (f64, Vec<Tensor<2>>) {
        let (features, targets, weights) = batch.to_rows();
        let (n, width) = (weights.len(), self.shapes[0].0);
        let tracked = self.device.clone().autodiff();
        let column = |values: Vec<f32>| -> Tensor<2> { Tensor::from_data(TensorData::new(values, [n, 1]), &tracked) };
        let absorbance = match self.answer {
            Answer::Sigmoid => None,
            Answer::AbsorbanceShare { column: at, offset } => Some(column(
                features
                    .chunks_exact(width)
                    .map(|row| (libm::expf(row[at].min(MAX_LOG_ABSORBANCE)) - offset).max(0.0))
                    .collect(),
            )),
        };
        let weights = column(weights);
        let y: Tensor<2> = Tensor::from_data(TensorData::new(targets, [n, self.outputs()]), &tracked);
        let x: Tensor<2> = Tensor::from_data(TensorData::new(features, [n, width]), &tracked);
        let leaves: Vec<Tensor<2>> = self
            .tensors
            .iter()
            .map(|t| Tensor::from_inner(t.clone()).require_grad())
            .collect();
        let mut h = x;
        for (index, layer) in leaves.chunks_exact(2).enumerate() {
            h = h.matmul(layer[0].clone()) + layer[1].clone();
            h = if index + 1 < self.shapes.len() {
                activation::relu(h)
            } else {
                activation::sigmoid(h)
            };
        }
        if let Some(absorbance) = absorbance {
            h = (absorbance * h).neg().exp();
        }
        let loss = ((h - y).square() * weights).mean();
        let mut gradients = loss.backward();
        let loss: f32 = loss.into_scalar();
        let gradients = leaves
            .iter()
            .map(|leaf| {
                leaf.grad_remove(&mut gradients)
                    .expect("every parameter takes part in the loss")
            })
            .collect();
        (loss.into(), gradients)
    }
}

fn numbers(tensor: Tensor<2>) -> Vec<f32> {
    tensor.into_data().try_to_vec::<f32>().expect("a float tensor")
}

impl Optimiser for BurnOptimiser {
    fn step(&mut self, batch: Batch<'_>, learning_rate: f64) -> f64 {
        let (loss, gradients) = self.backward(batch);
        for ((tensor, state), gradient) in self.tensors.iter_mut().zip(&mut self.states).zip(gradients) {
            let (stepped, next) = self.adam.step(learning_rate, tensor.clone(), gradient, state.take());
            *tensor = stepped;
            *state = next;
        }
        loss
    }

    fn gradient(&mut self, batch: Batch<'_>) -> (f64, Vec<f32>) {
        let (loss, gradients) = self.backward(batch);
        (loss, gradients.into_iter().flat_map(numbers).collect())
    }

    fn parameters(&self) -> Vec<f32> {
        self.tensors.iter().cloned().flat_map(numbers).collect()
    }

    fn moments(&self) -> AdamMoments {
        let states: Option<Vec<_>> = self.states.iter().cloned().collect();
        let Some(states) = states else {
            return AdamMoments::default();
        };
        AdamMoments {
            steps: states[0].momentum.time as u64,
            first: states
                .iter()
                .flat_map(|s| numbers(s.momentum.moment_1.clone()))
                .collect(),
            second: states
                .iter()
                .flat_map(|s| numbers(s.momentum.moment_2.clone()))
                .collect(),
        }
    }

    fn restore(&mut self, parameters: &[f32], moments: &AdamMoments) {
        self.tensors = self.tensors_of(parameters);
        self.states = if moments.steps == 0 {
            vec![None; self.tensors.len()]
        } else {
            let pairs = self
                .tensors_of(&moments.first)
                .into_iter()
                .zip(self.tensors_of(&moments.second));
            pairs
                .map(|(first, second)| {
                    Some(AdamState::new(AdaptiveMomentumState::new(
                        moments.steps as usize,
                        first,
                        second,
                    )))
                })
                .collect()
        };
    }
}
