//! Fragments about a few centres.

use super::{Draw, Law, Shape};
use crate::numeric::doubles::DOUBLES;
use crate::numeric::rng::{self, Stream};
use crate::synth::config::{CountRange, Range, SynthError, above_zero, count};
use crate::synth::law::numbers::{FILLER, LogUniform, NumberLaw, below, normals};
use rand_distr::{Distribution, Uniform};
use serde::{Deserialize, Serialize};

/// Each fragment belongs to one of a few clusters and scatters about its centre, half of them by the normal and half by
/// the uniform law; centres are uniform. Smoke, hair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Clustered {
    /// Number of clusters, uniform.
    pub clusters: CountRange,
    /// Standard deviation of a cluster, log-uniform, > 0.
    pub width: Range,
}

#[derive(Debug, Clone)]
pub(super) struct Prepared {
    clusters: Uniform<u32>,
    width: LogUniform,
}

#[derive(Default)]
pub(super) struct Scratch {
    /// Centre and standard deviation of each cluster.
    clusters: Vec<(f64, f64)>,
    normal: Normal,
}

/// Normal numbers of a pixel, which are computed all at once.
#[derive(Default)]
struct Normal {
    /// The two units of each pair of numbers, then the numbers.
    pairs: [Vec<f64>; 2],
    /// The fragments that they are for.
    fragments: Vec<u32>,
}

impl Law for Clustered {
    type Prepared = Prepared;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        count(&format!("{at}.clusters"), self.clusters)?;
        above_zero(&format!("{at}.width"), self.width)
    }

    fn prepare(&self) -> Prepared {
        let CountRange { min, max } = self.clusters;
        Prepared {
            clusters: Uniform::new_inclusive(min, max).expect("validated: min <= max"),
            width: LogUniform::new(self.width),
        }
    }
}

impl Draw for Prepared {
    type Scratch = Scratch;

    fn draw(&self, rng: &mut Stream, n: usize, Scratch { clusters, normal }: &mut Scratch, shape: &mut Shape) {
        clusters.clear();
        clusters.extend((0..self.clusters.sample(rng)).map(|_| (rng.unit(), self.width.draw(rng))));
        scatter(rng, n, clusters.len(), normal, shape);
        for (x, &k) in shape.depth.iter_mut().zip(&shape.object) {
            let (center, width) = clusters[k as usize];
            *x = center + width * *x;
        }
    }
}

