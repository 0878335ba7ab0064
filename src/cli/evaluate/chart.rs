//! The chart over all scenes: error against memory, passes as marks.

use super::SceneResults;
use super::tables::{Compared, compare};
use crate::chart::{Axis, Chart, Mark, Point, Scale, Series};

/// Geometric mean of the image MSE against bits a pixel, a mark a method: its shape says how often the geometry is
/// drawn, and what is filled is a network. Methods without a mean, and those whose memory grows with the scene, have
/// none. No chart where none is left.
pub(super) fn chart(scenes: &[SceneResults]) -> Option<String> {
    let series: Vec<Series> = compare(scenes).iter().filter_map(series).collect();
    let names: Vec<&str> = scenes.iter().map(|s| s.name.as_str()).collect();
    let chart = Chart {
        summary: format!(
            "Image MSE of transparency methods against bits a pixel over {}",
            names.join(", ")
        ),
        x: Axis {
            label: "bits a pixel, colour accumulator apart".to_owned(),
            scale: Scale::Linear,
        },
        y: Axis {
            label: "image MSE, geometric mean".to_owned(),
            scale: Scale::Log { decades: 6 },
        },
        series,
    };
    chart.document(
        &format!("Error against memory over {} scenes", scenes.len()),
        "Circle: one pass over the geometry, square: two, triangle: three, diamond: more. Filled: networks.",
    )
}

fn series(compared: &Compared<'_>) -> Option<Series> {
    let (bits, mean) = (compared.capabilities.bits_per_pixel?, compared.mean?);
    let passes = compared.capabilities.geometry_passes;
    let network = ["neural:", "core:", "dfa", "star-nt"]
        .iter()
        .any(|head| compared.method.starts_with(head));
    Some(Series {
        name: compared.method.to_owned(),
        points: vec![Point {
            x: bits.into(),
            y: mean,
            spread: None,
            title: format!("{}: {mean:.2e}, {bits} bits, {passes} passes", compared.method),
        }],
        mark: if network { Mark::Filled } else { Mark::Hollow },
        color: passes.clamp(1, 4) as usize - 1,
    })
}
