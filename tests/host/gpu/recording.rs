//! Recorded commands: dispatches, barriers, labels and timers.

use super::*;
use rara::Error;

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
    assert_reported(&device.validation_messages(), "READ_AFTER_WRITE");
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
