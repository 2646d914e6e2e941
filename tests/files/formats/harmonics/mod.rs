//! Colours that change with the direction, through every change of axes: each coefficient by itself, in each channel, shows
//! in our axes what it means in the file's. The truth is the definition of spherical harmonics, in angles: nothing here
//! asks the library which signs and which order they have.

mod stored;

use std::f64::consts::PI;

use rara::glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use rara::scene::load;
use rara::{Gaussians, Placement};

use super::load_bytes;
use super::variants::{base64, webp};
use crate::common::folder::Folder;
use stored::{Stored, assert_shown, coefficients, plain};

/// glTF's axes are left, up and forward, and ours are right, down and forward.
const OF_GLTF: DVec3 = DVec3::new(-1.0, -1.0, 1.0);

fn extend(bytes: &mut Vec<u8>, numbers: impl IntoIterator<Item = f64>) {
    let numbers = numbers.into_iter();
    numbers.for_each(|number| bytes.extend((number as f32).to_le_bytes()));
}

fn properties(names: &[&str]) -> String {
    let lines = names.iter().map(|name| format!("property float {name}\n"));
    lines.collect()
}

#[test]
fn ply_has_a_channel_after_the_other() {
    for degree in 1..=3 {
        let stored = plain(degree);
        let rest = (0..stored.count()).map(|number| format!("property float f_rest_{number}\n"));
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\n{}{}{}end_header\n",
            stored.count(),
            properties(&["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2"]),
            rest.collect::<String>(),
            properties(&[
                "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"
            ]),
        );
        for gaussian in 0..stored.count() {
            text += "1 2 3 0 0 0 ";
            stored
                .by_channel(gaussian)
                .for_each(|number| text += &format!("{number} "));
            text += "0 0 0 0 1 0 0 0\n";
        }
        let found = load_bytes(text.as_bytes()).unwrap().gaussians;
        assert_shown("ply", &found, &stored, DMat3::IDENTITY);
    }
}

#[test]
fn compressed_ply_has_a_channel_after_the_other() {
    for degree in 1..=4 {
        let bytes = Stored {
            degree,
            low: 128_u8,
            high: 136,
        };
        let mut header = String::from("ply\nformat binary_little_endian 1.0\nelement chunk 1\n");
        header += &properties(&["min_x", "min_y", "min_z", "max_x", "max_y", "max_z"]);
        header += &properties(&["min_scale_x", "min_scale_y", "min_scale_z"]);
        header += &properties(&["max_scale_x", "max_scale_y", "max_scale_z"]);
        header += &format!("element vertex {}\n", bytes.count());
        for name in ["position", "rotation", "scale", "color"] {
            header += &format!("property uint packed_{name}\n");
        }
        header += &format!("element sh {}\n", bytes.count());
        (0..bytes.count())
            .for_each(|number| header += &format!("property uchar f_rest_{number}\n"));
        let mut file = (header + "end_header\n").into_bytes();
        extend(
            &mut file,
            [
                0.0, 0.0, 0.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 0.0, 0.0, 0.0,
            ],
        );
        for _ in 0..bytes.count() {
            [0_u32, 512 << 20 | 512 << 10 | 512, 0, u32::MAX]
                .iter()
                .for_each(|number| file.extend(number.to_le_bytes()));
        }
        (0..bytes.count()).for_each(|gaussian| file.extend(bytes.by_channel(gaussian)));
        // The middles of steps of a 32nd, from -4 on.
        let value = |byte: u8| (f64::from(byte) + 0.5) / 32.0 - 4.0;
        let stored = Stored {
            degree,
            low: value(bytes.low),
            high: value(bytes.high),
        };
        let found = load_bytes(&file).unwrap().gaussians;
        assert_shown("compressed ply", &found, &stored, DMat3::IDENTITY);
    }
}

/// A `.spz` of version 2, with the axes that an extension says.
fn spz(degree: u32, axes: Option<u32>) -> Vec<u8> {
    // 128 is zero, and 128 steps are one.
    let stored = Stored {
        degree,
        low: 128_u8,
        high: 160,
    };
    let count = stored.count();
    let mut bytes = b"NGSP\x02\0\0\0".to_vec();
    bytes.extend((count as u32).to_le_bytes());
    bytes.extend([degree as u8, 12, if axes.is_some() { 2 } else { 0 }, 0]);
    for (value, size) in [(0, 9), (255, 1), (128, 3), (160, 3), (128, 3)] {
        bytes.resize(bytes.len() + count * size, value);
    }
    (0..count).for_each(|gaussian| bytes.extend(stored.by_coefficient(gaussian)));
    for number in axes.into_iter().flat_map(|axes| [0xADBE_0003, 4, axes]) {
        bytes.extend(number.to_le_bytes());
    }
    bytes
}

