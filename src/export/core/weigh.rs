//! Pass 2 of a core whose tail a beta law or a network shares out, as shader source.
//!
//! The formulas are those of [`crate::features::core::formulas`], written out by the expressions of [`Source`]; only
//! the slots are unpacked by text.

use super::{dialect, piece, vectors};
use crate::export::Target;
use crate::export::shader::ENTRY;
use crate::features::core::CoreSet;
use crate::features::core::formulas::{
    absorbance_of, allowed, bounds, bounds_noise, described, fixed_features, normalised, place_noise, recentred,
    share_by_law, share_of_one, share_of_two, transmittance, without,
};
use crate::model::Mlp;
use crate::numeric::real::{Constant, Real, c};
use crate::numeric::source::{Expression, Source, Type};

/// Lanes of a vector.
pub(super) const LANES: [&str; 4] = ["x", "y", "z", "w"];

/// Most moments of a core in shaders: those of a vector.
pub const MAX_SHADER_MOMENTS: usize = 4;

/// Fragments of the tail that are exact beside the fragment itself, and half of one more.
const fn exact_tail(moments: usize) -> f64 {
    if moments >= 3 { 2.5 } else { 1.5 }
}

/// Pixels of up to so many fragments that absorb need no network: the core holds all but one, or but two.
pub fn known_fragments(set: CoreSet) -> usize {
    set.slots() + exact_tail(set.moments) as usize
}

/// Who shares out a tail of which nothing is known.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tail {
    Law,
    /// The exported network, where the bounds leave more than so much of T open.
    Network {
        open: f32,
    },
}

/// `nmt_core_transmittance` of a core whose tail is a beta law, and what it calls, which stand behind the codes.
///
/// # Panics
/// If there are more than [`MAX_SHADER_MOMENTS`] moments.
pub fn weigh(set: CoreSet, language: Target) -> String {
    whole(set, language, Tail::Law)
}

/// `nmt_core_transmittance` of a core whose tail a network shares out, and what it calls, which stand behind the codes
/// and the network's export. [`OPEN_SWITCH`] is `open`.
///
/// # Panics
/// If there are more than [`MAX_SHADER_MOMENTS`] moments.
pub fn weigh_by_network(set: CoreSet, language: Target, open: f32) -> String {
    whole(set, language, Tail::Network { open })
}

fn whole(set: CoreSet, language: Target, tail: Tail) -> String {
    assert!(set.moments <= MAX_SHADER_MOMENTS, "{set:?}");
    let law = match set.moments {
        1 => on_numbers::<2>(set, language, tail),
        2 => on_numbers::<3>(set, language, tail),
        3 => on_numbers::<4>(set, language, tail),
        _ => on_numbers::<5>(set, language, tail),
    };
    let text = piece(language, include_str!("weigh.wgsl"), include_str!("weigh.glsl"));
    let vectors = vectors(set);
    let dialect = dialect(language);
    let parameter = |of: Type, name: &str| dialect.parameter(&dialect.type_name(of), name);
    let mut parameters = vec![parameter(Type::Word2, "steps"), dialect.parameter("NmtCodes", "codes")];
    parameters.extend((0..vectors).map(|i| parameter(Type::Word4, &format!("core{i}"))));
    parameters.extend(["n", "b0"].map(|name| parameter(Type::Real, name)));
    parameters.push(parameter(Type::Vec4, "moments"));
    let unpack = (0..set.slots()).map(|place| {
        let code = format!("core{}.{}", place / 4, LANES[place % 4]);
        let steps = match place {
            0 => format!("nmt_core_nearest_steps({code})"),
            1 => format!("nmt_core_farthest_steps({code})"),
            _ => format!("nmt_core_heavy_steps({code}, codes)"),
        };
        let value = format!("nmt_core_slot({code}, {steps})");
        format!("    {}", dialect.let_(Type::Reals(2), &format!("slot{place}"), &value))
    });
    let gathered = |i: usize, lane: &str| {
        let item = |place: usize| match place < set.slots() {
            true => format!("slot{place}.{lane}"),
            false => "0.0".to_owned(),
        };
        let items: Vec<String> = (4 * i..4 * i + 4).map(item).collect();
        format!("{}({})", dialect.type_name(Type::Vec4), items.join(", "))
    };
    let mut arguments = vec![
        "nmt_core_depth(steps)".to_owned(),
        "nmt_core_absorbance(steps)".to_owned(),
    ];
    for i in 0..vectors {
        arguments.extend([gathered(i, "x"), gathered(i, "y")]);
    }
    arguments.extend(["n", "b0", "moments"].map(str::to_owned));
    let text = text
        .replace("CORE_PARAMETERS", &format!("\n    {}\n", parameters.join(",\n    ")))
        .replace("CORE_UNPACK", &unpack.collect::<Vec<_>>().join("\n"))
        .replace(
            "CORE_ARGUMENTS",
            &format!("\n        {}\n    ", arguments.join(",\n        ")),
        );
    law + &text
}

