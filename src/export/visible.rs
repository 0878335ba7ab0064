//! Shader source of what cannot be seen: the twin of [`crate::features::visible`], behind the function that answers everything.

use super::recentred::{PASS2_PARAMETERS, ROUNDING, Writer, pass2_parameters, recentred_moments};
use super::shader::{Language, Numbers, Precision};
use crate::features::FeatureSet;
use crate::features::recentred::MAX_ABSORBANCE;
use crate::features::visible::{FAINT, HIDDEN, MIN_HIDING, ORDER};

/// Greatest b0 of a pixel whose fragments are answered without the network.
pub const FAINT_SWITCH: &str = "NMT_FAINT";

/// Greatest weight of all hidden fragments of a pixel.
pub const HIDDEN_SWITCH: &str = "NMT_HIDDEN";

/// The function that a renderer calls in pass 2 instead of `nmt_fragment_transmittance`, and what it asks.
pub fn source(language: Language, set: FeatureSet) -> String {
    let k = set.moments();
    let mut w = Writer::new(language);
    let numbers = Numbers {
        language,
        precision: Precision::F32,
    };
    w.line("\n// What cannot be seen needs no network. Two switches, each by itself; 0 turns one off. Colours are taken to lie in [0, 1].");
    w.line("// Pixels with b0 up to this are faint: no answer changes a channel by more than 1.923e-3, less than half a display step of 1/256.");
    w.text += &numbers.scalar_constant(FAINT_SWITCH, FAINT);
    w.line("// Fragments that are hidden weigh no more than this, all of a pixel together: answered like the farthest, they change no channel by more than twice as");
    w.line("// much against exact answers of theirs, where the weights of the pixel (opacity times answer, what pass 2 adds up) sum to a half or more. Exact answers");
    w.line("// sum to 0.99 where one looks; a network's do not have to.");
    w.text += &numbers.scalar_constant(HIDDEN_SWITCH, HIDDEN);

    let most = w.number(MAX_ABSORBANCE);
    let others = format!("clamp(b0 - absorbance, 0.0, {most})");

    w.line(
        "\n// Moment depth from which on one looks for hidden fragments in a pixel; no depth reaches it where the pixel lets too much light through.",
    );
    w.function("nmt_first_hidden_depth", &[("b0", 0), ("b1", 0), ("b2", 0)], 0);
    let least = w.number(MIN_HIDING.into());
    w.let_("excess", &format!("b0 - {least}"));
    w.let_(
        "deviation",
        &format!("sqrt({least} * max(b2 * b0 - b1 * b1, 0.0) / max(excess, 1e-6))"),
    );
    let chosen = w.select("excess > 0.0", "(b1 + deviation) / max(b0, 1e-30)", "3e38");
    w.return_value(&chosen);

    w.line("\n// The most that a fragment and all behind it weigh, opacity times transmittance, whatever has these moments. Polynomials that are 0 or more in the pixel");
    w.line("// and 1 or more from the fragment on bound the share that lies there, rounding included.");
    let weighed: Vec<&str> = PASS2_PARAMETERS[1..]
        .iter()
        .copied()
        .filter(|name| !["nearest", "farthest"].contains(name))
        .collect();
    let parameters: Vec<(&str, usize)> = weighed.iter().map(|&name| (name, 0)).chain([("b", k)]).collect();
    w.function("nmt_hidden_weight", &parameters, 0);
    w.let_("others", &others);
    recentred_moments(&mut w, 4);
    w.let_("reach", "1.0 + 2.0 * abs(c) * h1");
    w.let_("unsure", &format!("(n + 16.0) * {ROUNDING} * b0 * per_b0"));
    let order = w.number(ORDER);
    w.let_("off", &format!("{order} * h1"));
    w.let_("end", "1.0 + off");
    w.let_("x", "clamp((z - c) * h1, -1.0, 1.0) - off");
    // Cantelli's inequality. Any zero in front of x will do; this far off it says nothing anyhow.
    w.let_("ahead", "x - m1");
    w.let_("r1", "max(m1 - max(m2 - m1 * m1, 0.0) / max(ahead, 1e-30), -1e6)");
    w.let_("gap1", "x - r1");
    w.let_("reach1", "reach + abs(r1)");
    w.let_(
        "share1",
        "(m2 - 2.0 * r1 * m1 + r1 * r1 + unsure * reach1 * reach1) / max(gap1 * gap1, 1e-30)",
    );
    // The quartic.
    w.let_("w1", "m1 - m3");
    w.let_("below", "w1 - x * (1.0 - m2)");
    let below = w.select("abs(below) < 1e-30", "1e-30", "below");
    w.let_("inner", &format!("(m2 - m4 - x * w1) / {below}"));
    let inner = w.select("inner >= -end", "inner", "3e38");
    w.let_("inside", &inner);
    let zero = w.select("inside < x", "inside", "max(r1, -1.0)");
    w.let_("r", &zero);
    w.let_("gap", "x - r");
    w.let_("per_value", "1.0 / max((end + x) * gap * gap, 1e-30)");
    w.let_(
        "gamma",
        "0.99999 * (1.0 - 1.0 / (2.0 * end * (end - r) * (end - r) * per_value)) / (end - x)",
    );
    w.let_("lift", "1.0 + gamma * x");
    w.let_("p0", "end * r * r");
    w.let_("p1", "r * r - 2.0 * r * end");
    w.let_("p2", "end - 2.0 * r");
    w.let_("value", "p0 * lift + (p1 * lift - gamma * p0) * m1 + (p2 * lift - gamma * p1) * m2 + (lift - gamma * p2) * m3 - gamma * m4");
    w.let_("reach2", "reach + abs(r)");
    w.let_(
        "lost",
        "unsure * (end + reach) * reach2 * reach2 * (1.0 + gamma * (abs(x) + reach))",
    );
    w.let_("share2", "(value + lost) * per_value");
    w.let_("share", "1.00001 * min(share1, share2)");
    // NaN is not less than 1 either.
    let behind = w.select("share < 1.0", "max(share, 0.0)", "1.0");
    w.let_("below_1", &behind);
    let behind = w.select("ahead > 0.0", "below_1", "1.0");
    w.let_("behind", &behind);
    w.let_(
        "least_depth",
        &format!("others * (1.0 - behind) - (n + 4.0) * {ROUNDING} * b0 - 1e-5"),
    );
    w.return_value("exp(-least_depth) * min(others * behind + absorbance, n - 2.0)");

    w.line("\n// Pass 2, with the network for what can be seen: parameters and answers as of nmt_fragment_transmittance, but for faint pixels and hidden fragments. Pixels");
    w.line("// of up to four fragments have forms of their own.");
    w.function("nmt_visible_transmittance", &pass2_parameters(k), 0);
    w.let_("others", &others);
    w.variable("front", "-1.0");
    for condition in ["n > 4.0", "v != nearest", "v != farthest", "others > 1e-6 * b0"] {
        w.begin_if(condition);
    }
    w.begin_if(&format!("b0 <= {FAINT_SWITCH}"));
    w.statement("front = 0.5 * others;");
    w.end_if();
    w.begin_if(&format!("{HIDDEN_SWITCH} > 0.0"));
    w.begin_if("z >= nmt_first_hidden_depth(b0, b[0], b[1])");
    w.begin_if(&format!(
        "nmt_hidden_weight({}, b) <= {HIDDEN_SWITCH}",
        weighed.join(", ")
    ));
    w.statement("front = others;");
    for _ in 0..7 {
        w.end_if();
    }
    w.variable("answer", "min(exp(-front), 1.0)");
    w.begin_if("front < 0.0");
    w.statement(&format!(
        "answer = nmt_fragment_transmittance({}, b);",
        PASS2_PARAMETERS.join(", ")
    ));
    w.end_if();
    w.return_value("answer");
    w.text
}
