//! Shader source of the recentred features: the formulas of [`formulas`](super::formulas) and [`visible`] as functions,
//! and the branches around them.

use super::formulas::{
    ALONE, Others, Pass2, absorbance, half_range, is_thin, moment_depth, others, place_in_thin, share_of_three,
    transmittance,
};
use super::{Rounding, columns};
use crate::features::SHARE;
use crate::features::visible::{self, FAINT, HIDDEN};
use crate::numeric::real::{Real, c};
use crate::numeric::source::{Expression, Source, Type};

/// Constant of what storage does to moments.
pub const ROUNDING: &str = "NMT_ROUNDING";

/// Greatest b0 of a pixel whose fragments are answered without the network.
pub const FAINT_SWITCH: &str = "NMT_FAINT";

/// Greatest weight of all hidden fragments of a pixel.
pub const HIDDEN_SWITCH: &str = "NMT_HIDDEN";

/// Names of the parameters of pass 2 in order, before the moments `b`: the fragment's own data, and what pass 1 left.
pub const PASS2_PARAMETERS: [&str; 9] = [
    "v",
    "z",
    "absorbance",
    "nearest",
    "farthest",
    "z_nearest",
    "z_farthest",
    "n",
    "b0",
];

/// What `nmt_hidden_weight` must know of these.
const WEIGHED: [&str; 6] = ["z", "absorbance", "z_nearest", "z_farthest", "n", "b0"];

fn parameters<'a>(names: &[&'a str], k: usize) -> Vec<(&'a str, Type)> {
    let numbers = names.iter().map(|&name| (name, Type::Real));
    numbers.chain([("b", Type::Reals(k))]).collect()
}

fn rounding(source: &Source) -> Rounding<Expression<'_>> {
    Rounding {
        unit: source.real(ROUNDING),
        every_addition: true,
    }
}

/// The parameters of a function of pass 2 as numbers.
fn pass2<const K: usize>(source: &Source) -> Pass2<Expression<'_>, K> {
    let [z, absorbance, z_nearest, z_farthest, n, b0] = WEIGHED.map(|name| source.real(name));
    let [centre, half_range] = half_range([z_nearest, z_farthest]);
    Pass2 {
        z,
        absorbance,
        b0,
        b: source.reals("b"),
        n,
        centre,
        half_range,
    }
}

/// Place of the fragment, by view depth in thin pixels.
fn position<'s, const K: usize>(source: &'s Source, others: &Others<Expression<'s>, K>) -> Expression<'s> {
    let [v, nearest, farthest] = ["v", "nearest", "farthest"].map(|name| source.real(name));
    let thin = place_in_thin(v, nearest, farthest);
    Expression::select(is_thin(nearest, farthest), thin, others.along).named("x")
}

/// Functions of pass 1, and the features of pass 2.
pub fn write_features<const K: usize>(source: &Source) {
    absorbance(source.real("alpha"));
    moment_depth(source.real("v"), ["v0", "v1"].map(|name| source.real(name)));
    let about = "Rounding of a stored moment, as a share of b0: of f32 sums 2^-23, of f16 sums 2^-10.";
    source.constant(ROUNDING, about, f32::EPSILON);
    let width = columns(K).len();
    let about = format!(
        "Pass 2: what is known of a fragment at view depth v and moment depth z, from what pass 1 left in its pixel: \
         nearest and farthest view depth as f32, their moment depths, number of fragments n, total absorbance b0 and \
         moments b1..b{K}. The result holds the {width} features, then T where it is known without the network, else \
         -1. No branch is taken."
    );
    let list = parameters(&PASS2_PARAMETERS, K);
    source.begin_function("nmt_recentred", &about, &list, Type::Reals(width + 1));
    let p = pass2::<K>(source);
    let absorbance = others(p.b0, p.absorbance).named("others");
    let others = Others::new(&p, absorbance);
    let rounded = others.rounded(&p, rounding(source));
    let mean = rounded.mean();
    let x = position(source, &others);
    let description = rounded.describe(mean);
    let front4 = absorbance * description.share_of_four(x);
    let front3 = absorbance * share_of_three(mean);
    source
        .comment("Optical depth in front where it is known: the exact rules, then the closed forms of three and four.");
    let front = source.variable("front", absorbance.like(-1.0));
    let [v, nearest, farthest] = ["v", "nearest", "farthest"].map(|name| source.real(name));
    let not = |value: f64| absorbance.like(value);
    for (condition, yes) in [
        (p.n.eq(c(4.0)), front4),
        (p.n.eq(c(3.0)), front3),
        (v.eq(farthest), absorbance),
    ] {
        source.assign(front, Expression::select(condition, yes, front));
    }
    source.assign(
        front,
        Expression::select(absorbance.gt(c(ALONE) * p.b0), front, not(0.0)),
    );
    source.assign(front, Expression::select(v.eq(nearest), not(0.0), front));
    let known = Expression::select(front.ge(c(0.0)), transmittance(front), not(-1.0)).named("known");
    let first = rounded.first_columns(x);
    let row: Vec<_> = first
        .into_iter()
        .chain(rounded.columns(&description))
        .chain([known])
        .collect();
    source.return_numbers(&row);
}

