//! Every call that can fail does so once, at every place of a headless life. Each failure ends in an error that says what to
//! do, and leaves nothing behind: no memory, no object, and no message of the validation layer.

use super::super::*;
use ash::vk::{self, Result as Code};
use glam::DVec3;
use rara_gpu::faults::{self, CAN_BE_LOST, Fault, Pretence};
use rara_gpu::{Bindings, DeviceShape, PipelineCache};
use rara_scene::clip::{ClipOp, Plane};
use rara_scene::settings::Raster;
use rara_scene::{Bounds, Kind, generate};

/// A scene, a frame of it from nothing, reclipped frames, and pictures of the first and the last. The one in between has a
/// background, so that there is a draw in any case.
fn life(headless: &mut Headless, raster: Raster) -> Result<[Picture; 2]> {
    let scene = generate(Kind::General, 600, 1);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (24, 16))?;
    let draw = |headless: &mut Headless, offset, background| {
        let clip = Clip::of([Plane::new(DVec3::X, offset)?], ClipOp::And);
        let settings = Settings::default().raster(raster).background(background);
        headless.render(&camera, &clip, &settings).map(drop)
    };
    headless.load(&scene)?;
    headless.forget();
    draw(headless, 0.0, None)?;
    let first = headless.picture()?;
    draw(headless, 0.1, Some([0.1; 3]))?;
    headless.picture()?;
    draw(headless, 0.2, None)?;
    Ok([first, headless.picture()?])
}

fn on(device: &Device) -> Result<Headless> {
    let desc = HeadlessDesc {
        bindings: Some(Bindings::Mixed),
        pipeline_cache: PipelineCache::Off,
        ..HeadlessDesc::default()
    };
    Headless::on(device.clone(), &desc)
}

#[test]
fn memory_may_run_out_anywhere() {
    if faults::is_slow() {
        eprintln!("SKIPPED: memory that runs out, on a slow driver, whose code it does not test");
        return;
    }
    run_out(|after| 9 * after + 2);
}

#[test]
#[ignore = "every one of 250 places: two minutes"]
fn memory_may_run_out_everywhere() {
    run_out(|after| after + 1);
}

/// Each call fails where it is called for the first time, and then at the places that `next` goes to.
fn run_out(next: impl Fn(usize) -> usize) {
    let device = faults::device(None).expect("a device");
    life(&mut on(&device).expect("no fault"), Raster::Tiles).expect("no fault");
    let counts = faults::CALLS.map(faults::count);
    let mut failed = std::collections::BTreeMap::new();
    for (call, count) in faults::CALLS.iter().zip(counts) {
        let mut after = 0;
        // The command buffer is made once and kept.
        while after < count && fails(&device, call, after) {
            *failed.entry(*call).or_insert(0) += 1;
            after = next(after);
        }
    }
    for call in [
        "vkAllocateMemory",
        "vkCreateBuffer",
        "vkBindBufferMemory",
        "vkCreateImage",
        "vkCreateImageView",
        "vkCreateComputePipelines",
        "vkCreateGraphicsPipelines",
        "vkQueueSubmit2",
        "vkWaitForFences",
    ] {
        assert!(failed.contains_key(call), "{call} is not in {failed:?}");
    }
    // Where the device's memory is not the host's, the blocks that are mapped may be older than this.
    assert!(failed.contains_key("vkMapMemory") || device.shape() != DeviceShape::Cpu);
    eprintln!("{} places: {failed:?}", failed.values().sum::<i32>());
    assert_eq!(device.close(), Vec::<String>::new());
}

