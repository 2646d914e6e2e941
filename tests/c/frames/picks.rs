//! Picks through the functions of `rara.h` are those of a headless renderer.

use std::ptr::null;

use super::channels::{SIZE, camera, with_renderer};
use super::*;
use crate::results::assert_fails;
use rara::scene::Bounds;
use rara::{Clip, Headless, Settings};
use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::cut::*;
use rara_c::picker::*;

/// A rectangle of the picture: its left and upper edge, its width and height.
const PART: (i32, i32, u32, u32) = (20, 11, 17, 13);
const PIXELS: usize = (PART.2 * PART.3) as usize;

#[test]
fn picks_are_those_of_a_headless_renderer() {
    with_both(1_200, |scene, _, device, ours| {
        let whole = camera(scene);
        let middle = (whole.rotation * (Bounds::of(scene).centre() - whole.eye)).z;
        let camera = whole.near_cut(Some(middle));
        let uploaded = ours.uploaded();
        let (x, y, width, height) = PART;
        with_renderer(ours.device, |renderer| {
            // SAFETY: the handles are alive, the pointers are null, or point to what they say, and each submission is waited for.
            unsafe {
                let mut picker = null_mut();
                assert_ok(rara_picker_create(renderer, 1, &mut picker));
                let seen = RaraCamera::from(camera);
                let mut cut = null_mut();
                assert_ok(rara_cut_create(renderer, &mut cut));
                assert_ok(rara_cut_configure(cut, uploaded, null(), null()));
                let ask_of_cut = |x: i32| {
                    let mut ticket = RaraPickTicket::default();
                    let submitted = device.submit_and_wait(|cmd| {
                        assert_ok(rara_cut_prepare(cut, cmd));
                        let (seen, none, to) = (&seen, null(), &mut ticket);
                        assert_ok(rara_picker_record_cut(
                            picker, cmd, uploaded, seen, cut, none, x, y, width, height, to,
                        ));
                        Ok(())
                    });
                    submitted.expect("submits");
                    ticket
                };
                let ask = |x: i32| {
                    let mut ticket = RaraPickTicket::default();
                    let mut result = RARA_OK;
                    let submitted = device.submit_and_wait(|cmd| {
                        let to = &mut ticket;
                        result = rara_picker_record(
                            picker,
                            cmd,
                            uploaded,
                            &seen,
                            null(),
                            null(),
                            x,
                            y,
                            width,
                            height,
                            to,
                        );
                        Ok(())
                    });
                    submitted.expect("submits");
                    (result, ticket)
                };
                let mut picks = [RaraPick::default(); PIXELS];
                let mut read =
                    |ticket, count| rara_picker_read(picker, ticket, picks.as_mut_ptr(), count);
                let (result, first) = ask(x);
                assert_ok(result);
                assert_ok(read(first, PIXELS));
                let (result, second) = ask(x);
                assert_ok(result);
                assert_fails(
                    read(first, PIXELS),
                    RARA_ERROR_INVALID,
                    "a later one has taken",
                );
                let other = RaraPickTicket {
                    picker: second.picker + 1,
                    ..second
                };
                assert_fails(read(other, PIXELS), RARA_ERROR_INVALID, "another picker's");
                for request in [second.request + 1, u64::MAX] {
                    let never = RaraPickTicket { request, ..second };
                    assert_fails(read(never, PIXELS), RARA_ERROR_INVALID, "never recorded");
                }
                assert_fails(
                    read(second, 1),
                    RARA_ERROR_INVALID,
                    "the rectangle has 221 pixels",
                );
                assert_ok(read(second, PIXELS));
                let of_clip = picks;
                let third = ask_of_cut(x);
                let to = picks.as_mut_ptr();
                assert_ok(rara_picker_read(picker, third, to, PIXELS));
                let all = |picks: [RaraPick; PIXELS]| picks.map(|p| (p.number, p.layer, p.alpha));
                assert!(all(of_clip) == all(picks), "the cut keeps the same");
                rara_cut_destroy(cut);
                let outside = ask(SIZE.0 as i32 - 3).0;
                assert_fails(
                    outside,
                    RARA_ERROR_INVALID,
                    "not inside the picture of 61x43 px",
                );
                rara_picker_destroy(picker);

                let headless = Headless::new(&Default::default());
                let mut headless = headless.expect("a device");
                headless.load(scene).expect("uploads");
                let rect = vk::Rect2D {
                    offset: vk::Offset2D { x, y },
                    extent: vk::Extent2D { width, height },
                };
                let mut pick = |camera| {
                    let picks = headless.pick(camera, &Clip::default(), &Settings::default(), rect);
                    picks.expect("picks").pixels
                };
                let expected = pick(&camera);
                assert!(
                    expected != pick(&whole),
                    "the near cut leaves something out"
                );
                let shown = expected.iter().flatten().count();
                assert!(shown > PIXELS / 2, "{shown}");
                for (pick, expected) in picks.iter().zip(expected) {
                    let expected = expected.map_or((0, 0, 0.0), |expected| {
                        (expected.number, expected.layer as u32, expected.alpha)
                    });
                    assert_eq!((pick.number, pick.layer), (expected.0, expected.1));
                    assert!((pick.alpha - expected.2).abs() < 1e-5);
                }
            }
        });
        // SAFETY: nothing uses it any more.
        unsafe { rara_scene_buffers_destroy(uploaded) };
    });
}
