//! What a fragment list holds: histograms, and how many fragments each rule answers.

use super::{ProfileError, Scene};
use crate::chart::histogram::{self, Panel};
use crate::features::{Extractor, FeatureSet};
use crate::infer::{Class, Passes, Skip};
use crate::pixel::{FragmentList, ViewZ, absorbance, abuffer};
use serde::Serialize;

/// Sides of a tile that an indirect dispatch would take or leave \[pixels\].
pub const TILE: u32 = 8;

/// Absorbance of a fragment that is as good as opaque: e^−7 = 0.0009 passes.
const OPAQUE: f64 = 7.0;

/// Transmittance below which a fragment cannot be seen, whatever its colour.
const UNSEEN: f64 = 1.0 / 1024.0;

/// How often a quantity fell between two edges.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Histogram {
    /// What was counted.
    pub quantity: &'static str,
    /// Its unit, and what each count is of.
    pub of: &'static str,
    /// Ascending; bin i holds what is at least `edges[i]` and less than `edges[i + 1]`, the last bin its end too.
    pub edges: Vec<f64>,
    /// One less than there are edges.
    pub counts: Vec<u64>,
    /// Where the values lie; none of nothing.
    pub quantiles: Option<Quantiles>,
}

/// Where the values of a quantity lie.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Quantiles {
    /// The least.
    pub min: f64,
    /// Five of a hundred do not exceed it.
    pub p5: f64,
    /// A quarter does not exceed it.
    pub p25: f64,
    /// Half do not exceed it.
    pub median: f64,
    /// Three quarters do not exceed it.
    pub p75: f64,
    /// Ninety-five of a hundred do not exceed it.
    pub p95: f64,
    /// The greatest.
    pub max: f64,
}

impl Histogram {
    /// Of some values; those beyond the ends are counted in the outermost bins.
    fn of(quantity: &'static str, of: &'static str, edges: Vec<f64>, mut values: Vec<f64>) -> Self {
        let bins = edges.len() - 1;
        let mut counts = vec![0; bins];
        for v in &values {
            counts[edges[1..bins].partition_point(|e| e <= v)] += 1;
        }
        values.sort_by(f64::total_cmp);
        let at = |q: f64| values[((values.len() - 1) as f64 * q).round() as usize];
        let quantiles = (!values.is_empty()).then(|| Quantiles {
            min: at(0.0),
            p5: at(0.05),
            p25: at(0.25),
            median: at(0.5),
            p75: at(0.75),
            p95: at(0.95),
            max: at(1.0),
        });
        Self {
            quantity,
            of,
            edges,
            counts,
            quantiles,
        }
    }
}

/// How a fragment is answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Alone in its pixel.
    Single,
    /// One of two.
    OneOfTwo,
    /// The nearest of three and more.
    Nearest,
    /// The farthest of three and more.
    Farthest,
    /// Nothing else in its pixel absorbs.
    Alone,
    /// The middle one of three.
    OneOfThree,
    /// One of the two in the middle of four.
    OneOfFour,
    /// Its pixel is too faint to be seen.
    Faint,
    /// What lies in front of it hides it.
    Hidden,
    /// The network answers it.
    Network,
}

impl Kind {
    /// All of them, in the order in which they are shown.
    pub const ALL: [Self; 10] = [
        Self::Single,
        Self::OneOfTwo,
        Self::Nearest,
        Self::Farthest,
        Self::Alone,
        Self::OneOfThree,
        Self::OneOfFour,
        Self::Faint,
        Self::Hidden,
        Self::Network,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "one in its pixel",
            Self::OneOfTwo => "one of two",
            Self::Nearest => "nearest",
            Self::Farthest => "farthest",
            Self::Alone => "nothing else in its pixel absorbs",
            Self::OneOfThree => "one of three",
            Self::OneOfFour => "one of four",
            Self::Faint => "of a faint pixel",
            Self::Hidden => "hidden",
            Self::Network => "the rest",
        }
    }

    /// What answers it.
    pub fn answer(self) -> &'static str {
        match self {
            Self::Single | Self::OneOfTwo | Self::Nearest | Self::Farthest | Self::Alone => "exact",
            Self::OneOfThree | Self::OneOfFour => "closed form",
            Self::Faint | Self::Hidden => "bound, under visible",
            Self::Network => "network",
        }
    }

    /// The kind of a fragment of a pixel of so many.
    fn of(count: usize, class: Class) -> Self {
        match (count, class) {
            (1, _) => Self::Single,
            (2, _) => Self::OneOfTwo,
            (_, Class::Nearest) => Self::Nearest,
            (_, Class::Farthest) => Self::Farthest,
            (_, Class::Alone) => Self::Alone,
            (_, Class::Three) => Self::OneOfThree,
            (_, Class::Four) => Self::OneOfFour,
            (_, Class::Faint) => Self::Faint,
            (_, Class::Hidden) => Self::Hidden,
            (_, Class::Known | Class::Network) => Self::Network,
        }
    }
}

