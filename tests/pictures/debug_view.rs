//! The debug view: class and weight of the splats as colours, as the reference shows them.

use crate::common;
use rara::scene::{Kind, generate};
use rara::{ClipOp, Mode, Raster, Settings, Show};

#[test]
fn classes_and_weights_are_shown_as_the_reference_does() {
    let mut headless = common::headless();
    let scene = generate(Kind::General, 2_000, 3);
    let camera = common::views(&scene, 3, common::scaled((200, 150)))[1];
    headless.load(&scene).expect("uploads");
    let mesh = headless.device().support().mesh_shader;
    for (mode, planes) in [
        (Mode::Exact, 1),
        (Mode::Exact, 2),
        (Mode::Rara, 1),
        (Mode::None, 0),
    ] {
        let clip = common::clip(&scene, planes, ClipOp::And);
        let mut rasters = vec![Raster::Tiles, Raster::Quad];
        rasters.extend(mesh.then_some(Raster::Mesh));
        for raster in rasters {
            let settings = Settings::default()
                .mode(mode)
                .raster(raster)
                .show(Show::Weight);
            common::check(&mut headless, "weights", &scene, &camera, &clip, &settings);
        }
    }
}

/// The view changes between frames while camera and clip stand still: one view takes over nothing from the other.
#[test]
fn colours_and_weights_take_turns() {
    let mut headless = common::headless();
    let scene = generate(Kind::General, 2_000, 3);
    let camera = common::views(&scene, 3, (160, 120))[1];
    let clip = common::clip(&scene, 1, ClipOp::And);
    headless.load(&scene).expect("uploads");
    for show in [Show::Colour, Show::Weight, Show::Colour, Show::Weight] {
        let settings = Settings::default().show(show);
        headless.render(&camera, &clip, &settings).expect("renders");
        let picture = headless.picture().expect("reads back");
        let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &settings).picture;
        common::assert_agrees(&format!("{show:?}"), &picture, &truth);
    }
}
