//! `rara devices`: which Vulkan devices there are, and which of them will do.

use clap::Args;
use rara::Error;
use serde::Serialize;

use super::failure::Failure;
use super::output;
use rara::gpu::list_devices;

/// List the Vulkan devices, and say why rara cannot use some of them
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara devices
  rara render scene.ply -o picture.png --device 1")]
pub(super) struct Devices {
    /// Print the list as JSON to standard output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct DeviceRow {
    number: usize,
    name: String,
    driver: String,
    kind: &'static str,
    supported: bool,
    problem: Option<String>,
}

impl Devices {
    pub(super) fn run(self) -> Result<(), Failure> {
        let list = list_devices()?
            .into_iter()
            .enumerate()
            .map(|(number, device)| DeviceRow {
                number,
                kind: device.kind_name(),
                name: device.name,
                driver: device.driver,
                supported: device.support.is_ok(),
                problem: device.support.err(),
            });
        let list: Vec<DeviceRow> = list.collect();
        if self.json {
            return Ok(output::json(&list)?);
        }
        if list.is_empty() {
            let message = "there is no Vulkan device; install a driver (tools/setup installs lavapipe, which needs no GPU)";
            return Err(Error::Device(message.into()).into());
        }
        let mut lines = Vec::new();
        for DeviceRow {
            number,
            name,
            driver,
            kind,
            problem,
            ..
        } in list
        {
            lines.push(format!("{number}  {name} ({kind}; {driver})"));
            if let Some(problem) = problem {
                lines.push(format!("   will not do: {problem}"));
            }
        }
        Ok(output::answer(&lines.join("\n"))?)
    }
}
