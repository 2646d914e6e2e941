//! A host of linear light: splats are blended as stored, and their picture meets the host's pixels as linear light.

use super::*;
use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use rara::gpu::DeviceShape;
use rara::{ColorSpace, DepthMap, Error, FrameLimits, Show};

/// The linear light of a colour as sRGB stores it.
fn linear(stored: f32) -> f32 {
    let stored = stored.max(0.0);
    match stored <= 0.04045 {
        true => stored / 12.92,
        false => ((stored + 0.055) / 1.055).powf(2.4),
    }
}

/// How sRGB stores linear light.
fn stored(light: f32) -> f32 {
    match light <= 0.003_130_8 {
        true => light * 12.92,
        false => 1.055 * light.powf(1.0 / 2.4) - 0.055,
    }
}

/// A premultiplied picture in linear light.
fn in_linear_light(picture: &Picture) -> Picture {
    let convert = |&[r, g, b, a]: &[f32; 4]| match a > 0.0 {
        true => {
            let [r, g, b] = [r, g, b].map(|c| a * linear(c / a));
            [r, g, b, a]
        }
        false => [0.0; 4],
    };
    Picture {
        pixels: picture.pixels.iter().map(convert).collect(),
        ..*picture
    }
}

/// Asserts that floats are as they should be, also beyond white.
fn assert_close(what: &str, pixels: &[[f32; 4]], expected: &[[f32; 4]]) {
    let pairs = pixels.iter().flatten().zip(expected.iter().flatten());
    let differences: Vec<f32> = pairs.map(|(a, b)| (a - b).abs()).collect();
    let worst = differences.iter().copied().fold(0.0, f32::max);
    let mean = differences.iter().sum::<f32>() / differences.len() as f32;
    assert!(
        worst < 2e-3 && mean < 2e-6,
        "{what}: {worst}, {mean} on average"
    );
}

/// The headless picture over the host's stripes, without bounds.
fn over_stripes(host: &Host, picture: &Picture) -> Vec<[f32; 4]> {
    let over = |(i, pixel): (usize, &[f32; 4])| {
        let below = host.backdrop(i as u32 % picture.width);
        [0, 1, 2, 3].map(|c| pixel[c] + (1.0 - pixel[3]) * below[c])
    };
    picture.pixels.iter().enumerate().map(over).collect()
}

/// With `RARA_PICTURES`, writes what a display shows of a host's linear pixels.
fn show(name: &str, pixels: &[[f32; 4]]) {
    if let Some(folder) = std::env::var_os("RARA_PICTURES") {
        let shown = pixels.iter().map(|&[r, g, b, _]| {
            let [r, g, b] = [r, g, b].map(|c| stored(c.clamp(0.0, 1.0)));
            [r, g, b, 1.0]
        });
        let mut picture = Picture::filled(VIEW.width, VIEW.height, [0.0; 4]);
        picture.pixels = shown.collect();
        let path = std::path::Path::new(&folder).join(name);
        picture.save(path).expect("the folder is there");
    }
}

#[test]
fn the_splats_picture_meets_a_hosts_pixels_as_linear_light() {
    let scene = generate(Kind::Layers, 20_000, 2);
    let camera = common::views(&scene, 3, (VIEW.width, VIEW.height))[0];
    let clip = common::clip(&scene, 1, ClipOp::And);
    let shown = (camera, clip, Settings::default());
    let mut light = scene.clone();
    let training = light.training().linear(true);
    light.set_training(training).expect("it can be drawn");
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let (camera, clip, settings) = &shown;
    headless.render(camera, clip, settings).expect("renders");
    let picture = headless.picture().expect("reads back");
    let converted = in_linear_light(&picture);
    // What is blended in linear light becomes what the host has, too.
    headless.load(&light).expect("uploads");
    headless.render(camera, clip, settings).expect("renders");
    let of_light = headless.picture().expect("reads back");
    let light_itself = in_linear_light(&of_light);
    for (space, bindings, scene, right, name) in [
        (
            ColorSpace::Linear,
            Bindings::Mixed,
            &scene,
            &converted,
            "linear.png",
        ),
        (
            ColorSpace::Linear,
            Bindings::Address,
            &scene,
            &converted,
            "linear.png",
        ),
        (
            ColorSpace::Stored,
            Bindings::Mixed,
            &scene,
            &picture,
            "stored.png",
        ),
        (
            ColorSpace::Linear,
            Bindings::Mixed,
            &light,
            &light_itself,
            "light.png",
        ),
        (
            ColorSpace::Stored,
            Bindings::Address,
            &light,
            &of_light,
            "light_stored.png",
        ),
    ] {
        let desc = in_flight(FLOATS, bindings).color_space(space);
        let host = open_host(FLOATS, VIEW, true);
        let mut engine = Engine::new(host, scene, ShFormat::default(), desc);
        engine.configure(&shown);
        let configured = engine.configured.as_ref().expect("it was configured");
        assert_eq!(configured.raster().path, "tiles");
        engine.record(vk::Offset2D::default());
        let pixels = engine.wait_for_all();
        let expected = over_stripes(&engine.host, right);
        assert_close(
            &format!("{name}, {space:?}, {bindings:?}"),
            &pixels,
            &expected,
        );
        show(name, &pixels);
        engine.close();
    }
    let apart = converted.pixels.iter().zip(&picture.pixels);
    let most = apart.map(|(a, b)| b[0] - a[0]).fold(0.0, f32::max);
    assert!(most > 0.15, "what is stored is brighter: {most}");
}

