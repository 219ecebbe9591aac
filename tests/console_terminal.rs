//! The real program in a pseudo-terminal: it draws, resizes, stops at a key, and gives the terminal back on quitting, on
//! SIGTERM and SIGHUP, and after a panic, in the order stop the robot, restore the terminal, tell.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::indexing_slicing,
    reason = "a test may fail loudly anywhere"
)]

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How long a busy machine may take for what a person would see at once.
const PATIENCE: Duration = Duration::from_secs(30);
/// What gives the screen back to the shell.
const LEAVE: &str = "\u{1b}[?1049l";
/// What shows the cursor again.
const CURSOR: &str = "\u{1b}[?25h";

/// A program on a terminal of its own.
struct Session {
    child: Box<dyn Child + Send + Sync>,
    terminal: Box<dyn MasterPty + Send>,
    keys: Box<dyn Write + Send>,
    output: Receiver<Vec<u8>>,
    seen: String,
}

impl Session {
    fn start(program: &Path, arguments: &[&str], variables: &[(&str, &str)]) -> Self {
        let size = PtySize { rows: 40, cols: 120, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        let mut command = CommandBuilder::new(program);
        command.args(arguments);
        for (name, value) in [("LANG", "C.UTF-8"), ("TERM", "xterm-256color")].iter().chain(variables) {
            command.env(name, value);
        }
        let child = pair.slave.spawn_command(command).unwrap();
        let mut reader = pair.master.try_clone_reader().unwrap();
        let keys = pair.master.take_writer().unwrap();
        let (sender, output) = channel();
        thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut bytes) {
                if sender.send(bytes[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        Self { child, terminal: pair.master, keys, output, seen: String::new() }
    }

    fn practise() -> Self {
        let mut session = Self::start(Path::new(env!("CARGO_BIN_EXE_valet")), &["keys", "--practise"], &[]);
        session.wait_for("EMERGENCY");
        session
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
        self.keys.flush().unwrap();
    }

    /// Reads until a text has come, from where the last wait ended.
    fn wait_for(&mut self, text: &str) {
        let start = Instant::now();
        loop {
            if let Some(place) = self.seen.find(text) {
                self.seen.drain(..place + text.len());
                return;
            }
            assert!(start.elapsed() < PATIENCE, "{text:?} did not come; seen last: {:?}", self.last());
            if let Ok(bytes) = self.output.recv_timeout(Duration::from_millis(100)) {
                self.seen.push_str(&String::from_utf8_lossy(&bytes));
            }
        }
    }

    /// The last thousand letters that were seen.
    fn last(&self) -> &str {
        let place = self.seen.char_indices().rev().nth(999).map_or(0, |(place, _)| place);
        &self.seen[place..]
    }

    /// Waits until the screen says that the robot has confirmed the stop. Only cells that change are written, so the words may
    /// come in pieces: another size has the whole frame written anew.
    fn wait_for_the_confirmed_stop(&mut self) {
        const WORDS: &str = "confirmed by the robot";
        let start = Instant::now();
        for cols in [119, 118].into_iter().cycle() {
            self.terminal.resize(PtySize { rows: 40, cols, pixel_width: 0, pixel_height: 0 }).unwrap();
            let turn = Instant::now();
            while turn.elapsed() < Duration::from_secs(1) && !self.seen.contains(WORDS) {
                if let Ok(bytes) = self.output.recv_timeout(Duration::from_millis(100)) {
                    self.seen.push_str(&String::from_utf8_lossy(&bytes));
                }
            }
            if self.seen.contains(WORDS) || start.elapsed() > PATIENCE {
                return self.wait_for(WORDS);
            }
        }
    }

    fn signal(&self, name: &str) {
        let id = self.child.process_id().unwrap().to_string();
        assert!(Command::new("kill").args(["-s", name, &id]).status().unwrap().success());
    }

    /// Waits for the end; returns the exit code and everything that was not read yet.
    fn end(mut self) -> (u32, String) {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(status) = self.child.try_wait().unwrap() {
                thread::sleep(Duration::from_millis(100));
                while let Ok(bytes) = self.output.try_recv() {
                    self.seen.push_str(&String::from_utf8_lossy(&bytes));
                }
                return (status.exit_code(), self.seen);
            }
            thread::sleep(Duration::from_millis(20));
        }
        self.child.kill().unwrap();
        panic!("the program did not end; seen: {:?}", self.seen);
    }
}

fn assert_restored(seen: &str) {
    assert!(seen.contains(LEAVE) && seen.contains(CURSOR), "the terminal was not given back: {seen:?}");
}

#[test]
fn it_draws_resizes_stops_at_the_key_and_gives_the_terminal_back() {
    let mut session = Session::practise();
    session.wait_for("red button");
    session.terminal.resize(PtySize { rows: 12, cols: 60, pixel_width: 0, pixel_height: 0 }).unwrap();
    session.wait_for("3.1:");
    session.terminal.resize(PtySize { rows: 1, cols: 1, pixel_width: 0, pixel_height: 0 }).unwrap();
    session.terminal.resize(PtySize { rows: 40, cols: 120, pixel_width: 0, pixel_height: 0 }).unwrap();
    session.wait_for("(steps");
    session.press(" ");
    session.wait_for_the_confirmed_stop();
    session.press("qy\r");
    let (code, seen) = session.end();
    assert_restored(&seen);
    assert_eq!(code, 0);
}

#[test]
fn no_stop_key_is_lost_behind_what_was_typed_before_it() {
    let pasted = "x".repeat(3000);
    let befores: [&[u8]; 9] = [
        b"\x1b",
        b"\x1b[",
        b"\x1bO",
        b"\x1b[1;",
        b"\x1b[<0;1",
        b"\x1b[200~",
        // One byte of a terminal that speaks Latin-1, and one that begins a letter of UTF-8.
        b"\xe4",
        b"\xc3",
        pasted.as_bytes(),
    ];
    for before in befores {
        for stop in [b" ", b"\x03"] {
            let mut session = Session::practise();
            session.keys.write_all(&[before, stop].concat()).unwrap();
            session.wait_for_the_confirmed_stop();
            session.press("\u{3}\u{3}");
            session.end();
        }
    }
}

// Drawn anew with a question to the terminal, whose answer would come among the keys, it would wait for that answer and leave.
#[test]
fn a_screen_drawn_anew_asks_the_terminal_nothing_and_loses_no_stop_key() {
    let mut session = Session::practise();
    session.press("\u{c} ");
    session.wait_for_the_confirmed_stop();
    session.press("\u{3}\u{3}");
    let (_, seen) = session.end();
    assert_restored(&seen);
}

#[test]
fn no_stop_key_is_lost_that_comes_with_a_new_size() {
    for cols in [100, 101, 102] {
        let mut session = Session::practise();
        session.signal("STOP");
        session.terminal.resize(PtySize { rows: 40, cols, pixel_width: 0, pixel_height: 0 }).unwrap();
        session.press(" ");
        session.signal("CONT");
        session.wait_for_the_confirmed_stop();
        session.press("\u{3}\u{3}");
        session.end();
    }
}

#[test]
fn sigterm_and_sighup_give_the_terminal_back() {
    for name in ["TERM", "HUP"] {
        let session = Session::practise();
        session.signal(name);
        let (_, seen) = session.end();
        assert_restored(&seen);
    }
}

#[test]
fn a_terminal_that_goes_away_ends_the_program() {
    let Session { mut child, terminal, keys, output, .. } = Session::practise();
    drop((terminal, keys, output));
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().unwrap();
            panic!("the program outlived its terminal");
        }
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn sigusr1_reads_theme_and_keys_again_and_the_stop_key_stays() {
    let mut session = Session::practise();
    session.signal("USR1");
    // Only cells that change are written, so a text may come in pieces: another size has the whole frame drawn anew.
    thread::sleep(Duration::from_millis(500));
    session.terminal.resize(PtySize { rows: 40, cols: 119, pixel_width: 0, pixel_height: 0 }).unwrap();
    session.wait_for("again");
    session.press(" ");
    session.wait_for_the_confirmed_stop();
    session.press("qy\r");
    let (_, seen) = session.end();
    assert_restored(&seen);
}

#[test]
fn control_z_is_refused_while_an_arm_may_move() {
    let mut session = Session::practise();
    session.press("\u{1a}");
    session.wait_for("not while an arm may move");
    session.press("\u{3}\u{3}");
    let (_, seen) = session.end();
    assert_restored(&seen);
}

#[test]
fn without_a_terminal_it_says_what_to_do() {
    let output = Command::new(env!("CARGO_BIN_EXE_valet")).args(["keys", "--practise"]).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && text.contains("--headless"), "{text}");
    assert!(output.stdout.is_empty());
}

/// The state of a process and its parent; `None` where there is none.
fn process(id: u32) -> Option<(char, u32)> {
    let text = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    // The name in brackets may hold anything.
    let mut rest = text.rsplit(')').next()?.split_whitespace();
    Some((rest.next()?.chars().next()?, rest.next()?.parse().ok()?))
}

/// The simulator that a demo has started.
fn simulator_of(demo: u32) -> Option<u32> {
    let entries = std::fs::read_dir("/proc").ok()?.flatten();
    let mut ids = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    ids.find(|id| {
        let command = std::fs::read_to_string(format!("/proc/{id}/cmdline")).unwrap_or_default();
        process(*id).is_some_and(|(_, parent)| parent == demo) && command.contains("embedded")
    })
}

/// Waits until something is there; `None` where it does not come.
fn awaited<T>(mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        if let Some(found) = look() {
            return Some(found);
        }
        thread::sleep(Duration::from_millis(20));
    }
    None
}

