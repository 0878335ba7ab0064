//! Both passes in compute shaders over per-pixel lists, and the network only for the fragments that need it.
//!
//! Pass 1 leaves number and range of a pixel's fragments. Pixels of up to four fragments, or of fragments at one depth,
//! follow from exact rules; they are shaded as soon as they are told apart, by a shader that holds no network. The
//! others go to a list, 64 to a workgroup whatever lies between them, and an indirect dispatch shades them. With
//! [`Skip::Visible`] faint pixels are known too, and pixels in which fragments may be hidden have a list and a shader
//! of their own: it finds the depth from which on all is hidden, once a pixel, and runs the network for what is in
//! front. Nothing needs blending, so that this is also the way where a device cannot blend into f32 targets.

use super::device::{Gpu, GpuError, groups};
use super::pipeline::{FrameSeconds, Rendered};
use super::upload::{self, DeviceList, frame};
use crate::oit::neural::Skip;
use crate::pixel::{CameraPlanes, FragmentList};
use crate::shader::MethodShader;
use crate::shader::compute::{ACCUMULATE, CLASSIFY, EVERY, LISTED, TILE, TILE_CORE, TileShaders};

/// How many pixels there are of each kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelCounts {
    /// Those with a fragment that needs the network.
    pub network: u32,
    /// Those of them in which fragments may be hidden.
    pub hiding: u32,
    /// The others, empty ones among them.
    pub known: u32,
}

/// Seconds of the passes; see [`Gpu::timed`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileSeconds {
    /// Pass 1.
    pub accumulate: f64,
    /// Telling the pixels apart, and pass 2 with the resolve for those that are known; 0 without.
    pub classify: f64,
    /// Pass 2 with the resolve: the pixels that need the network, or all.
    pub network: f64,
}

impl TileSeconds {
    /// All but pass 1, which is the same whatever is skipped.
    pub fn weights(self) -> f64 {
        self.classify + self.network
    }
}

/// A compute shader with its buffers.
#[derive(Debug)]
struct Kernel {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
}

impl Kernel {
    /// `core` is bound behind all others.
    fn new(
        gpu: &Gpu,
        label: &str,
        source: &str,
        entry: &str,
        buffers: &[&wgpu::Buffer],
        core: Option<(u32, &wgpu::Buffer)>,
    ) -> Result<Self, GpuError> {
        let pipeline = gpu.compute(label, source, entry)?;
        let group = gpu.checked(label, || {
            let entries: Vec<_> = (0..)
                .zip(buffers.iter().copied())
                .chain(core)
                .map(|(binding, b)| wgpu::BindGroupEntry {
                    binding,
                    resource: b.as_entire_binding(),
                })
                .collect();
            let layout = pipeline.get_bind_group_layout(0);
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout: &layout,
                entries: &entries,
            })
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
    every: Kernel,
    /// Pixels told apart, with and without what cannot be seen.
    classify: [Kernel; 2],
    network: Kernel,
    /// The network, where fragments may be hidden; none where the method cannot tell.
    hiding: Option<Kernel>,
    /// The network, where the bounds of a core's tail leave T open; none where there is no such network.
    open: Option<Kernel>,
    lists: wgpu::Buffer,
    image: wgpu::Buffer,
}

impl TilePasses {
    /// Makes a method ready for a list. `range` is what its depths are measured by; see [`MethodShader::depth_range`].
    ///
    /// # Errors
    /// [`GpuError::NoImage`] where the list makes none, [`GpuError::TooLarge`], [`GpuError::Refused`].
    pub fn new(
        gpu: &Gpu,
        list: &DeviceList,
        method: &MethodShader,
        range: [f32; 2],
        background: [f32; 3],
    ) -> Result<Self, GpuError> {
        let (width, height) = list.image_size()?;
        let most = gpu.device.limits().max_compute_workgroups_per_dimension;
        if width.max(height).div_ceil(TILE) > most {
            return Err(GpuError::NoImage(format!(
                "{width} x {height} takes more than {most} tiles in a direction; make it smaller"
            )));
        }
        let chunk = list.whole(gpu)?;
        let (pixels, shaders) = (list.pixels as u64, TileShaders::new(method));
        let frame = frame(gpu, method, range, (width, height), background, 1.0);
        let state = gpu.zeros("what pass 1 leaves", 16 * shaders.vectors as u64 * pixels)?;
        let image = gpu.zeros("image", 16 * pixels)?;
        let lists = gpu.zeros("lists of pixels", 4 * (8 + pixels))?;
        let core = upload::core(gpu, method, list.pixels)?;
        let core_at = |binding| core.as_ref().map(|buffer| (binding, buffer));

        let name = |pass: &str| format!("{}, {pass}", method.name);
        let (view_z, alpha, color) = (&chunk.view_z, &chunk.alpha, &chunk.color);
        let shaded = [&frame, &list.offsets, view_z, alpha, color, &state, &image, &lists];
        let kernel =
            |pass: &str, source: &str, entry| Kernel::new(gpu, &name(pass), source, entry, &shaded, core_at(TILE_CORE));
        let accumulated = [&frame, &list.offsets, view_z, alpha, &state];
        let listed = |pass: &str, source: Option<&str>| source.map(|source| kernel(pass, source, LISTED)).transpose();
        Ok(Self {
            name: method.name.clone(),
            width,
            height,
            accumulate: Kernel::new(
                gpu,
                &name("pass 1"),
                &shaders.accumulate,
                ACCUMULATE,
                &accumulated,
                core_at(5),
            )?,
            every: Kernel::new(
                gpu,
                &name("pass 2"),
                &shaders.every,
                EVERY,
                &shaded[..7],
                core_at(TILE_CORE),
            )?,
            classify: [
                kernel("pixels told apart", &shaders.classify[0], CLASSIFY)?,
                kernel("pixels told apart by what is seen", &shaders.classify[1], CLASSIFY)?,
            ],
            network: kernel("pass 2, network", &shaders.network, LISTED)?,
            hiding: listed("pass 2, hidden or network", shaders.hiding.as_deref())?,
            open: listed("pass 2, open or not", shaders.open.as_deref())?,
            lists,
            image,
        })
    }

