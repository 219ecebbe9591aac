//! The profiles that are built into the binary, so that a demo needs no file.

/// Name and text of each.
pub(super) const PROFILES: &[(&str, &str)] = &[("default", include_str!("../../profiles/default.toml"))];

/// The text of a built-in profile.
pub(super) fn profile(name: &str) -> Option<&'static str> {
    PROFILES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
