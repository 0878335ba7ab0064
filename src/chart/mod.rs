//! Charts: plain points to SVG, inline for a page or as a file of its own, and pictures of pixels.
//!
//! Shapes and labels say the same as colours do.

pub mod axis;
pub mod font;
pub mod histogram;
mod labels;
pub mod palette;
pub mod raster;
pub mod text;

pub use axis::{Axis, Scale};
pub use palette::COLORS;

use axis::Ruler;
use labels::{Area, text_width};
use palette::{FAINT, GRID, INK, LIGHT, PAPER};
use text::escape;

/// Room around the plot [CSS pixels]; that on the right holds the labels of lines.
const LEFT: f64 = 66.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 52.0;
/// Most points of a line that are drawn.
const MAX_POINTS: usize = 1200;

/// A place on a chart.
#[derive(Debug, Clone)]
pub struct Point {
    /// Value along x.
    pub x: f64,
    /// Value along y.
    pub y: f64,
    /// Least and greatest value along x, where it was measured more than once.
    pub spread: Option<(f64, f64)>,
    /// What is shown on hovering.
    pub title: String,
}

/// What is drawn of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line alone.
    Line,
    /// A broken line alone.
    Dashed,
    /// A line with a mark at each point.
    LineAndPoints,
    /// A mark at each point, filled.
    Filled,
    /// A mark at each point, hollow.
    Hollow,
    /// A cross at each point, without a name.
    Cross,
    /// A thin line that is no series but joins points of others.
    Joined,
}

/// Points that belong together.
#[derive(Debug, Clone)]
pub struct Series {
    /// Its label; none where empty.
    pub name: String,
    /// Its points.
    pub points: Vec<Point>,
    /// What is drawn.
    pub mark: Mark,
    /// Its colour, from 0; taken modulo [`COLORS`].
    pub color: usize,
}

/// A chart.
#[derive(Debug, Clone)]
pub struct Chart {
    /// What it shows, in words for who does not see it.
    pub summary: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, the first lowest.
    pub series: Vec<Series>,
}

impl Series {
    fn is_line(&self) -> bool {
        matches!(self.mark, Mark::Line | Mark::Dashed | Mark::LineAndPoints)
    }

    fn has_marks(&self) -> bool {
        matches!(
            self.mark,
            Mark::LineAndPoints | Mark::Filled | Mark::Hollow | Mark::Cross
        )
    }

    /// Its points that can be drawn; of very many the least and greatest of each stretch.
    fn drawn(&self) -> Vec<&Point> {
        let finite: Vec<&Point> = self
            .points
            .iter()
            .filter(|p| p.x.is_finite() && p.y.is_finite())
            .collect();
        if finite.len() <= MAX_POINTS {
            return finite;
        }
        let stretch = finite.len().div_ceil(MAX_POINTS / 2);
        let ends = |part: &[&'_ Point]| -> Vec<usize> {
            let by = |a: &usize, b: &usize| part[*a].y.total_cmp(&part[*b].y);
            let (least, most) = ((0..part.len()).min_by(by), (0..part.len()).max_by(by));
            let mut kept: Vec<usize> = least.into_iter().chain(most).collect();
            kept.sort_unstable();
            kept.dedup();
            kept
        };
        finite
            .chunks(stretch)
            .flat_map(|part| ends(part).into_iter().map(|i| part[i]))
            .collect()
    }
}

/// Where a chart is drawn: its size, and the axes within it.
struct Plot {
    width: f64,
    height: f64,
    x: Ruler,
    y: Ruler,
    x_end: f64,
    y_end: f64,
}

impl Plot {
    fn at(&self, p: &Point) -> (f64, f64) {
        (self.x.at(p.x), self.y.at(p.y))
    }

    /// Where labels of points may stand.
    fn area(&self) -> Area {
        Area {
            left: LEFT + 2.0,
            top: 0.0,
            right: self.width - 4.0,
            bottom: self.y_end - 2.0,
        }
    }
}

