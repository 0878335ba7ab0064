//! Compute passes over per-pixel lists, which need no blending.
//!
//! [`ListShaders`] are a method's arithmetic without a renderer around it; [`TileShaders`] make an image, with the
//! network only for the fragments that need it.

use super::passes::{FRAME, composite};
use super::{MethodShader, core};
use crate::export::core::known_fragments;
use crate::features::core::CoreSet;
use crate::features::visible::{FAINT, HIDDEN, MIN_WEIGHT};
use crate::oit::neural::Skip;
use crate::oit::shader::{Composite, Pass1};

/// Entry point of pass 1, a thread a pixel, 64 to a workgroup.
pub const ACCUMULATE: &str = "oit_accumulate_list";
/// Entry point of pass 2 of [`ListShaders`], a thread a fragment, 64 to a workgroup.
pub const WEIGH: &str = "oit_weigh_list";
/// Entry point of [`TileShaders::every`], a thread a pixel in tiles of [`TILE`].
pub const EVERY: &str = "oit_every_pixel";
/// Entry point of [`TileShaders::classify`], a thread a pixel in tiles of [`TILE`].
pub const CLASSIFY: &str = "oit_classify";
/// Entry point of [`TileShaders::network`] and [`TileShaders::hiding`], dispatched indirectly.
pub const LISTED: &str = "oit_listed_pixels";

/// The buffer of cores in pass 1, where a method keeps them.
const CORE_WRITTEN: &str = "\n@group(0) @binding(5) var<storage, read_write> oit_core: array<u32>;\n";
/// Binding of the cores in pass 2 of [`ListShaders`].
const LIST_CORE: u32 = 6;
/// Binding of the cores in [`TileShaders`] behind pass 1.
pub const TILE_CORE: u32 = 8;

/// Pixels of a workgroup in each direction.
pub const TILE: u32 = 8;

/// Workgroups in a row of an indirect dispatch.
const ROW: &str = "32768u";

/// Greatest b_0 of a pixel that shows less than half a display step: 1 − e^−b_0 < 1/512.
const MIN_OPACITY: f32 = 1.0 / 512.0;

/// What pass 1 leaves of a pixel, four numbers to a vector: the sums, and where they are kept number and range of its
/// fragments, the range with its moment depths, so that no fragment warps the depths of others.
#[derive(Debug, Clone, Copy)]
struct State {
    sums: usize,
    range: bool,
    pass1: Pass1,
    core: Option<CoreSet>,
}

impl State {
    fn numbers(self) -> usize {
        self.sums + if self.range { 5 } else { 0 }
    }

    fn vectors(self) -> usize {
        self.numbers().div_ceil(4)
    }

    fn accumulate(self) -> String {
        let kept = [
            "f32(oit_offsets[pixel + 1u] - oit_offsets[pixel])",
            "nearest",
            "farthest",
            "oit_depth(nearest, oit_frame.range)",
            "oit_depth(farthest, oit_frame.range)",
        ];
        let vectors = self.vectors();
        let number = |i: usize| match i.checked_sub(self.sums) {
            None => format!("sums[{i}]"),
            Some(i) if self.range && i < kept.len() => kept[i].to_owned(),
            Some(_) => "0.0".to_owned(),
        };
        let store = |i: usize| {
            let four: Vec<String> = (4 * i..4 * i + 4).map(number).collect();
            let vector = four.join(", ");
            format!("oit_state[pixel * {vectors}u + {i}u] = vec4<f32>({vector});")
        };
        let add: Vec<String> = (0..self.sums).map(|i| format!("sums[{i}] += term[{i}];")).collect();
        let (prepass, add) = match self.pass1 {
            Pass1::Added => ("", format!("let term = oit_accumulate(f); {}", add.join(" "))),
            Pass1::Inserted => {
                let add = "oit_add_to(&sums, f, ends.x, ends.y);".to_owned();
                (include_str!("prepass.wgsl").trim_end(), add)
            }
        };
        let stores: Vec<String> = (0..vectors).map(store).collect();
        let mut stores: Vec<String> = stores;
        let (mut head, mut variable, mut insert) = (String::new(), "", "");
        if let Some(set) = self.core {
            let slot = |i: usize| format!("oit_core[pixel * NMT_SLOTS + {i}u] = core[{i}];");
            stores.extend((0..set.stride()).map(slot));
            head = format!("{CORE_WRITTEN}{}", core::list(set));
            variable = "var core: array<u32, NMT_SLOTS>;";
            insert = "oit_insert(&core, f.steps);";
        }
        let text = include_str!("accumulate.wgsl")
            .replace("OIT_PREPASS", prepass)
            .replace("OIT_ADD", &add)
            .replace("OIT_STORE", &stores.join("\n    "))
            .replace("OIT_CORE_VARIABLE", variable)
            .replace("OIT_INSERT", insert);
        head + &text
    }

