//! Messages whose lists are measured before they are decoded.
//!
//! rosrust makes room for as many numbers as a message says it has, before it looks whether they are there: four bytes from the
//! network could ask for 34 GB and end the process. So each message that is listened to is walked first, and refused where a list
//! is longer than what came. Nothing is converted here.

use super::decode::AnyAssemblyState;
use super::message::{baxter_core_msgs, diagnostic_msgs, sensor_msgs, std_msgs, tf2_msgs, valet_msgs};
use rosrust::{Message, RosMsg};
use std::io;

/// A stretch of a message on the wire.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// So many bytes.
    Fixed(usize),
    /// A count and as many elements of so many bytes; a text is one of single bytes.
    List(usize),
    /// A count and as many texts.
    Texts,
}

/// `std_msgs/Header`: number, stamp and frame.
const NUMBER_AND_STAMP: Piece = Piece::Fixed(12);
const FRAME: Piece = Piece::List(1);

/// A message that says which stretches come before its last list of numbers; none where it has no such list.
pub trait Measured: Message {
    /// The stretches up to the last list of numbers, in order.
    const PIECES: &'static [Piece] = &[];
}

impl Measured for AnyAssemblyState {}
impl Measured for baxter_core_msgs::CollisionDetectionState {}
impl Measured for baxter_core_msgs::DigitalIOState {}
impl Measured for baxter_core_msgs::EndpointState {}
impl Measured for diagnostic_msgs::DiagnosticArray {}
impl Measured for std_msgs::Bool {}
impl Measured for std_msgs::Empty {}
impl Measured for std_msgs::Float64 {}
impl Measured for tf2_msgs::TFMessage {}

impl Measured for baxter_core_msgs::JointCommand {
    const PIECES: &'static [Piece] = &[Piece::Fixed(4), Piece::List(8)];
}

impl Measured for sensor_msgs::JointState {
    const PIECES: &'static [Piece] =
        &[NUMBER_AND_STAMP, FRAME, Piece::Texts, Piece::List(8), Piece::List(8), Piece::List(8)];
}

impl Measured for sensor_msgs::Image {
    const PIECES: &'static [Piece] =
        &[NUMBER_AND_STAMP, FRAME, Piece::Fixed(8), Piece::List(1), Piece::Fixed(5), Piece::List(1)];
}

impl Measured for sensor_msgs::CameraInfo {
    const PIECES: &'static [Piece] = &[NUMBER_AND_STAMP, FRAME, Piece::Fixed(8), Piece::List(1), Piece::List(8)];
}

impl Measured for valet_msgs::Snapshot {
    const PIECES: &'static [Piece] = &[NUMBER_AND_STAMP, FRAME, Piece::List(1)];
}

/// A message that is decoded only where its lists are as long as they say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checked<M>(pub M);

impl<M: Measured> RosMsg for Checked<M> {
    fn encode<W: io::Write>(&self, writer: W) -> io::Result<()> {
        self.0.encode(writer)
    }

    fn decode<R: io::Read>(mut reader: R) -> io::Result<Self> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes)?;
        let mut rest = bytes.as_slice();
        let fits = M::PIECES.iter().all(|piece| pass(&mut rest, *piece).is_some());
        if !fits {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a list is longer than the message"));
        }
        M::decode(bytes.as_slice()).map(Self)
    }
}

impl<M: Measured> Message for Checked<M> {
    fn msg_definition() -> String {
        M::msg_definition()
    }

    fn md5sum() -> String {
        M::md5sum()
    }

    fn msg_type() -> String {
        M::msg_type()
    }
}

/// Goes past a piece; `None` where it is not all there.
fn pass(rest: &mut &[u8], piece: Piece) -> Option<()> {
    match piece {
        Piece::Fixed(bytes) => *rest = rest.get(bytes..)?,
        Piece::List(size) => {
            let bytes = count(rest)?.checked_mul(size)?;
            *rest = rest.get(bytes..)?;
        }
        Piece::Texts => {
            for _ in 0..count(rest)? {
                pass(rest, Piece::List(1))?;
            }
        }
    }
    Some(())
}

fn count(rest: &mut &[u8]) -> Option<usize> {
    let (number, after) = rest.split_first_chunk::<4>()?;
    *rest = after;
    usize::try_from(u32::from_le_bytes(*number)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bytes<M: RosMsg>(message: &M) -> Vec<u8> {
        let mut bytes = Vec::new();
        message.encode(&mut bytes).unwrap();
        bytes
    }

    fn joints() -> sensor_msgs::JointState {
        sensor_msgs::JointState {
            name: vec!["left_s0".into(), "left_s1".into()],
            position: vec![0.1, 0.2],
            effort: vec![1.0],
            ..sensor_msgs::JointState::default()
        }
    }

    /// A whole message is read as it is, and one that is cut anywhere is an error, as is one with a count that lies.
    fn is_measured<M: Measured>(message: &M) {
        let whole = bytes(message);
        assert_eq!(Checked::<M>::decode(whole.as_slice()).unwrap().0, *message);
        for end in 0..whole.len() {
            assert!(Checked::<M>::decode(&whole[..end]).is_err(), "{} cut at {end}", M::msg_type());
        }
    }

    #[test]
    fn a_whole_message_is_read_and_a_cut_one_is_refused() {
        is_measured(&joints());
        is_measured(&sensor_msgs::Image { width: 2, height: 1, data: vec![1; 4], ..sensor_msgs::Image::default() });
        is_measured(&sensor_msgs::CameraInfo { D: vec![0.0; 5], ..sensor_msgs::CameraInfo::default() });
        is_measured(&valet_msgs::Snapshot { cbor: vec![7; 9], ..valet_msgs::Snapshot::default() });
        let command = baxter_core_msgs::JointCommand { mode: 1, command: vec![0.5; 7], names: vec!["left_s0".into()] };
        is_measured(&command);
    }

    #[test]
    fn s_38_a_list_that_says_it_is_34_gigabytes_long_is_refused_before_room_is_made_for_it() {
        let mut lying = bytes(&joints());
        // The count of positions: after number and stamp, an empty frame, a count of two and two names of seven letters.
        let at = 12 + 4 + 4 + 2 * (4 + 7);
        assert_eq!(lying[at..at + 4], [2, 0, 0, 0]);
        lying[at..at + 4].fill(0xff);
        assert!(Checked::<sensor_msgs::JointState>::decode(lying.as_slice()).is_err());
    }

    proptest! {
        #[test]
        fn s_38_any_bytes_are_an_error_or_a_message(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
            let _ = Checked::<sensor_msgs::JointState>::decode(bytes.as_slice());
            let _ = Checked::<sensor_msgs::Image>::decode(bytes.as_slice());
            let _ = Checked::<sensor_msgs::CameraInfo>::decode(bytes.as_slice());
            let _ = Checked::<baxter_core_msgs::EndpointState>::decode(bytes.as_slice());
            let _ = Checked::<baxter_core_msgs::JointCommand>::decode(bytes.as_slice());
            let _ = Checked::<tf2_msgs::TFMessage>::decode(bytes.as_slice());
            let _ = Checked::<valet_msgs::Snapshot>::decode(bytes.as_slice());
        }
    }
}
