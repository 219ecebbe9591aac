//! What lies on top of a screen: questions, lists, text fields, settings and help, and how keys act on them.
//!
//! Every question about motion has No as its default. Nothing here sends anything: a dialog answers with what to do.

use super::keymap::Chord;
use crate::command::Command;
use ratatui::crossterm::event::KeyCode;

/// What lies on top of the screen.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    /// A question before a command. `yes` is false at first.
    Confirm {
        /// What is asked.
        question: String,
        /// What will move, in words; empty where nothing will.
        moves: String,
        /// The command that Yes sends.
        command: Command,
        /// True while Yes has the focus.
        yes: bool,
    },
    /// A word to be typed before a command.
    TypedWord {
        /// What is asked.
        question: String,
        /// The word.
        word: &'static str,
        /// What is typed so far.
        typed: String,
        /// The command that it sends.
        command: Command,
    },
    /// One of several commands.
    Choice {
        /// What is chosen.
        title: String,
        /// The choices: name, explanation and command.
        items: Vec<ChoiceItem>,
        /// The one that has the focus.
        selected: usize,
    },
    /// A text.
    Text {
        /// What for.
        purpose: TextPurpose,
        /// What is typed so far.
        typed: String,
    },
    /// Settings that can be changed live; the row that has the focus.
    Settings {
        /// Which row.
        selected: usize,
    },
    /// The key table, this screen first.
    Help {
        /// How far it is scrolled.
        row: usize,
        /// What is searched for.
        filter: String,
        /// True while the search is typed.
        typing: bool,
    },
    /// Whether to leave. `yes` is false at first.
    Quit {
        /// True where it follows an emergency stop: the same key again then quits.
        after_stop: bool,
        /// True while Yes has the focus.
        yes: bool,
    },
}

/// One line of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct ChoiceItem {
    /// Its name.
    pub name: String,
    /// What it means, or why it is refused.
    pub note: String,
    /// What it sends; `None` where it cannot be chosen now.
    pub command: Option<Command>,
}

/// What a text is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextPurpose {
    /// A note for the record.
    Note,
    /// The filter of the screen's list.
    Filter,
}

/// What a key did to a dialog.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// It stays.
    Stay,
    /// It closes and nothing happens.
    Close,
    /// It closes; this is to be sent, the operator having confirmed it.
    Send(Command),
    /// It closes; this is to be asked for in its turn.
    Ask(Command),
    /// A setting is to be moved by so many of its steps.
    MoveSetting {
        /// Which row.
        row: usize,
        /// Steps, positive or negative.
        steps: i8,
    },
    /// A setting's last change is to be undone.
    UndoSetting {
        /// Which row.
        row: usize,
    },
    /// The filter is to be this.
    Filter(String),
    /// The console is to be left.
    Quit,
}

/// The longest text that a field takes, in characters.
const TEXT_LIMIT: usize = 200;

impl Dialog {
    /// A question before a command; No has the focus.
    #[must_use]
    pub fn confirm(question: impl Into<String>, moves: impl Into<String>, command: Command) -> Self {
        Self::Confirm { question: question.into(), moves: moves.into(), command, yes: false }
    }

    /// True where an answer could set the robot in motion: such a dialog closes at a stop.
    #[must_use]
    pub fn may_move(&self) -> bool {
        match self {
            Self::Confirm { command, .. } | Self::TypedWord { command, .. } => command.may_move(),
            Self::Choice { items, .. } => items.iter().any(|item| item.command.as_ref().is_some_and(Command::may_move)),
            Self::Text { .. } | Self::Settings { .. } | Self::Help { .. } | Self::Quit { .. } => false,
        }
    }

    /// What a key does. Stop keys never come here.
    pub fn on_key(&mut self, chord: Chord) -> Answer {
        if chord.code() == KeyCode::Esc {
            return self.on_escape();
        }
        match self {
            Self::Confirm { yes, command, .. } => on_question(chord, yes, || Answer::Send(command.clone())),
            Self::Quit { yes, .. } => on_question(chord, yes, || Answer::Quit),
            Self::TypedWord { word, typed, command, .. } => on_word(chord, word, typed, command),
            Self::Choice { items, selected, .. } => on_choice(chord, items, selected),
            Self::Text { purpose, typed } => on_text(chord, *purpose, typed),
            Self::Settings { selected } => on_settings(chord, selected),
            Self::Help { row, filter, typing } => on_help(chord, row, filter, typing),
        }
    }

    fn on_escape(&mut self) -> Answer {
        match self {
            Self::Help { filter, typing, row } if !filter.is_empty() || *typing => {
                (*typing, *row) = (false, 0);
                filter.clear();
                Answer::Stay
            }
            Self::Text { purpose: TextPurpose::Filter, .. } => Answer::Filter(String::new()),
            _ => Answer::Close,
        }
    }
}

fn on_question(chord: Chord, yes: &mut bool, accepted: impl FnOnce() -> Answer) -> Answer {
    match (chord.code(), chord.letter()) {
        (KeyCode::Enter, _) => return if *yes { accepted() } else { Answer::Close },
        (KeyCode::Left | KeyCode::Right | KeyCode::Tab | KeyCode::BackTab, _) => *yes = !*yes,
        (_, Some('y')) => *yes = true,
        (_, Some('n')) => *yes = false,
        _ => {}
    }
    Answer::Stay
}

fn on_word(chord: Chord, word: &str, typed: &mut String, command: &Command) -> Answer {
    if chord.code() == KeyCode::Enter {
        return if typed == word { Answer::Send(command.clone()) } else { Answer::Stay };
    }
    edit(chord, typed);
    Answer::Stay
}

