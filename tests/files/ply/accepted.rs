//! Files that must load, and the Gaussians that they must give.

use std::io::Cursor;
use std::path::Path;

use glam::{DVec3, Quat, Vec3};
use rara::scene::{Gaussians, LoadOptions, load, load_from_with, save_ply, sh_coefficients};

use super::made::{FIXED, FORMATS, File, Format, floats, load_bytes, scene_file, value};

fn check_scene(scene: &Gaussians, count: usize) {
    assert_eq!(scene.len(), count);
    for i in 0..count {
        let v = |name: &str| value(name, i, false);
        assert_eq!(
            scene.positions()[i],
            Vec3::new(v("x") as f32, v("y") as f32, v("z") as f32)
        );
        assert_eq!(scene.scales()[i].y, v("scale_1").exp() as f32);
        assert_eq!(
            scene.opacities()[i],
            (1.0 / (1.0 + (-v("opacity")).exp())) as f32
        );
        let q = Quat::from_xyzw(
            v("rot_1") as f32,
            v("rot_2") as f32,
            v("rot_3") as f32,
            v("rot_0") as f32,
        );
        assert!(scene.rotations()[i].abs_diff_eq(q.normalize(), 1e-6));
        let rest = scene.sh_coefficients() - 1;
        let sh = scene.sh_of(i);
        for channel in 0..3 {
            assert_eq!(sh[channel], v(&format!("f_dc_{channel}")) as f32);
            for coefficient in 0..rest {
                let name = format!("f_rest_{}", channel * rest + coefficient);
                assert_eq!(sh[3 * (coefficient + 1) + channel], v(&name) as f32);
            }
        }
    }
}

#[test]
fn every_degree_order_and_encoding() {
    for format in FORMATS {
        for degree in 0..4 {
            let rest: Vec<_> = (0..3 * (sh_coefficients(degree) - 1))
                .map(|i| format!("f_rest_{i}"))
                .collect();
            let mut names: Vec<&str> = FIXED.to_vec();
            names.extend(rest.iter().map(String::as_str));
            names.extend(["nx", "confidence"]);
            for turn in [0, 5, 13] {
                names.rotate_left(turn);
                names.reverse();
                let loaded = load_bytes(&scene_file(format, 7, &floats(&names)).bytes()).unwrap();
                assert!(loaded.report.is_clean(), "{}", loaded.report);
                assert_eq!(loaded.gaussians.sh_degree(), degree);
                check_scene(&loaded.gaussians, 7);
            }
        }
    }
}

/// Channel by channel, so that what is left out lies between what is read.
#[test]
fn the_harmonics_of_degree_4_are_left_out_and_said() {
    let rest: Vec<String> = (0..72).map(|i| format!("f_rest_{i}")).collect();
    let mut names = FIXED.to_vec();
    names.extend(rest.iter().map(String::as_str));
    for format in FORMATS {
        let loaded = load_bytes(&scene_file(format, 5, &floats(&names)).bytes()).unwrap();
        assert_eq!(
            loaded.report.lines(),
            ["left out the spherical harmonics of degree 4, which are not drawn"]
        );
        assert_eq!(loaded.gaussians.sh_degree(), 3);
        for i in 0..5 {
            for (at, own) in loaded.gaussians.sh_of(i)[3..].iter().enumerate() {
                let name = &rest[at % 3 * 24 + at / 3];
                assert_eq!(f64::from(*own), value(name, i, false), "{name}");
            }
        }
    }
}

/// What activated columns are cannot be known; where all lie within 0 to 1 a note says what to do.
#[test]
fn activated_columns_are_read_as_they_are_where_that_is_asked_for() {
    let activated = |number: f64, name: &str| match name {
        "opacity" => 0.125 * number,
        name if name.starts_with("scale_") => 0.25 * number,
        _ => 1.0,
    };
    for (most, notes) in [(4, 2), (9, 0)] {
        let mut file = File::new(Format::Little);
        file.element("vertex", most, &floats(FIXED));
        for number in 1..=most {
            FIXED
                .iter()
                .for_each(|name| file.number("float", activated(number as f64, name)));
        }
        let bytes = file.bytes();
        let usual = load_bytes(&bytes).unwrap();
        let text = usual.report.lines().join("; ");
        assert_eq!(usual.report.notes.len(), notes, "{text}");
        let flags = ["--activated opacity", "--activated scale"];
        assert!(
            flags.iter().all(|flag| notes == 0 || text.contains(flag)),
            "{text}"
        );
        for (opacity, scale) in [(true, false), (false, true), (true, true)] {
            let options = LoadOptions::default().activated(opacity, scale);
            let (read, _) =
                load_from_with(Cursor::new(&bytes), Path::new("a"), options, &mut |_, _| ())
                    .unwrap();
            for number in 1..=most.min(4) {
                let [o, s] = [0.125, 0.25].map(|unit| (unit * number as f64) as f32);
                let own = (
                    read.gaussians.opacities()[number - 1],
                    read.gaussians.scales()[number - 1].x,
                );
                let plain = (1.0 / (1.0 + (-f64::from(o)).exp())) as f32;
                let expected = (
                    if opacity { o } else { plain },
                    if scale { s } else { f64::from(s).exp() as f32 },
                );
                assert_eq!(own, expected);
            }
            assert_eq!(
                read.report.repaired,
                if most > 8 && opacity { 1 } else { 0 }
            );
        }
    }
}

