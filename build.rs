//! Tells the program which revision it was built from, for `nmt --version` and the provenance of what it trains.

use std::process::Command;

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git")
        .args(arguments)
        .output()
        .ok()
        .filter(|o| o.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

fn main() {
    let mut version = std::env::var("CARGO_PKG_VERSION").expect("cargo sets it");
    println!("cargo:rerun-if-changed=src");
    println!("cargo:rerun-if-changed=Cargo.toml");
    // Only where this package is the repository, and not a dependency unpacked inside another one.
    let here = git(&["rev-parse", "--show-prefix"]).is_some_and(|prefix| prefix.is_empty());
    if let Some(revision) = git(&["rev-parse", "--short=12", "HEAD"]).filter(|_| here) {
        for path in [
            git(&["rev-parse", "--git-path", "HEAD"]),
            git(&["rev-parse", "--git-path", "logs/HEAD"]),
        ]
        .into_iter()
        .flatten()
        {
            println!("cargo:rerun-if-changed={path}");
        }
        let clean = Command::new("git")
            .args(["diff", "--quiet", "HEAD", "--", "src", "Cargo.toml"])
            .status()
            .is_ok_and(|s| s.success());
        let commit = format!("{revision}{}", if clean { "" } else { "-modified" });
        println!("cargo:rustc-env=NMT_COMMIT={commit}");
        version += &format!(" ({commit})");
    }
    println!("cargo:rustc-env=NMT_VERSION={version}");
}
