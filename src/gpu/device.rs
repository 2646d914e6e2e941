//! The device that everything else is made from.

use std::any::Any;
use std::collections::BTreeSet;
use std::ffi::CString;
use std::path::PathBuf;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::Allocator;

use super::account::Account;
use super::commands::Commands;
use super::deferred::Deferred;
use super::desc::AdoptDesc;
use super::devices::DeviceInfo;
use super::instance::Instance;
use super::lent::MemorySource;
use super::requirements::Support;
use super::shape::DeviceShape;
use super::submission::Submission;
use super::validation::Messages;

/// A device, shared by everything made from it; clones are the same device.
#[derive(Clone)]
pub struct Device {
    pub(super) inner: Arc<Inner>,
}

pub(super) struct Inner {
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    raw: ash::Device,
    shape: DeviceShape,
    shape_reason: &'static str,
    info: DeviceInfo,
    support: Support,
    pub(super) queue: Mutex<vk::Queue>,
    queue_family: u32,
    /// The families whose queues use its memory, each once, that of the queue included.
    families: Vec<u32>,
    pipeline_cache: vk::PipelineCache,
    /// How long the driver has made pipelines.
    pub(super) pipeline_ns: AtomicU64,
    /// How pipelines are compiled ahead; empty where they are not.
    pub(super) ahead: OnceLock<Ahead>,
    /// What is called when pipelines are made.
    pub(super) on_compile: OnceLock<OnCompile>,
    commands: Commands,
    mesh_shader: Option<ext::mesh_shader::Device>,
    push_descriptor: Option<khr::push_descriptor::Device>,
    debug_utils: Option<ext::debug_utils::Device>,
    /// Our own or the host's; `None` only while being dropped.
    allocator: Option<Arc<Mutex<Allocator>>>,
    /// The host's own source of memory, which takes the allocator's place.
    source: Option<Arc<dyn MemorySource>>,
    account: Account,
    /// The objects that are dropped when a fence is signalled.
    pub(super) deferred: Mutex<Vec<Deferred>>,
    /// Idle command buffers of [`Device::submit_and_wait`].
    pub(super) idle: Mutex<Vec<Submission>>,
    /// `None` for a host's device, which is never destroyed here. Shared with a window's surface.
    owned: Option<Arc<Instance>>,
    #[cfg(feature = "lab")]
    pub(super) inspector: std::sync::OnceLock<super::inspector::Inspector>,
    /// What keeps a host's device alive. It is the last field, so that it goes last.
    _keep_alive: Option<Arc<dyn Any + Send + Sync>>,
}

/// A function that is called with `true` when the making and compiling of pipelines begins, and with `false` when it ends: for
/// programs that say what they wait for. Both calls come from the thread that configures a frame.
#[derive(Clone)]
pub struct OnCompile(pub(super) Arc<dyn Fn(bool) + Send + Sync>);

impl OnCompile {
    /// Has a function called.
    pub fn new(hook: impl Fn(bool) + Send + Sync + 'static) -> Self {
        Self(Arc::new(hook))
    }
}

impl std::fmt::Debug for OnCompile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("OnCompile")
    }
}

/// A driver that compiles at the first dispatch, and the list of what it is known to have kept.
#[derive(Debug)]
pub(super) struct Ahead {
    /// The file of the list, a hash a line. It is no more than a hint: where it names a pipeline that the driver has lost, the
    /// frame's own device compiles that.
    pub(super) path: PathBuf,
    pub(super) known: Mutex<BTreeSet<u64>>,
}

