//! Deep images as people have them: parts, windows, layers, opacity for each colour, light without opacity, and files
//! that OpenEXR's own library wrote.

use nmt::numeric::file::Replace;
use nmt::pixel::{FragmentList, Windows};
use nmt::scene::exr::{self, ReadOptions};
use std::path::Path;

fn attribute(out: &mut Vec<u8>, name: &str, kind: &str, value: &[u8]) {
    for text in [name, kind] {
        out.extend(text.as_bytes());
        out.push(0);
    }
    out.extend((value.len() as u32).to_le_bytes());
    out.extend(value);
}

/// A part of one row of pixels, uncompressed; every channel holds 32-bit floats, one row of samples a pixel.
struct Part<'a> {
    name: &'a str,
    channels: &'a [&'a str],
    /// By pixel and sample, the channels' values in their order.
    pixels: Vec<Vec<Vec<f32>>>,
    window: [i32; 4],
}

/// The bytes of a file of parts.
fn file(parts: &[Part<'_>]) -> Vec<u8> {
    let multi = parts.len() > 1;
    let mut out = 20_000_630u32.to_le_bytes().to_vec();
    out.extend((2u32 | 0x800 | if multi { 0x1000 } else { 0 }).to_le_bytes());
    for part in parts {
        let mut channels = Vec::new();
        for name in part.channels {
            channels.extend(name.as_bytes());
            channels.push(0);
            channels.extend([2u32, 0, 1, 1].iter().flat_map(|v| v.to_le_bytes()));
        }
        channels.push(0);
        let window: Vec<u8> = part.window.iter().flat_map(|v| v.to_le_bytes()).collect();
        attribute(&mut out, "channels", "chlist", &channels);
        attribute(&mut out, "chunkCount", "int", &1i32.to_le_bytes());
        attribute(&mut out, "compression", "compression", &[0]);
        attribute(&mut out, "dataWindow", "box2i", &window);
        attribute(
            &mut out,
            "displayWindow",
            "box2i",
            &[0i32, 0, 99, 49].map(i32::to_le_bytes).concat(),
        );
        attribute(&mut out, "name", "string", part.name.as_bytes());
        attribute(&mut out, "type", "string", b"deepscanline");
        out.push(0);
    }
    if multi {
        out.push(0);
    }
    let mut at = out.len() as u64 + 8 * parts.len() as u64;
    let chunks: Vec<Vec<u8>> = parts
        .iter()
        .enumerate()
        .map(|(number, part)| {
            let mut chunk = Vec::new();
            if multi {
                chunk.extend((number as u32).to_le_bytes());
            }
            chunk.extend(part.window[1].to_le_bytes());
            let samples: Vec<&Vec<f32>> = part.pixels.iter().flatten().collect();
            let sums = part.pixels.iter().scan(0u32, |sum, p| {
                *sum += p.len() as u32;
                Some(*sum)
            });
            let table: Vec<u8> = sums.flat_map(u32::to_le_bytes).collect();
            let data: Vec<u8> = (0..part.channels.len())
                .flat_map(|c| samples.iter().flat_map(move |s| s[c].to_le_bytes()))
                .collect();
            for size in [table.len(), data.len(), data.len()] {
                chunk.extend((size as u64).to_le_bytes());
            }
            [chunk, table, data].concat()
        })
        .collect();
    for chunk in &chunks {
        out.extend(at.to_le_bytes());
        at += chunk.len() as u64;
    }
    out.extend(chunks.concat());
    out
}

fn read(bytes: &[u8], part: Option<&str>) -> Result<FragmentList, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep.exr");
    std::fs::write(&path, bytes).unwrap();
    let options = ReadOptions {
        part: part.map(str::to_owned),
        ..ReadOptions::default()
    };
    exr::read(&path, &options).map_err(|e| e.to_string())
}

fn said(list: &FragmentList, part: &str) -> u64 {
    list.left_out()
        .iter()
        .filter(|l| l.to_string().contains(part))
        .map(|l| l.count)
        .sum()
}

