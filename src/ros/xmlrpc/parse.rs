//! Reads XML-RPC text. Everything that is not XML-RPC is an error; nothing here panics or recurses without end.

use super::Value;
use std::collections::BTreeMap;
use thiserror::Error;

/// Arrays and structs inside each other, at most. Parameter trees of robots have about ten.
const DEPTH: u32 = 64;

/// Why a text is not XML-RPC.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ParseError {
    /// Something else was expected.
    #[error("expected {expected} at byte {position}")]
    Expected {
        /// What.
        expected: String,
        /// Where.
        position: usize,
    },
    /// A number is none.
    #[error("{0:?} is no number")]
    Number(String),
    /// Values inside each other beyond the limit.
    #[error("values are nested more than {DEPTH} deep")]
    TooDeep,
    /// The peer answered with a fault.
    #[error("{0}")]
    Fault(String),
}

/// A call's method and parameters.
///
/// # Errors
/// A [`ParseError`] where the text is not a call.
pub fn parse_call(text: &str) -> Result<(String, Vec<Value>), ParseError> {
    let mut reader = Reader::new(text);
    reader.open("methodCall")?;
    reader.open("methodName")?;
    let method = reader.text_until_tag();
    reader.close("methodName")?;
    let mut parameters = Vec::new();
    if reader.try_tag("params/") || !reader.try_tag("params") {
        reader.close("methodCall")?;
        return Ok((method, parameters));
    }
    while reader.try_tag("param") {
        parameters.push(reader.value(0)?);
        reader.close("param")?;
    }
    reader.close("params")?;
    reader.close("methodCall")?;
    Ok((method, parameters))
}

/// An answer's value.
///
/// # Errors
/// A [`ParseError`] where the text is not an answer, or is a fault.
pub fn parse_response(text: &str) -> Result<Value, ParseError> {
    let mut reader = Reader::new(text);
    reader.open("methodResponse")?;
    if reader.try_tag("fault") {
        let Value::Struct(members) = reader.value(0)? else { return Err(reader.expected("a fault")) };
        let words = members.get("faultString").and_then(Value::as_text).unwrap_or("a fault without words");
        return Err(ParseError::Fault(words.to_owned()));
    }
    reader.open("params")?;
    reader.open("param")?;
    let value = reader.value(0)?;
    reader.close("param")?;
    reader.close("params")?;
    reader.close("methodResponse")?;
    Ok(value)
}

struct Reader<'a> {
    rest: &'a str,
    length: usize,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str) -> Self {
        let mut rest = text.trim_start_matches('\u{feff}').trim_start();
        if rest.starts_with("<?")
            && let Some((_, after)) = rest.split_once("?>")
        {
            rest = after;
        }
        Self { rest, length: text.len() }
    }

    fn expected(&self, what: impl Into<String>) -> ParseError {
        ParseError::Expected { expected: what.into(), position: self.length - self.rest.len() }
    }

    /// Takes the tag `<name>` after white space, where it is next.
    fn try_tag(&mut self, name: &str) -> bool {
        let after = self.rest.trim_start().strip_prefix('<').and_then(|rest| rest.strip_prefix(name));
        let Some(after) = after.and_then(|rest| rest.trim_start().strip_prefix('>')) else { return false };
        self.rest = after;
        true
    }

    fn open(&mut self, name: &str) -> Result<(), ParseError> {
        if self.try_tag(name) { Ok(()) } else { Err(self.expected(format!("<{name}>"))) }
    }

    fn close(&mut self, name: &str) -> Result<(), ParseError> {
        let after = self.rest.trim_start().strip_prefix("</").and_then(|rest| rest.strip_prefix(name));
        let after = after.and_then(|rest| rest.trim_start().strip_prefix('>'));
        self.rest = after.ok_or_else(|| self.expected(format!("</{name}>")))?;
        Ok(())
    }

    fn text_until_tag(&mut self) -> String {
        let (text, rest) = self.rest.split_at(self.rest.find('<').unwrap_or(self.rest.len()));
        self.rest = rest;
        unescape(text)
    }

    fn value(&mut self, depth: u32) -> Result<Value, ParseError> {
        if depth > DEPTH {
            return Err(ParseError::TooDeep);
        }
        if self.try_tag("value/") {
            return Ok(Value::text(""));
        }
        self.open("value")?;
        let value = self.typed(depth)?;
        self.close("value")?;
        Ok(value)
    }

    fn typed(&mut self, depth: u32) -> Result<Value, ParseError> {
        for (name, read) in SCALARS {
            if self.try_tag(name) {
                let text = self.text_until_tag();
                self.close(name)?;
                return read(text);
            }
            if self.try_tag(&format!("{name}/")) {
                return read(String::new());
            }
        }
        if self.try_tag("array") {
            return self.array(depth);
        }
        if self.try_tag("struct/") {
            return Ok(Value::Struct(BTreeMap::new()));
        }
        if self.try_tag("struct") {
            return self.members(depth);
        }
        let text = self.text_until_tag();
        if self.rest.starts_with("</") { Ok(Value::Text(text)) } else { Err(self.expected("a type of XML-RPC")) }
    }

    fn array(&mut self, depth: u32) -> Result<Value, ParseError> {
        let mut elements = Vec::new();
        if !self.try_tag("data/") {
            self.open("data")?;
            while !self.rest.trim_start().starts_with("</") {
                elements.push(self.value(depth + 1)?);
            }
            self.close("data")?;
        }
        self.close("array")?;
        Ok(Value::Array(elements))
    }

    fn members(&mut self, depth: u32) -> Result<Value, ParseError> {
        let mut members = BTreeMap::new();
        while self.try_tag("member") {
            self.open("name")?;
            let name = self.text_until_tag();
            self.close("name")?;
            members.insert(name, self.value(depth + 1)?);
            self.close("member")?;
        }
        self.close("struct")?;
        Ok(Value::Struct(members))
    }
}

type ReadScalar = fn(String) -> Result<Value, ParseError>;

const SCALARS: [(&str, ReadScalar); 7] = [
    ("string", |text| Ok(Value::Text(text))),
    ("int", |text| number(&text).map(Value::Integer)),
    ("i4", |text| number(&text).map(Value::Integer)),
    ("double", |text| number(&text).map(Value::Double)),
    ("boolean", |text| match text.trim() {
        "0" | "false" => Ok(Value::Boolean(false)),
        "1" | "true" => Ok(Value::Boolean(true)),
        _ => Err(ParseError::Number(text)),
    }),
    ("base64", |text| Ok(Value::Opaque("base64", text))),
    ("dateTime.iso8601", |text| Ok(Value::Opaque("dateTime.iso8601", text))),
];

fn number<T: std::str::FromStr>(text: &str) -> Result<T, ParseError> {
    text.trim().parse().map_err(|_| ParseError::Number(text.to_owned()))
}

/// Replaces the five named characters and numbered ones; what is none of them stays as it is.
fn unescape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        out.push_str(before);
        let named = after.split_once(';').and_then(|(name, tail)| character(name).map(|found| (found, tail)));
        if let Some((found, tail)) = named {
            out.push(found);
            rest = tail;
        } else {
            out.push('&');
            rest = after;
        }
    }
    out.push_str(rest);
    out
}

fn character(name: &str) -> Option<char> {
    match name {
        "lt" => Some('<'),
        "gt" => Some('>'),
        "amp" => Some('&'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        _ => {
            let code = name.strip_prefix('#')?;
            let code = match code.strip_prefix('x') {
                Some(digits) => u32::from_str_radix(digits, 16).ok()?,
                None => code.parse().ok()?,
            };
            char::from_u32(code)
        }
    }
}
