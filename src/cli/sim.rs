//! `valet sim`: the simulated Baxter, person and camera as a ROS node.
//!
//! Glues the simulated world to the wire; neither knows the other.

use super::exit::Failure;
use super::faults::FaultArguments;
use super::output::Output;
use super::sim_images;
use crate::assembly::SwitchRequest;
use crate::body::{PerSide, Side};
use crate::config::{LoadedProfile, Places, Profile, Settings};
use crate::geometry::Pose;
use crate::kinematics::JointVector;
use crate::ros::master::{EmbeddedMaster, USUAL_PORT, relay_log};
use crate::ros::simulation::{DepthPicture, Senses, SimNode, SimulatedCamera, SimulatedRobot};
use crate::ros::{Node, RosError, environment, leave};
use crate::sim::camera;
use crate::sim::person::{ArmPoints, SimulatedPerson};
use crate::sim::world::{Backend, World, WorldSetup};
use crate::snapshot::Level;
use crate::time::Stamp;
use crate::vision::Intrinsics;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The seed where none is given.
const DEFAULT_SEED: u64 = 1;

/// Where the ROS master comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum MasterChoice {
    /// One that runs already, where `ROS_MASTER_URI` says.
    #[default]
    Running,
    /// One inside this process.
    Embedded,
}

/// Which model of the garment is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum GarmentModel {
    /// A tube round the movement that the person likes best: fast, smooth, calibrated to the thesis' table 4.2.
    #[default]
    Reduced,
    /// An armhole of cloth round a moving arm: believable, a core's work of its own.
    Cloth,
}

impl GarmentModel {
    /// As it is typed.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Reduced => "reduced",
            Self::Cloth => "cloth",
        }
    }
}

impl From<GarmentModel> for Backend {
    fn from(model: GarmentModel) -> Self {
        match model {
            GarmentModel::Reduced => Self::Reduced,
            GarmentModel::Cloth => Self::Cloth,
        }
    }
}

/// What the simulated skeleton tracker publishes on `/tf`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum SkeletonTracker {
    /// All joints, always: a camera that nothing stands before.
    #[default]
    Steady,
    /// Joints that the robot's grippers hide from the camera are no longer published: their frames go stale.
    Occluded,
    /// No tracker runs: the person's pose must come from depth images.
    None,
}

/// The simulated Baxter, person and camera as a ROS node.
///
/// The private parameters ~profile and ~seed stand in for options that are not typed.
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
    /// Seed of everything random [default: 1].
    #[arg(long)]
    pub(super) seed: Option<u64>,
    /// The model of the garment.
    #[arg(long, value_enum, default_value_t)]
    pub(super) garment: GarmentModel,
    /// What the skeleton tracker publishes on /tf.
    #[arg(long, value_enum, default_value_t)]
    pub(super) skeleton: SkeletonTracker,
    /// The garment, by its name in the profile; the first one there where none is named.
    #[arg(long, value_name = "NAME")]
    pub(super) garment_name: Option<String>,
    /// End when the standard input does: whoever started this simulator is gone then.
    #[arg(long, hide = true)]
    pub(super) until_input_ends: bool,
    /// For so many seconds the person moves both arms about first, as before a first trial: something to record.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    pub(super) exercise: f64,
    #[command(flatten)]
    pub(super) faults: FaultArguments,
    /// Instead of a robot: write depth images of simulated people with their truth into this folder.
    #[arg(long, value_name = "DIR")]
    pub(super) images: Option<PathBuf>,
    /// With --images: how many.
    #[arg(long, default_value_t = 20, requires = "images")]
    pub(super) count: u64,
}

/// A simulated world behind the robot's topics.
struct WorldOnTheWire {
    world: World,
    seen: SeenArms,
    has_tracker: bool,
}

/// Where the person's arms are, for the camera, which takes its pictures in a thread of its own; `None` where a fault keeps
/// it from taking any.
type SeenArms = Arc<Mutex<Option<PerSide<ArmPoints>>>>;

/// The camera on the robot's head.
struct HeadCamera {
    person: SimulatedPerson,
    seen: SeenArms,
    intrinsics: Intrinsics,
    seed: u64,
}

impl SimulatedCamera for HeadCamera {
    fn mount(&self) -> Pose {
        camera::robot_mount()
    }

    fn picture(&mut self) -> Option<DepthPicture> {
        let arms = (*self.seen.lock().unwrap_or_else(PoisonError::into_inner))?;
        // Each picture has noise of its own.
        self.seed = self.seed.wrapping_add(1);
        let view = camera::view(&self.person, &arms, &self.intrinsics, &self.mount(), self.seed);
        let Intrinsics { fx, fy, cx, cy } = self.intrinsics;
        let pixels = |count: usize| u32::try_from(count).unwrap_or_default();
        Some(DepthPicture {
            size: (pixels(view.depth.width()), pixels(view.depth.height())),
            millimetres: view.depth.millimetres().to_vec(),
            intrinsics: [fx, fy, cx, cy],
        })
    }
}