/// Checks that a call whose memory runs out, after `after` that succeed, ends in an error and leaves no trace. Returns false
/// where there are not so many calls.
fn fails(device: &Device, call: &'static &'static str, after: usize) -> bool {
    let result = [
        Code::ERROR_OUT_OF_DEVICE_MEMORY,
        Code::ERROR_OUT_OF_HOST_MEMORY,
    ][after % 2];
    faults::set_among(std::slice::from_ref(call), Some(Fault { after, result }));
    let mut opened = on(device);
    let lived = match &mut opened {
        Ok(headless) => life(headless, Raster::Tiles).map(Some),
        Err(_) => Ok(None),
    };
    let fired = faults::fired().is_some();
    faults::set_among(&[], None);
    if !fired {
        return false;
    }
    match lived.as_ref().err().or(opened.as_ref().err()) {
        Some(Error::Memory(text)) => {
            let says = text.contains("memory") || text.contains("allocated");
            assert!(says, "{text}");
        }
        // Without an error, times are left out, tiles have become quads and a reclipped frame a whole one.
        None => {
            let tolerated = [
                "vkGetQueryPoolResults",
                "vkAllocateMemory",
                "vkCreateBuffer",
                "vkBindBufferMemory",
            ];
            assert!(
                tolerated.contains(call),
                "nobody noticed that {call} failed"
            );
        }
        Some(other) => panic!("{call}, {result:?}: {other}"),
    }
    // The same renderer can try again what failed.
    if let (Ok(headless), 0) = (&mut opened, after) {
        let [first, last] = life(headless, Raster::Tiles).expect("there is memory again");
        assert!(first != last && first.pixels.iter().any(|pixel| pixel[3] > 0.1));
    }
    drop(opened);
    assert_eq!(device.device_bytes(), 0, "after {call} failed");
    assert_eq!(device.validation_messages(), Vec::<String>::new(), "{call}");
    true
}

#[test]
fn a_device_may_be_lost_anywhere() {
    let mut places = 0;
    let mut after = 0;
    let step = if faults::is_slow() { 8 } else { 1 };
    loop {
        // A lost device is given up with all that was made from it.
        let device = faults::device(None).expect("a device");
        let result = Code::ERROR_DEVICE_LOST;
        // The next call that can say so.
        let mut opened = on(&device).expect("no fault yet");
        faults::set_among(&CAN_BE_LOST, Some(Fault { after, result }));
        let lived = life(&mut opened, Raster::Tiles);
        let Some(call) = faults::fired() else {
            faults::set_among(&[], None);
            lived.expect("nothing has failed");
            break;
        };
        match lived {
            Err(Error::DeviceLost { call }) => assert!(call.starts_with("vk"), "{call}"),
            // Only the last frame's times are missing: its picture is there already.
            Ok(_) if call == "vkGetQueryPoolResults" => {}
            Ok(_) => panic!("{call} was lost and nobody noticed"),
            Err(other) => panic!("{call}: {other}"),
        }
        // It stays lost.
        let again = opened
            .picture()
            .and(life(&mut opened, Raster::Tiles).map(drop));
        assert!(matches!(
            again,
            Err(Error::DeviceLost { .. } | Error::Invalid(_))
        ));
        drop(opened);
        assert_eq!(device.device_bytes(), 0, "after {call}");
        faults::set_among(&[], None);
        assert_eq!(device.close(), Vec::<String>::new(), "{call}");
        places += 1;
        after += step;
    }
    assert!(places * step > 10, "{places}");
}

#[test]
fn a_device_that_is_too_old_or_lacks_something_says_so() {
    for (pretence, says) in [
        (
            Pretence::Vulkan11,
            "it offers Vulkan 1.1 and 1.2 is needed; a newer driver may help",
        ),
        (
            Pretence::Vulkan12Alone,
            "Vulkan 1.2 needs the extension VK_KHR_synchronization2, which it lacks",
        ),
        (
            Pretence::Without("synchronization2"),
            "it lacks the feature synchronization2",
        ),
        (
            Pretence::Without("dynamicRendering"),
            "it lacks the feature dynamicRendering",
        ),
        (
            Pretence::WithoutGraphics,
            "no queue family has both graphics and compute",
        ),
        (Pretence::ExtensionsFail, "host memory"),
        (
            Pretence::CreateFails(Code::ERROR_DEVICE_LOST),
            "the device was lost (vkCreateDevice)",
        ),
        (
            Pretence::CreateFails(Code::ERROR_OUT_OF_DEVICE_MEMORY),
            "vkCreateDevice ran out of device memory",
        ),
        (
            Pretence::CreateFails(Code::ERROR_INITIALIZATION_FAILED),
            "vkCreateDevice failed",
        ),
    ] {
        let error = faults::device(Some(pretence)).expect_err("it is of no use");
        let text = error.to_string();
        assert!(text.contains(says), "{pretence:?}: {text}");
        // It is listed all the same, with the reason.
        let listed = faults::instance(Some(pretence)).devices().expect("a list");
        let refused = listed.iter().filter(|(_, info)| info.support.is_err());
        let creates = matches!(pretence, Pretence::CreateFails(_));
        assert_eq!(refused.count(), if creates { 0 } else { listed.len() });
    }
}