    /// Runs all passes, waits for them, and says how long they took; see [`Gpu::timed`].
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn run(&self, gpu: &Gpu, skip: Skip) -> Result<TileSeconds, GpuError> {
        let all = Groups::Direct(self.width.div_ceil(TILE), self.height.div_ceil(TILE));
        let [x, y] = groups(u64::from(self.width) * u64::from(self.height));
        let accumulate = (&self.accumulate, Groups::Direct(x, y));
        let network = (&self.network, Groups::Indirect(0));
        let passes = match (skip, &self.hiding) {
            (Skip::None, _) => vec![vec![accumulate], vec![(&self.every, all)]],
            (Skip::Visible, Some(hiding)) => {
                vec![
                    vec![accumulate],
                    vec![(&self.classify[1], all)],
                    vec![network, (hiding, Groups::Indirect(12))],
                ]
            }
            (Skip::Visible, None) => {
                let network = (self.open.as_ref().unwrap_or(&self.network), Groups::Indirect(0));
                vec![vec![accumulate], vec![(&self.classify[1], all)], vec![network]]
            }
            (Skip::Exact, _) => vec![vec![accumulate], vec![(&self.classify[0], all)], vec![network]],
        };
        let s = gpu.timed(&self.name, passes.len(), |index, encoder, stamps| {
            if index == 0 {
                encoder.clear_buffer(&self.lists, 0, Some(32));
            }
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(&self.name),
                timestamp_writes: stamps.compute(),
            });
            for (kernel, groups) in &passes[index] {
                pass.set_pipeline(&kernel.pipeline);
                pass.set_bind_group(0, &kernel.group, &[]);
                match *groups {
                    Groups::Direct(x, y) => pass.dispatch_workgroups(x, y, 1),
                    Groups::Indirect(offset) => pass.dispatch_workgroups_indirect(&self.lists, offset),
                }
            }
        })?;
        Ok(match s[..] {
            [accumulate, classify, network] => TileSeconds {
                accumulate,
                classify,
                network,
            },
            _ => TileSeconds {
                accumulate: s[0],
                classify: 0.0,
                network: s[1],
            },
        })
    }

    /// Runs the passes, and fetches the image.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn render(&self, gpu: &Gpu, skip: Skip) -> Result<Rendered, GpuError> {
        let seconds = self.run(gpu, skip)?;
        let seconds = FrameSeconds {
            accumulate: seconds.accumulate,
            weights: seconds.weights(),
            resolve: 0.0,
        };
        Ok(Rendered {
            width: self.width,
            height: self.height,
            pixels: self.image(gpu)?,
            seconds,
        })
    }

    /// How many pixels there were of each kind, once [`Self::run`] has told them apart.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn counts(&self, gpu: &Gpu) -> Result<PixelCounts, GpuError> {
        let head: Vec<u32> = gpu.download(&self.lists, 8)?;
        let (network, hiding) = (head[6] + head[7], head[7]);
        Ok(PixelCounts {
            network,
            hiding,
            known: self.width * self.height - network,
        })
    }

    /// How many fragments the network was run for, or under [`Skip::None`] all, once [`Self::run`] is done.
    ///
    /// # Errors
    /// [`GpuError::Refused`].
    pub fn evaluated(&self, gpu: &Gpu) -> Result<u64, GpuError> {
        let texels: Vec<[f32; 4]> = gpu.download(&self.image, self.width as usize * self.height as usize)?;
        Ok(texels.iter().map(|t| t[3] as u64).sum())
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

/// As [`super::pipeline::render`], in compute passes that blend nothing, with the network for fragments whose answer is
/// used.
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
    let range = method.depth_range(list, planes, depth_range)?;
    let list = DeviceList::new(gpu, list)?;
    TilePasses::new(gpu, &list, method, range, background)?.render(gpu, Skip::Exact)
}

