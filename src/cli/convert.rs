//! `rara convert`: scenes from one format to another.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::{DQuat, DVec3};
use rara::scene::{self, Annotations, Clusters, Format, Part, SaveOptions};
use rara::{Clip, Gaussians, LayerState, Placement};
use serde::Serialize;
use serde_json::json;

use super::clip::{ClipArgs, Regions};
use super::failure::Failure;
use super::output::{self, counted, say};
use super::pattern::{is_several, scene_files};
use super::scenes::SceneArgs;
use super::{trained, up, values};
use rara::scene::layers::{FileNumbers, LayerRemains, LoadedLayer, SceneLayers, joined, without};
use rara_shots::UP;

/// Write a scene in another format
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  rara convert scene.ply -o scene.spz
  rara convert scene.sog -o scene.ply
  rara convert scene.ply -o core.compressed.ply --clip sphere:0,0,0,2 --min-opacity 0.01
  rara convert scan.ply -o clean.ply --min-opacity 0.05 --min-cluster 100
  rara convert scene.splat -o turned.glb --rotate 1,0,0,180 --scale 0.1 --move 0,1,0
  rara convert body.ply organ.ply -o both.sog --sh-degree 1
  rara convert body.ply organ.ply -o small_{{}}.spz

The extension of OUT chooses the format: {}. Several scenes are joined into one file. With {{}} in OUT, each scene is
converted by itself, into a file with the scene's name in place of {{}}. If a list of layers places or fades layers, their
Gaussians are written as placed and faded. Hidden layers are left out.

--clip and the other clip flags keep or drop whole Gaussians by their centres; `rara bake` cuts Gaussians. The order is --place,
the clip, --scale, --rotate, --move.", Format::endings()))]
pub(super) struct Convert {
    /// File to write; its extension chooses the format; {} becomes the name of each SCENE
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Leave out Gaussians with a smaller opacity, 0 to 1
    #[arg(long, value_name = "A", value_parser = values::share)]
    min_opacity: Option<f32>,
    /// Leave out floaters: Gaussians in clusters of fewer than N
    ///
    /// Gaussians of a layer that touch each other, also through a chain of others, are a cluster. Two Gaussians touch if their
    /// ellipsoids of two standard deviations do. Gaussians that --clip or --min-opacity removes do not connect others. To see the floaters
    /// first, draw the scene with --select 'floaters=cluster_size<N'.
    #[arg(long, value_name = "N")]
    min_cluster: Option<u32>,
    /// Leave out all but the largest cluster of each layer
    #[arg(long)]
    largest_cluster: bool,
    /// Leave out spherical harmonics above degree N, 0 to 3
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=3))]
    sh_degree: Option<u32>,
    /// Scale the scene about the origin
    #[arg(long, value_name = "K", value_parser = values::positive, allow_hyphen_values = true)]
    scale: Option<f32>,
    /// Turn the scene about the axis X,Y,Z through the origin, by DEGREES
    #[arg(long, value_name = "X,Y,Z,DEGREES", value_parser = values::turn, allow_hyphen_values = true)]
    rotate: Option<DQuat>,
    /// Move the scene by X,Y,Z world units
    #[arg(long = "move", value_name = "X,Y,Z", value_parser = values::vec3, allow_hyphen_values = true)]
    offset: Option<DVec3>,
    /// The version of a .spz file
    ///
    /// Older programs need version 2. Version 4 is compressed with zstd instead of gzip; programs from before 2026 cannot read it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=4))]
    #[arg(help = format!("The version of a .spz file [default: {}]", SaveOptions::default().spz_version))]
    spz_version: Option<u32>,
    /// Print a report as JSON to standard output
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
    floating: usize,
    lost: usize,
    written: usize,
    /// The number of Gaussians that were written with the least or greatest value of the format in place of their own.
    clamped: u64,
    sh_degree: u32,
    bytes: u64,
    notes: Vec<String>,
}

