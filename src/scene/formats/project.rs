//! Projects of SuperSplat (`.ssproj`): an archive of a document and of a PLY for each splat that it places, colours and hides.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde_json::Value;
use zip::ZipArchive;

use super::files::{Archive, Files, own_name};
use super::{Failure, FormatOutput, SH_0, list, unread_members};
use crate::input::LoadOptions;
use crate::parts::keep;
use crate::placement::Placement;
use crate::scene_file::SceneFile;
use crate::{Format, Gaussians, LayerState, LoadReport, Property, ply};
use rara_base::counted::counted;
use rara_base::error::{Error, Result, shortened};

/// The file that describes a project.
pub(super) const DOCUMENT: &str = "document.json";
/// The bit of a Gaussian's `state` by which it is deleted.
const DELETED: u64 = 4;
/// The property that says it.
const STATE: &str = "state";
/// The members of a splat that are read.
const READ: [&str; 12] = [
    "name",
    "position",
    "rotation",
    "scale",
    "visible",
    "tintClr",
    "temperature",
    "saturation",
    "brightness",
    "blackPoint",
    "whitePoint",
    "transparency",
];

/// A layer of a file that lists several, such as a project of SuperSplat. [`load_layer`] loads its Gaussians.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FileLayer {
    /// The name of the layer in the file.
    pub name: String,
    /// The placement, opacity and visibility of the layer.
    pub state: LayerState,
    /// The factors by which the layer is stretched along its own axes before it is placed. Negative factors mirror.
    pub stretch: DVec3,
}

/// Returns the layers that a file lists. The list is empty for a file that is a single scene, and for a file that cannot be
/// read; [`load`](crate::load) returns the error of the latter.
///
/// # Errors
/// [`Error::Format`] for a list of layers that is damaged.
pub fn file_layers(path: &Path) -> Result<Vec<FileLayer>> {
    if !path.is_file() {
        return Ok(Vec::new()); // opening a pipe would wait for its writer
    }
    let archive = File::open(path).map(|file| ZipArchive::new(BufReader::new(file)));
    let is_named = |archive: &ZipArchive<_>| {
        let mut names = archive.file_names().filter_map(std::result::Result::ok);
        names.any(|name| own_name(Path::new(&*name)) == DOCUMENT)
    };
    if !matches!(&archive, Ok(Ok(archive)) if is_named(archive)) {
        return Ok(Vec::new());
    }
    let bytes = std::fs::read(path).map_err(Error::io(path))?;
    let layers = Archive::open(&bytes).and_then(|archive| match document(&archive) {
        Some((document, _)) => layers(&document),
        None => Ok(Vec::new()),
    });
    layers.map_err(|failure| failure.error_in(path))
}

/// Loads the Gaussians of one of the layers that a file [lists](file_layers), in their own space, and some of their properties as
/// [`load_with`](crate::load_with) does.
///
/// # Errors
/// The errors of `load_with`, and [`Error::Invalid`] for a number that no layer has.
pub fn load_layer<'a>(
    path: &Path,
    number: usize,
    options: impl Into<LoadOptions<'a>>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(SceneFile, Vec<Property>)> {
    let bytes = std::fs::read(path).map_err(Error::io(path))?;
    let read = Archive::open(&bytes).and_then(|archive| {
        let listed = document(&archive);
        let listed = listed.ok_or_else(|| "it lists no layers; load it as one scene".to_owned())?;
        let (document, files) = listed;
        let layers = layers(&document)?;
        let layer = layers.get(number).ok_or_else(|| {
            Error::Invalid(format!(
                "{}: there is no layer {number} of {}; they are numbered from 0",
                path.display(),
                layers.len()
            ))
        })?;
        let (mut loaded, properties) = layer_of(&document, files, number, options.into())?;
        loaded.says_origin();
        if number == 0 {
            note_rest(&document, &archive, &mut loaded.report);
        }
        if !layer.state.visible {
            loaded.report.note(hidden(&layer.name));
        }
        Ok((loaded, properties))
    });
    let read = read.map_err(|failure| failure.error_in(path))?;
    let total = bytes.len() as u64;
    progress(total, total);
    Ok(read)
}

/// The document of an archive that is a project, and the files beside it.
pub(super) fn document<'a>(archive: &'a Archive<'_>) -> Option<(Value, Files<'a>)> {
    let (document, files) = archive.document(DOCUMENT).ok()?;
    is(&document).then_some((document, files))
}

/// True for the document of a project.
pub(super) fn is(document: &Value) -> bool {
    document.get("splats").is_some_and(Value::is_array)
}

