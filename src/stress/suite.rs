//! The whole suite: which subjects run, on which cases, on how many random fragments, and along which sweeps.

use super::random::{Counts, hunt};
use super::subject::{TwoMoments, with_digits};
use super::sweep::{self, Point};
use super::{Case, Classic, Doubles, Execution, Fragments, Promise, Report, Subject, measure};
use crate::chart::{self, Axis, COLORS, Chart, Mark, Scale, Series};
use crate::export::Format;
use crate::features::{FeatureSet, MomentFrame};
use crate::gpu::{self, Gpu, GpuError, MethodShader};
use crate::model::{Mlp, ShapeError};
use crate::oit::{Method, MethodError, ParseError, all_names, parse, shader_of};
use std::collections::HashSet;
use std::time::Instant;

/// Methods that networks are compared with by default.
pub const DEFAULT_METHODS: [&str; 9] = [
    "moment-power-4:f32",
    "moment-power-8:f32",
    "moment-trig-4:f32",
    "moment-power-4:unorm16",
    "moment-power-8:unorm16",
    "moment-trig-4:unorm16",
    "moment-power-4:f32+own",
    "moment-trig-4:f32+own",
    "moment-power-4:unorm16+own",
];

/// Methods that charts show beside the networks.
const CHART_METHODS: [&str; 5] = [
    "moment-power-4:f32",
    "moment-power-8:f32",
    "moment-trig-4:f32",
    "moment-power-4:unorm16",
    "moment-power-4:f32+own",
];

/// Fragments of the longest pixels of a chart stay below this.
const MAX_CHART_FRAGMENTS: usize = 200_000;

/// Why the suite cannot run.
#[derive(Debug, thiserror::Error)]
pub enum SuiteError {
    /// No case has that name.
    #[error("there is no such case; there are {0}")]
    Case(String),
    /// No method has that name.
    #[error(transparent)]
    Name(#[from] ParseError),
    /// A format of weights that cannot hold a network.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A network that cannot answer random fragments.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// No GPU, or a network without a shader.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// The cases of these names; all of them where there are no names.
///
/// # Errors
/// [`SuiteError::Case`] for an unknown name.
pub fn cases(names: &[String]) -> Result<Vec<Case>, SuiteError> {
    let mut cases = Case::all();
    if !names.is_empty() {
        let known: Vec<&str> = cases.iter().map(|c| c.name).collect();
        if names.iter().any(|name| !known.contains(&name.as_str())) {
            return Err(SuiteError::Case(known.join(", ")));
        }
        cases.retain(|c| names.iter().any(|name| name == c.name));
    }
    Ok(cases)
}

/// Networks as `nmt predict` runs them.
///
/// # Errors
/// [`SuiteError::Shape`].
pub fn networks(mlps: &[Mlp]) -> Result<Vec<Subject<'static>>, SuiteError> {
    mlps.iter()
        .map(|mlp| Ok(Subject::network(mlp, Execution::default())?))
        .collect()
}

/// Networks in every other arithmetic, storage and format of weights.
///
/// # Errors
/// [`SuiteError::Shape`].
pub fn executions(mlps: &[Mlp]) -> Result<Vec<Subject<'static>>, SuiteError> {
    let mut subjects = Vec::new();
    for mlp in mlps {
        for execution in Execution::all(mlp.feature_set())
            .into_iter()
            .filter(|e| *e != Execution::default())
        {
            subjects.push(Subject::network(mlp, execution)?);
        }
    }
    Ok(subjects)
}

/// Classic methods of these names; "all" stands for every one, "none" for none. Beside [`DEFAULT_METHODS`] and "all"
/// come the methods with all their arithmetic in single precision.
///
/// # Errors
/// [`SuiteError::Name`].
pub fn classic(methods: &[String]) -> Result<Vec<Subject<'static>>, SuiteError> {
    let mut subjects = Vec::new();
    let mut seen = HashSet::new();
    for name in methods.iter().filter(|name| *name != "none") {
        let names = if name == "all" { all_names() } else { vec![name.clone()] };
        for name in names {
            if seen.insert(name.clone()) {
                subjects.push(classic_method(&name)?);
            }
        }
    }
    if methods == DEFAULT_METHODS || methods.iter().any(|name| name == "all") {
        subjects.extend(Classic::ALL.map(Classic::subject));
    }
    Ok(subjects)
}

