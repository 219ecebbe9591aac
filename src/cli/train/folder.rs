//! Own images to train on, as `valet sim --images` writes them: depth, notes, labels, and joints where they are known.

use super::super::exit::Failure;
use super::super::images::{ImageNotes, pictures_in, read_depth};
use super::progress::Bar;
use super::{Arguments, KEPT_PERCENT, Kept, Material};
use crate::body::{Joint, PerSide, Side};
use crate::geometry::Point;
use crate::vision::probe::ProbeImage;
use crate::vision::training::{Example, TrainingSet};
use crate::vision::tree::{VOTED, vote_index};
use crate::vision::{DepthImage, Facing, Intrinsics, View, ViewError};
use rayon::prelude::*;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// A line of `truth/joints.jsonl`.
#[derive(Deserialize)]
struct Truth {
    file: String,
    joints: PerSide<BTreeMap<String, Option<[f64; 3]>>>,
}

type Joints = BTreeMap<String, [Point; VOTED]>;

/// Everything that one image brings.
struct Own {
    depth: DepthImage,
    empty: Option<DepthImage>,
    labels: Vec<u8>,
    camera: Intrinsics,
    neck: Point,
    joints: [Point; VOTED],
}

/// Reads a folder; the last images are kept to judge by.
pub(super) fn read(folder: &Path, arguments: &Arguments) -> Result<Material, Failure> {
    let mut pictures = pictures_in(folder)?;
    pictures.truncate(usize::try_from(arguments.images).unwrap_or(usize::MAX));
    let Some(first) = pictures.first() else {
        return Err(Failure::Configuration(format!("{}: there is no NAME.png to train on", folder.display())));
    };
    let joints = read_joints(&folder.join("truth/joints.jsonl"))?;
    let focal = ImageNotes::beside(first).map_err(Failure::Configuration)?.fx;
    let learnt = pictures.len() - (pictures.len() * KEPT_PERCENT).div_ceil(100).min(pictures.len() - 1);
    let bar = Bar::of_images("own images", pictures.len() as u64);
    let per_part = usize::from(arguments.pixels);
    let take = |(index, picture): (usize, &PathBuf)| {
        let own = Own::read(folder, picture, &joints).map_err(Failure::Configuration)?;
        bar.step();
        let mut set = TrainingSet::new(focal, per_part);
        if index >= learnt {
            return Ok((set, Kept::from_parts(&own.view(), &own.depth, &own.labels)));
        }
        own.add_to(&mut set, index as u64).map_err(|error| named(picture, &error))?;
        Ok((set, None))
    };
    let pieces: Vec<(TrainingSet, Option<Kept>)> =
        pictures.par_iter().enumerate().map(take).collect::<Result<_, Failure>>()?;
    let mut set = TrainingSet::new(focal, per_part);
    let mut kept = Vec::new();
    for (piece, image) in pieces {
        set.append(piece);
        kept.extend(image);
    }
    let description = format!("{} own images, seed {}", set.image_count(), arguments.seed);
    Ok(Material { focal, description, kept, own: Some(set) })
}

fn named(file: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::Configuration(format!("{}: {error}", file.display()))
}

/// Joints of each file; none where nobody has written any.
fn read_joints(file: &Path) -> Result<Joints, Failure> {
    let Ok(text) = std::fs::read_to_string(file) else { return Ok(Joints::new()) };
    let mut joints = Joints::new();
    for (number, line) in text.lines().enumerate() {
        let truth: Truth = serde_json::from_str(line)
            .map_err(|error| Failure::Configuration(format!("{}, line {}: {error}", file.display(), number + 1)))?;
        let mut points = [unknown(); VOTED];
        for side in Side::BOTH {
            for joint in Joint::ALL {
                let place = truth.joints.get(side).get(joint.name()).copied().flatten();
                if let (Some(slot), Some(place)) = (points.get_mut(vote_index(side, joint)), place) {
                    *slot = Point::from(place);
                }
            }
        }
        joints.insert(truth.file, points);
    }
    Ok(joints)
}

/// A joint that nothing is learnt about.
fn unknown() -> Point {
    Point::new(f64::NAN, f64::NAN, f64::NAN)
}

impl Own {
    /// Reads what belongs to a picture, turned so that the person faces the lower edge.
    fn read(folder: &Path, picture: &Path, joints: &Joints) -> Result<Self, String> {
        let notes = ImageNotes::beside(picture)?;
        let name = picture.file_name().unwrap_or_default();
        let mut depth = read_depth(picture)?;
        let labels_file = folder.join("truth").join(name);
        let mut labels = read_labels(&labels_file)?;
        if labels.len() != depth.millimetres().len() {
            return Err(format!("{}: not of the size of {}", labels_file.display(), picture.display()));
        }
        let empty_file = folder.join("empty").join(name);
        let mut empty = if empty_file.exists() { Some(read_depth(&empty_file)?) } else { None };
        let mut joints = joints.get(&*name.to_string_lossy()).copied().unwrap_or([unknown(); VOTED]);
        let (mut camera, mut neck) = (notes.camera(), notes.neck());
        if notes.facing == Some(Facing::UpperEdge) {
            let turn = |point: Point| Point::new(-point.x, -point.y, point.z);
            camera.cx = depth.width() as f64 - 1.0 - camera.cx;
            camera.cy = depth.height() as f64 - 1.0 - camera.cy;
            neck = turn(neck);
            joints = joints.map(turn);
            labels.reverse();
            depth.millimetres_mut().reverse();
            empty.iter_mut().for_each(|empty| empty.millimetres_mut().reverse());
        }
        Ok(Self { depth, empty, labels, camera, neck, joints })
    }

    const fn view(&self) -> View<'_> {
        View { camera: self.camera, neck: self.neck, empty: self.empty.as_ref(), facing: Facing::LowerEdge }
    }

    fn add_to(&self, set: &mut TrainingSet, seed: u64) -> Result<(), ViewError> {
        let (mut image, mut pixels) = (ProbeImage::default(), Vec::new());
        self.view().extract(&self.depth, &mut image, &mut pixels)?;
        set.add(&Example { image: &image, labels: &self.labels, camera: self.camera, joints: self.joints }, seed);
        Ok(())
    }
}

/// Reads a label image: parts from 0 to 7, 8 for what is no part but near the person; others are not learnt from.
fn read_labels(path: &Path) -> Result<Vec<u8>, String> {
    let named = |error: &dyn std::fmt::Display| {
        format!("{}: {error}; a label image is grey with 8 bits, written beside each depth image", path.display())
    };
    let file = File::open(path).map_err(|error| named(&error))?;
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().map_err(|error| named(&error))?;
    let (kind, bits) = (reader.info().color_type, reader.info().bit_depth);
    if (kind, bits) != (png::ColorType::Grayscale, png::BitDepth::Eight) {
        return Err(named(&format!("{kind:?} of {} bits a channel", bits as u8)));
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    reader.next_frame(&mut bytes).map_err(|error| named(&error))?;
    Ok(bytes)
}