fn one_part<'a>(channels: &'a [&'a str], samples: &[&[f32]]) -> Part<'a> {
    Part {
        name: "deep",
        channels,
        pixels: vec![samples.iter().map(|s| s.to_vec()).collect()],
        window: [0, 0, 0, 0],
    }
}

#[test]
fn every_part_can_be_read_and_all_are_listed() {
    let part = |name, alpha| Part {
        name,
        ..one_part(&["A", "Z"], &[&[alpha, 2.0]])
    };
    let bytes = file(&[part("left", 0.25), part("right", 0.5), part("3", 0.75)]);
    let first = read(&bytes, None).unwrap();
    assert_eq!(
        (first.alpha(), said(&first, "part 1 'right' (deepscanline), part 2 '3'")),
        (&[0.25][..], 2)
    );
    for (wanted, alpha) in [("right", 0.5), ("1", 0.5), ("left", 0.25), ("3", 0.75), ("2", 0.75)] {
        let list = read(&bytes, Some(wanted)).unwrap();
        assert!(list.alpha() == [alpha] && list.left_out().is_empty(), "{wanted}");
    }
    let message = read(&bytes, Some("middle")).unwrap_err();
    assert!(
        message.contains("'middle'") && message.contains("'left'") && message.contains("'right'"),
        "{message}"
    );
}

#[test]
fn windows_stay_and_places_are_the_files_own() {
    let part = |z: f32| Part {
        pixels: vec![vec![], vec![vec![0.5, z]], vec![]],
        window: [-3, -2, -1, -2],
        ..one_part(&["A", "Z"], &[])
    };
    let list = read(&file(&[part(2.0)]), None).unwrap();
    let windows = Windows {
        data: [-3, -2, -1, -2],
        display: [0, 0, 99, 49],
    };
    assert_eq!((list.windows(), list.size()), (Some(windows), Some((3, 1))));
    let message = read(&file(&[part(-1.0)]), None).unwrap_err();
    assert!(message.contains("pixel (-2, -2)"), "{message}");
    // Through both formats of this program.
    let folder = tempfile::tempdir().unwrap();
    let (deep, npz) = (folder.path().join("a.exr"), folder.path().join("a.npz"));
    exr::write(&deep, Replace::No, &list).unwrap();
    nmt::scene::npz::write(&npz, Replace::No, &list).unwrap();
    for path in [&deep, &npz] {
        assert_eq!(nmt::scene::read(path).unwrap(), list, "{}", path.display());
    }
}

#[test]
fn light_is_kept_and_what_hides_nothing_is_counted() {
    let channels = ["A", "B", "G", "R", "Z"];
    let list = read(
        &file(&[one_part(
            &channels,
            &[
                &[0.5, 0.0, 0.5, 2.0, 1.0],
                &[0.0, 0.0, 0.0, 0.0, 1e30],
                &[0.0, 0.0, 0.0, 0.0, f32::INFINITY],
                &[0.0, 0.0, 0.0, 0.0, f32::NAN],
                &[0.0, 0.0, 3.0, 0.0, 2.0],
                &[1.5, 1.0, 1.0, 1.0, 4.0],
                &[0.25, -0.5, 0.0, 0.0, 5.0],
            ],
        )]),
        None,
    )
    .unwrap();
    assert_eq!(list.view_z(), [1.0, 2.0, 4.0, 5.0]);
    assert_eq!(list.color().unwrap()[0], [4.0, 1.0, 0.0]);
    // What a sample adds to the image, alpha times colour, is what the file says.
    let light = list.color().unwrap()[1][1] * list.alpha()[1];
    assert!(light == 3.0 && list.alpha()[1] < 1e-4, "{light}");
    assert_eq!((list.alpha()[2], list.color().unwrap()[3]), (1.0, [0.0; 3]));
    for (part, count) in [
        ("alpha 0 without light", 3),
        ("light sources", 1),
        ("outside [0, 1]", 1),
        ("negative colours", 1),
    ] {
        assert_eq!(said(&list, part), count, "{part}: {:?}", list.left_out());
    }
    assert_eq!(list.depth_range(), Some((1.0, 5.0)));
    for sample in [
        [0.5, 0.0, 0.0, f32::INFINITY, 1.0],
        [0.5, 0.0, 0.0, 0.0, f32::INFINITY],
        [f32::NAN, 0.0, 0.0, 0.0, 1.0],
    ] {
        let message = read(&file(&[one_part(&channels, &[&sample])]), None).unwrap_err();
        assert!(message.contains("pixel (0, 0), sample 0"), "{message}");
    }
}

#[test]
fn channels_are_found_in_layers_and_by_colour() {
    let glass = one_part(
        &["AB", "AG", "AR", "B", "G", "R", "Z"],
        &[&[0.25, 0.5, 0.75, 0.25, 0.25, 0.5, 2.0]],
    );
    let list = read(&file(&[glass]), None).unwrap();
    assert_eq!((list.alpha(), said(&list, "AR, AG, AB")), (&[0.5][..], 1));
    assert_eq!(list.color().unwrap(), [[1.0, 0.5, 0.5]]);
    let layered = one_part(
        &["Z", "id", "main.alpha", "main.b", "main.g", "main.r"],
        &[&[2.0, 7.0, 0.5, 0.1, 0.2, 0.4]],
    );
    let list = read(&file(&[layered]), None).unwrap();
    assert_eq!(
        (list.alpha(), list.color().unwrap()[0][0], said(&list, "channels id")),
        (&[0.5][..], 0.8, 1)
    );
    let volume = one_part(&["A", "Z", "ZBack"], &[&[0.5, 1.0, 2.0]]);
    let list = read(&file(&[volume]), None).unwrap();
    assert_eq!((list.len(), said(&list, "volumetric")), (4, 1));
}

/// Written by OpenEXR's library (`tests/data/deep/make_more.py`): ZSTD in scanlines and tiles, parts, half depths,
/// windows. Values are steps that halves hold.
#[test]
fn files_of_openexr_itself() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/deep");
    for (name, part) in [
        ("zstd_scanline", None),
        ("zstd_tiled", None),
        ("zstd_halves", None),
        ("parts", Some("second")),
        ("parts", Some("first")),
        ("half_depth", None),
    ] {
        let options = ReadOptions {
            part: part.map(str::to_owned),
            ..ReadOptions::default()
        };
        let list = exr::read(&root.join(format!("{name}.exr")), &options).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(list.size(), Some((40, 21)), "{name}");
        let shift = if part == Some("second") { 1.0 } else { 0.0 };
        let mut seen = 0;
        for p in 0..list.pixels() {
            let (x, y) = (p % 40, p / 40);
            let pixel = list.pixel(p);
            assert_eq!(pixel.len(), (x + 2 * y) % 4, "{name} ({x}, {y})");
            for k in 0..pixel.len() {
                seen += 1;
                assert_eq!(
                    pixel.view_z[k],
                    1.0 + shift + k as f32 + x as f32 / 8.0,
                    "{name} ({x}, {y})"
                );
                assert_eq!(pixel.alpha[k], (k + 1) as f32 / 4.0);
                assert_eq!(pixel.color.unwrap()[k], [0.5, 0.25, 2.0]);
            }
        }
        assert_eq!(seen, list.len());
    }
}
