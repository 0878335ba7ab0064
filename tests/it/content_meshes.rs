//! Meshes as people have them: opacity from wherever a file holds it, text as editors save it, polygons of any shape,
//! and a word about all that is not read.

use nmt::pixel::FragmentList;
use nmt::scene::{self, Options, SceneFile};
use std::path::Path;

const CAMERA: &str = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvertical_fov = 30\nwidth = 16\nheight = \
    16\nnear = 1\nfar = 20\n";

/// A square from (-1, -1) to (1, 1), which covers 144 of the 256 pixels.
const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";

fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

fn seen_with(folder: &Path, mesh: &str, more: &str) -> Result<FragmentList, String> {
    let text = format!("{CAMERA}[[mesh]]\nfile = \"{mesh}\"\n{more}");
    let scene = SceneFile::parse(&folder.join("scene.toml"), &text).map_err(|e| e.to_string())?;
    scene::build(&scene, &Options::default()).map_err(|e| e.to_string())
}

fn seen(files: &[(&str, &[u8])], mesh: &str) -> Result<FragmentList, String> {
    seen_with(folder(files).path(), mesh, "")
}

/// The one alpha of all fragments; the number of them.
fn alpha(list: &FragmentList) -> (f32, usize) {
    let first = list.alpha()[0];
    assert!(list.alpha().iter().all(|a| *a == first), "{:?}", list.alpha());
    (first, list.len())
}

fn said(list: &FragmentList, part: &str) -> bool {
    list.left_out()
        .iter()
        .any(|l| l.to_string().contains(part) && l.count > 0)
}

fn png(width: u32, rgba: &[[u8; 4]]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, rgba.len() as u32 / width);
    encoder.set_color(png::ColorType::Rgba);
    encoder
        .write_header()
        .unwrap()
        .write_image_data(rgba.as_flattened())
        .unwrap();
    out
}