/// How many fragments are of a kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Share {
    /// Which.
    #[serde(skip)]
    pub kind: Kind,
    /// Its name.
    pub class: &'static str,
    /// How it is answered.
    pub answer: &'static str,
    /// How many.
    pub fragments: u64,
    /// As a share of all.
    pub share: f64,
}

/// Tiles of an image and whether they need the network.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tiles {
    /// All of them, 8 × 8 pixels each, cut off at the right and the bottom.
    pub tiles: u64,
    /// Without a fragment.
    pub empty: u64,
    /// With fragments, none of which needs the network under `exact`.
    pub known: u64,
    /// The same under `visible`.
    pub known_or_unseen: u64,
}

impl Tiles {
    /// Share of all tiles that an indirect dispatch of the network would leave out.
    pub fn saved(&self, skip: Skip) -> f64 {
        let left_out = match skip {
            Skip::None => self.empty,
            Skip::Exact => self.empty + self.known,
            Skip::Visible => self.empty + self.known_or_unseen,
        };
        left_out as f64 / self.tiles.max(1) as f64
    }
}

/// What a list holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Facts {
    /// Pixels, empty ones too.
    pub pixels: u64,
    /// Pixels without a fragment, as a share.
    pub empty_pixels: f64,
    /// All fragments.
    pub fragments: u64,
    /// Most fragments of a pixel.
    pub depth_complexity: u64,
    /// Least and greatest view depth \[scene units\]; none of nothing.
    pub depth_range: Option<(f32, f32)>,
    /// Fragments, alpha, absorbance and depth range.
    pub histograms: Vec<Histogram>,
    /// Every fragment is of one of these.
    pub classes: Vec<Share>,
    /// Fragments strictly behind one that leaves less than e^−7, as a share.
    pub behind_opaque: f64,
    /// Fragments whose exact transmittance is below 1/1024, as a share: what no rule can exceed.
    pub unseen: f64,
    /// Where the list is an image.
    pub tiles: Option<Tiles>,
}

impl Facts {
    /// Fragments of a kind, as a share of all.
    pub fn share(&self, kind: Kind) -> f64 {
        self.classes.iter().find(|c| c.kind == kind).map_or(0.0, |c| c.share)
    }

    /// The histograms of the scene and, below them, how every fragment is answered, as an SVG file.
    pub fn drawing(&self, title: &str) -> String {
        let panel = |h: &Histogram| Panel {
            title: format!("{}, % of {}", h.quantity, h.of),
            edges: h.edges.clone(),
            counts: h.counts.clone(),
        };
        let share = |class: &Share| histogram::Share {
            label: format!("{}: {:.1} % ({})", class.class, 100.0 * class.share, class.answer),
            share: class.share,
        };
        let panels: Vec<Panel> = self.histograms.iter().map(panel).collect();
        let shares: Vec<histogram::Share> = self.classes.iter().map(share).collect();
        histogram::svg(title, &panels, "How every fragment is answered", &shares)
    }
}