/// Frames of numbers stay numbers; what only quads could draw is refused, and says what to do.
#[test]
fn linear_light_is_of_colours_and_of_tiles() {
    let scene = scene();
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let counted = settings.show(Show::Count);
    headless.render(&camera, &clip, &counted).expect("renders");
    let picture = headless.picture().expect("reads back");
    let desc = in_flight(FLOATS, Bindings::Mixed).color_space(ColorSpace::Linear);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    engine.configure(&(camera, clip.clone(), counted));
    engine.record(vk::Offset2D::default());
    let pixels = engine.wait_for_all();
    let expected = over_stripes(&engine.host, &picture);
    // A GPU's blend may round the product before it adds, or not.
    let is_cpus = headless.device().shape() == DeviceShape::Cpu;
    let rounding = if is_cpus { 0.0 } else { f32::EPSILON };
    let apart = |(a, b): (&f32, &f32)| {
        let is_near = (a - b).abs() <= rounding * b.max(1.0);
        !is_near
    };
    let pairs = pixels.as_flattened().iter().zip(expected.as_flattened());
    assert_eq!(pairs.filter(|&pair| apart(pair)).collect::<Vec<_>>(), []);
    let refused = |result: rara::Result<ConfiguredFrame>| {
        let error = result.expect_err("only quads could");
        assert!(matches!(&error, Error::Invalid(text) if text.contains("ColorSpace::Linear")));
    };
    let quads = settings.raster(Raster::Quad);
    refused(
        engine
            .renderer
            .configure(&engine.scene, &camera, &clip, &quads),
    );
    let map = DepthMap::ordinary(0.1, 100.0).expect("a map");
    let depth = rara::DepthDesc::new(vk::Format::D32_SFLOAT, map);
    let behind = engine.renderer.sharing(desc.depth(Some(depth)));
    let mut behind = behind.expect("a renderer");
    refused(behind.configure(&engine.scene, &camera, &clip, &settings));
    drop(behind);
    engine.close();
}

/// Linear light needs no room for all pairs either.
#[test]
fn frames_of_linear_light_without_room_show_the_same() {
    let scene = scene();
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let size = (VIEW.width, VIEW.height);
    with_host(true, |host, device| {
        let canvas = Canvas::new(&host.lend(), device, CanvasDesc::new(size, FLOATS));
        let desc = RendererDesc::new(FLOATS).bindings(Bindings::Mixed);
        let desc = desc.color_space(ColorSpace::Linear);
        let mut renderer = Renderer::new(device, desc).expect("a renderer");
        let there = SceneBuffers::upload(device, &scene, ShFormat::Float).expect("uploads");
        let limits = FrameLimits::new(size, scene.len() as u32).planes(1);
        let [coarse, whole] = [Some(16), None].map(|pairs| {
            let limits = limits.clone().pairs(pairs);
            renderer.reserve(&limits).expect("there is memory");
            let configured = renderer.configure(&there, &camera, &clip, &settings);
            let pixels = canvas.draw_frame(&mut renderer, &there, configured, &Frame::new(size));
            assert_eq!(renderer.fell_back(), pairs.is_some());
            pixels
        });
        assert!(whole.iter().filter(|pixel| pixel[3] > 0.1).count() > 1_000);
        let apart = |(a, b): (&[f32; 4], &[f32; 4])| {
            (0..4).map(|at| (a[at] - b[at]).abs()).fold(0.0, f32::max)
        };
        let worst = coarse.iter().zip(&whole).map(apart).fold(0.0, f32::max);
        assert!(worst <= 1e-6, "{worst}");
    });
}
