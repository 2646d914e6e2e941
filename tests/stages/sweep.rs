//! Stages `reclip` and `recut`: what a moved clip changes while the camera stands still.

use bytemuck::Zeroable;
use rara::types::{CUT_AWAY, NOT_CUT, Quad, Splat};
use rara::{Clip, ClipOp, Mode, Plane, Raster, Settings, Surface};
use rara_reference::{Side, ViewTransform, classify};

use crate::stages::frame::{self, Stages};
use crate::stages::ties;

fn moved(clip: &Clip, by: f64) -> Clip {
    let planes = clip.surfaces.iter().filter_map(Surface::as_plane);
    let moved = |plane: Plane| Plane::new(plane.normal(), plane.offset() + by);
    Clip::of(
        planes.map(|plane| moved(plane).expect("a finite normal")),
        clip.op,
    )
}

/// What the rasteriser holds of the first so many splats, by their numbers in the scene: splats, and quads to draw.
fn held(stages: &mut Stages, count: usize, raster: Raster) -> Vec<(u32, (Splat, Option<Quad>))> {
    let splats = stages.splats_in_view(count);
    let quads: Vec<_> = match raster {
        Raster::Tiles => vec![None; count],
        _ => stages.quads(count).into_iter().map(Some).collect(),
    };
    let numbers = stages.numbers_in_view(count);
    numbers
        .into_iter()
        .zip(splats.into_iter().zip(quads))
        .collect()
}

#[test]
fn a_moved_clip_changes_what_the_twin_says() {
    frame::for_each_scene(|stages, scene| {
        let camera = frame::views(scene)[0];
        let view = ViewTransform::<f32>::new(&camera);
        for (mode, planes, op, raster) in [
            (Mode::Exact, 1, ClipOp::And, Raster::Tiles),
            (Mode::Rara, 2, ClipOp::Or, Raster::Quad),
            (Mode::Hard, 1, ClipOp::And, Raster::Tiles),
        ] {
            let settings = Settings::default().mode(mode).raster(raster);
            let clip = frame::clip(scene, planes, op);
            stages.headless.forget();
            stages.again(&camera, &clip, &settings);
            // The second frame begins the sweep, the third goes on with it.
            for by in [0.1, 0.2, -0.3] {
                let clip = moved(&clip, by);
                let swept = stages.again(&camera, &clip, &settings);
                if scene.is_empty() {
                    continue;
                }
                assert_eq!(swept.skipped.contains(&"project"), by != 0.1, "{by}");
                // All in view survive; the list has those that the clip changes, and their new side.
                let splat_gaussians = stages.gaussians_in_view();
                let recuts: Vec<[u32; 2]> = stages.read("recuts");
                let changed = stages.counts().recut_groups[3] as usize;
                let twin = classify::classify(&stages.scene, &view, &clip, &settings);
                let mut cuts = 0;
                for &[splat_index, cut] in &recuts[..changed] {
                    let index = splat_gaussians[splat_index as usize] as usize;
                    let ours = match cut {
                        NOT_CUT => Side::Visible,
                        CUT_AWAY => Side::Invisible,
                        _ => {
                            assert_eq!(cut, cuts, "in order");
                            cuts += 1;
                            Side::Cutoff
                        }
                    };
                    if ours != twin[index] {
                        let camera = Some(&camera);
                        let possible =
                            ties::classes(&stages.scene, index, camera, &clip, &settings);
                        assert!(possible.contains(&ours), "{index}: {ours:?}, {possible:?}");
                    }
                }
                assert_eq!(cuts, swept.counts.cutoff);
                // The rasteriser then holds for each what a whole frame computes.
                let swept_splats = held(stages, splat_gaussians.len(), raster);
                let mut whole = std::collections::HashMap::new();
                let counts = stages.draw(&camera, &clip, &settings).counts;
                assert_eq!(counts, swept.counts);
                let drawn = stages.splat_gaussians().len();
                whole.extend(held(stages, drawn, raster));
                let mut gone = 0;
                for (number, (mut splat, quad)) in swept_splats {
                    let Some((truth, its_quad)) = whole.get(&number) else {
                        assert_eq!(splat.conic_cut[2], 4e30, "clipped away");
                        assert!(quad.is_none_or(|quad| quad == Zeroable::zeroed()));
                        gone += 1;
                        continue;
                    };
                    if truth.conic_cut[2] < -1e30 {
                        // Each names a record of its own frame.
                        assert!(splat.conic_cut[2] < -1e30);
                        splat.conic_cut[2] = truth.conic_cut[2];
                    }
                    assert!(splat == *truth, "{splat:?}, in a whole frame {truth:?}");
                    assert_eq!(quad, *its_quad);
                }
                assert_eq!(gone, counts.invisible);
                // The next frame of the sweep goes on from this one.
                stages.headless.forget();
                stages.again(&camera, &moved(&clip, 0.05), &settings);
                stages.again(&camera, &clip, &settings);
            }
        }
    });
}
