//! What RADV, Mesa's driver for AMD's GPUs, makes of every pipeline, on GPUs that are pretended.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::{env, fs};

use rara_gpu::{CompiledShader, DeviceDesc, DeviceShape};

use crate::common::folder::Folder;
use crate::gpu_cost::budget::{self, Numbers, Rule, Table};
use crate::gpu_cost::frames::{Frames, LARGE, SMALL};
use crate::spirv;

/// Generations of AMD's GPUs, by the names that Mesa gives them: RDNA 2 and 3, with subgroups of 32 and of 64, and GCN, with
/// 64 alone.
const GPUS: [&str; 3] = ["navi21", "navi31", "vega10"];

/// Where a child process writes what it has found.
const OUT: &str = "RARA_GPU_COST_OUT";

/// Our names of numbers, and the driver's names of those that are added up.
const NUMBERS: [(&str, &[&str]); 5] = [
    ("registers", &["VGPRs"]),
    ("spilled", &["Spilled VGPRs", "Spilled SGPRs"]),
    ("scratch", &["Scratch size"]),
    ("lds", &["LDS size"]),
    ("code", &["Code size"]),
];

#[test]
fn pipelines_take_no_more_of_a_gpu_than_budgeted() {
    let driver = match Driver::find() {
        Ok(driver) => driver,
        Err(reason) => {
            eprintln!(
                "SKIPPED: NO GPU'S COMPILER SAW THE PIPELINES: {reason}; tools/setup test installs it"
            );
            return;
        }
    };
    let folder = Folder::new("gpu_cost");
    let test = "gpu_cost::pipelines::of_the_device_that_is_pretended";
    let children = GPUS.map(|gpu| (gpu, driver.start(gpu, test, &folder.join(gpu))));
    let mut found = BTreeMap::new();
    for (gpu, child) in children {
        let output = child.wait_with_output().expect("the child process ends");
        assert!(
            output.status.success(),
            "{gpu}: {}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        let lines = fs::read_to_string(folder.join(gpu)).expect("what the child has found");
        let table: Table = lines.lines().map(read).collect();
        assert!(table.len() > 50, "{gpu}: only {} shaders", table.len());
        found.insert(format!("pipelines.{gpu}"), table);
    }
    budget::check(found, Rule::CompilersCeiling);
}

/// The driver, and the library that pretends there is a GPU.
struct Driver {
    shim: PathBuf,
    description: PathBuf,
}

impl Driver {
    /// Where Debian puts them.
    fn find() -> Result<Self, String> {
        let libraries = format!("/usr/lib/{}-linux-gnu", env::consts::ARCH);
        let shim = Path::new(&libraries).join("libamdgpu_noop_drm_shim.so");
        if !shim.exists() {
            return Err(format!(
                "there is no {} (package mesa-drm-shim)",
                shim.display()
            ));
        }
        let folder = "/usr/share/vulkan/icd.d";
        let files = fs::read_dir(folder).map_err(|error| format!("{folder}: {error}"))?;
        let mut descriptions: Vec<_> = files.filter_map(|file| Some(file.ok()?.path())).collect();
        descriptions.sort();
        let is_radv = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("radeon_icd")
        };
        let description = descriptions.into_iter().find(is_radv);
        let description = description.ok_or(format!("{folder} has no radeon_icd*.json"))?;
        Ok(Self { shim, description })
    }

    /// Starts a test of this executable once more, on a device of that kind.
    fn start(&self, gpu: &str, test: &str, out: &Path) -> Child {
        let mut command = Command::new(env::current_exe().expect("this executable"));
        command
            .args(["--exact", test, "--ignored", "--nocapture"])
            .env("LD_PRELOAD", &self.shim)
            .env("AMDGPU_GPU_ID", gpu)
            .env("VK_DRIVER_FILES", &self.description)
            // What is found in a cache is not compiled, and says nothing about itself.
            .env("MESA_SHADER_CACHE_DISABLE", "true")
            .env(OUT, out)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        for other in [
            "RARA_SHAPE",
            "RADV_DEBUG",
            "RADV_PERFTEST",
            "VK_ICD_FILENAMES",
        ] {
            command.env_remove(other);
        }
        command.spawn().expect("this executable starts")
    }
}

