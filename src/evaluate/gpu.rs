//! What the GPU makes of a method, beside the CPU's image of it and the exact one.

use super::{EvaluateError, FlipMap, Image, Truth, flip};
use crate::gpu::pipeline::{Pipeline, Rendered};
use crate::gpu::tiles::TilePasses;
use crate::gpu::{DeviceList, Gpu, GpuError, MethodShader};
use crate::oit::Context;
use crate::oit::neural::Skip;
use crate::oit::shader::Pass1;
use crate::pixel::FragmentList;
use crate::shader::passes::TargetPrecision;
use serde::{Deserialize, Serialize};

/// A method's image from the GPU against the CPU's, and against the exact one. In JSON, NaN and infinity become null;
/// the count says why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GpuResult {
    /// Name of the method.
    pub method: String,
    /// Name of the adapter and its backend.
    pub adapter: String,
    /// "render" where fragments are drawn and blended, "compute" where the adapter cannot blend into f32 targets.
    pub passes: String,
    /// How sums were stored between render passes; compute passes keep f32.
    pub storage: String,
    /// What 99.9 % of the pixels that hold fragments stay within: greatest difference of a channel from the CPU's
    /// image.
    pub channel_difference_999: f64,
    /// Greatest difference of a channel from the CPU's image.
    pub channel_difference_worst: f64,
    /// Mean of the FLIP map against the CPU's image.
    pub flip_mean_to_cpu: f64,
    /// Mean squared error against the exact image, over all pixels and channels, unclamped.
    pub image_mse: f64,
    /// Mean of the FLIP map against the exact image.
    pub flip_mean: f64,
    /// Number of channel values that are not finite.
    pub image_nonfinite: u64,
    /// Time of pass 1 \[s\].
    pub seconds_accumulate: f64,
    /// Time of pass 2 \[s\].
    pub seconds_weights: f64,
    /// Time of the resolve \[s\]; 0 where pass 2 makes the colour itself.
    pub seconds_resolve: f64,
}

/// A result with the pictures that it is of.
#[derive(Debug, Clone)]
pub struct GpuJudged {
    /// The numbers.
    pub result: GpuResult,
    /// The GPU's image.
    pub image: Image,
    /// How far it looks from the CPU's.
    pub map: FlipMap,
}

/// Greatest difference of a channel, pixel by pixel; infinite where one is not finite.
///
/// # Errors
/// [`EvaluateError::SizesDiffer`].
pub fn channel_differences(image: &Image, reference: &Image) -> Result<Vec<f64>, EvaluateError> {
    super::image::same_size(reference, image)?;
    let finite = |d: f64| if d.is_nan() { f64::INFINITY } else { d };
    let of = |(a, b): (&[f64; 3], &[f64; 3])| a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max(finite((a - b).abs())));
    Ok(image.pixels().iter().zip(reference.pixels()).map(of).collect())
}

/// The least of some values that 99.9 % of them stay within; 0 of none.
pub fn within_999(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let most = (values.len() * 999).div_ceil(1000);
    most.checked_sub(1).map_or(0.0, |last| values[last])
}

/// The image by render passes, or where the device cannot blend as the storage needs by compute passes. Drivers compile
/// when they first draw: the second frame is timed.
fn render(
    gpu: &Gpu,
    method: &MethodShader,
    list: &FragmentList,
    context: Context,
    background: [f32; 3],
    storage: TargetPrecision,
    skip: Skip,
) -> Result<Rendered, GpuError> {
    if method.pass1 != Pass1::Added {
        return Err(GpuError::Source {
            label: method.name.clone(),
            reason: "its pass 1 is no sum that could be blended; 'nmt bench methods' runs it over the list".to_owned(),
        });
    }
    let range = method.depth_range(list, context.planes, context.depth_range)?;
    let list = DeviceList::new(gpu, list)?;
    if !draws(gpu, method, storage) {
        let passes = TilePasses::new(gpu, &list, method, range, background)?;
        passes.run(gpu, skip)?;
        return passes.render(gpu, skip);
    }
    let pipeline = Pipeline::new(gpu, &list, &method.clone().with_skip(skip), range, background, storage)?;
    pipeline.run(gpu)?;
    pipeline.render(gpu)
}

/// Whether render passes make the image of a method: it must keep its core, where it has one, in the fragment stage.
fn draws(gpu: &Gpu, method: &MethodShader, storage: TargetPrecision) -> bool {
    is_drawn(gpu, storage) && (!method.needs_atomics() || gpu.has_fragment_atomics())
}

/// Whether render passes make the image.
pub fn is_drawn(gpu: &Gpu, storage: TargetPrecision) -> bool {
    gpu.blends_f32() || !storage.blends_f32()
}

