//! From declared properties to slots: which value of a row is which attribute of a Gaussian.

use ply_rs::ply::{ElementDef, Encoding, PropertyDef, PropertyType};

use super::header::PlyHeader;
use super::number::Number;
use super::trained::{self, FILTER};
use crate::Property;
use crate::assemble::{FIXED, SCALES, SH, SLOTS, check_count, degree_of};
use crate::input::ALL;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// One declared property of the Gaussians, in file order.
#[derive(Debug, Clone, Copy)]
pub(super) enum Field {
    /// A number, and the slot it goes to; `None` for one that we don't use.
    Scalar(Number, Option<usize>),
    /// A list that we don't use: type of its length and of its items.
    List(Number, Number),
}

/// The layout of the payload.
#[derive(Debug, Clone)]
pub(super) struct Layout<'a> {
    /// Elements that stand before the Gaussians.
    pub(super) before: &'a [ElementDef],
    /// Gaussians the header promises.
    pub(super) count: u64,
    pub(super) fields: Vec<Field>,
    /// Of the spherical harmonics that the file has.
    pub(super) stored_degree: u32,
    /// Of those that are read.
    pub(super) sh_degree: u32,
    /// True for discs, which have no third scale.
    pub(super) is_flat: bool,
    /// The most of a colour, where `red`, `green` and `blue` stand for the harmonics of degree 0.
    pub(super) full_colour: Option<f32>,
    /// The properties that were asked for and the Gaussians' filters, in the order of their slots from [`SLOTS`] on; without
    /// values.
    pub(super) properties: Vec<Property>,
    /// The names of what the file has beside that.
    pub(super) others: Vec<String>,
    /// Bytes of all elements after the Gaussians, if no list makes that unknowable.
    pub(super) after: Option<u64>,
}

impl<'a> Layout<'a> {
    /// Maps `header`'s properties by name, those of a Gaussian and `asked` ones, or says why this is no scene or what it
    /// lacks.
    pub(super) fn from_header(header: &'a PlyHeader, asked: &[&str]) -> Result<Self, String> {
        let at = header.elements.iter().position(|e| e.name == "vertex");
        let at = at.ok_or("the file has no `vertex` element, which holds the Gaussians of a 3DGS .ply; export the scene again")?;
        let vertex = &header.elements[at];
        check_count(vertex.count as u64)?;
        let rest = count_rest(vertex)?;
        let stored_degree = degree_of(rest).ok_or_else(|| {
            format!(
                "the file has {rest} f_rest properties; spherical harmonics of degree 0, 1, 2, 3 or 4 have 0, 9, 24, 45 or \
                 72, export the scene with one of these"
            )
        })?;
        let mut missing: Vec<_> = FIXED
            .iter()
            .copied()
            .filter(|name| !vertex.properties.contains_key(*name))
            .collect();
        trained::check(vertex)?;
        let is_flat = missing == ["scale_2"];
        missing.retain(|name| !(is_flat && *name == "scale_2"));
        let full_colour = full_colour(vertex).filter(|_| missing == FIXED[SH..]);
        missing.retain(|_| full_colour.is_none());
        let slot_of = |name: &str| {
            let colour = COLOURS.iter().position(|&colour| colour == name);
            let colour = colour.filter(|_| full_colour.is_some());
            slot_of(name, rest).or(colour.map(|channel| SH + channel))
        };
        if missing.iter().any(|name| name.len() > 1) && missing.len() > 8 {
            return Err(
                "the file holds points or a mesh, not Gaussians: it has no scale_*, rot_*, opacity and f_dc_* \
                 properties; use the .ply that 3DGS training wrote"
                    .into(),
            );
        }
        if !missing.is_empty() {
            return Err(format!(
                "the `vertex` element does not have {}; export the scene with all 3DGS properties",
                missing.join(", ")
            ));
        }
        let extra = |name: &str| {
            let is_usual =
                ["nx", "ny", "nz", FILTER].contains(&name) || name.starts_with("f_rest_");
            !is_usual && slot_of(name).is_none()
        };
        let extra: Vec<_> = vertex
            .properties
            .values()
            .filter(|one| extra(&one.name))
            .collect();
        let is_number = |one: &&&PropertyDef| matches!(one.data_type, PropertyType::Scalar(_));
        let all = extra.iter().filter(is_number).map(|one| one.name.as_str());
        let all = all.filter(|_| asked.contains(&ALL));
        let mut asked: Vec<&str> = asked
            .iter()
            .copied()
            .filter(|name| *name != ALL)
            .chain(all)
            .collect();
        asked.extend(trained::has_filter(vertex).then_some(FILTER));
        let properties = asked_properties(vertex, &asked, &slot_of)?;
        let is_read = |name: &str| properties.iter().any(|asked| asked.name == name);
        let left = extra
            .into_iter()
            .filter(|one| !is_read(&one.name))
            .map(|one| &one.name);
        let elements = header
            .elements
            .iter()
            .filter(|one| one.name != "vertex" && one.count > 0);
        let others = left
            .chain(elements.map(|one| &one.name))
            .map(|name| shortened(name));
        let others = others.collect();
        let asked_slot = |name: &str| {
            let at = properties.iter().position(|asked| asked.name == name);
            at.map(|at| SLOTS + at)
        };
        let fields = vertex
            .properties
            .values()
            .map(|property| {
                let slot = slot_of(&property.name).or_else(|| asked_slot(&property.name));
                match Field::from(&property.data_type) {
                    Field::Scalar(kind, _) => Ok(Field::Scalar(kind, slot)),
                    Field::List(..) if slot.is_some() => Err(format!(
                        "the property `{}` is a list where a number is needed; export the scene again",
                        property.name
                    )),
                    list => Ok(list),
                }
            })
            .collect::<Result<_, _>>()?;
        let after = header.elements[at + 1..].iter().try_fold(0_u64, |sum, e| {
            sum.checked_add((e.count as u64).checked_mul(fixed_size(e)?)?)
        });
        Ok(Self {
            before: &header.elements[..at],
            count: vertex.count as u64,
            fields,
            stored_degree,
            sh_degree: stored_degree.min(3),
            is_flat,
            full_colour,
            properties,
            others,
            after,
        })
    }

