//! Multi-layer alpha blending: a k-buffer that merges its last two layers when it overflows.

use super::capabilities::{Capabilities, Needs};
use super::layered::Layered;
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::pixel::{FragmentList, Pixel, absorbance};

/// The stem of its name on the command line, `multi-layer-alpha:K`.
pub const NAME: &str = "multi-layer-alpha";

/// K layers of (depth, colour, transmittance), sorted by depth. Fragments are inserted in the order of the input,
/// behind layers of equal depth; when there are K + 1 layers, the last two become one at the nearer of their depths:
/// (C1 + T1 C2, T1 T2). At the end the layers are blended from front to back. Nothing is lost, but fragments that come
/// late and lie behind a merged layer are blended in the wrong place; the result depends on the order of the input
/// unless K is at least the number of fragments.
///
/// The composite is linear in the colours, and a fragment's weight is what it multiplies a C by.
///
/// # Source
/// Salvi, Vaidyanathan, *Multi-Layer Alpha Blending*, I3D 2014, Sec. 3.
#[derive(Debug, Clone, Copy)]
pub struct MultiLayerAlpha {
    /// Layers, K.
    pub layers: usize,
}

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "multi-layer-alpha:K",
    source: "Salvi, Vaidyanathan, I3D 2014",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    [4, 8, 16].map(|k| format!("{head}:{k}")).to_vec()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments
        .layers()
        .map(|layers| Box::new(MultiLayerAlpha { layers }) as _)
}

impl Method for MultiLayerAlpha {
    fn name(&self) -> String {
        format!("{NAME}:{}", self.layers)
    }

    /// A layer is a colour and a transmittance in RGBA16F and a depth in R32F.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: Some(96u32.saturating_mul(self.layers as u32)),
            colour_bits_per_pixel: 0,
            geometry_passes: 1,
            needs: Needs::INTERLOCK,
            order_dependent: true,
        }
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Layered::of(list, |buffer: &mut Buffer, pixel, out| {
            buffer.blend(self.layers, pixel, out)
        })))
    }
}

/// A layer: the fragment, or the merge, that it stands for; where it lies; what it lets through.
#[derive(Debug, Clone, Copy)]
struct Layer {
    node: usize,
    view_z: f32,
    transmittance: f64,
}

/// Two layers that became one: what they stood for, and what the front one let through.
#[derive(Debug, Clone, Copy)]
struct Merge {
    front: usize,
    back: usize,
    front_transmittance: f64,
}

/// A pixel's layers; colours are not blended but accounted for: node i < n is fragment i, node n + j is merge j.
#[derive(Debug, Default)]
struct Buffer {
    layers: Vec<Layer>,
    merges: Vec<Merge>,
    weights: Vec<f64>,
}

impl Buffer {
    fn blend(&mut self, k: usize, pixel: Pixel<'_>, out: &mut [f64]) -> f64 {
        let n = pixel.len();
        self.layers.clear();
        self.merges.clear();
        for (i, (&view_z, &alpha)) in pixel.view_z.iter().zip(pixel.alpha).enumerate() {
            let at = self.layers.partition_point(|layer| layer.view_z <= view_z);
            self.layers.insert(
                at,
                Layer {
                    node: i,
                    view_z,
                    transmittance: libm::exp(-absorbance(alpha)),
                },
            );
            if self.layers.len() > k {
                let back = self.layers.pop().expect("there are k + 1 layers");
                let front = self.layers.last_mut().expect("k is at least 1");
                self.merges.push(Merge {
                    front: front.node,
                    back: back.node,
                    front_transmittance: front.transmittance,
                });
                front.node = n + self.merges.len() - 1;
                front.transmittance *= back.transmittance;
            }
        }
        self.weights.clear();
        self.weights.resize(n + self.merges.len(), 0.0);
        let mut in_front = 1.0;
        for layer in &self.layers {
            self.weights[layer.node] = in_front;
            in_front *= layer.transmittance;
        }
        // Later merges contain earlier ones.
        for (j, merge) in self.merges.iter().enumerate().rev() {
            let weight = self.weights[n + j];
            self.weights[merge.front] = weight;
            self.weights[merge.back] = weight * merge.front_transmittance;
        }
        out.copy_from_slice(&self.weights[..n]);
        in_front
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;

    fn of(layers: usize, list: &FragmentList) -> [f64; 3] {
        image(&MultiLayerAlpha { layers }, list)[0]
    }

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        assert_close(&of(1, &one()), &[0.625, 0.5, 0.5]);
        // Red comes after green and lies in front of it: even one layer merges them in the right order.
        assert_close(&of(1, &two()), &[0.75, 0.5, 0.25]);
        // The other way round green goes behind red: right again.
        assert_close(&of(1, &reversed(&two())), &[0.75, 0.5, 0.25]);
        // Blue at 4, red at 1: merged at 1 with T = 1/4. Green at 2 then comes to lie behind both instead of between.
        assert_close(&of(1, &three()), &[0.5 + 0.125, 0.125 + 0.125, 0.25 + 0.125]);
        assert_close(&weights(&MultiLayerAlpha { layers: 1 }, &three()), &[0.5, 1.0, 0.25]);
        // Two layers: red, and green merged over blue.
        assert_close(&of(2, &three()), &exact_image(&three())[0]);
    }