#[test]
fn a_comment_says_what_is_up() {
    let mut file = scene_file(Format::Ascii, 3, &floats(FIXED));
    let header = file.header.clone();
    for (axis, up) in [
        ("z", Some(DVec3::Z)),
        ("-Y", Some(DVec3::NEG_Y)),
        ("w", None),
    ] {
        file.header = header.replacen(
            "element",
            &format!("comment Vertical Axis: {axis}\nelement"),
            1,
        );
        assert_eq!(load_bytes(&file.bytes()).unwrap().up, up, "{axis}");
    }
}

#[test]
fn doubles_and_lists_and_other_types() {
    for format in FORMATS {
        let mut properties = vec![
            ("list uchar int", "seen_by"),
            ("uchar", "red"),
            ("int16", "label"),
        ];
        properties.extend(FIXED.iter().map(|name| ("double", *name)));
        properties.push(("list uint float64", "history"));
        check_scene(
            &load_bytes(&scene_file(format, 9, &properties).bytes())
                .unwrap()
                .gaussians,
            9,
        );
        properties.retain(|(kind, _)| !kind.starts_with("list"));
        check_scene(
            &load_bytes(&scene_file(format, 9, &properties).bytes())
                .unwrap()
                .gaussians,
            9,
        );
        // Positions as integers of each type.
        for kind in ["char", "uint8", "short", "ushort", "int32", "uint"] {
            let whole: Vec<_> = FIXED
                .iter()
                .map(|n| (if *n == "x" { kind } else { "float" }, *n))
                .collect();
            let loaded = load_bytes(&scene_file(format, 3, &whole).bytes()).unwrap();
            assert_eq!(
                loaded.gaussians.positions()[2].x,
                value("x", 2, true) as f32
            );
        }
    }
}

#[test]
fn other_elements_before_and_after() {
    for format in FORMATS {
        let mut file = File::new(format);
        file.element("camera", 2, &[("float", "x"), ("uchar", "y")]);
        file.element(
            "face",
            3,
            &[("list uchar int", "vertex_indices"), ("short", "label")],
        );
        file.element("vertex", 4, &floats(FIXED));
        file.element("edge", 1, &[("int", "a")]);
        for i in 0..2 {
            file.number("float", f64::from(i));
            file.number("uchar", 3.0);
            file.end_element();
        }
        for i in 0..3 {
            file.number("uchar", f64::from(i));
            (0..i).for_each(|_| file.number("int", 1.0));
            file.number("short", -1.0);
            file.end_element();
        }
        let vertices = scene_file(format, 4, &floats(FIXED));
        file.payload.extend(vertices.payload);
        file.number("int", 1.0);
        file.end_element();
        let loaded = load_bytes(&file.bytes()).unwrap();
        check_scene(&loaded.gaussians, 4);
        assert!(loaded.report.is_clean(), "{}", loaded.report);
    }
}

#[test]
fn what_a_header_lacks_is_made_up_for_and_said() {
    for format in FORMATS {
        let mut names = FIXED.to_vec();
        names.retain(|name| *name != "scale_2");
        let flat = load_bytes(&scene_file(format, 5, &floats(&names)).bytes()).unwrap();
        assert!(
            flat.report
                .to_string()
                .contains("discs of 2D Gaussian Splatting")
        );
        for (i, scale) in flat.gaussians.scales().iter().enumerate() {
            assert_eq!(scale.y, value("scale_1", i, false).exp() as f32);
            assert_eq!(scale.z, 1e-3 * scale.x.min(scale.y));
        }

        names = FIXED.to_vec();
        names.retain(|name| !name.starts_with("f_dc_"));
        for (kind, full) in [("uchar", 255.0), ("uint16", 65535.0), ("float", 1.0)] {
            let mut properties = floats(&names);
            properties.extend(["red", "green", "blue"].map(|name| (kind, name)));
            let coloured = load_bytes(&scene_file(format, 5, &properties).bytes()).unwrap();
            assert!(
                coloured
                    .report
                    .to_string()
                    .contains("from red, green and blue")
            );
            for i in 0..5 {
                let share = value("green", i, kind != "float") / full;
                let shown = coloured.gaussians.sh_of(i)[1] * 0.282_094_8 + 0.5;
                assert!((f64::from(shown) - share).abs() < 1e-6 * share.abs().max(1.0));
            }
            properties.retain(|(_, name)| *name != "blue");
            let error = load_bytes(&scene_file(format, 5, &properties).bytes()).unwrap_err();
            assert!(
                error
                    .to_string()
                    .contains("does not have f_dc_0, f_dc_1, f_dc_2"),
                "{error}"
            );
        }

        let mut file = scene_file(format, 5, &floats(FIXED));
        file.header = file.header.replacen("element", "\n  \nelement", 1);
        if format != Format::Ascii {
            file.header += "element sh 7\n";
        }
        let blank = load_bytes(&file.bytes()).unwrap();
        assert_eq!(
            blank.report.lines(),
            ["skipped 2 blank lines of the header"]
        );
        check_scene(&blank.gaussians, 5);
    }
}

