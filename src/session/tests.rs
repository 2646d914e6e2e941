//! Tests of the loop itself, without a window and with several frames in flight.

use super::target::vulkan_format;
use super::*;
use crate::renderer::{Outcome, RecordedFrame};
use glam::{DVec3, Vec3};
use rara_gpu::{PipelineCache, testing};
use rara_scene::clip::Clip;
use rara_scene::precision::TargetFormat;
use rara_scene::settings::Raster;
use rara_scene::{Bounds, Gaussians, Kind, generate};

/// A session with frames in flight.
fn session() -> Session {
    let desc = HeadlessDesc {
        validation: true,
        pipeline_cache: PipelineCache::Off,
        ..HeadlessDesc::default()
    };
    let renderer = RendererDesc {
        frames_in_flight: 2,
        ..RendererDesc::new(vulkan_format(TargetFormat::default()))
    };
    Session::new(testing::device(), &desc, renderer).expect("a renderer")
}

/// Closes a session of which the validation layer has nothing to say.
fn closes(session: Session) {
    let device = session.device.clone();
    drop(session);
    assert_eq!(device.close(), Vec::<String>::new());
}

/// More pairs of tile and splat than a first frame has room for: the estimate looks at every third Gaussian of so many, and the
/// large ones, which are all alike, are among the others.
fn crowded() -> (Gaussians, Camera) {
    let mut scene = generate(Kind::General, 2_100, 5);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (160, 120));
    let radius = Bounds::of(&scene).radius() as f32;
    scene.scales_mut().fill(Vec3::splat(1e-3));
    for index in (0..2_100).filter(|index| index % 3 != 0) {
        scene.scales_mut()[index] = Vec3::splat(radius);
    }
    scene.opacities_mut().fill(0.02); // so that no pixel is saturated before the last
    (scene, camera.expect("a view"))
}

/// Submits a frame of quads or tiles as one of several in flight, which is drawn whatever room it has, and waits for it.
fn show(session: &mut Session, camera: &Camera, settings: &Settings) -> Outcome {
    let renderer = &mut session.renderer;
    let (scene, clip) = (session.scene.as_ref().expect("loaded"), Clip::default());
    let request = FrameRequest::in_flight(scene, camera, (&clip).into(), settings);
    let frame = renderer.configure_frame(&request).expect("configures");
    let mut target = Target::default();
    let format = settings.precision.target;
    target.set_format(&session.device, format).expect("blends");
    let made = target.make_image(&session.device, camera);
    made.expect("an image");
    let submitted = submit(
        &session.device,
        renderer,
        &request,
        (&mut target, frame),
        None,
    );
    submitted.expect("submits");
    let frame = renderer.newest().expect("just prepared");
    renderer.outcome_of(frame)
}

/// The frame that shows how much room is needed is the last one, and not the oldest that is in flight. The first one has coarse
/// lists.
#[test]
fn a_picture_after_frames_in_flight_has_the_room_it_needs() {
    let (scene, camera) = crowded();
    let settings = Settings::default().raster(Raster::Tiles);
    let mut pictures = Vec::new();
    for frames_before in 0..3 {
        let mut session = session();
        session
            .load((&scene).into(), ShFormat::Float)
            .expect("uploads");
        for frame in 0..frames_before {
            let outcome = show(&mut session, &camera, &settings);
            let expected = [Outcome::Drawn, Outcome::Unchanged][frame];
            assert_eq!(outcome, expected, "frame {frame} of {frames_before}");
        }
        let draw = |session: &mut Session, target: &mut Target| {
            let clip = Clip::default();
            let scene = SplatColours::Scene;
            let drawn = session.draw(target, &camera, (&clip).into(), &settings, scene);
            drawn.expect("draws")
        };
        let mut target = Target::default();
        let is_coarse = draw(&mut session, &mut target)
            .raster
            .reason
            .contains("coarse");
        assert_eq!(is_coarse, frames_before == 0, "after {frames_before}");
        pictures.push(target.read_back(&session.device).expect("reads back"));
        if is_coarse {
            let with_room = draw(&mut session, &mut target).raster.reason;
            assert!(!with_room.contains("coarse"), "{with_room}");
        }
        // Once more, there is nothing to do for this target; another target gets the draw alone.
        let again = draw(&mut session, &mut target);
        assert!(again.skipped.contains(&"splat"));
        let mut other = Target::default();
        assert!(draw(&mut session, &mut other).skipped.ends_with(&["tiles"]));
        pictures.push(other.read_back(&session.device).expect("reads back"));
        drop((target, other));
        closes(session);
    }
    assert!(pictures.iter().all(|picture| *picture == pictures[0]));
    assert!(pictures[0].pixels.iter().any(|pixel| pixel[3] > 0.5));
}

/// A frame that was never submitted has no counts: those on the device are another frame's.
#[test]
fn a_frame_that_was_not_submitted_has_no_statistics() {
    let mut session = session();
    let (scene, camera) = crowded();
    session
        .load((&scene).into(), ShFormat::Float)
        .expect("uploads");
    let settings = Settings::default();
    show(&mut session, &camera, &settings);
    let failed = session.device.submit_and_wait(|cmd| {
        let renderer = &mut session.renderer;
        let scene = session.scene.as_ref().expect("loaded");
        let frame = renderer.configure(scene, &camera, &Clip::default(), &settings)?;
        // SAFETY: `cmd` is recording outside rendering, and is never submitted.
        unsafe { renderer.prepare(cmd, scene, None, frame) }?;
        Err::<(), _>(Error::Invalid("changed my mind".into()))
    });
    failed.expect_err("as it says");
    session.renderer.abandon();
    let newest = session.renderer.newest().map(RecordedFrame::stats);
    assert_eq!(newest, Some(FrameStats::default()));
    assert!(
        session.renderer.counts().drawn > 0,
        "the one before has them"
    );
}