    /// `fn oit_pixel`; the core is read from this binding.
    fn load(self, binding: u32) -> String {
        let vectors = self.vectors();
        let loads: Vec<String> = (0..vectors)
            .map(|i| format!("let state{i} = oit_state[pixel * {vectors}u + {i}u];"))
            .collect();
        let number = |i: usize| format!("state{}[{}]", i / 4, i % 4);
        let sums: Vec<String> = (0..self.sums).map(number).collect();
        let range: Vec<String> = (self.sums..self.sums + 5).map(number).collect();
        let range = if self.range {
            range.join(", ")
        } else {
            // As one fragment at depth 1.
            "0.0, 1.0, 1.0, 0.0, 0.0".to_owned()
        };
        let core = self.core.map_or(String::new(), |_| {
            format!("\n@group(0) @binding({binding}) var<storage, read> oit_core: array<vec2<u32>>;\n\n")
        });
        let text = include_str!("state.wgsl")
            .replace("OIT_CORE_MEMBER", &core::member(self.core))
            .replace("OIT_LOAD", &loads.join("\n    "))
            .replace("OIT_PARTS", &sums.join(", "))
            .replace("OIT_RANGE", &range);
        core + &text
    }
}

/// Both passes of a method over a list, as whole WGSL modules.
///
/// Bind group 0: 0 the frame; 1 offsets of pixels in pass 1, pixels of fragments in pass 2; 2 view depths; 3 opacities;
/// 4 what pass 1 leaves; 5 weights. Where a method keeps cores, they are binding 5 of pass 1 and 6 of pass 2.
#[derive(Debug, Clone, PartialEq)]
pub struct ListShaders {
    /// Pass 1.
    pub accumulate: String,
    /// Pass 2.
    pub weigh: String,
    /// Vectors of four numbers that pass 1 leaves of a pixel.
    pub vectors: usize,
}

impl ListShaders {
    /// Shaders of a method.
    pub fn new(method: &MethodShader) -> Self {
        let state = State {
            sums: method.sums,
            range: method.range,
            pass1: method.pass1,
            core: method.core,
        };
        let module = method.module();
        let weigh = include_str!("weigh.wgsl").replace("OIT_WEIGHT", method.weight);
        Self {
            accumulate: format!("{module}{FRAME}{}", state.accumulate()),
            weigh: format!("{module}{FRAME}{}{weigh}", state.load(LIST_CORE)),
            vectors: state.vectors(),
        }
    }
}

/// Passes that make an image of per-pixel lists, as whole WGSL modules.
///
/// Pass 1 leaves sums, number and range of a pixel's fragments. `every` shades all pixels with the network. Or pixels
/// are told apart: `classify` shades those that need no network at once and lists the others by kind, `network` and
/// `hiding` shade the listed ones.
///
/// Bind group 0 behind pass 1: 0 the frame, 1 offsets, 2 view depths, 3 opacities, 4 colours, 5 what pass 1 left, 6 the
/// image, 7 the lists of pixels, 8 the cores where a method keeps them.
#[derive(Debug, Clone, PartialEq)]
pub struct TileShaders {
    /// Pass 1; its bindings are those of [`ListShaders`].
    pub accumulate: String,
    /// Pass 2 and the resolve, the network for every fragment; it has no lists.
    pub every: String,
    /// Pixels told apart: without and with what cannot be seen.
    pub classify: [String; 2],
    /// Listed pixels, the network for every fragment.
    pub network: String,
    /// Listed pixels in which fragments may be hidden; none where the method cannot tell.
    pub hiding: Option<String>,
    /// Listed pixels, the network where the bounds of a core's tail leave T open; none where there is no such network.
    pub open: Option<String>,
    /// Vectors of four numbers that pass 1 leaves of a pixel.
    pub vectors: usize,
}

