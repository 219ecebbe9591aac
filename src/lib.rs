//! valet runs robot-assisted dressing trials on a Baxter: a ROS 1 node with a terminal console.
//!
//! # The map of the house
//!
//! Everything that decides is a **pure core that is stepped**: no clock, no thread, no file, no socket and no random
//! source of its own. Time and seeds come in as arguments, so one and the same core drives the robot, the simulated
//! robot, a replay and ten thousand simulated trials. Rooms may use only what stands above them in this list
//! (`docs/architecture.md` holds the exact edges, `tests/architecture.rs` enforces them):
//!
//! - ground floor: [`time`], [`geometry`], [`body`];
//! - the pure core: `sensing` (force windows, freshness), `vision` (depth image to joints), `modelling` (movement space),
//!   `planning` (way-points, optimisers), `strategy` (how a path learns), `kinematics` (the arms), `safety` (verdicts),
//!   `sequencing` (the steps of a trial), `supervisor` (owns them all), `snapshot` and `command` (what may be seen and asked);
//! - the border: `robot` (ports to limbs and senses, and the guards that refuse);
//! - adapters, of which none knows another: `ros`, `sim`, `record`;
//! - the shell: `engine` (threads), `console` (the screen), `headless`, `experiments` and `report`, `config`, [`cli`].
//!
//! What this library never does: move anything after a stop without Reset, Enable and Start, each an act of the operator.

pub mod assembly;
pub mod body;
pub mod cli;
pub mod command;
pub mod config;
pub mod console;
pub mod engine;
pub mod experiments;
pub mod geometry;
pub mod headless;
pub mod kinematics;
pub mod modelling;
pub mod planning;
pub mod record;
pub mod report;
pub mod robot;
pub mod ros;
pub mod safety;
pub mod sensing;
pub mod sequencing;
pub mod sim;
pub mod snapshot;
pub mod strategy;
pub mod supervisor;
pub mod time;
pub mod vision;
