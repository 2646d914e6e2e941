//! A window as Vulkan sees it: opened together with a device that can show pictures in it.

use std::ffi::CStr;
use std::sync::Arc;

use rara::ash::{self, khr, vk};
use rara::gpu::Support;
use rara::{Error, Result};
use rara_gpu::{Device, DeviceDesc, Instance, failed, offers};
use raw_window_handle::{HandleError, HasDisplayHandle, HasWindowHandle};

/// An object that has a window and the display that the window is on.
pub(crate) trait Window: HasWindowHandle + HasDisplayHandle {}

impl<T: HasWindowHandle + HasDisplayHandle> Window for T {}

/// A window's surface. It keeps the window and the instance alive.
pub(crate) struct Surface {
    loader: khr::surface::Instance,
    handle: vk::SurfaceKHR,
    // The surface is destroyed before both.
    instance: Arc<Instance>,
    _window: Arc<dyn Window>,
}

/// Colour formats that are blended and shown as stored, the preferred ones first.
const FORMATS: [vk::Format; 5] = [
    vk::Format::B8G8R8A8_UNORM,
    vk::Format::R8G8B8A8_UNORM,
    vk::Format::A8B8G8R8_UNORM_PACK32,
    vk::Format::A2B10G10R10_UNORM_PACK32,
    vk::Format::A2R10G10B10_UNORM_PACK32,
];

impl Surface {
    /// Opens the device that the description means, among those that can show pictures in the window.
    pub(crate) fn open(desc: &DeviceDesc, window: Arc<dyn Window>) -> Result<(Device, Self)> {
        let display = window.display_handle().map_err(no_window)?.as_raw();
        let needed = ash_window::enumerate_required_extensions(display)
            .map_err(failed("enumerate_required_extensions"))?;
        let needed: Vec<&'static CStr> = needed
            .iter()
            // SAFETY: these are the names of extensions, as static as the slice that lists them.
            .map(|name| unsafe { CStr::from_ptr(*name) })
            .collect();
        let instance = Instance::new(&desc.application_name, desc.validation, &needed)?;
        let instance = Arc::new(instance);
        let surface = Self::new(instance.clone(), window)?;
        let mut candidates = instance.devices()?;
        for (physical, info) in &mut candidates {
            if let Ok(support) = &mut info.support
                && let Err(error) = surface.fit(*physical, support)
            {
                info.support = Err(format!("{} cannot be used here: {error}", info.name));
            }
        }
        let device = Device::open(instance, candidates, desc, &[khr::swapchain::NAME])?;
        Ok((device, surface))
    }

    fn new(instance: Arc<Instance>, window: Arc<dyn Window>) -> Result<Self> {
        let display = window.display_handle().map_err(no_window)?.as_raw();
        let raw_window = window.window_handle().map_err(no_window)?.as_raw();
        let loader = khr::surface::Instance::new(&instance.entry, &instance.raw);
        // SAFETY: the instance was created with the display's extensions, and the surface keeps it and the window, and
        // with the window its display, alive until it is destroyed.
        let handle = unsafe {
            ash_window::create_surface(&instance.entry, &instance.raw, display, raw_window, None)
        };
        Ok(Self {
            handle: handle.map_err(failed("vkCreateSurfaceKHR"))?,
            loader,
            instance,
            _window: window,
        })
    }

    /// Notes in `support` which queue family can show pictures here as well as draw them; the error says why none can.
    fn fit(&self, physical: vk::PhysicalDevice, support: &mut Support) -> Result<()> {
        let no = |why: &str| Err(Error::Device(why.into()));
        let raw = &self.instance.raw;
        // SAFETY: the instance is alive and the physical device its own, as for the calls below.
        let offered = unsafe { raw.enumerate_device_extension_properties(physical) }
            .map_err(failed("vkEnumerateDeviceExtensionProperties"))?;
        if !offers(&offered, khr::swapchain::NAME) {
            return no(
                "it has no VK_KHR_swapchain, so that it can only draw without a window (rara render)",
            );
        }
        // SAFETY: as above.
        let (families, limits) = unsafe {
            (
                raw.get_physical_device_queue_family_properties(physical),
                raw.get_physical_device_properties(physical).limits,
            )
        };
        for (index, family) in (0_u32..).zip(&families) {
            let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
            // SAFETY: as above; the surface is alive.
            let shows = unsafe {
                self.loader
                    .get_physical_device_surface_support(physical, index, self.handle)
            };
            let shows = shows.map_err(failed("vkGetPhysicalDeviceSurfaceSupportKHR"))?;
            if shows && family.queue_flags.contains(both) {
                support.queue_family = index;
                support.timestamp_bits = family.timestamp_valid_bits;
                support.timestamp_period = match family.timestamp_valid_bits {
                    0 => 0.0,
                    _ => limits.timestamp_period,
                };
                return Ok(());
            }
        }
        no(
            "no queue of it both draws and shows pictures in this window; choose the device that the display is \
             connected to with --device, or draw without a window (rara render)",
        )
    }

    pub(crate) fn format(&self, device: &Device) -> Result<vk::SurfaceFormatKHR> {
        // SAFETY: the surface is alive, and the device was opened for it.
        let offered = unsafe {
            self.loader
                .get_physical_device_surface_formats(device.physical(), self.handle)
        };
        let offered = offered.map_err(failed("vkGetPhysicalDeviceSurfaceFormatsKHR"))?;
        choose(&offered, |format| {
            device
                .format_features(format)
                .contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND)
        })
    }

    /// Sizes, image counts and transforms that are possible now.
    pub(crate) fn capabilities(&self, device: &Device) -> Result<vk::SurfaceCapabilitiesKHR> {
        // SAFETY: as in `format`.
        unsafe {
            self.loader
                .get_physical_device_surface_capabilities(device.physical(), self.handle)
        }
        .map_err(lost)
    }

    pub(crate) fn handle(&self) -> vk::SurfaceKHR {
        self.handle
    }

    pub(crate) fn instance(&self) -> &ash::Instance {
        &self.instance.raw
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: its swapchain was destroyed before; instance and window are dropped after this.
        unsafe { self.loader.destroy_surface(self.handle, None) };
    }
}

fn no_window(error: HandleError) -> Error {
    Error::Device(format!("the window cannot be drawn into: {error}"))
}

/// The error of a call on the surface.
pub(crate) fn lost(result: vk::Result) -> Error {
    match result {
        vk::Result::ERROR_SURFACE_LOST_KHR => Error::Device(
            "the window was lost: its display closed it or went away; start the program again"
                .into(),
        ),
        result => failed("a call on the window's surface")(result),
    }
}

/// The best of the formats that blend and show colours as stored: an sRGB one would blend in linear light.
fn choose(
    offered: &[vk::SurfaceFormatKHR],
    blends: impl Fn(vk::Format) -> bool,
) -> Result<vk::SurfaceFormatKHR> {
    let as_stored = |format: &&vk::SurfaceFormatKHR| {
        format.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR && blends(format.format)
    };
    let found = FORMATS.iter().find_map(|wanted| {
        let mut fitting = offered.iter().filter(as_stored);
        fitting.find(|format| format.format == *wanted)
    });
    found.copied().ok_or_else(|| {
        let names: Vec<_> = offered
            .iter()
            .map(|o| format!("{:?} {:?}", o.format, o.color_space))
            .collect();
        Error::Device(format!(
            "this window offers no format that blends colours as they are stored (8 or 10 bits, UNORM, sRGB colour \
             space), only {}; choose another --device, or draw without a window (rara render)",
            names.join(", ")
        ))
    })
}

#[cfg(test)]
mod tests;
