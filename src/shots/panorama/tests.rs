use super::*;

fn camera() -> Camera {
    let (eye, target) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 0.0, 4.0));
    Camera::look_at(eye, target, DVec3::NEG_Y, 50.0, (8, 8)).unwrap()
}

/// What a face shows where every direction has a colour of its own.
fn painted(face: &Camera, axes: DMat3) -> Picture {
    let mut picture = Picture::filled(face.width, face.height, [0.0; 4]);
    for (index, pixel) in picture.pixels.iter_mut().enumerate() {
        let (x, y) = (index as u32 % face.width, index as u32 / face.width);
        let off = DVec3::new(
            (f64::from(x) + 0.5 - face.cx) / face.fx,
            (f64::from(y) + 0.5 - face.cy) / face.fy,
            1.0,
        );
        let seen = axes * (face.rotation.transpose() * off.normalize());
        *pixel = [seen.x as f32, seen.y as f32, seen.z as f32, 1.0];
    }
    picture
}

#[test]
fn every_direction_is_where_it_belongs_without_a_seam() {
    let panorama = Panorama { width: 128 };
    let camera = levelled(camera(), DVec3::NEG_Y);
    let axes = camera.rotation;
    assert!((axes.row(1) - DVec3::Y).length() < 1e-12 && axes.determinant() > 0.999);
    let faces = panorama.faces(&camera);
    for face in &faces {
        assert!((face.rotation.determinant() - 1.0).abs() < 1e-12);
    }
    let pictures = faces.map(|face| painted(&face, axes));
    let made = panorama.assembled(&pictures);
    let seams = panorama.seams(&pictures);
    assert!(
        seams.largest < 0.5 && seams.mean < seams.largest,
        "{seams:?}"
    );
    // A picture that is another shade has four edges of twelve, whichever it is.
    let all = [0, 1, 2, 3, 4, 5].map(|number: usize| {
        let mut other = pictures.clone();
        other[number]
            .pixels
            .iter_mut()
            .for_each(|pixel| pixel[2] += 0.2);
        panorama.seams(&other)
    });
    for seams in all.into_iter().chain(Seams::together(&all)) {
        assert!(
            (seams.largest - 51.0).abs() < 0.5 && (seams.mean - 17.0).abs() < 0.5,
            "{seams:?}"
        );
    }
    assert_eq!((made.width, made.height), (128, 64));
    for y in 0..64 {
        for x in 0..128 {
            let right = panorama.direction((f64::from(x) + 0.5, f64::from(y) + 0.5));
            let [r, g, b, a] = made.at(x, y).map(f64::from);
            // Bilinear steps and the mean over a pixel shorten what turns.
            assert!((DVec3::new(r, g, b) - right).length() < 2e-3, "{x} {y}");
            assert!((a - 1.0).abs() < 1e-6);
        }
    }
    // The middle is what the camera looks at, but for its tilt.
    let middle = panorama.direction((64.0, 32.0));
    assert!((middle - DVec3::Z).length() < 1e-12);
}

#[test]
fn a_file_s_camera_keeps_its_own_axes_and_sizes_are_two_to_one() {
    let camera = camera();
    let panorama = Panorama { width: 64 };
    let faces = panorama.faces(&camera);
    assert!(
        (faces[0].rotation - camera.rotation)
            .to_cols_array()
            .iter()
            .all(|one| one.abs() < 1e-12)
    );
    assert_eq!(Panorama::face_names()[5], "down");
    let pixels = faces
        .iter()
        .map(|face| u64::from(face.width) * u64::from(face.height));
    assert_eq!(panorama.face_pixels(), pixels.sum::<u64>());
    assert_eq!(Panorama::new((2048, 1024)).unwrap().size(), (2048, 1024));
    for wrong in [(64, 64), (0, 0), (32768, 16384), (63, 31)] {
        assert!(Panorama::new(wrong).is_err(), "{wrong:?}");
    }
}
