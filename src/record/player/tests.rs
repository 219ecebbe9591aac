use super::*;
use crate::command::{Command, Origin};
use crate::record::JournalWriter;
use crate::supervisor::{Input, Supervisor};

/// A journal of ten seconds of beats, with a note each second.
fn journal(folder: &Path) -> PathBuf {
    let setup = Setup::default();
    let header = Header::of(&setup, "", 0).unwrap();
    let mut writer = JournalWriter::create(folder, &header).unwrap();
    let mut core = Supervisor::new(setup, crate::kinematics::RobotModel::baxter().unwrap()).unwrap();
    for number in 0..=1000_u64 {
        let now = Stamp::from_nanoseconds(5_000_000_000 + number * 10_000_000);
        let input = if number % 100 == 50 {
            Input::Operator { command: Command::Note(format!("note {}", number / 100)), origin: Origin::OperatorKey }
        } else {
            Input::Tick
        };
        let effects = core.step(now, &input);
        writer.step(now, &input, &effects, 0).unwrap();
    }
    writer.finish().unwrap()
}

fn player(folder: &Path) -> Player {
    Player::open(&journal(folder), Box::new(Ok)).unwrap()
}

fn notes(player: &Player) -> usize {
    player.snapshot().log.iter().filter(|line| line.source == "note").count()
}

fn seen(player: &mut Player) -> ReplayView {
    assert!(player.catch_up(usize::MAX));
    player.snapshot().replay.unwrap()
}

#[test]
fn it_goes_on_with_time_at_its_pace_and_stands_still_at_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let mut player = player(folder.path());
    player.pass(Duration::from_secs(2));
    assert!((seen(&mut player).position - 2.0).abs() < 1e-9);
    assert_eq!(notes(&player), 2);
    player.change_speed(4.0);
    player.pass(Duration::from_secs(1));
    assert!((seen(&mut player).position - 6.0).abs() < 1e-9);
    assert_eq!(notes(&player), 6);
    player.pass(Duration::from_mins(1));
    let view = seen(&mut player);
    assert!((view.position - view.length).abs() < 1e-9 && view.paused && (view.length - 10.0).abs() < 1e-9);
    assert_eq!((notes(&player), player.differing()), (10, 0));
    player.pause_or_go_on().unwrap();
    assert!(seen(&mut player).position.abs() < 1e-9);
    assert_eq!(notes(&player), 0);
}

#[test]
fn it_pauses_steps_to_the_next_decision_and_seeks_both_ways() {
    let folder = tempfile::tempdir().unwrap();
    let mut player = player(folder.path());
    player.pause_or_go_on().unwrap();
    player.pass(Duration::from_secs(3));
    assert!(seen(&mut player).position.abs() < 1e-9);
    player.step();
    // The first beat says that nothing is heard from the robot, or the first note comes: either is a decision.
    let first = seen(&mut player).position;
    player.step();
    let second = seen(&mut player).position;
    assert!(second > first && seen(&mut player).paused, "{first} {second}");
    player.seek(7.0).unwrap();
    assert!(seen(&mut player).position > 7.0);
    let far = notes(&player);
    player.seek(-5.0).unwrap();
    let view = seen(&mut player);
    assert!((2.0..5.0).contains(&view.position) && notes(&player) < far, "{view:?}");
    player.seek(-100.0).unwrap();
    assert!(seen(&mut player).position.abs() < 1e-9);
}

#[test]
fn work_is_done_in_portions_so_that_the_screen_stays_awake() {
    let folder = tempfile::tempdir().unwrap();
    let mut player = player(folder.path());
    player.seek(10.0).unwrap();
    let portions = (0..1000).take_while(|_| !player.catch_up(100)).count();
    assert_eq!(portions, 10);
}

#[test]
fn a_decision_that_differs_stands_in_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let path = journal(folder.path());
    let mut bytes = Vec::new();
    // The same trial with one note replaced: the journal says otherwise than the core decides.
    let mut writer = JournalWriter::create(folder.path(), &Header::of(&Setup::default(), "", 0).unwrap()).unwrap();
    read(&path, |_, mut step| {
        if step.number == 350 {
            step.effects.truncate(1);
        }
        bytes.push(step.number);
        writer.step(step.now, &step.input, &step.effects, 0).unwrap();
    })
    .unwrap();
    let mut player = Player::open(&writer.finish().unwrap(), Box::new(Ok)).unwrap();
    player.seek(10.0).unwrap();
    seen(&mut player);
    let log = player.snapshot().log;
    let told: Vec<_> = log.iter().filter(|line| line.source == "replay").collect();
    assert_eq!((player.differing(), told.len()), (1, 1));
    assert!(told[0].text.starts_with("step 350: recorded"), "{}", told[0].text);
}

#[test]
fn a_journal_without_a_step_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let header = Header::of(&Setup::default(), "", 0).unwrap();
    let path = JournalWriter::create(folder.path(), &header).unwrap().finish().unwrap();
    let error = Player::open(&path, Box::new(Ok)).unwrap_err().to_string();
    assert!(error.contains("no step"), "{error}");
}
