//! A headless GPU device: buffers in, dispatches timed, buffers out.

use crate::shader::ShaderError;
use bytemuck::Pod;
use std::sync::OnceLock;
use std::time::Instant;
use wgpu::util::DeviceExt;

/// Why the GPU did not do what it was asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GpuError {
    /// There is no adapter.
    #[error(
        "no GPU adapter: {0}; install a Vulkan driver, or Mesa's lavapipe (Debian: mesa-vulkan-drivers libvulkan1), or \
         build with --features gles for OpenGL"
    )]
    NoAdapter(String),
    /// The adapter gives no device.
    #[error("{adapter} gives no device: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// Why.
        reason: String,
    },
    /// The device lacks a feature.
    #[error("{adapter} lacks {feature}")]
    Lacks {
        /// Name of the adapter.
        adapter: String,
        /// What it lacks.
        feature: &'static str,
    },
    /// The fragment list makes no image.
    #[error("there is no image: {0}")]
    NoImage(String),
    /// More data than a buffer of the device holds.
    #[error("{what} takes {bytes} bytes, and {adapter} holds at most {most} in one buffer; take fewer fragments")]
    TooLarge {
        /// Name of the adapter.
        adapter: String,
        /// What was to be put there.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// What fits.
        most: u64,
    },
    /// A shader or a call was refused.
    #[error("{label}: {reason}")]
    Refused {
        /// What was made or run.
        label: String,
        /// The device's words.
        reason: String,
    },
    /// The shader source cannot be turned into what the device takes.
    #[error("{label}: {reason}")]
    Source {
        /// What it is.
        label: String,
        /// Why.
        reason: String,
    },
}

impl From<ShaderError> for GpuError {
    fn from(error: ShaderError) -> Self {
        let ShaderError { label, reason } = error;
        Self::Source { label, reason }
    }
}

/// Features that are taken where the adapter has them.
const WANTED: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::FLOAT32_BLENDABLE)
    .union(wgpu::Features::SHADER_F16)
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    info: wgpu::AdapterInfo,
    /// Whether the fragment stage may write storage buffers.
    fragment_writes: bool,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// A dispatch: a pipeline, the buffers of its bind group 0 in the order of their bindings, and numbers of workgroups.
#[derive(Debug, Clone, Copy)]
pub struct Dispatch<'a> {
    /// What runs.
    pub pipeline: &'a wgpu::ComputePipeline,
    /// Binding i holds buffer i.
    pub buffers: &'a [&'a wgpu::Buffer],
    /// Workgroups in x and y.
    pub groups: [u32; 2],
}

/// Invocations of one workgroup in x, in every compute shader here.
pub const WORKGROUP: u32 = 64;

/// Workgroups in x and y that hold so many invocations; the shader's index is `id.x + id.y * groups.x * 64`.
pub fn groups(invocations: u64) -> [u32; 2] {
    // WebGPU allows 65535 in each direction.
    const MOST: u64 = 32_768;
    let all = invocations.div_ceil(WORKGROUP.into()).max(1);
    let rows = all.div_ceil(MOST);
    [all.div_ceil(rows) as u32, rows as u32]
}

impl Gpu {
    /// Opens the adapter that the environment names (`WGPU_ADAPTER_NAME`, part of its name; `WGPU_BACKEND`), or else
    /// the most powerful; OpenGL's only with the cargo feature `gles` and where there is no other.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`], [`GpuError::NoDevice`].
    pub fn open() -> Result<Self, GpuError> {
        // Looking for OpenGL alone makes some drivers write to stderr.
        match std::env::var_os("WGPU_BACKEND") {
            Some(_) => Self::open_on(wgpu::Backends::all(), WANTED),
            None => {
                Self::open_on(wgpu::Backends::PRIMARY, WANTED).or_else(|_| Self::open_on(wgpu::Backends::all(), WANTED))
            }
        }
    }

    /// A device that does not use these features, whatever the adapter has.
    #[cfg(test)]
    pub(crate) fn open_without(features: wgpu::Features) -> Result<Self, GpuError> {
        Self::open_on(wgpu::Backends::all(), WANTED - features)
    }

