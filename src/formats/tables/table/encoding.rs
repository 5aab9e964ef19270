//! The text of a table's file: UTF-8, UTF-16 as spreadsheets call "Unicode text", or Windows-1252 as they save CSV in western Europe.

use crate::fault::Fault;
use crate::files::text_from_bytes;

/// What 0x80 to 0x9F are in Windows-1252; `\0` where they are nothing. The others are as in Unicode.
const HIGH: [char; 32] = [
    '€', '\0', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\0', 'Ž', '\0', //
    '\0', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\0', 'ž', 'Ÿ',
];

/// The text, and what is said of how it was read.
///
/// # Errors
/// Where it is none of these.
pub(super) fn decoded(bytes: &[u8]) -> Result<(String, Option<&'static str>), Fault> {
    if let Some(text) = utf_16(bytes) {
        return text.map(|text| (text, None));
    }
    match text_from_bytes(bytes) {
        Ok(text) => Ok((text.to_owned(), None)),
        Err(fault) => match windows_1252(bytes) {
            Some(text) => Ok((text, Some("it is no UTF-8, and is read as Windows-1252"))),
            None => Err(fault),
        },
    }
}

/// The text in UTF-16, which its mark says or, in a text of mostly Latin letters, every second byte, which is 0. `None` where it is not.
fn utf_16(bytes: &[u8]) -> Option<Result<String, Fault>> {
    let start = bytes.get(..bytes.len().min(64)).unwrap_or_default();
    let zeros = |first: usize| {
        start
            .iter()
            .skip(first)
            .step_by(2)
            .filter(|byte| **byte == 0)
            .count()
    };
    let (is_big, text) = match bytes {
        [0xff, 0xfe, text @ ..] => (false, text),
        [0xfe, 0xff, text @ ..] => (true, text),
        _ if start.len() >= 8 && zeros(1) * 3 > start.len() && zeros(0) == 0 => (false, bytes),
        _ if start.len() >= 8 && zeros(0) * 3 > start.len() && zeros(1) == 0 => (true, bytes),
        _ => return None,
    };
    let units = text.chunks_exact(2).map(|pair| match (pair, is_big) {
        (&[high, low], true) | (&[low, high], false) => u16::from_be_bytes([high, low]),
        _ => 0,
    });
    let text: Result<String, _> = char::decode_utf16(units).collect();
    Some(text.map_err(|_| Fault::new("it is no whole text in UTF-16", "save it as CSV in UTF-8")))
}

/// The text in Windows-1252; `None` where a byte is nothing there.
fn windows_1252(bytes: &[u8]) -> Option<String> {
    let letter = |byte: &u8| match byte {
        0 => None,
        0x80..=0x9f => HIGH
            .get(usize::from(byte - 0x80))
            .copied()
            .filter(|c| *c != '\0'),
        _ => Some(char::from(*byte)),
    };
    bytes.iter().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By Python's "cp1252", "utf-16-le" and "utf-16-be".
    #[test]
    fn as_python_writes_them() {
        let text = "Tamaño (mm);Größe “x” – €\n";
        let cp1252 = b"Tama\xf1o (mm);Gr\xf6\xdfe \x93x\x94 \x96 \x80\n";
        assert_eq!(decoded(cp1252).map(|of| of.0).as_deref(), Ok(text));
        assert!(decoded(cp1252).is_ok_and(|of| of.1.is_some()));
        assert_eq!(decoded(text.as_bytes()), Ok((text.to_owned(), None)));
        let little = b"S\0i\0z\0e\0 \0\xb5\0m\0,\0a\0\n\0";
        let big = b"\0S\0i\0z\0e\0 \0\xb5\0m\0,\0a\0\n";
        let wanted = "Size µm,a\n".to_owned();
        assert_eq!(decoded(little), Ok((wanted.clone(), None)));
        assert_eq!(decoded(big), Ok((wanted.clone(), None)));
        let marked = [&b"\xff\xfe"[..], little].concat();
        assert_eq!(decoded(&marked), Ok((wanted, None)));
    }

    #[test]
    fn what_is_no_text_is_refused() {
        assert!(decoded(b"a,\x81\xff\n").is_err());
        assert!(decoded(b"a,\xff\0\n").is_err());
        assert!(decoded(b"\xff\xfe\0\xd8a\0").is_err());
    }
}
