//! Clips in JSON.

use super::*;
use crate::Random;
use crate::clip::placed::tests::shapes;
use glam::DVec3;

#[test]
fn clips_round_trip() {
    let texts = [
        "all(box:0,0,0,1,2,3, !sphere:1,0,0,0.5, not(any(cone:0,0,0,1,1,1,2, plane:0,0.6,0.8,0.3)))",
        "any(capsule:0,0,0,0,1,0,0.1, !cylinder:0,0,0,0,1,0,0.1, slab:1,0,0,0.25,0.5)",
        "ellipsoid:0,0,0,1,2,3,0.5,0.5,0.5,0.5",
        "!box:1,2,3,1,1,1,0,1,0,0",
        "all(polygon:z=-1..2.5;0,0;2,0;2,1|1.5,0.25;1.75,0.25;1.75,0.5, !polygon:x;0,0;1,0;1,1, sphere:0,0,0,1)",
    ];
    let clips: Vec<NamedClip> = texts
        .iter()
        .map(|text| NamedClip {
            name: format!("clip \"{}\"", text.len()),
            clip: text.parse().unwrap(),
            layer: (text.len() % 2 == 0).then(|| format!("layer {text}")),
        })
        .chain([NamedClip {
            name: "shielded".into(),
            clip: Expression::All(Vec::new()),
            layer: Some("skin".into()),
        }])
        .collect();
    assert!(
        clips
            .last()
            .is_some_and(|last| last.clip.clip().is_everything())
    );
    let json = clips_to_json(&clips);
    let again = clips_from_json(json.as_bytes(), Path::new("clips.json")).unwrap();
    assert_eq!(again, clips);
}

#[test]
fn shapes_of_every_kind_round_trip() {
    let mut random = Random::new(12);
    let shapes = [(); 20].map(|()| shapes(&mut random)).concat();
    let clips = shapes.into_iter().map(|shape| NamedClip {
        name: shape.solid().name().into(),
        clip: Expression::Shape(shape),
        layer: None,
    });
    let clips: Vec<NamedClip> = clips.collect();
    let json = clips_to_json(&clips);
    let again = clips_from_json(json.as_bytes(), Path::new("clips.json")).unwrap();
    for (clip, again) in clips.iter().zip(&again) {
        assert_eq!(again, clip);
        assert_eq!(
            clip.clip.to_string().parse::<Expression>().unwrap(),
            clip.clip
        );
    }
}

#[test]
fn planes_are_normalised_and_named_or_numbered() {
    let json = "\u{feff} [{\"name\": \"axial\", \"normal\": [0, 0, 2], \"d\": -5, \"note\": null},
                 {\"d\": 1e-3, \"normal\": [-1.0, 0, 0]}]";
    let clips = clips_from_json(json.as_bytes(), Path::new("planes.json")).unwrap();
    let names: Vec<_> = clips.iter().map(|clip| clip.name.as_str()).collect();
    assert_eq!(names, ["axial", "1"]);
    let planes: Vec<_> = clips
        .iter()
        .filter_map(|named| named.clip.as_plane())
        .collect();
    assert_eq!(planes[0], Plane::new(DVec3::Z, -2.5).unwrap());
    assert_eq!(planes[1], Plane::new(-DVec3::X, 1e-3).unwrap());
    let tree = "[{\"clip\": {\"not\": {\"plane\": {\"normal\": [0, 0, 1], \"d\": 2}}}}]";
    let clips = clips_from_json(tree.as_bytes(), Path::new("planes.json")).unwrap();
    let other = clips[0].clip.as_plane().unwrap();
    assert_eq!(other, Plane::new(-DVec3::Z, -2.0).unwrap());
}

#[test]
fn nonsense_is_refused_with_its_place() {
    let deep = format!(
        "[{{\"clip\": {}1{}}}]",
        "{\"not\":".repeat(200),
        "}".repeat(200)
    );
    for (json, words) in [
        ("", "line 1"),
        ("{}", "line 1"),
        ("[]", "there is no clip in it"),
        ("[{}]", "element 0"),
        ("[{\"normal\": [1, 0, 0]}]", "\"d\""),
        ("[\n{\"normal\": [1, 0], \"d\": 0}]", "line 2"),
        ("[{\"normal\": [1, 0, 0], \"d\": 1e999}]", "line 1"),
        (
            "[{\"normal\": [1, 0, 0], \"d\": 0}, {\"normal\": [0, 0, 0], \"d\": 0}]",
            "element 1: ",
        ),
        ("[{\"normal\": [1e-300, 0, 0], \"d\": 1e300}]", "overflows"),
        ("[{\"clip\": {\"all\": []}}]", "no operand"),
        ("[{\"clip\": {\"globe\": {}}}]", "globe"),
        (
            "[{\"clip\": {\"sphere\": {\"centre\": [0,0,0], \"radius\": 0}}}]",
            "element 0: ",
        ),
        (
            "[{\"clip\": {\"sphere\": {\"centre\": [0,0,0], \"size\": 1}}}]",
            "size",
        ),
        (&deep, "line 1"),
    ] {
        let message = clips_from_json(json.as_bytes(), Path::new("clips.json"));
        let message = message.unwrap_err().to_string();
        assert!(
            message.starts_with("clips.json: ") && message.contains(words),
            "{message}"
        );
    }
}
