//! Shader source of the recentred features: the twin of [`crate::features::recentred`], unrolled for the number of moments.

use super::shader::{Language, Numbers, Precision, SHARE};
use crate::features::FeatureSet;
use crate::features::recentred::{
    ABSORBANCE_OFFSET, ARITHMETIC, ByCount, INNER_MEAN_DEVIATION, INNER_SPREAD_DEVIATION, INNER_SPREAD_OF_OFFSET,
    INNER_SPREAD_OF_SPREAD, MAX_ABSORBANCE, MEAN_DEVIATION, MIN_HALF_RANGE, NOISE_GROWTH, SPREAD_DEVIATION, THIN,
    USUAL_INNER_SPREAD, USUAL_NOISE, USUAL_SPREAD,
};
use std::fmt::Write;

/// Writes lines of any language.
pub(super) struct Writer {
    language: Language,
    pub(super) text: String,
    /// Blocks that are open inside of the function.
    depth: usize,
}

/// What becomes of what [`pass2`] computes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Output {
    /// The features are the result, and behind them what is known without the network. No branch is taken.
    FeaturesAndKnown,
    /// The answer is the result; what is known branches around all that only others need.
    Transmittance,
}

impl Writer {
    /// A constant that keeps its f32 bits.
    pub(super) fn number(&self, x: f64) -> String {
        self.language.literal(x as f32)
    }

    pub(super) fn new(language: Language) -> Self {
        Self {
            language,
            text: String::new(),
            depth: 0,
        }
    }

    pub(super) fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
    }

    /// A statement.
    pub(super) fn statement(&mut self, statement: &str) {
        self.line(&format!("    {}{statement}", "    ".repeat(self.depth)));
    }

    /// Opens a block that runs under a condition.
    pub(super) fn begin_if(&mut self, condition: &str) {
        self.statement(&format!("if ({condition}) {{"));
        self.depth += 1;
    }

    pub(super) fn end_if(&mut self) {
        self.depth -= 1;
        self.statement("}");
    }

    /// A value that does not change.
    pub(super) fn let_(&mut self, name: &str, value: &str) {
        let head = if self.language == Language::Wgsl {
            "let"
        } else {
            "float"
        };
        self.statement(&format!("{head} {name} = {value};"));
    }

    /// A value that does.
    pub(super) fn variable(&mut self, name: &str, value: &str) {
        let head = if self.language == Language::Wgsl {
            "var"
        } else {
            "float"
        };
        self.statement(&format!("{head} {name} = {value};"));
    }

    /// `condition ? yes : no`, both computed.
    pub(super) fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        match self.language {
            Language::Wgsl => format!("select({no}, {yes}, {condition})"),
            Language::Glsl | Language::Hlsl => format!("({condition} ? {yes} : {no})"),
        }
    }

    /// Head of a function; a parameter with a number is an array of so many, and so is the result.
    pub(super) fn function(&mut self, name: &str, parameters: &[(&str, usize)], result: usize) {
        let mut list: Vec<String> = parameters
            .iter()
            .map(|&(name, n)| match (self.language, n) {
                (Language::Wgsl, 0) => format!("{name}: f32"),
                (Language::Wgsl, n) => format!("{name}: array<f32, {n}>"),
                (_, 0) => format!("float {name}"),
                (_, n) => format!("float {name}[{n}]"),
            })
            .collect();
        let kind = match (self.language, result) {
            (Language::Wgsl, 0) => "f32".to_owned(),
            (Language::Wgsl, n) => format!("array<f32, {n}>"),
            (_, 0) => "float".to_owned(),
            (Language::Glsl, n) => format!("float[{n}]"),
            (Language::Hlsl, n) => {
                list.push(format!("out float result[{n}]"));
                "void".to_owned()
            }
        };
        let list = list.join(", ");
        self.line(&if self.language == Language::Wgsl {
            format!("fn {name}({list}) -> {kind} {{")
        } else {
            format!("{kind} {name}({list}) {{")
        });
    }

    /// Ends a function with a number.
    pub(super) fn return_value(&mut self, value: &str) {
        self.statement(&format!("return {value};"));
        self.line("}");
    }

    /// Ends a function with an array.
    fn return_array(&mut self, items: &[String]) {
        match self.language {
            Language::Wgsl => self.statement(&format!("return array<f32, {}>({});", items.len(), items.join(", "))),
            Language::Glsl => self.statement(&format!("return float[{}]({});", items.len(), items.join(", "))),
            Language::Hlsl => items
                .iter()
                .enumerate()
                .for_each(|(i, item)| self.statement(&format!("result[{i}] = {item};"))),
        }
        self.line("}");
    }

    /// The share that the network answers to features, as an expression.
    fn share(&mut self, features: &[String]) -> String {
        let (n, list) = (features.len(), features.join(", "));
        match self.language {
            Language::Wgsl => format!("{SHARE}(array<f32, {n}>({list}))"),
            Language::Glsl => format!("{SHARE}(float[{n}]({list}))"),
            Language::Hlsl => {
                self.statement(&format!("float features[{n}] = {{ {list} }};"));
                format!("{SHARE}(features)")
            }
        }
    }
}