impl Chart {
    /// The chart as an `svg` element for a page, whose style gives the colours; none where no point is finite.
    pub fn svg(&self) -> Option<String> {
        let plot = self.plot(720.0, 380.0)?;
        let (width, height) = (plot.width, plot.height);
        Some(format!(
            "<svg class=\"chart\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" \
             role=\"img\" aria-label=\"{}\">\n{}</svg>\n",
            escape(&self.summary),
            self.body(&plot)
        ))
    }

    /// The chart as a file of its own, with its heading, a line below it, and its font; none where no point is finite.
    pub fn document(&self, title: &str, foot: &str) -> Option<String> {
        let plot = self.plot(1000.0, 560.0)?;
        let (head, below) = (36.0, if foot.is_empty() { 6.0 } else { 26.0 });
        let (width, height) = (plot.width, head + plot.height + below);
        let foot_at = height - 9.0;
        Some(format!(
            "{}<text class=\"title\" x=\"{LEFT}\" y=\"25\">{}</text>\n<g transform=\"translate(0 {head})\">\n{}</g>\n\
             <text class=\"foot\" x=\"{LEFT}\" y=\"{foot_at}\">{}</text>\n</svg>\n",
            document_head(width, height, &self.summary),
            escape(title),
            self.body(&plot),
            escape(foot)
        ))
    }

    fn plot(&self, width: f64, height: f64) -> Option<Plot> {
        let labels = self.series.iter().filter(|s| s.is_line() && !s.name.is_empty());
        let widest = labels.map(|s| text_width(&labels::shortened(&s.name))).reduce(f64::max);
        let right = widest.map_or(20.0, |widest| (widest + 30.0).min(0.36 * width));
        let (x_end, y_end) = (width - right, height - BOTTOM);
        let points = || {
            self.series
                .iter()
                .flat_map(|s| &s.points)
                .filter(|p| p.x.is_finite() && p.y.is_finite())
        };
        let spread = |p: &Point| p.spread.map_or([p.x; 2], |(a, b)| [a, b]).into_iter().chain([p.x]);
        Some(Plot {
            width,
            height,
            x: Ruler::new(&self.x, points().flat_map(spread), LEFT, x_end)?,
            y: Ruler::new(&self.y, points().map(|p| p.y), y_end, TOP)?,
            x_end,
            y_end,
        })
    }

    fn body(&self, plot: &Plot) -> String {
        let mut out = String::new();
        self.frame(plot, &mut out);
        for series in &self.series {
            out += &format!("<g class=\"s{}\">", series.color % COLORS);
            let drawn = series.drawn();
            let places: Vec<(f64, f64)> = drawn.iter().map(|p| plot.at(p)).collect();
            if series.is_line() || series.mark == Mark::Joined {
                let class = match series.mark {
                    Mark::Joined => "joined",
                    Mark::Dashed => "line dashed",
                    _ => "line",
                };
                let path: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
                out += &format!(
                    "<polyline class=\"{class}\" points=\"{}\"><title>{}</title></polyline>",
                    path.join(" "),
                    escape(&series.name)
                );
            }
            if series.has_marks() {
                for (point, &place) in drawn.iter().zip(&places) {
                    out += &marked(series, point, place, plot);
                }
            }
            out += "</g>\n";
        }
        labels::lines(&self.series, plot, &mut out);
        labels::points(&self.series, plot, &mut out);
        out
    }

