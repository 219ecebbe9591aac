//! `valet bench pose`: joints in a folder of depth images, with label images, so that anyone can judge it on own data.
//!
//! Reads `NAME.png` (16-bit, millimetres) with `NAME.json` (`fx`, `fy`, `cx`, `cy`, `neck_m`), writes the label image
//! `NAME.png` and a line of `joints.jsonl` for each. One core, one image after the other, and only the finding is timed.
//! An image that cannot be used is named with its reason and left out; the others are done all the same.

use super::super::exit::Failure;
use super::super::images::{ImageNotes, pictures_in, read_depth, write_labels};
use super::super::output::{Output, complain};
use crate::body::{ArmPose, Joint, PerSide};
use crate::config::write_whole;
use crate::vision::generic;
use crate::vision::{CameraJoints, DepthImage, Facing, Forest, PoseFinder, View};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Joints in a folder of depth images: label images, places and times.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct Arguments {
    /// Folder with NAME.png (16-bit grey, millimetres) and NAME.json (fx, fy, cx, cy in pixels; `neck_m` as [x, y, z] in the
    /// camera frame).
    #[arg(long, value_name = "DIR")]
    images: PathBuf,
    /// Folder with the empty scene of each image: NAME.png, or one image for all.
    #[arg(long, value_name = "DIR")]
    empty: Option<PathBuf>,
    /// Folder for label images (8-bit, 255 is no part) and joints.jsonl; made where it does not exist.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The forest to use; without it, the one that valet brings along.
    #[arg(long, value_name = "FILE")]
    forest: Option<PathBuf>,
    /// Which way the person faces in images whose NAME.json does not say so with `facing`.
    #[arg(long, value_enum, default_value_t)]
    facing: FacingChoice,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum FacingChoice {
    /// Towards the lower edge: the camera is above or ahead of the person.
    #[default]
    LowerEdge,
    /// Towards the upper edge: the camera is behind the person, as on the robot's head.
    UpperEdge,
}

impl From<FacingChoice> for Facing {
    fn from(choice: FacingChoice) -> Self {
        match choice {
            FacingChoice::LowerEdge => Self::LowerEdge,
            FacingChoice::UpperEdge => Self::UpperEdge,
        }
    }
}

/// A line of `joints.jsonl`: metres in the camera frame, `null` where not seen.
#[derive(Debug, Serialize)]
struct Line<'a> {
    file: &'a str,
    joints: PerSide<Places>,
}

#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Places {
    shoulder: Option<[f64; 3]>,
    upper_arm: Option<[f64; 3]>,
    forearm: Option<[f64; 3]>,
    hand: Option<[f64; 3]>,
    elbow: Option<[f64; 3]>,
    wrist: Option<[f64; 3]>,
}

impl Places {
    fn of(arm: &ArmPose) -> Self {
        let place = |joint| arm.position(joint).map(|point| [point.x, point.y, point.z]);
        Self {
            shoulder: place(Joint::Shoulder),
            upper_arm: place(Joint::UpperArm),
            forearm: place(Joint::Forearm),
            hand: place(Joint::Hand),
            elbow: place(Joint::Elbow),
            wrist: place(Joint::Wrist),
        }
    }
}

#[derive(Debug, Serialize)]
struct Unusable<'a> {
    event: &'static str,
    file: &'a str,
    reason: &'a str,
}

#[derive(Debug, Default, Serialize)]
struct Summary {
    event: &'static str,
    images: usize,
    failed: usize,
    joints_seen: usize,
    joints_not_seen: usize,
    mean_milliseconds: f64,
    median_milliseconds: f64,
    p99_milliseconds: f64,
    /// Of this thread's own: what other programs take is not in it.
    p99_processor_milliseconds: f64,
    total_wall_seconds: f64,
}

pub(in crate::cli) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut bench = Bench::open(arguments)?;
    let pictures = pictures_in(&arguments.images)?;
    if pictures.is_empty() {
        return Err(Failure::Configuration(format!(
            "{}: holds no NAME.png; make images with `valet sim --images DIR`",
            arguments.images.display()
        )));
    }
    let mut output = Output::new(arguments.json);
    let mut failed = 0;
    for picture in &pictures {
        if let Err(reason) = bench.judge(picture) {
            failed += 1;
            complain(&Failure::Configuration(reason.clone()));
            output.event(&Unusable { event: "unusable", file: &name_of(picture), reason: &reason })?;
        }
    }
    let joints = arguments.out.join("joints.jsonl");
    write_whole(&joints, bench.lines.as_bytes()).map_err(Failure::configuration)?;
    let summary = bench.summary(pictures.len(), failed);
    output.line(format!(
        "{} images, {failed} unusable, {} joints seen, {} not seen; mean {:.2} ms, 99 of 100 within {:.2} ms ({:.2} ms of \
         processor time). Written: {}",
        summary.images,
        summary.joints_seen,
        summary.joints_not_seen,
        summary.mean_milliseconds,
        summary.p99_milliseconds,
        summary.p99_processor_milliseconds,
        joints.display()
    ))?;
    output.event(&summary)?;
    if failed > 0 {
        return Err(Failure::Configuration(format!("{failed} of {} images could not be used", pictures.len())));
    }
    Ok(())
}

