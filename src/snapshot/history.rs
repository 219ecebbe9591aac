//! A ring of past values that costs next to nothing to clone, and a value that clones share.
//!
//! Holds values in chunks behind reference counts: a clone copies only the newest, unfinished chunk. Never grows beyond
//! its capacity.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::VecDeque;
use std::ops::Deref;
use std::sync::Arc;

/// Values of a full chunk.
const CHUNK: usize = 64;

/// The newest values of a series, oldest first. At least `capacity` of them are kept, and at most 64 more.
#[derive(Clone, Debug)]
pub struct History<T> {
    capacity: usize,
    sealed: VecDeque<Arc<[T]>>,
    tail: Vec<T>,
}

impl<T: Clone> History<T> {
    /// An empty series that keeps `capacity` values.
    #[must_use]
    pub const fn new(capacity: usize) -> Self {
        Self { capacity, sealed: VecDeque::new(), tail: Vec::new() }
    }

    /// Adds the newest value.
    pub fn push(&mut self, value: T) {
        self.tail.push(value);
        if self.tail.len() < CHUNK {
            return;
        }
        self.sealed.push_back(self.tail.drain(..).collect());
        // The newest chunk always stays: without it there would be no newest value.
        while self.len() >= self.capacity.max(1).saturating_add(CHUNK) {
            self.sealed.pop_front();
        }
    }
}

impl<T: Clone> History<T> {
    /// The newest `count` values as a series of their own, with the same room.
    #[must_use]
    pub fn newest(&self, count: usize) -> Self {
        let mut newest: Vec<T> = self.iter().rev().take(count).cloned().collect();
        newest.reverse();
        let mut series = Self::new(self.capacity);
        series.extend(newest);
        series
    }
}

impl<T> History<T> {
    /// How many values are held.
    #[must_use]
    pub fn len(&self) -> usize {
        self.sealed.len() * CHUNK + self.tail.len()
    }

    /// True where nothing was pushed yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The newest value.
    #[must_use]
    pub fn last(&self) -> Option<&T> {
        self.tail.last().or_else(|| self.sealed.back().and_then(|chunk| chunk.last()))
    }

    /// All values, oldest first; to be walked from the newest with `rev`.
    #[must_use]
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> {
        self.sealed.iter().flat_map(|chunk| chunk.iter()).chain(self.tail.iter())
    }
}

/// Chunks that are shared are equal without a look at their values.
impl<T: PartialEq> PartialEq for History<T> {
    fn eq(&self, other: &Self) -> bool {
        let same = |(one, two): (&Arc<[T]>, &Arc<[T]>)| Arc::ptr_eq(one, two) || one == two;
        self.sealed.len() == other.sealed.len()
            && self.tail == other.tail
            && self.sealed.iter().zip(&other.sealed).all(same)
    }
}

/// An empty series that keeps 6000 values: a minute at 100 Hz.
impl<T> Default for History<T> {
    fn default() -> Self {
        Self { capacity: 6000, sealed: VecDeque::new(), tail: Vec::new() }
    }
}

impl<T: Clone> Extend<T> for History<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, values: I) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

impl<T: Serialize> Serialize for History<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de, T: Clone + Deserialize<'de>> Deserialize<'de> for History<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values = Vec::<T>::deserialize(deserializer)?;
        let mut history = Self { capacity: values.len().max(Self::default().capacity), ..Self::default() };
        history.extend(values);
        Ok(history)
    }
}

/// A value that clones of a snapshot share.
#[derive(Debug, Default)]
pub struct Shared<T>(Arc<T>);

/// Values that are shared are equal without a look at them.
impl<T: PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl<T> Shared<T> {
    /// Takes a value in.
    #[must_use]
    pub fn new(value: T) -> Self {
        Self(Arc::new(value))
    }
}

impl<T: Clone> Shared<T> {
    /// The value, to change it: copied first where another snapshot still shows it.
    pub fn make_mut(&mut self) -> &mut T {
        Arc::make_mut(&mut self.0)
    }
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Deref for Shared<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> From<T> for Shared<T> {
    fn from(value: T) -> Self {
        Self::new(value)
    }
}

impl<T: Serialize> Serialize for Shared<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Shared<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_newest_values_are_kept_in_order_and_memory_is_bounded(capacity in 0_usize..300, pushed in 0_usize..1000) {
            let mut history = History::new(capacity);
            history.extend(0..pushed);
            let kept: Vec<usize> = history.iter().copied().collect();
            let expected: Vec<usize> = (pushed - kept.len()..pushed).collect();
            prop_assert_eq!(&kept, &expected);
            prop_assert!(kept.len() >= capacity.min(pushed));
            prop_assert!(kept.len() < capacity + 2 * CHUNK);
            prop_assert_eq!(history.last().copied(), pushed.checked_sub(1));
            prop_assert_eq!(history.is_empty(), pushed == 0);
        }
    }

    #[test]
    fn a_clone_does_not_see_what_is_pushed_later() {
        let mut history = History::new(200);
        history.extend(0..150);
        let before = history.clone();
        history.extend(150..400);
        assert_eq!(before.iter().copied().collect::<Vec<_>>(), (0..150).collect::<Vec<_>>());
    }

    #[test]
    fn series_and_shared_values_survive_the_way_through_a_file() {
        let mut history = History::new(10);
        history.extend(0..70);
        let text = serde_json::to_string(&Shared::new(history.clone())).unwrap();
        let back: Shared<History<i32>> = serde_json::from_str(&text).unwrap();
        assert!(back.iter().eq(history.iter()));
    }
}
