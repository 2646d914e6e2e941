//! The same cut, given in another way, and the same scene, stored in another way.

use proptest::prelude::*;
use rara::scene::{GaussianArrays, load, save_ply};
use rara::{Clip, ClipOp, Gaussians, Mode, Plane, Settings};

use super::{check, draw, operations, planes, scenes, views};
use crate::common::folder::Folder;

#[test]
fn cutting_twice_is_cutting_once_and_the_order_of_planes_is_nobodys_business() {
    let strategy = (
        scenes(),
        views(),
        planes(1..5),
        operations(),
        any::<prop::sample::Index>(),
    );
    check(strategy, |headless, (scene, camera, planes, op, again)| {
        headless.load(&scene).expect("uploads");
        for mode in [Mode::Hard, Mode::Rara, Mode::Exact] {
            let settings = Settings::default().mode(mode);
            let mut picture =
                |planes: Vec<Plane>| draw(headless, &camera, &Clip::of(planes, op), &settings);
            let expected = picture(planes.clone());
            // A plane given twice is the plane once, and planes are sorted into an order of their own: not a bit may
            // differ.
            let mut doubled = planes.clone();
            doubled.push(planes[again.index(planes.len())]);
            prop_assert!(picture(doubled) == expected, "{mode:?}: twice");
            let reversed = planes.iter().rev().copied().collect();
            prop_assert!(picture(reversed) == expected, "{mode:?}: reversed");
        }
        Ok(())
    });
}

#[test]
fn splitting_a_scene_into_files_gives_the_same_bytes() {
    let folder = Folder::new("invariance-cuts");
    let cuts = [any::<prop::sample::Index>(), any::<prop::sample::Index>()];
    check(
        (scenes(), views(), planes(1..3), cuts),
        |headless, (scene, camera, planes, cuts)| {
            let mut cuts = cuts.map(|cut| cut.index(scene.len() + 1));
            cuts.sort_unstable();
            let stored = |name: &str, from: usize, to: usize| {
                let path = folder.join(name);
                save_ply(&path, &part(&scene, from, to)).expect("saves");
                load(&path, &mut |_, _| ()).expect("loads").gaussians
            };
            let clip = Clip::of(planes, ClipOp::And);
            let mut picture = |scene: &Gaussians| {
                headless.load(scene).expect("uploads");
                draw(headless, &camera, &clip, &Settings::default())
            };
            let whole = picture(&stored("whole.ply", 0, scene.len()));
            let mut merged = stored("part.ply", 0, cuts[0]);
            merged.append(&stored("part.ply", cuts[0], cuts[1]));
            merged.append(&stored("part.ply", cuts[1], scene.len()));
            prop_assert!(picture(&merged) == whole, "cut at {cuts:?}");
            Ok(())
        },
    );
}

fn part(scene: &Gaussians, from: usize, to: usize) -> Gaussians {
    let stride = 3 * scene.sh_coefficients();
    let part = GaussianArrays {
        origin: scene.origin(),
        positions: scene.positions()[from..to].to_vec(),
        scales: scene.scales()[from..to].to_vec(),
        rotations: scene.rotations()[from..to].to_vec(),
        opacities: scene.opacities()[from..to].to_vec(),
        sh_degree: scene.sh_degree(),
        sh: scene.sh()[from * stride..to * stride].to_vec(),
        training: scene.training(),
    };
    Gaussians::new(part).expect("parts of what fits")
}
