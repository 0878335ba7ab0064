//! Run time against error as a picture: one point a method, both axes logarithmic, the Pareto front as a line.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A point of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// What is written beside it.
    pub label: String,
    /// Time \[ns a fragment\].
    pub time: f64,
    /// Error.
    pub error: f64,
    /// Whether it lies on the front.
    pub on_front: bool,
    /// Whether it is one of ours, which are drawn in another colour.
    pub network: bool,
}

/// What stands around the points.
#[derive(Debug, Clone, PartialEq)]
pub struct Captions {
    /// Above all.
    pub title: String,
    /// Beside the abscissa.
    pub time: String,
    /// Beside the ordinate.
    pub error: String,
    /// Below all: what is not in the picture.
    pub foot: String,
}

const WIDTH: i32 = 1000;
const HEIGHT: i32 = 640;
/// Where the axes lie: left, right, top, bottom \[pixels\].
const FRAME: [i32; 4] = [92, WIDTH - 24, 56, HEIGHT - 86];
/// Size of labels \[pixels\].
const LABEL: f64 = 16.0;
/// Height of a label's line, and width of one of its letters on average \[pixels\].
const LETTER: [f64; 2] = [15.0, 7.2];
/// Colour-blind safe: classic methods, networks, the front (Okabe and Ito's palette).
const COLORS: [RGBColor; 3] = [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(120, 120, 120)];

/// A rectangle: left, top, right, bottom.
type Box4 = [f64; 4];

fn overlap(a: &Box4, b: &Box4) -> f64 {
    let w = (a[2].min(b[2]) - a[0].max(b[0])).max(0.0);
    let h = (a[3].min(b[3]) - a[1].max(b[1])).max(0.0);
    w * h
}

/// Area of a rectangle around a segment that lies within a box: how much of the line a label would cover.
fn crossing(b: &Box4, from: (f64, f64), to: (f64, f64)) -> f64 {
    let steps = 48;
    let inside = (0..=steps).filter(|&i| {
        let t = f64::from(i) / f64::from(steps);
        let (x, y) = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
        x > b[0] && x < b[2] && y > b[1] && y < b[3]
    });
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    inside.count() as f64 / f64::from(steps + 1) * length * 3.0
}

/// Where labels go: for each point the place around it, near or, with a leader, far, that covers least of points, lines and labels before it.
fn places(at: &[(f64, f64)], labels: &[&str], lines: &[[(f64, f64); 2]], frame: &Box4) -> Vec<Box4> {
    let mut taken: Vec<Box4> = at.iter().map(|(x, y)| [x - 6.0, y - 6.0, x + 6.0, y + 6.0]).collect();
    let mut leaders: Vec<[(f64, f64); 2]> = lines.to_vec();
    let mut found = Vec::new();
    for (&(x, y), label) in at.iter().zip(labels) {
        let (w, h) = (LETTER[1] * label.chars().count() as f64 + 4.0, LETTER[0]);
        let mut best = (f64::INFINITY, [0.0; 4]);
        for reach in [9.0, 24.0, 42.0, 66.0, 96.0, 130.0, 170.0] {
            for turn in 0..16 {
                let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(turn) / 8.0);
                // The label's nearest point lies at the reach.
                let (cx, cy) = (x + cos * (reach + 0.5 * w * cos.abs()), y - sin * (reach + 0.5 * h));
                let place = [cx - 0.5 * w, cy - 0.5 * h, cx + 0.5 * w, cy + 0.5 * h];
                let outside = w * h - overlap(&place, frame);
                let covered: f64 = taken.iter().map(|t| overlap(&place, t)).sum();
                let crossed: f64 = leaders.iter().map(|l| crossing(&place, l[0], l[1])).sum();
                let led = if reach > 9.0 {
                    taken.iter().map(|t| crossing(t, (x, y), (cx, cy)) * 0.5).sum::<f64>()
                } else {
                    0.0
                };
                let cost =
                    40.0 * outside + 40.0 * covered + crossed + led + 1.2 * reach + if turn == 0 { 0.0 } else { 3.0 };
                if cost < best.0 {
                    best = (cost, place);
                }
            }
        }
        let place = best.1;
        let leader = [(x, y), nearest(&place, (x, y))];
        leaders.push(leader);
        taken.push(place);
        found.push(place);
    }
    found
}

/// The point of a box that is nearest to a point.
fn nearest(b: &Box4, (x, y): (f64, f64)) -> (f64, f64) {
    (x.clamp(b[0], b[2]), y.clamp(b[1], b[3]))
}

