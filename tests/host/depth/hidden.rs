//! Splats behind an opaque mesh are hidden, on ordinary and reversed depth, in few bits and many, in every way of drawing.

use super::*;
use crate::canvas::host::Host;
use crate::canvas::with_host;
use rara::gpu::Bindings;

/// Whatever the depth buffer's numbers mean, from a perspective and an orthographic camera, and in either order.
#[test]
fn meshes_hide_the_splats_behind_them_on_ordinary_and_reversed_depth() {
    let linear = |zero, one| DepthMap::orthographic(zero, one).expect("two depths");
    let worlds = [
        (World::new(), maps().to_vec()),
        (World::flat(), vec![linear(-1.0, 30.0), linear(30.0, 0.0)]),
        (World::by_distance(), vec![maps()[1]]),
    ];
    let mut headless = common::headless();
    with_host(true, |host, device| {
        let first = first(device);
        let on = (device, &first);
        for (world, maps) in &worlds {
            let truth = world.truth(&mut headless);
            for map in maps {
                hides(on, host, (world, &truth), *map);
            }
        }
    });
}

/// Checks that every way of drawing leaves out what is behind the meshes.
fn hides(on: On<'_>, host: &Host, (world, truth): (&World, &Picture), map: DepthMap) {
    let (device, _) = on;
    let desc = canvas(world, map, vk::Format::D32_SFLOAT);
    let depth = depth_desc(&desc, map, true);
    let canvas = Canvas::new(&host.lend(), device, desc);
    for (raster, bindings) in common::rasters(device)
        .into_iter()
        .flat_map(|raster| [(raster, Bindings::Bound), (raster, Bindings::Address)])
    {
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(depth))
            .bindings(bindings);
        let (picture, path) = draw(on, &canvas, world, desc, raster);
        let asked = match raster {
            Raster::Tiles => "tiles",
            Raster::Mesh => "mesh",
            _ => "quad",
        };
        assert_eq!(path, asked);
        let worst = apart(&picture, truth, 0.0);
        assert!(
            worst < 1.0,
            "{map:?}, {raster:?}, {bindings:?}: {worst}/255"
        );
    }
}

/// A depth that hides parts of splats cuts them as a far plane of the camera does, to first order of perspective: the affine form
/// of the exact weights. Where a clip cuts them too, the two are taken along the line of sight, which is exact but for the low-pass.
/// What the host has drawn nothing before stays whole.
#[test]
fn a_soft_depth_hides_what_a_far_plane_cuts() {
    let linear = DepthMap::orthographic(-1.0, 30.0).expect("two depths");
    let flat = (World::flat(), linear);
    let mut unclipped = [(World::new(), maps()[0]), (World::flat(), linear)];
    for (world, _) in &mut unclipped {
        world.clip = Clip::default();
    }
    let [perspective, orthographic] = unclipped;
    let worlds = [
        (perspective, 0.1),
        (orthographic, 0.1),
        ((World::new(), maps()[2]), 0.2),
        (flat, 0.2),
    ];
    let mut errors = Vec::new();
    with_host(true, |host, device| {
        let first = first(device);
        for ((mut world, map), most) in worlds {
            world.settings = world.settings.form(rara::ExactForm::Affine);
            let depth = world.meshes[0].1;
            let offset = vk::Offset2D { x: 10, y: 5 };
            let (width, height) = (120, 100);
            let extent = vk::Extent2D { width, height };
            world.meshes = [(vk::Rect2D { offset, extent }, depth); 2];
            let desc = canvas(&world, map, vk::Format::D32_SFLOAT);
            let behind = depth_desc(&desc, map, true);
            let canvas = Canvas::new(&host.lend(), device, desc);
            let render = |camera: &Camera| {
                let (scene, clip, settings) = (&world.scene, &world.clip, &world.settings);
                rara_reference::render::<f64>(scene, camera, clip, settings).picture
            };
            let mut truth = render(&world.camera.clip_far(Some(depth)));
            let whole = render(&world.camera);
            for (at, pixel) in truth.pixels.iter_mut().enumerate() {
                let (x, y) = (at as u32 % VIEW.0, at as u32 / VIEW.0);
                if !(10..10 + width).contains(&x) || !(5..5 + height).contains(&y) {
                    *pixel = whole.pixels[at];
                }
            }
            for bindings in [Bindings::Bound, Bindings::Mixed] {
                let [hard, soft] = [false, true].map(|soft| {
                    let desc = RendererDesc::new(FLOATS).bindings(bindings);
                    let desc = desc.depth(Some(behind.soft(soft)));
                    let (picture, _) = draw((device, &first), &canvas, &world, desc, Raster::Tiles);
                    [0.0, 0.01].map(|share| apart(&picture, &truth, share))
                });
                eprintln!("{map:?}, {bindings:?}: {soft:?}/255, {hard:?} by centres");
                errors.push((soft[1], hard[1], most));
            }
        }
    });
    for (soft, hard, most) in errors {
        assert!(
            soft < most && hard > 10.0,
            "99 %: {soft}, by centres {hard}"
        );
    }
}

