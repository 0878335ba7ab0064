//! Both passes in compute shaders over per-pixel lists, and the network only in the tiles that need it.
//!
//! Pass 1 leaves number and range of a pixel's fragments. Pixels of up to three fragments, or of fragments at one depth, follow from exact rules. Tiles of
//! 8 × 8 pixels are sorted into two lists: those where all pixels do, and those with one that needs the network; two indirect dispatches shade them, and
//! the one over the first list runs a shader that holds no network. Neither needs blending, so that this is also the way where a device cannot blend into
//! f32 targets.

use super::device::{Gpu, GpuError};
use super::method::MethodShader;
use super::pipeline::{FRAME, FrameSeconds, Rendered, composite, size_of};
use crate::pixel::{CameraPlanes, FragmentList};

/// Pixels of a tile in each direction, the size of a workgroup.
const TILE: u32 = 8;

/// Workgroups in a row of an indirect dispatch.
const ROW: &str = "32768u";

/// Whether tiles are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Skip {
    /// One dispatch over all tiles.
    None,
    /// The network runs in the tiles that need it.
    Tiles,
}

/// How many tiles there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TileCounts {
    /// Those with a pixel that needs the network.
    pub network: u32,
    /// The others, empty ones among them.
    pub exact: u32,
}

/// Seconds of the passes; see [`Gpu::timed`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileSeconds {
    /// Pass 1.
    pub accumulate: f64,
    /// Telling the tiles apart; 0 without.
    pub classify: f64,
    /// Pass 2 with the resolve: the tiles with the network, or all.
    pub network: f64,
    /// Pass 2 with the resolve: the tiles without; 0 where they are not told apart.
    pub exact: f64,
}

impl TileSeconds {
    /// All but pass 1, which is the same with and without tiles.
    pub fn weights(self) -> f64 {
        self.classify + self.network + self.exact
    }
}

/// A compute shader with its buffers.
#[derive(Debug)]
struct Kernel {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
}

impl Kernel {
    fn new(gpu: &Gpu, label: &str, source: &str, entry: &str, buffers: &[&wgpu::Buffer]) -> Result<Self, GpuError> {
        let pipeline = gpu.compute(label, source, entry)?;
        let group = gpu.checked(label, || {
            let entries: Vec<_> = (0..).zip(buffers).map(|(binding, b)| wgpu::BindGroupEntry { binding, resource: b.as_entire_binding() }).collect();
            let layout = pipeline.get_bind_group_layout(0);
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout: &layout, entries: &entries })
        })?;
        Ok(Self { pipeline, group })
    }
}

/// A method made ready for a list.
#[derive(Debug)]
pub struct TilePasses {
    name: String,
    width: u32,
    height: u32,
    accumulate: Kernel,
    classify: Kernel,
    arrange: Kernel,
    /// All tiles, those with the network, those without.
    every: Kernel,
    network: Kernel,
    exact: Kernel,
    tiles: wgpu::Buffer,
    dispatches: wgpu::Buffer,
    image: wgpu::Buffer,
}

