//! `valet bench console`: what the console costs and how fast it stops, measured on the real node over TCPROS and a real
//! pseudo-terminal.

mod stops;
mod terminal;

use crate::cli::exit::Failure;
use crate::cli::output::Output;
use crate::console::frame_times;
use crate::ros::{environment, node};
use serde::Serialize;
use std::os::unix::process::CommandExt;
use std::process::{Child, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use terminal::{Cost, Terminal};

/// How long anything may take to come up on a loaded machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// How often something is looked for.
const LOOK: Duration = Duration::from_millis(20);
/// The rings of the screen hold a minute: memory is judged after it.
const WARM_UP: Duration = Duration::from_secs(75);

/// The console: frames, stop latency, processor time, bytes to the terminal, memory.
#[derive(Debug, Clone, clap::Args)]
pub(in crate::cli) struct Arguments {
    /// Frames of each screen.
    #[arg(long, default_value_t = 2000)]
    frames: usize,
    /// How often the robot is stopped: by the key, and by a force over the hard cap.
    #[arg(long, default_value_t = 200)]
    stops: usize,
    /// For how many seconds each load is measured.
    #[arg(long, default_value_t = 10)]
    seconds: u64,
    /// For how many seconds memory is watched at full rate (75 s of warm-up come before).
    #[arg(long, default_value_t = 0)]
    soak: u64,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
    /// The port of the master; the program sets it for itself when it begins anew.
    #[arg(long, hide = true)]
    port: Option<u16>,
}

#[derive(Serialize)]
struct Latency<'a> {
    event: &'static str,
    bench: &'a str,
    count: usize,
    median_wall_seconds: f64,
    p99_wall_seconds: f64,
    bytes: Option<usize>,
}

#[derive(Serialize)]
struct Load<'a> {
    event: &'static str,
    bench: &'a str,
    frames_per_wall_seconds: f64,
    bytes_per_wall_seconds: f64,
    screen_thread_percent_wall_seconds: f64,
    process_percent_wall_seconds: f64,
}

#[derive(Serialize)]
struct Soak {
    event: &'static str,
    bench: &'static str,
    seconds: u64,
    first_quarter_kilobytes: f64,
    last_quarter_kilobytes: f64,
    largest_kilobytes: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(port) = arguments.port.filter(|port| environment::is_local(*port)) else {
        return begin_anew();
    };
    let mut output = Output::new(arguments.json);
    for times in frame_times(arguments.frames).map_err(Failure::configuration)? {
        let name = format!("frame 120x40 {}", times.screen);
        tell_latency(&mut output, &name, &times.sorted, Some(times.bytes))?;
    }
    let simulator = Simulator::start(port)?;
    measure_loads(&mut output, arguments)?;
    stops::measure(&mut output, arguments.stops)?;
    measure_memory(&mut output, arguments)?;
    measure_idle(&mut output, arguments, simulator)
}

/// The variables by which nodes find each other are read once, at the start: this program begins anew with them.
fn begin_anew() -> Result<(), Failure> {
    let port = environment::free_port().map_err(Failure::fault)?;
    let typed = std::env::args().skip(1).chain(["--port".into(), port.to_string()]);
    let mut again = environment::this_program(typed, port).map_err(Failure::fault)?;
    // Only returns where it fails.
    Err(Failure::fault(again.exec()))
}

/// The simulated robot in a process of its own, with the master in it; ends with its owner.
struct Simulator(Child);