#[test]
fn line_ends_and_missing_last_one() {
    let file = scene_file(Format::Ascii, 3, &floats(FIXED)).bytes();
    let text = String::from_utf8(file).unwrap();
    for text in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace('\n', "\n\n").replacen("\n\n", "\n", 18),
        text.trim_end().into(),
    ] {
        check_scene(&load_bytes(text.as_bytes()).unwrap().gaussians, 3);
    }
    let binary = scene_file(Format::Little, 3, &floats(FIXED));
    let bytes = [
        binary.header.replace('\n', "\r\n").as_bytes(),
        b"end_header\r\n",
        &binary.payload,
    ]
    .concat();
    check_scene(&load_bytes(&bytes).unwrap().gaussians, 3);
}

#[test]
fn trailing_bytes_are_reported() {
    for format in FORMATS {
        let mut file = scene_file(format, 2, &floats(FIXED));
        file.payload.extend(b"tail");
        let loaded = load_bytes(&file.bytes()).unwrap();
        assert_eq!(loaded.report.trailing_bytes, 4);
        assert!(loaded.report.to_string().contains("4 byte"));
    }
}

#[test]
fn bad_elements_are_dropped_and_counted() {
    let mut file = File::new(Format::Ascii);
    file.element("vertex", 4, &floats(FIXED));
    file.payload.extend(b"nan 0 0 0 0 0 0 0 0 0 1 0 0 0\n0 0 0 0 0 0 0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0 1e3 0 1 0 0 0\n");
    file.payload.extend(b"0 1e39 0 0 0 0 0 0 0 0 1 0 0 0\n");
    let loaded = load_bytes(&file.bytes()).unwrap();
    let report = &loaded.report;
    assert_eq!(
        (loaded.gaussians.len(), report.dropped, report.repaired),
        (1, 3, 1)
    );
    assert_eq!(
        report
            .first_dropped
            .iter()
            .map(|r| r.element)
            .collect::<Vec<_>>(),
        [0, 2, 3]
    );
    assert_eq!(report.lines().len(), 2);
}

#[test]
fn an_empty_scene_is_a_scene() {
    for format in FORMATS {
        assert!(
            load_bytes(&scene_file(format, 0, &floats(FIXED)).bytes())
                .unwrap()
                .gaussians
                .is_empty()
        );
    }
}

#[test]
fn saving_and_loading_gives_the_scene_back() {
    for degree in 0..4 {
        let file = scene_file(Format::Little, 50, &floats(FIXED));
        let mut scene = load_bytes(&file.bytes()).unwrap().gaussians;
        scene.set_sh_degree(degree);
        scene
            .sh_mut()
            .iter_mut()
            .enumerate()
            .for_each(|(i, v)| *v = i as f32 * 0.01);
        scene.scales_mut()[3].x = 0.0;
        scene.opacities_mut()[4] = 1.0;
        scene.opacities_mut()[5] = 0.0;
        let path =
            std::env::temp_dir().join(format!("rara-ply-save-{}-{degree}.ply", std::process::id()));
        save_ply(&path, &scene).unwrap();
        let loaded = load(&path, &mut |_, _| ()).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert!(loaded.report.is_clean());
        let back = loaded.gaussians;
        assert_eq!(
            (back.positions(), back.sh(), back.sh_degree()),
            (scene.positions(), scene.sh(), degree)
        );
        for i in 0..50 {
            assert!(
                back.scales()[i]
                    .abs_diff_eq(scene.scales()[i], 1e-6 * scene.scales()[i].max_element())
            );
            assert!(back.rotations()[i].abs_diff_eq(scene.rotations()[i], 1e-6));
            assert!((back.opacities()[i] - scene.opacities()[i]).abs() < 1e-6);
        }
        assert_eq!(
            (back.scales()[3].x, back.opacities()[4], back.opacities()[5]),
            (0.0, 1.0, 0.0)
        );
    }
}
