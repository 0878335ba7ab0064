//! Both passes and the resolve as a renderer makes them, as whole WGSL modules that can be lifted into one: render
//! passes whose targets are blended into, in whatever order the fragments come. `docs/integration.md` says what a
//! renderer does otherwise.
//!
//! | pass | targets | blending |
//! |---|---|---|
//! | 1 | sums of the method and number of fragments, four to a texture | add |
//! | 1 | (−v, v) as rg32float, or both ends of a core as codes | max |
//! | 2 | Σ a w C and Σ a w | add |
//! | resolve | colour | none |
//!
//! Where f32 targets cannot be blended into, [`TargetPrecision::Half`] keeps sums as f16 and both ends of the range in
//! depth buffers, a draw each.

use super::MethodShader;
use crate::export::Target as Language;
use crate::export::core::{CoreBinding, insert};
use crate::export::recentred::with_rounding;
use crate::oit::shader::Composite;

/// How sums are stored between the passes. Both ends of a pixel's range are f32 in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TargetPrecision {
    /// All f32; blending needs the feature `float32-blendable`.
    #[default]
    Full,
    /// Σ a w C and Σ a w as rgba16float, which rounds to 11 bits with every fragment; moments f32.
    HalfColor,
    /// All sums f16, which every device blends into; the range through two depth buffers.
    ///
    /// # Accuracy
    /// For networks only: methods that reconstruct a curve from moments need other constants for 16 bits, and answer
    /// NaN with these. Test `half_storage_costs_little`.
    Half,
}

impl TargetPrecision {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Full, Self::HalfColor, Self::Half];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::HalfColor => "half-color",
            Self::Half => "half",
        }
    }

    /// Whether passes blend into f32 targets.
    pub fn blends_f32(self) -> bool {
        self != Self::Half
    }
}

/// What a device lets pass 1 write at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of one pixel over all targets of a pass.
    pub bytes_per_pixel: u32,
    /// Targets of a pass.
    pub targets: u32,
}

impl Limits {
    /// What every WebGPU device allows.
    pub const WEBGPU: Self = Self {
        bytes_per_pixel: 32,
        targets: 8,
    };
}

/// How a number of a render target is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// f32.
    F32,
    /// f16.
    F16,
    /// f32 in a depth buffer.
    Depth,
}

/// A render target of pass 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// One, two or four numbers.
    pub channels: u32,
    /// How each is kept.
    pub channel: Channel,
    /// What it holds.
    pub holds: Holds,
}

/// What a render target of pass 1 holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holds {
    /// So many of the numbers that are added up, from the one of this index on; the number after the last sum is the
    /// number of fragments.
    Added {
        /// Index of the first.
        first: usize,
        /// How many.
        count: usize,
    },
    /// (−v, v), of which the greatest is kept: −nearest and farthest.
    Range,
    /// Both ends of a core, of which the greatest codes are kept.
    Ends,
    /// The least v, scaled, in a depth buffer.
    Nearest,
    /// The greatest v, scaled, in a depth buffer.
    Farthest,
}

impl Target {
    /// The targets that a method needs.
    pub fn of(method: &MethodShader, precision: TargetPrecision) -> Vec<Self> {
        let numbers = method.sums + usize::from(method.range);
        let half = precision == TargetPrecision::Half;
        let target = |channels, channel, holds| Self {
            channels,
            channel,
            holds,
        };
        let added = |first: usize| {
            let count = (numbers - first).min(4);
            let channel = if half { Channel::F16 } else { Channel::F32 };
            // There is no format of three.
            target([1, 2, 4, 4][count - 1], channel, Holds::Added { first, count })
        };
        let mut targets: Vec<Self> = (0..numbers).step_by(4).map(added).collect();
        match method.range {
            false => {}
            true if half => targets.extend([Holds::Nearest, Holds::Farthest].map(|h| target(1, Channel::Depth, h))),
            true => targets.push(target(2, Channel::F32, Holds::Range)),
        }
        if method.core.is_some_and(|core| core.is_blended()) {
            targets.push(target(2, Channel::F32, Holds::Ends));
        }
        targets
    }