/// A classic method by its name, with what it would be without the rounding of its storage.
fn classic_method(name: &str) -> Result<Subject<'static>, SuiteError> {
    let plain = [":f32", ":unorm16", ":nlqm"]
        .iter()
        .fold(name.to_owned(), |name, suffix| name.replace(suffix, ""));
    let double: Option<Box<dyn Method>> = if plain == name { None } else { Some(parse(&plain)?) };
    Ok(Subject::method(parse(name)?, double))
}

/// Networks and classic methods with both passes in compute shaders, by the sources that `nmt export` writes.
///
/// # Errors
/// [`SuiteError`] where there is no GPU, or a network has no shader.
pub fn on_gpu(mlps: &[Mlp], methods: &[String]) -> Result<Vec<Subject<'static>>, SuiteError> {
    let gpu = Gpu::shared()?;
    let run = |shader: MethodShader| {
        move |f: &Fragments| {
            let list = f.list().map_err(|e| e.to_string())?;
            let weights = gpu::list::weights(gpu, &shader, &list, f.context.planes, f.context.depth_range)
                .map_err(|e| e.to_string())?;
            Ok(weights.into_iter().map(f64::from).collect())
        }
    };
    let mut subjects = Vec::new();
    for mlp in mlps
        .iter()
        .filter(|mlp| mlp.feature_set() != FeatureSet::DeepWeightedBlended)
    {
        let promise = Subject::network(mlp, Execution::default())?.promise;
        let shader = MethodShader::neural(mlp, Format::WGSL).map_err(GpuError::from)?;
        let name = format!("{} @ {}", shader.name, gpu.name());
        subjects.push(Subject::new(name, promise, run(shader)).with_network_as_double(mlp));
    }
    let mut names: Vec<String> = Vec::new();
    for name in methods {
        let plain = name.replace(":f32", "");
        if !names.contains(&plain) {
            names.push(plain);
        }
    }
    for name in names {
        let Some(shader) = shader_of(&name) else {
            continue;
        };
        let promise = if name.ends_with("+own") {
            Promise::Ends
        } else {
            Promise::None
        };
        let label = format!("{name} @ {}", gpu.name());
        subjects.push(Subject::new(label, promise, run(shader)).with_method_as_double(parse(&name)?));
    }
    Ok(subjects)
}

/// Reports by subject, then by case. `progress` is told how many are done, the case and the subject.
pub fn run(cases: &[Case], subjects: &[&Subject<'_>], progress: &dyn Fn(u64, &str, &str)) -> Vec<Vec<Report>> {
    let mut reports: Vec<Vec<Report>> = subjects.iter().map(|_| Vec::new()).collect();
    let mut done = 0;
    for case in cases {
        let mut doubles = Doubles::default();
        for (subject, reports) in subjects.iter().zip(&mut reports) {
            progress(done, case.name, &subject.name);
            reports.push(measure(case, subject, &mut doubles));
            done += 1;
        }
    }
    reports
}

/// What a network answered to random fragments, in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomReport {
    /// Its name, and how it was run.
    pub network: String,
    /// The frame of the moments.
    pub frame: MomentFrame,
    /// How many answers are what they must not be.
    pub counts: Counts,
    /// What the network promises.
    pub promise: Promise,
    /// How long it took \[s\].
    pub seconds: f64,
}

