use super::*;

fn device(name: &str, kind: vk::PhysicalDeviceType, usable: bool) -> DeviceInfo {
    let support = if usable {
        Ok(Support::default())
    } else {
        Err(format!("{name} is too old"))
    };
    DeviceInfo {
        name: name.into(),
        driver: String::new(),
        kind,
        api: (1, 3, 0),
        memory: 0,
        support,
    }
}

fn machine() -> Vec<DeviceInfo> {
    vec![
        device("llvmpipe", vk::PhysicalDeviceType::CPU, true),
        device("Old Radeon", vk::PhysicalDeviceType::DISCRETE_GPU, false),
        device(
            "Iris Graphics",
            vk::PhysicalDeviceType::INTEGRATED_GPU,
            true,
        ),
        device("New Radeon", vk::PhysicalDeviceType::DISCRETE_GPU, true),
    ]
}

#[test]
fn the_best_usable_device_is_the_default() {
    assert_eq!(choose(&machine(), None).unwrap(), 3);
    assert_eq!(choose(&machine()[..3], None).unwrap(), 2);
}

#[test]
fn devices_go_by_number_or_part_of_the_name() {
    assert_eq!(choose(&machine(), Some("0")).unwrap(), 0);
    assert_eq!(choose(&machine(), Some("iris")).unwrap(), 2);
    assert_eq!(choose(&machine(), Some("radeon")).unwrap(), 3);
}

#[test]
fn errors_say_what_there_is() {
    let unknown = choose(&machine(), Some("voodoo")).unwrap_err().to_string();
    assert!(
        unknown.contains("voodoo") && unknown.contains("2 (Iris Graphics)"),
        "{unknown}"
    );
    assert!(
        choose(&machine(), Some("9"))
            .unwrap_err()
            .to_string()
            .contains("0 (llvmpipe)")
    );
    assert_eq!(
        choose(&machine(), Some("old")).unwrap_err().to_string(),
        "Old Radeon is too old"
    );
    assert!(
        choose(&[], None)
            .unwrap_err()
            .to_string()
            .contains("no Vulkan device")
    );
}
