use super::*;
use std::mem::MaybeUninit;

#[test]
fn memory_that_holds_nothing_is_written_where_it_is_meant_to_be() {
    let mut memory = [MaybeUninit::<u8>::uninit(); 6];
    let first = NonNull::from(&mut memory).cast();
    // SAFETY: six bytes that can be written, and nobody uses them until they are read below.
    let mut bytes = unsafe { WriteOnly::new(NonNull::slice_from_raw_parts(first, 6)) };
    assert_eq!(bytes.size(), 6);
    bytes.write(0, &[1, 2, 3, 4]);
    bytes.part(3..6).write(0, &[5, 6, 7]);
    bytes.write(6, &[]);
    // SAFETY: all of them have been written.
    let read = memory.map(|byte| unsafe { byte.assume_init() });
    assert_eq!(read, [1, 2, 3, 5, 6, 7]);
}

#[test]
fn chunks_hold_every_byte_once() {
    let mut bytes = [0; 8];
    let chunks = WriteOnly::from(&mut bytes[..]).chunks(3);
    for (number, mut chunk) in (1..).zip(chunks) {
        let size = chunk.size();
        chunk.write(0, &[number; 3][..size]);
    }
    assert_eq!(bytes, [1, 1, 1, 2, 2, 2, 3, 3]);
}

#[test]
#[should_panic(expected = "from 5 to 7 do not lie in 6")]
fn nothing_is_written_beside_it() {
    WriteOnly::from(&mut [0; 6][..]).write(5, &[1, 2]);
}
