//! The Vulkan layer on the device at hand. Every test ends without messages of the validation layer, or with those that
//! it provokes: lavapipe draws the right picture with barriers missing, and only the layer notices.

use ash::vk;
use rara::Error;
use rara::gpu::*;

/// A committed SPIR-V file as words.
macro_rules! spirv {
    ($file:literal) => {{
        const BYTES: &[u8] = include_bytes!(concat!("shaders/", $file, ".spv"));
        const WORDS: [u32; BYTES.len() / 4] = words(BYTES);
        &WORDS
    }};
}

const fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let mut words = [0; N];
    let mut i = 0;
    while i < N {
        words[i] = u32::from_le_bytes([
            bytes[4 * i],
            bytes[4 * i + 1],
            bytes[4 * i + 2],
            bytes[4 * i + 3],
        ]);
        i += 1;
    }
    words
}

const fn used(name: &'static str, binding: u32, access: BufferAccess) -> BufferUse {
    BufferUse {
        name,
        binding,
        access,
    }
}

/// `target[i] = FACTOR * source[i] + param[1]` for i below `param[0]`, 64 a workgroup.
const ADD: Shader = Shader {
    name: "add",
    stage: vk::ShaderStageFlags::COMPUTE,
    address: spirv!("add.comp.address"),
    bound: spirv!("add.comp.bound"),
    buffers: &[
        used("source", 0, BufferAccess::Read),
        used("target", 1, BufferAccess::Write),
    ],
};
const VERTEX: Shader = Shader {
    name: "square",
    stage: vk::ShaderStageFlags::VERTEX,
    address: spirv!("square.vert.address"),
    bound: spirv!("square.vert.bound"),
    buffers: &[used("corners", 0, BufferAccess::Read)],
};
const MESH: Shader = Shader {
    name: "square",
    stage: vk::ShaderStageFlags::MESH_EXT,
    address: spirv!("square.mesh.address"),
    bound: spirv!("square.mesh.bound"),
    buffers: &[used("corners", 0, BufferAccess::Read)],
};
const FRAGMENT: Shader = Shader {
    name: "square",
    stage: vk::ShaderStageFlags::FRAGMENT,
    address: spirv!("square.frag.address"),
    bound: spirv!("square.frag.bound"),
    buffers: &[used("paint", 1, BufferAccess::Read)],
};

/// The ways to reach buffers on this device.
fn all_bindings(device: &Device) -> &'static [Bindings] {
    if device.support().push_descriptor {
        &[Bindings::Address, Bindings::Bound]
    } else {
        eprintln!(
            "{} has no push descriptors: bound buffers are not tested",
            device.info().name
        );
        &[Bindings::Address]
    }
}

/// The device under test: the best one, or the one that `RARA_TEST_DEVICE` names.
fn open() -> Device {
    let selector = std::env::var("RARA_TEST_DEVICE").ok();
    Device::headless(&DeviceDesc::default().selector(selector).validation(true)).unwrap()
}

/// Runs a test on a device with validation and asserts that the layer reports nothing, up to the destruction.
fn clean(test: impl FnOnce(&Device)) {
    let device = open();
    test(&device);
    assert_eq!(device.device_bytes(), 0, "everything allocated was freed");
    assert_eq!(device.close(), Vec::<String>::new());
}

fn buffer(device: &Device, name: &str, size: u64, location: Location) -> Buffer {
    device
        .create_buffer(&BufferDesc {
            name,
            size,
            location,
        })
        .unwrap()
}

fn on_device(device: &Device, name: &str, data: &[u32]) -> Buffer {
    let made = buffer(device, name, 4 * data.len() as u64, Location::GpuOnly);
    device.upload(&made, 0, bytemuck::cast_slice(data)).unwrap();
    made
}

fn read(device: &Device, buffer: &Buffer, count: usize) -> Vec<u32> {
    let bytes = device.download_range(buffer, 0, 4 * count as u64).unwrap();
    bytes
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes(word.try_into().unwrap()))
        .collect()
}

