//! What is drawn after the splats meets them: their depths are in the host's depth buffer.

use super::*;
use crate::canvas::with_host;
use rara::gpu::{Bindings, Target};
use rara::{ExpectedDepthDesc, FrameLimits, Mode};

/// A depth where there is neither splat nor mesh.
const FAR: f64 = 1e6;

/// Draws a frame of the world on a canvas; returns the depths that its buffer then holds under the camera's picture, `FAR` where
/// it holds none, and the picture.
fn draw_written(
    device: &Device,
    canvas: &Canvas,
    world: &World,
    renderer: &mut Renderer,
    map: DepthMap,
) -> (Vec<f64>, Picture) {
    let format = rara::ShFormat::Float;
    let scene = SceneBuffers::upload(device, &world.scene, format).expect("uploads");
    let configured = renderer.configure(&scene, &world.camera, &world.clip, &world.settings);
    let behind = canvas.depth_image(ORIGIN.0, ORIGIN.1);
    let pixels = canvas.draw_frame(renderer, &scene, configured, &frame(Some(behind)));
    let held = canvas.depths().into_iter().map(|held| {
        let far = f32::from(!map.is_reversed());
        [if held == far {
            FAR
        } else {
            map.scale() / (f64::from(held) - map.offset())
        } as f32; 4]
    });
    let depths = part(&held.collect::<Vec<_>>());
    let depths = depths.pixels.iter().map(|pixel| f64::from(pixel[0]));
    (depths.collect(), part(&pixels))
}

/// In every mode the depths are those of the reference, and meshes that are nearer keep theirs.
#[test]
fn splats_leave_their_depths_in_the_hosts_buffer() {
    with_host(true, |host, device| {
        let first = first(device);
        let (ordinary, reversed) = (maps()[0], maps()[2]);
        for (mode, alpha, map, bindings, expected) in [
            (Mode::Exact, 0.5, reversed, Bindings::Bound, false),
            (Mode::Exact, 0.9, ordinary, Bindings::Mixed, true),
            (Mode::Rara, 0.1, reversed, Bindings::Address, false),
            (Mode::None, 0.8, ordinary, Bindings::Mixed, false),
        ] {
            let mut world = World::new();
            world.settings = world.settings.mode(mode);
            let desc = canvas(&world, map, vk::Format::D32_SFLOAT);
            let depth = depth_desc(&desc, map, true);
            let canvas = Canvas::new(&host.lend(), device, desc);
            let desc = RendererDesc::new(FLOATS)
                .bindings(bindings)
                .expected_depth(expected.then(|| ExpectedDepthDesc::new(FLOATS)));
            let [(unwritten, colours), (depths, picture)] = [None, Some(alpha)].map(|alpha| {
                let desc = desc.depth(Some(depth.write_alpha(alpha)));
                let mut renderer = first.sharing(desc).expect("a renderer");
                draw_written(device, &canvas, &world, &mut renderer, map)
            });
            assert!(picture == colours, "colours are as they are without depths");
            let least =
                f64::from(alpha).min(1.0 - f64::from(world.settings.precision.transmittance_min));
            let mut truth = reaching(&world, &world.scene, least);
            for (rect, mesh) in world.meshes {
                let before = reaching(&world, &world.before(mesh), least);
                for y in rect.offset.y as u32..rect.offset.y as u32 + rect.extent.height {
                    for x in rect.offset.x as u32..rect.offset.x as u32 + rect.extent.width {
                        let at = (y * VIEW.0 + x) as usize;
                        truth[at] = before[at].min(mesh);
                    }
                }
            }
            let inside = |at: &usize| unwritten[*at] != 0.0; // of the target
            let mut written = 0;
            let mut errors: Vec<_> = (0..truth.len())
                .filter(inside)
                .map(|at| {
                    written += usize::from(depths[at] != unwritten[at]);
                    (depths[at] / truth[at]).ln().abs()
                })
                .collect();
            errors.sort_by(f64::total_cmp);
            let most = errors[errors.len() * 99 / 100];
            let what = format!(
                "{mode:?}, from {alpha}: {most:.1e} for 99 % of the pixels, {written} written"
            );
            eprintln!("{what}");
            assert!(written > 500 && most < 1e-4, "{what}");
            let farther = (0..truth.len()).filter(|&at| depths[at] > unwritten[at]);
            assert_eq!(farther.count(), 0, "no depth is pushed away");
        }
    });
}

