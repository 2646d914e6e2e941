//! Debug labels and timestamps around what a command buffer records.

use std::ffi::CStr;

use ash::vk;

use super::device::Device;
use super::timer::Timer;
use super::validation;

/// Opens a debug label on a command buffer, which the caller has made sure is recording on `device`.
pub(super) fn begin_label(device: &Device, cmd: vk::CommandBuffer, name: &str) {
    let Some(debug) = device.debug_utils() else {
        return;
    };
    if device.validates() {
        validation::enter(name);
    }
    // The text is on the stack, as recording does not allocate; a longer name is cut.
    let mut text = [0_u8; 64];
    let length = name.len().min(text.len() - 1);
    text[..length].copy_from_slice(&name.as_bytes()[..length]);
    let label = vk::DebugUtilsLabelEXT::default()
        .label_name(CStr::from_bytes_until_nul(&text).expect("the last byte is always NUL"));
    // SAFETY: recorder and drawer are made from a command buffer that is recording; the label outlives the call.
    unsafe { debug.cmd_begin_debug_utils_label(cmd, &label) };
}

pub(super) fn end_label(device: &Device, cmd: vk::CommandBuffer) {
    if let Some(debug) = device.debug_utils() {
        // SAFETY: as in `begin_label`, which callers call first.
        unsafe { debug.cmd_end_debug_utils_label(cmd) };
        if device.validates() {
            validation::leave();
        }
    }
}

/// Records `record` with `by`, which records into a command buffer, under a debug label of a name, if there is one.
pub(super) fn under<T, R>(
    by: &mut T,
    (device, cmd): (&Device, vk::CommandBuffer),
    name: Option<&str>,
    record: impl FnOnce(&mut T) -> R,
) -> R {
    let Some(name) = name else {
        return record(by);
    };
    begin_label(device, cmd, name);
    let result = record(by);
    end_label(device, cmd);
    result
}

/// Opens a pass, which is a debug label and an entry of the timer. Returns the entry for [`end_pass`], if it has one.
///
/// # Safety
///
/// `cmd` must be recording on `device`, after the timer was reset for it.
pub(super) unsafe fn begin_pass(
    device: &Device,
    cmd: vk::CommandBuffer,
    timer: Option<&mut Timer>,
    name: &'static str,
) -> Option<u32> {
    begin_label(device, cmd, name);
    // SAFETY: the caller vouches for `cmd` and the timer.
    timer.and_then(|timer| unsafe { timer.begin(cmd, name) })
}

/// Closes the pass that [`begin_pass`] opened.
///
/// # Safety
///
/// As for [`begin_pass`], once for each pass, with the same timer.
pub(super) unsafe fn end_pass(
    device: &Device,
    cmd: vk::CommandBuffer,
    timer: Option<&mut Timer>,
    timed: Option<u32>,
) {
    if let (Some(timer), Some(pass)) = (timer, timed) {
        // SAFETY: the caller vouches for `cmd` and the timer.
        unsafe { timer.end(cmd, pass) };
    }
    end_label(device, cmd);
}
