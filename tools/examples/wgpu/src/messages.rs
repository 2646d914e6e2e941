//! What the validation layer says, collected by a messenger of the host's own: wgpu's writes to the log alone.

#[path = "../../messenger.rs"]
mod messenger;

use rara::ash::{ext, vk};
use wgpu::hal::api::Vulkan;

use crate::Failure;

/// The layer's messages that are wgpu's own doing: a part of the text that nothing of rara's can have, and the reason. A new
/// one needs a sentence here.
const ALLOWED: [(&str, &str); 1] = [(
    "Invalid source language operand: 10",
    "wgpu says in the SPIR-V that it makes under `InstanceFlags::DEBUG` that its source is WGSL, which older layers do not \
     know; rara's modules do not come through wgpu, and none is of WGSL",
)];

pub(crate) struct Messages {
    loader: ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    said: Box<messenger::Messages>,
}

impl Messages {
    /// Collects from now on. The instance outlives this.
    pub(crate) fn new(instance: &wgpu::Instance) -> Result<Self, Failure> {
        // SAFETY: nothing of what is shown is destroyed.
        let hal = unsafe { instance.as_hal::<Vulkan>() }.ok_or("no instance of Vulkan's")?;
        let instance = hal.shared_instance();
        // SAFETY: the entry's loader is loaded.
        let layers = unsafe { instance.entry().enumerate_instance_layer_properties() }?;
        let is_layer = |layer: &vk::LayerProperties| {
            layer.layer_name_as_c_str() == Ok(c"VK_LAYER_KHRONOS_validation")
        };
        if !layers.iter().any(is_layer) {
            return Err("the Khronos validation layer is not installed".into());
        }
        let said = Box::new(messenger::Messages::default());
        let loader = ext::debug_utils::Instance::new(instance.entry(), instance.raw_instance());
        // SAFETY: wgpu has enabled the extension, and the messages outlive the messenger.
        let messenger =
            unsafe { loader.create_debug_utils_messenger(&messenger::info(&said), None) }?;
        Ok(Self {
            loader,
            messenger,
            said,
        })
    }

    /// All that was said.
    pub(crate) fn close(self) -> Vec<String> {
        std::mem::take(&mut self.said.lock().expect("no holder panics"))
    }
}

impl Drop for Messages {
    fn drop(&mut self) {
        // SAFETY: the instance is alive, and nobody uses the messenger any more.
        unsafe {
            self.loader
                .destroy_debug_utils_messenger(self.messenger, None)
        };
    }
}
