//! `valet console`: the operator console on a ROS graph, on a screen or as lines.

mod lines;

use super::anew::{Choosing, Chosen};
use super::exit::Failure;
use super::key::KeyArguments;
use super::output::Output;
use super::planning::choose_planner;
use super::recorded_pose::RecordedPose;
use super::recording::{RecordArguments, sealed};
use super::screen::ScreenArguments;
use super::session::{Opening, Session};
use super::sim::ros_failure;
use crate::command::Origin;
use crate::config::{Key, LoadedProfile, Places, Settings};
use crate::console::{ConsoleOptions, ExitReason, Reload};
use crate::record::JournalFile;
use crate::ros::Node;
use crate::snapshot::{Snapshot, Watermark};
use crate::strategy::StrategyKind;
use crate::supervisor::Setup;
use std::path::{Path, PathBuf};

/// The operator console on a ROS graph.
///
/// The private parameters `~profile`, `~strategy`, `~seed`, `~record` and `~dry_run` stand in for options that are not typed.
#[derive(Clone, Debug, Default, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own on the command line")]
pub(super) struct Arguments {
    /// The person: a name or a file.
    #[arg(long)]
    profile: Option<String>,
    /// The garment, by its name in the profile; the first one there where none is named.
    #[arg(long)]
    garment: Option<String>,
    /// The strategy that a trial begins with.
    #[arg(long)]
    strategy: Option<String>,
    /// Who plans the straight lines: `built_in` or `moveit`.
    #[arg(long)]
    planner: Option<String>,
    /// Seed of everything random; it is recorded [default: 1].
    #[arg(long)]
    seed: Option<u64>,
    /// Another file of settings than the one that is found.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    #[command(flatten)]
    record: RecordArguments,
    #[command(flatten)]
    key: KeyArguments,
    #[command(flatten)]
    screen: ScreenArguments,
    /// Begin with the paths that earlier trials of this person learned.
    #[arg(long)]
    warm_start: bool,
    /// The arms move only as long as the run key is held down, as in the first trial with a person.
    #[arg(long)]
    hold_to_run: bool,
    /// Take the person's pose from this recorded trial, at its pace, instead of a camera or a tracker.
    #[arg(long, value_name = "TRIAL")]
    pose_from: Option<PathBuf>,
    /// Decide everything, command nothing.
    #[arg(long)]
    dry_run: bool,
    /// Show the trial of a node that runs already: this screen can stop it and do nothing else.
    #[arg(long, value_name = "NODE", num_args = 0..=1, default_missing_value = "/valet",
          conflicts_with_all = ["profile", "strategy", "seed", "dry_run"])]
    watch: Option<String>,
    /// Without a screen: print what happens as lines, read commands as lines (`enable`, `start`, `stop`, ...).
    #[arg(long)]
    headless: bool,
    /// With --headless: print one JSON object a line.
    #[arg(long, requires = "headless")]
    json: bool,
}

/// What is needed to open a session, read and checked.
struct Prepared {
    settings: Settings,
    person: LoadedProfile,
    setup: Setup,
    pose: Option<RecordedPose>,
    key: Option<Key>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(node) = &arguments.watch {
        let settings = Settings::find(arguments.config.as_deref(), &Places::of_this_machine());
        let options = arguments.screen.over(settings.map_err(Failure::configuration)?.console());
        return super::watch::run(node, &options);
    }
    // What was typed is checked first: a wrong option needs no master to be found.
    let mut prepared = prepare(arguments)?;
    let node = Node::start("valet").map_err(ros_failure)?;
    let mut arguments = arguments.clone();
    if arguments.take_parameters(&node) {
        prepared = prepare(&arguments)?;
    }
    operate(&arguments, node, prepared)
}

fn operate(arguments: &Arguments, node: Node, prepared: Prepared) -> Result<(), Failure> {
    let Prepared { settings, person, setup, pose, key } = prepared;
    let strategy = setup.settings.strategy;
    let recording = arguments.record.of_trials(&Places::of_this_machine().trials, settings.recording());
    let is_dry_run = arguments.dry_run;
    let session = Session::open(Opening { node, setup, person: &person, recording, is_dry_run, pose })?;
    let chosen = Chosen::default();
    let reason = if arguments.headless {
        lines::follow(&session, strategy, arguments.seed(), arguments.json).map(|()| ExitReason::Quit)
    } else {
        let options = arguments.screen.over(settings.console());
        let mut reader = arguments.screen.reader(arguments.config.clone());
        show(&session, &options, &mut reader, &chosen)
    };
    let recorded = session.close().map(|path| sealed(path, &person, key.as_ref())).transpose()?;
    if let Some(trial) = recorded.as_deref().filter(|_| person.keeps_learned() && !arguments.dry_run) {
        let mut output = Output::new(arguments.json);
        if let Err(failure) = super::profile::learn(&mut output, &person, trial, key.as_ref()) {
            // How the trial ended is what the exit code tells.
            super::output::complain(&failure);
        }
    }
    if matches!(reason, Ok(ExitReason::BeginAnew)) {
        return super::anew::begin(&chosen);
    }
    conclude(reason, recorded.as_deref().filter(|_| !arguments.json))
}

impl Arguments {
    fn seed(&self) -> u64 {
        self.seed.unwrap_or(1)
    }