/// Records, submits and waits.
fn record(device: &Device, timer: Option<&mut Timer>, passes: impl FnOnce(&mut Recorder<'_>)) {
    let done = device.submit_and_wait(|cmd| {
        // SAFETY: `cmd` is recording on `device`, and the passes use only what outlives this call, which waits.
        passes(&mut unsafe { Recorder::begin(device, cmd, timer) });
        Ok(())
    });
    done.unwrap();
}

fn add(device: &Device, factor: u32, bindings: Bindings) -> ComputePipeline {
    let desc = ComputeDesc {
        name: "add",
        shader: &ADD,
        constants: &[(0, factor)],
        bindings,
    };
    ComputePipeline::new(device, &desc).unwrap()
}

#[test]
fn a_device_opens_with_validation_and_says_who_it_is() {
    clean(|device| {
        let info = device.info();
        assert!(!info.name.is_empty() && !info.driver.is_empty() && info.memory > 0);
        assert!(info.api >= (1, 3, 0));
        let listed = list_devices().unwrap();
        assert!(
            listed
                .iter()
                .any(|other| other.name == info.name && other.support.is_ok())
        );
    });
}

#[test]
fn an_unknown_device_is_an_error_that_lists_the_known_ones() {
    let desc = DeviceDesc::default().selector(Some("no such device".into()));
    let error = Device::headless(&desc).unwrap_err().to_string();
    assert!(
        error.contains("no such device") && error.contains(&list_devices().unwrap()[0].name),
        "{error}"
    );
}

#[test]
fn leaks_are_seen_when_the_device_closes() {
    let device = open();
    // SAFETY: the device is alive; leaking the fence is the point.
    let _leak = unsafe {
        device
            .raw()
            .create_fence(&vk::FenceCreateInfo::default(), None)
    }
    .unwrap();
    let messages = device.close();
    assert!(
        messages
            .iter()
            .any(|message| message.contains("vkDestroyDevice")),
        "{messages:?}"
    );
}

#[test]
fn uploads_in_chunks_come_back() {
    clean(|device| {
        let data: Vec<u32> = (0..(40 << 20) / 4)
            .map(|i: u32| i.wrapping_mul(2_654_435_761))
            .collect();
        let large = on_device(device, "large", &data);
        assert!(read(device, &large, data.len()) == data);

        device.upload(&large, 12, &[1, 2, 3, 4, 5]).unwrap();
        assert_eq!(
            device.download_range(&large, 11, 7).unwrap()[1..6],
            [1, 2, 3, 4, 5]
        );

        let mut chunks = Vec::new();
        let fill = |at, chunk: &mut [u8]| {
            chunks.push((at, chunk.len()));
            chunk.fill(7);
            Ok(())
        };
        device.upload_with(&large, 4, 33 << 20, fill).unwrap();
        assert_eq!(chunks, [(0, 32 << 20), (32 << 20, 1 << 20)]);
        assert!(
            device
                .download_range(&large, 4, 33 << 20)
                .unwrap()
                .iter()
                .all(|byte| *byte == 7)
        );
    });
}

#[test]
fn sizes_are_rounded_up_and_freed() {
    clean(|device| {
        let empty = buffer(device, "empty", 0, Location::GpuOnly);
        assert_eq!(empty.size(), 16);
        assert!(empty.address() != 0 && empty.address().is_multiple_of(16));
        let large = buffer(device, "large", 100 << 20, Location::GpuOnly);
        assert!(device.device_bytes() >= large.size() + 16);
        drop(large);
        assert!(device.device_bytes() < 1 << 20);
    });
}

#[test]
fn what_does_not_fit_is_an_error_that_names_it() {
    clean(|device| {
        let desc = BufferDesc {
            name: "splats",
            size: 1 << 50,
            location: Location::GpuOnly,
        };
        let error = device.create_buffer(&desc).unwrap_err();
        assert!(matches!(error, Error::Memory(_)));
        assert!(
            error.to_string().contains("\"splats\" of 1048576.00 GiB"),
            "{error}"
        );
    });
}

#[test]
fn fills_updates_and_copies_reach_mapped_memory() {
    clean(|device| {
        let mut source = buffer(device, "source", 256, Location::Upload);
        source.mapped_mut().fill(0xAB);
        let middle = buffer(device, "middle", 1 << 20, Location::GpuOnly);
        let target = buffer(device, "target", 1 << 20, Location::Readback);
        let update: Vec<u8> = (0..200_000_u32).map(|i| (i % 251) as u8).collect();
        record(device, None, |recorder| {
            recorder.fill(&middle, 0, middle.size(), 0x01020304);
            recorder.update(&middle, 1024, &update);
            recorder.copy(
                &source,
                &middle,
                &[vk::BufferCopy {
                    src_offset: 0,
                    dst_offset: 16,
                    size: 256,
                }],
            );
            recorder.copy(
                &middle,
                &target,
                &[vk::BufferCopy {
                    src_offset: 0,
                    dst_offset: 0,
                    size: 1 << 20,
                }],
            );
            recorder.ready_for_host(&[&target]);
        });
        let bytes = target.mapped();
        assert_eq!(bytes[..16], [4, 3, 2, 1].repeat(4));
        assert!(bytes[16..272].iter().all(|byte| *byte == 0xAB));
        assert!(bytes[1024..][..update.len()] == update);
        assert_eq!(bytes[(1 << 20) - 4..], [4, 3, 2, 1]);
    });
}

#[test]
fn dependent_dispatches_wait_for_each_other() {
    clean(|device| {
        let input: Vec<u32> = (0..1000).collect();
        for &bindings in all_bindings(device) {
            let pipeline = add(device, 3, bindings);
            let first = on_device(device, "first", &input);
            let second = buffer(device, "second", 4000, Location::GpuOnly);
            record(device, None, |recorder| {
                recorder.pass("there and back", |recorder| {
                    for _ in 0..2 {
                        recorder.dispatch(
                            &pipeline,
                            &[&first, &second],
                            &[1000, 1],
                            Groups::Count(16),
                        );
                        recorder.dispatch(
                            &pipeline,
                            &[&second, &first],
                            &[1000, 2],
                            Groups::Count(16),
                        );
                    }
                });
            });
            let twice = |x: u32| 3 * (3 * x + 1) + 2;
            let expected: Vec<u32> = input.iter().map(|x| twice(twice(*x))).collect();
            assert_eq!(read(device, &first, 1000), expected, "{bindings:?}");
        }
    });
}

#[test]
fn indirect_dispatches_read_what_was_written_before() {
    clean(|device| {
        for &bindings in all_bindings(device) {
            let pipeline = add(device, 1, bindings);
            let source = on_device(device, "source", &[5; 256]);
            let target = on_device(device, "target", &[0; 256]);
            let args = on_device(device, "args", &[0; 4]);
            record(device, None, |recorder| {
                recorder.update(&args, 4, bytemuck::cast_slice(&[2_u32, 1, 1]));
                recorder.dispatch(
                    &pipeline,
                    &[&source, &target],
                    &[256, 1],
                    Groups::Indirect(&args, 4),
                );
                // Without work nothing is recorded.
                recorder.dispatch(&pipeline, &[&target, &source], &[256, 1], Groups::Count(0));
                recorder.fill(&args, 0, 16, 0);
            });
            let expected: Vec<u32> = [[6; 128], [0; 128]].concat();
            assert_eq!(read(device, &target, 256), expected);
            assert_eq!(read(device, &source, 256), [5; 256]);
        }
    });
}

#[test]
fn more_groups_than_a_row_holds_all_run() {
    clean(|device| {
        let limit = device.support().max_group_count.min(65_535);
        let count = 64 * (limit + 1000);
        let pipeline = add(device, 1, Bindings::Address);
        let source = buffer(device, "source", 4 * u64::from(count), Location::GpuOnly);
        let target = buffer(device, "target", 4 * u64::from(count), Location::GpuOnly);
        record(device, None, |recorder| {
            recorder.fill(&source, 0, source.size(), 1);
            recorder.dispatch(
                &pipeline,
                &[&source, &target],
                &[count, 1],
                Groups::Count(count / 64),
            );
        });
        assert!(
            read(device, &target, count as usize)
                .iter()
                .all(|x| *x == 2)
        );
    });
}

#[test]
fn a_missing_barrier_is_seen() {
    let device = open();
    let first = on_device(&device, "first", &[1; 64]);
    let second = on_device(&device, "second", &[2; 64]);
    let done = device.submit_and_wait(|cmd| {
        let region = [vk::BufferCopy::default().size(256)];
        // SAFETY: `cmd` is recording and the buffers outlive it; the missing barrier is the point.
        unsafe {
            device.raw().cmd_fill_buffer(cmd, first.handle(), 0, 256, 0);
            device
                .raw()
                .cmd_copy_buffer(cmd, first.handle(), second.handle(), &region);
        }
        Ok(())
    });
    done.unwrap();
    let messages = device.validation_messages();
    assert!(
        messages
            .iter()
            .any(|message| message.contains("READ_AFTER_WRITE")),
        "{messages:?}"
    );
}

#[test]
fn messages_name_the_pass_and_the_objects() {
    let device = open();
    let splats = on_device(&device, "splats", &[1; 64]);
    let keys = on_device(&device, "keys", &[2; 64]);
    record(&device, None, |recorder| {
        recorder.pass("sort", |recorder| {
            recorder.pass("digit", |recorder| {
                let (raw, cmd) = (device.raw(), recorder.cmd());
                let region = [vk::BufferCopy::default().size(256)];
                // SAFETY: `cmd` is recording and the buffers outlive it; the missing barrier is the point.
                unsafe {
                    raw.cmd_fill_buffer(cmd, splats.handle(), 0, 256, 0);
                    raw.cmd_copy_buffer(cmd, splats.handle(), keys.handle(), &region);
                }
            });
        });
    });
    let messages = device.validation_messages();
    let hazard = messages.iter().find(|text| text.contains("HAZARD"));
    let hazard = hazard.expect("a hazard");
    assert!(hazard.starts_with("in pass sort > digit: "), "{hazard}");
    assert!(hazard.contains("splats"), "{hazard}");

    // Messages of a layer arrive as they were sent.
    // SAFETY: loader and library stay loaded, the instance is this test's, and what is pointed to outlives the calls.
    unsafe {
        let entry = ash::Entry::load().unwrap();
        let raw_instance = device.instance().handle();
        let instance = ash::Instance::load(entry.static_fn(), raw_instance);
        let debug = ash::ext::debug_utils::Instance::new(&entry, &instance);
        let labels = [vk::DebugUtilsLabelEXT::default().label_name(c"project")];
        let objects = [vk::DebugUtilsObjectNameInfoEXT::default()
            .object_handle(splats.handle())
            .object_name(c"splats")];
        let data = vk::DebugUtilsMessengerCallbackDataEXT::default()
            .cmd_buf_labels(&labels)
            .objects(&objects)
            .message(c"only a test");
        debug.submit_debug_utils_message(
            vk::DebugUtilsMessageSeverityFlagsEXT::WARNING,
            vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION,
            &data,
        );
    }
    assert_eq!(
        device.validation_messages(),
        ["in pass project: buffer splats: only a test"]
    );
}

#[test]
fn memory_is_listed_by_name() {
    clean(|device| {
        let _one = buffer(device, "pairs", 1 << 20, Location::GpuOnly);
        let _other = buffer(device, "pairs", 17 << 20, Location::GpuOnly);
        let _small = buffer(device, "counts", 64, Location::Readback);
        let parts = device.memory_by_name();
        let names: Vec<_> = parts.iter().map(|of| of.name.as_str()).collect();
        assert_eq!(names, ["pairs", "counts"]);
        assert!(parts[0].bytes >= 18 << 20, "{parts:?}");
        let sum: u64 = parts.iter().map(|of| of.bytes).sum();
        assert_eq!(sum, device.device_bytes());
    });
}

#[test]
#[should_panic(expected = "\"add\" was given 1 buffers and its shaders declare 2")]
fn a_wrong_number_of_buffers_is_refused() {
    let device = open();
    let pipeline = add(&device, 1, Bindings::Address);
    let source = on_device(&device, "source", &[0; 4]);
    record(&device, None, |recorder| {
        recorder.dispatch(&pipeline, &[&source], &[], Groups::Count(1))
    });
}

#[test]
fn passes_are_timed_by_name() {
    clean(|device| {
        let mut timer = Timer::new(device, 4).unwrap();
        assert_eq!(timer.read(), None, "nothing was recorded");
        let target = buffer(device, "target", 16 << 20, Location::GpuOnly);
        for _ in 0..2 {
            record(device, Some(&mut timer), |recorder| {
                recorder.pass("fill", |recorder| {
                    recorder.fill(&target, 0, target.size(), 1)
                });
                recorder.pass("nothing", |_| ());
                recorder.pass("fill", |recorder| {
                    recorder.fill(&target, 0, target.size(), 2)
                });
            });
            match timer.read() {
                Some(times) => {
                    assert_eq!(
                        times.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
                        ["fill", "nothing"]
                    );
                    assert!(
                        times.iter().all(|(_, ms)| (0.0..10_000.0).contains(ms)),
                        "{times:?}"
                    );
                    assert!(times[0].1 > times[1].1, "{times:?}");
                }
                None => assert_eq!(device.support().timestamp_period, 0.0),
            }
        }
    });
}

/// Draws the left half of an 8 x 8 image, with arguments, corners and colour written in the same command buffer.
fn draw_half(device: &Device, front: &Shader, bindings: Bindings, indexed: bool) {
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let desc = GraphicsDesc {
        name: "square",
        front,
        fragment: &FRAGMENT,
        constants: &[],
        attachments: Attachments::color(format),
        depth_test: false,
        blend: None,
        topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
        bindings,
    };
    let pipeline = GraphicsPipeline::new(device, &desc).unwrap();
    let image = device
        .create_image(&ImageDesc {
            name: "picture",
            width: 8,
            height: 8,
            format,
        })
        .unwrap();
    let corners = buffer(device, "corners", 32, Location::GpuOnly);
    let paint = buffer(device, "paint", 16, Location::GpuOnly);
    let args = buffer(device, "args", 32, Location::GpuOnly);
    let indices = buffer(device, "indices", 16, Location::GpuOnly);
    let target = buffer(device, "target", 8 * 8 * 16, Location::Readback);
    let mut timer = Timer::new(device, 2).unwrap();
    let colour = [0.25_f32, 0.5, 0.75, 1.0];
    let frame = |cmd| {
        // SAFETY: `cmd` is recording on `device`, and everything used outlives the wait.
        let mut recorder = unsafe { Recorder::begin(device, cmd, Some(&mut timer)) };
        recorder.pass("prepare", |recorder| {
            recorder.update(
                &corners,
                0,
                bytemuck::cast_slice(&[-1.0_f32, -1.0, 0.0, -1.0, -1.0, 1.0, 0.0, 1.0]),
            );
            recorder.update(&paint, 0, bytemuck::cast_slice(&colour));
            recorder.update(&indices, 0, bytemuck::cast_slice(&[0_u32, 1, 2, 3]));
            let arguments: &[u32] = match (pipeline.is_mesh(), indexed) {
                (true, _) => &[1, 1, 1],
                (false, true) => &[4, 1, 0, 0, 0],
                (false, false) => &[4, 1, 0, 0],
            };
            recorder.update(&args, 4, bytemuck::cast_slice(arguments));
        });
        recorder.ready_to_draw(&[&corners, &paint, &args, &indices]);
        // SAFETY: as above; the drawer lives inside the rendering and the buffers were made ready to draw.
        unsafe {
            image.begin_rendering(cmd, [0.0; 4]);
            let mut drawer = Drawer::new(device, cmd, Some(&mut timer));
            drawer.viewport(image.extent().into());
            drawer.pass("draw", |drawer| {
                let buffers = [&corners, &paint];
                if pipeline.is_mesh() {
                    drawer.draw_mesh_tasks_indirect(&pipeline, &buffers, &[], &args, 4);
                } else if indexed {
                    drawer.draw_indexed_indirect(&pipeline, &buffers, &[], &indices, &args, 4);
                } else {
                    drawer.draw_indirect(&pipeline, &buffers, &[], &args, 4);
                }
            });
            image.end_rendering(cmd);
            image.copy_to(cmd, &target);
        }
        Ok(())
    };
    device.submit_and_wait(frame).unwrap();
    for (i, pixel) in target.mapped().chunks_exact(16).enumerate() {
        let expected = if i % 8 < 4 { colour } else { [0.0; 4] };
        assert_eq!(
            pixel,
            bytemuck::bytes_of(&expected),
            "pixel {i}, {bindings:?}"
        );
    }
    if let Some(times) = timer.read() {
        assert_eq!(
            times.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
            ["prepare", "draw"]
        );
    }
}

#[test]
fn draws_read_what_the_same_command_buffer_wrote() {
    clean(|device| {
        for &bindings in all_bindings(device) {
            draw_half(device, &VERTEX, bindings, false);
            draw_half(device, &VERTEX, bindings, true);
        }
    });
}

#[test]
fn mesh_shaders_draw_or_are_refused_with_a_reason() {
    clean(|device| {
        if device.support().mesh_shader {
            for &bindings in all_bindings(device) {
                draw_half(device, &MESH, bindings, false);
            }
        } else {
            let desc = GraphicsDesc {
                name: "square",
                front: &MESH,
                fragment: &FRAGMENT,
                constants: &[],
                attachments: Attachments::color(vk::Format::R8G8B8A8_UNORM),
                depth_test: false,
                blend: None,
                topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                bindings: Bindings::Address,
            };
            let error = GraphicsPipeline::new(device, &desc).unwrap_err();
            assert!(error.to_string().contains("VK_EXT_mesh_shader"), "{error}");
        }
    });
}

#[test]
fn several_threads_share_a_device() {
    clean(|device| {
        std::thread::scope(|scope| {
            for thread in 0..4_u32 {
                scope.spawn(move || {
                    let data = vec![thread; 10_000];
                    let made = on_device(device, "shared", &data);
                    assert_eq!(read(device, &made, data.len()), data);
                });
            }
        });
    });
}

#[test]
fn a_failed_or_panicking_recording_submits_nothing_and_leaves_the_device_usable() {
    clean(|device| {
        let refused: rara::Result<()> =
            device.submit_and_wait(|_| Err(Error::Invalid("no".into())));
        assert_eq!(refused.unwrap_err().to_string(), "no");
        let panic = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            device.submit_and_wait(|_| -> rara::Result<()> { panic!("on purpose") })
        }));
        assert!(panic.is_err());
        let inner = device.submit_and_wait(|_| device.submit_and_wait(|_| Ok(7)));
        assert_eq!(inner.unwrap(), 7);
    });
}

