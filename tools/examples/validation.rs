//! A host's instance, with the validation layer's checks of synchronisation and best practices, and the warnings of the
//! latter that are allowed, each with its reason.

#[path = "messenger.rs"]
mod messenger;

use rara::Result;
use rara::ash::{Entry, Instance, ext, vk};

pub(crate) use messenger::Messages;

/// The object that sends the messages, with its functions.
pub(crate) type Messenger = (ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT);

/// The messages that are allowed: part of the message's id, and the reason.
const ALLOWED: [(&str, &str); 4] = [
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

/// The version of the layer that the list is for; a newer one may report more.
const KNOWN: u32 = vk::make_api_version(0, 1, 3, 239);

/// An instance of a version, with the layer or without.
///
/// # Safety
/// `messages` outlives the instance and the messenger.
pub(crate) unsafe fn instance(
    entry: &Entry,
    version: u32,
    validation: bool,
    messages: &Messages,
) -> Result<(Instance, Option<Messenger>)> {
    let application = vk::ApplicationInfo::default()
        .application_name(c"rara's example host")
        .api_version(version);
    let info = vk::InstanceCreateInfo::default().application_info(&application);
    if !validation {
        // SAFETY: everything pointed to outlives the call.
        let instance = unsafe { entry.create_instance(&info, None) };
        return Ok((
            instance.map_err(rara_gpu::failed("vkCreateInstance"))?,
            None,
        ));
    }
    let layers = [c"VK_LAYER_KHRONOS_validation".as_ptr()];
    let extensions = [
        ext::debug_utils::NAME.as_ptr(),
        ext::validation_features::NAME.as_ptr(),
    ];
    let enabled = checks(entry);
    let mut checks = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
    let info = info
        .enabled_layer_names(&layers)
        .enabled_extension_names(&extensions)
        .push_next(&mut checks);
    // SAFETY: everything pointed to outlives the calls; the caller vouches for `messages`.
    unsafe {
        let instance = entry
            .create_instance(&info, None)
            .map_err(rara_gpu::failed("vkCreateInstance"))?;
        let loader = ext::debug_utils::Instance::new(entry, &instance);
        let messenger = loader
            .create_debug_utils_messenger(&messenger::info(messages), None)
            .map_err(rara_gpu::failed("vkCreateDebugUtilsMessengerEXT"))?;
        Ok((instance, Some((loader, messenger))))
    }
}

/// The checks that a host asks for: synchronisation, and best practices if the list above is for this layer.
fn checks(entry: &Entry) -> Vec<vk::ValidationFeatureEnableEXT> {
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
