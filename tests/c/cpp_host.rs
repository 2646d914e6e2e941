//! `tools/examples/host.cpp` is compiled, linked with the shared and with the static library, and run under validation:
//! its splats are the headless picture, and a mesh among them hides some and not others.

use std::env;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::compiler::{compiler, libraries, root, run, run_host};
use crate::folder::Folder;
use crate::header::HEADER;
use rara::glam::DVec3;
use rara::scene::{Bounds, Kind, generate, save_ply};
use rara::{
    Camera, Clip, ClipOp, Gaussians, Headless, HeadlessDesc, PipelineCache, Plane, Raster,
    Settings, ShFormat,
};

const SIZE: (u32, u32) = (480, 360);

fn compile(compiler: &str, out: PathBuf, library: &[&str]) -> PathBuf {
    let warnings = [
        "-Wall",
        "-Wextra",
        "-Wno-missing-field-initializers",
        "-Werror",
    ];
    let mut command = Command::new(compiler);
    command
        .args(["-std=c++17", "-O1"])
        .args(warnings)
        .arg("-I")
        .arg(HEADER)
        .arg(root().join("tools/examples/host.cpp"))
        .arg("-o")
        .arg(&out)
        .args(library)
        .args(["-lvulkan", "-lpthread", "-ldl", "-lm"]);
    let says = "host.cpp does not compile (tools/setup test installs the Vulkan headers)";
    run(&mut command, says);
    out
}

/// The picture that the host draws of some words; it must report no problem.
fn draw(host: &Path, device: &str, scene: &Path, what: &str) -> Vec<u8> {
    let picture = host.with_extension(format!("{}.ppm", what.replace(' ', "-")));
    let mut host = Command::new(host);
    let printed = run_host(host.args([scene, &picture]).args(what.split(' ')), device);
    assert!(
        printed.contains(" visible, ") && printed.contains(" tiles "), // which are the fast way
        "{printed}"
    );
    let bytes = std::fs::read(&picture).expect("a picture");
    let header = format!("P6 {} {} 255\n", SIZE.0, SIZE.1);
    let pixels = bytes.strip_prefix(header.as_bytes()).expect("a PPM");
    assert_eq!(pixels.len(), 3 * (SIZE.0 * SIZE.1) as usize);
    pixels.to_vec()
}

/// The frames of the host without a mesh, one eye's and that of two eyes, and the name of the device that has drawn them.
fn truth(scene: &Gaussians) -> ([Vec<u8>; 2], String) {
    let mut headless = Headless::new(
        &HeadlessDesc::default()
            .device(env::var("RARA_TEST_DEVICE").ok())
            .validation(true)
            .bindings(None)
            .pipeline_cache(PipelineCache::Off),
    )
    .expect("a Vulkan device and the validation layer (tools/test installs both)");
    let bounds = Bounds::of(scene);
    let camera = |size| Camera::frame(&bounds, -DVec3::Y, 50.0, size).expect("a view");
    let normal = DVec3::new(-0.28, 0.0, 0.96);
    let centre = bounds.centre();
    let clip = Clip::of(
        [Plane::new(normal, -normal.dot(centre)).expect("a normal")],
        ClipOp::And,
    );
    let settings = Settings::default().raster(Raster::Tiles);
    headless.load_as(scene, ShFormat::Packed).expect("uploads");
    let mut draw = |camera: &Camera| {
        headless.render(camera, &clip, &settings).expect("renders");
        headless.picture().expect("reads back").pixels
    };
    let level = |v: f32| (255.0 * v.clamp(0.0, 1.0)).round() as u8;
    let one = draw(&camera(SIZE));
    let one = one.iter().flat_map(|pixel| pixel[..3].to_vec());
    let one = one.map(level).collect();

    let half = (SIZE.0 / 2, SIZE.1);
    let middle = camera(half);
    let size = (bounds.max - bounds.min).max_element();
    let aside = middle.rotation.transpose() * DVec3::X * (0.02 * size);
    let eyes = [-1.0, 1.0].map(|side| {
        let eye = middle.eye(middle.eye + side * aside);
        draw(&eye.cx(eye.cx + 0.25).cy(eye.cy - 0.375))
    });
    let [left, right] = eyes.each_ref().map(|eye| eye.chunks(half.0 as usize));
    let rows = left.zip(right).flat_map(|(left, right)| [left, right]);
    let two = rows.flatten().flat_map(|[r, g, b, alpha]| {
        let light = |stored| alpha * rara_scene::picture::linear_light(stored / alpha.max(1e-30));
        [r, g, b].map(|stored| level(light(*stored)))
    });
    let two = two.collect();
    ([one, two], headless.device().info().name.clone())
}

