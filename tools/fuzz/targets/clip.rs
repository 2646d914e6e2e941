//! The text of `--clip`: shapes by line, joined by the last line's `and` or `or`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rara::{Clip, ClipOp, Shape};
use rara_fuzz::{assert_readable, assert_surface, within};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let op = if text.ends_with("or") {
        ClipOp::Or
    } else {
        ClipOp::And
    };
    // A plane of twelve bytes is four f64; a box of seventeen is six planes.
    let shapes: Vec<Shape> = within(4 << 10, 64, bytes, || {
        text.lines().filter_map(|line| line.parse().ok()).collect()
    });
    for shape in &shapes {
        shape.surfaces().iter().for_each(assert_surface);
        // The outside of the outside is the inside, to the bit; a single plane has no operation to return to.
        let back = shape.clone().complement().complement();
        assert_eq!((back.surfaces(), back.op()), (shape.surfaces(), shape.op()));
    }
    match Clip::of_shapes(&shapes, op) {
        Ok(clip) => assert!(clip.surfaces.len() <= Clip::MAX_SURFACES),
        Err(error) => assert_readable(&error),
    }
});