/// What the fragment's own data and what pass 1 left are called, in the order of parameters.
pub(super) const PASS2_PARAMETERS: [&str; 9] = [
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

/// Parameters of the functions that look at a fragment.
pub(super) fn pass2_parameters(k: usize) -> Vec<(&'static str, usize)> {
    PASS2_PARAMETERS
        .into_iter()
        .map(|name| (name, 0))
        .chain([("b", k)])
        .collect()
}

/// Constant of what storage does to moments.
pub const ROUNDING: &str = "NMT_ROUNDING";

/// WGSL of a recentred network whose sums are rounded to `unit` of b0 where they are stored, instead of as f32; other source stays as it is.
pub fn with_rounding(wgsl: &str, unit: f32) -> String {
    let constant = |unit| {
        Numbers {
            language: Language::Wgsl,
            precision: Precision::F32,
        }
        .scalar_constant(ROUNDING, unit)
    };
    wgsl.replace(&constant(f32::EPSILON), &constant(unit))
}

/// Functions of pass 1, and the one that looks at a fragment in pass 2.
pub fn source(language: Language, set: FeatureSet) -> String {
    let (k, width) = (set.moments(), set.width());
    let mut w = Writer::new(language);
    w.line("// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.");
    w.function("nmt_absorbance", &[("alpha", 0)], 0);
    w.let_(
        "faint",
        "alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))))",
    );
    let chosen = w.select("alpha < 0.03", "faint", "-log(max(1.0 - alpha, 0.000045399931))");
    w.return_value(&chosen);

    w.line("\n// ln(a / b), as accurate relative to itself where a is near b as elsewhere.");
    w.function("nmt_log_ratio", &[("a", 0), ("b", 0)], 0);
    w.let_("s", "(a - b) / (a + b)");
    w.let_("q", "s * s");
    let chosen = w.select(
        "abs(s) < 0.2",
        "(s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111))))",
        "log(a / b)",
    );
    w.return_value(&chosen);

    w.line("\n// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the pixel's own nearest and farthest view");
    w.line("// depth, these may be v0 and v1 in both passes: then no pixel is too thin for its moments.");
    w.function("nmt_moment_depth", &[("v", 0), ("v0", 0), ("v1", 0)], 0);
    w.let_(
        "warped",
        "2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0",
    );
    let chosen = w.select("v1 > v0", "clamp(warped, -1.0, 1.0)", "0.0");
    w.return_value(&chosen);

    w.line(&format!(
        "\n// Pass 1: what a fragment at moment depth z adds to b1..b{k}; to b0 it adds its absorbance, to n it adds 1."
    ));
    w.function("nmt_moments", &[("z", 0), ("absorbance", 0)], k);
    own_moments(&mut w, k);
    let items: Vec<String> = (1..=k).map(|i| format!("own{i}")).collect();
    w.return_array(&items);

    w.line("\n// Rounding of a stored moment, as a share of b0: of f32 sums 2^-23, of f16 sums 2^-10.");
    w.text += &Numbers {
        language,
        precision: Precision::F32,
    }
    .scalar_constant(ROUNDING, f32::EPSILON);

    w.line("\n// Pass 2: what is known of a fragment at view depth v and moment depth z, from what pass 1 left in its pixel: nearest and farthest view depth as f32,");
    w.line(&format!("// their moment depths, number of fragments n, total absorbance b0 and moments b1..b{k}. The result holds the {width} features, then T where it is"));
    w.line("// known without the network, else -1. No branch is taken.");
    w.function("nmt_recentred", &pass2_parameters(k), width + 1);
    pass2(&mut w, k, Output::FeaturesAndKnown);
    w.text
}

fn own_moments(w: &mut Writer, k: usize) {
    for i in 1..=k {
        let before = if i == 1 {
            "absorbance".to_owned()
        } else {
            format!("own{}", i - 1)
        };
        w.let_(&format!("own{i}"), &format!("{before} * z"));
    }
}

fn pass2(w: &mut Writer, k: usize, output: Output) {
    let early = output == Output::Transmittance;
    let most = w.number(MAX_ABSORBANCE);
    w.let_("others", &format!("clamp(b0 - absorbance, 0.0, {most})"));
    if early {
        // One condition a line: short-circuit operators would branch too.
        w.variable("front", "0.0");
        w.begin_if("v != nearest");
        w.begin_if("others > 1e-6 * b0");
        w.statement("front = others;");
        w.begin_if("v != farthest");
    }
    recentred_moments(w, k);
    w.let_("along", "(z - c) * h1");
    // In thin pixels view depth says more than moment depth.
    w.let_("range", "farthest - nearest");
    w.let_("ratio", "range / nearest");
    w.let_("t", "(v - nearest) / max(range, 1e-30)");
    let thin = w.number(THIN);
    let x = w.select(
        &format!("ratio < {thin}"),
        "2.0 * t * (1.0 + 0.5 * ratio * (1.0 - t)) - 1.0",
        "along",
    );
    w.let_("x", &format!("clamp({x}, -1.0, 1.0)"));

    // Three fragments, and four.
    w.let_("reach", "1.0 + 2.0 * abs(c) * h1");
    w.let_("e1", &format!("{ROUNDING} * reach * b0 * per_b0"));
    let (usual, deviation) = (w.number(USUAL_NOISE), by_count(w, MEAN_DEVIATION));
    w.let_("per_n", "1.0 / n");
    w.let_("noise1", &format!("e1 * ({usual} * sqrt(n))"));
    w.let_("deviation1", &deviation);
    w.let_("trust1", "deviation1 * deviation1");
    w.let_("mean0", "m1 * (trust1 / (trust1 + noise1 * noise1))");
    w.let_("front3", "others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0)");
    if early {
        w.statement("front = front3;");
        w.begin_if("n != 3.0");
    }
    first_features(w);
    four(w);
    match output {
        Output::Transmittance => {
            w.statement("front = front4;");
            w.begin_if("n != 4.0");
        }
        Output::FeaturesAndKnown => {
            w.variable("front", "-1.0");
            let rules = [
                ("n == 4.0", "front4", "front"),
                ("n == 3.0", "front3", "front"),
                ("v == farthest", "others", "front"),
            ];
            let first = [("others > 1e-6 * b0", "front", "0.0"), ("v == nearest", "0.0", "front")];
            for (condition, yes, no) in rules.into_iter().chain(first) {
                let chosen = w.select(condition, yes, no);
                w.statement(&format!("front = {chosen};"));
            }
            let known = w.select("front >= 0.0", "min(exp(-front), 1.0)", "-1.0");
            w.let_("known", &known);
        }
    }
    let mut items = features(w, k);
    match output {
        Output::FeaturesAndKnown => {
            items.push("known".to_owned());
            w.return_array(&items);
        }
        Output::Transmittance => {
            let share = w.share(&items);
            w.statement(&format!("front = others * {share};"));
            while w.depth > 0 {
                w.end_if();
            }
            // However coarse the exponential, no answer is above 1.
            w.return_value("min(exp(-front), 1.0)");
        }
    }
}

/// c, 1/h and m1..mk.
pub(super) fn recentred_moments(w: &mut Writer, k: usize) {
    w.let_("c", "0.5 * (z_nearest + z_farthest)");
    let least = w.number(MIN_HALF_RANGE);
    w.let_("h1", &format!("1.0 / max(0.5 * (z_farthest - z_nearest), {least})"));
    own_moments(w, k);
    w.let_("per_b0", "1.0 / max(others, 1e-30)");
    for i in 1..=k {
        w.variable(&format!("m{i}"), &format!("(b[{}] - own{i}) * per_b0", i - 1));
    }
    // Moments of z − c, one factor at a time.
    for pass in 1..=k {
        for i in (pass..=k).rev() {
            let before = if i == 1 {
                "c".to_owned()
            } else {
                format!("c * m{}", i - 1)
            };
            w.statement(&format!("m{i} = m{i} - {before};"));
        }
    }
    w.let_("h2", "h1 * h1");
    w.let_("h3", "h2 * h1");
    w.let_("h4", "h2 * h2");
    for i in 1..=k {
        let power = if i <= 4 {
            format!("h{i}")
        } else {
            format!("h4 * h{}", i - 4)
        };
        w.statement(&format!("m{i} = clamp(m{i} * {power}, -1.0, 1.0);"));
    }
}

/// Spread and inner mean, and how far the latter may usually be off; what rounding has made noise of goes over to what is expected.
///
/// Value and expectation are weighted by the squares of deviation and noise over one common denominator, so that the chain of divisions is short. Noise is bounded,
/// so that its square does not overflow.
fn first_features(w: &mut Writer) {
    let growth = w.number(NOISE_GROWTH);
    w.let_("further", &format!("reach * {growth}"));
    w.let_("noise2", "min(noise1 * further, 1e15)");
    w.let_("noise3", "noise1 * further * further");

    w.let_("most0", "max(1.0 - mean0 * mean0, 1e-6)");
    let (deviation, expected) = (by_count(w, SPREAD_DEVIATION), by_count(w, USUAL_SPREAD));
    w.let_("deviation2", &deviation);
    w.let_("trust2", "deviation2 * deviation2 * most0");
    w.let_("doubt2", "noise2 * noise2");
    w.let_(
        "spread0",
        &format!(
            "(clamp(m2 - mean0 * mean0, 0.0, most0) * trust2 + ({expected}) * doubt2) / (most0 * trust2 + doubt2)"
        ),
    );

    // What mean and spread lead to expect has a denominator of its own.
    w.let_("per_mass1", "1.0 / max(1.0 - m2, 1e-6)");
    w.let_("mean_part", "1.0 + spread0");
    let deviation = by_count(w, INNER_MEAN_DEVIATION);
    w.let_("deviation3", &format!("({deviation}) * (spread0 + 0.02)"));
    w.let_("trust3", "deviation3 * deviation3");
    w.let_("bounded3", "min(noise3 * per_mass1, 1e15)");
    w.let_("doubt3", "bounded3 * bounded3");
    w.let_("expected3", "mean0 * (1.0 - spread0)");
    w.let_("raw_mean1", "clamp((m1 - m3) * per_mass1, -1.0, 1.0)");
    w.let_(
        "mean1",
        "(raw_mean1 * mean_part * trust3 + expected3 * doubt3) / (mean_part * (trust3 + doubt3))",
    );
}

/// The closed form of four fragments: optical depth in front.
fn four(w: &mut Writer) {
    let rounding = w.number(ARITHMETIC * f64::from(f32::EPSILON));
    w.let_("noise", &format!("bounded3 + {rounding} * per_mass1"));
    w.let_("off", "noise * deviation3 / (noise + deviation3)");
    w.let_("inner", "(1.0 - spread0) * (1.0 - mean0 * mean0)");
    w.let_(
        "near_share",
        "clamp(0.5 * (1.0 - mean0 - inner / max(1.0 + mean1, 1e-6)), 0.0, 1.0)",
    );
    w.let_(
        "far_share",
        "clamp(0.5 * (1.0 + mean0 - inner / max(1.0 - mean1, 1e-6)), 0.0, 1.0)",
    );
    w.let_("behind", "clamp(0.5 + 0.5 * (x - mean1) / off, 0.0, 1.0)");
    w.let_(
        "front4",
        "others * clamp(near_share + behind * (1.0 - far_share - near_share), 0.0, 1.0)",
    );
}

/// The other features. Returns the names of all.
fn features(w: &mut Writer, k: usize) -> Vec<String> {
    let third = w.number(std::f64::consts::LOG2_E / 3.0);
    w.let_("count", &format!("log(n) * {third} - 1.0"));
    let offset = w.number(ABSORBANCE_OFFSET.into());
    let mut items = vec!["x".to_owned(), "count".to_owned(), format!("log(others + {offset})")];
    w.let_("most1", "max(1.0 - mean1 * mean1, 1e-6)");
    w.let_("spread_part", "mean_part + spread0");
    let (deviation, usual) = (by_count(w, INNER_SPREAD_DEVIATION), by_count(w, USUAL_INNER_SPREAD));
    let (of_spread, of_offset) = (w.number(INNER_SPREAD_OF_SPREAD), w.number(INNER_SPREAD_OF_OFFSET));
    w.let_("offset", "mean1 * mean_part - expected3");
    w.let_("square0", "spread0 * spread0");
    w.let_("expected4", &format!("clamp(({usual} + {of_spread} * square0 * square0 - {of_offset} * offset * offset) * spread0, 0.0, spread_part)"));
    w.let_("deviation4", &format!("({deviation}) * (spread0 + 0.02)"));
    w.let_("trust4", "deviation4 * deviation4 * most1");
    w.let_("bounded4", "min(noise3 * further * per_mass1, 1e15)");
    w.let_("doubt4", "bounded4 * bounded4");
    w.let_(
        "raw_square1",
        "clamp((m2 - m4) * per_mass1 - mean1 * mean1, 0.0, most1)",
    );
    w.let_(
        "square1",
        "(raw_square1 * trust4 * spread_part + expected4 * doubt4) / (spread_part * (trust4 * most1 + doubt4))",
    );
    w.let_("spread1", "sqrt(square1)");
    items.extend(["mean0", "spread0", "mean1", "spread1"].map(str::to_owned));

    if k == 4 {
        return items;
    }
    // Beyond, moments of (1 − x²)² μ and so on: differences of differences.
    let mut q: Vec<String> = std::iter::once("1.0".to_owned())
        .chain((1..=k).map(|i| format!("m{i}")))
        .collect();
    for level in 1..k / 2 {
        q = (0..q.len() - 2)
            .map(|i| {
                let name = format!("q{level}_{i}");
                w.let_(&name, &format!("{} - {}", q[i], q[i + 2]));
                name
            })
            .collect();
        if level == 1 {
            continue;
        }
        let (mean, spread) = (format!("mean{level}"), format!("spread{level}"));
        w.let_(&format!("per_mass{level}"), &format!("1.0 / max({}, 1e-6)", q[0]));
        w.let_(&mean, &format!("clamp({} * per_mass{level}, -1.0, 1.0)", q[1]));
        w.let_(&format!("most{level}"), &format!("max(1.0 - {mean} * {mean}, 1e-6)"));
        w.let_(
            &spread,
            &format!(
                "sqrt(clamp(({} * per_mass{level} - {mean} * {mean}) / most{level}, 0.0, 1.0))",
                q[2]
            ),
        );
        for (of, moment, value) in [
            (&mean, 2 * level + 1, format!("{mean} * trust_{mean}")),
            (
                &spread,
                2 * level + 2,
                format!("0.5 + ({spread} - 0.5) * trust_{spread}"),
            ),
        ] {
            w.let_(
                &format!("noise_{of}"),
                &format!("e1{} * per_mass{level}", " * reach".repeat(moment - 1)),
            );
            w.let_(
                &format!("trust_{of}"),
                &format!("1.0 / (1.0 + noise_{of} * noise_{of})"),
            );
            w.let_(&format!("sure_{of}"), &value);
            items.push(format!("sure_{of}"));
        }
    }
    items
}

/// a + b/n.
fn by_count(w: &Writer, quantity: ByCount) -> String {
    format!("{} + {} * per_n", w.number(quantity.many), w.number(quantity.few))
}

/// The function that a renderer calls in pass 2: known answers where there are, the network where there are none.
pub fn answer(language: Language, set: FeatureSet) -> String {
    let k = set.moments();
    let mut w = Writer::new(language);
    w.line("\n// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the network branches around the features");
    w.line("// and the network, so that groups of threads in which all is known skip them.");
    w.function("nmt_fragment_transmittance", &pass2_parameters(k), 0);
    pass2(&mut w, k, Output::Transmittance);
    w.text
}
