//! The features that a host enables when it creates a device: structs that it chains, or fields of its own structs.

use std::ffi::c_void;

use ash::vk;

use super::requirements::Support;
use rara_base::error::{Error, Result};

impl Support {
    /// The features to enable, as structs to be chained into the device's create info. A host that has structs with the same
    /// fields, of which `VkPhysicalDeviceVulkan12Features` and `VkPhysicalDeviceVulkan13Features` are the usual ones, calls
    /// [`set_features`](Self::set_features) instead, since Vulkan takes each feature from one struct only.
    pub fn features(&self) -> Features {
        Features {
            buffer_device_address: vk::PhysicalDeviceBufferDeviceAddressFeatures::default()
                .buffer_device_address(self.buffer_device_address),
            synchronization2: vk::PhysicalDeviceSynchronization2Features::default()
                .synchronization2(true),
            dynamic_rendering: vk::PhysicalDeviceDynamicRenderingFeatures::default()
                .dynamic_rendering(true),
            mesh: self.mesh_shader.then(|| {
                vk::PhysicalDeviceMeshShaderFeaturesEXT::default()
                    .mesh_shader(true)
                    .task_shader(true)
            }),
            subgroup_size: (self.full_subgroups[1] > 0).then(|| {
                vk::PhysicalDeviceSubgroupSizeControlFeatures::default()
                    .subgroup_size_control(true)
                    .compute_full_subgroups(true)
            }),
        }
    }

    /// Sets the features in a host's own structs: those in the `pNext` chain of its `VkDeviceCreateInfo`, whichever of
    /// Vulkan's structs they are in. No other field is touched. Those that are optional may be missing, since a host can do
    /// without: `meshShader` and `taskShader`, `subgroupSizeControl` and `computeFullSubgroups`.
    ///
    /// # Errors
    /// [`Error::Invalid`] names a feature for which the chain has no struct, and the struct to chain.
    ///
    /// # Safety
    ///
    /// `p_next` is null, or a chain of Vulkan's structs that nobody else uses meanwhile.
    pub unsafe fn set_features(&self, p_next: *mut c_void) -> Result<()> {
        // SAFETY: the caller's promise.
        let found = unsafe { self.set_in(p_next) };
        for (found, feature, holder) in [
            (
                found.address || !self.buffer_device_address,
                "bufferDeviceAddress",
                "VkPhysicalDeviceVulkan12Features or VkPhysicalDeviceBufferDeviceAddressFeatures",
            ),
            (
                found.synchronization,
                "synchronization2",
                "VkPhysicalDeviceVulkan13Features or VkPhysicalDeviceSynchronization2Features",
            ),
            (
                found.rendering,
                "dynamicRendering",
                "VkPhysicalDeviceVulkan13Features or VkPhysicalDeviceDynamicRenderingFeatures",
            ),
        ] {
            if !found {
                return Err(Error::Invalid(format!(
                    "no struct of p_next has the feature {feature}: chain a {holder}"
                )));
            }
        }
        Ok(())
    }

