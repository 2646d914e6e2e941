use glam::{DVec3, Quat, Vec3};

use super::*;

fn remains(origin: f64, places: &[f32], numbers: Option<FileNumbers>) -> LayerRemains {
    let mut gaussians = Gaussians::default();
    gaussians.set_origin(DVec3::X * origin).expect("finite");
    for &x in places {
        gaussians.push(Vec3::X * x, Vec3::ONE, Quat::IDENTITY, 0.5, &[0.0; 3]);
    }
    LayerRemains {
        numbers,
        count: places.len(),
        gaussians,
        sources: (0..places.len() as u32).collect(),
    }
}

/// Files about different origins are joined about that of the first Gaussians, whether selections have divided them or not.
#[test]
fn files_of_several_origins_are_joined_about_one() {
    let divided = |numbers: &[u32]| Some((0, numbers.to_vec()));
    let nothing = || remains(0.0, &[], None);
    let far = || remains(5e6 + 64.0, &[1.0, -2.0], None);
    for (layers, expected) in [
        (
            vec![nothing(), remains(5e6, &[0.5, 7.0], None), far()],
            &[0.5, 7.0, 65.0, 62.0][..],
        ),
        (
            vec![
                remains(5e6, &[0.5, 7.0], divided(&[0, 2])),
                remains(5e6, &[3.0], divided(&[1])),
                far(),
            ],
            &[0.5, 3.0, 7.0, 65.0, 62.0],
        ),
        (
            vec![
                remains(0.0, &[], divided(&[])),
                remains(5e6, &[3.0], divided(&[0])),
                far(),
                remains(0.0, &[5e6], None),
            ],
            &[3.0, 65.0, 62.0, 0.0],
        ),
    ] {
        let Part { gaussians, numbers } = joined(layers);
        assert_eq!(gaussians.origin(), 5e6 * DVec3::X);
        let found: Vec<f32> = gaussians.positions().iter().map(|at| at.x).collect();
        assert_eq!(found, expected);
        assert!(numbers.iter().copied().eq(0..expected.len() as u32));
    }
}
