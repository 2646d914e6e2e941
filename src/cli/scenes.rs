//! Scene files to the layers of a scene.

use std::path::{Path, PathBuf};

use clap::Args;
use rara::{Gaussians, Layer, LayerState};

use super::failure::Failure;
use super::output::{Progress, say};
use super::scene_file::{self, LayerClip, LayerEntry};
use rara::scene;

/// The flags that name the scene.
#[derive(Debug, Args)]
pub(super) struct SceneArgs {
    /// Scene files (3DGS .ply); several are the layers of one scene, each called by its file's name or as in NAME=FILE. A
    /// .json file lists layers: {"layers":[{"path":"skin.ply","name":"skin","opacity":0.5,"visible":true,
    /// "position":[x,y,z],"rotation":[w,x,y,z],"scale":s,"clip":{...} or "clip_expr":"..."}]}
    #[arg(value_name = "SCENE", required = true)]
    files: Vec<PathBuf>,
    /// The clip of one layer in place of the frame's (repeatable): an expression as for --clip-expr, whole for a layer
    /// that no clip cuts, or frame for one that the frame's cuts although its list gives it another
    #[arg(long, value_name = "NAME=EXPRESSION")]
    layer_clip: Vec<String>,
    /// Leaves a layer out of the picture (repeatable)
    #[arg(long, value_name = "NAME")]
    hide: Vec<String>,
    /// Shows a layer that its list hides (repeatable)
    #[arg(long, value_name = "NAME")]
    unhide: Vec<String>,
}

impl SceneArgs {
    /// The layers that are named, of which none is read yet.
    pub(super) fn entries(&self) -> Result<Vec<LayerEntry>, Failure> {
        entries(&self.files)
    }

    /// True when one of the layers that are named is given a clip of its own.
    pub(super) fn has_clips(&self, entries: &[LayerEntry]) -> bool {
        !self.layer_clip.is_empty() || entries.iter().any(|entry| entry.clip.is_some())
    }

    /// Reads the files.
    pub(super) fn load(&self) -> Result<Loaded, Failure> {
        let mut loaded = load(self.entries()?)?;
        for text in &self.layer_clip {
            // A name may hold the sign that ends it.
            let signs: Vec<usize> = text.match_indices('=').map(|(at, _)| at).collect();
            let of_a_layer = |at: &&usize| loaded.layers.iter().any(|l| l.name == text[..**at]);
            let Some(&at) = signs.iter().find(of_a_layer).or(signs.first()) else {
                return Err(Failure::Usage(format!(
                    "--layer-clip {text}: expected NAME=EXPRESSION, as in skin=plane:1,0,0,0"
                )));
            };
            let (name, region) = (&text[..at], &text[at + 1..]);
            let clip = match region.trim() {
                "frame" => None,
                region => Some(
                    LayerClip::parse(region)
                        .map_err(|error| Failure::Usage(format!("--layer-clip {name}: {error}")))?,
                ),
            };
            for layer in loaded.named("--layer-clip", name)? {
                layer.clip = clip.clone();
            }
        }
        for name in &self.hide {
            for layer in loaded.named("--hide", name)? {
                layer.state = layer.state.visible(false);
            }
        }
        for name in &self.unhide {
            for layer in loaded.named("--unhide", name)? {
                layer.state = layer.state.visible(true);
            }
        }
        Ok(loaded)
    }
}

/// A layer that has been read.
pub(super) struct LoadedLayer {
    /// What it is called.
    pub(super) name: String,
    pub(super) gaussians: Gaussians,
    pub(super) state: LayerState,
    /// Its own clip.
    pub(super) clip: Option<LayerClip>,
    /// Whether it is visible and has a clip of its own before any flag says otherwise.
    #[cfg_attr(not(feature = "view"), allow(dead_code))]
    pub(super) listed: Listed,
}

/// What the list of a scene's layers says of one, in so far as flags may say otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "view"), allow(dead_code))]
pub(super) struct Listed {
    pub(super) visible: bool,
    pub(super) clipped: bool,
}

/// One or more scene files.
pub(super) struct Loaded {
    pub(super) layers: Vec<LoadedLayer>,
    /// Gaussians that had a field put right.
    pub(super) repaired: u64,
    /// Gaussians that could not be used.
    pub(super) dropped: u64,
    /// The loader's reports, a line each.
    pub(super) notes: Vec<String>,
}