    /// True where centres are stored in more than single precision.
    pub(super) fn has_wide_centres(&self) -> bool {
        let is_wide = |field: &Field| match field {
            Field::Scalar(kind, Some(slot)) => *slot < SCALES && !matches!(kind, Number::F32),
            Field::Scalar(..) | Field::List(..) => false,
        };
        self.fields.iter().any(is_wide)
    }

    /// A row of zeros with a slot for each number that is read.
    pub(super) fn row(&self) -> Vec<f64> {
        vec![0.0; SLOTS + self.properties.len()]
    }

    /// Checks that `available` payload bytes can hold what the header promises, before anything is allocated for it.
    pub(super) fn check_size(&self, encoding: Encoding, available: u64) -> Result<(), String> {
        let least = |fields: &mut dyn Iterator<Item = Field>| -> u128 {
            fields.map(|f| u128::from(least_size(f, encoding))).sum()
        };
        let before: u128 = self
            .before
            .iter()
            .map(|e| {
                e.count as u128
                    * least(&mut e.properties.values().map(|p| Field::from(&p.data_type)))
            })
            .sum();
        let each = least(&mut self.fields.iter().copied());
        let mut needed = before + u128::from(self.count) * each;
        if encoding == Encoding::Ascii {
            // The very last line may do without an end.
            needed = needed.saturating_sub(1);
        }
        if needed > u128::from(available) {
            let whole = u128::from(available).saturating_sub(before) / each.max(1);
            return Err(format!(
                "the header promises {} of at least {}, but the {} after it have room for {whole}; the file is cut off, get it \
                 again",
                counted(self.count, "Gaussian"),
                counted(each, "byte"),
                counted(available, "byte")
            ));
        }
        Ok(())
    }
}

/// The names that point clouds have for the channels of a colour, in their order.
const COLOURS: [&str; 3] = ["red", "green", "blue"];

/// The most of the colours that a file has: of integers the type's, of floats 1.
fn full_colour(vertex: &ElementDef) -> Option<f32> {
    let mut all =
        COLOURS.iter().map(
            |name| match Field::from(&vertex.properties.get(*name)?.data_type) {
                Field::Scalar(Number::U8, _) => Some(255.0),
                Field::Scalar(Number::U16, _) => Some(65535.0),
                Field::Scalar(Number::F32 | Number::F64, _) => Some(1.0),
                _ => None,
            },
        );
    let first = all.next()?;
    all.all(|other| other == first).then_some(first?)
}

