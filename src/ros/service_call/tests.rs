use super::*;
use crate::ros::message::std_srvs::Trigger;
use crate::ros::message::std_srvs::{TriggerReq, TriggerRes};
use std::collections::HashMap;
use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::thread;

/// A master that knows one service, and the service's server, which says `answers` one after the other on one connection.
fn peers(answers: Vec<Vec<u8>>) -> ServiceCaller {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = server.local_addr().unwrap().port();
    thread::spawn(move || {
        let (mut stream, _) = server.accept().unwrap();
        for answer in answers {
            let _ = read_block(&mut stream, 1 << 16);
            let _ = stream.write_all(&answer);
        }
        // Silence, not a closed connection, is what a server that hangs shows.
        loop {
            thread::park();
        }
    });
    caller(&master(format!("rosrpc://127.0.0.1:{port}")))
}

fn caller(master: &str) -> ServiceCaller {
    ServiceCaller {
        master: master.into(),
        caller: "/test".into(),
        service: "/trigger".into(),
        // Far more than an answer takes on a machine that is busy with other tests.
        limit: Duration::from_secs(20),
    }
}

/// Answers one look-up over XML-RPC.
fn master(uri: String) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}", listener.local_addr().unwrap());
    thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        read_request(&stream);
        let status = i32::from(!uri.is_empty()) * 2 - 1;
        let body = format!(
            "<?xml version=\"1.0\"?><methodResponse><params><param><value><array><data><value><i4>{status}</i4></value>\
             <value><string>words</string></value><value><string>{uri}</string></value></data></array></value></param></params></methodResponse>"
        );
        let _ =
            write!(stream, "HTTP/1.0 200 OK\r\nContent-Type: text/xml\r\nContent-Length: {}\r\n\r\n{body}", body.len());
    });
    address
}

/// Reads one request to its last byte: a socket that is closed with bytes unread takes the answer with it.
fn read_request(stream: &TcpStream) {
    let mut reader = BufReader::new(stream);
    let (mut line, mut length) = (String::new(), 0);
    while reader.read_line(&mut line).unwrap() > 2 {
        if let Some(value) = line.to_ascii_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().unwrap();
        }
        line.clear();
    }
    reader.read_exact(&mut vec![0; length]).unwrap();
}

fn greeting(fields: &[(&str, &str)]) -> Vec<u8> {
    let fields: HashMap<String, String> = fields.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect();
    let mut bytes = Vec::new();
    fields.encode(&mut bytes).unwrap();
    bytes
}

fn block(bytes: &[u8]) -> Vec<u8> {
    [&u32::try_from(bytes.len()).unwrap().to_le_bytes(), bytes].concat()
}

#[test]
fn the_digest_is_what_the_server_greets_with() {
    let caller = peers(vec![greeting(&[("md5sum", "c54b9430"), ("type", "moveit_msgs/GetCartesianPath")])]);
    assert_eq!(caller.digest().unwrap(), "c54b9430");
}

#[test]
fn an_answer_is_decoded() {
    use rosrust::Message;
    let answer = TriggerRes { success: true, message: "done".into() };
    let mut bytes = vec![1];
    bytes.extend(answer.encode_vec().unwrap());
    let caller = peers(vec![greeting(&[("md5sum", &Trigger::md5sum())]), bytes]);
    assert_eq!(caller.call::<Trigger>(&TriggerReq {}).unwrap(), answer);
}

#[test]
fn a_service_that_nobody_offers_is_named() {
    let error = caller(&master(String::new())).digest().unwrap_err();
    assert!(matches!(&error, ServiceError::NotOffered { .. }), "{error}");
    assert!(error.to_string().contains("/trigger"));
}

#[test]
fn a_server_that_hangs_is_given_up_after_the_limit() {
    let mut caller = peers(vec![]);
    caller.limit = Duration::from_millis(300);
    let error = caller.digest().unwrap_err();
    assert!(matches!(&error, ServiceError::NoAnswer { .. }), "{error}");
}

#[test]
fn a_refusal_is_told_in_the_servers_words() {
    let error =
        peers(vec![greeting(&[("error", "md5sums do not match")])]).call::<Trigger>(&TriggerReq {}).unwrap_err();
    assert!(error.to_string().contains("md5sums do not match"), "{error}");
    let mut failed = vec![0];
    failed.extend(block(b"service threw"));
    let error = peers(vec![greeting(&[("md5sum", "x")]), failed]).call::<Trigger>(&TriggerReq {}).unwrap_err();
    assert!(matches!(&error, ServiceError::Refused { reason, .. } if reason == "service threw"), "{error}");
}

#[test]
fn what_cannot_be_read_is_an_error_and_no_panic() {
    for answer in [block(b"\xff\xff\xff\x7fshort"), block(b"\x02\x00\x00\x00ab"), vec![0xff; 4]] {
        assert!(peers(vec![answer.clone()]).digest().is_err(), "{answer:?}");
    }
    let mut bytes = vec![1];
    bytes.extend(block(&[1, 0xff, 0xff, 0xff, 0x7f]));
    let error = peers(vec![greeting(&[("md5sum", "x")]), bytes]).call::<Trigger>(&TriggerReq {}).unwrap_err();
    assert!(matches!(&error, ServiceError::Unreadable { .. }), "{error}");
}