/// Looks a list over.
///
/// # Errors
/// [`ProfileError::Depth`] where the range of depth is none.
pub fn facts(scene: &Scene<'_>) -> Result<Facts, ProfileError> {
    let list = scene.list;
    let extractor = Extractor::for_list(
        FeatureSet::Recentred,
        list,
        scene.context.planes,
        scene.context.depth_range,
    )?;
    let passes = Passes::of(&extractor).expect("made for recentred features");
    let (mut out, mut class) = (vec![0.0; list.len()], vec![Class::Network; list.len()]);
    passes.run(
        list,
        0..list.pixels(),
        Skip::Visible.switches(),
        || |_: &[_], out: &mut [f32]| out.fill(f32::NAN),
        &mut out,
        &mut class,
    );
    drop(out);

    let covered: Vec<usize> = (0..list.pixels()).filter(|&p| !list.range(p).is_empty()).collect();
    let histograms = histograms(scene, &covered);
    let (mut counts, mut behind_opaque) = ([0u64; 10], 0u64);
    let mut order = Vec::new();
    for &p in &covered {
        let (pixel, own) = (list.pixel(p), list.range(p));
        for &class in &class[own] {
            counts[Kind::of(pixel.len(), class) as usize] += 1;
        }
        abuffer::front_to_back(pixel, &mut order);
        let opaque = order
            .iter()
            .map(|&i| i as usize)
            .find(|&i| absorbance(pixel.alpha[i]) >= OPAQUE)
            .map(|i| pixel.view_z[i]);
        behind_opaque += opaque.map_or(0, |v| pixel.view_z.iter().filter(|&&w| w > v).count() as u64);
    }
    let share = |n: u64| n as f64 / list.len().max(1) as f64;
    let classes = Kind::ALL
        .into_iter()
        .zip(counts)
        .map(|(kind, n)| Share {
            kind,
            class: kind.name(),
            answer: kind.answer(),
            fragments: n,
            share: share(n),
        })
        .collect();
    let tiles = list.size().map(|size| tiles(list, size, &class));
    Ok(Facts {
        pixels: list.pixels() as u64,
        empty_pixels: 1.0 - covered.len() as f64 / list.pixels().max(1) as f64,
        fragments: list.len() as u64,
        depth_complexity: list.depth_complexity() as u64,
        depth_range: list.depth_range(),
        histograms,
        classes,
        behind_opaque: share(behind_opaque),
        unseen: share(scene.transmittance.iter().filter(|&&t| t < UNSEEN).count() as u64),
        tiles,
    })
}

/// Fragments, alpha, absorbance and depth range, over the pixels that hold something.
fn histograms(scene: &Scene<'_>, covered: &[usize]) -> Vec<Histogram> {
    let list = scene.list;
    let total = |p: usize| list.pixel(p).alpha.iter().map(|&a| absorbance(a)).sum::<f64>();
    let range = scene.context.depth_range.or(list.depth_range());
    let warp = range.and_then(|(a, b)| crate::pixel::LogWarp::new(ViewZ(a.into()), ViewZ(b.into())).ok());
    let half = |p: usize| {
        let (near, far) = list
            .pixel(p)
            .view_z
            .iter()
            .fold((f32::INFINITY, 0.0f32), |(a, b), &v| (a.min(v), b.max(v)));
        warp.map_or(0.0, |w| {
            0.5 * (w.moment(ViewZ(far.into())).0 - w.moment(ViewZ(near.into())).0)
        })
    };
    let several: Vec<usize> = covered.iter().copied().filter(|&p| list.range(p).len() > 1).collect();
    let decades = |from: i32, to: i32| {
        (2 * from..=2 * to)
            .map(|e| 10f64.powf(0.5 * f64::from(e)))
            .collect::<Vec<_>>()
    };
    vec![
        Histogram::of(
            "fragments",
            "covered pixels",
            vec![
                1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 9.0, 13.0, 17.0, 25.0, 33.0, 49.0, 65.0, 97.0, 129.0, 193.0, 257.0, 1e6,
            ],
            covered.iter().map(|&p| list.range(p).len() as f64).collect(),
        ),
        Histogram::of(
            "alpha",
            "fragments",
            (0..=20).map(|i| 0.05 * f64::from(i)).collect(),
            list.alpha().iter().map(|&a| a.into()).collect(),
        ),
        Histogram::of(
            "absorbance",
            "covered pixels",
            decades(-3, 3),
            covered.iter().map(|&p| total(p)).collect(),
        ),
        Histogram::of(
            "half range in moment depth",
            "pixels of two and more",
            decades(-6, 0),
            several.iter().map(|&p| half(p)).collect(),
        ),
    ]
}

