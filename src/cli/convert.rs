//! `rara convert`: scenes from one format to another.

use std::path::PathBuf;

use clap::Args;
use glam::{DQuat, DVec3};
use rara::scene::{self, Annotations, Part, SaveOptions};
use rara::{Clip, LayerState, Placement};
use serde::Serialize;

use super::clip::ClipArgs;
use super::failure::Failure;
use super::output::{self, counted, say};
use super::scene_layers::LoadedLayer;
use super::scenes::SceneArgs;
use super::select::{self, LayerRemains, Numbers};
use super::{trained, values};

/// Write a scene in another format
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  rara convert scene.ply -o scene.spz
  rara convert scene.sog -o scene.ply
  rara convert scene.ply -o core.compressed.ply --clip sphere:0,0,0,2 --min-opacity 0.01
  rara convert scene.splat -o turned.glb --rotate 1,0,0,180 --scale 0.1 --move 0,1,0
  rara convert body.ply organ.ply -o both.sog --sh-degree 1

OUT's name says the format; it ends in {}. Several scenes become one; where their list places, fades or hides layers, the Gaussians are
placed and faded, and hidden layers are left out.

--clip and the like keep whole Gaussians by their centres, in the space of the scene as it was read; `rara bake` cuts
them. After the clip, the scene is scaled, then turned, then moved.", scene::Format::endings()))]
pub(super) struct Convert {
    /// The file to write; its name says the format
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Leaves out what is less opaque
    #[arg(long, value_name = "A", value_parser = values::share)]
    min_opacity: Option<f32>,
    /// Leaves out spherical harmonics above a degree
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=3))]
    sh_degree: Option<u32>,
    /// Scales the scene about the origin
    #[arg(long, value_name = "K", value_parser = values::positive, allow_hyphen_values = true)]
    scale: Option<f32>,
    /// Turns the scene about an axis through the origin, by degrees
    #[arg(long, value_name = "X,Y,Z,DEGREES", value_parser = values::turn, allow_hyphen_values = true)]
    rotate: Option<DQuat>,
    /// Moves the scene
    #[arg(long = "move", value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true)]
    offset: Option<DVec3>,
    /// The version of a .spz file
    ///
    /// 2 is for older programs. 4 is compressed with zstd in place of gzip, and needs programs of 2026.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=4), default_value_t = SaveOptions::default().spz_version)]
    spz_version: u32,
    /// Print what was done as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    clip: ClipArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

#[derive(Debug, Default, Serialize)]
struct ConvertJson {
    file: PathBuf,
    format: String,
    /// Gaussians that were read, and of these what was left out and why; the rest was written.
    gaussians: usize,
    hidden: usize,
    clipped: usize,
    faint: usize,
    lost: usize,
    written: usize,
    /// The number of Gaussians that were written with the least or greatest value of the format in place of their own.
    clamped: u64,
    sh_degree: u32,
    bytes: u64,
    notes: Vec<String>,
}

impl Convert {
    pub(super) fn run(self) -> Result<(), Failure> {
        let format =
            scene::saved_format(&self.output).map_err(|error| Failure::Usage(error.to_string()))?;
        output::check_file(&self.output)?;
        for entry in self.scenes.entries()? {
            if output::is_same(&entry.path, &self.output) {
                return Err(Failure::Usage(format!(
                    "{} is one of the scenes to convert, and would be replaced; name another file",
                    self.output.display()
                )));
            }
        }
        let placement = self.placement()?;
        let clip = self.clip.meant()?;
        let mut loaded = self.scenes.load()?;
        clip.settle(&mut loaded)?;
        let clip = clip.clip(&loaded.scene())?;
        trained::check_alike(&loaded)?;
        let mut document = ConvertJson {
            file: self.output.clone(),
            format: format.to_string(),
            notes: std::mem::take(&mut loaded.notes),
            ..ConvertJson::default()
        };
        let mut taken = Vec::new();
        for layer in std::mem::take(&mut loaded.layers) {
            let count = layer.gaussians.len();
            document.gaussians += count;
            let (numbers, part) = if layer.state.visible {
                self.kept(layer, &clip, &mut document)?
            } else {
                document.hidden += count;
                (layer.numbers, Part::default())
            };
            taken.push(LayerRemains {
                numbers,
                count,
                gaussians: part.gaussians,
                sources: part.numbers,
            });
        }
        let Part {
            gaussians: mut whole,
            numbers,
        } = select::joined(taken);
        let mut annotations = std::mem::take(&mut loaded.annotations);
        annotations.keep(&numbers);
        let lost = whole.place(&placement);
        document.lost += lost.len();
        annotations.keep(&select::without(&lost, whole.len() + lost.len()));
        if let Some(degree) = self.sh_degree.filter(|&degree| degree < whole.sh_degree()) {
            whole.set_sh_degree(degree);
        }
        let lost_words = lost_words(format, &annotations);
        let options = SaveOptions::default()
            .spz_version(self.spz_version)
            .annotations(Some(annotations));
        document.clamped = scene::save_with(&self.output, &whole, &options)?;
        let notes = [
            trained::lost(format, whole.training()),
            lost_origin(format, &whole),
            lost_words,
        ];
        for note in notes.into_iter().flatten() {
            say(format_args!("warning: {note}"));
            document.notes.push(note);
        }
        document.written = whole.len();
        document.sh_degree = whole.sh_degree();
        document.bytes = std::fs::metadata(&self.output).map_or(0, |metadata| metadata.len());
        self.print(&document)
    }