fn reaching(world: &World, scene: &Gaussians, least: f64) -> Vec<f64> {
    let (camera, clip, settings) = (&world.camera, &world.clip, &world.settings);
    let reached = rara_reference::depth::reaching::<f64>(scene, camera, clip, settings, least);
    reached
        .into_iter()
        .map(|depth| depth.unwrap_or(FAR))
        .collect()
}

/// In a classic render pass they are the same bytes, and without room for the tiles' lists the same too.
#[test]
fn render_passes_and_frames_without_room_get_the_same_depths() {
    let world = World::new();
    let map = maps()[1];
    with_host(true, |host, device| {
        let first = first(device);
        let [dynamic, classic, roomless] =
            [(false, None), (true, None), (false, Some(16))].map(|(render_pass, pairs)| {
                let mut desc = canvas(&world, map, vk::Format::D32_SFLOAT);
                desc.render_pass = render_pass;
                let depth = depth_desc(&desc, map, true).write_alpha(Some(0.5));
                let canvas = Canvas::new(&host.lend(), device, desc);
                let target = match render_pass {
                    // SAFETY: the canvas has the pass until its end.
                    true => unsafe { Target::render_pass(canvas.render_pass(), 0) },
                    false => Target::DYNAMIC,
                };
                let desc = RendererDesc::new(FLOATS).depth(Some(depth)).target(target);
                let desc = desc.bindings(Bindings::Mixed);
                // A render pass is gone before the next one has pipelines.
                let mut renderer = match render_pass {
                    true => Renderer::new(device, desc),
                    false => first.sharing(desc),
                }
                .expect("a renderer");
                let limits = FrameLimits::new(VIEW, world.scene.len() as u32)
                    .planes(1)
                    .pairs(pairs);
                renderer.reserve(&limits).expect("there is memory");
                let drawn = draw_written(device, &canvas, &world, &mut renderer, map);
                assert_eq!(renderer.fell_back(), pairs.is_some());
                drawn
            });
        assert!(dynamic == classic);
        let (depths, picture) = roomless;
        let worst = apart(&picture, &dynamic.1, 0.0);
        assert!(worst < 1e-3, "{worst}/255");
        let others = depths.iter().zip(&dynamic.0).filter(|(a, b)| a != b);
        assert_eq!(others.count(), 0);
    });
}

/// Depths that nothing could find are refused where the renderer is made, and where it is told to draw otherwise.
#[test]
fn depths_that_cannot_be_written_are_refused() {
    let world = World::new();
    let map = maps()[1];
    with_host(true, |_, device| {
        let depth = DepthDesc::new(vk::Format::D32_SFLOAT, map).readable(true);
        let desc = |depth| RendererDesc::new(FLOATS).depth(Some(depth));
        for (depth, says) in [
            (depth.write_alpha(Some(0.5)).readable(false), "readable"),
            (depth.soft(true).readable(false), "readable"),
            (depth.write_alpha(Some(0.0)), "above 0 and at most 1"),
            (depth.write_alpha(Some(1.5)), "above 0 and at most 1"),
            (depth.write_alpha(Some(f32::NAN)), "above 0 and at most 1"),
        ] {
            let refused = Renderer::new(device, desc(depth)).expect_err(says);
            assert!(refused.to_string().contains(says), "{refused}");
        }
        let scene = SceneBuffers::upload(device, &world.scene, rara::ShFormat::Float);
        let scene = scene.expect("uploads");
        let made = Renderer::new(device, desc(depth.write_alpha(Some(0.5))));
        let settings = world.settings.raster(Raster::Quad);
        let refused =
            made.expect("a renderer")
                .configure(&scene, &world.camera, &world.clip, &settings);
        let refused = refused.expect_err("quads find no depths").to_string();
        assert!(refused.contains("write_alpha"), "{refused}");
    });
}
