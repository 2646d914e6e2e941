//! A driver's compiled pipelines, as bytes to keep and to give back. Who keeps them in a file checks them first: drivers are
//! supposed to refuse what is not theirs, but some crash.

use std::sync::atomic::Ordering;

use ash::vk;

use super::device::Device;
use super::failure::failed;
use rara_base::error::Result;

/// The driver and the device that have compiled pipelines; no others can use them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PipelineCacheId {
    /// The device's vendor.
    pub vendor: u32,
    /// The device's model.
    pub device: u32,
    /// The driver's version, in the vendor's own way of writing it.
    pub driver: u32,
    /// An id that the driver changes with the format of its caches.
    pub uuid: [u8; vk::UUID_SIZE],
}

/// Bytes of the header that every cache begins with: its size, its version, vendor, device and UUID.
const HEADER: usize = 16 + vk::UUID_SIZE;

impl PipelineCacheId {
    /// True when `data` begins with the header of this driver's caches.
    pub fn matches(&self, data: &[u8]) -> bool {
        let word = |at: usize| u32::from_le_bytes(std::array::from_fn(|byte| data[4 * at + byte]));
        data.len() >= HEADER
            && (HEADER..=data.len()).contains(&(word(0) as usize))
            && word(1) == vk::PipelineCacheHeaderVersion::ONE.as_raw() as u32
            && (word(2), word(3)) == (self.vendor, self.device)
            && data[16..HEADER] == self.uuid
    }
}

impl Device {
    /// The id of the caches that this device's driver can use.
    pub fn pipeline_cache_id(&self) -> PipelineCacheId {
        let properties = self.properties();
        PipelineCacheId {
            vendor: properties.vendor_id,
            device: properties.device_id,
            driver: properties.driver_version,
            uuid: properties.pipeline_cache_uuid,
        }
    }

    /// How long the driver has taken to make this device's pipelines so far, milliseconds. Some drivers compile when they
    /// make a pipeline, others when it is used first: then the frame that uses it first takes longer, which is not in here.
    pub fn pipeline_ms(&self) -> f64 {
        self.inner.pipeline_ns.load(Ordering::Relaxed) as f64 / 1e6
    }

    /// Adds the pipelines that an earlier run kept, so that they need not be compiled again.
    ///
    /// # Safety
    ///
    /// `data` is what [`pipeline_cache_data`](Self::pipeline_cache_data) returned on a device of the same
    /// [`PipelineCacheId`], whole and unchanged.
    pub(crate) unsafe fn add_pipeline_cache_data(&self, data: &[u8]) -> Result<()> {
        if self.pipeline_cache() == vk::PipelineCache::null() {
            return Ok(());
        }
        let info = vk::PipelineCacheCreateInfo::default().initial_data(data);
        // SAFETY: the caller vouches for the data.
        let added = unsafe { self.raw().create_pipeline_cache(&info, None) }
            .map_err(failed("vkCreatePipelineCache"))?;
        // SAFETY: both caches are this device's. Nobody else uses the first, whose owner is borrowed or calls this before
        // it compiles; the second is ours alone.
        let merged = unsafe {
            self.raw()
                .merge_pipeline_caches(self.pipeline_cache(), &[added])
        };
        // SAFETY: created above, used by nothing any more.
        unsafe { self.raw().destroy_pipeline_cache(added, None) };
        merged.map_err(failed("vkMergePipelineCaches"))
    }

    /// The pipelines compiled so far, for a later run. It is empty where nothing is kept: on a host's device that came
    /// without a cache.
    pub fn pipeline_cache_data(&self) -> Result<Vec<u8>> {
        if self.pipeline_cache() == vk::PipelineCache::null() {
            return Ok(Vec::new());
        }
        // SAFETY: the cache is this device's, or the host's and outlives it.
        unsafe { self.raw().get_pipeline_cache_data(self.pipeline_cache()) }
            .map_err(failed("vkGetPipelineCacheData"))
    }
}

/// A driver, and the header of its caches.
#[cfg(test)]
pub(super) fn example() -> (PipelineCacheId, Vec<u8>) {
    let id = PipelineCacheId {
        vendor: 1,
        device: 2,
        driver: 3,
        uuid: [7; 16],
    };
    let words = [32_u32, 1, 1, 2];
    let mut header: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
    header.extend([7; 16]);
    (id, header)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_same_drivers_header_matches() {
        let (id, mut data) = example();
        assert!(id.matches(&data));
        for byte in 0..data.len() {
            data[byte] ^= 0x10;
            assert!(!id.matches(&data), "byte {byte} is not looked at");
            data[byte] ^= 0x10;
        }
        assert!(!id.matches(&data[..31]) && !id.matches(&[]));
        data.extend([1, 2, 3]);
        assert!(id.matches(&data));
    }
}