#[cfg(test)]
mod tests {
    use super::super::pipeline::{
        self,
        tests::{GREY, agree, built_in, cpu, differences, few, image, model, odd, shader},
    };
    use super::*;
    use crate::evaluate::{Image, flip};
    use crate::gpu::tests::gpu;
    use crate::model::Mlp;
    use crate::oit::neural::Neural;
    use crate::oit::shader::Offers;
    use crate::oit::{Context, Method, weights};

    fn passes(gpu: &Gpu, list: &FragmentList, method: &MethodShader) -> TilePasses {
        let range = method.depth_range(list, None, None).unwrap();
        TilePasses::new(gpu, &DeviceList::new(gpu, list).unwrap(), method, range, GREY).unwrap()
    }

    fn shaded(gpu: &Gpu, passes: &TilePasses, skip: Skip) -> Vec<[u32; 3]> {
        passes.run(gpu, skip).unwrap();
        passes.image(gpu).unwrap().iter().map(|c| c.map(f32::to_bits)).collect()
    }

    /// Pixels of the list, counted here.
    fn expected(list: &FragmentList, known: impl Fn(&[f32]) -> bool) -> PixelCounts {
        let known = (0..list.pixels()).filter(|&p| known(list.pixel(p).view_z)).count() as u32;
        PixelCounts {
            network: list.pixels() as u32 - known,
            hiding: 0,
            known,
        }
    }

    /// With the pixels told apart and without: the same bits, and the lists hold what a count here says. The sizes are
    /// no multiples of 8.
    #[test]
    fn telling_pixels_apart_changes_no_bit() {
        let Some(gpu) = gpu() else { return };
        for (name, size) in [("teapots", 75), ("foliage", 60), ("hair", 41)] {
            let list = built_in(name, size);
            for network in ["recommended", "small", "moments-6"] {
                let passes = passes(gpu, &list, &shader(&model(network)));
                let (plain, apart) = (shaded(gpu, &passes, Skip::None), shaded(gpu, &passes, Skip::Exact));
                assert!(plain == apart, "{name}, {network}");
                let counts = passes.counts(gpu).unwrap();
                assert_eq!(
                    counts,
                    expected(&list, |v| v.len() <= 4 || v.iter().all(|x| *x == v[0])),
                    "{name}, {network}"
                );
                assert!(counts.network > 0 && counts.known > 0, "{counts:?}");
                let evaluated: usize = (0..list.pixels()).map(|p| list.range(p).len()).filter(|&n| n > 4).sum();
                let found = passes.evaluated(gpu).unwrap() as usize;
                assert!(
                    found <= evaluated && found * 100 >= evaluated * 98,
                    "{name}, {network}: {found} of {evaluated}"
                );
            }
        }
    }

