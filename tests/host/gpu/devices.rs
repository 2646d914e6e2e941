//! Devices: which are found, who shares them, what is left of them.

use super::*;

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
    assert_reported(&device.close(), "vkDestroyDevice");
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
