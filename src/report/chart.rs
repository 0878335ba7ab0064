//! Charts as inline SVG: lines and points on linear or logarithmic axes, labelled where they are.
//!
//! Colours are classes of the page's style, so that they follow its light and dark form; shapes and labels say the same as colours do.

use super::html::{escape, number};

/// Width and height of a chart [CSS pixels].
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 380.0;
/// Room around the plot [CSS pixels]; that on the right holds the labels of lines.
const LEFT: f64 = 66.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 52.0;
/// Width of a letter at the size of labels, on average, and height of a line [CSS pixels].
const LETTER: f64 = 7.3;
const LINE: f64 = 15.0;
/// Letters of a label that are shown.
const LETTERS: usize = 30;
/// Colours that can be told apart.
pub const COLORS: usize = 8;
/// Most points of a line that are drawn.
const MAX_POINTS: usize = 1200;

/// How an axis runs.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// Equal steps are equal differences.
    Linear,
    /// Equal steps are equal ratios. What lies more than so many decades below the greatest value, 0 too, stands on the lower edge.
    Log {
        /// Decades that are shown at most.
        decades: i32,
    },
    /// Equal steps from name to name; values are places in the list.
    Names(Vec<String>),
}

/// An axis.
#[derive(Debug, Clone)]
pub struct Axis {
    /// What it measures, with its unit.
    pub label: String,
    /// How it runs.
    pub scale: Scale,
}

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
    /// A line with a mark at each point.
    LineAndPoints,
    /// A mark at each point, filled.
    Filled,
    /// A mark at each point, hollow.
    Hollow,
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

/// An axis with its ends known.
struct Ruler {
    low: f64,
    high: f64,
    log: bool,
    from: f64,
    to: f64,
    /// Values and their texts; the lowest says so where smaller values are drawn on it.
    ticks: Vec<(f64, String)>,
}

impl Ruler {
    fn new(axis: &Axis, values: impl Iterator<Item = f64>, from: f64, to: f64) -> Option<Self> {
        let mut low = f64::INFINITY;
        let mut high = f64::NEG_INFINITY;
        let mut any = false;
        let mut clipped = false;
        let log = matches!(axis.scale, Scale::Log { .. });
        for v in values.filter(|v| v.is_finite()) {
            any = true;
            if log && v <= 0.0 {
                clipped = true;
            } else {
                (low, high) = (low.min(v), high.max(v));
            }
        }
        if !any {
            return None;
        }
        Some(match &axis.scale {
            Scale::Names(names) => {
                let last = names.len().max(1) as f64 - 1.0;
                let ticks = names
                    .iter()
                    .enumerate()
                    .map(|(i, name)| (i as f64, name.clone()))
                    .collect();
                Self {
                    low: -0.35,
                    high: last + 0.35,
                    log: false,
                    from,
                    to,
                    ticks,
                }
            }
            Scale::Linear => {
                // Differences of what is drawn must not overflow.
                let [low, high] = [low, high].map(|v| v.clamp(-1e300, 1e300));
                let size = high.abs().max(low.abs());
                let step = linear_step((high - low).max(size * 1e-6).max(1e-300) / 6.0);
                // Ends lie a little beyond what is drawn, and on 0 where that is near.
                let room = (0.02 * (high - low)).max(0.5 * step * f64::from(u8::from(high - low < step)));
                let start = if low >= 0.0 && low < 0.1 * high {
                    0.0
                } else {
                    low - room
                };
                let (low, high) = (start, high + room);
                let first = (low / step).ceil();
                let ticks = (0..20)
                    .map(|i| (first + f64::from(i)) * step)
                    .take_while(|v| *v <= high)
                    .map(|v| (v, number(tidy(v, step))))
                    .collect();
                Self {
                    low,
                    high,
                    log: false,
                    from,
                    to,
                    ticks,
                }
            }
            Scale::Log { decades } => {
                if low > high {
                    // Nothing but zeros.
                    (low, high) = (0.1, 1.0);
                }
                // What is drawn keeps clear of the smallest numbers that there are.
                let high = high.clamp(1e-290, 1e300);
                let floor = high.log10().ceil() - f64::from(*decades);
                clipped |= low.max(1e-300).log10() < floor;
                let low = low.max(1e-290).log10().max(floor);
                // A zero needs an edge of its own, below all else.
                let high = high.log10();
                let room = (0.03 * (high - low)).max(0.02);
                let (low, high) = (if clipped { low.floor() } else { low - room }, high + room);
                let (low, high) = if high - low < 0.3 {
                    (low - 0.15, high + 0.15)
                } else {
                    (low, high)
                };
                let mut ticks = log_ticks(low, high);
                if clipped {
                    ticks.retain(|(v, _)| v.log10() > low + 0.02 * (high - low));
                    ticks.insert(0, (10f64.powf(low), format!("≤1e{low:.0}")));
                }
                Self {
                    low,
                    high,
                    log: true,
                    from,
                    to,
                    ticks,
                }
            }
        })
    }

