//! Any bytes are an error or an input.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = serde_json::from_slice::<valet::supervisor::Input>(bytes);
});
