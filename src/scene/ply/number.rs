//! The number types of PLY and glTF, and how bytes store them.

use ply_rs::ply::ScalarType;

/// The library's type of the same meaning, but `Copy`.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl From<&ScalarType> for Number {
    fn from(kind: &ScalarType) -> Self {
        match kind {
            ScalarType::Char => Self::I8,
            ScalarType::UChar => Self::U8,
            ScalarType::Short => Self::I16,
            ScalarType::UShort => Self::U16,
            ScalarType::Int => Self::I32,
            ScalarType::UInt => Self::U32,
            ScalarType::Float => Self::F32,
            ScalarType::Double => Self::F64,
        }
    }
}

impl Number {
    /// Bytes of one.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number at the start of `bytes`, which hold at least its size. Every type fits a double.
    #[inline]
    pub(crate) fn decode(self, bytes: &[u8], big_endian: bool) -> f64 {
        match self {
            Self::I8 => f64::from(bytes[0] as i8),
            Self::U8 => f64::from(bytes[0]),
            Self::I16 => f64::from(i16::from_le_bytes(little(bytes, big_endian))),
            Self::U16 => f64::from(u16::from_le_bytes(little(bytes, big_endian))),
            Self::I32 => f64::from(i32::from_le_bytes(little(bytes, big_endian))),
            Self::U32 => f64::from(u32::from_le_bytes(little(bytes, big_endian))),
            Self::F32 => f64::from(f32::from_le_bytes(little(bytes, big_endian))),
            Self::F64 => f64::from_le_bytes(little(bytes, big_endian)),
        }
    }
}

/// The first bytes in little-endian order.
fn little<const N: usize>(bytes: &[u8], big_endian: bool) -> [u8; N] {
    let mut array = [0; N];
    array.copy_from_slice(&bytes[..N]);
    if big_endian {
        array.reverse();
    }
    array
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_in_both_orders() {
        let cases: [(Number, &[u8], f64); 8] = [
            (Number::I8, &[0xfe], -2.0),
            (Number::U8, &[0xfe], 254.0),
            (Number::I16, &[0xfe, 0xff], -2.0),
            (Number::U16, &[0xfe, 0xff], 65534.0),
            (Number::I32, &[0xfe, 0xff, 0xff, 0xff], -2.0),
            (Number::U32, &[0xfe, 0xff, 0xff, 0xff], 4294967294.0),
            (Number::F32, &[0, 0, 0xc0, 0x3f], 1.5),
            (Number::F64, &[0, 0, 0, 0, 0, 0, 0xf8, 0xbf], -1.5),
        ];
        for (kind, bytes, value) in cases {
            assert_eq!(kind.size(), bytes.len());
            assert_eq!(kind.decode(bytes, false), value);
            let reversed: Vec<u8> = bytes.iter().rev().copied().collect();
            assert_eq!(kind.decode(&reversed, true), value);
        }
    }
}