impl TilePasses {
    /// Makes a method ready for a list. `range` is what its depths are measured by; see [`MethodShader::depth_range`].
    ///
    /// # Errors
    /// [`GpuError::NoImage`] where the list makes none, [`GpuError::TooLarge`], [`GpuError::Refused`].
    pub fn new(gpu: &Gpu, list: &FragmentList, method: &MethodShader, range: [f32; 2], background: [f32; 3]) -> Result<Self, GpuError> {
        let (width, height) = size_of(list)?;
        let (pixels, k) = (list.pixels() as u64, method.sums);
        let most = gpu.device.limits().max_compute_workgroups_per_dimension;
        if width.max(height).div_ceil(TILE) > most {
            return Err(GpuError::NoImage(format!("{width} x {height} takes more than {most} tiles in a direction; make it smaller")));
        }
        let offsets: Vec<u32> = list.offsets().iter().map(|&o| o as u32).collect();
        let offsets = gpu.upload("offsets", &offsets)?;
        let view_z = gpu.upload("view_z", list.view_z())?;
        let alpha = gpu.upload("alpha", list.alpha())?;
        let color = gpu.upload("color", list.color().unwrap_or(&[]).as_flattened())?;
        let sums = gpu.zeros("sums of pixels", 4 * k as u64 * pixels)?;
        let ranges = gpu.zeros("ranges of pixels", 16 * pixels)?;
        let image = gpu.zeros("image", 16 * pixels)?;
        let count = width.div_ceil(TILE) * height.div_ceil(TILE);
        let tiles = gpu.zeros("tiles", 4 * (2 + 2 * u64::from(count)))?;
        let dispatches = gpu.zeros("dispatches", 24)?;
        let words = [range[0].to_bits(), range[1].to_bits(), width, height];
        let words = [words, [background[0].to_bits(), background[1].to_bits(), background[2].to_bits(), 0]];
        let frame = gpu.uniform("frame", words.as_flattened());

        let each = |f: &dyn Fn(usize) -> String, between: &str| (0..k).map(f).collect::<Vec<_>>().join(between);
        let module = method.module();
        let accumulate = include_str!("tiles/accumulate.wgsl")
            .replace("OIT_ADD", &each(&|i| format!("sums[{i}] += term[{i}];"), " "))
            .replace("OIT_STORE", &each(&|i| format!("oit_sums[pixel * {k}u + {i}u] = sums[{i}];"), " "));
        // What has no short form needs the long one wherever there is a fragment.
        let short = method.has_short_weight();
        let needs = if short { "ends.x > 3.0 && ends.y < ends.z" } else { "ends.x > 0.0" };
        let classify = include_str!("tiles/classify.wgsl").replace("OIT_NEEDS_NETWORK", needs);
        let weigh = |weight: &str| {
            let weigh = include_str!("tiles/weigh.wgsl")
                .replace("OIT_LOAD", &each(&|i| format!("oit_sums[pixel * {k}u + {i}u]"), ", "))
                .replace("OIT_WEIGHT", weight);
            format!("{module}{FRAME}{}{weigh}", composite(method.composite))
        };
        let listed =
            |weight, list: &str| format!("{}{}", weigh(weight), include_str!("tiles/listed.wgsl").replace("OIT_LIST", list).replace("OIT_ROW", ROW));
        let every = format!("{}{}", weigh("oit_weight"), include_str!("tiles/every.wgsl"));
        let arrange = include_str!("tiles/arrange.wgsl").replace("OIT_ROW", ROW);

        let name = |pass: &str| format!("{}, {pass}", method.name);
        let shaded = [&frame, &offsets, &view_z, &alpha, &color, &sums, &ranges, &image, &tiles];
        let short = if short { "oit_short_weight" } else { "oit_weight" };
        Ok(Self {
            name: method.name.clone(),
            width,
            height,
            accumulate: Kernel::new(
                gpu,
                &name("pass 1"),
                &format!("{module}{FRAME}{accumulate}"),
                "oit_accumulate_tiles",
                &[&frame, &offsets, &view_z, &alpha, &sums, &ranges],
            )?,
            classify: Kernel::new(gpu, "tiles told apart", &format!("{FRAME}{classify}"), "oit_classify", &[&frame, &ranges, &tiles])?,
            arrange: Kernel::new(gpu, "indirect dispatches", &arrange, "oit_arrange", &[&tiles, &dispatches])?,
            every: Kernel::new(gpu, &name("pass 2"), &every, "oit_every_tile", &shaded[..8])?,
            network: Kernel::new(gpu, &name("pass 2"), &listed("oit_weight", "0u"), "oit_listed_tiles", &shaded)?,
            exact: Kernel::new(gpu, &name("pass 2, exact"), &listed(short, "1u"), "oit_listed_tiles", &shaded)?,
            tiles,
            dispatches,
            image,
        })
    }

