//! Moves bytes to device memory and back through a bounded staging buffer, for headless use and for loading scenes.

use ash::vk;

use super::{Buffer, BufferDesc, Device, Location, Recorder};
use crate::Result;

/// The most bytes staged at once. More would gain nothing, since a chunk takes milliseconds; with fewer, submissions would
/// cost noticeable time.
const STAGING: u64 = 32 << 20;

impl Device {
    /// Writes `data` at `offset` in a buffer and waits until it is there.
    #[cfg_attr(not(feature = "lab"), doc(hidden))]
    pub fn upload(&self, buffer: &Buffer, offset: u64, data: &[u8]) -> Result<()> {
        self.upload_with(buffer, offset, data.len() as u64, |at, chunk| {
            chunk.copy_from_slice(&data[at as usize..][..chunk.len()]);
            Ok(())
        })
    }

    /// Writes `size` bytes at `offset` in a buffer and waits until they are there. `fill` is called for one chunk after
    /// the other, with the chunk's first byte among the `size`, and writes all of it: at most 32 MiB, and a multiple of
    /// 1 MiB except for the last. The chunk is mapped memory that is slow to read.
    #[cfg_attr(not(feature = "lab"), doc(hidden))]
    pub fn upload_with(
        &self,
        buffer: &Buffer,
        offset: u64,
        size: u64,
        mut fill: impl FnMut(u64, &mut [u8]) -> Result<()>,
    ) -> Result<()> {
        buffer.check_range(offset, size);
        if size == 0 {
            return Ok(());
        }
        let mut staging = self.staging(size, Location::Upload)?;
        for at in (0..size).step_by(STAGING as usize) {
            let length = STAGING.min(size - at);
            fill(at, &mut staging.mapped_mut()[..length as usize])?;
            let region = vk::BufferCopy {
                src_offset: 0,
                dst_offset: offset + at,
                size: length,
            };
            self.copy_and_wait(&staging, buffer, region)?;
        }
        Ok(())
    }

    /// Reads a whole buffer back, after everything submitted before.
    #[cfg_attr(not(feature = "lab"), doc(hidden))]
    pub fn download(&self, buffer: &Buffer) -> Result<Vec<u8>> {
        self.download_range(buffer, 0, buffer.size())
    }

    /// Reads `size` bytes at `offset` of a buffer back, after everything submitted before.
    #[cfg_attr(not(feature = "lab"), doc(hidden))]
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
            let mut recorder = unsafe { Recorder::begin(self, cmd, None) };
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
