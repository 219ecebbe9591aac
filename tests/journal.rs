//! The journal of a whole simulated trial: it replays to the same decisions, survives cuts and corruption, and is a bag
//! that rosbag's own tools accept.

#![allow(clippy::unwrap_used, clippy::cast_possible_truncation, reason = "a test may fail loudly anywhere")]

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;
use valet::body::Side;
use valet::command::{Command, Origin};
use valet::config::Key;
use valet::geometry::{Pose, Wrench};
use valet::headless::{ScriptedOperator, VirtualTrial};
use valet::record::{
    Header, JournalError, JournalFile, JournalWriter, Recorder, RecorderNotice, Replay, Step, Told, close_journal,
    read, read_header, write_bag, write_csv,
};
use valet::sim::world::WorldSetup;
use valet::snapshot::{Level, Outcome, Watermark};
use valet::supervisor::{Effect, EndpointSample, Input, LinkEvent, Setup};
use valet::time::Stamp;

/// Records the first `seconds` of a simulated trial, with a flush after each second as the recorder does it.
fn recorded(folder: &Path, seconds: u64) -> PathBuf {
    let setup = Setup { seed: 3, watermark: Watermark::Demo, profile: "p-01".into(), ..Setup::default() };
    let mut writer = JournalWriter::create(folder, &Header::of(&setup, "version = 1\n", 0).unwrap()).unwrap();
    let mut trial = VirtualTrial::new(setup, &WorldSetup { seed: 3, ..WorldSetup::default() }).unwrap();
    let mut flushed = Stamp::ZERO;
    trial.run(&mut ScriptedOperator::new(3), Duration::from_secs(seconds), |now, input, effects| {
        writer.step(now, input, effects, 0).unwrap();
        if now.since(flushed) >= Duration::from_secs(1) {
            writer.flush().unwrap();
            flushed = now;
        }
    });
    writer.finish().unwrap()
}

fn steps_of(path: &Path) -> (Vec<Step>, valet::record::Reading) {
    let mut steps = Vec::new();
    let reading = read(path, |_, step| steps.push(step)).unwrap();
    (steps, reading)
}

fn damaged(path: &Path, damage: impl FnOnce(&mut Vec<u8>)) -> PathBuf {
    let mut bytes = std::fs::read(path).unwrap();
    damage(&mut bytes);
    let other = path.with_file_name("damaged.mcap");
    std::fs::write(&other, bytes).unwrap();
    other
}

#[test]
fn a_recorded_trial_replays_to_the_same_decisions_byte_for_byte() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 40);
    let (mut decisions, mut differences) = (0, Vec::new());
    let reading = Replay::run(&path, Ok, |_, _, _, effects, difference| {
        decisions += effects.len();
        differences.extend(difference.cloned());
    })
    .unwrap();
    assert!(reading.finished && reading.problems.is_empty() && reading.lost == 0);
    assert!(reading.steps > 5_000 && decisions > 1_000, "{} steps, {decisions} decisions", reading.steps);
    assert_eq!(differences, []);
}

#[test]
fn other_settings_bring_other_decisions_and_the_difference_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 40);
    let mut differences = Vec::new();
    let slower = |mut setup: Setup| {
        setup.settings.motion.speed = 0.05;
        Ok(setup)
    };
    Replay::run(&path, slower, |_, _, _, _, difference| differences.extend(difference.cloned())).unwrap();
    assert!(differences[0].recorded != differences[0].decided && differences[0].step > 0);
}

#[test]
fn a_number_that_is_not_finite_is_recorded_as_it_came() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 2);
    let (steps, _) = steps_of(&path);
    let mut sample = steps.iter().find_map(|step| match step.input {
        Input::Endpoint(sample) => Some(sample),
        _ => None,
    });
    let sample = sample.as_mut().unwrap();
    sample.wrench.force.x = f64::NAN;
    sample.wrench.force.y = f64::NEG_INFINITY;
    let mut writer = JournalWriter::create(folder.path(), &Header::of(&Setup::default(), "", 0).unwrap()).unwrap();
    writer.step(Stamp::from_nanoseconds(5), &Input::Endpoint(*sample), &[], 0).unwrap();
    let (steps, _) = steps_of(&writer.finish().unwrap());
    let Input::Endpoint(read) = &steps[0].input else { panic!("{:?}", steps[0].input) };
    assert!(read.wrench.force.x.is_nan() && read.wrench.force.y == f64::NEG_INFINITY);
}

