//! Tests that look inside a renderer.

use super::*;
use crate::camera::Camera;
use crate::clip::Clip;
use crate::gpu::{Drawer, ImageDesc, testing};
use crate::passes::SceneBuffers;
use crate::precision::ShFormat;
use crate::scene::{Bounds, Kind, generate};
use crate::settings::Settings;
use glam::DVec3;

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Recording goes on while another renderer compiles into the pipelines that both share. Who compiles holds the lock, as
/// this test does, which would not end if recording waited for it. Configuring a frame that needs nothing new does not wait
/// either.
#[test]
fn recording_waits_for_no_compiler() {
    let device = testing::device();
    let scene = generate(Kind::General, 600, 1);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (24, 16)).expect("a view");
    let buffers = SceneBuffers::upload(&device, &scene, ShFormat::Packed).expect("uploads");
    let target = device.create_image(&ImageDesc {
        name: "target",
        width: camera.width,
        height: camera.height,
        format: FORMAT,
    });
    let target = target.expect("memory");
    let mut renderer = Renderer::new(&device, RendererDesc::new(FORMAT)).expect("a renderer");
    let other = renderer.sharing(RendererDesc::new(FORMAT)).expect("shares");
    let (clip, settings) = (Clip::default(), Settings::default());
    let configured = renderer.configure(&buffers, &camera, &clip, &settings);
    configured.expect("configures");

    let compiling = other.pipelines.all.lock().expect("nobody has panicked");
    let configured = renderer.configure(&buffers, &camera, &clip, &settings);
    configured.expect("configures");
    let submitted = device.submit_and_wait(|cmd| {
        // SAFETY: `cmd` is recording outside rendering, and all that is used outlives the wait. The scope is opened and
        // closed around the draw, on an attachment of the renderer's format.
        unsafe {
            renderer.prepare(cmd, &buffers)?;
            target.begin_rendering(cmd, [0.0; 4]);
            Drawer::new(&device, cmd, None).viewport(target.extent().into());
            renderer.draw(cmd, [0.0; 2])?;
            target.end_rendering(cmd);
        }
        Ok(())
    });
    submitted.expect("submits");
    drop(compiling);
    drop((renderer, other, target, buffers));
    assert_eq!(device.close(), Vec::<String>::new());
}
