//! The console as a machine that is stepped: a key, a click, a size or a snapshot comes in, reactions go out.
//!
//! Reads no clock, touches no terminal and sends nothing itself: the runner carries the reactions out. A stop key is
//! answered before everything else, whatever lies on the screen.

mod acts;
mod availability;
mod moves;

pub(super) use availability::{is_replay, refusal};

use super::dialog::{Answer, Dialog};
use super::keymap::{Action, Chord, KeyMap, Screen};
use super::view::{Message, Tier, ViewState};
use super::{ExitReason, ReplayRequest};
use crate::command::Command;
use crate::snapshot::{Snapshot, Watermark};
use crate::time::Stamp;
use ratatui::crossterm::event::{KeyEvent, KeyEventKind, MouseEvent, MouseEventKind};

/// How many rows a notch of the mouse's wheel scrolls.
const WHEEL_ROWS: usize = 3;

/// What is to be done about an event.
#[derive(Clone, Debug, PartialEq)]
pub enum Reaction {
    /// Set the stop latch.
    Stop,
    /// Hand a command over.
    Send(Command),
    /// Ask something of a replay.
    Replay(ReplayRequest),
    /// Clear the terminal and draw everything anew.
    Redraw,
    /// Take or give back the mouse.
    Mouse(bool),
    /// Leave the screen to the shell until the process is continued.
    Suspend,
    /// Ring the bell.
    Bell,
    /// Leave the console.
    Leave(ExitReason),
}

/// The console's state between two events.
#[derive(Clone, Debug)]
pub struct App {
    /// The keys in force.
    pub keys: KeyMap,
    /// What the operator looks at.
    pub view: ViewState,
    stop_was_latched: bool,
    stop_key_pressed: bool,
    resistances: usize,
    answered: Option<Stamp>,
    asked_setting: Option<AskedSetting>,
    run_pressed: Option<Stamp>,
}

/// A value that was asked for and may not be in the snapshot yet: the next key goes on from it.
#[derive(Clone, Debug)]
struct AskedSetting {
    key: String,
    value: f64,
    at: Stamp,
}

impl App {
    /// A console that has seen nothing yet.
    #[must_use]
    pub fn new(keys: KeyMap, view: ViewState) -> Self {
        Self {
            keys,
            view,
            stop_was_latched: false,
            stop_key_pressed: false,
            resistances: 0,
            answered: None,
            asked_setting: None,
            run_pressed: None,
        }
    }

    /// Takes a newer snapshot in: a dialog about motion closes when a stop is latched.
    pub fn on_snapshot(&mut self, snapshot: &Snapshot) -> Vec<Reaction> {
        let latched = snapshot.stop.latched;
        let newly = latched && !self.stop_was_latched;
        self.stop_was_latched = latched;
        if newly {
            self.close_what_may_move();
        }
        let answered = snapshot.receipts.last().map(|line| line.stamp);
        if answered > self.answered && self.view.message.as_ref().is_some_and(|message| !message.refused) {
            // What was asked is answered: the answer takes the place of the question.
            self.view.message = None;
        }
        self.answered = answered;
        let found = snapshot.sides.left.force.detections.len() + snapshot.sides.right.force.detections.len();
        let rings = newly || found > self.resistances;
        self.resistances = found;
        if rings { vec![Reaction::Bell] } else { Vec::new() }
    }

    /// A key was pressed.
    pub fn on_key(&mut self, event: KeyEvent, snapshot: &Snapshot) -> Vec<Reaction> {
        if event.kind == KeyEventKind::Release {
            return Vec::new();
        }
        let Some(chord) = Chord::from_event(event) else { return Vec::new() };
        if let Some(stop) = self.keys.stop(chord) {
            return self.on_stop_key(stop);
        }
        self.view.message = None;
        if self.view.dialog.is_some() {
            return self.on_dialog_key(chord, snapshot);
        }
        if let Some(action) = self.keys.action(chord, self.view.screen) {
            return self.act(action, snapshot);
        }
        self.say(self.why_nothing(chord));
        Vec::new()
    }

    /// What a key that means nothing on this screen means elsewhere.
    fn why_nothing(&self, chord: Chord) -> String {
        let elsewhere = Screen::ALL.into_iter().find_map(|screen| Some((screen, self.keys.action(chord, screen)?)));
        match elsewhere.and_then(|(screen, action)| Some((screen, action.entry()?))) {
            Some((screen, entry)) => {
                format!("{chord} does nothing here; on the {} screen: {}", screen.name(), entry.text)
            }
            None => format!("{chord} does nothing here; {} shows the keys", self.keys.first_key(Action::Help)),
        }
    }