/// A fragment as its steps have it; of an empty slot, the absorbance is 0.
#[derive(Debug, Clone, Copy)]
pub struct Entry<R> {
    /// Moment depth.
    pub z: R,
    /// Absorbance.
    pub absorbance: R,
}

/// A fragment between its pixel's sums and its transmittance, without branches: pass 2 of
/// [`pixel`](crate::features::core::pixel).
struct Query<R: Real, const N: usize> {
    /// Absorbance of the core in front.
    front: R,
    /// Absorbance of the tail.
    tail: R,
    /// Moments of the tail, the first 1.
    m: [R; N],
    /// The fragment's place in the pixel's range.
    x: R,
    /// Fragments of the tail.
    count: R,
    /// Absorbance of the pixel.
    total: R,
    /// Middle of its range, and one over half of it.
    range: [R; 2],
    /// The share of the tail in front where exact rules say it.
    exact: R,
    /// Whether they do.
    is_exact: R::Mask,
}

impl<R: Real, const N: usize> Query<R, N> {
    /// What a network is asked, in the order of the feature set's columns.
    fn features(&self) -> Vec<R> {
        self.row(bounds(self.x, self.m).share, described(self.m))
    }

    /// The same from the bounds and the description of the tail.
    fn row(&self, bounds: [R; 2], described: [R; N]) -> Vec<R> {
        let fixed = fixed_features(self.x, self.count, self.tail, bounds);
        fixed.into_iter().chain(described.into_iter().skip(1)).collect()
    }
}

/// Takes the core and the fragment itself out of its pixel's sums.
#[inline(always)]
fn query<R: Real, const N: usize>(own: Entry<R>, core: &[Entry<R>], n: R, b: [R; N], depth_bits: u32) -> Query<R, N> {
    let (zero, one) = (own.z.like(0.0), own.z.like(1.0));
    let name = |stem: &str, values: [R; N]| {
        let mut k = 0;
        values.map(|value| {
            k += 1;
            value.named_at(stem, k - 1)
        })
    };
    // Out with the core.
    let (mut front, mut in_core, mut count, mut rest) = (zero, zero, n, b);
    for entry in core {
        front = (front + R::select(entry.z.lt(own.z), entry.absorbance, zero)).named("front");
        let is_own = entry.z.eq(own.z) & entry.absorbance.eq(own.absorbance);
        in_core = R::select(is_own, one, in_core).named("in_core");
        count = (count - R::select(entry.absorbance.gt(c(0.0)), one, zero)).named("count");
        rest = name("rest", without(rest, entry.absorbance, entry.z));
    }
    // To the pixel's own range.
    let step = 2.0 / f64::from(1u32 << depth_bits);
    let near = core[0].z;
    let far = R::select(core[1].absorbance.gt(c(0.0)), core[1].z, near).named("far");
    let center = (c(0.5) * (near + far)).named("center");
    let half = (c(0.5) * (far - near)).max(c(0.5 * step)).named("half_range");
    let per_h = (c(1.0) / half).named("per_h");
    let rest = name("moved", recentred(rest, center, per_h));
    // Out with the fragment itself.
    let x = ((own.z - center) * per_h).clamp(c(-1.0), c(1.0)).named("x");
    let removed = R::select(in_core.eq(c(0.0)), own.absorbance, zero).named("removed");
    let tail = name("tail", without(rest, removed, x));
    let count = (count - R::select(removed.gt(c(0.0)), one, zero)).named("others");
    let absorbance = absorbance_of(tail).named("absorbance_of_tail");
    let m = name("m", normalised(tail));
    // What has a closed form.
    let own_step = (per_h * Constant(step)).named("own_step");
    let noise = place_noise(b[0], absorbance, center, per_h).named("noise");
    let mut exact = share_of_one(x, m[1], own_step, noise).named("exact");
    if N > 3 {
        let two = share_of_two(x, [m[1], m[2], m[3.min(N - 1)]], own_step, noise);
        exact = R::select(count.gt(c(1.5)), two, exact).named("exact");
    }
    let behind_all = own.z.ge(far);
    let before_all = count.lt(c(0.5)) | own.z.le(near);
    exact = R::select(behind_all, one, exact).named("exact");
    exact = R::select(before_all, zero, exact).named("exact");
    Query {
        front,
        tail: absorbance,
        m,
        x,
        count,
        total: b[0],
        range: [center, per_h],
        exact,
        is_exact: count.lt(c(exact_tail(N - 1))) | own.z.ge(far) | own.z.le(near),
    }
}

