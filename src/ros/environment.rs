//! The environment variables by which ROS nodes of this machine find each other.
//!
//! rosrust reads them once, from the process' own environment; changing that from inside is not safe while threads run, so a
//! command that needs other values is started anew with them.

use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::process::Command;

/// The variables under which nodes of this machine use a master on `port` of this machine.
#[must_use]
pub fn local(port: u16) -> [(&'static str, String); 2] {
    [("ROS_MASTER_URI", format!("http://127.0.0.1:{port}/")), ("ROS_IP", "127.0.0.1".to_owned())]
}

/// True where this process already runs under the variables of [`local`].
#[must_use]
pub fn is_local(port: u16) -> bool {
    local(port).iter().all(|(key, value)| std::env::var(key).is_ok_and(|found| found == *value))
}

/// This program again, with the arguments and the variables for a master on `port` of this machine.
///
/// # Errors
/// Where the system does not tell where this program is.
pub fn this_program<I: IntoIterator<Item = String>>(arguments: I, port: u16) -> std::io::Result<Command> {
    let program: PathBuf = std::env::current_exe()?;
    let mut command = Command::new(program);
    command.args(arguments).envs(local(port)).env_remove("ROS_HOSTNAME");
    Ok(command)
}

/// A port of this machine that nobody listens on at this moment.
///
/// # Errors
/// Where the system has none.
pub fn free_port() -> std::io::Result<u16> {
    Ok(TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?.local_addr()?.port())
}
