//! Requirements of `docs/safety.md` that the whole of supervisor, guards and simulated world must keep, each with its fault
//! injected; and that every requirement has a test that bears its number.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    reason = "a test may fail loudly anywhere"
)]
#![allow(clippy::float_cmp, reason = "an arm that is held is commanded the very same joints")]

mod catch;
mod force;
mod hold;
mod inputs;
mod limits;
mod numbers;
mod retries;
mod room;
mod run_key;
mod sensed;
mod services;
mod stopped;
mod switch;
mod withdrawal;
