//! Any text is an error or a person's profile.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = valet::config::LoadedProfile::parse(std::path::Path::new("person.toml"), text);
});
