//! The console without a screen: what happens as lines, commands as lines.
//!
//! For screen readers, scripts and `roslaunch`. The end of the input is an operator who has gone: the trial holds.

use crate::cli::demo::{print_report, verdict};
use crate::cli::exit::Failure;
use crate::cli::output::{Output, complain};
use crate::cli::session::Session;
use crate::cli::sim::ending_signals;
use crate::command::{Command, Origin};
use crate::headless::{Report, TrialResult, Typed};
use crate::strategy::StrategyKind;
use crate::supervisor::Effect;
use crossbeam_channel::{Receiver, bounded};
use std::io::BufRead;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

/// How often the input is looked at while nothing happens.
const LOOK: Duration = Duration::from_millis(20);
/// Lines that may wait.
const LINES: usize = 64;

/// One thing that came from the input.
enum Read {
    Line(String),
    End,
}

/// Prints what happens and asks what is typed, until the operator leaves or the node is told to end.
///
/// # Errors
/// Where a stop is latched at the end: the outcome that goes with it.
pub(super) fn follow(session: &Session, strategy: StrategyKind, seed: u64, json: bool) -> Result<(), Failure> {
    let ended = ending_signals()?;
    let mut output = Output::new(json);
    let mut desk = Desk { session, typed: read_lines()?, has_asked: false };
    let engine = session.engine().ok_or_else(|| Failure::Fault("the supervisor has ended".into()))?;
    output.line(format!("seed {seed}, strategy {strategy}"))?;
    let (began, mut last) = (Instant::now(), None);
    while session.is_running() && !ended.load(Ordering::SeqCst) {
        if let Some(effect) = engine.next_effect(LOOK).map_err(Failure::fault)? {
            let seconds = began.elapsed().as_secs_f64();
            if let Some(report) = Report::of(&effect) {
                print_report(&mut output, &report, seconds)?;
            }
            if let Some(result) = TrialResult::of(&effect) {
                let strategy = engine.snapshots().newest().trial.strategy.unwrap_or(strategy);
                tell_end(&mut output, &effect, &result, (strategy, seed, seconds))?;
                last = Some(result);
            }
        }
        if !desk.obey()? {
            break;
        }
    }
    if !session.is_running() {
        output.line(
            "told to end by another program (rosnode kill, roslaunch, or a second node of this one's name): a trial that was \
             led from here holds, and the robot stays enabled",
        )?;
    }
    match last.filter(|_| session.is_stopped()) {
        Some(result) => verdict(&result),
        None => Ok(()),
    }
}

fn tell_end(
    output: &mut Output,
    effect: &Effect,
    result: &TrialResult,
    (strategy, seed, seconds): (StrategyKind, u64, f64),
) -> Result<(), Failure> {
    if matches!(effect, Effect::TrialEnded { .. }) {
        output.line(format!("the trial is {}: {}", result.outcome.words(), result.reason))?;
    }
    output.event(&result.event(strategy.name(), seed, seconds))
}

/// Where commands come from.
struct Desk<'a> {
    session: &'a Session,
    typed: Receiver<Read>,
    has_asked: bool,
}

impl Desk<'_> {
    /// Carries out what was typed since the last look. False where the operator leaves.
    fn obey(&mut self) -> Result<bool, Failure> {
        let mut ask = self.session.asker(Origin::OperatorKey);
        for read in self.typed.try_iter() {
            let line = match read {
                Read::Line(line) => line,
                // Where nobody ever asked for anything, as under roslaunch, nobody has gone.
                Read::End if !self.has_asked => continue,
                Read::End => {
                    self.session.lose_console();
                    continue;
                }
            };
            match Typed::read(&line) {
                Ok(None) => {}
                Ok(Some(Typed::Quit)) => return Ok(false),
                Ok(Some(Typed::Ask(Command::Stop))) => self.session.stopper().stop(),
                Ok(Some(Typed::Ask(command))) => {
                    self.has_asked = true;
                    ask(command).map_err(Failure::Fault)?;
                }
                Err(refused) => complain(&Failure::configuration(refused)),
            }
        }
        Ok(true)
    }
}

/// Reads lines in a thread of its own, which ends with the input or the process.
fn read_lines() -> Result<Receiver<Read>, Failure> {
    let (sender, lines) = bounded(LINES);
    let reading = move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(Read::Line(line)).is_err() {
                return;
            }
        }
        // Nobody listens any more where this fails.
        let _ = sender.send(Read::End);
    };
    thread::Builder::new().name("lines".into()).spawn(reading).map_err(Failure::fault)?;
    Ok(lines)
}
