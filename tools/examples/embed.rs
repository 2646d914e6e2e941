//! rara in somebody else's engine: cargo run --release --example embed [OUT.png]
//!
//! `host.rs` is the engine: its own instance, device, queue, targets and frames in flight. Here rara adopts its device,
//! uploads a scene, and draws each frame in three calls, which record and do nothing else.

mod host;

use host::{FRAMES, Host, HostDesc};
use rara::ash::vk;
use rara::glam::DVec3;
use rara::gpu::Device;
use rara::scene::{Kind, generate};
use rara::{Camera, Clip, ClipOp, Picture, Plane, Renderer, RendererDesc, SceneBuffers, Settings};

const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;
const TARGET: vk::Extent2D = vk::Extent2D {
    width: 640,
    height: 480,
};
/// The part of the target that the splats are drawn in; the host's stripes are around it, and show through.
const VIEW: vk::Rect2D = vk::Rect2D {
    offset: vk::Offset2D { x: 40, y: 30 },
    extent: vk::Extent2D {
        width: 560,
        height: 420,
    },
};

fn main() -> rara::Result<()> {
    let out = std::env::args().nth(1).unwrap_or("embed.png".into());
    let mut host = Host::new(&HostDesc {
        device: None,
        validation: false,
        optional: true,
        extent: TARGET,
        format: FORMAT,
    })?;

    // SAFETY: the handles belong together, and the host outlives the device, which is dropped below.
    let device = unsafe { Device::adopt(host.lend()) }?;
    let scene = SceneBuffers::upload(
        &device,
        &generate(Kind::General, 50_000, 1),
        rara::ShFormat::default(),
    )?;
    let mut renderer = Renderer::new(
        &device,
        RendererDesc::new(FORMAT).frames_in_flight(FRAMES as u32),
    )?;

    let size = (VIEW.extent.width, VIEW.extent.height);
    for frame in 0..8 {
        let turn = f64::from(frame) * 0.1;
        let eye = 2.6 * DVec3::new(turn.sin(), -0.35, -turn.cos());
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, size)?;
        let clip = Clip::of([Plane::new(DVec3::X, 0.1 * f64::from(frame))?], ClipOp::And);

        host.wait()?;
        let frame = renderer.configure(&scene, &camera, &clip, &Settings::default())?;
        let cmd = host.begin()?;
        // SAFETY: `cmd` is recording outside rendering, the scene outlives the wait at the end.
        let frame = unsafe { renderer.prepare(cmd, &scene, None, frame) }?;
        host.begin_rendering(VIEW);
        let origin = [VIEW.offset.x as f32, VIEW.offset.y as f32];
        // SAFETY: `cmd` is inside rendering to a target of this format, viewport and scissor are set.
        unsafe { renderer.draw(cmd, origin, &frame) }?;
        host.submit()?;
    }
    let pixels = host.wait_for_all()?;

    // The order matters: the host's device goes last.
    drop((renderer, scene, device));
    host.close();
    let picture = Picture {
        width: TARGET.width,
        height: TARGET.height,
        pixels,
    };
    picture.save(out)
}
