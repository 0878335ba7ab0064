//! The methods that were asked for.

use super::{Evaluate, shadows};
use crate::export::Format;
use crate::features::MomentFrame;
use crate::gpu::MethodShader;
use crate::model::shipped;
use crate::oit::neural::Neural;
use crate::oit::{Method, all_names, parse, shader_of};
use crate::shader::ShaderError;
use std::collections::HashSet;
use std::path::Path;

/// The methods that tell the story: what blending costs nothing gives, what moments, wavelets, layers and luck give.
pub const STORY: [&str; 9] = [
    "weighted-blended:mb13-9",
    "weighted-blended:mb13-9:best-scale",
    "moment-power-4",
    "moment-power-8",
    "moment-trig-4+own",
    "wavelet:3:f16",
    "hybrid:6",
    "multi-layer-alpha:4",
    "stochastic:8",
];

/// A method that was asked for.
pub struct Requested {
    pub method: Box<dyn Method>,
    /// Whether it was asked for by its own name.
    pub demanded: bool,
    /// Whether `--skip` is for it: a network of `--model`.
    pub skips: bool,
    /// What the GPU runs; none where there is no shader for it.
    pub shader: Option<Result<MethodShader, ShaderError>>,
}

fn network_shader(path: &Path) -> anyhow::Result<Result<MethodShader, ShaderError>> {
    Ok(MethodShader::neural(&shipped::open(path)?, Format::WGSL))
}

impl Evaluate {
    /// Methods by name, each once, then networks.
    pub(super) fn requested(&self) -> anyhow::Result<Vec<Requested>> {
        let mut methods = Vec::new();
        let mut seen = HashSet::new();
        let story = || if self.shadows { &shadows::STORY[..] } else { &STORY[..] };
        let names = if self.methods.is_empty() {
            story().iter().map(|&name| name.to_owned()).collect()
        } else {
            self.methods.clone()
        };
        for name in &names {
            let (names, demanded) = if name == "all" {
                (all_names(), false)
            } else {
                (vec![name.clone()], true)
            };
            for name in names {
                if seen.insert(name.clone()) {
                    methods.push(self.classic(&name, demanded)?);
                }
            }
        }
        for path in &self.model {
            methods.extend(self.network(path)?);
        }
        Ok(methods)
    }

    fn classic(&self, name: &str, demanded: bool) -> anyhow::Result<Requested> {
        let method = parse(name)?;
        let shader = match name.strip_prefix("neural:") {
            _ if !self.gpu => None,
            Some(path) => Some(network_shader(Path::new(path))?),
            None => shader_of(name).map(Ok),
        };
        Ok(Requested {
            method,
            demanded,
            skips: false,
            shader,
        })
    }

    /// A network, and with `--prepass` the same network on moments of the pixel's own frame, where its moments have
    /// one.
    fn network(&self, path: &Path) -> anyhow::Result<Vec<Requested>> {
        let neural = || shipped::open(path).map(|mlp| Neural::new(mlp).with_skip(self.skip.into()));
        let mut requested = vec![Requested {
            method: Box::new(neural()?),
            demanded: true,
            skips: true,
            shader: self.gpu.then(|| network_shader(path)).transpose()?,
        }];
        let after = neural()?.with_frame(MomentFrame::Pixel);
        if self.prepass && after.frame() == MomentFrame::Pixel {
            requested.push(Requested {
                method: Box::new(after),
                demanded: true,
                skips: true,
                shader: None,
            });
        }
        Ok(requested)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every one of them has a name, one of its own, and the names that stand for all hold it.
    #[test]
    fn the_story_is_part_of_all() {
        let all = all_names();
        for name in STORY.into_iter().chain(shadows::STORY) {
            assert_eq!(parse(name).unwrap().name(), name);
        }
        for name in STORY {
            assert!(all.iter().any(|n| n == name), "{name}");
        }
    }
}
