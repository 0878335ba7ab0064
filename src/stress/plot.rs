//! Sweeps as line charts in SVG.

use plotters::prelude::*;

/// One line of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// What the legend says.
    pub name: String,
    /// Points from left to right, both coordinates > 0.
    pub points: Vec<(f64, f64)>,
    /// Points at which some answers are no numbers: marked.
    pub marked: Vec<(f64, f64)>,
}

/// A chart with logarithmic axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart<'a> {
    /// Heading.
    pub title: &'a str,
    /// What the horizontal axis is, with its unit.
    pub x: &'a str,
    /// What the vertical axis is, with its unit.
    pub y: &'a str,
    /// Whether the horizontal axis goes up by factors.
    pub log_x: bool,
    /// The lines.
    pub lines: &'a [Line],
}

/// Size of a chart, and the part of its width that the legend takes \[pixels\].
const SIZE: (u32, u32) = (1120, 560);
const LEGEND: u32 = 290;

/// Mean squared errors below this are drawn as this: nobody sees them.
const FLOOR: f64 = 1e-7;

/// Colours that people tell apart whatever their sight, after M. Okabe and K. Ito; they come again after the eighth.
const COLORS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(120, 120, 120),
];

impl Chart<'_> {
    /// The chart as SVG; none where no line has a point.
    ///
    /// # Errors
    /// In words, where it cannot be drawn.
    pub fn svg(&self) -> Result<Option<String>, String> {
        let all = || self.lines.iter().flat_map(|l| &l.points).copied();
        let bound = |of: fn((f64, f64)) -> f64, pick: fn(f64, f64) -> f64| all().map(of).reduce(pick);
        let (Some(left), Some(right)) = (bound(|p| p.0, f64::min), bound(|p| p.0, f64::max)) else {
            return Ok(None);
        };
        let (Some(low), Some(high)) = (bound(|p| p.1, f64::min), bound(|p| p.1, f64::max)) else {
            return Ok(None);
        };
        // Whole powers of ten, one at least.
        let decade = |v: f64, round: fn(f64) -> f64| libm::exp10(round(libm::log10(v)));
        let (low, high) = (decade(low.max(FLOOR), f64::floor), decade(high.max(FLOOR), f64::ceil));
        let high = if high > low { high } else { 10.0 * low };
        let mut text = String::new();
        if self.log_x {
            self.draw(&mut text, (left..right).log_scale(), (low..high).log_scale())
        } else {
            self.draw(&mut text, left..right, (low..high).log_scale())
        }
        .map_err(|e| e.to_string())?;
        Ok(Some(text))
    }

    fn draw<X, Y>(&self, text: &mut String, x: X, y: Y) -> Result<(), Box<dyn std::error::Error>>
    where
        X: plotters::coord::ranged1d::AsRangedCoord<Value = f64>,
        X::CoordDescType: plotters::coord::ranged1d::ValueFormatter<f64>,
        Y: plotters::coord::ranged1d::AsRangedCoord<Value = f64>,
        Y::CoordDescType: plotters::coord::ranged1d::ValueFormatter<f64>,
    {
        let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (left, right) = area.split_horizontally(SIZE.0 - LEGEND);
        let mut chart = ChartBuilder::on(&left)
            .caption(self.title, ("sans-serif", 18))
            .margin(12)
            .margin_right(20)
            .x_label_area_size(42)
            .y_label_area_size(64)
            .build_cartesian_2d(x, y)?;
        let number = |v: &f64| {
            if (0.01..=9999.0).contains(v) {
                format!("{v}")
            } else {
                format!("{v:.0e}")
            }
        };
        chart
            .configure_mesh()
            .x_desc(self.x)
            .y_desc(self.y)
            .x_label_formatter(&number)
            .y_label_formatter(&number)
            .light_line_style(RGBColor(240, 240, 240))
            .bold_line_style(RGBColor(215, 215, 215))
            .label_style(("sans-serif", 13))
            .draw()?;
        // A method that is run in several ways has one colour.
        let base = |line: &Line| line.name.split(" @ ").next().unwrap_or("").to_owned();
        let mut bases: Vec<String> = Vec::new();
        for (i, line) in self.lines.iter().enumerate() {
            let of = bases.iter().position(|b| *b == base(line)).unwrap_or_else(|| {
                bases.push(base(line));
                bases.len() - 1
            });
            let style = ShapeStyle {
                color: COLORS[of % COLORS.len()].to_rgba(),
                filled: false,
                stroke_width: 2,
            };
            // Solid, dashed in another way of being run, dotted where colours come again.
            let dash = match (
                self.lines[..i].iter().any(|before| base(before) == base(line)),
                of >= COLORS.len(),
            ) {
                (false, false) => None,
                (true, _) => Some((9, 5)),
                (false, true) => Some((2, 4)),
            };
            let points = line.points.iter().map(|&(x, y)| (x, y.max(FLOOR)));
            let at = 30 + 24 * i as i32;
            let sample = [(0, at), (34, at)];
            match dash {
                None => {
                    chart.draw_series(LineSeries::new(points, style))?;
                    right.draw(&PathElement::new(sample, style))?;
                }
                Some((size, spacing)) => {
                    chart.draw_series(DashedLineSeries::new(points, size, spacing, style))?;
                    right.draw(&plotters::element::DashedPathElement::new(sample, size, spacing, style))?;
                }
            }
            chart.draw_series(
                line.marked
                    .iter()
                    .map(|&(x, y)| Cross::new((x, y.max(FLOOR)), 4, style)),
            )?;
            right.draw(&Text::new(line.name.clone(), (42, at - 7), ("sans-serif", 13)))?;
        }
        area.present()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(name: &str, points: &[(f64, f64)]) -> Line {
        Line {
            name: name.to_owned(),
            points: points.to_vec(),
            marked: points[..1].to_vec(),
        }
    }

    /// Every line has its name, a path and its mark. Control: a chart of fewer lines has fewer.
    #[test]
    fn charts_hold_their_lines() {
        let lines = [
            line("one", &[(1e-6, 1e-3), (0.5, 2e-2)]),
            line("two", &[(1e-6, 0.1), (0.5, 1e-5)]),
        ];
        let chart = |lines| Chart {
            title: "Error",
            x: "half-range",
            y: "MSE",
            log_x: true,
            lines,
        };
        let svg = chart(&lines).svg().unwrap().unwrap();
        assert!(
            svg.starts_with("<svg")
                && ["one", "two", "half-range", "MSE", "Error"]
                    .iter()
                    .all(|t| svg.contains(t))
        );
        let few = chart(&lines[..1]).svg().unwrap().unwrap();
        assert!(!few.contains("two") && svg.matches("<polyline").count() > few.matches("<polyline").count());
        assert_eq!(chart(&[]).svg().unwrap(), None);
        let linear = Chart {
            log_x: false,
            ..chart(&lines)
        }
        .svg()
        .unwrap()
        .unwrap();
        assert_ne!(linear, svg);
    }
}