/// The functions that a renderer calls in pass 2, behind the network.
pub fn write_answers<const K: usize>(source: &Source) {
    fragment_transmittance::<K>(source);
    visible_transmittance::<K>(source);
}

/// Known answers where there are, the network where there are none.
fn fragment_transmittance<const K: usize>(source: &Source) {
    let about = "Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is \
                 known without the network branches around the features and the network, so that groups of threads in \
                 which all is known skip them.";
    let list = parameters(&PASS2_PARAMETERS, K);
    source.begin_function("nmt_fragment_transmittance", about, &list, Type::Real);
    let [v, nearest, farthest, b0] = ["v", "nearest", "farthest", "b0"].map(|name| source.real(name));
    let absorbance = others(b0, source.real("absorbance")).named("others");
    let front = source.variable("front", absorbance.like(0.0));
    // One condition a line: short-circuit operators would branch too.
    source.begin_if(v.ne(nearest));
    source.begin_if(absorbance.gt(c(ALONE) * b0));
    source.assign(front, absorbance);
    source.begin_if(v.ne(farthest));
    let p = pass2::<K>(source);
    let others = Others::new(&p, absorbance);
    let rounded = others.rounded(&p, rounding(source));
    let mean = rounded.mean();
    source.assign(front, absorbance * share_of_three(mean));
    source.begin_if(p.n.ne(c(3.0)));
    let x = position(source, &others);
    let description = rounded.describe(mean);
    source.assign(front, absorbance * description.share_of_four(x));
    source.begin_if(p.n.ne(c(4.0)));
    let first = rounded.first_columns(x);
    let row: Vec<_> = first.into_iter().chain(rounded.columns(&description)).collect();
    let share = source.call(SHARE, &[source.numbers(&row)]);
    source.assign(front, absorbance * share);
    source.end_all_ifs();
    // However coarse the exponential, no answer is above 1.
    source.return_value(transmittance(front));
}

