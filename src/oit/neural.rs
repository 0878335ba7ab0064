//! Neural moment transparency: a network answers from moments.

use super::capabilities::{Capabilities, Needs};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError, core, deep_weighted_blended};
use crate::features::{Extractor, FeatureSet, MomentFrame, SumPrecision};
use crate::infer::{self, Switches};
pub use crate::infer::{Answered, Skip};
use crate::model::{Mlp, shipped};
use crate::pixel::FragmentList;
use std::path::Path;

/// A network as a transparency method.
pub struct Neural {
    mlp: Mlp,
    switches: Switches,
    precision: SumPrecision,
    frame: MomentFrame,
}

/// The method by its name, `neural:MODEL`; it is in no list of all methods, since it needs a file.
pub const ENTRY: Entry = Entry {
    head: "neural",
    pattern: "neural:MODEL",
    source: "Tsopouridis, Vasilakis, Fudos, Eurographics 2024 (`paper`); the others are ours",
    names: |_| Vec::new(),
    build,
};

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    let path = arguments
        .argument
        .ok_or_else(|| arguments.wrong("expected the path of a model file"))?;
    let mlp = shipped::open(Path::new(path)).map_err(|source| ParseError::Model {
        name: arguments.name.to_owned(),
        source,
    })?;
    Ok(Box::new(Neural::new(mlp)))
}

impl Neural {
    /// The method that asks this network where its answer is used.
    pub fn new(mlp: Mlp) -> Self {
        Self {
            mlp,
            switches: Skip::default().switches(),
            precision: SumPrecision::default(),
            frame: MomentFrame::default(),
        }
    }

    /// The same, asking about other fragments.
    pub fn with_skip(self, skip: Skip) -> Self {
        self.with_switches(skip.switches())
    }

    /// The same, each way of skipping switched on or off.
    pub fn with_switches(self, switches: Switches) -> Self {
        Self { switches, ..self }
    }

    /// The same on moments that pass 1 adds up in another precision, where the feature set leaves that open.
    pub fn with_precision(self, precision: SumPrecision) -> Self {
        Self { precision, ..self }
    }

    /// The same on moments of another frame, where the feature set takes moments of logarithmic depth: `Pixel` stands
    /// for a prepass that has found each pixel's nearest and farthest fragment.
    pub fn with_frame(self, frame: MomentFrame) -> Self {
        let frame = if self.mlp.feature_set().spec().sums.has_precisions {
            frame
        } else {
            MomentFrame::Scene
        };
        Self { frame, ..self }
    }

    /// The frame of its moments.
    pub fn frame(&self) -> MomentFrame {
        self.frame
    }

    /// What it keeps of a pixel besides the colour \[bits\].
    pub fn bits_per_pixel(&self) -> u32 {
        self.capabilities().bits_per_pixel.expect("a network keeps sums")
    }

    /// The network.
    pub fn mlp(&self) -> &Mlp {
        &self.mlp
    }

    fn error(&self, source: crate::pixel::DepthError) -> MethodError {
        MethodError::Depth {
            method: self.name(),
            source,
        }
    }

    /// The network's answer (transmittance, or the like) for every fragment of a list, in its order.
    ///
    /// `progress` is told how many fragments are done.
    ///
    /// # Errors
    /// [`MethodError::Depth`] where camera planes are needed and unknown, a fragment lies outside them, or the depth
    /// range is none.
    pub fn transmittance(
        &self,
        list: &FragmentList,
        context: Context,
        progress: &dyn Fn(u64),
    ) -> Result<Vec<f32>, MethodError> {
        self.answers(list, context, progress)
            .map(|answered| answered.transmittance)
    }

    /// [`Self::transmittance`] with what decided each answer, and how long both passes took; see [`infer::answers`].
    ///
    /// # Errors
    /// As [`Self::transmittance`].
    pub fn answers(
        &self,
        list: &FragmentList,
        context: Context,
        progress: &dyn Fn(u64),
    ) -> Result<Answered, MethodError> {
        let extractor = Extractor::for_list(self.mlp.feature_set(), list, context.planes, context.depth_range)
            .map_err(|e| self.error(e))?
            .with_precision(self.precision)
            .with_frame(self.frame);
        infer::answers(&self.mlp, &extractor, list, self.switches, progress).map_err(|e| self.error(e))
    }
}

impl Method for Neural {
    fn name(&self) -> String {
        format!(
            "neural:{}{}",
            self.mlp.name(),
            if self.frame == MomentFrame::Pixel {
                " @ prepass"
            } else {
                ""
            }
        )
    }

