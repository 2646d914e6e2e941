//! Stage `compact`: the splats' lists, from the classes that the stages before have found.

use rara::types::NOT_CUT;
use rara::{ClipOp, Mode, Raster, Settings};
use rara_base::limits::SPLAT_GROUP_SIZE;
use rara_reference::{Side, compact};

use crate::stages::classify;
use crate::stages::frame;

#[test]
fn splats_are_in_the_scenes_order() {
    frame::for_each_scene(|stages, scene| {
        for (view, mode, op) in [
            (0, Mode::None, ClipOp::And),
            (0, Mode::Exact, ClipOp::And),
            (1, Mode::Exact, ClipOp::Or),
            (1, Mode::Hard, ClipOp::And),
        ] {
            let settings = Settings::default().mode(mode).raster(Raster::Quad);
            let planes = frame::clip(scene, 2, op);
            let stats = stages.draw(&frame::views(scene)[view], &planes, &settings);
            if scene.is_empty() {
                assert_eq!(stats.counts, rara::Counts::default());
                continue;
            }
            let sides = classify::sides(stages);
            let sides = sides.iter().map(|side| side.unwrap_or(Side::Culled));
            let sides: Vec<_> = sides.collect();
            let kept = compact::compact(&sides);
            let splat_gaussians = stages.splat_gaussians();
            let ours = splat_gaussians.iter().map(|&[index, _]| index);
            assert!(
                ours.eq(kept.iter().copied()),
                "{}, {settings:?}",
                scene.len()
            );
            // The cut ones are numbered in the same order.
            let mut cut = Vec::new();
            for &[index, number] in &splat_gaussians {
                if sides[index as usize] == Side::Cutoff {
                    assert_eq!(number as usize, cut.len());
                    cut.push(index);
                } else {
                    assert_eq!(number, NOT_CUT);
                }
            }
            let cutoffs: Vec<u32> = stages.read("cutoffs");
            assert_eq!(cutoffs[..cut.len()], cut);
            let counts = stages.counts();
            let of = |side| sides.iter().filter(|&&one| one == side).count() as u32;
            assert_eq!(counts.visible, of(Side::Visible));
            assert_eq!(counts.cutoff, of(Side::Cutoff));
            let all = counts.visible + counts.cutoff + counts.invisible + counts.culled;
            assert_eq!(all as usize, scene.len());
            for (groups, count) in [
                (counts.project_groups, kept.len()),
                (counts.cutoff_groups, cut.len()),
            ] {
                let [x, y, z, w] = groups.map(u64::from);
                assert_eq!((w, z), (count as u64, 1));
                let size = u64::from(SPLAT_GROUP_SIZE);
                assert!(x * y * size >= w && (w == 0 || (x * y - 1) * size < w));
            }
            assert_eq!(counts.draw, [4, kept.len() as u32, 0, 0]);
        }
    });
}
