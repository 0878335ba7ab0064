//! Adaptive transparency: the transmittance of a pixel as a step function of few nodes.

use super::capabilities::{COLOUR_BITS, Capabilities, Needs};
use super::layered::Layered;
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::pixel::{FragmentList, Pixel, absorbance, abuffer};

/// The stem of its name on the command line, `adaptive:K` or `adaptive:K:RULE`.
pub const NAME: &str = "adaptive";

/// Which node goes when there is one too many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Removal {
    /// The node whose removal changes the area under the function least.
    ///
    /// # Source
    /// Salvi, Montgomery, Lefohn, HPG 2011, Sec. 3.2.
    #[default]
    LeastArea,
    /// The farthest node; what [`super::multi_layer_alpha`] does with colours. It needs no search, shaders of the
    /// method written since 2014 merge their last two nodes so, and of a function without colours the same nodes are
    /// left in whatever order fragments arrive.
    ///
    /// # Source
    /// Salvi, Vaidyanathan, I3D 2014, Sec. 3.
    Farthest,
}

/// Pass 1 keeps T over depth as a step function of K nodes (depth, T behind it). A fragment inserts a node, behind
/// nodes of equal depth, and brings down all nodes behind it; when there are K + 1 nodes, one goes by the [`Removal`]
/// rule, and its step is moved to the node before it. So T is never overestimated, and the last node always has the
/// exact total. The first node is never removed. Pass 2 weights a fragment by the function in front of its node: C = Σ
/// a T C + T_last C_bg, not normalised.
///
/// Areas are taken over view_z. Nodes are sorted by (view_z, input index), which is also how the function is asked, so
/// that a tie is broken as the A-buffer's image breaks it. Fragments are inserted in the order of the input; the result
/// depends on it unless K is at least their number.
///
/// # Source
/// Salvi, Montgomery, Lefohn, *Adaptive Transparency*, HPG 2011, Sec. 3.
#[derive(Debug, Clone, Copy)]
pub struct Adaptive {
    /// Nodes, K.
    pub nodes: usize,
    /// Which node goes.
    pub removal: Removal,
}

/// The method by its name.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: "adaptive:K[:2011|2014]",
    source: "Salvi, Montgomery, Lefohn, HPG 2011; :2014 by Salvi, Vaidyanathan, I3D 2014",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    ["4", "8", "16", "4:2014", "8:2014", "16:2014"]
        .map(|tail| format!("{head}:{tail}"))
        .to_vec()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    let (nodes, removal) = match arguments.argument.and_then(|a| a.split_once(':')) {
        Some((nodes, "2011")) => (nodes, Removal::LeastArea),
        Some((nodes, "2014")) => (nodes, Removal::Farthest),
        Some(_) => return Err(arguments.wrong("expected 2011 or 2014 after the number of nodes")),
        None => (arguments.argument.unwrap_or_default(), Removal::LeastArea),
    };
    let arguments = Arguments {
        argument: Some(nodes),
        ..*arguments
    };
    let nodes = arguments.layers()?;
    Ok(Box::new(Adaptive { nodes, removal }))
}

impl Method for Adaptive {
    fn name(&self) -> String {
        match self.removal {
            Removal::LeastArea => format!("{NAME}:{}", self.nodes),
            Removal::Farthest => format!("{NAME}:{}:2014", self.nodes),
        }
    }

    /// A node is a depth and a transmittance in RG32F.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            bits_per_pixel: Some(64u32.saturating_mul(self.nodes as u32)),
            colour_bits_per_pixel: COLOUR_BITS,
            geometry_passes: 2,
            needs: Needs::INTERLOCK,
            order_dependent: self.removal == Removal::LeastArea,
        }
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(match self.removal {
            Removal::LeastArea => Layered::of(list, |function: &mut StepFunction, pixel, out| {
                function.of_pixel(self.nodes, pixel);
                for (i, (out, &view_z)) in out.iter_mut().zip(pixel.view_z).enumerate() {
                    *out = function.in_front_of(view_z, i);
                }
                function.total()
            }),
            Removal::Farthest => Layered::of(list, |order: &mut Vec<u32>, pixel, out| {
                self.farthest_removed(order, pixel, out)
            }),
        }))
    }
}

