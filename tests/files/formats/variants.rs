//! What formats can say in more than one way: each is put together here, and read to the numbers that it stands for.

use std::f64::consts::SQRT_2;
use std::path::Path;

use rara::Gaussians;
use rara::glam::{Mat3, Quat, Vec3};
use rara::scene::load;

use super::load_bytes;
use crate::common::folder::Folder;

/// The spherical harmonic of degree 0.
const SH_0: f32 = 0.282_094_8;

fn near(found: &[f32], expected: &[f32], most: f32) {
    assert_eq!(found.len(), expected.len());
    let fits = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (a - b).abs() <= most);
    assert!(fits, "{found:?}, not {expected:?}");
}

/// The covariance, which says what a rotation and scales are worth.
fn covariance(gaussians: &Gaussians, at: usize) -> Mat3 {
    let turn = Mat3::from_quat(gaussians.rotations()[at]);
    let scales = gaussians.scales()[at];
    turn * Mat3::from_diagonal(scales * scales) * turn.transpose()
}

/// A `.spz` of version 2 with one Gaussian of degree 1, and the axes that an extension says.
fn spz_with_axes(axes: Option<u32>) -> Vec<u8> {
    let mut bytes = b"NGSP\x02\0\0\0\x01\0\0\0\x01\x0c".to_vec();
    bytes.extend([if axes.is_some() { 2 } else { 0 }, 0]);
    // 12 bits behind the point.
    for value in [1.0_f32, 2.0, 3.0] {
        bytes.extend(&((value * 4096.0) as i32).to_le_bytes()[..3]);
    }
    bytes.push(128);
    bytes.extend([100, 120, 140]);
    bytes.extend([160, 176, 192]); // e^0, e^1, e^2
    bytes.extend([178, 153, 102]); // x 0.4, y 0.2, z -0.2
    bytes.extend([160, 128, 128, 128, 192, 128, 128, 128, 144]);
    if let Some(axes) = axes {
        bytes.extend(0xADBE_0003_u32.to_le_bytes());
        bytes.extend(4_u32.to_le_bytes());
        bytes.extend(axes.to_le_bytes());
    }
    bytes
}

/// The axes have Niantic's names: left or right, down or up, back or forward, in the order of their numbers.
#[test]
fn spz_says_which_way_its_axes_point() {
    let names = [
        "LDB", "RDB", "LUB", "RUB", "LDF", "RDF", "LUF", "RUF", "LBD", "RBD", "LBU", "RBU", "LFD",
        "RFD", "LFU", "RFU",
    ];
    let none = load_bytes(&spz_with_axes(None)).unwrap().gaussians;
    let own = load_bytes(&spz_with_axes(Some(6))).unwrap().gaussians; // RDF, which are ours
    near(&own.positions()[0].to_array(), &[1.0, 2.0, 3.0], 0.0);
    let bytes = [178.0, 153.0, 102.0_f32].map(|byte| byte / 127.5 - 1.0);
    let turn = Vec3::from_array(bytes);
    let turn = Quat::from_vec4(turn.extend((1.0 - turn.length_squared()).sqrt()));
    assert!(own.rotations()[0].dot(turn).abs() > 1.0 - 1e-6);
    // Of degree 1: y, z, x, red of y, green of z, blue of x.
    near(
        &own.sh_of(0)[3..],
        &[0.25, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.125],
        0.0,
    );
    for (number, name) in (1..).zip(names) {
        let found = load_bytes(&spz_with_axes(Some(number))).unwrap().gaussians;
        // The file's axes in ours, right, down and forward.
        let axis = |letter: char| match letter {
            'R' => Vec3::X,
            'L' => -Vec3::X,
            'D' => Vec3::Y,
            'U' => -Vec3::Y,
            'F' => Vec3::Z,
            _ => -Vec3::Z,
        };
        let axes: Vec<Vec3> = name.chars().map(axis).collect();
        let axes = Mat3::from_cols(axes[0], axes[1], axes[2]);
        let expected = axes * own.positions()[0];
        near(&found.positions()[0].to_array(), &expected.to_array(), 1e-6);
        let expected = axes * covariance(&own, 0) * axes.transpose();
        assert!(covariance(&found, 0).abs_diff_eq(expected, 1e-4), "{name}");
        // Of degree 1 the coefficients of y, z and x are -, + and - times a vector.
        let vector = |sh: &[f32], channel: usize| {
            Vec3::new(-sh[9 + channel], -sh[3 + channel], sh[6 + channel])
        };
        near(&found.sh_of(0)[..3], &own.sh_of(0)[..3], 0.0);
        for channel in 0..3 {
            let expected = axes * vector(own.sh_of(0), channel);
            let turned = vector(found.sh_of(0), channel);
            near(&turned.to_array(), &expected.to_array(), 1e-6);
        }
        if name == "RUB" {
            assert_eq!(found, none, "what says nothing is right, up and back");
        }
    }
    assert!(load_bytes(&spz_with_axes(Some(17))).is_err());
}

