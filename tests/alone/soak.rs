//! Nothing leaks: thousands of frames, scenes swapped and clips moved, and memory stays what it was.

use crate::common;
use crate::common::folder::has_run_alone;
use rara::scene::{Kind, generate};
use rara::{Camera, ClipOp, Gaussians, Headless, HeadlessDesc, PipelineCache, Settings};

/// Frames before the next scene replaces a scene.
const STAY: usize = 20;

#[test]
fn memory_stays_flat_over_a_thousand_frames() {
    if has_run_alone(memory_stays_flat_over_a_thousand_frames) {
        return;
    }
    soak((1_000.0 * common::scale()) as usize);
}

/// `cargo test --release --test library -- --ignored --nocapture alone::soak`.
#[test]
#[ignore = "half a minute; the thousand say the same"]
fn memory_stays_flat_over_ten_thousand_frames() {
    if has_run_alone(memory_stays_flat_over_ten_thousand_frames) {
        return;
    }
    soak(10_000);
}

fn soak(frames: usize) {
    // Without the validation layer: it keeps books of its own that grow.
    let mut headless = Headless::new(
        &HeadlessDesc::default()
            .device(std::env::var("RARA_TEST_DEVICE").ok())
            .pipeline_cache(PipelineCache::Off),
    )
    .expect("a Vulkan device");
    let scenes: Vec<Gaussians> = [
        (Kind::General, 300),
        (Kind::Strands, 700),
        (Kind::Layers, 500),
    ]
    .map(|(kind, count)| generate(kind, count, 1))
    .into();
    let begun = std::time::Instant::now();
    // The memory that each scene took with so many planes the last time, and that of the process after all were there
    // twice.
    let cycle = 2 * scenes.len();
    let mut taken = vec![0; cycle];
    let mut resident = 0;
    let settled = 2 * cycle * STAY;
    for frame in 0..frames {
        let swap = frame / STAY;
        let at = swap % scenes.len();
        if frame % STAY == 0 {
            headless.load(&scenes[at]).expect("uploads");
        }
        // The clip moves each frame, the camera each fifth; every other stay has several planes.
        let camera: Camera = common::views(&scenes[at], 5, (33, 25))[frame / 5 % 5];
        let clip = common::clip(&scenes[at], 1 + swap % 2 * 3, ClipOp::And);
        let clip = common::moved(clip, 0.01 * (frame % STAY) as f64);
        headless
            .render(&camera, &clip, &Settings::default())
            .expect("renders");
        if frame % STAY == STAY - 1 {
            headless.picture().expect("reads back");
            let bytes = headless.device_bytes();
            if frame >= settled {
                assert_eq!(
                    bytes,
                    taken[swap % cycle],
                    "device memory after frame {frame}"
                );
            }
            taken[swap % cycle] = bytes;
            if frame + 1 == settled {
                resident = resident_bytes();
            }
        }
    }
    let grown = resident_bytes() - resident;
    eprintln!(
        "{frames} frames in {:.1} s: device memory flat at {taken:?} bytes, resident memory {:.1} MiB, grown by {:.2} MiB",
        begun.elapsed().as_secs_f64(),
        resident as f64 / f64::from(1 << 20),
        grown as f64 / f64::from(1 << 20)
    );
    // Allocators and drivers keep some of the memory that they are given back.
    assert!(
        grown < 16 << 20,
        "resident memory has grown by {grown} bytes"
    );
}

/// Resident memory of this process; 0 where the system does not report it.
fn resident_bytes() -> i64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|rest| rest.trim().trim_end_matches("kB").trim().parse().ok());
    1024 * kib.unwrap_or(0_i64)
}