impl Adaptive {
    /// The function whose farthest node always goes: the K nearest fragments have nodes, the last of which takes every
    /// step behind it. Whatever the order of insertion, the same nodes are left.
    fn farthest_removed(&self, order: &mut Vec<u32>, pixel: Pixel<'_>, out: &mut [f64]) -> f64 {
        abuffer::front_to_back(pixel, order);
        let total = libm::exp(-abuffer::total_absorbance(pixel));
        let mut in_front = 0.0;
        for (place, &i) in order.iter().enumerate() {
            out[i as usize] = if place < self.nodes {
                libm::exp(-in_front)
            } else {
                total
            };
            in_front += absorbance(pixel.alpha[i as usize]);
        }
        total
    }
}

#[derive(Debug, Clone, Copy)]
struct Node {
    view_z: f32,
    /// The fragment that made it.
    index: usize,
    /// T from here to the next node.
    transmittance: f64,
}

/// T over depth: 1 in front of the first node.
#[derive(Debug, Default)]
struct StepFunction {
    nodes: Vec<Node>,
}

impl StepFunction {
    fn of_pixel(&mut self, k: usize, pixel: Pixel<'_>) {
        self.nodes.clear();
        for (index, (&view_z, &alpha)) in pixel.view_z.iter().zip(pixel.alpha).enumerate() {
            self.insert(index, view_z, libm::exp(-absorbance(alpha)));
            if self.nodes.len() > k {
                self.remove_one();
            }
        }
    }

    fn insert(&mut self, index: usize, view_z: f32, transmittance: f64) {
        let at = self.nodes.partition_point(|node| node.view_z <= view_z);
        for node in &mut self.nodes[at..] {
            node.transmittance *= transmittance;
        }
        let before = self.before(at);
        self.nodes.insert(
            at,
            Node {
                view_z,
                index,
                transmittance: before * transmittance,
            },
        );
    }

    /// Removes the node whose removal takes the least area away; the first of several.
    fn remove_one(&mut self) {
        let area = |pair: &[Node]| {
            (pair[0].transmittance - pair[1].transmittance) * (f64::from(pair[1].view_z) - f64::from(pair[0].view_z))
        };
        let areas = self.nodes.windows(2).map(area).enumerate();
        if let Some((before, _)) = areas.min_by(|a, b| a.1.total_cmp(&b.1)) {
            self.nodes[before].transmittance = self.nodes[before + 1].transmittance;
            self.nodes.remove(before + 1);
        }
    }

    /// T between the node before place `at` and that place.
    fn before(&self, at: usize) -> f64 {
        match at.checked_sub(1) {
            Some(before) => self.nodes[before].transmittance,
            None => 1.0,
        }
    }

    fn in_front_of(&self, view_z: f32, index: usize) -> f64 {
        self.before(
            self.nodes
                .partition_point(|node| node.view_z < view_z || (node.view_z == view_z && node.index < index)),
        )
    }

