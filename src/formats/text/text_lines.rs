//! Text, line by line, of files that may be too large for memory as a whole.

use std::io::BufRead;

use crate::fault::Fault;

/// The longest line that is read, in bytes: a binary file has no line breaks.
const LONGEST_LINE: u64 = 1 << 20;

/// Reads lines without their ends (LF, CRLF or CR LF mixed) and without a byte order mark.
#[derive(Debug)]
pub(crate) struct TextLines<R> {
    input: R,
    buffer: Vec<u8>,
    line: u64,
    bytes: u64,
}

impl<R: BufRead> TextLines<R> {
    pub(crate) fn new(input: R) -> Self {
        Self {
            input,
            buffer: Vec::new(),
            line: 0,
            bytes: 0,
        }
    }

    /// The number, from 1, of the line last read.
    pub(crate) fn line(&self) -> u64 {
        self.line
    }

    /// How many bytes have been read.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The next line, or `None` at the end.
    pub(crate) fn next_line(&mut self) -> Result<Option<&str>, Fault> {
        use std::io::Read;
        self.buffer.clear();
        self.line += 1;
        let read = self
            .input
            .by_ref()
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut self.buffer)
            .map_err(|e| {
                Fault::at(
                    self.line,
                    format!("it cannot be read ({e})"),
                    "check the disk",
                )
            })?;
        if read == 0 {
            return Ok(None);
        }
        self.bytes += read as u64;
        if read as u64 == LONGEST_LINE && self.buffer.last() != Some(&b'\n') {
            return Err(self.fault(
                "a line of over a million bytes",
                "check that it is a text file",
            ));
        }
        let mut bytes = self.buffer.as_slice();
        if self.line == 1 {
            bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        }
        let bytes = bytes.strip_suffix(b"\n").unwrap_or(bytes);
        let last = bytes.iter().rposition(|byte| *byte != b'\r');
        let bytes = bytes
            .get(..last.map_or(0, |last| last + 1))
            .unwrap_or(bytes);
        if bytes.contains(&b'\r') {
            return Err(Fault::at(
                self.line,
                "its lines end with CR alone, as on Macs of old",
                "save it with lines that end with LF, or CR and LF",
            ));
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Some(text)),
            Err(_) => Err(Fault::at(
                self.line,
                "it is not UTF-8 text",
                "save it as UTF-8",
            )),
        }
    }

    /// A fault at the line last read.
    pub(crate) fn fault(&self, what: impl Into<String>, remedy: &str) -> Fault {
        Fault::at(self.line, what, remedy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_marks_are_dropped() {
        let mut lines = TextLines::new(&b"\xef\xbb\xbfa b\r\n\nc"[..]);
        assert_eq!(lines.next_line(), Ok(Some("a b")));
        assert_eq!(lines.next_line(), Ok(Some("")));
        assert_eq!(lines.next_line(), Ok(Some("c")));
        assert_eq!((lines.line(), lines.bytes()), (3, 10));
        assert_eq!(lines.next_line(), Ok(None));
    }

    /// All of them would be one line, of which a table takes the first columns.
    #[test]
    fn lines_that_end_with_cr_alone_are_refused() {
        let mut lines = TextLines::new(&b"1 2 3\r4 5 6\r"[..]);
        let fault = lines.next_line().unwrap_err();
        assert!(fault.line == Some(1) && fault.what.contains("CR alone"));
        let mut lines = TextLines::new(&b"1 2 3\r\r\n4 5 6\r\r\n"[..]);
        assert_eq!(lines.next_line(), Ok(Some("1 2 3")));
        assert_eq!(lines.next_line(), Ok(Some("4 5 6")));
    }

    #[test]
    fn what_is_no_text_is_refused() {
        let mut lines = TextLines::new(&b"a\n\xff\n"[..]);
        assert_eq!(lines.next_line(), Ok(Some("a")));
        assert_eq!(lines.next_line().unwrap_err().line, Some(2));
        let endless = vec![b'x'; 3 << 20];
        let mut lines = TextLines::new(endless.as_slice());
        assert!(lines.next_line().is_err());
    }
}
