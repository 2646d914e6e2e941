//! What is measured in a process of its own.

use std::hint::black_box;
use std::time::Instant;

use rara::ash::vk;
use rara::gpu::{Bindings, Drawer, ImageDesc};
use rara::{
    Clip, Error, Headless, HeadlessDesc, Renderer, RendererDesc, Result, SceneBuffers, Settings,
    TargetFormat,
};

use super::run::{RunTimeOptions, in_mode};
use super::world::World;
use crate::frames::MODES;

/// The works of a child process: from nothing to the first picture; and what instructions are counted of: loading a file,
/// planning frames, recording them.
pub const CHILDREN: [&str; 4] = ["start", "load", "configure", "record"];

/// Frames that are counted, and those before them, which create the buffers and pipelines.
pub(super) const FRAMES: u32 = 10;
const WARM_UP: u32 = 2;

/// The step of a start that ends with the first picture.
pub(super) const FIRST: &str = "first picture";

/// Does one of the works of [`CHILDREN`] with the first scene file. `say` takes the steps of a start, each with its
/// milliseconds.
///
/// # Errors
/// If the file cannot be read, or nothing be drawn.
pub fn child(
    work: &str,
    options: &RunTimeOptions,
    say: &mut dyn FnMut(&str) -> Result<()>,
) -> Result<()> {
    let (device, width) = (&options.device, options.size());
    let load = || World::load(&options.scenes[0], options.cameras.as_deref());
    match work {
        "start" => start(load, width, device, say),
        "load" => black_box(counted_by_callgrind(load)).map(drop),
        _ => frames(work, &load()?, width, device),
    }
}

fn start(
    load: impl Fn() -> Result<World>,
    width: u32,
    device: &HeadlessDesc,
    say: &mut dyn FnMut(&str) -> Result<()>,
) -> Result<()> {
    let mut clock = Instant::now();
    let mut step = |name| {
        let said = say(&format!(
            "{name} {:.3}",
            clock.elapsed().as_secs_f64() * 1e3
        ));
        clock = Instant::now();
        said
    };
    let world = load()?;
    step("load")?;
    let mut headless = Headless::new(device)?;
    step("device")?;
    headless.load_as(&world.scene, Settings::default().precision.sh)?;
    step("upload")?;
    let (camera, settings) = (world.camera(0, width)?, in_mode(MODES[0].1));
    headless.render(&camera, &Clip::default(), &settings)?;
    step(FIRST)?;
    headless.render(&camera, &Clip::default(), &settings)?;
    step("second picture")
}

/// Plans and records frames as an engine would, and submits none of them: the driver compiles a shader when it first
/// executes it, which must not be counted here, and takes minutes in a simulator.
fn frames(work: &str, world: &World, width: u32, device: &HeadlessDesc) -> Result<()> {
    let headless = Headless::new(device)?;
    let device = headless.device();
    let format = TargetFormat::default().vulkan();
    let desc = RendererDesc::new(format).bindings(Bindings::suiting(device));
    let mut renderer = Renderer::new(device, desc)?;
    let settings = in_mode(MODES[3].1);
    let scene = SceneBuffers::upload(device, &world.scene, settings.precision.sh)?;
    let clip = world.keeping(0.5)?;
    for index in 0..WARM_UP + FRAMES {
        let camera = world.camera(index, width)?;
        let (width, height) = (camera.width, camera.height);
        let image = device.create_image(&ImageDesc {
            name: "target",
            width,
            height,
            format,
        })?;
        let area = vk::Rect2D {
            offset: vk::Offset2D::default(),
            extent: image.extent(),
        };
        let counts = |what| index >= WARM_UP && work == what;
        let frame = count_if(counts("configure"), || {
            renderer.configure(&scene, &camera, &clip, &settings)
        })?;
        let recorded = device.submit_and_wait(|cmd| {
            let counts = counts("record");
            // SAFETY: `cmd` is recording outside rendering; scene, image and renderer outlive the recording, which is
            // never submitted.
            let frame = count_if(counts, || unsafe {
                renderer
                    .prepare(cmd, &scene, None, frame)
                    .expect("prepares")
            });
            // SAFETY: as above; the rendering scope has one attachment of the renderer's format.
            unsafe { image.begin_rendering(cmd, [0.0; 4]) };
            // SAFETY: as above.
            unsafe { Drawer::new(device, cmd, None) }.viewport(area);
            // SAFETY: as above, inside the scope.
            count_if(counts, || unsafe {
                renderer.draw(cmd, [0.0, 0.0], &frame).expect("draws")
            });
            // SAFETY: as above.
            unsafe { image.end_rendering(cmd) };
            Err(Error::Invalid(NOT_SUBMITTED.into()))
        });
        match recorded {
            Err(Error::Invalid(text)) if text == NOT_SUBMITTED => {}
            other => other?,
        }
    }
    Ok(())
}

const NOT_SUBMITTED: &str = "recorded, and not meant to be submitted";

fn count_if<R>(counts: bool, work: impl FnOnce() -> R) -> R {
    if counts {
        counted_by_callgrind(work)
    } else {
        work()
    }
}

/// Callgrind counts the function of this name, and only in the thread that calls it, so that a CPU driver's threads do
/// not count.
#[inline(never)]
fn counted_by_callgrind<R>(work: impl FnOnce() -> R) -> R {
    black_box(work())
}
