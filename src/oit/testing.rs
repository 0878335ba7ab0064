//! Pixels and comparisons that the tests of all methods share.

use super::{Context, Method, weights as list_weights};
use crate::numeric::rng::stream;
use crate::numeric::tolerance::close;
use crate::pixel::{CameraPlanes, FragmentList, abuffer};
use rand::RngExt;

/// Every image here is composited over white.
pub(crate) const WHITE: [f64; 3] = [1.0; 3];

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

/// One pixel, seen by a camera with planes 0.5 and 10.
pub(crate) fn pixel(view_z: &[f32], alpha: &[f32], color: &[[f32; 3]]) -> FragmentList {
    let offsets = vec![0, view_z.len() as u64];
    let list = FragmentList::new(offsets, view_z.to_vec(), alpha.to_vec(), Some(color.to_vec())).unwrap();
    list.with_planes(CameraPlanes::new(0.5, 10.0).unwrap())
}

/// One fragment, (0.25, 0, 0) at alpha 1/2: the over operator gives (0.625, 0.5, 0.5) on white.
pub(crate) fn one() -> FragmentList {
    pixel(&[2.0], &[0.5], &[[0.25, 0.0, 0.0]])
}

/// Green at 2 before red at 1 in the input, alpha 1/2 both.
pub(crate) fn two() -> FragmentList {
    pixel(&[2.0, 1.0], &[0.5, 0.5], &[GREEN, RED])
}

/// Blue at 4, red at 1, green at 2; alpha 1/2 each: (1/2 + 1/8, 1/4 + 1/8, 1/8 + 1/8) on white.
pub(crate) fn three() -> FragmentList {
    pixel(&[4.0, 1.0, 2.0], &[0.5; 3], &[BLUE, RED, GREEN])
}

/// 400 random pixels of 0 to 24 fragments, with ties and with alpha 0 and 1.
pub(crate) fn scene(seed: u64) -> FragmentList {
    let mut rng = stream(seed, 77, 0);
    let mut offsets = vec![0];
    let (mut view_z, mut alpha, mut color) = (Vec::new(), Vec::new(), Vec::new());
    for p in 0..400 {
        for _ in 0..p % 25 {
            let v = rng.random_range(1.0f32..9.0);
            view_z.push(if p % 3 == 0 { v.round() } else { v });
            alpha.push(match rng.random_range(0..12) {
                0 => 0.0,
                1 => 1.0,
                _ => rng.random_range(0.0f32..1.0),
            });
            color.push([rng.random(), rng.random(), rng.random()]);
        }
        offsets.push(view_z.len() as u64);
    }
    FragmentList::new(offsets, view_z, alpha, Some(color))
        .unwrap()
        .with_planes(CameraPlanes::new(0.5, 10.0).unwrap())
}

/// The same pixels with the fragments of each in the opposite order.
pub(crate) fn reversed(list: &FragmentList) -> FragmentList {
    let order = |p| list.range(p).rev();
    let pick = |i: usize| (list.view_z()[i], list.alpha()[i], list.color().unwrap()[i]);
    let mut arrays = (Vec::new(), Vec::new(), Vec::new());
    for (v, a, c) in (0..list.pixels()).flat_map(order).map(pick) {
        arrays.0.push(v);
        arrays.1.push(a);
        arrays.2.push(c);
    }
    FragmentList::new(list.offsets().to_vec(), arrays.0, arrays.1, Some(arrays.2))
        .unwrap()
        .with_planes(list.planes().unwrap())
}

/// The same pixels with every fragment of this colour.
pub(crate) fn painted(list: &FragmentList, color: [f32; 3]) -> FragmentList {
    let colors = vec![color; list.len()];
    FragmentList::new(
        list.offsets().to_vec(),
        list.view_z().to_vec(),
        list.alpha().to_vec(),
        Some(colors),
    )
    .unwrap()
    .with_planes(list.planes().unwrap())
}

/// Weights of all fragments.
pub(crate) fn weights(method: &dyn Method, list: &FragmentList) -> Vec<f64> {
    list_weights(list, &*method.accumulate(list, Context::default()).unwrap())
}

/// Colours of all pixels.
pub(crate) fn image(method: &dyn Method, list: &FragmentList) -> Vec<[f64; 3]> {
    let accumulated = method.accumulate(list, Context::default()).unwrap();
    let color = |p| {
        let mut weights = vec![f64::NAN; list.pixel(p).len()];
        accumulated.weights(p, &mut weights);
        accumulated.composite(list.pixel(p), p, &weights, WHITE)
    };
    (0..list.pixels()).map(color).collect()
}

/// What the A-buffer shows.
pub(crate) fn exact_image(list: &FragmentList) -> Vec<[f64; 3]> {
    (0..list.pixels())
        .map(|p| abuffer::composite(list.pixel(p), WHITE))
        .collect()
}

/// Mean square of the difference to the A-buffer's image.
pub(crate) fn image_mse(method: &dyn Method, list: &FragmentList) -> f64 {
    let (ours, exact) = (image(method, list), exact_image(list));
    let squares = ours
        .as_flattened()
        .iter()
        .zip(exact.as_flattened())
        .map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>() / (3 * list.pixels()) as f64
}

/// Whether all numbers agree within 1e-13, absolute and relative; NaN never does.
pub(crate) fn agree(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(&a, &b)| close(a, b, 1e-13, 1e-13))
}

pub(crate) fn assert_close(a: &[f64], b: &[f64]) {
    assert!(agree(a, b), "{a:?} against {b:?}");
}

/// What holds for every method of K layers, nodes or passes: as many as there are fragments give the A-buffer's image,
/// ties and opaque fragments included, and its weights where nothing ties; fewer do not, and the more the less error on
/// average.
pub(crate) fn assert_converges(method: impl Fn(usize) -> Box<dyn Method>) {
    let (list, exact) = (scene(1), exact_image(&scene(1)));
    for k in [24, 25, 1000] {
        assert_close(image(&*method(k), &list).as_flattened(), exact.as_flattened());
        assert_close(&weights(&*method(k), &list), &abuffer::list_front_to_back_factor(&list));
    }
    // The control: one layer is not enough.
    assert!(!agree(image(&*method(1), &list).as_flattened(), exact.as_flattened()));
    let errors = [2, 4, 8, 16].map(|k| image_mse(&*method(k), &list));
    assert!(errors.windows(2).all(|e| e[1] < e[0]), "{errors:?}");
}

/// That the order of the fragments in the input changes nothing but rounding, but for ties.
pub(crate) fn order_matters(method: &dyn Method, list: &FragmentList) -> bool {
    !agree(
        image(method, list).as_flattened(),
        image(method, &reversed(list)).as_flattened(),
    )
}

/// [`scene`] without ties.
pub(crate) fn untied(seed: u64) -> FragmentList {
    let list = scene(seed);
    let mut view_z = list.view_z().to_vec();
    let mut rng = stream(seed, 78, 0);
    view_z.iter_mut().for_each(|v| *v = rng.random_range(1.0f32..9.0));
    let color = list.color().unwrap().to_vec();
    FragmentList::new(list.offsets().to_vec(), view_z, list.alpha().to_vec(), Some(color))
        .unwrap()
        .with_planes(list.planes().unwrap())
}