/// Whole powers of ten, and with few of them their doubles and fives, within an interval of logarithms.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    let decades = high - low;
    let steps: &[f64] = if decades < 1.2 {
        &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0]
    } else if decades < 3.0 {
        &[1.0, 2.0, 5.0]
    } else {
        &[1.0]
    };
    let powers = (low.floor() as i32..=high.ceil() as i32).flat_map(|p| steps.iter().map(move |s| s * 10f64.powi(p)));
    powers.filter(|t| (low..=high).contains(&t.log10())).collect()
}

/// A number of an axis.
fn number(x: f64) -> String {
    if (0.01..10_000.0).contains(&x) {
        let text = format!("{x:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let text = format!("{x:.1e}");
        text.replace(".0e", "e")
    }
}

/// The picture as SVG; points whose time or error is not positive and finite have no place on logarithmic axes and are left out, which is for the caller to say.
///
/// # Panics
/// Never: drawing into memory does not fail.
pub fn svg(captions: &Captions, points: &[Point]) -> String {
    let mut text = String::new();
    draw(captions, points, &mut text).expect("drawing into memory does not fail");
    text
}

/// Whether logarithmic axes have a place for it.
pub fn is_drawn(point: &Point) -> bool {
    [point.time, point.error].iter().all(|x| x.is_finite() && *x > 0.0)
}

fn draw(captions: &Captions, points: &[Point], text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::with_string(text, (WIDTH as u32, HEIGHT as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let font = |size: f64, color: RGBColor, h: HPos, v: VPos| {
        ("sans-serif", size).into_font().color(&color).pos(Pos::new(h, v))
    };
    let write = |s: &str, at: (i32, i32), style: TextStyle<'_>| root.draw(&Text::new(s.to_owned(), at, style));
    let dark = RGBColor(30, 30, 30);
    let [left, right, top, bottom] = FRAME;
    write(&captions.title, (left, 14), font(20.0, dark, HPos::Left, VPos::Top))?;

    let mut drawn: Vec<&Point> = points.iter().filter(|p| is_drawn(p)).collect();
    // The front from left to right; labels of what lies on it are placed first.
    drawn.sort_by(|a, b| {
        b.on_front
            .cmp(&a.on_front)
            .then(a.time.total_cmp(&b.time))
            .then_with(|| a.label.cmp(&b.label))
    });
    let range = |of: fn(&Point) -> f64| {
        let logs: Vec<f64> = drawn.iter().map(|p| of(p).log10()).collect();
        let (low, high) = logs
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
        let (low, high) = if low.is_finite() { (low, high) } else { (0.0, 1.0) };
        let margin = (0.06 * (high - low)).max(0.05);
        (low - margin, high + margin)
    };
    let ((x0, x1), (y0, y1)) = (range(|p| p.time), range(|p| p.error));
    let x_of = |time: f64| f64::from(left) + (time.log10() - x0) / (x1 - x0) * f64::from(right - left);
    let y_of = |error: f64| f64::from(bottom) - (error.log10() - y0) / (y1 - y0) * f64::from(bottom - top);
    let pixel = |(x, y): (f64, f64)| (x.round() as i32, y.round() as i32);

    let grid = RGBColor(228, 228, 228);
    for tick in ticks(x0, x1) {
        let x = x_of(tick).round() as i32;
        root.draw(&PathElement::new(vec![(x, top), (x, bottom)], grid.stroke_width(1)))?;
        write(
            &number(tick),
            (x, bottom + 6),
            font(13.0, dark, HPos::Center, VPos::Top),
        )?;
    }
    for tick in ticks(y0, y1) {
        let y = y_of(tick).round() as i32;
        root.draw(&PathElement::new(vec![(left, y), (right, y)], grid.stroke_width(1)))?;
        write(
            &number(tick),
            (left - 8, y),
            font(13.0, dark, HPos::Right, VPos::Center),
        )?;
    }
    root.draw(&PathElement::new(
        vec![(left, top), (left, bottom), (right, bottom)],
        dark.stroke_width(1),
    ))?;
    write(
        &captions.time,
        ((left + right) / 2, bottom + 28),
        font(15.0, dark, HPos::Center, VPos::Top),
    )?;
    let side = ("sans-serif", 15.0)
        .into_font()
        .transform(FontTransform::Rotate270)
        .color(&dark)
        .pos(Pos::new(HPos::Center, VPos::Top));
    write(&captions.error, (12, (top + bottom) / 2), side)?;
    write(
        &captions.foot,
        (left, HEIGHT - 22),
        font(13.0, dark, HPos::Left, VPos::Top),
    )?;

    let at: Vec<(f64, f64)> = drawn.iter().map(|p| (x_of(p.time), y_of(p.error))).collect();
    let front: Vec<(f64, f64)> = at
        .iter()
        .zip(&drawn)
        .filter(|(_, p)| p.on_front)
        .map(|(&a, _)| a)
        .collect();
    // Between two methods of the front nothing better is known: it goes in steps.
    let steps: Vec<(f64, f64)> = front
        .windows(2)
        .flat_map(|w| [w[0], (w[1].0, w[0].1)])
        .chain(front.last().copied())
        .collect();
    root.draw(&PathElement::new(
        steps.iter().map(|&p| pixel(p)).collect::<Vec<_>>(),
        COLORS[2].stroke_width(2),
    ))?;
    let lines: Vec<[(f64, f64); 2]> = steps.windows(2).map(|w| [w[0], w[1]]).collect();
    let labels: Vec<&str> = drawn.iter().map(|p| p.label.as_str()).collect();
    let frame = [
        f64::from(left) + 2.0,
        f64::from(top),
        f64::from(right) + 12.0,
        f64::from(bottom) - 2.0,
    ];
    for ((place, &point), p) in places(&at, &labels, &lines, &frame).iter().zip(&at).zip(&drawn) {
        let color = COLORS[usize::from(p.network)];
        let end = nearest(place, point);
        if (end.0 - point.0).hypot(end.1 - point.1) > 14.0 {
            root.draw(&PathElement::new(
                vec![pixel(point), pixel(end)],
                color.mix(0.45).stroke_width(1),
            ))?;
        }
        root.draw(&Circle::new(
            pixel(point),
            5,
            if p.on_front { color.filled() } else { WHITE.filled() },
        ))?;
        root.draw(&Circle::new(pixel(point), 5, color.stroke_width(2)))?;
        let middle = (0.5 * (place[0] + place[2]), 0.5 * (place[1] + place[3]));
        write(&p.label, pixel(middle), font(LABEL, color, HPos::Center, VPos::Center))?;
    }
    root.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(label: &str, time: f64, error: f64) -> Point {
        Point {
            label: label.to_owned(),
            time,
            error,
            on_front: true,
            network: false,
        }
    }

    fn captions() -> Captions {
        Captions {
            title: "a < b".to_owned(),
            time: "ns".to_owned(),
            error: "MSE".to_owned(),
            foot: "left out".to_owned(),
        }
    }

    /// Twenty points in a heap: no label covers another label or leaves the frame. Control: labels all to the right of their points do.
    #[test]
    fn labels_do_not_overlap() {
        let at: Vec<(f64, f64)> = (0..20)
            .map(|i| (400.0 + 40.0 * f64::from(i % 5), 300.0 + 12.0 * f64::from(i / 5)))
            .collect();
        let labels = vec!["moment-power-4+own"; 20];
        let frame = [92.0, 56.0, 988.0, 550.0];
        let collide = |boxes: &[Box4]| (0..20).any(|i| (0..i).any(|j| overlap(&boxes[i], &boxes[j]) > 0.0));
        let found = places(&at, &labels, &[], &frame);
        assert!(
            !collide(&found)
                && found
                    .iter()
                    .all(|b| b[0] >= frame[0] && b[2] <= frame[2] && b[1] >= frame[1] && b[3] <= frame[3])
        );
        let right: Vec<Box4> = at.iter().map(|(x, y)| [x + 9.0, y - 7.0, x + 135.0, y + 8.0]).collect();
        assert!(collide(&right));
    }

    /// All that can be drawn is; the rest, and text that looks like markup, does no harm.
    #[test]
    fn the_picture_holds_its_points() {
        let points = [
            point("one", 10.0, 1e-4),
            point("<two>", 100.0, 1e-5),
            point("exact", 50.0, 0.0),
            point("lost", 50.0, f64::NAN),
        ];
        let text = svg(&captions(), &points);
        assert!(
            text.starts_with("<svg")
                && text.contains("one")
                && text.contains("&lt;two&gt;")
                && text.contains("a &lt; b"),
            "{text}"
        );
        assert!(!text.contains("exact") && !text.contains("lost") && !text.contains("NaN") && !text.contains("<two>"));
        assert_eq!(text.matches("<circle").count(), 4);
        assert_eq!(svg(&captions(), &points), text);
        let none = svg(&captions(), &[]);
        assert!(none.contains("MSE") && !none.contains("<circle") && !none.contains("NaN"));
    }

    #[test]
    fn ticks_and_their_numbers() {
        assert_eq!(ticks(1.0, 3.5), [10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0]);
        assert_eq!(ticks(-5.2, -0.9).len(), 5);
        assert_eq!(
            [1e-5, 0.02, 1.5, 20.0, 3e4].map(number),
            ["1e-5", "0.02", "1.5", "20", "3e4"]
        );
    }
}
