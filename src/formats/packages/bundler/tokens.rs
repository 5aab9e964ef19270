//! The white-space separated words of a text whose lines do not matter, with faults that name the
//! word and its line.

use std::str::FromStr;

use glam::DVec3;

use super::EXPORT;
use crate::fault::Fault;
use crate::text::fields::shown;

/// The words that are still to be read.
pub(super) struct Tokens<'a> {
    rest: &'a str,
    line: u64,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            rest: text,
            line: 1,
        }
    }

    /// The line, from 1, of the word last read.
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// A fault at the word last read.
    pub(super) fn fault(&self, what: impl Into<String>) -> Fault {
        Fault::at(self.line, what, EXPORT)
    }

    /// What is left of the first line that is not empty.
    pub(super) fn rest_of_line(&mut self) -> &'a str {
        self.skip_space();
        let end = self.rest.find('\n').unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest;
        line.trim()
    }

    /// Whether there is another word; passes over the space before it.
    pub(super) fn has_more(&mut self) -> bool {
        self.skip_space();
        !self.rest.is_empty()
    }

    /// The next word, or a fault that says that `name` is missing.
    pub(super) fn word(&mut self, name: &str) -> Result<&'a str, Fault> {
        self.skip_space();
        let end = self
            .rest
            .find(char::is_whitespace)
            .unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return Err(self.fault(format!("the file ends where {name} should be")));
        }
        Ok(word)
    }

    /// The next word as a finite number.
    pub(super) fn number(&mut self, name: &str) -> Result<f64, Fault> {
        let word = self.word(name)?;
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| {
            let found = shown(word);
            self.fault(format!("{name} is '{found}', not a finite number"))
        })
    }

    /// The next word as a whole number that fits `T`.
    pub(super) fn whole<T: FromStr>(&mut self, name: &str) -> Result<T, Fault> {
        let word = self.word(name)?;
        word.parse().map_err(|_| {
            let found = shown(word);
            self.fault(format!(
                "{name} is '{found}', not a whole number in its range"
            ))
        })
    }

    /// The next three words as a vector.
    pub(super) fn triple(&mut self, name: &str) -> Result<DVec3, Fault> {
        let (x, y) = (self.number(name)?, self.number(name)?);
        Ok(DVec3::new(x, y, self.number(name)?))
    }

    fn skip_space(&mut self) {
        let rest = self.rest.trim_start();
        let space = self.rest.len() - rest.len();
        let lines = self
            .rest
            .bytes()
            .take(space)
            .filter(|&b| b == b'\n')
            .count();
        self.line += lines as u64;
        self.rest = rest;
    }
}