    fn total(&self) -> f64 {
        self.before(self.nodes.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oit::parse;
    use crate::oit::testing::*;
    use proptest::prelude::*;

    fn of_2011(nodes: usize) -> Adaptive {
        Adaptive {
            nodes,
            removal: Removal::LeastArea,
        }
    }

    /// The rule of 2014 merges the farthest: of nodes 1 (1/2), 2 (1/4), 5 (1/8) that at 5 goes, where the rule of 2011
    /// lets that at 2 go.
    #[test]
    fn both_rules_by_hand() {
        let far = pixel(&[5.0, 1.0, 2.0], &[0.5; 3], three().color().unwrap());
        let of_2014 = Adaptive {
            nodes: 2,
            removal: Removal::Farthest,
        };
        assert_close(&weights(&of_2014, &far), &[0.125, 1.0, 0.5]);
        assert_close(&weights(&of_2011(2), &far), &[0.25, 1.0, 0.25]);
        // One node at 1 takes all steps: what lies behind sees the total.
        let of_2014 = Adaptive { nodes: 1, ..of_2014 };
        assert_close(&weights(&of_2014, &far), &[0.125, 1.0, 0.125]);
        assert!(!of_2014.capabilities().order_dependent && !order_matters(&of_2014, &untied(2)));
    }

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        let of = |nodes, list: &FragmentList| image(&of_2011(nodes), list)[0];
        assert_close(&of(1, &one()), &[0.625, 0.5, 0.5]);
        // One node at 1 with T = 1/4: green sees its own absorbance too.
        assert_close(&weights(&of_2011(1), &two()), &[0.25, 1.0]);
        assert_close(&of(1, &two()), &[0.5 + 0.25, 0.125 + 0.25, 0.25]);
        assert_close(&of(2, &two()), &[0.75, 0.5, 0.25]);
        assert_close(&of(3, &three()), &exact_image(&three())[0]);
        // Nodes 1 (1/2), 2 (1/4), 5 (1/8): areas 1/4 · 1 and 1/8 · 3; the node at 2 goes, and that at 1 gets T = 1/4.
        let far = pixel(&[5.0, 1.0, 2.0], &[0.5; 3], three().color().unwrap());
        assert_close(&weights(&of_2011(2), &far), &[0.25, 1.0, 0.25]);
        assert_close(&of(2, &far), &[0.5 + 0.125, 0.125 + 0.125, 0.125 + 0.125]);
        // Nearer, the last step costs less, 1/8 · 1: the node at 3 goes, and that at 2 gets T = 1/8.
        let near = pixel(&[3.0, 1.0, 2.0], &[0.5; 3], three().color().unwrap());
        assert_close(&weights(&of_2011(2), &near), &[0.125, 1.0, 0.5]);
    }

    #[test]
    fn enough_nodes_give_the_a_buffer() {
        assert_converges(|nodes| Box::new(of_2011(nodes)));
        assert_converges(|nodes| {
            Box::new(Adaptive {
                nodes,
                removal: Removal::Farthest,
            })
        });
    }

    #[test]
    fn order_matters_unless_there_are_nodes_enough() {
        assert!(order_matters(&of_2011(3), &untied(2)));
        assert!(!order_matters(&of_2011(24), &untied(2)));
        assert_eq!(image(&of_2011(3), &pixel(&[], &[], &[]))[0], WHITE);
    }

    proptest! {
        /// T is never overestimated, the first fragment sees everything, and the total is exact. Tolerance 1e-12.
        #[test]
        fn never_above_the_truth(pairs in prop::collection::vec((0.5f32..8.0, 0.0f32..=1.0), 1..40),
            nodes in 1usize..12) {
            let (view_z, alpha): (Vec<f32>, Vec<f32>) = pairs.into_iter().unzip();
            let list = FragmentList::new(vec![0, view_z.len() as u64], view_z.clone(), alpha, None).unwrap();
            let (ours, exact) = (weights(&of_2011(nodes), &list), abuffer::list_transmittance(&list));
            prop_assert!(ours.iter().zip(&exact).all(|(o, e)| *o <= e + 1e-12));
            let nearest = view_z.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
            prop_assert_eq!(ours[nearest], 1.0);
            let mut function = StepFunction::default();
            function.of_pixel(nodes, list.pixel(0));
            prop_assert!(function.nodes.len() <= nodes);
            prop_assert!((function.total() - (-abuffer::total_absorbance(list.pixel(0))).exp()).abs() < 1e-12);
        }
    }

    #[test]
    fn names() {
        assert_eq!(parse("adaptive:8").unwrap().name(), "adaptive:8");
        assert_eq!(parse("adaptive:8:2014").unwrap().name(), "adaptive:8:2014");
        assert_eq!(parse("adaptive:8:2011").unwrap().name(), "adaptive:8");
        assert!(parse("adaptive:99999").is_err() && parse("adaptive:8:2012").is_err());
    }
}
