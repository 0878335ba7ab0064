//! What methods say that they cost, against what their passes bind and blend.

use super::MethodShader;
use super::passes::{Holds, Limits, Shaders, TargetPrecision};
use crate::export::Format;
use crate::model::shipped;
use crate::oit::neural::Neural;
use crate::oit::{Capabilities, Method, Needs, names_with_shader, parse};
use naga::{AddressSpace, Binding, ScalarKind, StorageAccess, TypeInner};

/// What the WGSL of a frame's passes binds and writes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bound {
    /// Bits of a pixel that pass 1 writes, colour targets and what it does atomically.
    bits: u32,
    /// Draws of the geometry.
    draws: u32,
    /// Whether pass 1 works on a buffer by atomics.
    atomics: bool,
    /// Whether an f32 target is added up in.
    f32_blending: bool,
    /// Numbers that pass 2 adds up, in bits.
    colour_bits: u32,
}

/// Bits of the numbers that an entry point returns.
fn returned(module: &naga::Module, entry: &str) -> u32 {
    let entry = module.entry_points.iter().find(|e| e.name == entry).expect(entry);
    let Some(result) = &entry.function.result else { return 0 };
    let bits = |inner: &TypeInner| match *inner {
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => 8 * u32::from(scalar.width),
        TypeInner::Vector { size, scalar } => 8 * u32::from(scalar.width) * size as u32,
        ref other => panic!("no target: {other:?}"),
    };
    match &module.types[result.ty].inner {
        TypeInner::Struct { members, .. } => members
            .iter()
            .filter(|m| matches!(m.binding, Some(Binding::Location { .. })))
            .map(|m| bits(&module.types[m.ty].inner))
            .sum(),
        inner => bits(inner),
    }
}

/// Reads the passes of a method on a device that writes everything in one draw.
fn bound(method: &MethodShader) -> Bound {
    let unlimited = Limits {
        bytes_per_pixel: u32::MAX,
        targets: u32::MAX,
    };
    let shaders = Shaders::new(method, TargetPrecision::Full, unlimited);
    let parsed =
        |source: &str| naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    let pass1: Vec<naga::Module> = shaders.pass1.iter().map(|(source, _)| parsed(source)).collect();
    let written = pass1.iter().flat_map(|m| m.global_variables.iter());
    let atomics = written
        .filter(|(_, v)| matches!(v.space, AddressSpace::Storage { access } if access.contains(StorageAccess::STORE)))
        .count();
    assert!(atomics <= 1, "one buffer of cores");
    let slots = shaders.pass1[0].0.split_once("const NMT_SLOTS: u32 = ");
    let slots = slots.and_then(|(_, rest)| rest.split_once("u;")?.0.parse::<u32>().ok());
    let core = if atomics == 1 {
        32 * slots.expect("slots of a core")
    } else {
        0
    };
    assert_eq!(atomics == 1, method.needs_atomics(), "{}", method.name);
    let added = |target: &super::passes::Target| matches!(target.holds, Holds::Added { .. });
    Bound {
        bits: pass1.iter().map(|m| returned(m, "oit_pass1")).sum::<u32>() + core,
        draws: pass1.len() as u32 + 1,
        atomics: atomics == 1,
        f32_blending: shaders.targets.iter().any(added),
        colour_bits: returned(&parsed(&shaders.pass2), "oit_pass2"),
    }
}

/// What a method says, in the same words.
fn said(capabilities: Capabilities) -> Bound {
    Bound {
        bits: capabilities.bits_per_pixel.unwrap_or(0),
        draws: capabilities.geometry_passes,
        atomics: capabilities.needs.atomics,
        f32_blending: capabilities.needs.f32_blending,
        colour_bits: capabilities.colour_bits_per_pixel,
    }
}

/// Memory, draws, atomics and blending of every method that the reference pipeline draws, shipped networks among them,
/// are what its passes bind, and nothing else is asked for. Methods of one pass, which blend colours and what is left
/// of the background, are the exception: the pipeline draws them as all others, in two passes, and their numbers are
/// those of their sources. Control: a method that says one number, a draw or a need more or less is found.
#[test]
fn capabilities_are_what_passes_bind() {
    let mut methods: Vec<(Capabilities, MethodShader)> = Vec::new();
    for name in names_with_shader() {
        let method = parse(&name).unwrap();
        methods.push((method.capabilities(), method.shader().unwrap()));
    }
    for name in shipped::names() {
        let mlp = shipped::named(name).unwrap();
        if let Ok(shader) = MethodShader::neural(&mlp, Format::WGSL) {
            methods.push((Neural::new(mlp).capabilities(), shader));
        }
    }
    let (mut compared, mut with_core) = (0, 0);
    for (capabilities, shader) in methods {
        let (found, name) = (bound(&shader), &shader.name);
        if capabilities.geometry_passes == 1 {
            assert!(name.starts_with("weighted-"), "{name}");
            continue;
        }
        let same = |capabilities: Capabilities| said(capabilities) == found;
        assert!(
            same(capabilities),
            "{name} says {:?}, and binds {found:?}",
            said(capabilities)
        );
        assert!(!capabilities.order_dependent, "{name}");
        let needs = Needs {
            atomics: found.atomics,
            f32_blending: found.f32_blending,
            ..Needs::NONE
        };
        assert_eq!(capabilities.needs, needs, "{name}");
        let bits = found.bits;
        for bits_per_pixel in [None, Some(bits - 16), Some(bits + 32)] {
            assert!(
                !same(Capabilities {
                    bits_per_pixel,
                    ..capabilities
                }),
                "the control of {name}"
            );
        }
        assert!(!same(Capabilities {
            geometry_passes: found.draws + 1,
            ..capabilities
        }));
        for needs in [
            Needs {
                atomics: !needs.atomics,
                ..needs
            },
            Needs {
                f32_blending: false,
                ..needs
            },
        ] {
            assert!(!same(Capabilities { needs, ..capabilities }), "the control of {name}");
        }
        compared += 1;
        with_core += u32::from(found.atomics);
    }
    assert!(
        compared > 20 && with_core >= 2,
        "{compared} methods, {with_core} with a core"
    );
}
