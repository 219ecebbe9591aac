//! A subscription that outlives what goes wrong in it.
//!
//! rosrust kills a callback for ever when it panics, and never reconnects a link that broke while its publisher lived: so
//! each callback is caught, and the watch may make the subscription anew.

use super::checked::{Checked, Measured};
use super::definitions::Definition;
use super::error::RosError;
use super::monitor::{Monitor, now};
use super::node::resolved;
use crate::supervisor::{Input, LinkEvent};
use crate::time::Stamp;
use rosrust::Subscriber;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Where inputs go. Must not block: it is called from the transport's threads.
pub type Sink = Arc<dyn Fn(Input) + Send + Sync>;

/// What a decoder made of a message.
pub(super) enum Decoded {
    /// An input for the core.
    Input(Input),
    /// Taken in, nothing to tell.
    Kept,
    /// Not to be understood.
    Unusable,
}

/// What is asked of a topic.
#[derive(Clone, Copy, Debug)]
pub(super) struct TopicNeed {
    pub(super) topic: &'static str,
    /// Messages that may wait for the callback; the oldest go first.
    pub(super) queue: usize,
    /// Least and most messages a second.
    pub(super) expected_hertz: (f64, f64),
    pub(super) required: bool,
}

type Make = Box<dyn Fn() -> Result<Subscriber, RosError> + Send>;

/// A topic that is listened to.
pub(super) struct Subscription {
    pub(super) monitor: Monitor,
    make: Make,
    current: Option<Subscriber>,
}

impl Subscription {
    /// Listens to a topic.
    ///
    /// # Errors
    /// Where the master does not register it.
    pub(super) fn new<T: Measured>(
        need: TopicNeed,
        sink: &Sink,
        decode: impl Fn(T) -> Decoded + Send + Sync + 'static,
    ) -> Result<Self, RosError> {
        let definition = Definition { kind: T::msg_type(), digest: T::md5sum() };
        let monitor =
            Monitor::new(need.topic, definition, need.expected_hertz, need.required).resolved_as(resolved(need.topic));
        let (decode, sink, watched) = (Arc::new(decode), Arc::clone(sink), monitor.clone());
        let make: Make = Box::new(move || {
            let (decode, sink, monitor) = (Arc::clone(&decode), Arc::clone(&sink), watched.clone());
            let callback = move |Checked(message): Checked<T>| receive(message, decode.as_ref(), &sink, &monitor);
            rosrust::subscribe(need.topic, need.queue, callback)
                .map_err(|error| RosError::registration(need.topic, error))
        });
        let current = Some(make()?);
        Ok(Self { monitor, make, current })
    }

    /// The same where messages of one type are read by the definitions of these digests.
    pub(super) fn reading(self, digests: Vec<String>) -> Self {
        Self { monitor: self.monitor.reading(digests), ..self }
    }

    /// The same where the publisher says once what holds for good: silence is no fault then.
    pub(super) fn said_once(self) -> Self {
        Self { monitor: self.monitor.said_once(), ..self }
    }

    /// Gives the old subscription up and makes a new one.
    pub(super) fn renew(&mut self) -> Result<(), RosError> {
        self.current = None;
        self.current = Some((self.make)()?);
        Ok(())
    }
}

fn receive<T>(message: T, decode: &(impl Fn(T) -> Decoded + ?Sized), sink: &Sink, monitor: &Monitor) {
    let arrival = now();
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(message)));
    monitor.observe(arrival, decoded.as_ref().ok().and_then(own_stamp));
    match decoded {
        Ok(Decoded::Input(input)) => sink(input),
        Ok(Decoded::Kept) => {}
        Ok(Decoded::Unusable) => monitor.unusable(),
        Err(_) => sink(Input::Link(LinkEvent::WorkerLost { name: format!("the reader of {}", monitor.topic) })),
    }
}

/// The stamp that a message carries itself.
const fn own_stamp(decoded: &Decoded) -> Option<Stamp> {
    match decoded {
        Decoded::Input(Input::Endpoint(sample)) => Some(sample.stamp),
        Decoded::Input(Input::Joints(sample)) => Some(sample.stamp),
        Decoded::Input(Input::Body(pose)) => Some(pose.stamp),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    fn definition() -> Definition {
        Definition { kind: "type".into(), digest: "digest".into() }
    }

    fn collecting() -> (Sink, Arc<Mutex<Vec<Input>>>) {
        let inputs = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&inputs);
        (Arc::new(move |input| kept.lock().unwrap().push(input)), inputs)
    }

    #[test]
    fn a_decoder_that_panics_is_told_and_the_next_message_is_read() {
        let (sink, inputs) = collecting();
        let monitor = Monitor::new("/topic", definition(), (1.0, 2.0), true);
        let decode = |number: u32| if number == 0 { panic!("broken") } else { Decoded::Input(Input::Tick) };
        receive(0, &decode, &sink, &monitor);
        receive(1, &decode, &sink, &monitor);
        let lost = Input::Link(LinkEvent::WorkerLost { name: "the reader of /topic".into() });
        assert_eq!(*inputs.lock().unwrap(), [lost, Input::Tick]);
    }

    #[test]
    fn what_cannot_be_used_is_counted() {
        let (sink, inputs) = collecting();
        let monitor = Monitor::new("/topic", definition(), (1.0, 2.0), true);
        receive((), &|()| Decoded::Unusable, &sink, &monitor);
        assert_eq!((monitor.report(now()).unusable, inputs.lock().unwrap().len()), (1, 0));
    }
}