impl SimulatedRobot for WorldOnTheWire {
    fn command_joints(&mut self, side: Side, joints: &JointVector, now: Stamp) {
        self.world.command_joints(side, joints, now);
    }

    fn switch(&mut self, request: SwitchRequest, now: Stamp) {
        self.world.switch(request, now);
    }

    fn set_speed_ratio(&mut self, side: Side, ratio: f64) {
        self.world.set_speed_ratio(side, ratio);
    }

    fn set_command_timeout(&mut self, side: Side, timeout: Duration) {
        self.world.set_command_timeout(side, timeout);
    }

    fn step(&mut self, now: Stamp) -> Senses {
        let output = self.world.step(now);
        let seen = (!self.world.camera_is_lost(now)).then(|| self.world.person_arms());
        *self.seen.lock().unwrap_or_else(PoisonError::into_inner) = seen;
        Senses {
            endpoints: output.endpoints,
            joints: output.joints,
            robot: output.robot,
            collisions: output.collisions,
            bodies: if self.has_tracker { output.bodies } else { Vec::new() },
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(folder) = &arguments.images {
        return sim_images::write(folder, arguments.count, arguments.seed.unwrap_or(DEFAULT_SEED));
    }
    let master = match arguments.master {
        MasterChoice::Running => None,
        MasterChoice::Embedded => Some(embedded_master(arguments.port)?),
    };
    // What was typed is checked first: a wrong name needs no master to be found.
    simulated_person(arguments.profile.as_deref())?;
    let ended = ending_signals()?;
    if arguments.until_input_ends {
        end_with_the_input(Arc::clone(&ended));
    }
    let node = Node::start("simulated_baxter").map_err(ros_failure)?;
    let profile = arguments.profile.clone().or_else(|| node.text_parameter("~profile"));
    let seed = arguments.seed.or_else(|| node.seed_parameter("~seed")).unwrap_or(DEFAULT_SEED);
    let person = simulated_person(profile.as_deref())?;
    if let Some(name) = arguments.garment_name.as_deref().filter(|name| person.garment(Some(name)).is_none()) {
        return Err(Failure::Configuration(format!("--garment-name {name} is no garment of this profile")));
    }
    let setup = WorldSetup {
        seed,
        person: person.simulated.clone().unwrap_or_default(),
        garment: person.garment(arguments.garment_name.as_deref()).cloned().unwrap_or_default(),
        backend: arguments.garment.into(),
        arms_hide_joints: arguments.skeleton == SkeletonTracker::Occluded,
        exercise_seconds: arguments.exercise,
        faults: arguments.faults.plan(),
        ..WorldSetup::default()
    };
    let world = World::new(&setup).map_err(Failure::configuration)?;
    let seen_arms: SeenArms = Arc::new(Mutex::new(Some(world.person_arms())));
    let relay = master.as_ref().map(|_| relay_log()).transpose().map_err(ros_failure)?;
    let camera =
        HeadCamera { person: setup.person, seen: Arc::clone(&seen_arms), intrinsics: Intrinsics::default(), seed };
    let has_tracker = arguments.skeleton != SkeletonTracker::None;
    let behind = WorldOnTheWire { world, seen: seen_arms, has_tracker };
    let mut robot = SimNode::new(&node, Box::new(behind)).map_err(ros_failure)?;
    robot.add_camera(Box::new(camera)).map_err(ros_failure)?;
    let words = format!("simulated Baxter {} with seed {seed} on the master at {}", node.name(), node.master());
    Output::new(false).line(&words)?;
    node.log(Level::Information, &words);
    robot.run(|| node.is_running() && !ended.load(Ordering::SeqCst));
    leave((robot, relay, node));
    drop(master);
    // A thread that still waits for a master that hangs must not keep the process.
    std::process::exit(0);
}

/// The profile that is named, or the one that settings name.
fn simulated_person(typed: Option<&str>) -> Result<Profile, Failure> {
    let places = Places::of_this_machine();
    let settings = Settings::find(None, &places).map_err(Failure::configuration)?;
    let name = typed.unwrap_or_else(|| settings.profile());
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

/// Raises the flag when the standard input ends: a process that was killed cannot say that it is gone, but its end of the
/// pipe closes.
fn end_with_the_input(ended: Arc<AtomicBool>) {
    std::thread::spawn(move || {
        // An input that cannot be read has ended, too.
        let _ = std::io::copy(&mut std::io::stdin(), &mut std::io::sink());
        ended.store(true, Ordering::SeqCst);
    });
}

/// The exit code that fits what went wrong with ROS.
#[expect(clippy::needless_pass_by_value, reason = "it stands in map_err, which gives the error away")]
pub(super) fn ros_failure(error: RosError) -> Failure {
    match error {
        RosError::NoMaster { .. } => Failure::NoMaster(error.to_string()),
        _ => Failure::Fault(error.to_string()),
    }
}
