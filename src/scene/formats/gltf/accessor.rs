//! The numbers of an attribute.

use serde_json::Value;

use super::super::{Failure, list};
use super::buffers::Buffers;
use super::index;
use crate::ply::Number;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// An attribute's numbers in memory.
pub(super) struct Accessor {
    bytes: Vec<u8>,
    /// Bytes from one element to the next.
    stride: usize,
    kind: Number,
    parts: usize,
    /// What they are divided by.
    most: Option<f64>,
    /// The elements that have other numbers, which ascend, and the bytes of these one behind the other.
    sparse: (Vec<u64>, Vec<u8>),
}

/// The type that something's numbers are of, and what normalised ones are divided by, which floats never are.
fn component_type(of: &Value) -> Option<(Number, Option<f64>)> {
    Some(match index(of, "componentType")? {
        5120 => (Number::I8, Some(127.0)),
        5121 => (Number::U8, Some(255.0)),
        5122 => (Number::I16, Some(32767.0)),
        5123 => (Number::U16, Some(65535.0)),
        5125 => (Number::U32, Some(u32::MAX.into())),
        5126 => (Number::F32, None),
        _ => return None,
    })
}

impl Accessor {
    /// The accessor of a number, of `count` elements with `parts` parts (or three of four, for colours without alpha).
    pub(super) fn from_json(
        document: &Value,
        buffers: &mut Buffers<'_>,
        number: usize,
        name: &str,
        count: u64,
        parts: usize,
    ) -> Result<Self, Failure> {
        let name = shortened(name);
        let wrong = |what: &str| {
            Failure::Format(format!(
                "the attribute {name} {what}; export the scene again"
            ))
        };
        let accessor = list(document, "accessors").get(number);
        let accessor =
            accessor.ok_or_else(|| wrong("refers to an accessor that the file does not have"))?;
        if index(accessor, "count") != Some(count) {
            return Err(wrong(&format!(
                "is not of {} as the others are",
                counted(count, "element")
            )));
        }
        let no_type = || wrong("is of no known type of numbers");
        let (kind, most) = component_type(accessor).ok_or_else(no_type)?;
        let found = match accessor.get("type").and_then(Value::as_str) {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            _ => 0,
        };
        if found != parts && !(name == "COLOR_0" && found == 3) {
            return Err(wrong(&format!("has not {}", counted(parts, "part"))));
        }
        let element = found * kind.size();
        let mut read = |part: &Value, count: u64, element: usize| {
            elements(document, buffers, part, count, element)?.ok_or_else(|| {
                wrong(&format!(
                    "has not the bytes of {}; it may be cut off",
                    counted(count, "element")
                ))
            })
        };
        let (bytes, stride) = match accessor.get("bufferView") {
            Some(_) => read(accessor, count, element)?,
            // What sparse elements do not replace is zero then.
            None => (vec![0; element], 0),
        };
        let mut sparse = (Vec::new(), Vec::new());
        if let Some(part) = accessor.get("sparse") {
            let no_part = || wrong("is sparse without a count, indices or values");
            let [indices, values] = ["indices", "values"].map(|key| part.get(key));
            let replaced = index(part, "count").ok_or_else(no_part)?;
            let (indices, values) = indices.zip(values).ok_or_else(no_part)?;
            let (kind, _) = component_type(indices).ok_or_else(no_type)?;
            let (places, stride) = read(indices, replaced, kind.size())?;
            let place = |at: usize| kind.decode(&places[at * stride..], false) as u64;
            sparse.0 = (0..replaced as usize).map(place).collect();
            let is_in_order = sparse.0.windows(2).all(|pair| pair[0] < pair[1]);
            if !is_in_order || sparse.0.last().is_some_and(|last| *last >= count) {
                return Err(wrong(
                    "has sparse indices that do not ascend, or end beyond its elements",
                ));
            }
            let (bytes, stride) = read(values, replaced, element)?;
            sparse.1 = (0..replaced as usize)
                .flat_map(|at| &bytes[at * stride..][..element])
                .copied()
                .collect();
        }
        Ok(Self {
            bytes,
            stride,
            kind,
            parts: found,
            most: most
                .filter(|_| accessor.get("normalized").and_then(Value::as_bool) == Some(true)),
            sparse,
        })
    }

    /// One part of an element below the count; the alpha of a colour without is 1.
    pub(super) fn at(&self, element: u64, part: usize) -> f64 {
        if part >= self.parts {
            return 1.0;
        }
        let size = self.kind.size();
        let (places, values) = &self.sparse;
        let bytes = match places.binary_search(&element) {
            Ok(at) => &values[at * self.parts * size..],
            Err(_) => &self.bytes[element as usize * self.stride..],
        };
        let number = self.kind.decode(&bytes[part * size..], false);
        self.most.map_or(number, |most| (number / most).max(-1.0))
    }
}

/// The bytes of so many elements of a size, and those from one to the next; `None` where there are not as many.
fn elements(
    document: &Value,
    buffers: &mut Buffers<'_>,
    of: &Value,
    count: u64,
    element: usize,
) -> Result<Option<(Vec<u8>, usize)>, Failure> {
    let Some(view) = index(of, "bufferView") else {
        return Ok(None);
    };
    let (bytes, stride) = buffers.view(document, view)?;
    let stride = stride.unwrap_or(element);
    let range = || {
        let first = usize::try_from(index(of, "byteOffset").unwrap_or(0)).ok()?;
        let size = match usize::try_from(count).ok()?.checked_sub(1) {
            Some(others) => others.checked_mul(stride)?.checked_add(element)?,
            None => 0,
        };
        bytes.get(first..first.checked_add(size)?)
    };
    let bytes = range().filter(|_| stride >= element);
    Ok(bytes.map(|bytes| (bytes.to_vec(), stride)))
}