/// Makes the pipelines of every kind of frame on whatever device there is, and writes what they are compiled to.
#[test]
#[ignore = "another test starts this one for each GPU that is pretended"]
fn of_the_device_that_is_pretended() {
    let out = env::var_os(OUT).expect("the test that starts this one names a file");
    let mut table = Table::new();
    let mut add = |frames: &Frames| {
        for shader in frames.device.compiled_shaders() {
            let has = numbers(&shader);
            let most = table.entry(name(&shader)).or_insert_with(|| has.clone());
            // Pipelines that differ in their attachments alone have one name.
            for (most, has) in most.iter_mut().zip(has) {
                most.1 = most.1.max(has.1);
            }
        }
    };
    let frames = Frames::on(&DeviceDesc::default(), SMALL);
    let driver = &frames.device.info().driver;
    assert!(driver.contains("radv"), "{driver}");
    let all = frames.all();
    for frame in &all {
        frames.draw(frame);
    }
    add(&frames);
    let large = Frames::on(&DeviceDesc::default(), LARGE);
    large.draw(&all[0]);
    add(&large);
    // Where no subgroups can be asked for there are other pipelines, whatever the frame.
    let shape = DeviceShape::Gpu { subgroup: 0 };
    let without = Frames::on(&DeviceDesc::default().shape(Some(shape)), SMALL);
    without.draw(&all[0]);
    add(&without);
    let lines = table.iter().map(|(name, numbers)| line(name, numbers));
    fs::write(out, lines.collect::<String>()).expect("the file is writable");
}

/// A shader's file, and the constants of its pipeline that it declares and that are not 0.
fn name(shader: &CompiledShader) -> String {
    let declared = declarations(&shader.file).constants;
    let mut name = shader.file.clone();
    for constant in declared {
        let value = shader.constants.iter().find(|(id, _)| *id == constant.id);
        if let Some((_, value)) = value.filter(|(_, value)| *value != 0) {
            name += &format!(" {}={value}", constant.name);
        }
    }
    name
}

/// What a shader declares.
fn declarations(file: &str) -> spirv::Declarations {
    let modules = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl/spirv");
    let bytes = fs::read(modules.join(format!("{file}.bound.spv"))).expect("a committed module");
    spirv::declarations(&bytemuck::pod_collect_to_vec::<u8, u32>(&bytes))
}

fn numbers(shader: &CompiledShader) -> Numbers {
    let asked = shader.asked_subgroup;
    assert!(
        asked == 0 || shader.subgroup == asked,
        "{}: subgroups of {} where {asked} was asked for",
        shader.file,
        shader.subgroup
    );
    let number = |driver: &str| {
        let found = shader.numbers.iter().find(|(name, _)| name == driver);
        let found = found
            .unwrap_or_else(|| panic!("{}: no {driver} among {:?}", shader.file, shader.numbers));
        found.1
    };
    let of_driver = NUMBERS.map(|(name, driver)| (name, driver.iter().copied().map(number).sum()));
    of_driver
        .into_iter()
        .chain([("asked", u64::from(asked))])
        .collect()
}

/// A shader's line between the processes: its name, and its numbers in order.
fn line(name: &str, numbers: &Numbers) -> String {
    let numbers: Vec<_> = numbers.iter().map(|(_, value)| value.to_string()).collect();
    format!("{name}|{}\n", numbers.join(" "))
}

fn read(line: &str) -> (String, Numbers) {
    let (name, values) = line.split_once('|').expect("a name and numbers");
    let names = NUMBERS.iter().map(|(name, _)| *name).chain(["asked"]);
    let values = values
        .split(' ')
        .map(|value| value.parse().expect("a number"));
    (name.to_owned(), names.zip(values).collect())
}