    /// Puts the node's private parameters in the places of options that were not typed. True where one changed.
    fn take_parameters(&mut self, node: &Node) -> bool {
        let becomes_dry = !self.dry_run && node.switch_parameter("~dry_run");
        self.dry_run |= becomes_dry;
        let taken = [
            take(&mut self.profile, || node.text_parameter("~profile")),
            take(&mut self.strategy, || node.text_parameter("~strategy")),
            take(&mut self.seed, || node.seed_parameter("~seed")),
            self.record.take_folder(|| node.text_parameter("~record").map(PathBuf::from)),
            becomes_dry,
        ];
        taken.contains(&true)
    }
}

/// Puts a parameter into an empty place. True where there was one.
fn take<T>(place: &mut Option<T>, parameter: impl FnOnce() -> Option<T>) -> bool {
    if place.is_none() {
        *place = parameter();
        return place.is_some();
    }
    false
}

fn prepare(arguments: &Arguments) -> Result<Prepared, Failure> {
    let places = Places::of_this_machine();
    let settings = Settings::find(arguments.config.as_deref(), &places).map_err(Failure::configuration)?;
    let name = arguments.profile.as_deref().unwrap_or_else(|| settings.profile());
    let key = arguments.key.given()?;
    let person = LoadedProfile::find_with(name, &places, key.as_ref()).map_err(Failure::configuration)?;
    let watermark = if arguments.dry_run { Watermark::DryRun } else { Watermark::Live };
    let mut setup = settings.setup_for(&person, arguments.seed(), watermark).map_err(Failure::configuration)?;
    choose_strategy(&mut setup, arguments.strategy.as_deref())?;
    choose_planner(&mut setup, arguments.planner.as_deref())?;
    choose_garment(&mut setup, &person, arguments.garment.as_deref())?;
    setup.settings.warm_start |= arguments.warm_start;
    setup.settings.trial.hold_to_run |= arguments.hold_to_run;
    let pose = arguments.pose_from.as_ref().map(|path| RecordedPose::read(JournalFile::new(path, key.clone())));
    let pose = pose.transpose()?;
    Ok(Prepared { settings, person, setup, pose, key })
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

/// Puts the garment that was asked for, or else the profile's first, into a setup: the grippers go no further apart than it is slack.
pub(super) fn choose_garment(setup: &mut Setup, person: &LoadedProfile, name: Option<&str>) -> Result<(), Failure> {
    let Some(garment) = person.profile.garment(name) else {
        let Some(name) = name else { return Ok(()) };
        let known: Vec<_> = person.profile.garments.iter().map(|garment| garment.name.as_str()).collect();
        let unknown = format!("--garment {name} is none of this profile's: {}", known.join(", "));
        return Err(Failure::Configuration(unknown));
    };
    setup.garment.clone_from(&garment.name);
    let motion = &mut setup.settings.motion;
    motion.maximum_gripper_distance = motion.maximum_gripper_distance.min(garment.slack_metres());
    Ok(())
}

/// Runs the screen until the operator leaves it, or has chosen another person or garment.
pub(super) fn show(
    session: &Session,
    options: &ConsoleOptions,
    reload: &mut Reload<'_>,
    chosen: &Chosen,
) -> Result<ExitReason, Failure> {
    let mut viewer = session.viewer();
    let newest = move || -> Option<Snapshot> { viewer() };
    let commands = Choosing { inner: session.asker(Origin::OperatorKey), chosen: Chosen::clone(chosen) };
    crate::console::run_reloading(newest, commands, &session.stopper(), None, options, reload)
        .map_err(Failure::configuration)
}

/// Says on leaving where the record is, and turns the reason into an exit code.
pub(super) fn conclude(reason: Result<ExitReason, Failure>, recorded: Option<&Path>) -> Result<(), Failure> {
    if let Some(path) = recorded {
        let mut output = Output::new(false);
        output.line(format!("recorded in {}", path.display()))?;
        output.line(format!("the program's own log is in {}", Places::of_this_machine().logs.display()))?;
    }
    let reason = reason?;
    if reason == ExitReason::Terminated {
        Output::new(false).line("left on SIGTERM; a trial that this console led holds")?;
    }
    match reason {
        ExitReason::QuitAfterStop => Err(Failure::OperatorStop("the emergency stop was used".into())),
        ExitReason::Quit | ExitReason::BeginAnew | ExitReason::Terminated | ExitReason::TerminalLost => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERSON: &str = "version = 1\npseudonym = \"p-01\"\n[[garments]]\nname = \"wide\"\nback_reach_metres = 1.2\n\
                          [[garments]]\nname = \"narrow\"\nback_reach_metres = 0.6\n";

    fn chosen(name: Option<&str>) -> Result<Setup, Failure> {
        let person = LoadedProfile::parse(Path::new("p-01.toml"), PERSON).unwrap();
        let mut setup = Setup::default();
        choose_garment(&mut setup, &person, name).map(|()| setup)
    }

    #[test]
    fn a_narrow_garment_brings_the_grippers_closer_and_a_wide_one_lets_them_no_further_apart() {
        for (name, garment, metres) in [(None, "wide", 0.90), (Some("narrow"), "narrow", 0.59)] {
            let setup = chosen(name).unwrap();
            assert_eq!(setup.garment, garment);
            assert!((setup.settings.motion.maximum_gripper_distance - metres).abs() < 1e-12);
        }
    }

    #[test]
    fn an_unknown_garment_is_refused_with_those_that_are_known() {
        let words = chosen(Some("cape")).unwrap_err().to_string();
        assert!(words.contains("cape") && words.contains("wide, narrow"), "{words}");
    }
}
