//! The demo over the wire: the simulator as a process of its own with a master in it, and the real node beside it.

use super::{Arguments, LONGEST_TRIAL, person_and_setup, print_report, verdict};
use crate::cli::anew::{self, Chosen};
use crate::cli::console::{choose_strategy, conclude, show};
use crate::cli::exit::Failure;
use crate::cli::output::Output;
use crate::cli::recording::{sealed, warn};
use crate::cli::session::{Opening, Session};
use crate::cli::sim::ros_failure;
use crate::command::Origin;
use crate::config::{LoadedProfile, Places};
use crate::console::ExitReason;
use crate::headless::{Report, ScriptedOperator, TrialResult};
use crate::ros::{Node, environment, node};
use crate::snapshot::Outcome;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// How long the simulator may take to come up on a loaded machine.
const SIMULATOR_WITHIN: Duration = Duration::from_secs(30);
/// How often the scripted operator goes on after a hold: a computer that has other things to do, too, holds the trial for late
/// beats and messages again and again. At two acts a second this is a minute of a trial that does not go on.
const CONTINUES: u32 = 120;
/// How often its master is looked for meanwhile.
const LOOK: Duration = Duration::from_millis(50);

/// The simulator's process: ends with the demo.
struct Simulator(Child);

impl Drop for Simulator {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to end.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs the demo over TCPROS, in real time, on a screen or as lines.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(port) = arguments.port.filter(|port| environment::is_local(*port)) else {
        return start_anew();
    };
    let simulator = start_simulator(arguments, port)?;
    supervise(arguments, simulator)
}

/// The variables by which nodes find each other are read once, at the start: this program begins anew with them.
fn start_anew() -> Result<(), Failure> {
    let port = environment::free_port().map_err(Failure::fault)?;
    let mut typed: Vec<String> = std::env::args().skip(1).collect();
    if typed.first().map(String::as_str) != Some("demo") {
        typed.insert(0, "demo".into());
    }
    typed.extend(["--port".into(), port.to_string()]);
    let mut again = environment::this_program(typed, port).map_err(Failure::fault)?;
    // Only returns where it fails.
    Err(Failure::fault(again.exec()))
}

fn start_simulator(arguments: &Arguments, port: u16) -> Result<Simulator, Failure> {
    let typed = ["sim", "--master", "embedded", "--port"].map(String::from).into_iter();
    let typed = typed.chain([port.to_string(), "--seed".into(), arguments.seed.to_string()]);
    let typed = typed.chain(["--garment".to_owned(), arguments.garment.name().to_owned()]);
    let typed = typed.chain(["--exercise".to_owned(), arguments.exercise.to_string()]);
    let profile = arguments.profile.iter().flat_map(|name| ["--profile".to_owned(), name.clone()]);
    let name = arguments.garment_name.iter().flat_map(|name| ["--garment-name".to_owned(), name.clone()]);
    let typed =
        typed.chain(profile).chain(name).chain(arguments.faults.typed()).chain(["--until-input-ends".to_owned()]);
    let mut command = environment::this_program(typed, port).map_err(Failure::fault)?;
    // The screen belongs to the console alone. The input is never written to: it ends with this process, however that
    // ends, and the simulator with it.
    let child =
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().map_err(Failure::fault)?;
    let mut simulator = Simulator(child);
    let began = Instant::now();
    while node::probe_master(&node::master_uri()).is_err() {
        if let Ok(Some(status)) = simulator.0.try_wait() {
            return Err(Failure::Fault(format!(
                "the simulator ended before it was up ({status}): run `valet sim` to see why"
            )));
        }
        if began.elapsed() > SIMULATOR_WITHIN {
            return Err(Failure::Fault("the simulator does not come up: this computer is overloaded".into()));
        }
        std::thread::sleep(LOOK);
    }
    Ok(simulator)
}

fn supervise(arguments: &Arguments, simulator: Simulator) -> Result<(), Failure> {
    let (person, mut setup, settings) = person_and_setup(arguments, arguments.seed)?;
    choose_strategy(&mut setup, arguments.strategy.as_deref())?;
    let strategy = setup.settings.strategy;
    let node = Node::start("valet").map_err(ros_failure)?;
    let recording = arguments.record.of_demos(&Places::of_this_machine().demos, settings.recording());
    let session = Session::open(Opening { node, setup, person: &person, recording, is_dry_run: false, pose: None })?;
    if arguments.headless {
        let result = follow(arguments, &session, strategy.name());
        if let Some(path) = recorded_in(session, &person, arguments)? {
            warn(&format!("recorded in {}", path.display()));
        }
        return verdict(&result?);
    }
    let (options, chosen) = (arguments.screen.over(settings.console()), Chosen::default());
    let reason = show(&session, &options, &mut arguments.screen.reader(None), &chosen);
    let recorded = recorded_in(session, &person, arguments)?;
    if matches!(reason, Ok(ExitReason::BeginAnew)) {
        drop(simulator);
        return anew::begin(&chosen);
    }
    conclude(reason, recorded.as_deref())
}

/// Closes the session and says where its journal is now.
fn recorded_in(session: Session, person: &LoadedProfile, arguments: &Arguments) -> Result<Option<PathBuf>, Failure> {
    let key = arguments.key.given()?;
    session.close().map(|path| sealed(path, person, key.as_ref())).transpose()
}

/// The scripted operator on the real node: prints what happens until the trial has ended.
fn follow(arguments: &Arguments, session: &Session, strategy: &str) -> Result<TrialResult, Failure> {
    let mut output = Output::new(arguments.json);
    let mut operator = ScriptedOperator::new(CONTINUES);
    let (mut viewer, mut ask) = (session.viewer(), session.asker(Origin::Headless));
    let engine = session.engine().ok_or_else(|| Failure::Fault("the supervisor has ended".into()))?;
    output.line(format!("seed {}, strategy {strategy}", arguments.seed))?;
    let began = Instant::now();
    while began.elapsed() < LONGEST_TRIAL && session.is_running() {
        if let Some(effect) = engine.next_effect(LOOK).map_err(Failure::fault)? {
            if let Some(report) = Report::of(&effect) {
                print_report(&mut output, &report, began.elapsed().as_secs_f64())?;
            }
            if let Some(result) = TrialResult::of(&effect) {
                output.line(format!("the trial is {}: {}", result.outcome.words(), result.reason))?;
                output.event(&result.event(strategy, arguments.seed, began.elapsed().as_secs_f64()))?;
                return Ok(result);
            }
        }
        if let Some(command) = viewer().and_then(|seen| operator.act(&seen)) {
            ask(command).map_err(Failure::Fault)?;
        }
        if let Some(reason) = operator.gave_up() {
            return Ok(TrialResult { outcome: Outcome::Fault, reason: reason.to_owned() });
        }
    }
    Ok(TrialResult { outcome: Outcome::Fault, reason: "the node was told to end before the trial had ended".into() })
}
