//! Processes that the benchmark starts to measure them: this program again, with --child.

use std::env::current_exe;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use clap::ValueEnum;
use rara::ash::vk;
use rara::gpu::{Bindings, Drawer, ImageDesc};
use rara::{
    Clip, Error, Headless, Renderer, RendererDesc, Result, SceneBuffers, Settings, TargetFormat,
};

use crate::args::Args;
use crate::variant::{MODES, Variant};
use crate::world::{Source, World};

/// The work of the child process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Child {
    /// From nothing to the first picture; prints what each step took, milliseconds.
    Start,
    /// Loads the file; its instructions are counted.
    Load,
    /// Plans frames; their instructions are counted.
    Configure,
    /// Records frames; their instructions are counted.
    Record,
}

/// Frames that are counted, and those before them, which create the buffers and pipelines.
pub(crate) const FRAMES: u32 = 10;
const WARM_UP: u32 = 2;

/// This program on a scene file.
pub(crate) fn command(args: &Args, child: Child, file: &Path) -> Result<Vec<std::ffi::OsString>> {
    let program = current_exe().map_err(Error::io("/proc/self/exe"))?;
    let name = child.to_possible_value().expect("no child is hidden");
    let mut words = vec![
        program.into_os_string(),
        "--child".into(),
        name.get_name().into(),
    ];
    words.extend(["--scene".into(), file.into()]);
    words.extend(["--sizes".into(), args.size().to_string().into()]);
    if let Some(cameras) = &args.cameras {
        words.extend(["--cameras".into(), cameras.into()]);
    }
    if let Some(device) = args.desc().device {
        words.extend(["--device".into(), device.into()]);
    }
    Ok(words)
}

/// The command of such words.
pub(crate) fn process(words: &[std::ffi::OsString]) -> Command {
    let mut command = Command::new(&words[0]);
    command.args(&words[1..]);
    command
}

/// Does in the child process what `child` says.
pub(crate) fn run(child: Child, args: &Args) -> Result<()> {
    let source = Source::File(args.scenes[0].clone(), args.cameras.clone());
    match child {
        Child::Start => start(&source, args),
        Child::Load => {
            black_box(counted_by_callgrind(|| source.world()))?;
            Ok(())
        }
        Child::Configure | Child::Record => frames(child, &source.world()?, args),
    }
}

fn start(source: &Source, args: &Args) -> Result<()> {
    let mut clock = Instant::now();
    let mut step = |name| {
        println!("{name} {:.3}", clock.elapsed().as_secs_f64() * 1e3);
        clock = Instant::now();
    };
    let world = source.world()?;
    step("load");
    let mut headless = Headless::new(&args.desc())?;
    step("device");
    headless.load_as(&world.scene, Settings::default().precision.sh)?;
    step("upload");
    let (camera, settings) = (
        world.camera(0, args.size())?,
        Variant::auto(MODES[0]).settings,
    );
    headless.render(&camera, &Clip::default(), &settings)?;
    step("first picture");
    headless.render(&camera, &Clip::default(), &settings)?;
    step("second picture");
    Ok(())
}

/// Plans and records frames as an engine would, and submits none of them: the driver compiles a shader when it first
/// executes it, which must not be counted here, and takes minutes in a simulator.
fn frames(child: Child, world: &World, args: &Args) -> Result<()> {
    let headless = Headless::new(&args.desc())?;
    let device = headless.device();
    let format = TargetFormat::default().vulkan();
    let desc = RendererDesc::new(format).bindings(Bindings::suiting(device));
    let mut renderer = Renderer::new(device, desc)?;
    let variant = Variant::auto(MODES[3]);
    let scene = SceneBuffers::upload(device, &world.scene, variant.settings.precision.sh)?;
    let clip = world.halved()?;
    for index in 0..WARM_UP + FRAMES {
        let camera = world.camera(index, args.size())?;
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
        let counts = |what| index >= WARM_UP && child == what;
        let settings = &variant.settings;
        count_if(counts(Child::Configure), || {
            renderer.configure(&scene, &camera, &clip, settings)
        })?;
        let recorded = device.submit_and_wait(|cmd| {
            let counts = counts(Child::Record);
            // SAFETY: `cmd` is recording outside rendering; scene, image and renderer outlive the recording, which is
            // never submitted.
            count_if(counts, || unsafe {
                renderer.prepare(cmd, &scene).expect("prepares")
            });
            // SAFETY: as above; the rendering scope has one attachment of the renderer's format.
            unsafe { image.begin_rendering(cmd, [0.0; 4]) };
            // SAFETY: as above.
            unsafe { Drawer::new(device, cmd, None) }.viewport(area);
            // SAFETY: as above, inside the scope, after its prepare().
            count_if(counts, || unsafe {
                renderer.draw(cmd, [0.0, 0.0]).expect("draws")
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
