//! Calls of a ROS service with a time limit on everything, and the question which definition a server has.
//!
//! rosrust's own client waits for ever for a server that hangs, and cannot ask for a digest. One call, one connection: the
//! server is looked up at the master, greeted with the digest of the definition, and asked.

use super::greeting::{self, Fields, read_block};
use super::xmlrpc::Value;
use super::xmlrpc::http::{CallError, call_ros};
use rosrust::{RosMsg, ServicePair};
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use thiserror::Error;

/// Largest answer: a path of some thousand points with all joints is about a megabyte.
const LARGEST_ANSWER: u32 = 64 << 20;

/// Why a service did not answer as it should.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ServiceError {
    /// The master knows nobody who offers it.
    #[error("no node offers the service {service} ({reason})")]
    NotOffered {
        /// Its name.
        service: String,
        /// The master's words.
        reason: String,
    },
    /// The server does not answer, or not in time.
    #[error("the node that offers {service} does not answer within {seconds:.1} s ({reason})")]
    NoAnswer {
        /// Its name.
        service: String,
        /// How long it was waited for.
        seconds: f64,
        /// What the connection says.
        reason: String,
    },
    /// The server refuses, or says that it failed.
    #[error("{service} refuses: {reason}")]
    Refused {
        /// Its name.
        service: String,
        /// The server's words.
        reason: String,
    },
    /// What came is not an answer of this definition.
    #[error("{service} answers something that cannot be read ({reason})")]
    Unreadable {
        /// Its name.
        service: String,
        /// What is wrong with it.
        reason: String,
    },
}

/// A service on the graph, as this node sees it.
#[derive(Clone, Debug)]
pub(super) struct ServiceCaller {
    /// Where the master is.
    pub(super) master: String,
    /// This node's name.
    pub(super) caller: String,
    /// The service's name.
    pub(super) service: String,
    /// How long one step (look-up, greeting, answer) may take.
    pub(super) limit: Duration,
}

impl ServiceCaller {
    /// The digest of the definition that the server has, without calling anything.
    ///
    /// # Errors
    /// [`ServiceError`] where nobody offers it or the server is silent.
    pub(super) fn digest(&self) -> Result<String, ServiceError> {
        let (_, greeting) = self.greet("*", true)?;
        greeting.get("md5sum").cloned().ok_or_else(|| self.unreadable("its greeting has no md5sum"))
    }

    /// Calls the service.
    ///
    /// # Errors
    /// [`ServiceError`]; in words that name the service.
    pub(super) fn call<S: ServicePair>(&self, request: &S::Request) -> Result<S::Response, ServiceError> {
        let began = Instant::now();
        let (mut stream, _) = self.greet(&S::md5sum(), false)?;
        let silent = |error: io::Error| self.silent(began, &error);
        let request = request.encode_vec().map_err(|error| self.unreadable(&error))?;
        stream.write_all(&request).map_err(silent)?;
        let mut done = [0];
        stream.read_exact(&mut done).map_err(silent)?;
        let answer = read_block(&mut stream, LARGEST_ANSWER).map_err(silent)?;
        if done == [0] {
            return Err(self.refused(&String::from_utf8_lossy(&answer)));
        }
        S::Response::decode(answer.as_slice()).map_err(|error| self.unreadable(&error))
    }

    /// Connects, and exchanges greetings. `probe` asks for the greeting alone.
    fn greet(&self, digest: &str, probe: bool) -> Result<(TcpStream, Fields), ServiceError> {
        let began = Instant::now();
        let mut stream = self.connect(began)?;
        let mut fields = Fields::from([
            ("callerid".to_owned(), self.caller.clone()),
            ("service".to_owned(), self.service.clone()),
            ("md5sum".to_owned(), digest.to_owned()),
        ]);
        if probe {
            fields.insert("probe".to_owned(), "1".to_owned());
        }
        let answer = greeting::exchange(&mut stream, &fields).map_err(|error| match error.kind() {
            io::ErrorKind::InvalidData => self.unreadable(&error),
            _ => self.silent(began, &error),
        })?;
        match answer.get("error") {
            Some(reason) => Err(self.refused(reason)),
            None => Ok((stream, answer)),
        }
    }

    fn connect(&self, began: Instant) -> Result<TcpStream, ServiceError> {
        let parameters = [Value::text(&self.caller), Value::text(&self.service)];
        let found = call_ros(&self.master, "lookupService", &parameters, self.limit).map_err(|error| match error {
            CallError::Refused(reason) => ServiceError::NotOffered { service: self.service.clone(), reason },
            error => self.silent(began, &io::Error::other(error.to_string())),
        })?;
        let uri = found.as_text().unwrap_or_default();
        let authority = uri.strip_prefix("rosrpc://").unwrap_or(uri).trim_end_matches('/');
        greeting::connect(authority, self.limit).map_err(|error| self.silent(began, &error))
    }

    fn silent(&self, began: Instant, reason: &io::Error) -> ServiceError {
        ServiceError::NoAnswer {
            service: self.service.clone(),
            seconds: began.elapsed().as_secs_f64(),
            reason: reason.to_string(),
        }
    }

    fn refused(&self, reason: &str) -> ServiceError {
        ServiceError::Refused { service: self.service.clone(), reason: reason.to_owned() }
    }

    fn unreadable(&self, reason: impl std::fmt::Display) -> ServiceError {
        ServiceError::Unreadable { service: self.service.clone(), reason: reason.to_string() }
    }
}

#[cfg(test)]
mod tests;
