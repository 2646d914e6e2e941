use super::*;

/// A directory of its own for one test, removed at the end.
struct Scratch(std::path::PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("rara-picture-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn ramp() -> Picture {
    let pixel = |i: u32| {
        let alpha = (i % 7) as f32 / 6.0;
        [
            i as f32 / 34.0 * alpha,
            1.7 * alpha,
            0.1234567 * alpha,
            alpha,
        ]
    };
    Picture {
        width: 7,
        height: 5,
        pixels: (0..35).map(pixel).collect(),
    }
}

#[test]
fn exr_keeps_every_bit_and_png_what_quantised_says() {
    let scratch = Scratch::new("round-trip");
    for (name, expected) in [("a.exr", ramp()), ("a.PNG", ramp().quantised())] {
        let path = scratch.0.join(name);
        ramp().save(&path).unwrap();
        assert_eq!(Picture::load(&path).unwrap(), expected, "{name}");
    }
    assert_eq!(
        std::fs::read_dir(&scratch.0).unwrap().count(),
        2,
        "nothing else is left in the folder"
    );
}

#[test]
fn arrays_of_numpy_have_rows_of_columns_of_four() {
    let scratch = Scratch::new("npy");
    let path = scratch.0.join("a.npy");
    ramp().save(&path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let (header, values) = bytes.split_at(128);
    assert!(header.starts_with(
        b"\x93NUMPY\x01\0\x76\0{'descr': '<f4', 'fortran_order': False, 'shape': (5, 7, 4, ), }"
    ));
    assert_eq!(header.last(), Some(&b'\n'));
    assert_eq!(values, bytemuck::cast_slice::<_, u8>(&ramp().pixels));
}

#[test]
fn errors_name_the_file_and_leave_nothing_behind() {
    let scratch = Scratch::new("errors");
    let saved = ramp()
        .save(scratch.0.join("a.jpg"))
        .unwrap_err()
        .to_string();
    assert!(saved.contains("a.jpg") && saved.contains(".png"), "{saved}");
    assert!(ramp().save(scratch.0.join("no/such/folder.png")).is_err());
    let refused = |path: &Path, part: &str| {
        let error = Picture::load(path).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    };
    refused(&scratch.0.join("missing.png"), "missing.png");
    let broken = scratch.0.join("broken.png");
    std::fs::write(&broken, b"\x89PNG\r\n\x1a\n and no more").unwrap();
    refused(&broken, "cannot be decoded");
    std::fs::write(&broken, b"plain text").unwrap();
    refused(&broken, "neither");
    assert_eq!(std::fs::read_dir(&scratch.0).unwrap().count(), 1);
}
