//! The console on a real terminal: sets it up, runs the loop, and gives it back whatever happens.
//!
//! Order of a panic: stop the robot, restore the terminal, log, tell. A signal or a lost terminal means hold, then leave.

mod changes;
mod frames;
mod guard;
mod runner;
mod signals;

use super::app::App;
use super::input::InputThread;
use super::keymap::KeyMap;
use super::options::ConsoleOptions;
use super::theme::Look;
use super::view::ViewState;
use super::{CommandSink, ConsoleError, ExitReason, ReplayControl, SnapshotSource, StopHandle};
use guard::{PanicGuard, TerminalGuard};
use runner::{Runner, Wires};
use signals::Signals;
use std::io::IsTerminal;
use std::sync::Arc;

/// Reads theme and keys again.
pub type Reload<'a> = dyn FnMut() -> Result<ConsoleOptions, String> + 'a;

/// Runs the console on this process' terminal until the operator leaves it, the process is told to end or the terminal
/// is gone. `replay` is given where a recorded trial is shown.
///
/// # Errors
/// A [`ConsoleError`] where there is no terminal, the key table is not usable, or the terminal fails at the start.
pub fn run(
    snapshots: impl SnapshotSource,
    commands: impl CommandSink,
    stop: &Arc<dyn StopHandle>,
    replay: Option<Box<dyn ReplayControl>>,
    options: &ConsoleOptions,
) -> Result<ExitReason, ConsoleError> {
    run_reloading(snapshots, commands, stop, replay, options, &mut || Ok(options.clone()))
}

/// The same, with what reads theme and keys again when the process is sent SIGUSR1. Nothing else of the options changes
/// then, and a key table that is not usable leaves the present one in force.
///
/// # Errors
/// As [`run`].
pub fn run_reloading(
    mut snapshots: impl SnapshotSource,
    mut commands: impl CommandSink,
    stop: &Arc<dyn StopHandle>,
    replay: Option<Box<dyn ReplayControl>>,
    options: &ConsoleOptions,
    reload: &mut Reload<'_>,
) -> Result<ExitReason, ConsoleError> {
    let keys = KeyMap::new(&options.keys)?;
    if !std::io::stdin().is_terminal() || !std::io::stdout().is_terminal() {
        return Err(ConsoleError::NoTerminal);
    }
    let look = Look::from_options(options, |name| std::env::var(name).ok());
    let signals = Signals::register().map_err(ConsoleError::Terminal)?;
    let _panic = PanicGuard::install(Arc::clone(stop));
    let guard = TerminalGuard::enter(options.mouse).map_err(ConsoleError::Terminal)?;
    let (sender, heard) = crossbeam_channel::unbounded();
    let input = InputThread::start(keys.clone(), Arc::clone(stop), sender).map_err(ConsoleError::Terminal)?;
    let view = ViewState { mouse: options.mouse, ..ViewState::default() };
    let wires = Wires { snapshots: &mut snapshots, commands: &mut commands, stop: stop.as_ref(), replay, reload };
    let mut runner = Runner::new(App::new(keys, view), look, options, wires, guard, signals);
    let reason = runner.run(&heard, &input);
    // The terminal is given back first, so that what is told next is read.
    drop(runner);
    drop(input);
    reason
}
