//! Shader source of the recentred features: the twin of [`crate::features::recentred`], unrolled for the number of moments.

use super::shader::{ENTRY, Language, Numbers, Precision};
use crate::features::FeatureSet;
use crate::features::recentred::{
    ABSORBANCE_OFFSET, ByCount, CLOSED_FORM_TOLERANCE, INNER_MEAN_DEVIATION, INNER_SPREAD_DEVIATION, LEAST_HALF_RANGE, MEAN_DEVIATION,
    MOST_ABSORBANCE, NOISE_GROWTH, SPREAD_DEVIATION, STRADDLE, THIN, USUAL_INNER_SPREAD, USUAL_NOISE, USUAL_SPREAD,
};
use std::fmt::Write;

/// Writes lines of any language.
struct Writer {
    language: Language,
    text: String,
    /// Blocks that are open inside of the function.
    depth: usize,
}

/// How [`look`] hands over what is known without the network.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Hand {
    /// As the last number of the features, everything computed and no branch taken.
    Beside,
    /// At once, before anything is computed that only others need.
    Early,
}

impl Writer {
    /// A constant that keeps its f32 bits.
    fn number(&self, x: f64) -> String {
        self.language.literal(x as f32)
    }

    fn new(language: Language) -> Self {
        Self { language, text: String::new(), depth: 0 }
    }

    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
    }

    /// A statement.
    fn statement(&mut self, statement: &str) {
        self.line(&format!("    {}{statement}", "    ".repeat(self.depth)));
    }

    /// Opens a block that runs under a condition.
    fn open(&mut self, condition: &str) {
        self.statement(&format!("if ({condition}) {{"));
        self.depth += 1;
    }

    fn close(&mut self) {
        self.depth -= 1;
        self.statement("}");
    }

    /// Leaves the function under a condition, where answers are handed over early.
    fn leave(&mut self, hand: Hand, condition: &str, value: &str) {
        if hand == Hand::Early {
            self.open(condition);
            self.statement(&format!("return {value};"));
            self.close();
        }
    }

    /// A value that does not change.
    fn bind(&mut self, name: &str, value: &str) {
        let head = if self.language == Language::Wgsl { "let" } else { "float" };
        self.statement(&format!("{head} {name} = {value};"));
    }

    /// A value that does.
    fn variable(&mut self, name: &str, value: &str) {
        let head = if self.language == Language::Wgsl { "var" } else { "float" };
        self.statement(&format!("{head} {name} = {value};"));
    }

    /// `condition ? yes : no`, both computed.
    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        match self.language {
            Language::Wgsl => format!("select({no}, {yes}, {condition})"),
            Language::Glsl | Language::Hlsl => format!("({condition} ? {yes} : {no})"),
        }
    }

    /// Head of a function; a parameter with a number is an array of so many, and so is the result.
    fn function(&mut self, name: &str, parameters: &[(&str, usize)], result: usize) {
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
        self.line(&if self.language == Language::Wgsl { format!("fn {name}({list}) -> {kind} {{") } else { format!("{kind} {name}({list}) {{") });
    }

    /// Ends a function with a number.
    fn give(&mut self, value: &str) {
        self.statement(&format!("return {value};"));
        self.line("}");
    }

    /// Ends a function with an array.
    fn give_array(&mut self, items: &[String]) {
        match self.language {
            Language::Wgsl => self.statement(&format!("return array<f32, {}>({});", items.len(), items.join(", "))),
            Language::Glsl => self.statement(&format!("return float[{}]({});", items.len(), items.join(", "))),
            Language::Hlsl => items.iter().enumerate().for_each(|(i, item)| self.statement(&format!("result[{i}] = {item};"))),
        }
        self.line("}");
    }

    /// Ends a function with what the network answers to features.
    fn give_answer(&mut self, features: &[String]) {
        let (n, list) = (features.len(), features.join(", "));
        match self.language {
            Language::Wgsl => self.give(&format!("min({ENTRY}(array<f32, {n}>({list})), 1.0)")),
            Language::Glsl => self.give(&format!("min({ENTRY}(float[{n}]({list})), 1.0)")),
            Language::Hlsl => {
                self.statement(&format!("float features[{n}] = {{ {list} }};"));
                self.give(&format!("min({ENTRY}(features), 1.0)"));
            }
        }
    }
}

/// What the fragment's own data and what pass 1 left are called, in the order of parameters.
const LOOK: [&str; 9] = ["v", "z", "absorbance", "nearest", "farthest", "z_nearest", "z_farthest", "n", "b0"];

/// Constant of what storage does to moments.
pub const ROUNDING: &str = "NMT_ROUNDING";

