use super::*;
use crate::ros::greeting::read_block;
use crate::ros::xmlrpc::http::{Handler, serve};
use rosrust::RosMsg;
use std::io::Write;
use std::net::TcpListener;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

/// Far more than an answer takes on a machine that is busy with other tests.
const PATIENCE: Duration = Duration::from_secs(30);
const WANTED: [&str; 2] = ["baxter_core_msgs/EndpointState", "44be"];

/// Master and node at one address.
struct Graph {
    address: Mutex<String>,
    port: i32,
}

impl Handler for Graph {
    fn handle(&self, method: &str, _parameters: &[Value]) -> Value {
        let value = match method {
            "lookupNode" => Value::text(self.address.lock().unwrap().clone()),
            "requestTopic" => {
                Value::Array(vec![Value::text("TCPROS"), Value::text("127.0.0.1"), Value::Integer(self.port)])
            }
            other => panic!("{other}"),
        };
        Value::Array(vec![Value::Integer(1), Value::text(""), value])
    }
}

/// A publisher that greets each subscriber with the fields that `greeting` holds at the time.
fn publisher(greeting: Arc<Mutex<Fields>>) -> Asker {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = i32::from(listener.local_addr().unwrap().port());
    thread::spawn(move || {
        for stream in listener.incoming() {
            let mut stream = stream.unwrap();
            let asked = read_block(&mut stream, 1 << 16).unwrap();
            assert!(asked.windows(8).any(|window| window == b"md5sum=*"), "it takes any definition");
            let mut bytes = Vec::new();
            greeting.lock().unwrap().encode(&mut bytes).unwrap();
            stream.write_all(&bytes).unwrap();
        }
    });
    let graph = Arc::new(Graph { address: Mutex::default(), port });
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}/", listener.local_addr().unwrap());
    graph.address.lock().unwrap().clone_from(&address);
    serve(listener, graph, Arc::new(AtomicBool::new(false))).unwrap();
    Asker { master: address, caller: "/valet".into(), limit: PATIENCE }
}

fn fields(kind: &str, digest: &str) -> Fields {
    [("type", kind), ("md5sum", digest)].into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
}

fn monitor() -> Monitor {
    let [kind, digest] = WANTED.map(str::to_owned);
    Monitor::new("/robot/limb/left/endpoint_state", Definition { kind, digest }, (80.0, 125.0), true)
}

/// What is told of a publisher that greets with these fields, looked at so many times.
fn told(greeting: Fields, monitor: &Monitor, looks: usize) -> Vec<LinkEvent> {
    let asker = publisher(Arc::new(Mutex::new(greeting)));
    let events = Arc::new(Mutex::new(Vec::new()));
    let kept = Arc::clone(&events);
    let sink: Sink = Arc::new(move |input| {
        if let Input::Link(event) = input {
            kept.lock().unwrap().push(event);
        }
    });
    let (sender, lists) = bounded(looks);
    let there = Publisher { node: "/old_robot".into(), monitor: monitor.clone(), is_silent: false };
    (0..looks).for_each(|_| sender.send(vec![there.clone()]).unwrap());
    drop(sender);
    follow(&asker, &lists, &sink);
    std::mem::take(&mut *events.lock().unwrap())
}

#[test]
fn a_publisher_with_another_definition_is_named_once_with_both_digests() {
    let monitor = monitor();
    monitor.set_publishers(vec!["/old_robot".into()]);
    let events = told(fields(WANTED[0], "beef"), &monitor, 3);
    let [LinkEvent::WrongDefinition { topic, node, found, wanted }] = events.as_slice() else { panic!("{events:?}") };
    assert_eq!((topic.as_str(), node.as_str()), ("/robot/limb/left/endpoint_state", "/old_robot"));
    assert_eq!(found, "baxter_core_msgs/EndpointState (md5 beef)");
    assert_eq!(wanted, "baxter_core_msgs/EndpointState (md5 44be)");
    assert_eq!(monitor.report(crate::ros::monitor::now()).wrong, [("/old_robot".to_owned(), found.clone())]);
}

#[test]
fn a_publisher_with_the_same_definition_is_nothing_to_tell() {
    assert_eq!(told(fields(WANTED[0], WANTED[1]), &monitor(), 2), []);
    assert_eq!(told(fields("*", "*"), &monitor(), 1), [], "a bag player may not say");
    let either = monitor().reading(vec!["new".into(), "old".into()]);
    assert_eq!(told(fields(WANTED[0], "old"), &either, 1), []);
    assert_eq!(told(fields(WANTED[0], "44be"), &either, 1).len(), 1);
}

#[test]
fn a_publisher_that_refuses_or_says_nothing_is_no_other_definition() {
    let refusal: Fields = [("error".to_owned(), "not a publisher of this".to_owned())].into();
    assert_eq!(told(refusal, &monitor(), 1), []);
    assert_eq!(told(Fields::new(), &monitor(), 1), []);
    let nobody = Asker { master: "http://127.0.0.1:1/".into(), caller: "/valet".into(), limit: PATIENCE };
    assert!(nobody.definition("/topic", "/node").is_err());
}