#[test]
fn what_was_recorded_before_a_crash_is_readable_after_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 12);
    let (all, _) = steps_of(&path);
    let length = std::fs::metadata(&path).unwrap().len() as usize;
    let mut longest = 0;
    // A crash leaves any beginning of the file.
    for cut in (0..24).map(|part| length * part / 24 + part) {
        let path = damaged(&path, |bytes| bytes.truncate(cut));
        match read(&path, |_, step| {
            assert_eq!(step, all[step.number as usize]);
            longest = longest.max(step.number);
        }) {
            Ok(reading) => assert!(!reading.finished, "cut at {cut}"),
            // Too little for even the header.
            Err(error) => assert!(cut < 4096 && matches!(error, JournalError::Foreign { .. }), "{cut}: {error}"),
        }
    }
    let (cut_off, whole) = (longest, all.len() as u64);
    assert!(cut_off > whole * 8 / 10, "{cut_off} of {whole}");
}

#[test]
fn a_corrupted_chunk_is_named_with_its_offset_and_the_rest_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 12);
    let (all, whole) = steps_of(&path);
    for share in [3, 5, 7] {
        let mut at = 0;
        let path = damaged(&path, |bytes| {
            at = bytes.len() * share / 10;
            bytes[at..at + 40].fill(0xa5);
        });
        let (steps, reading) = steps_of(&path);
        assert!(!reading.problems.is_empty());
        assert!(reading.problems[0].offset <= at as u64, "{} and {at}", reading.problems[0]);
        assert!(steps.len() * 10 > all.len() * 6 && reading.steps < whole.steps, "{} of {}", steps.len(), all.len());
        assert_eq!(steps.last(), all.last());
        assert!(steps.iter().all(|step| *step == all[step.number as usize]));
    }
}

#[test]
fn foreign_and_future_files_are_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 1);
    let message = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        read(&path, |_, _| {}).unwrap_err().to_string()
    };
    assert!(message("x.mcap", b"").contains("x.mcap is not a trial that valet recorded: it is empty"));
    assert!(message("x.bag", b"#ROSBAG V2.0\n").contains("rosbag play"));
    assert!(message("x.txt", b"hello").contains("no MCAP file"));
    assert!(read(&folder.path().join("none.mcap"), |_, _| {}).unwrap_err().to_string().contains("none.mcap"));
    let path = damaged(&path, |bytes| {
        let pattern = b"\x06\0\0\0format\x01\0\0\0";
        let at = bytes.windows(pattern.len()).position(|window| window == pattern).unwrap();
        bytes[at + pattern.len()] = b'9';
    });
    let error = read(&path, |_, _| {}).unwrap_err();
    assert!(matches!(error, JournalError::Future { found: 9, .. }), "{error}");
}

#[test]
fn an_encrypted_journal_is_read_with_its_key_alone_and_a_cut_one_as_far_as_it_goes() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 12);
    let (all, _) = steps_of(&path);
    let key = |words: &str| Key::Passphrase(words.to_owned().into());
    let closed = close_journal(&path, &key("correct horse battery")).unwrap();
    assert!(!path.exists(), "the plain file is gone");
    let locked = read(&closed, |_, _| {}).unwrap_err();
    assert!(matches!(locked, JournalError::Locked { .. }) && locked.to_string().contains("--key"), "{locked}");
    let wrong = JournalFile::new(&closed, Some(key("another horse battery")));
    let refused = read(&wrong, |_, _| {}).unwrap_err().to_string();
    assert!(refused.contains(".mcap.age") && refused.contains("key"), "{refused}");
    let right = JournalFile::new(&closed, Some(key("correct horse battery")));
    assert_eq!(read_header(&right).unwrap().profile, "p-01");
    let mut steps = Vec::new();
    let reading = read(&right, |_, step| steps.push(step)).unwrap();
    assert!(reading.finished && reading.problems.is_empty() && steps == all);
    let bytes = std::fs::read(&closed).unwrap();
    std::fs::write(&closed, &bytes[..bytes.len() * 8 / 10]).unwrap();
    let reading = read(&right, |_, _| {}).unwrap();
    assert!(reading.steps * 10 > all.len() as u64 * 6, "{} of {}", reading.steps, all.len());
    assert!(reading.problems.iter().any(|problem| problem.what.contains("encrypted file is cut")), "{reading:?}");
    std::fs::write(&closed, &bytes[..9_000]).unwrap();
    let error = read(&right, |_, _| {}).unwrap_err().to_string();
    assert!(error.contains("cut or damaged at its beginning"), "{error}");
}

