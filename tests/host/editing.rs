//! Gaussians that a host's shaders and copies write on the device, under the host's validation with synchronisation checks. The
//! pictures are, to the byte, those of scenes that were uploaded with the same Gaussians.

use ash::vk;

use super::streaming::{FORMAT, VIEW, layers, lend, open, record};
use crate::canvas::host::FRAMES;
use crate::common;
use rara::ash;
use rara::glam::{Quat, Vec3};
use rara::scene::{Kind, generate};
use rara::{
    Bounds, ClipOp, Gaussians, LayerEdit, LayerEditor, PlainGaussian, Raster, Renderer,
    RendererDesc, SceneBuffers, Settings, ShFormat,
};
use rara_gpu::{
    Bindings, Buffer, BufferAccess, BufferUse, ComputeDesc, ComputePipeline, Device, Draws, Groups,
    Recorder, Shader,
};

/// `shaders/bend.comp`, which reads its source by its address.
const BEND: Shader = {
    const BYTES: &[u8] = include_bytes!("shaders/bend.comp.address.spv");
    const WORDS: [u32; BYTES.len() / 4] = super::gpu::words(BYTES);
    Shader {
        name: "bend",
        file: "bend.comp",
        stage: vk::ShaderStageFlags::COMPUTE,
        address: &WORDS,
        bound: &WORDS,
        mixed: &WORDS,
        buffers: &[BufferUse {
            name: "source",
            binding: 0,
            access: BufferAccess::Read,
            common: false,
        }],
        subgroups: false,
        image: false,
    }
};

/// What `bend.comp` makes of Gaussians.
fn bent(gaussians: &Gaussians, amount: f32) -> Gaussians {
    let mut bent = gaussians.clone();
    for p in bent.positions_mut() {
        p.x += amount * (p.y * p.y);
    }
    for q in bent.rotations_mut() {
        const H: f32 = 0.707_106_77;
        *q = Quat::from_xyzw(
            H * (q.x + q.y),
            H * (q.y - q.x),
            H * (q.z + q.w),
            H * (q.w - q.z),
        );
    }
    bent
}

/// The numbers that an editor takes.
pub(super) fn plain(gaussians: &Gaussians) -> Vec<PlainGaussian> {
    let of = |index: usize| {
        let [r, g, b] = [0, 1, 2].map(|channel| gaussians.sh_of(index)[channel]);
        let position = gaussians.positions()[index];
        PlainGaussian {
            position_opacity: position.extend(gaussians.opacities()[index]).into(),
            scale: gaussians.scales()[index].extend(f32::NAN).into(),
            rotation: gaussians.rotations()[index].into(),
            colour: [r, g, b, f32::NAN],
        }
    };
    (0..gaussians.len()).map(of).collect()
}

/// A buffer of Gaussians of the host's.
pub(super) fn lent(device: &Device, plain: &[PlainGaussian]) -> Buffer {
    let bytes = bytemuck::cast_slice(plain);
    let mut buffer = lend(device, bytes.len() as u64);
    buffer.mapped_mut().write(0, bytes);
    buffer
}

