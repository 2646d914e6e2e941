//! The numbers of an attribute.

use serde_json::Value;

use super::super::Failure;
use super::buffers::Buffers;
use super::{index, list};
use rara_base::counted::counted;
use rara_base::error::shortened;

/// An attribute's numbers in memory.
pub(super) struct Accessor {
    bytes: Vec<u8>,
    /// Bytes from one element to the next, and of one part.
    stride: usize,
    kind: ComponentType,
    parts: usize,
    normalized: bool,
}

#[derive(Clone, Copy)]
enum ComponentType {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl ComponentType {
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number of these bytes, and what it is divided by where it is normalised.
    fn number(self, bytes: &[u8]) -> (f64, f64) {
        let two = || [bytes[0], bytes[1]];
        let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
        match self {
            Self::I8 => (f64::from(bytes[0] as i8), 127.0),
            Self::U8 => (f64::from(bytes[0]), 255.0),
            Self::I16 => (f64::from(i16::from_le_bytes(two())), 32767.0),
            Self::U16 => (f64::from(u16::from_le_bytes(two())), 65535.0),
            Self::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
            Self::F32 => (f64::from(f32::from_le_bytes(four())), 1.0),
        }
    }
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
        let accessor = accessor.ok_or_else(|| wrong("has an accessor that there is not"))?;
        if accessor.get("sparse").is_some() {
            return Err(wrong("is sparse, which is not read"));
        }
        if index(accessor, "count") != Some(count) {
            return Err(wrong(&format!(
                "is not of {} as the others are",
                counted(count, "element")
            )));
        }
        let kind = match index(accessor, "componentType") {
            Some(5120) => ComponentType::I8,
            Some(5121) => ComponentType::U8,
            Some(5122) => ComponentType::I16,
            Some(5123) => ComponentType::U16,
            Some(5125) => ComponentType::U32,
            Some(5126) => ComponentType::F32,
            _ => return Err(wrong("is of no known type of numbers")),
        };
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
        let view = index(accessor, "bufferView").ok_or_else(|| wrong("has no bufferView"))?;
        let (bytes, stride) = buffers.view(document, view)?;
        let element = found * kind.size();
        let stride = stride.unwrap_or(element);
        let offset = index(accessor, "byteOffset").unwrap_or(0);
        let size = match count.checked_sub(1) {
            Some(others) => others
                .checked_mul(stride as u64)
                .and_then(|size| size.checked_add(element as u64)),
            None => Some(0),
        };
        let range = size.and_then(|size| {
            let first = usize::try_from(offset).ok()?;
            first
                .checked_add(usize::try_from(size).ok()?)
                .map(|end| first..end)
        });
        let bytes = range
            .and_then(|range| bytes.get(range))
            .filter(|_| stride >= element);
        let bytes = bytes.ok_or_else(|| {
            wrong(&format!(
                "has not the bytes of {}; it may be cut off",
                counted(count, "element")
            ))
        })?;
        Ok(Self {
            bytes: bytes.to_vec(),
            stride,
            kind,
            parts: found,
            // Of floats it means nothing.
            normalized: !matches!(kind, ComponentType::F32)
                && accessor.get("normalized").and_then(Value::as_bool) == Some(true),
        })
    }

    /// One part of an element below the count; the alpha of a colour without is 1.
    pub(super) fn at(&self, element: u64, part: usize) -> f64 {
        if part >= self.parts {
            return 1.0;
        }
        let at = element as usize * self.stride + part * self.kind.size();
        let (number, most) = self.kind.number(&self.bytes[at..]);
        if self.normalized {
            (number / most).max(-1.0)
        } else {
            number
        }
    }
}
