//! `rara bake`: scenes that show a cut in any viewer.

use std::path::PathBuf;

use clap::Args;
use rara::scene::{self, Bounds};
use rara::{
    BakeCounts, BakeSettings, BakedGaussians, Camera, Clip, Gaussians, Layer, Mode, Placement,
    Scene, bake_layer,
};
use serde::Serialize;

use super::clip::{ClipArgs, Regions};
use super::compare::Measures;
use super::failure::Failure;
use super::output::{self, ProgressLine, counted, grouped, say};
use super::residual::{Residual, ResidualView, residual};
use super::scene_file::LayerEntry;
use super::scene_layers::SceneLayers;
use super::scenes::SceneArgs;
use super::select::{self, LayerRemains};
use super::settings::DeviceArgs;
use super::trained;
use super::values::{self, name};

/// Write a scene that shows a cut in any viewer
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara bake scene.ply -o cut.ply --clip plane:0,0,1,-2
  rara bake scene.ply -o core.ply --clip box:0,0,0,1,1,2 --json
  rara bake body.ply organ.ply -o both.ply --clip plane:1,0,0,0
  rara bake body.ply organ.ply -o cut_{}.ply --clip plane:1,0,0,0 --views 0

Splats that lie outside are dropped, those that the clip leaves whole are kept, and each that it cuts is replaced by one
with the mass, the mean and the covariance of what is left. A splat has no edge, so that this is a preview: measured on
single cut splats, 12 to 17 % of their light is off, where dropping them by their centres is off by 35 %. The table says
how far the pictures of the baked scene are from the exact cut. Baking a baked scene again with the same clip changes
next to nothing.

Several scenes become one, as they are drawn together; with {} in OUT each is baked into a file of its own, with its name
in place of {}.")]
pub(super) struct Bake {
    /// The baked scene's file; {} becomes the name of each SCENE without its ending
    #[arg(short, long, value_name = "OUT.ply", value_parser = values::ply_path)]
    output: PathBuf,
    /// Cut what a frame of this mode cuts; hard cuts nothing
    ///
    /// With hard splats stay or go by their centres.
    #[arg(long, default_value = "exact")]
    mode: Mode,
    /// Mode rara: deviations of the ellipsoid that is traced [default: 3]
    ///
    /// A splat is cut if the ellipsoid is, or what shows of the splat, whichever is larger.
    #[arg(long, value_name = "K", value_parser = values::positive, allow_hyphen_values = true)]
    sigma: Option<f32>,
    /// Splats that stand for one that is cut, 1 to 3
    ///
    /// They stand side by side along the cut's normal. More follow the cut closer, but thin ones are too opaque
    /// from some sides: look at the table.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=3))]
    children: u32,
    /// A splat whose inner K deviations are kept stays whole
    ///
    /// Up to 1, baking again with the same clip cuts nothing again; about 1.5 follows the cut closest.
    #[arg(long, value_name = "K", default_value_t = 1.0, value_parser = values::not_negative, allow_hyphen_values = true)]
    leave: f32,
    /// Views around the scene in which the baked scene is compared
    ///
    /// It is compared with the exact cut; 0 skips that, and needs no device.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(0..=360))]
    views: u32,
    /// Size of the pictures that are compared
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = values::size)]
    size: (u32, u32),
    /// The direction that is up in the views
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    #[arg(default_value = "0,-1,0")]
    up: glam::DVec3,
    /// Print what was done as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    clip: ClipArgs,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

#[derive(Debug, Serialize)]
struct BakeJson {
    mode: String,
    /// Gaussians of all scenes, and of all files that were written.
    gaussians: usize,
    written: usize,
    counts: BakeCounts,
    files: Vec<PathBuf>,
    /// Against the exact cut, over all views; null without any.
    baked: Option<Measures>,
    /// The same of a clip by centres.
    hard: Option<Measures>,
    views: Vec<ResidualView>,
}

/// A file to be written: its layers' baked Gaussians.
struct Output {
    path: PathBuf,
    gaussians: Gaussians,
}