/// By Niantic's names: left or right, down or up, back or forward, in the order of their numbers.
#[test]
fn spz_turns_with_its_axes() {
    let names = ["LDB", "RDB", "LUB", "RUB", "LDF", "RDF", "LUF", "RUF"];
    let numbered = (1..).map(Some).zip(names);
    for (axes, name) in numbered.chain([(None, "RUB")]) {
        let sign = |at: usize, ours: &str| if &name[at..=at] == ours { 1.0 } else { -1.0 };
        let signs = DVec3::new(sign(0, "R"), sign(1, "D"), sign(2, "F"));
        for degree in 1..=3 {
            let found = load_bytes(&spz(degree, axes)).unwrap().gaussians;
            assert_shown(name, &found, &plain(degree), DMat3::from_diagonal(signs));
        }
    }
}

#[test]
fn ksplat_has_a_channel_after_the_other_in_each_degree() {
    for degree in 1..=3 {
        let stored = plain(degree);
        let count = stored.count() as u32;
        let mut bytes = vec![0_u8, 1, 0, 0];
        // Sections, those in use, room, Gaussians.
        bytes.extend([1, 1, count, count].map(u32::to_le_bytes).as_flattened());
        bytes.resize(4096, 0);
        bytes.extend([count, count].map(u32::to_le_bytes).as_flattened());
        bytes.resize(4096 + 40, 0);
        bytes.push(degree as u8);
        bytes.resize(4096 + 1024, 0);
        for gaussian in 0..stored.count() {
            // Centre, scales, quaternion, w first.
            extend(
                &mut bytes,
                [1.0, 2.0, 3.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
            );
            bytes.extend([128, 128, 128, 255]);
            for band in 1..=degree as usize {
                for channel in 0..3 {
                    let own = band * band - 1..(band + 1) * (band + 1) - 1;
                    extend(
                        &mut bytes,
                        own.map(|coefficient| stored.at(gaussian, coefficient, channel)),
                    );
                }
            }
        }
        let found = load_bytes(&bytes).unwrap().gaussians;
        assert_shown("ksplat", &found, &stored, DMat3::IDENTITY);
    }
}

#[test]
fn sog_has_a_pixel_for_each_coefficient() {
    for degree in 1..=3 {
        let folder = Folder::new(&format!("formats-sog-harmonics-{degree}"));
        let bytes = Stored {
            degree,
            low: 0_u8,
            high: 255,
        };
        let count = bytes.count();
        let picture = |name: &str, pixels: &[[u8; 4]]| webp(&folder.join(name), pixels);
        picture("plain.webp", &vec![[128, 128, 128, 255]; count]);
        picture("quats.webp", &vec![[128, 128, 128, 252]; count]);
        let labels: Vec<_> = (0..count).map(|set| [set as u8, 0, 0, 255]).collect();
        picture("labels.webp", &labels);
        // A row has room for 64 sets.
        let mut sets: Vec<_> = (0..count)
            .flat_map(|set| (0..count / 3).map(move |coefficient| (set, coefficient)))
            .map(|(set, coefficient)| {
                let [r, g, b] = [0, 1, 2].map(|channel| bytes.at(set, coefficient, channel));
                [r, g, b, 255]
            })
            .collect();
        sets.resize(64 * count / 3, [0; 4]);
        picture("sets.webp", &sets);
        let meta = format!(
            r#"{{
            "means": {{"shape": [{count}, 3], "mins": [0, 0, 0], "maxs": [1, 1, 1], "files": ["plain.webp", "plain.webp"]}},
            "scales": {{"mins": [-1, -1, -1], "maxs": [0, 0, 0], "files": ["plain.webp"]}},
            "quats": {{"files": ["quats.webp"]}},
            "sh0": {{"mins": [-1, -1, -1, -4], "maxs": [1, 1, 1, 6], "files": ["plain.webp"]}},
            "shN": {{"mins": 0, "maxs": 0.25, "files": ["sets.webp", "labels.webp"]}}
            }}"#
        );
        std::fs::write(folder.join("meta.json"), meta).unwrap();
        let found = load(&folder, &mut |_, _| ()).unwrap().gaussians;
        assert_shown("sog", &found, &plain(degree), DMat3::IDENTITY);
    }
}

