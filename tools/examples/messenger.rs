//! The messenger that collects what the validation layer says to a host, but for what the host's list allows.

use std::ffi::{CStr, c_void};
use std::sync::Mutex;

use rara::ash::vk;

use super::ALLOWED;

/// The layer's warnings and errors, without those that are allowed.
pub(crate) type Messages = Mutex<Vec<String>>;

/// The description of a messenger, which `messages` has to outlive.
pub(super) fn info(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
    use vk::DebugUtilsMessageTypeFlagsEXT as Kind;
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Kind::VALIDATION | Kind::PERFORMANCE)
        .pfn_user_callback(Some(collect))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast())
}

unsafe extern "system" fn collect(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan passes a valid struct for the length of the call, and `user` is the host's messages.
    let (text, messages): (&CStr, &Messages) = unsafe {
        let text = (*data).message_as_c_str().unwrap_or(c"(no text)");
        (text, &*user.cast())
    };
    let text = text.to_string_lossy();
    if !ALLOWED.iter().any(|(id, _)| text.contains(id)) {
        let mut messages = messages.lock().expect("no holder panics");
        messages.push(text.into_owned());
    }
    vk::FALSE
}
