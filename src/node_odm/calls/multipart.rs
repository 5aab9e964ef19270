//! The body of a form with fields and files (RFC 7578, multipart/form-data), written as it is read: a file is
//! never in memory as a whole, and how long all of it is, is known before.

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::Path;

/// A form's body.
pub(crate) struct Multipart {
    boundary: String,
    /// What is sent, one after the other.
    parts: Vec<Part>,
    length: u64,
}

enum Part {
    Bytes(Cursor<Vec<u8>>),
    /// So many bytes of a file, no more: a file that grows meanwhile is sent as long as it was said to be.
    File(File, u64),
}

/// Occurs in no photo by chance: 2^-160 a place. (It need not be secret: what is sent is the user's own.)
const BOUNDARY: &str = "----fragscale-9wQ2mZkT7vXb4LrN5cHs8JdYpGfUaE3o";

impl Multipart {
    pub(crate) fn new() -> Self {
        Self {
            boundary: BOUNDARY.to_owned(),
            parts: Vec::new(),
            length: 0,
        }
    }

    fn bytes(&mut self, bytes: Vec<u8>) {
        self.length += bytes.len() as u64;
        self.parts.push(Part::Bytes(Cursor::new(bytes)));
    }

    /// A field with a text.
    pub(crate) fn field(mut self, name: &str, text: &str) -> Self {
        let boundary = &self.boundary;
        let part = format!(
            "--{boundary}\r\nContent-Disposition: form-data; name=\"{name}\"\r\n\r\n{text}\r\n"
        );
        self.bytes(part.into_bytes());
        self
    }

    fn file_head(&mut self, field: &str, name: &str, kind: &str) {
        let boundary = &self.boundary;
        // Names that could end the quotation do not come this far (`sent`); this holds it here, too.
        let name: String = name
            .chars()
            .filter(|c| !c.is_control() && !"\"\\".contains(*c))
            .collect();
        let head = format!(
            "--{boundary}\r\nContent-Disposition: form-data; name=\"{field}\"; filename=\"{name}\"\r\n\
             Content-Type: {kind}\r\n\r\n"
        );
        self.bytes(head.into_bytes());
    }

    /// A file under a name.
    ///
    /// # Errors
    /// Where it cannot be opened.
    pub(crate) fn file(
        mut self,
        field: &str,
        name: &str,
        kind: &str,
        path: &Path,
    ) -> io::Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        self.file_head(field, name, kind);
        self.length += length;
        self.parts.push(Part::File(file, length));
        self.bytes(b"\r\n".to_vec());
        Ok(self)
    }

    /// A file whose bytes are at hand.
    pub(crate) fn file_of(mut self, field: &str, name: &str, kind: &str, bytes: &[u8]) -> Self {
        self.file_head(field, name, kind);
        self.bytes(bytes.to_vec());
        self.bytes(b"\r\n".to_vec());
        self
    }

    /// The body with its end: its type, how many bytes it has, and what they are read from.
    pub(crate) fn end(mut self) -> (String, u64, impl Read) {
        let end = format!("--{}--\r\n", self.boundary);
        self.bytes(end.into_bytes());
        let kind = format!("multipart/form-data; boundary={}", self.boundary);
        let body = Body {
            parts: self.parts,
            at: 0,
        };
        (kind, self.length, body)
    }
}

struct Body {
    parts: Vec<Part>,
    at: usize,
}

impl Read for Body {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while let Some(part) = self.parts.get_mut(self.at) {
            let read = match part {
                Part::Bytes(bytes) => bytes.read(buffer)?,
                Part::File(_, 0) => 0,
                Part::File(file, left) => {
                    let most = buffer
                        .len()
                        .min(usize::try_from(*left).unwrap_or(usize::MAX));
                    let read = buffer
                        .get_mut(..most)
                        .map_or(Ok(0), |buffer| file.read(buffer))?;
                    if read == 0 && most > 0 {
                        // It was said to be longer.
                        return Err(io::Error::new(
                            io::ErrorKind::UnexpectedEof,
                            "the file became shorter",
                        ));
                    }
                    *left -= read as u64;
                    read
                }
            };
            if read > 0 || buffer.is_empty() {
                return Ok(read);
            }
            self.at += 1;
        }
        Ok(0)
    }
}

