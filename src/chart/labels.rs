//! Where names stand: at the ends of lines, and beside single points, clear of one another.

use super::text::escape;
use super::{COLORS, Mark, Plot, Series, TOP, font};

/// Size of labels and height of a line of them [CSS pixels].
const SIZE: f64 = 12.0;
const LINE: f64 = 15.0;
/// Letters of a label that are shown.
const LETTERS: usize = 34;

/// The name, cut where it is long.
pub(super) fn shortened(name: &str) -> String {
    if name.chars().count() <= LETTERS {
        name.to_owned()
    } else {
        name.chars().take(LETTERS - 1).chain(['…']).collect()
    }
}

/// Width of a label [CSS pixels].
pub(super) fn text_width(text: &str) -> f64 {
    font::width(text, SIZE)
}

/// A rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Area {
    fn around((x, y): (f64, f64), half_width: f64, half_height: f64) -> Self {
        Self {
            left: x - half_width,
            top: y - half_height,
            right: x + half_width,
            bottom: y + half_height,
        }
    }

    fn overlap(&self, other: &Self) -> f64 {
        let width = (self.right.min(other.right) - self.left.max(other.left)).max(0.0);
        let height = (self.bottom.min(other.bottom) - self.top.max(other.top)).max(0.0);
        width * height
    }

    /// The point of the rectangle that is nearest to a point.
    fn nearest(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (x.clamp(self.left, self.right), y.clamp(self.top, self.bottom))
    }

    /// How much of a segment, three pixels thick, lies within.
    fn crossed(&self, from: (f64, f64), to: (f64, f64)) -> f64 {
        let steps = 48;
        let inside = (0..=steps).filter(|&i| {
            let t = f64::from(i) / f64::from(steps);
            let (x, y) = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            x > self.left && x < self.right && y > self.top && y < self.bottom
        });
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        inside.count() as f64 / f64::from(steps + 1) * length * 3.0
    }
}

type Segment = [(f64, f64); 2];

/// For each point the place around it, near or, with a leader, far, that covers least of points, lines and labels
/// before it; none where every place would cover another label.
fn places(at: &[(f64, f64)], labels: &[String], lines: &[Segment], frame: &Area) -> Vec<Option<Area>> {
    let mut taken: Vec<Area> = at.iter().map(|&p| Area::around(p, 6.0, 6.0)).collect();
    let points = taken.len();
    let mut leaders: Vec<Segment> = lines.to_vec();
    let mut found = Vec::new();
    for (&(x, y), label) in at.iter().zip(labels) {
        let (w, h) = (text_width(label) + 4.0, LINE);
        let mut best: (f64, Option<Area>) = (f64::INFINITY, None);
        for reach in [9.0, 24.0, 42.0, 66.0, 96.0, 130.0, 170.0] {
            for turn in 0..16 {
                let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(turn) / 8.0);
                // The label's nearest point lies at the reach.
                let middle = (x + cos * (reach + 0.5 * w * cos.abs()), y - sin * (reach + 0.5 * h));
                let place = Area::around(middle, 0.5 * w, 0.5 * h);
                let outside = w * h - place.overlap(frame);
                if outside > 1e-6 || taken[points..].iter().any(|t| place.overlap(t) > 0.0) {
                    continue;
                }
                let covered: f64 = taken.iter().map(|t| place.overlap(t)).sum();
                let crossed: f64 = leaders.iter().map(|l| place.crossed(l[0], l[1])).sum();
                let led = if reach > 9.0 {
                    taken.iter().map(|t| 0.5 * t.crossed((x, y), middle)).sum::<f64>()
                } else {
                    0.0
                };
                let cost = 40.0 * covered + crossed + led + 1.2 * reach + if turn == 0 { 0.0 } else { 3.0 };
                if cost < best.0 {
                    best = (cost, Some(place));
                }
            }
        }
        if let Some(place) = best.1 {
            leaders.push([(x, y), place.nearest((x, y))]);
            taken.push(place);
        }
        found.push(best.1);
    }
    found
}

