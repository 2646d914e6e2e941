//! Files that must be refused, in one or two sentences that help.

use std::path::Path;

use rara::scene::load;

use super::made::{FIXED, FORMATS, File, Format, floats, refusal, scene_file};

#[test]
fn headers_that_are_refused() {
    let with = |line: &str| {
        let mut file = scene_file(Format::Ascii, 1, &floats(FIXED));
        file.header += line;
        file.bytes()
    };
    let without = |name: &str| {
        let names: Vec<_> = FIXED.iter().copied().filter(|n| *n != name).collect();
        scene_file(Format::Ascii, 1, &floats(&names)).bytes()
    };
    let rest = |numbers: &[&str]| {
        with(
            &numbers
                .iter()
                .map(|n| format!("property float f_rest_{n}\n"))
                .collect::<String>(),
        )
    };
    let compressed = b"ply\nformat binary_little_endian 1.0\nelement chunk 1\nproperty float min_x\nelement vertex 1\n\
        property uint packed_position\nend_header\n";
    let mesh = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
        element face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n";
    for (bytes, words) in [
        (b"".to_vec(), "empty"),
        (b"plywood\n".to_vec(), "not a PLY"),
        (b"\x1f\x8b\x08".to_vec(), "gzip"),
        (b"ply\nformat ascii 1.0\n".to_vec(), "cut off"),
        (b"ply\nend_header\n".to_vec(), "format"),
        (
            b"ply\nformat ascii 1.0\nend_header\n".to_vec(),
            "no `vertex`",
        ),
        (
            b"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n".to_vec(),
            "line 3",
        ),
        (
            b"ply\nformat ascii 1.0\nelement vertex -1\nend_header\n".to_vec(),
            "line 3",
        ),
        (
            b"ply\nformat ascii 1.0\nelement a 1000000000\nend_header\n".to_vec(),
            "without any property",
        ),
        (compressed.to_vec(), "`chunk` with its 1 element"),
        (mesh.to_vec(), "mesh"),
        (
            with("property float f_offset_0\nproperty float f_anchor_feat_0\n"),
            "anchors of Scaffold-GS",
        ),
        (without("opacity"), "does not have opacity"),
        (without("rot_3"), "does not have rot_3"),
        (
            with("property float x\n"),
            "line 19 of the header declares the property `x` a second time",
        ),
        (with("element vertex 1\n"), "a second time"),
        (with("property list float int a\n"), "not an integer"),
        (with("bogus\n"), "line 19"),
        (rest(&["0", "1"]), "2 f_rest"),
        (rest(&["0", "2", "3"]), "no f_rest_1"),
        (rest(&["0", "1x", "2"]), "f_rest_1x"),
        (rest(&["0", "01", "2"]), "f_rest_01"),
        (rest(&["0", "18446744073709551616"]), "not a valid"),
    ] {
        let message = refusal(&bytes);
        assert!(message.contains(words), "{message:?} lacks {words:?}");
        assert!(
            !message.contains('\n') && message.contains([';', ',']),
            "{message:?}"
        );
    }
    for name in [
        "trbf_center",
        "motion_0",
        "omega_3",
        "t",
        "scale_t",
        "rot_r_0",
        "velocity_x",
    ] {
        let message = refusal(&with(&format!("property float {name}\n")));
        let says = format!("change with time (by 1 property, such as `{name}`)");
        assert!(
            message.contains(&says) && message.contains("for each moment"),
            "{message}"
        );
    }
    let mut file = File::new(Format::Ascii);
    let properties: Vec<_> = FIXED
        .iter()
        .map(|n| {
            (
                if *n == "opacity" {
                    "list uchar float"
                } else {
                    "float"
                },
                *n,
            )
        })
        .collect();
    file.element("vertex", 1, &properties);
    file.payload.extend([b'1', b' '].repeat(40));
    assert!(refusal(&file.bytes()).contains("`opacity` is a list"));
}

#[test]
fn counts_beyond_the_file_are_refused_before_anything_is_allocated() {
    for format in FORMATS {
        for count in [3, 1_000_000_000, u32::MAX as usize, u64::MAX as usize] {
            for before in [false, true] {
                let mut file = File::new(format);
                if before {
                    file.element("face", count, &[("list uint double", "a")]);
                }
                file.element("vertex", if before { 2 } else { count }, &floats(FIXED));
                file.payload = scene_file(format, 2, &floats(FIXED)).payload;
                file.payload.truncate(file.payload.len() - 1);
                refusal(&file.bytes());
            }
        }
    }
    // A list whose length leads beyond the file's end.
    for kind in ["uint", "int"] {
        let mut file = File::new(Format::Little);
        let mut properties = floats(FIXED);
        properties.push((
            if kind == "int" {
                "list int double"
            } else {
                "list uint double"
            },
            "a",
        ));
        file.element("vertex", 1, &properties);
        FIXED.iter().for_each(|_| file.number("float", 1.0));
        file.number(kind, if kind == "int" { -1.0 } else { 4e9 });
        refusal(&file.bytes());
    }
}

#[test]
fn ascii_errors_name_the_line() {
    let cases = [
        ("0 0 0", "too few"),
        ("x", "\"x\" is not a number"),
        (&"0 ".repeat(15), "more numbers"),
        ("", "cut off"),
    ];
    for (line, words) in cases {
        let mut file = scene_file(Format::Ascii, 1, &floats(FIXED));
        file.header = file.header.replace("vertex 1", "vertex 2");
        file.payload.extend(line.as_bytes());
        file.payload.extend([b' '; 60]);
        let message = refusal(&file.bytes());
        assert!(
            message.starts_with("line 2") && message.contains(words),
            "{message}"
        );
    }
}

#[test]
fn folders_and_missing_files_are_errors() {
    assert!(load(&std::env::temp_dir(), &mut |_, _| ()).is_err());
    assert!(
        load(Path::new("no/such/file.ply"), &mut |_, _| ())
            .unwrap_err()
            .to_string()
            .contains("no/such")
    );
}
