//! Shadows of transparent surfaces: methods answer how much light reaches a point, from what a shadow map keeps of each
//! texel.

use crate::numeric::tolerance::AbsoluteError;
use crate::oit::{self, Capabilities, Context, Method, MethodError};
use crate::pixel::{FragmentList, absorbance};
use crate::scene::shadow::{Receiver, Shadowed};
use serde::{Deserialize, Serialize};

/// How a texel of the shadow map is looked up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Filter {
    /// The texel that holds the point.
    Nearest,
    /// Sums of 9 × 9 texels under a Gaussian of standard deviation 1.5, interpolated between texels: absorbances are
    /// filtered, that is, moments with their normalisation by b0 undone.
    ///
    /// # Source
    /// MKKP18 Sec. 6.
    Gaussian9x9,
}

/// Errors of the transmittance towards the light. In JSON, NaN becomes null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShadowResult {
    /// Name of the method.
    pub method: String,
    /// What a texel keeps, and what the method needs.
    #[serde(flatten)]
    pub capabilities: Capabilities,
    /// How the map was looked up.
    pub filter: Filter,
    /// Points on surfaces and particles.
    pub surface_points: u64,
    /// Mean squared error of T there; NaN where one is not finite.
    pub surface_transmittance_mse: f64,
    /// Greatest error there.
    pub surface_worst_error: f64,
    /// Points of the floor.
    pub floor_points: u64,
    /// Mean squared error of T there.
    pub floor_transmittance_mse: f64,
    /// Greatest error there.
    pub floor_worst_error: f64,
}

/// How far the light is moved back before methods see depths, in extents of the depths that it sees: there a logarithm
/// of depth is linear, to a quarter of a per cent of the range.
///
/// # Source
/// MKKP18 Sec. 6: depths of shadow maps are linear.
const MOVED_BACK: f32 = 100.0;

/// Fragments that one list of queries may hold.
const MAX_FRAGMENTS: usize = 1 << 22;

