//! The buffers of a document: in the same file, in its text, or in files beside it.

use std::borrow::Cow;
use std::collections::BTreeMap;

use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use meshoptimizer_rs::codec::{
    decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat,
    decode_index_buffer, decode_index_sequence, decode_vertex_buffer,
};
use meshoptimizer_rs::{Error, Workspace};
use percent_encoding::percent_decode_str;
use serde_json::Value;

use super::super::{Failure, Files, list};
use super::size;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// What names of the compression of views by meshoptimizer begin or end with: Khronos' and the older one.
const MESHOPT: &str = "_meshopt_compression";

/// Buffers, each read when it is first asked for.
pub(super) struct Buffers<'a> {
    uris: Vec<Option<&'a str>>,
    binary: Option<&'a [u8]>,
    files: Files<'a>,
    read: BTreeMap<usize, Cow<'a, [u8]>>,
    /// The bytes of views that were compressed.
    decoded: BTreeMap<u64, Vec<u8>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(document: &'a Value, binary: Option<&'a [u8]>, files: Files<'a>) -> Self {
        let buffers = list(document, "buffers").iter();
        Self {
            uris: buffers
                .map(|buffer| buffer.get("uri").and_then(Value::as_str))
                .collect(),
            binary,
            files,
            read: BTreeMap::new(),
            decoded: BTreeMap::new(),
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
                        Cow::Owned(self.files.get(&name)?)
                    }
                },
            };
            self.read.insert(number, bytes);
        }
        Ok(&self.read[&number])
    }

    /// Bytes of all buffers that were needed so far, and of what was decompressed.
    pub(super) fn size(&self) -> usize {
        let read = self.read.values().map(|bytes| bytes.len());
        read.chain(self.decoded.values().map(Vec::len)).sum()
    }

    /// The bytes that a view, or what it says of its compression, has in its buffer.
    fn bytes(&mut self, of: &Value, wrong: &dyn Fn(&str) -> Failure) -> Result<&[u8], Failure> {
        let first = size(of, "byteOffset").unwrap_or(0);
        let end = size(of, "byteLength").and_then(|length| first.checked_add(length));
        let buffer = size(of, "buffer").ok_or_else(|| wrong("has no buffer"))?;
        let bytes = self.read(buffer)?;
        let bytes = end.and_then(|end| bytes.get(first..end));
        bytes.ok_or_else(|| wrong("reaches beyond its buffer, which may be cut off"))
    }

    /// Decompresses a view by meshoptimizer, as the extension of a name says.
    fn decode(
        &mut self,
        name: &str,
        part: &Value,
        wrong: &dyn Fn(&str) -> Failure,
    ) -> Result<Vec<u8>, Failure> {
        let name = shortened(name);
        let unknown = |what: &str, word: &str| {
            wrong(&format!(
                "is compressed by {name} with the {what} {}, which is not read",
                shortened(word)
            ))
        };
        let no_layout = || wrong(&format!("has no count, byteStride or mode of {name}"));
        let layout = size(part, "count").zip(size(part, "byteStride"));
        let (count, stride) = layout.ok_or_else(no_layout)?;
        let mode = part.get("mode").and_then(Value::as_str);
        let decode = match mode.ok_or_else(no_layout)? {
            "ATTRIBUTES" => decode_vertex_buffer,
            "TRIANGLES" => decode_index_buffer,
            "INDICES" => decode_index_sequence,
            mode => return Err(unknown("mode", mode)),
        };
        let filter = match part.get("filter").and_then(Value::as_str).unwrap_or("NONE") {
            "NONE" => |_: &mut [u8], _, _, _: &mut Workspace| Ok(()),
            "OCTAHEDRAL" => decode_filter_oct,
            "QUATERNION" => decode_filter_quat,
            "EXPONENTIAL" => decode_filter_exp,
            "COLOR" => decode_filter_color,
            filter => return Err(unknown("filter", filter)),
        };
        let source = self.bytes(part, wrong)?;
        // It takes no memory for more than the source can be.
        let scratch = &mut Workspace::default();
        let decoded = decode(count, stride, source, scratch).and_then(|mut bytes| {
            filter(&mut bytes, count, stride, scratch)?;
            Ok(bytes)
        });
        decoded.map_err(|error| match error {
            Error::AllocationFailed => Failure::Memory(counted(count, "element")),
            error => wrong(&format!("is not compressed by {name} as it says ({error})")),
        })
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
        let stride = size(view, "byteStride");
        let extensions = view.get("extensions").and_then(Value::as_object);
        let compression = extensions
            .into_iter()
            .flatten()
            .find(|(name, _)| name.contains("compression"));
        match compression {
            Some((name, part)) if name.ends_with(MESHOPT) => {
                if !self.decoded.contains_key(&number) {
                    let decoded = self.decode(name, part, &wrong)?;
                    self.decoded.insert(number, decoded);
                }
                Ok((&self.decoded[&number], stride))
            }
            Some((name, _)) => Err(wrong(&format!(
                "is compressed by {}, which is not read",
                shortened(name)
            ))),
            None => Ok((self.bytes(view, &wrong)?, stride)),
        }
    }
}

/// The bytes of `TYPE;base64,TEXT`.
fn from_data(data: &str) -> Result<Vec<u8>, String> {
    let wrong = || "a buffer in the glTF's text is not base64; export the scene again".to_owned();
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
