//! A host that configures the next frame while it records this one gets the pictures of one that does not.

use super::*;
use rara::Error;

impl Engine {
    fn ahead(&mut self, (camera, clip, settings): &Frame) -> ConfiguredFrame {
        let renderer = &mut self.renderer;
        let configured = renderer.configure(&self.scene, camera, clip, settings);
        configured.expect("configures")
    }

    /// Records and submits a frame; `meanwhile` comes between its stages and its draw.
    fn record_frame(&mut self, frame: ConfiguredFrame, meanwhile: impl FnOnce(&mut Self)) {
        self.configured = Some(frame);
        let cmd = self.prepare();
        meanwhile(self);
        self.host.begin_rendering(VIEW.into());
        self.draw(cmd, [0.0; 2]);
        self.host.submit().expect("submits");
    }
}

/// The pictures of frames, each of which is configured before, while or after the one before is recorded.
fn drawn(
    desc: RendererDesc,
    scene: &Gaussians,
    frames: &[Frame],
    when: usize,
) -> Vec<Vec<[f32; 4]>> {
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, scene, ShFormat::default(), desc);
    let mut pictures = Vec::new();
    let mut next = engine.ahead(&frames[0]);
    for index in 0..frames.len() {
        pictures.extend(engine.wait());
        let following = &frames[(index + 1) % frames.len()];
        let before = (when == 0).then(|| engine.ahead(following));
        let mut between = None;
        engine.record_frame(next, |engine| {
            between = (when == 1).then(|| engine.ahead(following));
        });
        next = match before.or(between) {
            Some(frame) => frame,
            None => engine.ahead(following),
        };
    }
    let last = frames.len() - 1;
    if pictures.len() < last {
        pictures.extend(engine.wait());
    }
    pictures.push(engine.wait_for_all());
    drop(next);
    engine.close();
    pictures
}

#[test]
fn frames_that_are_configured_ahead_show_the_same_pictures() {
    let scene = scene();
    // They need more and more room, so that memory is replaced while a frame waits; then a clip that moves.
    let mut frames = frames(&scene);
    let (camera, _, settings) = frames[2].clone();
    for shift in [0.1, 0.2, 0.2, 0.3] {
        let clip = common::moved(common::clip(&scene, 2, ClipOp::And), shift);
        frames.push((camera, clip, settings));
    }
    // The next frame is configured before the slot of this one is free.
    let usual = in_flight(FLOATS, Bindings::Mixed).frames_in_flight(FRAMES as u32 + 1);
    for desc in [usual, usual.reuse(true)] {
        let host = open_host(FLOATS, VIEW, true);
        let mut engine = Engine::new(host, &scene, ShFormat::default(), desc.reuse(false));
        let mut expected = Vec::new();
        for frame in &frames {
            engine.wait();
            engine.configure(frame);
            engine.record(vk::Offset2D::default());
            expected.push(engine.wait_for_all());
        }
        engine.close();
        for when in 0..3 {
            let pictures = drawn(desc, &scene, &frames, when);
            assert_eq!(pictures.len(), expected.len());
            for (index, (own, expected)) in pictures.iter().zip(&expected).enumerate() {
                assert_shows(&format!("frame {index}, {when}"), FLOATS, own, expected);
            }
        }
    }
}

#[test]
fn frames_in_an_order_that_makes_no_sense_are_refused() {
    let scene = scene();
    let frames = frames(&scene);
    let desc = in_flight(FLOATS, Bindings::Mixed).reuse(true);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let refused = |result: rara::Result<()>, says: &str| {
        let error = result.expect_err("it makes no sense");
        assert!(
            matches!(&error, Error::Invalid(text) if text.contains(says)),
            "{error}"
        );
    };
    let mut other = engine.renderer.sharing(desc).expect("a renderer");
    let [first, second] = [0; 2].map(|_| engine.ahead(&frames[1]));
    let cmd = engine.host.begin().expect("begins");
    // SAFETY: `cmd` is recording outside rendering; nothing is recorded by calls that are refused.
    let prepared = unsafe {
        let theirs = engine.ahead(&frames[1]);
        let prepared = other.prepare(cmd, &engine.scene, None, theirs);
        refused(prepared.map(drop), "another renderer's");
        let renderer = &mut engine.renderer;
        [first, second].map(|frame| {
            let prepared = renderer.prepare(cmd, &engine.scene, None, frame);
            prepared.expect("prepares")
        })
    };
    engine.host.begin_rendering(VIEW.into());
    // SAFETY: `cmd` is inside rendering to a target of the renderer's format, viewport and scissor are set.
    unsafe {
        let renderer = &mut engine.renderer;
        refused(renderer.draw(cmd, [0.0; 2], &prepared[0]), "prepared last");
        refused(other.draw(cmd, [0.0; 2], &prepared[1]), "prepared last");
        let drawn = renderer.draw(cmd, [f32::NAN, 0.0], &prepared[1]);
        refused(drawn, "draw was given the origin NaN, 0:");
        let drawn = renderer.draw_depth(cmd, [7.0, f32::INFINITY], &prepared[1]);
        let why = "draw_depth was given the origin 7, inf: give the upper left corner";
        refused(drawn, why);
        let drawn = renderer.draw_depth(cmd, [0.0; 2], &prepared[1]);
        refused(drawn, "expected_depth");
        renderer.draw(cmd, [0.0; 2], &prepared[1]).expect("draws");
    }
    engine.host.submit().expect("submits");
    engine.wait_for_all();
    // One that takes over from the frame before cannot be prepared once that is forgotten.
    let frame = engine.ahead(&frames[1]);
    engine.renderer.forget();
    let cmd = engine.host.begin().expect("begins");
    // SAFETY: as above.
    let refuses = unsafe { engine.renderer.prepare(cmd, &engine.scene, None, frame) };
    refused(refuses.map(drop), "takes over");
    engine.host.begin_rendering(VIEW.into());
    engine.host.submit().expect("submits");
    engine.wait_for_all();
    drop((prepared, other));
    engine.close();
}
