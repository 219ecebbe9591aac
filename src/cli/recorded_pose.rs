//! The person's pose from a recorded trial: its poses are told again at the pace at which they came.
//!
//! For trials in which no camera sees the person, who sits as recorded, and for comparing strategies on the very same pose. A gap of
//! the recording is a gap here, and after its end nothing more is told: the pose ages as one that no camera sees any more.

use super::exit::Failure;
use crate::body::BodyPose;
use crate::geometry::Finite;
use crate::record::{JournalFile, read};
use crate::ros::monitor;
use crate::supervisor::{Input, LinkEvent};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How long the thread sleeps at once: it ends within this time.
const LOOK: Duration = Duration::from_millis(5);

/// Poses with the time since the first.
#[derive(Debug)]
pub(super) struct RecordedPose {
    name: String,
    poses: Vec<(Duration, BodyPose)>,
}

/// The thread that tells them. Dropping it ends it.
pub(super) struct Telling {
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl RecordedPose {
    /// Reads the poses of a recorded trial.
    ///
    /// # Errors
    /// Where the file is no recording of valet, or no pose with a joint is in what can be read of it.
    pub(super) fn read(journal: JournalFile) -> Result<Self, Failure> {
        let name = journal.name();
        let mut poses: Vec<(Duration, BodyPose)> = Vec::new();
        let mut began = None;
        let mut refused = 0_usize;
        let reading = read(journal, |_, step| {
            let Input::Body(pose) = step.input else { return };
            if !has_joints(&pose) {
                refused += 1;
                return;
            }
            let at = step.now.since(*began.get_or_insert(step.now));
            if poses.last().is_none_or(|(last, _)| at > *last) {
                poses.push((at, pose));
            }
        })
        .map_err(Failure::configuration)?;
        if poses.is_empty() {
            let damage = reading.problems.first().map(|problem| format!("; {problem}")).unwrap_or_default();
            return Err(Failure::Configuration(format!(
                "{name}: no pose of a person is in it ({} steps read, {refused} poses without joints){damage}; choose a recording of a \
                 trial in which a camera or a tracker saw the person",
                reading.steps
            )));
        }
        Ok(Self { name, poses })
    }

    /// Where the pose comes from, in words.
    pub(super) fn source(&self) -> String {
        format!("recording {}", self.name)
    }

    /// Begins to tell the poses, as of now.
    ///
    /// # Errors
    /// Where the system has no thread to give.
    pub(super) fn tell(self, tell: Arc<dyn Fn(Input) + Send + Sync>) -> std::io::Result<Telling> {
        let ended = Arc::new(AtomicBool::new(false));
        let end = Arc::clone(&ended);
        let work = move || {
            let began = Instant::now();
            for (at, pose) in &self.poses {
                while began.elapsed() < *at {
                    if end.load(Ordering::SeqCst) {
                        return;
                    }
                    thread::sleep(at.saturating_sub(began.elapsed()).min(LOOK));
                }
                tell(Input::Body(BodyPose { stamp: monitor::now(), ..*pose }));
            }
            let reason = format!("{} has ended: no more poses come", self.source());
            tell(Input::Link(LinkEvent::CannotSee { reason }));
        };
        Ok(Telling { ended, thread: Some(thread::Builder::new().name("recorded pose".into()).spawn(work)?) })
    }
}

fn has_joints(pose: &BodyPose) -> bool {
    pose.arms.iter().any(|(_, arm)| {
        crate::body::Joint::ALL.iter().any(|joint| arm.position(*joint).is_some_and(|place| place.is_finite()))
    })
}

impl Drop for Telling {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has nothing more to tell.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{ArmPose, Evidence, Joint, JointEstimate, PerSide};
    use crate::geometry::Point;
    use crate::record::{Header, JournalWriter};
    use crate::supervisor::Setup;
    use crate::time::Stamp;
    use std::path::PathBuf;
    use std::sync::Mutex;

