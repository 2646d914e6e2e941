//! The Khronos validation layer with synchronisation checks, and the messages it has sent.

use std::cell::RefCell;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::{ext, vk};

use super::failure::failed;
use super::requirements::offers;
use rara_base::error::{Error, Result};

pub(crate) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Synchronisation checks are off in the layer unless asked for.
pub(crate) const CHECKS: [vk::ValidationFeatureEnableEXT; 1] =
    [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];

/// Warnings and errors of the layer, in the order they came. Any thread that calls Vulkan may add to them.
#[derive(Debug, Default)]
pub(crate) struct Messages(Mutex<Vec<String>>);

impl Messages {
    fn push(&self, message: String) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(message);
    }

    /// Takes everything that has been collected.
    pub(crate) fn drain(&self) -> Vec<String> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The description that both the instance's creation and the messenger are given. It points into `messages`, which must
/// live as long as everything that is created with it.
pub(crate) fn messenger_info(
    messages: &Arc<Messages>,
) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
    use vk::DebugUtilsMessageTypeFlagsEXT as Kind;
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Kind::GENERAL | Kind::VALIDATION | Kind::PERFORMANCE)
        .pfn_user_callback(Some(collect))
        .user_data(Arc::as_ptr(messages).cast_mut().cast())
}

/// The messenger of an instance and the messages it collects.
pub(crate) struct Validation {
    loader: ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    pub(crate) messages: Arc<Messages>,
}

impl Validation {
    /// Attaches a messenger to an instance with `VK_EXT_debug_utils` enabled.
    pub(crate) fn new(
        entry: &ash::Entry,
        instance: &ash::Instance,
        messages: Arc<Messages>,
    ) -> Result<Self> {
        let loader = ext::debug_utils::Instance::new(entry, instance);
        // SAFETY: the instance is alive, and `messages` is kept beside the messenger until `destroy`.
        let messenger =
            unsafe { loader.create_debug_utils_messenger(&messenger_info(&messages), None) }
                .map_err(failed("vkCreateDebugUtilsMessengerEXT"))?;
        Ok(Self {
            loader,
            messenger,
            messages,
        })
    }

    /// Detaches the messenger.
    ///
    /// # Safety
    ///
    /// Its instance must be alive, and this must be the only call.
    pub(crate) unsafe fn destroy(&self) {
        // SAFETY: the caller vouches for the instance and that the messenger was not destroyed before.
        unsafe {
            self.loader
                .destroy_debug_utils_messenger(self.messenger, None)
        };
    }
}

/// Finds the layer, which must be installed; true when it has its own extension for switching checks on.
pub(crate) fn find(entry: &ash::Entry) -> Result<bool> {
    // SAFETY: the entry's loader is loaded, as for the call below.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .map_err(failed("vkEnumerateInstanceLayerProperties"))?;
    if !layers
        .iter()
        .any(|layer| layer.layer_name_as_c_str() == Ok(LAYER))
    {
        return Err(Error::Device(
            "validation was asked for but VK_LAYER_KHRONOS_validation is not installed; install the package \
             vulkan-validationlayers (or the Vulkan SDK), or do without validation"
                .into(),
        ));
    }
    // SAFETY: as above.
    let extensions = unsafe { entry.enumerate_instance_extension_properties(Some(LAYER)) }
        .map_err(failed("vkEnumerateInstanceExtensionProperties"))?;
    Ok(offers(&extensions, ext::validation_features::NAME))
}

/// The messenger's callback. General messages are the loader's, about drivers and layers of the machine and not about our
/// calls: they go to the log. All others count.
unsafe extern "system" fn collect(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan passes a valid struct for the length of the call, and whatever it points to.
    let text = PASSES.with_borrow(|passes| unsafe { describe(&*data, passes) });
    if kind == vk::DebugUtilsMessageTypeFlagsEXT::GENERAL {
        log::debug!("Vulkan loader, {severity:?}: {text}");
    } else {
        log::error!("validation, {severity:?}: {text}");
        // SAFETY: `user` is the `Messages` that `messenger_info` was given, kept alive beside the messenger.
        unsafe { &*user.cast::<Messages>() }.push(text);
    }
    vk::FALSE
}

thread_local! {
    /// The labels that are open where this thread records. The layer speaks on the recording thread, and not all of its
    /// messages (in 1.3.239 none about synchronisation) come with the command buffer's labels.
    static PASSES: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// Notes that a label was opened on this thread, under validation.
pub(super) fn enter(pass: &str) {
    PASSES.with_borrow_mut(|passes| passes.push(pass.to_owned()));
}

/// Notes that the last label was closed.
pub(super) fn leave() {
    PASSES.with_borrow_mut(|passes| passes.pop());
}

/// The message behind the pass that it is about, the outermost label first, and the objects that have a name. `passes` are
/// those of this thread, for a message that comes without labels.
///
/// # Safety
///
/// All that `data` points to must be valid, as it is in the messenger's callback.
unsafe fn describe(data: &vk::DebugUtilsMessengerCallbackDataEXT<'_>, passes: &[String]) -> String {
    let text = |text: Option<&CStr>| text.map(|text| text.to_string_lossy().into_owned());
    // SAFETY: the caller vouches for the struct's pointers and counts; null arrays have a count of zero.
    let (message, labels, objects) = unsafe {
        let labels = slice(data.p_cmd_buf_labels, data.cmd_buf_label_count);
        let objects = slice(data.p_objects, data.object_count);
        let label = |label: &vk::DebugUtilsLabelEXT<'_>| text(label.label_name_as_c_str());
        let named = |object: &vk::DebugUtilsObjectNameInfoEXT<'_>| {
            let name = text(object.object_name_as_c_str()).filter(|name| !name.is_empty())?;
            let kind = format!("{:?}", object.object_type).to_lowercase();
            Some(format!("{} {name}", kind.replace('_', " ")))
        };
        (
            text(data.message_as_c_str()).unwrap_or("(no text)".into()),
            labels.iter().rev().filter_map(label).collect::<Vec<_>>(),
            objects.iter().filter_map(named).collect::<Vec<_>>(),
        )
    };
    let labels = if labels.is_empty() { passes } else { &labels };
    let pass = (!labels.is_empty()).then(|| format!("in pass {}", labels.join(" > ")));
    let objects = (!objects.is_empty()).then(|| objects.join(", "));
    let parts = [pass, objects, Some(message)].into_iter().flatten();
    parts.collect::<Vec<_>>().join(": ")
}

/// # Safety
///
/// `count` elements lie at `first`, unless it is null.
unsafe fn slice<'a, T>(first: *const T, count: u32) -> &'a [T] {
    if first.is_null() {
        return &[];
    }
    // SAFETY: the caller vouches for it.
    unsafe { std::slice::from_raw_parts(first, count as usize) }
}

#[cfg(test)]
mod tests;
