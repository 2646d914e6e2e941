//! The device that the unit tests use.

use super::{Device, DeviceDesc};

/// The description of the device under test: the best one, or the one that `RARA_TEST_DEVICE` names, under validation.
pub fn desc() -> DeviceDesc {
    DeviceDesc {
        selector: std::env::var("RARA_TEST_DEVICE").ok(),
        validation: true,
        ..DeviceDesc::default()
    }
}

/// The device under test.
pub fn device() -> Device {
    let device = Device::headless(&desc());
    device.expect("a Vulkan device and the validation layer (tools/test installs both)")
}