/// Tells somebody how many bytes were read.
pub(crate) struct Counting<R, F> {
    pub(crate) inner: R,
    pub(crate) count: F,
}

impl<R: Read, F: FnMut(u64)> Read for Counting<R, F> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(buffer)?;
        (self.count)(read as u64);
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_of(mut reader: impl Read) -> String {
        let mut text = String::new();
        reader.read_to_string(&mut text).unwrap();
        text
    }

    /// Byte by byte what RFC 7578 (section 4) asks for.
    #[test]
    fn a_form_is_written_as_the_standard_says() {
        let (_folder, path) = fragscale_test_data::written("a.jpg", "\u{1}photo\u{2}");
        let form = Multipart::new()
            .field("name", "pile")
            .file("images", "a.jpg", "image/jpeg", &path)
            .unwrap();
        let (kind, length, body) = form
            .file_of("images", "geo.txt", "text/plain", b"EPSG:4326\n")
            .end();
        assert_eq!(kind, format!("multipart/form-data; boundary={BOUNDARY}"));
        let text = all_of(body);
        let expected = format!(
            "--{BOUNDARY}\r\nContent-Disposition: form-data; name=\"name\"\r\n\r\npile\r\n\
             --{BOUNDARY}\r\nContent-Disposition: form-data; name=\"images\"; filename=\"a.jpg\"\r\n\
             Content-Type: image/jpeg\r\n\r\n\u{1}photo\u{2}\r\n\
             --{BOUNDARY}\r\nContent-Disposition: form-data; name=\"images\"; filename=\"geo.txt\"\r\n\
             Content-Type: text/plain\r\n\r\nEPSG:4326\n\r\n--{BOUNDARY}--\r\n"
        );
        assert_eq!(text, expected);
        assert_eq!(length, expected.len() as u64);
    }

    #[test]
    fn an_empty_file_is_a_part_and_bytes_are_counted() {
        let (_folder, path) = fragscale_test_data::written("b.jpg", "");
        let (_, length, body) = Multipart::new()
            .file("images", "b.jpg", "image/jpeg", &path)
            .unwrap()
            .end();
        let mut counted = 0;
        let mut counting = Counting {
            inner: body,
            count: |bytes| counted += bytes,
        };
        let mut read = 0;
        // Small buffers, too.
        let mut buffer = [0; 7];
        loop {
            let now = counting.read(&mut buffer).unwrap();
            if now == 0 {
                break;
            }
            read += now as u64;
        }
        assert_eq!((read, counted), (length, length));
    }

    #[test]
    fn a_file_is_sent_as_long_as_it_was_said_to_be() {
        let (_folder, path) = fragscale_test_data::written("c.jpg", "0123456789");
        let (_, length, body) = Multipart::new()
            .file("images", "c.jpg", "image/jpeg", &path)
            .unwrap()
            .end();
        std::fs::write(&path, "0123456789 and more").unwrap();
        assert_eq!(all_of(body).len() as u64, length);
        let (_, _, mut body) = Multipart::new()
            .file("images", "c.jpg", "image/jpeg", &path)
            .unwrap()
            .end();
        std::fs::write(&path, "0").unwrap();
        let error = body.read_to_end(&mut Vec::new()).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::UnexpectedEof);
    }

    #[test]
    fn no_name_ends_its_quotation() {
        let form = Multipart::new().file_of("images", "a\"\r\nX: y\\.jpg", "image/jpeg", b"");
        let (_, _, body) = form.end();
        assert!(all_of(body).contains("filename=\"aX: y.jpg\"\r\n"));
    }
}
