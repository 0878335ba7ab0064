//! A transparency method of one's own beside a classic one and a network, on a built-in scene.
//!
//! `cargo run --release --example own_method`

use nmt::evaluate::Truth;
use nmt::model::shipped;
use nmt::oit::{Accumulated, Capabilities, Context, Method, MethodError, neural::Neural, parse};
use nmt::pixel::{FragmentList, absorbance};
use nmt::scene;

/// Every fragment sees half of the other absorbance of its pixel in front of it.
struct HalfInFront;

struct Totals<'a> {
    list: &'a FragmentList,
    totals: Vec<f64>,
}

impl Method for HalfInFront {
    fn name(&self) -> String {
        "half-in-front".to_owned()
    }

    /// One sum a pixel, and two passes over the geometry.
    fn capabilities(&self) -> Capabilities {
        Capabilities::of_sums(1, false)
    }

    /// Pass 1: the sum of absorbance of each pixel.
    fn accumulate<'a>(&'a self, list: &'a FragmentList, _: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let total = |p: usize| list.range(p).map(|i| absorbance(list.alpha()[i])).sum();
        let totals = (0..list.pixels()).map(total).collect();
        Ok(Box::new(Totals { list, totals }))
    }
}

impl Accumulated for Totals<'_> {
    /// Pass 2: the transmittance of each fragment.
    fn weights(&self, p: usize, out: &mut [f64]) {
        for (weight, i) in out.iter_mut().zip(self.list.range(p)) {
            let others = self.totals[p] - absorbance(self.list.alpha()[i]);
            *weight = (-0.5 * others).exp();
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = scene::Options {
        size: Some((160, 120)),
        seed: None,
    };
    let list = scene::build(&scene::open("glass-stacks")?, &options)?;
    let truth = Truth::new(&list, [1.0; 3]);
    let network = Neural::new(shipped::named("recommended").ok_or("a network of that name")?);
    let methods: [Box<dyn Method>; 3] = [Box::new(HalfInFront), parse("moment-power-4")?, Box::new(network)];
    for method in methods {
        let judged = truth.judge(&*method, Context::default())?;
        let (image, t) = (judged.result.image_mse, judged.result.transmittance_mse);
        println!(
            "{}: image MSE {:.2e}, T-MSE {:.2e}",
            method.name(),
            image.unwrap_or(f64::NAN),
            t.unwrap_or(f64::NAN)
        );
    }
    Ok(())
}
