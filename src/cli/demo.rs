//! `valet demo`: the whole thing with a simulated robot and person.

mod wire;

use super::console::choose_garment;
use super::exit::Failure;
use super::faults::FaultArguments;
use super::key::KeyArguments;
use super::output::Output;
use super::recording::{RecordArguments, sealed, warn};
use super::screen::ScreenArguments;
use super::sim::GarmentModel;
use crate::config::{LoadedProfile, Places, Settings};
use crate::headless::{Report, ScriptedOperator, TrialResult, VirtualTrial};
use crate::sim::world::WorldSetup;
use crate::snapshot::{Outcome, Watermark};
use crate::strategy::StrategyKind;
use crate::supervisor::Setup;
use std::time::Duration;

/// How often a run without a screen goes on by itself after a hold before it gives the trial up.
const CONTINUES: u32 = 10;
/// No trial of the thesis took longer than 195 s (table 4.2); both arms with every pass of the maximum stay below this.
const LONGEST_TRIAL: Duration = Duration::from_hours(1);

/// The whole thing with a simulated robot and person (the default).
#[derive(Debug, Clone, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own on the command line")]
pub(super) struct Arguments {
    /// Run without a screen: virtual time, one process, done in seconds.
    #[arg(long)]
    pub(super) headless: bool,
    /// With --headless: take the way over TCPROS, in real time.
    #[arg(long, requires = "headless")]
    pub(super) ros: bool,
    /// Seed of everything random; it is printed and recorded.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// The person: a name or a file.
    #[arg(long)]
    pub(super) profile: Option<String>,
    /// The strategy that the trial begins with.
    #[arg(long)]
    pub(super) strategy: Option<String>,
    /// The model of the garment.
    #[arg(long, value_enum, default_value_t)]
    pub(super) garment: GarmentModel,
    /// The garment, by its name in the profile; the first one there where none is named.
    #[arg(long, value_name = "NAME")]
    pub(super) garment_name: Option<String>,
    /// For so many seconds the person moves both arms about first, as before a first trial: something to record.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    pub(super) exercise: f64,
    #[command(flatten)]
    pub(super) faults: FaultArguments,
    /// How many trials to run, with consecutive seeds.
    #[arg(long, default_value_t = 1)]
    pub(super) trials: u32,
    /// Print one JSON object a line.
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) record: RecordArguments,
    #[command(flatten)]
    pub(super) key: KeyArguments,
    #[command(flatten)]
    pub(super) screen: ScreenArguments,
    /// Begin with the paths that earlier trials of this person learned.
    #[arg(long)]
    pub(super) warm_start: bool,
    /// The arms move only as long as the run key is held down, as in the first trial with a person.
    #[arg(long)]
    pub(super) hold_to_run: bool,
    /// The port of the simulator's master; the program sets it for itself when it begins anew.
    #[arg(long, hide = true)]
    pub(super) port: Option<u16>,
}

