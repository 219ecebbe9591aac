//! How long a stop takes until a peer has its message: from the key that is typed, and from a force that calls for it.

use super::terminal::Terminal;
use super::{LOOK, PATIENCE, console, tell_latency, wait_until};
use crate::body::Side;
use crate::cli::exit::Failure;
use crate::cli::output::Output;
use crate::cli::sim::ros_failure;
use crate::ros::ears::{ForceVoice, Ping, StopEar};
use crate::ros::{Node, WatchLink, leave};
use crate::snapshot::{Snapshot, TrialPhase};
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::thread;
use std::time::{Duration, Instant};

/// The keys and the word that clear a stop, enable the robot, and start a trial.
const RESET: [&[u8]; 1] = [b"Rreset\r"];
const ENABLE: [&[u8]; 2] = [b"E", b"y\r"];
const START: [&[u8]; 2] = [b"S", b"y\r"];
/// The screen puts a question a frame after the key that asks for it.
const UNTIL_THE_QUESTION: Duration = Duration::from_millis(300);
/// How long an act may take before it is asked for again.
const ASK_AGAIN: Duration = Duration::from_secs(2);
/// A force beyond the cap of 35 N that no setting raises.
const NEWTONS_BEYOND_THE_CAP: f64 = 60.0;

/// The ways that are in every stop by themselves; the key until a peer has the stop message; and a force message until then.
pub(super) fn measure(output: &mut Output, stops: usize) -> Result<(), Failure> {
    tell_latency(output, "loopback round trip of one byte", &tcp_round_trips(stops)?, None)?;
    let (terminal, _folder) = console(30)?;
    let own = Node::start("valet_bench").map_err(ros_failure)?;
    let ping = Ping::start().map_err(ros_failure)?;
    wait_until("the loopback message", || ping.once(LOOK).is_some())?;
    let mut ways: Vec<Duration> = (0..stops).filter_map(|_| ping.once(PATIENCE)).collect();
    ways.sort_unstable();
    tell_latency(output, "one empty TCPROS message over loopback", &ways, None)?;
    let ear = StopEar::listen().map_err(ros_failure)?;
    let watch = WatchLink::connect("/valet").map_err(ros_failure)?;
    let mut bench = Stops { terminal, ear, watch, newest: Snapshot::default() };
    // Without a trial force is nothing to stop for. Once stopped, it stays a trial, held.
    bench.begin_trial()?;
    // The heaviest screen: a minute of both arms.
    bench.press(&[b"F---"])?;
    let times = bench.several(stops, |terminal| terminal.press(b" "))?;
    tell_latency(output, "key to stop at a peer", &times, None)?;
    let voice = ForceVoice::start(Side::Right, PATIENCE).map_err(ros_failure)?;
    let times = bench.several(stops, |_| voice.say(NEWTONS_BEYOND_THE_CAP).map_err(ros_failure))?;
    tell_latency(output, "force over the cap to stop at a peer", &times, None)?;
    leave((bench.ear, bench.watch, voice, ping, own));
    Ok(())
}

/// A console, an ear for its stops and eyes for its state.
struct Stops {
    terminal: Terminal,
    ear: StopEar,
    watch: WatchLink,
    newest: Snapshot,
}

impl Stops {
    /// How long so many stops took, sorted.
    fn several(
        &mut self,
        count: usize,
        mut call: impl FnMut(&mut Terminal) -> Result<(), Failure>,
    ) -> Result<Vec<Duration>, Failure> {
        let mut times = (0..count).map(|index| self.one(index, &mut call)).collect::<Result<Vec<_>, _>>()?;
        times.sort_unstable();
        Ok(times)
    }

    fn one(
        &mut self,
        index: usize,
        call: &mut impl FnMut(&mut Terminal) -> Result<(), Failure>,
    ) -> Result<Duration, Failure> {
        self.ask_until("the robot without a stop", &RESET, is_clear)?;
        // At every phase of the beat and of the frames.
        thread::sleep(Duration::from_millis(index as u64 * 7 % 40));
        self.ear.forget();
        let called = Instant::now();
        call(&mut self.terminal)?;
        let heard = self.ear.next(PATIENCE).ok_or_else(|| Failure::Fault("a stop was not heard".into()))?;
        wait_until("the confirmed stop", || {
            let seen = self.look();
            seen.stop.confirmed_at.is_some() && seen.stop.latched && !seen.stop.is_reset
        })?;
        // The console is told by the same snapshots, a frame later.
        thread::sleep(Duration::from_millis(200));
        self.press(&RESET)?;
        Ok(heard.saturating_duration_since(called))
    }

    fn begin_trial(&mut self) -> Result<(), Failure> {
        let is_enabled = |seen: &Snapshot| seen.robot.state.is_some_and(|robot| robot.enabled);
        self.ask_until("the enabled robot", &ENABLE, is_enabled)?;
        let is_trial = |phase| !matches!(phase, TrialPhase::Idle | TrialPhase::Stopped | TrialPhase::Ended);
        self.ask_until("a trial", &START, |seen| is_trial(seen.trial.phase))
    }

    fn press(&mut self, keys: &[&[u8]]) -> Result<(), Failure> {
        for (index, part) in keys.iter().enumerate() {
            if index > 0 {
                thread::sleep(UNTIL_THE_QUESTION);
            }
            self.terminal.press(part)?;
        }
        Ok(())
    }

    /// The newest state of the node.
    fn look(&mut self) -> &Snapshot {
        if let Some(seen) = self.watch.newest() {
            self.newest = seen;
        }
        &self.newest
    }

    /// Types keys until the state is as wanted. They are typed again where a screen that had not seen the newest state refused.
    fn ask_until(&mut self, what: &str, keys: &[&[u8]], is_so: impl Fn(&Snapshot) -> bool) -> Result<(), Failure> {
        let mut asked = Instant::now();
        wait_until(what, || {
            if asked.elapsed() > ASK_AGAIN {
                asked = Instant::now();
                let _ = self.press(keys);
            }
            is_so(self.look())
        })
    }
}

fn is_clear(seen: &Snapshot) -> bool {
    seen.robot.state.is_some_and(|robot| !robot.stopped) && (!seen.stop.latched || seen.stop.is_reset)
}

fn tcp_round_trips(count: usize) -> Result<Vec<Duration>, Failure> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).map_err(Failure::fault)?;
    let address = listener.local_addr().map_err(Failure::fault)?;
    let echo = thread::spawn(move || -> std::io::Result<()> {
        let (mut peer, _) = listener.accept()?;
        peer.set_nodelay(true)?;
        let mut byte = [0];
        while peer.read(&mut byte)? > 0 {
            peer.write_all(&byte)?;
        }
        Ok(())
    });
    let round = || -> std::io::Result<Vec<Duration>> {
        let mut stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        let mut times = Vec::with_capacity(count);
        let mut byte = [0];
        for _ in 0..count {
            let began = Instant::now();
            stream.write_all(&byte)?;
            stream.read_exact(&mut byte)?;
            times.push(began.elapsed());
        }
        Ok(times)
    };
    let mut times = round().map_err(Failure::fault)?;
    // The echo ends with the connection; how it ended says nothing.
    let _ = echo.join();
    times.sort_unstable();
    Ok(times)
}
