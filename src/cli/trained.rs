//! `--antialiasing` and `--low-pass`: how layers were trained, which is how they are drawn.

use clap::Args;
use rara::scene::Format;
use rara::{SortBy, Training};

use super::failure::Failure;
use super::layer_names::named;
use rara::scene::layers::SceneLayers;

/// What flags say of how the scene was trained.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct TrainedOptions {
    /// Whether training used antialiasing: on, off or auto
    ///
    /// The low-pass widens splats, which makes small splats too bright. Trainers with antialiasing compensate by a lower opacity
    /// of small splats: 3DGS with --antialiasing, gsplat and nerfstudio with 'antialiased', Mip-Splatting, and Brush with 'mip'.
    /// With on, rara does the same. With auto, the default, rara does so if the file of a layer says that training used
    /// antialiasing, or if the trainer's settings in the folder of this file say it. NAME=on applies to one layer only
    /// (repeatable).
    #[arg(long, value_name = "on|off|auto")]
    antialiasing: Vec<String>,
    /// Variance of the low-pass used in training, px^2, or auto
    ///
    /// The low-pass widens each splat: it adds this variance in both directions of the picture. The value is from 0.01 to 10.
    /// 3DGS, gsplat and nerfstudio train with 0.3, and Mip-Splatting and the mip mode of Brush train with 0.1. With auto, the
    /// default, rara uses the value that the file of a layer states, or that of the trainer that wrote the file. NAME=0.1
    /// applies to one layer only (repeatable).
    #[arg(long, value_name = "PX2|auto")]
    low_pass: Vec<String>,
}

/// What a flag says of the layers of a name, or of all.
struct TrainingNote<'a, T> {
    /// The name of the layers; none for all.
    name: Option<&'a str>,
    /// What they are; none where that is found by the files.
    value: Option<T>,
}

impl<'a, T> TrainingNote<'a, T> {
    /// What the texts of a flag say. `read` takes a value that is not auto.
    fn all(
        flag: &str,
        texts: &'a [String],
        expected: &str,
        read: impl Fn(&str) -> Option<T>,
        loaded: &mut SceneLayers,
    ) -> Result<Vec<Self>, Failure> {
        let parsed = texts.iter().map(|text| {
            // A name may hold the sign that ends it.
            let (name, value) = match text.rsplit_once('=') {
                Some((name, value)) => (Some(name), value),
                None => (None, text.as_str()),
            };
            let value = match value.trim() {
                "auto" => None,
                value => Some(read(value).ok_or_else(|| {
                    Failure::Usage(format!("{flag} {text}: expected {expected} for one layer"))
                })?),
            };
            if let Some(name) = name {
                named(loaded, flag, name)?;
            }
            Ok(Self { name, value })
        });
        parsed.collect()
    }

    /// What was said last of a layer; none where its file decides.
    fn of_layer(all: &[Self], layer: &str) -> Option<T>
    where
        T: Copy,
    {
        let mut said = all.iter().rev();
        said.find(|said| said.name.is_none_or(|name| name == layer))?
            .value
    }
}