/// Version 1 has halves for centres.
#[test]
fn spz_of_version_1_has_halves() {
    let mut bytes = b"NGSP\x01\0\0\0\x01\0\0\0\0\0\0\0".to_vec();
    // 1.5, -2 and 0.25.
    [0x3e00_u16, 0xc000, 0x3400]
        .iter()
        .for_each(|half| bytes.extend(half.to_le_bytes()));
    bytes.extend([255, 128, 128, 128, 160, 160, 160, 128, 128, 128]);
    let found = load_bytes(&bytes).unwrap().gaussians;
    near(&found.positions()[0].to_array(), &[1.5, 2.0, -0.25], 0.0);
    near(&found.scales()[0].to_array(), &[1.0; 3], 0.0);
    assert_eq!(found.opacities(), [1.0]);
}

pub(super) fn webp(path: &Path, pixels: &[[u8; 4]]) {
    wide_webp(path, pixels, pixels.len());
}

fn wide_webp(path: &Path, pixels: &[[u8; 4]], width: usize) {
    let mut bytes = Vec::new();
    image_webp::WebPEncoder::new(&mut bytes)
        .encode(
            pixels.as_flattened(),
            width as u32,
            (pixels.len() / width) as u32,
            image_webp::ColorType::Rgba8,
        )
        .unwrap();
    std::fs::write(path, bytes).unwrap();
}

/// Version 1 has ranges where version 2 has codebooks, logits for opacities, and does not say how many sets of spherical
/// harmonics there are.
#[test]
fn sog_of_version_1_has_ranges() {
    let folder = Folder::new("formats-sog-1");
    let picture = |name: &str, pixels: &[[u8; 4]]| webp(&folder.join(name), pixels);
    picture("l.webp", &[[0, 255, 0, 255], [255, 255, 255, 255]]);
    picture("u.webp", &[[0, 255, 0, 255], [255, 255, 127, 255]]);
    picture("scales.webp", &[[0, 51, 255, 255], [102, 0, 0, 255]]);
    // No rotation: w is the largest.
    picture("quats.webp", &[[128, 128, 128, 252]; 2]);
    picture("sh0.webp", &[[0, 51, 255, 51], [102, 0, 0, 255]]);
    picture("labels.webp", &[[1, 0, 0, 255], [0, 0, 0, 255]]);
    let mut sets = vec![[0, 0, 0, 255]; 192];
    sets[3] = [255, 0, 51, 255];
    picture("sets.webp", &sets);
    let meta = r#"{
        "means": {"shape": [2, 3], "mins": [-1, 0, 0], "maxs": [1, 1, 2], "files": ["l.webp", "u.webp"]},
        "scales": {"mins": [-5, -5, -1], "maxs": [0, 0, 0], "files": ["scales.webp"]},
        "quats": {"files": ["quats.webp"]},
        "sh0": {"mins": [-1, -1, -1, -4], "maxs": [1, 1, 1, 6], "files": ["sh0.webp"]},
        "shN": {"mins": -0.5, "maxs": 0.5, "files": ["sets.webp", "labels.webp"]}
    }"#;
    std::fs::write(folder.join("meta.json"), meta).unwrap();
    let found = load(&folder, &mut |_, _| ()).unwrap().gaussians;
    let e = 1.0_f32.exp_m1();
    near(&found.positions()[0].to_array(), &[-e, e, 0.0], 1e-6);
    let middle = (2.0 * 32767.0 / 65535.0_f32).exp_m1();
    near(&found.positions()[1].to_array(), &[e, e, middle], 1e-5);
    let exp = |log: f32| log.exp();
    near(
        &found.scales()[0].to_array(),
        &[exp(-5.0), exp(-4.0), 1.0],
        1e-6,
    );
    near(
        &found.scales()[1].to_array(),
        &[exp(-3.0), exp(-5.0), exp(-1.0)],
        1e-6,
    );
    near(&found.sh_of(0)[..3], &[-1.0, -0.6, 1.0], 1e-6);
    let sigmoid = |logit: f32| 1.0 / (1.0 + (-logit).exp());
    near(found.opacities(), &[sigmoid(-2.0), sigmoid(6.0)], 1e-6);
    near(&found.sh_of(0)[3..6], &[0.5, -0.5, -0.3], 1e-6);
    near(&found.sh_of(1)[3..6], &[-0.5; 3], 1e-6);
    assert!(found.rotations()[0].w > 0.999);
}