/// Reads the visible splats of a project as one scene.
pub(super) fn read(
    document: &Value,
    files: Files<'_>,
) -> std::result::Result<FormatOutput, Failure> {
    let mut whole = FormatOutput::default();
    for (number, layer) in layers(document)?.into_iter().enumerate() {
        if !layer.state.visible {
            whole.report.note(hidden(&layer.name));
            continue;
        }
        let (loaded, _) = layer_of(document, files, number, LoadOptions::default())?;
        let mut made = FormatOutput {
            elements: loaded.gaussians.len() as u64,
            gaussians: loaded.gaussians,
            report: loaded.report,
            ..FormatOutput::default()
        };
        if layer.stretch != DVec3::ONE {
            made.transform(&DAffine3::from_scale(layer.stretch));
        }
        made.place(&layer.state.placement);
        for opacity in made.gaussians.opacities_mut() {
            *opacity *= layer.state.opacity;
        }
        whole.append(made)?;
    }
    if let Some(archive) = files.archive() {
        note_rest(document, archive, &mut whole.report);
    }
    Ok(whole)
}

fn hidden(name: &str) -> String {
    format!("the project hides its splat '{}'", shortened(name))
}

/// Says what of a project is not read.
fn note_rest(document: &Value, archive: &Archive<'_>, report: &mut LoadReport) {
    let count = splats(document).len();
    let is_read = |path: &&Path| {
        let name = own_name(path);
        name == DOCUMENT || (0..count).any(|number| name == file_of(number))
    };
    let files = archive.paths().filter(|path| !is_read(path));
    let mut rest = unread_members(document, |name| ["version", "splats"].contains(&name));
    rest.extend(files.map(|path| shortened(&path.to_string_lossy())));
    report.left_out("parts of the project that rara does not use", &rest);
}

fn splats(document: &Value) -> &[Value] {
    list(document, "splats")
}

/// The name of the file of a splat.
fn file_of(number: usize) -> String {
    format!("splat_{number}.ply")
}

/// The splats of a project as layers of our axes: SuperSplat's world is ours after half a turn about the direction of view, as
/// the `.ply` that it exports is.
fn layers(document: &Value) -> std::result::Result<Vec<FileLayer>, Failure> {
    let version = document
        .get("version")
        .and_then(Value::as_f64)
        .unwrap_or(0.0);
    if version != 0.0 {
        return Err(Failure::Format(format!(
            "this is a SuperSplat project of version {version}; version 0 is read: export a .ply from SuperSplat"
        )));
    }
    let half_turn = DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0);
    let layer = |(number, splat): (usize, &Value)| {
        let wrong = |what: String| {
            Failure::Format(format!(
                "splat {number} of {DOCUMENT} has {what}; save the project again"
            ))
        };
        let [x, y, z] = numbers(splat, "position", [0.0; 3]).map_err(&wrong)?;
        let turn = numbers(splat, "rotation", [0.0, 0.0, 0.0, 1.0]).map_err(&wrong)?;
        let scales = numbers(splat, "scale", [1.0; 3]).map_err(&wrong)?;
        let [opacity] = numbers(splat, "transparency", [1.0]).map_err(&wrong)?;
        let is_even = scales[0] > 0.0 && scales.iter().all(|scale| *scale == scales[0]);
        let (scale, stretch) = match is_even {
            true => (scales[0], DVec3::ONE),
            false => (1.0, scales.into()),
        };
        let turn = half_turn * DQuat::from_array(turn);
        let placement = Placement::new(half_turn * DVec3::new(x, y, z), turn, scale);
        let name = splat.get("name").and_then(Value::as_str);
        Ok(FileLayer {
            name: name.map_or_else(|| file_of(number), str::to_owned),
            state: LayerState::default()
                .placement(placement.map_err(|_| wrong("no place for anything".into()))?)
                .opacity(opacity.clamp(0.0, 1.0) as f32)
                .visible(splat.get("visible").and_then(Value::as_bool) != Some(false)),
            stretch,
        })
    };
    splats(document).iter().enumerate().map(layer).collect()
}

/// So many numbers, or one, or what stands for them where there are none.
fn numbers<const N: usize>(
    splat: &Value,
    key: &str,
    usual: [f64; N],
) -> std::result::Result<[f64; N], String> {
    let all = match splat.get(key) {
        None | Some(Value::Null) => return Ok(usual),
        Some(value) => super::numbers(value),
    };
    let all = all.and_then(|all| all.try_into().ok());
    all.ok_or_else(|| format!("a {key} that is not {}", counted(N, "number")))
}

