use super::*;
use crate::Random;
use crate::clip::parameter::Role;
use crate::clip::solid::KINDS;
use glam::DQuat;

fn direction(random: &mut Random) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| random.range(-1.0, 1.0))).normalize()
}

/// One of each kind, within a few units of the origin, kept inside or outside.
pub(in crate::clip) fn shapes(random: &mut Random) -> Vec<Shape> {
    let size = |random: &mut Random| random.range(0.3, 1.5);
    let mut shapes = Vec::new();
    for kind in KINDS {
        let mut far = 0.0;
        let values = kind.parameters.iter().map(|(.., role)| {
            let towards = direction(random);
            Ok(match role {
                Role::Plane => Parameter::Plane(Plane::new(towards, random.range(-1.0, 1.0))?),
                Role::Point => {
                    far += 1.0;
                    Parameter::Point(far * towards)
                }
                Role::Sizes => Parameter::Sizes(DVec3::from_array([(); 3].map(|()| size(random)))),
                Role::Size => Parameter::Size(size(random)),
                Role::Rotation => {
                    let angle = random.range(0.0, 6.0);
                    Parameter::Rotation(DQuat::from_axis_angle(towards, angle))
                }
            })
        });
        let shape = Shape::new(kind.with(values).unwrap()).unwrap();
        shapes.push(match random.unit() < 0.5 {
            true => shape,
            false => shape.complement(),
        });
    }
    shapes
}

#[test]
fn a_placed_shape_keeps_the_placed_points() {
    let mut random = Random::new(11);
    for _ in 0..40 {
        let turn = DQuat::from_axis_angle(direction(&mut random), random.range(0.0, 6.0));
        let at = 3.0 * direction(&mut random);
        let placement = Placement::new(at, turn, random.range(0.2, 4.0)).unwrap();
        for shape in shapes(&mut random) {
            let (before, after) = (shape.clip(), shape.placed(&placement).unwrap().clip());
            for _ in 0..50 {
                let point = 3.0 * random.unit() * direction(&mut random);
                let surfaces = before.all_surfaces();
                // On a surface rounding decides.
                if surfaces.iter().all(|s| s.distance(point).abs() > 1e-9) {
                    let placed = placement.to_world(point);
                    assert_eq!(before.keeps(point), after.keeps(placed), "{shape}");
                }
            }
        }
    }
}

#[test]
fn what_overflows_or_shrinks_to_nothing_is_refused() {
    let placed = |text: &str, position: DVec3, scale: f64| {
        let shape: Shape = text.parse().unwrap();
        shape.placed(&Placement::new(position, DQuat::IDENTITY, scale).unwrap())
    };
    assert!(placed("sphere:0,0,0,1", DVec3::ZERO, 1e-200).is_ok());
    assert!(placed("sphere:0,0,0,1e-200", DVec3::ZERO, 1e-200).is_err());
    assert!(placed("box:1e300,0,0,1,1,1", DVec3::ZERO, 1e300).is_err());
    assert!(placed("slab:0,0,1,-1e300,1", DVec3::ZERO, 1e300).is_err());
}

#[test]
fn a_middle_is_in_the_middle() {
    let near = DVec3::new(1.0, 2.0, 3.0);
    for (text, middle) in [
        ("plane:0,0,1,-1", [1.0, 2.0, 1.0]),
        ("!slab:0,0,1,-1,2", [1.0, 2.0, 2.0]),
        ("box:5,6,7,1,1,1", [5.0, 6.0, 7.0]),
        ("cone:0,0,0,0,0,4,1", [0.0, 0.0, 2.0]),
    ] {
        let shape: Shape = text.parse().unwrap();
        assert_eq!(shape.middle(near), DVec3::from(middle), "{text}");
    }
}