#[test]
fn a_scene_bends_while_frames_are_in_flight() {
    const AMOUNTS: [f32; 6] = [0.0, 0.1, 0.2, -0.15, 0.3, 0.05];
    let first = generate(Kind::General, 300, 1);
    let straight = generate(Kind::Strands, 1_500, 2);
    let last = generate(Kind::Layers, 500, 3);
    let camera = common::views(&straight, 1, (VIEW.width, VIEW.height))[0];
    let clip = common::clip(&straight, 1, ClipOp::And);
    let count = straight.len() as u32;
    for (raster, bindings) in [
        (Raster::Tiles, Bindings::Mixed),
        (Raster::Quad, Bindings::Bound),
    ] {
        let (mut host, device) = open(true);
        let settings = Settings::default().raster(raster);
        let [mut pictures, mut truth] = [Vec::new(), Vec::new()];
        for is_whole in [false, true] {
            let desc = RendererDesc::new(FORMAT)
                .bindings(bindings)
                .reuse(!is_whole)
                .frames_in_flight(FRAMES as u32);
            let mut renderer = Renderer::new(&device, desc).expect("a renderer");
            let drawn = if is_whole { &mut truth } else { &mut pictures };
            let upload = |middle: &Gaussians| {
                let scene = layers([&first, middle, &last]);
                SceneBuffers::upload(&device, scene, ShFormat::Packed).expect("uploads")
            };
            let mut edited = upload(&straight);
            let mut editor = LayerEditor::new(&renderer, &edited, count).expect("an editor");
            let desc = ComputeDesc {
                name: "bend",
                shader: &BEND,
                constants: &[],
                bindings: Bindings::Address,
            };
            let bend = ComputePipeline::new(&device, &desc).expect("a pipeline");
            let source = lent(&device, &plain(&straight));
            let mut kept = Vec::new();
            for (at, amount) in AMOUNTS.into_iter().enumerate() {
                let pixels = host.wait().expect("waits");
                drawn.extend(pixels.filter(|_| at >= FRAMES));
                let truth = bent(&straight, amount);
                let whole = is_whole.then(|| upload(&truth));
                let cmd = host.begin().expect("begins");
                if !is_whole {
                    let to = editor.address();
                    let params = [to as u32, (to >> 32) as u32, count, amount.to_bits()];
                    // SAFETY: `cmd` is recording outside rendering, and all is kept until it has been waited for.
                    unsafe {
                        let mut recorder = Recorder::begin(&device, cmd, Draws::Around, None);
                        let groups = Groups::Count(count.div_ceil(64));
                        recorder.dispatch(&bend, &[&source], &params, groups);
                        let edit = LayerEdit::of(0..count).positions(true).rotations(true);
                        let edit = edit.bounds(Some(Bounds::of(&truth)));
                        let done = editor.record(cmd, &mut edited, 1, &edit);
                        done.expect("it fits");
                    }
                }
                let scene = whole.as_ref().unwrap_or(&edited);
                let configured = renderer.configure(scene, &camera, &clip, &settings);
                record(&mut host, &mut renderer, cmd, scene, configured);
                kept.push(whole);
            }
            drawn.push(host.wait_for_all().expect("waits"));
        }
        for (at, (picture, truth)) in pictures.iter().zip(&truth).enumerate() {
            assert!(picture == truth, "{raster:?}, frame {at}");
        }
        assert!(pictures[0] != pictures[1], "the scene bends");
        drop(device);
        assert_eq!(host.close(), Vec::<String>::new());
    }
}

/// What an edit of the Gaussians of a range does to them.
type Change = (LayerEdit, fn(&mut Gaussians, std::ops::Range<usize>));

/// A brush that paints and erases, and a tenth that moves.
fn changes() -> [Change; 4] {
    let range = 400..550;
    let of = LayerEdit::of(range.start..range.end);
    let paint: fn(&mut Gaussians, _) = |gaussians, range| {
        let numbers = 3 * gaussians.sh_coefficients();
        for index in range {
            gaussians.opacities_mut()[index] = 0.9;
            gaussians.sh_mut()[index * numbers..][..3].copy_from_slice(&[1.7, -0.9, 0.1]);
        }
    };
    [
        (of.colours(true).opacities(true), paint),
        (
            of.colours(true).opacities(true).flat(true),
            |gaussians, range| {
                let numbers = 3 * gaussians.sh_coefficients();
                for index in range {
                    gaussians.opacities_mut()[index] = 1.0;
                    let sh = &mut gaussians.sh_mut()[index * numbers..][..numbers];
                    sh.fill(0.0);
                    sh[..3].copy_from_slice(&[-1.0, 0.333, 1.5]);
                }
            },
        ),
        (
            of.positions(true).scales(true).rotations(true),
            |gaussians, range| {
                for index in range {
                    gaussians.positions_mut()[index] += Vec3::new(0.3, -0.2, 0.1);
                    gaussians.scales_mut()[index] *= 1.7;
                    gaussians.rotations_mut()[index] = Quat::from_rotation_y(0.7);
                }
            },
        ),
        (of.opacities(true), |gaussians, range| {
            gaussians.opacities_mut()[range].fill(0.0);
        }),
    ]
}

