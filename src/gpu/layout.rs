//! The layout that pipelines and commands share: push constants, and the descriptor set of bound buffers.

use ash::vk;

use super::device::Device;
use super::failure::failed;
use super::memory::Buffer;
use super::requirements::Support;
use super::shader::{Bindings, BufferUse, MAX_BUFFERS, MAX_PARAMS, Shader};
use super::shape::DeviceShape;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

impl Bindings {
    /// The fastest way on a device. CPU drivers load what all lanes share once from a bound buffer, and for each lane from
    /// an address, but compile a branch for each lane where a bound buffer is read at several places: lavapipe then takes
    /// about twice as long to compile a frame's shaders as with [`Mixed`](Self::Mixed), and draws it no faster. Addresses alone
    /// take a third more. On GPUs addresses cost nothing. A device that lacks what that needs is suited by what it has.
    pub fn suiting(device: &Device) -> Self {
        let fastest = match device.shape() {
            DeviceShape::Cpu => Self::Mixed,
            DeviceShape::Gpu { .. } => Self::Address,
        };
        fastest.or_other(device.support())
    }

    /// This way where a device has what it needs, or else the one that the device has.
    #[doc(hidden)]
    pub fn or_other(self, support: &Support) -> Self {
        match self {
            Self::Bound | Self::Mixed if !support.push_descriptor => Self::Address,
            Self::Address | Self::Mixed if !support.buffer_device_address => Self::Bound,
            way => way,
        }
    }
}

/// The block that `glsl/buffers.glsl` declares: 128 bytes, which every device has. Shaders that bind their buffers declare
/// its parameters alone.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct PushConstants {
    address: [u64; MAX_BUFFERS],
    param: [u32; MAX_PARAMS],
}

const _: () = assert!(size_of::<PushConstants>() == 128);

impl PushConstants {
    /// The bytes of the block that shaders declare: those that bind their buffers need no addresses.
    fn bytes(bindings: Bindings) -> std::ops::Range<usize> {
        match bindings {
            Bindings::Address | Bindings::Mixed => 0..size_of::<Self>(),
            Bindings::Bound => std::mem::offset_of!(Self, param)..size_of::<Self>(),
        }
    }
}

/// A pipeline layout for the buffers of one or several shaders.
#[derive(Debug)]
pub struct Layout {
    device: Device,
    pub raw: vk::PipelineLayout,
    /// Null for [`Bindings::Address`].
    set: vk::DescriptorSetLayout,
    stages: vk::ShaderStageFlags,
    bindings: Bindings,
    /// The buffers of all stages, by ascending binding.
    pub uses: Vec<BufferUse>,
    /// True when an image is bound behind them.
    image: bool,
}

impl Layout {
    #[doc(hidden)]
    pub fn new(
        device: &Device,
        name: &str,
        shaders: &[&Shader],
        bindings: Bindings,
    ) -> Result<Self> {
        if bindings != Bindings::Bound && !device.support().buffer_device_address {
            return Err(Error::Device(
                "buffer addresses need the feature bufferDeviceAddress, which this device lacks or was made without; bind \
                 buffers instead (Bindings::Bound)"
                    .into(),
            ));
        }
        let mut uses: Vec<BufferUse> = Vec::new();
        for buffer in shaders.iter().flat_map(|shader| shader.buffers) {
            assert!(
                (buffer.binding as usize) < MAX_BUFFERS,
                "pipeline \"{name}\": binding {} is too high",
                buffer.binding
            );
            match uses.iter().find(|known| known.binding == buffer.binding) {
                None => uses.push(*buffer),
                Some(known) => assert!(
                    known.name == buffer.name && known.access == buffer.access,
                    "pipeline \"{name}\": its shaders disagree about binding {}",
                    buffer.binding
                ),
            }
        }
        uses.sort_by_key(|buffer| buffer.binding);
        let stages = shaders
            .iter()
            .fold(vk::ShaderStageFlags::empty(), |stages, shader| {
                stages | shader.stage
            });
        let mut this = Self {
            device: device.clone(),
            raw: vk::PipelineLayout::null(),
            set: vk::DescriptorSetLayout::null(),
            stages,
            bindings,
            uses,
            image: shaders.iter().any(|shader| shader.image),
        };
        let binds = this.image || this.bound().next().is_some();
        if binds {
            this.set = this.create_set()?;
            device.set_name(this.set, name);
        }
        let ranges = [vk::PushConstantRange::default()
            .stage_flags(stages)
            .size(PushConstants::bytes(bindings).len() as u32)];
        let sets = [this.set];
        let info = vk::PipelineLayoutCreateInfo::default()
            .push_constant_ranges(&ranges)
            .set_layouts(if binds { &sets } else { &[] });
        // SAFETY: the device is alive as long as `device`, and the set layout was made from it.
        this.raw = unsafe { device.raw().create_pipeline_layout(&info, None) }
            .map_err(failed("vkCreatePipelineLayout"))?;
        device.set_name(this.raw, name);
        Ok(this)
    }