/// What a recorder says by itself, gathered.
fn gathered() -> (Told, Receiver<RecorderNotice>) {
    let (sender, notices) = channel();
    (Box::new(move |notice| sender.send(notice).unwrap()), notices)
}

#[test]
fn a_full_queue_never_blocks_and_is_told_of() {
    let folder = tempfile::tempdir().unwrap();
    let mut settings = valet::config::RecordingSettings { queue: 4, ..Default::default() };
    settings.least_free_megabytes = 0;
    let header = Header::of(&Setup::default(), "", 0).unwrap();
    let (told, notices) = gathered();
    let recorder = Recorder::start(folder.path(), &header, &settings, told).unwrap();
    for index in 0..20_000 {
        recorder.offer(Stamp::from_nanoseconds(index), &Input::Tick, &[]);
    }
    std::thread::sleep(Duration::from_millis(50));
    recorder.offer(Stamp::from_nanoseconds(20_000), &Input::Tick, &[]);
    let status = recorder.finish();
    assert_eq!(status.failed, None);
    let (steps, reading) = steps_of(&status.path);
    assert_eq!(reading.lost, status.lost);
    assert_eq!(reading.steps + reading.lost, 20_001);
    assert_eq!(steps.last().unwrap().number, 20_000);
    let told: u64 = notices
        .iter()
        .map(|notice| match notice {
            RecorderNotice::Overflowed { lost } => lost,
            RecorderNotice::Failed { reason } => panic!("{reason}"),
        })
        .sum();
    assert!(told > 0 && told == status.lost, "{told} of {}", status.lost);
}

#[test]
fn steps_while_recording_is_off_are_a_hole_that_the_journal_tells_of() {
    let folder = tempfile::tempdir().unwrap();
    let settings = valet::config::RecordingSettings { least_free_megabytes: 0, ..Default::default() };
    let header = Header::of(&Setup::default(), "", 0).unwrap();
    let recorder = Recorder::start(folder.path(), &header, &settings, Box::new(|_| {})).unwrap();
    for index in 0..30 {
        recorder.set_on(!(10..20).contains(&index));
        recorder.offer(Stamp::from_nanoseconds(index), &Input::Tick, &[]);
    }
    let status = recorder.finish();
    let (steps, reading) = steps_of(&status.path);
    assert_eq!((steps.len(), reading.lost, status.lost), (20, 10, 0));
    assert_eq!((steps[10].number, steps[10].lost_before), (20, 10));
}

#[test]
fn a_disk_without_space_is_refused_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let settings = valet::config::RecordingSettings { least_free_megabytes: u64::MAX >> 21, ..Default::default() };
    let header = Header::of(&Setup::default(), "", 0).unwrap();
    let error = Recorder::start(folder.path(), &header, &settings, Box::new(|_| {})).unwrap_err().to_string();
    assert!(error.contains("free on the disk"), "{error}");
}

#[test]
fn tables_hold_every_sample_and_an_anonymous_export_no_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 12);
    let (steps, _) = steps_of(&path);
    let samples = steps.iter().filter(|step| matches!(step.input, Input::Endpoint(_))).count();
    write_csv(&path, &folder.path().join("all"), false).unwrap();
    let lines = |name: &str| csv::Reader::from_path(folder.path().join(name)).unwrap().into_records().count();
    assert_eq!(lines("all/wrench.csv"), samples);
    write_csv(&path, &folder.path().join("anonymous"), true).unwrap();
    assert!(lines("anonymous/events.csv") < lines("all/events.csv"));
}

