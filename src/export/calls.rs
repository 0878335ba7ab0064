//! Pass 1, pass 2 and the resolve in one call each, with a vector for every render target: what stands behind the
//! functions of an export.

use crate::features::{FeatureSet, FeatureSpec, MomentDepthKind};
use crate::numeric::real::{Real, c};
use crate::numeric::source::{Expression, Source, Type, Value};

/// Render targets of four numbers that hold sums and the number of fragments; the target of the range comes behind
/// them.
pub fn targets(set: FeatureSet) -> usize {
    targets_of(set.moments())
}

/// The same by the number of moments.
pub(super) fn targets_of(moments: usize) -> usize {
    (moments + 2).div_ceil(4)
}

/// Names of the targets of sums.
pub(super) fn names(moments: usize) -> Vec<String> {
    (0..targets_of(moments)).map(|i| format!("sums{i}")).collect()
}

/// Writes `NmtSums`, what pass 1 leaves of a pixel: `count` says what is counted behind the moments, `range` what the
/// last target holds.
pub(super) fn structure(source: &Source, moments: usize, count: &str, range: &str) {
    let name = |number: usize| match number {
        n if n <= moments => format!("b{n}"),
        n if n == moments + 1 => count.to_owned(),
        _ => "0".to_owned(),
    };
    let targets = names(moments);
    let sums: Vec<String> = (0..targets.len())
        .map(|target| {
            let names: Vec<String> = (4 * target..4 * target + 4).map(name).collect();
            format!("({}): blended by addition, cleared to 0.", names.join(", "))
        })
        .collect();
    let of_target = sums.iter().zip(&targets);
    let mut fields: Vec<_> = of_target
        .map(|(about, target)| (about.as_str(), target.as_str(), Type::Vec4))
        .collect();
    fields.push((range, "range", Type::Vec4));
    let about = "What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.";
    source.structure("NmtSums", about, &fields);
}

/// Numbers that a target of sums holds: four, or what is left for the last.
pub fn channels(set: FeatureSet, target: usize) -> usize {
    (set.moments() + 2 - 4 * target).min(4)
}

/// The calls of a set whose passes blend their sums.
struct Calls<'s> {
    source: &'s Source,
    moments: usize,
    /// Names of the targets of sums.
    targets: Vec<String>,
}

/// Writes the calls of a feature set; none where pass 2 answers of more than blended sums and their range. Those of a
/// core are written behind its codes ([`super::core::ends`]).
pub fn write(source: &Source, spec: &FeatureSpec) {
    if !spec.has_blended_passes() || spec.core.is_some() {
        return;
    }
    let moments = spec.sums.moments;
    let calls = Calls {
        source,
        moments,
        targets: names(moments),
    };
    match spec.depth {
        MomentDepthKind::Window => calls.by_window_depth(),
        MomentDepthKind::Log | MomentDepthKind::None => calls.by_view_depth(),
    }
    write_resolve(source);
}

/// Comment of the call of pass 2.
const PASS2: &str = "Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. \
    Add up (alpha * T * color, alpha * T).";

