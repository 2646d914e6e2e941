//! `rara bake`: scenes that show a cut in any viewer.

use std::path::PathBuf;

use clap::Args;
use rara::scene::{self, Annotations, Bounds, Format, SaveOptions};
use rara::{
    BakeCounts, BakeSettings, BakedGaussians, Camera, Clip, Gaussians, Layer, Mode, Placement,
    Scene, bake_layer,
};
use serde::Serialize;

use super::clip::{ClipArgs, Regions};
use super::compare::Measures;
use super::convert;
use super::failure::Failure;
use super::output::{self, ProgressLine, counted, grouped, say};
use super::pattern::{is_several, scene_files};
use super::residual::{Residual, ResidualView, residual};
use super::scenes::SceneArgs;
use super::settings::DeviceArgs;
use super::trained;
use super::values;
use rara::scene::layers::{LayerEntry, LayerRemains, SceneLayers, joined};
use rara_shots::UP;

/// Write a scene that shows a cut in any viewer
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  rara bake scene.ply -o cut.ply --clip plane:0,0,1,-2
  rara bake scene.ply -o core.ply --clip box:0,0,0,1,1,2 --json
  rara bake body.ply organ.ply -o both.ply --clip plane:1,0,0,0
  rara bake body.ply organ.ply -o cut_{{}}.ply --clip plane:1,0,0,0 --views 0
  rara bake scene.ply -o cut.spz --clip plane:z=40%

The extension of OUT chooses the format: {}. What the format cannot store is left out with a warning.

Gaussians outside the clip are dropped, and Gaussians that the clip leaves whole are kept. Each Gaussian that the clip cuts
is replaced by one with the mass, the mean and the covariance of its visible part. A Gaussian has no sharp edge, so a baked
cut is soft: in measurements, 12 to 17 % of the light of single cut splats was wrong. When splats were kept or dropped by
their centres instead, 35 % was wrong. The command prints a table of the differences between pictures of the baked scene and
of the exact cut. Baking the result again with the same clip changes nothing or almost nothing, unless --leave is above 1.

The compared pictures show the baked Gaussians before a format rounds them.

Several scenes are joined and baked as one. With {{}} in OUT, each scene is baked by itself, into a file with the scene's name in
place of {{}}.", Format::endings()))]
pub(super) struct Bake {
    /// File to write; its extension chooses the format; {} becomes the name of each SCENE
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Replace the splats that this mode would cut in a picture
    ///
    /// Mode hard cuts no splat: it keeps or drops each one as a whole, by its centre.
    #[arg(long, value_parser = values::named_but::<Mode>(Mode::None.name()), default_value = Mode::default().name())]
    mode: Mode,
    /// Mode rara: the radius of a splat's ellipsoid, in standard deviations [default: 3]
    ///
    /// A splat is cut if the clip cuts this ellipsoid, or the visible extent of the splat if that is larger.
    #[arg(long, value_name = "K", value_parser = values::positive, allow_hyphen_values = true)]
    sigma: Option<f32>,
    /// Number of Gaussians that replace each cut Gaussian, 1 to 3
    ///
    /// If there are 2 or 3, they lie side by side along the normal of the cut. They are thin, so they are too opaque from
    /// some sides and too faint from others. In measurements, baking with 2 instead of 1 changed the PSNR against the exact
    /// cut by +2 to -3 dB, depending on the scene. 3 were hardly ever better than 2. Bake with each number and compare the
    /// tables that the command prints.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=3))]
    children: u32,
    /// Leave a splat whole if the clip keeps it up to K standard deviations from its centre
    ///
    /// With K up to 1, baking the result again with the same clip replaces nothing, or only a few Gaussians if
    /// the clip is not convex. K of about 1.5 follows the cut most closely.
    #[arg(long, value_name = "K", default_value_t = 1.0, value_parser = values::not_negative, allow_hyphen_values = true)]
    leave: f32,
    /// Number of views in which the baked scene is compared with the exact cut
    ///
    /// The cameras stand around the scene. With 0, nothing is compared, and no device is needed.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(0..=360))]
    views: u32,
    /// Size of the pictures that are compared
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = values::size)]
    size: (u32, u32),
    /// The direction that is up in the views [default: what the scene's file says, or 0,-1,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    up: Option<glam::DVec3>,
    /// Print a report as JSON to standard output
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
    /// The number of Gaussians that were written with the nearest values of the format in place of their own.
    clamped: u64,
    files: Vec<PathBuf>,
    /// Notes of the formats: what they cannot store.
    notes: Vec<String>,
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
    annotations: Annotations,
    /// The direction that is up in it, where its scenes say so.
    up: Option<glam::DVec3>,
}

