//! `--antialiasing`: whether layers are drawn as Gaussians that were trained antialiased.

use std::path::Path;

use super::failure::Failure;
use super::scene_layers::SceneLayers;
use super::training;

/// What a text says of the layers of a name, or of all.
struct TrainingNote<'a> {
    /// The name of the layers; none for all.
    name: Option<&'a str>,
    /// What they are; none where that is found by the files.
    antialiased: Option<bool>,
}

impl<'a> TrainingNote<'a> {
    fn parse(text: &'a str) -> Result<Self, Failure> {
        // A name may hold the sign that ends it.
        let (name, value) = match text.rsplit_once('=') {
            Some((name, value)) => (Some(name), value),
            None => (None, text),
        };
        let antialiased = match value.trim() {
            "on" => Some(true),
            "off" => Some(false),
            "auto" => None,
            _ => {
                return Err(Failure::Usage(format!(
                    "--antialiasing {text}: expected on, off or auto, or NAME=on for one layer"
                )));
            }
        };
        Ok(Self { name, antialiased })
    }
}

/// What to say of a file, which says nothing itself, where the settings beside it say that it was trained antialiased.
pub(super) fn trained(file: &Path) -> Option<String> {
    let by = training::antialiased_by(file)?;
    Some(format!(
        "{}: it is drawn antialiased, as {} says that it was trained; --antialiasing off draws it as it is",
        file.display(),
        by.display()
    ))
}

/// Does what the flags say, and otherwise what the settings of the training say, with a note of it. Of several flags that say
/// something of a layer the last one counts.
pub(super) fn apply(texts: &[String], loaded: &mut SceneLayers) -> Result<(), Failure> {
    let mut all = Vec::new();
    for text in texts {
        let said = TrainingNote::parse(text)?;
        if let Some(name) = said.name {
            loaded.named("--antialiasing", name)?;
        }
        all.push(said);
    }
    for layer in &mut loaded.layers {
        let is_of = |said: &&TrainingNote<'_>| said.name.is_none_or(|name| name == layer.name);
        let said = all.iter().rev().find(is_of);
        let trained = layer.trained.take();
        if let Some(antialiased) = said.and_then(|said| said.antialiased) {
            layer.gaussians.set_antialiased(antialiased);
        } else if let Some(note) = trained {
            layer.gaussians.set_antialiased(true);
            // Selections make several layers of a file.
            if loaded.notes.last() != Some(&note) {
                loaded.notes.push(note);
            }
        }
    }
    Ok(())
}

/// Refuses layers of both kinds where they become one set, which is antialiased as a whole or not at all. Hidden ones are left
/// out of it.
pub(super) fn check_alike(loaded: &SceneLayers) -> Result<(), Failure> {
    let shown = loaded.layers.iter();
    let shown = shown.filter(|layer| layer.state.visible && !layer.gaussians.is_empty());
    let of = |antialiased: bool| {
        let mut all = shown.clone();
        all.find(|layer| layer.gaussians.is_antialiased() == antialiased)
    };
    match (of(true), of(false)) {
        (Some(antialiased), Some(plain)) => Err(Failure::Usage(format!(
            "the layer '{}' was trained antialiased and '{}' was not, and a file of both can say only one of it: write them \
             to a file each, or say --antialiasing on or off for all",
            antialiased.name, plain.name
        ))),
        _ => Ok(()),
    }
}
