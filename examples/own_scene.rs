//! Fragments of a renderer of one's own: predicts their transmittance and compares it with the exact answer.
//!
//! `cargo run --release --example own_scene`

use nmt::features::Target;
use nmt::model::shipped;
use nmt::oit::{Context, neural::Neural};
use nmt::pixel::FragmentList;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Three pixels: five sheets of glass, none, and a puff of smoke of two hundred fragments, in any order.
    let mut view_z = vec![4.0, 1.0, 3.0, 5.0, 2.0];
    let mut alpha = vec![0.5, 0.3, 0.2, 0.9, 0.4];
    for i in 0..200 {
        view_z.push(2.0 + 0.013 * ((i * 67) % 200) as f32);
        alpha.push(0.03);
    }
    let list = FragmentList::new(vec![0, 5, 5, 205], view_z, alpha, None)?;

    let network = shipped::named("recommended").ok_or("a network of that name")?;
    let answers = Neural::new(network).transmittance(&list, Context::default(), &|_| {})?;
    let exact = Target::Transmittance.of_list(&list);
    for i in 0..5 {
        println!(
            "v = {}: T = {:.4}, exactly {:.4}",
            list.view_z()[i],
            answers[i],
            exact[i]
        );
    }
    let squares = answers.iter().zip(&exact).map(|(t, e)| (f64::from(*t) - *e).powi(2));
    println!("T-MSE {:.2e}", squares.sum::<f64>() / exact.len() as f64);
    Ok(())
}
