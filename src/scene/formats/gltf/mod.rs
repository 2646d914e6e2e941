//! glTF 2.0 with `KHR_gaussian_splatting`: attributes of points, or a whole `.spz` in their place.

mod accessor;
mod annotations;
mod buffers;
mod nodes;
mod triangles;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use glam::{DQuat, DVec3};
use serde_json::Value;

use self::accessor::Accessor;
use self::annotations::AnnotationsReader;
use self::buffers::Buffers;
use self::nodes::Transform;
pub(crate) use self::triangles::triangles;
use super::super::assemble::{ColumnForm, OPACITY, ROTATION, SCALES, SH, SLOTS, room_with};
use super::super::input::ALL;
use super::super::{Property, SH_0, SortBy, sh_coefficients};
use super::bytes::Bytes;
use super::{Failure, Files, FormatOutput, json, list, spz};
use crate::placement::Placement;
use rara_base::counted::counted;
use rara_base::error::shortened;
use rara_base::rows;

/// The extension's name, which attributes begin with.
pub(super) const EXTENSION: &str = "KHR_gaussian_splatting";
/// The member of a primitive's extras that has this project's marks of training, and the mark that other formats have by
/// themselves.
pub(super) const MARKS: &str = "rara";
pub(super) const ANTIALIASED: &str = "antialiased";
/// Its names of linear light, and of colours as displays store them.
pub(super) const LINEAR: &str = "lin_rec709_display";
pub(super) const STORED: &str = "srgb_rec709_display";
/// What names of its compression begin with; drafts have a number behind.
const SPZ: &str = "KHR_gaussian_splatting_compression_spz";

/// Members of the extension, the words for them that are known, and how Gaussians of another word are drawn.
const WORDS: [(&str, &[&str], &str, &str); 4] = rows! {
    "kernel", &["ellipse"], "the kernel", "is drawn as an ellipse";
    "projection", &["perspective"], "the projection", "is drawn as perspective";
    "sortingMethod", &["cameraDistance"], "the order", "is drawn by distance";
    "colorSpace", &[LINEAR, STORED], "colours of the space", "are drawn as sRGB";
};

/// Gaussians that a byte of the buffers may be drawn as: even one of a compressed scene is no more than 52.
const MOST_DRAWN: u64 = 64;
/// Primitives of Gaussians that a scene may draw.
const MOST_PRIMITIVES: u64 = 1 << 16;

/// The turn from glTF's axes, left, up and forward, to ours: half a turn about the direction of view.
pub(super) fn turn() -> DQuat {
    DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0)
}

/// Reads a `.glb`.
pub(super) fn read_binary(
    bytes: &[u8],
    files: Files<'_>,
    asked: &[&str],
) -> Result<FormatOutput, Failure> {
    let (document, binary, behind) = chunks(bytes)?;
    let mut made = read_document(&document, binary, files, asked)?;
    made.report.trailing_bytes = behind as u64;
    Ok(made)
}

