//! rara in a host on wgpu: cargo run --release [-- [--device NAME] [OUT.png | --check | --check-careless]]
//!
//! `host.rs` opens a device of wgpu's with what rara needs and lends it, `meshes.rs` draws by wgpu alone, `splats.rs` is
//! rara's part of a frame. `--check` compares pictures with the headless ones, under the validation layer.

mod check;
mod host;
mod meshes;
mod messages;
mod splats;
mod target;
mod world;

use std::fs::File;
use std::io::BufWriter;
use std::process::ExitCode;

use half::f16;
use host::Host;
use meshes::Meshes;
use rara::scene::{Kind, generate};
use splats::{Eye, Splats};
use target::Target;
use world::World;

/// Whatever goes wrong ends the example.
pub(crate) type Failure = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    match run(std::env::args().skip(1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            ExitCode::FAILURE
        }
    }
}

fn run(mut args: impl Iterator<Item = String>) -> Result<(), Failure> {
    let (mut device, mut what) = (String::new(), "wgpu.png".to_owned());
    while let Some(arg) = args.next() {
        match &*arg {
            "--device" => device = args.next().ok_or("--device needs part of a name")?,
            _ => what = arg,
        }
    }
    match &*what {
        "--check" => check::check(&device),
        "--check-careless" => check::careless(&device),
        other if other.starts_with("--") => Err(format!("there is no {other}").into()),
        path => picture(&device, path),
    }
}

/// Draws a few frames, and writes the last as a PNG file.
fn picture(device: &str, path: &str) -> Result<(), Failure> {
    let host = Host::new(device, false)?;
    let world = World::new(generate(Kind::Layers, 50_000, 1), (640, 480))?;
    let format = wgpu::TextureFormat::Rgba16Float;
    let target = Target::new(&host, format, world.size);
    let meshes = Meshes::new(&host, format, world.furniture());
    let mut splats = Splats::new(&host, &world.scene, format, &world.view, 1)?;
    let eye = Eye {
        meshes: &meshes,
        target: &target,
        camera: world.view.camera,
    };
    for _ in 0..8 {
        splats.frame(&host, std::slice::from_ref(&eye), &world.view, true)?;
    }
    let bytes = target.bytes(&host)?;
    let halves = bytes.chunks_exact(2);
    let levels = halves.map(|half| {
        let value = f16::from_le_bytes([half[0], half[1]]).to_f32();
        (value.clamp(0.0, 1.0) * 255.0).round() as u8
    });
    let levels: Vec<u8> = levels.collect();

    let (width, height) = world.size;
    let mut png = png::Encoder::new(BufWriter::new(File::create(path)?), width, height);
    png.set_color(png::ColorType::Rgba);
    png.set_depth(png::BitDepth::Eight);
    png.write_header()?.write_image_data(&levels)?;
    Ok(())
}
