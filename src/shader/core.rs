//! Text of the passes of methods that keep a core.

use super::absorbance;
use crate::export::Target;
use crate::export::core::weigh::OPEN_SWITCH;
use crate::export::core::{codes, ends, gathered, weigh, weigh_by_network};
use crate::export::shader::ENTRY;
use crate::features::core::CoreSet;

/// Prelude and method of a core whose tail is shared out by a network, of which this is the export, or where there is
/// none by a beta law. The network is asked where the bounds leave more than `open` of T open.
pub(super) fn module(set: CoreSet, network: &str, open: f32) -> String {
    let weigh = match network {
        "" => weigh(set, Target::Wgsl),
        _ => weigh_by_network(set, Target::Wgsl, open),
    };
    let listed = |items: Vec<String>| items.join(", ");
    let lanes = ["x", "y", "z", "w"];
    let added = listed((0..set.moments).map(|k| format!("moments.{}", lanes[k])).collect());
    let slots = gathered(set, Target::Wgsl, &|i| format!("p.core[{i}]"));
    let sum = |k: usize| match k < set.moments {
        true => format!("p.sums[{}]", k + 1),
        false => "0.0".to_owned(),
    };
    let moments = format!("vec4<f32>({})", listed((0..4).map(sum).collect()));
    let short = match network {
        "" => String::new(),
        _ => short(&weigh, &slots, &moments),
    };
    let values = match set.is_blended() {
        true => ends::values(set, Target::Wgsl),
        false => String::new(),
    };
    let prelude = include_str!("core/prelude.wgsl")
        .replace("OIT_PIXEL_MOMENTS", &moments)
        .replace("OIT_MOMENTS", &added)
        .replace("OIT_SLOTS", &slots);
    format!(
        "{network}\nconst OIT_SUMS = {}u;\nconst OIT_CORE = {}u;\n\n{}{values}{}{}{prelude}{short}",
        set.moments + 2,
        set.stride() / 2,
        codes(set, Target::Wgsl),
        weigh,
        absorbance(),
    )
}

/// The weight in pixels that need no network, which is the network's weight without it: `oit_short_weight`.
fn short(weigh: &str, slots: &str, moments: &str) -> String {
    let (before, call) = weigh.split_once(&format!("{ENTRY}(")).expect("a call of the network");
    let mut open = 1;
    let end = call.find(|c| {
        open += i32::from(c == '(') - i32::from(c == ')');
        open == 0
    });
    let text = format!("{before}1.0{}", &call[end.expect("the end of the call") + 1..]);
    // The switch stands above.
    let mut text = text.replacen(
        &format!("\nconst {OPEN_SWITCH}"),
        &format!("\n// const {OPEN_SWITCH}"),
        1,
    );
    for line in weigh.lines().filter_map(|line| line.strip_prefix("fn ")) {
        let name = line.split('(').next().expect("a name");
        text = text.replace(&format!("{name}("), &format!("{}_known(", name.replace("nmt_", "oit_")));
    }
    format!(
        "{text}\nfn oit_short_weight(f: OitFragment, p: OitPixel) -> f32 {{\n    return oit_core_transmittance_known(\
         f.steps, oit_codes(), {slots}, p.sums[OIT_SUMS - 1u], p.sums[0], {moments});\n}}\n"
    )
}

/// How a thread that goes over a pixel's list keeps its core: `oit_insert`.
pub(super) fn list(set: CoreSet) -> String {
    let heavy = (2..set.slots()).map(|slot| {
        format!(
            "let kept{slot} = (*core)[{slot}]; (*core)[{slot}] = max(kept{slot}, code); code = min(kept{slot}, code);"
        )
    });
    include_str!("core/list.wgsl").replace("OIT_HEAVY", &heavy.collect::<Vec<_>>().join("\n    "))
}

/// The core of a pixel as the last member of `OitPixel`, from the target of this index, in which blending kept both
/// ends.
pub(super) fn member_of_ends(target: usize) -> String {
    format!(", array<vec2<u32>, OIT_CORE>(nmt_core_ends(textureLoad(oit_target{target}, at, 0).xy))")
}

/// The core of a pixel as the last member of `OitPixel`, from a buffer of pairs; nothing where the method keeps none.
pub(super) fn member(set: Option<CoreSet>) -> String {
    let Some(set) = set else { return String::new() };
    let items: Vec<String> = (0..set.stride() / 2)
        .map(|i| format!("oit_core[pixel * OIT_CORE + {i}u]"))
        .collect();
    format!(", array<vec2<u32>, OIT_CORE>({})", items.join(", "))
}