/// Depths that a buffer rounds: a splat may lie on a mesh's own step, and then counts as before it in every way of
/// drawing.
#[test]
fn depths_in_few_bits_hide_the_same_splats_in_every_way_of_drawing() {
    let world = World::new();
    with_host(true, |host, device| {
        let first = first(device);
        let on = (device, &first);
        for format in [
            vk::Format::D16_UNORM,
            vk::Format::X8_D24_UNORM_PACK32,
            vk::Format::D24_UNORM_S8_UINT,
            vk::Format::D32_SFLOAT_S8_UINT,
        ] {
            let needed = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT
                | vk::FormatFeatureFlags::TRANSFER_SRC;
            if !device.format_features(format).contains(needed) {
                continue;
            }
            for map in [maps()[0], maps()[2]] {
                let desc = canvas(&world, map, format);
                let depth = depth_desc(&desc, map, true);
                let canvas = Canvas::new(&host.lend(), device, desc);
                let desc = RendererDesc::new(FLOATS)
                    .depth(Some(depth))
                    .bindings(Bindings::Mixed);
                let (quads, _) = draw(on, &canvas, &world, desc, Raster::Quad);
                let (tiles, path) = draw(on, &canvas, &world, desc, Raster::Tiles);
                assert_eq!(path, "tiles");
                let worst = apart(&quads, &tiles, 0.0);
                eprintln!("{format:?}, {map:?}: {worst}/255");
                assert!(worst < 1.0, "{format:?}, {map:?}: {worst}/255");
            }
        }
    });
}

/// A depth that is sampled hides what its copy does, byte for byte, also where the image covers a part of the picture.
#[test]
fn a_depth_that_is_sampled_hides_what_its_copy_does() {
    let world = World::new();
    let map = maps()[0];
    with_host(true, |host, device| {
        let first = first(device);
        let on = (device, &first);
        for (format, bindings, shift) in [
            (vk::Format::D32_SFLOAT, Bindings::Address, 0),
            (vk::Format::D32_SFLOAT, Bindings::Bound, 50),
            (vk::Format::D16_UNORM, Bindings::Mixed, -51),
            (vk::Format::X8_D24_UNORM_PACK32, Bindings::Mixed, 0),
        ] {
            if !device
                .format_features(format)
                .contains(vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT)
            {
                continue;
            }
            let desc = canvas(&world, map, format);
            let depth = depth_desc(&desc, map, true);
            let canvas = Canvas::new(&host.lend(), device, desc);
            let draw = |sampled| {
                let desc = RendererDesc::new(FLOATS)
                    .depth(Some(depth.sampled(sampled)))
                    .bindings(bindings);
                let mut behind = match sampled {
                    true => canvas.depth_view(ORIGIN.0, ORIGIN.1),
                    false => canvas.depth_image(ORIGIN.0, ORIGIN.1),
                };
                behind.origin.x += shift;
                draw_behind(on, &canvas, &world, desc, Raster::Tiles, Some(behind)).0
            };
            let (sampled, copied) = (draw(true), draw(false));
            assert!(sampled == copied, "{format:?}, {bindings:?}, {shift}");
        }
    });
}

/// A depth image that is not under the picture hides nothing, and nothing beside its copy is read.
#[test]
fn a_depth_image_beside_the_picture_hides_nothing() {
    let world = World::new();
    let mut headless = common::headless();
    headless.load(&world.scene).expect("uploads");
    let settings = Settings::default().raster(Raster::Tiles);
    let drawn = headless.render(&world.camera, &world.clip, &settings);
    drawn.expect("renders");
    let truth = headless.picture().expect("reads back");
    with_host(true, |host, device| {
        let first = first(device);
        let on = (device, &first);
        for map in maps() {
            let desc = canvas(&world, map, vk::Format::D32_SFLOAT);
            let depth = depth_desc(&desc, map, true);
            let canvas = Canvas::new(&host.lend(), device, desc);
            let desc = RendererDesc::new(FLOATS)
                .depth(Some(depth))
                .bindings(Bindings::Mixed);
            let mut beside = canvas.depth_image(ORIGIN.0, ORIGIN.1);
            beside.origin.x += 5_000;
            let tiles = Raster::Tiles;
            let (picture, _) = draw_behind(on, &canvas, &world, desc, tiles, Some(beside));
            let worst = apart(&picture, &truth, 0.0);
            assert!(worst < 1.0, "{map:?}: {worst}/255");
        }
    });
}

#[test]
fn tiles_that_cannot_see_the_hosts_depth_are_quads() {
    let world = World::new();
    let truth = world.truth(&mut common::headless());
    let map = maps()[1];
    with_host(false, |host, device| {
        let first = first(device);
        let on = (device, &first);
        let desc = canvas(&world, map, vk::Format::D32_SFLOAT);
        let depth = depth_desc(&desc, map, false);
        let canvas = Canvas::new(&host.lend(), device, desc);
        let desc = RendererDesc::new(FLOATS).depth(Some(depth));
        for raster in [Raster::Tiles, Raster::Auto] {
            let (picture, path) = draw(on, &canvas, &world, desc, raster);
            assert_eq!(path, "quad", "{raster:?}");
            let worst = apart(&picture, &truth, 0.0);
            assert!(worst < 1.0, "{raster:?}: {worst}/255");
        }
    });
}
