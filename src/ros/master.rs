//! A ROS 1 master in this process, so that a demonstration needs no ROS installation.
//!
//! Speaks the master and parameter API of ROS 1 to nodes of any language. It moves no data: nodes talk to each other. Telling
//! a node something never makes another one wait: each has a queue and a thread of its own. It is no security boundary, as no
//! ROS 1 master is, and listens where it is told to.

mod names;
mod notify;
mod parameters;
mod registry;

use super::error::RosError;
use super::link::advertise;
use super::message::rosgraph_msgs;
use super::xmlrpc::Value;
use super::xmlrpc::http::{Handler, serve};
use names::resolve;
use notify::{Notice, Notifier};
use parameters::Parameters;
use registry::{Registry, Role};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The port on which ROS looks for a master.
pub const USUAL_PORT: u16 = 11311;

/// A running master. Dropping it ends it; nodes then see a master that is gone.
#[derive(Debug)]
pub struct EmbeddedMaster {
    address: SocketAddr,
    ended: Arc<AtomicBool>,
}

impl EmbeddedMaster {
    /// Starts a master on this machine's own interface; port 0 takes any free one.
    ///
    /// # Errors
    /// Where something listens there already, or the system has no thread to give.
    pub fn start(port: u16) -> Result<Self, RosError> {
        Self::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port)))
    }

    /// Starts a master on an address of the caller's choice. Whoever reaches it can command every node.
    ///
    /// # Errors
    /// Where something listens there already, or the system has no thread to give.
    pub fn bind(address: SocketAddr) -> Result<Self, RosError> {
        let broken =
            |error: std::io::Error| RosError::MasterAddress { address: address.to_string(), reason: error.to_string() };
        let listener = TcpListener::bind(address).map_err(broken)?;
        let address = listener.local_addr().map_err(broken)?;
        let ended = Arc::new(AtomicBool::new(false));
        let service = Service::new(&format!("http://{address}/"), address.port());
        serve(listener, Arc::new(service), Arc::clone(&ended))
            .map_err(|error| RosError::thread("the embedded master", error))?;
        Ok(Self { address, ended })
    }

    /// What `ROS_MASTER_URI` has to be to use it.
    #[must_use]
    pub fn uri(&self) -> String {
        format!("http://{}/", self.address)
    }
}

impl Drop for EmbeddedMaster {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::SeqCst);
        // One more connection wakes the listener, which then sees that it has ended.
        let _ = TcpStream::connect_timeout(&self.address, Duration::from_millis(200));
    }
}

/// Passes `/rosout` on to `/rosout_agg`, as the rosout node does that comes with roscore.
///
/// # Errors
/// Where the master does not register one of them.
pub fn relay_log() -> Result<rosrust::Subscriber, RosError> {
    let aggregate = advertise::<rosgraph_msgs::Log>("/rosout_agg", 100)?;
    let relay = move |line: rosgraph_msgs::Log| drop(aggregate.send(line));
    rosrust::subscribe("/rosout", 100, relay).map_err(|error| RosError::registration("/rosout", error))
}

struct Service {
    uri: String,
    registry: Mutex<Registry>,
    parameters: Mutex<Parameters>,
    notifier: Notifier,
}

/// An answer before it is put into the three words of ROS.
type Answer = Result<Value, String>;

impl Service {
    fn new(uri: &str, port: u16) -> Self {
        let mut parameters = Parameters::default();
        let run = format!("valet-{}-{port}-{}", std::process::id(), super::monitor::now().nanoseconds());
        for (key, value) in [("/run_id", run.as_str()), ("/rosdistro", "noetic\n"), ("/rosversion", "1.15.15\n")] {
            parameters.set(key, Value::text(value));
        }
        Self {
            uri: uri.to_owned(),
            registry: Mutex::default(),
            parameters: Mutex::new(parameters),
            notifier: Notifier::default(),
        }
    }

    fn registry(&self) -> MutexGuard<'_, Registry> {
        self.registry.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn parameters(&self) -> MutexGuard<'_, Parameters> {
        self.parameters.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Queues notices while the lock that made them is still held, so that their order is that of the changes.
    fn tell(&self, notices: Vec<Notice>) {
        notices.into_iter().for_each(|notice| self.notifier.tell(notice));
    }

    fn register(&self, role: Role, caller: &str, name: &str, kind: &str, uri: &str) -> Value {
        let name = resolve(name, caller);
        let mut registry = self.registry();
        let (others, notices) = registry.register(role, caller, &name, kind, uri);
        self.tell(notices);
        Value::texts(others)
    }

    fn unregister(&self, role: Role, caller: &str, name: &str, uri: &str) -> Value {
        let name = resolve(name, caller);
        let mut registry = self.registry();
        let (count, notices) = registry.unregister(role, caller, &name, uri);
        self.tell(notices);
        Value::Integer(i32::from(count))
    }

    fn set_parameter(&self, key: &str, value: Value) -> Value {
        let mut parameters = self.parameters();
        let notices = parameters.set(key, value);
        self.tell(notices);
        Value::Integer(0)
    }