/// The document of a `.glb`, its buffer, and how many bytes follow.
fn chunks(bytes: &[u8]) -> Result<(Value, Option<&[u8]>, usize), Failure> {
    let what = "the .glb";
    let mut bytes = Bytes(bytes);
    bytes.take(4, what)?;
    let version = bytes.u32(what)?;
    if version != 2 {
        return Err(Failure::Format(format!(
            "this is glTF of version {version}; version 2 is read, export the scene again"
        )));
    }
    let length = u64::from(bytes.u32(what)?).saturating_sub(12);
    let mut chunks = Bytes(bytes.take(length, what)?);
    let (mut document, mut binary) = (None, None);
    while !chunks.0.is_empty() {
        let (size, kind) = (chunks.u32("a chunk")?, chunks.u32("a chunk")?);
        let chunk = chunks.take(size.into(), "a chunk of the .glb")?;
        match kind {
            0x4E4F_534A if document.is_none() => document = Some(json(chunk)?),
            0x004E_4942 if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
    }
    let document = document.ok_or_else(|| "the .glb has no JSON; get it again".to_owned())?;
    Ok((document, binary, bytes.0.len()))
}

/// Reads a document; `binary` is the buffer of the file that it is in.
pub(super) fn read_document(
    document: &Value,
    binary: Option<&[u8]>,
    files: Files<'_>,
    asked: &[&str],
) -> Result<FormatOutput, Failure> {
    let mut buffers = Buffers::new(document, binary, files);
    let mut whole = FormatOutput::default();
    let (mut found, mut others, mut invisible, mut hidden) = (0_u64, 0_u64, 0_usize, 0_usize);
    let turned = Transform::Similar(Placement::new(DVec3::ZERO, turn(), 1.0)?);
    let mut meshes = BTreeMap::new();
    check_extensions(document)?;
    let (all, parents) = nodes::meshes(document, &mut buffers)?;
    let mut annotations = AnnotationsReader::new(document, parents);
    for drawn in all {
        let mesh = match meshes.entry(drawn.mesh) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(unknown) => unknown.insert(Mesh::from_json(document, drawn.mesh)?),
        };
        found += mesh.splats.len() as u64;
        others += mesh.others;
        if !drawn.is_visible {
            invisible += mesh.splats.len();
            continue;
        }
        if drawn.transform.hides() {
            hidden += mesh.splats.len();
            continue;
        }
        if found > MOST_PRIMITIVES {
            return Err(Failure::Format(format!(
                "the glTF draws more than {MOST_PRIMITIVES} primitives of Gaussians; export the scene as one"
            )));
        }
        for &(primitive, extension) in &mesh.splats {
            let mut made = read_primitive(document, &mut buffers, (primitive, extension), asked)?;
            set_training(&mut made, primitive, extension);
            match turned.of_inner(&drawn.transform)? {
                Transform::Similar(placement) => made.place(&placement),
                Transform::Other(affine) => made.transform(&affine),
            }
            annotations.add(&drawn, primitive, made.gaussians.len());
            whole.append(made)?;
            check_drawn(whole.gaussians.len() as u64, &buffers)?;
        }
    }
    if found == 0 {
        return Err(Failure::Format(format!(
            "the glTF has no Gaussians in its scene: none of its {others} drawn primitive(s) has {EXTENSION}; export them \
             with it"
        )));
    }
    whole.annotations = Some(annotations.finish());
    for (count, why) in [(hidden, "are scaled to nothing"), (invisible, "nodes hide")] {
        if count > 0 {
            whole.report.note(format!(
                "left out {} of the glTF that {why}",
                counted(count, "primitive")
            ));
        }
    }
    for (key, one) in [("animations", "animation"), ("skins", "skin")] {
        let count = list(document, key).len();
        if count > 0 {
            whole.report.note(format!(
                "left out {} of the glTF: it is drawn as its nodes stand",
                counted(count, one)
            ));
        }
    }
    if others > 0 {
        whole.report.note(format!(
            "left out {others} primitive(s) of the glTF that are not Gaussians"
        ));
    }
    Ok(whole)
}

/// Refuses more Gaussians than the bytes are worth.
fn check_drawn(count: u64, buffers: &Buffers<'_>) -> Result<(), Failure> {
    match count / MOST_DRAWN > buffers.size() as u64 {
        false => Ok(()),
        true => Err(Failure::Format(format!(
            "the glTF draws {} and more of {}, the same ones again and again; export the scene once",
            counted(count, "Gaussian"),
            counted(buffers.size(), "byte")
        ))),
    }
}

/// Refuses a document that requires an extension which may change its Gaussians in a way that is not known (glTF 2.0, 3.12).
fn check_extensions(document: &Value) -> Result<(), Failure> {
    // These say how something looks that is no Gaussian, or let accessors have types that are read anyway. What compresses
    // is refused where it is met, since it may concern other meshes.
    const HARMLESS: [&str; 4] = [
        "KHR_materials_",
        "KHR_texture_",
        "KHR_lights_",
        "KHR_mesh_quantization",
    ];
    let known = |name: &str| {
        name == EXTENSION
            || name == nodes::INSTANCES
            || name == nodes::VISIBILITY
            || name.contains("compression")
            || HARMLESS.iter().any(|known| name.starts_with(known))
    };
    let required = list(document, "extensionsRequired");
    match required
        .iter()
        .filter_map(Value::as_str)
        .find(|name| !known(name))
    {
        Some(name) => Err(Failure::Format(format!(
            "the glTF requires the extension {}, which is not read; export the scene without it",
            shortened(name)
        ))),
        None => Ok(()),
    }
}

/// The primitives of a mesh that are Gaussians, with what the extension says, and how many are not.
struct Mesh<'a> {
    splats: Vec<(&'a Value, &'a Value)>,
    others: u64,
}

