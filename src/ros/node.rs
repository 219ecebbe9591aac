//! This process as a ROS node: found master, registered name, shutdown that always ends.
//!
//! rosrust allows one node a process, hangs on a master that accepts and never answers, and leaks threads on each failed
//! start: so the master is probed first, by a client with a time limit. Shutdown may hang in the same way: so it is given a
//! second, and then the process ends without it. ROS arguments and the environment name node and master.

use super::error::RosError;
use super::message::rosgraph_msgs::Log;
use super::xmlrpc::Value;
use super::xmlrpc::http::call_ros;
use crate::snapshot::Level;
use rosrust::Publisher;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// How long the master may take for an answer: a healthy one on a local network takes milliseconds.
pub(super) const MASTER_LIMIT: Duration = Duration::from_secs(2);
/// How long it may take at the start: nothing waits for it but the operator, and a master may be starting up itself.
const START_LIMIT: Duration = Duration::from_secs(5);
/// How long the way out may take.
const SHUTDOWN_LIMIT: Duration = Duration::from_secs(1);
/// Lines of log that may wait for a slow `/rosout`.
const LOG_QUEUE: usize = 100;

/// Where the ROS arguments or the environment say that the master is.
#[must_use]
pub fn master_uri() -> String {
    let typed = std::env::args().skip(1).find_map(|argument| argument.strip_prefix("__master:=").map(str::to_owned));
    typed.or_else(|| std::env::var("ROS_MASTER_URI").ok()).unwrap_or_else(|| "http://localhost:11311/".to_owned())
}

/// Asks the master for its process number: whether one answers at all.
///
/// # Errors
/// [`RosError::NoMaster`] after at most a few seconds.
pub fn probe_master(uri: &str) -> Result<(), RosError> {
    call_ros(uri, "getPid", &[Value::text("/valet_probe")], START_LIMIT)
        .map(drop)
        .map_err(|error| RosError::NoMaster { uri: uri.to_owned(), reason: error.to_string() })
}

/// The node. One a process.
#[derive(Clone)]
pub struct Node {
    log: Publisher<Log>,
    master: String,
}

impl std::fmt::Debug for Node {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Node").field("name", &self.name()).field("master", &self.master).finish_non_exhaustive()
    }
}

impl Node {
    /// Finds the master and registers this process under `name`, unless ROS arguments give another. Signals are left to the caller.
    ///
    /// # Errors
    /// No master, or a name that ROS does not allow.
    pub fn start(name: &str) -> Result<Self, RosError> {
        let master = master_uri();
        probe_master(&master)?;
        let broken = |reason: String| RosError::Node { name: name.to_owned(), reason };
        rosrust::try_init_with_options(name, false).map_err(|error| broken(error.to_string()))?;
        let log = rosrust::publish("/rosout", LOG_QUEUE).map_err(|error| broken(error.to_string()))?;
        Ok(Self { log, master })
    }

    /// The full name, as the graph knows it.
    #[must_use]
    pub fn name(&self) -> String {
        rosrust::name()
    }

    /// Where the master is.
    #[must_use]
    pub fn master(&self) -> &str {
        &self.master
    }

    /// False once another node, as `rosnode kill`, or this one has asked for the end.
    #[must_use]
    pub fn is_running(&self) -> bool {
        rosrust::is_ok()
    }

    /// Sends a line to `/rosout`. Never blocks and never prints: rosrust's own log macros would write over the screen.
    pub fn log(&self, level: Level, text: &str) {
        let level = match level {
            Level::Debug => Log::DEBUG,
            Level::Information => Log::INFO,
            Level::Warning => Log::WARN,
            Level::Error => Log::ERROR,
        };
        let line = Log { level, msg: text.to_owned(), name: self.name(), ..Log::default() };
        // A line that cannot be sent is in the program's own log file all the same.
        let _ = self.log.send(line);
    }

    /// The name that remappings and namespaces make of a name.
    #[must_use]
    pub fn resolved(&self, name: &str) -> String {
        resolved(name)
    }

    /// A private or global parameter as text, where the master has it. Read at the start: rosrust never renews it.
    #[must_use]
    pub fn text_parameter(&self, name: &str) -> Option<String> {
        rosrust::param(name)?.get().ok()
    }

    /// A parameter as a seed: a whole number, as roslaunch or `_seed:=1` gives it.
    #[must_use]
    pub fn seed_parameter(&self, name: &str) -> Option<u64> {
        let parameter = rosrust::param(name)?;
        parameter.get::<i32>().ok().and_then(|seed| u64::try_from(seed).ok())
    }

    /// A parameter as a switch; false where the master has none.
    #[must_use]
    pub fn switch_parameter(&self, name: &str) -> bool {
        rosrust::param(name).is_some_and(|parameter| parameter.get().unwrap_or(false))
    }
}

/// The name that this process' remappings and namespaces make of a name, as the master knows it. rosrust resolves every name
/// in the same way, and tells the outcome for parameters only.
pub(super) fn resolved(name: &str) -> String {
    rosrust::param(name).map_or_else(|| name.to_owned(), |parameter| parameter.name().to_owned())
}

/// Gives up what `held` holds (publishers, subscribers, services) and leaves the graph, in at most a second.
///
/// Unregistering waits for the master, and a master that hangs would keep this process for ever; a thread that is left behind
/// ends with the process, which the caller ends next.
pub fn leave<T: Send + 'static>(held: T) {
    let (done, finished) = mpsc::channel();
    let leaving = thread::Builder::new().name("leave".into()).spawn(move || {
        drop(held);
        if rosrust::is_initialized() {
            rosrust::shutdown();
        }
        // Nobody waits any more where the time is over.
        let _ = done.send(());
    });
    if leaving.is_ok() {
        // Either it has ended, or the time is over: both lead out.
        let _ = finished.recv_timeout(SHUTDOWN_LIMIT);
    }
}