impl TileShaders {
    /// Shaders of a method.
    pub fn new(method: &MethodShader) -> Self {
        let state = State {
            sums: method.sums,
            range: true,
            pass1: method.pass1,
            core: method.core,
        };
        let module = method.module();
        let composite = composite(method.composite);
        let shared = format!(
            "{module}{FRAME}{composite}{}{}",
            include_str!("shade.wgsl"),
            state.load(TILE_CORE)
        );
        let hiding = include_str!("hiding.wgsl")
            .replace("OIT_HIDDEN", &format!("{HIDDEN:?}"))
            .replace("OIT_LEAST_WEIGHT", &format!("{MIN_WEIGHT:?}"));
        let hiding = method.offers.visibility.then(|| listed(&shared, &hiding, "1u"));
        let spared = method.clone().with_skip(Skip::Visible);
        let open = (spared.open > 0.0).then(|| {
            let text = format!("{}{}", spared.module(), &shared[module.len()..]);
            listed(&text, include_str!("network.wgsl"), "0u")
        });
        Self {
            accumulate: format!("{module}{FRAME}{}", state.accumulate()),
            every: format!("{shared}{}", include_str!("every.wgsl")),
            classify: [false, true].map(|visible| format!("{shared}{}", classify(method, visible))),
            network: listed(&shared, include_str!("network.wgsl"), "0u"),
            hiding,
            open,
            vectors: state.vectors(),
        }
    }
}

/// The shader that tells pixels apart: whether one is `known` or `faint`, what `kind` it is else, and the weight of
/// fragments of the known.
fn classify(method: &MethodShader, visible: bool) -> String {
    let offers = method.offers;
    // What has no short form needs the long one wherever there is a fragment.
    let (known, short) = match method.core {
        Some(set) if offers.short_weight => (
            format!("state.sums[OIT_SUMS - 1u] <= {}.0", known_fragments(set)),
            "oit_short_weight(f, state)",
        ),
        None if offers.short_weight => (
            "state.n <= 4.0 || state.nearest >= state.farthest".to_owned(),
            "oit_short_weight(f, state)",
        ),
        _ => ("state.n == 0.0".to_owned(), "0.0"),
    };
    let (kinds, weight) = if visible && offers.visibility {
        let faint = format!("select({short}, oit_faint_weight(f, state), faint && !known)");
        (include_str!("kinds_visible.wgsl"), faint)
    } else if visible && method.composite == Composite::Normalised {
        // Both mean colours lie in [0, 1], whatever the weights.
        (include_str!("kinds_faint.wgsl"), "1.0".to_owned())
    } else {
        (include_str!("kinds_exact.wgsl"), short.to_owned())
    };
    include_str!("classify.wgsl")
        .replace("OIT_KINDS", kinds.trim_end())
        .replace("OIT_KNOWN", &known)
        .replace("OIT_WEIGHT", &weight)
        .replace("OIT_FAINT", &format!("{FAINT:?}"))
        .replace("OIT_MIN_OPACITY", &format!("{MIN_OPACITY:?}"))
        .replace("OIT_ROW", ROW)
}

/// The shader of pixels of one kind that need the network.
fn listed(shared: &str, way: &str, kind: &str) -> String {
    let listed = include_str!("listed.wgsl")
        .replace("OIT_LOOP", way.trim_end())
        .replace("OIT_ROW", ROW)
        .replace("OIT_KIND", kind);
    format!("{shared}{listed}")
}