/// Names of lines at their right ends, moved apart where they would meet.
pub(super) fn lines(series: &[Series], plot: &Plot, out: &mut String) {
    let mut labels: Vec<(f64, f64, f64, &Series)> = Vec::new();
    for series in series.iter().filter(|s| s.is_line() && !s.name.is_empty()) {
        if let Some(last) = series.drawn().last() {
            let (x, y) = plot.at(last);
            labels.push((x, y, y, series));
        }
    }
    labels.sort_by(|a, b| a.1.total_cmp(&b.1));
    // Down from the top, and back up from the bottom where they ran over it.
    let mut free = TOP - LINE;
    for label in &mut labels {
        label.2 = label.1.max(free + LINE);
        free = label.2;
    }
    let mut free = plot.y_end + 0.5 * LINE;
    for label in labels.iter_mut().rev() {
        label.2 = label.2.min(free);
        free = label.2 - LINE;
    }
    let x_end = plot.x_end;
    for (px, py, label_y, series) in labels {
        let (color, at) = (series.color % COLORS, x_end + 16.0);
        *out += &format!(
            "<g class=\"s{color}\"><polyline class=\"leader\" points=\"{px:.1},{py:.1} {x_end:.1},{py:.1} \
                {:.1},{label_y:.1}\"/>\
             <text class=\"label\" x=\"{at:.1}\" y=\"{:.1}\">{}<title>{}</title></text></g>\n",
            at - 4.0,
            label_y + 4.0,
            escape(&shortened(&series.name)),
            escape(&series.name)
        );
    }
}

/// Names beside single points, where there is room for them; the others have theirs on hovering.
pub(super) fn points(series: &[Series], plot: &Plot, out: &mut String) {
    let mut crossed: Vec<Segment> = Vec::new();
    for joined in series.iter().filter(|s| s.mark == Mark::Joined) {
        let path: Vec<(f64, f64)> = joined.drawn().iter().map(|p| plot.at(p)).collect();
        crossed.extend(path.windows(2).map(|w| [w[0], w[1]]));
    }
    let named = |s: &&Series| matches!(s.mark, Mark::Filled | Mark::Hollow) && !s.name.is_empty();
    let named: Vec<(&Series, (f64, f64))> = series
        .iter()
        .filter(named)
        .filter_map(|s| Some((s, plot.at(s.drawn().first()?))))
        .collect();
    let at: Vec<(f64, f64)> = named.iter().map(|n| n.1).collect();
    let labels: Vec<String> = named.iter().map(|n| shortened(&n.0.name)).collect();
    let found = places(&at, &labels, &crossed, &plot.area());
    for (((series, point), label), place) in named.into_iter().zip(&labels).zip(found) {
        let Some(place) = place else { continue };
        let (color, end) = (series.color % COLORS, place.nearest(point));
        *out += &format!("<g class=\"s{color}\">");
        if (end.0 - point.0).hypot(end.1 - point.1) > 14.0 {
            let [(x0, y0), (x1, y1)] = [point, end];
            *out += &format!("<polyline class=\"leader\" points=\"{x0:.1},{y0:.1} {x1:.1},{y1:.1}\"/>");
        }
        let (x, y) = (place.left + 2.0, place.top + 11.5);
        *out += &format!(
            "<text class=\"label\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text></g>\n",
            escape(label)
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty points in a heap: no label covers another label or leaves the frame. Control: labels all to the right of
    /// their points do.
    #[test]
    fn labels_do_not_overlap() {
        let at: Vec<(f64, f64)> = (0..20)
            .map(|i| (400.0 + 40.0 * f64::from(i % 5), 300.0 + 12.0 * f64::from(i / 5)))
            .collect();
        let labels = vec!["moment-power-4+own".to_owned(); 20];
        let frame = Area {
            left: 66.0,
            top: 56.0,
            right: 988.0,
            bottom: 550.0,
        };
        let collide = |areas: &[Area]| (0..areas.len()).any(|i| (0..i).any(|j| areas[i].overlap(&areas[j]) > 0.0));
        let found: Vec<Area> = places(&at, &labels, &[], &frame).into_iter().flatten().collect();
        assert!(found.len() >= 16 && !collide(&found), "{}", found.len());
        assert!(found.iter().all(|b| b.left >= frame.left && b.right <= frame.right));
        assert!(found.iter().all(|b| b.top >= frame.top && b.bottom <= frame.bottom));
        let right = |&(x, y): &(f64, f64)| Area::around((x + 72.0, y), 63.0, 7.5);
        assert!(collide(&at.iter().map(right).collect::<Vec<_>>()));
    }
}
