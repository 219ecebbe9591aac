//! Any line is an error or a command, and so is any name of a key.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    for line in text.lines() {
        let _ = valet::headless::Typed::read(line);
    }
});
