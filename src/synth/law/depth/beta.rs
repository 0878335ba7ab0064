//! Fragments that crowd somewhere.

use super::{Draw, Law, Shape};
use crate::numeric::rng::Stream;
use crate::synth::config::{Range, SynthError, within};
use crate::synth::law::gamma::{Ahead, Gamma};
use crate::synth::law::numbers::{LogUniform, NumberLaw};
use serde::{Deserialize, Serialize};

/// Shape parameters of the beta law. Below, its draws underflow; above, they are a constant for all that f32 can tell.
pub const BETA_SHAPES: std::ops::RangeInclusive<f64> = 0.1..=1e3;

/// The beta law, density proportional to x^(a − 1) (1 − x)^(b − 1): fragments crowd at one end, at both or in the
/// middle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Beta {
    /// Exponent a, log-uniform, drawn once a pixel, in [`BETA_SHAPES`].
    pub a: Range,
    /// Exponent b, the same.
    pub b: Range,
}

#[derive(Debug, Clone)]
pub(super) struct Prepared {
    a: LogUniform,
    b: LogUniform,
}

#[derive(Default)]
pub(super) struct Scratch {
    ahead: Ahead,
    /// The second gamma variable of each fragment; the first is where the depth will be.
    second: Vec<f64>,
    /// Logarithms of the factors of the two, then the factors.
    factors: [Vec<f64>; 2],
}

impl Law for Beta {
    type Prepared = Prepared;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        let must = format!("lie in [{}, {}]", BETA_SHAPES.start(), BETA_SHAPES.end());
        [("a", self.a), ("b", self.b)]
            .into_iter()
            .try_for_each(|(name, r)| within(&format!("{at}.{name}"), r, |x| BETA_SHAPES.contains(&x), &must))
    }

    fn prepare(&self) -> Prepared {
        Prepared {
            a: LogUniform::new(self.a),
            b: LogUniform::new(self.b),
        }
    }
}

impl Draw for Prepared {
    type Scratch = Scratch;

    fn draw(&self, rng: &mut Stream, n: usize, scratch: &mut Scratch, shape: &mut Shape) {
        let laws = [&self.a, &self.b].map(|exponent| Gamma::new(exponent.draw(rng)));
        let units_of_a_fragment: usize = laws.iter().map(Gamma::units).sum();
        let Scratch {
            ahead,
            second: y,
            factors: [of_x, of_y],
        } = scratch;
        let x = &mut shape.depth;
        for of_law in [&mut *x, y, of_x, of_y] {
            of_law.resize(n, 0.0);
        }
        for i in 0..n {
            let wanted = units_of_a_fragment * (n - i);
            (x[i], of_x[i]) = laws[0].draw(rng, ahead, wanted);
            (y[i], of_y[i]) = laws[1].draw(rng, ahead, wanted);
        }
        ahead.end(rng);
        laws[0].boost(x, of_x);
        laws[1].boost(y, of_y);
        x.iter_mut().zip(y).for_each(|(x, y)| *x /= *x + *y);
        shape.stand_alone(n);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DepthLaw, shapes};
    use super::*;
    use crate::numeric::rng::stream;
    use crate::synth::law::gamma::one_gamma;
    use crate::synth::law::testing::{DRAWS, Normals, has_mean, range, says};
    use rand::Rng;

    fn law(a: f64, b: f64) -> Beta {
        Beta {
            a: range(a, a),
            b: range(b, b),
        }
    }

    #[test]
    fn in_a_file() {
        let expected = Beta {
            a: range(0.3, 5.0),
            b: range(1.0, 2.0),
        };
        let text = "law = 'beta'\na = { min = 0.3, max = 5 }\nb = { min = 1, max = 2 }";
        assert!(says::<DepthLaw>(text, expected));
    }

    #[test]
    fn beta_shapes() {
        for (a, b) in [(0.3, 0.3), (0.5, 4.0), (5.0, 2.0), (0.1, 0.1)] {
            let x: Vec<f64> = shapes(&law(a, b), 8, DRAWS / 8)
                .into_iter()
                .flat_map(|(depth, _)| depth)
                .collect();
            assert!(x.iter().all(|x| (0.0..=1.0).contains(x)));
            let m = a / (a + b);
            assert!(
                has_mean(&x, |x| x, m) && has_mean(&x, |x| (x - m).powi(2), a * b / ((a + b).powi(2) * (a + b + 1.0))),
                "a = {a}, b = {b}"
            );
        }
    }

    /// Fragments drawn one by one with scalar functions, in the order in which words are taken: the same depths to the
    /// bit as many at once, and as many words taken. Control: the pixel before.
    #[test]
    fn many_at_once_are_those_drawn_one_by_one() {
        let mut last = Vec::new();
        for pixel in (0..3000).step_by(2) {
            let mut many = stream(9, 0x7e57, pixel);
            // Words before the pixel, so that it starts anywhere.
            for _ in 0..pixel % 200 {
                many.next_u32();
            }
            let mut one = many.clone();
            let n = 1 + (pixel as usize * 7) % 150;
            let (a, b) = (0.1 + 0.003 * (pixel % 1000) as f64, 0.1 + 0.01 * (pixel % 300) as f64);
            let (mut shape, mut normals) = (Shape::default(), Normals::default());
            law(a, b)
                .prepare()
                .draw(&mut many, n, &mut Scratch::default(), &mut shape);
            let _ = (one.unit(), one.unit());
            let expected: Vec<f64> = (0..n)
                .map(|_| {
                    let x = one_gamma(a, &mut one, &mut normals);
                    x / (x + one_gamma(b, &mut one, &mut normals))
                })
                .collect();
            assert_eq!(shape.depth, expected, "pixel {pixel}");
            assert_eq!(many.next_u64(), one.next_u64(), "pixel {pixel}");
            assert_ne!(expected, last);
            last = expected;
        }
    }
}
