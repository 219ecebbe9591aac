//! `kill -9` in the middle of a recording: the journal opens and holds all but its last second.
//!
//! The process that is killed is this test itself, begun again: it records samples at the full rate of a robot. Twelve kills at
//! random moments are part of the tests; `VALET_TEST_KILLS=200 cargo test --test killed_recorder` makes two hundred.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::cast_possible_truncation,
    reason = "a test may fail loudly anywhere"
)]
#![allow(clippy::print_stdout, reason = "what is missing after each kill is to be read")]

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use valet::body::Side;
use valet::config::RecordingSettings;
use valet::geometry::{Pose, Wrench};
use valet::record::{Header, Recorder, read};
use valet::supervisor::{Effect, EndpointSample, Input, Setup};
use valet::time::Stamp;

/// The variable by which the process that is to be killed knows what it is.
const FOLDER: &str = "VALET_TEST_RECORDS_UNTIL_IT_IS_KILLED";
/// The variable that asks for another number of kills.
const KILLS: &str = "VALET_TEST_KILLS";
/// Kills without it.
const USUAL_KILLS: u64 = 12;
/// Recordings side by side: each sleeps most of its time.
const SIDE_BY_SIDE: u64 = 4;
/// The moments of the kills.
const SEED: u64 = 8;

fn now() -> Stamp {
    Stamp::ZERO + SystemTime::now().duration_since(UNIX_EPOCH).unwrap()
}

/// Records two wrenches, a beat and the positions of an arm at 100 Hz, as a trial does.
fn record_until_killed(folder: &Path) {
    let settings = RecordingSettings { least_free_megabytes: 0, ..RecordingSettings::default() };
    let header = Header::of(&Setup::default(), "", 0).unwrap();
    let recorder = Recorder::start(folder, &header, &settings, Box::new(|_| {})).unwrap();
    let began = Instant::now();
    while began.elapsed() < Duration::from_secs(60) {
        for side in Side::BOTH {
            let (pose, wrench) = (Pose::identity(), Wrench::default());
            recorder.offer(now(), &Input::Endpoint(EndpointSample { side, stamp: now(), pose, wrench }), &[]);
        }
        recorder.offer(now(), &Input::Tick, &[Effect::Setpoint { side: Side::Left, joints: [0.1; 7].into() }]);
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// The recording process, killed at the latest when the test ends.
struct Recording(Child);

impl Recording {
    fn start(folder: &Path) -> Self {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.env(FOLDER, folder).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        Self(command.spawn().unwrap())
    }

    /// Sends SIGKILL and waits until the process is gone.
    fn kill(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

/// The journal, as soon as something of the recording is on the disk.
fn growing_journal(folder: &Path) -> PathBuf {
    const MORE_THAN_THE_HEADER: u64 = 60_000;
    let began = Instant::now();
    while began.elapsed() < Duration::from_secs(50) {
        let entries = std::fs::read_dir(folder).unwrap().flatten();
        if let Some(entry) = entries.into_iter().find(|entry| entry.metadata().unwrap().len() > MORE_THAN_THE_HEADER) {
            return entry.path();
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("no journal grows in {}", folder.display());
}

#[test]
fn after_kill_9_the_journal_opens_and_holds_all_but_the_last_second() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        return record_until_killed(Path::new(&folder));
    }
    let kills = std::env::var(KILLS).map_or(USUAL_KILLS, |text| text.parse().unwrap());
    std::thread::scope(|scope| {
        for lane in 0..SIDE_BY_SIDE {
            scope.spawn(move || (lane..kills).step_by(SIDE_BY_SIDE as usize).for_each(kill_once));
        }
    });
}

/// Kills a recording at a moment that the number of the kill decides, and reads what is left of it.
fn kill_once(number: u64) {
    let delay = ChaCha8Rng::seed_from_u64(SEED + number).random_range(0..2500);
    let folder = tempfile::tempdir().unwrap();
    let mut recording = Recording::start(folder.path());
    let path = growing_journal(folder.path());
    std::thread::sleep(Duration::from_millis(delay));
    let killed = now();
    recording.kill();
    let (mut last, mut next) = (Stamp::ZERO, 0);
    let reading = read(&path, |_, step| {
        assert_eq!(step.number, next, "kill {number}: no hole before the end");
        (last, next) = (step.now, next + 1);
    })
    .unwrap();
    assert!(!reading.finished && reading.problems.is_empty(), "kill {number}: {:?}", reading.problems);
    assert!(next > 100 && reading.lost == 0, "kill {number}: {next} steps");
    // A second between two flushes, and the rest for a disk and a machine that are busy.
    let missing = killed.since(last);
    assert!(missing < Duration::from_secs(5), "kill {number}: {missing:?} are missing");
    println!("kill {number}: {next} steps, the last {:.2} s are missing", missing.as_secs_f64());
}
