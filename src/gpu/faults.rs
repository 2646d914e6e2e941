//! Devices for tests, which fail when a test says so, pretend to be too old, and remember which objects were made and named.
//!
//! The seam is the one pointer through which ash asks for every function of a device, `vkGetDeviceProcAddr`, and the few
//! through which it asks for a physical device's properties. Tests therefore run the code that ships, the memory
//! allocator's included, without a branch, a trait or a feature that only tests need.

mod pretence;

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::ffi::{CStr, c_char, c_void};

use ash::vk;
use ash::vk::Handle;

use super::instance::Instance;
use super::{AdoptDesc, Device, testing};
pub use pretence::Pretence;
use rara_base::error::Result;

/// A fault: which call fails, and with which result.
#[derive(Debug, Clone, Copy)]
pub struct Fault {
    /// How many fallible calls succeed before.
    pub after: usize,
    /// The result of the one after them. A lost device stays lost: all later calls that can say so do.
    pub result: vk::Result,
}

#[derive(Default)]
struct State {
    real: HashMap<&'static str, Function>,
    instance: Option<ash::Instance>,
    pretence: Option<Pretence>,
    fault: Option<Fault>,
    among: &'static [&'static str],
    /// Calls among them since the fault was set.
    calls: usize,
    /// All fallible calls since then.
    counts: HashMap<&'static str, usize>,
    fired: Option<&'static str>,
    /// Objects by handle, with the call that made them.
    made: BTreeMap<u64, &'static str>,
    named: BTreeMap<u64, String>,
    labels: Vec<String>,
    depth: usize,
    unlabelled: Vec<&'static str>,
}

type Function = unsafe extern "system" fn();

thread_local! {
    // Each test is a thread, and no other thread uses its device.
    static STATE: RefCell<State> = RefCell::default();
}

fn with<R>(act: impl FnOnce(&mut State) -> R) -> R {
    STATE.with_borrow_mut(act)
}

/// True on a thread that has made such an instance.
pub(crate) fn are_here() -> bool {
    with(|state| state.instance.is_some())
}

/// An instance under validation whose devices are as `pretence` says and fail as `set_among` asks from then on.
pub fn instance(pretence: Option<Pretence>) -> Instance {
    let mut instance = Instance::new("rara", true, &[]).expect("the validation layer");
    let raw = instance.raw.clone();
    let mut v1_0 = raw.fp_v1_0().clone();
    let mut v1_1 = raw.fp_v1_1().clone();
    v1_0.get_device_proc_addr = get_device_proc_addr;
    v1_0.get_physical_device_properties = pretence::properties;
    v1_0.get_physical_device_queue_family_properties = pretence::queue_families;
    v1_0.enumerate_device_extension_properties = pretence::extensions;
    v1_0.create_device = pretence::create_device;
    v1_1.get_physical_device_features2 = pretence::features;
    v1_1.get_physical_device_properties2 = pretence::properties2;
    instance.raw = ash::Instance::from_parts_1_3(raw.handle(), v1_0, v1_1, raw.fp_v1_3().clone());
    with(|state| {
        *state = State {
            instance: Some(raw),
            pretence,
            ..State::default()
        };
    });
    instance
}

/// A device under validation that fails as `set_among` asks.
pub fn device(pretence: Option<Pretence>) -> Result<Device> {
    let instance = instance(pretence);
    let candidates = instance.devices()?;
    Device::open(
        std::sync::Arc::new(instance),
        candidates,
        &testing::desc(),
        &[],
    )
}

/// True when fewer places are enough, as on slow drivers: the code under test is not theirs.
pub fn is_slow() -> bool {
    let scale = std::env::var("RARA_TEST_SCALE").ok();
    scale.is_some_and(|scale| scale.parse().is_ok_and(|scale: f64| scale < 1.0))
}

/// A device as a host would lend it.
pub fn lent(host: &Device) -> AdoptDesc {
    let queue = (*host.lock_queue(), host.queue_family());
    let (instance, raw) = (host.instance().clone(), host.raw().clone());
    let support = host.support();
    AdoptDesc::new(support.api_version, instance, host.physical(), raw, queue)
        .mesh_shader(support.mesh_shader)
        .push_descriptor(support.push_descriptor)
        .full_subgroups(support.full_subgroups[1] > 0)
        .debug_utils(true)
}

/// Sets which of these calls fails from now on, if any.
pub fn set_among(among: &'static [&'static str], fault: Option<Fault>) {
    with(|state| {
        (state.fault, state.among) = (fault, among);
        (state.calls, state.fired) = (0, None);
        state.counts.clear();
    });
}