/// Functions of pass 1, and the one that looks at a fragment in pass 2.
pub fn source(language: Language, set: FeatureSet) -> String {
    let (k, width) = (set.moments(), set.width());
    let mut w = Writer::new(language);
    w.line("// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.");
    w.function("nmt_absorbance", &[("alpha", 0)], 0);
    w.bind("faint", "alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))))");
    let chosen = w.select("alpha < 0.03", "faint", "-log(max(1.0 - alpha, 0.000045399931))");
    w.give(&chosen);

    w.line("\n// ln(a / b), as accurate relative to itself where a is near b as elsewhere.");
    w.function("nmt_log_ratio", &[("a", 0), ("b", 0)], 0);
    w.bind("s", "(a - b) / (a + b)");
    w.bind("q", "s * s");
    let chosen = w.select("abs(s) < 0.2", "(s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111))))", "log(a / b)");
    w.give(&chosen);

    w.line("\n// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the pixel's own nearest and farthest view");
    w.line("// depth, these may be v0 and v1 in both passes: then no pixel is too thin for its moments.");
    w.function("nmt_moment_depth", &[("v", 0), ("v0", 0), ("v1", 0)], 0);
    w.bind("warped", "2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0");
    let chosen = w.select("v1 > v0", "clamp(warped, -1.0, 1.0)", "0.0");
    w.give(&chosen);

    w.line(&format!("\n// Pass 1: what a fragment at moment depth z adds to b1..b{k}; to b0 it adds its absorbance, to n it adds 1."));
    w.function("nmt_moments", &[("z", 0), ("absorbance", 0)], k);
    own_moments(&mut w, k);
    let items: Vec<String> = (1..=k).map(|i| format!("own{i}")).collect();
    w.give_array(&items);

    w.line("\n// Rounding of a stored moment, as a share of b0: of f32 sums 2^-23, of f16 sums 2^-10.");
    w.text += &Numbers { language, precision: Precision::F32 }.scalar_constant(ROUNDING, f32::EPSILON);

    w.line("\n// Pass 2: what is known of a fragment at view depth v and moment depth z, from what pass 1 left in its pixel: nearest and farthest view depth as f32,");
    w.line(&format!("// their moment depths, number of fragments n, total absorbance b0 and moments b1..b{k}. The result holds the {width} features, then T where it is"));
    w.line("// known without the network, else -1. No branch is taken.");
    let parameters: Vec<(&str, usize)> = LOOK.iter().map(|&name| (name, 0)).chain([("b", k)]).collect();
    w.function("nmt_recentred", &parameters, width + 1);
    look(&mut w, k, Hand::Beside);
    w.text
}

fn own_moments(w: &mut Writer, k: usize) {
    for i in 1..=k {
        let before = if i == 1 { "absorbance".to_owned() } else { format!("own{}", i - 1) };
        w.bind(&format!("own{i}"), &format!("{before} * z"));
    }
}

