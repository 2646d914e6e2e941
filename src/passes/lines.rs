//! Draws lines over a finished picture, all in one draw, as windows do. No frame that is only rendered has this.

use bytemuck::{Pod, Zeroable};

use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::shaders::lines;
use rara_base::error::Result;
use rara_gpu::{Attachments, Bindings, Buffer, BufferDesc, DepthUse, Device, Drawer, Location};

/// A line in the picture, as `glsl/lines.vert` reads it.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PictureLine {
    /// x and y of one end, and of the other, px.
    pub ends: [f32; 4],
    /// Red, green and blue.
    pub colour: [f32; 3],
    /// Half its width, px.
    pub radius: f32,
}

/// Bytes of the draw's own command, which stands before the lines.
const COMMAND: usize = 16;

/// The lines of each frame in flight, and the pipeline that draws them.
#[derive(Debug)]
pub struct Lines {
    pipelines: Pipelines,
    /// A buffer a frame in flight, as large as the most lines so far.
    buffers: Vec<Option<Buffer>>,
}

impl Lines {
    /// No lines yet, for so many frames in flight.
    pub fn new(bindings: Bindings, frames: usize) -> Self {
        Self {
            pipelines: Pipelines::new(bindings),
            buffers: (0..frames).map(|_| None).collect(),
        }
    }

    /// Puts the lines of a frame in place, before it is recorded. The last frame of this number has been waited for.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory) where there is no room for them, and what the pipeline's compilation reports.
    pub fn write(
        &mut self,
        device: &Device,
        frame: usize,
        lines: &[PictureLine],
        attachments: Attachments,
    ) -> Result<()> {
        if lines.is_empty() {
            return Ok(());
        }
        self.pipelines
            .ensure(device, vec![draw(attachments).key()])?;
        let bytes = bytemuck::cast_slice::<_, u8>(lines);
        let needed = (COMMAND + bytes.len()) as u64;
        let place = &mut self.buffers[frame];
        let buffer = match place.take().filter(|buffer| buffer.size() >= needed) {
            Some(buffer) => buffer,
            None => device.create_buffer(&BufferDesc {
                name: "lines",
                size: needed.next_power_of_two(),
                location: Location::Upload,
            })?,
        };
        let mut mapped = place.insert(buffer).mapped_mut();
        // A strip of four corners for each line.
        let command = [4, lines.len() as u32, 0, 0];
        mapped.write(0, bytemuck::cast_slice(&command));
        mapped.write(COMMAND, bytes);
        Ok(())
    }

    /// Draws the lines that were written for a frame into a picture of this size, with the attachments that they were written
    /// for.
    pub fn record(
        &self,
        drawer: &mut Drawer<'_>,
        frame: usize,
        (width, height): (u32, u32),
        attachments: Attachments,
    ) {
        if let Some(buffer) = &self.buffers[frame] {
            let params = lines::Params {
                pixel: [2.0 / width as f32, 2.0 / height as f32],
            };
            let buffers = lines::Buffers { lines: buffer };
            let buffers = (buffers, |buffer| buffer);
            draw(attachments).draw(&self.pipelines, drawer, buffers, params, (buffer, 0));
        }
    }
}

fn draw(attachments: Attachments) -> Draw<lines::Program> {
    Draw::new(
        [&lines::VERT, &lines::FRAG],
        (),
        attachments,
        DepthUse::Ignored,
    )
}
