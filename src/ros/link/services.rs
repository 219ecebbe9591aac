//! The services: any node may stop, any node may hold, none may start.

use super::{RosError, Sink};
use crate::command::{Command, Origin};
use crate::ros::message::std_srvs::{Trigger, TriggerRes};
use crate::supervisor::Input;
use rosrust::Service;
use std::sync::Arc;

pub(super) fn serve(sink: &Sink) -> Result<Vec<Service>, RosError> {
    [("~stop", Command::Stop), ("~hold", Command::Hold)]
        .into_iter()
        .map(|(name, command)| one(name, command, sink))
        .collect()
}

fn one(name: &str, command: Command, sink: &Sink) -> Result<Service, RosError> {
    let sink = Arc::clone(sink);
    let answer = move |_| {
        sink(Input::Operator { command: command.clone(), origin: Origin::RosService });
        Ok(TriggerRes { success: true, message: format!("asked for: {command}; ~state tells what came of it") })
    };
    rosrust::service::<Trigger, _>(name, answer).map_err(|error| RosError::registration(name, error))
}
