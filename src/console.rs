//! The operator's screen: draws snapshots, asks for commands, and stops the robot at one key.
//!
//! The screen is a function of a snapshot and of what the operator looks at. It knows no robot, no ROS and no strategy,
//! and decides nothing. Stop keys go from the input thread straight to the [`StopHandle`], before any dialog, text field
//! or key map, so that a stop does not wait for a drawing that is under way.

mod app;
mod dialog;
mod draw;
mod fixture;
mod input;
mod keyboard;
mod keymap;
mod measure;
mod options;
mod practice;
mod screens;
mod terminal;
mod theme;
mod view;
mod widgets;

#[cfg(test)]
mod tests;

pub use app::{App, Reaction};
pub use draw::{Scene, draw};
pub use fixture::{Situation, fixture};
pub use keymap::{Action, Chord, Entry, Guard, KeyMap, KeyMapError, Scope, Screen, TABLE};
pub use measure::{FrameTimes, frame_times};
pub use options::{ColourChoice, ConsoleOptions, GlyphChoice, KeyNames, ThemeName};
pub use practice::Practice;
pub use terminal::{Reload, run, run_reloading};
pub use theme::{Look, Role};
pub use view::ViewState;

use crate::command::Command;
use crate::snapshot::Snapshot;
use thiserror::Error;

/// Where snapshots come from.
pub trait SnapshotSource {
    /// The newest snapshot, where it is newer than the one that was taken last. Must not block.
    fn newest(&mut self) -> Option<Snapshot>;
}

impl<F: FnMut() -> Option<Snapshot>> SnapshotSource for F {
    fn newest(&mut self) -> Option<Snapshot> {
        self()
    }
}

/// Where commands go.
pub trait CommandSink {
    /// Hands a command over. The answer comes as a receipt in a later snapshot. Must not block.
    ///
    /// # Errors
    /// Why the command could not be handed over, in words.
    fn send(&mut self, command: Command) -> Result<(), String>;

    /// True where what was asked can only be had by beginning anew: the console is left then.
    fn begins_anew(&self) -> bool {
        false
    }
}

impl<F: FnMut(Command) -> Result<(), String>> CommandSink for F {
    fn send(&mut self, command: Command) -> Result<(), String> {
        self(command)
    }
}

/// The latch of the emergency stop. Setting it must not lock, wait, allocate or fail: it is called from the input
/// thread and from the panic hook.
pub trait StopHandle: Send + Sync {
    /// Sets the latch. Setting it again does no harm.
    fn stop(&self);
}

impl<F: Fn() + Send + Sync> StopHandle for F {
    fn stop(&self) {
        self();
    }
}

/// What the keys of a replay do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReplayRequest {
    /// Pause, or go on.
    PauseOrGoOn,
    /// One step.
    Step,
    /// Multiply the speed by this factor.
    Speed(f64),
    /// Move by this many seconds.
    Seek(f64),
}

/// The controls of a replay; nothing where a trial runs.
pub trait ReplayControl {
    /// Carries a request out. Must not block.
    fn request(&mut self, request: ReplayRequest);
}

/// Why the console was left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExitReason {
    /// The operator quit.
    Quit,
    /// The program begins anew with what was chosen: another person or garment.
    BeginAnew,
    /// The operator quit after an emergency stop.
    QuitAfterStop,
    /// The process was told to end (SIGTERM): the arms were asked to hold.
    Terminated,
    /// The terminal is gone (SIGHUP, or it cannot be read or written any more): the arms were asked to hold.
    TerminalLost,
}

/// Why the console could not run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConsoleError {
    /// Standard input or output is no terminal.
    #[error("this is no terminal: run in a terminal, or with --headless for lines instead of a screen")]
    NoTerminal,
    /// The terminal does not do as it is told.
    #[error("the terminal cannot be set up ({0}): run in another terminal, or with --headless")]
    Terminal(#[source] std::io::Error),
    /// The key table of the configuration is not usable.
    #[error(transparent)]
    Keys(#[from] KeyMapError),
}
