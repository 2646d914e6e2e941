//! The flags that say how a frame is drawn, and on which device.

use clap::error::Result;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use rara::{
    Headless, HeadlessDesc, PipelineCache, Precision, Preset, Setting, SettingKind, Settings,
};

use super::values::{self, named};
use super::{output, process};

/// How to draw: all settings, or [`LookArgs`]. Their flags are the rows of the library's tables.
#[derive(Debug, Clone, Default)]
pub struct SettingsArgs<const CUTS: bool = true>(Settings);

/// The settings that have nothing to do with clipping.
pub type LookArgs = SettingsArgs<false>;

impl<const CUTS: bool> SettingsArgs<CUTS> {
    pub fn meant(&self) -> Settings {
        self.0
    }

    fn fields() -> impl Iterator<Item = &'static Setting<Settings>> {
        Settings::ALL.iter().filter(|setting| match setting.kind {
            SettingKind::Cut => CUTS,
            SettingKind::Look => true,
            _ => false,
        })
    }
}

/// The name of a flag among those of a command.
fn id(name: &str) -> String {
    name.replace('-', "_")
}

/// A flag with the help that a documentation's text is.
fn described(name: &'static str, heading: &'static str, about: &str) -> Arg {
    let (short, long) = values::help(about);
    let arg = Arg::new(id(name)).long(name).help_heading(heading);
    let arg = arg.help(short);
    match long {
        Some(long) => arg.long_help(long),
        None => arg,
    }
}

/// The flag of a setting. `usual` is a value that it has by itself.
fn arg<S: Default + 'static>(
    setting: &'static Setting<S>,
    heading: &'static str,
    usual: Option<String>,
) -> Arg {
    let arg = described(setting.name, heading, setting.about);
    if setting.value.is_empty() {
        return arg.action(ArgAction::SetTrue);
    }
    let arg = arg.value_name(setting.value);
    let arg = match usual {
        Some(usual) => arg.default_value(usual),
        None => arg,
    };
    if !setting.choices.is_empty() {
        return arg.value_parser(values::choices(setting.choices));
    }
    let check = move |text: &str| setting.check(text).map(|()| text.to_owned());
    arg.allow_hyphen_values(true).value_parser(check)
}

/// Sets what the flags of these settings say.
fn set<S: 'static>(
    settings: &mut S,
    fields: impl Iterator<Item = &'static Setting<S>>,
    given: &ArgMatches,
) -> Result<()> {
    for setting in fields {
        let text = match setting.value.is_empty() {
            true => Some(given.get_flag(&id(setting.name)).to_string()),
            false => given.get_one::<String>(&id(setting.name)).cloned(),
        };
        if let Some(text) = text {
            let set = setting.read(settings, &text);
            set.map_err(|error| clap::Error::raw(clap::error::ErrorKind::ValueValidation, error))?;
        }
    }
    Ok(())
}

impl<const CUTS: bool> Args for SettingsArgs<CUTS> {
    fn augment_args(command: Command) -> Command {
        let usual = Settings::default();
        let own = Self::fields().map(|setting| arg(setting, "Drawing", setting.text(&usual)));
        let about = "Set all precision flags below at once; a flag that is also given keeps its own value.\n\n\
                     The guide (src/guide/modes.md) says what each preset costs and how exact it is.";
        let preset = described("preset", "Precision", about)
            .value_name("PRESET")
            .value_parser(named::<Preset>())
            .default_value(Preset::default().name());
        let precise = Precision::ALL.iter();
        command
            .args(own)
            .arg(preset)
            .args(precise.map(|setting| arg(setting, "Precision", None)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<const CUTS: bool> FromArgMatches for SettingsArgs<CUTS> {
    fn from_arg_matches(given: &ArgMatches) -> Result<Self> {
        let mut made = Self::default();
        made.update_from_arg_matches(given)?;
        Ok(made)
    }

    fn update_from_arg_matches(&mut self, given: &ArgMatches) -> Result<()> {
        let preset = given.get_one::<Preset>("preset").copied();
        self.0.precision = preset.unwrap_or_default().precision();
        set(&mut self.0, Self::fields(), given)?;
        set(&mut self.0.precision, Precision::ALL.iter(), given)
    }
}

/// The flags of the fields that differ from `usual`, as a user would type them.
#[cfg(feature = "view")]
fn differences<S: 'static>(
    own: &S,
    usual: &S,
    fields: impl Iterator<Item = &'static Setting<S>>,
) -> Vec<String> {
    let changed = fields.filter(|setting| setting.text(own) != setting.text(usual));
    let flag = |setting: &Setting<S>| match setting.text(own) {
        Some(text) if !setting.value.is_empty() => format!("--{} {text}", setting.name),
        _ => format!("--{}", setting.name),
    };
    changed.map(flag).collect()
}

/// The flags of the settings that are not the default, as a user would type them; the mode always. The preset is the one that
/// leaves the fewest single flags.
#[cfg(feature = "view")]
pub(super) fn flags(own: &Settings) -> Vec<String> {
    let others = SettingsArgs::<true>::fields().filter(|setting| setting.name != "mode");
    let mut flags = vec![format!("--mode {}", own.mode)];
    flags.extend(differences(own, &Settings::default(), others));
    let written = |preset: &Preset| {
        let mut flags = Vec::new();
        if *preset != Preset::default() {
            flags.push(format!("--preset {preset}"));
        }
        let (own, usual) = (own.precision, preset.precision());
        flags.extend(differences(&own, &usual, Precision::ALL.iter()));
        flags
    };
    // The default comes first, which is taken of several that leave as few.
    let usual = [Preset::default()];
    let presets = usual.iter().chain(Preset::ALL);
    flags.extend(
        presets
            .map(written)
            .min_by_key(Vec::len)
            .into_iter()
            .flatten(),
    );
    flags
}

/// Which device, and how closely it is watched.
#[derive(Debug, Args)]
#[command(next_help_heading = "Device")]
pub struct DeviceArgs {
    /// Device: its number or a part of its name, as rara devices lists them
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
    /// Load the Vulkan validation layer, and fail if it reports anything
    ///
    /// The layer also checks synchronisation.
    #[arg(long)]
    validation: bool,
    /// Compile all shaders again, and do not store them for the next run
    ///
    /// Without this flag, rara stores compiled pipelines in the folder that the environment variable RARA_CACHE names, or in
    /// the user's cache folder if RARA_CACHE is not set. If RARA_CACHE is empty, rara stores nothing. This flag does not
    /// affect the cache that a driver may have.
    #[arg(long)]
    no_pipeline_cache: bool,
}

impl DeviceArgs {
    pub fn headless(&self) -> rara::Result<Headless> {
        process::make_drivers_folder();
        Headless::new(&self.meant())
    }

    pub fn meant(&self) -> HeadlessDesc {
        HeadlessDesc::default()
            .device(self.device.clone())
            .validation(self.validation)
            .on_compile(Some(output::Compiling::hook()))
            .pipeline_cache(if self.no_pipeline_cache {
                PipelineCache::Off
            } else {
                PipelineCache::User
            })
    }
}