fn look(w: &mut Writer, k: usize, hand: Hand) {
    let most = w.number(MOST_ABSORBANCE);
    w.bind("others", &format!("clamp(b0 - absorbance, 0.0, {most})"));
    w.leave(hand, "v == nearest", "1.0");
    w.leave(hand, "others <= 1e-6 * b0", "1.0");
    // However coarse the exponential, no answer is above 1.
    w.leave(hand, "v == farthest", "min(exp(-others), 1.0)");
    w.bind("c", "0.5 * (z_nearest + z_farthest)");
    let least = w.number(LEAST_HALF_RANGE);
    w.bind("h", &format!("max(0.5 * (z_farthest - z_nearest), {least})"));
    own_moments(w, k);
    w.bind("per_b0", "1.0 / max(others, 1e-30)");
    for i in 1..=k {
        w.variable(&format!("m{i}"), &format!("(b[{}] - own{i}) * per_b0", i - 1));
    }
    // Moments of z − c, one factor at a time.
    for pass in 1..=k {
        for i in (pass..=k).rev() {
            let before = if i == 1 { "c".to_owned() } else { format!("c * m{}", i - 1) };
            w.statement(&format!("m{i} = m{i} - {before};"));
        }
    }
    w.bind("h1", "1.0 / h");
    w.bind("h2", "h1 * h1");
    w.bind("h3", "h2 * h1");
    w.bind("h4", "h2 * h2");
    for i in 1..=k {
        let power = if i <= 4 { format!("h{i}") } else { format!("h4 * h{}", i - 4) };
        w.statement(&format!("m{i} = clamp(m{i} * {power}, -1.0, 1.0);"));
    }
    // In thin pixels view depth says more than moment depth.
    w.bind("range", "farthest - nearest");
    w.bind("ratio", "range / nearest");
    w.bind("t", "(v - nearest) / max(range, 1e-30)");
    let thin = w.number(THIN);
    let x = w.select(&format!("ratio < {thin}"), "2.0 * t * (1.0 + 0.5 * ratio * (1.0 - t)) - 1.0", "(z - c) / h");
    w.bind("x", &format!("clamp({x}, -1.0, 1.0)"));

    // Three fragments, and four.
    w.bind("reach", "1.0 + 2.0 * abs(c) / h");
    let epsilon = w.number(f32::EPSILON.into());
    w.bind("e1", &format!("{ROUNDING} * reach * b0 * per_b0"));
    w.bind("per_n", "1.0 / n");
    let (usual, deviation) = (w.number(USUAL_NOISE), by_count(w, MEAN_DEVIATION));
    w.bind("noise1", &format!("e1 * ({usual} * sqrt(n))"));
    shrunk(w, "mean0", "m1", "0.0", "noise1", &deviation);
    w.bind("share3", "clamp(0.5 * (1.0 - mean0), 0.0, 1.0)");
    w.leave(hand, "n == 3.0", "min(exp(-(others * share3)), 1.0)");
    if hand == Hand::Early {
        w.open("n == 4.0");
    }
    w.bind("e2", "e1 * reach");
    w.bind("inner", "1.0 - m2");
    w.bind("safe_inner", "max(inner, 1e-30)");
    w.bind("u", "clamp((m1 - m3) / safe_inner, -1.0, 1.0)");
    w.bind("u_error", "(e1 + e2 * reach + abs(u) * e2) / safe_inner");
    let sign = w.select("u < (z - c) / h", "-1.0", "1.0");
    w.bind("side", &sign);
    w.bind("gap", "1.0 + side * u");
    w.bind("safe_gap", "max(gap, 1e-30)");
    w.bind("end", "0.5 * (1.0 - side * m1 - inner / safe_gap)");
    let straddle = w.number(STRADDLE);
    let straddles = w.select(&format!("abs((z - c) / h - u) <= {straddle} * u_error"), &format!("inner / max(1.0 - u * u, {epsilon})"), "0.0");
    w.bind("error", &format!("0.5 * (e1 + e2 / safe_gap + inner * u_error / (safe_gap * safe_gap)) + {straddles}"));
    let share = w.select("side < 0.0", "1.0 - end", "end");
    w.bind("share4", &format!("clamp({share}, 0.0, 1.0)"));
    w.bind("steepest", "others * exp(-(others * max(share4 - error, 0.0)))");
    let tolerance = w.number(CLOSED_FORM_TOLERANCE);
    // One condition a line: short-circuit operators would branch.
    w.variable("known", "exp(-(others * share4))");
    let mut rules = vec![(format!("error * steepest > {tolerance}"), "-1.0"), ("inner <= 0.0".to_owned(), "-1.0"), ("gap <= 0.0".to_owned(), "-1.0")];
    if hand == Hand::Beside {
        rules.extend([
            ("n != 4.0".to_owned(), "-1.0"),
            ("n == 3.0".to_owned(), "exp(-(others * share3))"),
            ("v == farthest".to_owned(), "exp(-others)"),
            ("others <= 1e-6 * b0".to_owned(), "1.0"),
            ("v == nearest".to_owned(), "1.0"),
        ]);
    }
    for (condition, value) in rules {
        let chosen = w.select(&condition, value, "known");
        w.statement(&format!("known = {chosen};"));
    }
    w.statement("known = min(known, 1.0);");
    if hand == Hand::Early {
        w.leave(hand, "known >= 0.0", "known");
        w.close();
    }

    // The measure, and what is left of it without its ends; what rounding has made noise of goes over to what is expected.
    let mut q: Vec<String> = std::iter::once("1.0".to_owned()).chain((1..=k).map(|i| format!("m{i}"))).collect();
    let third = w.number(std::f64::consts::LOG2_E / 3.0);
    w.bind("count", &format!("log(n) * {third} - 1.0"));
    let offset = w.number(ABSORBANCE_OFFSET.into());
    let mut items = vec!["x".to_owned(), "count".to_owned(), format!("log(others + {offset})")];
    let growth = w.number(NOISE_GROWTH);
    w.bind("further", &format!("reach * {growth}"));
    for i in 2..=4 {
        w.bind(&format!("noise{i}"), &format!("noise{} * further", i - 1));
    }
    for level in 0..k / 2 {
        let (mean, spread) = (format!("mean{level}"), format!("spread{level}"));
        let (first, second) = match level {
            0 => (q[1].clone(), q[2].clone()),
            _ => {
                w.bind(&format!("per_mass{level}"), &format!("1.0 / max({}, 1e-6)", q[0]));
                (format!("{} * per_mass{level}", q[1]), format!("{} * per_mass{level}", q[2]))
            }
        };
        let raw = match level {
            0 => first,
            _ => format!("clamp({first}, -1.0, 1.0)"),
        };
        match level {
            // With the closed forms.
            0 => {}
            1 => {
                let deviation = by_count(w, INNER_MEAN_DEVIATION);
                let expected = "mean0 * (1.0 - spread0) / (1.0 + spread0)";
                shrunk(w, &mean, &raw, expected, "noise3 * per_mass1", &format!("({deviation}) * (spread0 + 0.02)"));
            }
            _ => w.bind(&mean, &raw),
        }
        w.bind(&format!("most{level}"), &format!("max(1.0 - {mean} * {mean}, 1e-6)"));
        let raw = format!("clamp(({second} - {mean} * {mean}) / most{level}, 0.0, 1.0)");
        match level {
            0 => {
                let (deviation, expected) = (by_count(w, SPREAD_DEVIATION), by_count(w, USUAL_SPREAD));
                shrunk(w, &spread, &raw, &expected, "noise2 / most0", &deviation);
            }
            1 => {
                let (deviation, usual) = (by_count(w, INNER_SPREAD_DEVIATION), by_count(w, USUAL_INNER_SPREAD));
                let expected = format!("({usual}) * spread0 / (1.0 + spread0 + spread0)");
                shrunk(w, "square1", &raw, &expected, "noise4 * per_mass1 / most1", &format!("({deviation}) * (spread0 + 0.02)"));
                w.bind(&spread, "sqrt(square1)");
            }
            _ => w.bind(&spread, &format!("sqrt({raw})")),
        }
        if level >= 2 {
            for (name, moment, value) in [
                (format!("sure_{mean}"), 2 * level + 1, format!("{mean} * trust_{mean}")),
                (format!("sure_{spread}"), 2 * level + 2, format!("0.5 + ({spread} - 0.5) * trust_{spread}")),
            ] {
                let of = name.trim_start_matches("sure_");
                w.bind(&format!("noise_{of}"), &format!("e1{} * per_mass{level}", " * reach".repeat(moment - 1)));
                w.bind(&format!("trust_{of}"), &format!("1.0 / (1.0 + noise_{of} * noise_{of})"));
                w.bind(&name, &value);
            }
            items.extend([format!("sure_{mean}"), format!("sure_{spread}")]);
        } else {
            items.extend([mean, spread]);
        }
        let rest = q.len() - 2;
        if rest > 2 {
            q = (0..rest)
                .map(|i| {
                    let name = format!("q{}_{i}", level + 1);
                    let value = format!("{} - {}", q[i], q[i + 2]);
                    w.bind(&name, &value);
                    name
                })
                .collect();
        }
    }
    match hand {
        Hand::Beside => {
            items.push("known".to_owned());
            w.give_array(&items);
        }
        Hand::Early => w.give_answer(&items),
    }
}