    fn frame(&self, plot: &Plot, out: &mut String) {
        let (x_end, y_end) = (plot.x_end, plot.y_end);
        for (v, text) in &plot.y.ticks {
            let at = plot.y.at(*v);
            *out += &format!(
                "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{x_end:.1}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>\
                 <text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 8.0,
                at + 4.0,
                escape(text)
            );
        }
        let mut last = f64::NEG_INFINITY;
        for (v, text) in &plot.x.ticks {
            let (at, half) = (plot.x.at(*v), text_width(text) / 2.0);
            *out += &format!("<line class=\"grid\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{TOP}\" y2=\"{y_end:.1}\"/>");
            // A tick whose text would touch the one before has none.
            if at - half > last + 4.0 {
                *out += &format!(
                    "<text class=\"tick\" x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                    y_end + 18.0,
                    escape(text)
                );
                last = at + half;
            }
        }
        let (across, down) = ((LEFT + x_end) / 2.0, (TOP + y_end) / 2.0);
        *out += &format!(
            "<path class=\"axis\" d=\"M{LEFT} {TOP}V{y_end:.1}H{x_end:.1}\"/>\n\
             <text class=\"name\" x=\"{across:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text class=\"name\" transform=\"translate(14 {down:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            plot.height - 10.0,
            escape(&self.x.label),
            escape(&self.y.label)
        );
    }
}

/// One mark with its spread.
fn marked(series: &Series, point: &Point, (x, y): (f64, f64), plot: &Plot) -> String {
    let class = match series.mark {
        Mark::Hollow => "hollow",
        Mark::Cross => "cross",
        _ => "filled",
    };
    let mut out = format!("<g class=\"{class}\"><title>{}</title>", escape(&point.title));
    if let Some((low, high)) = point.spread.filter(|(a, b)| a.is_finite() && b.is_finite()) {
        let (low, high) = (plot.x.at(low), plot.x.at(high));
        out += &format!("<line class=\"spread\" x1=\"{low:.1}\" x2=\"{high:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>");
    }
    let size = if series.is_line() { 3.4 } else { 5.2 };
    out += &match series.mark {
        Mark::Cross => format!("<path d=\"M{:.1} {:.1}l8 8m0 -8l-8 8\"/>", x - 4.0, y - 4.0),
        _ => shape(series.color, x, y, size),
    };
    out + "</g>"
}

/// A mark whose shape goes with its colour.
fn shape(color: usize, x: f64, y: f64, r: f64) -> String {
    let polygon = |points: &[(f64, f64)]| {
        let points: Vec<String> = points
            .iter()
            .map(|(dx, dy)| format!("{:.1},{:.1}", x + r * dx, y + r * dy))
            .collect();
        format!("<polygon points=\"{}\"/>", points.join(" "))
    };
    match color % COLORS {
        0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r:.1}\"/>"),
        1 => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
        2 => polygon(&[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)]),
        3 => polygon(&[(0.0, -1.3), (1.1, 0.0), (0.0, 1.3), (-1.1, 0.0)]),
        4 => polygon(&[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)]),
        5 => polygon(&[(-1.2, 0.0), (0.8, -1.1), (0.8, 1.1)]),
        6 => polygon(&[(1.2, 0.0), (-0.8, -1.1), (-0.8, 1.1)]),
        _ => polygon(&[
            (-0.5, -1.1),
            (0.5, -1.1),
            (1.1, 0.0),
            (0.5, 1.1),
            (-0.5, 1.1),
            (-1.1, 0.0),
        ]),
    }
}

/// The start of a drawing that is a file of its own: its size, what it shows in words, font, colours and paper.
fn document_head(width: f64, height: f64, summary: &str) -> String {
    let series: String = LIGHT
        .iter()
        .enumerate()
        .map(|(i, c)| {
            format!(
                ".s{i} .line, .s{i} .joined, .s{i} .leader, .s{i} .spread, .s{i} .cross {{ stroke: {c}; }} \
                 .s{i} .filled {{ fill: {c}; stroke: {PAPER}; }} .s{i} .hollow {{ fill: {PAPER}; stroke: {c}; }} \
                 .s{i} .label, .s{i}.label, .s{i}.area {{ fill: {c}; }}\n"
            )
        })
        .collect();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         height=\"{height:.0}\" role=\"img\" aria-label=\"{}\">\n<style>\n{}\n\
         text {{ font-family: \"{}\", \"Noto Sans\", Verdana, sans-serif; font-size: 12px; fill: {INK}; }}\n\
         .title {{ font-size: 17px; }} .tick, .foot {{ font-size: 11px; fill: {FAINT}; }}\n\
         .grid {{ stroke: {GRID}; stroke-width: .7; }} .axis {{ stroke: {FAINT}; fill: none; }}\n\
         .line {{ fill: none; stroke-width: 2; stroke-linejoin: round; }} .dashed {{ stroke-dasharray: 8 5; }}\n\
         .joined {{ fill: none; stroke-width: 1.4; stroke-dasharray: 5 4; }} .filled {{ stroke-width: 1; }}\n\
         .leader {{ fill: none; stroke-width: .8; opacity: .55; }} .hollow {{ stroke-width: 1.8; }}\n\
         .spread {{ stroke-width: 1.4; opacity: .6; }} .cross {{ fill: none; stroke-width: 1.8; }}\n{series}</style>\n\
         <rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"{PAPER}\"/>\n",
        escape(summary),
        font::embedded(),
        font::FAMILY
    )
}