    fn open_on(backends: wgpu::Backends, wanted: wgpu::Features) -> Result<Self, GpuError> {
        pollster::block_on(async {
            let descriptor = wgpu::InstanceDescriptor {
                backends,
                ..wgpu::InstanceDescriptor::new_without_display_handle()
            };
            let instance = wgpu::Instance::new(descriptor.with_env());
            let adapter = match std::env::var("WGPU_ADAPTER_NAME") {
                Ok(name) => {
                    let all = instance.enumerate_adapters(backends).await;
                    let names: Vec<String> = all.iter().map(|a| a.get_info().name).collect();
                    let wanted = name.to_lowercase();
                    let found = all
                        .into_iter()
                        .find(|a| a.get_info().name.to_lowercase().contains(&wanted));
                    found.ok_or_else(|| {
                        GpuError::NoAdapter(format!("WGPU_ADAPTER_NAME is '{name}', and there are {names:?}"))
                    })?
                }
                Err(_) => {
                    let options = wgpu::RequestAdapterOptions {
                        power_preference: wgpu::PowerPreference::HighPerformance,
                        ..Default::default()
                    };
                    instance
                        .request_adapter(&options)
                        .await
                        .map_err(|e| GpuError::NoAdapter(e.to_string()))?
                }
            };
            let info = adapter.get_info();
            let downlevel = adapter.get_downlevel_capabilities().flags;
            let fragment_writes = downlevel.contains(wgpu::DownlevelFlags::FRAGMENT_WRITABLE_STORAGE);
            let descriptor = wgpu::DeviceDescriptor {
                label: Some("nmt"),
                required_features: adapter.features() & wanted,
                required_limits: adapter.limits(),
                memory_hints: wgpu::MemoryHints::Performance,
                ..Default::default()
            };
            match adapter.request_device(&descriptor).await {
                Ok((device, queue)) => Ok(Self {
                    info,
                    fragment_writes,
                    device,
                    queue,
                }),
                Err(error) => Err(GpuError::NoDevice {
                    adapter: info.name,
                    reason: error.to_string(),
                }),
            }
        })
    }

