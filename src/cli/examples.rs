//! Examples at the end of every `--help`. A test runs them.

macro_rules! examples {
    ($($name:ident: $($line:literal)+;)+) => {
        $(pub const $name: &str = concat!("Examples:\n", $("  ", $line, "\n",)+);)+
    };
}

examples! {
    ALL:
        "nmt run configs/paper.toml"
        "nmt export recommended --out shaders"
        "nmt evaluate --fragments teapots --methods moment-power-4 --model small --out target/ours";
    RUN:
        "nmt run configs/paper.toml"
        "nmt run configs/recommended.toml --out target/recommended --epochs 5";
    GENERATE:
        "nmt generate configs/paper.toml --out target/dataset"
        "nmt generate configs/sample.toml --out target/sample --fragments target/sample.npz"
        "nmt generate configs/paper.toml --out target/from-scenes --from spheres teapots";
    TRAIN:
        "nmt train configs/paper.toml --out target/paper.json"
        "nmt train configs/small.toml --out target/small.json --epochs 20";
    EXPORT:
        "nmt export recommended --out shaders"
        "nmt export models/small.json --out target/half --format wgsl,hlsl --precision f16";
    CHECK:
        "nmt check recommended --exports shaders"
        "nmt check recommended --exports shaders --format wgsl json";
    PREDICT:
        "nmt predict recommended --fragments data/sample.npz --out target/T.npy"
        "nmt predict small --fragments foliage --size 320x320 --out target/T-visible.npy --skip visible";
    EVALUATE:
        "nmt evaluate --fragments hair smoke --methods moment-power-4 --model small --out target/eval"
        "nmt evaluate --fragments data/sample.npz --methods all --out target/sample-methods"
        "nmt evaluate --fragments built-in --size 128x128 --model recommended --out target/comparison"
        "nmt evaluate --fragments spheres --shadows --out target/shadows";
    METHODS:
        "nmt methods"
        "nmt methods --markdown";
    SCENE:
        "nmt scene hair --size 640x480 --out target/hair.npz"
        "nmt scene configs/scenes/house.toml --out target/house.npz"
        "nmt scene spheres --out target/spheres.exr";
    BENCH:
        "nmt bench train --backend fused"
        "nmt bench infer --model recommended --batch 8192 --out target/bench/infer"
        "nmt bench methods --fragments teapots --model small --device cpu --out target/bench/methods";
    BENCH_TRAIN:
        "nmt bench train --backend fused --network 7-32-16-1 7-16-8-1"
        "nmt bench train --stream configs/recommended.toml";
    BENCH_GENERATE:
        "nmt bench generate --config configs/paper.toml configs/recommended.toml";
    BENCH_INFER:
        "nmt bench infer --model recommended small --batch 8192";
    BENCH_METHODS:
        "nmt bench methods --fragments teapots --model small --device cpu --out target/bench/methods";
    BENCH_TILES:
        "nmt bench tiles --fragments teapots hair --model small";
    STRESS:
        "nmt stress --model recommended --cases single pair thin"
        "nmt stress --model recommended --random 1000000 --out target/stress";
    PROFILE:
        "nmt profile --fragments hair --out target/profile"
        "nmt profile --fragments hair --specialise small --network-size best --out target/hair.json"
        "nmt profile --fragments spheres --simplify paper --out target/spheres.json";
    REPORT:
        "nmt report target --out target/report.html";
    IMPORT:
        "nmt import weights.json --out target/imported.json";
    COMPLETIONS:
        "nmt completions bash > ~/.local/share/bash-completion/completions/nmt"
        "nmt completions zsh > ~/.zfunc/_nmt";
    MAN:
        "nmt man --out target/man";
    SCHEMA:
        "nmt schema config"
        "nmt schema scene";
}