#[test]
fn formats_say_what_they_can_do() {
    clean(|device| {
        let wanted = vk::FormatFeatureFlags::COLOR_ATTACHMENT
            | vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        assert!(
            device
                .format_features(vk::Format::R8G8B8A8_UNORM)
                .contains(wanted)
        );
        assert!(device.format_features(vk::Format::UNDEFINED).is_empty());
    });
}

/// A host that owns instance and device, as an application would.
#[test]
fn a_hosts_device_is_adopted_and_left_alone() {
    // SAFETY: the loader has no harmful initialisation; every handle is used while alive and destroyed once, in order.
    unsafe {
        let entry = ash::Entry::load().unwrap();
        let version = vk::API_VERSION_1_3;
        let application = vk::ApplicationInfo::default().api_version(version);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        let instance = entry.create_instance(&info, None).unwrap();
        let devices = instance.enumerate_physical_devices().unwrap();
        let usable = devices
            .into_iter()
            .find_map(|physical| Some((physical, check(&instance, physical, version).ok()?)));
        let (physical_device, support) = usable.unwrap();
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(support.queue_family)
            .queue_priorities(&[1.0])];
        let mut plain = support.clone();
        plain.mesh_shader = false;
        let mut features = plain.features();
        let info = features.chain(vk::DeviceCreateInfo::default().queue_create_infos(&queues));
        let raw = instance
            .create_device(physical_device, &info, None)
            .unwrap();
        let adopted = Device::adopt(AdoptDesc::new(
            version,
            instance.clone(),
            physical_device,
            raw.clone(),
            (
                raw.get_device_queue(support.queue_family, 0),
                support.queue_family,
            ),
        ))
        .unwrap();
        assert!(!adopted.support().mesh_shader && !adopted.support().push_descriptor);

        let pipeline = add(&adopted, 2, Bindings::Address);
        let source = on_device(&adopted, "source", &[21; 64]);
        let target = buffer(&adopted, "target", 256, Location::GpuOnly);
        record(&adopted, None, |recorder| {
            recorder.dispatch(&pipeline, &[&source, &target], &[64, 0], Groups::Count(1));
        });
        assert_eq!(read(&adopted, &target, 64), [42; 64]);
        let desc = ComputeDesc {
            name: "add",
            shader: &ADD,
            constants: &[],
            bindings: Bindings::Bound,
        };
        let error = ComputePipeline::new(&adopted, &desc).unwrap_err();
        assert!(
            error.to_string().contains("VK_KHR_push_descriptor"),
            "{error}"
        );
        drop((pipeline, source, target));
        assert_eq!(adopted.close(), Vec::<String>::new());

        // The host can still use and destroy its device.
        raw.device_wait_idle().unwrap();
        raw.destroy_device(None);
        instance.destroy_instance(None);
    }
}