    /// The one device of this process, opened when first asked for.
    ///
    /// # Errors
    /// As [`Self::open`], the same every time.
    pub fn shared() -> Result<&'static Self, GpuError> {
        static SHARED: OnceLock<Result<Gpu, GpuError>> = OnceLock::new();
        SHARED.get_or_init(Self::open).as_ref().map_err(Clone::clone)
    }

    /// Name of the adapter with its backend, for every row of a measurement.
    pub fn name(&self) -> String {
        let backend = match self.info.backend {
            wgpu::Backend::Vulkan => "Vulkan",
            wgpu::Backend::Gl => "OpenGL",
            wgpu::Backend::Metal => "Metal",
            wgpu::Backend::Dx12 => "Direct3D 12",
            wgpu::Backend::BrowserWebGpu => "WebGPU",
            wgpu::Backend::Noop => "no backend",
        };
        format!("{} ({backend})", self.info.name)
    }

    /// Whether the adapter runs on the CPU, as lavapipe does.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether shaders may `enable f16`.
    pub fn has_f16(&self) -> bool {
        self.device.features().contains(wgpu::Features::SHADER_F16)
    }

    /// Whether the fragment stage has atomic operations on storage buffers.
    pub fn has_fragment_atomics(&self) -> bool {
        self.fragment_writes
    }

    /// Whether f32 render targets may be blended into.
    pub fn blends_f32(&self) -> bool {
        self.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE)
    }

    /// Whether passes can be timed on the device.
    pub fn has_timestamps(&self) -> bool {
        self.device.features().contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// Runs calls to the device and hands on what it says against them.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn checked<T>(&self, label: &str, calls: impl FnOnce() -> T) -> Result<T, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = calls();
        let validation = pollster::block_on(validation.pop());
        let memory = pollster::block_on(memory.pop());
        match validation.or(memory) {
            None => Ok(made),
            Some(error) => Err(GpuError::Refused {
                label: label.to_owned(),
                reason: error.to_string(),
            }),
        }
    }

    /// A compute pipeline of a function in WGSL source; bind group 0 is what the source says.
    ///
    /// # Errors
    /// [`GpuError::Refused`] where the source is not valid.
    pub fn compute(&self, label: &str, source: &str, entry: &str) -> Result<wgpu::ComputePipeline, GpuError> {
        self.checked(label, || {
            let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(label),
                layout: None,
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        })
    }

    /// Checks that a storage buffer may be so large.
    fn fits(&self, what: &'static str, bytes: u64) -> Result<u64, GpuError> {
        let limits = self.device.limits();
        if bytes > limits.max_buffer_size.min(limits.max_storage_buffer_binding_size) {
            Err(self.too_large(what, bytes))
        } else {
            Ok(bytes.max(16).next_multiple_of(4))
        }
    }

    /// What is said of data that no buffer holds.
    pub(super) fn too_large(&self, what: &'static str, bytes: u64) -> GpuError {
        let limits = self.device.limits();
        GpuError::TooLarge {
            adapter: self.name(),
            what,
            bytes,
            most: limits.max_buffer_size.min(limits.max_storage_buffer_binding_size),
        }
    }

    /// A storage buffer that holds these values; of none, 16 bytes.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn upload<T: Pod>(&self, what: &'static str, values: &[T]) -> Result<wgpu::Buffer, GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        if self.fits(what, bytes.len() as u64)? != bytes.len() as u64 {
            let buffer = self.zeros(what, bytes.len() as u64)?;
            let mut padded = bytes.to_vec();
            padded.resize(buffer.size() as usize, 0);
            self.queue.write_buffer(&buffer, 0, &padded);
            return Ok(buffer);
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        Ok(self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(what),
            contents: bytes,
            usage,
        }))
    }

    /// A uniform buffer that holds these words.
    pub fn uniform(&self, what: &'static str, words: &[u32]) -> wgpu::Buffer {
        let contents = bytemuck::cast_slice(words);
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(what),
            contents,
            usage: wgpu::BufferUsages::UNIFORM,
        })
    }

    /// A storage buffer of zeros.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn zeros(&self, what: &'static str, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        let size = self.fits(what, bytes)?;
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::INDIRECT;
        self.checked(what, || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                size,
                usage,
                mapped_at_creation: false,
            })
        })
    }

    /// The first `count` values of a buffer, once all that was submitted is done.
    ///
    /// # Errors
    /// [`GpuError::Refused`] where the device is lost.
    ///
    /// # Panics
    /// If the buffer is shorter.
    pub fn download<T: Pod>(&self, buffer: &wgpu::Buffer, count: usize) -> Result<Vec<T>, GpuError> {
        let size = (count * size_of::<T>()) as u64;
        assert!(
            size <= buffer.size(),
            "the buffer holds {} bytes, not {size}",
            buffer.size()
        );
        if count == 0 {
            return Ok(Vec::new());
        }
        let refused = |reason: String| GpuError::Refused {
            label: "download".to_owned(),
            reason,
        };
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("download"),
            size: size.next_multiple_of(4),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, size.next_multiple_of(4));
        self.queue.submit([encoder.finish()]);
        let (tell, told) = std::sync::mpsc::channel();
        staging
            .slice(..)
            .map_async(wgpu::MapMode::Read, move |result| _ = tell.send(result));
        self.wait()?;
        told.recv()
            .map_err(|e| refused(e.to_string()))?
            .map_err(|e| refused(e.to_string()))?;
        let view = staging
            .slice(..)
            .get_mapped_range()
            .map_err(|e| refused(e.to_string()))?;
        let mut values = vec![T::zeroed(); count];
        bytemuck::cast_slice_mut::<T, u8>(&mut values).copy_from_slice(&view[..size as usize]);
        Ok(values)
    }

    /// Waits until all that was submitted is done.
    ///
    /// # Errors
    /// [`GpuError::Refused`] where the device is lost.
    pub fn wait(&self) -> Result<(), GpuError> {
        let done = self.device.poll(wgpu::PollType::wait_indefinitely());
        done.map(|_| ()).map_err(|e| GpuError::Refused {
            label: "wait".to_owned(),
            reason: e.to_string(),
        })
    }

    /// Runs dispatches one after the other, waits, and says how long each took \[s\], as [`Self::timed`] does.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn run(&self, label: &str, dispatches: &[Dispatch<'_>]) -> Result<Vec<f64>, GpuError> {
        self.timed(label, dispatches.len(), |index, encoder, stamps| {
            let dispatch = &dispatches[index];
            let entries: Vec<wgpu::BindGroupEntry<'_>> = dispatch
                .buffers
                .iter()
                .enumerate()
                .map(|(i, buffer)| wgpu::BindGroupEntry {
                    binding: i as u32,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout: &dispatch.pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(label),
                timestamp_writes: stamps.compute(),
            });
            pass.set_pipeline(dispatch.pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(dispatch.groups[0], dispatch.groups[1], 1);
        })
    }

    /// Whether [`Self::timed`] reads timestamps of the device, rather than the clock.
    ///
    /// Adapters on the CPU write the timestamps of compute passes when they like: lavapipe writes both of a pass before
    /// it has run.
    pub fn stamps(&self) -> bool {
        self.has_timestamps() && !self.is_software()
    }

    /// Records passes by their index, runs them one after the other, waits, and says how long each took \[s\]: by
    /// timestamps of the device, or where those are missing or not to be trusted by the clock around each, which is
    /// then submitted and waited for by itself.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn timed(
        &self,
        label: &str,
        passes: usize,
        record: impl Fn(usize, &mut wgpu::CommandEncoder, Stamps<'_>),
    ) -> Result<Vec<f64>, GpuError> {
        if !self.stamps() {
            let mut seconds = Vec::with_capacity(passes);
            for index in 0..passes {
                let commands = self.checked(label, || {
                    let mut encoder = self.device.create_command_encoder(&Default::default());
                    record(index, &mut encoder, Stamps(None));
                    encoder.finish()
                })?;
                let start = Instant::now();
                self.checked(label, || self.queue.submit([commands]))?;
                self.wait()?;
                seconds.push(start.elapsed().as_secs_f64());
            }
            return Ok(seconds);
        }
        let timer = Timer::new(self, passes);
        self.checked(label, || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            for index in 0..passes {
                record(index, &mut encoder, Stamps(Some((&timer, index as u32))));
            }
            timer.resolve(&mut encoder);
            self.queue.submit([encoder.finish()]);
        })?;
        self.wait()?;
        timer.seconds(self)
    }
}