/// A glTF of one primitive, whose `views` are parts of one buffer.
fn gltf(node: &str, primitive: &str, accessors: &[String], views: &[Vec<u8>]) -> Vec<u8> {
    let mut next = 0;
    let described = views.iter().map(|view| {
        next += view.len();
        let first = next - view.len();
        format!(
            r#"{{"buffer":0,"byteOffset":{first},"byteLength":{}}}"#,
            view.len()
        )
    });
    let described: Vec<String> = described.collect();
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{node}}}],
        "meshes":[{{"primitives":[{{"mode":0,{primitive}}}]}}],"accessors":[{}],"bufferViews":[{}],
        "buffers":[{{"byteLength":{next},"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        accessors.join(","),
        described.join(","),
        base64(&views.concat()),
    );
    text.into_bytes()
}

/// Nodes that stand as they are and turned, with the turn, in glTF's axes.
fn nodes() -> [(String, DQuat); 2] {
    let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9).normalize();
    let [x, y, z, w] = turn.to_array();
    let turned = format!(r#","rotation":[{x},{y},{z},{w}],"translation":[1,2,3],"scale":[2,2,2]"#);
    [(String::new(), DQuat::IDENTITY), (turned, turn)]
}

#[test]
fn gltf_turns_with_its_nodes() {
    const OWN: &str = "KHR_gaussian_splatting";
    for degree in 1..=3 {
        let stored = plain(degree);
        let count = stored.count();
        let all = |numbers: &[f64]| {
            let mut bytes = Vec::new();
            (0..count).for_each(|_| extend(&mut bytes, numbers.iter().copied()));
            bytes
        };
        let mut attributes = vec![
            ("POSITION".to_owned(), 3, all(&[1.0, 2.0, 3.0])),
            (format!("{OWN}:ROTATION"), 4, all(&[0.0, 0.0, 0.0, 1.0])),
            (format!("{OWN}:SCALE"), 3, all(&[1.0; 3])),
            (format!("{OWN}:SH_DEGREE_0_COEF_0"), 3, all(&[0.0; 3])),
            ("COLOR_0".to_owned(), 4, all(&[1.0; 4])),
        ];
        for (at, (l, m)) in coefficients(degree).into_iter().enumerate() {
            let mut bytes = Vec::new();
            for gaussian in 0..count {
                extend(
                    &mut bytes,
                    (0..3).map(|channel| stored.at(gaussian, at, channel)),
                );
            }
            let name = format!("{OWN}:SH_DEGREE_{l}_COEF_{}", m + l as i32);
            attributes.push((name, 3, bytes));
        }
        let (mut names, mut accessors, mut views) = (Vec::new(), Vec::new(), Vec::new());
        for (number, (name, parts, bytes)) in attributes.into_iter().enumerate() {
            names.push(format!(r#""{name}":{number}"#));
            accessors.push(format!(
                r#"{{"bufferView":{number},"componentType":5126,"count":{count},"type":"VEC{parts}"}}"#
            ));
            views.push(bytes);
        }
        let primitive = format!(
            r#""attributes":{{{}}},"extensions":{{"{OWN}":{{}}}}"#,
            names.join(",")
        );
        for (node, turn) in nodes() {
            let file = gltf(&node, &primitive, &accessors, &views);
            let found = load_bytes(&file).unwrap().gaussians;
            let to_ours = DMat3::from_diagonal(OF_GLTF) * DMat3::from_quat(turn);
            assert_shown(&format!("glTF{node}"), &found, &stored, to_ours);
        }
    }
}

/// A `.spz` in a glTF has glTF's axes.
#[test]
fn spz_in_gltf_turns_with_its_nodes() {
    let primitive = r#""extensions":{"KHR_gaussian_splatting":{"extensions":{"KHR_gaussian_splatting_compression_spz_2":{"bufferView":0}}}}"#;
    for degree in 1..=3 {
        for (node, turn) in nodes() {
            let file = gltf(&node, primitive, &[], &[spz(degree, None)]);
            let found = load_bytes(&file).unwrap().gaussians;
            let to_ours = DMat3::from_diagonal(OF_GLTF) * DMat3::from_quat(turn);
            assert_shown(
                &format!("spz in glTF{node}"),
                &found,
                &plain(degree),
                to_ours,
            );
        }
    }
}

#[test]
fn colours_turn_with_gaussians_that_are_placed_for_good() {
    for degree in 1..=3 {
        let stored = plain(degree);
        let mut scene = Gaussians::default();
        scene.set_sh_degree(degree);
        for gaussian in 0..stored.count() {
            let own = stored.by_coefficient(gaussian).map(|number| number as f32);
            let sh: Vec<f32> = [0.0; 3].into_iter().chain(own).collect();
            scene.push(Vec3::X, Vec3::ONE, Quat::IDENTITY, 0.5, &sh);
        }
        assert_shown("as it is", &scene, &stored, DMat3::IDENTITY);
        let quarter = DQuat::from_rotation_y(0.5 * PI);
        for turn in [quarter, quarter.inverse(), nodes()[1].1] {
            let placement = Placement::new(DVec3::ONE, turn, 3.0).unwrap();
            let mut placed = scene.clone();
            assert!(placed.place(&placement).is_empty());
            assert_shown("placed", &placed, &stored, DMat3::from_quat(turn));
        }
    }
}
