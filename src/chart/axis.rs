//! Axes: from the values that are drawn to places, ticks and their texts.

use super::text::number;

/// How an axis runs.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// Equal steps are equal differences.
    Linear,
    /// Equal steps are equal ratios. What lies more than so many decades below the greatest value, 0 too, stands on the
    /// lower edge.
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

/// An axis with its ends known.
pub(super) struct Ruler {
    low: f64,
    high: f64,
    log: bool,
    from: f64,
    to: f64,
    /// Values and their texts; the lowest says so where smaller values are drawn on it.
    pub ticks: Vec<(f64, String)>,
}

/// Ends of an axis, and its ticks with their texts.
type Ends = (f64, f64, Vec<(f64, String)>);

fn named(names: &[String]) -> Ends {
    let last = names.len().max(1) as f64 - 1.0;
    let ticks = names.iter().enumerate().map(|(i, name)| (i as f64, name.clone()));
    (-0.35, last + 0.35, ticks.collect())
}

fn linear(low: f64, high: f64) -> Ends {
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
        .map(|v| (v, number(tidy(v, step))));
    (low, high, ticks.collect())
}

/// Ends as logarithms; `clipped` says that there are values which no logarithm has.
fn logarithmic(mut low: f64, mut high: f64, mut clipped: bool, decades: i32) -> Ends {
    if low > high {
        // Nothing but zeros.
        (low, high) = (0.1, 1.0);
    }
    // What is drawn keeps clear of the smallest numbers that there are.
    let high = high.clamp(1e-290, 1e300);
    let floor = high.log10().ceil() - f64::from(decades);
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
    (low, high, ticks)
}

impl Ruler {
    /// The ruler of these values; none where none is finite.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>, from: f64, to: f64) -> Option<Self> {
        let log = matches!(axis.scale, Scale::Log { .. });
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut any, mut clipped) = (false, false);
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
        let (low, high, ticks) = match &axis.scale {
            Scale::Names(names) => named(names),
            Scale::Linear => linear(low, high),
            Scale::Log { decades } => logarithmic(low, high, clipped, *decades),
        };
        Some(Self {
            low,
            high,
            log,
            from,
            to,
            ticks,
        })
    }

    /// Where a value stands [CSS pixels].
    pub fn at(&self, v: f64) -> f64 {
        let v = if self.log { v.max(1e-300).log10() } else { v };
        let share = ((v - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.from + share * (self.to - self.from)
    }
}

/// The next of 1, 2, 5 times a power of ten.
pub(super) fn linear_step(least: f64) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    const LOG: Scale = Scale::Log { decades: 8 };

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
}