impl Bake {
    pub(super) fn run(self) -> Result<(), Failure> {
        let entries = self.scenes.entries()?;
        let clip = self.meant_clip(&entries)?;
        let paths = self.check_output(&entries)?;
        let mut loaded = self.scenes.load()?;
        clip.settle(&mut loaded)?;
        let clip = clip.clip(&loaded.scene())?;
        let is_merged = !self.output.to_string_lossy().contains("{}");
        if is_merged {
            trained::check_alike(&loaded)?;
        }
        // What --layer-clip says of a layer may also be that nothing cuts it.
        if clip.is_everything() && !loaded.has_clips() {
            return Err(no_clip());
        }

        let defaults = BakeSettings::default();
        let settings = defaults
            .mode(self.mode)
            .sigma(self.sigma.unwrap_or(defaults.sigma))
            .children(self.children)
            .leave(self.leave);
        let mut counts = BakeCounts::default();
        let mut baked: Vec<BakedGaussians> = Vec::new();
        let mut progress = ProgressLine::new("baking");
        let scene = loaded.scene();
        for (done, layer) in scene.layers().iter().enumerate() {
            progress.update(done as u64, scene.layers().len() as u64);
            let state = layer.state();
            if is_merged && !state.visible {
                baked.push(BakedGaussians::default());
                continue;
            }
            if is_merged && (state.placement != Placement::IDENTITY || state.opacity != 1.0) {
                return Err(Failure::Usage(format!(
                    "layer '{}' is placed or faded, which a merged file of Gaussians cannot say: put {{}} into -o, which \
                     bakes each layer by itself",
                    layer.name()
                )));
            }
            let layer = bake_layer(layer, &clip, &settings)?;
            counts += layer.counts;
            baked.push(layer);
        }
        drop(progress);

        // The comparison comes first: where it fails, nothing has been written.
        let residual = match self.views {
            0 => None,
            _ => Some(self.compare(&loaded, &baked, &clip)?),
        };
        let outputs = outputs(&loaded, &paths, baked);
        for output in &outputs {
            scene::save_ply(&output.path, &output.gaussians)?;
        }
        let gaussians = loaded.scene().gaussians();
        self.print(gaussians, counts, &outputs, residual)
    }

    /// The clip of the frame, where that or a layer's own may cut.
    fn meant_clip(&self, entries: &[LayerEntry]) -> Result<Regions, Failure> {
        let clip = self.clip.meant()?;
        if clip.is_empty() && !self.scenes.may_have_clips(entries) {
            return Err(no_clip());
        }
        if self.mode == Mode::None {
            return Err(Failure::Usage(
                "--mode none cuts nothing, so that there is nothing to bake; use exact, rara or hard".into(),
            ));
        }
        Ok(clip)
    }

    /// The files that `-o` means, one, or one for each scene. No scene is among them: it would be gone.
    fn check_output(&self, entries: &[LayerEntry]) -> Result<Vec<PathBuf>, Failure> {
        let pattern = self.output.to_str().filter(|text| text.contains("{}"));
        let paths: Vec<PathBuf> = match pattern {
            None => vec![self.output.clone()],
            Some(pattern) => {
                let names = entries.iter().flat_map(LayerEntry::names);
                names.map(|name| named(pattern, name)).collect()
            }
        };
        for (number, path) in paths.iter().enumerate() {
            if paths[..number].contains(path) {
                return Err(Failure::Usage(format!(
                    "two of the scenes would be written to {}; rename one, or leave {{}} out to merge them",
                    path.display()
                )));
            }
            let mut scenes = entries.iter().map(|entry| &entry.path);
            if let Some(scene) = scenes.find(|scene| output::is_same(scene, path)) {
                return Err(Failure::Usage(format!(
                    "{} is one of the scenes to bake, and writing it would replace {}; name another file",
                    path.display(),
                    scene.display()
                )));
            }
            output::check_file(path)?;
        }
        Ok(paths)
    }

    /// Draws the exact cut, the cut by centres and the baked scene, and compares them.
    fn compare(
        &self,
        loaded: &SceneLayers,
        baked: &[BakedGaussians],
        clip: &Clip,
    ) -> Result<Residual, Failure> {
        let scene = loaded.scene();
        let cameras = views(&scene, self.up, self.views, self.size)?;
        let layers = scene.layers().iter().zip(baked);
        let layers = layers
            .map(|(layer, baked)| Layer::new(layer.name(), &baked.gaussians).with(layer.state()));
        let baked: Scene<'_> = layers.collect();
        residual(&self.device.meant(), &scene, &baked, clip, &cameras)
    }

