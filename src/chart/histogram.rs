//! Histograms side by side, and one bar that is cut into shares, as one drawing.

use super::axis::linear_step;
use super::font::width;
use super::palette::LIGHT;
use super::text::escape;
use super::{COLORS, document_head};

/// One histogram.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What was counted.
    pub title: String,
    /// Ends of the bins, ascending.
    pub edges: Vec<f64>,
    /// What lies in each bin; one less than there are edges.
    pub counts: Vec<u64>,
}

/// A part of a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// What it is.
    pub label: String,
    /// From 0 to 1.
    pub share: f64,
}

/// Width of a drawing, room at its sides, and heights of a panel and of its plot [CSS pixels].
const WIDTH: f64 = 1000.0;
const SIDE: f64 = 24.0;
const PANEL: f64 = 230.0;
const PLOT: f64 = 168.0;
/// Room for the numbers of an ordinate [CSS pixels].
const NUMBERS: f64 = 36.0;

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

/// The bins that hold something, and one on either side.
fn occupied(counts: &[u64]) -> (usize, usize) {
    let first = counts.iter().position(|&n| n > 0).unwrap_or(0);
    let last = counts
        .iter()
        .rposition(|&n| n > 0)
        .unwrap_or(counts.len().saturating_sub(1));
    (first.saturating_sub(1), (last + 2).min(counts.len()))
}

impl Panel {
    /// The panel with its upper left corner at a place.
    fn draw(&self, left: f64, top: f64, across: f64) -> String {
        let (first, end) = occupied(&self.counts);
        let all = self.counts.iter().sum::<u64>().max(1) as f64;
        let greatest = 100.0 * self.counts.iter().copied().max().unwrap_or(0).max(1) as f64 / all;
        let (x0, x1, y0, y1) = (left + NUMBERS, left + across, top + 26.0 + PLOT, top + 26.0);
        let step = linear_step(greatest / 5.0);
        let high = (greatest / step).ceil() * step;
        let y_of = |percent: f64| y0 - percent / high * (y0 - y1);
        let mut out = format!(
            "<text x=\"{x0:.1}\" y=\"{:.1}\">{}</text>\n",
            top + 15.0,
            escape(&self.title)
        );
        for i in 0..=(high / step).round() as usize {
            let (value, y) = (i as f64 * step, y_of(i as f64 * step));
            out += &format!(
                "<line class=\"grid\" x1=\"{x0:.1}\" x2=\"{x1:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>\
                 <text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>\n",
                x0 - 6.0,
                y + 4.0,
                tick(value)
            );
        }
        let bin = (x1 - x0) / (end - first).max(1) as f64;
        for (i, &n) in self.counts[first..end].iter().enumerate().filter(|(_, n)| **n > 0) {
            let (x, y) = (x0 + (i as f64 + 0.06) * bin, y_of(100.0 * n as f64 / all));
            out += &format!(
                "<rect class=\"s0 area\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>\n",
                0.88 * bin,
                y0 - y
            );
        }
        let mut last = f64::NEG_INFINITY;
        for (i, &edge) in self.edges[first..=end.min(self.edges.len() - 1)].iter().enumerate() {
            let (x, text) = (x0 + i as f64 * bin, tick(edge));
            let half = width(&text, 11.0) / 2.0;
            // A number that would touch the one before is left out.
            if x - half > last + 5.0 {
                out += &format!(
                    "<text class=\"tick\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{text}</text>\n",
                    y0 + 16.0
                );
                last = x + half;
            }
        }
        out + &format!("<path class=\"axis\" d=\"M{x0:.1} {y1:.1}V{y0:.1}H{x1:.1}\"/>\n")
    }
}

/// Histograms two in a row, in percent, and below them a bar of shares with its legend, as an SVG file.
pub fn svg(title: &str, panels: &[Panel], shares_title: &str, shares: &[Share]) -> String {
    let half = (WIDTH - 3.0 * SIDE) / 2.0;
    let below = 44.0 + PANEL * panels.len().div_ceil(2) as f64;
    let height = below + 84.0 + 24.0 * shares.len().div_ceil(2) as f64;
    let mut out = document_head(WIDTH, height, title);
    out += &format!("<text class=\"title\" x=\"{SIDE}\" y=\"27\">{}</text>\n", escape(title));
    for (i, panel) in panels.iter().enumerate() {
        let left = SIDE + (i % 2) as f64 * (half + SIDE);
        out += &panel.draw(left, 44.0 + PANEL * (i / 2) as f64, half);
    }
    out += &format!(
        "<text x=\"{SIDE}\" y=\"{:.1}\">{}</text>\n",
        below + 16.0,
        escape(shares_title)
    );
    let mut at = SIDE;
    for (i, share) in shares.iter().enumerate() {
        // Colours come again after the eighth, fainter.
        let look = format!(
            "fill=\"{}\" fill-opacity=\"{}\"",
            LIGHT[i % COLORS],
            if i < COLORS { "0.9" } else { "0.45" }
        );
        let across = (WIDTH - 2.0 * SIDE) * share.share;
        let (x, y) = (
            SIDE + (WIDTH - 2.0 * SIDE) / 2.0 * (i % 2) as f64,
            below + 72.0 + 24.0 * (i / 2) as f64,
        );
        out += &format!(
            "<rect x=\"{at:.1}\" y=\"{:.1}\" width=\"{across:.1}\" height=\"32\" {look}/>\
             <rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"14\" height=\"14\" {look}/>\
             <text x=\"{:.1}\" y=\"{:.1}\">{}</text>\n",
            below + 26.0,
            x + 22.0,
            y + 11.5,
            escape(&share.label)
        );
        at += across;
    }
    out + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_holds_panels_and_shares() {
        let panel = Panel {
            title: "alpha <of> fragments".to_owned(),
            edges: vec![0.0, 0.25, 0.5, 0.75, 1.0],
            counts: vec![0, 3, 1, 0],
        };
        let share = |label: &str, share| Share {
            label: label.to_owned(),
            share,
        };
        let text = svg(
            "three",
            &[panel.clone(), panel],
            "classes",
            &[share("a", 0.25), share("b & c", 0.75)],
        );
        assert!(text.starts_with("<svg") && text.contains("alpha &lt;of&gt;") && text.contains("b &amp; c"));
        assert_eq!(text.matches("class=\"s0 area\"").count(), 4);
        // A quarter of the bar's 952 pixels.
        assert!(text.contains("width=\"238.0\" height=\"32\"") && !text.contains("NaN"));
        let empty = Panel {
            title: "nothing".to_owned(),
            edges: vec![0.0, 1.0],
            counts: vec![0],
        };
        assert!(!svg("none", &[empty], "", &[]).contains("NaN"));
    }

    #[test]
    fn ticks_are_short() {
        assert_eq!(
            [0.0, 5.0, 0.25, 1e-4, 30_000.0].map(tick),
            ["0", "5", "0.25", "1e-4", "3e4"]
        );
    }
}