impl<'a> Mesh<'a> {
    fn from_json(document: &'a Value, number: usize) -> Result<Self, Failure> {
        let mesh = list(document, "meshes").get(number).ok_or_else(|| {
            format!(
                "a node of the glTF refers to mesh {number}, which the file does not have; export the scene again"
            )
        })?;
        let all = list(mesh, "primitives");
        let splat = |primitive: &'a Value| {
            let extension = primitive.get("extensions")?.get(EXTENSION)?;
            Some((primitive, extension))
        };
        let splats: Vec<_> = all.iter().filter_map(splat).collect();
        Ok(Self {
            others: (all.len() - splats.len()) as u64,
            splats,
        })
    }
}

/// An index or a count.
fn index(object: &Value, key: &str) -> Option<u64> {
    object.get(key).and_then(Value::as_u64)
}

/// An index or a count of what is in memory.
fn size(object: &Value, key: &str) -> Option<usize> {
    usize::try_from(index(object, key)?).ok()
}

fn read_primitive(
    document: &Value,
    buffers: &mut Buffers<'_>,
    (primitive, extension): (&Value, &Value),
    asked: &[&str],
) -> Result<FormatOutput, Failure> {
    let inner = [extension.get("extensions"), primitive.get("extensions")];
    let inner = inner
        .into_iter()
        .flatten()
        .filter_map(Value::as_object)
        .flatten();
    for (name, compressed) in inner {
        if name.starts_with(SPZ) {
            let view = index(compressed, "bufferView").ok_or_else(|| {
                format!(
                    "{} has no bufferView; export the scene again",
                    shortened(name)
                )
            })?;
            return spz::read(buffers.view(document, view)?.0, false);
        }
        if name.contains("compression") {
            return Err(Failure::Format(format!(
                "the Gaussians are compressed by {}, which is not read; export them uncompressed or as {SPZ}",
                shortened(name)
            )));
        }
    }
    let notes = WORDS.iter().filter_map(|(key, known, what, is_drawn)| {
        let found = extension.get(*key)?.as_str()?;
        let is_unknown = !known.contains(&found);
        is_unknown.then(|| format!("{what} \"{}\" {is_drawn}", shortened(found)))
    });
    let attributes = primitive.get("attributes");
    let count = count_of(document, attributes, "POSITION").ok_or_else(|| {
        "the Gaussians have no attribute POSITION with a count; export the scene again".to_owned()
    })?;
    let mut get = |name: &str, parts: usize| -> Result<Option<Accessor>, Failure> {
        match attribute(attributes, name) {
            Some(number) => {
                Accessor::from_json(document, buffers, number, name, count, parts).map(Some)
            }
            None => Ok(None),
        }
    };
    let own = |name: &str| format!("{EXTENSION}:{name}");
    let lacks =
        |name: &str| format!("the Gaussians have no attribute {name}; export the scene again");
    let mut needed =
        |name: &str, parts: usize| get(name, parts)?.ok_or_else(|| Failure::Format(lacks(name)));
    let positions = needed("POSITION", 3)?;
    let rotations = needed(&own("ROTATION"), 4)?;
    let scales = needed(&own("SCALE"), 3)?;
    let opacities = get(&own("OPACITY"), 1)?;
    let colours = get("COLOR_0", 4)?;
    let mut harmonics = Vec::new();
    let mut degree = 0;
    for band in 0..=3_u32 {
        let name = |coefficient: u32| own(&format!("SH_DEGREE_{band}_COEF_{coefficient}"));
        if attribute(attributes, &name(0)).is_none() {
            break;
        }
        for coefficient in 0..=2 * band {
            let accessor = get(&name(coefficient), 3)?;
            harmonics.push(accessor.ok_or_else(|| lacks(&name(coefficient)))?);
        }
        degree = band;
    }
    if harmonics.is_empty() && colours.is_none() {
        return Err(Failure::Format(lacks(&own("SH_DEGREE_0_COEF_0"))));
    }
    if opacities.is_none() && colours.is_none() {
        return Err(Failure::Format(lacks(&own("OPACITY"))));
    }
    let all = attributes.and_then(Value::as_object).into_iter().flatten();
    let own: Vec<_> = all
        .map(|(name, _)| &name[..])
        .filter(|name| !is_read(name, degree))
        .collect();
    let mut properties = Vec::new();
    let mut columns = Vec::new();
    for name in own
        .iter()
        .filter(|name| asked.contains(name) || asked.contains(&ALL))
    {
        let is_number = |of: &Value| of.get("type").and_then(Value::as_str) == Some("SCALAR");
        let accessor =
            attribute(attributes, name).and_then(|at| list(document, "accessors").get(at));
        if !asked.contains(name) && !accessor.is_some_and(is_number) {
            continue;
        }
        columns.extend(get(name, 1)?);
        let mut property = Property::new(*name, Vec::new());
        property.single = accessor.and_then(|of| index(of, "componentType")) == Some(5126);
        properties.push(property);
    }
    check_drawn(count, buffers)?;
    // The text of the extension from January to April 2026 had logarithms, and today's has no negative scales.
    let has_logarithms = (0..count).any(|at| (0..3).any(|axis| scales.at(at, axis) < 0.0));
    let form = match has_logarithms {
        true => ColumnForm::LogScales,
        false => ColumnForm::Plain,
    };
    let read: Vec<_> = properties
        .iter()
        .map(|property| property.name.clone())
        .collect();
    let mut made = room_with(count, degree, form, properties)?.make(|index, row| {
        let index = index as u64;
        for axis in 0..3 {
            row[axis] = positions.at(index, axis);
            row[SCALES + axis] = scales.at(index, axis);
        }
        // x, y, z, w in the file.
        row[ROTATION] = rotations.at(index, 3);
        for axis in 0..3 {
            row[ROTATION + 1 + axis] = rotations.at(index, axis);
        }
        let alpha = || colours.as_ref().map_or(1.0, |colours| colours.at(index, 3));
        row[OPACITY] = opacities
            .as_ref()
            .map_or_else(alpha, |opacities| opacities.at(index, 0));
        for channel in 0..3 {
            if let (true, Some(colours)) = (harmonics.is_empty(), &colours) {
                row[SH + channel] = (colours.at(index, channel) - 0.5) / SH_0;
            }
            for (coefficient, accessor) in
                harmonics.iter().enumerate().take(sh_coefficients(degree))
            {
                row[SH + 3 * coefficient + channel] = accessor.at(index, channel);
            }
        }
        for (to, column) in row[SLOTS..].iter_mut().zip(&columns) {
            *to = column.at(index, 0);
        }
        Ok(())
    })?;
    notes.for_each(|note| made.report.note(note));
    let left = own
        .into_iter()
        .filter(|name| !read.iter().any(|read| read == name));
    let parts = [("indices", "indices"), ("targets", "morph targets")];
    let parts = parts.iter().filter(|(key, _)| primitive.get(key).is_some());
    let left = left.chain(parts.map(|(_, what)| *what)).map(shortened);
    let what = "parts of the Gaussians that drawing does not use";
    made.report.left_out(what, &left.collect::<Vec<_>>());
    if has_logarithms {
        made.report.note(
            "took the scales for logarithms, as an older text of the extension has them, since some are negative".into(),
        );
    }
    Ok(made.into())
}