    /// b0 and the moments, the number of fragments and both ends; of core sets also the single fragments, kept by
    /// atomics. Moments in the pixel's own frame need a prepass.
    fn capabilities(&self) -> Capabilities {
        let set = self.mlp.feature_set();
        if set == FeatureSet::DeepWeightedBlended {
            return deep_weighted_blended::CAPABILITIES;
        }
        let of_sums = Capabilities::of_sums(1 + set.moments() as u32, true);
        if let Some(core) = set.spec().core {
            return core::capabilities(&core);
        }
        if self.frame == MomentFrame::Scene {
            return of_sums;
        }
        Capabilities {
            geometry_passes: of_sums.geometry_passes + 1,
            needs: Needs {
                prepass: true,
                ..of_sums.needs
            },
            ..of_sums
        }
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Answers {
            list,
            transmittance: self.transmittance(list, context, &|_| {})?,
        }))
    }
}

/// All answers of a network; they are cheaper to ask for at once.
struct Answers<'a> {
    list: &'a FragmentList,
    transmittance: Vec<f32>,
}

impl Accumulated for Answers<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        for (out, &t) in out.iter_mut().zip(&self.transmittance[self.list.range(p)]) {
            *out = t.into();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::FeatureSet;
    use crate::infer::{Class, Passes};
    use crate::model::file;
    use crate::model::mlp::tests::random_mlp;
    use crate::numeric::rng::stream;
    use crate::oit;
    use crate::pixel::CameraPlanes;

    /// Two fragments need no network, whatever it says; of five the ends do not, and all answers lie between the total
    /// transmittance and 1.
    #[test]
    fn what_is_known_is_not_asked() {
        let view_z = vec![2.0, 1.0, 4.0, 1.5, 2.5, 3.0, 7.0];
        let alpha = vec![0.5, 0.25, 0.9, 0.3, 0.6, 0.2, 0.7];
        let list = FragmentList::new(vec![0, 2, 7], view_z, alpha, None).unwrap();
        let mlp = Mlp::new(
            "r",
            FeatureSet::Recentred,
            random_mlp(&[4], 1).layers().to_vec(),
            crate::model::Provenance::default(),
        )
        .unwrap();
        let found = Neural::new(mlp)
            .transmittance(&list, Context::default(), &|_| {})
            .unwrap();
        let exact = crate::pixel::abuffer::list_transmittance(&list);
        for known in [0, 1, 3, 6] {
            assert!((f64::from(found[known]) - exact[known]).abs() < 1e-6, "{known}");
        }
        assert_eq!((found[1], found[3]), (1.0, 1.0));
        let total = exact[6] as f32 * 0.3;
        assert!([2, 4, 5].iter().all(|&i| found[i] >= total && found[i] <= 1.0));
    }

    #[test]
    fn answers_stand_in_the_order_of_the_list() {
        let list = FragmentList::new(vec![0, 0, 2, 3], vec![2.0, 1.0, 4.0], vec![0.5, 0.25, 1.0], None).unwrap();
        let planes = CameraPlanes::new(0.5, 8.0).unwrap();
        let method = Neural::new(random_mlp(&[4], 1));
        assert!(matches!(
            method.accumulate(&list, Context::default()),
            Err(MethodError::Depth { .. })
        ));
        let context = Context {
            planes: Some(planes),
            ..Context::default()
        };
        let all = oit::weights(&list, &*method.accumulate(&list, context).unwrap());
        let rows = Extractor::new(FeatureSet::Paper, Some(planes), None)
            .unwrap()
            .list(&list, 1..2)
            .unwrap()
            .features;
        assert_eq!(
            all[..2],
            random_mlp(&[4], 1)
                .predict(&rows)
                .into_iter()
                .map(f64::from)
                .collect::<Vec<_>>()
        );
        assert_eq!(all.len(), 3);
        let none = FragmentList::new(vec![0], vec![], vec![], None)
            .unwrap()
            .with_planes(planes);
        assert!(
            method
                .transmittance(&none, Context::default(), &|_| {})
                .unwrap()
                .is_empty()
        );
    }

    fn recentred(hidden: &[usize], seed: u64, scale: f32) -> Mlp {
        let mut layers = random_mlp(hidden, seed).layers().to_vec();
        layers
            .iter_mut()
            .for_each(|l| l.biases.iter_mut().for_each(|b| *b *= scale));
        Mlp::new("r", FeatureSet::Recentred, layers, crate::model::Provenance::default()).unwrap()
    }

