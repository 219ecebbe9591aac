//! XML-RPC over HTTP, with a time limit on everything: a client for one call, and a small server.
//!
//! One call, one connection. What a peer sends is bounded in size and time, so that a silent or endless one costs a thread
//! for seconds and nothing else.

use super::{ParseError, Value, parse_call, parse_response, write_call, write_response};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream, ToSocketAddrs};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;
use thiserror::Error;

/// Largest body: a robot description is about 100 kB.
const LARGEST_BODY: u64 = 16 << 20;
/// Largest header.
const LARGEST_HEADER: u64 = 16 << 10;
/// How long the server waits for a peer's next byte.
const PATIENCE: Duration = Duration::from_secs(5);
/// Connections at a time; more than that are closed at once.
const CONNECTIONS: usize = 256;

/// Why a call had no answer.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CallError {
    /// The address is none.
    #[error("{0:?} is no address of the form http://host:port")]
    Address(String),
    /// Nobody answers there, or not in time.
    #[error("{0}")]
    Connection(#[from] io::Error),
    /// What came is not an answer.
    #[error("not an XML-RPC answer: {0}")]
    Answer(#[from] ParseError),
    /// The ROS answer says that it failed.
    #[error("{0}")]
    Refused(String),
}

/// Calls a method and returns the answer's value.
///
/// # Errors
/// A [`CallError`] after at most about twice `limit`.
pub fn call(address: &str, method: &str, parameters: &[Value], limit: Duration) -> Result<Value, CallError> {
    let authority = authority(address).ok_or_else(|| CallError::Address(address.to_owned()))?;
    let body = exchange(authority, &write_call(method, parameters), limit).map_err(|error| in_time(error, limit))?;
    Ok(parse_response(&body)?)
}

/// The system calls a peer that is silent a resource that is temporarily unavailable.
fn in_time(error: io::Error, limit: Duration) -> io::Error {
    match error.kind() {
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => {
            io::Error::new(io::ErrorKind::TimedOut, format!("no answer within {} s", limit.as_secs_f64()))
        }
        _ => error,
    }
}

fn exchange(authority: &str, body: &str, limit: Duration) -> io::Result<String> {
    let mut stream = connect(authority, limit)?;
    let head = format!(
        "POST / HTTP/1.0\r\nHost: {authority}\r\nContent-Type: text/xml\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())?;
    Ok(read_message(&mut BufReader::new(stream))?.1)
}

/// Calls a ROS method, whose answer is (status, words, value), and returns the value.
///
/// # Errors
/// A [`CallError`] where there is no answer, or the status says that it failed.
pub fn call_ros(address: &str, method: &str, parameters: &[Value], limit: Duration) -> Result<Value, CallError> {
    match call(address, method, parameters, limit)? {
        Value::Array(triple) => match <[Value; 3]>::try_from(triple) {
            Ok([Value::Integer(1), _, value]) => Ok(value),
            Ok([_, words, _]) => Err(CallError::Refused(words.as_text().unwrap_or("no reason given").to_owned())),
            Err(_) => Err(CallError::Refused("an answer without status".into())),
        },
        _ => Err(CallError::Refused("an answer without status".into())),
    }
}

fn authority(address: &str) -> Option<&str> {
    let rest = address.strip_prefix("http://")?;
    let authority = rest.split('/').next()?;
    authority.contains(':').then_some(authority)
}

fn connect(authority: &str, limit: Duration) -> io::Result<TcpStream> {
    let mut last = io::Error::new(io::ErrorKind::NotFound, format!("{authority} has no address"));
    for address in authority.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, limit) {
            Ok(stream) => {
                stream.set_read_timeout(Some(limit))?;
                stream.set_write_timeout(Some(limit))?;
                stream.set_nodelay(true)?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Reads a request or an answer: its first line, and its body.
fn read_message(reader: &mut impl BufRead) -> io::Result<(String, String)> {
    let broken = |words: &str| io::Error::new(io::ErrorKind::InvalidData, words.to_owned());
    let mut head = reader.by_ref().take(LARGEST_HEADER);
    let mut first = String::new();
    head.read_line(&mut first)?;
    let mut length = None;
    loop {
        let mut line = String::new();
        if head.read_line(&mut line)? == 0 {
            return Err(broken("the connection ended within an HTTP header"));
        }
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("content-length")
        {
            length = Some(value.trim().parse::<u64>().map_err(|_| broken("a content length that is no number"))?);
        }
    }
    let length = length.ok_or_else(|| broken("an HTTP message without content length"))?;
    if length > LARGEST_BODY {
        return Err(broken("an HTTP body that is too large"));
    }
    let mut body = Vec::new();
    reader.by_ref().take(length).read_to_end(&mut body)?;
    if body.len() as u64 != length {
        return Err(broken("the connection ended within an HTTP body"));
    }
    String::from_utf8(body).map(|body| (first, body)).map_err(|_| broken("a body that is not UTF-8"))
}

/// Answers calls: method and parameters to a value.
pub trait Handler: Send + Sync + 'static {
    /// Answers one call.
    fn handle(&self, method: &str, parameters: &[Value]) -> Value;
}

/// Serves calls on `listener` in threads of their own until `ended` is set and one more connection comes.
///
/// # Errors
/// Where the system has no thread to give.
pub fn serve(
    listener: TcpListener,
    handler: Arc<dyn Handler>,
    ended: Arc<AtomicBool>,
) -> io::Result<thread::JoinHandle<()>> {
    thread::Builder::new().name("xmlrpc".into()).spawn(move || {
        let open = Arc::new(AtomicUsize::new(0));
        for stream in listener.incoming() {
            if ended.load(Ordering::SeqCst) {
                return;
            }
            let Ok(stream) = stream else { continue };
            if open.fetch_add(1, Ordering::SeqCst) >= CONNECTIONS {
                open.fetch_sub(1, Ordering::SeqCst);
                continue;
            }
            let (handler, guard) = (Arc::clone(&handler), Open(Arc::clone(&open)));
            // Where there is no thread, the connection is closed and the peer may try again.
            let _ = thread::Builder::new().name("xmlrpc-call".into()).spawn(move || {
                let _guard = guard;
                // A peer that went away needs no answer.
                let _ = answer(&stream, handler.as_ref());
            });
        }
    })
}

struct Open(Arc<AtomicUsize>);

impl Drop for Open {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

fn answer(stream: &TcpStream, handler: &dyn Handler) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    let (_, body) = read_message(&mut BufReader::new(stream))?;
    let (status, body) = match parse_call(&body) {
        Ok((method, parameters)) => ("200 OK", write_response(&handler.handle(&method, &parameters))),
        Err(error) => ("400 Bad Request", error.to_string()),
    };
    let head = format!(
        "HTTP/1.0 {status}\r\nContent-Type: text/xml\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    let mut out = stream;
    out.write_all(head.as_bytes())?;
    out.write_all(body.as_bytes())?;
    out.flush()?;
    stream.shutdown(Shutdown::Write)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Echo;

    impl Handler for Echo {
        fn handle(&self, method: &str, parameters: &[Value]) -> Value {
            Value::Array(vec![Value::Integer(1), Value::text(method), Value::Array(parameters.to_vec())])
        }
    }

    fn server() -> String {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}/", listener.local_addr().unwrap());
        serve(listener, Arc::new(Echo), Arc::new(AtomicBool::new(false))).unwrap();
        address
    }

    #[test]
    fn a_call_reaches_the_handler_and_its_answer_returns() {
        let parameters = [Value::text("/node & <co>"), Value::Integer(-4)];
        let answer = call_ros(&server(), "echo", &parameters, Duration::from_secs(2)).unwrap();
        assert_eq!(answer, Value::Array(parameters.to_vec()));
    }

    #[test]
    fn a_peer_that_never_answers_is_given_up() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}", listener.local_addr().unwrap());
        let error = call(&address, "getPid", &[], Duration::from_millis(50)).unwrap_err();
        assert_eq!(error.to_string(), "no answer within 0.05 s");
    }

    #[test]
    fn garbage_does_not_end_the_server() {
        let address = server();
        let host = address.strip_prefix("http://").unwrap().trim_end_matches('/').to_owned();
        for garbage in [
            "",
            "\0\0\0",
            "POST / HTTP/1.1\r\n\r\n",
            "POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n",
            "POST / HTTP/1.1\r\nContent-Length: 3\r\n\r\n<a>",
        ] {
            let mut stream = TcpStream::connect(&host).unwrap();
            stream.write_all(garbage.as_bytes()).unwrap();
            stream.shutdown(Shutdown::Write).unwrap();
        }
        assert!(call_ros(&address, "echo", &[], Duration::from_secs(2)).is_ok());
    }

    #[test]
    fn an_address_that_is_none_is_named() {
        for address in ["", "localhost:11311", "http://localhost", "https://a:1"] {
            assert!(matches!(call(address, "x", &[], PATIENCE), Err(CallError::Address(named)) if named == address));
        }
    }
}