/// A JPEG file of 8 x 8 texels of one colour, given as Y, Cb and Cr: three blocks with nothing but their means.
fn jpeg(ycbcr: [i32; 3]) -> Vec<u8> {
    let segment = |marker: u8, content: &[u8]| {
        let length = (content.len() as u16 + 2).to_be_bytes();
        [&[0xff, marker], &length[..], content].concat()
    };
    // The mean's categories 0 to 11 are codes of four bits; "no more coefficients" is a code of one.
    let means = [
        &[0x00, 0, 0, 0, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
        &(0..12).collect::<Vec<u8>>()[..],
    ]
    .concat();
    let others = [0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let mut bits = String::new();
    for value in ycbcr.map(|v| (v - 128) * 8) {
        let category = 32 - value.unsigned_abs().leading_zeros();
        bits += &format!("{category:04b}");
        if category > 0 {
            let low = if value < 0 { value - 1 + (1 << category) } else { value };
            bits += &format!("{low:0width$b}", width = category as usize);
        }
        bits += "0";
    }
    while !bits.len().is_multiple_of(8) {
        bits += "1";
    }
    let data = (0..bits.len() / 8).map(|i| u8::from_str_radix(&bits[8 * i..8 * i + 8], 2).unwrap());
    [
        vec![0xff, 0xd8],
        segment(0xdb, &[&[0][..], &[1; 64]].concat()),
        segment(0xc0, &[8, 0, 8, 0, 8, 3, 1, 0x11, 0, 2, 0x11, 0, 3, 0x11, 0]),
        segment(0xc4, &means),
        segment(0xc4, &others),
        segment(0xda, &[3, 1, 0, 2, 0, 3, 0, 0, 63, 0]),
        data.flat_map(|b| if b == 0xff { vec![b, 0] } else { vec![b] })
            .collect(),
        vec![0xff, 0xd9],
    ]
    .concat()
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digit = |v: u32, k: u32| char::from(DIGITS[(v >> (18 - 6 * k) & 63) as usize]);
    let group = |b: &[u8]| {
        let v = (0..3).fold(0, |v, k| v << 8 | u32::from(b.get(k).copied().unwrap_or(0)));
        (0..4)
            .map(|k| if k as usize <= b.len() { digit(v, k) } else { '=' })
            .collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}

/// A library's words for opacity, in every spelling that a file may have.
#[test]
fn libraries_say_opacity_in_many_ways() {
    let half_left: Vec<[u8; 4]> = (0..4).map(|x| [255, 255, 255, if x < 2 { 0 } else { 128 }]).collect();
    let grey: Vec<[u8; 4]> = vec![[51, 51, 51, 255]; 4];
    let (half_left, grey) = (png(4, &half_left), png(4, &grey));
    let uv = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    let obj = |library: &str| format!("mtllib {library}\n{SQUARE}{uv}usemtl g\nf 1/1 2/2 3/3 4/4\n");
    for (mtl, expected, count) in [
        ("newmtl g\nKd 1 0 0\nd 0.25\n", 0.25, 144),
        ("newmtl g\nd -halo 0.25\n", 0.25, 144),
        ("newmtl g\nTr 0.75\n", 0.25, 144),
        ("newmtl g\nd 0.25\nTr 0.75\n", 0.25, 144),
        ("newmtl h\nd 1\nnewmtl g\nd 0.25", 0.25, 144),
        // Luminance of an image without alpha, 51/255, times d.
        ("newmtl g\nd 0.5\nmap_d grey.png\n", 0.1, 144),
        // The left half of the image is not there at all.
        ("newmtl g\nmap_d -clamp on half.png\n", 128.0 / 255.0, 90),
        ("newmtl g\nmap_d -imfchan r half.png\n", 1.0, 144),
    ] {
        let obj = obj("m.mtl");
        let files: [(&str, &[u8]); 4] = [
            ("a.obj", obj.as_bytes()),
            ("m.mtl", mtl.as_bytes()),
            ("half.png", &half_left),
            ("grey.png", &grey),
        ];
        let list = seen(&files, "a.obj").unwrap_or_else(|e| panic!("{mtl}: {e}"));
        let most = list.alpha().iter().fold(0.0f32, |m, a| m.max(*a));
        assert!((most - expected).abs() < 1e-6, "{mtl}: {most}");
        assert!(
            list.len().abs_diff(count) <= if count == 144 { 0 } else { 6 },
            "{mtl}: {}",
            list.len()
        );
    }
    // What would be opaque without a word is said or refused.
    let with = |mtl: &str, obj: &str| {
        seen(
            &[
                ("a.obj", obj.as_bytes()),
                ("m.mtl", mtl.as_bytes()),
                ("half.png", &half_left),
            ],
            "a.obj",
        )
    };
    let glass = with("newmtl g\nillum 4\nTf 0.2 0.2 0.2\n", &obj("m.mtl")).unwrap();
    assert!(
        said(&glass, "illum 4") && said(&glass, "Tf") && alpha(&glass).0 == 1.0,
        "{:?}",
        glass.left_out()
    );
    assert!(said(
        &with("newmtl g\nmap_Kd half.png\n", &obj("m.mtl")).unwrap(),
        "alpha of the map_Kd"
    ));
    for (mtl, obj, part) in [
        ("newmtl g\nmap_d gone.png\n", obj("m.mtl"), "gone.png"),
        ("newmtl g\nmap_d m.mtl\n", obj("m.mtl"), "PNG or JPEG"),
        ("newmtl g\nd 0.5x\n", obj("m.mtl"), "line 2: d '0.5x'"),
        ("newmtl h\n", obj("m.mtl"), "line 10: there is no material 'g'"),
        (
            "newmtl g\n",
            format!("{SQUARE}usemtl g\nf 1 2 3 4\n"),
            "no mtllib line names a library",
        ),
        ("newmtl g\n", obj("gone.mtl"), "gone.mtl"),
        (
            "newmtl g\nmap_d half.png\n",
            format!("mtllib m.mtl\n{SQUARE}usemtl g\nf 1 2 3 4\n"),
            "texture coordinates",
        ),
    ] {
        let message = with(mtl, &obj).unwrap_err();
        assert!(message.contains(part), "{message} / {part}");
    }
    // The scene file's word makes all of that needless.
    let at = folder(&[("a.obj", obj("gone.mtl").as_bytes())]);
    let given = seen_with(at.path(), "a.obj", "alpha = 0.5\ncolor = [1, 0, 3.5]\n").unwrap();
    assert!(alpha(&given) == (0.5, 144) && given.brightest() > 1.0);
}

/// Marks, Latin-1, continued lines, several libraries, quotes, other systems' slashes.
#[test]
fn text_is_read_as_it_is_saved() {
    let faces = format!("{SQUARE}usemtl gr\u{fc}n\nf 1 2 3 4\n");
    let latin = |text: &str| {
        text.chars()
            .map(|c| u8::try_from(u32::from(c)).unwrap())
            .collect::<Vec<u8>>()
    };
    let mark = |text: &str| [b"\xef\xbb\xbf".to_vec(), text.as_bytes().to_vec()].concat();
    let wide = |text: &str| {
        [0xfffe_u16]
            .iter()
            .map(|_| 0xfeff)
            .chain(text.encode_utf16())
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<u8>>()
    };
    let library = "newmtl gr\u{fc}n\nd 0.5\n";
    let other = "# \u{fc}\nnewmtl other\nd 1\n";
    type Encoding<'a> = &'a dyn Fn(&str) -> Vec<u8>;
    let encodings: [Encoding<'_>; 4] = [&|t| t.as_bytes().to_vec(), &mark, &latin, &wide];
    for of_mesh in encodings {
        for of_library in encodings {
            for name in [
                "mtllib m.mtl",
                "mtllib \"m.mtl\"",
                "mtllib .\\m.mtl",
                "mtllib C:\\work\\m.mtl",
                "mtllib other.mtl m.mtl",
                "mtllib other.mtl \"m.mtl\"",
                "mtllib \\\n m.mtl",
                "mtllib other.mtl\nmtllib m.mtl",
            ] {
                let obj = of_mesh(&format!("{name}\n{faces}"));
                let files: [(&str, &[u8]); 3] = [
                    ("a.obj", &obj),
                    ("m.mtl", &of_library(library)),
                    ("other.mtl", &latin(other)),
                ];
                let list = seen(&files, "a.obj").unwrap_or_else(|e| panic!("{name}: {e}"));
                assert_eq!(alpha(&list), (0.5, 144), "{name}");
            }
        }
    }
    let spaced = format!("mtllib my lib.mtl\n{faces}");
    assert_eq!(
        alpha(
            &seen(
                &[("a.obj", spaced.as_bytes()), ("my lib.mtl", library.as_bytes())],
                "a.obj"
            )
            .unwrap()
        )
        .0,
        0.5
    );
}

/// A polygon covers each pixel inside it once, whatever its shape and whichever corner it begins with.
#[test]
fn polygons_cover_what_is_inside_once() {
    let comb = [[-1, -1], [1, -1], [1, 1], [0, 1], [0, 0], [-1, 0]];
    for turn in 0..6 {
        let mut obj = String::new();
        for k in 0..6 {
            let [x, y] = comb[(k + turn) % 6];
            obj += &format!("v {x} {y} 0\n");
        }
        obj += "f 1 2 3 4 5 6\n";
        let list = seen(&[("a.obj", obj.as_bytes())], "a.obj").unwrap();
        assert_eq!((list.len(), list.depth_complexity()), (108, 1), "{turn}");
    }
    let rest = format!("{SQUARE}f 1 2 3 4\nl 1 2\np 1\ncurv 0 1 1 2\n");
    let list = seen(&[("a.obj", rest.as_bytes())], "a.obj").unwrap();
    assert!(
        ["lines (1)", "points (1)", "statements 'curv'"]
            .iter()
            .all(|p| said(&list, p)),
        "{:?}",
        list.left_out()
    );
    let far = "v 0 0 0\nv 2e15 0 0\nv 0 1 0\nf 1 2 3\n";
    assert!(
        seen(&[("a.obj", far.as_bytes())], "a.obj")
            .unwrap_err()
            .contains("1e15")
    );
}

/// A glTF file of the square, with more JSON and more data.
struct Gltf<'a> {
    material: &'a str,
    /// Attributes besides POSITION, after `"POSITION":0`.
    attributes: &'a str,
    /// Accessors after POSITION's and the indices'.
    accessors: &'a str,
    /// Data after 48 bytes of positions and 12 of indices.
    data: Vec<u8>,
    root: &'a str,
}

impl Gltf<'_> {
    fn text(&self) -> String {
        let mut data: Vec<u8> = [
            [-1.0f32, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
        ]
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
        data.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
        let own = data.len();
        data.extend(&self.data);
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0{}}},"indices":1,"material":0}}]}}],
"materials":[{}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
{{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}}{}],
"bufferViews":[{{"buffer":0,"byteLength":48}},
{{"buffer":0,"byteOffset":48,"byteLength":12}},{{"buffer":0,"byteOffset":{own},"byteLength":{}}}],
"buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}]{}}}"#,
            self.attributes,
            self.material,
            self.accessors,
            self.data.len().max(1),
            data.len(),
            base64(&data),
            self.root
        )
    }

    fn seen(&self) -> Result<FragmentList, String> {
        seen(&[("a.gltf", self.text().as_bytes())], "a.gltf")
    }
}