/// The properties that were asked for, each once, or what is wrong with one.
fn asked_properties(
    vertex: &ElementDef,
    asked: &[&str],
    slot_of: &dyn Fn(&str) -> Option<usize>,
) -> Result<Vec<Property>, String> {
    /// Names in a message, at most.
    const NAMED: usize = 12;
    let mut properties: Vec<Property> = Vec::new();
    for &name in asked {
        let quoted = shortened(name);
        if properties.iter().any(|known| known.name == name) {
            continue;
        }
        if slot_of(name).is_some() {
            return Err(format!(
                "`{quoted}` is what a Gaussian is made of, and no other property; use opacity, size, red, green, blue or a \
                 shape"
            ));
        }
        let single = match vertex.properties.get(name).map(|found| &found.data_type) {
            Some(PropertyType::Scalar(kind)) => matches!(Number::from(kind), Number::F32),
            Some(PropertyType::List(..)) => {
                return Err(format!(
                    "the property `{quoted}` is a list; use one that is a number"
                ));
            }
            None => {
                let others = vertex.properties.keys();
                let mut others: Vec<String> = others
                    .filter(|name| slot_of(name).is_none())
                    .map(|name| shortened(name))
                    .collect();
                let more = others.len().saturating_sub(NAMED);
                others.truncate(NAMED);
                let has = match (others.is_empty(), more) {
                    (true, _) => "none".into(),
                    (false, 0) => others.join(", "),
                    (false, more) => format!("{} and {more} more", others.join(", ")),
                };
                return Err(format!(
                    "the `vertex` element has no property `{quoted}`; next to those of a Gaussian it has {has}; name \
                     another, or select in a layer whose file has it"
                ));
            }
        };
        let mut property = Property::new(name, Vec::new());
        property.single = single;
        properties.push(property);
    }
    Ok(properties)
}

/// The number of `f_rest_*` properties, which must be numbered from 0 without a gap.
fn count_rest(vertex: &ElementDef) -> Result<usize, String> {
    let names = || {
        let names = vertex.properties.keys();
        names.filter_map(|name| Some((name, name.strip_prefix("f_rest_")?)))
    };
    let count = names().count();
    for (name, digits) in names() {
        match digits.parse::<usize>() {
            Ok(number) if number.to_string() != digits => {}
            Ok(number) if number < count => continue,
            Ok(_) => {
                let gap =
                    (0..count).find(|i| !vertex.properties.contains_key(&format!("f_rest_{i}")));
                return Err(format!(
                    "the f_rest properties have a gap: there is `{}` but no f_rest_{}; export the scene again",
                    shortened(name),
                    gap.unwrap_or(count)
                ));
            }
            Err(_) => {}
        }
        return Err(format!(
            "`{}` is not a valid spherical-harmonics property (f_rest_ and a number); export the scene again",
            shortened(name)
        ));
    }
    Ok(count)
}

/// The slot of a property, where a Gaussian with `rest` of the `f_rest` properties has it. Files store those channel by
/// channel: all of red, then green, then blue.
fn slot_of(name: &str, rest: usize) -> Option<usize> {
    if let Some(number) = name.strip_prefix("f_rest_") {
        let number: usize = number.parse().ok()?;
        if number >= rest {
            return None; // a name that was asked for may be one of a higher degree than the file's
        }
        let a_channel = rest / 3;
        let slot = SH + 3 + 3 * (number % a_channel) + number / a_channel;
        return (slot < SLOTS).then_some(slot);
    }
    FIXED.iter().position(|&fixed| fixed == name)
}

impl From<&PropertyType> for Field {
    /// A property that we skip, until it gets a slot.
    fn from(kind: &PropertyType) -> Self {
        match kind {
            PropertyType::Scalar(kind) => Self::Scalar(kind.into(), None),
            PropertyType::List(length, item) => Self::List(length.into(), item.into()),
        }
    }
}

/// Bytes of one such element in a binary payload, if it has no list.
pub(super) fn fixed_size(element: &ElementDef) -> Option<u64> {
    element
        .properties
        .values()
        .try_fold(0_u64, |sum, p| match Field::from(&p.data_type) {
            Field::Scalar(kind, _) => Some(sum + kind.size() as u64),
            Field::List(..) => None,
        })
}

/// The fewest bytes a field can take: in ascii a digit and a separator, in binary an empty list's length.
fn least_size(field: Field, encoding: Encoding) -> u64 {
    match (encoding, field) {
        (Encoding::Ascii, _) => 2,
        (_, Field::Scalar(kind, _) | Field::List(kind, _)) => kind.size() as u64,
    }
}
