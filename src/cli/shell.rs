//! `rara completions` and `rara man`: what shells and `man` know of the program.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;

use super::failure::Failure;
use super::{output, values};

/// Print a completion script for a shell
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  PROGRAM completions bash > ~/.local/share/bash-completion/completions/PROGRAM
  PROGRAM completions zsh > ~/.zfunc/_PROGRAM")]
pub(super) struct Completions {
    /// The shell that reads the script
    shell: Shell,
}

impl Completions {
    pub(super) fn run(self, mut command: Command) -> Result<(), Failure> {
        let mut script = Vec::new();
        let program = command.get_name().to_owned();
        clap_complete::generate(self.shell, &mut command, program, &mut script);
        Ok(output::answer(&String::from_utf8_lossy(&script))?)
    }
}

/// Print the manual page, or write a page for each command
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  PROGRAM man | man -l -
  PROGRAM man -o ~/.local/share/man/man1")]
pub(super) struct Man {
    /// Folder for the program's page and a page for each command; created if it does not exist
    #[arg(short, long, value_name = "DIR", value_parser = values::one_file())]
    output: Option<PathBuf>,
}

impl Man {
    pub(super) fn run(self, mut command: Command) -> Result<(), Failure> {
        command.build();
        let page = |command: Command| {
            let mut page = Vec::new();
            let rendered = clap_mangen::Man::new(command).render(&mut page);
            rendered.map_err(rara::Error::io("the manual page"))?;
            Ok::<_, rara::Error>(String::from_utf8_lossy(&page).into_owned())
        };
        let Some(folder) = &self.output else {
            return Ok(output::answer(&page(command)?)?);
        };
        output::make_folder(folder)?;
        let program = command.get_name().to_owned();
        let parts = command
            .get_subcommands()
            .filter(|part| part.get_name() != "help");
        for part in parts.cloned() {
            let name = format!("{program}-{}.1", part.get_name());
            output::text(&folder.join(name), &page(part)?)?;
        }
        output::text(&folder.join(format!("{program}.1")), &page(command)?)?;
        output::say(format_args!(
            "wrote the manual pages to {}",
            folder.display()
        ));
        Ok(())
    }
}
