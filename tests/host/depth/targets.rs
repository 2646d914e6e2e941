//! Classic render passes and targets of several samples show the same picture; impossible targets are refused.

use super::*;
use crate::canvas::with_host;
use rara::ColorSpace;
use rara::gpu::{Bindings, Target};

#[test]
fn a_classic_render_pass_shows_the_same_picture() {
    let world = World::new();
    let map = maps()[1];
    with_host(true, |host, device| {
        let with_depth = [vk::Format::D32_SFLOAT, vk::Format::UNDEFINED];
        for (format, raster) in with_depth.into_iter().flat_map(|format| {
            common::rasters(device)
                .into_iter()
                .map(move |raster| (format, raster))
        }) {
            let [dynamic, classic] = [false, true].map(|render_pass| {
                let mut desc = canvas(&world, map, format);
                desc.render_pass = render_pass;
                let tested = format != vk::Format::UNDEFINED;
                let depth = tested.then(|| depth_desc(&desc, map, true));
                let canvas = Canvas::new(&host.lend(), device, desc);
                let target = if render_pass {
                    // SAFETY: the canvas has the pass until its end.
                    unsafe { Target::render_pass(canvas.render_pass(), 0) }
                } else {
                    Target::DYNAMIC
                };
                let desc = RendererDesc::new(FLOATS)
                    .depth(depth)
                    .target(target)
                    .bindings(Bindings::Mixed);
                // A render pass is gone before the next one has pipelines.
                draw((device, &first(device)), &canvas, &world, desc, raster).0
            });
            assert!(dynamic.pixels.iter().any(|pixel| pixel[3] > 0.5));
            assert!(dynamic == classic, "{format:?}, {raster:?}: the same bytes");
        }
    });
}

/// With several samples only a splat's outline, where its alpha is 1/255, differs.
#[test]
fn targets_of_several_samples_resolve_to_the_same_picture() {
    let world = World::new();
    let truth = world.truth(&mut common::headless());
    let map = maps()[1];
    let samples = vk::SampleCountFlags::TYPE_4;
    with_host(true, |host, device| {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        if !device.sample_counts(FLOATS, usage).contains(samples) {
            eprintln!("SKIPPED: no {FLOATS:?} of four samples on this device");
            return;
        }
        let mut desc = canvas(&world, map, vk::Format::D32_SFLOAT);
        desc.samples = samples;
        let depth = depth_desc(&desc, map, false);
        let canvas = Canvas::new(&host.lend(), device, desc);
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(depth))
            .samples(samples)
            .bindings(Bindings::Mixed);
        let first = first(device);
        for raster in common::rasters(device) {
            let (picture, _) = draw((device, &first), &canvas, &world, desc, raster);
            let (worst, most) = (apart(&picture, &truth, 0.0), apart(&picture, &truth, 0.01));
            eprintln!("{raster:?}: {worst}/255, {most}/255 for 99 %");
            assert!(
                worst < 8.0 && most < 1.0,
                "{raster:?}: {worst}/255, {most}/255 for 99 %"
            );
        }
    });
}

/// A host of several samples and of linear light has tiles, too, where it resolves its depth for them.
#[test]
fn tiles_draw_linear_light_into_several_samples_behind_a_resolved_depth() {
    let world = World::new();
    let map = maps()[1];
    with_host(true, |host, device| {
        let first = first(device);
        let four = vk::SampleCountFlags::TYPE_4;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        if !device.sample_counts(FLOATS, usage).contains(four) {
            eprintln!("SKIPPED: no {FLOATS:?} of four samples on this device");
            return;
        }
        let [one, several] = [vk::SampleCountFlags::TYPE_1, four].map(|samples| {
            let mut desc = canvas(&world, map, vk::Format::D32_SFLOAT);
            desc.samples = samples;
            let depth = depth_desc(&desc, map, true);
            let canvas = Canvas::new(&host.lend(), device, desc);
            let desc = RendererDesc::new(FLOATS)
                .color_space(ColorSpace::Linear)
                .depth(Some(depth))
                .samples(samples)
                .bindings(Bindings::Mixed);
            let (picture, path) = draw((device, &first), &canvas, &world, desc, Raster::Auto);
            assert_eq!(path, "tiles");
            picture
        });
        assert!(one.pixels.iter().any(|pixel| pixel[3] > 0.5));
        let worst = apart(&one, &several, 0.0);
        assert!(worst < 1e-3, "{worst}/255");
    });
}

#[test]
fn what_a_device_cannot_draw_into_is_refused_with_a_reason() {
    with_host(true, |_, device| {
        let refused = |desc: RendererDesc| {
            let error = Renderer::new(device, desc).expect_err("refused");
            error.to_string()
        };
        let samples = vk::SampleCountFlags::TYPE_64;
        let usual = RendererDesc::new(vk::Format::R8G8B8A8_UNORM);
        let text = refused(usual.samples(samples));
        assert!(
            text.contains("TYPE_64") && text.contains("one sample"),
            "{text}"
        );
        let samples = vk::SampleCountFlags::TYPE_1 | vk::SampleCountFlags::TYPE_4;
        let text = refused(usual.samples(samples));
        assert!(text.contains("samples"), "{text}");
        let depth = DepthDesc::new(vk::Format::R8G8B8A8_UNORM, maps()[0]);
        let text = refused(usual.depth(Some(depth)));
        assert!(text.contains("no depth"), "{text}");
    });
}

#[test]
fn a_promised_depth_that_is_not_given_is_refused() {
    let headless = common::headless();
    let device = headless.device();
    let depth = DepthDesc::new(vk::Format::D32_SFLOAT, maps()[0]).readable(true);
    let desc = RendererDesc::new(FLOATS).depth(Some(depth));
    let world = World::new();
    let format = rara::ShFormat::Float;
    let scene = SceneBuffers::upload(device, &world.scene, format).expect("uploads");
    let mut renderer = Renderer::new(device, desc).expect("a renderer");
    let configured = renderer.configure(&scene, &world.camera, &world.clip, &Settings::default());
    let configured = configured.expect("configures");
    // SAFETY: refused before anything is recorded.
    let refused = unsafe { renderer.prepare(vk::CommandBuffer::null(), &scene, None, configured) };
    let text = refused.unwrap_err().to_string();
    assert!(text.contains("promised the host's depth"), "{text}");
    // An image where a view to sample was promised, and the other way round.
    let image = DepthImage {
        image: vk::Image::null(),
        view: vk::ImageView::null(),
        layout: vk::ImageLayout::GENERAL,
        extent: vk::Extent2D::default(),
        layer: 0,
        origin: vk::Offset2D::default(),
    };
    let view = DepthImage {
        view: vk::Handle::from_raw(1),
        ..image
    };
    for (sampled, given) in [(true, image), (false, view)] {
        let desc = desc.depth(Some(depth.sampled(sampled)));
        let mut renderer = renderer.sharing(desc).expect("another");
        let configured =
            renderer.configure(&scene, &world.camera, &world.clip, &Settings::default());
        let (cmd, configured) = (vk::CommandBuffer::null(), configured.expect("configures"));
        // SAFETY: refused before anything is recorded.
        let refused = unsafe { renderer.prepare(cmd, &scene, Some(&given), configured) };
        let text = refused.unwrap_err().to_string();
        assert!(text.contains("DepthDesc::sampled"), "{text}");
    }
}