/// Whether an attribute is read of Gaussians of a degree, or is what others draw in their place.
fn is_read(name: &str, degree: u32) -> bool {
    let own = name
        .strip_prefix(EXTENSION)
        .and_then(|own| own.strip_prefix(':'));
    match own {
        Some("ROTATION" | "SCALE" | "OPACITY") => true,
        Some(own) => (0..=degree).any(|band| own.starts_with(&format!("SH_DEGREE_{band}_"))),
        None => ["POSITION", "COLOR_0"].contains(&name),
    }
}

/// Says how the Gaussians of a primitive were trained. The extension knows one order, by distance, and no largest alpha; for the rest, and for what is
/// trained by depth, this project's own files have marks.
fn set_training(made: &mut FormatOutput, primitive: &Value, extension: &Value) {
    let colours = extension.get("colorSpace").and_then(Value::as_str);
    let mut training = made.gaussians.training().sort_by(SortBy::Distance);
    training = training.alpha_max(1.0).linear(colours == Some(LINEAR));
    let extras = primitive.get("extras");
    let marks = extras.and_then(|extras| extras.get(MARKS)?.as_object());
    for (name, value) in marks.into_iter().flatten() {
        if name == ANTIALIASED {
            training.antialiased = value.as_bool() == Some(true);
        } else if let Err(note) = training.mark(name, value.as_str().unwrap_or_default()) {
            made.report.note(note);
        }
    }
    made.gaussians.train(training);
}

/// The accessor of an attribute.
fn attribute(attributes: Option<&Value>, name: &str) -> Option<usize> {
    size(attributes?, name)
}

/// The elements that an attribute's accessor says to have.
fn count_of(document: &Value, attributes: Option<&Value>, name: &str) -> Option<u64> {
    let accessor = list(document, "accessors").get(attribute(attributes, name)?)?;
    index(accessor, "count")
}
