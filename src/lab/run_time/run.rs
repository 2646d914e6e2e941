//! What the sections share.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::Command;

use rara::{Headless, HeadlessDesc, Mode, Raster, Result, Settings};

use super::numbers::Measurements;
use super::world::World;
use crate::table::Table;

#[derive(Debug, Clone, Default)]
pub struct RunTimeOptions {
    /// The names of the sections; all if empty. `correct` is measured in any case, but for `unchecked`.
    pub sections: Vec<String>,
    /// Leaves out `correct` where other sections are named.
    pub unchecked: bool,
    /// Tiny scenes and one round: only whether everything runs.
    pub quick: bool,
    /// Scene files in place of generated scenes.
    pub scenes: Vec<PathBuf>,
    /// The cameras that frames of these scenes take in turn; without a file an orbit.
    pub cameras: Option<PathBuf>,
    /// How many Gaussians generated scenes have; each section's own if empty.
    pub gaussians: Vec<u32>,
    /// Widths of pictures; sections other than `passes` take the first.
    pub sizes: Vec<u32>,
    pub rounds: Option<u32>,
    /// Folders of SPIR-V modules, each a variant of the shaders, which section `full-hd` measures beside the program's own.
    pub modules: Vec<PathBuf>,
    pub device: HeadlessDesc,
}

impl RunTimeOptions {
    /// The pictures' width outside of `passes`.
    pub(super) fn size(&self) -> u32 {
        let usual = if self.quick { 64 } else { 1024 };
        self.sizes.first().copied().unwrap_or(usual)
    }
}

pub trait Program {
    /// Hears what is done now.
    fn hear(&mut self, what: &str);
    /// Takes a table for people, and all numbers so far, a row each.
    fn take(&mut self, table: &Table, all: &Table) -> Result<()>;
    /// The program itself, to do what [`start`](super::start) does with a scene file and pictures of this width.
    fn start(&self, scene: &Path, width: u32) -> Result<Command>;
    /// Fails where this machine has no memory for so many Gaussians and a renderer of them.
    fn check_room(&self, gaussians: u64) -> Result<()>;
}

/// What the sections share.
pub(super) struct Run<'a> {
    pub(super) options: &'a RunTimeOptions,
    pub(super) program: &'a mut dyn Program,
    pub(super) device: [String; 2],
    pub(super) all: Table,
    /// Names of ways of drawing whose pictures are wrong.
    pub(super) wrong: Vec<String>,
    pub(super) folder: PathBuf,
}

impl Run<'_> {
    pub(super) fn rounds(&self) -> RangeInclusive<u32> {
        let usual = if self.options.quick { 1 } else { 9 };
        let most = self.options.rounds.unwrap_or(usual);
        most.min(3)..=most
    }

    /// A device that holds the scene as frames of default settings want it.
    pub(super) fn headless(&self, world: &World) -> Result<Headless> {
        let mut headless = Headless::new(&self.options.device)?;
        headless.load_as(&world.scene, Settings::default().precision.sh)?;
        Ok(headless)
    }

    /// True where a mode may be timed on a raster path.
    pub(super) fn allows(&mut self, mode: &str, raster: &str) -> bool {
        let name = format!("{mode} {raster}");
        let allowed = !self.wrong.contains(&name);
        if !allowed {
            self.program
                .hear(&format!("{name}: not timed: it is wrong"));
        }
        allowed
    }

    /// Numbers are complete.
    pub(super) fn finish(&mut self, numbers: &Measurements) -> Result<()> {
        self.all.rows.extend(numbers.rows(&self.device));
        self.program.take(&numbers.table(), &self.all)
    }
}

/// The raster paths that a device has, without the choice between them.
pub(super) fn rasters(headless: &Headless) -> Vec<(&'static str, Raster)> {
    let mut rasters = vec![("tiles", Raster::Tiles), ("quad", Raster::Quad)];
    if headless.device().support().mesh_shader {
        rasters.push(("mesh", Raster::Mesh));
    }
    rasters
}

pub(super) fn in_mode(mode: Mode) -> Settings {
    Settings::default().mode(mode)
}