const PLAIN: Gltf<'static> = Gltf {
    material: "{}",
    attributes: "",
    accessors: "",
    data: Vec::new(),
    root: "",
};

const UV: &str = r#",{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"}"#;

fn uv() -> Vec<u8> {
    [0.0f32, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect()
}

#[test]
fn textures_of_gltf_carry_alpha() {
    let image = png(2, &[[255, 0, 0, 51], [255, 0, 0, 204]]);
    let root = |image: &[u8], kind: &str| {
        format!(
            r#","textures":[{{"source":0,"sampler":0}}],"samplers":[{{"magFilter":9728,"wrapS":33071}}],
"images":[{{"uri":"data:image/{kind};base64,{}"}}]"#,
            base64(image)
        )
    };
    let png_root = root(&image, "png");
    let of = |mode: &str, factor: &str| {
        format!(r#"{{"name":"leaf",{mode}"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}{factor}}}}}"#)
    };
    let build = |material: &str, root: &str| {
        Gltf {
            material,
            attributes: r#","TEXCOORD_0":2"#,
            accessors: UV,
            data: uv(),
            root,
        }
        .seen()
    };
    let blend = build(
        &of(r#""alphaMode":"BLEND","#, r#","baseColorFactor":[1,1,1,0.5]"#),
        &png_root,
    )
    .unwrap();
    let (low, high) = blend
        .alpha()
        .iter()
        .fold((1.0f32, 0.0f32), |(l, h), a| (l.min(*a), h.max(*a)));
    assert_eq!(blend.len(), 144);
    assert!((low - 0.1).abs() < 1e-6 && (high - 0.4).abs() < 1e-6, "{low} {high}");
    let cut = build(&of(r#""alphaMode":"MASK","#, ""), &png_root).unwrap();
    assert_eq!(alpha(&cut), (1.0, 72));
    let lower = build(&of(r#""alphaMode":"MASK","alphaCutoff":0.1,"#, ""), &png_root).unwrap();
    assert_eq!(alpha(&lower), (1.0, 144));
    assert_eq!(alpha(&build(&of("", ""), &png_root).unwrap()), (1.0, 144));
    // 188 in the curve of sRGB is a half; JPEG may miss it by a step. Y = 126, Cb = 104, Cr = 172 is R = 188, G = 103,
    // B = 83, of which the curve makes 0.503, 0.136 and 0.087.
    let plain = PLAIN.seen().unwrap();
    for (ycbcr, expected) in [([188, 128, 128], [0.503; 3]), ([126, 104, 172], [0.503, 0.136, 0.087])] {
        let lit = build(&of("", ""), &root(&jpeg(ycbcr), "jpeg")).unwrap();
        for (channel, expected) in expected.into_iter().enumerate() {
            let ratio = lit.color().unwrap()[0][channel] / plain.color().unwrap()[0][channel];
            assert!((ratio - expected).abs() < 0.02, "{ycbcr:?}: {ratio} and not {expected}");
        }
    }
    // Behind a cutoff, the scene file's alpha is that of what is left.
    let text = Gltf {
        material: &of(r#""alphaMode":"MASK","#, ""),
        attributes: r#","TEXCOORD_0":2"#,
        accessors: UV,
        data: uv(),
        root: &png_root,
    }
    .text();
    let at = folder(&[("a.gltf", text.as_bytes())]);
    assert_eq!(
        alpha(&seen_with(at.path(), "a.gltf", "alpha = 0.25\n").unwrap()),
        (0.25, 72)
    );
    // A colour of the scene file's takes the texture's place, and its alpha, which OPAQUE ignores, is named all the
    // same; control: an alpha of the scene file's takes the place of that too.
    let text = text.replace(r#""alphaMode":"MASK","#, "");
    let at = folder(&[("a.gltf", text.as_bytes())]);
    for (given, is_named) in [
        ("", true),
        ("color = [1, 1, 1]\n", true),
        ("color = [1, 1, 1]\nalpha = 0.5\n", false),
    ] {
        let list = seen_with(at.path(), "a.gltf", given).unwrap();
        assert_eq!(
            said(&list, "alpha of the texture of material 'leaf'"),
            is_named,
            "{given}"
        );
    }
    // A texture that opacity hangs on and that cannot be read is refused; where only colour does, it is left out.
    let broken =
        r#","textures":[{"extensions":{"KHR_texture_basisu":{"source":0}}}],"extensionsUsed":["KHR_texture_basisu"]"#;
    let refused = build(&of(r#""alphaMode":"BLEND","#, ""), broken).unwrap_err();
    assert!(
        refused.contains("KHR_texture_basisu") && refused.contains("PNG or JPEG"),
        "{refused}"
    );
    assert!(said(
        &build(&of("", ""), broken).unwrap(),
        "the texture of material 'leaf'"
    ));
}

#[test]
fn colours_of_vertices_carry_alpha_in_every_type() {
    let rows = [[1.0f32, 0.5, 0.0, 0.2]; 4];
    let float: Vec<u8> = rows.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let byte: Vec<u8> = rows.as_flattened().iter().map(|x| (x * 255.0).round() as u8).collect();
    let short: Vec<u8> = rows
        .as_flattened()
        .iter()
        .flat_map(|x| ((x * 65535.0).round() as u16).to_le_bytes())
        .collect();
    for (kind, data) in [
        ("5126", float),
        (r#"5121,"normalized":true"#, byte),
        (r#"5123,"normalized":true"#, short),
    ] {
        let accessors = format!(r#",{{"bufferView":2,"componentType":{kind},"count":4,"type":"VEC4"}}"#);
        let list = |mode: &str| {
            let material = format!(r#"{{{mode}"pbrMetallicRoughness":{{"baseColorFactor":[1,1,1,0.5]}}}}"#);
            Gltf {
                material: &material,
                attributes: r#","COLOR_0":2"#,
                accessors: &accessors,
                data: data.clone(),
                root: "",
            }
            .seen()
            .unwrap()
        };
        let blended = list(r#""alphaMode":"BLEND","#);
        assert!(
            (blended.alpha()[0] - 0.1).abs() < 1e-5,
            "{kind}: {}",
            blended.alpha()[0]
        );
        let opaque = list("");
        assert!(opaque.alpha()[0] == 1.0 && said(&opaque, "alpha of COLOR_0") && !said(&blended, "COLOR_0"));
        let [r, g, b] = blended.color().unwrap()[0];
        assert!((g / r - 0.5).abs() < 0.01 && b == 0.0, "{kind}");
    }
}

#[test]
fn what_gltf_holds_besides_is_said_and_valid_files_are_read() {
    let plain = PLAIN.seen().unwrap();
    assert!(
        plain.left_out().is_empty() && alpha(&plain) == (1.0, 144),
        "{:?}",
        plain.left_out()
    );
    // The byte order mark that editors add.
    let marked = [b"\xef\xbb\xbf".to_vec(), PLAIN.text().into_bytes()].concat();
    assert_eq!(seen(&[("a.gltf", &marked)], "a.gltf").unwrap(), plain);
    let glass =
        |extension: &str| format!(r#"{{"name":"pane","extensions":{{"{extension}":{{"transmissionFactor":0.9}}}}}}"#);
    for extension in [
        "KHR_materials_transmission",
        "KHR_materials_diffuse_transmission",
        "KHR_materials_volume",
    ] {
        let list = Gltf {
            material: &glass(extension),
            ..PLAIN
        }
        .seen()
        .unwrap();
        assert!(
            said(&list, extension) && said(&list, "'pane'") && said(&list, "scene file"),
            "{:?}",
            list.left_out()
        );
    }
    let old = r#"{"name":"old","alphaMode":"BLEND",
"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,0,0,0.3]}}}"#;
    let list = Gltf {
        material: old,
        root: r#","extensionsRequired":["KHR_materials_pbrSpecularGlossiness"]"#,
        ..PLAIN
    }
    .seen()
    .unwrap();
    assert!(alpha(&list).0 == 0.3 && said(&list, "SpecularGlossiness"));
    let opaque = r#"{"name":"o","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]}}"#;
    assert!(said(
        &Gltf {
            material: opaque,
            ..PLAIN
        }
        .seen()
        .unwrap(),
        "OPAQUE"
    ));
    let root = r#","animations":[{"samplers":[],"channels":[]}],"skins":[{"joints":[0]}],
        "cameras":[{"type":"orthographic"}],"extensionsUsed":["KHR_lights_punctual"],
        "extensionsRequired":["KHR_lights_punctual","KHR_materials_unlit","VRMC_materials_mtoon"],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}}"#;
    let list = Gltf { root, ..PLAIN }.seen().unwrap();
    assert!(
        ["animations (1)", "cameras (1)", "lights (1)"]
            .iter()
            .all(|p| said(&list, p)),
        "{:?}",
        list.left_out()
    );
    let posed = PLAIN
        .text()
        .replace(r#"{"mesh":0}"#, r#"{"mesh":0,"skin":0}"#)
        .replace(r#""material":0"#, r#""material":0,"targets":[{"POSITION":0}]"#);
    let list = seen(&[("a.gltf", posed.as_bytes())], "a.gltf").unwrap();
    assert!(said(&list, "skins of nodes (1)") && said(&list, "morph targets (1)"));
    let points = PLAIN.text().replace(r#""material":0"#, r#""material":0,"mode":0"#);
    let list = seen(&[("a.gltf", points.as_bytes())], "a.gltf").unwrap();
    assert!(list.is_empty() && said(&list, "primitives of points"));
}

#[test]
fn compressed_quantised_and_sparse_geometry_is_read_or_refused_by_name() {
    for (root, from, to, part) in [
        (
            r#","extensionsRequired":["KHR_draco_mesh_compression"]"#,
            "",
            "",
            "KHR_draco_mesh_compression, which the file requires, is not supported: export the mesh without it",
        ),
        (
            r#","extensionsRequired":["EXT_meshopt_compression"]"#,
            "",
            "",
            "EXT_meshopt_compression",
        ),
        (r#","extensionsRequired":["ACME_shape"]"#, "", "", "ACME_shape"),
        (
            "",
            r#"[{"bufferView":0,"componentType":5126"#,
            r#"[{"componentType":5126"#,
            "no buffer view",
        ),
    ] {
        let text = Gltf { root, ..PLAIN }.text().replace(from, to);
        let message = seen(&[("a.gltf", text.as_bytes())], "a.gltf").unwrap_err();
        assert!(message.contains(part) && !message.contains("invalid"), "{message}");
    }
    let draco = PLAIN.text().replace(r#"[{"bufferView":0,"#, "[{").replace(
        r#""material":0}"#,
        r#""material":0,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}"#,
    );
    assert!(
        seen(&[("a.gltf", draco.as_bytes())], "a.gltf")
            .unwrap_err()
            .contains("KHR_draco_mesh_compression")
    );
    // Positions as normalised bytes, four apart.
    let quantised = Gltf {
        accessors: r#",{"bufferView":2,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"}"#,
        data: [
            [-127i8, -127, 0, 9],
            [127, -127, 0, 9],
            [127, 127, 0, 9],
            [-127, 127, 0, 9],
        ]
        .as_flattened()
        .iter()
        .map(|b| *b as u8)
        .collect(),
        root: r#","extensionsRequired":["KHR_mesh_quantization"]"#,
        ..PLAIN
    };
    let text = quantised
        .text()
        .replace(r#""POSITION":0"#, r#""POSITION":2"#)
        .replace(r#""byteLength":16}"#, r#""byteLength":16,"byteStride":4}"#);
    assert_eq!(
        alpha(&seen(&[("a.gltf", text.as_bytes())], "a.gltf").unwrap()),
        (1.0, 144)
    );
    // Two corners moved by sparse entries: half of the square is left.
    let mut data: Vec<u8> = vec![2, 3, 0, 0];
    data.extend(
        [[1.0f32, 0.0, 0.0], [-1.0, 0.0, 0.0]]
            .as_flattened()
            .iter()
            .flat_map(|x| x.to_le_bytes()),
    );
    let sparse = Gltf { data, ..PLAIN }.text().replace(
        r#""count":4,"type":"VEC3""#,
        r#""count":4,"type":"VEC3","sparse":{"count":2,
"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":2,"byteOffset":4}}"#,
    );
    assert_eq!(seen(&[("a.gltf", sparse.as_bytes())], "a.gltf").unwrap().len(), 72);
}