impl RandomReport {
    /// The promises that were broken, in words.
    pub fn broken(&self) -> Vec<String> {
        let c = &self.counts;
        let ends = self.promise == Promise::Ends;
        let kinds = [
            (true, c.nonfinite, "are not finite"),
            (true, c.out_of_range, "are outside [0, 1]"),
            (ends, c.nearest_not_one, "to the nearest fragment are not 1"),
            (ends, c.single_not_one, "to a single fragment are not 1"),
        ];
        let of = |(promised, count, what): (bool, u64, &str)| {
            (promised && count > 0)
                .then(|| format!("{}: random: {count} of {} answers {what}", self.network, c.fragments))
        };
        kinds.into_iter().filter_map(of).collect()
    }
}

/// The frames in which a network can be run: after a prepass only where its moments are of logarithmic depth.
fn frames(promise: Promise) -> &'static [MomentFrame] {
    if promise == Promise::Ends {
        &[MomentFrame::Scene, MomentFrame::Pixel]
    } else {
        &[MomentFrame::Scene]
    }
}

/// Evaluates every network for at least so many random fragments, once in one pass and once after a prepass. `progress`
/// is told the network and how many fragments are done.
///
/// # Errors
/// [`SuiteError`] where a network cannot answer.
pub fn random(
    mlps: &[Mlp],
    fragments: u64,
    seed: u64,
    progress: &(dyn Fn(&str, u64) + Sync),
) -> Result<Vec<RandomReport>, SuiteError> {
    let mut reports = Vec::new();
    for mlp in mlps {
        let promise = Subject::network(mlp, Execution::default())?.promise;
        for &frame in frames(promise) {
            let execution = Execution {
                frame,
                ..Execution::default()
            };
            let network = Subject::network(mlp, execution)?.name;
            let start = Instant::now();
            let counts = hunt(mlp, frame, fragments, seed, &|n| progress(&network, n))?;
            let seconds = start.elapsed().as_secs_f64();
            reports.push(RandomReport {
                network,
                frame,
                counts,
                promise,
                seconds,
            });
        }
    }
    Ok(reports)
}

/// Number of places of all sweeps.
pub const PLACES: usize = sweep::HALF_RANGES.len() + sweep::COUNTS.len() + sweep::DIGITS.len();

/// Whether a network promises exact ends.
fn has_exact_ends(mlp: &Mlp) -> bool {
    Subject::network(mlp, Execution::default()).is_ok_and(|s| s.promise == Promise::Ends)
}

/// What the sweeps over half-range and number of fragments compare.
fn swept(mlps: &[Mlp]) -> Result<Vec<Subject<'static>>, SuiteError> {
    let prepass = Execution {
        frame: MomentFrame::Pixel,
        ..Execution::default()
    };
    let mut subjects = Vec::new();
    for mlp in mlps {
        subjects.push(Subject::network(mlp, Execution::default())?);
        if has_exact_ends(mlp) {
            subjects.push(Subject::network(mlp, prepass)?);
        }
    }
    let recentred = mlps.iter().find(|mlp| has_exact_ends(mlp));
    let of_four = recentred.filter(|mlp| mlp.feature_set().moments() == 4);
    subjects.extend(of_four.map(|mlp| TwoMoments::Beta.subject(mlp)));
    subjects.extend(recentred.map(|mlp| TwoMoments::Bounds.subject(mlp)));
    for name in CHART_METHODS {
        subjects.push(classic_method(name)?);
    }
    Ok(subjects)
}

/// Every place of the three sweeps, with `pixels` random pixels each. `progress` is told how many places are done, and
/// which sweep is next.
///
/// # Errors
/// [`SuiteError::Shape`].
pub fn sweeps(mlps: &[Mlp], pixels: usize, progress: &dyn Fn(u64, &str)) -> Result<Vec<Point>, SuiteError> {
    let subjects = swept(mlps)?;
    let mut points = Vec::new();
    let mut done = 0;
    let mut step = |what: &str| {
        progress(done, what);
        done += 1;
    };
    for half in sweep::HALF_RANGES {
        step("half-range");
        let fragments = sweep::of_half_range(half, pixels);
        points.extend(sweep::points("half_range", half, &fragments, &subjects));
    }
    for n in sweep::COUNTS {
        step("number of fragments");
        let pixels = pixels.min(MAX_CHART_FRAGMENTS / n as usize).max(10);
        let fragments = sweep::of_count(n, pixels);
        points.extend(sweep::points("fragments_per_pixel", n.into(), &fragments, &subjects));
    }
    let usual = sweep::usual(pixels);
    for digits in sweep::DIGITS {
        step("digits");
        let mut subjects = Vec::new();
        for mlp in mlps.iter().filter(|mlp| has_exact_ends(mlp)) {
            subjects.extend([MomentFrame::Scene, MomentFrame::Pixel].map(|frame| with_digits(mlp, digits, frame)));
        }
        subjects.extend(Classic::power_with_digits(digits));
        points.extend(sweep::points("storage_digits", digits.into(), &usual, &subjects));
    }
    Ok(points)
}

