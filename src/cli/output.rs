//! What a command prints: lines for people, or one JSON object a line for programs, and complaints on stderr.
//!
//! A reader that went away (a closed pipe) ends the output without a fuss, as `head` expects it.

use super::exit::Failure;
use serde::Serialize;
use std::io::{self, Write};

/// Where results go.
#[derive(Debug)]
pub struct Output {
    json: bool,
    stdout: io::Stdout,
}

impl Output {
    /// Output on stdout, as JSON where `json` is set.
    #[must_use]
    pub fn new(json: bool) -> Self {
        Self { json, stdout: io::stdout() }
    }

    /// True where programs read: nothing but JSON objects may then be printed.
    #[must_use]
    pub const fn is_json(&self) -> bool {
        self.json
    }

    /// Prints a line for people; nothing where programs read.
    ///
    /// # Errors
    /// A [`Failure::Fault`] where stdout cannot be written to, for another reason than that its reader went away.
    pub fn line(&mut self, text: impl AsRef<str>) -> Result<(), Failure> {
        if self.json { Ok(()) } else { self.write(text.as_ref()) }
    }

    /// Prints an event as one JSON object on a line; nothing where people read.
    ///
    /// # Errors
    /// A [`Failure::Fault`] where the event cannot be put into JSON or stdout cannot be written to.
    pub fn event(&mut self, event: &impl Serialize) -> Result<(), Failure> {
        if !self.json {
            return Ok(());
        }
        let text = serde_json::to_string(event).map_err(Failure::fault)?;
        self.write(&text)
    }

    fn write(&mut self, text: &str) -> Result<(), Failure> {
        match writeln!(self.stdout, "{text}") {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                Err(Failure::Fault(format!("cannot write to standard output: {error}")))
            }
            _ => Ok(()),
        }
    }
}

/// Reports a failure on stderr: the one place where a command does so.
pub fn complain(failure: &Failure) {
    // Nothing can be done where even stderr is gone.
    let _ = writeln!(io::stderr(), "valet: {failure}");
}