    /// `exact` gives the bits of `none`, and runs the network less often; with features that know nothing too.
    #[test]
    fn exact_answers_are_those_without_skipping() {
        let list = crate::infer::passes::tests::pixels(&mut stream(4, 94, 0), 4000)
            .with_planes(CameraPlanes::new(0.5, 200.0).unwrap());
        for mlp in [recentred(&[16, 8], 1, 1.0), random_mlp(&[4], 1)] {
            let of = |skip| {
                Neural::new(mlp.clone())
                    .with_skip(skip)
                    .answers(&list, Context::default(), &|_| {})
                    .unwrap()
            };
            let (none, exact, visible) = (of(Skip::None), of(Skip::Exact), of(Skip::Visible));
            let bits = |a: &Answered| a.transmittance.iter().map(|t| t.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&none), bits(&exact));
            assert_eq!(none.tally.rows as usize, list.len());
            assert!(exact.tally.rows < none.tally.rows || mlp.feature_set() == FeatureSet::Paper);
            assert!(visible.tally.rows < exact.tally.rows);
            assert_ne!(bits(&visible), bits(&exact));
        }
    }

    /// Adversarial pixels under networks that say anything: no channel is more than half a display step from the image
    /// in which hidden fragments are answered exactly and all others by the network. Controls: answering them with 1
    /// is; and some pixel is asked after all.
    #[test]
    fn what_is_skipped_cannot_be_seen() {
        let list = crate::infer::passes::tests::pixels(&mut stream(5, 94, 0), 20_000);
        let truth = crate::pixel::abuffer::list_transmittance(&list);
        let (mut worst, mut control, mut again) = (0.0f64, 0.0f64, 0);
        for (mlp, background) in [
            (recentred(&[16, 8], 1, 1.0), 1.0),
            (recentred(&[8], 2, 9.0), 0.0),
            (recentred(&[6], 3, -9.0), 1.0),
            (recentred(&[4], 9, 40.0), 0.0),
        ] {
            let of = |skip| {
                Neural::new(mlp.clone())
                    .with_skip(skip)
                    .answers(&list, Context::default(), &|_| {})
                    .unwrap()
            };
            let (exact, visible) = (of(Skip::Exact), of(Skip::Visible));
            let classes_alone = {
                let mut class = vec![Class::Network; list.len()];
                let extractor = Extractor::for_list(FeatureSet::Recentred, &list, None, None).unwrap();
                let passes = Passes::of(&extractor).unwrap();
                passes.run(
                    &list,
                    0..list.pixels(),
                    Skip::Visible.switches(),
                    || |_: &[_], out: &mut [f32]| out.fill(f32::NAN),
                    &mut vec![0.0; list.len()],
                    &mut class,
                );
                class
            };
            again += classes_alone
                .iter()
                .zip(&visible.classes)
                .filter(|(a, b)| a != b)
                .count();
            for p in 0..list.pixels() {
                let range = list.range(p);
                let image = |answer: &dyn Fn(usize) -> f64| {
                    let weights: Vec<f64> = range.clone().map(answer).collect();
                    oit::composite_normalised(list.pixel(p), &weights, [background; 3])
                };
                let is_hidden = |i: usize| visible.classes[i] == Class::Hidden;
                let reference = image(&|i| {
                    if is_hidden(i) {
                        truth[i]
                    } else {
                        exact.transmittance[i].into()
                    }
                });
                let found = image(&|i| visible.transmittance[i].into());
                let bold = image(&|i| {
                    if is_hidden(i) {
                        1.0
                    } else {
                        visible.transmittance[i].into()
                    }
                });
                for c in 0..3 {
                    let change = (found[c] - reference[c]).abs();
                    worst = if change.is_nan() { f64::NAN } else { worst.max(change) };
                    control = control.max((bold[c] - reference[c]).abs());
                }
            }
        }
        assert!(worst <= 1.0 / 512.0 && worst > 1e-4, "{worst}");
        assert!(control > 0.05 && again > 0, "{control} {again}");
    }

    /// The shipped network on the built-in scenes: what `visible` changes, against its own answers. Tolerances: 1/512
    /// in a channel, 0.0005 of FLIP. Control: the image of another network is farther.
    #[test]
    fn built_in_scenes_look_the_same() {
        let load = |text: &str| file::from_json(text.as_bytes(), Path::new("m.json")).unwrap();
        let recommended = load(include_str!("../../models/recommended.json"));
        for name in crate::scene::BUILT_IN {
            let options = crate::scene::Options {
                size: Some((96, 96)),
                seed: None,
            };
            let list = crate::scene::build(&crate::scene::open(name).unwrap(), &options).unwrap();
            let image = |mlp: &Mlp, skip| {
                let answers = Neural::new(mlp.clone())
                    .with_skip(skip)
                    .transmittance(&list, Context::default(), &|_| {})
                    .unwrap();
                let pixels = (0..list.pixels()).map(|p| {
                    let weights: Vec<f64> = answers[list.range(p)].iter().map(|&t| t.into()).collect();
                    oit::composite_normalised(list.pixel(p), &weights, [1.0; 3])
                });
                crate::evaluate::Image::new(96, 96, pixels.collect()).unwrap()
            };
            let (exact, visible) = (image(&recommended, Skip::Exact), image(&recommended, Skip::Visible));
            let farthest = |a: &crate::evaluate::Image| {
                let pairs = a.pixels().as_flattened().iter().zip(exact.pixels().as_flattened());
                pairs
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, |m: f64, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
            };
            assert!(farthest(&visible) <= 1.0 / 512.0, "{name}: {}", farthest(&visible));
            assert!(
                crate::evaluate::flip(&exact, &visible).unwrap().mean() <= 5e-4,
                "{name}"
            );
            let other = image(&recentred(&[4], 9, 9.0), Skip::Exact);
            assert!(farthest(&other) > 1.0 / 512.0, "{name}: {}", farthest(&other));
        }
    }

    /// What moments of half resolution would do: b_1..b_4 of 2 x 2 pixels added up and scaled to each pixel's own b_0,
    /// beside its own n and ends, which is the best that may be hoped for. The image MSE of the shipped network grows
    /// at least twofold on four of the six built-in scenes, so no renderer of ours does it. Control: moments of the
    /// pixel itself, put together in the same way, give the usual image MSE to 5 %.
    #[test]
    fn moments_of_half_resolution_lose_the_edges() {
        use crate::features::recentred::{FragmentTerms, Pass2Input, PixelSums, absorbance, moment_depth};
        const SIZE: usize = 128;
        let mlp = file::from_json(include_bytes!("../../models/recommended.json"), Path::new("m.json")).unwrap();
        let mut worse = 0;
        for name in crate::scene::BUILT_IN {
            let options = crate::scene::Options {
                size: Some((SIZE as u32, SIZE as u32)),
                seed: None,
            };
            let list = crate::scene::build(&crate::scene::open(name).unwrap(), &options).unwrap();
            let range = list.depth_range().map(|(v0, v1)| [v0, v1]).unwrap();
            let terms = |p: usize| -> Vec<FragmentTerms<f32>> {
                let pixel = list.pixel(p);
                let fragments = pixel.view_z.iter().zip(pixel.alpha);
                fragments
                    .map(|(&view_z, &a)| FragmentTerms {
                        view_z,
                        z: moment_depth(view_z, range),
                        absorbance: absorbance(a),
                    })
                    .collect()
            };
            let sums: Vec<PixelSums<f32, 4>> = (0..list.pixels())
                .map(|p| {
                    let mut sums = PixelSums::default();
                    terms(p).into_iter().for_each(|s| sums.add(s));
                    sums
                })
                .collect();
            let image = |step: usize| {
                let pixels = (0..list.pixels()).map(|p| {
                    let (x, y) = (p % SIZE / step * step, p / SIZE / step * step);
                    let block = (0..step * step).map(|i| sums[(y + i / step) * SIZE + x + i % step]);
                    let (mut b0, mut b) = (0.0, [0.0; 4]);
                    block.for_each(|s| {
                        b0 += s.b0;
                        b.iter_mut().zip(s.b).for_each(|(b, s)| *b += s);
                    });
                    let own = PixelSums {
                        b: b.map(|b| if step == 1 { b } else { b * (sums[p].b0 / b0.max(1e-30)) }),
                        ..sums[p]
                    };
                    let ends =
                        [own.nearest, own.farthest].map(|v| if v.is_finite() { moment_depth(v, range) } else { 0.0 });
                    let weights: Vec<f64> = terms(p)
                        .into_iter()
                        .map(|s| match own.classify(s, ends) {
                            Pass2Input::Solved(t) => t.into(),
                            Pass2Input::Query(first, measure) => {
                                mlp.forward::<f32>(&[&first[..], &measure[..]].concat()).into()
                            }
                        })
                        .collect();
                    oit::composite_normalised(list.pixel(p), &weights, [1.0; 3])
                });
                crate::evaluate::Image::new(SIZE as u32, SIZE as u32, pixels.collect()).unwrap()
            };
            let exact = crate::evaluate::image::ground_truth(&list, [1.0; 3]).unwrap();
            let mse = |image: &crate::evaluate::Image| image.error(&exact).unwrap().mse();
            let (full, half) = (image(1), image(2));
            let usual = crate::evaluate::Truth::new(&list, [1.0; 3])
                .judge(&Neural::new(mlp.clone()), Context::default())
                .unwrap();
            let usual = mse(&usual.picture.unwrap().0);
            let looks = crate::evaluate::flip(&full, &half).unwrap().mean();
            println!(
                "{name}: image MSE {:.3e}, with moments of 2 x 2 pixels {:.3e}, FLIP between them {looks:.1e}",
                mse(&full),
                mse(&half)
            );
            assert!(
                (mse(&full) - usual).abs() <= 0.05 * usual,
                "{name}: {:e} for {usual:e}",
                mse(&full)
            );
            worse += usize::from(mse(&half) >= 2.0 * mse(&full));
        }
        assert!(worse >= 4, "{worse}");
    }
}
