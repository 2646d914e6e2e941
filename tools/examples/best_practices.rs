//! The validation layer's best practices, and what of them is allowed to be said, each with its reason.

use std::ffi::CStr;

use rara::ash::{Entry, vk};

/// What the layer may say: part of its message's id, and why it is not heeded.
pub(crate) const ALLOWED: [(&str, &str); 4] = [
    (
        "BestPractices-pipeline-stage-flags",
        "ALL_COMMANDS: rara's first barrier waits for all that a host has recorded before, of which it knows nothing, and a \
         timestamp is to be behind all of its stage",
    ),
    (
        "BestPractices-SpirvDeprecated_WorkgroupSize",
        "what stands in its place needs Vulkan 1.3, and rara's modules are for 1.2 too",
    ),
    (
        "BestPractices-vkAllocateMemory-small-allocation",
        "memory of their own for these hosts' targets of a few pixels",
    ),
    (
        "BestPractices-vkBindMemory-small-dedicated-allocation",
        "the same, and rara's own targets, which drivers compress only there",
    ),
];

/// The layer of which the list is; a newer one may say more.
const KNOWN: u32 = vk::make_api_version(0, 1, 3, 239);

/// What of the layer's checks a host asks for: synchronisation, and best practices where the list above is of this layer.
pub(crate) fn checks(entry: &Entry) -> Vec<vk::ValidationFeatureEnableEXT> {
    let mut checks = vec![vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    // SAFETY: the entry's loader is loaded.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
    let layer = |layer: &&vk::LayerProperties| {
        layer.layer_name_as_c_str() == Ok(c"VK_LAYER_KHRONOS_validation")
    };
    match layers.iter().find(layer) {
        Some(layer) if layer.spec_version > KNOWN => {
            eprintln!(
                "SKIPPED: best practices, as the layer is newer than the list of what is allowed"
            );
        }
        _ => checks.push(vk::ValidationFeatureEnableEXT::BEST_PRACTICES),
    }
    checks
}

/// Whether a message is none of those.
pub(crate) fn counts(message: &CStr) -> bool {
    let message = message.to_string_lossy();
    !ALLOWED.iter().any(|(id, _)| message.contains(id))
}