/// The finder with what it has found so far.
struct Bench<'a> {
    arguments: &'a Arguments,
    finder: PoseFinder,
    empties: Vec<PathBuf>,
    labels: Vec<u8>,
    lines: String,
    times: Vec<Duration>,
    /// The same in processor time.
    processor_times: Vec<Duration>,
    seen: usize,
    began: Instant,
}

impl<'a> Bench<'a> {
    fn open(arguments: &'a Arguments) -> Result<Self, Failure> {
        let forest = read_forest(arguments.forest.as_deref())?;
        let empties = arguments.empty.as_deref().map(pictures_in).transpose()?.unwrap_or_default();
        if let Some(folder) = arguments.empty.as_ref().filter(|_| empties.is_empty()) {
            return Err(Failure::Configuration(format!("{}: holds no image of the empty scene", folder.display())));
        }
        std::fs::create_dir_all(&arguments.out).map_err(|error| {
            Failure::Configuration(format!("cannot make folder {}: {error}", arguments.out.display()))
        })?;
        Ok(Self {
            arguments,
            finder: PoseFinder::new(forest),
            empties,
            labels: Vec::new(),
            lines: String::new(),
            times: Vec::new(),
            processor_times: Vec::new(),
            seen: 0,
            began: Instant::now(),
        })
    }

    /// Finds the joints of one image and writes its labels.
    fn judge(&mut self, picture: &Path) -> Result<(), String> {
        let image = read_depth(picture)?;
        let notes = ImageNotes::beside(picture)?;
        let empty = self.empty_of(picture)?;
        let facing = notes.facing.unwrap_or_else(|| self.arguments.facing.into());
        let view = View { camera: notes.camera(), neck: notes.neck(), empty: empty.as_ref(), facing };
        let (start, processor_start) = (Instant::now(), processor_time());
        let joints = self.finder.find(&image, &view).map_err(|error| format!("{}: {error}", picture.display()))?;
        self.times.push(start.elapsed());
        self.processor_times.push(processor_time().saturating_sub(processor_start));
        self.finder.labels(&mut self.labels);
        let name = name_of(picture);
        write_labels(&self.arguments.out.join(&name), (image.width(), image.height()), &self.labels)
            .map_err(|error| error.to_string())?;
        self.note(&name, &joints)
    }

    /// The empty scene that goes with an image: of the same name, or the only one there is.
    fn empty_of(&self, picture: &Path) -> Result<Option<DepthImage>, String> {
        let own = self.empties.iter().find(|path| path.file_name() == picture.file_name());
        let path = match (own, self.empties.as_slice()) {
            (Some(own), _) => own,
            (None, [only]) => only,
            (None, []) => return Ok(None),
            (None, _) => {
                let remedy = "put one of the same name there, or a single one for all";
                return Err(format!("{}: there is no empty scene for it; {remedy}", picture.display()));
            }
        };
        read_depth(path).map(Some)
    }

    fn note(&mut self, name: &str, joints: &CameraJoints) -> Result<(), String> {
        let line = Line { file: name, joints: joints.arms.map(|_, arm| Places::of(arm)) };
        self.lines.push_str(&serde_json::to_string(&line).map_err(|error| format!("{name}: {error}"))?);
        self.lines.push('\n');
        for (_, arm) in joints.arms.iter() {
            self.seen += Joint::ALL.iter().filter(|joint| arm.joint(**joint).is_some()).count();
        }
        Ok(())
    }

    fn summary(&mut self, images: usize, failed: usize) -> Summary {
        self.times.sort_unstable();
        self.processor_times.sort_unstable();
        let count = self.times.len().max(1);
        let at = |times: &[Duration], index: usize| times.get(index).map_or(0.0, |time| time.as_secs_f64() * 1e3);
        let last_of_99 = (count * 99).div_ceil(100) - 1;
        Summary {
            event: "bench",
            images,
            failed,
            joints_seen: self.seen,
            joints_not_seen: (images - failed) * 2 * Joint::ALL.len() - self.seen,
            mean_milliseconds: self.times.iter().sum::<Duration>().as_secs_f64() * 1e3 / count as f64,
            median_milliseconds: at(&self.times, count / 2),
            p99_milliseconds: at(&self.times, last_of_99),
            p99_processor_milliseconds: at(&self.processor_times, last_of_99),
            total_wall_seconds: self.began.elapsed().as_secs_f64(),
        }
    }
}

/// What this thread has taken of a processor so far.
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::try_from(time).unwrap_or_default()
}

fn name_of(picture: &Path) -> String {
    picture.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn read_forest(file: Option<&Path>) -> Result<Forest, Failure> {
    let Some(file) = file else { return generic::forest().map_err(Failure::fault) };
    let named = |error: &dyn std::fmt::Display| Failure::Configuration(format!("{}: {error}", file.display()));
    let bytes = std::fs::read(file).map_err(|error| named(&error))?;
    Forest::from_bytes(&bytes).map_err(|error| named(&error))
}

#[cfg(test)]
mod tests;
