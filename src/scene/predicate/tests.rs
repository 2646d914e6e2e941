use super::*;
use glam::{DQuat, DVec3, Quat, Vec3};

/// Three Gaussians along x, ever larger, less opaque and redder.
fn three() -> Gaussians {
    let mut made = Gaussians::default();
    for (i, opacity) in [0.9, 0.1, 0.5].into_iter().enumerate() {
        let (x, red) = (i as f32, (i as f64 / 4.0 - 0.5) / SH_0);
        let scale = Vec3::new(0.1, 0.01, 0.05) * (1.0 + x);
        made.push(
            Vec3::X * x,
            scale,
            Quat::IDENTITY,
            opacity,
            &[red as f32, 0.0, 0.0],
        );
    }
    made
}

fn taken(text: &str) -> Vec<bool> {
    let labels = Property::new("label", vec![3.0, 4.0, 16_777_217.0]);
    let mut shares = Property::new("share", [0.1_f32, f32::NAN, 0.3].map(f64::from).to_vec());
    shares.single = true;
    let predicate: Predicate = text
        .parse()
        .unwrap_or_else(|error| panic!("{text}: {error}"));
    let again: Predicate = predicate.to_string().parse().unwrap();
    assert_eq!(again, predicate, "{text}");
    predicate
        .select(&three(), &[labels, shares], &Placement::IDENTITY)
        .unwrap()
}

#[test]
fn predicates_take_what_their_text_says() {
    for (text, expected) in [
        ("opacity>0.1", [1, 0, 1]),
        ("opacity>=0.1", [1, 1, 1]),
        ("opacity = .1", [0, 1, 0]),
        ("opacity!=0.1", [1, 0, 1]),
        ("size<0.2", [1, 0, 0]),
        ("size<=0.2", [1, 1, 0]),
        ("cluster_size<2", [1, 0, 0]),
        ("cluster_size=2", [0, 1, 1]),
        ("red in 0.2..0.3, 0.5", [0, 1, 1]),
        ("green=0.5 and blue=0.5", [1, 1, 1]),
        ("label in 3,4", [1, 1, 0]),
        ("label in 4..16777216", [0, 1, 0]),
        ("label=16777217", [0, 0, 1]),
        ("property(label)=3 or property(label)=4", [1, 1, 0]),
        ("share=0.1", [1, 0, 0]),
        ("share!=0.1", [0, 0, 1]),
        ("not share!=0.1", [1, 1, 0]),
        ("inside(sphere:0,0,0,1)", [1, 1, 0]),
        (
            "inside(not(any(sphere:0,0,0,.5, plane:1,0,0,-1.5)))",
            [0, 1, 0],
        ),
        ("not opacity<0.2 and label=4 or size>0.25", [0, 0, 1]),
        (
            "not (opacity<0.2 or size>0.25) and label in -1..1e9",
            [1, 0, 0],
        ),
        ("opacity<0.2 or opacity>0.8 and size>1", [0, 1, 0]),
    ] {
        assert_eq!(taken(text), expected.map(|bit| bit == 1), "{text}");
    }
}

#[test]
fn regions_and_sizes_are_the_scenes() {
    let placement = Placement::new(DVec3::X * 10.0, DQuat::IDENTITY, 2.0).unwrap();
    for (text, expected) in [
        ("inside(slab:1,0,0,-11,2)", [false, true, false]),
        ("size>0.5", [false, false, true]),
    ] {
        let predicate: Predicate = text.parse().unwrap();
        assert_eq!(
            predicate.select(&three(), &[], &placement).unwrap(),
            expected,
            "{text}"
        );
    }
}

#[test]
fn properties_are_named_once_and_missed() {
    let predicate: Predicate = "label=3 and (share>0 or not label in 4)".parse().unwrap();
    assert_eq!(predicate.properties(), ["label", "share"]);
    let error = predicate.split(three(), &[Property::new("share", vec![0.0; 3])]);
    let text = error.unwrap_err().to_string();
    assert!(text.contains("`label` was not loaded"), "{text}");
    let error = predicate.split(three(), &[Property::new("label", vec![0.0; 2])]);
    let text = error.unwrap_err().to_string();
    assert!(text.contains("2 values for 3 Gaussians"), "{text}");
}
