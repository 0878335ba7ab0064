//! Median and spread of repeated measurements.

/// Ratio of the slowest to the fastest sample above which a machine is too restless for its figures to be quoted.
pub const RESTLESS: f64 = 1.5;

/// Median and spread of some samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// The middle sample; the mean of the two in the middle where their number is even.
    pub median: f64,
    /// The least.
    pub min: f64,
    /// The greatest.
    pub max: f64,
    /// Median of the absolute deviations from the median.
    pub mad: f64,
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 {
        sorted[middle]
    } else {
        0.5 * (sorted[middle - 1] + sorted[middle])
    }
}

impl Summary {
    /// Of one sample or more, in any order.
    ///
    /// # Panics
    /// If there is none.
    pub fn of(samples: &[f64]) -> Self {
        assert!(!samples.is_empty(), "one sample or more");
        let middle = median(samples);
        let deviations: Vec<f64> = samples.iter().map(|s| (s - middle).abs()).collect();
        let end = |pick: fn(f64, f64) -> f64| samples.iter().copied().reduce(pick).expect("one sample or more");
        Self {
            median: middle,
            min: end(f64::min),
            max: end(f64::max),
            mad: median(&deviations),
        }
    }

    /// Greatest over least.
    pub fn spread(&self) -> f64 {
        self.max / self.min
    }

    /// Whether the samples differ so much ([`RESTLESS`]) that the median says little.
    pub fn is_restless(&self) -> bool {
        self.spread() > RESTLESS
    }
}

/// How many times as long each other subject took as the fastest, from the ratios within each repetition: the closing
/// sentence of a comparison, in the form that hyperfine gives it. Empty where nothing is compared.
pub fn comparison(seconds: &[(&str, &[f64])]) -> String {
    let medians: Vec<f64> = seconds.iter().map(|(_, s)| Summary::of(s).median).collect();
    let Some(fastest) = (0..medians.len()).min_by(|&a, &b| medians[a].total_cmp(&medians[b])) else {
        return String::new();
    };
    let mut others: Vec<usize> = (0..medians.len()).filter(|&i| i != fastest).collect();
    others.sort_by(|&a, &b| medians[a].total_cmp(&medians[b]));
    let of = |&other: &usize| {
        let ratios: Vec<f64> = seconds[other]
            .1
            .iter()
            .zip(seconds[fastest].1)
            .map(|(o, f)| o / f)
            .collect();
        let Summary { median, mad, .. } = Summary::of(&ratios);
        format!("{median:.2} ± {mad:.2} times faster than {}", seconds[other].0)
    };
    match others.as_slice() {
        [] => String::new(),
        [one] => format!("{} ran {}\n", seconds[fastest].0, of(one)),
        more => {
            let lines: Vec<String> = more.iter().map(|i| format!("  {}\n", of(i))).collect();
            format!("{} ran\n{}", seconds[fastest].0, lines.concat())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_by_hand() {
        let summary = Summary::of(&[5.0, 1.0, 4.0, 2.0, 100.0]);
        // Deviations from 4: 1, 3, 0, 2, 96.
        assert_eq!(
            summary,
            Summary {
                median: 4.0,
                min: 1.0,
                max: 100.0,
                mad: 2.0
            }
        );
        assert_eq!((summary.spread(), summary.is_restless()), (100.0, true));
        assert_eq!(
            Summary::of(&[3.0, 1.0, 2.0, 10.0]),
            Summary {
                median: 2.5,
                min: 1.0,
                max: 10.0,
                mad: 1.0
            }
        );
        assert_eq!(
            Summary::of(&[7.0]),
            Summary {
                median: 7.0,
                min: 7.0,
                max: 7.0,
                mad: 0.0
            }
        );
        assert!(!Summary::of(&[1.0, 1.5]).is_restless() && Summary::of(&[1.0, 1.51]).is_restless());
        // Control: the middle of unsorted samples, and a mean, are no median.
        assert_ne!(summary.median, [5.0, 1.0, 4.0, 2.0, 99.0][3]);
        assert_ne!(summary.median, [5.0, 1.0, 4.0, 2.0, 100.0].iter().sum::<f64>() / 5.0);
    }

    /// By hand: ratios of the same repetition, not of the medians.
    #[test]
    fn comparisons_take_ratios_within_repetitions() {
        let (fast, slow, slower) = ([1.0, 2.0, 4.0], [3.0, 8.0, 16.0], [10.0, 20.0, 41.0]);
        assert_eq!(
            comparison(&[("flex", &slow), ("fused", &fast)]),
            "fused ran 4.00 ± 0.00 times faster than flex\n"
        );
        let three = comparison(&[("ndarray", &slower), ("flex", &slow), ("fused", &fast)]);
        assert_eq!(
            three,
            "fused ran\n  4.00 ± 0.00 times faster than flex\n  10.00 ± 0.00 times faster than ndarray\n"
        );
        // Control: a subject alone is compared with nothing.
        assert_eq!(
            (comparison(&[("fused", &fast)]), comparison(&[])),
            (String::new(), String::new())
        );
    }

    /// An outlier moves neither the median nor the MAD of many. Control: it moves the greatest.
    #[test]
    fn outliers_move_the_ends_alone() {
        let quiet: Vec<f64> = (0..15).map(|i| 1.0 + 0.01 * f64::from(i)).collect();
        let mut disturbed = quiet.clone();
        disturbed[14] = 50.0;
        let [quiet, disturbed] = [quiet, disturbed].map(|samples| Summary::of(&samples));
        assert_eq!(
            (quiet.median, quiet.mad, quiet.min),
            (disturbed.median, disturbed.mad, disturbed.min)
        );
        assert!(!quiet.is_restless() && disturbed.is_restless() && disturbed.max == 50.0);
    }
}
