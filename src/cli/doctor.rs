//! `valet doctor`: the checklist before a trial: each line with age, value and what to do.
//!
//! Looks and listens for a few seconds; commands nothing and advertises no topic that could.

mod arms;
mod checks;

use super::exit::Failure;
use super::output::Output;
use super::planning::planner_named;
use super::sim::ros_failure;
use crate::kinematics::RobotModel;
use crate::ros::graph::{self, Graph};
use crate::ros::{LinkSettings, MoveItPlanner, Node, RobotLink, Sink, leave, monitor};
use crate::snapshot::Verdict;
use crate::supervisor::{Input, PlannerKind};
use arms::Arms;
use checks::{Check, Findings};
use serde::Serialize;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// The checklist before a trial: each line with age, value and what to do.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// Print one JSON object a line.
    #[arg(long)]
    json: bool,
    /// For how long to listen, in seconds.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..=60))]
    seconds: u64,
    /// Also ask this planner for a short line of each arm, without moving: `built_in` or `moveit`.
    #[arg(long)]
    planner: Option<String>,
}

#[derive(Serialize)]
struct Summary {
    event: &'static str,
    checks: usize,
    not_good: usize,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let planner = planner_named(arguments.planner.as_deref())?;
    let node = Node::start("valet_doctor").map_err(ros_failure)?;
    let found = Arc::new(Mutex::new(Findings::default()));
    let kept = Arc::clone(&found);
    let sink: Sink = Arc::new(move |input: Input| {
        kept.lock().unwrap_or_else(PoisonError::into_inner).take(&input, monitor::now());
    });
    let link = RobotLink::connect(&node, LinkSettings { is_dry_run: true }, sink).map_err(ros_failure)?;
    thread::sleep(Duration::from_secs(arguments.seconds));
    let graph = Graph::ask(node.master(), &node.name()).map_err(Failure::fault)?;
    let address = ["ROS_IP", "ROS_HOSTNAME"].into_iter().find_map(|key| std::env::var(key).ok());
    let findings = found.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let mut all = checks::all(&findings, &link.topics(), &graph, node.master(), address.as_deref(), monitor::now());
    let model = RobotModel::baxter().map_err(Failure::fault)?;
    let description = graph::text_parameter(node.master(), &node.name(), "/robot_description");
    all.extend(arms::all(&findings, &Arms { model: &model, description: description.as_deref(), graph: &graph }));
    if planner == PlannerKind::MoveIt {
        let moveit = MoveItPlanner::new(&node, model.clone());
        all.push(arms::planner(&findings, &model, |start, targets| moveit.ways(start, targets)));
    }
    let told = tell(&all, &mut Output::new(arguments.json));
    leave((link, node));
    told
}

fn tell(all: &[Check], output: &mut Output) -> Result<(), Failure> {
    for check in all {
        output.line(check.line())?;
        output.event(check)?;
    }
    let not_good: Vec<_> = all.iter().filter(|check| check.verdict != Verdict::Good).collect();
    output.event(&Summary { event: "doctor", checks: all.len(), not_good: not_good.len() })?;
    match not_good.iter().filter(|check| check.verdict == Verdict::Fault).count() {
        0 => Ok(()),
        faults => Err(Failure::Fault(format!("{faults} of {} checks failed: see what to do beside each", all.len()))),
    }
}
