//! Where nothing lies below, tiles leave the picture itself. Its bytes are those of the draw that blends the tiles' picture
//! into a cleared target, from frame to frame; on GPUs they may be a step of 8 bits apart, since how a blend rounds is the
//! device's own.

use super::super::*;
use glam::DVec3;
use rara_gpu::{Bindings, DeviceShape};
use rara_scene::clip::{ClipOp, Plane};
use rara_scene::settings::{Mode, Raster, Show};
use rara_scene::{Bounds, Kind, Layer, generate};

/// The formats in which tiles leave the picture.
const FORMATS: [TargetFormat; 2] = [TargetFormat::Unorm8, TargetFormat::Float];
/// No multiple of a tile, in more than one strip of tiles.
const SIZE: (u32, u32) = (93, 77);

/// Two renderers of one scene of two layers, apart from each other: one whose tiles leave the picture, and one that always
/// draws.
struct Pair {
    leaves: Headless,
    draws: Headless,
    bounds: Bounds,
}

impl Pair {
    fn new(shape: Option<DeviceShape>) -> Self {
        let left = generate(Kind::General, 1_500, 1);
        let mut right = generate(Kind::General, 1_500, 2);
        let aside = (2.5 * Bounds::of(&left).radius()) as f32;
        for position in right.positions_mut() {
            position.x += aside;
        }
        let layers = [Layer::new("left", &left), Layer::new("right", &right)];
        let scene = Scene::from_iter(layers);
        let bounds = Bounds::of(&scene);
        let [leaves, mut draws] = [(); 2].map(|()| {
            let desc = HeadlessDesc {
                device: std::env::var("RARA_TEST_DEVICE").ok(),
                validation: true,
                bindings: Some(Bindings::Mixed),
                shape,
                ..HeadlessDesc::default()
            };
            let mut headless = Headless::new(&desc).expect("a device and the validation layer");
            headless.load(&scene).expect("uploads");
            headless
        });
        draws.target = Target::default();
        Self {
            leaves,
            draws,
            bounds,
        }
    }

    fn both(&mut self) -> [&mut Headless; 2] {
        [&mut self.leaves, &mut self.draws]
    }

    /// Draws a frame with both, cut at an offset, and compares the pictures. Returns the first one's statistics.
    fn draw(&mut self, size: (u32, u32), offset: f64, settings: &Settings) -> FrameStats {
        let camera = Camera::frame(&self.bounds, -DVec3::Y, 50.0, size).expect("a view");
        let plane = Plane::new(DVec3::new(1.0, 0.3, 0.2), offset).expect("a finite normal");
        let clip = Clip::of([plane], ClipOp::And);
        let [(left, stats), (drawn, truth)] = self.both().map(|headless| {
            let stats = headless.render(&camera, &clip, settings).expect("renders");
            (headless.picture().expect("reads back"), stats)
        });
        assert_eq!((stats.counts, stats.raster), (truth.counts, truth.raster));
        assert_eq!((left.width, left.height), size);
        let is_exact = self.draws.device().shape() == DeviceShape::Cpu
            || settings.precision.target == TargetFormat::Float;
        let [left, drawn] = [&left, &drawn].map(|picture| picture.pixels.as_flattened());
        let differ = |(a, b): (&f32, &f32)| match is_exact {
            true => a.to_bits() != b.to_bits(),
            false => (255.0 * (a - b)).round().abs() > 1.0,
        };
        assert!(
            !left.iter().zip(drawn).any(differ),
            "{size:?} {offset} {settings:?}"
        );
        assert!(
            stats
                .passes
                .iter()
                .all(|pass| !stats.skipped.contains(&pass.name))
        );
        stats
    }

    /// Draws a frame that the tiles leave.
    fn leave(&mut self, size: (u32, u32), offset: f64, settings: &Settings) -> FrameStats {
        let stats = self.draw(size, offset, settings);
        assert_eq!(stats.raster.path, "tiles");
        assert!(stats.skipped.contains(&"splat"), "nothing is drawn");
        assert_eq!(bytes(&self.leaves, "target"), 0);
        let [left, drawn] = self.both().map(|headless| headless.device_bytes());
        assert!(left < drawn, "bytes: {left} and {drawn}");
        stats
    }

    fn close(self) {
        for headless in [self.leaves, self.draws] {
            headless.close().expect("the layer has nothing to say");
        }
    }
}

/// Device memory of a name.
fn bytes(headless: &Headless, name: &str) -> u64 {
    let all = headless.device().memory_by_name();
    all.iter()
        .filter(|of| of.name == name)
        .map(|of| of.bytes)
        .sum()
}

fn tiles(format: TargetFormat) -> Settings {
    let mut settings = Settings::default().raster(Raster::Tiles);
    settings.precision.target = format;
    settings
}