/// Asserts that pictures differ by rounding alone.
fn assert_alike(drawn: &[u8], truth: &[u8]) {
    let differences = drawn.iter().zip(truth).map(|(a, b)| a.abs_diff(*b));
    assert!(differences.max() <= Some(1), "the headless picture");
    let same = drawn.iter().zip(truth).filter(|(a, b)| a == b).count();
    let apart = drawn.len() - same;
    eprintln!("{apart} of {} bytes are off by one", drawn.len());
}

#[test]
fn a_host_in_cpp_draws_splats_and_a_mesh() {
    let Some(compiler) = compiler("rara.h was not tried from C++") else {
        return;
    };
    let scene = generate(Kind::Layers, 20_000, 2);
    let own = Folder::new("c-host");
    let path = own.join("scene.ply");
    save_ply(&path, &scene).expect("a temporary file");
    // The scene as loaded, since a file has opacities and scales in another form.
    let scene = rara::scene::load(&path, &mut |_, _| ())
        .expect("loads")
        .gaussians;
    let ([truth, truth_of_eyes], device) = truth(&scene);

    let folder = libraries();
    let shared = folder.join(format!("{DLL_PREFIX}rara_c{DLL_SUFFIX}"));
    let archive = folder.join("librara_c.a");
    // Where the program looks for it, by the name that it has when it is installed.
    let named = own.join(format!("librara.so.{}", rara_c::boundary::RARA_ABI_VERSION));
    std::os::unix::fs::symlink(&shared, named).expect("a link");
    let rpath = format!("-Wl,-rpath,{}", own.display());
    let shared = shared.to_str().expect("UTF-8");
    let shared = compile(&compiler, own.join("shared"), &[shared, &rpath]);
    let archive = archive.to_str().expect("UTF-8");
    let archive = compile(&compiler, own.join("static"), &[archive]);

    let splats = draw(&shared, &device, &path, "splats");
    assert_alike(&splats, &truth);

    let mesh = draw(&shared, &device, &path, "mesh");
    let both = draw(&shared, &device, &path, "both");
    assert!(
        draw(&archive, &device, &path, "both") == both,
        "linked statically"
    );
    let (mut outside, mut hidden, mut before) = (0, 0, 0);
    let pixels = mesh.chunks(3).zip(splats.chunks(3)).zip(both.chunks(3));
    for ((mesh, splats), both) in pixels {
        if mesh == [0; 3] {
            // Tiles end a column of pixels when all of them are saturated, which those that the mesh covers hardly are.
            let apart = both.iter().zip(splats).map(|(a, b)| a.abs_diff(*b));
            assert!(
                apart.max() <= Some(1),
                "beside the mesh all splats are there: {both:?} for {splats:?}"
            );
            outside += 1;
        } else if mesh == both {
            hidden += usize::from(splats != [0; 3]);
        } else {
            before += 1;
        }
    }
    eprintln!(
        "{outside} pixels beside the mesh, {hidden} hidden by it, {before} with splats before it"
    );
    assert!(hidden > 1000 && before > 200);

    // Where a mesh comes after the splats of two eyes, it is hidden by the depths that they have written.
    let [splats, mesh, both] =
        ["splats eyes", "mesh eyes", "both eyes"].map(|what| draw(&shared, &device, &path, what));
    assert_alike(&splats, &truth_of_eyes);
    let (mut shown, mut hidden) = (0, 0);
    let pixels = mesh.chunks(3).zip(splats.chunks(3)).zip(both.chunks(3));
    for ((mesh, splats), both) in pixels {
        let covered = mesh != [0; 3];
        assert!(both == splats || (covered && both == mesh));
        shown += usize::from(covered && both == mesh && both != splats);
        hidden += usize::from(covered && both != mesh);
    }
    eprintln!("{shown} pixels of two eyes show the mesh, in {hidden} splats hide it");
    assert!(shown > 1000 && hidden > 200);
}