/// Files of the charts, in the order of [`charts`].
pub const CHARTS: [&str; 3] = ["range.svg", "count.svg", "digits.svg"];

/// The sweeps as charts in SVG, each with the name of its file.
pub fn charts(points: &[Point]) -> Vec<(&'static str, String)> {
    let labels = [
        (
            "half_range",
            "Error of transmittance against the pixel's range",
            "half of the pixel's range in moment depth",
            true,
        ),
        (
            "fragments_per_pixel",
            "Error of transmittance against depth complexity",
            "fragments in the pixel",
            true,
        ),
        (
            "storage_digits",
            "Error of transmittance against the precision of stored moments",
            "significant binary digits",
            false,
        ),
    ];
    let mut charts = Vec::new();
    for ((sweep, title, x, log_x), name) in labels.into_iter().zip(CHARTS) {
        let axis = |label: &str, scale| Axis {
            label: label.to_owned(),
            scale,
        };
        let across = if log_x {
            Scale::Log { decades: 12 }
        } else {
            Scale::Linear
        };
        let chart = Chart {
            summary: title.to_owned(),
            x: axis(x, across),
            y: axis("T-MSE", Scale::Log { decades: 7 }),
            series: series(points.iter().filter(|p| p.sweep == sweep)),
        };
        let svg = chart.document(
            title,
            "Broken lines: the same method run in another way. Crosses: some answers are NaN.",
        );
        charts.extend(svg.map(|svg| (name, svg)));
    }
    charts
}

/// A line a method, of the places where its error is greater than 0, and crosses where some answers are no numbers.
fn series<'a>(points: impl Iterator<Item = &'a Point>) -> Vec<Series> {
    let mut lines: Vec<Series> = Vec::new();
    let mut crosses: Vec<Series> = Vec::new();
    // A method that is run in several ways has one colour, and is drawn broken from the second on.
    let mut methods: Vec<String> = Vec::new();
    for p in points {
        let Some(mse) = p.mse.filter(|&mse| mse > 0.0) else {
            continue;
        };
        let at = lines.iter().position(|l| l.name == p.method).unwrap_or_else(|| {
            let method = p.method.split(" @ ").next().unwrap_or("");
            let known = methods.iter().position(|m| m == method);
            let color = known.unwrap_or_else(|| {
                methods.push(method.to_owned());
                methods.len() - 1
            });
            let of = |name: &str, mark| Series {
                name: name.to_owned(),
                points: Vec::new(),
                mark,
                color,
            };
            let again = known.is_some() || color >= COLORS;
            lines.push(of(&p.method, if again { Mark::Dashed } else { Mark::Line }));
            crosses.push(of("", Mark::Cross));
            lines.len() - 1
        });
        let point = chart::Point {
            x: p.x,
            y: mse,
            spread: None,
            title: format!("{}: {mse:.2e} at {}", p.method, p.x),
        };
        if p.nonfinite > 0 {
            crosses[at].points.push(point.clone());
        }
        lines[at].points.push(point);
    }
    // From left to right, whatever the order of the sweep.
    for line in &mut lines {
        line.points.sort_by(|a, b| a.x.total_cmp(&b.x));
    }
    lines.into_iter().chain(crosses).collect()
}
