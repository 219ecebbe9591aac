//! How a command ends: the exit codes that scripts and launch files rely on.

use std::process::ExitCode;
use thiserror::Error;

/// Exit code of bad arguments or a bad configuration.
pub const BAD_ARGUMENTS: u8 = 2;

/// The table that `--help` closes with.
pub const HELP: &str = "Exit codes: 0 done, 2 bad arguments or configuration, 3 no ROS master, 4 stopped by the operator, \
5 stopped by a safety verdict, 6 fault";

/// Why a command did not end well. The text says what happened, to what, and what to do now.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Failure {
    /// An argument, a profile or another file is not usable.
    #[error("{0}")]
    Configuration(String),
    /// No ROS master answers.
    #[error("{0}")]
    NoMaster(String),
    /// The operator stopped the trial.
    #[error("stopped by the operator: {0}")]
    OperatorStop(String),
    /// A safety verdict stopped the trial.
    #[error("stopped for safety: {0}")]
    SafetyStop(String),
    /// Something broke.
    #[error("{0}")]
    Fault(String),
}

impl Failure {
    /// A failure of configuration from any error that explains itself.
    pub fn configuration(error: impl std::fmt::Display) -> Self {
        Self::Configuration(error.to_string())
    }

    /// A fault from any error that explains itself.
    pub fn fault(error: impl std::fmt::Display) -> Self {
        Self::Fault(error.to_string())
    }

    /// The exit code of this failure.
    #[must_use]
    pub fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Configuration(_) => BAD_ARGUMENTS,
            Self::NoMaster(_) => 3,
            Self::OperatorStop(_) => 4,
            Self::SafetyStop(_) => 5,
            Self::Fault(_) => 6,
        })
    }
}
