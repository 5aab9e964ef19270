//! What a file says and what is made of it does not: one sentence for each kind, with how often and where first.

use std::fmt::Display;

/// More kinds than these are counted together: a broken file can have one for every line.
const MOST_KINDS: usize = 20;

/// Sentences with their counts, in the order in which they were first said.
#[derive(Debug, Clone, Default)]
pub(crate) struct Notes {
    kinds: Vec<Kind>,
    more: usize,
}

#[derive(Debug, Clone)]
struct Kind {
    text: String,
    count: usize,
    first: Option<String>,
}

impl Notes {
    /// Something about the whole file, said once.
    pub(crate) fn say(&mut self, text: impl Into<String>) {
        self.count(text.into(), None);
    }

    /// Something at a place ("item 3", "line 7", "waypoint 2").
    pub(crate) fn at(&mut self, text: impl Into<String>, place: impl Display) {
        self.count(text.into(), Some(place.to_string()));
    }

    fn count(&mut self, text: String, first: Option<String>) {
        if let Some(kind) = self.kinds.iter_mut().find(|kind| kind.text == text) {
            kind.count += 1;
        } else if self.kinds.len() < MOST_KINDS {
            let count = 1;
            self.kinds.push(Kind { text, count, first });
        } else {
            self.more += 1;
        }
    }

    /// All sentences.
    pub(crate) fn sentences(self) -> Vec<String> {
        let mut sentences: Vec<String> = (self.kinds.into_iter())
            .map(|Kind { text, count, first }| match (first, count) {
                (None, _) => text,
                (Some(first), 1) => format!("{text} ({first})"),
                (Some(first), _) => format!("{text} ({count} times, first at {first})"),
            })
            .collect();
        if self.more > 0 {
            sentences.push(format!("{} more things are passed over", self.more));
        }
        sentences
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_often_is_counted() {
        let mut notes = Notes::default();
        notes.say("one");
        notes.at("two", "item 1");
        notes.at("two", "item 3");
        notes.at("three", "item 4");
        let expected = ["one", "two (2 times, first at item 1)", "three (item 4)"];
        assert_eq!(notes.sentences(), expected);
        let mut many = Notes::default();
        (0..1000).for_each(|i| many.at(format!("command {i}"), i));
        let sentences = many.sentences();
        assert_eq!(sentences.len(), MOST_KINDS + 1);
        assert_eq!(sentences[MOST_KINDS], "980 more things are passed over");
    }
}