#[test]
fn a_brush_paints_and_erases_and_a_tenth_moves() {
    let parts = [300, 1_500, 20].map(|count| generate(Kind::General, count, 4));
    let range = 400..550;
    let camera = common::views(&parts[1], 1, (VIEW.width, VIEW.height))[0];
    let clip = common::clip(&parts[1], 1, ClipOp::And);
    let mut headless = common::headless();
    let device = headless.device().clone();
    let renderer = Renderer::new(&device, RendererDesc::new(FORMAT)).expect("a renderer");
    for (format, raster) in [
        (ShFormat::Float, Raster::Tiles),
        (ShFormat::Half, Raster::Quad),
        (ShFormat::Packed, Raster::Tiles),
        (ShFormat::Byte, Raster::Quad),
    ] {
        let settings = Settings::default().raster(raster);
        let upload = |middle: &Gaussians| {
            let scene = layers([&parts[0], middle, &parts[2]]);
            SceneBuffers::upload(&device, scene, format).expect("uploads")
        };
        let mut draw = |scene: SceneBuffers| {
            headless.show(scene).expect("of this device");
            let drawn = headless.render(&camera, &clip, &settings);
            drawn.expect("renders");
            headless.picture().expect("reads back")
        };
        let (mut scene, mut truth) = (upload(&parts[1]), parts[1].clone());
        let room = range.len() as u32;
        let mut editor = LayerEditor::new(&renderer, &scene, room).expect("an editor");
        let mut before = draw(scene.clone());
        for (at, (edit, change)) in changes().into_iter().enumerate() {
            change(&mut truth, range.clone());
            let source = lent(&device, &plain(&truth)[range.clone()]);
            let edit = edit.bounds(Some(Bounds::of(&truth)));
            let done = device.submit_and_wait(|cmd| {
                let all = [vk::BufferCopy::default().size(editor.bytes())];
                // SAFETY: `cmd` is recording, and everything outlives the wait for it.
                unsafe {
                    let raw = device.raw();
                    raw.cmd_copy_buffer(cmd, source.handle(), editor.buffer(), &all);
                    editor.record(cmd, &mut scene, 1, &edit)
                }
            });
            done.expect("it fits");
            let ours = draw(scene.clone());
            assert!(ours == draw(upload(&truth)), "{format:?}, change {at}");
            assert!(ours != before, "change {at} shows");
            before = ours;
        }
    }
}

#[test]
fn edits_of_what_is_not_there_are_refused() {
    let parts = [300, 20, 10].map(|count| generate(Kind::General, count, 1));
    let [one, two, three] = &parts;
    let headless = common::headless();
    let device = headless.device().clone();
    let renderer = Renderer::new(&device, RendererDesc::new(FORMAT)).expect("a renderer");
    let upload = |scene| SceneBuffers::upload(&device, scene, ShFormat::Byte).expect("uploads");
    let mut scene = upload(layers([one, two, three]));
    let mut editor = LayerEditor::new(&renderer, &scene, 100).expect("an editor");
    let before = scene.clone();
    let box_of = |min: f64, max: f64| {
        let [min, max] = [min, max].map(rara::glam::DVec3::splat);
        Some(Bounds { min, max })
    };
    let all = LayerEdit::of(0..10).positions(true);
    let mut edit = |scene: &mut SceneBuffers, index, edit: &LayerEdit| {
        // SAFETY: `cmd` is recording, and everything outlives the wait for it.
        device.submit_and_wait(|cmd| unsafe { editor.record(cmd, scene, index, edit) })
    };
    for (index, refused, says) in [
        (3, all, "no layer 3"),
        (
            2,
            LayerEdit::of(3..11).opacities(true),
            "ends with Gaussian 11 of layer 'part', which has 10",
        ),
        (
            0,
            LayerEdit::of(10..u32::MAX).flat(true),
            "replace the layer",
        ),
        (
            0,
            LayerEdit::of(10..111).scales(true),
            "needs an editor for as many",
        ),
        (0, all.bounds(box_of(1.0, 0.0)), "not a box"),
        (0, all.bounds(box_of(f64::NAN, 0.0)), "not a box"),
        (0, all.bounds(box_of(0.0, 1e300)), "not a box"),
    ] {
        let error = edit(&mut scene, index, &refused)
            .expect_err(says)
            .to_string();
        assert!(error.contains(says), "{error}");
    }
    // Nothing is changed by these.
    edit(&mut scene, 0, &LayerEdit::of(5..5).positions(true)).expect("nothing");
    edit(&mut scene, 0, &LayerEdit::of(5..6)).expect("nothing");
    let camera = common::views(one, 1, (64, 64))[0];
    let mut renderer = renderer;
    let clip = common::clip(one, 1, ClipOp::And);
    let usual = Settings::default();
    let configured = renderer.configure(&before, &camera, &clip, &usual);
    drop(configured.expect("it was not edited"));
    edit(&mut scene, 0, &LayerEdit::of(5..6).flat(true)).expect("it fits");
    let stale = renderer.configure(&before, &camera, &clip, &usual);
    let stale = stale.expect_err("its Gaussians are gone").to_string();
    assert!(stale.contains("in a clone"), "{stale}");
}
