//! Table 4.2 of the thesis: twelve people, five experiments each, on the shipped cohort of simulated people.
//!
//! The cohort was calibrated on the shipped simulator so that its trials mirror the table; fresh seeds show how well. It
//! says nothing about other people.

mod cohort;
mod dresser;
mod example;
mod limits;
mod present;
mod run;

pub use cohort::{CohortError, EXPERIMENTS, Participant, ThesisRow, cohort};
pub use dresser::{ContactRecord, DressingRecord, PLANNING_SECONDS, PassRecord, dress, dress_with};
pub use example::worked_example;
pub use limits::figures_5_real;
pub use present::{duration_by_iteration, energy_by_iteration, run};
pub use run::{CohortRow, SERIES, TableError, experiments, table};
