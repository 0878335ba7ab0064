//! Gaussian splats: every format gives the same splats, and what is seen of them is what the formula says.

use crate::python::python;
use nmt::pixel::FragmentList;
use nmt::scene::splat::Splat;
use nmt::scene::splat::file::{self, Splats};
use nmt::scene::{self, Options, SceneFile};
use std::io::Write;
use std::path::Path;
use std::process::Command;

/// Splats that every format holds exactly or nearly: colours of bytes, positions in steps of 1/4096.
fn splats() -> Vec<Splat> {
    (0..40u32)
        .map(|i| {
            let step = |k: u32| f64::from((i * k) % 17) - 8.0;
            let q = [1.0 + step(3).abs() / 4.0, step(5) / 8.0, step(7) / 8.0, step(11) / 8.0];
            let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            Splat {
                position: [step(2) / 8.0, step(3) / 8.0, step(5) / 16.0].map(|x| x as f32),
                scale: [0.02 + 0.01 * f64::from(i % 5), 0.05, 0.01 + 0.02 * f64::from(i % 3)].map(|x| x as f32),
                rotation: q.map(|x| (x / length) as f32),
                rgba: [
                    (i * 5 % 256) as f32 / 255.0,
                    0.5,
                    1.0 - i as f32 / 60.0,
                    (20 + i * 5) as f32 / 255.0,
                ],
            }
        })
        .collect()
}

fn as_splat(splats: &[Splat]) -> Vec<u8> {
    let byte = |x: f32| (x * 255.0).round() as u8;
    let mut out = Vec::new();
    for s in splats {
        out.extend(s.position.iter().chain(&s.scale).flat_map(|x| x.to_le_bytes()));
        out.extend(s.rgba.map(byte));
        out.extend(s.rotation.map(|x| (x * 128.0 + 128.0).round().clamp(0.0, 255.0) as u8));
    }
    out
}

fn as_ply(splats: &[Splat], format: &str, harmonics: usize) -> Vec<u8> {
    let mut names: Vec<String> = ["x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"]
        .map(str::to_owned)
        .to_vec();
    names.extend((0..harmonics).map(|k| format!("f_rest_{k}")));
    names.extend(
        [
            "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3",
        ]
        .map(str::to_owned),
    );
    let properties: String = names.iter().map(|n| format!("property float {n}\n")).collect();
    let mut out = format!(
        "ply\nformat {format} 1.0\ncomment made by a test\nelement vertex {}\n{properties}end_header\n",
        splats.len()
    )
    .into_bytes();
    for s in splats {
        let mut row: Vec<f32> = s.position.to_vec();
        row.extend([0.0; 3]);
        row.extend([0, 1, 2].map(|k| ((f64::from(s.rgba[k]) - 0.5) / 0.282_094_791_773_878_14) as f32));
        row.extend(vec![0.25; harmonics]);
        let a = f64::from(s.rgba[3]);
        row.push((a / (1.0 - a)).ln() as f32);
        row.extend(s.scale.map(|x| f64::from(x).ln() as f32));
        // Quaternions of any length are meant by their direction.
        row.extend(s.rotation.map(|x| 3.0 * x));
        match format {
            "ascii" => out.extend((row.iter().map(f32::to_string).collect::<Vec<_>>().join(" ") + "\n").into_bytes()),
            "binary_little_endian" => out.extend(row.iter().flat_map(|x| x.to_le_bytes())),
            _ => out.extend(row.iter().flat_map(|x| x.to_be_bytes())),
        }
    }
    out
}

fn as_spz(splats: &[Splat], version: u32) -> Vec<u8> {
    let mut out = b"NGSP".to_vec();
    out.extend(version.to_le_bytes());
    out.extend((splats.len() as u32).to_le_bytes());
    out.extend([1, 12, 0, 0]);
    for s in splats {
        out.extend(
            s.position
                .iter()
                .flat_map(|x| ((x * 4096.0).round() as i32).to_le_bytes()[..3].to_vec()),
        );
    }
    out.extend(splats.iter().map(|s| (s.rgba[3] * 255.0).round() as u8));
    for s in splats {
        out.extend([0, 1, 2].map(|k| {
            ((f64::from(s.rgba[k]) - 0.5) / 0.282_094_791_773_878_14 * 0.15 * 255.0 + 127.5)
                .round()
                .clamp(0.0, 255.0) as u8
        }));
    }
    out.extend(
        splats
            .iter()
            .flat_map(|s| s.scale.map(|x| ((f64::from(x).ln() + 10.0) * 16.0).round() as u8)),
    );
    for s in splats {
        // x, y, z, w
        let q = [s.rotation[1], s.rotation[2], s.rotation[3], s.rotation[0]].map(f64::from);
        if version == 2 {
            out.extend([0, 1, 2].map(|k| ((q[k] + 1.0) * 127.5).round() as u8));
            continue;
        }
        let largest = (0..4).fold(0, |l, k| if q[k].abs() > q[l].abs() { k } else { l });
        let sign = if q[largest] < 0.0 { -1.0 } else { 1.0 };
        let mut bits = largest as u32;
        for k in (0..4).filter(|&k| k != largest) {
            let size = (q[k].abs() * std::f64::consts::SQRT_2 * 511.0).round().min(511.0) as u32;
            bits = bits << 10 | u32::from(q[k] * sign < 0.0) << 9 | size;
        }
        out.extend(bits.to_le_bytes());
    }
    // Nine coefficients of degree 1.
    out.extend(vec![128; splats.len() * 9]);
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gzip.write_all(&out).unwrap();
    gzip.finish().unwrap()
}

