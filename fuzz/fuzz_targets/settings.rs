//! Any text is an error or settings.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = valet::config::Settings::parse(std::path::Path::new("settings.toml"), text);
});
