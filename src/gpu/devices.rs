//! The list of devices, and the choice among them.

use std::ffi::CStr;

use ash::vk;

use super::failure::failed;
use super::instance::{API_VERSION, Instance, no_device};
use super::requirements::{self, Support};
use rara_base::error::{Error, Result};

/// A physical device as `rara devices` shows it; its number is its place in the list.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct DeviceInfo {
    /// The device's name.
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
    /// The kind of device.
    pub kind: vk::PhysicalDeviceType,
    /// The Vulkan version it offers.
    pub api: (u32, u32, u32),
    /// Bytes of its largest device-local heap.
    pub memory: u64,
    /// The features that it offers, or a sentence why it cannot be used.
    pub support: std::result::Result<Support, String>,
}

impl DeviceInfo {
    /// The kind in a word.
    pub fn kind_name(&self) -> &'static str {
        KINDS.get(self.rank()).map_or("other", |(_, name)| name)
    }

    /// The rank for the choice; a low one is better.
    fn rank(&self) -> usize {
        let known = KINDS.iter().position(|(kind, _)| *kind == self.kind);
        known.unwrap_or(KINDS.len())
    }
}

/// The kinds of device, the best first.
const KINDS: [(vk::PhysicalDeviceType, &str); 4] = [
    (vk::PhysicalDeviceType::DISCRETE_GPU, "discrete"),
    (vk::PhysicalDeviceType::INTEGRATED_GPU, "integrated"),
    (vk::PhysicalDeviceType::VIRTUAL_GPU, "virtual"),
    (vk::PhysicalDeviceType::CPU, "cpu"),
];

/// Names, kind, memory and support of a device.
///
/// # Safety
///
/// `instance` must be alive and created for `api_version`, and `physical` must be one of its devices.
pub(crate) unsafe fn describe(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    api_version: u32,
) -> DeviceInfo {
    // SAFETY: the caller vouches for both handles.
    let (base, memory, support) = unsafe {
        (
            instance.get_physical_device_properties(physical),
            instance.get_physical_device_memory_properties(physical),
            requirements::check(instance, physical, api_version),
        )
    };
    let text =
        |text: std::result::Result<&CStr, _>| text.unwrap_or(c"?").to_string_lossy().into_owned();
    let version = base.api_version;
    let driver = if version.min(api_version) >= vk::API_VERSION_1_2 {
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: as above; the struct is core in this version.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
        let name = text(driver.driver_name_as_c_str().map_err(drop));
        let info = text(driver.driver_info_as_c_str().map_err(drop));
        format!("{name} {info}").trim().to_owned()
    } else {
        format!("version {:#x}", base.driver_version)
    };
    let heaps = memory.memory_heaps_as_slice().iter();
    let local = heaps.filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
    DeviceInfo {
        name: text(base.device_name_as_c_str().map_err(drop)),
        driver,
        kind: base.device_type,
        api: (
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version),
        ),
        memory: local.map(|heap| heap.size).max().unwrap_or(0),
        support: support.map_err(|error| error.to_string()),
    }
}

impl Instance {
    /// Every device, in the loader's order.
    #[doc(hidden)]
    pub fn devices(&self) -> Result<Vec<(vk::PhysicalDevice, DeviceInfo)>> {
        // SAFETY: the instance is alive.
        let physical = unsafe { self.raw.enumerate_physical_devices() };
        let physical = match physical {
            Err(vk::Result::ERROR_INITIALIZATION_FAILED) => Vec::new(),
            other => other.map_err(failed("vkEnumeratePhysicalDevices"))?,
        };
        Ok(physical
            .into_iter()
            .map(|physical| {
                // SAFETY: the instance is alive and created for this version, and the device is its own.
                let info = unsafe { describe(&self.raw, physical, API_VERSION) };
                (physical, info)
            })
            .collect())
    }
}

/// Every device that Vulkan finds on this machine, the unusable ones with the reason.
pub fn list_devices() -> Result<Vec<DeviceInfo>> {
    let instance = Instance::new("rara", false, &[])?;
    Ok(instance
        .devices()?
        .into_iter()
        .map(|(_, info)| info)
        .collect())
}

/// The place in `devices` of the one that the selector means: by number, by part of the name (the best of those that
/// match), or the best of all.
pub(crate) fn choose(devices: &[DeviceInfo], selector: Option<&str>) -> Result<usize> {
    if devices.is_empty() {
        return Err(no_device());
    }
    let matching: Vec<usize> = match selector {
        None => (0..devices.len()).collect(),
        Some(selector) => match selector.parse::<usize>() {
            Ok(number) if number < devices.len() => vec![number],
            Ok(_) => Vec::new(),
            Err(_) => {
                let part = selector.to_lowercase();
                (0..devices.len())
                    .filter(|i| devices[*i].name.to_lowercase().contains(&part))
                    .collect()
            }
        },
    };
    if matching.is_empty() {
        let names: Vec<_> = devices
            .iter()
            .enumerate()
            .map(|(i, d)| format!("{i} ({})", d.name))
            .collect();
        return Err(Error::Device(format!(
            "no device is called \"{}\"; there is {}",
            selector.unwrap_or_default(),
            names.join(", ")
        )));
    }
    let usable = matching.iter().filter(|i| devices[**i].support.is_ok());
    usable
        .copied()
        .min_by_key(|i| devices[*i].rank())
        .ok_or_else(|| {
            let reasons: Vec<_> = matching
                .iter()
                .filter_map(|i| devices[*i].support.clone().err())
                .collect();
            Error::Device(reasons.join("; "))
        })
}

#[cfg(test)]
mod tests;
