//! What is written is read again as it was, within the format's steps.

use rara::glam::{DQuat, DVec3, Quat, Vec3};
use rara::scene::{Kind, SaveOptions, generate, load, save, save_ply, save_with};
use rara::{Gaussians, Placement};

use super::distance::Distance;
use crate::common::folder::Folder;

/// A scene whose harmonics are not zero.
fn scene(count: usize) -> Gaussians {
    let mut scene = generate(Kind::General, count, 7);
    scene.set_sh_degree(3);
    let mut number = 1_u32;
    for (at, value) in scene.sh_mut().iter_mut().enumerate() {
        number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if at % 48 >= 3 {
            *value = (number >> 8) as f32 / (1 << 24) as f32 - 0.5;
        }
    }
    scene
}

#[test]
fn round_trips_stay_within_the_formats_steps() {
    let folder = Folder::new("formats-written");
    let scene = scene(3000);
    let extent = scene
        .positions()
        .iter()
        .map(|p| p.abs().max_element())
        .fold(0.0, f32::max);
    let rotation = 4.0 * std::f32::consts::SQRT_2;
    for (name, [position, scale, turned, opacity, colour, harmonics]) in [
        ("a.ply", [0.0, 1e-5, 1e-3, 1e-6, 0.0, 0.0]),
        ("a.glb", [0.0, 0.0, 1e-3, 0.0, 0.0, 1e-6]),
        (
            "a.compressed.ply",
            [
                extent / 1023.0,
                0.01,
                rotation / 1023.0,
                0.002,
                0.01,
                0.0157,
            ],
        ),
        ("a.spz", [2e-4, 0.032, 4.0 / 511.0, 0.002, 0.004, 0.0040]),
        (
            "a.sog",
            [extent / 5e3, 0.1, rotation / 255.0, 0.002, 0.01, 0.0040],
        ),
    ] {
        let path = folder.join(name);
        save(&path, &scene).unwrap();
        let loaded = load(&path, &mut |_, _| ()).unwrap();
        assert!(loaded.report.is_clean(), "{name}: {}", loaded.report);
        let distance = Distance::between(&scene, &loaded.gaussians, 2.0 * position + 1e-4, 5e-5);
        eprintln!("{name}: {distance:?}");
        for (what, found, bound) in [
            ("position", distance.position, position),
            ("scale", distance.scale, scale),
            ("rotation", distance.rotation, turned),
            ("opacity", distance.opacity, opacity),
            ("colour", distance.colour, colour),
            ("harmonics", distance.harmonics, harmonics),
        ] {
            assert!(
                found <= bound,
                "{name}: {what} is off by {found}, over {bound}"
            );
        }
    }
}

#[test]
fn what_no_reader_could_draw_is_not_written() {
    let folder = Folder::new("formats-unsound");
    let mut scene = scene(300);
    scene.positions_mut()[7].y = f32::INFINITY;
    for name in ["a.ply", "a.glb", "a.compressed.ply", "a.spz", "a.sog"] {
        let path = folder.join(name);
        let error = save(&path, &scene).unwrap_err().to_string();
        assert!(error.contains("positions[7]"), "{error}");
        assert!(!path.exists());
    }
}

#[test]
fn what_a_format_clamps_is_counted() {
    let folder = Folder::new("formats-clamped");
    let mut plain = scene(300);
    plain.scales_mut().fill(Vec3::splat(0.1));
    let mut changed = plain.clone();
    changed.scales_mut()[0].x = 2e9;
    changed.sh_mut()[48 + 5] = 2.0;
    changed.sh_mut()[2 * 48 + 5] = -5.0;
    changed.scales_mut()[3].z = 0.0;
    for (name, clamped) in [
        ("a.ply", 0),
        ("a.glb", 0),
        ("a.compressed.ply", 3),
        ("a.spz", 4),
        ("a.sog", 1),
    ] {
        let path = folder.join(name);
        assert_eq!(save(&path, &plain).unwrap(), 0, "{name}");
        assert_eq!(save(&path, &changed).unwrap(), clamped, "{name}");
    }
}

/// The first writing rounds; after that nothing changes any more but the order.
#[test]
fn what_was_rounded_once_stays() {
    let folder = Folder::new("formats-twice");
    for name in ["a.spz", "a.glb"] {
        let path = folder.join(name);
        save(&path, &scene(300)).unwrap();
        let once = load(&path, &mut |_, _| ()).unwrap().gaussians;
        save(&path, &once).unwrap();
        let twice = load(&path, &mut |_, _| ()).unwrap().gaussians;
        assert_eq!(once.positions(), twice.positions(), "{name}");
        assert_eq!(once.opacities(), twice.opacities(), "{name}");
        let distance = Distance::between(&once, &twice, 1e-3, 1e-5);
        assert!(
            distance.scale < 1e-6 && distance.harmonics < 1e-6,
            "{name}: {distance:?}"
        );
    }
}

