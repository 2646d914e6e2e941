//! Two eyes of an engine of classic render passes: their pictures are halves of one target, their projections are shifted by parts of
//! a pixel, and they show one cut in linear light and leave its depths behind.

use std::cell::RefCell;

use super::*;
use crate::canvas::with_host;
use rara::gpu::{Bindings, Target};
use rara::{ColorSpace, Cut, PreparedFrame};

const ALPHA: f32 = 0.5;

/// The two eyes before a world, in one frame of a temporal host.
fn cameras(world: &World) -> [Camera; 2] {
    let middle = world.camera;
    let aside = middle.rotation.transpose() * rara::glam::DVec3::X * 0.05;
    [(-1.0, 0.25), (1.0, -0.375)].map(|(side, shift)| {
        let eye = middle.eye(middle.eye + side * aside);
        eye.cx(eye.cx + shift).cy(eye.cy - shift)
    })
}

/// A canvas for so many pictures side by side, with the world's meshes in each.
fn beside(world: &World, map: DepthMap, pictures: i32, render_pass: bool) -> CanvasDesc {
    let mut desc = CanvasDesc::new((pictures as u32 * VIEW.0, VIEW.1), FLOATS);
    desc.depth = vk::Format::D32_SFLOAT;
    desc.far = 0.0;
    desc.render_pass = render_pass;
    desc.clear = [0.25, 0.5, 0.125, 1.0];
    desc.meshes = (0..pictures)
        .flat_map(|at| world.meshes.map(|mesh| (at, mesh)))
        .map(|(at, (mut rect, depth))| {
            rect.offset.x += at * VIEW.0 as i32;
            (rect, map.at(depth) as f32)
        })
        .collect();
    desc
}

#[test]
fn classic_passes_show_both_halves_as_dynamic_rendering_shows_each_eye() {
    let world = World::new();
    let map = maps()[1];
    let eyes = cameras(&world);
    with_host(true, |host, device| {
        let scene = SceneBuffers::upload(device, &world.scene, rara::ShFormat::Float);
        let scene = scene.expect("uploads");
        let desc = |target| {
            let depth = DepthDesc::new(vk::Format::D32_SFLOAT, map);
            RendererDesc::new(FLOATS)
                .color_space(ColorSpace::Linear)
                .bindings(Bindings::Mixed)
                .depth(Some(depth.readable(true).write_alpha(Some(ALPHA))))
                .target(target)
        };
        let alone = eyes.map(|camera| {
            let canvas = Canvas::new(&host.lend(), device, beside(&world, map, 1, false));
            let mut renderer = Renderer::new(device, desc(Target::DYNAMIC)).expect("a renderer");
            let configured = renderer.configure(&scene, &camera, &world.clip, &world.settings);
            let frame = Frame {
                behind: Some(canvas.depth_image(0, 0)),
                ..Frame::new(VIEW)
            };
            let pixels = canvas.draw_frame(&mut renderer, &scene, configured, &frame);
            (pixels, canvas.depths())
        });
        let canvas = Canvas::new(&host.lend(), device, beside(&world, map, 2, true));
        // SAFETY: the canvas has the pass until its end.
        let target = unsafe { Target::render_pass(canvas.render_pass(), 0) };
        let first = Renderer::new(device, desc(target)).expect("a renderer");
        let second = first.sharing(desc(target)).expect("a renderer");
        let mut cut = Cut::new(&first);
        let configured = cut.configure(&scene, &world.clip, &world.settings);
        configured.expect("configures");
        let renderers = RefCell::new([first, second]);
        let prepared = RefCell::new(Vec::<PreparedFrame>::new());
        let lefts = [0, VIEW.0 as i32];
        let before = |cmd| {
            // SAFETY: `cmd` is recording outside a scope, and all is waited for.
            unsafe { cut.prepare(cmd) }.expect("prepares");
            let mut renderers = renderers.borrow_mut();
            for ((renderer, camera), left) in renderers.iter_mut().zip(&eyes).zip(lefts) {
                let configured = renderer.configure(&scene, camera, &cut, &world.settings);
                let (behind, configured) = (canvas.depth_image(left, 0), configured);
                let configured = configured.expect("configures");
                // SAFETY: the same; the depth is ready to be copied.
                let made = unsafe { renderer.prepare(cmd, &scene, Some(&behind), configured) };
                prepared.borrow_mut().push(made.expect("prepares"));
            }
        };
        let inside = |cmd| {
            let (mut renderers, prepared) = (renderers.borrow_mut(), prepared.borrow());
            for ((renderer, frame), left) in renderers.iter_mut().zip(&*prepared).zip(lefts) {
                canvas.viewport(cmd, left, 0, VIEW);
                // SAFETY: `cmd` is inside the canvas's pass, which the renderer was made for.
                let drawn = unsafe { renderer.draw(cmd, [left as f32, 0.0], frame) };
                drawn.expect("draws");
            }
        };
        let [pixels, _] = canvas.draw(before, inside);
        let depths = canvas.depths();
        let wide = 2 * VIEW.0 as usize;
        for (left, (own, own_depths)) in [0, VIEW.0 as usize].into_iter().zip(&alone) {
            let rows = |y: usize| y * wide + left..y * wide + left + VIEW.0 as usize;
            let colours: Vec<_> = (0..VIEW.1 as usize)
                .flat_map(|y| &pixels[rows(y)])
                .collect();
            let found: Vec<_> = (0..VIEW.1 as usize)
                .flat_map(|y| &depths[rows(y)])
                .collect();
            assert!(colours.into_iter().eq(own), "the eye at {left}: colours");
            assert!(
                found.into_iter().eq(own_depths),
                "the eye at {left}: depths"
            );
        }
        assert!(alone[0] != alone[1], "the eyes see it from two places");
    });
}
