use super::*;

const KINDS: [Kind; 3] = [Kind::General, Kind::Strands, Kind::Layers];

#[test]
fn the_count_is_exact_and_everything_is_sound() {
    for kind in KINDS {
        for count in [0, 1, 2, 5, 23, 25, 1000] {
            let scene = generate(kind, count, 7);
            assert_eq!(scene.len(), count, "{kind:?}");
            assert_eq!(scene.sh().len(), 3 * count * scene.sh_coefficients());
            assert!(scene.positions().iter().all(|p| p.length() < 1.1));
            assert!(
                scene
                    .scales()
                    .iter()
                    .all(|s| s.is_finite() && s.min_element() > 0.0)
            );
            assert!(
                scene
                    .rotations()
                    .iter()
                    .all(|q| (q.length() - 1.0).abs() < 1e-5)
            );
            assert!(scene.opacities().iter().all(|o| *o > 0.0 && *o <= 1.0));
            assert!(scene.sh().iter().all(|v| v.is_finite() && v.abs() < 3.0));
        }
    }
}

#[test]
fn the_seed_decides() {
    for kind in KINDS {
        assert_eq!(generate(kind, 500, 1), generate(kind, 500, 1));
        assert_ne!(
            generate(kind, 500, 1).positions(),
            generate(kind, 500, 2).positions()
        );
    }
}

#[test]
fn hair_is_made_of_thin_needles() {
    let hair = generate(Kind::Strands, 2400, 3);
    // A pixel at 1024^2, 60 degrees, distance 2.6.
    let pixel = 2.0 * 2.6 * 30_f32.to_radians().tan() / 1024.0;
    for scale in hair.scales() {
        assert!((scale.max_element() / scale.min_element() - 20.0).abs() < 0.1);
        assert!(scale.min_element() < pixel);
    }
}

#[test]
fn splats_shrink_with_their_number() {
    let median = |kind, count| {
        let mut sizes: Vec<_> = generate(kind, count, 1)
            .scales()
            .iter()
            .map(|s| s.max_element())
            .collect();
        sizes.sort_by(f32::total_cmp);
        sizes[count / 2]
    };
    let surfaces = median(Kind::General, 1000) / median(Kind::General, 100_000);
    assert!((7.0..14.0).contains(&surfaces), "{surfaces}");
    let volumes = median(Kind::Layers, 1000) / median(Kind::Layers, 64_000);
    assert!((3.0..5.0).contains(&volumes), "{volumes}");
}

#[test]
fn splitting_loses_none() {
    assert_eq!(split(10, [1.0, 1.0]), [5, 5]);
    assert_eq!(split(7, [0.1, 0.0, 3.0, 0.1]).iter().sum::<usize>(), 7);
    assert_eq!(split(0, [1.0, 2.0]), [0, 0]);
}
