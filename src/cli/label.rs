//! `valet label`: labels from coloured clothes (thesis section 3.2.2), for a folder that `valet train --from` then learns from.
//!
//! Reads `NAME.png`, `NAME.json` and `colour/NAME.png` (8-bit, registered to the depth image), writes `truth/NAME.png`. An image
//! that cannot be used is named with its reason and left out; the others are done all the same.

use super::exit::Failure;
use super::images::{ImageNotes, pictures_in, read_colour, read_depth, write_labels};
use super::key::KeyArguments;
use super::output::{Output, complain};
use crate::config::{Clothes, LoadedProfile, Places, clothes_of, sample_colours};
use crate::vision::labels::{ColourImage, SampleColours};
use crate::vision::part::{NONE, PARTS};
use crate::vision::probe::ProbeImage;
use crate::vision::{Facing, View};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Labels depth images by the colours of a person's clothes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Folder with NAME.png (16-bit grey, millimetres), NAME.json (`fx`, `fy`, `cx`, `cy`, `neck_m`) and colour/NAME.png (8-bit
    /// colour, registered to the depth image); empty/NAME.png is used where it is there.
    #[arg(long, value_name = "DIR")]
    images: PathBuf,
    /// TOML file with the colour of each part: `[left]` and `[right]` with `shoulder`, `upper_arm`, `forearm` and `hand`, each
    /// `[red, green, blue]` from 0 to 255, or `{ image = "NAME.png", column = 320, row = 240 }` to pick it from colour/NAME.png.
    #[arg(long, value_name = "FILE", required_unless_present = "profile")]
    samples: Option<PathBuf>,
    /// The person whose profile holds the colours (`[clothes.left]`, `[clothes.right]`): a name or a file.
    #[arg(long, conflicts_with = "samples")]
    profile: Option<String>,
    #[command(flatten)]
    key: KeyArguments,
    /// Folder for the label images (8-bit, 255 is no part); without it truth/ in the folder of the images.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
}

/// The colour of a part, or where to pick it.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Sample {
    Colour([u8; 3]),
    Pick { image: PathBuf, column: usize, row: usize },
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ArmSamples {
    shoulder: Sample,
    upper_arm: Sample,
    forearm: Sample,
    hand: Sample,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Samples {
    left: ArmSamples,
    right: ArmSamples,
}

/// What came of an image, for programs.
#[derive(Debug, Serialize)]
struct Labelled<'a> {
    event: &'static str,
    file: &'a str,
    /// Pixels of each label.
    pixels: [usize; PARTS],
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let colours = colours_of(arguments)?;
    let pictures = pictures_in(&arguments.images)?;
    if pictures.is_empty() {
        return Err(Failure::Configuration(format!("{}: holds no NAME.png", arguments.images.display())));
    }
    let out = arguments.out.clone().unwrap_or_else(|| arguments.images.join("truth"));
    std::fs::create_dir_all(&out)
        .map_err(|error| Failure::Configuration(format!("cannot make folder {}: {error}", out.display())))?;
    let mut output = Output::new(arguments.json);
    let mut failed = 0;
    for picture in &pictures {
        let name = picture.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        match label(picture, &out.join(&name), &colours) {
            Ok(pixels) => output.event(&Labelled { event: "labelled", file: &name, pixels })?,
            Err(reason) => {
                failed += 1;
                complain(&Failure::Configuration(reason));
            }
        }
    }
    let done = pictures.len() - failed;
    output.line(format!("{done} images labelled, {failed} unusable. Written: {}", out.display()))?;
    if arguments.profile.is_none() {
        output.line(format!("The same colours for the person's profile:\n\n{}", in_profile(&colours)?))?;
    }
    if failed > 0 {
        return Err(Failure::Configuration(format!("{failed} of {} images could not be used", pictures.len())));
    }
    Ok(())
}