impl TrainedOptions {
    /// The flags and what they say.
    #[cfg_attr(not(feature = "view"), allow(dead_code))]
    pub(super) fn texts(&self) -> [(&'static str, &[String]); 2] {
        [
            ("--antialiasing", &self.antialiasing),
            ("--low-pass", &self.low_pass),
        ]
    }

    /// Does what the flags say, and otherwise what the settings of the training say, with a note of it.
    pub(super) fn apply(&self, loaded: &mut SceneLayers) -> Result<(), Failure> {
        let on = |value: &str| match value {
            "on" => Some(true),
            "off" => Some(false),
            _ => None,
        };
        let antialiasing = TrainingNote::all(
            "--antialiasing",
            &self.antialiasing,
            "on, off or auto, or NAME=on",
            on,
            loaded,
        )?;
        let low_passes: Vec<TrainingNote<'_, f32>> = TrainingNote::all(
            "--low-pass",
            &self.low_pass,
            "a number of square pixels or auto, or NAME=0.1",
            |value| value.parse().ok(),
            loaded,
        )?;
        for layer in &mut loaded.layers {
            let mut training = layer.gaussians.training();
            if let Some(antialiased) = TrainingNote::of_layer(&antialiasing, &layer.name) {
                training.antialiased = antialiased;
            } else if let (Some(by), Some(file)) = (&layer.antialiased_by, &layer.file) {
                let note = format!(
                    "{}: it is drawn antialiased, as {} says that it was trained; --antialiasing off draws it as it is",
                    file.display(),
                    by.display()
                );
                // Selections make several layers of a file.
                if loaded.notes.last() != Some(&note) {
                    loaded.notes.push(note);
                }
            }
            if let Some(low_pass) = TrainingNote::of_layer(&low_passes, &layer.name) {
                training.low_pass = low_pass;
            }
            let set = layer.gaussians.set_training(training);
            set.map_err(|error| Failure::Usage(format!("--low-pass: {error}")))?;
        }
        Ok(())
    }
}

/// Refuses layers that were trained in several ways where they become one set, which is drawn in one way. Hidden ones are left
/// out of it.
pub(super) fn check_alike(loaded: &SceneLayers) -> Result<(), Failure> {
    let Some([first, other]) = loaded.trained_otherwise() else {
        return Ok(());
    };
    let [own, others] = [first, other].map(|layer| layer.gaussians.training());
    if own.linear != others.linear {
        return Err(Failure::Usage(format!(
            "the colours of '{}' and '{}' are not both linear light, and one file can have only one of these: write them to \
             a file each",
            first.name, other.name
        )));
    }
    let (how, flag) = match (own.antialiased, others.antialiased) {
        (true, false) => (
            ["with antialiasing", "without"].map(String::from),
            "--antialiasing on or off",
        ),
        (false, true) => (
            ["without antialiasing", "with it"].map(String::from),
            "--antialiasing on or off",
        ),
        _ => (
            [own, others].map(|training| format!("with a low-pass of {} px^2", training.low_pass)),
            "--low-pass",
        ),
    };
    Err(Failure::Usage(format!(
        "the layer '{}' was trained {} and '{}' {}, and one file can have only one of these: write them to a file each, or \
         give {flag} for all",
        first.name, how[0], other.name, how[1],
    )))
}

/// The warning that a file of this format says less of how its Gaussians were trained, or says it to rara alone.
pub(super) fn lost(format: Format, training: Training) -> Option<String> {
    if training.linear && format != Format::Gltf {
        return Some(format!(
            "{format} cannot say that the colours are linear light, and is drawn as if displays stored them so, but for a .ply \
             by rara; write a .glb"
        ));
    }
    let is_usual =
        |usual: Training| training == usual.linear(training.linear).alpha_max(training.alpha_max);
    let usual = match format {
        // Most scenes are trained so, and each program draws them as it does.
        Format::Gltf if is_usual(Training::default()) => return None,
        Format::Gltf => Training::default().sort_by(SortBy::Distance),
        Format::Spz => Training::default().antialiased(training.antialiased),
        _ => return None,
    };
    let flags = [
        (training.antialiased != usual.antialiased).then(|| "--antialiasing on".to_owned()),
        (training.low_pass != usual.low_pass).then(|| format!("--low-pass {}", training.low_pass)),
        (training.sort_by != usual.sort_by).then(|| format!("--sort {}", training.sort_by)),
    ];
    let flags: Vec<_> = flags.into_iter().flatten().collect();
    match (flags.is_empty(), format) {
        (true, _) => None,
        (false, Format::Gltf) => Some(format!(
            "glTF has no property that says how a scene was trained: the file's extras tell rara that this one was trained \
             {training}, and other programs draw it {usual}"
        )),
        (false, _) => Some(format!(
            "{format} does not store how the scene was trained; draw the file with {}",
            flags.join(" ")
        )),
    }
}
