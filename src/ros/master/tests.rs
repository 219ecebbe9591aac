use super::*;
use crate::ros::xmlrpc::http::{CallError, call, call_ros};
use std::collections::BTreeMap;
use std::io::Read;
use std::sync::mpsc;

const LIMIT: Duration = Duration::from_secs(3);

fn ask(master: &EmbeddedMaster, method: &str, parameters: &[&str]) -> Result<Value, CallError> {
    let parameters: Vec<_> = parameters.iter().map(|text| Value::text(*text)).collect();
    call_ros(&master.uri(), method, &parameters, LIMIT)
}

/// A node's own server, which tells what it was told.
fn node() -> (String, mpsc::Receiver<(String, Vec<Value>)>) {
    struct Node(Mutex<mpsc::Sender<(String, Vec<Value>)>>);
    impl Handler for Node {
        fn handle(&self, method: &str, parameters: &[Value]) -> Value {
            let _ = self.0.lock().unwrap().send((method.to_owned(), parameters.to_vec()));
            Value::Array(vec![Value::Integer(1), Value::text(""), Value::Integer(0)])
        }
    }
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let uri = format!("http://{}/", listener.local_addr().unwrap());
    let (sender, receiver) = mpsc::channel();
    serve(listener, Arc::new(Node(Mutex::new(sender))), Arc::new(AtomicBool::new(false))).unwrap();
    (uri, receiver)
}

#[test]
fn a_listener_hears_of_a_publisher_although_another_listener_hangs() {
    let master = EmbeddedMaster::start(0).unwrap();
    let hung = TcpListener::bind("127.0.0.1:0").unwrap();
    let hung_uri = format!("http://{}/", hung.local_addr().unwrap());
    let (uri, told) = node();
    ask(&master, "registerSubscriber", &["/hung", "/a", "std_msgs/Empty", &hung_uri]).unwrap();
    ask(&master, "registerSubscriber", &["/listener", "/a", "std_msgs/Empty", &uri]).unwrap();
    ask(&master, "registerPublisher", &["/speaker", "/a", "std_msgs/Empty", "http://127.0.0.1:1/"]).unwrap();
    let (method, parameters) = told.recv_timeout(LIMIT).unwrap();
    assert_eq!(method, "publisherUpdate");
    assert_eq!(parameters[2], Value::texts(["http://127.0.0.1:1/"]));
}

#[test]
fn what_nodes_and_tools_ask_is_answered() {
    let master = EmbeddedMaster::start(0).unwrap();
    assert!(ask(&master, "getPid", &["/n"]).unwrap().as_integer().unwrap() > 0);
    assert_eq!(ask(&master, "getUri", &["/n"]).unwrap(), Value::text(master.uri()));
    assert!(ask(&master, "getParam", &["/n", "/run_id"]).unwrap().as_text().is_some());
    ask(&master, "registerService", &["/n", "~stop", "rosrpc://h:1", "http://h:2/"]).unwrap();
    assert_eq!(ask(&master, "lookupService", &["/m", "/n/stop"]).unwrap(), Value::text("rosrpc://h:1"));
    assert_eq!(ask(&master, "lookupNode", &["/m", "/n"]).unwrap(), Value::text("http://h:2/"));
    assert!(ask(&master, "lookupNode", &["/m", "/nobody"]).is_err());
    assert!(ask(&master, "searchParam", &["/m", "missing"]).is_err());
    assert!(ask(&master, "noSuchMethod", &["/m"]).is_err());
    assert!(ask(&master, "getPid", &[]).is_err());
}

#[test]
fn several_calls_in_one_are_answered_one_by_one() {
    let master = EmbeddedMaster::start(0).unwrap();
    let one = |method: &str, parameters: Vec<Value>| {
        Value::Struct(BTreeMap::from([
            ("methodName".to_owned(), Value::text(method)),
            ("params".to_owned(), Value::Array(parameters)),
        ]))
    };
    let set = one("setParam", vec![Value::text("/launch"), Value::text("/a"), Value::Integer(5)]);
    let get = one("getParam", vec![Value::text("/launch"), Value::text("/a")]);
    let nested = one("system.multicall", vec![]);
    let answer = call(&master.uri(), "system.multicall", &[Value::Array(vec![set, get, nested])], LIMIT).unwrap();
    let answers = answer.as_array().unwrap();
    let value = |index: usize| &answers[index].as_array().unwrap()[0].as_array().unwrap()[2];
    assert_eq!((answers.len(), value(1)), (3, &Value::Integer(5)));
}

#[test]
fn a_master_on_a_port_in_use_is_refused_with_the_address() {
    let first = EmbeddedMaster::start(0).unwrap();
    let error = EmbeddedMaster::start(first.address.port()).unwrap_err();
    assert!(
        matches!(&error, RosError::MasterAddress { address, .. } if *address == first.address.to_string()),
        "{error}"
    );
}

#[test]
fn a_master_that_was_dropped_is_gone() {
    let master = EmbeddedMaster::start(0).unwrap();
    let uri = master.uri();
    drop(master);
    // The listener may be within its last connection; the one after it finds nobody.
    let gone = (0..50).any(|_| {
        std::thread::sleep(Duration::from_millis(10));
        call(&uri, "getPid", &[Value::text("/n")], LIMIT).is_err()
    });
    assert!(gone);
}

#[test]
fn a_silent_client_does_not_keep_others_from_the_master() {
    let master = EmbeddedMaster::start(0).unwrap();
    let silent: Vec<_> = (0..20).map(|_| TcpStream::connect(master.address).unwrap()).collect();
    assert!(ask(&master, "getPid", &["/n"]).is_ok());
    let mut buffer = [0; 1];
    silent[0].set_read_timeout(Some(Duration::from_millis(1))).unwrap();
    assert!((&silent[0]).read(&mut buffer).is_err(), "still open");
}