    /// The control: a short form that answers otherwise shows in the image of a scene with known pixels, and nowhere
    /// else.
    #[test]
    fn known_pixels_are_shaded_by_the_short_form() {
        let Some(gpu) = gpu() else { return };
        let (list, method) = (built_in("teapots", 64), shader(&model("small")));
        let wrong = MethodShader {
            source: method.source.replace("fn oit_short_weight(", "fn oit_right_weight(") + WRONG,
            ..method.clone()
        };
        const WRONG: &str = "\nfn oit_short_weight(f: OitFragment, p: OitPixel) -> f32 { return 0.5 * \
            oit_right_weight(f, p) + 0.5; }\n";
        let passes = passes(gpu, &list, &wrong);
        let (plain, apart) = (shaded(gpu, &passes, Skip::None), shaded(gpu, &passes, Skip::Exact));
        let different = plain.iter().zip(&apart).filter(|(a, b)| a != b).count();
        assert!(different > 0 && different < plain.len(), "{different}");
    }

    /// What cannot be seen is left out: on the built-in scenes no channel is more than 1/512 from the image that skips
    /// nothing, FLIP at most 0.0005, and the CPU's `visible` image is met as the CPU's is elsewhere; fewer fragments
    /// are evaluated for where some are hidden. Control: a shader that takes nearly all fragments for hidden.
    #[test]
    fn what_is_left_out_cannot_be_seen() {
        let Some(gpu) = gpu() else { return };
        let mut controls = 0;
        for name in crate::scene::BUILT_IN {
            let list = built_in(name, 96);
            for network in ["recommended", "small"] {
                let mlp = model(network);
                let method = shader(&mlp);
                let bold = method
                    .source
                    .replace("fn oit_hidden_weight(", "fn oit_right_weight(")
                    .replace("fn oit_first_hidden_depth(", "fn oit_right_depth(")
                    + "\nfn oit_hidden_weight(f: OitFragment, p: OitPixel) -> f32 { return 0.0 * oit_right_weight(f, \
                        p); }\n"
                    + "fn oit_first_hidden_depth(p: OitPixel) -> f32 { return min(0.0 * oit_right_depth(p), 0.0) + \
                        p.z_nearest; }\n";
                let of = |method: &MethodShader, skip| {
                    let passes = passes(gpu, &list, method);
                    passes.run(gpu, skip).unwrap();
                    (
                        image(&list, &passes.image(gpu).unwrap()),
                        passes.evaluated(gpu).unwrap(),
                        passes.counts(gpu).unwrap(),
                    )
                };
                let ((none, ..), (_, exact, _)) = (of(&method, Skip::None), of(&method, Skip::Exact));
                let (visible, evaluated, counts) = of(&method, Skip::Visible);
                let worst = |a: &Image| differences(a, &none)[list.pixels() - 1];
                let looks = flip(&none, &visible).unwrap().mean();
                println!(
                    "{name}, {network}: {counts:?}, evaluated {exact} and {evaluated}, change {:.1e}, FLIP {looks:.1e}",
                    worst(&visible)
                );
                assert!(
                    worst(&visible) <= 1.0 / 512.0 && looks <= 5e-4 && evaluated <= exact,
                    "{name}, {network}"
                );
                assert!(evaluated * 10 < exact * 9 || name != "foliage");
                let neural = Neural::new(mlp).with_skip(Skip::Visible);
                let accumulated = neural.accumulate(&list, Context::default()).unwrap();
                let cpu = crate::evaluate::image::of_method(
                    &list,
                    &*accumulated,
                    &weights(&list, &*accumulated),
                    GREY.map(f64::from),
                )
                .unwrap();
                // Of hair two f32 passes on the CPU are 2e-3 apart.
                assert!(agree(&visible, &cpu) || name == "hair", "{name}, {network}");
                if counts.hiding > 0 {
                    controls += usize::from(
                        worst(&of(&MethodShader { source: bold, ..method }, Skip::Visible).0) > 1.0 / 512.0,
                    );
                }
            }
        }
        assert!(controls > 3, "{controls}");
    }

