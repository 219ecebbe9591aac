//! `valet sim --images DIR`: depth images of simulated people with all that is true of them, to try vision on without a camera.
//!
//! Writes `NAME.png` and `NAME.json` as `valet bench pose` reads them, the empty scenes under `empty/`, and the truth under
//! `truth/`: label images and `joints.jsonl`. The same seed writes the same bytes.

use super::exit::Failure;
use super::images::{ImageNotes, write_depth, write_labels};
use super::output::Output;
use crate::body::{Joint, PerSide};
use crate::config::write_whole;
use crate::sim::camera::IMAGE_SIZE;
use crate::sim::camera::dataset::{Frame, Labelled};
use crate::vision::Facing;
use crate::vision::part::{NONE, PARTS};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// People of this seed and on are never trained on.
const FIRST_UNSEEN_PERSON: u64 = 1 << 40;

#[derive(Serialize)]
struct Truth<'a> {
    file: &'a str,
    joints: PerSide<BTreeMap<&'static str, [f64; 3]>>,
}

/// Writes a number of images of different people.
///
/// # Errors
/// Where a folder or file cannot be written.
pub(super) fn write(folder: &Path, count: u64, seed: u64) -> Result<(), Failure> {
    for place in [folder.to_path_buf(), folder.join("empty"), folder.join("truth")] {
        std::fs::create_dir_all(&place)
            .map_err(|error| Failure::Configuration(format!("cannot make folder {}: {error}", place.display())))?;
    }
    let mut truth = String::new();
    for number in 0..count {
        let person = FIRST_UNSEEN_PERSON + (seed << 24) + number;
        let image = Frame { person, number: 2 * number }.render();
        let name = format!("{number:05}");
        write_one(folder, &name, &image)?;
        let file = format!("{name}.png");
        let place = |side, joint: Joint| (joint.name(), image.sampled.scene.joint(side, joint).into());
        let places = |side| Joint::ALL.map(|joint| place(side, joint)).into();
        let line = Truth { file: &file, joints: PerSide::from_fn(places) };
        truth.push_str(&serde_json::to_string(&line).map_err(Failure::fault)?);
        truth.push('\n');
    }
    write_whole(&folder.join("truth/joints.jsonl"), truth.as_bytes()).map_err(Failure::configuration)?;
    Output::new(false).line(format!(
        "{count} images written to {0}. Try: valet bench pose --images {0} --empty {0}/empty --out {0}/found",
        folder.display()
    ))
}

fn write_one(folder: &Path, name: &str, image: &Labelled) -> Result<(), Failure> {
    let file = format!("{name}.png");
    write_depth(&folder.join(&file), &image.rendering.depth)?;
    if let Some(empty) = &image.empty {
        write_depth(&folder.join("empty").join(&file), empty)?;
    }
    // Lap, chair and head are no parts, and what the sensor did not see has no label.
    let labels = image.rendering.labels.iter().zip(image.rendering.depth.millimetres());
    let labels: Vec<u8> =
        labels.map(|(label, depth)| if usize::from(*label) < PARTS && *depth > 0 { *label } else { NONE }).collect();
    write_labels(&folder.join("truth").join(&file), IMAGE_SIZE, &labels)?;
    let camera = image.sampled.camera;
    let notes = ImageNotes {
        fx: camera.fx,
        fy: camera.fy,
        cx: camera.cx,
        cy: camera.cy,
        neck_m: image.neck.into(),
        facing: Some(Facing::LowerEdge),
    };
    let text = serde_json::to_string_pretty(&notes).map_err(Failure::fault)?;
    write_whole(&folder.join(format!("{name}.json")), text.as_bytes()).map_err(Failure::configuration)
}