    #[test]
    fn enough_layers_give_the_a_buffer() {
        assert_converges(|layers| Box::new(MultiLayerAlpha { layers }));
    }

    /// Colours blended layer by layer, as a renderer does it, give what the weights give.
    #[test]
    fn the_accounting_is_the_blending() {
        let list = scene(5);
        for k in [1, 2, 5] {
            let ours = image(&MultiLayerAlpha { layers: k }, &list);
            for (p, ours) in ours.iter().enumerate() {
                let pixel = list.pixel(p);
                let mut layers: Vec<(f32, [f64; 3], f64)> = Vec::new();
                for i in 0..pixel.len() {
                    let alpha = f64::from(pixel.alpha[i]);
                    let color = pixel.color.unwrap()[i].map(|c| alpha * f64::from(c));
                    let at = layers
                        .iter()
                        .position(|l| l.0 > pixel.view_z[i])
                        .unwrap_or(layers.len());
                    layers.insert(at, (pixel.view_z[i], color, (-absorbance(pixel.alpha[i])).exp()));
                    if layers.len() > k {
                        let (back, front) = (layers[k], layers[k - 1]);
                        layers.truncate(k - 1);
                        layers.push((
                            front.0,
                            std::array::from_fn(|c| front.1[c] + front.2 * back.1[c]),
                            front.2 * back.2,
                        ));
                    }
                }
                let color = layers
                    .iter()
                    .rev()
                    .fold(WHITE, |behind, l| std::array::from_fn(|c| l.1[c] + l.2 * behind[c]));
                assert_close(ours, &color);
            }
        }
    }

    /// One colour over itself stays where nothing is clamped, and what passes through the pixel is exact, whatever was
    /// merged.
    #[test]
    fn one_colour_stays() {
        let white = image(&MultiLayerAlpha { layers: 2 }, &painted(&scene(5), [1.0; 3]));
        // An opaque fragment counts e^−10 twice: in its colour, and in what it lets through.
        assert!(white.as_flattened().iter().all(|&c| (c - 1.0).abs() < 1e-4));
        let clear = pixel(&[3.0, 1.0, 2.0], &[0.25, 0.5, 0.75], &[[1.0; 3]; 3]);
        assert_close(&of(1, &clear), &[1.0; 3]);
        assert_close(&of(3, &pixel(&[], &[], &[])), &WHITE);
    }

    #[test]
    fn order_matters_unless_there_are_layers_enough() {
        assert!(order_matters(&MultiLayerAlpha { layers: 2 }, &untied(2)));
        assert!(!order_matters(&MultiLayerAlpha { layers: 24 }, &untied(2)));
    }

    #[test]
    fn names() {
        assert_eq!(parse("multi-layer-alpha:8").unwrap().name(), "multi-layer-alpha:8");
        assert!(parse("multi-layer-alpha:x").is_err());
    }
}
