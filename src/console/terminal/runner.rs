//! The console's loop: takes events and snapshots in, carries reactions out, and draws when something changed.

use super::Reload;
use super::changes::{Vitals, is_news};
use super::guard::TerminalGuard;
use super::signals::Signals;
use crate::command::Command;
use crate::console::app::{App, Reaction};
use crate::console::draw::{Scene, draw};
use crate::console::input::{Heard, InputThread};
use crate::console::keymap::KeyMap;
use crate::console::theme::Look;
use crate::console::{
    CommandSink, ConsoleError, ConsoleOptions, ExitReason, ReplayControl, SnapshotSource, StopHandle,
};
use crate::snapshot::{Snapshot, Watermark};
use crossbeam_channel::{Receiver, RecvTimeoutError};
use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use std::time::{Duration, Instant};

/// How often an unchanged screen is drawn anew, so that ages and the clock go on.
const CLOCK: Duration = Duration::from_secs(1);

/// How often it is looked for news where there were none for as long as [`CLOCK`]; a key and a new size need no look.
const IDLE_LOOK: Duration = Duration::from_millis(100);

/// How long the core may say nothing before the screen says so: it makes a snapshot at every beat of its 100 Hz.
const SILENCE: Duration = Duration::from_millis(500);

/// What the loop is connected to.
pub(super) struct Wires<'a> {
    pub(super) snapshots: &'a mut dyn SnapshotSource,
    pub(super) commands: &'a mut dyn CommandSink,
    pub(super) stop: &'a dyn StopHandle,
    pub(super) replay: Option<Box<dyn ReplayControl>>,
    pub(super) reload: &'a mut Reload<'a>,
}

/// The loop with all that it owns.
pub(super) struct Runner<'a> {
    app: App,
    look: Look,
    bell: bool,
    frame: Duration,
    wires: Wires<'a>,
    guard: TerminalGuard,
    signals: Signals,
    snapshot: Snapshot,
    taken: Instant,
    vitals: Vitals,
    dirty: bool,
    /// When there was news last.
    changed: Instant,
    drawn: Option<Instant>,
}

impl<'a> Runner<'a> {
    pub(super) fn new(
        app: App,
        look: Look,
        options: &ConsoleOptions,
        wires: Wires<'a>,
        guard: TerminalGuard,
        signals: Signals,
    ) -> Self {
        let frame = Duration::from_secs(1) / options.frames_per_second.clamp(1, 30);
        let snapshot = Snapshot::default();
        let (vitals, taken) = (Vitals::of(&snapshot), Instant::now());
        let bell = options.bell;
        Self {
            app,
            look,
            bell,
            frame,
            wires,
            guard,
            signals,
            snapshot,
            taken,
            vitals,
            dirty: true,
            changed: taken,
            drawn: None,
        }
    }

    /// Runs until there is a reason to leave. The arms are asked to hold where nobody watches them any more.
    pub(super) fn run(&mut self, heard: &Receiver<Heard>, input: &InputThread) -> Result<ExitReason, ConsoleError> {
        let (columns, rows) = self.guard.size().map_err(ConsoleError::Terminal)?;
        self.app.on_resize(columns, rows);
        loop {
            if let Some(reason) = self.turn(heard, input) {
                if matches!(reason, ExitReason::Terminated | ExitReason::TerminalLost) {
                    // The engine also notices that the console is gone; this only spares it the wait.
                    let _ = self.wires.commands.send(Command::Hold);
                }
                return Ok(reason);
            }
        }
    }