    fn pose(x: f64) -> BodyPose {
        let mut arm = ArmPose::default();
        let estimate = JointEstimate {
            position: Point::new(x, 0.2, 0.3),
            covariance: nalgebra::Matrix3::identity() * 1e-4,
            confidence: 1.0,
            evidence: Evidence::Seen,
        };
        arm.set(Joint::Hand, Some(estimate));
        BodyPose { arms: PerSide { left: arm, right: arm }, ..BodyPose::default() }
    }

    /// A journal of poses at these milliseconds.
    fn recorded(folder: &std::path::Path, poses: &[(u64, BodyPose)]) -> PathBuf {
        let header = Header::of(&Setup::default(), "", 1).unwrap();
        let mut writer = JournalWriter::create(folder, &header).unwrap();
        for (milliseconds, pose) in poses {
            let now = Stamp::from_nanoseconds(1_000_000_000 + milliseconds * 1_000_000);
            writer.step(now, &Input::Body(*pose), &[], 0).unwrap();
        }
        let path = writer.path().to_path_buf();
        writer.finish().unwrap();
        path
    }

    fn read_at(path: PathBuf) -> Result<RecordedPose, Failure> {
        RecordedPose::read(JournalFile::new(path, None))
    }

    #[test]
    fn poses_are_told_again_in_order_with_stamps_of_now_and_the_end_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let path =
            recorded(folder.path(), &[(0, pose(0.1)), (20, BodyPose::default()), (30, pose(0.2)), (60, pose(0.3))]);
        let read = read_at(path).unwrap();
        assert!(read.source().contains("trial-seed0-001"), "{}", read.source());
        let told: Arc<Mutex<Vec<Input>>> = Arc::default();
        let sink = Arc::clone(&told);
        let before = monitor::now();
        let telling = read.tell(Arc::new(move |input| sink.lock().unwrap().push(input))).unwrap();
        while told.lock().unwrap().len() < 4 {
            thread::sleep(LOOK);
        }
        drop(telling);
        let told = told.lock().unwrap();
        let places = told.iter().filter_map(|input| match input {
            Input::Body(pose) => {
                assert!(pose.stamp >= before, "a stamp of now");
                pose.arms.left.position(Joint::Hand)
            }
            _ => None,
        });
        assert_eq!(places.map(|place| place.x).collect::<Vec<_>>(), [0.1, 0.2, 0.3]);
        let Some(Input::Link(LinkEvent::CannotSee { reason })) = told.last() else { panic!("{told:?}") };
        assert!(reason.contains("has ended"), "{reason}");
    }

    #[test]
    fn a_thread_in_a_gap_ends_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let read = read_at(recorded(folder.path(), &[(0, pose(0.1)), (3_600_000, pose(0.2))])).unwrap();
        drop(read.tell(Arc::new(|_| ())).unwrap());
    }

    #[test]
    fn a_recording_without_a_person_a_file_that_is_none_and_one_that_is_not_there_are_named_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let words = |path: PathBuf| read_at(path).unwrap_err().to_string();
        let empty = words(recorded(folder.path(), &[(0, BodyPose::default())]));
        assert!(empty.contains("no pose of a person") && empty.contains("1 poses without joints"), "{empty}");
        let other = folder.path().join("other.mcap");
        std::fs::write(&other, "not a journal").unwrap();
        assert!(words(other).contains("other.mcap"));
        assert!(words(folder.path().join("missing.mcap")).contains("missing.mcap"));
        // One that is cut short is read as far as it goes.
        let whole = recorded(folder.path(), &[(0, pose(0.1)), (10, pose(0.2))]);
        let bytes = std::fs::read(&whole).unwrap();
        let cut = folder.path().join("cut.mcap");
        std::fs::write(&cut, &bytes[..bytes.len() / 8]).unwrap();
        assert!(words(cut).contains("cut.mcap"));
    }
}
