//! A host that configures the next frame while it records this one gets the pictures of one that does not.

use super::*;
use rara::{Error, FrameToken};

impl Engine {
    fn ahead(&mut self, (camera, clip, settings): &Frame) -> FrameToken {
        let renderer = &mut self.renderer;
        let configured = renderer.configure_ahead(&self.scene, camera, clip, settings);
        configured.expect("configures")
    }

    /// Records and submits a token's frame; `meanwhile` comes between its stages and its draw.
    fn record_token(&mut self, token: &mut FrameToken, meanwhile: impl FnOnce(&mut Self)) {
        let cmd = self.host.begin().expect("begins");
        let (renderer, scene) = (&mut self.renderer, &self.scene);
        // SAFETY: `cmd` is recording outside rendering, and every test waits before it drops the scene.
        unsafe { renderer.prepare_token(cmd, scene, None, token) }.expect("prepares");
        meanwhile(self);
        self.host.begin_rendering(VIEW.into());
        // SAFETY: `cmd` is inside rendering to a target of the renderer's format, viewport and scissor are set.
        unsafe { self.renderer.draw_token(cmd, [0.0; 2], token) }.expect("draws");
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
        let mut token = next;
        let following = &frames[(index + 1) % frames.len()];
        let before = (when == 0).then(|| engine.ahead(following));
        let mut between = None;
        engine.record_token(&mut token, |engine| {
            between = (when == 1).then(|| engine.ahead(following));
        });
        next = match before.or(between) {
            Some(token) => token,
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
    for desc in [
        in_flight(FLOATS, Bindings::Mixed),
        in_flight(FLOATS, Bindings::Mixed).reuse(true),
    ] {
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
fn tokens_in_an_order_that_makes_no_sense_are_refused() {
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
    let mut first = engine.ahead(&frames[1]);
    let cmd = engine.host.begin().expect("begins");
    // SAFETY: `cmd` is recording outside rendering; nothing is recorded by calls that are refused.
    unsafe {
        let drawn = engine.renderer.draw_token(cmd, [0.0; 2], &first);
        refused(drawn, "prepared last");
        let prepared = other.prepare_token(cmd, &engine.scene, None, &mut first);
        refused(prepared, "another renderer's");
        let renderer = &mut engine.renderer;
        renderer
            .prepare_token(cmd, &engine.scene, None, &mut first)
            .expect("prepares");
        let again = renderer.prepare_token(cmd, &engine.scene, None, &mut first);
        refused(again, "prepared already");
    }
    engine.host.begin_rendering(VIEW.into());
    // SAFETY: `cmd` is inside rendering to a target of the renderer's format, viewport and scissor are set.
    unsafe { engine.renderer.draw_token(cmd, [0.0; 2], &first) }.expect("draws");
    engine.host.submit().expect("submits");
    engine.wait_for_all();
    // One that takes over from the frame before cannot be prepared once that is forgotten.
    let mut second = engine.ahead(&frames[1]);
    engine.renderer.forget();
    let cmd = engine.host.begin().expect("begins");
    // SAFETY: as above.
    let prepared = unsafe {
        engine
            .renderer
            .prepare_token(cmd, &engine.scene, None, &mut second)
    };
    refused(prepared, "takes over");
    engine.host.begin_rendering(VIEW.into());
    engine.host.submit().expect("submits");
    engine.wait_for_all();
    drop((first, second, other));
    engine.close();
}
