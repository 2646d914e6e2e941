//! Measures how long passes take on the device, by name.

use ash::vk;

use super::device::Device;
use super::failure::failed;
use rara_base::error::Result;
use rara_base::stats::PassStatistics;

/// Timestamps around the passes of one recording. Where the device has none, it does nothing and reads nothing.
///
/// Both timestamps of a pass are written when all earlier work is done, so times of passes in a row add up to the
/// whole, and overlap is charged to the pass that ends later.
#[derive(Debug)]
pub struct Timer {
    device: Device,
    /// Null where the device has no timestamps.
    pool: vk::QueryPool,
    capacity: u32,
    /// Passes begun since the last reset; pass `i` has the queries `2 i` and `2 i + 1`.
    names: Vec<&'static str>,
    /// True when a recording has reset the pool and may write to it.
    ready: bool,
    /// True if each dispatch is measured instead of the stage that it belongs to.
    by_dispatch: bool,
    statistics: Option<Statistics>,
}

/// The most dispatches of a frame that are measured one by one.
const MOST_DISPATCHES: u32 = 256;

/// True if the environment has `RARA_TIMES=dispatches`: timers then measure each compute dispatch, under the name of its
/// pipeline, instead of the stage that it belongs to.
#[doc(hidden)]
pub fn measures_dispatches() -> bool {
    std::env::var_os("RARA_TIMES").is_some_and(|times| times == "dispatches")
}

/// Pipeline statistics of the passes: pass `i` has query `i`.
#[derive(Debug)]
struct Statistics {
    pool: vk::QueryPool,
    /// The pass that counts. Passes within it are counted with it, as Vulkan has only one such query active at a time.
    active: Option<u32>,
    /// The passes that have counted.
    passes: Vec<u32>,
}

/// When a pass began and ended, in ticks of the device's clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PassSpan {
    /// The pass.
    pub name: &'static str,
    /// When all earlier work was done.
    pub begin: u64,
    /// When its own work was done too.
    pub end: u64,
}

impl Timer {
    /// A timer with room for `capacity` passes, or for those of [`measures_dispatches`].
    pub fn new(device: &Device, capacity: u32) -> Result<Self> {
        let by_dispatch = measures_dispatches();
        let capacity = if by_dispatch {
            MOST_DISPATCHES
        } else {
            capacity
        };
        let mut pool = vk::QueryPool::null();
        if device.support().timestamp_period > 0.0 {
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(2 * capacity.max(1));
            // SAFETY: the device is alive as long as `device`, and its queue has timestamps.
            pool = unsafe { device.raw().create_query_pool(&info, None) }
                .map_err(failed("vkCreateQueryPool"))?;
            device.set_name(pool, "timer");
        }
        let names = Vec::with_capacity(capacity as usize);
        Ok(Self {
            device: device.clone(),
            pool,
            capacity,
            names,
            ready: false,
            by_dispatch,
            statistics: None,
        })
    }

    /// True if dispatches are measured instead of stages.
    pub(super) fn is_by_dispatch(&self) -> bool {
        self.by_dispatch
    }