/// Where a pass writes its timestamps.
#[derive(Debug, Clone, Copy)]
pub struct Stamps<'a>(Option<(&'a Timer, u32)>);

impl<'a> Stamps<'a> {
    /// For a compute pass.
    pub fn compute(self) -> Option<wgpu::ComputePassTimestampWrites<'a>> {
        self.0.map(|(timer, index)| wgpu::ComputePassTimestampWrites {
            query_set: &timer.queries,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        })
    }

    /// For a render pass.
    pub fn render(self) -> Option<wgpu::RenderPassTimestampWrites<'a>> {
        self.0.map(|(timer, index)| wgpu::RenderPassTimestampWrites {
            query_set: &timer.queries,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        })
    }
}

/// Timestamps before and after each of some passes.
#[derive(Debug)]
pub struct Timer {
    /// Two queries a pass: its beginning and its end.
    pub queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    passes: usize,
}

impl Timer {
    /// For so many passes.
    pub fn new(gpu: &Gpu, passes: usize) -> Self {
        let count = 2 * passes.max(1) as u32;
        let queries = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("timer"),
            ty: wgpu::QueryType::Timestamp,
            count,
        });
        let resolved = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("timer"),
            size: u64::from(8 * count),
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Self {
            queries,
            resolved,
            passes,
        }
    }

    /// Copies the timestamps out; to be called after the last pass.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2 * self.passes.max(1) as u32, &self.resolved, 0);
    }

    /// Seconds of each pass, once they are done.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn seconds(&self, gpu: &Gpu) -> Result<Vec<f64>, GpuError> {
        let ticks: Vec<u64> = gpu.download(&self.resolved, 2 * self.passes)?;
        let period = f64::from(gpu.queue.get_timestamp_period()) * 1e-9;
        Ok(ticks
            .chunks_exact(2)
            .map(|t| t[1].saturating_sub(t[0]) as f64 * period)
            .collect())
    }
}