    /// Bytes of a pixel.
    pub fn bytes(self) -> u32 {
        self.channels * if self.channel == Channel::F16 { 2 } else { 4 }
    }

    /// Whether it is a depth buffer.
    pub fn is_depth(self) -> bool {
        self.channel == Channel::Depth
    }

    fn wgsl_type(self) -> &'static str {
        ["f32", "vec2<f32>", "vec4<f32>"][self.channels as usize / 2]
    }

    /// What a fragment writes there.
    fn terms(self, sums: usize) -> String {
        let terms: Vec<String> = match self.holds {
            Holds::Range => vec!["-seen.v".to_owned(), "seen.v".to_owned()],
            Holds::Ends => vec!["nmt_core_end_values(seen.steps)".to_owned()],
            Holds::Nearest | Holds::Farthest => unreachable!("depth buffers have a shader of their own"),
            Holds::Added { first, .. } => (0..self.channels as usize)
                .map(|i| match first + i {
                    i if i < sums => format!("terms[{i}]"),
                    i if i == sums => "1.0".to_owned(),
                    _ => "0.0".to_owned(),
                })
                .collect(),
        };
        if terms.len() == 1 {
            terms[0].clone()
        } else {
            format!("{}({})", self.wgsl_type(), terms.join(", "))
        }
    }
}

/// The shader source of a frame: whole WGSL modules.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaders {
    /// All targets of pass 1.
    pub targets: Vec<Target>,
    /// Pass 1, and the indices of the targets that it writes; in several draws where the device does not write all at
    /// once. Entry points `oit_point` and `oit_pass1`.
    pub pass1: Vec<(String, Vec<usize>)>,
    /// Pass 2; entry points `oit_point` and `oit_pass2`.
    pub pass2: String,
    /// Resolve; entry points `oit_everywhere` and `oit_resolve`.
    pub resolve: String,
}

pub(super) const FRAME: &str = include_str!("passes/frame.wgsl");
const POINTS: &str = include_str!("passes/points.wgsl");
const PASS1: &str = include_str!("passes/pass1.wgsl");
const END: &str = include_str!("passes/end.wgsl");
const STATE: &str = include_str!("passes/state.wgsl");
const PASS2: &str = include_str!("passes/pass2.wgsl");
const RESOLVE: &str = include_str!("passes/resolve.wgsl");

/// Where render passes find the cores.
pub const CORE: CoreBinding = CoreBinding { group: 3, binding: 0 };
const CORE_READ: &str = "\n@group(3) @binding(0) var<storage, read> oit_core: array<vec2<u32>>;\n\n";
const INSERT: &str = "let place = vec2<u32>(f.position.xy);\n    \
                      nmt_core_insert(place.y * oit_frame.size.x + place.x, seen.steps, oit_codes());";

/// `fn oit_composite` of a way to composite.
pub(super) fn composite(composite: Composite) -> &'static str {
    match composite {
        Composite::Normalised => include_str!("passes/normalised.wgsl"),
        Composite::Sum => include_str!("passes/sum.wgsl"),
        Composite::Average => include_str!("passes/average.wgsl"),
    }
}