    /// Makes it count also what the passes do, where the device was opened for it.
    pub fn with_statistics(mut self) -> Result<Self> {
        if self.device.support().pipeline_statistics {
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::PIPELINE_STATISTICS)
                .pipeline_statistics(COUNTED)
                .query_count(self.capacity.max(1));
            // SAFETY: the device is alive, and its feature for such queries was enabled.
            let pool = unsafe { self.device.raw().create_query_pool(&info, None) }
                .map_err(failed("vkCreateQueryPool"))?;
            self.device.set_name(pool, "statistics");
            self.statistics = Some(Statistics {
                pool,
                active: None,
                passes: Vec::with_capacity(self.capacity as usize),
            });
        }
        Ok(self)
    }

    /// Forgets the last recording's passes and records the reset of the queries.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on this timer's device, outside rendering, and recordings that used the timer before
    /// must be submitted earlier, or never.
    pub unsafe fn reset(&mut self, cmd: vk::CommandBuffer) {
        self.names.clear();
        self.ready = true;
        if self.pool != vk::QueryPool::null() {
            // SAFETY: the caller vouches for `cmd`; the range is the whole pool.
            unsafe {
                self.device
                    .raw()
                    .cmd_reset_query_pool(cmd, self.pool, 0, 2 * self.capacity.max(1))
            };
        }
        if let Some(statistics) = &mut self.statistics {
            statistics.active = None;
            statistics.passes.clear();
            let count = self.capacity.max(1);
            // SAFETY: as above.
            unsafe {
                let raw = self.device.raw();
                raw.cmd_reset_query_pool(cmd, statistics.pool, 0, count);
            }
        }
    }

    /// Records the beginning of a pass, and returns its number for [`Timer::end`]. `None` where there is no room for one
    /// more, which then has no times.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on this timer's device, in the queue's order after [`Timer::reset`].
    pub unsafe fn begin(&mut self, cmd: vk::CommandBuffer, name: &'static str) -> Option<u32> {
        assert!(
            self.ready,
            "the timer was not reset before pass \"{name}\": call reset in the same recording first"
        );
        let pass = self.names.len() as u32;
        if pass >= self.capacity {
            return None;
        }
        self.names.push(name);
        // SAFETY: the caller vouches for `cmd`.
        unsafe { self.write(cmd, 2 * pass) };
        if let Some(statistics) = self.statistics.as_mut().filter(|s| s.active.is_none()) {
            statistics.active = Some(pass);
            statistics.passes.push(pass);
            let flags = vk::QueryControlFlags::empty();
            // SAFETY: as above; no other query of this pool is active.
            unsafe {
                let raw = self.device.raw();
                raw.cmd_begin_query(cmd, statistics.pool, pass, flags);
            }
        }
        Some(pass)
    }

    /// Records the end of a pass.
    ///
    /// # Safety
    ///
    /// As for [`Timer::begin`], once for each pass.
    pub unsafe fn end(&mut self, cmd: vk::CommandBuffer, pass: u32) {
        if let Some(statistics) = self.statistics.as_mut().filter(|s| s.active == Some(pass)) {
            statistics.active = None;
            // SAFETY: the caller vouches for `cmd`; the query was begun in the same scope.
            unsafe { self.device.raw().cmd_end_query(cmd, statistics.pool, pass) };
        }
        // SAFETY: the caller vouches for `cmd`.
        unsafe { self.write(cmd, 2 * pass + 1) };
    }

    /// Milliseconds of each pass, in the order they began; passes of one name are added up. `None` where there are no
    /// timestamps, nothing was recorded, or the device is not done yet. Ask after waiting for the recording: before it
    /// runs, the queries still hold what an earlier recording left. Hosts with several frames in flight have a timer
    /// for each.
    pub fn read(&self) -> Option<Vec<(&'static str, f64)>> {
        let support = self.device.support();
        let mut sums: Vec<(&'static str, f64)> = Vec::with_capacity(self.names.len());
        for span in self.spans()? {
            let ticks = elapsed(span.begin, span.end, support.timestamp_bits);
            let time = ticks as f64 * f64::from(support.timestamp_period) * 1e-6;
            match sums.iter_mut().find(|(known, _)| *known == span.name) {
                Some((_, sum)) => *sum += time,
                None => sums.push((span.name, time)),
            }
        }
        Some(sums)
    }

    /// When each pass began and ended, in the order they began; `None` as for [`read`](Self::read).
    pub fn spans(&self) -> Option<Vec<PassSpan>> {
        if self.pool == vk::QueryPool::null() || self.names.is_empty() {
            return None;
        }
        let mut ticks = vec![0_u64; 2 * self.names.len()];
        // SAFETY: the pool is alive and `ticks` holds one 64-bit result for each query asked for. The queries were
        // reset by the recording; before it runs the result is "not ready".
        let read = unsafe {
            self.device.raw().get_query_pool_results(
                self.pool,
                0,
                &mut ticks,
                vk::QueryResultFlags::TYPE_64,
            )
        };
        read.ok()?;
        let pairs = self.names.iter().zip(ticks.chunks_exact(2));
        let span = |(name, pair): (&&'static str, &[u64])| PassSpan {
            name,
            begin: pair[0],
            end: pair[1],
        };
        Some(pairs.map(span).collect())
    }

    /// The statistics of each pass; passes of one name are added up. It is empty without statistics, else as for
    /// [`read`](Self::read).
    pub fn statistics(&self) -> Vec<PassStatistics> {
        let mut sums: Vec<PassStatistics> = Vec::new();
        let Some(statistics) = &self.statistics else {
            return sums;
        };
        for &pass in &statistics.passes {
            let mut counts = [[0_u64; 4]];
            let flags = vk::QueryResultFlags::TYPE_64;
            // SAFETY: the pool is alive, and a query of it has as many 64-bit results.
            let read = unsafe {
                let raw = self.device.raw();
                raw.get_query_pool_results(statistics.pool, pass, &mut counts, flags)
            };
            if read.is_err() {
                return Vec::new();
            }
            let [vertices, primitives, fragments, invocations] = counts[0];
            let name = self.names[pass as usize];
            let at = sums.iter().position(|sum| sum.name == name);
            let at = at.unwrap_or_else(|| {
                sums.push(PassStatistics::new(name));
                sums.len() - 1
            });
            let sum = &mut sums[at];
            sum.vertex_invocations += vertices;
            sum.primitives += primitives;
            sum.fragment_invocations += fragments;
            sum.compute_invocations += invocations;
        }
        sums
    }

    /// # Safety
    ///
    /// As for [`Timer::begin`].
    unsafe fn write(&self, cmd: vk::CommandBuffer, query: u32) {
        if self.pool != vk::QueryPool::null() {
            let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
            // SAFETY: the caller vouches for `cmd`; the query is below the pool's count and was reset.
            unsafe {
                self.device
                    .commands()
                    .write_timestamp(cmd, stage, self.pool, query)
            };
        }
    }
}

/// The statistics in the order of their bits, which is that of the results.
const COUNTED: vk::QueryPipelineStatisticFlags = vk::QueryPipelineStatisticFlags::from_raw(
    vk::QueryPipelineStatisticFlags::VERTEX_SHADER_INVOCATIONS.as_raw()
        | vk::QueryPipelineStatisticFlags::CLIPPING_PRIMITIVES.as_raw()
        | vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS.as_raw()
        | vk::QueryPipelineStatisticFlags::COMPUTE_SHADER_INVOCATIONS.as_raw(),
);

/// Ticks between two timestamps of `bits` valid bits, which may wrap around once.
fn elapsed(begin: u64, end: u64, bits: u32) -> u64 {
    end.wrapping_sub(begin) & (u64::MAX >> (64 - bits.clamp(1, 64)))
}

impl Drop for Timer {
    fn drop(&mut self) {
        // SAFETY: whoever submitted the recording waited for it; a null pool is ignored.
        unsafe { self.device.raw().destroy_query_pool(self.pool, None) };
        if let Some(statistics) = &self.statistics {
            // SAFETY: as above.
            unsafe { self.device.raw().destroy_query_pool(statistics.pool, None) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::elapsed;

    #[test]
    fn timestamps_may_wrap() {
        assert_eq!(elapsed(5, 12, 64), 7);
        assert_eq!(elapsed(u64::MAX, 1, 64), 2);
        assert_eq!(elapsed((1 << 36) - 1, 1, 36), 2);
    }
}
