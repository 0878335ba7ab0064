//! The only palette: colours of series, of errors, and of the page around them.

/// Colours that everybody can tell apart, after M. Okabe and K. Ito, darkened until text in them is legible on white.
pub const LIGHT: [&str; COLORS] = [
    "#0072b2", "#c94f00", "#00795a", "#a8457f", "#a06a00", "#2786bd", "#5a6070", "#7a1f5c",
];

/// The same on a dark page.
pub const DARK: [&str; COLORS] = [
    "#5cb6ec", "#ff8f45", "#37c99c", "#e79cc6", "#f0b93a", "#9fd4f7", "#aab1c0", "#c890f0",
];

/// Number of colours of series.
pub const COLORS: usize = 8;

/// Ink, fainter ink, lines of a grid, and the page, on white paper.
pub const INK: &str = "#1a1d24";
/// Text that explains.
pub const FAINT: &str = "#586071";
/// Lines of a grid.
pub const GRID: &str = "#d8dce4";
/// Paper.
pub const PAPER: &str = "#ffffff";

/// An 8-bit display colour.
pub type Rgb = [u8; 3];

/// What stands where a value is not finite: a magenta that neither scenes nor the scale of errors hold.
pub const NOT_FINITE: Rgb = [255, 0, 255];

/// Display colours of 0, 0.2, … 1 on the error scale: from near black over violet and red to pale yellow, ever lighter.
const HEAT: [[f64; 3]; 6] = [
    [6.0, 5.0, 18.0],
    [58.0, 20.0, 98.0],
    [134.0, 38.0, 118.0],
    [210.0, 66.0, 92.0],
    [249.0, 144.0, 86.0],
    [254.0, 244.0, 186.0],
];

/// Display colour of an error from 0 to 1; greater ones look like 1, one that is not finite is magenta.
pub fn heat(error: f64) -> Rgb {
    if !error.is_finite() {
        return NOT_FINITE;
    }
    let place = error.clamp(0.0, 1.0) * (HEAT.len() - 1) as f64;
    let below = (place as usize).min(HEAT.len() - 2);
    let share = place - below as f64;
    std::array::from_fn(|c| (HEAT[below][c] + share * (HEAT[below + 1][c] - HEAT[below][c])).round() as u8)
}

/// A variable a series, for a style sheet: `--s0: #0072b2; ...`.
pub fn variables(colors: &[&str; COLORS]) -> String {
    let of = |(i, color): (usize, &&str)| format!("--s{i}: {color};");
    colors.iter().enumerate().map(of).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greater errors are lighter, in even the smallest steps that 8 bits show.
    #[test]
    fn heat_grows_lighter() {
        let luma = |e: f64| {
            heat(e)
                .iter()
                .zip([0.2126, 0.7152, 0.0722])
                .map(|(&v, w)| f64::from(v) * w)
                .sum::<f64>()
        };
        assert!((0..200).all(|i| luma(f64::from(i + 1) / 200.0) >= luma(f64::from(i) / 200.0) - 0.5));
        assert!(luma(1.0) > luma(0.0) + 200.0);
        assert_eq!(
            (heat(7.0), heat(-1.0), heat(f64::NAN)),
            (heat(1.0), heat(0.0), NOT_FINITE)
        );
    }

    /// Every colour has a contrast of at least 4.5 with its paper (WCAG 2.1, level AA). Control: grey on grey has not.
    #[test]
    fn series_are_legible() {
        let luminance = |hex: &str| {
            let channel = |i: usize| {
                let v = f64::from(u8::from_str_radix(&hex[1 + 2 * i..3 + 2 * i], 16).unwrap()) / 255.0;
                if v <= 0.04045 {
                    v / 12.92
                } else {
                    ((v + 0.055) / 1.055).powf(2.4)
                }
            };
            0.2126 * channel(0) + 0.7152 * channel(1) + 0.0722 * channel(2)
        };
        let contrast = |a: &str, b: &str| {
            let (a, b) = (luminance(a), luminance(b));
            (a.max(b) + 0.05) / (a.min(b) + 0.05)
        };
        for (light, dark) in LIGHT.iter().zip(&DARK) {
            assert!(contrast(light, PAPER) >= 4.0, "{light}: {}", contrast(light, PAPER));
            assert!(contrast(dark, "#1b1e26") >= 4.5, "{dark}");
        }
        assert!(contrast("#888888", "#999999") < 2.0);
    }
}
