//! Another person or garment before a trial: the program begins anew with it, so that nothing of the one before is left.

use super::exit::Failure;
use crate::command::Command;
use crate::console::CommandSink;
use std::os::unix::process::CommandExt;
use std::sync::{Arc, OnceLock};

/// What was chosen, as the option that chooses it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Choice {
    option: &'static str,
    value: String,
}

/// Where the screen leaves its choice.
pub(super) type Chosen = Arc<OnceLock<Choice>>;

/// Keeps the choice of a person or a garment and hands everything else over.
pub(super) struct Choosing<S> {
    pub(super) inner: S,
    pub(super) chosen: Chosen,
}

impl<S: CommandSink> CommandSink for Choosing<S> {
    fn send(&mut self, command: Command) -> Result<(), String> {
        let choice = match command {
            Command::SelectProfile(value) => Choice { option: "--profile", value },
            Command::SelectGarment(value) => {
                Choice { option: garment_option(std::env::args().nth(1).as_deref()), value }
            }
            other => return self.inner.send(other),
        };
        self.chosen.set(choice).map_err(|_| "another choice is being taken up".into())
    }

    fn begins_anew(&self) -> bool {
        self.chosen.get().is_some()
    }
}

/// The option that names the garment: the demo's `--garment` names the model by which it is simulated.
fn garment_option(command: Option<&str>) -> &'static str {
    if command == Some("console") { "--garment" } else { "--garment-name" }
}

/// Takes the place of this process with a new one that has the choice. Only returns where that fails.
pub(super) fn begin(chosen: &Chosen) -> Result<(), Failure> {
    let Some(choice) = chosen.get() else { return Ok(()) };
    let typed = with_choice(std::env::args().skip(1), choice);
    let program = std::env::current_exe().map_err(Failure::fault)?;
    Err(Failure::fault(std::process::Command::new(program).args(typed).exec()))
}

/// The arguments with the choice in the place of an earlier one. A garment belongs to a person, and a port to one run.
fn with_choice(typed: impl Iterator<Item = String>, choice: &Choice) -> Vec<String> {
    let mut kept = Vec::new();
    let mut typed = typed.peekable();
    while let Some(argument) = typed.next() {
        let named = kept.first().map(String::as_str);
        let garment = garment_option(named);
        let dropped = |option: &str| {
            option == choice.option || option == "--port" || (option == garment && choice.option == "--profile")
        };
        match argument.split_once('=') {
            Some((option, _)) if dropped(option) => {}
            None if dropped(&argument) => drop(typed.next()),
            _ => kept.push(argument),
        }
    }
    if kept.first().is_none_or(|first| first.starts_with('-')) {
        kept.insert(0, "demo".into());
    }
    kept.extend([choice.option.to_owned(), choice.value.clone()]);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(typed: &[&str], option: &'static str, value: &str) -> Vec<String> {
        let choice = Choice { option, value: value.into() };
        with_choice(typed.iter().map(|text| (*text).to_owned()), &choice)
    }

    #[test]
    fn the_choice_takes_the_place_of_the_one_before() {
        let typed = ["console", "--profile", "anna", "--garment=coat", "--seed", "3", "__name:=left"];
        assert_eq!(after(&typed, "--profile", "ben"), ["console", "--seed", "3", "__name:=left", "--profile", "ben"]);
        let kept = ["console", "--profile", "anna", "--seed", "3", "__name:=left", "--garment", "gown"];
        assert_eq!(after(&typed, "--garment", "gown"), kept);
        let demo = ["demo", "--garment", "cloth", "--garment-name", "gown", "--port", "4711"];
        assert_eq!(after(&demo, "--profile", "ben"), ["demo", "--garment", "cloth", "--profile", "ben"]);
        let named = ["demo", "--garment", "cloth", "--garment-name", "coat"];
        assert_eq!(after(&demo, "--garment-name", "coat"), named);
        assert_eq!(after(&["demo", "--port", "4711"], "--profile", "ben"), ["demo", "--profile", "ben"]);
        assert_eq!(after(&[], "--profile", "ben"), ["demo", "--profile", "ben"]);
    }

    #[test]
    fn only_a_choice_of_person_or_garment_begins_anew() {
        let mut sent = Vec::new();
        let inner = |command: Command| {
            sent.push(command);
            Ok(())
        };
        let mut sink = Choosing { inner, chosen: Chosen::default() };
        sink.send(Command::Hold).unwrap();
        assert!(!sink.begins_anew());
        sink.send(Command::SelectProfile("ben".into())).unwrap();
        assert!(sink.begins_anew());
        assert_eq!(sent, [Command::Hold]);
    }
}