#[test]
fn frames_that_follow_each_other_are_left_as_they_are_drawn() {
    let mut pair = Pair::new(None);
    for format in FORMATS {
        let settings = tiles(format);
        let stats = pair.leave(SIZE, 0.0, &settings);
        assert!(!stats.skipped.contains(&"tiles"));
        let pixels = u64::from(SIZE.0 * SIZE.1);
        assert!(bytes(&pair.leaves, "tile_picture") >= pixels * format.pixel_bytes());
        let again = pair.leave(SIZE, 0.0, &settings);
        assert!(again.skipped.contains(&"tiles") && again.passes.is_empty());
        // The clip moves: first over all that is in view, then over what is there.
        for offset in [0.1, 0.2, -0.3, 0.2] {
            let stats = pair.leave(SIZE, offset, &settings);
            assert!(!stats.skipped.contains(&"tiles"));
        }
        // Smaller than the buffer is, larger, and as before.
        for size in [(40, 61), (121, 80), SIZE] {
            pair.leave(size, 0.2, &settings);
            pair.leave(size, 0.25, &settings);
        }
        // What a layer has covered is empty without it, and full again with it.
        for visible in [false, true] {
            for headless in pair.both() {
                let state = LayerState::default().visible(visible);
                headless.set_layer_state(1, state).expect("a layer");
            }
            pair.leave(SIZE, 0.25, &settings);
            pair.leave(SIZE, 0.3, &settings);
        }
        let weights = settings.show(Show::Weight);
        pair.leave(SIZE, 0.3, &weights);
        // All of it is clipped away, and comes back.
        for offset in [-1e3, 0.3] {
            pair.leave(SIZE, offset, &settings);
        }
    }
    pair.close();
}

#[test]
fn frames_that_have_to_be_drawn_come_in_between() {
    let mut pair = Pair::new(None);
    for format in FORMATS {
        let settings = tiles(format);
        let quads = settings.raster(Raster::Quad);
        let red = settings.background(Some([0.5, 0.1, 0.0]));
        for between in [quads, red] {
            for offset in [0.0, 0.1] {
                pair.leave(SIZE, offset, &settings);
                let stats = pair.draw(SIZE, offset, &between);
                assert!(!stats.skipped.contains(&"splat"));
                pair.draw(SIZE, offset + 0.1, &between);
                pair.draw((40, 61), offset, &between);
            }
        }
        pair.leave(SIZE, 0.0, &settings);
    }
    for offset in [0.0, 0.1] {
        pair.leave(SIZE, offset, &tiles(TargetFormat::Unorm8));
        let stats = pair.draw(SIZE, offset, &tiles(TargetFormat::Half));
        assert!(!stats.skipped.contains(&"splat"), "halves are drawn");
    }
    // Floats that are the picture are blended onto a background without being computed again.
    let settings = tiles(TargetFormat::Float);
    let red = settings.background(Some([0.5, 0.1, 0.0]));
    pair.leave(SIZE, 0.0, &settings);
    let stats = pair.draw(SIZE, 0.0, &red);
    assert!(stats.skipped.contains(&"tiles") && !stats.skipped.contains(&"splat"));
    let stats = pair.leave(SIZE, 0.0, &settings);
    assert!(stats.skipped.contains(&"tiles"), "they are still there");
    pair.close();
}

#[test]
fn frames_whose_tiles_have_no_room_come_in_between() {
    let mut pair = Pair::new(None);
    let settings = tiles(TargetFormat::Float);
    for offset in [0.0, 0.1, 0.2] {
        pair.leave(SIZE, offset, &settings);
        for headless in pair.both() {
            headless.session.renderer.limit_pairs(1 << 10);
        }
        for moved in [offset, offset, offset + 0.1] {
            let stats = pair.draw((200, 150), moved, &settings);
            assert!(stats.raster.reason.contains("coarse"));
        }
        for headless in pair.both() {
            headless.session.renderer.limit_pairs(1 << 24);
        }
    }
    pair.leave(SIZE, 0.2, &settings);
    pair.close();
}

#[test]
fn what_a_gpu_leaves_is_copied_when_it_is_wanted() {
    let mut pair = Pair::new(Some(DeviceShape::Gpu { subgroup: 0 }));
    for format in FORMATS {
        // How the picture leaves the tiles has nothing to do with what they weigh, whose pipelines take a CPU driver a minute
        // to compile.
        let settings = tiles(format).mode(Mode::Hard);
        pair.leave(SIZE, 0.0, &settings);
        pair.leave(SIZE, 0.1, &settings);
    }
    pair.close();
}

#[test]
fn a_frame_that_is_refused_leaves_the_picture_before_it() {
    let mut pair = Pair::new(None);
    let settings = tiles(TargetFormat::Float);
    pair.leave(SIZE, 0.0, &settings);
    let picture = pair.leaves.picture().expect("reads back");
    let camera = Camera::frame(&pair.bounds, -DVec3::Y, 50.0, (300, 200)).expect("a view");
    let refused = settings.sigma(f32::NAN).mode(Mode::Rara);
    let plane = Plane::new(DVec3::X, 0.0).expect("a finite normal");
    let clip = Clip::of([plane], ClipOp::And);
    let error = pair.leaves.render(&camera, &clip, &refused);
    error.expect_err("as it says");
    assert!(pair.leaves.picture().expect("reads back") == picture);
    pair.close();
}