/// The call that has failed first since [`set_among`].
pub fn fired() -> Option<&'static str> {
    with(|state| state.fired)
}

/// How often a call was made since [`set_among`].
pub fn count(call: &str) -> usize {
    with(|state| state.counts.get(call).copied().unwrap_or(0))
}

/// Objects without a name, by the call that made them.
pub fn nameless() -> Vec<&'static str> {
    with(|state| {
        let made = state.made.iter();
        made.filter(|(handle, _)| !state.named.contains_key(handle))
            .map(|(_, call)| *call)
            .collect()
    })
}

/// Every debug label since the device was made, and the commands that were recorded under none.
pub fn labels() -> (Vec<String>, Vec<&'static str>) {
    with(|state| (state.labels.clone(), state.unlabelled.clone()))
}

/// The result that `call` has to return instead of being called.
fn due(call: &'static str) -> Option<vk::Result> {
    with(|state| {
        *state.counts.entry(call).or_insert(0) += 1;
        let fault = state.fault?;
        if !state.among.contains(&call) {
            return None;
        }
        let first = state.calls == fault.after;
        state.calls += 1;
        if first {
            state.fired = Some(call);
            return Some(fault.result);
        }
        let lost = fault.result == vk::Result::ERROR_DEVICE_LOST && state.fired.is_some();
        (lost && CAN_BE_LOST.contains(&call)).then_some(fault.result)
    })
}

/// The calls here that may return `VK_ERROR_DEVICE_LOST`.
pub const CAN_BE_LOST: [&str; 4] = [
    "vkQueueSubmit2",
    "vkWaitForFences",
    "vkDeviceWaitIdle",
    "vkGetQueryPoolResults",
];

fn real(call: &'static str) -> Function {
    with(|state| state.real[call])
}

fn under_label(call: &'static str) {
    with(|state| {
        if state.depth == 0 {
            state.unlabelled.push(call);
        }
    });
}

/// Functions that fail when they are due, or report something; the others are the driver's.
macro_rules! functions {
    (
        fallible { $($fallible:ident = $name:literal: $pfn:ident($($arg:ident: $type:ty),*)
            $(-> $made:ident)?;)* }
        commands { $($command:ident = $cname:literal: $cpfn:ident($($carg:ident: $ctype:ty),*);)* }
    ) => {
        $(unsafe extern "system" fn $fallible($($arg: $type),*) -> vk::Result {
            let due = due($name);
            // A device that is lost is idle; this one is idle only after the wait.
            if due.is_some() && !["vkWaitForFences", "vkDeviceWaitIdle"].contains(&$name) {
                return due.expect("just seen");
            }
            // SAFETY: the driver's function of this name has this type, and the caller's arguments.
            let result = unsafe {
                std::mem::transmute::<Function, vk::$pfn>(real($name))($($arg),*)
            };
            $(if result == vk::Result::SUCCESS {
                // SAFETY: the call has succeeded and has written at least one handle.
                let handle = unsafe { *$made }.as_raw();
                with(|state| {
                    state.named.remove(&handle); // of an object that is gone
                    state.made.insert(handle, $name)
                });
            })?
            due.unwrap_or(result)
        })*
        $(unsafe extern "system" fn $command($($carg: $ctype),*) {
            under_label($cname);
            // SAFETY: as above.
            unsafe { std::mem::transmute::<Function, vk::$cpfn>(real($cname))($($carg),*) }
        })*
        /// Every call here that may fail.
        pub static CALLS: [&str; [$($name),*].len()] = [$($name),*];

        /// Our function in place of the driver's, with the name under which the driver's is kept.
        fn exchanged(name: &CStr) -> Option<(&'static str, *const c_void)> {
            match name.to_str().ok()? {
                $($name => Some(($name, $fallible as *const c_void)),)*
                $($cname => Some(($cname, $command as *const c_void)),)*
                "vkSetDebugUtilsObjectNameEXT" => {
                    Some(("vkSetDebugUtilsObjectNameEXT", set_name as *const c_void))
                }
                "vkCmdBeginDebugUtilsLabelEXT" => {
                    Some(("vkCmdBeginDebugUtilsLabelEXT", begin_label as *const c_void))
                }
                "vkCmdEndDebugUtilsLabelEXT" => {
                    Some(("vkCmdEndDebugUtilsLabelEXT", end_label as *const c_void))
                }
                _ => None,
            }
        }
    };
}

type A = *const vk::AllocationCallbacks<'static>;
type D = vk::Device;
type C = vk::CommandBuffer;