/// A picture of one colour takes hardly any bytes, which no scene's do.
#[test]
fn sog_promises_no_more_than_its_pictures_can_hold() {
    let folder = Folder::new("formats-sog-vain");
    wide_webp(&folder.join("a.webp"), &vec![[7, 7, 7, 255]; 1 << 20], 1024);
    let one = r#""files": ["a.webp"]"#;
    let ends = r#""mins": [0, 0, 0], "maxs": [1, 1, 1]"#;
    let meta = format!(
        r#"{{"means": {{"shape": [1048576, 3], {ends}, "files": ["a.webp", "a.webp"]}}, "scales": {{{ends}, {one}}},
        "quats": {{{one}}}, "sh0": {{"mins": [0, 0, 0, 0], "maxs": [1, 1, 1, 1], {one}}}}}"#
    );
    std::fs::write(folder.join("meta.json"), meta).unwrap();
    let error = load(&folder, &mut |_, _| ()).unwrap_err().to_string();
    assert!(error.contains("cannot hold"), "{error}");
}

/// Without ranges for colours their bytes are what they show.
#[test]
fn compressed_ply_without_ranges_of_colours() {
    let mut header = String::from("ply\nformat binary_little_endian 1.0\nelement chunk 1\n");
    for part in ["", "scale_"] {
        for end in ["min", "max"] {
            for axis in ["x", "y", "z"] {
                header += &format!("property float {end}_{part}{axis}\n");
            }
        }
    }
    header += "element vertex 1\n";
    for name in ["position", "rotation", "scale", "color"] {
        header += &format!("property uint packed_{name}\n");
    }
    let mut bytes = (header + "end_header\n").into_bytes();
    [
        -1.0, 2.0, 0.0, 1.0, 4.0, 8.0, -3.0, -3.0, -3.0, 0.0, 0.0, 0.0,
    ]
    .iter()
    .for_each(|v: &f32| bytes.extend(v.to_le_bytes()));
    // The lower end of x, the upper ends of y and z; no rotation but that of a step; the upper ends of scales.
    let half = (0.5_f64 / SQRT_2 * SQRT_2 * 1023.0).round() as u32;
    let numbers = [
        1023 << 11 | 2047,
        half << 20 | half << 10 | half,
        2047 << 21 | 1023 << 11 | 2047,
        0xff33_0066,
    ];
    numbers
        .iter()
        .for_each(|v: &u32| bytes.extend(v.to_le_bytes()));
    let found = load_bytes(&bytes).unwrap().gaussians;
    near(&found.positions()[0].to_array(), &[-1.0, 4.0, 8.0], 1e-6);
    near(&found.scales()[0].to_array(), &[1.0; 3], 1e-6);
    assert!(found.rotations()[0].w > 0.999_99);
    let shown = [1.0, 0.2, 0.0].map(|value: f32| (value - 0.5) / SH_0);
    near(found.sh_of(0), &shown, 1e-5);
    near(found.opacities(), &[0.4], 1e-6);
}

