//! Streams of deflate, gzip and zstd to bytes, of which there are as many as are known to be needed.

use std::io::{self, Read};

use flate2::bufread::GzDecoder;
use structured_zstd::decoding::StreamingDecoder;

use super::Failure;
use rara_base::counted::counted;

/// No stream of deflate becomes larger than this many times itself.
const MOST_DEFLATE: u64 = 1040;

/// The first bytes of a gzip stream, and how to read on.
pub(super) struct Gzip<'a>(GzDecoder<&'a [u8]>);

impl<'a> Gzip<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self(GzDecoder::new(bytes))
    }

    /// The next `count` bytes, or as many as there are. Memory grows with what comes out of the stream.
    pub(super) fn next(&mut self, count: u64) -> Result<Vec<u8>, Failure> {
        let mut read = Vec::new();
        (&mut self.0)
            .take(count)
            .read_to_end(&mut read)
            .map_err(|error| failed("gzip", &error))?;
        Ok(read)
    }

    /// Bytes that come after, in the stream and behind it. This checks the stream's sum, too.
    pub(super) fn rest(mut self) -> Result<u64, Failure> {
        let inside =
            io::copy(&mut self.0, &mut io::sink()).map_err(|error| failed("gzip", &error))?;
        Ok(inside + self.0.into_inner().len() as u64)
    }
}

fn failed(what: &str, error: &io::Error) -> Failure {
    match error.kind() {
        io::ErrorKind::OutOfMemory => Failure::Memory(format!("what its {what} stream holds")),
        _ => damaged(what, error),
    }
}

fn damaged(what: &str, error: &dyn std::fmt::Display) -> Failure {
    let error = rara_base::error::shortened(&error.to_string());
    Failure::Format(format!(
        "its {what} stream is damaged ({error}); get the file again"
    ))
}

/// True where so many bytes may come out of a stream of deflate. Other formats can do better on what is all the same, but
/// on no scene: what promises more is refused before there is memory for it.
pub(super) fn may_become(stream: usize, bytes: u64) -> bool {
    bytes <= (stream as u64).saturating_mul(MOST_DEFLATE)
}

/// The `size` bytes that a stream of zstd stands for; `what` is what is in it.
pub(super) fn zstd(stream: &[u8], size: u64, what: &str) -> Result<Vec<u8>, Failure> {
    if size == 0 {
        return Ok(Vec::new());
    }
    let decoder = StreamingDecoder::new(stream);
    exactly(decoder, size, "zstd", what)
}

/// All bytes of a stream of a `kind`, which has to have `size`; `what` is what is in it.
pub(super) fn exactly(
    from: impl Read,
    size: u64,
    kind: &str,
    what: &str,
) -> Result<Vec<u8>, Failure> {
    let mut read = Vec::new();
    let mut from = from.take(size.saturating_add(1));
    from.read_to_end(&mut read)
        .map_err(|error| failed(kind, &error))?;
    match read.len() as u64 == size {
        true => Ok(read),
        false => Err(Failure::Format(format!(
            "the {kind} stream of {what} does not have the {} that are promised, but {}; get the file again",
            counted(size, "byte"),
            if read.len() as u64 > size {
                "more".to_owned()
            } else {
                read.len().to_string()
            }
        ))),
    }
}
