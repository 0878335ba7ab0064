//! Generates pixels, trains a network on them, and exports it: what `nmt run` does, from code.
//!
//! `cargo run --release --example train_and_export`

use nmt::dataset::{DatasetConfig, build};
use nmt::export::{self, Format};
use nmt::features::FeatureSet;
use nmt::model::Provenance;
use nmt::numeric::file::Replace;
use nmt::synth::SynthConfig;
use nmt::train::trainer::Job;
use nmt::train::{Backend, Outcome, TrainConfig, train};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = Path::new("target/examples");
    std::fs::create_dir_all(out)?;

    // 20,000 rows of features with their exact answers, from random pixels; the same seed gives the same bytes.
    let dataset = build(
        "example",
        1,
        &SynthConfig::wide(),
        &DatasetConfig::of(FeatureSet::Recentred, 20_000, 5_000),
        &|_| {},
    )?;
    let config: TrainConfig = toml::from_str("hidden = [16, 8]\nepochs = 20\nbatch = 1024\nlearning_rate = 3e-3")?;
    let job = Job {
        name: "example",
        config: &config,
        seed: 1,
        backend: Backend::Fused,
        checkpoint: &out.join("example.checkpoint.json"),
        resume: false,
        provenance: Provenance::default(),
    };
    let mut best = f64::NAN;
    let outcome = train(&dataset, &job, &|| false, &mut |epoch| best = epoch.best_validation)?;
    let Outcome::Finished { mlp, .. } = outcome else {
        return Err("nobody interrupts this training".into());
    };
    println!("{}: least validation loss {best:.3e}", mlp.shape());
    for path in export::write(&mlp, out, &[Format::WGSL, Format::ONNX], None, Replace::Yes)? {
        println!("{}", path.display());
    }
    Ok(())
}
