//! `valet keys`: the table of keys, as the console uses it.

use super::exit::Failure;
use super::output::Output;
use crate::console::{self, ConsoleOptions, KeyMap, Practice, StopHandle, TABLE};
use serde::Serialize;
use std::sync::Arc;

/// The table of keys.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// Print the table (this is what the command does; the option says it plainly in scripts).
    #[arg(long)]
    list: bool,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
    /// Practise the keys at a made-up trial that is connected to nothing.
    #[arg(long, conflicts_with_all = ["list", "json"])]
    practise: bool,
}

/// One row of the table for programs.
#[derive(Serialize)]
struct Row<'a> {
    event: &'a str,
    action: &'a str,
    keys: Vec<String>,
    scope: String,
    guard: &'a str,
    text: &'a str,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.practise {
        return practise();
    }
    let keys = KeyMap::new(&ConsoleOptions::default().keys).map_err(Failure::configuration)?;
    let mut output = Output::new(arguments.json);
    for entry in TABLE {
        let names = keys.keys_of(entry.action);
        let scope = entry.scope.words();
        let guard = entry.guard.words();
        let asks = if guard.is_empty() { String::new() } else { format!(" ({guard})") };
        output.line(format!("{:<20} {:<16} {:<44} {}{asks}", names.join(" "), entry.name, scope, entry.text))?;
        output.event(&Row { event: "key", action: entry.name, keys: names, scope, guard, text: entry.text })?;
    }
    Ok(())
}

fn practise() -> Result<(), Failure> {
    let practice = Practice::new();
    let stop: Arc<dyn StopHandle> = Arc::new(practice.clone());
    let left = console::run(practice.clone(), practice, &stop, None, &ConsoleOptions::default());
    left.map(|_| ()).map_err(Failure::fault)
}

/// The key table as lines of text, for the man page.
pub(super) fn as_text() -> String {
    let row = |entry: &crate::console::Entry| format!("{:<12} {}", entry.keys.join(" "), entry.text);
    TABLE.iter().map(row).collect::<Vec<_>>().join("\n")
}
