//! The histograms of a scene as one drawing.

use super::facts::{Facts, Histogram};
use plotters::prelude::*;

/// Why nothing could be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the plot could not be drawn: {0}")]
pub struct PlotError(String);

fn failed(error: impl std::fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

/// A number on an axis.
fn tick(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".to_owned()
    } else if !(0.01..10_000.0).contains(&size) {
        format!("{x:.0e}")
    } else if x == x.round() {
        format!("{x:.0}")
    } else {
        format!("{x:.2}")
    }
}

/// Four histograms and, below them, how every fragment is answered; SVG.
///
/// # Errors
/// [`PlotError`].
pub fn svg(title: &str, facts: &Facts) -> Result<String, PlotError> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (1000, 780)).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let root = root.titled(title, ("sans-serif", 20)).map_err(failed)?;
        let (upper, lower) = root.split_vertically(540);
        for (area, histogram) in upper.split_evenly((2, 2)).iter().zip(&facts.histograms) {
            panel(area, histogram)?;
        }
        classes(&lower, facts)?;
        root.present().map_err(failed)?;
    }
    Ok(text)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// The bins that hold something, and one on either side.
fn occupied(h: &Histogram) -> (usize, usize) {
    let first = h.counts.iter().position(|&n| n > 0).unwrap_or(0);
    let last = h.counts.iter().rposition(|&n| n > 0).unwrap_or(h.counts.len() - 1);
    (first.saturating_sub(1), (last + 2).min(h.counts.len()))
}

fn panel(area: &Area<'_>, h: &Histogram) -> Result<(), PlotError> {
    let (first, end) = occupied(h);
    let all = h.counts.iter().sum::<u64>().max(1) as f64;
    let most = 100.0 * h.counts.iter().copied().max().unwrap_or(0).max(1) as f64 / all;
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{}, % of {}", h.quantity, h.of), ("sans-serif", 15))
        .margin(8)
        .x_label_area_size(30)
        .y_label_area_size(40)
        .build_cartesian_2d(first as f64..end as f64, 0.0..1.05 * most)
        .map_err(failed)?;
    let edge = |x: &f64| {
        if (x - x.round()).abs() < 1e-9 {
            tick(h.edges[(x.round() as usize).min(h.edges.len() - 1)])
        } else {
            String::new()
        }
    };
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(WHITE)
        .y_labels(6)
        .x_labels((end - first + 1).min(12))
        .x_label_formatter(&edge)
        .y_label_formatter(&|y| tick(*y))
        .draw()
        .map_err(failed)?;
    let bars = h.counts[first..end].iter().enumerate().map(|(i, &n)| {
        let x = (first + i) as f64;
        Rectangle::new(
            [(x + 0.06, 0.0), (x + 0.94, 100.0 * n as f64 / all)],
            RGBColor(70, 110, 160).filled(),
        )
    });
    chart.draw_series(bars).map_err(failed)?;
    Ok(())
}

/// One bar, cut into the classes of fragments, with a legend.
fn classes(area: &Area<'_>, facts: &Facts) -> Result<(), PlotError> {
    const COLORS: [RGBColor; 10] = [
        RGBColor(33, 102, 172),
        RGBColor(67, 147, 195),
        RGBColor(146, 197, 222),
        RGBColor(169, 209, 230),
        RGBColor(209, 229, 240),
        RGBColor(27, 120, 55),
        RGBColor(127, 191, 123),
        RGBColor(231, 212, 232),
        RGBColor(175, 141, 195),
        RGBColor(214, 96, 77),
    ];
    let dark = ("sans-serif", 14).into_font().color(&BLACK);
    area.draw(&Text::new(
        "How every fragment is answered",
        (60, 6),
        ("sans-serif", 15).into_font().color(&BLACK),
    ))
    .map_err(failed)?;
    let (left, width) = (60.0, 880.0);
    let mut at = left;
    for (i, class) in facts.classes.iter().enumerate() {
        let end = at + width * class.share;
        area.draw(&Rectangle::new(
            [(at as i32, 30), (end as i32, 62)],
            COLORS[i % COLORS.len()].filled(),
        ))
        .map_err(failed)?;
        at = end;
        let (x, y) = (60 + 450 * (i as i32 % 2), 78 + 24 * (i as i32 / 2));
        area.draw(&Rectangle::new(
            [(x, y), (x + 14, y + 14)],
            COLORS[i % COLORS.len()].filled(),
        ))
        .map_err(failed)?;
        let legend = format!("{}: {:.1} % ({})", class.class, 100.0 * class.share, class.answer);
        area.draw(&Text::new(legend, (x + 22, y), dark.clone()))
            .map_err(failed)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::Context;
    use crate::pixel::FragmentList;
    use crate::profile::{Scene, facts};

    #[test]
    fn a_drawing_holds_every_class_and_the_same_bytes() {
        let list = FragmentList::new(vec![0, 1, 3, 3], vec![1.0, 2.0, 3.0], vec![0.5, 0.25, 1.0], None).unwrap();
        let facts = facts(&Scene::new(&list, Context::default(), [1.0; 3])).unwrap();
        let text = svg("three fragments", &facts).unwrap();
        assert!(text.starts_with("<svg") && text.contains("three fragments") && !text.contains("NaN"));
        assert!(facts.classes.iter().all(|c| text.contains(c.class)));
        assert_eq!(text, svg("three fragments", &facts).unwrap());
        let none = FragmentList::new(vec![0], vec![], vec![], None).unwrap();
        assert!(
            svg(
                "nothing",
                &super::super::facts(&Scene::new(&none, Context::default(), [1.0; 3])).unwrap()
            )
            .is_ok()
        );
    }

    #[test]
    fn ticks_are_short() {
        assert_eq!(
            [0.0, 5.0, 0.25, 1e-4, 30_000.0].map(tick),
            ["0", "5", "0.25", "1e-4", "3e4"]
        );
    }
}