    fn delete_parameter(&self, key: &str) -> Answer {
        let mut parameters = self.parameters();
        let notices = parameters.delete(key).ok_or_else(|| format!("parameter {key} is not set"))?;
        self.tell(notices);
        Ok(Value::Integer(0))
    }

    fn graph(&self, method: &str, caller: &str, rest: &[Value]) -> Option<Answer> {
        let text = |index: usize| rest.get(index).and_then(Value::as_text).unwrap_or_default();
        Some(Ok(match method {
            "registerPublisher" => self.register(Role::Publisher, caller, text(0), text(1), text(2)),
            "registerSubscriber" => self.register(Role::Subscriber, caller, text(0), text(1), text(2)),
            "registerService" => self.registry_service(caller, text(0), text(1), text(2)),
            "unregisterPublisher" => self.unregister(Role::Publisher, caller, text(0), text(1)),
            "unregisterSubscriber" => self.unregister(Role::Subscriber, caller, text(0), text(1)),
            "unregisterService" => {
                Value::Integer(i32::from(self.registry().unregister_service(&resolve(text(0), caller), text(1))))
            }
            "lookupNode" => {
                return Some(
                    self.registry().node(text(0)).map(Value::text).ok_or_else(|| format!("unknown node {}", text(0))),
                );
            }
            "lookupService" => {
                let name = resolve(text(0), caller);
                return Some(self.registry().service(&name).map(Value::text).ok_or_else(|| "no provider".to_owned()));
            }
            "getPublishedTopics" => self.registry().published(text(0)),
            "getTopicTypes" => self.registry().types(),
            "getSystemState" => self.registry().state(),
            "getUri" => Value::text(&self.uri),
            "getPid" => Value::Integer(i32::try_from(std::process::id()).unwrap_or(i32::MAX)),
            _ => return None,
        }))
    }

    fn registry_service(&self, caller: &str, name: &str, address: &str, uri: &str) -> Value {
        let mut registry = self.registry();
        let notices = registry.register_service(caller, &resolve(name, caller), address, uri);
        self.tell(notices);
        Value::Integer(1)
    }

    fn parameter(&self, method: &str, caller: &str, rest: &[Value]) -> Option<Answer> {
        let text = |index: usize| rest.get(index).and_then(Value::as_text).unwrap_or_default();
        let key = || resolve(text(0), caller);
        Some(match method {
            "setParam" => match rest.get(1) {
                Some(value) => Ok(self.set_parameter(&key(), value.clone())),
                None => Err("setParam needs a value".to_owned()),
            },
            "getParam" => self.parameters().get(&key()).ok_or_else(|| format!("Parameter [{}] is not set", key())),
            "deleteParam" => self.delete_parameter(&key()),
            "hasParam" => Ok(Value::Boolean(self.parameters().get(&key()).is_some())),
            "searchParam" => self
                .parameters()
                .search(caller, text(0))
                .map(Value::text)
                .ok_or_else(|| format!("Cannot find parameter [{}]", text(0))),
            "getParamNames" => Ok(Value::texts(self.parameters().names())),
            "subscribeParam" => Ok(self.parameters().subscribe(&resolve(text(1), caller), text(0))),
            "unsubscribeParam" => {
                Ok(Value::Integer(i32::from(self.parameters().unsubscribe(&resolve(text(1), caller), text(0)))))
            }
            _ => return None,
        })
    }

    /// Several calls in one, as roslaunch sets parameters.
    fn several(&self, calls: &[Value]) -> Value {
        let one = |call: &Value| {
            let Value::Struct(members) = call else { return failed("a call that is none") };
            let method = members.get("methodName").and_then(Value::as_text).unwrap_or_default();
            let parameters = members.get("params").and_then(Value::as_array).unwrap_or_default();
            // A multicall inside a multicall has no use, and could be nested without end.
            if method == "system.multicall" { failed("not inside itself") } else { self.handle(method, parameters) }
        };
        Value::Array(calls.iter().map(|call| Value::Array(vec![one(call)])).collect())
    }
}

impl Handler for Service {
    fn handle(&self, method: &str, parameters: &[Value]) -> Value {
        if method == "system.multicall" {
            return self.several(parameters.first().and_then(Value::as_array).unwrap_or_default());
        }
        let Some((caller, rest)) = parameters.split_first().and_then(|(caller, rest)| Some((caller.as_text()?, rest)))
        else {
            return failed("the first parameter has to be the caller's name");
        };
        match self.graph(method, caller, rest).or_else(|| self.parameter(method, caller, rest)) {
            Some(Ok(value)) => Value::Array(vec![Value::Integer(1), Value::text(""), value]),
            Some(Err(words)) => failed(&words),
            None => failed(&format!("a master has no method {method}")),
        }
    }
}

fn failed(words: &str) -> Value {
    Value::Array(vec![Value::Integer(-1), Value::text(words), Value::Integer(0)])
}

#[cfg(test)]
mod tests;