    fn create_set(&self) -> Result<vk::DescriptorSetLayout> {
        if self.device.push_descriptor().is_none() {
            return Err(Error::Device(
                "bound buffers need VK_KHR_push_descriptor, which this device lacks or was made without; use buffer \
                 addresses instead"
                    .into(),
            ));
        }
        let slot = |binding, kind| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(kind)
                .descriptor_count(1)
                .stage_flags(self.stages)
        };
        let buffers = self.bound().map(|buffer| buffer.binding);
        let buffers = buffers.map(|binding| slot(binding, vk::DescriptorType::STORAGE_BUFFER));
        let image = slot(MAX_BUFFERS as u32, vk::DescriptorType::SAMPLED_IMAGE);
        let slots: Vec<_> = buffers.chain(self.image.then_some(image)).collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
            .bindings(&slots);
        // SAFETY: the device is alive as long as `self.device`.
        unsafe { self.device.raw().create_descriptor_set_layout(&info, None) }
            .map_err(failed("vkCreateDescriptorSetLayout"))
    }

    /// The buffers that are bound.
    fn bound(&self) -> impl Iterator<Item = &BufferUse> {
        let is_bound = |buffer: &&BufferUse| match self.bindings {
            Bindings::Address => false,
            Bindings::Bound => true,
            Bindings::Mixed => buffer.common,
        };
        self.uses.iter().filter(is_bound)
    }

    /// Buffers that a command must be given: one for each binding up to the highest.
    pub(crate) fn buffer_count(&self) -> usize {
        self.uses
            .last()
            .map_or(0, |buffer| buffer.binding as usize + 1)
    }

    /// Panics with a sentence unless a command has the right number of buffers and parameters.
    #[doc(hidden)]
    pub fn check(&self, name: &str, buffers: &[&Buffer], params: &[u32]) {
        let wanted = self.buffer_count();
        assert!(
            buffers.len() == wanted,
            "\"{name}\" was given {} buffers and its shaders declare {wanted}: {:?}",
            buffers.len(),
            self.uses
                .iter()
                .map(|buffer| buffer.name)
                .collect::<Vec<_>>()
        );
        assert!(
            params.len() <= MAX_PARAMS,
            "\"{name}\" was given {} parameters and {MAX_PARAMS} are possible",
            params.len()
        );
    }

    /// Records push constants and, where bound, the buffers and the image.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on this layout's device; the buffers must outlive its execution.
    #[doc(hidden)]
    pub unsafe fn push(
        &self,
        cmd: vk::CommandBuffer,
        point: vk::PipelineBindPoint,
        buffers: &[&Buffer],
        params: &[u32],
        image: Option<vk::DescriptorImageInfo>,
    ) {
        let mut block: PushConstants = bytemuck::Zeroable::zeroed();
        for (address, buffer) in block.address.iter_mut().zip(buffers) {
            *address = buffer.address();
        }
        block.param[..params.len()].copy_from_slice(params);
        let raw = self.device.raw();
        let bytes = &bytemuck::bytes_of(&block)[PushConstants::bytes(self.bindings)];
        // SAFETY: the caller vouches for `cmd`; the layout has one range of this size for these stages.
        unsafe { raw.cmd_push_constants(cmd, self.raw, self.stages, 0, bytes) };
        let mut count = self.bound().count();
        if count == 0 && image.is_none() {
            return;
        }
        let limit = self.device.support().max_storage_buffer_range;
        let mut infos = [[vk::DescriptorBufferInfo::default()]; MAX_BUFFERS];
        for (info, buffer) in infos.iter_mut().zip(self.bound()) {
            let bound = buffers[buffer.binding as usize];
            assert!(
                bound.size() <= limit,
                "buffer \"{}\" of {} cannot be bound: this device binds at most {limit}; use buffer addresses",
                bound.name(),
                counted(bound.size(), "byte")
            );
            *info = [vk::DescriptorBufferInfo::default()
                .buffer(bound.handle())
                .range(vk::WHOLE_SIZE)];
        }
        let mut writes = [vk::WriteDescriptorSet::default(); MAX_BUFFERS + 1];
        for ((write, info), buffer) in writes.iter_mut().zip(&infos).zip(self.bound()) {
            *write = vk::WriteDescriptorSet::default()
                .dst_binding(buffer.binding)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .buffer_info(info);
        }
        let image = image.map(|image| [image]);
        if let Some(image) = &image {
            writes[count] = vk::WriteDescriptorSet::default()
                .dst_binding(MAX_BUFFERS as u32)
                .descriptor_type(vk::DescriptorType::SAMPLED_IMAGE)
                .image_info(image);
            count += 1;
        }
        let push = self
            .device
            .push_descriptor()
            .expect("a layout with a set was made with the extension");
        // SAFETY: as above; set 0 of the layout is a push descriptor set with exactly these bindings.
        unsafe { push.cmd_push_descriptor_set(cmd, point, self.raw, 0, &writes[..count]) };
    }
}

impl Drop for Layout {
    fn drop(&mut self) {
        // SAFETY: pipelines own their layout and go first; null handles are ignored.
        unsafe {
            self.device.raw().destroy_pipeline_layout(self.raw, None);
            self.device
                .raw()
                .destroy_descriptor_set_layout(self.set, None);
        }
    }
}