impl Device {
    /// The constructors are in `open.rs`.
    pub(super) fn new(
        desc: AdoptDesc,
        info: DeviceInfo,
        support: Support,
        allocator: Arc<Mutex<Allocator>>,
        owned: Option<Arc<Instance>>,
        (shape, shape_reason): (DeviceShape, &'static str),
    ) -> Self {
        let (instance, raw) = (desc.instance, desc.device);
        let mut families = desc.shared_families;
        families.push(desc.queue_family);
        families.sort_unstable();
        families.dedup();
        Self {
            inner: Arc::new(Inner {
                commands: Commands::load(&instance, &raw, support.api_version),
                mesh_shader: support
                    .mesh_shader
                    .then(|| ext::mesh_shader::Device::new(&instance, &raw)),
                push_descriptor: support
                    .push_descriptor
                    .then(|| khr::push_descriptor::Device::new(&instance, &raw)),
                debug_utils: desc
                    .debug_utils
                    .then(|| ext::debug_utils::Device::new(&instance, &raw)),
                physical: desc.physical_device,
                shape,
                shape_reason,
                info,
                support,
                queue: Mutex::new(desc.queue),
                queue_family: desc.queue_family,
                families,
                pipeline_cache: desc.pipeline_cache,
                pipeline_ns: AtomicU64::new(0),
                ahead: OnceLock::new(),
                on_compile: OnceLock::new(),
                allocator: Some(allocator),
                source: desc.memory,
                account: Account::default(),
                deferred: Mutex::new(Vec::new()),
                idle: Mutex::new(Vec::new()),
                owned,
                #[cfg(feature = "lab")]
                inspector: std::sync::OnceLock::new(),
                _keep_alive: desc.keep_alive,
                instance,
                raw,
            }),
        }
    }

    /// True when two handles are of one device.
    #[doc(hidden)]
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }

    /// The device's name, driver and kind.
    pub fn info(&self) -> &DeviceInfo {
        &self.inner.info
    }

    /// The kind of machine that pipelines are chosen for. The environment variable `RARA_SHAPE` (`cpu`, `gpu`, or `gpu:N` with
    /// subgroups of N) overrides what suits the device, and a device's description overrides both.
    pub fn shape(&self) -> DeviceShape {
        self.inner.shape
    }