#[test]
fn scenes_of_nothing_and_of_extremes_are_written() {
    let folder = Folder::new("formats-extremes");
    let mut extremes = Gaussians::default();
    for scale in [0.0, 1e-30, 1e20] {
        let position = Vec3::new(-1e3, scale, 2e3).min(Vec3::splat(1e5));
        extremes.push(
            position,
            Vec3::splat(scale),
            Quat::from_xyzw(0.0, 0.0, 0.0, -1.0),
            1.0,
            &[9.0, -9.0, 0.0],
        );
    }
    for scene in [Gaussians::default(), extremes] {
        for name in ["a.ply", "a.glb", "a.compressed.ply", "a.spz", "a.sog"] {
            let path = folder.join(name);
            save(&path, &scene).unwrap();
            let loaded = load(&path, &mut |_, _| ()).unwrap();
            assert!(loaded.report.is_clean(), "{name}: {}", loaded.report);
            assert_eq!(loaded.gaussians.len(), scene.len(), "{name}");
        }
    }
}

/// Chunks of a wide and flat scene are small: a curve through it jumps from one side to the other, and a chunk with such a jump has
/// steps of half a metre in a kilometre.
#[test]
fn chunks_of_wide_scenes_are_small() {
    let folder = Folder::new("formats-chunks");
    for flat in 0..3 {
        let mut scene = generate(Kind::Layers, 200_000, 5);
        let mut number = 9_u32;
        let mut share = || {
            number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (number >> 8) as f32 / (1 << 24) as f32
        };
        for position in scene.positions_mut() {
            *position = 1000.0 * Vec3::new(share(), share(), share());
            position[flat] *= 0.01;
        }
        let path = folder.join("wide.compressed.ply");
        save(&path, &scene).unwrap();
        let loaded = load(&path, &mut |_, _| ()).unwrap().gaussians;
        // The order is another one.
        let along = |scene: &Gaussians, axis: usize| {
            let mut all: Vec<f32> = scene.positions().iter().map(|p| p[axis]).collect();
            all.sort_by(f32::total_cmp);
            all
        };
        for axis in 0..3 {
            let pairs = along(&scene, axis).into_iter().zip(along(&loaded, axis));
            let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(error < 0.024, "flat along {flat}: {error} along {axis}");
        }
    }
}

/// Every version of .spz that is written holds the same numbers; rotations of the second in steps of their own.
#[test]
fn versions_of_spz() {
    let folder = Folder::new("formats-versions");
    for scene in [
        scene(700),
        generate(Kind::Layers, 30, 2),
        Gaussians::default(),
    ] {
        let written = |version: u32| {
            let path = folder.join(format!("v{version}.spz"));
            let options = SaveOptions::default().spz_version(version);
            save_with(&path, &scene, &options).unwrap();
            let loaded = load(&path, &mut |_, _| ()).unwrap();
            assert!(loaded.report.is_clean(), "{version}: {}", loaded.report);
            (std::fs::read(&path).unwrap(), loaded.gaussians)
        };
        let [(_, second), (third, of_third), (fourth, of_fourth)] = [2, 3, 4].map(written);
        assert_eq!(of_third, of_fourth);
        assert!(third.starts_with(&[0x1f, 0x8b]) && fourth.starts_with(b"NGSP\x04\0\0\0"));
        save(&folder.join("usual.spz"), &scene).unwrap();
        assert_eq!(third, std::fs::read(folder.join("usual.spz")).unwrap());
        let mut as_second = of_third.clone();
        as_second
            .rotations_mut()
            .copy_from_slice(second.rotations());
        assert_eq!(second, as_second);
        for (read, given) in second.rotations().iter().zip(scene.rotations()) {
            let sign = if given.w < 0.0 { -1.0 } else { 1.0 };
            let apart = (*read * sign - *given).xyz().abs();
            assert!(apart.max_element() < 1.0 / 254.0, "{read} {given}");
        }
        for version in [0, 1, 5] {
            let options = SaveOptions::default().spz_version(version);
            let error = save_with(&folder.join("no.spz"), &scene, &options).unwrap_err();
            assert!(error.to_string().contains("give 2, 3 or 4"), "{error}");
        }
    }
}

#[test]
fn centres_that_spz_cannot_hold_are_refused() {
    let folder = Folder::new("formats-far");
    let mut far = Gaussians::default();
    far.push(Vec3::splat(1e9), Vec3::ONE, Quat::IDENTITY, 1.0, &[0.0; 3]);
    let path = folder.join("a.spz");
    let error = save(&path, &far).unwrap_err().to_string();
    assert!(error.contains("1e9") && !path.exists(), "{error}");
}