    /// One turn: wait, take in, carry out, draw.
    fn turn(&mut self, heard: &Receiver<Heard>, input: &InputThread) -> Option<ExitReason> {
        match heard.recv_timeout(self.patience()) {
            Ok(first) => {
                let all: Vec<_> = std::iter::once(first).chain(heard.try_iter()).collect();
                for event in all {
                    if let Some(reason) = self.take_in(event, input) {
                        return Some(reason);
                    }
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Some(ExitReason::TerminalLost),
        }
        if let Some(reason) = self.check_signals(input) {
            return Some(reason);
        }
        self.take_snapshot(input).or_else(|| self.draw_if_due())
    }

    /// Until the next frame may be drawn; a key ends the wait at once.
    fn patience(&self) -> Duration {
        match self.drawn {
            Some(drawn) if self.dirty => self.frame.saturating_sub(drawn.elapsed()),
            Some(_) if self.changed.elapsed() > CLOCK => self.frame.max(IDLE_LOOK),
            Some(_) => self.frame,
            None => Duration::ZERO,
        }
    }

    fn take_in(&mut self, heard: Heard, input: &InputThread) -> Option<ExitReason> {
        let Heard::Event(event) = heard else { return Some(ExitReason::TerminalLost) };
        self.dirty = true;
        let reactions = match event {
            Event::Key(key) => self.app.on_key(key, &self.snapshot),
            Event::Mouse(mouse) => {
                self.app.on_mouse(mouse, &self.snapshot);
                Vec::new()
            }
            Event::Resize(columns, rows) => {
                self.app.on_resize(columns, rows);
                self.drawn = None;
                Vec::new()
            }
            _ => Vec::new(),
        };
        self.carry_out(reactions, input)
    }

    fn take_snapshot(&mut self, input: &InputThread) -> Option<ExitReason> {
        let mut newer = self.wires.snapshots.newest()?;
        let known = std::mem::take(&mut self.snapshot);
        let vitals = Vitals::of(&newer);
        if is_news(known, &mut newer) || vitals != self.vitals {
            (self.dirty, self.changed) = (true, Instant::now());
        }
        (self.snapshot, self.vitals, self.taken) = (newer, vitals, Instant::now());
        let reactions = self.app.on_snapshot(&self.snapshot);
        self.carry_out(reactions, input)
    }

    fn carry_out(&mut self, reactions: Vec<Reaction>, input: &InputThread) -> Option<ExitReason> {
        for reaction in reactions {
            let done = match reaction {
                Reaction::Stop => {
                    self.wires.stop.stop();
                    Ok(())
                }
                Reaction::Send(command) => {
                    if let Err(reason) = self.wires.commands.send(command.clone()) {
                        self.app.complain(format!("{command}: could not be handed over: {reason}"));
                    }
                    if self.wires.commands.begins_anew() {
                        return Some(ExitReason::BeginAnew);
                    }
                    Ok(())
                }
                Reaction::Replay(request) => {
                    if let Some(replay) = self.wires.replay.as_mut() {
                        replay.request(request);
                    }
                    Ok(())
                }
                Reaction::Redraw => self.guard.clear(),
                Reaction::Mouse(on) => self.guard.mouse(on),
                Reaction::Bell if self.bell => self.guard.bell(),
                Reaction::Bell => Ok(()),
                Reaction::Suspend => self.suspend(input),
                Reaction::Leave(reason) => return Some(reason),
            };
            if done.is_err() {
                return Some(ExitReason::TerminalLost);
            }
        }
        None
    }

    fn suspend(&mut self, input: &InputThread) -> std::io::Result<()> {
        input.pause(true);
        let lent = self.guard.lend(self.app.view.mouse, Signals::sleep_for_the_shell);
        input.pause(false);
        self.resized();
        lent
    }

    fn check_signals(&mut self, input: &InputThread) -> Option<ExitReason> {
        if self.signals.hung_up() {
            return Some(ExitReason::TerminalLost);
        }
        if self.signals.terminated() {
            return Some(ExitReason::Terminated);
        }
        if self.signals.take_reload() {
            self.reload(input);
        }
        if self.signals.take_resumed() {
            self.resized();
            if self.guard.clear().is_err() {
                return Some(ExitReason::TerminalLost);
            }
        }
        if self.signals.take_suspend() {
            // Asked from outside, it is refused or done for the same reasons as at the key.
            let asked = KeyEvent::new(KeyCode::Char('z'), KeyModifiers::CONTROL);
            let reactions = self.app.on_key(asked, &self.snapshot);
            return self.carry_out(reactions, input);
        }
        None
    }

    /// Theme and keys anew, as the file says now. What is not usable changes nothing and is said.
    fn reload(&mut self, input: &InputThread) {
        self.dirty = true;
        let options = (self.wires.reload)();
        let read = options.and_then(|options| {
            let keys = KeyMap::new(&options.keys).map_err(|error| error.to_string())?;
            Ok((options, keys))
        });
        match read {
            Ok((options, keys)) => {
                self.look = Look::from_options(&options, |name| std::env::var(name).ok());
                input.use_keys(keys.clone());
                self.app.keys = keys;
                self.app.inform("theme and keys were read again");
            }
            Err(reason) => self.app.complain(format!("theme and keys stay as they are: {reason}")),
        }
    }

    fn resized(&mut self) {
        if let Ok((columns, rows)) = self.guard.size() {
            self.app.on_resize(columns, rows);
        }
        self.dirty = true;
    }

    /// Draws where something changed and the last frame is old enough, or where the clock has gone on.
    fn draw_if_due(&mut self) -> Option<ExitReason> {
        let waited = self.drawn.map(|drawn| drawn.elapsed());
        let due = waited.is_none_or(|waited| (self.dirty && waited >= self.frame) || waited >= CLOCK);
        if !due {
            return None;
        }
        self.dirty = false;
        self.drawn = Some(Instant::now());
        let silence = self.taken.elapsed();
        let silent = silence > SILENCE && self.snapshot.watermark != Watermark::Replay;
        self.app.view.silence = silent.then_some(silence.as_secs_f64());
        // Where the core says nothing, what it said last grows old all the same.
        let aged = silent.then(|| Snapshot { now: self.snapshot.now + silence, ..self.snapshot.clone() });
        let live = aged.as_ref().unwrap_or(&self.snapshot);
        let scene = Scene { live, view: &self.app.view, look: self.look, keys: &self.app.keys };
        let drawn = self.guard.draw(|area, buffer| draw(&scene, area, buffer));
        drawn.is_err().then_some(ExitReason::TerminalLost)
    }
}
