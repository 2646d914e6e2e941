//! Pipelines are made, and compiled, on all cores.
//!
//! Drivers for GPUs compile a pipeline when it is made. Mesa's driver for CPUs, lavapipe, compiles a compute shader when it is
//! dispatched first, one after the other on the one thread of its queue, and keeps the result in a folder that all
//! processes share. So that a first frame does not wait for one core, its pipelines are dispatched ahead, without a workgroup, on
//! several devices, each with a queue of its own; the frame then finds them in that folder.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

use ash::vk;

use super::desc::DeviceDesc;
use super::device::{Ahead, Device};
use super::lent::Location;
use super::memory::{Buffer, BufferDesc};
use super::pipeline::{ComputeDesc, ComputePipeline};
use rara_base::error::{Error, Result};
use rara_base::files::write_atomically;
use rara_base::fnv;

impl Ahead {
    /// The list in a file. `None` for drivers that compile when a pipeline is made, or keep nothing.
    pub(super) fn open(device: &Device, path: PathBuf) -> Option<Self> {
        if device.driver_id() != vk::DriverId::MESA_LLVMPIPE {
            return None;
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        let hashes = text.lines().map(|line| u64::from_str_radix(line, 16));
        let known = Mutex::new(hashes.filter_map(std::result::Result::ok).collect());
        Some(Self { path, known })
    }

    /// Has the driver compile those of the pipelines that it is not known to have compiled. An error costs time alone.
    fn compile(&self, device: &Device, pipelines: &[ComputeDesc<'_>]) {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let pipelines = pipelines.iter().map(|desc| (desc, hash(device, desc)));
        let new: Vec<_> = {
            let known = known();
            pipelines
                .filter(|(_, hash)| !known.contains(hash))
                .collect()
        };
        if new.is_empty() {
            return;
        }
        // A dispatcher's instance is its own too: when that goes, what the driver has compiled is in its folder.
        let compile = |own: &Dispatcher, (desc, _): &(&_, _)| own.dispatch(desc);
        // A single pipeline takes as long on the frame's own queue.
        let done = match new.len() {
            1 => Ok(Vec::new()),
            _ => on_threads(&new, || Dispatcher::like(device), compile),
        };
        match done {
            Ok(_) => {
                let mut known = known();
                known.extend(new.iter().map(|(_, hash)| hash));
                self.keep(&known);
            }
            Err(error) => log::warn!("shaders are compiled on one core: {error}"),
        }
    }

    fn keep(&self, known: &BTreeSet<u64>) {
        let kept = || -> Result<()> {
            let folder = self.path.parent().expect("a file in a folder");
            fs::create_dir_all(folder).map_err(Error::io(folder))?;
            write_atomically(&self.path, |out| {
                known
                    .iter()
                    .try_for_each(|hash| writeln!(out, "{hash:016x}"))
            })
        };
        if let Err(error) = kept() {
            // The compiled pipelines go to the same folder, and what is wrong with it is told of those.
            log::debug!("what the driver has compiled is not noted: {error}");
        }
    }
}

/// A device on which pipelines are dispatched for the sake of their compilation.
struct Dispatcher {
    device: Device,
    /// The buffer that stands for all of a pipeline's: nothing reads or writes it.
    buffer: Buffer,
}

impl Dispatcher {
    /// Opens another device like one.
    fn like(model: &Device) -> Result<Self> {
        let name = &model.info().name;
        let desc = DeviceDesc::default().selector(Some(name.clone()));
        let device = Device::headless(&desc.shape(Some(model.shape())))?;
        if device.pipeline_cache_id() != model.pipeline_cache_id() {
            return Err(Error::Device(format!("several devices are called {name}")));
        }
        let buffer = device.create_buffer(&BufferDesc {
            name: "compiled ahead",
            size: 16,
            location: Location::GpuOnly,
        })?;
        Ok(Self { device, buffer })
    }

    fn dispatch(&self, desc: &ComputeDesc<'_>) -> Result<()> {
        let pipeline = ComputePipeline::new(&self.device, desc)?;
        let inner = pipeline.inner();
        let buffers = vec![&self.buffer; inner.layout.buffer_count()];
        let raw = self.device.raw();
        let point = vk::PipelineBindPoint::COMPUTE;
        self.device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording on the pipeline's device; pipeline and buffer outlive the wait.
            unsafe {
                raw.cmd_bind_pipeline(cmd, point, inner.raw);
                inner.layout.push(cmd, point, &buffers, &[], None);
                raw.cmd_dispatch(cmd, 0, 0, 0);
            }
            Ok(())
        })
    }
}

/// The hash that tells a pipeline's compilation from others by the same driver.
fn hash(device: &Device, desc: &ComputeDesc<'_>) -> u64 {
    let constants = desc.constants.iter().flat_map(|(id, value)| [id, value]);
    let code = desc.shader.code(desc.bindings).iter();
    let words = code
        .chain(constants)
        .chain([&device.support().subgroup_size]);
    fnv::with(fnv::NOTHING, words.copied())
}

fn threads() -> usize {
    #[cfg(any(test, feature = "lab"))]
    if crate::faults::are_here() {
        return 1; // a device that fails on purpose does so on the test's own thread
    }
    rara_base::parallel::threads()
}

impl Device {
    /// Makes a pipeline of each of `wanted`, on all cores where the device is our own: a host's device is used by the thread
    /// alone that calls. Counts how long it takes. `pipeline` describes those that compute.
    #[doc(hidden)]
    pub fn making_pipelines<T: Sync, R: Send>(
        &self,
        wanted: &[T],
        pipeline: impl Fn(&T) -> Option<ComputeDesc<'_>>,
        make: impl Fn(&T) -> Result<R> + Sync,
    ) -> Result<Vec<R>> {
        let begin = Instant::now();
        let said = |is_begun| self.inner.on_compile.get().map(|hook| hook.0(is_begun));
        said(true);
        let made = if !self.is_own() || threads() < 2 || wanted.len() < 2 {
            wanted.iter().map(make).collect()
        } else {
            let pipelines: Vec<_> = wanted.iter().filter_map(pipeline).collect();
            thread::scope(|scope| {
                if let Some(ahead) = self.inner.ahead.get() {
                    scope.spawn(move || ahead.compile(self, &pipelines));
                }
                on_threads(wanted, || Ok(()), |(), item| make(item))
            })
        };
        said(false);
        let ns = u64::try_from(begin.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.inner.pipeline_ns.fetch_add(ns, Ordering::Relaxed);
        made
    }
}

/// Makes something of each item, in their order, on threads of which each begins with something of its own.
fn on_threads<T: Sync, S, R: Send>(
    items: &[T],
    begin: impl Fn() -> Result<S> + Sync,
    make: impl Fn(&S, &T) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let next = AtomicUsize::new(0);
    let work = || {
        let own = begin()?;
        let mut made = Vec::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(at) else {
                return Ok(made);
            };
            made.push((at, make(&own, item)?));
        }
    };
    let mut made = Vec::new();
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads().min(items.len()))
            .map(|_| scope.spawn(work))
            .collect();
        for worker in workers {
            let end: Result<Vec<_>> = worker
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            made.extend(end?);
        }
        Ok(())
    })?;
    made.sort_by_key(|(at, _)| *at);
    Ok(made.into_iter().map(|(_, made)| made).collect())
}
