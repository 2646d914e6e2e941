//! `rara completions` and `rara man`: what shells and `man` know of the program.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

use super::failure::Failure;
use super::{help, output};

/// Print the completions of a shell
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara completions bash > ~/.local/share/bash-completion/completions/rara
  rara completions zsh > ~/.zfunc/_rara")]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub(super) fn run(self) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut help::command(), "rara", &mut script);
        Ok(output::answer(&String::from_utf8_lossy(&script))?)
    }
}

/// Print the manual page, or write one for each command
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara man | man -l -
  rara man -o ~/.local/share/man/man1")]
pub(super) struct Man {
    /// Folder for the pages, rara.1 and one for each command; made unless it is there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

impl Man {
    pub(super) fn run(self) -> Result<(), Failure> {
        let mut command = help::command();
        command.build();
        let page = |command: clap::Command| {
            let mut page = Vec::new();
            let rendered = clap_mangen::Man::new(command).render(&mut page);
            rendered.map_err(rara::Error::io("the manual page"))?;
            Ok::<_, rara::Error>(String::from_utf8_lossy(&page).into_owned())
        };
        let Some(folder) = &self.output else {
            return Ok(output::answer(&page(command)?)?);
        };
        output::make_folder(folder)?;
        let parts = command
            .get_subcommands()
            .filter(|part| part.get_name() != "help");
        for part in parts.cloned() {
            let name = format!("rara-{}", part.get_name());
            let text = page(part)?;
            output::text(&folder.join(format!("{name}.1")), &text)?;
        }
        output::text(&folder.join("rara.1"), &page(command.clone())?)?;
        output::say(format_args!(
            "wrote the manual pages to {}",
            folder.display()
        ));
        Ok(())
    }
}