impl Drop for Simulator {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to end.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Simulator {
    fn start(port: u16) -> Result<Self, Failure> {
        let typed = ["sim", "--master", "embedded", "--port"].map(String::from).into_iter().chain([port.to_string()]);
        let mut command = environment::this_program(typed, port).map_err(Failure::fault)?;
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let simulator = Self(command.spawn().map_err(Failure::fault)?);
        wait_until("the simulator's master", || node::probe_master(&node::master_uri()).is_ok())?;
        Ok(simulator)
    }
}

fn wait_until(what: &str, mut holds: impl FnMut() -> bool) -> Result<(), Failure> {
    let began = Instant::now();
    while !holds() {
        if began.elapsed() > PATIENCE {
            return Err(Failure::Fault(format!("{what} did not come up: this computer is overloaded")));
        }
        thread::sleep(LOOK);
    }
    Ok(())
}

/// A console on the simulated robot, drawing at most so many frames a second.
fn console(frames_per_second: u32) -> Result<(Terminal, tempfile::TempDir), Failure> {
    let folder = tempfile::tempdir().map_err(Failure::fault)?;
    let settings = folder.path().join("settings.toml");
    let text = format!("version = 1\n[console]\nframes_per_second = {frames_per_second}\n");
    std::fs::write(&settings, text).map_err(Failure::fault)?;
    let arguments = ["console", "--no-record", "--config"].map(String::from).into_iter();
    let arguments: Vec<String> = arguments.chain([settings.display().to_string()]).collect();
    let terminal = Terminal::start(&arguments, &[])?;
    let mut seen = Ok(0);
    wait_until("the console", || {
        seen = terminal.cost().map(|cost| cost.frames);
        !matches!(seen, Ok(0..=3))
    })?;
    seen.map(|_| (terminal, folder))
}

fn measure_loads(output: &mut Output, arguments: &Arguments) -> Result<(), Failure> {
    let span = Duration::from_secs(arguments.seconds);
    for (rate, screens) in [(30, "TFP"), (10, "TFPH")] {
        let (mut terminal, _folder) = console(rate)?;
        for screen in screens.chars() {
            terminal.press(screen.to_string().as_bytes())?;
            if screen == 'F' {
                terminal.press(b"---")?;
            }
            thread::sleep(Duration::from_secs(2));
            let load = load_over(&terminal, span)?;
            tell_load(output, &format!("load {rate} frames a second, screen {screen}"), span, load)?;
        }
    }
    Ok(())
}

fn load_over(terminal: &Terminal, span: Duration) -> Result<(Cost, Cost), Failure> {
    let before = terminal.cost()?;
    thread::sleep(span);
    Ok((before, terminal.cost()?))
}

fn measure_memory(output: &mut Output, arguments: &Arguments) -> Result<(), Failure> {
    if arguments.soak == 0 {
        return Ok(());
    }
    let (mut terminal, _folder) = console(30)?;
    terminal.press(b"F---")?;
    thread::sleep(WARM_UP);
    let mut samples = Vec::new();
    let began = Instant::now();
    while began.elapsed() < Duration::from_secs(arguments.soak) {
        samples.push(terminal.memory()?);
        thread::sleep(Duration::from_secs(1));
    }
    let quarter = (samples.len() / 4).max(1);
    let mean = |part: &mut dyn Iterator<Item = &u64>| part.take(quarter).sum::<u64>() as f64 / quarter as f64;
    let soak = Soak {
        event: "bench",
        bench: "memory at full rate",
        seconds: arguments.soak,
        first_quarter_kilobytes: mean(&mut samples.iter()),
        last_quarter_kilobytes: mean(&mut samples.iter().rev()),
        largest_kilobytes: samples.iter().copied().max().unwrap_or_default(),
    };
    output.line(format!(
        "{:<46} {} s: first quarter {:.0} kB, last quarter {:.0} kB, largest {} kB",
        soak.bench, soak.seconds, soak.first_quarter_kilobytes, soak.last_quarter_kilobytes, soak.largest_kilobytes
    ))?;
    output.event(&soak)
}

/// A console whose robot has gone: everything is stale, and only the clock goes on.
fn measure_idle(output: &mut Output, arguments: &Arguments, simulator: Simulator) -> Result<(), Failure> {
    let span = Duration::from_secs(arguments.seconds);
    let (terminal, _folder) = console(30)?;
    drop(simulator);
    thread::sleep(Duration::from_secs(3));
    let load = load_over(&terminal, span)?;
    tell_load(output, "load idle, no robot", span, load)
}

fn tell_latency(output: &mut Output, bench: &str, sorted: &[Duration], bytes: Option<usize>) -> Result<(), Failure> {
    let latency = Latency {
        event: "bench",
        bench,
        count: sorted.len(),
        median_wall_seconds: percentile(sorted, 50).as_secs_f64(),
        p99_wall_seconds: percentile(sorted, 99).as_secs_f64(),
        bytes,
    };
    let bytes = bytes.map_or_else(String::new, |bytes| format!(", {bytes} bytes"));
    let (median, p99) = (latency.median_wall_seconds * 1e3, latency.p99_wall_seconds * 1e3);
    output.line(format!(
        "{bench:<46} median {median:.3} ms, 99 of 100 within {p99:.3} ms ({} times{bytes})",
        latency.count
    ))?;
    output.event(&latency)
}

/// The value below which so many of a hundred lie, by the nearest rank.
fn percentile(sorted: &[Duration], hundredths: usize) -> Duration {
    let rank = (sorted.len() * hundredths).div_ceil(100).saturating_sub(1);
    sorted.get(rank).copied().unwrap_or_default()
}

fn tell_load(output: &mut Output, bench: &str, span: Duration, (before, after): (Cost, Cost)) -> Result<(), Failure> {
    let per_second = |count: u64| count as f64 / span.as_secs_f64();
    let percent = |time: Duration| 100.0 * time.as_secs_f64() / span.as_secs_f64();
    let load = Load {
        event: "bench",
        bench,
        frames_per_wall_seconds: per_second(after.frames - before.frames),
        bytes_per_wall_seconds: per_second(after.bytes - before.bytes),
        screen_thread_percent_wall_seconds: percent(after.screen.saturating_sub(before.screen)),
        process_percent_wall_seconds: percent(after.process.saturating_sub(before.process)),
    };
    output.line(format!(
        "{bench:<46} {:.1} frames/s, {:.1} kB/s, screen {:.2} % of a core, whole process {:.1} %",
        load.frames_per_wall_seconds,
        load.bytes_per_wall_seconds / 1e3,
        load.screen_thread_percent_wall_seconds,
        load.process_percent_wall_seconds
    ))?;
    output.event(&load)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_of_the_nearest_rank() {
        let times: Vec<Duration> = (1..=200).map(Duration::from_millis).collect();
        assert_eq!(percentile(&times, 50), Duration::from_millis(100));
        assert_eq!(percentile(&times, 99), Duration::from_millis(198));
        assert_eq!(percentile(&[], 99), Duration::ZERO);
        assert_eq!(percentile(&times[..1], 50), Duration::from_millis(1));
    }
}
