//! Any bytes are an error or a forest.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = valet::vision::Forest::from_bytes(bytes);
});