/// The network for what can be seen.
fn visible_transmittance<const K: usize>(source: &Source) {
    source.between(
        "\n// What cannot be seen needs no network. Two switches, each by itself; 0 turns one off. Colours are taken \
            to lie in\n\
         // [0, 1].\n",
    );
    let about = "Pixels with b0 up to this are faint: no answer changes a channel by more than 1.923e-3, less than \
                 half a display step of 1/256.";
    source.constant(FAINT_SWITCH, about, FAINT);
    let about = "Fragments that are hidden weigh no more than this, all of a pixel together: answered like the \
                 farthest, they change no channel by more than twice as much against exact answers of theirs, where \
                 the weights of the pixel (opacity times answer, what pass 2 adds up) sum to a half or more. Exact \
                 answers sum to 0.99 where one looks; a network's do not have to.";
    source.constant(HIDDEN_SWITCH, about, HIDDEN);
    let b: [_; K] = source.reals("b");
    visible::first_hidden_depth(source.real("b0"), b[0], b[1]);
    hidden_weight::<K>(source);

    let about = "Pass 2, with the network for what can be seen: parameters and answers as of \
                 nmt_fragment_transmittance, but for faint pixels and hidden fragments. Pixels of up to four fragments \
                 have forms of their own.";
    source.begin_function(
        "nmt_visible_transmittance",
        about,
        &parameters(&PASS2_PARAMETERS, K),
        Type::Real,
    );
    let [v, z, nearest, farthest, n, b0] = ["v", "z", "nearest", "farthest", "n", "b0"].map(|name| source.real(name));
    let [faint, hidden] = [FAINT_SWITCH, HIDDEN_SWITCH].map(|name| source.real(name));
    let absorbance = others(b0, source.real("absorbance")).named("others");
    let front = source.variable("front", absorbance.like(-1.0));
    for condition in [
        n.gt(c(4.0)),
        v.ne(nearest),
        v.ne(farthest),
        absorbance.gt(c(ALONE) * b0),
    ] {
        source.begin_if(condition);
    }
    source.begin_if(b0.le(faint));
    source.assign(front, c(0.5) * absorbance);
    source.end_if();
    source.begin_if(hidden.gt(c(0.0)));
    source.begin_if(z.ge(visible::first_hidden_depth(b0, b[0], b[1])));
    let whole = |names: &[&str]| -> Vec<_> { names.iter().chain(&["b"]).map(|name| source.whole(name)).collect() };
    source.begin_if(source.call("nmt_hidden_weight", &whole(&WEIGHED)).le(hidden));
    source.assign(front, absorbance);
    source.end_all_ifs();
    let answer = source.variable("answer", transmittance(front));
    source.begin_if(front.lt(c(0.0)));
    source.assign(
        answer,
        source.call("nmt_fragment_transmittance", &whole(&PASS2_PARAMETERS)),
    );
    source.end_if();
    source.return_value(answer);
}

fn hidden_weight<const K: usize>(source: &Source) {
    let about = "The most that a fragment and all behind it weigh, opacity times transmittance, whatever has these \
                 moments. Polynomials that are 0 or more in the pixel and 1 or more from the fragment on bound the \
                 share that lies there, rounding included.";
    source.begin_function("nmt_hidden_weight", about, &parameters(&WEIGHED, K), Type::Real);
    let p = pass2::<K>(source);
    let absorbance = others(p.b0, p.absorbance).named("others");
    let others = Others::new(&p, absorbance);
    let unit = source.real(ROUNDING);
    let noise = visible::Noise::of(p.n, p.b0, absorbance, others.half_range, others.noise_growth, unit);
    let m = std::array::from_fn(|k| others.m[k]);
    let behind = visible::most_behind(others.along, m, &noise);
    source.return_value(visible::hidden_weight(absorbance, p.absorbance, p.n, behind, &noise));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::dialect::{Glsl, Hlsl, Wgsl};
    use crate::numeric::source::Dialect;

    /// Whatever is used twice has a name, and no line is over 120 columns. Control: the writer tells of what has none.
    #[test]
    fn nothing_is_written_twice() {
        fn check<const K: usize>(dialect: &'static dyn Dialect) {
            let source = Source::new(dialect, "nmt");
            write_features::<K>(&source);
            write_answers::<K>(&source);
            assert_eq!(source.repeated(), Vec::<String>::new());
            let text = source.into_text();
            let long: Vec<&str> = text.lines().filter(|line| line.chars().count() > 120).collect();
            assert!(long.is_empty() && text.lines().count() > 150, "{long:?}");
        }
        for dialect in [&Wgsl as &'static dyn Dialect, &Glsl, &Hlsl] {
            check::<4>(dialect);
            check::<6>(dialect);
            check::<8>(dialect);
        }
        let source = Source::new(&Wgsl, "nmt");
        let unnamed = source.real("x").exp();
        assert!((!format!("{:?}", unnamed * unnamed).is_empty()) && source.repeated() == ["exp(x)"]);
    }
}
