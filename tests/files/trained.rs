//! Files that say how their Gaussians were trained are drawn so.

use std::path::Path;

use rara::Gaussians;
use rara::glam::Vec3;
use rara::scene::{Kind, SceneFile, generate, load, load_from, load_from_with, save};
use rara::{SortBy, Training};

use crate::common::folder::Folder;
use crate::files::ply::made::{FIXED, Format, floats, scene_file};

fn loaded(bytes: Vec<u8>) -> SceneFile {
    let name = Path::new("made up");
    load_from(std::io::Cursor::new(bytes), name, &mut |_, _| ()).expect("it is a scene")
}

#[test]
fn formats_that_can_say_it_keep_what_is_antialiased() {
    let folder = Folder::new("formats-antialiased");
    let mut scene = generate(Kind::General, 300, 7);
    for (antialiased, low_pass, sort_by) in [
        (true, 0.3, SortBy::Depth),
        (false, 0.3, SortBy::Distance),
        (true, 0.1, SortBy::Distance),
        (false, 0.7, SortBy::Depth),
    ] {
        let training = Training::default()
            .antialiased(antialiased)
            .low_pass(low_pass)
            .sort_by(sort_by);
        scene.set_training(training).expect("can be drawn");
        for name in ["a.ply", "a.compressed.ply", "a.spz", "a.sog", "a.glb"] {
            let path = folder.join(name);
            save(&path, &scene).expect("it is written");
            let read = load(&path, &mut |_, _| ()).expect("it is read");
            let kept = match name {
                "a.spz" => Training::default().antialiased(antialiased),
                _ => training,
            };
            assert_eq!(read.gaussians.training(), kept, "{name}");
        }
    }
}

#[test]
fn comments_of_trainers_are_read() {
    let said = |comment: &str| {
        let mut file = scene_file(Format::Little, 2, &floats(FIXED));
        file.header = file
            .header
            .replace("element", &format!("comment {comment}\nelement"));
        loaded(file.bytes())
    };
    for (comment, expected) in [
        ("SplatRenderMode: mip", true),
        ("SplatRenderMode: default", false),
        ("antialiased 1", true),
        ("antialiased 0", false),
        ("antialiasing is a word", false),
    ] {
        let found = said(comment).gaussians.training();
        assert_eq!(found.antialiased, expected, "{comment}");
        assert_eq!(found.low_pass, 0.3, "{comment}");
    }
    let of_brush = said("Exported from Brush\ncomment SplatRenderMode: mip");
    let mip = Training::default().antialiased(true).low_pass(0.1);
    assert_eq!(of_brush.gaussians.training(), mip);
    // What cannot be drawn is said.
    for value in ["0", "-1", "NaN", "1e9"] {
        let found = said(&format!("LowPass: {value}"));
        assert_eq!(found.gaussians.training(), Training::default(), "{value}");
        let report = found.report.to_string();
        assert!(report.contains("low-pass"), "{value}: {report}");
    }
}

#[test]
fn filters_of_mip_splatting_smooth() {
    let mut names = FIXED.to_vec();
    names.push("filter_3D");
    let plain = loaded(scene_file(Format::Ascii, 8, &floats(FIXED)).bytes());
    let bytes = scene_file(Format::Ascii, 8, &floats(&names)).bytes();
    let made = loaded(bytes.clone());
    assert!(made.gaussians.is_antialiased() && !plain.gaussians.is_antialiased());
    assert_eq!(
        (made.gaussians.low_pass(), plain.gaussians.low_pass()),
        (0.1, 0.3)
    );
    assert!(
        made.report.to_string().contains("filter_3D"),
        "{}",
        made.report
    );
    // Who asks for the property gets it as well.
    let source = std::io::Cursor::new(bytes);
    let asked = load_from_with(source, Path::new("made up"), &["filter_3D"], &mut |_, _| ());
    let (asked, properties) = asked.expect("it is a scene");
    assert_eq!(asked, made);
    let [filters] = &properties[..] else {
        panic!("{properties:?} is not one property");
    };
    for (at, filter) in filters.values.iter().enumerate() {
        let squares = plain.gaussians.scales()[at].as_dvec3().powf(2.0) + filter * filter;
        let scale = squares.map(f64::sqrt).as_vec3();
        let found = made.gaussians.scales()[at];
        assert!(
            (found - scale)
                .abs()
                .cmple(1e-6 * scale + Vec3::splat(f32::MIN_POSITIVE))
                .all()
        );
        let mass = |set: &Gaussians| set.opacities()[at] * set.scales()[at].element_product();
        let (before, after) = (mass(&plain.gaussians), mass(&made.gaussians));
        assert!((before - after).abs() <= 1e-5 * before, "{before} {after}");
    }
}