/// A chart in a box that scrolls on narrow screens, where the labels of lines stand below it once more.
pub fn figure(chart: &Chart, caption: &str) -> Option<String> {
    let svg = chart.svg()?;
    let label = escape(&chart.summary);
    let lines = chart.series.iter().filter(|s| s.is_line() && !s.name.is_empty());
    let legend: String = lines
        .map(|s| {
            let (color, name) = (s.color % COLORS, escape(&s.name));
            format!(
                "<li class=\"s{color}\"><svg width=\"14\" height=\"14\" aria-hidden=\"true\">{}</svg>{name}</li>",
                shape(color, 7.0, 7.0, 5.0)
            )
        })
        .collect();
    let legend = if legend.is_empty() {
        legend
    } else {
        format!("<ul class=\"legend\" aria-hidden=\"true\">{legend}</ul>")
    };
    Some(format!(
        "<figure class=\"plot\"><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{label}\">{svg}</div>\
         {legend}<figcaption>{}</figcaption></figure>\n",
        escape(caption)
    ))
}

/// A method among others: what it costs and how far it is off.
#[derive(Debug, Clone)]
pub struct Tradeoff {
    /// Its name.
    pub name: String,
    /// What it costs.
    pub cost: f64,
    /// Least and greatest cost that was measured.
    pub spread: Option<(f64, f64)>,
    /// Its error.
    pub error: f64,
    /// Whether nothing is both cheaper and better.
    pub on_front: bool,
    /// Whether it is a network: these have a colour of their own.
    pub network: bool,
    /// What is shown on hovering.
    pub title: String,
}

impl Tradeoff {
    /// Whether logarithmic axes have a place for it.
    pub fn is_drawn(&self) -> bool {
        [self.cost, self.error].iter().all(|v| v.is_finite() && *v > 0.0)
    }

    fn point(&self) -> Point {
        Point {
            x: self.cost,
            y: self.error,
            spread: self.spread,
            title: self.title.clone(),
        }
    }
}