    /// Sets the features in those structs of a chain that have them.
    ///
    /// # Safety
    /// As for [`set_features`](Self::set_features).
    unsafe fn set_in(&self, p_next: *mut c_void) -> OfferedFeatures {
        use vk::StructureType as Type;
        let mut found = OfferedFeatures::default();
        let (addresses, full_subgroups) = (self.buffer_device_address, self.full_subgroups[1] > 0);
        let mut next = p_next.cast::<vk::BaseOutStructure<'_>>();
        // SAFETY: each struct of the caller's chain begins with its type, which says what it is, and with a pointer to the
        // next one.
        unsafe {
            while !next.is_null() {
                match (*next).s_type {
                    Type::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES if addresses => {
                        let all = &mut *next.cast::<vk::PhysicalDeviceVulkan12Features<'_>>();
                        all.buffer_device_address = vk::TRUE;
                        found.address = true;
                    }
                    Type::PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES if addresses => {
                        let one = next.cast::<vk::PhysicalDeviceBufferDeviceAddressFeatures<'_>>();
                        (*one).buffer_device_address = vk::TRUE;
                        found.address = true;
                    }
                    Type::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES => {
                        let all = &mut *next.cast::<vk::PhysicalDeviceVulkan13Features<'_>>();
                        (all.synchronization2, all.dynamic_rendering) = (vk::TRUE, vk::TRUE);
                        (found.synchronization, found.rendering) = (true, true);
                        found.subgroup_size = true;
                        if full_subgroups {
                            (all.subgroup_size_control, all.compute_full_subgroups) =
                                (vk::TRUE, vk::TRUE);
                        }
                    }
                    Type::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceSynchronization2Features<'_>>();
                        (*one).synchronization2 = vk::TRUE;
                        found.synchronization = true;
                    }
                    Type::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceDynamicRenderingFeatures<'_>>();
                        (*one).dynamic_rendering = vk::TRUE;
                        found.rendering = true;
                    }
                    Type::PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES if full_subgroups => {
                        found.subgroup_size = true;
                        let all = next.cast::<vk::PhysicalDeviceSubgroupSizeControlFeatures<'_>>();
                        let all = &mut *all;
                        (all.subgroup_size_control, all.compute_full_subgroups) =
                            (vk::TRUE, vk::TRUE);
                    }
                    Type::PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT if self.mesh_shader => {
                        found.mesh = true;
                        let all = &mut *next.cast::<vk::PhysicalDeviceMeshShaderFeaturesEXT<'_>>();
                        (all.mesh_shader, all.task_shader) = (vk::TRUE, vk::TRUE);
                    }
                    _ => {}
                }
                next = (*next).p_next;
            }
        }
        found
    }

    /// Completes a host's create info, whatever structs are chained to it, as they are by an engine that does not say which:
    /// features are set where a struct has them, and the structs of `ours` are chained for the others. All features are
    /// enabled then, the optional ones too.
    ///
    /// ```no_run
    /// # use {ash::vk, rara_gpu::Support};
    /// fn completed(support: &Support, engine: vk::DeviceCreateInfo<'_>, create: impl FnOnce(&vk::DeviceCreateInfo<'_>)) {
    ///     let mut ours = support.features();
    ///     // SAFETY: what the engine has chained is its own and ours until the device is created.
    ///     create(&unsafe { support.complete(&mut ours, engine) });
    /// }
    /// ```
    ///
    /// # Safety
    ///
    /// `info.p_next` is null, or a chain of Vulkan's structs that may be changed and that nobody else uses meanwhile.
    pub unsafe fn complete<'a>(
        &self,
        ours: &'a mut Features,
        info: vk::DeviceCreateInfo<'a>,
    ) -> vk::DeviceCreateInfo<'a> {
        // SAFETY: the caller's promise.
        let found = unsafe { self.set_in(info.p_next.cast_mut()) };
        let mut info = info;
        ours.unchain();
        if self.buffer_device_address && !found.address {
            info = info.push_next(&mut ours.buffer_device_address);
        }
        if !found.synchronization {
            info = info.push_next(&mut ours.synchronization2);
        }
        if !found.rendering {
            info = info.push_next(&mut ours.dynamic_rendering);
        }
        if let Some(mesh) = ours.mesh.as_mut().filter(|_| !found.mesh) {
            info = info.push_next(mesh);
        }
        if let Some(sizes) = ours.subgroup_size.as_mut().filter(|_| !found.subgroup_size) {
            info = info.push_next(sizes);
        }
        info
    }
}

/// Which features a chain has structs for.
#[derive(Default)]
struct OfferedFeatures {
    address: bool,
    synchronization: bool,
    rendering: bool,
    mesh: bool,
    subgroup_size: bool,
}

/// The feature structs that a device is created with, in 1.2 as in 1.3, each of one feature or one extension: they go
/// together with any struct of a host's that has other features.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Features {
    /// `bufferDeviceAddress`, where supported.
    pub buffer_device_address: vk::PhysicalDeviceBufferDeviceAddressFeatures<'static>,
    /// `synchronization2`.
    pub synchronization2: vk::PhysicalDeviceSynchronization2Features<'static>,
    /// `dynamicRendering`.
    pub dynamic_rendering: vk::PhysicalDeviceDynamicRenderingFeatures<'static>,
    /// `meshShader` and `taskShader`, where supported.
    pub mesh: Option<vk::PhysicalDeviceMeshShaderFeaturesEXT<'static>>,
    /// `subgroupSizeControl` and `computeFullSubgroups`, where supported.
    pub subgroup_size: Option<vk::PhysicalDeviceSubgroupSizeControlFeatures<'static>>,
}

impl Features {
    /// Chains the structs to `info`.
    pub fn chain<'a>(&'a mut self, info: vk::DeviceCreateInfo<'a>) -> vk::DeviceCreateInfo<'a> {
        self.unchain();
        let info = info
            .push_next(&mut self.buffer_device_address)
            .push_next(&mut self.synchronization2)
            .push_next(&mut self.dynamic_rendering);
        let info = match &mut self.mesh {
            Some(mesh) => info.push_next(mesh),
            None => info,
        };
        match &mut self.subgroup_size {
            Some(subgroup_size) => info.push_next(subgroup_size),
            None => info,
        }
    }

    /// Forgets what the structs were chained to: another create info may have ended since.
    fn unchain(&mut self) {
        self.buffer_device_address.p_next = std::ptr::null_mut();
        self.synchronization2.p_next = std::ptr::null_mut();
        self.dynamic_rendering.p_next = std::ptr::null_mut();
        if let Some(mesh) = &mut self.mesh {
            mesh.p_next = std::ptr::null_mut();
        }
        if let Some(sizes) = &mut self.subgroup_size {
            sizes.p_next = std::ptr::null_mut();
        }
    }
}

#[cfg(test)]
mod tests;