impl<'s> Calls<'s> {
    fn real(&self, name: &str) -> Expression<'s> {
        self.source.real(name)
    }

    /// The structure of what pass 1 writes.
    fn structure(&self, depth: &str, ends: [&str; 2]) {
        let range = format!(
            "(-{depth}, {depth}, 0, 0): blended by max, cleared to -3e38, so that it holds {} and {}. Two channels, \
             f32 always.",
            ends[0], ends[1]
        );
        structure(self.source, self.moments, "number of fragments", &range);
    }

    /// Ends the function of pass 1: b0, moments, 1 for the number of fragments, and the range.
    fn return_sums<const K: usize>(&self, absorbance: Expression<'s>, z: Expression<'s>, depth: Expression<'s>) {
        let [zero, one] = [0.0, 1.0].map(|x| absorbance.like(x));
        let b = self
            .source
            .call_numbers::<K>("b", "nmt_moments", &[z.into(), absorbance.into()]);
        let mut numbers = vec![absorbance];
        numbers.extend(b);
        numbers.push(one);
        numbers.resize(4 * self.targets.len(), zero);
        let range = [-depth, depth, zero, zero];
        let mut values: Vec<(&str, &[Expression<'_>])> = self
            .targets
            .iter()
            .zip(numbers.chunks(4))
            .map(|(target, numbers)| (target.as_str(), numbers))
            .collect();
        values.push(("range", &range));
        self.source.return_structure("NmtSums", &values);
    }

    fn moments_of_pass1(&self, absorbance: Expression<'s>, z: Expression<'s>, depth: Expression<'s>) {
        match self.moments {
            4 => self.return_sums::<4>(absorbance, z, depth),
            6 => self.return_sums::<6>(absorbance, z, depth),
            8 => self.return_sums::<8>(absorbance, z, depth),
            k => unreachable!("no set with blended passes has {k} moments"),
        }
    }

    /// A number of the targets by its place: b_0 first, then moments, then the number of fragments.
    fn sum(&self, number: usize) -> Expression<'s> {
        self.source.vec4(&self.targets[number / 4])[number % 4]
    }

    /// The moments of a pixel as one value.
    fn moments(&self) -> Value<'s> {
        let moments: Vec<_> = (1..=self.moments).map(|k| self.sum(k)).collect();
        self.source.numbers(&moments)
    }

    /// Parameters of pass 2: those of the fragment, then the targets.
    fn parameters<'n>(&'n self, fragment: &[&'n str]) -> Vec<(&'n str, Type)> {
        let numbers = fragment.iter().map(|&name| (name, Type::Real));
        let targets = self.targets.iter().map(|target| (target.as_str(), Type::Vec4));
        numbers.chain(targets).chain([("range", Type::Vec4)]).collect()
    }

    fn absorbance(&self) -> Expression<'s> {
        self.source.call("nmt_absorbance", &[self.real("alpha").into()])
    }

    /// Where moments are taken of window depth.
    fn by_window_depth(&self) {
        self.structure("w", ["-w_min", "w_max"]);
        let about = "Pass 1 in one call. w is window depth in [0, 1], the same bits in both passes.";
        let parameters = [("w", Type::Real), ("alpha", Type::Real)];
        self.source
            .begin_structure_function("nmt_pass1", about, &parameters, "NmtSums");
        let absorbance = self.absorbance().named("absorbance");
        self.moments_of_pass1(absorbance, self.real("w"), self.real("w"));

        self.source
            .begin_function("nmt_pass2", PASS2, &self.parameters(&["w"]), Type::Real);
        let [least, greatest, ..] = self.source.vec4("range");
        let (n, b0) = (self.sum(self.moments + 1), self.sum(0));
        let arguments = [self.real("w"), -least, greatest, n, b0].map(Value::from);
        let features = self
            .source
            .call("nmt_features", &[arguments.as_slice(), &[self.moments()]].concat());
        self.source
            .return_value(self.source.call("nmt_transmittance", &[features.into()]));
    }

    /// Where moments are taken of the logarithm of view depth.
    fn by_view_depth(&self) {
        self.structure("v", ["-nearest", "farthest"]);
        let about = "Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and \
                     v1 are the least and the greatest v of the scene.";
        let parameters = ["v", "v0", "v1", "alpha"].map(|name| (name, Type::Real));
        self.source
            .begin_structure_function("nmt_pass1", about, &parameters, "NmtSums");
        let absorbance = self.absorbance().named("absorbance");
        self.moments_of_pass1(absorbance, self.moment_depth(self.real("v")), self.real("v"));
        self.answer("nmt_pass2", PASS2, "nmt_fragment_transmittance");
        let about = "As nmt_pass2, without the network for what cannot be seen; see nmt_visible_transmittance.";
        self.answer("nmt_visible_pass2", about, "nmt_visible_transmittance");
    }

    fn moment_depth(&self, v: Expression<'s>) -> Expression<'s> {
        let range = ["v0", "v1"].map(|name| self.real(name).into());
        self.source.call("nmt_moment_depth", &[v.into(), range[0], range[1]])
    }

    /// A call of pass 2 that hands on to a function below it.
    fn answer(&self, name: &str, about: &str, function: &str) {
        let parameters = self.parameters(&["v", "v0", "v1", "alpha"]);
        self.source.begin_function(name, about, &parameters, Type::Real);
        let [least, greatest, ..] = self.source.vec4("range");
        let (nearest, farthest) = ((-least).named("nearest"), greatest.named("farthest"));
        let v = self.real("v");
        let fragment = [v, self.moment_depth(v), self.absorbance(), nearest, farthest];
        let pixel = [
            self.moment_depth(nearest),
            self.moment_depth(farthest),
            self.sum(self.moments + 1),
            self.sum(0),
        ];
        let numbers = fragment.into_iter().chain(pixel).map(Value::from);
        let arguments: Vec<_> = numbers.chain([self.moments()]).collect();
        self.source.return_value(self.source.call(function, &arguments));
    }
}

/// Writes `nmt_resolve`, the same for all that composite by Eq. 7 of NMT24.
pub fn write_resolve(source: &Source) {
    let about = "Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of \
                 the background shows through: result.rgb + result.a * background. As a blend state: source \
                 factor one, destination factor source alpha.";
    let parameters = [("weighted", Type::Vec4), ("sums0", Type::Vec4)];
    source.begin_function("nmt_resolve", about, &parameters, Type::Vec4);
    let [red, green, blue, weight] = source.vec4("weighted");
    let [b0, ..] = source.vec4("sums0");
    let behind = (-b0).exp().named("behind");
    let whole = (c(1.0) - behind) / weight.max(c(1e-37));
    let scale = Expression::select(weight.gt(c(0.0)), whole, weight.like(0.0)).named("scale");
    source.return_numbers(&[scale * red, scale * green, scale * blue, behind]);
}
