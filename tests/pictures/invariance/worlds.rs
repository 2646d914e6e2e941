//! The place of the world and the size of its unit.

use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;
use rara::clip::Expression;
use rara::{BakeSettings, Clip, ClipOp, Gaussians, Mode, Plane, Settings, bake};
use rara_lab::measure::differences;

use super::{check, directions, draw, operations, planes, scenes, views};

/// Everything is turned, then moved, and so are the camera and the planes. Harmonics do not turn: degree 0.
fn moved(scene: &Gaussians, turn: DQuat, step: DVec3) -> Gaussians {
    let mut moved = scene.clone();
    for position in moved.positions_mut() {
        *position = (turn * position.as_dvec3() + step).as_vec3();
    }
    for rotation in moved.rotations_mut() {
        *rotation = (turn * rotation.as_dquat()).as_quat();
    }
    moved
}

/// Positions and quaternions are single-precision numbers before and after: 6e-8 of some 10 units, a few thousandths
/// of a hair's pixel at this focal length of 80. On average nothing changes; at the rim of a splat alpha may pass 1/255
/// and two centres of almost one depth may swap, so that single pixels do.
#[test]
fn a_rigid_motion_of_everything_leaves_the_picture() {
    let motion = (
        (directions(), -3.0..3.0_f64),
        [-5.0..5.0_f64, -5.0..5.0, -5.0..5.0],
    );
    let strategy = (scenes(), views(), planes(1..3), motion);
    check(
        strategy,
        |headless, (mut scene, camera, planes, ((axis, angle), step))| {
            scene.set_sh_degree(0);
            let (turn, step) = (DQuat::from_axis_angle(axis, angle), DVec3::from(step));
            let away = camera
                .eye(turn * camera.eye + step)
                .rotation(camera.rotation * DMat3::from_quat(turn.inverse()));
            let carried = planes.iter().map(|p| {
                let normal = turn * p.normal();
                Plane::new(normal, p.offset() - normal.dot(step)).unwrap()
            });
            let op = ClipOp::And;
            let carried = Clip::of(carried, op);
            for mode in [Mode::Rara, Mode::Exact] {
                let settings = Settings::default().mode(mode);
                headless.load(&scene).expect("uploads");
                let clip = Clip::of(planes.clone(), op);
                let still = draw(headless, &camera, &clip, &settings);
                headless.load(&moved(&scene, turn, step)).expect("uploads");
                let result =
                    differences(&still, &draw(headless, &away, &carried, &settings)).unwrap();
                prop_assert!(
                    result.l1 < 0.02 && result.share_over_2 < 2e-3,
                    "{mode:?}: {result:?}"
                );
            }
            Ok(())
        },
    );
}

/// A camera whose rotation has a mirror in it, as of a left-handed host, sees what another sees, from right to left: in every
/// mode, cut by planes and by what bends, with colours that change with the direction.
#[test]
fn a_mirrored_camera_shows_the_picture_from_right_to_left() {
    let regions = [
        "!sphere:0.2,0.1,0,0.5",
        "any(cylinder:-1,0,0,1,0,0,.3, box:0,0,0,.5,.6,.7)",
    ];
    let strategy = (scenes(), views(), planes(1..4), operations());
    check(strategy, |headless, (scene, camera, planes, op)| {
        let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
        let mirrored = camera
            .rotation(mirror * camera.rotation)
            .cx(f64::from(camera.width) - camera.cx);
        let bent = regions.map(|text| text.parse::<Expression>().expect("a region").clip());
        headless.load(&scene).expect("uploads");
        for clip in [Clip::of(planes, op)].into_iter().chain(bent) {
            for mode in [Mode::Hard, Mode::Rara, Mode::Exact] {
                let settings = Settings::default().mode(mode);
                let plain = draw(headless, &camera, &clip, &settings);
                let mut turned = draw(headless, &mirrored, &clip, &settings);
                for row in turned.pixels.chunks_exact_mut(camera.width as usize) {
                    row.reverse();
                }
                let result = differences(&plain, &turned).unwrap();
                prop_assert!(
                    result.l1 < 0.002 && result.share_over_2 < 2e-4,
                    "{mode:?}: {result:?}"
                );
            }
        }
        Ok(())
    });
}

/// Only the near limit of 0.2 units depends on how large a unit is, and powers of two leave every rounding as it was.
#[test]
fn a_world_of_another_power_of_two_is_the_same_picture_to_the_bit() {
    let strategy = (scenes(), views(), planes(1..3), -1..10_i32);
    check(strategy, |headless, (scene, camera, planes, power)| {
        let factor = 2.0_f64.powi(power);
        let mut scaled = scene.clone();
        for position in scaled.positions_mut() {
            *position *= factor as f32;
        }
        for scale in scaled.scales_mut() {
            *scale *= factor as f32;
        }
        let clip = |factor: f64| {
            Clip::of(
                planes
                    .iter()
                    .map(|p| Plane::new(p.normal(), p.offset() * factor).unwrap()),
                ClipOp::And,
            )
        };
        for mode in [Mode::Rara, Mode::Exact] {
            let settings = Settings::default().mode(mode);
            headless.load(&scene).expect("uploads");
            let expected = draw(headless, &camera, &clip(1.0), &settings);
            headless.load(&scaled).expect("uploads");
            let away = camera.eye(camera.eye * factor);
            let picture = draw(headless, &away, &clip(factor), &settings);
            prop_assert!(
                picture == expected,
                "{mode:?}: {:?}",
                differences(&picture, &expected)
            );
        }
        Ok(())
    });
}

/// What single precision would round to half a unit is drawn as it is about zero. Eyes and planes lie on a grid that double
/// precision holds there, so that nothing but the origin differs.
#[test]
fn an_origin_far_away_leaves_the_picture() {
    let far = DVec3::new(500_000.0, 5_800_000.0, -12_345.0);
    let grid = |value: f64| (value * f64::from(1 << 20)).round() / f64::from(1 << 20);
    check(
        (scenes(), views(), -0.5..0.5_f64),
        |headless, (scene, camera, offset)| {
            let mut away = scene.clone();
            away.set_origin(far).expect("it is finite");
            let near = camera.eye(DVec3::from(camera.eye.to_array().map(grid)));
            let clips = |origin: DVec3| {
                let plane = Plane::new(DVec3::X, grid(offset) - origin.x).expect("a normal");
                Clip::of([plane], ClipOp::And)
            };
            let settings = Settings::default();
            headless.load(&scene).expect("uploads");
            let still = draw(headless, &near, &clips(DVec3::ZERO), &settings);
            let eye = near.eye(near.eye + far);
            headless.load(&away).expect("uploads");
            let found = draw(headless, &eye, &clips(far), &settings);
            prop_assert!(still.pixels == found.pixels);
            let baked = [(&scene, DVec3::ZERO), (&away, far)].map(|(scene, origin)| {
                let baked = bake(scene, &clips(origin), &BakeSettings::default());
                baked.expect("a clip").gaussians
            });
            prop_assert!(baked[0].positions() == baked[1].positions());
            prop_assert!(baked[1].origin() == far);
            Ok(())
        },
    );
}