impl Shaders {
    /// Shader source for a method on a device with these limits.
    pub fn new(method: &MethodShader, precision: TargetPrecision, limits: Limits) -> Self {
        let targets = Target::of(method, precision);
        // Pass 1 in as few draws as the limits allow; a draw has one target at least, and a depth buffer is the only
        // one of its draw.
        let mut draws: Vec<Vec<usize>> = Vec::new();
        let mut bytes = 0;
        for (index, target) in targets.iter().enumerate() {
            bytes += target.bytes();
            match draws.last_mut() {
                Some(draw)
                    if !target.is_depth()
                        && bytes <= limits.bytes_per_pixel
                        && draw.len() < limits.targets as usize =>
                {
                    draw.push(index)
                }
                _ => {
                    bytes = target.bytes();
                    draws.push(vec![index]);
                }
            }
        }
        let module = method.module();
        // What thin pixels take for noise follows from how sums are stored.
        let module = if precision == TargetPrecision::Half {
            with_rounding(&module, crate::features::SumPrecision::F16.rounding().unit)
        } else {
            module
        };
        let pass1 = draws.into_iter().enumerate().map(|(index, draw)| {
            if targets[draw[0]].is_depth() {
                return (format!("{module}{FRAME}{POINTS}{END}"), draw);
            }
            let declared = |(location, &i): (usize, &usize)| {
                format!("@location({location}) target{i}: {},", targets[i].wgsl_type())
            };
            let declared: Vec<String> = draw.iter().enumerate().map(declared).collect();
            let terms: Vec<String> = draw.iter().map(|&i| targets[i].terms(method.sums)).collect();
            let entry = PASS1
                .replace("OIT_TARGETS", &declared.join("\n    "))
                .replace("OIT_TERMS", &terms.join(", "));
            // One draw keeps the core.
            let (call, core) = match method.core {
                Some(_) if index == 0 && method.needs_atomics() => (INSERT, insert(Language::Wgsl, CORE)),
                _ => ("", String::new()),
            };
            let entry = entry.replace("OIT_INSERT", call);
            (format!("{module}{FRAME}{POINTS}{core}{entry}"), draw)
        });
        let state = state(&targets, method.sums);
        let core_read = if method.needs_atomics() { CORE_READ } else { "" };
        let ends = targets.iter().position(|target| target.holds == Holds::Ends);
        let member = match ends {
            Some(ends) => super::core::member_of_ends(ends),
            None => super::core::member(method.core),
        };
        Self {
            pass1: pass1.collect(),
            pass2: format!(
                "{module}{FRAME}{POINTS}{state}{core_read}{}",
                PASS2
                    .replace("OIT_CORE_MEMBER", &member)
                    .replace("OIT_RANGE", &range(&targets))
                    .replace("OIT_WEIGHT", method.weight)
            ),
            resolve: format!(
                "const OIT_SUMS = {}u;\n\n{FRAME}{state}{}{RESOLVE}",
                method.sums,
                composite(method.composite)
            ),
            targets,
        }
    }
}

/// `fn oit_sums`, which reads what pass 1 left.
fn state(targets: &[Target], sums: usize) -> String {
    let (mut textures, mut loads) = (Vec::new(), Vec::new());
    for (i, target) in targets.iter().enumerate() {
        let kind = if target.is_depth() {
            "texture_depth_2d"
        } else {
            "texture_2d<f32>"
        };
        textures.push(format!("@group(2) @binding({i}) var oit_target{i}: {kind};"));
        if matches!(target.holds, Holds::Added { first, .. } if first < sums) {
            loads.push(format!("let target{i} = textureLoad(oit_target{i}, at, 0);"));
        }
    }
    let added = |i: usize| format!("target{}[{}]", i / 4, i % 4);
    let parts: Vec<String> = (0..sums).map(added).collect();
    let counted = targets
        .iter()
        .any(|t| !matches!(t.holds, Holds::Added { .. } | Holds::Ends));
    let count = if counted {
        format!("textureLoad(oit_target{}, at, 0)[{}]", sums / 4, sums % 4)
    } else {
        "0.0".to_owned()
    };
    STATE
        .replace("OIT_TEXTURES", &textures.join("\n"))
        .replace("OIT_LOADS", &loads.join("\n    "))
        .replace("OIT_PARTS", &parts.join(", "))
        .replace("OIT_COUNT", &count)
}

/// Range of a pixel's fragments; that of the frame where the method does not keep it.
fn range(targets: &[Target]) -> String {
    let place = |holds: Holds| targets.iter().position(|t| t.holds == holds);
    match (place(Holds::Range), place(Holds::Nearest).zip(place(Holds::Farthest))) {
        (Some(range), _) => format!(
            "let ends = textureLoad(oit_target{range}, at, 0);\n    let nearest = -ends.x;\n    let farthest = ends.y;"
        ),
        (None, Some((nearest, farthest))) => format!(
            "let nearest = textureLoad(oit_target{nearest}, at, 0) * oit_frame.scale.y;\n    let farthest = \
                textureLoad(oit_target{farthest}, at, 0) * \
             oit_frame.scale.y;"
        ),
        (None, None) => "let nearest = oit_frame.range.x;\n    let farthest = oit_frame.range.y;".to_owned(),
    }
}
