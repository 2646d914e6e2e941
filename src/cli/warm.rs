//! `rara warm`: shaders compiled before a picture waits for them.

use clap::Args;
use glam::DVec3;
use rara::clip::Expression;
use rara::scene::{Bounds, Kind, generate};
use rara::{Aov, Camera, Clip, Error, Mode, Raster, Scene, Settings, ShFormat};

use super::failure::Failure;
use super::output::{ProgressLine, say};
use super::session::Session;
use super::settings::DeviceArgs;

/// Compile the shaders in advance, for example in a container image or on a cluster node
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara warm
  RARA_CACHE=/var/cache/rara rara warm --all

The command compiles the shaders of the default mode for four kinds of pictures: without a clip, cut by a plane, cut by a
curved shape, and cut by several shapes. It also compiles the shaders of the channels of --aov. It stores the compiled shaders
in the folder that the environment variable RARA_CACHE names, or in folders of rara and of the driver in the user's cache.")]
pub(super) struct Warm {
    /// Also compile the shaders of all other modes, --raster paths and --sh-format choices
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    device: DeviceArgs,
}

/// The clips whose frames differ in their shaders.
const CLIPS: [Option<&str>; 4] = [
    None,
    Some("plane:0,0,1,0"),
    Some("sphere:0,0,0,1"),
    Some("all(box:0,0,0,1,1,1, not(sphere:0.5,0,0,0.5))"),
];

impl Warm {
    pub(super) fn run(self) -> Result<(), Failure> {
        let gaussians = generate(Kind::General, 500, 1);
        let scene = Scene::from(&gaussians);
        let up = -DVec3::Y;
        let camera = Camera::frame(&Bounds::of(&gaussians), up, 50.0, (64, 64))?;
        let usual = Settings::default();
        let sh = usual.precision.sh;
        let mut session = Session::open(&self.device.meant(), &scene, sh)?;
        let frames = self.frames()?;
        let mut progress = ProgressLine::new("compiling shaders");
        for (done, (stored, clip, settings)) in frames.iter().enumerate() {
            progress.update(done as u64, frames.len() as u64 + 1);
            session.headless.load_as(&scene, *stored)?;
            match session.fresh(&camera, clip, settings) {
                // A device without mesh shaders, say, has none to compile.
                Err(Error::Device(why)) if settings.raster != Raster::Auto => {
                    say(format_args!("note: {why}"));
                }
                drawn => drop(drawn?),
            }
        }
        session.headless.load_as(&scene, sh)?;
        for text in CLIPS {
            let clip = clip(text)?;
            let frame = (&camera, &clip, &usual);
            session.headless.channels(Aov::ALL, frame)?;
        }
        drop(progress);
        let (seconds, kept) = (session.first_use_ms(0.0) / 1e3, session.has_kept());
        session.headless.close()?;
        let before = if kept {
            "; an earlier run had kept some"
        } else {
            ""
        };
        say(format_args!("compiled shaders: {seconds:.1} s{before}"));
        Ok(())
    }

    /// The frames that need all of the shaders, each with how the scene's spherical harmonics are stored.
    fn frames(&self) -> Result<Vec<(ShFormat, Clip, Settings)>, Failure> {
        let clips = CLIPS.into_iter().map(clip).collect::<Result<Vec<_>, _>>()?;
        let settings = Settings::default();
        let usual = clips
            .iter()
            .map(|clip| (settings.precision.sh, clip.clone(), settings));
        let mut frames: Vec<_> = usual.collect();
        if self.all {
            for mode in Mode::ALL {
                for raster in Raster::ALL {
                    let settings = settings.mode(*mode).raster(*raster);
                    let of_mode = clips
                        .iter()
                        .map(|clip| (settings.precision.sh, clip.clone(), settings));
                    frames.extend(of_mode);
                }
            }
            for sh in ShFormat::ALL {
                for degree in 0..=3 {
                    frames.push((*sh, clips[1].clone(), settings.sh_degree(Some(degree))));
                }
            }
        }
        Ok(frames)
    }
}

/// The clip of an expression; none is everything.
fn clip(text: Option<&str>) -> rara::Result<Clip> {
    Ok(match text {
        Some(text) => text.parse::<Expression>()?.clip(),
        None => Clip::default(),
    })
}