/// Cost against error of methods: a mark each, filled where nothing is both cheaper and better; these are joined in
/// steps. What has no place on logarithmic axes is left out, which is for the caller to say.
pub fn tradeoffs(summary: String, cost: &str, error: &str, methods: &[Tradeoff]) -> Chart {
    let mut drawn: Vec<&Tradeoff> = methods.iter().filter(|m| m.is_drawn()).collect();
    drawn.sort_by(|a, b| a.cost.total_cmp(&b.cost).then_with(|| a.name.cmp(&b.name)));
    let front: Vec<Point> = drawn.iter().filter(|m| m.on_front).map(|m| m.point()).collect();
    // Between two methods of the front nothing better is known: it goes in steps.
    let corner = |w: &[Point]| Point {
        x: w[1].x,
        ..w[0].clone()
    };
    let mut steps: Vec<Point> = front.windows(2).flat_map(|w| [w[0].clone(), corner(w)]).collect();
    steps.extend(front.last().cloned());
    let mut series = vec![Series {
        name: "Pareto front".to_owned(),
        points: steps,
        mark: Mark::Joined,
        color: 6,
    }];
    // Names find room in this order.
    drawn.sort_by_key(|m| (!m.network, !m.on_front));
    series.extend(drawn.iter().map(|m| Series {
        name: m.name.clone(),
        points: vec![m.point()],
        mark: if m.on_front { Mark::Filled } else { Mark::Hollow },
        color: usize::from(m.network),
    }));
    let axis = |label: &str, decades| Axis {
        label: label.to_owned(),
        scale: Scale::Log { decades },
    };
    Chart {
        summary,
        x: axis(cost, 9),
        y: axis(error, 8),
        series,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(y: Scale, points: &[(f64, f64)], mark: Mark) -> Chart {
        let points = points
            .iter()
            .map(|&(x, y)| Point {
                x,
                y,
                spread: None,
                title: "<t>".to_owned(),
            })
            .collect();
        Chart {
            summary: "a <chart>".to_owned(),
            x: Axis {
                label: "x & x".to_owned(),
                scale: Scale::Linear,
            },
            y: Axis {
                label: "y".to_owned(),
                scale: y,
            },
            series: vec![Series {
                name: "<m>".to_owned(),
                points,
                mark,
                color: 1,
            }],
        }
    }

    const LOG: Scale = Scale::Log { decades: 8 };

    #[test]
    fn texts_are_escaped_and_have_a_summary() {
        let svg = chart(LOG, &[(1.0, 1e-3), (2.0, 1e-5)], Mark::LineAndPoints)
            .svg()
            .unwrap();
        assert!(
            svg.contains("role=\"img\" aria-label=\"a &lt;chart&gt;\"")
                && svg.contains("x &amp; x")
                && svg.contains("<title>&lt;t&gt;</title>")
        );
        assert!(!svg.contains("<m>") && !svg.contains("<t>"));
    }

    /// Every coordinate is a finite number inside the chart, whatever the values; without a finite point there is no
    /// chart.
    #[test]
    fn any_value_stays_inside() {
        let wild: [&[(f64, f64)]; 8] = [
            &[(0.0, 0.0)],
            &[(1.0, 0.0), (2.0, 1e-320)],
            &[(f64::MAX, f64::MAX), (f64::MIN, 1.0)],
            &[(1e-300, 1e300), (f64::NAN, 1.0), (1.0, f64::INFINITY), (2.0, 5.0)],
            &[(-5.0, -5.0), (3.0, 2.0)],
            &[(3.0, 3.0), (3.0, 3.0)],
            &[(1e15, 1e-9), (1e15 + 1.0, 2e-9)],
            &[(-0.0, 5e-324)],
        ];
        for points in wild {
            for scale in [Scale::Linear, LOG, Scale::Names(vec!["a".to_owned()])] {
                for mark in [Mark::LineAndPoints, Mark::Hollow] {
                    let svg = chart(scale.clone(), points, mark).svg().unwrap();
                    assert!(
                        !svg.contains("NaN,") && !svg.contains("inf") && !svg.contains("\"NaN"),
                        "{points:?} {scale:?}\n{svg}"
                    );
                    for part in svg.split("points=\"").skip(1) {
                        for pair in part.split('"').next().unwrap().split_ascii_whitespace() {
                            let (x, y) = pair.split_once(',').unwrap();
                            let [x, y] = [x, y].map(|v| v.parse::<f64>().unwrap());
                            assert!((0.0..=720.0).contains(&x) && (-1.0..=380.0).contains(&y), "{pair}");
                        }
                    }
                    assert!(svg.len() < 20_000);
                }
            }
        }
        assert!(
            chart(LOG, &[(f64::NAN, 1.0)], Mark::Line).svg().is_none() && chart(LOG, &[], Mark::Line).svg().is_none()
        );
    }

    /// Labels of lines that end at one place stand apart. Control: their ends do not.
    #[test]
    fn labels_stand_apart() {
        let mut crowd = chart(LOG, &[(1.0, 1e-3), (2.0, 1e-3)], Mark::Line);
        for color in 0..6 {
            crowd.series.push(Series {
                name: format!("m{color}"),
                color,
                ..crowd.series[0].clone()
            });
        }
        let svg = crowd.svg().unwrap();
        let labels: Vec<f64> = svg
            .split("class=\"label\"")
            .skip(1)
            .map(|t| {
                t.split("y=\"")
                    .nth(1)
                    .unwrap()
                    .split('"')
                    .next()
                    .unwrap()
                    .parse()
                    .unwrap()
            })
            .collect();
        assert_eq!(labels.len(), 7);
        assert!(labels.windows(2).all(|w| (w[1] - w[0]).abs() >= 14.8), "{labels:?}");
        let ends: Vec<&str> = svg
            .split("class=\"leader\" points=\"")
            .skip(1)
            .map(|t| t.split(' ').next().unwrap())
            .collect();
        assert!(ends.windows(2).all(|w| w[0] == w[1]));
        // Of points on one place, not all names can be shown.
        let dense: Vec<Series> = (0..200)
            .map(|i| Series {
                name: format!("name-{i}"),
                mark: Mark::Hollow,
                ..crowd.series[0].clone()
            })
            .collect();
        let svg = Chart { series: dense, ..crowd }.svg().unwrap();
        let shown = svg.matches("class=\"label").count();
        assert!((2..200).contains(&shown), "{shown}");
    }

    #[test]
    fn long_curves_are_thinned_and_keep_their_peaks() {
        let points: Vec<(f64, f64)> = (0..50_000)
            .map(|i| (f64::from(i), if i == 31_234 { 0.9 } else { 1e-3 }))
            .collect();
        let series = &chart(LOG, &points, Mark::Line).series[0];
        let drawn = series.drawn();
        assert!(
            drawn.len() <= MAX_POINTS && drawn.iter().any(|p| p.y == 0.9) && drawn.windows(2).all(|w| w[0].x < w[1].x)
        );
    }

    /// A file of its own brings its font, its colours and its heading. Control: the chart of a page has none of them.
    #[test]
    fn documents_stand_alone() {
        let chart = chart(LOG, &[(1.0, 1e-3), (2.0, 1e-5)], Mark::Dashed);
        let text = chart.document("Error & range", "not drawn: <one>").unwrap();
        assert!(text.starts_with("<svg xmlns=") && text.contains("Error &amp; range") && text.contains("&lt;one&gt;"));
        assert!(text.contains("@font-face") && text.contains(LIGHT[7]) && text.contains("line dashed"));
        assert!(!chart.svg().unwrap().contains("font-face"));
        assert_eq!(text, chart.document("Error & range", "not drawn: <one>").unwrap());
    }

    /// All that logarithmic axes have a place for is drawn, filled on the front. Control: what lies behind it is
    /// hollow.
    #[test]
    fn tradeoffs_tell_the_front() {
        let method = |name: &str, cost, error, on_front| Tradeoff {
            name: name.to_owned(),
            cost,
            spread: None,
            error,
            on_front,
            network: false,
            title: String::new(),
        };
        let methods = [
            method("one", 10.0, 1e-4, true),
            method("<two>", 100.0, 1e-5, true),
            method("behind", 120.0, 1e-3, false),
            method("exact", 50.0, 0.0, true),
            method("lost", 50.0, f64::NAN, false),
        ];
        let text = tradeoffs(String::new(), "ns", "MSE", &methods).svg().unwrap();
        assert!(
            text.contains("one") && text.contains("&lt;two&gt;") && !text.contains("exact") && !text.contains("lost")
        );
        assert_eq!(
            (
                text.matches("class=\"filled\"").count(),
                text.matches("class=\"hollow\"").count()
            ),
            (2, 1)
        );
        assert!(tradeoffs(String::new(), "ns", "MSE", &[]).svg().is_none());
    }
}
