//! `valet config`: the default settings, and the check of a file.

use super::exit::Failure;
use super::output::Output;
use crate::config::{LoadedProfile, Places, Settings};
use crate::snapshot::Watermark;
use std::path::PathBuf;

/// The configuration: print the default one, check a file.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// Print the default settings as a file.
    #[arg(long)]
    print_default: bool,
    /// Check a file of settings (the one that would be used, where none is named) and the profile that it names.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    #[expect(clippy::option_option, reason = "an option that may stand without its value, as clap tells it")]
    check: Option<Option<PathBuf>>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(false);
    if arguments.print_default {
        return output.line(Settings::print_default().map_err(Failure::Fault)?.trim_end());
    }
    let places = Places::of_this_machine();
    let given = arguments.check.clone().flatten();
    let settings = Settings::find(given.as_deref(), &places).map_err(Failure::configuration)?;
    let found = given.or_else(|| places.settings.iter().find(|path| path.is_file()).cloned());
    let profile = LoadedProfile::find(settings.profile(), &places).map_err(Failure::configuration)?;
    settings.setup_for(&profile, 0, Watermark::Live).map_err(Failure::configuration)?;
    output.line(
        found.map_or("settings: the built-in defaults".to_owned(), |path| format!("settings: {}", path.display())),
    )?;
    for path in &places.settings {
        output.line(format!("  looked for at {}", path.display()))?;
    }
    output.line(format!("profile: {} ({}, {})", settings.profile(), profile.path.display(), profile.short_hash()))?;
    output.line(format!("  looked for in {}", places.profile_folders()))?;
    output.line(format!("trials: {}", places.trials.display()))?;
    output.line("everything can be used")
}
