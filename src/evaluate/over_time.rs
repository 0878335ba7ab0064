//! Error over time: how a method's image changes from frame to frame, beside how the truth changes.
//!
//! An error that stays where it is looks like another material; one that comes and goes flickers. Of frames 0, 1, …
//! with images m and exact images t the measure is the mean, over frames from the second on, pixels and channels, of
//! ((m_i − m_{i−1}) − (t_i − t_{i−1}))².

use super::{EvaluateError, Image, image};
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::{self, Context, Method};
use crate::pixel::FragmentList;
use serde::{Deserialize, Serialize};

/// Change of a method from frame to frame against the change of the truth. In JSON, NaN becomes null; the count says
/// why.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OverTime {
    /// Number of frames.
    pub frames: u32,
    /// Mean square of (change of the method − change of the truth), over all frames but the first, all pixels and
    /// channels; NaN where a channel is not finite.
    pub frame_change_mse: Option<f64>,
    /// Greatest |change of the method − change of the truth| of a channel; NaN as for the mean.
    pub frame_change_worst: Option<f64>,
    /// Mean square of the change of the truth, which is what a still picture of any frame would have.
    pub truth_change_mse: Option<f64>,
    /// Number of changes of which either side is not finite.
    pub frame_change_nonfinite: u64,
}

/// Error of one frame and the next, compared.
#[derive(Debug, Default)]
struct Change {
    /// Method − truth of the frame before, channel by channel.
    before: Option<Vec<f64>>,
    error: AbsoluteError,
}

impl Change {
    /// Adds the next frame.
    fn add(&mut self, method: &Image, truth: &Image) -> Result<(), EvaluateError> {
        image::same_size(truth, method)?;
        let channels = method.pixels().as_flattened().iter().zip(truth.pixels().as_flattened());
        let now: Vec<f64> = channels.map(|(m, t)| m - t).collect();
        if let Some(before) = &self.before {
            now.iter()
                .zip(before)
                .for_each(|(&now, &before)| self.error.add(now, before));
        }
        self.before = Some(now);
        Ok(())
    }
}

/// Runs methods on every frame and compares their changes with the truth's; none for a method that cannot be applied to
/// a frame.
///
/// Where the context holds no range of depth, all frames share the extremes of all of them, as a renderer's planes or
/// bounding box stay the same from frame to frame. The list of a frame is asked for once more to find them.
///
/// # Errors
/// What `frame` returns, and [`EvaluateError`] where a list makes no image, or images of different sizes.
pub fn measure<E: From<EvaluateError>>(
    frames: u32,
    mut frame: impl FnMut(u32) -> Result<FragmentList, E>,
    methods: &[&dyn Method],
    mut context: Context,
    background: [f64; 3],
) -> Result<Vec<Option<OverTime>>, E> {
    if context.depth_range.is_none() {
        for i in 0..frames {
            let range = frame(i)?.depth_range();
            context.depth_range = match (context.depth_range, range) {
                (Some((a0, a1)), Some((b0, b1))) => Some((a0.min(b0), a1.max(b1))),
                (a, b) => a.or(b),
            };
        }
    }
    let mut changes: Vec<Option<Change>> = methods.iter().map(|_| Some(Change::default())).collect();
    let mut truth_change = AbsoluteError::default();
    let mut truth_before: Option<Image> = None;
    for i in 0..frames {
        let list = frame(i)?;
        let truth = image::ground_truth(&list, background)?;
        if let Some(before) = &truth_before {
            image::same_size(before, &truth)?;
            let channels = truth.pixels().as_flattened().iter().zip(before.pixels().as_flattened());
            channels.for_each(|(&now, &before)| truth_change.add(now, before));
        }
        for (method, change) in methods.iter().zip(&mut changes) {
            let Some(open) = change else { continue };
            match method.accumulate(&list, context) {
                Ok(accumulated) => {
                    let weights = oit::weights(&list, &*accumulated);
                    let image = image::of_method(&list, &*accumulated, &weights, background)?;
                    open.add(&image, &truth)?;
                }
                Err(_) => *change = None,
            }
        }
        truth_before = Some(truth);
    }
    let result = |change: Change| OverTime {
        frames,
        frame_change_mse: Some(change.error.mse()),
        frame_change_worst: Some(change.error.worst()),
        truth_change_mse: Some(truth_change.mse()),
        frame_change_nonfinite: change.error.nonfinite(),
    };
    Ok(changes.into_iter().map(|change| change.map(result)).collect())
}

#[cfg(test)]
mod tests {
    use super::super::judge::tests::{Shifted, colored_list};
    use super::*;
    use crate::model::mlp::tests::random_mlp;
    use crate::oit::neural::Neural;
    use crate::oit::{Accumulated, MethodError};
    use crate::scene::{CameraPath, Options, open};
    use std::sync::atomic::{AtomicU64, Ordering};

