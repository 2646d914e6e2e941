//! Scene files to the layers of a scene.

use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::json_kind::{JsonKind, wanted};
use super::layer_names::{named, no_layer};
use super::output::{self, counted, say};
use super::pattern::filled;
use super::reading::{self, Watch};
use super::trained::TrainedOptions;
use super::{layer_clip, layer_look, place};
use clap::Args;
use rara::scene::Format;
use rara::scene::layers::{
    self, LayerEntry, SceneLayers, SelectionRequest, is_list, load_by, stem,
};

fn files() -> String {
    format!(
        "Scene files or folders; several become the layers of a scene; - is standard input\n\nThe formats are {}. A folder may \
         be an SOG scene, or one that a trainer wrote: rara then reads the scene with the most training steps. A layer has the \
         name of its file, or NAME if the file is given as NAME=FILE. For rara render, a pattern such as scene_{{:03}}.ply stands \
         for the scenes of a film: each picture shows the file with the next number.\n\nA .json file is a list of layers; \
         in each layer only path is required: {{\"layers\":[{{\"path\":\"skin.ply\",\"name\":\"skin\",\"opacity\":0.5, \
         \"visible\":true, \"antialiased\":true,\"low_pass\":0.3,\"position\":[x,y,z],\"rotation\":[w,x,y,z], \
         \"scale\":s or [x,y,z],\"clip\":{{...}} or \"clip_expr\":\"...\", \
         \"select\":[{{\"name\":\"vessels\",\"where\":\"label in 3,4\"}}]}}]}}",
        Format::readable()
    )
}

/// The flags that name the scene.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Layers")]
pub struct SceneArgs {
    /// Scene files or folders; several become the layers of a scene; - is standard input
    #[arg(value_name = "SCENE", required = true, help_heading = None, long_help = files())]
    files: Vec<PathBuf>,
    /// Move splats that match PREDICATE to a layer NAME (repeatable)
    ///
    /// PREDICATE compares a number of each splat by <, <=, >, >=, = or !=, as in opacity>0.5. The number may be opacity (from
    /// 0 to 1), size (the largest standard deviation), red, green or blue (the colour of degree 0, where 1 is full), cluster_size,
    /// or a property of the file by its name. Splats that touch each other, also through a chain of other splats, are a cluster,
    /// and cluster_size is the number of splats in it. If a property of the file has the same name as one of these words, such as
    /// size, write property(size) for the property.
    ///
    /// 'label in 3,4,7..9' is true if the number is in the list; 7..9 includes 7, 9 and everything between.
    /// 'inside(sphere:0,0,0,1)' is true if the centre is inside the shape; any expression for --clip-expr may stand there.
    /// Percentages, as in inside(plane:x=40%), are those of the bounds that the scene has before --place and --hide. and, or,
    /// not and ( ) combine predicates.
    ///
    /// NAME=PREDICATE takes splats from every file. LAYER/NAME=PREDICATE takes them from one layer, which may be an earlier
    /// selection. If several selections match a splat, the first one takes it.
    #[arg(long, value_name = "NAME=PREDICATE")]
    select: Vec<String>,
    /// Cut one layer by its own clip, not by --clip (repeatable)
    ///
    /// EXPRESSION is written as for --clip-expr. For this layer, it replaces the clip that --clip and the other clip flags make.
    /// The plane of a --section cuts the layer too. The words whole and frame may stand in place of EXPRESSION. With NAME=whole,
    /// only --clip-near and --clip-far cut the layer. With NAME=frame, --clip and the other clip flags cut the layer, even if a
    /// list of layers gives it a clip of its own.
    #[arg(long, value_name = "NAME=EXPRESSION")]
    layer_clip: Vec<String>,
    /// Multiply the opacities of one layer by a share, as in skin=40% (repeatable)
    ///
    /// SHARE is from 0 to 1, or from 0% to 100%. It replaces the opacity that a list of layers gives the layer.
    #[arg(long, value_name = "NAME=SHARE")]
    layer_opacity: Vec<String>,
    /// Mix a colour into one layer, as in bone=gold or bone=#ffe0c0:30% (repeatable)
    ///
    /// COLOUR:SHARE says how much of the colour is mixed in: SHARE is from 0 to 1, or from 0% to 100%. COLOUR alone is mixed in by
    /// half.
    #[arg(long, value_name = "NAME=COLOUR")]
    layer_tint: Vec<String>,
    /// Read opacities or scales of a .ply as plain values, not as logits or logarithms
    ///
    /// 3DGS stores opacities as logits, and scales as logarithms. Some programs store plain values instead: opacities from 0
    /// to 1, and scales in world units. A file does not say which of these it has. If all opacities or all scales are from 0
    /// to 1, rara prints a note that suggests this flag. The flag applies to all .ply files of the scene.
    #[arg(long, value_name = "opacity,scale", value_delimiter = ',', value_parser = ["opacity", "scale"])]
    activated: Vec<String>,
    #[command(flatten)]
    trained: TrainedOptions,
    /// Move, turn and scale a layer: 'move:X,Y,Z turn:X,Y,Z,DEGREES scale:S' (repeatable)
    ///
    /// PLACE has one or more of these three parts, in any order, with blanks between them. Whatever the order, the layer is
    /// scaled first, then turned about its own origin, then moved. turn has an axis and an angle; rotation:W,X,Y,Z may
    /// replace it by a quaternion. scale:X,Y,Z scales along each axis of the layer, and a negative number mirrors.
    ///
    /// NAME=PLACE places one layer; without NAME=, all layers are placed. PLACE replaces the position, rotation and scale
    /// that a list of layers gives the layer.
    #[arg(long, value_name = "[NAME=]PLACE")]
    place: Vec<String>,
    /// Hide a layer: neither draw nor write it (repeatable)
    #[arg(long, value_name = "NAME")]
    hide: Vec<String>,
    /// Show a layer that a list or project hides (repeatable)
    #[arg(long, value_name = "NAME")]
    unhide: Vec<String>,
}