#[test]
fn a_device_of_vulkan_1_2_draws_the_same_picture() {
    let [natural, floor] = [None, Some(Pretence::Vulkan12)].map(|pretence| {
        let device = faults::device(pretence).expect("a device");
        let natural = device.support().api_version == vk::API_VERSION_1_3;
        assert_eq!(natural, pretence.is_none());
        let mut headless = on(&device).expect("a renderer");
        let pictures = [Raster::Tiles, Raster::Quad].map(|raster| life(&mut headless, raster));
        drop(headless);
        assert_eq!(device.close(), Vec::<String>::new());
        pictures.map(|pictures| pictures.expect("renders"))
    });
    assert!(natural == floor, "to the bit");
}

/// As where a capture tool hides the feature.
#[test]
fn a_device_without_addresses_binds_its_buffers() {
    let without = Pretence::Without("bufferDeviceAddress");
    let [natural, bound] = [None, Some(without)].map(|pretence| {
        let device = faults::device(pretence).expect("a device");
        assert_eq!(device.support().buffer_device_address, pretence.is_none());
        let desc = HeadlessDesc {
            bindings: Some(match pretence {
                None => Bindings::Bound,
                Some(_) => Bindings::Mixed,
            }),
            pipeline_cache: PipelineCache::Off,
            ..HeadlessDesc::default()
        };
        let mut headless = Headless::on(device.clone(), &desc).expect("a renderer");
        let pictures = life(&mut headless, Raster::Tiles).expect("renders");
        drop(headless);
        assert_eq!(device.close(), Vec::<String>::new());
        pictures
    });
    assert!(natural == bound, "to the bit");
}

#[test]
fn without_any_extension_a_frame_is_drawn_all_the_same() {
    let device = faults::device(Some(Pretence::WithoutExtensions)).expect("a device");
    let support = device.support();
    assert!(!support.mesh_shader && !support.push_descriptor);
    let mut headless = on(&device).expect("a renderer");
    let [tiles, quads] = [Raster::Tiles, Raster::Quad]
        .map(|raster| life(&mut headless, raster).expect("renders")[0].clone());
    let difference =
        rara_reference::differences::differences(&tiles, &quads).expect("the same size");
    assert!(difference.psnr > 60.0, "{difference:?}");
    let error = life(&mut headless, Raster::Mesh).expect_err("there are none");
    assert!(error.to_string().contains("VK_EXT_mesh_shader"), "{error}");
    drop(headless);
    assert_eq!(device.close(), Vec::<String>::new());
}

/// Everything has a name, which RenderDoc, Nsight and the validation layer show.
#[test]
fn every_object_has_a_name_and_every_command_a_label() {
    let device = faults::device(None).expect("a device");
    let mut rasters = vec![Raster::Tiles, Raster::Quad];
    if device.support().mesh_shader {
        rasters.push(Raster::Mesh);
    }
    let mut timed = std::collections::BTreeSet::new();
    for raster in rasters {
        let mut headless = on(&device).expect("a renderer");
        headless.session.renderer.set_name("left eye");
        for offset in [0.0, 0.1, 0.2] {
            let scene = generate(Kind::General, 600, 1);
            let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (24, 16));
            if headless.session.scene.is_none() {
                headless.load(&scene).expect("uploads");
            }
            let clip = Clip::of(
                [Plane::new(DVec3::X, offset).expect("a plane")],
                ClipOp::And,
            );
            let settings = Settings::default().raster(raster);
            let stats = headless.render(&camera.expect("a view"), &clip, &settings);
            timed.extend(stats.expect("renders").passes.iter().map(|pass| pass.name));
        }
        headless.picture().expect("reads back");
    }
    assert_eq!(faults::nameless(), Vec::<&str>::new());
    let (labels, unlabelled) = faults::labels();
    assert_eq!(unlabelled, Vec::<&str>::new(), "recorded outside any label");
    let stages = [
        "clip", "blocks", "classify", "compact", "cutoff", "project", "sort", "bin", "tiles",
        "splat", "reclip", "recut",
    ];
    for name in stages {
        assert!(labels.iter().any(|label| label == name), "{name}");
        assert!(
            timed.contains(name) || device.support().timestamp_period == 0.0,
            "{name}"
        );
    }
    for name in [
        "left eye", "frame", "counts", "upload", "target", "readback",
    ] {
        assert!(labels.iter().any(|label| label == name), "{name}");
    }
    assert!(timed.iter().all(|name| stages.contains(name)), "{timed:?}");
    assert_eq!(device.close(), Vec::<String>::new());
}