/// Clusters of n fragments, and how far each lies from its cluster's centre, in standard deviations: half of them by
/// the normal and half by the uniform law.
///
/// Every fragment takes a word for its cluster, two to choose the law, and two or four more: normal numbers come in
/// pairs, of which the second takes none. Which words serve what is settled first, without a branch; then all normal
/// numbers are computed at once.
fn scatter(
    rng: &mut Stream,
    n: usize,
    clusters: usize,
    Normal {
        pairs: [radii, angles],
        fragments,
    }: &mut Normal,
    Shape { depth, object }: &mut Shape,
) {
    object.resize(n, 0);
    depth.resize(n, 0.0);
    fragments.resize(n, 0);
    for units in [&mut *radii, angles] {
        // Half of the fragments take a pair each at the most, and one place more is written ahead.
        units.resize((n / 2 + 2).next_multiple_of(DOUBLES), FILLER);
    }
    let (mut pairs, mut count, mut spare) = (0, 0, 0);
    for i in 0..n {
        let &[which, _, law, u0, u1, v0, v1, _] = rng.peek();
        object[i] = below(which, clusters) as u32;
        let (u, v) = (rng::unit([u0, u1]), rng::unit([v0, v1]));
        // √3 makes the uniform law's deviation 1.
        depth[i] = (2.0 * u - 1.0) * 3f64.sqrt();
        (radii[pairs], angles[pairs], fragments[count]) = (u, v, i as u32);
        // Units below ½ have no highest bit.
        let is_normal = (law >> 31 ^ 1) as usize;
        let takes_pair = is_normal & (spare ^ 1);
        (pairs, count, spare) = (pairs + takes_pair, count + is_normal, spare ^ is_normal);
        rng.skip(3 + 2 * (is_normal ^ 1) + 4 * takes_pair);
    }
    let whole = pairs.next_multiple_of(DOUBLES);
    normals(&mut radii[..whole], &mut angles[..whole]);
    for (j, &i) in fragments[..count].iter().enumerate() {
        depth[i as usize] = if j % 2 == 0 { radii[j / 2] } else { angles[j / 2] };
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DepthLaw, shapes};
    use super::*;
    use crate::numeric::rng::stream;
    use crate::synth::law::testing::{DRAWS, Normals, has_mean, mean, range, says};
    use rand::Rng;

    fn law(min: u32, max: u32, width: Range) -> Clustered {
        Clustered {
            clusters: CountRange { min, max },
            width,
        }
    }

    #[test]
    fn in_a_file() {
        assert!(says::<DepthLaw>(
            "law = 'clustered'\nclusters = { min = 1, max = 6 }\nwidth = { min = 1e-3, max = 0.3 }",
            law(1, 6, range(1e-3, 0.3))
        ));
    }

    #[test]
    fn clusters() {
        // One cluster of a known width: the variance is its square. Tolerance: 5 standard errors, sqrt(2/n) relative.
        let (x, object) = shapes(&law(1, 1, range(0.05, 0.05)), DRAWS, 1).remove(0);
        let center = mean(&x);
        assert!(has_mean(&x, |x| (x - center).powi(2), 0.05f64.powi(2)) && object.iter().all(|&o| o == 0));
        // Narrow clusters: as many places as objects, and fragments of one object close together.
        for (depth, object) in shapes(&law(2, 6, range(1e-6, 1e-5)), 200, 200) {
            let clusters = *object.iter().max().unwrap() + 1;
            assert!((2..=6).contains(&clusters));
            for (x, o) in depth.iter().zip(&object) {
                let first = object.iter().position(|p| p == o).unwrap();
                assert!((x - depth[first]).abs() < 1e-4);
            }
        }
        let wide = shapes(&law(1, 6, range(1e-3, 0.3)), 2, 50_000);
        // A fragment's mean is that of the centres, wherever its cluster lies.
        assert!(has_mean(
            &wide.iter().map(|(x, _)| x[0]).collect::<Vec<_>>(),
            |x| x,
            0.5
        ));
    }

    /// Fragments drawn one by one with scalar functions, in the order in which words are taken: the same depths to the
    /// bit as many at once, and as many words taken. Control: the pixel before.
    #[test]
    fn many_at_once_are_those_drawn_one_by_one() {
        let mut last = Vec::new();
        for pixel in (1..3000).step_by(2) {
            let mut many = stream(9, 0x7e57, pixel);
            // Words before the pixel, so that it starts anywhere.
            for _ in 0..pixel % 200 {
                many.next_u32();
            }
            let mut one = many.clone();
            let n = 1 + (pixel as usize * 7) % 150;
            let (mut shape, mut normals) = (Shape::default(), Normals::default());
            scatter(&mut many, n, 5, &mut Normal::default(), &mut shape);
            let expected: Vec<f64> = (0..n)
                .map(|i| {
                    assert_eq!(shape.object[i] as usize, below(one.next_u32(), 5));
                    if one.unit() < 0.5 {
                        normals.one(&mut one)
                    } else {
                        (2.0 * one.unit() - 1.0) * 3f64.sqrt()
                    }
                })
                .collect();
            assert_eq!(shape.depth, expected, "pixel {pixel}");
            assert_eq!(many.next_u64(), one.next_u64(), "pixel {pixel}");
            assert_ne!(expected, last);
            last = expected;
        }
    }
}