/// Loads the Gaussians of a splat in its own space, without those that are deleted, in the colours that the project gives them.
fn layer_of(
    document: &Value,
    files: Files<'_>,
    number: usize,
    options: LoadOptions<'_>,
) -> std::result::Result<(SceneFile, Vec<Property>), Failure> {
    let name = file_of(number);
    let bytes = files.get(&name)?;
    let asked = options.properties;
    let mut names = asked.to_vec();
    if !asked.contains(&STATE) && has_state(&bytes) {
        names.push(STATE);
    }
    let options = LoadOptions {
        properties: &names,
        ..options
    };
    let (mut loaded, mut properties) = ply::read_bytes(&bytes, Path::new(&name), options)?;
    loaded.format = Format::SuperSplat;
    let splat = &splats(document)[number];
    grade(splat, &mut loaded.gaussians).map_err(|what| {
        format!("splat {number} of {DOCUMENT} has {what}; save the project again")
    })?;
    if let Some(at) = properties
        .iter()
        .position(|property| property.name == STATE)
    {
        let states = properties[at].values.iter();
        let is_kept =
            |(number, state): (u32, &f64)| (*state as u64 & DELETED == 0).then_some(number);
        let kept: Vec<u32> = (0..).zip(states).filter_map(is_kept).collect();
        let deleted = loaded.gaussians.len() - kept.len();
        if deleted > 0 {
            loaded.gaussians.keep(&kept);
            for property in &mut properties {
                keep(&mut property.values, &kept, 1);
            }
            loaded.report.note(format!(
                "left out {} that the project has deleted",
                counted(deleted, "Gaussian")
            ));
        }
        if !asked.contains(&STATE) {
            properties.remove(at);
        }
    }
    let rest = unread_members(splat, |name| READ.contains(&name));
    loaded.report.left_out(
        "values of the project's splats that rara does not use",
        &rest,
    );
    Ok((loaded, properties))
}

/// True where the header of a PLY declares a `state`.
fn has_state(ply: &[u8]) -> bool {
    let mut lines = ply.split(|byte| matches!(byte, b'\n' | b'\r'));
    let header = lines
        .by_ref()
        .take_while(|line| !line.starts_with(b"end_header"));
    let mut declared = header.filter(|line| line.starts_with(b"property"));
    declared.any(|line| line.trim_ascii_end().ends_with(b" state"))
}

/// Gives Gaussians the colours of a splat: they are scaled between the black and the white point by tint and temperature, made
/// brighter, and mixed with their grey (Rec. 601) by the saturation. All of this is affine, so that the coefficients of each
/// spherical harmonic follow it, those above degree 0 without what is added.
fn grade(splat: &Value, gaussians: &mut Gaussians) -> std::result::Result<(), String> {
    let number = |key, usual| numbers(splat, key, [usual]).map(|[number]| number);
    let [red, green, blue] = match numbers(splat, "tintClr", [1.0; 4]) {
        Ok([red, green, blue, _]) => [red, green, blue],
        Err(_) => numbers(splat, "tintClr", [1.0; 3])?,
    };
    let (temperature, saturation) = (number("temperature", 0.0)?, number("saturation", 1.0)?);
    let (black, white) = (number("blackPoint", 0.0)?, number("whitePoint", 1.0)?);
    let added = number("brightness", 0.0)? - black;
    if white == black {
        return Err("a whitePoint that is its blackPoint".into());
    }
    let tint =
        DVec3::new(red * (1.0 + temperature), green, blue * (1.0 - temperature)) / (white - black);
    if (tint, saturation, added) == (DVec3::ONE, 1.0, 0.0) {
        return Ok(()); // to the bit
    }
    let grey = DMat3::from_cols(
        DVec3::splat(0.299),
        DVec3::splat(0.587),
        DVec3::splat(0.114),
    );
    let mixed = grey * (1.0 - saturation) + DMat3::from_diagonal(DVec3::splat(saturation));
    let matrix = mixed * DMat3::from_diagonal(tint);
    // Of degree 0 the colour is half and the coefficient's part.
    let shift = (matrix * DVec3::splat(0.5) + DVec3::splat(added - 0.5)) / SH_0;
    let stride = gaussians.sh_coefficients();
    for (at, own) in gaussians.sh_mut().chunks_exact_mut(3).enumerate() {
        let graded = matrix * DVec3::new(own[0].into(), own[1].into(), own[2].into());
        let shift = if at % stride == 0 { shift } else { DVec3::ZERO };
        own.copy_from_slice(&(graded + shift).as_vec3().to_array());
    }
    Ok(())
}

#[cfg(test)]
mod tests;
