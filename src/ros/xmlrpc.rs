//! XML-RPC, as far as a ROS 1 master needs it: values, calls and answers as text.
//!
//! The `xml-rpc` crate under rosrust waits for ever on a peer that does not answer and keeps its parser to itself; both the
//! watch over a master and the embedded master must never wait for ever. No socket is touched here: `http` does that.

pub mod http;
mod parse;

pub use parse::{ParseError, parse_call, parse_response};

use std::collections::BTreeMap;
use std::fmt::Write;

/// A value of XML-RPC. Dates are kept as their text.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `int` or `i4`.
    Integer(i32),
    /// `boolean`.
    Boolean(bool),
    /// `double`.
    Double(f64),
    /// `string`, or no type at all.
    Text(String),
    /// `base64` or `dateTime.iso8601`: its name and its text, passed on untouched.
    Opaque(&'static str, String),
    /// `array`.
    Array(Vec<Value>),
    /// `struct`.
    Struct(BTreeMap<String, Value>),
}

impl Value {
    /// A text.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// An array of texts.
    pub fn texts<T: Into<String>>(texts: impl IntoIterator<Item = T>) -> Self {
        Self::Array(texts.into_iter().map(|text| Self::Text(text.into())).collect())
    }

    /// The text, where it is one.
    #[must_use]
    pub fn as_text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }

    /// The elements, where it is an array.
    #[must_use]
    pub fn as_array(&self) -> Option<&[Self]> {
        if let Self::Array(elements) = self { Some(elements) } else { None }
    }

    /// The whole number, where it is one.
    #[must_use]
    pub const fn as_integer(&self) -> Option<i32> {
        if let Self::Integer(number) = self { Some(*number) } else { None }
    }

    fn write(&self, out: &mut String) {
        out.push_str("<value>");
        // Writing to a string cannot fail.
        let _ = match self {
            Self::Integer(number) => write!(out, "<int>{number}</int>"),
            Self::Boolean(truth) => write!(out, "<boolean>{}</boolean>", u8::from(*truth)),
            Self::Double(number) => write!(out, "<double>{number:?}</double>"),
            Self::Text(text) => write!(out, "<string>{}</string>", escape(text)),
            Self::Opaque(kind, text) => write!(out, "<{kind}>{}</{kind}>", escape(text)),
            Self::Array(elements) => {
                out.push_str("<array><data>");
                elements.iter().for_each(|element| element.write(out));
                out.write_str("</data></array>")
            }
            Self::Struct(members) => {
                out.push_str("<struct>");
                for (name, member) in members {
                    out.push_str("<member><name>");
                    out.push_str(&escape(name));
                    out.push_str("</name>");
                    member.write(out);
                    out.push_str("</member>");
                }
                out.write_str("</struct>")
            }
        };
        out.push_str("</value>");
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A call as text.
#[must_use]
pub fn write_call(method: &str, parameters: &[Value]) -> String {
    let mut out = format!("<?xml version=\"1.0\"?><methodCall><methodName>{}</methodName>", escape(method));
    write_parameters(parameters, &mut out);
    out.push_str("</methodCall>");
    out
}

/// An answer as text.
#[must_use]
pub fn write_response(value: &Value) -> String {
    let mut out = String::from("<?xml version=\"1.0\"?><methodResponse>");
    write_parameters(std::slice::from_ref(value), &mut out);
    out.push_str("</methodResponse>");
    out
}

fn write_parameters(parameters: &[Value], out: &mut String) {
    out.push_str("<params>");
    for parameter in parameters {
        out.push_str("<param>");
        parameter.write(out);
        out.push_str("</param>");
    }
    out.push_str("</params>");
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_value() -> impl Strategy<Value = Value> {
        let leaf = prop_oneof![
            any::<i32>().prop_map(Value::Integer),
            any::<bool>().prop_map(Value::Boolean),
            any::<f64>().prop_filter("finite", |number| number.is_finite()).prop_map(Value::Double),
            "[ -~äöü]{0,12}".prop_map(Value::Text),
        ];
        leaf.prop_recursive(3, 24, 4, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 0..4).prop_map(Value::Array),
                prop::collection::btree_map("[a-z<&]{1,6}", inner, 0..4).prop_map(Value::Struct),
            ]
        })
    }

    proptest! {
        #[test]
        fn a_call_returns_as_it_was_written(method in "[a-zA-Z]{1,12}", parameters in prop::collection::vec(any_value(), 0..4)) {
            let text = write_call(&method, &parameters);
            prop_assert_eq!(parse_call(&text).unwrap(), (method, parameters));
        }

        #[test]
        fn an_answer_returns_as_it_was_written(value in any_value()) {
            prop_assert_eq!(parse_response(&write_response(&value)).unwrap(), value);
        }

        #[test]
        fn garbage_is_an_error_and_no_panic(text in "(<[a-z/]{0,8}>|[a-z0-9&;<]{0,5}){0,30}") {
            let _ = parse_call(&text);
            let _ = parse_response(&text);
        }

        #[test]
        fn a_cut_call_is_an_error(cut in 1_usize..150) {
            let text = write_call("registerPublisher", &[Value::text("/node"), Value::Integer(4), Value::texts(["a", "b"])]);
            let end = text.len().saturating_sub(cut).max(1);
            prop_assert!(parse_call(&text[..end]).is_err());
        }
    }

    #[test]
    fn what_python_writes_is_read() {
        let text = "<?xml version='1.0'?>\n<methodCall>\n<methodName>setParam</methodName>\n<params>\n<param>\n<value><string>/node</string></value>\n</param>\n<param>\n<value><array><data>\n<value><int>1</int></value>\n<value><boolean>1</boolean></value>\n<value><double>2.5</double></value>\n<value><nil/></value></data></array></value>\n</param>\n</params>\n</methodCall>\n";
        assert!(parse_call(text).is_err(), "nil is no value of ROS");
        let (method, parameters) =
            parse_call(&text.replace("<value><nil/></value>", "<value>plain &lt;</value>")).unwrap();
        assert_eq!(method, "setParam");
        let expected = vec![Value::Integer(1), Value::Boolean(true), Value::Double(2.5), Value::text("plain <")];
        assert_eq!(parameters, [Value::text("/node"), Value::Array(expected)]);
    }

    #[test]
    fn a_tower_of_arrays_is_refused_before_it_fills_the_stack() {
        let text =
            format!("<methodCall><methodName>x</methodName><params><param>{}", "<value><array><data>".repeat(100_000));
        assert_eq!(parse_call(&text), Err(ParseError::TooDeep));
    }

    #[test]
    fn a_fault_is_an_error_with_its_words() {
        let text = "<methodResponse><fault><value><struct><member><name>faultCode</name><value><int>4</int></value></member><member><name>faultString</name><value><string>no such method</string></value></member></struct></value></fault></methodResponse>";
        assert_eq!(parse_response(text), Err(ParseError::Fault("no such method".into())));
    }
}