    /// Runs all passes, waits for them, and says how long they took; see [`Gpu::timed`].
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn run(&self, gpu: &Gpu, skip: Skip) -> Result<TileSeconds, GpuError> {
        let all = Groups::Direct(self.width.div_ceil(TILE), self.height.div_ceil(TILE));
        let passes = match skip {
            Skip::None => vec![(&self.accumulate, all), (&self.every, all)],
            Skip::Tiles => vec![
                (&self.accumulate, all),
                (&self.classify, all),
                (&self.arrange, Groups::Direct(1, 1)),
                (&self.network, Groups::Indirect(0)),
                (&self.exact, Groups::Indirect(12)),
            ],
        };
        let s = gpu.timed(&self.name, passes.len(), |index, encoder, stamps| {
            if index == 0 {
                encoder.clear_buffer(&self.tiles, 0, Some(8));
            }
            let (kernel, groups) = passes[index];
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(&self.name), timestamp_writes: stamps.compute() });
            pass.set_pipeline(&kernel.pipeline);
            pass.set_bind_group(0, &kernel.group, &[]);
            match groups {
                Groups::Direct(x, y) => pass.dispatch_workgroups(x, y, 1),
                Groups::Indirect(offset) => pass.dispatch_workgroups_indirect(&self.dispatches, offset),
            }
        })?;
        Ok(match skip {
            Skip::None => TileSeconds { accumulate: s[0], classify: 0.0, network: s[1], exact: 0.0 },
            Skip::Tiles => TileSeconds { accumulate: s[0], classify: s[1] + s[2], network: s[3], exact: s[4] },
        })
    }

    /// Runs the passes with the tiles told apart, and fetches the image.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn render(&self, gpu: &Gpu) -> Result<Rendered, GpuError> {
        let seconds = self.run(gpu, Skip::Tiles)?;
        let seconds = FrameSeconds { accumulate: seconds.accumulate, weights: seconds.weights(), resolve: 0.0 };
        Ok(Rendered { width: self.width, height: self.height, pixels: self.image(gpu)?, seconds })
    }

    /// How many tiles there were, once [`Self::run`] has told them apart.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn counts(&self, gpu: &Gpu) -> Result<TileCounts, GpuError> {
        let counts: Vec<u32> = gpu.download(&self.tiles, 2)?;
        Ok(TileCounts { network: counts[0], exact: counts[1] })
    }

    /// The image, once it is made.
    ///
    /// # Shapes
    /// `[height * width]`, row by row from the top.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn image(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>, GpuError> {
        let texels: Vec<[f32; 4]> = gpu.download(&self.image, self.width as usize * self.height as usize)?;
        Ok(texels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
    }
}

/// Workgroups of a dispatch, or where in a buffer their numbers stand.
#[derive(Debug, Clone, Copy)]
enum Groups {
    Direct(u32, u32),
    Indirect(u64),
}

/// As [`super::pipeline::render`], in compute passes that blend nothing, with the tiles told apart.
///
/// # Errors
/// [`GpuError`].
pub fn render(
    gpu: &Gpu,
    method: &MethodShader,
    list: &FragmentList,
    planes: Option<CameraPlanes>,
    depth_range: Option<(f32, f32)>,
    background: [f32; 3],
) -> Result<Rendered, GpuError> {
    TilePasses::new(gpu, list, method, method.depth_range(list, planes, depth_range)?, background)?.render(gpu)
}

#[cfg(test)]
mod tests {
    use super::super::pipeline::{
        self,
        tests::{GREY, agree, built_in, cpu, differences, few, image, model, odd, shader},
    };
    use super::*;
    use crate::gpu::tests::gpu;

    fn passes(gpu: &Gpu, list: &FragmentList, method: &MethodShader) -> TilePasses {
        TilePasses::new(gpu, list, method, method.depth_range(list, None, None).unwrap(), GREY).unwrap()
    }

    fn shaded(gpu: &Gpu, passes: &TilePasses, skip: Skip) -> Vec<[u32; 3]> {
        passes.run(gpu, skip).unwrap();
        passes.image(gpu).unwrap().iter().map(|c| c.map(f32::to_bits)).collect()
    }

    /// Tiles that pixels of the list need, counted here.
    fn expected(list: &FragmentList, exact: impl Fn(&[f32]) -> bool) -> TileCounts {
        let (width, height) = list.size().unwrap();
        let across = width.div_ceil(TILE);
        let mut needed = vec![false; (across * height.div_ceil(TILE)) as usize];
        for p in 0..list.pixels() {
            let (x, y) = (p as u32 % width, p as u32 / width);
            needed[(y / TILE * across + x / TILE) as usize] |= !exact(list.pixel(p).view_z);
        }
        let network = needed.iter().filter(|&&n| n).count() as u32;
        TileCounts { network, exact: needed.len() as u32 - network }
    }

