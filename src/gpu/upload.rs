//! Moves bytes to device memory and back through a bounded staging buffer, for headless use and for loading scenes.

use ash::vk;

use super::device::Device;
use super::lent::Location;
use super::memory::{Buffer, BufferDesc};
use super::recorder::Recorder;
use super::tracker::Draws;
use rara_base::error::Result;

/// The most bytes staged at once. More would gain nothing, since a chunk takes milliseconds; with fewer, submissions would
/// cost noticeable time.
const STAGING: u64 = 32 << 20;

impl Device {
    /// Writes `data` at `offset` in a buffer and waits until it is there.
    #[doc(hidden)]
    pub fn upload(&self, buffer: &Buffer, offset: u64, data: &[u8]) -> Result<()> {
        buffer.check_range(offset, data.len() as u64);
        if data.is_empty() {
            return Ok(());
        }
        let mut staging = self.staging(data.len() as u64, Location::Upload)?;
        let mut at = offset;
        for chunk in data.chunks(STAGING as usize) {
            staging.mapped_mut().write(0, chunk);
            let region = vk::BufferCopy {
                src_offset: 0,
                dst_offset: at,
                size: chunk.len() as u64,
            };
            self.copy_and_wait(&staging, buffer, region)?;
            at += region.size;
        }
        Ok(())
    }

    /// Reads a whole buffer back, after everything submitted before.
    #[doc(hidden)]
    pub fn download(&self, buffer: &Buffer) -> Result<Vec<u8>> {
        self.download_range(buffer, 0, buffer.size())
    }

    /// Reads `size` bytes at `offset` of a buffer back, after everything submitted before.
    #[doc(hidden)]
    pub fn download_range(&self, buffer: &Buffer, offset: u64, size: u64) -> Result<Vec<u8>> {
        buffer.check_range(offset, size);
        let mut data = Vec::with_capacity(size as usize);
        if size == 0 {
            return Ok(data);
        }
        let staging = self.staging(size, Location::Readback)?;
        for at in (0..size).step_by(STAGING as usize) {
            let length = STAGING.min(size - at);
            let region = vk::BufferCopy {
                src_offset: offset + at,
                dst_offset: 0,
                size: length,
            };
            self.copy_and_wait(buffer, &staging, region)?;
            data.extend_from_slice(&staging.mapped()[..length as usize]);
        }
        Ok(data)
    }

    fn staging(&self, size: u64, location: Location) -> Result<Buffer> {
        self.create_buffer(&BufferDesc {
            name: "staging",
            size: size.min(STAGING),
            location,
        })
    }

    fn copy_and_wait(
        &self,
        source: &Buffer,
        target: &Buffer,
        region: vk::BufferCopy,
    ) -> Result<()> {
        self.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording for this device's queue, and both buffers outlive the wait.
            let mut recorder = unsafe { Recorder::begin(self, cmd, Draws::Around, None) };
            let reads = target.location() == Location::Readback;
            recorder.label(if reads { "download" } else { "upload" }, |recorder| {
                recorder.copy(source, target, &[region]);
                if reads {
                    recorder.ready_for_host(&[target]);
                }
            });
            Ok(())
        })
    }
}
