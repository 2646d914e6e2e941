use super::*;
use rara::glam::{DQuat, DVec3};
use rara::{LayerState, Shape};

fn camera(eye: DVec3) -> Camera {
    Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, (64, 64)).unwrap()
}

fn clip(texts: &[&str], op: ClipOp) -> Clip {
    let shapes = texts.iter().map(|text| text.parse::<Shape>().unwrap());
    Clip::joined(shapes.map(|shape| shape.clip()), op)
}

#[test]
fn faces_are_those_that_the_camera_is_before() {
    let normals = |clip: &Clip, eye| {
        let faces = faces(clip, &camera(eye)).unwrap();
        let mut normals: Vec<_> = faces.iter().map(|face| face.plane.normal()).collect();
        normals.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
        for Face { plane, rest } in faces {
            assert!(!rest.surfaces.iter().any(|s| s.as_plane() == Some(plane)));
            assert_eq!(rest.surfaces.len() + 1, clip.surfaces.len());
        }
        normals
    };
    let cube = Shape::cuboid(DVec3::ZERO, DVec3::ONE, DQuat::IDENTITY).unwrap();
    let corner = normals(&cube.clip(), DVec3::new(-4.0, 3.0, -5.0));
    assert_eq!(corner, [DVec3::NEG_Y, DVec3::Z, DVec3::X]);
    assert_eq!(normals(&cube.clip(), DVec3::NEG_X * 9.0), [DVec3::X]);
    assert!(normals(&cube.clip(), DVec3::X * 0.5).is_empty(), "within");
    let slab = clip(&["slab:0,0,1,0,1"], ClipOp::And);
    assert_eq!(normals(&slab, DVec3::NEG_Z * 9.0), [DVec3::Z]);
    assert!(normals(&Clip::default(), DVec3::Z).is_empty());
    // Without perspective the direction counts, wherever the eye is.
    let flat = camera(DVec3::X * 0.5).projection(Projection::Orthographic);
    let seen = faces(&cube.clip(), &flat).unwrap();
    assert_eq!(seen.len(), 1);
    assert_eq!(seen[0].plane.normal(), DVec3::NEG_X);
}

#[test]
fn only_planes_that_cut_together_have_faces() {
    let eye = camera(DVec3::NEG_Z * 9.0);
    for (texts, op, has_faces) in [
        (&["plane:0,0,1,0"][..], ClipOp::Or, true),
        (&["plane:0,0,1,0", "plane:1,0,0,0"], ClipOp::And, true),
        (&["plane:0,0,1,0", "plane:1,0,0,0"], ClipOp::Or, false),
        (&["!box:0,0,0,1,1,1"], ClipOp::And, false),
        (&["plane:0,0,1,0", "sphere:0,0,0,1"], ClipOp::And, false),
    ] {
        assert_eq!(
            faces(&clip(texts, op), &eye).is_some(),
            has_faces,
            "{texts:?}"
        );
    }
}

#[test]
fn layers_with_clips_of_their_own_have_no_faces_of_the_frame() {
    let none = Gaussians::default();
    let scene: Scene<'_> = [
        Layer::new("a", &none),
        Layer::new("b", &none).clipped(Clip::default()),
        Layer::new("c", &none).with(LayerState::default().visible(false)),
    ]
    .into_iter()
    .collect();
    let cut = cut_by_frame(&scene);
    let visible: Vec<_> = cut
        .layers()
        .iter()
        .map(|layer| layer.state().visible)
        .collect();
    assert_eq!(visible, [true, false, false]);
}