impl SceneArgs {
    /// The layers that are named, of which none is read yet.
    pub(super) fn entries(&self) -> Result<Vec<LayerEntry>, Failure> {
        let mut entries = entries(&self.files)?;
        for text in &self.select {
            let flag = format!("--select {text}");
            let usage = |error| Failure::Usage(format!("{flag}: {error}"));
            let request: SelectionRequest = text.parse().map_err(usage)?;
            if !request.add_to(&mut entries) {
                let names = entries.iter().flat_map(LayerEntry::names);
                return Err(no_layer(&flag, &request.layer.unwrap_or_default(), names));
            }
        }
        Ok(entries)
    }

    /// Each of the scenes that are named by itself, with its name.
    pub(super) fn each(&self) -> Result<Vec<(String, Self)>, Failure> {
        let one = |file: &PathBuf| {
            let name = match &entries(std::slice::from_ref(file))?[..] {
                [only] => only.name.clone(),
                _ => stem(file),
            };
            let files = vec![file.clone()];
            Ok((
                name,
                Self {
                    files,
                    ..self.clone()
                },
            ))
        };
        self.files.iter().map(one).collect()
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
    pub fn places(&self) -> Vec<PathBuf> {
        let places = |typed: &PathBuf| {
            if typed.exists() && !is_list(typed) {
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
            ("--activated", &self.activated),
            antialiasing,
            low_pass,
            ("--place", &self.place),
            ("--layer-tint", &self.layer_tint),
        ];
        let all = all.into_iter();
        all.flat_map(|(flag, texts)| texts.iter().map(move |text| (flag, text.as_str())))
            .collect()
    }

    /// True when one of the layers that are named may have a clip of its own, once they are read.
    pub(super) fn may_have_clips(&self, entries: &[LayerEntry]) -> bool {
        !self.layer_clip.is_empty() || entries.iter().any(LayerEntry::has_clip)
    }

    pub fn load(&self) -> Result<SceneLayers, Failure> {
        self.load_watched(&mut |_| ())
    }

    /// Reads the files with all that they have of each Gaussian.
    pub(super) fn load_whole(&self) -> Result<SceneLayers, Failure> {
        self.load_with(true, &mut |_| ())
    }

    /// Reads the files, and tells how far it has come.
    pub(super) fn load_watched(&self, watch: Watch<'_>) -> Result<SceneLayers, Failure> {
        self.load_with(false, watch)
    }

    fn load_with(&self, is_whole: bool, watch: Watch<'_>) -> Result<SceneLayers, Failure> {
        let entries = self.entries()?;
        let mut loaded = load(entries, (&self.trained, &self.activated, is_whole), watch)?;
        place::apply(&self.place, &mut loaded)?;
        layer_look::apply(&self.layer_opacity, &self.layer_tint, &mut loaded)?;
        let flags = [
            ("--hide", &self.hide, false),
            ("--unhide", &self.unhide, true),
        ];
        for (flag, names, visible) in flags {
            for name in names {
                for layer in named(&mut loaded, flag, name)? {
                    layer.state = layer.state.visible(visible);
                }
            }
        }
        if !loaded.is_shown() {
            say("warning: all that has Gaussians is hidden; --unhide NAME shows a layer");
        }
        // Last, as a clip may lie at a share of what is visible, where it is placed.
        layer_clip::apply(&self.layer_clip, &mut loaded)?;
        Ok(loaded)
    }
}

/// Reads the layers that these files are or list, and tells how far it has come.
pub(super) fn load_files(paths: &[PathBuf], watch: Watch<'_>) -> Result<SceneLayers, Failure> {
    let flags = (&TrainedOptions::default(), &[][..], false);
    load(entries(paths)?, flags, watch)
}

fn entries(files: &[PathBuf]) -> Result<Vec<LayerEntry>, Failure> {
    let mut entries = Vec::new();
    for file in files {
        entries.extend(named_file(file)?);
    }
    Ok(entries)
}

/// Reads the files in order, and prints what had to be repaired. The flags say how layers were trained, which columns are stored as
/// they are, and whether all is read that the files have of each Gaussian.
fn load(
    entries: Vec<LayerEntry>,
    (trained, activated, is_whole): (&TrainedOptions, &[String], bool),
    watch: Watch<'_>,
) -> Result<SceneLayers, Failure> {
    tell_equal_names(&entries);
    let count = entries.len();
    let has = |column: &str| activated.iter().any(|one| one == column);
    let mut loaded = load_by(entries, is_whole, |entry, number, options| {
        let options = options.activated(has("opacity"), has("scale"));
        reading::read((entry, options), (number + 1, count), watch)
    })?;
    trained.apply(&mut loaded)?;
    for note in &loaded.notes {
        say(format_args!("note: {note}"));
    }
    Ok(loaded)
}

/// Says which names several files or parts of a file have. Selections of one name are meant to be one to its flags.
fn tell_equal_names(entries: &[LayerEntry]) {
    let mut names: Vec<_> = entries.iter().map(|entry| entry.name.as_str()).collect();
    names.sort_unstable();
    for alike in names.chunk_by(|a, b| a == b).filter(|all| all.len() > 1) {
        output::warn_once(format!(
            "note: {} are called '{}', and flags of that name mean all of them; NAME=FILE gives one another name",
            counted(alike.len() as u64, "layer"),
            alike[0]
        ));
    }
}

/// The layers of `FILE` or `NAME=FILE`, of which the first may be a list of layers. A file that exists goes before a name.
fn named_file(typed: &Path) -> Result<Vec<LayerEntry>, Failure> {
    let text = typed.to_string_lossy();
    let (name, path) = match text.split_once('=') {
        Some((name, path)) if !typed.exists() && !name.is_empty() => (Some(name), Path::new(path)),
        _ => (None, typed),
    };
    if let Some(name) = name
        && is_list(path)
    {
        return Err(Failure::Usage(format!(
            "{name}={}: a list of layers has names of its own; leave this one out",
            path.display()
        )));
    }
    let mut entries =
        layers::entries(path).map_err(|error| wanted(JsonKind::Scene, path, error))?;
    match (&mut entries[..], name) {
        ([entry], Some(name)) => entry.name = name.to_owned(),
        ([entry], None) if path == Path::new(output::STANDARD) => entry.name = "stdin".into(),
        (several, Some(name)) => {
            return Err(Failure::Usage(format!(
                "{name}={}: the file lists {} with names of their own; leave this one out",
                path.display(),
                counted(several.len() as u64, "layer")
            )));
        }
        _ => {}
    }
    Ok(entries)
}