    /// With the tiles told apart and without: the same bits, and the lists hold what a count here says. The sizes are no multiples of 8.
    #[test]
    fn tiles_change_no_bit() {
        let Some(gpu) = gpu() else { return };
        for (name, size) in [("teapots", 75), ("foliage", 60), ("hair", 41)] {
            let list = built_in(name, size);
            for network in ["recommended", "small", "moments-6"] {
                let passes = passes(gpu, &list, &shader(&model(network)));
                let (plain, tiles) = (shaded(gpu, &passes, Skip::None), shaded(gpu, &passes, Skip::Tiles));
                assert!(plain == tiles, "{name}, {network}");
                let counts = passes.counts(gpu).unwrap();
                assert_eq!(counts, expected(&list, |v| v.len() <= 3 || v.iter().all(|x| *x == v[0])), "{name}, {network}");
                assert!(counts.network > 0 && (name == "hair" || counts.exact > 0), "{counts:?}");
            }
        }
    }

    /// The control: a short form that answers otherwise shows in the image of a scene with exact tiles, and nowhere else.
    #[test]
    fn exact_tiles_are_shaded_by_the_short_form() {
        let Some(gpu) = gpu() else { return };
        let (list, method) = (built_in("teapots", 64), shader(&model("small")));
        let wrong = MethodShader { source: method.source.replace("fn oit_short_weight(", "fn oit_right_weight(") + WRONG, ..method.clone() };
        const WRONG: &str = "\nfn oit_short_weight(f: OitFragment, p: OitPixel) -> f32 { return 0.5 * oit_right_weight(f, p) + 0.5; }\n";
        let passes = passes(gpu, &list, &wrong);
        let (plain, tiles) = (shaded(gpu, &passes, Skip::None), shaded(gpu, &passes, Skip::Tiles));
        let different = plain.iter().zip(&tiles).filter(|(a, b)| a != b).count();
        assert!(different > 0 && different < plain.len(), "{different}");
    }

    /// A method without a short form runs its own wherever there is a fragment.
    #[test]
    fn methods_without_a_short_form_skip_empty_tiles() {
        let Some(gpu) = gpu() else { return };
        let (list, method) = (built_in("teapots", 64), shader(&model("small")));
        let bare = MethodShader { source: method.source.replace("oit_short_weight", "oit_unknown"), ..method };
        let passes = passes(gpu, &list, &bare);
        assert!(shaded(gpu, &passes, Skip::None) == shaded(gpu, &passes, Skip::Tiles));
        let counts = passes.counts(gpu).unwrap();
        assert_eq!(counts, expected(&list, <[f32]>::is_empty));
        assert!(counts.exact > 0);
    }

    /// The image is the render passes' (they add in the same order, so within 1e-5) and the CPU evaluator's; on a device that cannot blend too.
    #[test]
    fn compute_passes_need_no_blending() {
        let Some(gpu) = gpu() else { return };
        let (list, mlp) = (built_in("foliage", 96), model("recommended"));
        let method = shader(&mlp);
        let poor = Gpu::open_without(wgpu::Features::FLOAT32_BLENDABLE).unwrap();
        assert!(!poor.blends_f32());
        let found = image(&list, &render(&poor, &method, &list, None, None, GREY).unwrap().pixels);
        assert!(agree(&found, &cpu(&mlp, &list)));
        if gpu.blends_f32() {
            let drawn = image(&list, &pipeline::render(gpu, &method, &list, None, None, GREY).unwrap().pixels);
            let d = differences(&found, &drawn);
            assert!(d[d.len() - 1] <= 1e-5, "{:e}", d[d.len() - 1]);
        }
    }

    /// Empty lists, and pixels that are easily got wrong, 1e-6 from the CPU's image.
    #[test]
    fn odd_pixels_are_exact() {
        let Some(gpu) = gpu() else { return };
        let (list, mlp) = (odd(), model("small"));
        let found = render(gpu, &shader(&mlp), &list, None, None, GREY).unwrap();
        let d = differences(&image(&list, &found.pixels), &cpu(&mlp, &list));
        assert!(d[11] <= 1e-6, "{:e}", d[11]);
        let nothing = few(2, &[&[], &[]]);
        assert_eq!(render(gpu, &shader(&mlp), &nothing, None, None, GREY).unwrap().pixels, [GREY; 2]);
    }
}