    fn of(values: &[f64]) -> Image {
        Image::new(values.len() as u32, 1, values.iter().map(|&v| [v; 3]).collect()).unwrap()
    }

    fn change(pairs: &[(&[f64], &[f64])]) -> AbsoluteError {
        let mut change = Change::default();
        for (method, truth) in pairs {
            change.add(&of(method), &of(truth)).unwrap();
        }
        change.error
    }

    /// By hand, to 1e-15: a constant error changes nothing, one that comes and goes counts twice, a still picture has
    /// the change of the truth.
    #[test]
    fn changes_by_hand() {
        let (t0, t1, t2) = ([0.1, 0.5], [0.2, 0.5], [0.4, 0.1]);
        let constant = change(&[(&[0.2, 0.4], &t0), (&[0.3, 0.4], &t1), (&[0.5, 0.0], &t2)]);
        assert!(constant.mse() < 1e-30, "{constant:?}");
        // Errors 0, .1, 0 in the first pixel: changes .1 and −.1 in two of four.
        let flicker = change(&[(&[0.1, 0.5], &t0), (&[0.3, 0.5], &t1), (&[0.4, 0.1], &t2)]);
        assert!((flicker.mse() - 0.005).abs() < 1e-15, "{flicker:?}");
        assert!((flicker.worst() - 0.1).abs() < 1e-15);
        let still = change(&[(&t0, &t0), (&t0, &t1), (&t0, &t2)]);
        assert!((still.mse() - (0.01 + 0.04 + 0.16) / 4.0).abs() < 1e-15);
        let nan = change(&[(&t0, &t0), (&[f64::NAN, 0.5], &t1)]);
        assert!(nan.mse().is_nan() && nan.nonfinite() == 3);
        // One frame has no change, and no number that could be taken for a good one.
        assert!(change(&[(&t0, &t0)]).mse().is_nan());
    }

    /// Exact in even frames, off by 0.2 in odd ones.
    struct Flickering(AtomicU64);

    impl Method for Flickering {
        fn name(&self) -> String {
            "flickering".to_owned()
        }

        fn capabilities(&self) -> crate::oit::Capabilities {
            crate::oit::Capabilities::of_sums(1, false)
        }

        fn accumulate<'a>(
            &'a self,
            list: &'a FragmentList,
            context: Context,
        ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
            let odd = self.0.fetch_add(1, Ordering::Relaxed) % 2 == 1;
            // The weights live as long as the list, not as the method that is made here.
            let method: &'static Shifted = if odd { &Shifted(0.2) } else { &Shifted(0.0) };
            method.accumulate(list, context)
        }
    }

    /// On a scene in motion: the exact method keeps to rounding (1e-30), the truth does change. Controls: a method that
    /// flickers, and one frame shown for all.
    #[test]
    fn methods_on_a_moving_scene() {
        let scene = open("sphere-cluster").unwrap();
        let options = Options {
            size: Some((48, 48)),
            seed: None,
        };
        let path = CameraPath {
            frames: 3,
            degrees_per_frame: 0.6,
        };
        let exact = oit::parse("abuffer").unwrap();
        let moments = oit::parse("moment-power-4").unwrap();
        let flickering = Flickering(AtomicU64::new(0));
        let methods: [&dyn Method; 3] = [&*exact, &*moments, &flickering];
        let found = measure(
            3,
            |i| path.build(&scene, &options, i).map_err(|_| EvaluateError::EmptySheet),
            &methods,
            Context::default(),
            [1.0; 3],
        )
        .unwrap();
        let [exact, moments, flickering] = [0, 1, 2].map(|i| found[i].unwrap().frame_change_mse.unwrap());
        let truth = found[0].unwrap().truth_change_mse.unwrap();
        println!("exact {exact:.1e}, moments {moments:.1e}, flickering {flickering:.1e}, truth {truth:.1e}");
        assert!(exact < 1e-30 && truth > 1e-6 && moments > 1e-9 && moments < truth);
        assert!(flickering > 1e-6 && flickering > 3.0 * moments);
    }

    /// A method that needs planes, of lists that have none, has no number; images of two sizes are an error.
    #[test]
    fn what_cannot_be_measured() {
        let paper = Neural::new(random_mlp(&[8], 3));
        let found = measure(
            2,
            |_| Ok::<_, EvaluateError>(colored_list(6, 6)),
            &[&paper, &Shifted(0.0)],
            Context::default(),
            [1.0; 3],
        )
        .unwrap();
        assert!(found[0].is_none() && found[1].is_some());
        let sizes = measure(
            2,
            |i| Ok::<_, EvaluateError>(colored_list(6 + i, 6)),
            &[&Shifted(0.0)],
            Context::default(),
            [1.0; 3],
        );
        assert!(matches!(sizes, Err(EvaluateError::SizesDiffer { .. })));
    }
}