/// What a glTF node places is where it says, whatever its axes are called.
#[test]
fn nodes_of_gltf_place_their_gaussians() {
    let folder = Folder::new("formats-nodes");
    let scene = scene(20);
    let (plain, path) = (folder.join("a.glb"), folder.join("b.glb"));
    save(&plain, &scene).unwrap();
    let bytes = std::fs::read(&plain).unwrap();
    let from = r#""nodes":[{"mesh":0}]"#;
    // As long as what stands there, so that no length changes.
    let text = String::from_utf8_lossy(&bytes).into_owned();
    assert!(text.contains(from));
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json = std::str::from_utf8(&bytes[20..20 + length]).unwrap();
    let to = r#""nodes":[{"children":[1],"scale":[2,2,2]},{"mesh":0,"translation":[1,2,3]}]"#;
    let json = format!(
        "{:<width$}",
        json.trim_end().replace(from, to),
        width = length + 128
    )
    .into_bytes();
    let mut changed = b"glTF\x02\0\0\0".to_vec();
    changed.extend(((bytes.len() + json.len() - length) as u32).to_le_bytes());
    changed.extend((json.len() as u32).to_le_bytes());
    changed.extend(b"JSON");
    changed.extend(&json);
    changed.extend(&bytes[20 + length..]);
    std::fs::write(&path, changed).unwrap();
    let loaded = load(&path, &mut |_, _| ()).unwrap().gaussians;
    // glTF's left, up and forward are ours turned by half about the third.
    let mut expected = scene.clone();
    let offset = rara::glam::DVec3::new(-2.0, -4.0, 6.0);
    let _all_fit =
        expected.place(&Placement::new(offset, rara::glam::DQuat::IDENTITY, 2.0).unwrap());
    let distance = Distance::between(&expected, &loaded, 1e-3, 1e-9);
    assert!(
        distance.position < 1e-4 && distance.scale < 1e-5 && distance.harmonics < 1e-5,
        "{distance:?}"
    );
    save_ply(&path, &loaded).unwrap();
}

/// Coordinates of a map, of which single precision has half units.
#[test]
fn centres_far_from_zero_keep_their_digits() {
    let folder = Folder::new("formats-far");
    let mut scene = generate(Kind::General, 300, 7);
    let far = DVec3::new(500_000.0, 5_800_000.0, 100.0);
    scene.set_origin(far).expect("it is finite");
    for name in ["a.ply", "a.glb"] {
        let path = folder.join(name);
        save(&path, &scene).expect("it is written");
        let read = load(&path, &mut |_, _| ()).expect("it is read");
        let report = read.report.to_string();
        assert!(
            report.contains("stored the centres relative to"),
            "{name}: {report}"
        );
        let read = read.gaussians;
        assert!(read.origin().distance(far) < 2.0, "{name}");
        for index in 0..scene.len() {
            let apart = read.centre(index).distance(scene.centre(index));
            assert!(apart < 3e-7, "{name}: {apart}");
        }
        save(&path, &read).expect("it is written");
        let again = load(&path, &mut |_, _| ()).expect("it is read").gaussians;
        assert_eq!(again.origin(), read.origin(), "{name}");
        assert!(again.positions() == read.positions(), "{name}");
    }
    // What lies near zero is stored and read as ever.
    let (path, near) = (folder.join("near.ply"), generate(Kind::General, 30, 7));
    save(&path, &near).expect("it is written");
    let read = load(&path, &mut |_, _| ()).expect("it is read").gaussians;
    assert_eq!(
        (read.origin(), read.positions()),
        (DVec3::ZERO, near.positions())
    );
}

/// What is placed far away has its origin there, and sets of several origins become one.
#[test]
fn places_far_away_are_origins() {
    let mut scene = generate(Kind::General, 300, 7);
    let near = scene.clone();
    let far = DVec3::new(-1_714_128.625, 4_991_800.25, 3_569_099.75);
    let placement = Placement::new(far, DQuat::from_rotation_z(0.3), 2.0).expect("finite numbers");
    assert!(scene.place(&placement).is_empty());
    for index in 0..near.len() {
        let expected = placement.to_world(near.centre(index));
        assert!(scene.centre(index).distance(expected) < 1e-6);
    }
    let mut other = near.clone();
    other.set_origin(far + 10.0).expect("it is finite");
    let mut both = scene.clone();
    both.append(&other);
    assert_eq!(both.origin(), scene.origin());
    for index in 0..near.len() {
        let apart = both
            .centre(scene.len() + index)
            .distance(other.centre(index));
        assert!(apart < 2e-6, "{apart}");
    }
    // Back near zero it has none.
    let back = Placement::new(-far, DQuat::IDENTITY, 1.0).expect("finite numbers");
    assert!(scene.place(&back).is_empty());
    assert_eq!(scene.origin(), DVec3::ZERO);
    assert!(scene.set_origin(DVec3::NAN).is_err());
}