#[test]
fn the_tools_of_ros_accept_the_bag() {
    let folder = tempfile::tempdir().unwrap();
    let path = recorded(folder.path(), 12);
    let bag = folder.path().join("trial.bag");
    write_bag(&path, &bag, false).unwrap();
    let bytes = std::fs::read(&bag).unwrap();
    assert!(bytes.starts_with(b"#ROSBAG V2.0\n"));
    // The index stands where the first record says.
    let name = b"index_pos=";
    let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len();
    let index = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    // The index begins with a connection.
    assert!(bytes[index..index + 40].windows(4).any(|window| window == b"op=\x07"));
    // Where ROS is installed, its own tool reads every message with the definitions in the bag.
    let Ok(output) = std::process::Command::new("rosbag").args(["info", "--yaml"]).arg(&bag).output() else { return };
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for words in ["indexed: True", "baxter_core_msgs/EndpointState", "44bea01d596ff699fa1447bec34167ac", "/robot/state"]
    {
        assert!(text.contains(words), "{words} in {text}");
    }
}

/// A journal of a real afternoon with words in every place that can hold some.
fn wordy(folder: &Path, began: Stamp) -> PathBuf {
    let operator = |command| Input::Operator { command, origin: Origin::OperatorKey };
    let words = || "SECRET-WORDS".to_owned();
    let endpoint = |stamp| {
        let sample = EndpointSample { side: Side::Left, stamp, pose: Pose::identity(), wrench: Wrench::default() };
        (Input::Endpoint(sample), Vec::new())
    };
    let setup = Setup { profile: "p-01".into(), ..Setup::default() };
    let header = Header::of(&setup, "notes = \"SECRET-WORDS\"\n", began.nanoseconds()).unwrap();
    let mut writer = JournalWriter::create(folder, &header).unwrap();
    let log = Effect::Log { level: Level::Error, text: words() };
    let ended = Effect::TrialEnded { outcome: Outcome::Fault, reason: words() };
    let stopped = Effect::Stopped { outcome: Outcome::OperatorStop, cause: words() };
    let steps = [
        endpoint(began),
        (operator(Command::Note(words())), vec![log]),
        (operator(Command::SelectProfile(words())), Vec::new()),
        (Input::SetpointRefused { side: Side::Left, reason: words() }, vec![stopped]),
        (Input::Link(LinkEvent::ForeignPublisher { topic: words(), node: words() }), vec![ended]),
        endpoint(began + Duration::from_secs(1)),
    ];
    for (second, (input, effects)) in (0..).zip(steps) {
        writer.step(began + Duration::from_secs(second), &input, &effects, 0).unwrap();
    }
    writer.finish().unwrap()
}

/// Every file below a folder, one after the other.
fn bytes_below(folder: &Path) -> Vec<u8> {
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.iter().flat_map(|path| if path.is_dir() { bytes_below(path) } else { std::fs::read(path).unwrap() }).collect()
}

#[test]
fn an_anonymous_export_leaks_no_word_and_no_absolute_time() {
    let folder = tempfile::tempdir().unwrap();
    let seconds = 1_795_392_138_u32;
    let path = wordy(folder.path(), Stamp::ZERO + Duration::from_secs(u64::from(seconds)));
    let holds = |bytes: &[u8], pattern: &[u8]| bytes.windows(pattern.len()).any(|window| window == pattern);
    for (anonymous, name) in [(false, "plain"), (true, "anonymous")] {
        let out = folder.path().join(name);
        write_csv(&path, &out, anonymous).unwrap();
        write_bag(&path, &out.join("trial.bag"), anonymous).unwrap();
        let bytes = bytes_below(&out);
        assert_eq!(holds(&bytes, b"SECRET-WORDS"), !anonymous, "{name}");
        // The hour is enough to find somebody in a calendar: no second of it may stand there, in words or in a stamp.
        let stamped = (0..3600).any(|later| holds(&bytes, &(seconds - 1800 + later).to_le_bytes()));
        assert_eq!(stamped, !anonymous, "{name}");
        assert!(!anonymous || !holds(&bytes, b"17953"), "{name}");
    }
    let events = std::fs::read_to_string(folder.path().join("anonymous/events.csv")).unwrap();
    assert!(events.contains("stop") && events.contains("end"), "what happened is still told: {events}");
}