    /// The reason for that shape, in a few words.
    pub fn shape_reason(&self) -> &'static str {
        self.inner.shape_reason
    }

    /// The features that it offers, without those that the host did not enable.
    pub fn support(&self) -> &Support {
        &self.inner.support
    }

    /// The ash device.
    pub fn raw(&self) -> &ash::Device {
        &self.inner.raw
    }

    /// The ash instance.
    pub fn instance(&self) -> &ash::Instance {
        &self.inner.instance
    }

    /// The uses of optimally tiled images of a format.
    pub fn format_features(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        let (instance, physical) = (&self.inner.instance, self.inner.physical);
        // SAFETY: the instance is ours, or the host's and outlives this device.
        unsafe { instance.get_physical_device_format_properties(physical, format) }
            .optimal_tiling_features
    }

    /// How many samples optimally tiled 2D images of a format and use can have; none where there are no such images.
    pub fn sample_counts(
        &self,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
    ) -> vk::SampleCountFlags {
        let (instance, physical) = (&self.inner.instance, self.inner.physical);
        let (kind, tiling) = (vk::ImageType::TYPE_2D, vk::ImageTiling::OPTIMAL);
        let flags = vk::ImageCreateFlags::empty();
        // SAFETY: the instance is ours, or the host's and outlives this device.
        let found = unsafe {
            instance.get_physical_device_image_format_properties(
                physical, format, kind, tiling, usage, flags,
            )
        };
        found.map(|found| found.sample_counts).unwrap_or_default()
    }

    /// The physical device.
    #[doc(hidden)]
    pub fn physical(&self) -> vk::PhysicalDevice {
        self.inner.physical
    }

    pub(super) fn properties(&self) -> vk::PhysicalDeviceProperties {
        let (instance, physical) = (&self.inner.instance, self.inner.physical);
        // SAFETY: the instance is ours, or the host's and outlives this device.
        unsafe { instance.get_physical_device_properties(physical) }
    }

    /// The driver; zero where it does not say.
    pub(super) fn driver_id(&self) -> vk::DriverId {
        let (instance, physical) = (&self.inner.instance, self.inner.physical);
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: the instance is ours, or the host's and outlives this device, which has Vulkan 1.2.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
        driver.driver_id
    }

    /// The family of the queue.
    pub fn queue_family(&self) -> u32 {
        self.inner.queue_family
    }

    /// The families whose queues use its memory.
    pub(super) fn families(&self) -> &[u32] {
        &self.inner.families
    }

    /// The abilities of a family's queues; `None` for one that its memory is not shared with.
    #[doc(hidden)]
    pub fn queue_flags(&self, family: u32) -> Option<vk::QueueFlags> {
        self.families().contains(&family).then(|| {
            let (instance, physical) = (&self.inner.instance, self.inner.physical);
            // SAFETY: the instance is ours, or the host's and outlives this device.
            let all = unsafe { instance.get_physical_device_queue_family_properties(physical) };
            all[family as usize].queue_flags
        })
    }

    /// Takes the validation layer's warnings and errors since the last call, from all threads. Empty without the
    /// layer, and for a host's device, whose messages go to the host.
    pub fn validation_messages(&self) -> Vec<String> {
        self.messages()
            .map(|messages| messages.drain())
            .unwrap_or_default()
    }

    /// Gives up this handle and returns the validation layer's messages. If it was the last one, the device is
    /// destroyed first, so that the messages include what the layer says of things left alive.
    pub fn close(self) -> Vec<String> {
        let messages = self.messages();
        drop(self);
        messages
            .map(|messages| messages.drain())
            .unwrap_or_default()
    }

    /// True when the validation layer's messages come to us.
    pub(super) fn validates(&self) -> bool {
        let owned = self.inner.owned.as_ref();
        owned.is_some_and(|instance| instance.validation.is_some())
    }

    fn messages(&self) -> Option<Arc<Messages>> {
        let validation = self.inner.owned.as_ref()?.validation.as_ref()?;
        Some(validation.messages.clone())
    }

    pub(super) fn commands(&self) -> &Commands {
        &self.inner.commands
    }

    #[doc(hidden)]
    pub fn mesh_shader(&self) -> Option<&ext::mesh_shader::Device> {
        self.inner.mesh_shader.as_ref()
    }

    #[doc(hidden)]
    pub fn push_descriptor(&self) -> Option<&khr::push_descriptor::Device> {
        self.inner.push_descriptor.as_ref()
    }

    #[doc(hidden)]
    pub fn debug_utils(&self) -> Option<&ext::debug_utils::Device> {
        self.inner.debug_utils.as_ref()
    }

    #[doc(hidden)]
    pub fn pipeline_cache(&self) -> vk::PipelineCache {
        self.inner.pipeline_cache
    }

    /// True for a device that was opened here, false for a host's.
    pub(super) fn is_own(&self) -> bool {
        self.inner.owned.is_some()
    }

    /// Has a function called when pipelines are made, unless one is already.
    #[doc(hidden)]
    pub fn on_compile(&self, hook: OnCompile) {
        let _ = self.inner.on_compile.set(hook);
    }

    /// Names an object of this device for debuggers and validation messages.
    #[doc(hidden)]
    pub fn set_name<H: vk::Handle + Copy>(&self, object: H, name: &str) {
        let Some(debug) = self.debug_utils().filter(|_| object.as_raw() != 0) else {
            return; // there is no object, as a cache need not exist
        };
        let name = CString::new(name.replace('\0', "")).expect("no NUL is left");
        let info = vk::DebugUtilsObjectNameInfoEXT::default()
            .object_handle(object)
            .object_name(&name);
        // SAFETY: callers name objects that they just made from this device. A failure costs a name, nothing else.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// What is made on it.
    pub(super) fn account(&self) -> &Account {
        &self.inner.account
    }

    pub(super) fn memory_source(&self) -> Option<&dyn MemorySource> {
        self.inner.source.as_deref()
    }

    pub(super) fn lent_allocator(&self) -> &Mutex<Allocator> {
        self.inner.allocator.as_ref().expect("taken only by drop")
    }
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Device")
            .field("name", &self.inner.info.name)
            .field("owned", &self.inner.owned.is_some())
            .field("device_bytes", &self.device_bytes())
            .finish_non_exhaustive()
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        for submission in self
            .idle
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner)
            .drain(..)
        {
            submission.destroy(&self.raw);
        }
        // Our own allocator frees its blocks now, while there is a device.
        drop(self.allocator.take());
        if self.owned.is_some() {
            // SAFETY: everything made from the device holds an `Arc` of it or was destroyed above, and the cache is its
            // own or null. The instance goes after this function, with the field.
            unsafe {
                self.raw.destroy_pipeline_cache(self.pipeline_cache, None);
                self.raw.destroy_device(None);
            }
        }
    }
}
