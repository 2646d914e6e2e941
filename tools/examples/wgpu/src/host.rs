//! The host: an instance, a device and a queue of wgpu's, with what rara needs besides, and rara's part of them.

use std::sync::Arc;

use rara::ash::{self, vk};
use rara::gpu::{self, AdoptDesc, Support};
use wgpu::hal::api::Vulkan;

use crate::Failure;
use crate::messages::Messages;

pub(crate) struct Host {
    /// rara's view of the device. It keeps wgpu's alive, so that either may be dropped first.
    pub(crate) rara: gpu::Device,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    // After what it may say something about, and before its instance.
    messages: Option<Messages>,
    instance: wgpu::Instance,
}

impl Host {
    /// Opens the first device that draws splats and has this in its name, with the validation layer or without.
    pub(crate) fn new(part: &str, validation: bool) -> Result<Self, Failure> {
        let mut desc = wgpu::InstanceDescriptor::new_without_display_handle();
        desc.backends = wgpu::Backends::VULKAN;
        // With these wgpu loads the layer, and asks it for its checks of synchronisation too.
        desc.flags = match validation {
            true => wgpu::InstanceFlags::VALIDATION | wgpu::InstanceFlags::DEBUG,
            false => wgpu::InstanceFlags::empty(),
        };
        let instance = wgpu::Instance::new(desc);
        let messages = match validation {
            true => Some(Messages::new(&instance)?),
            false => None,
        };
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let wanted = |adapter: &wgpu::Adapter| {
            let name = adapter.get_info().name.to_lowercase();
            name.contains(&part.to_lowercase())
        };
        let mut refused = format!("no device has {part:?} in its name");
        for adapter in adapters.iter().filter(|adapter| wanted(adapter)) {
            match support(adapter) {
                Ok((api_version, support)) => {
                    let (device, queue) = open(adapter, &support)?;
                    let rara = adopt(&device, api_version, &support, validation)?;
                    return Ok(Self {
                        rara,
                        device,
                        queue,
                        messages,
                        instance,
                    });
                }
                Err(error) => refused = error.to_string(),
            }
        }
        Err(refused.into())
    }

    /// Records raw commands, in an encoder of their own: wgpu refuses to mix them with its own commands in one.
    pub(crate) fn raw<T>(
        &self,
        label: &str,
        record: impl FnOnce(vk::CommandBuffer) -> T,
    ) -> (T, wgpu::CommandBuffer) {
        let desc = wgpu::CommandEncoderDescriptor { label: Some(label) };
        let mut encoder = self.device.create_command_encoder(&desc);
        // SAFETY: the command buffer is only recorded into, and the encoder is not used meanwhile.
        let recorded = unsafe {
            encoder.as_hal_mut::<Vulkan, _, _>(|encoder| {
                record(encoder.expect("a device of Vulkan's").raw_handle())
            })
        };
        (recorded, encoder.finish())
    }

    /// Waits until a submission has executed; without one, until all have.
    pub(crate) fn wait(&self, submission: Option<wgpu::SubmissionIndex>) -> Result<(), Failure> {
        self.device.poll(wgpu::PollType::Wait {
            submission_index: submission,
            timeout: None,
        })?;
        Ok(())
    }

    /// Drops everything; returns the validation layer's messages, also about what was left alive.
    pub(crate) fn close(self) -> Vec<String> {
        let Self {
            rara,
            device,
            queue,
            messages,
            instance,
        } = self;
        drop((queue, device, rara));
        let said = messages.map(Messages::close).unwrap_or_default();
        drop(instance); // after its messenger
        said
    }
}

/// What rara needs of a device, and the version of Vulkan that wgpu has created its instance for.
fn support(adapter: &wgpu::Adapter) -> Result<(u32, Support), Failure> {
    // SAFETY: nothing of what the guard shows is destroyed.
    let hal = unsafe { adapter.as_hal::<Vulkan>() }.ok_or("no device of Vulkan's")?;
    let instance = hal.shared_instance();
    // That is the loader's version, of which wgpu asks for 1.3 at most.
    let api_version = instance.instance_api_version().min(vk::API_VERSION_1_3);
    // SAFETY: the instance is alive, and the physical device its own.
    let support = unsafe {
        gpu::check(
            instance.raw_instance(),
            hal.raw_physical_device(),
            api_version,
        )
    }?;
    Ok((api_version, support))
}

/// Creates a device with the extensions and features of both, and gives it to wgpu, which destroys it in the end.
fn open(
    adapter: &wgpu::Adapter,
    support: &Support,
) -> Result<(wgpu::Device, wgpu::Queue), Failure> {
    let desc = wgpu::DeviceDescriptor {
        label: Some("host"),
        ..wgpu::DeviceDescriptor::default()
    };
    let wanted = desc.required_features;
    // SAFETY: nothing of what the guard shows is destroyed.
    let hal = unsafe { adapter.as_hal::<Vulkan>() }.ok_or("no device of Vulkan's")?;

    let mut extensions = hal.required_device_extensions(wanted);
    for name in support.extensions() {
        if !extensions.contains(&name) {
            extensions.push(name);
        }
    }
    let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(support.queue_family)
        .queue_priorities(&[1.0])];
    let mut theirs = hal.physical_device_features(&extensions, wanted);
    let mut ours = support.features();
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&names);
    let info = theirs.add_to_device_create(info);
    // SAFETY: the chain's structs are alive and nobody else's; the device offers all that is asked for; wgpu gets it with
    // the extensions that it was created with, and owns it from there on.
    unsafe {
        // wgpu has structs of its own, for subgroups and mesh shaders as for others, and does not say which.
        let info = support.complete(&mut ours, info);
        let instance = hal.shared_instance().raw_instance();
        let raw = instance.create_device(hal.raw_physical_device(), &info, None)?;
        let open = hal.device_from_raw(
            raw,
            None,
            &extensions,
            wanted,
            &desc.required_limits,
            &desc.memory_hints,
            support.queue_family,
            0,
        )?;
        Ok(adapter.create_device_from_hal::<Vulkan>(open, &desc)?)
    }
}

/// Lends wgpu's device to rara.
fn adopt(
    device: &wgpu::Device,
    api_version: u32,
    support: &Support,
    debug_utils: bool,
) -> Result<gpu::Device, Failure> {
    // SAFETY: nothing of what the guard shows is destroyed.
    let hal = unsafe { device.as_hal::<Vulkan>() }.ok_or("no device of Vulkan's")?;
    let instance: ash::Instance = hal.shared_instance().raw_instance().clone();
    let queue = (hal.raw_queue(), hal.queue_family_index());
    let (physical, raw) = (hal.raw_physical_device(), hal.raw_device().clone());
    let desc = AdoptDesc::new(api_version, instance, physical, raw, queue)
        .mesh_shader(support.mesh_shader)
        .push_descriptor(support.push_descriptor)
        .full_subgroups(support.full_subgroups[1] > 0)
        .debug_utils(debug_utils)
        .keep_alive(Some(Arc::new(device.clone())));
    // SAFETY: the handles belong together, were created with all that the description says, and what is kept alive
    // outlives whatever is made from them.
    Ok(unsafe { gpu::Device::adopt(desc) }?)
}
