//! The Vulkan layer on the device at hand. Every test ends without messages of the validation layer, or with those that
//! it provokes: lavapipe draws the right picture with barriers missing, and only the layer notices.

mod devices;
mod drawing;
mod memory;
mod recording;

use ash::vk;
use rara_gpu::*;

/// A committed SPIR-V file as words.
macro_rules! spirv {
    ($file:literal) => {{
        const BYTES: &[u8] = include_bytes!(concat!("../shaders/", $file, ".spv"));
        const WORDS: [u32; BYTES.len() / 4] = words(BYTES);
        &WORDS
    }};
}

pub(super) const fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let mut words = [0; N];
    let mut i = 0;
    while i < N {
        words[i] = u32::from_le_bytes([
            bytes[4 * i],
            bytes[4 * i + 1],
            bytes[4 * i + 2],
            bytes[4 * i + 3],
        ]);
        i += 1;
    }
    words
}

const fn used(name: &'static str, binding: u32, access: BufferAccess) -> BufferUse {
    BufferUse {
        name,
        binding,
        access,
        common: false,
    }
}

/// `target[i] = FACTOR * source[i] + param[1]` for i below `param[0]`, 64 a workgroup.
const ADD: Shader = Shader {
    name: "add",
    file: "add.comp",
    stage: vk::ShaderStageFlags::COMPUTE,
    address: spirv!("add.comp.address"),
    bound: spirv!("add.comp.bound"),
    mixed: spirv!("add.comp.address"),
    buffers: &[
        used("source", 0, BufferAccess::Read),
        used("target", 1, BufferAccess::Write),
    ],
    subgroups: false,
    image: false,
};
const VERTEX: Shader = Shader {
    name: "square",
    file: "square.vert",
    stage: vk::ShaderStageFlags::VERTEX,
    address: spirv!("square.vert.address"),
    bound: spirv!("square.vert.bound"),
    mixed: spirv!("square.vert.address"),
    buffers: &[used("corners", 0, BufferAccess::Read)],
    subgroups: false,
    image: false,
};
const MESH: Shader = Shader {
    name: "square",
    file: "square.mesh",
    stage: vk::ShaderStageFlags::MESH_EXT,
    address: spirv!("square.mesh.address"),
    bound: spirv!("square.mesh.bound"),
    mixed: spirv!("square.mesh.address"),
    buffers: &[used("corners", 0, BufferAccess::Read)],
    subgroups: false,
    image: false,
};
const FRAGMENT: Shader = Shader {
    name: "square",
    file: "square.frag",
    stage: vk::ShaderStageFlags::FRAGMENT,
    address: spirv!("square.frag.address"),
    bound: spirv!("square.frag.bound"),
    mixed: spirv!("square.frag.address"),
    buffers: &[used("paint", 1, BufferAccess::Read)],
    subgroups: false,
    image: false,
};

/// The ways to reach buffers on this device.
fn all_bindings(device: &Device) -> &'static [Bindings] {
    if device.support().push_descriptor {
        &[Bindings::Address, Bindings::Bound]
    } else {
        eprintln!(
            "{} has no push descriptors: bound buffers are not tested",
            device.info().name
        );
        &[Bindings::Address]
    }
}

/// The device under test: the best one, or the one that `RARA_TEST_DEVICE` names.
fn open() -> Device {
    let selector = std::env::var("RARA_TEST_DEVICE").ok();
    Device::headless(&DeviceDesc::default().selector(selector).validation(true)).unwrap()
}

/// Runs a test on a device with validation and asserts that the layer reports nothing, up to the destruction.
fn clean(test: impl FnOnce(&Device)) {
    let device = open();
    test(&device);
    assert_eq!(device.device_bytes(), 0, "everything allocated was freed");
    assert_eq!(device.close(), Vec::<String>::new());
}

/// Asserts that one of the layer's messages has this part.
#[track_caller]
fn assert_reported(messages: &[String], part: &str) {
    let reported = messages.iter().any(|message| message.contains(part));
    assert!(reported, "{messages:?}");
}

fn buffer(device: &Device, name: &str, size: u64, location: Location) -> Buffer {
    device
        .create_buffer(&BufferDesc {
            name,
            size,
            location,
        })
        .unwrap()
}

fn on_device(device: &Device, name: &str, data: &[u32]) -> Buffer {
    let made = buffer(device, name, 4 * data.len() as u64, Location::GpuOnly);
    device.upload(&made, 0, bytemuck::cast_slice(data)).unwrap();
    made
}

fn read(device: &Device, buffer: &Buffer, count: usize) -> Vec<u32> {
    let bytes = device.download_range(buffer, 0, 4 * count as u64).unwrap();
    bytes
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes(word.try_into().unwrap()))
        .collect()
}

/// Records, submits and waits.
fn record(device: &Device, timer: Option<&mut Timer>, passes: impl FnOnce(&mut Recorder<'_>)) {
    let done = device.submit_and_wait(|cmd| {
        // SAFETY: `cmd` is recording on `device`, and the passes use only what outlives this call, which waits.
        passes(&mut unsafe { Recorder::begin(device, cmd, Draws::Around, timer) });
        Ok(())
    });
    done.unwrap();
}

fn add(device: &Device, factor: u32, bindings: Bindings) -> ComputePipeline {
    let desc = ComputeDesc {
        name: "add",
        shader: &ADD,
        constants: &[(0, factor)],
        bindings,
    };
    ComputePipeline::new(device, &desc).unwrap()
}
