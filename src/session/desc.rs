//! The description from which a session is opened.

use crate::trace::Trace;
use rara_base::setters;
use rara_gpu::{Bindings, Device, DeviceShape, OnCompile, PipelineCache};

/// The description from which a headless renderer is created.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct HeadlessDesc {
    /// Device number or part of its name; `None` is the best device.
    pub device: Option<String>,
    /// Load the Khronos validation layer with synchronisation checks; any message becomes
    /// [`Error::Validation`](crate::Error::Validation).
    pub validation: bool,
    /// How buffers are reached, where the device has what that needs. `None` is [what suits the device](Bindings::suiting), but
    /// bound under validation, whose synchronisation checks cannot watch an address.
    pub bindings: Option<Bindings>,
    /// The place in which compiled pipelines are kept from one run to the next.
    pub pipeline_cache: PipelineCache,
    /// The function that is called when shaders are compiled, which may take seconds.
    pub on_compile: Option<OnCompile>,
    /// The trace in which to note how long each step takes on the processor and on the device.
    pub trace: Option<Trace>,
    /// Count what the stages do, where the device can.
    pub statistics: bool,
    /// The kind of machine that pipelines are chosen for; `None` is what suits the device.
    pub shape: Option<DeviceShape>,
}

setters!(HeadlessDesc {
    device: Option<String>,
    validation: bool,
    bindings: Option<Bindings>,
    pipeline_cache: PipelineCache,
    on_compile: Option<OnCompile>,
    trace: Option<Trace>,
    statistics: bool,
    shape: Option<DeviceShape>,
});

impl HeadlessDesc {
    /// How buffers are reached.
    #[doc(hidden)]
    pub fn bindings_on(&self, device: &Device) -> Bindings {
        let wanted = self.bindings.unwrap_or(if self.validation {
            Bindings::Bound
        } else {
            Bindings::suiting(device)
        });
        wanted.or_other(device.support())
    }
}
