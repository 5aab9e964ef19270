//! The elements behind the header, one at a time, as ascii or binary.

use std::io::BufRead;

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{ElementDef, Encoding, PropertyAccess};

use crate::fault::Fault;
use crate::jobs::Progress;

/// The elements behind the header.
pub(super) struct Elements<R> {
    pub(super) encoding: Encoding,
    pub(super) input: R,
    /// Number of the line last read, for ascii.
    pub(super) line: u64,
    pub(super) text: String,
}

impl<R: BufRead> Elements<R> {
    pub(super) fn read_all<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        progress: &Progress,
        mut take: impl FnMut(E) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        // Elements without properties take no bytes: their number is nobody's matter.
        if element.properties.is_empty() {
            return Ok(());
        }
        let parser = Parser::<E>::new();
        for index in 0..element.count {
            if index % 65_536 == 0 {
                progress.advance(index as u64, element.count as u64)?;
            }
            let read = match self.encoding {
                Encoding::Ascii => {
                    self.next_text_line(element, index)?;
                    parser.read_ascii_element(&self.text, element)
                }
                Encoding::BinaryBigEndian => {
                    parser.read_big_endian_element(&mut self.input, element)
                }
                Encoding::BinaryLittleEndian => {
                    parser.read_little_endian_element(&mut self.input, element)
                }
            };
            let read = read.map_err(|e| match self.encoding {
                Encoding::Ascii => {
                    let (name, text) = (&element.name, self.text.trim());
                    let what = format!("{name} {index} is not what the header promises: '{text}'");
                    Fault::at(self.line, what, "export the file again")
                }
                _ if e.kind() == std::io::ErrorKind::UnexpectedEof => cut_off(element, index),
                _ => Fault::new(
                    format!("{} {index}: {e}", element.name),
                    "export the file again",
                ),
            })?;
            take(read).map_err(|fault| match self.encoding {
                Encoding::Ascii => Fault {
                    line: Some(self.line),
                    ..fault
                },
                _ => fault,
            })?;
        }
        Ok(())
    }

    /// What follows the elements shows that a binary header does not belong to them. Behind text it
    /// is left out, with a warning.
    pub(super) fn left_out(&mut self) -> Result<Option<String>, Fault> {
        let rest = self.input.fill_buf().map_err(|e| {
            Fault::new(
                format!("it cannot be read to its end ({e})"),
                "check the disk",
            )
        })?;
        if rest.iter().all(u8::is_ascii_whitespace) {
            return Ok(None);
        }
        let what = "it goes on behind the elements that its header promises";
        match self.encoding {
            Encoding::Ascii => Ok(Some(format!("{what}; what follows is left out"))),
            _ => Err(Fault::new(what, "export the file again")),
        }
    }

    fn next_text_line(&mut self, element: &ElementDef, index: usize) -> Result<(), Fault> {
        loop {
            self.text.clear();
            self.line += 1;
            let read = self.input.read_line(&mut self.text).map_err(|e| {
                Fault::at(
                    self.line,
                    format!("it cannot be read as text ({e})"),
                    "export the file again",
                )
            })?;
            if read == 0 {
                return Err(cut_off(element, index));
            }
            if !self.text.trim().is_empty() {
                return Ok(());
            }
        }
    }
}

fn cut_off(element: &ElementDef, index: usize) -> Fault {
    let (name, count) = (&element.name, element.count);
    Fault::new(
        format!(
            "the file ends after {index} of the {count} {name} elements that its header promises"
        ),
        "copy or export it again",
    )
}

/// An element that nobody asked for.
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