fn read(name: &str, bytes: &[u8]) -> Result<Splats, String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    file::read(&folder.path().join(name)).map_err(|e| e.to_string())
}

/// Tolerances are each format's own steps; a quaternion and its negative are one rotation.
#[test]
fn every_format_gives_the_same_splats() {
    let all = splats();
    let (third, bytes_only) = (
        as_ply(&all, "binary_little_endian", 9),
        as_ply(&all, "binary_big_endian", 0),
    );
    for (name, bytes, position, scale, turn, color, named) in [
        ("a.splat", as_splat(&all), 0.0, 0.0, 2e-2, 2e-3, ""),
        ("a.ply", third, 0.0, 1e-6, 1e-6, 1e-6, "9 coefficients"),
        ("b.ply", bytes_only, 0.0, 1e-6, 1e-6, 1e-6, ""),
        ("c.ply", as_ply(&all, "ascii", 0), 0.0, 1e-6, 1e-6, 1e-6, ""),
        ("a.spz", as_spz(&all, 2), 1e-7, 4e-2, 2e-2, 8e-3, "9 coefficients"),
        ("b.spz", as_spz(&all, 3), 1e-7, 4e-2, 3e-3, 8e-3, "9 coefficients"),
    ] {
        let found = read(name, &bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(found.splats.len(), all.len(), "{name}");
        assert_eq!(
            found.left_out.iter().any(|l| l.what.contains("harmonics")),
            !named.is_empty(),
            "{name}: {:?}",
            found.left_out
        );
        assert!(
            found.left_out.iter().all(|l| l.to_string().contains(named)),
            "{name}: {:?}",
            found.left_out
        );
        for (a, b) in found.splats.iter().zip(&all) {
            let near = |a: &[f32], b: &[f32], most: f32| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= most);
            let sign = if a.rotation.iter().zip(&b.rotation).map(|(a, b)| a * b).sum::<f32>() < 0.0 {
                -1.0
            } else {
                1.0
            };
            assert!(near(&a.position, &b.position, position), "{name}: {a:?} {b:?}");
            assert!(
                a.scale.iter().zip(&b.scale).all(|(a, b)| (a / b - 1.0).abs() <= scale),
                "{name}: {a:?} {b:?}"
            );
            assert!(
                near(&a.rotation.map(|x| x * sign), &b.rotation, turn),
                "{name}: {a:?} {b:?}"
            );
            assert!(near(&a.rgba, &b.rgba, color), "{name}: {a:?} {b:?}");
        }
    }
}

#[test]
fn what_is_no_splat_is_counted_or_refused() {
    let mut all = splats();
    all[3].position[1] = f32::NAN;
    all[5].scale[0] = f32::INFINITY;
    all[7].rotation = [0.0; 4];
    let found = read("a.splat", &as_splat(&all)).unwrap();
    assert_eq!(
        (found.splats.len(), found.left_out.len()),
        (37, 2),
        "{:?}",
        found.left_out
    );
    assert_eq!((found.left_out[0].count, found.left_out[1].count), (2, 1));
    let good = as_ply(&splats(), "binary_little_endian", 0);
    let changed = |from: &str, to: &str| {
        let text: Vec<u8> = good.clone();
        let at = text.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        [&text[..at], to.as_bytes(), &text[at + from.len()..]].concat()
    };
    for (name, bytes, part) in [
        ("a.splat", as_splat(&splats())[..100].to_vec(), "ends early"),
        ("a.ply", good[..good.len() - 1].to_vec(), "ends early"),
        ("a.ply", [&good[..], b"x"].concat(), "bytes follow"),
        ("a.ply", changed("f_dc_0", "red_00"), "no property 'f_dc_0'"),
        (
            "a.ply",
            changed("element vertex", "element chunk 1\nelement vertex"),
            "compressed splats",
        ),
        ("a.ply", changed("vertex 40", "vertex 99999999999"), "ends early"),
        (
            "a.ply",
            changed("float opacity", "list opacity"),
            "'list' is no number type",
        ),
        ("a.ply", b"plyx\n".to_vec(), "no PLY file"),
        ("a.spz", as_spz(&splats(), 9), "version 9"),
        ("a.spz", as_spz(&splats(), 3)[..300].to_vec(), "a.spz"),
        ("a.spz", b"no gzip".to_vec(), "a.spz"),
    ] {
        let message = read(name, &bytes).unwrap_err();
        assert!(message.contains(part) && message.contains(name), "{message} / {part}");
    }
}