impl Loaded {
    /// Gaussians that come from no file.
    pub(super) fn made_up(name: &str, gaussians: Gaussians) -> Self {
        Self {
            layers: vec![LoadedLayer {
                name: name.to_owned(),
                gaussians,
                state: LayerState::default(),
                clip: None,
                listed: Listed {
                    visible: true,
                    clipped: false,
                },
            }],
            repaired: 0,
            dropped: 0,
            notes: Vec::new(),
        }
    }

    /// The scene of the layers.
    pub(super) fn scene(&self) -> rara::Scene<'_> {
        let layers = self.layers.iter().map(|layer| {
            let made = Layer::new(&layer.name, &layer.gaussians).with(layer.state);
            match &layer.clip {
                Some(clip) => made.clipped(clip.clip()),
                None => made,
            }
        });
        layers.collect()
    }

    /// The layers of a name, which `flag` asks for.
    fn named(&mut self, flag: &str, name: &str) -> Result<Vec<&mut LoadedLayer>, Failure> {
        let names: Vec<_> = self.layers.iter().map(|layer| layer.name.clone()).collect();
        let found: Vec<_> = self
            .layers
            .iter_mut()
            .filter(|layer| layer.name == name)
            .collect();
        match found.is_empty() {
            true => Err(Failure::Usage(format!(
                "{flag}: no layer is called '{name}'; there are {}",
                names.join(", ")
            ))),
            false => Ok(found),
        }
    }

    /// All files' Gaussians as one set.
    pub(super) fn merged(self) -> Gaussians {
        let mut layers = self.layers.into_iter().map(|layer| layer.gaussians);
        let mut merged = layers.next().unwrap_or_default();
        layers.for_each(|more| merged.append(&more));
        merged
    }
}

/// Reads the layers that these files are or list.
pub(super) fn load_files(paths: &[PathBuf]) -> Result<Loaded, Failure> {
    load(entries(paths)?)
}

/// The layers that files are or list.
fn entries(files: &[PathBuf]) -> Result<Vec<LayerEntry>, Failure> {
    let mut entries = Vec::new();
    for file in files {
        entries.extend(named_file(file)?);
    }
    Ok(entries)
}

/// Reads the files in order, and prints what had to be repaired.
fn load(entries: Vec<LayerEntry>) -> Result<Loaded, Failure> {
    let mut all = Loaded {
        layers: Vec::new(),
        repaired: 0,
        dropped: 0,
        notes: Vec::new(),
    };
    for LayerEntry {
        name,
        path,
        state,
        clip,
    } in entries
    {
        let loaded = load_one(&path)?;
        all.repaired += loaded.report.repaired;
        all.dropped += loaded.report.dropped;
        let lines = loaded.report.lines();
        all.notes.extend(
            lines
                .into_iter()
                .map(|line| format!("{}: {line}", path.display())),
        );
        all.layers.push(LoadedLayer {
            listed: Listed {
                visible: state.visible,
                clipped: clip.is_some(),
            },
            name,
            gaussians: loaded.gaussians,
            state,
            clip,
        });
    }
    for note in &all.notes {
        say(format_args!("note: {note}"));
    }
    Ok(all)
}

/// The layers of `FILE` or `NAME=FILE`, of which the first may be a list of layers. A file that exists goes before a name.
fn named_file(typed: &Path) -> Result<Vec<LayerEntry>, Failure> {
    let is_list = |path: &Path| path.extension().is_some_and(|ending| ending == "json");
    let text = typed.to_string_lossy();
    let (name, path) = match text.split_once('=') {
        Some((name, path)) if !typed.exists() && !name.is_empty() => (Some(name), Path::new(path)),
        _ => (None, typed),
    };
    if is_list(path) {
        return match name {
            Some(name) => Err(Failure::Usage(format!(
                "{name}={}: a list of layers has names of its own; leave this one out",
                path.display()
            ))),
            None => Ok(scene_file::read(path)?),
        };
    }
    let mut entry = LayerEntry::of(path);
    entry.name = name.map_or(entry.name, str::to_owned);
    Ok(vec![entry])
}

fn load_one(path: &Path) -> rara::Result<scene::Loaded> {
    let mut progress = Progress::new(format!("reading {}", path.display()));
    scene::load(path, &mut |done, total| progress.update(done, total))
}
