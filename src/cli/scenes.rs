//! Scene files to the layers of a scene.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::Error;

use super::failure::Failure;
use super::json_kind::JsonKind;
use super::output::say;
use super::pattern::filled;
use super::reading::{self, Watch};
use super::scene_file::{self, LayerEntry};
use super::scene_layers::SceneLayers;
use super::trained::TrainedOptions;
use super::{layer_clip, layer_place, place, select, trained, training, values};
use rara::scene::{Annotations, Format};

fn files() -> String {
    format!(
        "Scene files or a folder; - is standard input\n\nFormats: {}, or a folder of SOG; or a folder that training left, of \
         which the last iteration counts. Several files are the layers of one scene. rara render takes scene_{{:03}}.ply as the scenes of a film, one a picture. A layer has the name of its file, or a \
         name given as NAME=FILE. A .json file lists layers: \
         {{\"layers\":[{{\"path\":\"skin.ply\",\"name\":\"skin\",\"opacity\":0.5,\"visible\":true, \
         \"antialiased\":true,\"low_pass\":0.3,\"position\":[x,y,z],\"rotation\":[w,x,y,z],\"scale\":s or [x,y,z],\"clip\":{{...}} or \
         \"clip_expr\":\"...\", \"select\":[{{\"name\":\"vessels\",\"where\":\"label in 3,4\"}}]}}]}}",
        Format::readable()
    )
}

/// The flags that name the scene.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Layers")]
pub(super) struct SceneArgs {
    /// Scene files or a folder; - is standard input
    #[arg(value_name = "SCENE", required = true, help_heading = None, long_help = files())]
    files: Vec<PathBuf>,
    /// Make a layer of the splats that fulfil a predicate (repeatable)
    ///
    /// Predicates are opacity>0.5, size<0.01 (the largest standard deviation), red>0.6, green and blue (the colour
    /// of degree 0), 'label in 3,4,7..9' (any property of the file; property(NAME) if its name means something
    /// else) and 'inside(sphere:0,0,0,1)' (by the centre, in any expression as for --clip-expr), joined by and, or,
    /// not and ( ). Comparisons are < <= > >= = and !=. Shares, as in inside(plane:x=40%), are those of the scene's
    /// bounds as its files are listed, before --place and --hide. A selection takes from every file, or as
    /// LAYER/NAME=PREDICATE from one layer, what earlier selections have left.
    #[arg(long, value_name = "NAME=PREDICATE")]
    select: Vec<String>,
    /// Give one layer a clip of its own (repeatable)
    ///
    /// The clip is an expression as for --clip-expr, in place of the frame's clip; a --section cuts the layer as
    /// well. whole is a layer that nothing cuts. frame is a layer that the frame's clip cuts although its list says
    /// otherwise.
    #[arg(long, value_name = "NAME=EXPRESSION")]
    layer_clip: Vec<String>,
    #[command(flatten)]
    trained: TrainedOptions,
    /// Place a layer: move:X,Y,Z turn:X,Y,Z,DEGREES scale:S (repeatable)
    ///
    /// The place replaces what a list says of the layer. rotation:W,X,Y,Z is a quaternion in place of turn.
    /// scale:X,Y,Z scales along each axis, and a negative number mirrors. Blanks separate several. The layer is
    /// scaled, then turned about its own origin, then moved. Without NAME= all layers are placed.
    #[arg(long, value_name = "[NAME=]PLACE")]
    place: Vec<String>,
    /// Leave a layer out of the picture (repeatable)
    #[arg(long, value_name = "NAME")]
    hide: Vec<String>,
    /// Show a layer that its list hides (repeatable)
    #[arg(long, value_name = "NAME")]
    unhide: Vec<String>,
}

impl SceneArgs {
    /// The layers that are named, of which none is read yet.
    pub(super) fn entries(&self) -> Result<Vec<LayerEntry>, Failure> {
        let mut entries = entries(&self.files)?;
        for text in &self.select {
            select::add(&mut entries, text)?;
        }
        Ok(entries)
    }

