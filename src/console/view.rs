//! What the operator looks at: screen, dialog, filters, zoom, freeze and selection.
//!
//! Nothing here touches the robot or the terminal.

use super::dialog::Dialog;
use super::keymap::Screen;
use crate::body::Side;
use crate::snapshot::{Level, LogLine, Snapshot};
use std::collections::BTreeSet;

/// Seconds that the force plots show at first.
pub(super) const USUAL_SPAN: f64 = 10.0;
/// The shortest and the longest time that they can show, in seconds.
pub(super) const SPAN_LIMITS: (f64, f64) = (1.25, 60.0);

/// A line for the operator about the last key, and whether it tells of something that did not work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What.
    pub text: String,
    /// True where something was refused or failed.
    pub refused: bool,
}

/// Which lines of the log are shown.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LogFilter {
    /// The least grave level.
    pub minimum: Level,
    /// The only source that is shown.
    pub solo: Option<String>,
    /// Sources that are not shown.
    pub muted: BTreeSet<String>,
    /// True where the text filter hides what it finds.
    pub inverted: bool,
}

/// What the operator looks at.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the operator, independent of the others")]
pub struct ViewState {
    /// The screen.
    pub screen: Screen,
    /// What is asked, chosen, typed or explained on top of it.
    pub dialog: Option<Dialog>,
    /// Columns and rows of the terminal.
    pub size: (u16, u16),
    /// The side that has the focus.
    pub side: Side,
    /// What plots, paths and log show instead of the newest snapshot.
    pub frozen: Option<Box<Snapshot>>,
    /// Seconds that the force plots show.
    pub span: f64,
    /// True where the force axis keeps to the tiers instead of fitting the data.
    pub fixed_scale: bool,
    /// The selected resistance of the focused side, counted back from the newest.
    pub mark: Option<usize>,
    /// The filter of the screen's list.
    pub filter: String,
    /// How far the screen's list is scrolled or which row is selected, from the top.
    pub row: usize,
    /// True where the log follows its newest line.
    pub follow: bool,
    /// Which lines of the log are shown.
    pub log: LogFilter,
    /// True where the way-point table takes the larger part of the path screen.
    pub large_table: bool,
    /// True where the mouse focuses and scrolls.
    pub mouse: bool,
    /// About the last key.
    pub message: Option<Message>,
    /// Seconds since the core said anything, where that is too long.
    pub silence: Option<f64>,
}

impl Default for ViewState {
    fn default() -> Self {
        Self {
            screen: Screen::default(),
            dialog: None,
            size: (80, 24),
            side: Side::Right,
            frozen: None,
            span: USUAL_SPAN,
            fixed_scale: false,
            mark: None,
            filter: String::new(),
            row: 0,
            follow: true,
            log: LogFilter { minimum: Level::Information, ..LogFilter::default() },
            large_table: false,
            mouse: false,
            message: None,
            silence: None,
        }
    }
}

/// How much fits on the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// One line with the stop state.
    Line,
    /// 40 x 10 and more: stop banner, force numbers, step.
    Compact,
    /// 80 x 24 and more.
    Standard,
    /// 120 x 40 and more.
    Wide,
}

impl Tier {
    /// The tier of a size in columns and rows.
    #[must_use]
    pub const fn of(columns: u16, rows: u16) -> Self {
        if columns >= 120 && rows >= 40 {
            Self::Wide
        } else if columns >= 80 && rows >= 24 {
            Self::Standard
        } else if columns >= 40 && rows >= 10 {
            Self::Compact
        } else {
            Self::Line
        }
    }
}

impl ViewState {
    /// The tier of the present size.
    #[must_use]
    pub const fn tier(&self) -> Tier {
        Tier::of(self.size.0, self.size.1)
    }

    /// What plots, paths and log show: the frozen snapshot, or the live one.
    #[must_use]
    pub fn shown<'a>(&'a self, live: &'a Snapshot) -> &'a Snapshot {
        self.frozen.as_deref().unwrap_or(live)
    }

    /// True where a text passes the filter of the screen.
    #[must_use]
    pub fn passes(&self, text: &str) -> bool {
        self.filter.is_empty() || text.to_lowercase().contains(&self.filter.to_lowercase())
    }

    /// True where a line of the log is shown.
    #[must_use]
    pub fn shows_line(&self, line: &LogLine) -> bool {
        let source = self.log.solo.as_ref().map_or(!self.log.muted.contains(&line.source), |solo| *solo == line.source);
        let found = self.filter.is_empty() || self.passes(&line.text) || self.passes(&line.source);
        line.level >= self.log.minimum && source && (found != (self.log.inverted && !self.filter.is_empty()))
    }

    /// The lines of the log that are shown, oldest first.
    #[must_use]
    pub fn log_lines<'a>(&'a self, snapshot: &'a Snapshot) -> impl DoubleEndedIterator<Item = &'a LogLine> {
        snapshot.log.iter().filter(|line| self.shows_line(line))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::Stamp;

    fn line(level: Level, source: &str, text: &str) -> LogLine {
        LogLine { id: 0, stamp: Stamp::ZERO, level, source: source.into(), text: text.into() }
    }

    #[test]
    fn the_log_filters_by_level_source_and_text() {
        let mut view = ViewState::default();
        assert!(!view.shows_line(&line(Level::Debug, "ros", "a")));
        view.log.muted.insert("ros".into());
        assert!(!view.shows_line(&line(Level::Error, "ros", "a")));
        view.log.solo = Some("ros".into());
        assert!(view.shows_line(&line(Level::Error, "ros", "a")));
        assert!(!view.shows_line(&line(Level::Error, "safety", "a")));
        view.filter = "SLEEVE".into();
        assert!(view.shows_line(&line(Level::Error, "ros", "the sleeve caught")));
        view.log.inverted = true;
        assert!(!view.shows_line(&line(Level::Error, "ros", "the sleeve caught")));
        assert!(view.shows_line(&line(Level::Error, "ros", "master lost")));
    }

    #[test]
    fn tiers_follow_the_size() {
        assert_eq!(Tier::of(120, 40), Tier::Wide);
        assert_eq!(Tier::of(200, 39), Tier::Standard);
        assert_eq!(Tier::of(79, 60), Tier::Compact);
        assert_eq!(Tier::of(39, 60), Tier::Line);
        assert_eq!(Tier::of(0, 0), Tier::Line);
    }
}