    fn print(
        &self,
        gaussians: usize,
        counts: BakeCounts,
        outputs: &[Output],
        residual: Option<Residual>,
    ) -> Result<(), Failure> {
        let written = outputs.iter().map(|output| output.gaussians.len()).sum();
        for Output { path, gaussians } in outputs {
            let count = counted(gaussians.len() as u64, "Gaussian");
            say(format_args!("wrote {count} to {}", path.display()));
            if gaussians.is_empty() {
                say("note: the clip keeps nothing of it; the file is a scene without Gaussians");
            }
        }
        let (baked, hard, views) = match residual {
            Some(mut residual) => {
                residual.compiled.take().into_iter().for_each(say);
                (Some(residual.baked), Some(residual.hard), residual.views)
            }
            None => (None, None, Vec::new()),
        };
        if self.json {
            return Ok(output::json(&BakeJson {
                mode: name(self.mode),
                gaussians,
                written,
                counts,
                files: outputs.iter().map(|output| output.path.clone()).collect(),
                baked,
                hard,
                views,
            })?);
        }
        print_counts(&counts);
        if let (Some(baked), Some(hard)) = (baked, hard) {
            say(format_args!(
                "\n{:<32} {:>9} {:>10} {:>9}",
                format!(
                    "against the exact cut, {}",
                    counted(views.len() as u64, "view")
                ),
                "PSNR, dB",
                "L1 of 255",
                "SSIM"
            ));
            for (what, m) in [
                ("baked, drawn without a clip", baked),
                ("clipped by centres", hard),
            ] {
                let (psnr, l1, ssim) = (m.psnr_text(), m.l1, m.ssim);
                say(format_args!("{what:<32} {psnr:>9} {l1:>10.4} {ssim:>9.5}"));
            }
        }
        Ok(())
    }
}

fn no_clip() -> Failure {
    let what = "there is no clip to bake: give --clip, --clip-expr, --clip-file, or --layer-clip with a region";
    Failure::Usage(what.into())
}

fn print_counts(counts: &BakeCounts) {
    let replaced = counts.cutoff - counts.left - counts.faint;
    let (children, left, faint) = (counts.children, counts.left, counts.faint);
    for (what, count, note) in [
        ("kept", counts.visible, String::new()),
        ("dropped", counts.invisible, String::new()),
        (
            "cut",
            counts.cutoff,
            format!(
                "{} replaced by {}, {} left whole, {} too faint to stay",
                grouped(replaced),
                grouped(children),
                grouped(left),
                grouped(faint)
            ),
        ),
    ] {
        let line = format!("{what:<8} {:>12}  {note}", grouped(count));
        say(line.trim_end());
    }
}

/// The files with what they hold: all in one, or one each.
fn outputs(loaded: &SceneLayers, paths: &[PathBuf], baked: Vec<BakedGaussians>) -> Vec<Output> {
    let gaussians = match paths.len() == baked.len() {
        true => baked.into_iter().map(|baked| baked.gaussians).collect(),
        false => {
            let taken = loaded.layers.iter().zip(baked);
            let taken = taken.map(|(layer, baked)| LayerRemains {
                numbers: layer.numbers.clone(),
                count: layer.gaussians.len(),
                gaussians: baked.gaussians,
                sources: baked.sources,
            });
            vec![select::joined(taken.collect()).gaussians]
        }
    };
    let outputs = paths.iter().cloned().zip(gaussians);
    outputs
        .map(|(path, gaussians)| Output { path, gaussians })
        .collect()
}

/// `pattern` with the layer's name in place of `{}`.
fn named(pattern: &str, layer: &str) -> PathBuf {
    PathBuf::from(pattern.replace("{}", &layer.replace(['/', '\\'], "_")))
}

/// Cameras around the scene, equally far apart, the first on the side from which a picture without a camera is taken.
fn views(
    scene: &Scene<'_>,
    up: glam::DVec3,
    count: u32,
    size: (u32, u32),
) -> Result<Vec<Camera>, Failure> {
    /// Vertical field of view, degrees, as that of `rara render`.
    const FOV_Y: f64 = 50.0;
    let bounds = Bounds::of(scene);
    let first = Camera::frame(&bounds, up, FOV_Y, size).map_err(Failure::usage)?;
    let centre = bounds.centre();
    let camera = |number: u32| {
        if number == 0 {
            return Ok(first);
        }
        let angle = std::f64::consts::TAU * f64::from(number) / f64::from(count);
        let turn = glam::DQuat::from_axis_angle(up.normalize(), angle);
        let eye = centre + turn * (first.eye - centre);
        Ok(Camera::look_at(eye, centre, up, FOV_Y, size)?)
    };
    (0..count).map(camera).collect()
}