impl ConvertJson {
    /// Says to people what was left out and what was written.
    fn say(&self) {
        for (count, why) in [
            (self.hidden, "in hidden layers"),
            (self.clipped, "outside the clip"),
            (self.faint, "too faint"),
            (self.floating, "in small clusters"),
            (self.lost, "beyond single precision where they are placed"),
        ] {
            if count > 0 {
                say(format_args!(
                    "left out {} {why}",
                    counted(count as u64, "Gaussian")
                ));
            }
        }
        if self.written == 0 && self.gaussians > 0 {
            say(format_args!(
                "warning: {} is empty, because the flags leave out all {}; rara info prints the bounds of the scene, for a clip that \
                 keeps some of them",
                self.file.display(),
                counted(self.gaussians as u64, "Gaussian")
            ));
        }
        say(format_args!(
            "wrote {} of degree {} to {} ({}, {})",
            counted(self.written as u64, "Gaussian"),
            self.sh_degree,
            self.file.display(),
            self.format,
            counted(self.bytes, "byte")
        ));
    }
}

impl Convert {
    pub(super) fn run(self) -> Result<(), Failure> {
        let format =
            scene::saved_format(&self.output).map_err(|error| Failure::Usage(error.to_string()))?;
        if self.spz_version.is_some() && format != Format::Spz {
            return Err(Failure::Usage(format!(
                "--spz-version has no effect on {format}: name a .spz file, or leave --spz-version out"
            )));
        }
        let entries = self.scenes.entries()?;
        let scenes = match is_several(&self.output) {
            true => self.scenes.each()?,
            false => vec![(String::new(), self.scenes.clone())],
        };
        let names: Vec<_> = scenes.iter().map(|(name, _)| name.as_str()).collect();
        let sources = entries.iter().map(|entry| entry.path.as_path());
        let files = scene_files(&self.output, &names, sources)?;
        let placement = self.placement()?;
        let clip = self.clip.meant()?;
        let mut documents = Vec::new();
        for (file, (_, scenes)) in files.into_iter().zip(&scenes) {
            let document = self.convert(scenes, (file, format), (&clip, placement))?;
            document.say();
            documents.push(document);
        }
        match &documents[..] {
            _ if !self.json => Ok(()),
            [document] => Ok(output::json(document)?),
            documents => Ok(output::json(&json!({ "files": documents }))?),
        }
    }

    /// Writes a file of scenes.
    fn convert(
        &self,
        scenes: &SceneArgs,
        (file, format): (PathBuf, Format),
        (clip, placement): (&Regions, Placement),
    ) -> Result<ConvertJson, Failure> {
        let mut loaded = scenes.load_whole()?;
        clip.settle(&mut loaded)?;
        let clip = clip.clip(&loaded.scene())?;
        trained::check_alike(&loaded)?;
        let mut document = ConvertJson {
            file,
            format: format.to_string(),
            notes: std::mem::take(&mut loaded.notes),
            ..ConvertJson::default()
        };
        let mut taken = Vec::new();
        let up = up(&loaded, &placement);
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
        } = joined(taken);
        let mut annotations = std::mem::take(&mut loaded.annotations);
        annotations.keep(&numbers);
        let mut extra = std::mem::take(&mut loaded.extra);
        extra.keep(&numbers);
        let lost = whole.place(&placement);
        document.lost += lost.len();
        let left = without(&lost, whole.len() + lost.len());
        annotations.keep(&left);
        extra.keep(&left);
        if let Some(degree) = self.sh_degree.filter(|&degree| degree < whole.sh_degree()) {
            whole.set_sh_degree(degree);
        }
        let lost = extra.lost(format);
        let usual = SaveOptions::default();
        let version = self.spz_version.unwrap_or(usual.spz_version);
        let options = usual
            .spz_version(version)
            .annotations(Some(annotations))
            .properties(extra.properties)
            .up(up);
        let (clamped, notes) = write(&document.file, &whole, &options, lost)?;
        document.clamped = clamped;
        document.notes.extend(notes);
        document.written = whole.len();
        document.sh_degree = whole.sh_degree();
        document.bytes = std::fs::metadata(&document.file).map_or(0, |metadata| metadata.len());
        Ok(document)
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
    ) -> Result<(Option<FileNumbers>, Part), Failure> {
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
        if let Some(floats) = self.floats(&part.gaussians) {
            document.floating += floats.iter().filter(|floats| **floats).count();
            let part_of: Vec<u32> = floats.into_iter().map(u32::from).collect();
            let rest = part.gaussians.into_parts(&part_of, 2)?.swap_remove(0);
            part = Part {
                gaussians: rest.gaussians,
                numbers: numbered(rest.numbers, &part.numbers),
            };
        }
        if !lost.is_empty() {
            part.numbers = numbered(part.numbers, &without(&lost, count));
        }
        Ok((layer.numbers, part))
    }

    /// For each Gaussian whether its cluster is too small, where any is.
    fn floats(&self, gaussians: &Gaussians) -> Option<Vec<bool>> {
        (self.min_cluster.is_some() || self.largest_cluster).then(|| {
            let clusters = Clusters::of(gaussians);
            let least = self.min_cluster.unwrap_or(0);
            let floats = |index| {
                clusters.size_at(index) < least
                    || self.largest_cluster && !clusters.is_in_largest(index)
            };
            (0..gaussians.len()).map(floats).collect()
        })
    }
}

