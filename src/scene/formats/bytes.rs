//! The bytes of a file, taken from the front; nothing is taken that is not there.

use rara_base::counted::counted;

/// What is left of a file, or of a part of one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl<'a> Bytes<'a> {
    /// The next `count` bytes, which hold `what`.
    pub(super) fn take(&mut self, count: u64, what: &str) -> Result<&'a [u8], String> {
        let split = usize::try_from(count).ok();
        let split = split.and_then(|count| self.0.split_at_checked(count));
        let (taken, rest) = split.ok_or_else(|| {
            format!(
                "{what} takes {}, but {} are left; the file is cut off or its header wrong, get it again",
                counted(count, "byte"),
                self.0.len()
            )
        })?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], String> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N as u64, what)?);
        Ok(array)
    }

    pub(super) fn u8(&mut self, what: &str) -> Result<u8, String> {
        self.array::<1>(what).map(|[byte]| byte)
    }

    pub(super) fn u16(&mut self, what: &str) -> Result<u16, String> {
        self.array(what).map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self, what: &str) -> Result<u32, String> {
        self.array(what).map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self, what: &str) -> Result<u64, String> {
        self.array(what).map(u64::from_le_bytes)
    }

    pub(super) fn f32(&mut self, what: &str) -> Result<f32, String> {
        self.array(what).map(f32::from_le_bytes)
    }
}

/// The single-precision number at a place that is known to be there.
pub(super) fn f32_at(bytes: &[u8], at: usize) -> f64 {
    let mut array = [0; 4];
    array.copy_from_slice(&bytes[at..at + 4]);
    f32::from_le_bytes(array).into()
}

/// The half-precision number at a place that is known to be there.
pub(super) fn f16_at(bytes: &[u8], at: usize) -> f64 {
    half::f16::from_le_bytes([bytes[at], bytes[at + 1]]).into()
}

/// The 16-bit number at a place that is known to be there.
pub(super) fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([bytes[at], bytes[at + 1]])
}
