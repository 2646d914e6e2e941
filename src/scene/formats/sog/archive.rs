//! The files in a zip archive, stored or deflated: what `.sog` files are.

use super::super::bytes::Bytes;
use super::super::inflate;
use super::Failure;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// Files of an archive that are looked at, at most.
const MOST_FILES: u16 = 1000;
/// Bytes of the record at the archive's end, and how long its comment can be.
const END: usize = 22;
const COMMENT: usize = 65535;

struct Entry<'a> {
    name: &'a [u8],
    method: u16,
    crc: u32,
    stored: u64,
    size: u64,
    /// Where its own header begins.
    at: usize,
}

/// An archive's directory.
pub(super) struct Archive<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry<'a>>,
}

impl<'a> Archive<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Failure> {
        let lost = || {
            Failure::Format(
                "this is a zip archive without its directory, which is at the end; it is cut off, get it again".into(),
            )
        };
        let last = bytes.len().checked_sub(END).ok_or_else(lost)?;
        let first = last.saturating_sub(COMMENT);
        let end = (first..=last)
            .rev()
            .find(|&at| bytes[at..].starts_with(b"PK\x05\x06"));
        let what = "the archive's directory";
        let mut end = Bytes(&bytes[end.ok_or_else(lost)? + 8..]);
        end.u16(what)?;
        let count = end.u16(what)?;
        let (size, at) = (end.u32(what)?, end.u32(what)?);
        if count == u16::MAX || at == u32::MAX {
            return Err(Failure::Format(
                "this is a zip archive of more than 4 GiB, which is not read; unpack it and give its meta.json".into(),
            ));
        }
        let mut directory = Bytes(bytes);
        directory.take(at.into(), what)?;
        let mut directory = Bytes(directory.take(size.into(), what)?);
        let mut entries = Vec::new();
        for _ in 0..count.min(MOST_FILES) {
            if directory.u32(what)? != 0x0201_4b50 {
                return Err(lost());
            }
            directory.take(6, what)?;
            let method = directory.u16(what)?;
            directory.take(4, what)?;
            let crc = directory.u32(what)?;
            let (stored, size) = (directory.u32(what)?, directory.u32(what)?);
            let name = directory.u16(what)?;
            let (extra, comment) = (directory.u16(what)?, directory.u16(what)?);
            directory.take(8, what)?;
            let at = directory.u32(what)? as usize;
            let name = directory.take(name.into(), what)?;
            directory.take(u64::from(extra) + u64::from(comment), what)?;
            entries.push(Entry {
                name,
                method,
                crc,
                stored: stored.into(),
                size: size.into(),
                at,
            });
        }
        Ok(Self { bytes, entries })
    }

    /// The file of a name, in whatever folder of the archive.
    pub(super) fn get(&self, name: &str) -> Result<Vec<u8>, Failure> {
        let quoted = shortened(name);
        let is_it = |entry: &&Entry<'_>| {
            let own = entry
                .name
                .rsplit(|&byte| byte == b'/' || byte == b'\\')
                .next();
            entry.name == name.as_bytes() || own == Some(name.as_bytes())
        };
        let entry = self.entries.iter().find(is_it).ok_or_else(|| {
            format!("the archive has no file \"{quoted}\", which SOG needs; get the scene again")
        })?;
        let what = format!("the archive's file \"{quoted}\"");
        let mut bytes = Bytes(self.bytes.get(entry.at..).unwrap_or_default());
        if bytes.u32(&what)? != 0x0403_4b50 {
            return Err(Failure::Format(format!(
                "{what} is not where its directory says; get the scene again"
            )));
        }
        bytes.take(22, &what)?;
        let (name, extra) = (bytes.u16(&what)?, bytes.u16(&what)?);
        bytes.take(u64::from(name) + u64::from(extra), &what)?;
        let stored = bytes.take(entry.stored, &what)?;
        let plain = match entry.method {
            0 if entry.size == entry.stored => stored.to_vec(),
            8 if inflate::may_become(stored.len(), entry.size) => {
                inflate::deflate(stored, entry.size, &what)?
            }
            0 | 8 => {
                return Err(Failure::Format(format!(
                    "{what} cannot have {}, as its directory says; get the scene again",
                    counted(entry.size, "byte")
                )));
            }
            method => {
                return Err(Failure::Format(format!(
                    "{what} is compressed by method {method}; pack it stored or deflated"
                )));
            }
        };
        let mut crc = flate2::Crc::new();
        crc.update(&plain);
        if crc.sum() != entry.crc {
            return Err(Failure::Format(format!(
                "{what} does not have the sum that its directory says; get the scene again"
            )));
        }
        Ok(plain)
    }
}
