//! The binary payload, read a few MiB at a time by offsets computed from the header.

use std::io::{BufRead, BufReader, ErrorKind, Read, Seek};

use ply_rs::ply::{ElementDef, Encoding};

use super::Progress;
use super::header::PlyHeader;
use super::layout::{Field, Layout, fixed_size};
use super::number::Number;
use crate::assemble::Assembler;
use crate::failure::Failure;

/// Bytes read at once. A larger chunk gains nothing, a smaller one costs system calls.
const CHUNK: usize = 4 << 20;

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
        let rows_at_once = (CHUNK / stride).max(1);
        let mut chunk = vec![0; stride * rows_at_once.min(layout.count as usize)];
        let mut row = layout.row();
        while assembler.rows < layout.count {
            let rows = (layout.count - assembler.rows).min(rows_at_once as u64) as usize;
            let chunk = &mut chunk[..rows * stride];
            self.fill(chunk, || {
                format!("Gaussian {} of {}", assembler.rows, layout.count)
            })?;
            for bytes in chunk.chunks_exact(stride) {
                for &(offset, kind, slot) in &used {
                    row[slot] = kind.decode(&bytes[offset..], self.big_endian);
                }
                assembler.push(&row);
            }
            progress.left(self.left);
        }
        Ok(())
    }

    /// Gaussians with list properties, which are walked one number at a time.
    fn read_varying(
        &mut self,
        layout: &Layout<'_>,
        assembler: &mut Assembler,
        progress: &mut Progress<'_>,
    ) -> Result<(), Failure> {
        let mut row = layout.row();
        while assembler.rows < layout.count {
            self.walk(
                layout.fields.iter().copied(),
                "Gaussian",
                assembler.rows,
                |slot, value| row[slot] = value,
            )?;
            assembler.push(&row);
            if assembler.rows.is_multiple_of(8192) {
                progress.left(self.left);
            }
        }
        Ok(())
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
