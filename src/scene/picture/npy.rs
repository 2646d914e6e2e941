//! NumPy's files of one array.

/// The bytes of a `.npy` file (version 1.0) of single-precision numbers, row by row; `shape` has the length along each axis.
pub(super) fn encoded(shape: &[usize], values: &[f32]) -> Vec<u8> {
    let lengths: String = shape.iter().map(|length| format!("{length}, ")).collect();
    let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({lengths}), }}");
    // The array begins at a multiple of 64 bytes, behind the line's end.
    let start = (10 + header.len() + 1).next_multiple_of(64);
    header.extend(std::iter::repeat_n(' ', start - 10 - header.len() - 1));
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\0".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}
