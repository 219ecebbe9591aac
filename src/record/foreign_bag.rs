//! What a rosbag that is not ours holds of a trial's topics: read from its index alone (bag format 2.0), so that the operator
//! knows before playing it what is missing. Reads no messages.

use super::channels::{BODY, CHANNELS, COMMANDS, Channel};

/// What every bag of this format begins with.
const BEGIN: &[u8] = b"#ROSBAG V2.0\n";
/// The operation of a record that names a topic.
const CONNECTION: &[u8] = &[0x07];
/// What becomes of any bag.
const PLAY: &str = "it is a rosbag; play it with `rosbag play` into `valet console --dry-run`";

/// A topic of a bag.
struct Topic {
    name: String,
    kind: String,
}

/// What a bag is good for, in words.
pub(super) fn describe(bytes: &[u8]) -> String {
    match topics(bytes) {
        Some(found) if found.is_empty() => {
            format!("{PLAY}. Its index is missing, as after a recording that was cut: `rosbag reindex` mends that")
        }
        Some(found) => format!("{PLAY}. {}", told(&found)),
        None => PLAY.to_owned(),
    }
}

/// What is there and what is missing of what a trial needs: end points, joints, the robot's state, and the person's pose.
fn told(found: &[Topic]) -> String {
    let needed = || CHANNELS.iter().take(COMMANDS).chain(CHANNELS.get(BODY));
    let named = |channel: &&Channel| found.iter().find(|topic| topic.name == channel.topic);
    let fits = |channel: &&Channel| named(channel).is_some_and(|topic| topic.kind == channel.kind.name);
    let usable: Vec<_> = needed().filter(fits).map(|channel| channel.topic).collect();
    let missing: Vec<_> = needed()
        .filter(|channel| !fits(channel))
        .map(|channel| match named(&channel) {
            Some(topic) => format!("{} ({} in the bag, {} is read)", channel.topic, topic.kind, channel.kind.name),
            None => format!("{} ({})", channel.topic, channel.kind.name),
        })
        .collect();
    if missing.is_empty() {
        return "It has every topic that a trial needs".to_owned();
    }
    let usable = if usable.is_empty() { "nothing".to_owned() } else { usable.join(", ") };
    format!("It lacks {}; what can be read is {usable}", missing.join(", "))
}

/// The topics that the bag's index names; none where it has no index, `None` where it is no such bag or damaged.
fn topics(bytes: &[u8]) -> Option<Vec<Topic>> {
    let (header, _, _) = record(bytes.strip_prefix(BEGIN)?)?;
    let index = u64::from_le_bytes(field(header, "index_pos")?.try_into().ok()?);
    let mut found = Vec::new();
    let mut rest = if index == 0 { &[][..] } else { bytes.get(usize::try_from(index).ok()?..)? };
    while let Some((header, data, after)) = record(rest) {
        if field(header, "op") == Some(CONNECTION) {
            let words = |value: Option<&[u8]>| Some(String::from_utf8_lossy(value?).into_owned());
            found.push(Topic { name: words(field(header, "topic"))?, kind: words(field(data, "type"))? });
        }
        rest = after;
    }
    Some(found)
}

/// The first record: header, data, and what comes after.
fn record(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (header, rest) = counted(bytes)?;
    let (data, rest) = counted(rest)?;
    Some((header, data, rest))
}

/// Bytes after their count, and the rest.
fn counted(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (count, rest) = bytes.split_first_chunk::<4>()?;
    rest.split_at_checked(usize::try_from(u32::from_le_bytes(*count)).ok()?)
}

/// The value of a field, `name=value` after its length.
fn field<'a>(mut fields: &'a [u8], name: &str) -> Option<&'a [u8]> {
    while let Some((field, rest)) = counted(fields) {
        if let Some(value) = field.strip_prefix(name.as_bytes()).and_then(|value| value.strip_prefix(b"=")) {
            return Some(value);
        }
        fields = rest;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fields(pairs: &[(&str, &[u8])]) -> Vec<u8> {
        let field = |(name, value): &(&str, &[u8])| {
            let text = [name.as_bytes(), b"=", value].concat();
            [&u32::try_from(text.len()).unwrap().to_le_bytes()[..], &text].concat()
        };
        pairs.iter().flat_map(field).collect()
    }

    fn a_record(header: &[u8], data: &[u8]) -> Vec<u8> {
        let counted = |bytes: &[u8]| [&u32::try_from(bytes.len()).unwrap().to_le_bytes()[..], bytes].concat();
        [counted(header), counted(data)].concat()
    }

    /// A bag whose index names these topics; without an index where there are none.
    fn bag(topics: &[(&str, &str)]) -> Vec<u8> {
        let head = |index: u64| a_record(&fields(&[("op", &[3]), ("index_pos", &index.to_le_bytes())]), b"  ");
        let index = if topics.is_empty() { 0 } else { (BEGIN.len() + head(0).len()) as u64 };
        let named = topics.iter().flat_map(|(topic, kind)| {
            let header = fields(&[("op", CONNECTION), ("conn", &[0; 4]), ("topic", topic.as_bytes())]);
            a_record(&header, &fields(&[("type", kind.as_bytes())]))
        });
        [BEGIN.to_vec(), head(index)].concat().into_iter().chain(named).collect()
    }

    #[test]
    fn what_is_missing_and_what_can_be_read_is_named() {
        let words = describe(&bag(&[("/chatter", "std_msgs/String"), ("/tf", "tf2_msgs/TFMessage")]));
        assert!(words.contains("lacks /robot/limb/left/endpoint_state (baxter_core_msgs/EndpointState)"), "{words}");
        assert!(words.ends_with("what can be read is /tf"), "{words}");
    }

    #[test]
    fn a_topic_of_another_type_is_named_with_both() {
        let words = describe(&bag(&[("/robot/state", "std_msgs/String")]));
        let wrong = "/robot/state (std_msgs/String in the bag, baxter_core_msgs/AssemblyState is read)";
        assert!(words.contains(wrong) && words.ends_with("what can be read is nothing"), "{words}");
    }

    #[test]
    fn a_whole_bag_one_without_an_index_and_a_cut_one() {
        let all: Vec<_> = CHANNELS.iter().map(|channel| (channel.topic, channel.kind.name)).collect();
        assert!(describe(&bag(&all)).ends_with("It has every topic that a trial needs"));
        assert!(describe(&bag(&[])).contains("rosbag reindex"));
        assert_eq!(describe(b"#ROSBAG V1.2\n"), PLAY);
    }

    proptest! {
        #[test]
        fn no_damage_makes_it_panic(place in 0_usize..400, byte: u8, cut in 0_usize..400) {
            let mut bytes = bag(&[("/tf", "tf2_msgs/TFMessage"), ("/robot/state", "baxter_core_msgs/AssemblyState")]);
            if let Some(hit) = bytes.get_mut(place) {
                *hit = byte;
            }
            bytes.truncate(cut);
            prop_assert!(!describe(&bytes).is_empty());
        }
    }
}