    /// The mouse focuses and scrolls, and never acts.
    pub fn on_mouse(&mut self, event: MouseEvent, snapshot: &Snapshot) {
        if !self.view.mouse || self.view.dialog.is_some() {
            return;
        }
        match event.kind {
            MouseEventKind::ScrollUp => (0..WHEEL_ROWS).for_each(|_| self.scroll(Action::Up, snapshot)),
            MouseEventKind::ScrollDown => (0..WHEEL_ROWS).for_each(|_| self.scroll(Action::Down, snapshot)),
            MouseEventKind::Down(_) => self.focus_at(event.column, event.row),
            _ => {}
        }
    }

    fn focus_at(&mut self, column: u16, row: u16) {
        if let Some(screen) = super::draw::tab_at(column, row, self.view.size) {
            self.show(screen);
        } else if let Some(side) = super::draw::arm_at(self.view.screen, row, self.view.size)
            && side != self.view.side
        {
            (self.view.side, self.view.mark) = (side, None);
        }
    }

    /// The terminal has another size: selection and dialog stay.
    pub fn on_resize(&mut self, columns: u16, rows: u16) {
        self.view.size = (columns, rows);
    }

    /// True once the operator has pressed a stop key.
    #[must_use]
    pub const fn stop_key_pressed(&self) -> bool {
        self.stop_key_pressed
    }

    /// Tells the operator that something did not work.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.view.message = Some(Message { text: text.into(), refused: true });
    }

    /// Tells the operator that something was done.
    pub fn inform(&mut self, text: impl Into<String>) {
        self.say(text);
    }

    fn say(&mut self, text: impl Into<String>) {
        self.view.message = Some(Message { text: text.into(), refused: false });
    }

    fn on_stop_key(&mut self, action: Action) -> Vec<Reaction> {
        self.stop_key_pressed = true;
        self.close_what_may_move();
        let mut reactions = vec![Reaction::Stop, Reaction::Send(Command::Stop)];
        if action == Action::StopAndQuit {
            if matches!(self.view.dialog, Some(Dialog::Quit { after_stop: true, .. })) {
                reactions.push(Reaction::Leave(ExitReason::QuitAfterStop));
            }
            self.view.dialog = Some(Dialog::Quit { after_stop: true, yes: false });
        }
        reactions
    }

    fn close_what_may_move(&mut self) {
        if self.view.dialog.as_ref().is_some_and(Dialog::may_move) {
            self.view.dialog = None;
        }
    }

    fn on_dialog_key(&mut self, chord: Chord, snapshot: &Snapshot) -> Vec<Reaction> {
        let Some(dialog) = self.view.dialog.as_mut() else { return Vec::new() };
        let answer = dialog.on_key(chord);
        match answer {
            Answer::Stay => return Vec::new(),
            Answer::MoveSetting { row, steps } => return self.move_setting(row, steps, snapshot),
            Answer::UndoSetting { row } => return self.undo_setting(row, snapshot),
            _ => self.view.dialog = None,
        }
        match answer {
            Answer::Send(command) => self.send_confirmed(command, snapshot),
            Answer::Ask(command) => self.ask(command, snapshot),
            Answer::Filter(text) => {
                (self.view.filter, self.view.row) = (text, 0);
                Vec::new()
            }
            Answer::Quit => vec![Reaction::Leave(self.leaving())],
            _ => Vec::new(),
        }
    }

    /// What was confirmed on a screen too small to read what it names is not confirmed.
    fn send_confirmed(&mut self, command: Command, snapshot: &Snapshot) -> Vec<Reaction> {
        if command.may_move() && self.view.tier() == Tier::Line {
            self.complain("the terminal is too small to show what would move: nothing was sent");
            return Vec::new();
        }
        self.send(command, snapshot)
    }

    fn send(&mut self, command: Command, snapshot: &Snapshot) -> Vec<Reaction> {
        let deaf = match snapshot.watermark {
            Watermark::Watch => Some("this screen only watches; it can stop and do nothing else"),
            Watermark::Replay => Some("a recorded trial: nothing can be asked of it"),
            Watermark::Live | Watermark::Demo | Watermark::DryRun => None,
        };
        if let Some(reason) = deaf {
            self.complain(format!("{command}: {reason}"));
            return Vec::new();
        }
        self.say(format!("asked: {command}"));
        vec![Reaction::Send(command)]
    }

    const fn leaving(&self) -> ExitReason {
        if self.stop_key_pressed { ExitReason::QuitAfterStop } else { ExitReason::Quit }
    }

    fn show(&mut self, screen: Screen) {
        if self.view.screen != screen {
            self.view.screen = screen;
            self.view.row = 0;
            self.view.filter.clear();
        }
    }
}