    fn placement(&self) -> Result<Placement, Failure> {
        let (position, turn) = (
            self.offset.unwrap_or_default(),
            self.rotate.unwrap_or(DQuat::IDENTITY),
        );
        Ok(Placement::new(
            position,
            turn,
            self.scale.unwrap_or(1.0).into(),
        )?)
    }

    /// What a layer keeps of the frame's clip or its own, in the scene's space, and its numbers in its file.
    fn kept(
        &self,
        layer: LoadedLayer,
        clip: &Clip,
        document: &mut ConvertJson,
    ) -> Result<(Option<Numbers>, Part), Failure> {
        let LayerState {
            placement, opacity, ..
        } = layer.state;
        let own = layer.clip.as_ref().map(|own| own.clip());
        let clip = own.as_ref().unwrap_or(clip);
        let mut gaussians = layer.gaussians;
        let count = gaussians.len();
        let lost = gaussians.place(&placement);
        document.lost += lost.len();
        gaussians
            .opacities_mut()
            .iter_mut()
            .for_each(|own| *own *= opacity);
        let least = self.min_opacity.unwrap_or(0.0);
        let mut part_of = Vec::with_capacity(gaussians.len());
        for (index, own) in gaussians.opacities().iter().enumerate() {
            let is_clipped = !clip.keeps(gaussians.centre(index));
            let is_faint = !is_clipped && *own < least;
            document.clipped += usize::from(is_clipped);
            document.faint += usize::from(is_faint);
            part_of.push(u32::from(is_clipped || is_faint));
        }
        let mut part = gaussians.into_parts(&part_of, 2)?.swap_remove(0);
        if !lost.is_empty() {
            let left = select::without(&lost, count);
            part.numbers
                .iter_mut()
                .for_each(|number| *number = left[*number as usize]);
        }
        Ok((layer.numbers, part))
    }

    fn print(&self, document: &ConvertJson) -> Result<(), Failure> {
        if self.json {
            return Ok(output::json(document)?);
        }
        for (count, why) in [
            (document.hidden, "in hidden layers"),
            (document.clipped, "outside the clip"),
            (document.faint, "too faint"),
            (
                document.lost,
                "beyond single precision where they are placed",
            ),
        ] {
            if count > 0 {
                say(format_args!(
                    "left out {} {why}",
                    counted(count as u64, "Gaussian")
                ));
            }
        }
        if document.clamped > 0 {
            say(format_args!(
                "note: of {} scales, colours or coefficients are beyond what {} holds, and the nearest that it does now",
                counted(document.clamped, "Gaussian"),
                document.format
            ));
        }
        say(format_args!(
            "wrote {} of degree {} to {} ({}, {})",
            counted(document.written as u64, "Gaussian"),
            document.sh_degree,
            document.file.display(),
            document.format,
            counted(document.bytes, "byte")
        ));
        Ok(())
    }
}

/// The warning that a file of this format cannot hold what the centres are counted from.
fn lost_origin(format: scene::Format, gaussians: &rara::Gaussians) -> Option<String> {
    let [x, y, z] = gaussians.origin().to_array();
    match format {
        _ if [x, y, z] == [0.0; 3] => None,
        scene::Format::Ply | scene::Format::Gltf => None,
        _ => Some(format!(
            "{format} holds centres near zero only, so they are written as counted from ({x}, {y}, {z}); draw the file with \
             --place move:{x},{y},{z}"
        )),
    }
}

/// The warning that a file of this format has no room for what others say around their Gaussians.
fn lost_words(format: scene::Format, annotations: &Annotations) -> Option<String> {
    (format != scene::Format::Gltf && !annotations.is_silent()).then(|| {
        format!("{format} has no room for the names and extras of the glTF; a .glb keeps them")
    })
}
