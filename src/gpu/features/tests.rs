use super::*;

/// The structs that are chained to a create info; more than there are where they are chained in a ring.
fn chained(info: &vk::DeviceCreateInfo<'_>) -> usize {
    let mut next = info.p_next.cast::<vk::BaseInStructure<'_>>();
    let mut count = 0;
    while !next.is_null() && count < 100 {
        // SAFETY: the structs that are chained are alive, and each begins with its type and the next one's place.
        next = unsafe { (*next).p_next };
        count += 1;
    }
    count
}

/// A host that fails to create a device tries again, with another create info.
#[test]
fn features_are_chained_to_one_create_info_after_another() {
    let support = Support {
        buffer_device_address: true,
        mesh_shader: true,
        ..Support::default()
    };
    let mut ours = support.features();
    for _ in 0..2 {
        assert_eq!(chained(&ours.chain(vk::DeviceCreateInfo::default())), 4);
        let mut theirs = vk::PhysicalDeviceVulkan13Features::default().synchronization2(true);
        let info = vk::DeviceCreateInfo::default().push_next(&mut theirs);
        // SAFETY: the chain is of one struct that nobody else uses.
        let info = unsafe { support.complete(&mut ours, info) };
        assert_eq!(chained(&info), 3, "theirs, addresses and meshes");
    }
}
