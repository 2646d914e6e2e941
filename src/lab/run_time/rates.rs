//! The work that the device does in a second when it does nothing else: bytes moved, fragments blended.

use std::time::Instant;

use rara::ash::util::read_spv;
use rara::ash::vk;
use rara::{Error, Result};
use rara_base::limits::{TILE_HEIGHT, TILE_WIDTH};
use rara_gpu::{
    Bindings, Buffer, BufferAccess, BufferDesc, BufferUse, ComputeDesc, ComputePipeline, Device,
    Draws, Groups, Location, Recorder, Shader, Timer,
};

/// Splats that cover every tile, and their opacity: each is above 1/255 everywhere, and the last still gets light.
const SPLATS: u32 = 128;
const OPACITY: f32 = 0.015;
const TILE_BYTES: u64 = 16 * (TILE_WIDTH * TILE_HEIGHT) as u64;

pub(super) struct Rates {
    device: Device,
    copy: ComputePipeline,
    /// One invocation has a tile's column, as CPU drivers like it, or a pixel.
    blends: [ComputePipeline; 2],
    source: Buffer,
    target: Buffer,
    splats: Buffer,
}

impl Rates {
    /// Buffers with so many bytes to move, more than caches hold.
    pub(super) fn new(device: &Device, bytes: u64) -> Result<Self> {
        let buffer = |name, size| {
            let location = Location::GpuOnly;
            device.create_buffer(&BufferDesc {
                name,
                size,
                location,
            })
        };
        let pipeline = |shader, constants: &[(u32, u32)]| {
            ComputePipeline::new(
                device,
                &ComputeDesc {
                    name: "rate",
                    shader,
                    constants,
                    bindings: Bindings::Address,
                },
            )
        };
        let blend = shader(include_bytes!("shaders/blend.comp.spv"))?;
        let rows = |rows| pipeline(blend, &[(0, rows), (1, TILE_HEIGHT / rows)]);
        let splats = buffer("splats", u64::from(SPLATS) * 48)?;
        let each = (0..SPLATS).flat_map(|i| {
            let (x, y) = ((i % 8) as f32, (i / 16) as f32);
            [[x, y, 0.02, 0.01], [0.02, OPACITY, 0.0, 0.0], [0.5; 4]]
        });
        let each: Vec<[f32; 4]> = each.collect();
        let bytes_of = each.as_flattened().iter().flat_map(|v| v.to_le_bytes());
        device.upload(&splats, 0, &bytes_of.collect::<Vec<u8>>())?;
        let rates = Self {
            device: device.clone(),
            copy: pipeline(shader(include_bytes!("shaders/copy.comp.spv"))?, &[])?,
            blends: [rows(TILE_HEIGHT)?, rows(1)?],
            source: buffer("source", bytes)?,
            target: buffer("target", bytes)?,
            splats,
        };
        // Memory that nothing has written may be a single page.
        rates.seconds(|recorder| {
            recorder.fill(&rates.source, 0, bytes, 1);
            recorder.fill(&rates.target, 0, bytes, 2);
        })?;
        Ok(rates)
    }

    /// Bytes read and bytes written in a second, by a shader or by the driver's own copy.
    pub(super) fn moved(&self) -> Result<f64> {
        let (from, to, size) = (&self.source, &self.target, self.source.size());
        let words = (size / 16) as u32;
        let shader = self.seconds(|recorder| {
            let groups = Groups::Count(words.div_ceil(64));
            recorder.dispatch(&self.copy, &[from, to], &[words], groups);
        })?;
        let driver = self.seconds(|recorder| {
            recorder.copy(from, to, &[vk::BufferCopy::default().size(size)]);
        })?;
        Ok(2.0 * size as f64 / shader.min(driver))
    }