/// Transmittance towards the light of each receiver, as a method has it.
///
/// A receiver asks as a fragment of opacity 0 among those of its texel. Filtered, it stands among the fragments of all
/// texels under the filter, each with its absorbance times its weight: sums of absorbance, moments and coefficients are
/// then the filtered ones. Number and range of fragments are no such sums; a method that looks at them should ask
/// unfiltered. Depths are linear, as those of a light that stands far away.
///
/// # Errors
/// [`MethodError`] where the method cannot be applied to a texel.
pub fn transmittances(
    map: &FragmentList,
    receivers: &[Receiver],
    filter: Filter,
    method: &dyn Method,
) -> Result<Vec<f64>, MethodError> {
    let depths = receivers.iter().map(|r| r.view_z).chain(map.view_z().iter().copied());
    let (least, greatest) = depths.fold((f32::INFINITY, 0.0f32), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let back = if least < greatest {
        MOVED_BACK * (greatest - least)
    } else {
        0.0
    };
    let context = Context {
        depth_range: (least <= greatest).then_some((least + back, greatest + back)),
        ..Context::default()
    };
    let mut found = Vec::with_capacity(receivers.len());
    let mut rest = receivers;
    while !rest.is_empty() {
        let (list, taken) = queries(map, rest, filter, back);
        let weights = oit::weights(&list, &*method.accumulate(&list, context)?);
        found.extend(list.offsets()[1..].iter().map(|&end| weights[end as usize - 1]));
        rest = &rest[taken..];
    }
    Ok(found)
}

/// A pixel a receiver, the query its last fragment, all depths greater by `back`; and how many receivers the list has
/// room for.
fn queries(map: &FragmentList, receivers: &[Receiver], filter: Filter, back: f32) -> (FragmentList, usize) {
    let (mut offsets, mut view_z, mut alpha) = (vec![0], Vec::new(), Vec::new());
    let mut taken = 0;
    for receiver in receivers {
        match filter {
            Filter::Nearest => {
                let pixel = map.pixel(texel(map, receiver.texel.0.floor(), receiver.texel.1.floor()).unwrap_or(0));
                view_z.extend(pixel.view_z.iter().map(|v| v + back));
                alpha.extend_from_slice(pixel.alpha);
            }
            Filter::Gaussian9x9 => {
                for (p, weight) in filtered(map, receiver.texel) {
                    let pixel = map.pixel(p);
                    view_z.extend(pixel.view_z.iter().map(|v| v + back));
                    alpha.extend(
                        pixel
                            .alpha
                            .iter()
                            .map(|&a| -libm::expm1(-weight * absorbance(a)) as f32),
                    );
                }
            }
        }
        view_z.push(receiver.view_z + back);
        alpha.push(0.0);
        offsets.push(view_z.len() as u64);
        taken += 1;
        if view_z.len() > MAX_FRAGMENTS {
            break;
        }
    }
    let list = FragmentList::new(offsets, view_z, alpha, None).expect("fragments of a valid map");
    (list, taken)
}

/// Index of a texel; none outside of the map.
fn texel(map: &FragmentList, x: f64, y: f64) -> Option<usize> {
    let (width, height) = map.size()?;
    let inside = (0.0..f64::from(width)).contains(&x) && (0.0..f64::from(height)).contains(&y);
    inside.then_some(y as usize * width as usize + x as usize)
}

/// Weight of a texel under the filter, at a distance from its middle \[texels\].
fn gaussian(distance: f64) -> f64 {
    if distance.abs() > 4.5 {
        return 0.0;
    }
    const SIGMA: f64 = 1.5;
    let sum: f64 = (-4..=4).map(|k| bell(f64::from(k) / SIGMA)).sum();
    bell(distance.round() / SIGMA) / sum
}

fn bell(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

/// Texels under the filter and their weights, which add up to 1 where none lies outside of the map.
fn filtered(map: &FragmentList, (x, y): (f64, f64)) -> Vec<(usize, f64)> {
    let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
    let (u, v) = (x - 0.5 - left, y - 0.5 - top);
    // Interpolated between the filtered texels at `left` and at `left + 1`.
    let weight = |k: f64, share: f64| (1.0 - share) * gaussian(k) + share * gaussian(k - 1.0);
    let mut texels = Vec::with_capacity(100);
    for j in -4..=5 {
        for i in -4..=5 {
            let (i, j) = (f64::from(i), f64::from(j));
            let w = weight(i, u) * weight(j, v);
            if let Some(p) = texel(map, left + i, top + j).filter(|_| w > 0.0) {
                texels.push((p, w));
            }
        }
    }
    texels
}

/// A method's answers on the floor and its errors.
#[derive(Debug, Clone)]
pub struct ShadowJudged {
    /// The numbers.
    pub result: ShadowResult,
    /// Transmittance of the floor's points, those outside of the light's view left out.
    pub floor: Vec<f64>,
}

/// Judges a method by the rays of a scene.
///
/// # Errors
/// [`MethodError`].
pub fn judge(shadowed: &Shadowed, filter: Filter, method: &dyn Method) -> Result<ShadowJudged, MethodError> {
    let of = |receivers: &[Receiver]| -> Result<(Vec<f64>, AbsoluteError), MethodError> {
        let found = transmittances(&shadowed.map, receivers, filter, method)?;
        let exact: Vec<f64> = receivers.iter().map(|r| r.transmittance).collect();
        let error = AbsoluteError::of(&found, &exact);
        Ok((found, error))
    };
    let floor: Vec<Receiver> = shadowed.floor.iter().flatten().copied().collect();
    let (_, on_surfaces) = of(&shadowed.on_surfaces)?;
    let (floor, on_floor) = of(&floor)?;
    Ok(ShadowJudged {
        result: ShadowResult {
            method: method.name(),
            capabilities: method.capabilities(),
            filter,
            surface_points: on_surfaces.count(),
            surface_transmittance_mse: on_surfaces.mse(),
            surface_worst_error: on_surfaces.worst(),
            floor_points: on_floor.count(),
            floor_transmittance_mse: on_floor.mse(),
            floor_worst_error: on_floor.worst(),
        },
        floor,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::scene::{Options, open, shadow::ShadowOptions};

    /// Weights of the filter add up to 1 wherever between texels; half way between two both weigh the same.
    #[test]
    fn the_filter_keeps_what_it_spreads() {
        let map = FragmentList::new(vec![0; 32 * 32 + 1], vec![], vec![], None).unwrap();
        let map = map.with_size(32, 32).unwrap();
        for at in [(16.5, 16.5), (16.0, 12.25), (15.9, 17.1)] {
            let weights: Vec<f64> = filtered(&map, at).into_iter().map(|(_, w)| w).collect();
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{at:?}");
        }
        assert_eq!(filtered(&map, (16.5, 16.5)).len(), 81);
        assert!(filtered(&map, (0.5, 0.5)).len() < 81);
    }

    /// One pane of alpha 1/2 at depth 2 shades what lies behind it by 1/2 and nothing in front, filtered or not; the
    /// control asks in front.
    #[test]
    fn one_pane_by_hand() {
        let n = 32usize * 32;
        let map = FragmentList::new((0..=n as u64).collect(), vec![2.0; n], vec![0.5; n], None).unwrap();
        let map = map.with_size(32, 32).unwrap();
        let at = |view_z| Receiver {
            texel: (16.2, 15.7),
            view_z,
            transmittance: f64::NAN,
        };
        let method = parse("moment-power-4").unwrap();
        for (filter, tolerance) in [(Filter::Nearest, 0.01), (Filter::Gaussian9x9, 0.01)] {
            let found = transmittances(&map, &[at(3.0), at(1.0)], filter, &*method).unwrap();
            assert!(
                (found[0] - 0.5).abs() < tolerance && (found[1] - 1.0).abs() < tolerance,
                "{found:?}"
            );
        }
    }

    /// Depths that methods see are linear: the middle of the range lies in the middle of a logarithmic warp to 1 %, and
    /// order stays. Control: where the light is not moved back it does not.
    #[test]
    fn depths_are_linear() {
        let map = FragmentList::new(vec![0, 3], vec![2.0, 6.0, 4.0], vec![0.5; 3], None).unwrap();
        let map = map.with_size(1, 1).unwrap();
        let receiver = Receiver {
            texel: (0.5, 0.5),
            view_z: 5.0,
            transmittance: f64::NAN,
        };
        let middle = |back: f32| {
            let (list, _) = queries(&map, &[receiver], Filter::Nearest, back);
            let v: Vec<f64> = list.view_z().iter().map(|&v| v.into()).collect();
            assert!(v[0] < v[2] && v[2] < v[3] && v[3] < v[1]);
            (v[2] / v[0]).ln() / (v[1] / v[0]).ln()
        };
        assert!((middle(MOVED_BACK * 4.0) - 0.5).abs() < 0.01);
        assert!((middle(0.0) - 0.5).abs() > 0.1);
    }

    /// The A-buffer, asked at the texel, is as near to the rays as the map's resolution allows: nearer than Fourier
    /// opacity maps, and a finer map is nearer.
    #[test]
    fn methods_are_judged_by_rays() {
        let shadowed = |map_size| {
            let options = Options {
                size: Some((48, 48)),
                seed: None,
            };
            let shadow = ShadowOptions {
                map_size,
                on_surfaces: 400,
                floor_size: 16,
            };
            open("spheres").unwrap().shadowed(&options, &shadow).unwrap()
        };
        let mse = |shadowed: &Shadowed, name: &str| {
            let judged = judge(shadowed, Filter::Nearest, &*parse(name).unwrap()).unwrap();
            assert_eq!(judged.floor.len() as u64, judged.result.floor_points);
            judged.result.surface_transmittance_mse
        };
        let (coarse, fine) = (shadowed(64), shadowed(512));
        let exact = mse(&fine, "abuffer");
        assert!(
            exact < mse(&coarse, "abuffer") && exact < 0.5 * mse(&fine, "fourier-opacity:3"),
            "{exact:e}"
        );
    }
}
