//! The white-space separated fields of one line of a text format, read from left to right with
//! faults that name the field and the line.

use std::str::FromStr;

use glam::{DVec2, DVec3};

use crate::fault::Fault;

/// The fields of one line that are still to be read.
#[derive(Debug, Clone)]
pub(crate) struct Fields<'a> {
    line: u64,
    rest: &'a str,
    remedy: &'static str,
}

impl<'a> Fields<'a> {
    /// The fields of `text`, which is line number `line` (from 1); `remedy` ends every fault.
    pub(crate) fn new(line: u64, text: &'a str, remedy: &'static str) -> Self {
        let rest = text.trim();
        Self { line, rest, remedy }
    }

    /// What has not been read yet, without white space at its ends.
    pub(crate) fn rest(&self) -> &'a str {
        self.rest
    }

    /// A fault of this line.
    pub(crate) fn fault(&self, what: impl Into<String>) -> Fault {
        Fault::at(self.line, what, self.remedy)
    }

    /// The next field, or a fault that says that `name` is missing.
    pub(crate) fn word(&mut self, name: &str) -> Result<&'a str, Fault> {
        if self.rest.is_empty() {
            return Err(self.fault(format!("the line ends where {name} should be")));
        }
        let (word, rest) = self
            .rest
            .split_once(char::is_whitespace)
            .unwrap_or((self.rest, ""));
        self.rest = rest.trim_start();
        Ok(word)
    }

    /// The next field as a finite number.
    pub(crate) fn number(&mut self, name: &str) -> Result<f64, Fault> {
        let word = self.word(name)?;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err(self.fault(format!("{name} is '{}', not finite", shown(word)))),
            Err(_) => Err(self.fault(format!("{name} is '{}', not a number", shown(word)))),
        }
    }

    /// The next field as a whole number that fits `T`.
    pub(crate) fn whole<T: FromStr>(&mut self, name: &str) -> Result<T, Fault> {
        let word = self.word(name)?;
        word.parse().map_err(|_| {
            let found = shown(word);
            self.fault(format!(
                "{name} is '{found}', not a whole number in its range"
            ))
        })
    }

    /// The next two fields as a vector.
    pub(crate) fn pair(&mut self, name: &str) -> Result<DVec2, Fault> {
        Ok(DVec2::new(self.number(name)?, self.number(name)?))
    }

    /// The next three fields as a vector.
    pub(crate) fn triple(&mut self, name: &str) -> Result<DVec3, Fault> {
        Ok(self.pair(name)?.extend(self.number(name)?))
    }

    /// The next three fields as red, green, blue, each 0 to 255.
    pub(crate) fn color(&mut self) -> Result<[u8; 3], Fault> {
        Ok([
            self.whole("the red")?,
            self.whole("the green")?,
            self.whole("the blue")?,
        ])
    }
}

/// A word of a broken file, cut to what an error line can carry.
pub(crate) fn shown(word: &str) -> String {
    match word.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", word.get(..end).unwrap_or_default()),
        None => word.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_read_in_order() {
        let mut fields = Fields::new(7, "\t 12  -1.5e-005\ta b \r\n", "mend it");
        assert_eq!(fields.whole::<u32>("id"), Ok(12));
        assert_eq!(fields.number("x"), Ok(-1.5e-5));
        assert_eq!(fields.rest(), "a b");
        assert_eq!(fields.word("name"), Ok("a"));
        assert_eq!(fields.word("name"), Ok("b"));
        let end = fields.word("y").unwrap_err();
        assert_eq!(
            end,
            Fault::at(7, "the line ends where y should be", "mend it")
        );
    }

    #[test]
    fn what_is_no_number_is_refused_and_quoted_short() {
        for bad in ["nan", "inf", "-infinity", "1e999", "x", "1,5"] {
            assert!(Fields::new(1, bad, "").number("x").is_err(), "{bad}");
        }
        for bad in ["-1", "4294967296", "1.0", ""] {
            assert!(Fields::new(1, bad, "").whole::<u32>("id").is_err(), "{bad}");
        }
        assert!(Fields::new(1, "0 256 0", "").color().is_err());
        let long = "é".repeat(1000);
        let fault = Fields::new(1, &long, "").number("x").unwrap_err();
        assert!(fault.what.len() < 150, "{fault}");
    }
}
