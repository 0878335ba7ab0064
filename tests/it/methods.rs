//! Methods against an independent program, and the table of them against the registry.

use ndarray::ArrayView1;
use nmt::numeric::file::Replace;
use nmt::numeric::npy::write_npy;
use nmt::oit::{self, Context};
use nmt::scene::npz;
use std::path::Path;
use std::process::Command;

/// Wavelet and hybrid transparency agree with `scripts/oit_reference.py` to 1e-6 in T over the sample of pixels in `data/`. Control: one weight that is
/// off by 1e-4 is found; the script's own control is the weights in another order.
#[test]
fn wavelet_and_hybrid_agree_with_numpy() {
    let Some(python) = crate::python::python() else { return };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let fragments = root.join("data/sample.npz");
    let list = npz::read(&fragments).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("weights.npy");
    let agrees = |name: &str, weights: &[f32]| {
        write_npy(&path, Replace::Yes, ArrayView1::from(weights)).unwrap();
        let output = Command::new(&python)
            .arg(root.join("scripts/oit_reference.py"))
            .args([fragments.as_os_str(), name.as_ref(), path.as_os_str()])
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        println!("{text}");
        assert!(
            output.status.code().is_some_and(|c| c < 2) && text.contains(name),
            "{text}"
        );
        output.status.success()
    };
    for name in [
        "wavelet:1",
        "wavelet:3",
        "wavelet:3+own",
        "wavelet:5+own",
        "hybrid:1",
        "hybrid:6",
    ] {
        let method = oit::parse(name).unwrap();
        let weights = oit::weights(&list, &*method.accumulate(&list, Context::default()).unwrap());
        let mut weights: Vec<f32> = weights.into_iter().map(|w| w as f32).collect();
        assert!(agrees(name, &weights), "{name}");
        let middle = weights.len() / 2;
        weights[middle] += 1e-4;
        assert!(!agrees(name, &weights), "the control of {name}");
    }
}
