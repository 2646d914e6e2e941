//! The documentation's pictures. Generated pages have no file that a relative link could lead to, so there the link holds
//! the picture itself.

/// The pictures in `tools/pictures` to which links of the documentation lead.
pub(crate) const NAMES: [&str; 11] = [
    "brain", "layers", "linear", "mesh", "modes", "organ", "plot", "report", "section", "sheet",
    "stored",
];

/// The definition of the link `NAME picture`.
pub(crate) fn definition(name: &str, png: &[u8]) -> String {
    format!("[{name} picture]: data:image/png;base64,{}\n", base64(png))
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digits = |chunk: &[u8]| {
        let byte = |i: usize| u32::from(chunk.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        [0, 1, 2, 3].map(|i| match i <= chunk.len() {
            true => char::from(DIGITS[(bits >> (18 - 6 * i) & 63) as usize]),
            false => '=',
        })
    };
    bytes.chunks(3).flat_map(digits).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_in_their_links() {
        // The test vectors of RFC 4648, section 10.
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
        assert_eq!(
            definition("a", b"f"),
            "[a picture]: data:image/png;base64,Zg==\n"
        );
    }
}