/// The tiles of an image by what they need; `class` is of each fragment.
fn tiles(list: &FragmentList, (width, height): (u32, u32), class: &[Class]) -> Tiles {
    let mut tiles = Tiles {
        tiles: 0,
        empty: 0,
        known: 0,
        known_or_unseen: 0,
    };
    for (y, x) in (0..height)
        .step_by(TILE as usize)
        .flat_map(|y| (0..width).step_by(TILE as usize).map(move |x| (y, x)))
    {
        let (mut fragments, mut evaluated, mut shown) = (0, 0, 0);
        for p in (y..height.min(y + TILE))
            .flat_map(|y| (x..width.min(x + TILE)).map(move |x| y as usize * width as usize + x as usize))
        {
            let of = &class[list.range(p)];
            fragments += of.len();
            evaluated += of
                .iter()
                .filter(|c| matches!(c, Class::Network | Class::Faint | Class::Hidden))
                .count();
            shown += of.iter().filter(|c| matches!(c, Class::Network)).count();
        }
        tiles.tiles += 1;
        tiles.empty += u64::from(fragments == 0);
        tiles.known += u64::from(fragments > 0 && evaluated == 0);
        tiles.known_or_unseen += u64::from(fragments > 0 && shown == 0);
    }
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::Context;
    use crate::pixel::FragmentList;

    /// Two tiles of one row: an empty pixel, one fragment, two, three, four, and six of which four need the network.
    fn list() -> FragmentList {
        let counts = [0u64, 1, 2, 3, 4, 0, 0, 0, 6, 0];
        let offsets = counts.iter().scan(0, |sum, n| {
            *sum += n;
            Some(*sum)
        });
        let offsets: Vec<u64> = std::iter::once(0).chain(offsets).collect();
        let n = *offsets.last().unwrap() as usize;
        let view_z = (0..n).map(|i| 1.0 + 0.37 * ((i * 7) % n) as f32).collect();
        let mut alpha = vec![0.5; n];
        alpha[1] = 1.0;
        FragmentList::new(offsets, view_z, alpha, None)
            .unwrap()
            .with_size(10, 1)
            .unwrap()
    }

    #[test]
    fn every_fragment_has_one_class() {
        let list = list();
        let facts = facts(&Scene::new(&list, Context::default(), [1.0; 3])).unwrap();
        let counts: Vec<u64> = facts.classes.iter().map(|c| c.fragments).collect();
        assert_eq!(counts, [1, 2, 3, 3, 0, 1, 2, 0, 0, 4]);
        assert_eq!((facts.pixels, facts.fragments, facts.depth_complexity), (10, 16, 6));
        assert!((facts.empty_pixels - 0.5).abs() < 1e-12);
        assert!((facts.classes.iter().map(|c| c.share).sum::<f64>() - 1.0).abs() < 1e-12);
        let tiles = facts.tiles.unwrap();
        assert_eq!(
            tiles,
            Tiles {
                tiles: 2,
                empty: 0,
                known: 1,
                known_or_unseen: 1
            }
        );
        assert_eq!((tiles.saved(Skip::None), tiles.saved(Skip::Exact)), (0.0, 0.5));
        let of_fragments = &facts.histograms[0];
        assert_eq!(of_fragments.counts[..5], [1, 1, 1, 1, 1]);
        assert_eq!(of_fragments.counts.iter().sum::<u64>(), 5);
        // The opaque one of the pixel of two lies in front of the other.
        assert_eq!(
            facts.behind_opaque,
            if list.view_z()[1] < list.view_z()[2] {
                1.0 / 16.0
            } else {
                0.0
            }
        );
    }

    #[test]
    fn nothing_has_facts_too() {
        let none = FragmentList::new(vec![0], vec![], vec![], None).unwrap();
        let facts = facts(&Scene::new(&none, Context::default(), [1.0; 3])).unwrap();
        assert_eq!((facts.pixels, facts.fragments, facts.tiles), (0, 0, None));
        assert!(
            facts
                .histograms
                .iter()
                .all(|h| h.quantiles.is_none() && h.counts.iter().all(|&n| n == 0))
        );
    }

    #[test]
    fn values_on_an_edge_belong_above_it() {
        let h = Histogram::of(
            "x",
            "y",
            vec![0.0, 1.0, 2.0, 3.0],
            vec![-1.0, 0.0, 1.0, 1.5, 2.0, 3.0, 9.0],
        );
        assert_eq!(h.counts, [2, 2, 3]);
        let q = h.quantiles.unwrap();
        assert_eq!((q.min, q.median, q.max), (-1.0, 1.5, 9.0));
    }
}
