//! Pictures that are a part of the host's target.

use super::*;

#[test]
fn a_viewport_anywhere_in_the_target_leaves_the_rest_alone() {
    let scene = scene();
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let target = vk::Extent2D {
        width: 320,
        height: 200,
    };
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    headless.render(&camera, &clip, &settings).expect("renders");
    let truth = headless.picture().expect("reads back");
    for (format, optional) in [(FLOATS, true), (HALVES, true), (BYTES, false)] {
        let desc = in_flight(format, Bindings::Mixed);
        let host = open_host(format, target, optional);
        let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
        for raster in common::rasters(&engine.device) {
            // In a corner, in the middle, and over the target's edge.
            for (x, y) in [(0, 0), (77, 43), (250, 150)] {
                engine.wait();
                engine.configure(&(camera, clip.clone(), settings.raster(raster)));
                engine.record(vk::Offset2D { x, y });
                let pixels = engine.wait_for_all();

                let inside = expected(&engine.host, &truth, x as u32);
                let (x, y) = (x as u32, y as u32);
                let mut ours = Vec::new();
                let mut theirs = Vec::new();
                for (i, pixel) in pixels.iter().enumerate() {
                    let (column, row) = (i as u32 % target.width, i as u32 / target.width);
                    let (left, up) = (column.wrapping_sub(x), row.wrapping_sub(y));
                    if left < VIEW.width && up < VIEW.height {
                        ours.push(*pixel);
                        theirs.push(inside[(up * VIEW.width + left) as usize]);
                    } else {
                        let backdrop = engine.host.backdrop(column);
                        let worst = apart(&[*pixel], &[backdrop]).0;
                        // As exact as truncated halves are, see `assert_shows`.
                        assert!(worst < 0.125, "{column},{row} is the host's: {pixel:?}");
                    }
                }
                let what = format!("{format:?}, {raster:?} at {x},{y}");
                assert_shows(&what, format, &ours, &theirs);
            }
        }
        engine.close();
    }
}
