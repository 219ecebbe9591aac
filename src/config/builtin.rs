//! The profiles that are built into the binary, so that a demo or a trial with a person of the cohort needs no file.

macro_rules! shipped {
    ($name:literal) => {
        ($name, include_str!(concat!("../../profiles/", $name, ".toml")))
    };
}

/// Name and text of each: the person of the demo, and the cohort that mirrors the thesis' table 4.2.
pub(super) const PROFILES: &[(&str, &str)] = &[
    shipped!("default"),
    shipped!("participant-01"),
    shipped!("participant-02"),
    shipped!("participant-03"),
    shipped!("participant-04"),
    shipped!("participant-05"),
    shipped!("participant-06"),
    shipped!("participant-07"),
    shipped!("participant-08"),
    shipped!("participant-09"),
    shipped!("participant-10"),
    shipped!("participant-11"),
    shipped!("participant-12"),
];

/// The text of a built-in profile.
pub(super) fn profile(name: &str) -> Option<&'static str> {
    PROFILES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