/// Labels one image; the pixels of each label.
fn label(picture: &Path, out: &Path, colours: &SampleColours) -> Result<[usize; PARTS], String> {
    let named = |error: &dyn std::fmt::Display| format!("{}: {error}", picture.display());
    let depth = read_depth(picture)?;
    let notes = ImageNotes::beside(picture)?;
    let empty =
        Some(beside(picture, "empty")).filter(|path| path.exists()).map(|path| read_depth(&path)).transpose()?;
    let facing = notes.facing.unwrap_or_default();
    let view = View { camera: notes.camera(), neck: notes.neck(), empty: empty.as_ref(), facing };
    let (mut turned, mut pixels) = (ProbeImage::default(), Vec::new());
    view.extract(&depth, &mut turned, &mut pixels).map_err(|error| named(&error))?;
    let (width, height) = (depth.width(), depth.height());
    // Colours lie as the camera saw them, and the foreground is turned where the person faces the upper edge.
    let foreground = if facing == Facing::UpperEdge { turned.turned() } else { turned };
    let (colour_width, colour_height, bytes) = read_colour(&beside(picture, "colour"))?;
    let colour = ColourImage { width: colour_width, height: colour_height, bytes: &bytes };
    let labels = colours.label(&colour, &foreground, facing).map_err(|error| named(&error))?;
    write_labels(out, (width, height), &labels).map_err(|error| error.to_string())?;
    let mut counts = [0; PARTS];
    for label in labels.iter().filter(|label| **label != NONE) {
        if let Some(count) = counts.get_mut(usize::from(*label)) {
            *count += 1;
        }
    }
    Ok(counts)
}

/// The file of the same name in a folder beside an image.
fn beside(picture: &Path, folder: &str) -> PathBuf {
    let name = picture.file_name().unwrap_or_default();
    picture.parent().unwrap_or_else(|| Path::new(".")).join(folder).join(name)
}

/// The sample colours that are asked for: a profile's, or those of a file.
fn colours_of(arguments: &Arguments) -> Result<SampleColours, Failure> {
    if let Some(file) = &arguments.samples {
        return samples_in(file, &arguments.images).map_err(Failure::Configuration);
    }
    let name = arguments.profile.as_deref().unwrap_or_default();
    let key = arguments.key.given()?;
    let person = LoadedProfile::find_with(name, &Places::of_this_machine(), key.as_ref());
    let person = person.map_err(Failure::configuration)?;
    person.profile.clothes.as_ref().map(sample_colours).ok_or_else(|| {
        let file = person.path.display();
        Failure::Configuration(format!(
            "{file}: holds no colours of clothes ([clothes.left], [clothes.right]): label once with --samples, which prints them"
        ))
    })
}

/// The colours as a profile says them.
fn in_profile(colours: &SampleColours) -> Result<String, Failure> {
    #[derive(Serialize)]
    struct Part {
        clothes: Clothes,
    }
    toml::to_string(&Part { clothes: clothes_of(colours) }).map_err(Failure::fault)
}

/// The sample colours of a file, checked; those to be picked are picked from the colour images of a folder.
fn samples_in(file: &Path, images: &Path) -> Result<SampleColours, String> {
    let named = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
    let text = std::fs::read_to_string(file).map_err(|error| named(&error))?;
    let Samples { left, right } = toml::from_str(&text).map_err(|error| named(&error))?;
    let mut colours = [[0; 3]; PARTS];
    let parts = [left, right].into_iter().flat_map(|arm| [arm.shoulder, arm.upper_arm, arm.forearm, arm.hand]);
    for (colour, sample) in colours.iter_mut().zip(parts) {
        *colour = match sample {
            Sample::Colour(colour) => colour,
            Sample::Pick { image, column, row } => {
                let path = images.join("colour").join(image);
                let (width, height, bytes) = read_colour(&path)?;
                let picked = ColourImage { width, height, bytes: &bytes }.pick(column, row);
                picked.map_err(|error| format!("{}: {error}", path.display()))?
            }
        };
    }
    let colours = SampleColours(colours);
    colours.check().map_err(|error| named(&error))?;
    Ok(colours)
}

#[cfg(test)]
mod tests;
