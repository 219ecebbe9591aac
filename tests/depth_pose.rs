//! The person's pose from depth images, over TCPROS: it arrives without any tracker, and where the camera stops it is lost,
//! and said to be.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail loudly anywhere")]

use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How long anything may take on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(150);
/// When the simulated camera stops for good, in seconds of the simulation.
const LOST_AT: u32 = 25;
/// A pose that is older than this in milliseconds is not merely late.
const LONG_LOST: u64 = 5_000;

/// A process that ends with the test.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn valet(arguments: &[&str], port: u16) -> Process {
    let mut command = Command::new(env!("CARGO_BIN_EXE_valet"));
    command.args(arguments).env("ROS_MASTER_URI", format!("http://127.0.0.1:{port}")).env("ROS_IP", "127.0.0.1");
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    Process(command.spawn().unwrap())
}

/// What a process prints, line by line, as it comes.
fn lines_of(process: &mut Process) -> Receiver<String> {
    let (sender, lines) = channel();
    let output = BufReader::new(process.0.stdout.take().unwrap());
    thread::spawn(move || {
        for line in output.lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    lines
}

/// Asks for a start, or to go on, again and again until a line is as wanted; panics with all that was said where none comes.
fn start_until(console: &mut Process, lines: &Receiver<String>, what: &str, wanted: impl Fn(&str) -> bool) {
    let (began, mut said) = (Instant::now(), Vec::new());
    while began.elapsed() < PATIENCE {
        let input = console.0.stdin.as_mut().unwrap();
        // The robot's state may not have come yet when it is first to be enabled.
        writeln!(input, "enable\nstart\ncontinue").and_then(|()| input.flush()).unwrap();
        let pause = Instant::now();
        while let Ok(line) = lines.recv_timeout(Duration::from_millis(500).saturating_sub(pause.elapsed())) {
            if wanted(&line) {
                return;
            }
            said.push(line);
        }
    }
    panic!("{what}; it said:\n{}", said.join("\n"));
}

/// The age in milliseconds of a pose that a line calls too old.
fn age_of_the_pose(line: &str) -> Option<u64> {
    line.split_once("the person's pose: ")?.1.split_once(" ms old")?.0.parse().ok()
}

#[test]
fn a_pose_from_depth_images_arrives_and_is_lost_with_the_camera() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let folder = tempfile::tempdir().unwrap();
    let profile = folder.path().join("camera.toml");
    let person = include_str!("../profiles/default.toml");
    std::fs::write(&profile, format!("{person}\n[camera]\nneck_metres = [0.84, 0.0, 0.31]\n")).unwrap();
    let (number, fault) = (port.to_string(), format!("lost_camera@{LOST_AT}+600"));
    let mut simulator = valet(
        &[
            "sim",
            "--master",
            "embedded",
            "--port",
            &number,
            "--skeleton",
            "none",
            "--fault",
            &fault,
            "--until-input-ends",
        ],
        port,
    );
    // It speaks once its master answers.
    lines_of(&mut simulator).recv_timeout(PATIENCE).unwrap();
    let mut console = valet(&["console", "--headless", "--no-record", "--profile", profile.to_str().unwrap()], port);
    let lines = lines_of(&mut console);
    // A pose that has come has an age, and on a slow machine too great a one; that is judged before its joints, so whoever is
    // told that a joint is not seen has a fresh one.
    let came = |line: &str| {
        line.contains("is not seen") || line.contains("the trial begins") || age_of_the_pose(line).is_some()
    };
    start_until(&mut console, &lines, "no pose came", came);
    let lost = |line: &str| age_of_the_pose(line).is_some_and(|age| age > LONG_LOST);
    start_until(&mut console, &lines, "the loss was not told", lost);
}
