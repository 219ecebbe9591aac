//! Any text is an error or a call, an error or an answer; and what was read is written so that it is read the same.
#![no_main]

use valet::ros::xmlrpc::{parse_call, parse_response, write_call};

libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = parse_response(text);
    if let Ok((method, parameters)) = parse_call(text) {
        let again = write_call(&method, &parameters);
        let _ = parse_call(&again).expect("a call that was written");
    }
});
