//! The Vulkan instance of those who lend none, with or without the validation layer.

use std::ffi::{CStr, CString};
use std::sync::Arc;

use ash::{ext, khr, vk};

use super::failure::failed;
use super::requirements::offers;
use super::validation::{self, Messages, Validation};
use rara_base::error::{Error, Result};

/// The version that an instance of our own is created for; its devices may offer less.
pub(super) const API_VERSION: u32 = vk::API_VERSION_1_3;

/// An instance of our own. Dropping it destroys messenger and instance; everything made from it is destroyed first.
pub struct Instance {
    /// The ash instance.
    pub raw: ash::Instance,
    pub(super) validation: Option<Validation>,
    /// True when debug labels and names are recorded, for a layer or a capture tool if there is one.
    pub(super) debug_utils: bool,
    /// Keeps the loader's library open.
    pub entry: ash::Entry,
}

impl Instance {
    /// Loads Vulkan and creates an instance, with the validation layer where asked for. `needed` are a window's
    /// extensions, without which this is an error.
    #[doc(hidden)]
    pub fn new(
        application_name: &str,
        with_validation: bool,
        needed: &[&'static CStr],
    ) -> Result<Self> {
        // SAFETY: the system's Vulkan loader has no initialisation that could break the process.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| {
            Error::Device(format!(
                "the Vulkan loader could not be loaded ({error}); install it (package libvulkan1 on Debian and \
                 Ubuntu, vulkan-loader on Fedora) or the graphics driver that brings it"
            ))
        })?;
        let has_checks = with_validation && validation::find(&entry)?;
        // SAFETY: the entry is loaded.
        let offered = unsafe { entry.enumerate_instance_extension_properties(None) }
            .map_err(failed("vkEnumerateInstanceExtensionProperties"))?;
        let has = |wanted: &CStr| offers(&offered, wanted);
        let debug_utils = with_validation || has(ext::debug_utils::NAME);
        let portability = has(khr::portability_enumeration::NAME);

        let mut extensions = Vec::new();
        for name in needed {
            if !has(name) {
                return Err(Error::Device(format!(
                    "Vulkan on this machine cannot draw into windows: neither its loader nor a driver offers {}; \
                     install the graphics card's own driver, or draw without a window (rara render)",
                    name.to_string_lossy()
                )));
            }
            extensions.push(name.as_ptr());
        }
        for (wanted, name) in [
            (debug_utils, ext::debug_utils::NAME),
            (portability, khr::portability_enumeration::NAME),
            (has_checks, ext::validation_features::NAME),
        ] {
            if wanted {
                extensions.push(name.as_ptr());
            }
        }
        let layers = if with_validation {
            vec![validation::LAYER.as_ptr()]
        } else {
            Vec::new()
        };
        let application_name =
            CString::new(application_name.replace('\0', "")).expect("no NUL is left");
        let application = vk::ApplicationInfo::default()
            .application_name(&application_name)
            .engine_name(c"rara")
            .api_version(API_VERSION);
        let messages = Arc::new(Messages::default());
        let mut messenger = validation::messenger_info(&messages);
        let mut checks =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(&validation::CHECKS);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_extension_names(&extensions)
            .enabled_layer_names(&layers);
        if portability {
            info = info.flags(vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR);
        }
        if with_validation {
            info = info.push_next(&mut messenger);
        }
        if has_checks {
            info = info.push_next(&mut checks);
        }
        // SAFETY: everything `info` points to outlives the call, and `messages` outlives the instance (see below).
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
            vk::Result::ERROR_INCOMPATIBLE_DRIVER => no_device(),
            result => failed("vkCreateInstance")(result),
        })?;
        // The messages live in the instance's `validation`, or are unused; if the messenger fails, they outlive `raw`.
        let mut instance = Self {
            raw,
            validation: None,
            debug_utils,
            entry,
        };
        if with_validation {
            instance.validation = Some(Validation::new(
                &instance.entry,
                &instance.raw,
                messages.clone(),
            )?);
        }
        Ok(instance)
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: whatever was made from the instance is gone: the device that holds it is destroyed first.
        unsafe {
            if let Some(validation) = &self.validation {
                validation.destroy();
            }
            self.raw.destroy_instance(None);
        }
    }
}

/// The error where there is nothing to choose from.
pub(crate) fn no_device() -> Error {
    Error::Device(
        "no Vulkan device was found; install the graphics card's Vulkan driver, or the software driver lavapipe \
         (package mesa-vulkan-drivers)"
            .into(),
    )
}
