//! The greeting with which TCPROS connections begin: fields of the form key=value, each and all with their length before them.
//!
//! Bounded in size; the time is bounded by the stream's own limits. Whose greeting it is and what it means is up to the caller.

use rosrust::RosMsg;
use std::collections::HashMap;
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

/// The fields of a greeting.
pub(super) type Fields = HashMap<String, String>;

/// Largest greeting: a message's whole definition stands in it.
const LARGEST: u32 = 1 << 20;

/// Connects to `host:port` with a time limit on this and on every read and write that follows.
pub(super) fn connect(authority: &str, limit: Duration) -> io::Result<TcpStream> {
    let no_address = || io::Error::other(format!("{authority} is no address"));
    let address = authority.to_socket_addrs()?.next().ok_or_else(no_address)?;
    let stream = TcpStream::connect_timeout(&address, limit)?;
    stream.set_read_timeout(Some(limit))?;
    stream.set_write_timeout(Some(limit))?;
    // A request is one small packet: waiting for more of it would only cost time.
    stream.set_nodelay(true)?;
    Ok(stream)
}

/// Says `fields` and reads what the other side says.
pub(super) fn exchange(stream: &mut (impl Read + Write), fields: &Fields) -> io::Result<Fields> {
    let mut greeting = Vec::new();
    fields.encode(&mut greeting)?;
    stream.write_all(&greeting)?;
    let answer = read_block(stream, LARGEST)?;
    read_fields(&answer).ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "its greeting has no fields"))
}

/// Reads a block of bytes that begins with its length.
pub(super) fn read_block(stream: &mut impl Read, most: u32) -> io::Result<Vec<u8>> {
    let mut length = [0; 4];
    stream.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length);
    if length > most {
        return Err(io::Error::other(format!("{length} bytes are announced, more than {most}")));
    }
    let mut block = Vec::new();
    stream.take(u64::from(length)).read_to_end(&mut block)?;
    let whole = u32::try_from(block.len()) == Ok(length);
    if whole { Ok(block) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}

fn read_fields(mut bytes: &[u8]) -> Option<Fields> {
    let mut fields = Fields::new();
    while !bytes.is_empty() {
        let (length, rest) = bytes.split_first_chunk()?;
        let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
        let (field, rest) = rest.split_at_checked(length)?;
        let (key, value) = std::str::from_utf8(field).ok()?.split_once('=')?;
        fields.insert(key.to_owned(), value.to_owned());
        bytes = rest;
    }
    Some(fields)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::io::Cursor;

    /// A peer that says `answer` whatever it is told.
    struct Peer {
        told: Vec<u8>,
        answer: Cursor<Vec<u8>>,
    }

    impl Read for Peer {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.answer.read(buffer)
        }
    }

    impl Write for Peer {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.told.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn fields(pairs: &[(&str, &str)]) -> Fields {
        pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
    }

    #[test]
    fn both_sides_read_what_the_other_says() {
        let (asked, answered) =
            (fields(&[("topic", "/t"), ("md5sum", "*")]), fields(&[("type", "a/B"), ("note", "x=y")]));
        let mut answer = Vec::new();
        answered.encode(&mut answer).unwrap();
        let mut peer = Peer { told: Vec::new(), answer: Cursor::new(answer) };
        assert_eq!(exchange(&mut peer, &asked).unwrap(), answered);
        assert_eq!(read_fields(&read_block(&mut peer.told.as_slice(), LARGEST).unwrap()), Some(asked));
    }

    #[test]
    fn a_block_that_is_too_large_or_cut_is_an_error() {
        assert!(read_block(&mut [0xff_u8; 4].as_slice(), LARGEST).unwrap_err().to_string().contains("more than"));
        let cut = read_block(&mut [9_u8, 0, 0, 0, 1].as_slice(), LARGEST).unwrap_err();
        assert_eq!(cut.kind(), io::ErrorKind::UnexpectedEof);
    }

    proptest! {
        #[test]
        fn no_answer_panics(answer in proptest::collection::vec(any::<u8>(), 0..64)) {
            let _ = exchange(&mut Peer { told: Vec::new(), answer: Cursor::new(answer) }, &Fields::new());
        }
    }
}
