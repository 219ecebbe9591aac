//! What the operator does to the view alone: screens, scrolling, zoom, freeze, filters, marks, and leaving.

use super::{App, Reaction};
use crate::command::Command;
use crate::console::ExitReason;
use crate::console::dialog::{Dialog, TextPurpose};
use crate::console::keymap::{Action, Screen};
use crate::console::view::{SPAN_LIMITS, USUAL_SPAN};
use crate::snapshot::{Level, Snapshot, Watermark};

const PAGE: usize = 10;

impl App {
    /// An action that changes nothing but the view.
    pub(super) fn look(&mut self, action: Action, snapshot: &Snapshot) -> Vec<Reaction> {
        match action {
            Action::Trial => self.show(Screen::Trial),
            Action::Force => self.show(Screen::Force),
            Action::Path => self.show(Screen::Path),
            Action::Strategies => self.show(Screen::Strategies),
            Action::Health => self.show(Screen::Health),
            Action::Log => self.show(Screen::Log),
            Action::Left => self.show_neighbour(Screen::ALL.len() - 1),
            Action::Right => self.show_neighbour(1),
            Action::NextPane | Action::PreviousPane => {
                self.view.side = self.view.side.other();
                self.view.mark = None;
            }
            Action::Freeze => self.freeze(snapshot),
            Action::ZoomIn => self.zoom(self.view.span / 2.0),
            Action::ZoomOut => self.zoom(self.view.span * 2.0),
            Action::ZoomReset => self.zoom(USUAL_SPAN),
            Action::FixedScale => self.view.fixed_scale = !self.view.fixed_scale,
            Action::Waypoints => self.view.large_table = !self.view.large_table,
            Action::PreviousMark | Action::NextMark => self.select_mark(action, snapshot),
            Action::OpenMark => self.open_mark(snapshot),
            Action::Filter => {
                let typed = self.view.filter.clone();
                return self.open(Dialog::Text { purpose: TextPurpose::Filter, typed });
            }
            Action::Help => return self.open(Dialog::Help { row: 0, filter: String::new(), typing: false }),
            Action::Back => self.back(),
            Action::Redraw => return vec![Reaction::Redraw],
            Action::Mouse => return self.toggle_mouse(),
            Action::Suspend => return self.suspend(snapshot),
            Action::Quit => return self.quit(snapshot),
            Action::LogLevel | Action::LogSolo | Action::LogMute | Action::LogInvert => {
                self.filter_log(action, snapshot);
            }
            other => self.scroll(other, snapshot),
        }
        Vec::new()
    }

    fn show_neighbour(&mut self, step: usize) {
        let index = (self.view.screen as usize + step) % Screen::ALL.len();
        if let Some(screen) = Screen::ALL.get(index) {
            self.show(*screen);
        }
    }

    fn freeze(&mut self, snapshot: &Snapshot) {
        self.view.frozen = match self.view.frozen.take() {
            Some(_) => None,
            None => Some(Box::new(snapshot.clone())),
        };
    }

    fn zoom(&mut self, span: f64) {
        self.view.span = span.clamp(SPAN_LIMITS.0, SPAN_LIMITS.1);
    }

    fn back(&mut self) {
        if !self.view.filter.is_empty() {
            self.view.filter.clear();
        } else if self.view.frozen.is_some() {
            self.view.frozen = None;
        } else if self.view.mark.is_some() {
            self.view.mark = None;
        } else {
            self.show(Screen::Trial);
        }
    }

    fn toggle_mouse(&mut self) -> Vec<Reaction> {
        self.view.mouse = !self.view.mouse;
        self.say(if self.view.mouse { "mouse on: it focuses and scrolls, nothing else" } else { "mouse off" });
        vec![Reaction::Mouse(self.view.mouse)]
    }

    fn suspend(&mut self, snapshot: &Snapshot) -> Vec<Reaction> {
        // A robot that was heard once and is silent now may still be enabled.
        let disabled =
            snapshot.robot.fresh(snapshot.now).map_or(snapshot.robot.state.is_none(), |robot| !robot.enabled);
        let not_ours = matches!(snapshot.watermark, Watermark::Watch | Watermark::Replay);
        let still = not_ours || (disabled && !snapshot.trial.phase.is_running());
        if still {
            return vec![Reaction::Suspend];
        }
        self.complain("not while an arm may move: hold, end the trial and disable the robot first");
        Vec::new()
    }

