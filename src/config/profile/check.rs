//! What a profile may say: the checks that TOML's own types cannot make.

use super::Profile;

/// Words that only a person's name or address would stand under.
const FORBIDDEN: [&str; 10] = [
    "name",
    "first_name",
    "last_name",
    "surname",
    "full_name",
    "birthday",
    "date_of_birth",
    "address",
    "email",
    "phone",
];

/// Keys at the top of a file that a profile must not have: key and what to do.
pub(super) fn forbidden_key(table: &toml::Table) -> Option<&str> {
    table.keys().map(String::as_str).find(|key| FORBIDDEN.contains(key))
}

/// The first value that cannot be used: its key and why.
pub(super) fn check(profile: &Profile) -> Result<(), (String, String)> {
    pseudonym(&profile.pseudonym)?;
    if let Some(consent) = &profile.consent {
        date("consent.date", &consent.date)?;
        if consent.version.trim().is_empty() {
            return Err(("consent.version".into(), "it is empty: write the version of the consent form".into()));
        }
    }
    if let Some(person) = &profile.simulated {
        person.check().map_err(|error| ("simulated".to_owned(), error.to_string()))?;
    }
    if let Some(camera) = &profile.camera {
        camera.check()?;
    }
    if let Some(clothes) = &profile.clothes {
        super::clothes::check(clothes)?;
    }
    garments(profile)?;
    learned(profile)
}

fn pseudonym(text: &str) -> Result<(), (String, String)> {
    let allowed = |sign: char| sign.is_ascii_lowercase() || sign.is_ascii_digit() || sign == '-';
    if (3..=40).contains(&text.len()) && text.chars().all(allowed) {
        return Ok(());
    }
    let reason = format!("{text:?} must be 3 to 40 small letters, digits and dashes, and no name");
    Err(("pseudonym".into(), reason))
}

fn date(key: &str, text: &str) -> Result<(), (String, String)> {
    let parsed: Result<toml::value::Datetime, _> = text.parse();
    let is_day = parsed.is_ok_and(|date| date.date.is_some() && date.time.is_none());
    if is_day { Ok(()) } else { Err((key.into(), format!("{text:?} must be a day, as in 2026-11-22"))) }
}

fn garments(profile: &Profile) -> Result<(), (String, String)> {
    for (index, garment) in profile.garments.iter().enumerate() {
        let key = format!("garments[{index}].name");
        if garment.name.trim().is_empty() {
            return Err((key, "it is empty: garments are chosen by name".into()));
        }
        if profile.garments.iter().skip(index + 1).any(|other| other.name == garment.name) {
            return Err((key, format!("{:?} stands there twice", garment.name)));
        }
        if let Some(person) = &profile.simulated {
            let fits = garment.check(&person.body.arm_sizes());
            fits.map_err(|error| (format!("garments[{index}]"), error.to_string()))?;
        }
    }
    Ok(())
}

fn learned(profile: &Profile) -> Result<(), (String, String)> {
    for (index, path) in profile.learned.iter().enumerate() {
        let broken = path.waypoints.iter().position(|waypoint| !waypoint.is_usable());
        if let Some(waypoint) = broken {
            let key = format!("learned[{index}].waypoints[{waypoint}]");
            return Err((key, "needs a share from -1 to 2 and offsets within 0.5 m".into()));
        }
        if path.waypoints.len() < 2 {
            return Err((format!("learned[{index}].waypoints"), "a path has at least two".into()));
        }
        let pairs = path.waypoints.iter().zip(path.waypoints.iter().skip(1));
        if let Some(first) = pairs.into_iter().position(|(one, next)| one.is_at(next)) {
            let key = format!("learned[{index}].waypoints[{}]", first + 1);
            return Err((key, "lies where the one before it lies: a path's segments have a length".into()));
        }
    }
    Ok(())
}