fn on_choice(chord: Chord, items: &[ChoiceItem], selected: &mut usize) -> Answer {
    if chord.code() == KeyCode::Enter {
        let command = items.get(*selected).and_then(|item| item.command.clone());
        return command.map_or(Answer::Stay, Answer::Ask);
    }
    move_row(chord, selected, items.len());
    Answer::Stay
}

fn on_text(chord: Chord, purpose: TextPurpose, typed: &mut String) -> Answer {
    if chord.code() == KeyCode::Enter {
        return match purpose {
            TextPurpose::Filter => Answer::Filter(typed.clone()),
            TextPurpose::Note if typed.is_empty() => Answer::Close,
            // Space is the stop key even here, so that an underscore stands for it.
            TextPurpose::Note => Answer::Send(Command::Note(typed.replace('_', " "))),
        };
    }
    edit(chord, typed);
    Answer::Stay
}

fn on_settings(chord: Chord, selected: &mut usize) -> Answer {
    match (chord.code(), chord.letter()) {
        (KeyCode::Right, _) | (_, Some('+' | '=' | 'l')) => Answer::MoveSetting { row: *selected, steps: 1 },
        (KeyCode::Left, _) | (_, Some('-' | 'h')) => Answer::MoveSetting { row: *selected, steps: -1 },
        (_, Some('u')) => Answer::UndoSetting { row: *selected },
        (KeyCode::Enter, _) | (_, Some(',' | 'q')) => Answer::Close,
        _ => {
            move_row(chord, selected, usize::MAX);
            Answer::Stay
        }
    }
}

fn on_help(chord: Chord, row: &mut usize, filter: &mut String, typing: &mut bool) -> Answer {
    if *typing {
        if chord.code() == KeyCode::Enter {
            *typing = false;
        } else {
            *row = 0;
            edit(chord, filter);
        }
        return Answer::Stay;
    }
    match (chord.code(), chord.letter()) {
        (_, Some('/')) => *typing = true,
        (_, Some('?' | 'q')) | (KeyCode::F(1), _) => return Answer::Close,
        _ => move_row(chord, row, usize::MAX),
    }
    Answer::Stay
}

fn edit(chord: Chord, text: &mut String) {
    match (chord.code(), chord.letter()) {
        (KeyCode::Backspace, _) => drop(text.pop()),
        (KeyCode::Char('u'), None) => text.clear(),
        (_, Some(letter)) if !letter.is_whitespace() && text.chars().count() < TEXT_LIMIT => text.push(letter),
        _ => {}
    }
}

/// Moves a selection or a scroll position by the keys that move.
pub(super) fn move_row(chord: Chord, row: &mut usize, count: usize) {
    const PAGE: usize = 10;
    let last = count.saturating_sub(1);
    *row = match (chord.code(), chord.letter()) {
        (KeyCode::Up, _) | (_, Some('k')) => row.saturating_sub(1),
        (KeyCode::Down, _) | (_, Some('j')) => row.saturating_add(1),
        (KeyCode::PageUp, _) => row.saturating_sub(PAGE),
        (KeyCode::PageDown, _) => row.saturating_add(PAGE),
        (KeyCode::Home, _) | (_, Some('g')) => 0,
        (KeyCode::End, _) | (_, Some('G')) if count != usize::MAX => last,
        _ => *row,
    }
    .min(last);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn press(dialog: &mut Dialog, keys: &[&str]) -> Answer {
        keys.iter().map(|key| dialog.on_key(Chord::parse(key).unwrap())).last().unwrap()
    }

    #[test]
    fn the_answer_that_does_nothing_is_the_default() {
        let mut dialog = Dialog::confirm("Start?", "both arms", Command::Start);
        assert_eq!(press(&mut dialog, &["enter"]), Answer::Close);
        assert_eq!(press(&mut dialog, &["y", "enter"]), Answer::Send(Command::Start));
        assert_eq!(press(&mut dialog, &["esc"]), Answer::Close);
        let mut quit = Dialog::Quit { after_stop: false, yes: false };
        assert_eq!(press(&mut quit, &["enter"]), Answer::Close);
        assert_eq!(press(&mut quit, &["tab", "enter"]), Answer::Quit);
    }

    #[test]
    fn only_the_whole_word_resets() {
        let question = String::from("Reset?");
        let mut dialog = Dialog::TypedWord { question, word: "reset", typed: String::new(), command: Command::Reset };
        assert_eq!(press(&mut dialog, &["enter"]), Answer::Stay);
        assert_eq!(press(&mut dialog, &["r", "e", "s", "x", "enter"]), Answer::Stay);
        assert_eq!(press(&mut dialog, &["backspace", "e", "t", "enter"]), Answer::Send(Command::Reset));
    }

    #[test]
    fn a_note_takes_an_underscore_for_a_space() {
        let mut dialog = Dialog::Text { purpose: TextPurpose::Note, typed: String::new() };
        assert_eq!(press(&mut dialog, &["a", "_", "b", "enter"]), Answer::Send(Command::Note("a b".into())));
    }

    #[test]
    fn a_choice_that_cannot_be_made_stays() {
        let item = |command| ChoiceItem { name: "x".into(), note: String::new(), command };
        let items = vec![item(None), item(Some(Command::Hold))];
        let mut dialog = Dialog::Choice { title: "t".into(), items, selected: 0 };
        assert_eq!(press(&mut dialog, &["enter"]), Answer::Stay);
        assert_eq!(press(&mut dialog, &["j", "j", "j", "enter"]), Answer::Ask(Command::Hold));
    }

    #[test]
    fn escape_in_help_clears_the_search_first() {
        let mut dialog = Dialog::Help { row: 0, filter: String::new(), typing: false };
        assert_eq!(press(&mut dialog, &["/", "q", "esc"]), Answer::Stay);
        assert_eq!(press(&mut dialog, &["esc"]), Answer::Close);
    }
}
