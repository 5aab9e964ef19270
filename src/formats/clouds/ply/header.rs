//! The text header: what the elements behind it are.

use std::io::{BufRead, Read};

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::Header;

use super::elements::{Elements, Skipped};
use crate::fault::Fault;
use crate::text::fields::shown;

/// More bytes than any header has.
const LONGEST_HEADER: u64 = 1 << 20;

pub(super) fn read_header<R: BufRead>(mut input: R) -> Result<(Header, Elements<R>), Fault> {
    let (header, lines) = plain_header(&mut input)?;
    let header = Parser::<Skipped>::new()
        .read_header(&mut Reader::new(header.as_bytes()))
        .map_err(|error| header_fault(&error, &header))?;
    if (header.version.major, header.version.minor) != (1, 0) {
        let (major, minor) = (header.version.major, header.version.minor);
        return Err(Fault::new(
            format!("it is PLY of version {major}.{minor}; only 1.0 is known"),
            "export version 1.0",
        ));
    }
    let elements = Elements {
        encoding: header.encoding,
        line: lines,
        input,
        text: String::new(),
    };
    Ok((header, elements))
}

/// Reads the header's lines, each with single spaces between its words, and their number. Comments
/// lose their words, which may be of any encoding.
fn plain_header(input: &mut impl BufRead) -> Result<(String, u64), Fault> {
    let mut bounded = input.by_ref().take(LONGEST_HEADER);
    let mut plain = String::new();
    let mut line = Vec::new();
    for lines in 0.. {
        line.clear();
        let read = bounded.read_until(b'\n', &mut line).map_err(|e| {
            Fault::new(format!("its header cannot be read ({e})"), "check the disk")
        })?;
        if read == 0 {
            return Ok((plain, lines));
        }
        let text = String::from_utf8_lossy(&line);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words.first() {
            Some(&"comment" | &"obj_info") => plain.push_str("comment -"),
            _ => plain.push_str(&words.join(" ")),
        }
        plain.push('\n');
        if words == ["end_header"] {
            return Ok((plain, lines + 1));
        }
    }
    Ok((plain, 0))
}

fn header_fault(error: &ParseError, header: &str) -> Fault {
    let remedy = "check that it is a PLY file, and export it again";
    let number = error.line().unwrap_or(1).max(1);
    match header.lines().nth(number - 1) {
        Some(line) => {
            let what = format!("its header does not go on as PLY at '{}'", shown(line));
            Fault::at(number as u64, what, remedy)
        }
        None => Fault::at(number as u64, "its header ends before end_header", remedy),
    }
}
