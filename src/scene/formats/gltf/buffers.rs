//! The buffers of a document: in the same file, in its text, or in files beside it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use percent_encoding::percent_decode_str;
use serde_json::Value;

use super::super::{Failure, beside};
use super::{index, list};

/// Buffers, each read when it is first asked for.
pub(super) struct Buffers<'a> {
    uris: Vec<Option<&'a str>>,
    binary: Option<&'a [u8]>,
    folder: Option<&'a Path>,
    read: BTreeMap<usize, Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        document: &'a Value,
        binary: Option<&'a [u8]>,
        folder: Option<&'a Path>,
    ) -> Self {
        let buffers = list(document, "buffers").iter();
        Self {
            uris: buffers
                .map(|buffer| buffer.get("uri").and_then(Value::as_str))
                .collect(),
            binary,
            folder,
            read: BTreeMap::new(),
        }
    }

    fn read(&mut self, number: usize) -> Result<&[u8], Failure> {
        if !self.read.contains_key(&number) {
            let missing = || {
                format!("the glTF has no buffer {number}, which is needed; export the scene again")
            };
            let bytes = match self.uris.get(number).copied().ok_or_else(missing)? {
                None => Cow::Borrowed(self.binary.filter(|_| number == 0).ok_or_else(missing)?),
                Some(uri) => match uri.strip_prefix("data:") {
                    Some(data) => Cow::Owned(from_data(data)?),
                    None => {
                        let name = percent_decode_str(uri).decode_utf8_lossy();
                        Cow::Owned(beside(&name, self.folder)?)
                    }
                },
            };
            self.read.insert(number, bytes);
        }
        Ok(&self.read[&number])
    }

    /// Bytes of all buffers that were needed so far.
    pub(super) fn size(&self) -> usize {
        self.read.values().map(|bytes| bytes.len()).sum()
    }

    /// The bytes of a view, and those from one of its elements to the next where that is said.
    pub(super) fn view(
        &mut self,
        document: &Value,
        number: u64,
    ) -> Result<(&[u8], Option<usize>), Failure> {
        let wrong = |what: &str| {
            Failure::Format(format!(
                "bufferView {number} {what}; export the scene again"
            ))
        };
        let view = usize::try_from(number)
            .ok()
            .and_then(|at| list(document, "bufferViews").get(at));
        let view = view.ok_or_else(|| wrong("is not there"))?;
        let extensions = view.get("extensions").and_then(Value::as_object);
        if let Some(name) = extensions
            .into_iter()
            .flatten()
            .map(|(name, _)| name)
            .find(|n| n.contains("compression"))
        {
            let name = rara_base::error::shortened(name);
            return Err(wrong(&format!(
                "is compressed by {name}, which is not read"
            )));
        }
        let size = |key: &str| index(view, key).and_then(|size| usize::try_from(size).ok());
        let first = size("byteOffset").unwrap_or(0);
        let end = size("byteLength").and_then(|length| first.checked_add(length));
        let buffer = size("buffer").ok_or_else(|| wrong("has no buffer"))?;
        let bytes = self.read(buffer)?;
        let bytes = end.and_then(|end| bytes.get(first..end));
        let bytes =
            bytes.ok_or_else(|| wrong("reaches beyond its buffer, which may be cut off"))?;
        Ok((bytes, size("byteStride")))
    }
}

/// The bytes of `TYPE;base64,TEXT`.
fn from_data(data: &str) -> Result<Vec<u8>, String> {
    let wrong = || "a buffer in the glTF's text is no base64; export the scene again".to_owned();
    let (kind, text) = data.split_once(',').ok_or_else(wrong)?;
    if !kind.ends_with(";base64") {
        return Err(wrong());
    }
    // Some writers take the alphabet of URLs, and some leave the end unfilled.
    let text = text
        .trim_end_matches('=')
        .replace('-', "+")
        .replace('_', "/");
    STANDARD_NO_PAD.decode(text).map_err(|_| wrong())
}