    /// The scenes of a film, by number, where names of files have braces for it and there are such files; none where no name has.
    pub(super) fn moments(&self) -> Result<Vec<(usize, Self)>, Failure> {
        /// The greatest number that is looked for.
        const MOST: usize = 99_999;
        let is_pattern = |file: &&PathBuf| {
            !file.exists() && filled(file, 0, "{name}") != filled(file, 1, "{name}")
        };
        let Some(pattern) = self.files.iter().find(is_pattern) else {
            return Ok(Vec::new());
        };
        let numbered = |number: usize| {
            let fill = |file: &PathBuf| match is_pattern(&file) {
                true => filled(file, number, "{name}"),
                false => file.clone(),
            };
            let files: Vec<_> = self.files.iter().map(fill).collect();
            let is_there = |file: &PathBuf| {
                let named = entries(std::slice::from_ref(file)).unwrap_or_default();
                named.iter().all(|entry| entry.path.exists()) && !named.is_empty()
            };
            let are_there = files.iter().all(is_there);
            are_there.then(|| {
                (
                    number,
                    Self {
                        files,
                        ..self.clone()
                    },
                )
            })
        };
        let found: Vec<_> = (0..=MOST).filter_map(numbered).collect();
        match found.is_empty() {
            false => Ok(found),
            true => Err(Failure::Usage(format!(
                "{}: there is no file of that name with a number from 0 to {MOST} in place of the braces",
                pattern.display()
            ))),
        }
    }

    /// The places of the scenes: what was typed, or the files that it names.
    pub(super) fn places(&self) -> Vec<PathBuf> {
        let places = |typed: &PathBuf| {
            if typed.exists() && !scene_file::is_list(typed) {
                return vec![typed.clone()];
            }
            // What is wrong with them is said when they are read.
            let named = entries(std::slice::from_ref(typed)).unwrap_or_default();
            named.into_iter().map(|entry| entry.path).collect()
        };
        self.files.iter().flat_map(places).collect()
    }

    /// The flags that say what the layers are before anything changes them, with what was typed behind each.
    #[cfg(feature = "view")]
    pub(super) fn typed(&self) -> Vec<(&'static str, &str)> {
        let [antialiasing, low_pass] = self.trained.texts();
        let all = [
            ("--select", &self.select[..]),
            antialiasing,
            low_pass,
            ("--place", &self.place),
        ];
        let all = all.into_iter();
        all.flat_map(|(flag, texts)| texts.iter().map(move |text| (flag, text.as_str())))
            .collect()
    }

    /// True when one of the layers that are named may have a clip of its own, once they are read.
    pub(super) fn may_have_clips(&self, entries: &[LayerEntry]) -> bool {
        !self.layer_clip.is_empty() || entries.iter().any(LayerEntry::has_clip)
    }

    pub(super) fn load(&self) -> Result<SceneLayers, Failure> {
        self.load_watched(&mut |_| ())
    }

    /// Reads the files, and tells how far it has come.
    pub(super) fn load_watched(&self, watch: Watch<'_>) -> Result<SceneLayers, Failure> {
        let mut loaded = load(self.entries()?, &self.trained, watch)?;
        place::apply(&self.place, &mut loaded)?;
        let flags = [
            ("--hide", &self.hide, false),
            ("--unhide", &self.unhide, true),
        ];
        for (flag, names, visible) in flags {
            for name in names {
                for layer in loaded.named(flag, name)? {
                    layer.state = layer.state.visible(visible);
                }
            }
        }
        // Last, as a clip may lie at a share of what is visible, where it is placed.
        layer_clip::apply(&self.layer_clip, &mut loaded)?;
        Ok(loaded)
    }
}

/// Reads the layers that these files are or list, and tells how far it has come.
pub(super) fn load_files(paths: &[PathBuf], watch: Watch<'_>) -> Result<SceneLayers, Failure> {
    load(entries(paths)?, &TrainedOptions::default(), watch)
}

