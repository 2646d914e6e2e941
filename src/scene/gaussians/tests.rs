//! Arrays that fit and arrays that do not.

use super::*;

fn arrays() -> GaussianArrays {
    GaussianArrays {
        origin: DVec3::new(5e6, 0.0, -1.0),
        positions: vec![Vec3::ZERO, Vec3::X],
        scales: vec![Vec3::ONE, Vec3::ZERO],
        rotations: vec![Quat::IDENTITY, Quat::from_rotation_x(1.0)],
        opacities: vec![0.0, 1.0],
        sh_degree: 1,
        sh: vec![-0.5; 24],
        training: Training::default().antialiased(true).low_pass(0.1),
    }
}

#[test]
fn arrays_that_fit_are_taken_and_given_back() {
    let made = Gaussians::new(arrays()).expect("they fit");
    assert_eq!((made.len(), made.sh_coefficients()), (2, 4));
    assert_eq!(made.into_arrays(), arrays());
    let none = Gaussians::new(GaussianArrays::default()).expect("nothing fits nothing");
    assert!(none.is_empty());
}

#[test]
fn the_array_that_does_not_fit_is_named() {
    type Spoil = fn(&mut GaussianArrays);
    let cases: [(&str, Spoil); 15] = [
        ("scales has 1 element,", |a| a.scales.truncate(1)),
        ("rotations has 3", |a| a.rotations.push(Quat::IDENTITY)),
        ("opacities has 0", |a| a.opacities.clear()),
        (
            "sh has 23 elements, which do not fit 2 positions, each 12",
            |a| a.sh.truncate(23),
        ),
        ("scales has 2 elements, which do not fit 3", |a| {
            a.positions.push(Vec3::Y)
        }),
        ("sh has 24", |a| a.sh_degree = 3),
        ("sh_degree is 4", |a| a.sh_degree = 4),
        ("sh_degree is 4294967295", |a| a.sh_degree = u32::MAX),
        ("positions[1]", |a| a.positions[1].z = f32::NAN),
        ("scales[0]", |a| a.scales[0].y = -1e-9),
        ("scales[1]", |a| a.scales[1].y = f32::INFINITY),
        ("rotations[1]", |a| {
            a.rotations[1] = Quat::from_xyzw(1.0, 1.0, 0.0, 0.0)
        }),
        ("opacities[0]", |a| a.opacities[0] = 1.1),
        ("opacities[1]", |a| a.opacities[1] = f32::NAN),
        ("sh[7]", |a| a.sh[7] = f32::NEG_INFINITY),
    ];
    for (says, spoil) in cases {
        let mut spoilt = arrays();
        spoil(&mut spoilt);
        let error = Gaussians::new(spoilt).expect_err(says).to_string();
        assert!(error.starts_with(says), "{error}, not {says}");
    }
}

#[test]
fn pushing_and_truncating_keep_the_arrays_in_step() {
    let mut made = Gaussians::new(arrays()).expect("they fit");
    made.push(Vec3::Y, Vec3::ONE, Quat::IDENTITY, 0.5, &[1.0; 12]);
    assert_eq!((made.len(), made.sh_of(2)), (3, &[1.0; 12][..]));
    made.truncate(9);
    assert_eq!(made.len(), 3);
    made.truncate(2);
    assert_eq!(made.into_arrays(), arrays());
}

#[test]
fn the_first_gaussians_say_whether_a_set_is_antialiased() {
    let antialiased = Gaussians::new(arrays()).expect("they fit");
    let mut plain = antialiased.clone();
    plain.set_antialiased(false);
    for (first, second) in [(&antialiased, &plain), (&plain, &antialiased)] {
        let mut set = Gaussians::default();
        set.append(first);
        set.append(second);
        assert_eq!(set.is_antialiased(), first.is_antialiased());
    }
}

#[test]
#[should_panic(expected = "3 numbers cannot be spherical harmonics of degree 1")]
fn harmonics_of_another_degree_are_misuse() {
    let mut made = Gaussians::new(arrays()).expect("they fit");
    made.push(Vec3::Y, Vec3::ONE, Quat::IDENTITY, 0.5, &[1.0; 3]);
}

#[test]
fn a_tint_goes_from_nothing_to_one_colour_from_all_sides() {
    let mut made = Gaussians::new(arrays()).expect("they fit");
    made.tint([1.0, 0.25, 0.0], 0.0);
    assert_eq!(made.sh_of(1), &[-0.5; 12]);
    made.tint([1.0, 0.25, 0.0], 0.5);
    assert_eq!(made.sh_of(1)[3..], [-0.25; 9]);
    made.tint([1.0, 0.25, 0.0], 1.0);
    let constant = |of: f64| ((of - 0.5) / SH_0) as f32;
    assert_eq!(made.sh_of(0)[..3], [1.0, 0.25, 0.0].map(constant));
    assert_eq!(made.sh_of(0)[3..], [0.0; 9]);
}