    /// Fragments blended in a second.
    pub(super) fn blended(&self) -> Result<f64> {
        let tiles = self.target.size() / TILE_BYTES;
        let fragments = tiles * u64::from(TILE_WIDTH * TILE_HEIGHT * SPLATS);
        let mut least = f64::INFINITY;
        for pipeline in &self.blends {
            let seconds = self.seconds(|recorder| {
                let buffers = [&self.splats, &self.target];
                recorder.dispatch(pipeline, &buffers, &[SPLATS], Groups::Count(tiles as u32));
            })?;
            least = least.min(seconds);
        }
        Ok(fragments as f64 / least)
    }

    /// Microseconds that a dispatch takes in a chain of them, each of which waits for the one before, by kind.
    pub(super) fn fixed(&self) -> Result<Vec<(&'static str, f64)>> {
        /// Workgroups of a dispatch that is not tiny.
        const MANY: u32 = 1024;
        let [from, to] = [&self.source, &self.target];
        let one = |_| Groups::Indirect(&self.splats, 0);
        let none = |_| Groups::Indirect(&self.splats, 16);
        let written = |even| Groups::Indirect(if even { from } else { to }, 0);
        // Commands for one workgroup, and one for none.
        self.seconds(|recorder| {
            recorder.fill(&self.splats, 0, 16, 1);
            recorder.fill(&self.splats, 16, 16, 0);
            recorder.fill(from, 0, 16, 1);
            recorder.fill(to, 0, 16, 1);
        })?;
        Ok(vec![
            ("direct", self.chain(64, false, |_| Groups::Count(1))?),
            (
                "direct, many workgroups",
                self.chain(64 * MANY, false, |_| Groups::Count(MANY))?,
            ),
            ("indirect", self.chain(64, false, one)?),
            ("indirect, none", self.chain(64, false, none)?),
            (
                "indirect, written by the one before",
                self.chain(64, false, written)?,
            ),
            (
                "fill, then direct",
                self.chain(64, true, |_| Groups::Count(1))?,
            ),
        ])
    }

    /// Copies so many words of 16 bytes there and back; `groups` hears whether the way is there.
    fn chain<'a>(
        &'a self,
        words: u32,
        fills: bool,
        groups: impl Fn(bool) -> Groups<'a>,
    ) -> Result<f64> {
        const CHAIN: u32 = 256;
        let [from, to] = [&self.source, &self.target];
        let seconds = self.seconds(|recorder| {
            for link in 0..CHAIN {
                let even = link % 2 == 0;
                let buffers = if even { [from, to] } else { [to, from] };
                if fills {
                    recorder.fill(buffers[0], 0, 64, 1);
                }
                recorder.dispatch(&self.copy, &buffers, &[words], groups(even));
            }
        })?;
        Ok(1e6 * seconds / f64::from(CHAIN))
    }

    /// How many seconds the device takes for a recording.
    fn seconds(&self, record: impl FnOnce(&mut Recorder<'_>)) -> Result<f64> {
        let mut timer = Timer::new(&self.device, 1)?;
        let begin = Instant::now();
        self.device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording on this device outside rendering, and what it uses outlives the wait.
            let mut recorder =
                unsafe { Recorder::begin(&self.device, cmd, Draws::After, Some(&mut timer)) };
            recorder.pass("rate", record);
            Ok(())
        })?;
        let timed = timer
            .read()
            .and_then(|passes| Some(passes.first()?.1 / 1e3));
        Ok(timed.unwrap_or(begin.elapsed().as_secs_f64()))
    }
}

/// A shader that reads its first buffer and writes its second; it lives as long as the program.
fn shader(bytes: &[u8]) -> Result<&'static Shader> {
    let words = read_spv(&mut std::io::Cursor::new(bytes)).map_err(Error::io("shaders"))?;
    Ok(Box::leak(Box::new(Shader {
        name: "rate",
        file: "rate.comp",
        stage: vk::ShaderStageFlags::COMPUTE,
        address: words.leak(),
        bound: &[],
        mixed: &[],
        buffers: &[
            BufferUse {
                name: "read",
                binding: 0,
                access: BufferAccess::Read,
                common: false,
            },
            BufferUse {
                name: "written",
                binding: 1,
                access: BufferAccess::Write,
                common: false,
            },
        ],
        subgroups: false,
        image: false,
    })))
}