/// The numbers that those of a part have in what it is a part of.
fn numbered(mut part: Vec<u32>, of: &[u32]) -> Vec<u32> {
    part.iter_mut()
        .for_each(|number| *number = of[*number as usize]);
    part
}

/// Writes a scene in the format that the file's name says, and warns of all that the format cannot say, which follows, and of
/// what is `lost` anyway. The number is that of the Gaussians that were clamped.
pub(super) fn write(
    file: &Path,
    gaussians: &Gaussians,
    options: &SaveOptions,
    lost: Option<String>,
) -> Result<(u64, Vec<String>), Failure> {
    let format = scene::saved_format(file)?;
    let clamped = scene::save_with(file, gaussians, options)?;
    let words = options.annotations.as_ref();
    let notes = [
        trained::lost(format, gaussians.training()),
        lost_origin(format, gaussians),
        words.and_then(|words| lost_words(format, words)),
        lost,
        lost_up(format, options.up),
    ];
    let notes: Vec<String> = notes.into_iter().flatten().collect();
    for note in &notes {
        say(format_args!("warning: {note}"));
    }
    if clamped > 0 {
        say(format_args!(
            "note: {} had scales, colours or coefficients outside the range of {format}; each is written as the nearest value \
             that {format} can store",
            counted(clamped, "Gaussian")
        ));
    }
    Ok((clamped, notes))
}

/// The direction that is up in the file that is written, where that of its first layer says so.
pub(super) fn up(loaded: &SceneLayers, placement: &Placement) -> Option<DVec3> {
    let first = loaded.layers.iter().find(|layer| layer.state.visible)?;
    let turn = placement.rotation() * first.state.placement.rotation();
    Some(turn * first.up?)
}

/// The warning that a file of this format cannot say which direction is up, where that is not the one without a file's word.
fn lost_up(format: Format, up: Option<DVec3>) -> Option<String> {
    let is_axis = |up: DVec3| up.abs().max_element() > 1.0 - 1e-6;
    up.filter(|up| up.distance(UP) > 1e-6 && (format != Format::Ply || !is_axis(*up)))
        .map(|up| {
            let up = up::direction_text(up);
            format!("left out that {up} is up; draw the file with --up {up}")
        })
}

/// The warning that a file of this format cannot hold what the centres are counted from.
fn lost_origin(format: Format, gaussians: &Gaussians) -> Option<String> {
    let [x, y, z] = gaussians.origin().to_array();
    match format {
        _ if [x, y, z] == [0.0; 3] => None,
        Format::Ply | Format::Gltf => None,
        _ => Some(format!(
            "{format} stores precise centres only near zero, so they are written relative to ({x}, {y}, {z}); draw the file with \
             --place move:{x},{y},{z}"
        )),
    }
}

/// The warning that a file of this format has no room for what others say around their Gaussians.
fn lost_words(format: Format, annotations: &Annotations) -> Option<String> {
    (format != Format::Gltf && !annotations.is_silent()).then(|| {
        format!("{format} has no room for the names and extras of the glTF; a .glb keeps them")
    })
}