#[test]
fn a_demo_that_is_killed_takes_its_simulator_with_it() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_valet"));
    command.args(["demo", "--headless", "--ros", "--no-record"]).stdout(Stdio::null()).stderr(Stdio::null());
    let mut demo = command.spawn().unwrap();
    let simulator = awaited(|| simulator_of(demo.id()));
    demo.kill().unwrap();
    demo.wait().unwrap();
    let simulator = simulator.expect("no simulator was started");
    let gone = awaited(|| process(simulator).is_none_or(|(state, _)| state == 'Z').then_some(()));
    if gone.is_none() {
        Command::new("kill").args(["-9", &simulator.to_string()]).status().unwrap();
    }
    assert!(gone.is_some(), "the simulator lives on without its demo");
}

/// Variable by which this test program, started by itself in a pseudo-terminal, knows that it is to panic.
const PANICKING: &str = "VALET_TEST_PANICS";
/// What the made-up robot says when it is stopped.
const STOPPED: &str = "the robot was told to stop";

#[test]
fn a_panic_stops_the_robot_first_then_restores_the_terminal_then_tells() {
    if std::env::var_os(PANICKING).is_some() {
        panic_in_the_console();
    }
    let arguments = ["--exact", "a_panic_stops_the_robot_first_then_restores_the_terminal_then_tells", "--nocapture"];
    let program = std::env::current_exe().unwrap();
    let (_, seen) = Session::start(&program, &arguments, &[(PANICKING, "1")]).end();
    assert_restored(&seen);
    let place = |text: &str| seen.find(text).unwrap_or_else(|| panic!("{text:?} is missing in {seen:?}"));
    let (stopped, restored, told) = (place(STOPPED), place(LEAVE), place("the drawing broke"));
    assert!(stopped < restored && restored < told, "{stopped} {restored} {told}: {seen:?}");
}

/// Runs a console whose snapshots break; its stop says so on the terminal, where the order of things can be read.
fn panic_in_the_console() -> ! {
    use valet::console::{ConsoleOptions, StopHandle, run};
    let stop = || {
        print!("{STOPPED}");
        std::io::stdout().flush().unwrap();
    };
    let stop: std::sync::Arc<dyn StopHandle> = std::sync::Arc::new(stop);
    let mut turns = 0;
    let snapshots = move || {
        turns += 1;
        assert!(turns < 5, "the drawing broke");
        None
    };
    let commands = |_| Ok(());
    let left = run(snapshots, commands, &stop, None, &ConsoleOptions::default());
    panic!("the console was left without a panic: {left:?}");
}