/// glTF with integers that stand for shares, colours without harmonics, and a node's matrix. Its axes are left, up and forward.
#[test]
fn gltf_of_integers_and_a_matrix() {
    let mut bytes = Vec::new();
    [1.0_f32, 2.0, 3.0]
        .iter()
        .for_each(|v| bytes.extend(v.to_le_bytes()));
    // A quarter about z: x, y, z, w.
    let quarter = (32767.0 / SQRT_2).round() as i16;
    [0, 0, quarter, quarter]
        .iter()
        .for_each(|v| bytes.extend(v.to_le_bytes()));
    [1.0_f32, 2.0, 4.0]
        .iter()
        .for_each(|v| bytes.extend(v.to_le_bytes()));
    bytes.extend([255, 51, 0, 102]);
    let accessor = |view: u32, kind: u32, parts: u32, normalized: bool| {
        format!(
            r#"{{"bufferView":{view},"componentType":{kind},"count":1,"type":"VEC{parts}","normalized":{normalized}}}"#
        )
    };
    // Normalised means nothing of floats.
    let accessors = [
        accessor(0, 5126, 3, true),
        accessor(1, 5122, 4, true),
        accessor(2, 5126, 3, false),
        accessor(3, 5121, 4, true),
    ];
    let views = [(0, 12), (12, 8), (20, 12), (32, 4)]
        .map(|(at, size)| format!(r#"{{"buffer":0,"byteOffset":{at},"byteLength":{size}}}"#));
    // Twice as large, a quarter about z, and then 10 along x; column by column.
    let document = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"mesh":0,"matrix":[0,2,0,0,-2,0,0,0,0,0,2,0,10,0,0,1]}}],
        "meshes":[{{"primitives":[{{"mode":0,"attributes":{{"POSITION":0,"KHR_gaussian_splatting:ROTATION":1,
        "KHR_gaussian_splatting:SCALE":2,"COLOR_0":3}},"extensions":{{"KHR_gaussian_splatting":{{}}}}}}]}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{}"}}],
        "bufferViews":[{}],"accessors":[{}]}}"#,
        base64(&bytes),
        views.join(","),
        accessors.join(",")
    );
    let folder = Folder::new("formats-gltf");
    let read = |document: &str| {
        let path = folder.join("a.gltf");
        std::fs::write(&path, document).unwrap();
        load(&path, &mut |_, _| ())
    };
    let found = read(&document).unwrap().gaussians;
    // (1, 2, 3) becomes (-4 + 10, 2, 6) in glTF's axes.
    near(&found.positions()[0].to_array(), &[-6.0, -2.0, 6.0], 1e-5);
    // A quarter and a quarter are half a turn, which leaves the axes' lengths where they are.
    let expected = Mat3::from_diagonal(Vec3::new(4.0, 16.0, 64.0));
    assert!(
        covariance(&found, 0).abs_diff_eq(expected, 1e-2),
        "{}",
        covariance(&found, 0)
    );
    let shown = [1.0, 0.2, 0.0].map(|value: f32| (value - 0.5) / SH_0);
    near(found.sh_of(0), &shown, 1e-5);
    near(found.opacities(), &[0.4], 1e-6);

    let matrix = r#""matrix":[0,2,0,0,-2,0,0,0,0,0,2,0,10,0,0,1]"#;
    for (instead, says) in [
        (
            r#""scale":[1e308,2,1],"rotation":[0,0,0,0]"#,
            "rotation of length 0",
        ),
        (r#""rotation":[0,0,0,0]"#, "rotation of length 0"),
        (r#""translation":null"#, "not of 16, 3, 4 or 3 numbers"),
        (r#""children":[-1]"#, "not all numbers of nodes"),
    ] {
        let error = read(&document.replace(matrix, instead))
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{error}");
    }
    let error = read(&document.replace(r#""scene":0"#, r#""scene":7"#)).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("a scene that the file does not have"),
        "{error}"
    );
    let required = |name: &str| {
        document.replace(
            r#""scene":0"#,
            &format!(r#""scene":0,"extensionsRequired":["{name}"]"#),
        )
    };
    let error = read(&required("EXT_something_unknown"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("requires the extension EXT_something_unknown"),
        "{error}"
    );
    read(&required("KHR_mesh_quantization")).unwrap();
    let moving = document.replace(
        r#""scene":0"#,
        r#""scene":0,"animations":[{"channels":[],"samplers":[]}]"#,
    );
    let notes = read(&moving).unwrap().report.to_string();
    assert!(
        notes.contains("left out 1 animation of the glTF"),
        "{notes}"
    );
    // Instances are drawn each at its own place within the node: here at the numbers of the scales, in the node's own axes.
    let instances = r#""extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":2}}}"#;
    let found = read(&document.replace(matrix, &format!("{matrix},{instances}")))
        .unwrap()
        .gaussians;
    // (2, 4, 7) becomes (-8 + 10, 4, 14).
    near(&found.positions()[0].to_array(), &[-2.0, -4.0, 14.0], 1e-5);
    // An older text of the extension has logarithms of the scales.
    let with_scales = |scales: [f32; 3]| {
        let mut changed = bytes.clone();
        changed[20..32].copy_from_slice(&scales.map(f32::to_le_bytes).concat());
        read(&document.replace(&base64(&bytes), &base64(&changed))).unwrap()
    };
    let plain = with_scales([0.5, 2.0, 4.0]);
    let logarithms = with_scales([0.5_f32, 2.0, 4.0].map(f32::ln));
    assert!(plain.report.is_clean());
    assert!(
        logarithms
            .report
            .to_string()
            .contains("took the scales for logarithms")
    );
    let expected = covariance(&plain.gaussians, 0);
    assert!(covariance(&logarithms.gaussians, 0).abs_diff_eq(expected, 1e-4));
    // What a node moves out of what single precision holds is dropped, and said.
    let far = document.replace(matrix, r#""translation":[1e39,0,0]"#);
    let found = read(&far).unwrap();
    assert_eq!((found.gaussians.len(), found.report.dropped), (0, 1));
    assert!(found.report.to_string().contains("where it is placed"));
}

pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, at| {
            bits << 8 | u32::from(*three.get(at).unwrap_or(&0))
        });
        for letter in 0..4 {
            text.push(match letter <= three.len() {
                true => LETTERS[(bits >> (18 - 6 * letter) & 63) as usize].into(),
                false => '=',
            });
        }
    }
    text
}
