//! rara in a host's own engine, under the host's own validation: `tools/examples/host.rs` has instance, device, queue,
//! targets and two frames in flight; the pictures must be the headless ones, over what the host has painted.

mod ahead;
mod ending;
mod frames;
mod linear;
mod memory;
mod queues;
mod refused;
mod reserve;
mod viewport;

use crate::canvas::host::{FRAMES, Host};
use crate::canvas::{adopt, open_host};
use crate::common;
use rara::ash::vk;
use rara::gpu::{Bindings, Device};
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, ConfiguredFrame, Gaussians, Picture, PreparedFrame, Raster, Renderer,
    RendererDesc, SceneBuffers, Settings, ShFormat,
};

const BYTES: vk::Format = vk::Format::R8G8B8A8_UNORM;
const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// The size of the camera's picture: no multiple of anything, so that nothing is right by chance.
const VIEW: vk::Extent2D = vk::Extent2D {
    width: 189,
    height: 131,
};

fn in_flight(format: vk::Format, bindings: Bindings) -> RendererDesc {
    RendererDesc::new(format)
        .bindings(bindings)
        .timing(true)
        .frames_in_flight(FRAMES as u32)
}

fn scene() -> Gaussians {
    generate(Kind::General, 3_000, 5)
}

/// The camera, the clip and the settings of a frame.
type Frame = (Camera, Clip, Settings);

/// Frames that need more and more room, and less again: cameras, clips of zero to six planes, settings.
fn frames(scene: &Gaussians) -> Vec<Frame> {
    let planes = [0, 1, 6, 2, 0, 3];
    let cameras = common::views(scene, planes.len(), (VIEW.width, VIEW.height));
    let clip = |count| common::clip(scene, count, ClipOp::And);
    let frame = |(camera, count)| (camera, clip(count), Settings::default());
    cameras.into_iter().zip(planes).map(frame).collect()
}

/// A host that draws a scene with a renderer on its own device.
struct Engine {
    host: Host,
    device: Device,
    scene: SceneBuffers,
    renderer: Renderer,
    /// The next frame, between `configure` and `prepare`.
    configured: Option<ConfiguredFrame>,
    /// The last frame, from `prepare` to the next `configure`.
    prepared: Option<PreparedFrame>,
}

impl Engine {
    fn new(host: Host, scene: &Gaussians, format: ShFormat, desc: RendererDesc) -> Self {
        let device = adopt(&host);
        Self {
            scene: SceneBuffers::upload(&device, scene, format).expect("uploads"),
            renderer: Renderer::new(&device, desc).expect("a renderer"),
            device,
            host,
            configured: None,
            prepared: None,
        }
    }

    fn configure(&mut self, (camera, clip, settings): &Frame) {
        (self.configured, self.prepared) = (None, None);
        let configured = self.renderer.configure(&self.scene, camera, clip, settings);
        self.configured = Some(configured.expect("configures"));
    }

    /// Begins the frame that is configured and prepares it.
    fn prepare(&mut self) -> vk::CommandBuffer {
        let cmd = self.host.begin().expect("begins");
        self.prepare_in(cmd);
        cmd
    }

    /// Prepares the frame that is configured.
    fn prepare_in(&mut self, cmd: vk::CommandBuffer) {
        let configured = self.configured.take().expect("it was configured");
        // SAFETY: `cmd` is recording outside rendering, and every test waits before it drops the scene.
        let prepared = unsafe { self.renderer.prepare(cmd, &self.scene, None, configured) };
        self.prepared = Some(prepared.expect("prepares"));
    }

    /// Draws the frame that is prepared, inside the host's rendering.
    fn draw(&mut self, cmd: vk::CommandBuffer, origin: [f32; 2]) {
        let prepared = self.prepared.as_ref().expect("it was prepared");
        // SAFETY: `cmd` is inside rendering to a target of the renderer's format, viewport and scissor are set.
        unsafe { self.renderer.draw(cmd, origin, prepared) }.expect("draws");
    }

    /// Records and submits the frame that is configured. The splats go to `at`.
    fn record(&mut self, at: vk::Offset2D) {
        let cmd = self.prepare();
        self.record_draw(cmd, at);
    }

    /// Records the draw of the frame that is prepared, and submits it.
    fn record_draw(&mut self, cmd: vk::CommandBuffer, at: vk::Offset2D) {
        self.host.begin_rendering(vk::Rect2D {
            offset: at,
            extent: VIEW,
        });
        self.draw(cmd, [at.x as f32, at.y as f32]);
        self.host.submit().expect("submits");
    }

    /// Waits until the frame `FRAMES` ago is done; returns its picture, if there was one.
    fn wait(&mut self) -> Option<Vec<[f32; 4]>> {
        self.host.wait().expect("waits")
    }

    /// Waits for the last frame; returns its picture.
    fn wait_for_all(&mut self) -> Vec<[f32; 4]> {
        self.host.wait_for_all().expect("waits")
    }

    /// Drops everything, which leaves no memory and no message of the validation layer behind.
    fn close(self) {
        drop((self.configured, self.prepared));
        drop((self.renderer, self.scene));
        assert_eq!(
            self.device.device_bytes(),
            0,
            "all that was allocated was freed"
        );
        drop(self.device);
        assert_eq!(self.host.close(), Vec::<String>::new());
    }
}

/// The headless picture over the host's stripes, of which column `left` is the first.
fn expected(host: &Host, picture: &Picture, left: u32) -> Vec<[f32; 4]> {
    let over = |(i, pixel): (usize, &[f32; 4])| {
        let below = host.backdrop(left + i as u32 % picture.width);
        [0, 1, 2, 3].map(|c| (pixel[c] + (1.0 - pixel[3]) * below[c]).clamp(0.0, 1.0))
    };
    picture.pixels.iter().enumerate().map(over).collect()
}

/// Largest and mean difference in units of 1/255. Values of a float target beyond white count as white.
fn apart(a: &[[f32; 4]], b: &[[f32; 4]]) -> (f32, f32) {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let differences = pairs.map(|(a, b)| 255.0 * (a.min(1.0) - b.min(1.0)).abs());
    let (worst, sum) = differences.fold((0.0_f32, 0.0), |(worst, sum), d| (worst.max(d), sum + d));
    (worst, sum / (4 * a.len()) as f32)
}

/// Asserts that a target shows what it should, as well as its format can. Every blend rounds to the format, and dozens of
/// splats lie over each other. In 32 bits that shows nowhere, except where the last bit of a splat's centre in the target
/// decides whether its alpha is below 1/255. Halves are right to 1/8 of 1/255, and lavapipe truncates to them. 8-bit
/// blends are off by 1/2 each, on lavapipe by 1, and each of them cuts off what is beyond white.
fn assert_shows(what: &str, format: vk::Format, pixels: &[[f32; 4]], expected: &[[f32; 4]]) {
    let (worst, mean) = apart(pixels, expected);
    let (most, average) = match format {
        FLOATS => (1.0, 1e-3),
        HALVES => (6.0, 0.1),
        _ => (20.0, 0.3),
    };
    assert!(
        worst <= most && mean <= average,
        "{what}: {worst:.3}/255 at most, {mean:.4}/255 on average"
    );
}
