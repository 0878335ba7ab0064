//! Speed of batched inference: features to answers, against the reference pass and onnxruntime.

use super::network::{MAX_ROWS, inference_multiply_adds, random_rows};
use super::{BenchError, Measurement, Plan, Subject, measure, peak};
use crate::check::onnx::Session;
use crate::export::onnx::encode;
use crate::model::Mlp;
use crate::train::fused::level_name;
use fearless_simd::Level;
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

/// How long onnxruntime's threads are left to stop spinning after they were used.
const ONNXRUNTIME_REST: Duration = Duration::from_millis(100);

/// Answers that differ by this much are no longer those of the same network.
const SAME: f64 = 1e-3;

/// Rows a second of [`Mlp::predict`] ("simd"), of [`Mlp::forward_batch`] in f32 ("reference") and, where its library is
/// given, of onnxruntime on the exported graph, by turns with the multiply-add peak. A call answers `batch` random
/// rows; onnxruntime's session is made once, outside of what is timed.
///
/// # Errors
/// [`BenchError`] where the batch is empty or onnxruntime fails or computes something else.
pub fn infer(
    plan: Plan,
    mlp: &Mlp,
    batch: usize,
    onnxruntime: Option<&Path>,
    progress: &dyn Fn(u64),
) -> Result<Vec<Measurement>, BenchError> {
    super::check((1..=MAX_ROWS).contains(&batch), "batch", batch, "from 1 to 67108864")?;
    let rows = random_rows(mlp.feature_set(), batch).features;
    let reference: Vec<f32> = mlp.forward_batch(&rows);
    let difference = |answers: &[f32]| {
        let differences = answers.iter().zip(&reference).map(|(a, r)| f64::from(a - r).abs());
        differences.fold(0.0, |most: f64, d| if d.is_nan() { f64::INFINITY } else { most.max(d) })
    };
    let width = mlp.feature_set().width();
    let mut session = match onnxruntime {
        Some(library) => Some(
            Session::new(library, &encode(mlp), Some(rayon::current_num_threads())).map_err(BenchError::Onnxruntime)?,
        ),
        None => None,
    };
    let mut differences = vec![difference(&mlp.predict(&rows)), 0.0];
    if let Some(session) = &mut session {
        let worst = session.run(&rows, width, difference).map_err(BenchError::Onnxruntime)?;
        if worst > SAME {
            return Err(BenchError::Onnxruntime(format!(
                "its answers differ from the network's by {worst:.1e}"
            )));
        }
        differences.push(worst);
    }

    let done = batch as u64;
    let mut subjects = vec![
        Subject::new(|| {
            black_box(mlp.predict(&rows));
            Ok(done)
        }),
        Subject::new(|| {
            black_box(mlp.forward_batch::<f32>(&rows));
            Ok(done)
        }),
    ];
    if let Some(session) = &mut session {
        let call = || {
            session
                .run(&rows, width, |answers| _ = black_box(answers))
                .map(|()| done)
                .map_err(BenchError::Onnxruntime)
        };
        subjects.push(Subject::new(call).with_rest(ONNXRUNTIME_REST));
    }
    subjects.push(peak::subject());
    let mut samples = measure(plan, &mut subjects, progress)?;
    let peak = samples.pop().expect("one for each subject");
    let shapes: Vec<(usize, usize)> = mlp.layers().iter().map(|l| (l.inputs(), l.outputs())).collect();
    let of = |((backend, samples), worst)| Measurement {
        network: mlp.shape(),
        backend,
        batch,
        simd: (backend == "simd").then(|| level_name(Level::new())),
        adapter: None,
        flops: 2 * inference_multiply_adds(&shapes),
        samples,
        peak: peak.clone(),
        worst_difference: Some(worst),
    };
    Ok(["simd", "reference", "onnxruntime"]
        .into_iter()
        .zip(samples)
        .zip(differences)
        .map(of)
        .collect())
}