functions! {
    fallible {
        allocate_memory = "vkAllocateMemory": PFN_vkAllocateMemory(d: D, info: *const vk::MemoryAllocateInfo<'static>, a: A, out: *mut vk::DeviceMemory) -> out;
        map_memory = "vkMapMemory": PFN_vkMapMemory(d: D, memory: vk::DeviceMemory, offset: u64, size: u64, flags: vk::MemoryMapFlags, out: *mut *mut c_void);
        bind_buffer = "vkBindBufferMemory": PFN_vkBindBufferMemory(d: D, buffer: vk::Buffer, memory: vk::DeviceMemory, offset: u64);
        bind_image = "vkBindImageMemory": PFN_vkBindImageMemory(d: D, image: vk::Image, memory: vk::DeviceMemory, offset: u64);
        create_buffer = "vkCreateBuffer": PFN_vkCreateBuffer(d: D, info: *const vk::BufferCreateInfo<'static>, a: A, out: *mut vk::Buffer) -> out;
        create_image = "vkCreateImage": PFN_vkCreateImage(d: D, info: *const vk::ImageCreateInfo<'static>, a: A, out: *mut vk::Image) -> out;
        create_image_view = "vkCreateImageView": PFN_vkCreateImageView(d: D, info: *const vk::ImageViewCreateInfo<'static>, a: A, out: *mut vk::ImageView) -> out;
        create_shader_module = "vkCreateShaderModule": PFN_vkCreateShaderModule(d: D, info: *const vk::ShaderModuleCreateInfo<'static>, a: A, out: *mut vk::ShaderModule) -> out;
        create_pipeline_layout = "vkCreatePipelineLayout": PFN_vkCreatePipelineLayout(d: D, info: *const vk::PipelineLayoutCreateInfo<'static>, a: A, out: *mut vk::PipelineLayout) -> out;
        create_set_layout = "vkCreateDescriptorSetLayout": PFN_vkCreateDescriptorSetLayout(d: D, info: *const vk::DescriptorSetLayoutCreateInfo<'static>, a: A, out: *mut vk::DescriptorSetLayout) -> out;
        create_compute = "vkCreateComputePipelines": PFN_vkCreateComputePipelines(d: D, cache: vk::PipelineCache, count: u32, infos: *const vk::ComputePipelineCreateInfo<'static>, a: A, out: *mut vk::Pipeline) -> out;
        create_graphics = "vkCreateGraphicsPipelines": PFN_vkCreateGraphicsPipelines(d: D, cache: vk::PipelineCache, count: u32, infos: *const vk::GraphicsPipelineCreateInfo<'static>, a: A, out: *mut vk::Pipeline) -> out;
        create_pipeline_cache = "vkCreatePipelineCache": PFN_vkCreatePipelineCache(d: D, info: *const vk::PipelineCacheCreateInfo<'static>, a: A, out: *mut vk::PipelineCache) -> out;
        create_query_pool = "vkCreateQueryPool": PFN_vkCreateQueryPool(d: D, info: *const vk::QueryPoolCreateInfo<'static>, a: A, out: *mut vk::QueryPool) -> out;
        query_results = "vkGetQueryPoolResults": PFN_vkGetQueryPoolResults(d: D, pool: vk::QueryPool, first: u32, count: u32, size: usize, data: *mut c_void, stride: u64, flags: vk::QueryResultFlags);
        create_command_pool = "vkCreateCommandPool": PFN_vkCreateCommandPool(d: D, info: *const vk::CommandPoolCreateInfo<'static>, a: A, out: *mut vk::CommandPool) -> out;
        reset_command_pool = "vkResetCommandPool": PFN_vkResetCommandPool(d: D, pool: vk::CommandPool, flags: vk::CommandPoolResetFlags);
        allocate_commands = "vkAllocateCommandBuffers": PFN_vkAllocateCommandBuffers(d: D, info: *const vk::CommandBufferAllocateInfo<'static>, out: *mut vk::CommandBuffer) -> out;
        begin_commands = "vkBeginCommandBuffer": PFN_vkBeginCommandBuffer(cmd: C, info: *const vk::CommandBufferBeginInfo<'static>);
        end_commands = "vkEndCommandBuffer": PFN_vkEndCommandBuffer(cmd: C);
        create_fence = "vkCreateFence": PFN_vkCreateFence(d: D, info: *const vk::FenceCreateInfo<'static>, a: A, out: *mut vk::Fence) -> out;
        reset_fences = "vkResetFences": PFN_vkResetFences(d: D, count: u32, fences: *const vk::Fence);
        wait_for_fences = "vkWaitForFences": PFN_vkWaitForFences(d: D, count: u32, fences: *const vk::Fence, all: vk::Bool32, timeout: u64);
        device_wait_idle = "vkDeviceWaitIdle": PFN_vkDeviceWaitIdle(d: D);
        queue_submit2 = "vkQueueSubmit2": PFN_vkQueueSubmit2(queue: vk::Queue, count: u32, submits: *const vk::SubmitInfo2<'static>, fence: vk::Fence);
    }
    commands {
        dispatch = "vkCmdDispatch": PFN_vkCmdDispatch(cmd: C, x: u32, y: u32, z: u32);
        dispatch_indirect = "vkCmdDispatchIndirect": PFN_vkCmdDispatchIndirect(cmd: C, args: vk::Buffer, offset: u64);
        draw_indirect = "vkCmdDrawIndirect": PFN_vkCmdDrawIndirect(cmd: C, args: vk::Buffer, offset: u64, count: u32, stride: u32);
        draw_mesh = "vkCmdDrawMeshTasksIndirectEXT": PFN_vkCmdDrawMeshTasksIndirectEXT(cmd: C, args: vk::Buffer, offset: u64, count: u32, stride: u32);
        begin_rendering = "vkCmdBeginRendering": PFN_vkCmdBeginRendering(cmd: C, info: *const vk::RenderingInfo<'static>);
        fill = "vkCmdFillBuffer": PFN_vkCmdFillBuffer(cmd: C, target: vk::Buffer, offset: u64, size: u64, word: u32);
        update = "vkCmdUpdateBuffer": PFN_vkCmdUpdateBuffer(cmd: C, target: vk::Buffer, offset: u64, size: u64, data: *const c_void);
        copy = "vkCmdCopyBuffer": PFN_vkCmdCopyBuffer(cmd: C, from: vk::Buffer, to: vk::Buffer, count: u32, regions: *const vk::BufferCopy);
        copy_image = "vkCmdCopyImageToBuffer": PFN_vkCmdCopyImageToBuffer(cmd: C, from: vk::Image, layout: vk::ImageLayout, to: vk::Buffer, count: u32, regions: *const vk::BufferImageCopy);
    }
}

unsafe extern "system" fn set_name(
    device: vk::Device,
    info: *const vk::DebugUtilsObjectNameInfoEXT<'static>,
) -> vk::Result {
    // SAFETY: the caller's struct is valid, its name too; the driver's function has this type.
    unsafe {
        let name = (*info).object_name_as_c_str().unwrap_or_default();
        let name = name.to_string_lossy().into_owned();
        with(|state| state.named.insert((*info).object_handle, name));
        let call = real("vkSetDebugUtilsObjectNameEXT");
        std::mem::transmute::<Function, vk::PFN_vkSetDebugUtilsObjectNameEXT>(call)(device, info)
    }
}

unsafe extern "system" fn begin_label(
    cmd: vk::CommandBuffer,
    label: *const vk::DebugUtilsLabelEXT<'static>,
) {
    // SAFETY: as above.
    unsafe {
        let name = (*label).label_name_as_c_str().unwrap_or_default();
        with(|state| {
            state.labels.push(name.to_string_lossy().into_owned());
            state.depth += 1;
        });
        let call = real("vkCmdBeginDebugUtilsLabelEXT");
        std::mem::transmute::<Function, vk::PFN_vkCmdBeginDebugUtilsLabelEXT>(call)(cmd, label);
    }
}

unsafe extern "system" fn end_label(cmd: vk::CommandBuffer) {
    with(|state| state.depth -= 1);
    let call = real("vkCmdEndDebugUtilsLabelEXT");
    // SAFETY: as above.
    unsafe { std::mem::transmute::<Function, vk::PFN_vkCmdEndDebugUtilsLabelEXT>(call)(cmd) };
}

unsafe extern "system" fn get_device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let instance = driver();
    // SAFETY: the caller's device and name are valid; a function of ours has the type of the one it stands for.
    unsafe {
        let found = (instance.fp_v1_0().get_device_proc_addr)(device, name)?;
        let Some((name, ours)) = exchanged(CStr::from_ptr(name)) else {
            return Some(found);
        };
        with(|state| state.real.insert(name, found));
        Some(std::mem::transmute::<*const c_void, Function>(ours))
    }
}

fn driver() -> ash::Instance {
    with(|state| state.instance.clone()).expect("made by `instance`")
}