    /// Where a value stands [CSS pixels].
    fn at(&self, v: f64) -> f64 {
        let v = if self.log { v.max(1e-300).log10() } else { v };
        let share = ((v - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.from + share * (self.to - self.from)
    }
}

/// The next of 1, 2, 5 times a power of ten.
fn linear_step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|digit| digit * power)
        .find(|&step| step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// Rounds away what additions left below a step.
fn tidy(v: f64, step: f64) -> f64 {
    if v.abs() < step * 1e-6 { 0.0 } else { v }
}

/// Powers of ten between two logarithms; fewer of many, and digits between few.
fn log_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let powers: Vec<i32> = (low.ceil() as i32..=high.floor() as i32).collect();
    let text = |power: i32, digit: i32| match (power, digit) {
        (0..=3, digit) => (digit * 10i32.pow(power as u32)).to_string(),
        (-2..=-1, digit) => format!("{:.*}", -power as usize, f64::from(digit) * 10f64.powi(power)),
        (power, 1) => format!("1e{power}"),
        (power, digit) => format!("{digit}e{power}"),
    };
    if powers.len() >= 3 {
        let every = powers.len().div_ceil(9) as i32;
        return powers
            .into_iter()
            .filter(|p| p.rem_euclid(every) == 0)
            .map(|p| (10f64.powi(p), text(p, 1)))
            .collect();
    }
    let digits: &[i32] = if high - low < 0.8 {
        &[1, 2, 3, 4, 5, 6, 8]
    } else {
        &[1, 2, 5]
    };
    let all = (low.floor() as i32..=high.floor() as i32).flat_map(|p| digits.iter().map(move |&d| (p, d)));
    all.map(|(p, d)| (f64::from(d) * 10f64.powi(p), text(p, d)))
        .filter(|(v, _)| (low..=high).contains(&v.log10()))
        .collect()
}

/// A box that a label takes.
#[derive(Clone, Copy)]
struct Box {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl Box {
    fn overlap(&self, other: &Self) -> f64 {
        let along = |a: f64, wa: f64, b: f64, wb: f64| ((a + wa).min(b + wb) - a.max(b)).max(0.0);
        along(self.x, self.width, other.x, other.width) * along(self.y, self.height, other.y, other.height)
    }
}

fn shortened(name: &str) -> String {
    if name.chars().count() <= LETTERS {
        name.to_owned()
    } else {
        name.chars().take(LETTERS - 1).chain(['…']).collect()
    }
}

fn text_width(text: &str) -> f64 {
    text.chars().count() as f64 * LETTER
}

impl Series {
    fn is_line(&self) -> bool {
        matches!(self.mark, Mark::Line | Mark::LineAndPoints)
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

impl Chart {
    /// The chart as an `svg` element; none where no point is finite.
    pub fn svg(&self) -> Option<String> {
        let labelled = self.series.iter().any(|s| s.is_line() && !s.name.is_empty());
        let widest = self
            .series
            .iter()
            .filter(|s| s.is_line())
            .map(|s| text_width(&shortened(&s.name)))
            .fold(0.0, f64::max);
        let right = if labelled {
            (widest + 30.0).min(0.36 * WIDTH)
        } else {
            20.0
        };
        let (x_end, y_end) = (WIDTH - right, HEIGHT - BOTTOM);
        let points = || {
            self.series
                .iter()
                .flat_map(|s| &s.points)
                .filter(|p| p.x.is_finite() && p.y.is_finite())
        };
        let spread = |p: &Point| p.spread.map_or([p.x; 2], |(a, b)| [a, b]).into_iter().chain([p.x]);
        let x = Ruler::new(&self.x, points().flat_map(spread), LEFT, x_end)?;
        let y = Ruler::new(&self.y, points().map(|p| p.y), y_end, TOP)?;

        let mut out = format!(
            "<svg class=\"chart\" viewBox=\"0 0 {WIDTH:.0} {HEIGHT:.0}\" width=\"{WIDTH:.0}\" height=\"{HEIGHT:.0}\" role=\"img\" aria-label=\"{}\">\n",
            escape(&self.summary)
        );
        self.frame(&x, &y, x_end, y_end, &mut out);
        let mut taken: Vec<Box> = Vec::new();
        for series in &self.series {
            let places: Vec<(f64, f64)> = series.drawn().iter().map(|p| (x.at(p.x), y.at(p.y))).collect();
            out += &format!("<g class=\"s{}\">", series.color % COLORS);
            if series.is_line() || series.mark == Mark::Joined {
                let class = if series.mark == Mark::Joined { "joined" } else { "line" };
                let path: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
                out += &format!(
                    "<polyline class=\"{class}\" points=\"{}\"><title>{}</title></polyline>",
                    path.join(" "),
                    escape(&series.name)
                );
            }
            if matches!(series.mark, Mark::LineAndPoints | Mark::Filled | Mark::Hollow) {
                for (point, &(px, py)) in series.drawn().into_iter().zip(&places) {
                    let class = if series.mark == Mark::Hollow {
                        "hollow"
                    } else {
                        "filled"
                    };
                    out += &format!("<g class=\"{class}\"><title>{}</title>", escape(&point.title));
                    if let Some((low, high)) = point.spread.filter(|(a, b)| a.is_finite() && b.is_finite()) {
                        out += &format!(
                            "<line class=\"spread\" x1=\"{:.1}\" x2=\"{:.1}\" y1=\"{py:.1}\" y2=\"{py:.1}\"/>",
                            x.at(low),
                            x.at(high)
                        );
                    }
                    let size = if series.is_line() { 3.4 } else { 5.2 };
                    out += &shape(series.color, px, py, size);
                    out += "</g>";
                    taken.push(Box {
                        x: px - 6.0,
                        y: py - 6.0,
                        width: 12.0,
                        height: 12.0,
                    });
                }
            }
            out += "</g>\n";
        }
        self.line_labels(&x, &y, x_end, &mut taken, &mut out);
        self.point_labels(&x, &y, taken, &mut out);
        out += "</svg>\n";
        Some(out)
    }

    fn frame(&self, x: &Ruler, y: &Ruler, x_end: f64, y_end: f64, out: &mut String) {
        for (v, text) in &y.ticks {
            let at = y.at(*v);
            *out += &format!("<line class=\"grid\" x1=\"{LEFT}\" x2=\"{x_end:.1}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>");
            *out += &format!(
                "<text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 8.0,
                at + 4.0,
                escape(text)
            );
        }
        let mut last = f64::NEG_INFINITY;
        for (v, text) in &x.ticks {
            let (at, half) = (x.at(*v), text_width(text) / 2.0);
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
        *out += &format!("<path class=\"axis\" d=\"M{LEFT} {TOP}V{y_end:.1}H{x_end:.1}\"/>\n");
        let middle = (LEFT + x_end) / 2.0;
        *out += &format!(
            "<text class=\"name\" x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            HEIGHT - 10.0,
            escape(&self.x.label)
        );
        let middle = (TOP + y_end) / 2.0;
        *out += &format!(
            "<text class=\"name\" transform=\"translate(14 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            escape(&self.y.label)
        );
    }

    /// Names of lines at their right ends, moved apart where they would meet.
    fn line_labels(&self, x: &Ruler, y: &Ruler, x_end: f64, taken: &mut Vec<Box>, out: &mut String) {
        let mut labels: Vec<(f64, f64, f64, &Series)> = Vec::new();
        for series in self.series.iter().filter(|s| s.is_line() && !s.name.is_empty()) {
            if let Some(last) = series.drawn().last() {
                let at = y.at(last.y);
                labels.push((x.at(last.x), at, at, series));
            }
        }
        labels.sort_by(|a, b| a.1.total_cmp(&b.1));
        let bottom = HEIGHT - BOTTOM;
        // Down from the top, and back up from the bottom where they ran over it.
        let mut free = TOP - LINE;
        for label in &mut labels {
            label.2 = label.1.max(free + LINE);
            free = label.2;
        }
        let mut free = bottom + 0.5 * LINE;
        for label in labels.iter_mut().rev() {
            label.2 = label.2.min(free);
            free = label.2 - LINE;
        }
        for (px, py, label_y, series) in labels {
            let color = series.color % COLORS;
            let at = x_end + 16.0;
            taken.push(Box {
                x: at,
                y: label_y - 0.5 * LINE,
                width: text_width(&shortened(&series.name)),
                height: LINE,
            });
            *out += &format!(
                "<g class=\"s{color}\"><polyline class=\"leader\" points=\"{px:.1},{py:.1} {x_end:.1},{py:.1} {:.1},{label_y:.1}\"/>",
                at - 4.0
            );
            *out += &format!(
                "<text class=\"label\" x=\"{at:.1}\" y=\"{:.1}\">{}<title>{}</title></text></g>\n",
                label_y + 4.0,
                escape(&shortened(&series.name)),
                escape(&series.name)
            );
        }
    }

    /// Names beside single points, where there is room for them; the others have theirs on hovering and in the table.
    fn point_labels(&self, x: &Ruler, y: &Ruler, mut taken: Vec<Box>, out: &mut String) {
        for series in self
            .series
            .iter()
            .filter(|s| matches!(s.mark, Mark::Filled | Mark::Hollow) && !s.name.is_empty())
        {
            let Some(point) = series.drawn().into_iter().next() else {
                continue;
            };
            let (px, py) = (x.at(point.x), y.at(point.y));
            let name = shortened(&series.name);
            let (w, h) = (text_width(&name), LINE);
            let places = [
                (px + 9.0, py - h / 2.0),
                (px - 9.0 - w, py - h / 2.0),
                (px + 5.0, py - h - 7.0),
                (px + 5.0, py + 7.0),
                (px - 5.0 - w, py - h - 7.0),
                (px - 5.0 - w, py + 7.0),
                (px - w / 2.0, py - h - 8.0),
                (px - w / 2.0, py + 8.0),
                (px + 5.0, py - 2.0 * h - 9.0),
                (px + 5.0, py + h + 4.0),
            ];
            let inside = |b: &Box| {
                b.x >= LEFT && b.x + b.width <= WIDTH - 4.0 && b.y >= 0.0 && b.y + b.height <= HEIGHT - BOTTOM
            };
            let free = places
                .into_iter()
                .map(|(x, y)| Box {
                    x,
                    y,
                    width: w,
                    height: h,
                })
                .find(|b| inside(b) && taken.iter().all(|t| b.overlap(t) <= 4.0));
            if let Some(b) = free {
                *out += &format!(
                    "<text class=\"label s{}\" x=\"{:.1}\" y=\"{:.1}\">{}</text>\n",
                    series.color % COLORS,
                    b.x,
                    b.y + 11.5,
                    escape(&name)
                );
                taken.push(b);
            }
        }
    }
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
        "<figure class=\"plot\"><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{label}\">{svg}</div>{legend}\
         <figcaption>{}</figcaption></figure>\n",
        escape(caption)
    ))
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
    fn texts_are_escaped_and_said_aloud() {
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

    /// Every coordinate is a finite number inside the chart, whatever the values; without a finite point there is no chart.
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
                            assert!((0.0..=WIDTH).contains(&x) && (-1.0..=HEIGHT).contains(&y), "{pair}");
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

    #[test]
    fn a_logarithmic_axis_runs_in_powers() {
        let of = |values: &[f64]| {
            Ruler::new(
                &Axis {
                    label: String::new(),
                    scale: LOG,
                },
                values.iter().copied(),
                0.0,
                100.0,
            )
            .unwrap()
        };
        let ruler = of(&[1e-5, 1e-3, 1e-1]);
        let texts: Vec<&str> = ruler.ticks.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(texts, ["1e-5", "1e-4", "1e-3", "0.01", "0.1"]);
        assert!((ruler.at(1e-3) - 50.0).abs() < 1e-9);
        // Zeros, and what is far below the greatest, stand on the edge, which says so.
        let ruler = of(&[1.0, 0.0, 1e-30]);
        assert_eq!(ruler.ticks[0].1, "≤1e-8");
        assert!(ruler.at(0.0) == 0.0 && ruler.at(1e-30) == 0.0 && ruler.at(0.5) > 90.0);
        let near = of(&[0.011, 0.013]);
        assert!(near.ticks.len() >= 2, "{:?}", near.ticks);
    }

    #[test]
    fn linear_ticks_are_round() {
        let axis = Axis {
            label: String::new(),
            scale: Scale::Linear,
        };
        let ruler = Ruler::new(&axis, [0.0, 1000.0].into_iter(), 0.0, 1.0).unwrap();
        assert_eq!(
            ruler.ticks.iter().map(|t| t.0).collect::<Vec<_>>(),
            [0.0, 200.0, 400.0, 600.0, 800.0, 1000.0]
        );
        let ruler = Ruler::new(&axis, [1.0, 120.0].into_iter(), 0.0, 1.0).unwrap();
        assert_eq!(
            ruler.ticks.iter().map(|t| t.1.as_str()).collect::<Vec<_>>(),
            ["0", "20", "40", "60", "80", "100", "120"]
        );
        assert_eq!([0.9, 1.0, 1.1, 2.5, 7.0].map(linear_step), [1.0, 1.0, 2.0, 5.0, 10.0]);
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
        assert!(
            labels.windows(2).all(|w| (w[1] - w[0]).abs() >= LINE - 0.2),
            "{labels:?}"
        );
        let ends: Vec<&str> = svg
            .split("class=\"leader\" points=\"")
            .skip(1)
            .map(|t| t.split(' ').next().unwrap())
            .collect();
        assert!(ends.windows(2).all(|w| w[0] == w[1]));
        // Of points on one place, not all names can be shown.
        let dense: Vec<Series> = (0..40)
            .map(|i| Series {
                name: format!("name-{i}"),
                mark: Mark::Hollow,
                ..crowd.series[0].clone()
            })
            .collect();
        let svg = Chart { series: dense, ..crowd }.svg().unwrap();
        let shown = svg.matches("class=\"label").count();
        assert!((2..20).contains(&shown), "{shown}");
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
}