const CAMERA: &str = "[camera]\nposition = [0.3, -0.4, -4]\nlook_at = [0, 0, 0]\nup = [0, -1, 0]\nvertical_fov = \
    40\nwidth = 64\nheight = 48\nnear = 0.5\nfar = 20\n";

fn seen(folder: &Path, splats: &[Splat], more: &str) -> FragmentList {
    std::fs::write(folder.join("a.splat"), as_splat(splats)).unwrap();
    let text = format!("{CAMERA}[[splats]]\nfile = \"a.splat\"\n{more}");
    let scene = SceneFile::parse(&folder.join("scene.toml"), &text).unwrap();
    scene::build(&scene, &Options::default()).unwrap()
}

/// A round splat on the axis: alpha is opacity exp(−d²/2(s² + 0.3)), s its size in pixels, in exactly those pixels
/// where that is at least 1/255. The control has no 0.3.
#[test]
fn a_round_splat_has_the_alpha_of_its_formula() {
    let folder = tempfile::tempdir().unwrap();
    let ball = Splat {
        position: [0.0; 3],
        scale: [0.1; 3],
        rotation: [1.0, 0.0, 0.0, 0.0],
        rgba: [1.0, 0.0, 0.0, 200.0 / 255.0],
    };
    let list = seen(folder.path(), &[ball], "");
    let z = (0.3f64 * 0.3 + 0.4 * 0.4 + 16.0).sqrt();
    let focal = 24.0 / (20f64.to_radians()).tan();
    let variance = (focal * 0.1 / z).powi(2);
    let (mut worst, mut worst_without) = (0.0f64, 0.0f64);
    for p in 0..list.pixels() {
        let (x, y) = ((p % 64) as f64 + 0.5 - 32.0, (p / 64) as f64 + 0.5 - 24.0);
        let alpha = |variance: f64| 200.0 / 255.0 * (-(x * x + y * y) / 2.0 / variance).exp();
        let expected = alpha(variance + 0.3);
        let pixel = list.pixel(p);
        assert_eq!(
            pixel.len(),
            usize::from(expected >= 1.0 / 255.0),
            "pixel {p}: {expected}"
        );
        if let Some(a) = pixel.alpha.first() {
            worst = worst.max((f64::from(*a) - expected).abs());
            worst_without = worst_without.max((f64::from(*a) - alpha(variance)).abs());
            assert!((f64::from(pixel.view_z[0]) - z).abs() < 1e-6);
        }
    }
    assert!(worst < 1e-6 && worst_without > 1e-2, "{worst} {worst_without}");
}

/// Splats that are turned and moved in the scene file look as those that stand so in theirs.
#[test]
fn splats_are_placed_by_the_scene_file() {
    let folder = tempfile::tempdir().unwrap();
    let plain = seen(folder.path(), &splats(), "");
    let turned = seen(folder.path(), &splats(), "rotate = [0, 0, 180]\n");
    assert_ne!(plain, turned);
    let twice = "rotate = [0, 0, 360]\ntranslate = [0, 0, 0]\nscale = 1\n[[splats]]\nfile = \"a.splat\"\nscale = \
        1e-9\ntranslate = [0, 0, -90]\n";
    let again = seen(folder.path(), &splats(), twice);
    assert_eq!((plain.offsets(), plain.view_z()), (again.offsets(), again.view_z()));
    assert!(
        plain
            .alpha()
            .iter()
            .zip(again.alpha())
            .all(|(a, b)| (a - b).abs() < 1e-5)
    );
}

/// Against NumPy, which projects every splat by itself: the same fragments in the same pixels, alpha within 1e-5, depth
/// within 1e-6. The script's control fails.
#[test]
fn fragments_agree_with_an_independent_program() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let list = seen(folder.path(), &splats(), "");
    assert!(list.len() > 500, "{}", list.len());
    let npz = folder.path().join("a.npz");
    scene::npz::write(&npz, nmt::numeric::file::Replace::No, &list).unwrap();
    let output = Command::new(python)
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/splat_reference.py"))
        .args([folder.path().join("a.splat"), npz])
        .args([
            "--position",
            "0.3",
            "-0.4",
            "-4",
            "--up",
            "0",
            "-1",
            "0",
            "--fov",
            "40",
            "--near",
            "0.5",
            "--far",
            "20",
        ])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && text.contains("ok alpha") && text.contains("ok control"),
        "{text}"
    );
}

/// No camera, and no scene file: one is placed so that most of it is seen.
#[test]
fn a_file_alone_is_seen_by_a_camera_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in [
        ("a.splat", as_splat(&splats())),
        ("a.spz", as_spz(&splats(), 3)),
        ("a.ply", as_ply(&splats(), "ascii", 0)),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let scene = scene::open(path.to_str().unwrap()).unwrap();
        let options = Options {
            size: Some((64, 64)),
            seed: None,
        };
        let (list, camera) = scene::build_with_camera(&scene, &options).unwrap();
        let covered = (0..list.pixels()).filter(|&p| !list.range(p).is_empty()).count();
        assert!(covered > 300, "{name}: {covered} of 4096 pixels, {camera:?}");
        assert_eq!(camera.up[1], if name == "a.spz" { 1.0 } else { -1.0 });
    }
}
