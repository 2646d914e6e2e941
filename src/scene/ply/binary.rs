//! The binary payload, read a part at a time by offsets computed from the header.

use std::io::{BufRead, BufReader, ErrorKind, Read, Seek};
use std::ops::Range;

use ply_rs::ply::{ElementDef, Encoding};

use super::header::PlyHeader;
use super::layout::{Field, Layout, fixed_size};
use super::number::Number;
use crate::assemble::{Assembler, ROWS};
use crate::failure::Failure;
use crate::input::Progress;

/// Bytes read at once: few enough to stay in the processor's cache until they are parsed, and enough to make system calls
/// cheap.
const CHUNK: usize = 1 << 18;

struct Payload<R> {
    reader: BufReader<R>,
    /// Bytes of the file not yet read.
    left: u64,
    big_endian: bool,
}

/// Reads the payload that begins at `source`'s position into `assembler`; `left` bytes remain of it there.
pub(super) fn read<R: Read + Seek>(
    source: R,
    left: u64,
    header: &PlyHeader,
    layout: &Layout<'_>,
    assembler: &mut Assembler,
    progress: &mut Progress<'_>,
) -> Result<(), Failure> {
    let mut payload = Payload {
        reader: BufReader::with_capacity(1 << 18, source),
        left,
        big_endian: header.encoding == Encoding::BinaryBigEndian,
    };
    for element in layout.before {
        payload.skip_element(element)?;
    }
    let fixed = layout.fields.iter().all(|f| matches!(f, Field::Scalar(..)));
    if fixed {
        payload.read_fixed(layout, assembler, progress)?;
    } else {
        payload.read_varying(layout, assembler, progress)?;
    }
    assembler.report.trailing_bytes = layout
        .after
        .map_or(0, |after| payload.left.saturating_sub(after));
    Ok(())
}

impl<R: Read + Seek> Payload<R> {
    /// Gaussians without lists: whole rows of equal size, the used numbers at fixed offsets.
    fn read_fixed(
        &mut self,
        layout: &Layout<'_>,
        assembler: &mut Assembler,
        progress: &mut Progress<'_>,
    ) -> Result<(), Failure> {
        let mut used = Vec::new();
        let mut stride = 0;
        for field in &layout.fields {
            if let Field::Scalar(kind, slot) = *field {
                used.extend(slot.map(|slot| (stride, kind, slot)));
                stride += kind.size();
            }
        }
        let big_endian = self.big_endian;
        // As trainers write them; knowing it once is faster than asking for each.
        let is_usual = !big_endian && used.iter().all(|&(_, kind, _)| matches!(kind, Number::F32));
        let read = |numbers: Range<u64>| {
            let mut rows = vec![0; stride * (numbers.end - numbers.start) as usize];
            self.fill(&mut rows, || {
                format!("Gaussian {} of {}", numbers.start, layout.count)
            })?;
            progress.left(self.left);
            Ok(rows)
        };
        assembler.read((CHUNK / stride).max(1), read, |bytes, rows| {
            let mut row = layout.row();
            for bytes in bytes.chunks_exact(stride) {
                match is_usual {
                    true => used.iter().for_each(|&(offset, _, slot)| {
                        row[slot] = Number::F32.decode(&bytes[offset..], false);
                    }),
                    false => used.iter().for_each(|&(offset, kind, slot)| {
                        row[slot] = kind.decode(&bytes[offset..], big_endian);
                    }),
                }
                rows.push(&row);
            }
            Ok(())
        })
    }

    /// Gaussians with list properties, which are walked one number at a time.
    fn read_varying(
        &mut self,
        layout: &Layout<'_>,
        assembler: &mut Assembler,
        progress: &mut Progress<'_>,
    ) -> Result<(), Failure> {
        let slots = layout.row().len();
        let read = |numbers: Range<u64>| {
            let mut rows = vec![0.0; slots * (numbers.end - numbers.start) as usize];
            for (number, row) in numbers.zip(rows.chunks_exact_mut(slots)) {
                let fields = layout.fields.iter().copied();
                self.walk(fields, "Gaussian", number, |slot, value| row[slot] = value)?;
            }
            progress.left(self.left);
            Ok(rows)
        };
        assembler.read(ROWS, read, |read, rows| {
            read.chunks_exact(slots).for_each(|row| rows.push(row));
            Ok(())
        })
    }

    fn skip_element(&mut self, element: &ElementDef) -> Result<(), Failure> {
        let (name, count) = (&element.name, element.count as u64);
        if let Some(size) = fixed_size(element) {
            // In range: the size check before reading multiplied the same numbers.
            return self.skip(count.saturating_mul(size), || {
                format!("the {count} `{name}` elements")
            });
        }
        for index in 0..count {
            let fields = element
                .properties
                .values()
                .map(|p| Field::from(&p.data_type));
            self.walk(fields, name, index, |_, _| ())?;
        }
        Ok(())
    }

    /// Reads one row number by number, giving each used one to `put`.
    fn walk(
        &mut self,
        fields: impl Iterator<Item = Field>,
        element: &str,
        index: u64,
        mut put: impl FnMut(usize, f64),
    ) -> Result<(), Failure> {
        let place = || format!("{element} {index}");
        for field in fields {
            match field {
                Field::Scalar(kind, slot) => {
                    let value = self.number(kind, place)?;
                    if let Some(slot) = slot {
                        put(slot, value);
                    }
                }
                Field::List(length, item) => {
                    let items = self.number(length, place)?;
                    if items < 0.0 {
                        let text = format!(
                            "a list in {} has the length {items}; export the scene again",
                            place()
                        );
                        return Err(Failure::Format(text));
                    }
                    // At most 2^32 items of 8 bytes.
                    self.skip(items as u64 * item.size() as u64, place)?;
                }
            }
        }
        Ok(())
    }

    fn number(&mut self, kind: Number, place: impl Fn() -> String) -> Result<f64, Failure> {
        let mut bytes = [0; 8];
        self.fill(&mut bytes[..kind.size()], place)?;
        Ok(kind.decode(&bytes, self.big_endian))
    }

    fn fill(&mut self, bytes: &mut [u8], place: impl Fn() -> String) -> Result<(), Failure> {
        self.take(bytes.len() as u64, &place)?;
        self.reader
            .read_exact(bytes)
            .map_err(|error| match error.kind() {
                // This happens only if the file shrank while it was read, since its size was checked.
                ErrorKind::UnexpectedEof => Failure::Format(cut_off(&place())),
                _ => Failure::Io(error),
            })
    }

    fn skip(&mut self, mut bytes: u64, place: impl Fn() -> String) -> Result<(), Failure> {
        self.take(bytes, &place)?;
        while bytes > 0 {
            // Steps within the buffer keep it, longer ones seek. A seek takes a signed number, so one step cannot cover
            // all of u64.
            let step = bytes.min(1 << 40);
            let buffered = self.reader.buffer().len() as u64;
            if step <= buffered {
                self.reader.consume(step as usize);
            } else {
                self.reader.seek_relative(step as i64)?;
            }
            bytes -= step;
        }
        Ok(())
    }

    fn take(&mut self, bytes: u64, place: &impl Fn() -> String) -> Result<(), Failure> {
        let left = self.left.checked_sub(bytes);
        self.left = left.ok_or_else(|| Failure::Format(cut_off(&place())))?;
        Ok(())
    }
}

fn cut_off(place: &str) -> String {
    format!("the file ends inside {place}; it is cut off (or its header wrong), get it again")
}