/// Transmittance in front of a fragment: the beta law shares the tail out where nothing is known of it.
///
/// # Shapes
/// `core` begins with the nearest and the farthest fragment; `n` counts the fragments of the pixel that absorb, `b`
/// holds b_0..b_M.
#[inline(always)]
pub fn weigh_by_law<R: Real, const N: usize>(own: Entry<R>, core: &[Entry<R>], n: R, b: [R; N], depth_bits: u32) -> R {
    let q = query(own, core, n, b, depth_bits);
    let spread = if N > 2 {
        described(q.m)[2].named("spread")
    } else {
        own.z.like(1.0 / 3.0)
    };
    let law = share_by_law(q.x, q.m[1], spread).named("law");
    let share = R::select(q.is_exact, q.exact, law).named("share");
    transmittance(q.front, q.tail, share)
}

/// [`weigh_by_law`] with a network in the law's place.
///
/// # Shapes
/// As [`weigh_by_law`]; the network's feature set has a core and N − 1 moments.
pub fn weigh_by_mlp<const N: usize>(
    own: Entry<f32>,
    core: &[Entry<f32>],
    n: f32,
    b: [f32; N],
    depth_bits: u32,
    mlp: &Mlp,
) -> f32 {
    let q = query(own, core, n, b, depth_bits);
    match q.is_exact {
        true => transmittance(q.front, q.tail, q.exact),
        false => (-q.front).exp() * mlp.forward::<f32>(&q.features()),
    }
}

/// `nmt_core_weigh`: the formulas on numbers.
fn on_numbers<const N: usize>(set: CoreSet, language: Target, tail: Tail) -> String {
    let vectors = vectors(set);
    let names: Vec<[String; 2]> = (0..vectors)
        .map(|i| [format!("depths{i}"), format!("absorbances{i}")])
        .collect();
    let mut parameters = vec![("z", Type::Real), ("absorbance", Type::Real)];
    parameters.extend(names.iter().flatten().map(|name| (&name[..], Type::Vec4)));
    parameters.extend([("n", Type::Real), ("b0", Type::Real), ("moments", Type::Vec4)]);
    let source = Source::new(dialect(language), "nmt_core");
    if let Tail::Network { open } = tail {
        let about = "Where the moments of the tail leave what the fragment adds to the image open by no more than \
                     this, T is the middle of what they allow, and the network is not asked. 0 always asks it; 1/512 \
                     cannot be seen.";
        source.constant(OPEN_SWITCH, about, open);
    }
    source.begin_function(
        "nmt_core_weigh",
        "Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), \
         from the depths and absorbances of the core's fragments and sums over all.",
        &parameters,
        Type::Real,
    );
    let core: Vec<_> = (0..set.slots())
        .map(|place| Entry {
            z: source.vec4(&names[place / 4][0])[place % 4],
            absorbance: source.vec4(&names[place / 4][1])[place % 4],
        })
        .collect();
    let own = Entry {
        z: source.real("z"),
        absorbance: source.real("absorbance"),
    };
    let moments = source.vec4("moments");
    let b = std::array::from_fn::<_, N, _>(|k| if k == 0 { source.real("b0") } else { moments[k - 1] });
    let (n, bits) = (source.real("n"), set.layout.depth_bits);
    match tail {
        Tail::Law => source.return_value(weigh_by_law(own, &core, n, b, bits)),
        Tail::Network { .. } => ask_network(&source, own, query(own, &core, n, b, bits)),
    }
    source.into_text()
}

/// By how much the bounds may leave T open where a network is spared.
pub const OPEN_SWITCH: &str = "NMT_OPEN";

/// Ends a function: exact rules, and the exported network where there are none. It answers with e^−(tail in front).
fn ask_network<'s, const N: usize>(source: &'s Source, own: Entry<Expression<'s>>, q: Query<Expression<'s>, N>) {
    source.begin_if(q.is_exact);
    transmittance(q.front, q.tail, q.exact).named("known");
    source.statement("return known;");
    source.end_if();
    let bounds = bounds(q.x, q.m);
    let open = source.real(OPEN_SWITCH);
    source.begin_if(open.gt(c(0.0)));
    let noise = bounds_noise::<_, N>(q.total, q.tail, q.range, bounds.gain).named("bounds_noise");
    let [most, least] = allowed(q.front, q.tail, bounds.share, noise);
    let (most, least) = (most.named("most"), least.named("least"));
    let opacity = (c(1.0) - (-own.absorbance).exp()).named("opacity");
    source.begin_if((opacity * (most - least)).le(open));
    (c(0.5) * (most + least)).named("middle");
    source.statement("return middle;");
    source.end_if();
    source.end_if();
    let row = source.numbers(&q.row(bounds.share, described(q.m)));
    let answer = source.call(ENTRY, &[row]);
    source.return_value((-q.front).exp() * answer);
}
