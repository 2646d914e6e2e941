//! Mapped memory that is written and never read.

use std::marker::PhantomData;
use std::ops::Range;
use std::ptr::NonNull;

/// A part of memory, as of mapped memory that a device copies from, which rara writes and never reads: reading it is slow
/// where writes are combined, and hosts lend it for writing alone (`BufferViewMut` of wgpu is such). It is no slice, since a
/// compiler may read through a reference what no code does. A host that has a slice gives it by [`From`].
#[derive(Debug)]
pub struct WriteOnly<'a> {
    bytes: NonNull<[u8]>,
    exclusive: PhantomData<&'a mut [u8]>,
}

// SAFETY: it is used as an exclusive slice of bytes is, which any thread may have.
unsafe impl Send for WriteOnly<'_> {}
// SAFETY: nothing can be done with a shared one but to ask for its size.
unsafe impl Sync for WriteOnly<'_> {}

impl<'a> From<&'a mut [u8]> for WriteOnly<'a> {
    fn from(bytes: &'a mut [u8]) -> Self {
        // SAFETY: what may be written by the reference may be written by the pointer, and is borrowed as long.
        unsafe { Self::new(NonNull::from(bytes)) }
    }
}

impl WriteOnly<'_> {
    /// Memory behind a pointer: it may hold nothing yet, and need not be readable.
    ///
    /// # Safety
    /// `bytes` can be written, and nobody else uses them for the type's lifetime.
    pub const unsafe fn new(bytes: NonNull<[u8]>) -> Self {
        Self {
            bytes,
            exclusive: PhantomData,
        }
    }

    /// Bytes that can be written.
    pub const fn size(&self) -> usize {
        self.bytes.len()
    }

    /// Returns a pointer to the bytes, for code that writes them by itself.
    pub const fn pointer(&mut self) -> NonNull<[u8]> {
        self.bytes
    }

    /// Writes bytes from an offset on.
    ///
    /// # Panics
    /// If they do not lie inside.
    pub fn write(&mut self, offset: usize, bytes: &[u8]) {
        let to = self.part(offset..offset.saturating_add(bytes.len())).bytes;
        // SAFETY: the part is as long as the bytes, can be written and is nobody else's, not even theirs.
        unsafe {
            to.cast::<u8>()
                .copy_from_nonoverlapping(NonNull::from(bytes).cast(), bytes.len())
        };
    }

    /// The bytes in pieces of a size, of which the last may be smaller.
    #[doc(hidden)]
    pub fn chunks(self, size: usize) -> impl Iterator<Item = Self> {
        let mut rest = self.bytes;
        std::iter::from_fn(move || {
            let taken = rest.len().min(size);
            let first = rest.cast::<u8>();
            // SAFETY: inside of what can be written, as there are at least so many bytes.
            let after = unsafe { first.add(taken) };
            rest = NonNull::slice_from_raw_parts(after, rest.len() - taken);
            let chunk = NonNull::slice_from_raw_parts(first, taken);
            // SAFETY: no two pieces share a byte, and this is gone.
            (taken > 0).then(|| unsafe { Self::new(chunk) })
        })
    }

    /// The first bytes of these.
    ///
    /// # Panics
    /// If there are fewer.
    pub(super) fn first(mut self, size: usize) -> Self {
        self.bytes = self.part(0..size).bytes;
        self
    }

    /// A part of the bytes.
    ///
    /// # Panics
    /// If they do not lie inside.
    pub fn part(&mut self, range: Range<usize>) -> WriteOnly<'_> {
        let Range { start, end } = range;
        let size = self.size();
        assert!(
            start <= end && end <= size,
            "the bytes from {start} to {end} do not lie in {size} that can be written"
        );
        // SAFETY: a part of what can be written, and this is borrowed as long as it lives.
        unsafe {
            let first = self.bytes.cast::<u8>().add(start);
            WriteOnly::new(NonNull::slice_from_raw_parts(first, end - start))
        }
    }
}

#[cfg(test)]
mod tests;
