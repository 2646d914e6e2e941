//! The text of `--clip` and `--clip-expr`: a shape or an expression a line, joined by the last line's `and` or `or`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rara::clip::Expression;
use rara::{Clip, ClipOp};
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
    // A plane of twelve bytes is four f64; a capsule of twenty-one is five surfaces.
    let expressions: Vec<Expression> = within(4 << 10, 128, bytes, || {
        let read = text.lines().map(str::parse::<Expression>);
        read.filter_map(|read| read.map_err(|error| assert_readable(&error)).ok()).collect()
    });
    for expression in &expressions {
        let clip = expression.clip();
        clip.all_surfaces().iter().for_each(assert_surface);
        // The outside of the outside is the inside, to the bit, and text says all that there is.
        assert_eq!(clip.complement().complement(), clip);
        let again: Expression = expression.to_string().parse().expect("its own text");
        assert_eq!(again.to_string(), expression.to_string());
    }
    if !expressions.is_empty() {
        let joined = Clip::joined(expressions.iter().map(Expression::clip), op);
        joined.all_surfaces().iter().for_each(assert_surface);
    }
});