impl Bake {
    pub(super) fn run(self) -> Result<(), Failure> {
        let format =
            scene::saved_format(&self.output).map_err(|error| Failure::Usage(error.to_string()))?;
        let entries = self.scenes.entries()?;
        let clip = self.meant_clip(&entries)?;
        let names: Vec<_> = entries.iter().flat_map(LayerEntry::names).collect();
        let sources = entries.iter().map(|entry| entry.path.as_path());
        let paths = scene_files(&self.output, &names, sources)?;
        let mut loaded = self.scenes.load()?;
        clip.settle(&mut loaded)?;
        let clip = clip.clip(&loaded.scene())?;
        let is_merged = !is_several(&self.output);
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
        let mut outputs = outputs(&loaded, &paths, baked);
        // Baked Gaussians are others, and have no properties of their own; all files lose the same.
        let mut lost = loaded.extra.lost(format);
        let (mut clamped, mut notes) = (0, Vec::new());
        for output in &mut outputs {
            let annotations = std::mem::take(&mut output.annotations);
            let options = SaveOptions::default()
                .annotations(Some(annotations))
                .up(output.up);
            let written = convert::write(&output.path, &output.gaussians, &options, lost.take())?;
            clamped += written.0;
            notes.extend(written.1);
        }
        let gaussians = loaded.scene().gaussians();
        self.print((gaussians, counts), &outputs, (clamped, notes), residual)
    }

    /// The clip of the frame, where that or a layer's own may cut.
    fn meant_clip(&self, entries: &[LayerEntry]) -> Result<Regions, Failure> {
        let clip = self.clip.meant()?;
        if clip.is_empty() && !self.scenes.may_have_clips(entries) {
            return Err(no_clip());
        }
        Ok(clip)
    }

    /// Draws the exact cut, the cut by centres and the baked scene, and compares them.
    fn compare(
        &self,
        loaded: &SceneLayers,
        baked: &[BakedGaussians],
        clip: &Clip,
    ) -> Result<Residual, Failure> {
        let scene = loaded.scene();
        let stated = loaded.layers.iter().find_map(|layer| layer.up);
        let up = self.up.or(stated).unwrap_or(UP);
        let cameras = views(&scene, up, self.views, self.size)?;
        let layers = scene.layers().iter().zip(baked);
        let layers = layers
            .map(|(layer, baked)| Layer::new(layer.name(), &baked.gaussians).with(layer.state()));
        let baked: Scene<'_> = layers.collect();
        residual(&self.device.meant(), &scene, &baked, clip, &cameras)
    }

    fn print(
        &self,
        (gaussians, counts): (usize, BakeCounts),
        outputs: &[Output],
        (clamped, notes): (u64, Vec<String>),
        residual: Option<Residual>,
    ) -> Result<(), Failure> {
        let written = outputs.iter().map(|output| output.gaussians.len()).sum();
        for Output {
            path, gaussians, ..
        } in outputs
        {
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
                mode: self.mode.to_string(),
                gaussians,
                written,
                counts,
                clamped,
                files: outputs.iter().map(|output| output.path.clone()).collect(),
                notes,
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
    let is_each = loaded.layers.len() == paths.len();
    let mut before = 0;
    let remains = loaded.layers.iter().zip(baked).map(|(layer, baked)| {
        let count = layer.gaussians.len();
        let earlier = LayerRemains {
            numbers: None,
            count: before,
            gaussians: Gaussians::default(),
            sources: Vec::new(),
        };
        before += count;
        let own = LayerRemains {
            numbers: layer.numbers.clone(),
            count,
            gaussians: baked.gaussians,
            sources: baked.sources,
        };
        (earlier, own)
    });
    let output = |path: &PathBuf, remains: Vec<LayerRemains>, up| {
        let part = joined(remains);
        let mut annotations = loaded.annotations.clone();
        annotations.keep(&part.numbers);
        Output {
            path: path.clone(),
            gaussians: part.gaussians,
            annotations,
            up,
        }
    };
    if is_each {
        let each = paths.iter().zip(&loaded.layers).zip(remains);
        return each
            .map(|((path, layer), (earlier, own))| output(path, vec![earlier, own], layer.up))
            .collect();
    }
    let all = remains.map(|(_, own)| own).collect();
    let up = convert::up(loaded, &Placement::IDENTITY);
    vec![output(&paths[0], all, up)]
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
