//! `valet sim`: the simulated Baxter, person and camera as a ROS node.
//!
//! Glues the simulated world to the wire; neither knows the other.

use super::exit::Failure;
use super::output::Output;
use super::sim_images;
use crate::assembly::SwitchRequest;
use crate::body::Side;
use crate::config::{LoadedProfile, Places, Profile, Settings};
use crate::kinematics::JointVector;
use crate::ros::master::{EmbeddedMaster, USUAL_PORT, relay_log};
use crate::ros::simulation::{Senses, SimNode, SimulatedRobot};
use crate::ros::{Node, RosError, environment, leave};
use crate::sim::world::{World, WorldSetup};
use crate::snapshot::Level;
use crate::time::Stamp;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Where the ROS master comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum MasterChoice {
    /// One that runs already, where `ROS_MASTER_URI` says.
    #[default]
    Running,
    /// One inside this process.
    Embedded,
}

/// The simulated Baxter, person and camera as a ROS node.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// Where the ROS master comes from.
    #[arg(long, value_enum, default_value_t)]
    pub(super) master: MasterChoice,
    /// With --master embedded: the port that it listens on, on this machine only.
    #[arg(long, default_value_t = USUAL_PORT, value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) port: u16,
    /// The person: a name or a file.
    #[arg(long)]
    pub(super) profile: Option<String>,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Instead of a robot: write depth images of simulated people with their truth into this folder.
    #[arg(long, value_name = "DIR")]
    pub(super) images: Option<PathBuf>,
    /// With --images: how many.
    #[arg(long, default_value_t = 20, requires = "images")]
    pub(super) count: u64,
}

/// A simulated world behind the robot's topics.
struct WorldOnTheWire(World);

impl SimulatedRobot for WorldOnTheWire {
    fn command_joints(&mut self, side: Side, joints: &JointVector, now: Stamp) {
        self.0.command_joints(side, joints, now);
    }

    fn switch(&mut self, request: SwitchRequest, now: Stamp) {
        self.0.switch(request, now);
    }

    fn set_speed_ratio(&mut self, side: Side, ratio: f64) {
        self.0.set_speed_ratio(side, ratio);
    }

    fn step(&mut self, now: Stamp) -> Senses {
        let output = self.0.step(now);
        Senses {
            endpoints: output.endpoints,
            joints: output.joints,
            robot: output.robot,
            collisions: output.collisions,
            bodies: output.bodies,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(folder) = &arguments.images {
        return sim_images::write(folder, arguments.count, arguments.seed);
    }
    let master = match arguments.master {
        MasterChoice::Running => None,
        MasterChoice::Embedded => Some(embedded_master(arguments.port)?),
    };
    let person = simulated_person(arguments)?;
    let setup = WorldSetup {
        seed: arguments.seed,
        person: person.simulated.clone().unwrap_or_default(),
        garment: person.garment(None).cloned().unwrap_or_default(),
        ..WorldSetup::default()
    };
    let world = World::new(&setup).map_err(Failure::configuration)?;
    let ended = ending_signals()?;
    let node = Node::start("simulated_baxter").map_err(ros_failure)?;
    let relay = master.as_ref().map(|_| relay_log()).transpose().map_err(ros_failure)?;
    let mut robot = SimNode::new(&node, Box::new(WorldOnTheWire(world))).map_err(ros_failure)?;
    let words =
        format!("simulated Baxter {} with seed {} on the master at {}", node.name(), arguments.seed, node.master());
    Output::new(false).line(&words)?;
    node.log(Level::Information, &words);
    robot.run(|| node.is_running() && !ended.load(Ordering::SeqCst));
    leave((robot, relay, node));
    drop(master);
    // A thread that still waits for a master that hangs must not keep the process.
    std::process::exit(0);
}

/// The profile that is named, or the one that settings name.
fn simulated_person(arguments: &Arguments) -> Result<Profile, Failure> {
    let places = Places::of_this_machine();
    let settings = Settings::find(None, &places).map_err(Failure::configuration)?;
    let name = arguments.profile.as_deref().unwrap_or_else(|| settings.profile());
    LoadedProfile::find(name, &places).map(|person| person.profile).map_err(Failure::configuration)
}

/// Starts the embedded master; a process whose environment points elsewhere is started anew in its place.
fn embedded_master(port: u16) -> Result<EmbeddedMaster, Failure> {
    if !environment::is_local(port) {
        let mut again = environment::this_program(std::env::args().skip(1), port).map_err(Failure::fault)?;
        // Only returns where it fails.
        return Err(Failure::fault(again.exec()));
    }
    EmbeddedMaster::start(port).map_err(ros_failure)
}

/// A flag that INT, TERM and HUP set.
pub(super) fn ending_signals() -> Result<Arc<AtomicBool>, Failure> {
    let ended = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM, SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&ended)).map_err(Failure::fault)?;
    }
    Ok(ended)
}

/// The exit code that fits what went wrong with ROS.
pub(super) fn ros_failure(error: RosError) -> Failure {
    match error {
        RosError::NoMaster { .. } => Failure::NoMaster(error.to_string()),
        _ => Failure::Fault(error.to_string()),
    }
}