impl Default for Arguments {
    fn default() -> Self {
        Self {
            headless: false,
            ros: false,
            seed: 1,
            profile: None,
            strategy: None,
            garment: GarmentModel::default(),
            garment_name: None,
            exercise: 0.0,
            faults: FaultArguments::default(),
            trials: 1,
            json: false,
            record: RecordArguments::default(),
            key: KeyArguments::default(),
            screen: ScreenArguments::default(),
            warm_start: false,
            hold_to_run: false,
            port: None,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.headless && !arguments.ros {
        return run_in_virtual_time(arguments);
    }
    wire::run(arguments)
}

fn run_in_virtual_time(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.json);
    let mut last = None;
    for trial in 0..arguments.trials {
        let seed = arguments.seed + u64::from(trial);
        last = Some(run_one(arguments, seed, &mut output)?);
    }
    last.map_or(Ok(()), |result| verdict(&result))
}

fn run_one(arguments: &Arguments, seed: u64, output: &mut Output) -> Result<TrialResult, Failure> {
    let (person, mut setup, settings) = person_and_setup(arguments, seed)?;
    if let Some(strategy) = chosen_strategy(arguments)? {
        setup.settings.strategy = strategy;
    }
    let strategy = setup.settings.strategy;
    let profile = &person.profile;
    let world = WorldSetup {
        seed,
        person: profile.simulated.clone().unwrap_or_default(),
        garment: profile.garment(arguments.garment_name.as_deref()).cloned().unwrap_or_default(),
        backend: arguments.garment.into(),
        exercise_seconds: arguments.exercise,
        faults: arguments.faults.plan(),
        ..WorldSetup::default()
    };
    output.line(format!("seed {seed}, strategy {strategy}"))?;
    let place = arguments.record.of_demos(&Places::of_this_machine().demos, settings.recording());
    let journal = place.map(|place| place.write(&setup, &person)).transpose()?;
    let mut journal = journal.flatten();
    let mut recorded = Ok(());
    let mut trial = VirtualTrial::new(setup, &world).map_err(Failure::configuration)?;
    let mut operator = ScriptedOperator::new(CONTINUES);
    let mut printed = Ok(());
    let result = trial.run(&mut operator, LONGEST_TRIAL, |now, input, effects| {
        if let Some(journal) = journal.as_mut().filter(|_| recorded.is_ok()) {
            recorded = journal.step(now, input, effects, 0);
        }
        for report in effects.iter().filter_map(Report::of) {
            if printed.is_ok() {
                printed = print_report(output, &report, now.seconds());
            }
        }
    });
    printed?;
    recorded.map_err(Failure::fault)?;
    if let Some(journal) = journal {
        let path = journal.finish().map_err(Failure::fault)?;
        let path = sealed(path, &person, arguments.key.given()?.as_ref())?;
        // Not on stdout: the same seed prints the same bytes there.
        warn(&format!("recorded in {}", path.display()));
    }
    output.line(format!("the trial is {}: {}", result.outcome.words(), result.reason))?;
    output.event(&result.event(strategy.name(), seed, trial.trial_seconds()))?;
    Ok(result)
}

/// The person of the trial and what the core starts with: the file of settings, the profile over it.
fn person_and_setup(arguments: &Arguments, seed: u64) -> Result<(LoadedProfile, Setup, Settings), Failure> {
    let places = Places::of_this_machine();
    let settings = Settings::find(None, &places).map_err(Failure::configuration)?;
    let name = arguments.profile.as_deref().unwrap_or_else(|| settings.profile());
    let key = arguments.key.given()?;
    let person = LoadedProfile::find_with(name, &places, key.as_ref()).map_err(Failure::configuration)?;
    let mut setup = settings.setup_for(&person, seed, Watermark::Demo).map_err(Failure::configuration)?;
    choose_garment(&mut setup, &person, arguments.garment_name.as_deref())?;
    setup.settings.warm_start |= arguments.warm_start;
    setup.settings.trial.hold_to_run |= arguments.hold_to_run;
    Ok((person, setup, settings))
}

pub(super) fn print_report(output: &mut Output, report: &Report, seconds: f64) -> Result<(), Failure> {
    output.line(format!("{seconds:8.2} s  {}", report.sentence))?;
    report.event.as_ref().map_or(Ok(()), |event| output.event(event))
}

fn chosen_strategy(arguments: &Arguments) -> Result<Option<StrategyKind>, Failure> {
    let Some(name) = &arguments.strategy else { return Ok(None) };
    let names: Vec<_> = StrategyKind::ALL.iter().map(|kind| kind.name()).collect();
    let found = StrategyKind::ALL.into_iter().find(|kind| kind.name() == name);
    let none = || Failure::Configuration(format!("--strategy {name} is none of {}", names.join(", ")));
    found.map(Some).ok_or_else(none)
}

pub(super) fn verdict(result: &TrialResult) -> Result<(), Failure> {
    let reason = result.reason.clone();
    match result.outcome {
        Outcome::Completed => Ok(()),
        Outcome::Aborted | Outcome::OperatorStop => Err(Failure::OperatorStop(reason)),
        Outcome::SafetyStop => Err(Failure::SafetyStop(reason)),
        Outcome::Fault => Err(Failure::Fault(reason)),
    }
}
