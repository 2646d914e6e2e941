use super::*;
use crate::Random;

fn random_point(random: &mut Random) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| 6.0 * random.unit() - 3.0))
}

/// True when a point is in a solid, from distances alone.
fn holds(text: &str, x: DVec3) -> bool {
    let (a, b) = (DVec3::new(-1.0, 0.0, 0.5), DVec3::new(1.0, 1.0, 0.5));
    let along = (b - a).normalize();
    let at = (x - a).dot(along);
    let aside = (x - a - at * along).length();
    let length = a.distance(b);
    match text.split(':').next().unwrap() {
        "plane" => x.z >= 0.5,
        "slab" => x.z >= 0.5 && x.z <= 1.25,
        "box" => (x - a).abs().cmple(DVec3::new(1.0, 2.0, 0.5)).all(),
        "sphere" => x.distance(a) <= 1.5,
        "ellipsoid" => ((x - a) / DVec3::new(1.0, 2.0, 0.5)).length() <= 1.0,
        "cylinder" => aside <= 0.75 && (0.0..=length).contains(&at),
        "capsule" => (x - a - at.clamp(0.0, length) * along).length() <= 0.75,
        "cone" => (0.0..=length).contains(&at) && aside <= 0.75 * at / length,
        other => panic!("{other}"),
    }
}

#[test]
fn shapes_keep_what_their_solids_hold() {
    let mut random = Random::new(5);
    for text in [
        "plane:0,0,2,-1",
        "slab:0,0,2,-1,0.75",
        "box:-1,0,0.5,1,2,0.5",
        "sphere:-1,0,0.5,1.5",
        "ellipsoid:-1,0,0.5,1,2,0.5",
        "cylinder:-1,0,0.5,1,1,0.5,0.75",
        "capsule:-1,0,0.5,1,1,0.5,0.75",
        "cone:-1,0,0.5,1,1,0.5,0.75",
    ] {
        let shape: Shape = text.parse().unwrap();
        assert_eq!(shape.to_string().parse::<Shape>().unwrap(), shape, "{text}");
        let (inside, outside) = (shape.clip(), shape.complement().clip());
        let mut held = 0;
        for _ in 0..2_000 {
            let point = random_point(&mut random);
            let is_held = holds(text, point);
            held += u32::from(is_held);
            assert_eq!(inside.keeps(point), is_held, "{text} at {point}");
            assert_eq!(outside.keeps(point), !is_held, "!{text} at {point}");
        }
        assert!((2..1_500).contains(&held), "{text}: {held}");
    }
}
