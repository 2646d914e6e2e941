//! Everything that the fuzz targets share: a limit on memory by the input's size, and the checks of whatever loads.

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use rara::camera_files::{NamedCamera, cameras_from_json};
use rara::{Camera, Gaussians, Plane, Surface};

/// The system's allocator, which ends the process when a run needs more than its share.
struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;
static LIVE: AtomicUsize = AtomicUsize::new(0);
static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);

// SAFETY: every call is handed on to the system's allocator as it came; the counters are not memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let live = LIVE.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        let limit = LIMIT.load(Ordering::Relaxed);
        if live > limit {
            LIMIT.store(usize::MAX, Ordering::Relaxed);
            eprintln!("{live} bytes of memory are in use, {limit} are allowed");
            std::process::abort();
        }
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise; `at` came from the system's allocator.
        unsafe { System.dealloc(at, layout) }
    }
}

/// Runs `work`, which may hold at most this much memory at any time: a base, and some bytes for each of the input.
pub fn within<T>(base: usize, each: usize, input: &[u8], work: impl FnOnce() -> T) -> T {
    let limit = LIVE.load(Ordering::Relaxed) + base + each * input.len();
    LIMIT.store(limit, Ordering::Relaxed);
    let result = work();
    LIMIT.store(usize::MAX, Ordering::Relaxed);
    result
}

/// Writes the input to a file of this process, for what reads files only.
pub fn kept_in(name: &str, input: &[u8]) -> PathBuf {
    let path = std::env::temp_dir().join(format!("rara-fuzz-{}-{name}", std::process::id()));
    std::fs::write(&path, input).expect("a file in the folder of temporary files");
    path
}

/// Asserts that everything is finite, rotations are unit, scales not negative, opacities from 0 to 1, arrays of one
/// length.
pub fn assert_sound(scene: &Gaussians) {
    let n = scene.len();
    let lengths = [
        scene.scales().len(),
        scene.rotations().len(),
        scene.opacities().len(),
    ];
    assert_eq!(lengths, [n; 3]);
    assert!(scene.sh_degree() <= 3);
    assert_eq!(scene.sh().len(), 3 * n * scene.sh_coefficients());
    assert!(scene.positions().iter().all(|p| p.is_finite()));
    let sound = |s: &glam::Vec3| s.is_finite() && s.min_element() >= 0.0;
    assert!(scene.scales().iter().all(sound));
    let unit = |q: &glam::Quat| (q.length() - 1.0).abs() < 1e-5;
    assert!(scene.rotations().iter().all(unit));
    assert!(scene.opacities().iter().all(|o| (0.0..=1.0).contains(o)));
    assert!(scene.sh().iter().all(|v| v.is_finite()));
}

/// Asserts a possible size, positive focal lengths, a finite eye and a rotation.
pub fn assert_camera(camera: &Camera) {
    let sides = [camera.width, camera.height];
    assert!(sides.iter().all(|side| (1..=Camera::MAX_SIZE).contains(side)));
    assert!(
        [camera.fx, camera.fy]
            .iter()
            .all(|f| f.is_finite() && *f > 0.0)
    );
    assert!(camera.cx.is_finite() && camera.cy.is_finite());
    assert!(camera.eye.is_finite(), "{camera:?}");
    let turned_back = camera.rotation * camera.rotation.transpose();
    assert!(
        turned_back.abs_diff_eq(glam::DMat3::IDENTITY, 1e-12),
        "{camera:?}"
    );
    assert!(camera.rotation.determinant() > 0.0, "{camera:?}");
}

/// Loads a file of cameras, and asserts that all of them are cameras or that the error is for people.
pub fn assert_cameras(json: &[u8]) {
    // Unknown fields are kept until the object ends: "0," is a value of 32 bytes, and its list grows by doubling.
    match within(64 << 10, 64, json, || {
        cameras_from_json(json, Path::new("fuzz.json"))
    }) {
        Ok(cameras) => {
            assert!(!cameras.is_empty());
            cameras.iter().for_each(assert_named);
        }
        Err(error) => assert_readable(&error),
    }
}

/// Asserts that a camera of a file is one, or that its error is for people.
pub fn assert_named(named: &NamedCamera) {
    for outcome in [named.camera(), named.undistorted()] {
        match outcome {
            Ok(camera) => assert_camera(&camera),
            Err(error) => assert_readable(&error),
        }
    }
}

/// Asserts a unit normal and a finite distance.
pub fn assert_plane(plane: &Plane) {
    assert!((plane.normal().length() - 1.0).abs() < 1e-12, "{plane:?}");
    assert!(plane.offset().is_finite(), "{plane:?}");
}

/// Asserts what each kind of surface must satisfy.
pub fn assert_surface(surface: &Surface) {
    match surface {
        Surface::Plane(plane) => assert_plane(plane),
        Surface::Quadric(quadric) => {
            let numbers = [quadric.anchor(), quadric.linear()];
            assert!(numbers.iter().all(|v| v.is_finite()), "{quadric:?}");
            assert!(quadric.matrix().is_finite() && quadric.constant().is_finite(), "{quadric:?}");
            assert_eq!(quadric.flipped().flipped(), *quadric);
        }
        Surface::Inside(_) => assert_eq!(surface.complement().complement(), *surface),
    }
}

/// Asserts that an error's text is for people: something to read, on one line of some length, without control characters.
pub fn assert_readable(error: &rara::Error) {
    let text = error.to_string();
    assert!((11..5000).contains(&text.len()), "{text:?}");
    assert!(!text.chars().any(char::is_control), "{text:?}");
}