    fn quit(&mut self, snapshot: &Snapshot) -> Vec<Reaction> {
        let own = !matches!(snapshot.watermark, Watermark::Watch | Watermark::Replay);
        if !own || !snapshot.trial.phase.is_running() {
            return vec![Reaction::Leave(self.leaving_after(snapshot))];
        }
        self.view.dialog = Some(Dialog::Quit { after_stop: false, yes: false });
        if snapshot.trial.phase.moves() { vec![Reaction::Send(Command::Hold)] } else { Vec::new() }
    }

    const fn leaving_after(&self, snapshot: &Snapshot) -> ExitReason {
        if self.stop_key_pressed && snapshot.stop.latched { ExitReason::QuitAfterStop } else { ExitReason::Quit }
    }

    pub(super) fn scroll(&mut self, action: Action, snapshot: &Snapshot) {
        let last = self.row_count(snapshot).saturating_sub(1);
        if self.view.screen == Screen::Log && self.view.follow {
            self.view.row = last;
        }
        self.view.row = self.view.row.min(last);
        match action {
            Action::Up => self.scroll_up(1),
            Action::Down => self.view.row = (self.view.row + 1).min(last),
            Action::PageUp => self.scroll_up(PAGE),
            Action::PageDown => self.view.row = (self.view.row + PAGE).min(last),
            Action::Top => self.scroll_up(usize::MAX),
            Action::Bottom => (self.view.row, self.view.follow) = (last, true),
            _ => {}
        }
    }

    fn scroll_up(&mut self, rows: usize) {
        self.view.row = self.view.row.saturating_sub(rows);
        self.view.follow = false;
    }

    fn row_count(&self, snapshot: &Snapshot) -> usize {
        let shown = self.view.shown(snapshot);
        match self.view.screen {
            Screen::Log => self.view.log_lines(shown).count(),
            Screen::Health => snapshot.topics.iter().filter(|topic| self.view.passes(&topic.name)).count(),
            Screen::Path => shown.sides.get(self.view.side).path.changes.len(),
            Screen::Strategies => shown.strategies.len(),
            Screen::Trial | Screen::Force => 0,
        }
    }

    fn select_mark(&mut self, action: Action, snapshot: &Snapshot) {
        let count = self.view.shown(snapshot).sides.get(self.view.side).force.detections.len();
        self.view.mark = match (count, self.view.mark, action) {
            (0, _, _) | (_, Some(0) | None, Action::NextMark) => None,
            (_, None, _) => Some(0),
            (_, Some(mark), Action::NextMark) => Some(mark - 1),
            (_, Some(mark), _) => Some((mark + 1).min(count - 1)),
        };
        if count == 0 {
            self.say(format!("no resistance on the {} arm yet", self.view.side));
        }
    }

    fn open_mark(&mut self, snapshot: &Snapshot) {
        let force = &self.view.shown(snapshot).sides.get(self.view.side).force;
        let line = self.view.mark.and_then(|mark| force.detections.iter().rev().nth(mark)?.log_line);
        let Some(id) = line else {
            let key = self.keys.first_key(Action::PreviousMark);
            return self.say(format!("no resistance is selected: {key} selects the newest"));
        };
        self.show(Screen::Log);
        self.view.filter.clear();
        self.view.log.solo = None;
        self.view.log.muted.clear();
        self.view.log.minimum = Level::Information;
        let row = self.view.log_lines(self.view.shown(snapshot)).position(|line| line.id == id);
        match row {
            Some(row) => (self.view.row, self.view.follow) = (row, false),
            None => self.say(format!("line {id} is no longer in the log on the screen")),
        }
    }

    fn filter_log(&mut self, action: Action, snapshot: &Snapshot) {
        let shown = self.view.shown(snapshot);
        let count = self.view.log_lines(shown).count();
        let row = if self.view.follow { count.saturating_sub(1) } else { self.view.row.min(count.saturating_sub(1)) };
        let source = self.view.log_lines(shown).nth(row).map(|line| line.source.clone());
        let log = &mut self.view.log;
        match action {
            Action::LogLevel => log.minimum = next_level(log.minimum),
            Action::LogSolo => log.solo = if log.solo.is_some() { None } else { source },
            Action::LogMute => match source {
                Some(source) if log.muted.is_empty() => drop(log.muted.insert(source)),
                _ => log.muted.clear(),
            },
            _ => log.inverted = !log.inverted,
        }
    }
}

const fn next_level(level: Level) -> Level {
    match level {
        Level::Debug => Level::Information,
        Level::Information => Level::Warning,
        Level::Warning => Level::Error,
        Level::Error => Level::Debug,
    }
}
