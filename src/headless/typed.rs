//! Commands that are typed as lines: for a run without a screen, for screen readers and for scripts.
//!
//! Only reads words; whether a command is carried out is the supervisor's decision.

use crate::body::Side;
use crate::command::Command;
use crate::strategy::StrategyKind;
use serde::Deserialize;
use serde_json::Value;
use thiserror::Error;

/// What may be typed, for help.
pub const WORDS: &str = "stop, hold, continue, abort, withdraw, go-ahead, finish-after-this, next-iteration, next-step, \
previous-step, reset, enable, disable, start, strategy NAME, tare ARM, sign-check ARM, first-arm ARM, garment NAME, \
profile NAME, set KEY VALUE, undo KEY, record-movement ARM SECONDS, recording on|off, note TEXT, quit";

/// A line that was typed.
#[derive(Clone, Debug, PartialEq)]
pub enum Typed {
    /// Something for the supervisor.
    Ask(Command),
    /// The operator leaves.
    Quit,
}

/// A line that is no command.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{line}` is no command: type one of {WORDS}")]
pub struct NoCommand {
    line: String,
}

impl Typed {
    /// Reads a line; `None` where it is empty.
    ///
    /// # Errors
    /// [`NoCommand`] with what may be typed.
    pub fn read(line: &str) -> Result<Option<Self>, NoCommand> {
        let line = line.trim();
        if line.is_empty() {
            return Ok(None);
        }
        if line == "quit" {
            return Ok(Some(Self::Quit));
        }
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let command = if rest.is_empty() { plain(word) } else { with_words(word, rest.trim()) };
        command.map(|command| Some(Self::Ask(command))).ok_or_else(|| NoCommand { line: line.to_owned() })
    }
}

/// A command without anything more to say is typed by its name in the record, with `-` between words.
fn plain(word: &str) -> Option<Command> {
    Command::deserialize(Value::String(word.replace('-', "_"))).ok()
}

fn with_words(word: &str, rest: &str) -> Option<Command> {
    let side = || side_of(rest);
    Some(match word {
        "strategy" => Command::SelectStrategy(StrategyKind::ALL.into_iter().find(|kind| kind.name() == rest)?),
        "tare" => Command::Tare(side()?),
        "sign-check" => Command::SignCheck(side()?),
        "first-arm" => Command::SelectFirstArm(side()?),
        "garment" => Command::SelectGarment(rest.to_owned()),
        "profile" => Command::SelectProfile(rest.to_owned()),
        "undo" => Command::UndoSetting { key: rest.to_owned() },
        "note" => Command::Note(rest.to_owned()),
        "recording" if rest == "on" => Command::SetRecording(true),
        "recording" if rest == "off" => Command::SetRecording(false),
        "set" => {
            let (key, value) = rest.split_once(char::is_whitespace)?;
            Command::SetSetting { key: key.to_owned(), value: finite(value)? }
        }
        "record-movement" => {
            let (side, seconds) = rest.split_once(char::is_whitespace)?;
            Command::RecordMovement { side: side_of(side)?, seconds: finite(seconds)? }
        }
        _ => return None,
    })
}

fn side_of(word: &str) -> Option<Side> {
    Side::BOTH.into_iter().find(|side| side.name() == word)
}

fn finite(word: &str) -> Option<f64> {
    word.trim().parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(line: &str) -> Command {
        match Typed::read(line).unwrap().unwrap() {
            Typed::Ask(command) => command,
            Typed::Quit => panic!("{line} is no way out"),
        }
    }

    #[test]
    fn each_word_of_the_help_is_understood() {
        for words in WORDS.split(", ").filter(|words| *words != "quit") {
            let line = words
                .replace("strategy NAME", "strategy force")
                .replace("ARM", "left")
                .replace("on|off", "off")
                .replace("KEY", "window.threshold_newtons")
                .replace("VALUE", "5")
                .replace("SECONDS", "30");
            asked(&line);
        }
        assert_eq!(Typed::read("quit"), Ok(Some(Typed::Quit)));
    }

    #[test]
    fn commands_are_what_they_say() {
        assert_eq!(asked(" go-ahead "), Command::GoAhead);
        assert_eq!(asked("stop"), Command::Stop);
        assert_eq!(asked("strategy gmm"), Command::SelectStrategy(StrategyKind::Gmm));
        assert_eq!(asked("note the sleeve is caught"), Command::Note("the sleeve is caught".into()));
        assert_eq!(asked("set a.b 2.5"), Command::SetSetting { key: "a.b".into(), value: 2.5 });
    }

    #[test]
    fn an_empty_line_is_nothing_and_nonsense_is_refused_with_what_may_be_typed() {
        assert_eq!(Typed::read("  "), Ok(None));
        for line in ["starts", "start now", "strategy best", "tare both", "set a NaN", "record-movement left soon"] {
            let refused = Typed::read(line).unwrap_err();
            assert!(refused.to_string().contains(line) && refused.to_string().contains("go-ahead"), "{refused}");
        }
    }
}
