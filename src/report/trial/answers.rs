//! The short questionnaires of participant and operator, and their answers: a file beside the journal,
//! `NAME.answers.toml`, or a sheet to be filled in by hand.
//!
//! Numbers only: no free text, nothing by which a person could be known.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Who answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Respondent {
    /// The person who was dressed.
    Participant,
    /// The person at the console.
    Operator,
}

/// One statement: who agrees or disagrees, its key in the file, and its words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Statement {
    pub(super) respondent: Respondent,
    pub(super) key: &'static str,
    pub(super) text: &'static str,
}

const fn statement(respondent: Respondent, key: &'static str, text: &'static str) -> Statement {
    Statement { respondent, key, text }
}

/// All statements. The scale is Likert's with seven points: 1 disagree, 7 agree.
pub(super) const STATEMENTS: [Statement; 6] = [
    statement(Respondent::Participant, "dressed", "The robot dressed me successfully."),
    statement(Respondent::Participant, "force", "The force that I felt was appropriate."),
    statement(Respondent::Participant, "comfort", "I was comfortable."),
    statement(Respondent::Participant, "movement", "The robot coped with my movement."),
    statement(Respondent::Operator, "foresight", "I knew at every moment what the robot would do next."),
    statement(Respondent::Operator, "control", "I could have stopped it at any moment."),
];

/// The version of the file.
const VERSION: u32 = 1;
/// The scale's ends.
const SCALE: std::ops::RangeInclusive<u8> = 1..=7;

/// Why answers cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AnswersError {
    /// The file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is no list of answers.
    #[error("{path}: {reason}; `valet report --print-answers` shows what is expected")]
    Unusable {
        /// Which file.
        path: PathBuf,
        /// Where and why.
        reason: String,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AnswersFile {
    version: u32,
    #[serde(default)]
    participant: BTreeMap<String, u8>,
    #[serde(default)]
    operator: BTreeMap<String, u8>,
}

/// The answers to the questionnaires of a trial; empty where nobody was asked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answers(BTreeMap<&'static str, u8>);

impl Answers {
    /// Reads a file of answers.
    ///
    /// # Errors
    /// [`AnswersError`] names the file, and the key that is not known or not on the scale.
    pub fn read(path: &Path) -> Result<Self, AnswersError> {
        let text = fs::read_to_string(path).map_err(|source| AnswersError::File { path: path.into(), source })?;
        let unusable = |reason: String| AnswersError::Unusable { path: path.into(), reason };
        let file: AnswersFile = toml::from_str(&text).map_err(|error| unusable(error.to_string()))?;
        if file.version != VERSION {
            return Err(unusable(format!("version {} is not known, only {VERSION}", file.version)));
        }
        let mut answers = BTreeMap::new();
        for (respondent, table) in [(Respondent::Participant, file.participant), (Respondent::Operator, file.operator)]
        {
            for (key, value) in table {
                let table = table_of(respondent);
                let known = STATEMENTS.iter().find(|known| known.respondent == respondent && known.key == key);
                let known = known.ok_or_else(|| unusable(format!("{table}.{key} is no statement")))?;
                if !SCALE.contains(&value) {
                    return Err(unusable(format!("{table}.{key} = {value} is not from 1 to 7")));
                }
                answers.insert(known.key, value);
            }
        }
        Ok(Self(answers))
    }

    /// Where the answers of a trial are looked for: beside its journal.
    #[must_use]
    pub fn place(journal: &Path, name: &str) -> PathBuf {
        journal.with_file_name(format!("{name}.answers.toml"))
    }

    /// A file to be filled in.
    #[must_use]
    pub fn blank() -> String {
        let mut text =
            format!("# 1: disagree, 7: agree. Take the # away from what was answered.\nversion = {VERSION}\n");
        for respondent in [Respondent::Participant, Respondent::Operator] {
            let _ = writeln!(text, "\n[{}]", table_of(respondent));
            for statement in STATEMENTS.iter().filter(|statement| statement.respondent == respondent) {
                let _ = writeln!(text, "# {}\n# {} = 4", statement.text, statement.key);
            }
        }
        text
    }

    /// The answer to a statement, from 1 (disagree) to 7 (agree).
    pub(super) fn to(&self, statement: &Statement) -> Option<u8> {
        self.0.get(statement.key).copied()
    }
}

const fn table_of(respondent: Respondent) -> &'static str {
    match respondent {
        Respondent::Participant => "participant",
        Respondent::Operator => "operator",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Answers, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = Answers::place(&folder.path().join("p-01.mcap"), "p-01");
        fs::write(&path, text).unwrap();
        Answers::read(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn answers_are_read_and_what_was_not_answered_stays_open() {
        let answers = read("version = 1\n[participant]\nforce = 6\n[operator]\ncontrol = 7\n").unwrap();
        let given: Vec<_> = STATEMENTS.iter().map(|statement| answers.to(statement)).collect();
        assert_eq!(given, [None, Some(6), None, None, None, Some(7)]);
    }

    #[test]
    fn a_blank_sheet_is_a_file_without_answers_and_filled_in_it_is_whole() {
        assert_eq!(read(&Answers::blank()).unwrap(), Answers::default());
        let filled = read(&Answers::blank().replace(" = 4", " = 4\n").replace("# dressed", "dressed")).unwrap();
        assert_eq!(filled.to(&STATEMENTS[0]), Some(4));
    }

    #[test]
    fn what_is_wrong_is_named_with_file_and_key() {
        let cases = [
            ("version = 1\n[participant]\nforce = 8\n", "participant.force = 8"),
            ("version = 1\n[operator]\nforce = 3\n", "operator.force is no statement"),
            ("version = 2\n", "version 2"),
            ("version = 1\n[participant]\nname = \"Anna\"\n", "name"),
            ("version = 1\n[remarks]\n", "remarks"),
            ("so so", "print-answers"),
        ];
        for (text, words) in cases {
            let error = read(text).unwrap_err();
            assert!(error.contains(words) && error.contains("p-01.answers.toml"), "{text}: {error}");
        }
    }
}