    /// Faint pixels, whatever the network says: no channel changes by more than 1/512, and the network is evaluated in
    /// none of them. Controls: it is in pixels three times as opaque, and networks that answer 0 or 1 do change what is
    /// seen a little.
    #[test]
    fn faint_pixels_need_no_network() {
        let Some(gpu) = gpu() else { return };
        let pixel =
            |most: f32| -> Vec<(f32, f32)> { (0..20).map(|i| (2.0 + (i * 7 % 20) as f32, most / 20.0)).collect() };
        let list = |most: f32| few(8, &vec![&pixel(most)[..]; 64]);
        for bias in [-40.0, 0.0, 40.0] {
            let method = shader(&biased("small", bias));
            let changed = |method: &MethodShader, list: &FragmentList| {
                let passes = passes(gpu, list, method);
                let of = |skip| {
                    passes.run(gpu, skip).unwrap();
                    image(list, &passes.image(gpu).unwrap())
                };
                (
                    differences(&of(Skip::None), &of(Skip::Visible))[63],
                    passes.evaluated(gpu).unwrap(),
                )
            };
            let (worst, evaluated) = changed(&method, &list(0.06));
            assert!(worst <= 1.0 / 512.0 && evaluated == 0, "{worst} {evaluated}");
            assert_eq!(changed(&method, &list(0.2)), (0.0, 64 * 20));
            assert!(bias == 0.0 || worst > 1e-5, "{worst}");
        }
    }

    /// The network again, with another bias of its last layer: it answers share 0 or 1 to anything.
    fn biased(network: &str, by: f32) -> Mlp {
        let mlp = model(network);
        let mut layers = mlp.layers().to_vec();
        layers.last_mut().unwrap().biases.iter_mut().for_each(|b| *b += by);
        Mlp::new("biased", mlp.feature_set(), layers, crate::model::Provenance::default()).unwrap()
    }

    /// Where a network's answers weigh too little for the bound, it is evaluated for hidden fragments after all, once
    /// for each, and the image is that of none but for the order of its sums, 1e-5. Control: with answers that weigh
    /// enough, it is not evaluated.
    #[test]
    fn doubtful_pixels_are_asked_about() {
        let Some(gpu) = gpu() else { return };
        let pixel: Vec<(f32, f32)> = (0..40)
            .map(|i| (if i < 20 { 2.0 + 0.01 * i as f32 } else { 40.0 + i as f32 }, 0.45))
            .collect();
        let list = few(8, &vec![&pixel[..]; 64]);
        let evaluated = |bias: f32| {
            let passes = passes(gpu, &list, &shader(&biased("recommended", bias)));
            let of = |skip| {
                passes.run(gpu, skip).unwrap();
                image(&list, &passes.image(gpu).unwrap())
            };
            let change = differences(&of(Skip::None), &of(Skip::Visible))[63];
            assert_eq!(passes.counts(gpu).unwrap().hiding, 64);
            (passes.evaluated(gpu).unwrap(), change)
        };
        let (doubtful, change) = evaluated(40.0);
        let (usual, _) = evaluated(0.0);
        println!("{doubtful} and {usual} of {}", list.len());
        assert!(
            change <= 1e-5 && doubtful == list.len() as u64 && usual < list.len() as u64 * 3 / 4,
            "{doubtful} {usual}"
        );
    }

    /// A method without a short form runs its own wherever there is a fragment.
    #[test]
    fn methods_without_a_short_form_skip_empty_pixels() {
        let Some(gpu) = gpu() else { return };
        let (list, method) = (built_in("teapots", 64), shader(&model("small")));
        let bare = MethodShader {
            offers: Offers::default(),
            ..method
        };
        let passes = passes(gpu, &list, &bare);
        assert!(shaded(gpu, &passes, Skip::None) == shaded(gpu, &passes, Skip::Exact));
        let counts = passes.counts(gpu).unwrap();
        assert_eq!(counts, expected(&list, <[f32]>::is_empty));
        assert!(counts.known > 0);
    }

    /// The image is the render passes' (they add in the same order, so within 1e-5) and the CPU evaluator's; on a
    /// device that cannot blend too.
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
            let drawn = image(
                &list,
                &pipeline::render(gpu, &method, &list, None, None, GREY).unwrap().pixels,
            );
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
        assert_eq!(
            render(gpu, &shader(&mlp), &nothing, None, None, GREY).unwrap().pixels,
            [GREY; 2]
        );
    }
}
