//! A shader as build.rs describes it: its SPIR-V for all bindings and the buffers it declares.

use ash::vk;

/// The way in which shaders reach their buffers. A renderer takes another one where a device lacks what a way needs:
/// addresses need [`Support::buffer_device_address`](super::Support::buffer_device_address), and binding needs
/// [`Support::push_descriptor`](super::Support::push_descriptor).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bindings {
    /// Buffers are reached by device address. Their size has no limit, but the validation layer cannot check accesses.
    #[default]
    Address,
    /// Buffers are storage buffers of descriptor set 0, pushed with each command. The validation layer checks every access. A
    /// buffer may not be larger than [`Support::max_storage_buffer_range`](super::Support::max_storage_buffer_range).
    Bound,
    /// The constants of the frame are bound, and all other buffers are reached by device address.
    Mixed,
}

/// How a shader uses a buffer, as its GLSL declares it (`readonly`, `writeonly` or neither).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BufferAccess {
    /// `readonly`.
    Read,
    /// `writeonly`.
    Write,
    /// Neither.
    ReadWrite,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BufferUse {
    pub name: &'static str,
    /// Its place in the pass's list of buffers: binding number, or index into the push constants' addresses.
    pub binding: u32,
    pub access: BufferAccess,
    /// True when all lanes read the same of it, so that it is bound also where others are reached by address.
    pub common: bool,
}

/// A compiled shader. The same source is compiled thrice: with buffers behind device addresses (fast, and free of the
/// binding size limit), with bound storage buffers (which the validation layer can watch), and with some of
/// either (which CPU drivers need to compile fast and run fast).
#[derive(Debug, Clone, Copy)]
pub struct Shader {
    /// File name without its stage's ending: `classify` for `glsl/classify.comp`.
    pub name: &'static str,
    pub file: &'static str,
    pub stage: vk::ShaderStageFlags,
    /// SPIR-V that reaches its buffers through the addresses in the push constants.
    pub address: &'static [u32],
    /// SPIR-V that reaches its buffers through descriptor set 0.
    pub bound: &'static [u32],
    /// SPIR-V that reaches some of its buffers either way.
    pub mixed: &'static [u32],
    /// The buffers, by ascending binding.
    pub buffers: &'static [BufferUse],
    /// True when it has subgroup operations. Where the device can be asked for whole subgroups of a size, it is.
    pub subgroups: bool,
    /// True when it reads an image, which is bound behind all buffers, at [`MAX_BUFFERS`].
    pub image: bool,
}

impl Shader {
    /// Its SPIR-V that reaches its buffers in one of the two ways.
    pub(super) fn code(&self, bindings: Bindings) -> &'static [u32] {
        match bindings {
            Bindings::Address => self.address,
            Bindings::Bound => self.bound,
            Bindings::Mixed => self.mixed,
        }
    }
}

/// Buffers a pass can have: device addresses that fit in the guaranteed 128 bytes of push constants beside
/// [`MAX_PARAMS`] words.
pub const MAX_BUFFERS: usize = rara_base::limits::MAX_BUFFERS as usize;

/// 32-bit parameters a pass can have.
pub const MAX_PARAMS: usize = rara_base::limits::MAX_PARAMS as usize;
