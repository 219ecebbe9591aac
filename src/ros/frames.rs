//! Where frames stand in the robot's `base`, from the transforms on `/tf` and `/tf_static`.
//!
//! A frame that nobody has told of, that moved long ago or that hangs on itself is an error with a remedy, never a guess.

use super::decode::{isometry, stamp};
use super::message::geometry_msgs;
use crate::geometry::{Finite, Pose};
use crate::time::Stamp;
use std::collections::HashMap;
use std::time::Duration;
use thiserror::Error;

/// The robot's frame that everything else is expressed in.
const BASE: &str = "base";
/// Frames between a frame and `base`, at most: a longer chain is a circle.
const LONGEST_CHAIN: usize = 32;
/// Frames that are remembered: a Baxter has about 60.
const MOST_FRAMES: usize = 1000;
/// A transform on `/tf` counts for so long after its stamp; publishers repeat theirs at 10 Hz and more.
const MOST_AGE: Duration = Duration::from_secs(1);

/// Why a frame's place in `base` is not known.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FrameError {
    /// A link of the chain was never published.
    #[error(
        "nobody says on /tf or /tf_static where frame {missing} is, which {frame} hangs on: start a static_transform_publisher \
         from base, or write the camera's place into the profile ([camera.place])"
    )]
    Missing {
        /// What was asked for.
        frame: String,
        /// What is missing.
        missing: String,
    },
    /// A moving frame has not been told of for too long.
    #[error("frame {stale} on /tf is {seconds:.1} s old: see that its publisher runs and that both clocks agree")]
    Stale {
        /// Which one.
        stale: String,
        /// How old.
        seconds: f64,
    },
    /// The chain comes back to itself.
    #[error(
        "the frames on /tf that {frame} hangs on form a circle and never reach base: two publishers disagree, end one"
    )]
    Loop {
        /// What was asked for.
        frame: String,
    },
}

#[derive(Clone, Debug)]
struct Frame {
    parent: String,
    pose: Pose,
    /// `None` where it stays for good.
    stamp: Option<Stamp>,
}

/// The frames that are known.
#[derive(Clone, Debug, Default)]
pub(super) struct Frames {
    frames: HashMap<String, Frame>,
}

impl Frames {
    /// Takes a message's transforms. Those on `/tf_static` stay for good.
    pub(super) fn take(&mut self, transforms: &[geometry_msgs::TransformStamped], is_static: bool) {
        for transform in transforms {
            let child = plain(&transform.child_frame_id).to_owned();
            let (t, r) = (&transform.transform.translation, &transform.transform.rotation);
            let frame = Frame {
                parent: plain(&transform.header.frame_id).to_owned(),
                pose: isometry([t.x, t.y, t.z], [r.x, r.y, r.z, r.w]),
                stamp: (!is_static).then(|| stamp(transform.header.stamp)),
            };
            let has_room = self.frames.len() < MOST_FRAMES || self.frames.contains_key(&child);
            if frame.pose.is_finite() && has_room {
                self.frames.insert(child, frame);
            }
        }
    }

    /// The pose of a frame in `base` at the moment `now`.
    ///
    /// # Errors
    /// [`FrameError`] where the chain is broken, old or a circle.
    pub(super) fn in_base(&self, name: &str, now: Stamp) -> Result<Pose, FrameError> {
        let mut pose = Pose::identity();
        let mut at = plain(name);
        for _ in 0..LONGEST_CHAIN {
            if at == BASE {
                return Ok(pose);
            }
            let missing = || FrameError::Missing { frame: plain(name).to_owned(), missing: at.to_owned() };
            let frame = self.frames.get(at).ok_or_else(missing)?;
            let age = frame.stamp.and_then(|stamp| now.checked_since(stamp)).unwrap_or_default();
            if age > MOST_AGE {
                return Err(FrameError::Stale { stale: at.to_owned(), seconds: age.as_secs_f64() });
            }
            pose = frame.pose * pose;
            at = &frame.parent;
        }
        Err(FrameError::Loop { frame: plain(name).to_owned() })
    }
}

/// A frame's name without the slash that old publishers begin it with.
fn plain(name: &str) -> &str {
    name.trim_start_matches('/')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Vector};
    use crate::ros::encode;

    fn at(seconds: u64) -> Stamp {
        Stamp::ZERO + Duration::from_secs(seconds)
    }

    fn link(parent: &str, child: &str, seconds: u64) -> geometry_msgs::TransformStamped {
        let turn = Vector::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        encode::transform(at(seconds), parent, child, &Pose::new(Vector::new(1.0, 0.0, 0.0), turn))
    }

    #[test]
    fn a_chain_of_moving_and_static_frames_leads_to_the_base() {
        let mut frames = Frames::default();
        frames.take(&[link("camera_link", "camera_optical", 0)], true);
        frames.take(&[link("/base", "/camera_link", 100)], false);
        let pose = frames.in_base("/camera_optical", at(100)).unwrap();
        assert!((pose * Point::new(1.0, 0.0, 0.0) - Point::new(0.0, 1.0, 0.0)).norm() < 1e-12);
        assert_eq!(frames.in_base("base", at(0)).unwrap(), Pose::identity());
    }

    #[test]
    fn a_missing_frame_is_named_with_a_remedy() {
        let mut frames = Frames::default();
        frames.take(&[link("camera_link", "camera_optical", 0)], true);
        let error = frames.in_base("camera_optical", at(0)).unwrap_err();
        assert_eq!(error, FrameError::Missing { frame: "camera_optical".into(), missing: "camera_link".into() });
        assert!(error.to_string().contains("static_transform_publisher"));
    }

    #[test]
    fn a_stale_frame_is_refused_and_a_static_one_never_ages() {
        let mut frames = Frames::default();
        frames.take(&[link("base", "moving", 10)], false);
        frames.take(&[link("base", "fixed", 10)], true);
        assert!(frames.in_base("moving", at(11)).is_ok());
        assert_eq!(frames.in_base("moving", at(13)), Err(FrameError::Stale { stale: "moving".into(), seconds: 3.0 }));
        assert!(frames.in_base("fixed", at(10_000)).is_ok());
    }

    #[test]
    fn a_circle_ends_and_a_frame_that_is_not_finite_is_not_taken() {
        let mut frames = Frames::default();
        frames.take(&[link("a", "b", 0), link("b", "a", 0)], true);
        assert_eq!(frames.in_base("a", at(0)), Err(FrameError::Loop { frame: "a".into() }));
        let mut broken = link("base", "c", 0);
        broken.transform.translation.x = f64::NAN;
        frames.take(&[broken], true);
        assert!(matches!(frames.in_base("c", at(0)), Err(FrameError::Missing { .. })));
    }
}