fn entries(files: &[PathBuf]) -> Result<Vec<LayerEntry>, Failure> {
    let mut entries = Vec::new();
    for file in files {
        entries.extend(named_file(file)?);
    }
    Ok(entries)
}

/// Reads the files in order, and prints what had to be repaired. `flags` say how layers were trained.
fn load(
    entries: Vec<LayerEntry>,
    flags: &TrainedOptions,
    watch: Watch<'_>,
) -> Result<SceneLayers, Failure> {
    let mut all = SceneLayers::default();
    let count = entries.len();
    let mut read = Vec::with_capacity(count);
    for (number, entry) in (1..).zip(entries) {
        let (mut loaded, properties) = reading::read(&entry, (number, count), watch)?;
        let stretch = entry.stretch.unwrap_or(DVec3::ONE);
        layer_place::stretch(&mut loaded.gaussians, stretch)
            .map_err(|error| Error::format(&entry.path, error.to_string()))?;
        read.push((entry, loaded, properties));
    }
    let files = read
        .iter()
        .map(|(entry, loaded, _)| (entry, &loaded.gaussians));
    let settled = scene_file::settled(files)?;
    let mut before = 0;
    for ((entry, mut loaded, properties), settled) in read.into_iter().zip(settled) {
        let path = &entry.path;
        let said = loaded.gaussians.training();
        let training = said.antialiased(entry.antialiased.unwrap_or(said.antialiased));
        let training = training.low_pass(entry.low_pass.unwrap_or(said.low_pass));
        let set = loaded.gaussians.set_training(training);
        set.map_err(|error| rara::Error::Invalid(format!("the layer '{}': {error}", entry.name)))?;
        let is_said = entry.antialiased.or(loaded.antialiased).is_some();
        let trained = (!is_said).then(|| trained::trained(path)).flatten();
        all.repaired += loaded.report.repaired;
        all.dropped += loaded.report.dropped;
        let lines = loaded.report.lines();
        all.notes.extend(
            lines
                .into_iter()
                .map(|line| format!("{}: {line}", path.display())),
        );
        let count = loaded.gaussians.len() as u32;
        let usual = || Annotations::of(&loaded.gaussians);
        all.annotations
            .append(loaded.annotations.unwrap_or_else(usual));
        let stretch = entry.stretch.unwrap_or(DVec3::ONE);
        let first = all.layers.len();
        all.add((entry, settled), loaded.gaussians, &properties, before)?;
        for layer in &mut all.layers[first..] {
            layer.format = Some(loaded.format);
            layer.stretch = stretch;
            layer.trained.clone_from(&trained);
        }
        before = before.saturating_add(count);
    }
    flags.apply(&mut all)?;
    for note in &all.notes {
        say(format_args!("note: {note}"));
    }
    Ok(all)
}

/// The layers of `FILE` or `NAME=FILE`, of which the first may be a list of layers. A file that exists goes before a name.
fn named_file(typed: &Path) -> Result<Vec<LayerEntry>, Failure> {
    let text = typed.to_string_lossy();
    let (name, path) = match text.split_once('=') {
        Some((name, path)) if !typed.exists() && !name.is_empty() => (Some(name), Path::new(path)),
        _ => (None, typed),
    };
    if scene_file::is_list(path) {
        return match name {
            Some(name) => Err(Failure::Usage(format!(
                "{name}={}: a list of layers has names of its own; leave this one out",
                path.display()
            ))),
            None => scene_file::read(path).map_err(|error| JsonKind::Scene.wanted(path, error)),
        };
    }
    let mut entry = LayerEntry::from_path(path);
    if let Some(trained) = training::scene_in(path)? {
        entry.path = trained;
    }
    if path == Path::new(values::STANDARD) {
        entry.name = "stdin".into();
    }
    entry.name = name.map_or(entry.name, str::to_owned);
    Ok(vec![entry])
}
