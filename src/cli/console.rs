//! `valet console`: the operator console on a ROS graph.

use super::exit::Failure;
use super::key::KeyArguments;
use super::output::Output;
use super::recording::RecordArguments;
use super::session::{Opening, Session};
use crate::config::{LoadedProfile, Places, Settings};
use crate::console::{ConsoleOptions, ExitReason};
use crate::snapshot::{Snapshot, Watermark};
use crate::strategy::StrategyKind;
use crate::supervisor::Setup;
use std::path::{Path, PathBuf};

/// The operator console on a ROS graph.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// The person: a name or a file.
    #[arg(long)]
    profile: Option<String>,
    /// The strategy that a trial begins with.
    #[arg(long)]
    strategy: Option<String>,
    /// Seed of everything random; it is recorded.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Another file of settings than the one that is found.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    #[command(flatten)]
    record: RecordArguments,
    #[command(flatten)]
    key: KeyArguments,
    /// Begin with the paths that earlier trials of this person learned.
    #[arg(long)]
    warm_start: bool,
    /// Decide everything, command nothing.
    #[arg(long)]
    dry_run: bool,
    /// Show the trial of a node that runs already: this screen can stop it and do nothing else.
    #[arg(long, value_name = "NODE", num_args = 0..=1, default_missing_value = "/valet",
          conflicts_with_all = ["profile", "strategy", "seed", "dry_run"])]
    watch: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let places = Places::of_this_machine();
    let settings = Settings::find(arguments.config.as_deref(), &places).map_err(Failure::configuration)?;
    if let Some(node) = &arguments.watch {
        return super::watch::run(node, settings.console());
    }
    let name = arguments.profile.as_deref().unwrap_or_else(|| settings.profile());
    let key = arguments.key.given()?;
    let person = LoadedProfile::find_with(name, &places, key.as_ref()).map_err(Failure::configuration)?;
    let watermark = if arguments.dry_run { Watermark::DryRun } else { Watermark::Live };
    let mut setup = settings.setup_for(&person, arguments.seed, watermark).map_err(Failure::configuration)?;
    choose_strategy(&mut setup, arguments.strategy.as_deref())?;
    setup.settings.warm_start |= arguments.warm_start;
    let recording = arguments.record.of_trials(&places.trials, settings.recording());
    let session = Session::open(Opening { setup, person: &person, recording, is_dry_run: arguments.dry_run })?;
    let reason = show(&session, settings.console());
    let recorded = session.close();
    if let Some(trial) = recorded.as_deref().filter(|_| person.keeps_learned() && !arguments.dry_run) {
        if let Err(failure) = super::profile::learn(&mut Output::new(false), &person, Path::new(trial), key.as_ref()) {
            // How the trial ended is what the exit code tells.
            super::output::complain(&failure);
        }
    }
    conclude(reason, recorded.as_deref())
}

/// Puts the strategy that was asked for into a setup.
pub(super) fn choose_strategy(setup: &mut Setup, name: Option<&str>) -> Result<(), Failure> {
    let Some(name) = name else { return Ok(()) };
    let names: Vec<_> = StrategyKind::ALL.iter().map(|kind| kind.name()).collect();
    let found = StrategyKind::ALL.into_iter().find(|kind| kind.name() == name);
    let unknown = || Failure::Configuration(format!("--strategy {name} is none of {}", names.join(", ")));
    setup.settings.strategy = found.ok_or_else(unknown)?;
    Ok(())
}

/// Runs the screen until the operator leaves it.
pub(super) fn show(session: &Session, options: &ConsoleOptions) -> Result<ExitReason, Failure> {
    let mut viewer = session.viewer();
    let newest = move || -> Option<Snapshot> { viewer() };
    crate::console::run(newest, session.asker(), &session.stopper(), None, options).map_err(Failure::configuration)
}

/// Says on leaving where the record is, and turns the reason into an exit code.
pub(super) fn conclude(reason: Result<ExitReason, Failure>, recorded: Option<&str>) -> Result<(), Failure> {
    if let Some(path) = recorded {
        Output::new(false).line(format!("recorded in {path}"))?;
    }
    match reason? {
        ExitReason::QuitAfterStop => Err(Failure::OperatorStop("the emergency stop was used".into())),
        ExitReason::Quit | ExitReason::Terminated | ExitReason::TerminalLost => Ok(()),
    }
}
