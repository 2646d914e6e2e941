use glam::{Quat, Vec3};

use super::*;
use crate::SortBy;

#[test]
fn the_last_comment_that_says_a_kind_counts() {
    let kind = |lines: &[&str]| {
        TrainerKind::from_comments(&lines.iter().map(|l| l.to_string()).collect::<Vec<_>>())
    };
    for (lines, expected) in [
        (
            &["comment SplatRenderMode: mip"][..],
            Some(TrainerKind::Antialiased),
        ),
        (
            &["comment  splatrendermode:  MIP "],
            Some(TrainerKind::Antialiased),
        ),
        (&["comment SplatRenderMode: 2dgs"], Some(TrainerKind::Discs)),
        (&["comment SplatRenderMode: new"], None),
        (&["comment antialiased 1"], Some(TrainerKind::Antialiased)),
        (
            &["comment antialiased 1", "comment SplatRenderMode: default"],
            Some(TrainerKind::Plain),
        ),
        (
            &["comment antialiased 0", "comment SplatRenderMode: mip"],
            Some(TrainerKind::Antialiased),
        ),
        (
            &["property float antialiased 1", "comment SH degree: 3"],
            None,
        ),
        (&[], None),
    ] {
        assert_eq!(kind(lines), expected, "{lines:?}");
    }
}

#[test]
fn the_low_pass_is_what_a_mark_says_or_that_of_who_wrote_the_file() {
    let found = |lines: &[&str]| training(&lines.iter().map(|l| l.to_string()).collect::<Vec<_>>());
    let (brush, mip) = (
        "comment Exported from Brush",
        "comment SplatRenderMode: mip",
    );
    for (lines, expected) in [
        (&[brush, mip][..], 0.1),
        (&[mip, "obj_info made by brush-app 0.3"], 0.1),
        (&[brush, "comment SplatRenderMode: default"], 0.3),
        (&[brush], 0.3),
        (&[mip], 0.3),
        (&[mip, "comment a brushed scene"], 0.3),
        (&[brush, mip, "comment lowPass: 0.25"], 0.25),
        (&["comment LOWPASS : 0.2"], 0.2),
    ] {
        let (found, unusable) = found(lines);
        assert_eq!((found.low_pass, unusable), (expected, vec![]), "{lines:?}");
    }
    let (kept, unusable) = found(&["comment lowPass: much", "comment sortBy: distance"]);
    assert_eq!(kept, Training::default().sort_by(SortBy::Distance));
    assert!(unusable[0].contains("much"), "{unusable:?}");
}

#[test]
fn smoothing_widens_and_keeps_the_mass() {
    let mut set = Gaussians::default();
    for scale in [Vec3::new(0.3, 0.4, 0.0), Vec3::ZERO, Vec3::ONE] {
        set.push(Vec3::ZERO, scale, Quat::IDENTITY, 0.8, &[0.0; 3]);
    }
    let unusable = smooth(&mut set, &[0.4, 0.0, f64::NAN]);
    assert_eq!(unusable, 1);
    assert!((set.scales()[0] - Vec3::new(0.5, 0.4 * 2.0_f32.sqrt(), 0.4)).length() < 1e-6);
    assert_eq!(set.opacities()[0], 0.0, "a disc has no mass");
    assert_eq!((set.scales()[1], set.opacities()[1]), (Vec3::ZERO, 0.8));
    assert_eq!((set.scales()[2], set.opacities()[2]), (Vec3::ONE, 0.8));
    let mut round = Gaussians::default();
    round.push(Vec3::ZERO, Vec3::splat(0.3), Quat::IDENTITY, 0.5, &[0.0; 3]);
    smooth(&mut round, &[0.4]);
    assert!((round.opacities()[0] - 0.5 * 0.6_f32.powi(3)).abs() < 1e-6);
}
