//! Any bytes are an error or a journal.
#![no_main]

use std::io::Write;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(bytes).expect("room on the disk");
    let _ = valet::record::read(file.path(), |_, _| {});
    let _ = valet::record::read_header(file.path());
});
