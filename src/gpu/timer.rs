//! How long passes take on the device, by name.

use ash::vk;

use super::Device;
use super::failure::failed;
use crate::Result;

/// Timestamps around the passes of one recording. Where the device has none, it does nothing and reads nothing.
///
/// Both timestamps of a pass are written when all earlier work is done, so times of passes in a row add up to the
/// whole, and overlap is charged to the pass that ends later.
pub struct Timer {
    device: Device,
    /// Null where the device has no timestamps.
    pool: vk::QueryPool,
    capacity: u32,
    /// Passes begun since the last reset; pass `i` has the queries `2 i` and `2 i + 1`.
    names: Vec<&'static str>,
    /// Whether a recording has reset the pool and may write to it.
    ready: bool,
}

impl Timer {
    /// Room for `capacity` passes.
    pub fn new(device: &Device, capacity: u32) -> Result<Self> {
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
        })
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
    }

    /// Records the beginning of a pass; returns what [`Timer::end`] wants.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on this timer's device, in the queue's order after [`Timer::reset`].
    pub unsafe fn begin(&mut self, cmd: vk::CommandBuffer, name: &'static str) -> u32 {
        assert!(
            self.ready,
            "the timer was not reset before pass \"{name}\": call reset in the same recording first"
        );
        let pass = self.names.len() as u32;
        assert!(
            pass < self.capacity,
            "pass \"{name}\" is one more than the timer's capacity of {}",
            self.capacity
        );
        self.names.push(name);
        // SAFETY: the caller vouches for `cmd`.
        unsafe { self.write(cmd, 2 * pass) };
        pass
    }

    /// Records the end of a pass.
    ///
    /// # Safety
    ///
    /// As for [`Timer::begin`], once for each pass.
    pub unsafe fn end(&mut self, cmd: vk::CommandBuffer, pass: u32) {
        // SAFETY: the caller vouches for `cmd`.
        unsafe { self.write(cmd, 2 * pass + 1) };
    }

    /// Milliseconds of each pass, in the order they began; passes of one name are added up. `None` where there are no
    /// timestamps, nothing was recorded, or the device is not done yet. Ask after waiting for the recording: before it
    /// runs, the queries still hold what an earlier recording left. Hosts with several frames in flight have a timer
    /// for each.
    pub fn read(&self) -> Option<Vec<(&'static str, f64)>> {
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
        let support = self.device.support();
        let times = ticks.chunks_exact(2).map(|pair| {
            elapsed(pair[0], pair[1], support.timestamp_bits) as f64
                * f64::from(support.timestamp_period)
                * 1e-6
        });
        let mut sums: Vec<(&'static str, f64)> = Vec::with_capacity(self.names.len());
        for (name, time) in self.names.iter().zip(times) {
            match sums.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += time,
                None => sums.push((name, time)),
            }
        }
        Some(sums)
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
                    .raw()
                    .cmd_write_timestamp2(cmd, stage, self.pool, query)
            };
        }
    }
}

/// Ticks between two timestamps of `bits` valid bits, which may wrap around once.
fn elapsed(begin: u64, end: u64, bits: u32) -> u64 {
    end.wrapping_sub(begin) & (u64::MAX >> (64 - bits.clamp(1, 64)))
}

impl Drop for Timer {
    fn drop(&mut self) {
        // SAFETY: whoever submitted the recording waited for it; a null pool is ignored.
        unsafe { self.device.raw().destroy_query_pool(self.pool, None) };
    }
}

impl std::fmt::Debug for Timer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Timer")
            .field("capacity", &self.capacity)
            .field("names", &self.names)
            .finish_non_exhaustive()
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
