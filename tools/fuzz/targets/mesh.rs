//! A file of a mesh, closed and by winding number: whatever is taken is finite, within its own bounds, and has an inside.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rara::{Mesh, MeshRule};
use rara_fuzz::{assert_readable, kept_in, within};

fuzz_target!(|bytes: &[u8]| {
    // A binary file is known by its bytes; all else is read as its ending says.
    let path = kept_in("mesh.obj", bytes);
    for rule in [MeshRule::Closed, MeshRule::Winding] {
        // A vertex and a face of some eight bytes each take fifty in the hierarchy, and as much in tables while they are checked.
        match within(1 << 20, 200, bytes, || Mesh::read(&path, rule)) {
            Ok(mesh) => {
                let corners = (0..mesh.faces().len()).flat_map(|face| mesh.corners(face as u32));
                assert!(corners.into_iter().all(|corner| corner.is_finite()));
            }
            Err(error) => assert_readable(&error),
        }
    }
});