/// Draws a method on the GPU and compares its image with the CPU's and the exact one. A network is run for the
/// fragments that `skip` says.
///
/// # Errors
/// [`EvaluateError::Gpu`], and why the list makes no image.
pub fn judge(
    gpu: &Gpu,
    method: &MethodShader,
    truth: &Truth<'_>,
    context: Context,
    storage: TargetPrecision,
    skip: Skip,
    cpu: &Image,
) -> Result<GpuJudged, EvaluateError> {
    let list = truth.list();
    let rendered = render(
        gpu,
        method,
        list,
        context,
        truth.background().map(|c| c as f32),
        storage,
        skip,
    )?;
    let image = Image::new(
        rendered.width,
        rendered.height,
        rendered.pixels.iter().map(|p| p.map(f64::from)).collect(),
    )?;
    let differences = channel_differences(&image, cpu)?;
    let map = flip(cpu, &image)?;
    let exact = super::image::ground_truth(list, truth.background())?;
    let error = image.error(&exact)?;
    let result = GpuResult {
        method: method.name.clone(),
        adapter: gpu.name(),
        passes: if draws(gpu, method, storage) {
            "render"
        } else {
            "compute"
        }
        .to_owned(),
        storage: if draws(gpu, method, storage) {
            storage
        } else {
            TargetPrecision::Full
        }
        .name()
        .to_owned(),
        channel_difference_999: within_999(
            (0..list.pixels())
                .filter(|&p| !list.range(p).is_empty())
                .map(|p| differences[p]),
        ),
        channel_difference_worst: differences.iter().fold(0.0, |m, d| d.max(m)),
        flip_mean_to_cpu: map.mean(),
        image_mse: error.mse(),
        flip_mean: flip(&exact, &image)?.mean(),
        image_nonfinite: error.nonfinite(),
        seconds_accumulate: rendered.seconds.accumulate,
        seconds_weights: rendered.seconds.weights,
        seconds_resolve: rendered.seconds.resolve,
    };
    Ok(GpuJudged { result, image, map })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::judge::tests::colored_list;
    use crate::export::Format;
    use crate::gpu::tests::gpu;
    use crate::model::{Mlp, file};
    use crate::oit::neural::Neural;
    use std::path::Path;

    #[test]
    fn the_quantile_keeps_the_worst_thousandth_out() {
        let values = (0..2000).map(f64::from);
        assert_eq!(within_999(values), 1997.0);
        assert_eq!(
            (within_999([]), within_999([3.0]), within_999([1.0, f64::INFINITY])),
            (0.0, 3.0, f64::INFINITY)
        );
    }

    /// NaN on either side is infinitely far off; one channel is enough.
    #[test]
    fn differences_hide_nothing() {
        let image = |pixels: [[f64; 3]; 2]| Image::new(2, 1, pixels.to_vec()).unwrap();
        let a = image([[0.5; 3], [0.5, f64::NAN, 0.5]]);
        let b = image([[0.5, 0.25, 0.5], [0.5; 3]]);
        assert_eq!(channel_differences(&a, &b).unwrap(), [0.25, f64::INFINITY]);
        assert_eq!(channel_differences(&b, &a).unwrap(), [0.25, f64::INFINITY]);
        assert!(channel_differences(&a, &Image::new(1, 2, vec![[0.0; 3]; 2]).unwrap()).is_err());
    }

    /// Pixels of at most three fragments follow from exact rules on either side, to 1e-5. Control: an image of other
    /// colours is told from it.
    #[test]
    fn the_gpu_is_judged() {
        let Some(gpu) = gpu() else { return };
        let list = colored_list(40, 30);
        let truth = Truth::new(&list, [0.2, 0.4, 1.0]);
        let mlp: Mlp = file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("models/small.json")).unwrap();
        let method = MethodShader::neural(&mlp, Format::WGSL).unwrap();
        let cpu = truth
            .judge(&Neural::new(mlp), Context::default())
            .unwrap()
            .picture
            .unwrap()
            .0;
        let found = judge(
            gpu,
            &method,
            &truth,
            Context::default(),
            TargetPrecision::Full,
            Skip::Exact,
            &cpu,
        )
        .unwrap()
        .result;
        assert!(
            found.channel_difference_worst <= 1e-5 && found.flip_mean_to_cpu <= 1e-4 && found.image_mse <= 1e-9,
            "{found:?}"
        );
        assert_eq!((found.image_nonfinite, found.adapter), (0, gpu.name()));
        let other = Image::new(40, 30, cpu.pixels().iter().map(|p| [p[1], p[2], p[0]]).collect()).unwrap();
        let found = judge(
            gpu,
            &method,
            &truth,
            Context::default(),
            TargetPrecision::Full,
            Skip::Exact,
            &other,
        )
        .unwrap()
        .result;
        assert!(
            found.channel_difference_999 > 0.1 && found.flip_mean_to_cpu > 0.01,
            "{found:?}"
        );
    }
}
