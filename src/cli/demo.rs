//! `rara demo`: one scene, one plane through its middle, four modes, side by side and measured.

use std::path::PathBuf;

use clap::Args;
use rara::scene;
use rara::{
    Camera, Clip, ClipOp, Decay, ExactForm, FrameStats, Mode, Picture, Plane, Scene, Settings,
};
use rara_reference::comparison::compare;
use rara_reference::maps;

use super::camera::CameraArgs;
use super::combine::{Combine, combine};
use super::compare::{Measures, over};
use super::failure::Failure;
use super::memory;
use super::output::{self, counted, grouped, say};
use super::scenes;
use super::session::Session;
use super::settings::{DeviceArgs, LookArgs};
use super::sheet::{self, Sheet};
use super::times;
use super::values;
use rara::scene::layers::SceneLayers;

/// Cut a scene through its middle, draw it in all four modes, and measure their errors
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara demo -o out
  rara demo scene.ply -o out --cameras cameras.json --view 3

The command writes none.png, hard.png, rara.png, exact.png and sheet.png. The sheet shows all four pictures, and magnifies the
part in which hard and exact differ most. In the table, \"own\" compares the picture with the same mode computed in double
precision on the CPU, and \"truth\" compares it with the exact cut.")]
pub(super) struct Demo {
    /// Scene files, the layers of one scene [default: a generated scene]
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Folder for the pictures; created if it does not exist
    #[arg(short, long, value_name = "DIR", value_parser = values::one_file(), default_value = "out")]
    output: PathBuf,
    /// Do not compute the reference in double precision, which takes long for large scenes
    #[arg(long)]
    no_reference: bool,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    look: LookArgs,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Frames of each mode, whose median is shown.
const FRAMES: u32 = 5;

/// How much larger the sheet shows a piece of each picture.
const ZOOM: u32 = 6;

/// Colour behind the pictures.
const PAPER: [f32; 3] = [1.0; 3];

struct Shot {
    mode: Mode,
    settings: Settings,
    picture: Picture,
    stats: FrameStats,
}

impl Demo {
    pub(super) fn run(self) -> Result<(), Failure> {
        let look = self.look.meant();
        let views = self.camera.meant(&self.scenes)?.single("a demo")?;
        output::make_folder(&self.output)?;
        let loaded = if self.scenes.is_empty() {
            made_up()
        } else {
            scenes::load_files(&self.scenes, &mut |_| ())?
        };
        let scene = loaded.scene();
        let camera = views.in_scene(&scene)?.remove(0).camera;
        let clip = Clip::of([middle(&scene, &camera)?], ClipOp::And);

        memory::check_picture((camera.width, camera.height), 0)?;
        let mut session = Session::open(&self.device.meant(), &scene, look.precision.sh)?;
        let (device, driver) = (session.headless.device_name(), session.headless.driver());
        let count = counted(scene.gaussians() as u64, "Gaussian");
        say(format_args!(
            "{device} ({driver}); {count}, {}x{}",
            camera.width, camera.height
        ));
        let all = Mode::ALL.iter().map(|&mode| look.mode(mode));
        let all: Vec<Settings> = all.collect();
        // One after the other: each is drawn once before any is measured.
        for settings in &all {
            session.warm_up([(&camera, &clip, settings)])?;
        }
        // In turn, so that other work on the machine disturbs all of them alike.
        let mut frames = vec![Vec::new(); all.len()];
        for _ in 0..FRAMES {
            for (settings, frames) in all.iter().zip(&mut frames) {
                frames.push(session.fresh(&camera, &clip, settings)?);
            }
        }
        let mut shots = Vec::new();
        for (settings, frames) in all.into_iter().zip(&frames) {
            let picture = session.picture(&camera, &clip, &settings)?;
            shots.push(Shot {
                mode: settings.mode,
                settings,
                picture,
                stats: combine(frames, Combine::Median),
            });
        }
        let usual = times::sum(shots.iter().map(|shot| shot.stats.wall_ms)) / shots.len() as f64;
        let compiled = output::compiled(session.first_use_ms(usual), session.has_kept());
        session.headless.close()?;
        for Shot { mode, picture, .. } in &shots {
            over(picture, PAPER).save(self.output.join(format!("{}.png", mode)))?;
        }
        let [_, hard, _, exact] = [0, 1, 2, 3].map(|index| &shots[index].picture);
        let piece = hard.width.max(hard.height).div_ceil(ZOOM);
        let corner = maps::worst_square(hard, exact, piece)?;
        let size = (hard.width, 2 * hard.height + sheet::GAP);
        let count = shots.len() as u32;
        let mut sheet = Sheet::new(size, count, count)?;
        for shot in &shots {
            let magnified = with_piece(&over(&shot.picture, PAPER), corner);
            sheet.add(shot.mode.name(), &magnified);
        }
        sheet.picture().save(self.output.join("sheet.png"))?;
        compiled.into_iter().for_each(say);
        print_frames(&shots);
        if !self.no_reference {
            print_errors(&shots, &scene, &camera, &clip)?;
        }
        Ok(())
    }
}

/// A picture, and below it a piece of it, whose left and top are `corner`, in the picture's size.
fn with_piece(picture: &Picture, corner: [u32; 2]) -> Picture {
    let (width, height) = (picture.width, picture.height);
    let mut piece = Picture::filled(width, height, sheet::MARGIN);
    for (index, pixel) in piece.pixels.iter_mut().enumerate() {
        let (x, y) = (index as u32 % width, index as u32 / width);
        *pixel = picture.at(corner[0] + x / ZOOM, corner[1] + y / ZOOM);
    }
    let mut both = Picture::filled(width, 2 * height + sheet::GAP, sheet::MARGIN);
    sheet::paste(&mut both, picture, [0, 0]);
    sheet::paste(&mut both, &piece, [0, height + sheet::GAP]);
    both
}

/// The scene that is drawn if no file is given.
fn made_up() -> SceneLayers {
    let gaussians = scene::generate(scene::Kind::General, 60_000, 1);
    SceneLayers::made_up("demo", gaussians)
}

/// A plane that shows the camera the cut: it takes away what is near and to the left, which is half of the Gaussians.
pub fn middle(scene: &Scene<'_>, camera: &Camera) -> rara::Result<Plane> {
    let normal = camera.rotation.row(0) * 0.8 + camera.rotation.row(2) * 0.6;
    let layers = scene.layers().iter();
    let centres = layers.flat_map(|layer| layer.gaussians().positions());
    let mut along: Vec<f64> = centres.map(|p| normal.dot(p.as_dvec3())).collect();
    along.sort_unstable_by(f64::total_cmp);
    // The plane goes between two centres: through one, rounding would decide whether a hard clip keeps it.
    let upper = along.get(along.len() / 2).unwrap_or(&0.0);
    let lower = along
        .get((along.len() / 2).saturating_sub(1))
        .unwrap_or(upper);
    Plane::new(normal, -(lower + upper) / 2.0)
}

fn print_frames(shots: &[Shot]) {
    say(format_args!(
        "\n{:<6} {:>10} {:>10} {:>10} {:>10} {:>9}  ms a stage; medians of {FRAMES} frames",
        "mode", "visible", "cutoff", "invisible", "culled", "ms"
    ));
    for Shot { mode, stats, .. } in shots {
        let c = stats.counts;
        let [visible, cut, clipped, culled] =
            [c.visible, c.cutoff, c.invisible, c.culled].map(|n| grouped(n.into()));
        say(format_args!(
            "{:<6} {visible:>10} {cut:>10} {clipped:>10} {culled:>10} {:>9}  {}",
            mode,
            times::ms(stats.gpu_ms, 2),
            times::stages(stats, 2).join(", ")
        ));
    }
}

/// Prints the errors: each picture against its own mode in f64, and the cuts against the exact cut.
fn print_errors(
    shots: &[Shot],
    scene: &Scene<'_>,
    camera: &Camera,
    clip: &Clip,
) -> Result<(), Failure> {
    say("\nmeasuring against the double-precision reference on the CPU ...");
    let render =
        |settings: &Settings| rara_reference::render::<f64>(scene, camera, clip, settings).picture;
    let exact = shots[0]
        .settings
        .mode(Mode::Exact)
        .decay(Some(Decay::Depth))
        .form(ExactForm::Beam);
    let truth = render(&exact);
    say(format_args!(
        "{:<6} {:>11} {:>10} {:>10}   {:>11} {:>10} {:>10}",
        "mode", "own: PSNR", "L1", "largest", "truth: PSNR", "L1", "largest"
    ));
    for Shot {
        mode,
        settings,
        picture,
        ..
    } in shots
    {
        let own = columns(&compare(picture, &render(settings))?.into());
        let cut = match mode {
            Mode::None => String::new(), // Nothing is cut, so there is nothing to be exact about.
            _ => columns(&compare(picture, &truth)?.into()),
        };
        say(format_args!("{:<6} {own}   {cut}", mode)
            .to_string()
            .trim_end());
    }
    Ok(())
}

fn columns(measures: &Measures) -> String {
    format!(
        "{:>11} {:>10.5} {:>10.2}",
        measures.psnr_text(),
        measures.l1,
        measures.max
    )
}