/// a + b/n.
fn by_count(w: &Writer, quantity: ByCount) -> String {
    format!("{} + {} * per_n", w.number(quantity.many), w.number(quantity.few))
}

/// Twin of the function of this name beside the features.
fn shrunk(w: &mut Writer, name: &str, value: &str, expected: &str, noise: &str, deviation: &str) {
    w.bind(&format!("expected_{name}"), expected);
    w.bind(&format!("ratio_{name}"), &format!("({noise}) / ({deviation})"));
    w.bind(name, &format!("expected_{name} + ({value} - expected_{name}) / (1.0 + ratio_{name} * ratio_{name})"));
}

/// The function that a renderer calls in pass 2: known answers where there are, the network where there are none.
pub fn answer(language: Language, set: FeatureSet) -> String {
    let k = set.moments();
    let mut w = Writer::new(language);
    w.line("\n// Pass 2: transmittance in front of a fragment. Parameters as of nmt_recentred, and the same numbers; but what is known without the network returns");
    w.line("// before the features are computed, so that groups of threads in which all is known skip them and the network.");
    let parameters: Vec<(&str, usize)> = LOOK.iter().map(|&name| (name, 0)).chain([("b", k)]).collect();
    w.function("nmt_fragment_transmittance", &parameters, 0);
    look(&mut w, k, Hand::Early);
    w.text
}
