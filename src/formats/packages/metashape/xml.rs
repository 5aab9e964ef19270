//! Agisoft's XML: parsing it safely, and the elements and numbers in it.

use roxmltree::{Document, Node};

use crate::fault::Fault;
use crate::text::fields::{Fields, shown};
use crate::text::xml_document::{Writer, parse_of};

pub(super) use crate::text::xml_document::{child, children, text};

/// What to do about XML that is not as Agisoft writes it.
pub(super) const EXPORT: &str = "export it from Metashape again (File > Export > Export Cameras)";

/// A `<reference>` has about 20 attributes; a flight of 100 000 photos with all their metadata has
/// millions of nodes.
const AGISOFT: Writer = Writer {
    name: Some("Agisoft"),
    if_damaged: EXPORT,
    if_foreign: EXPORT,
    longest_tag: usize::MAX,
    most_attributes: 100,
    has_namespaces: false,
    most_nodes: 10_000_000,
};

/// The document of a text.
///
/// # Errors
/// Where it is no XML, or none of Agisoft's, with the line.
pub(super) fn parse(text: &str) -> Result<Document<'_>, Fault> {
    parse_of(text, &AGISOFT)
}

/// The name of the outermost element of XML of which `start` is the beginning; `None` where it is no
/// XML or begins with more than its declaration and comments.
pub(super) fn root_element(start: &[u8]) -> Option<&str> {
    // The cut may go through a character.
    let start = match std::str::from_utf8(start) {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(start.get(..error.valid_up_to())?).ok()?,
    };
    let mut rest = start.trim_start_matches('\u{feff}').trim_start();
    loop {
        let end = if rest.starts_with("<?") {
            "?>"
        } else if rest.starts_with("<!--") {
            "-->"
        } else {
            break;
        };
        rest = rest.split_once(end)?.1.trim_start();
    }
    let name = rest.strip_prefix('<')?;
    let end = name.find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '-' | ':')))?;
    name.get(..end).filter(|name| !name.is_empty())
}

/// The line of an element, from 1.
pub(super) fn line(node: Node<'_, '_>) -> u64 {
    u64::from(node.document().text_pos_at(node.range().start).row)
}

/// Whether an attribute says no; one that is not there says yes.
pub(super) fn is_off(node: Node<'_, '_>, attribute: &str) -> bool {
    node.attribute(attribute)
        .is_some_and(|value| matches!(value.trim(), "0" | "false" | "False"))
}

/// The N numbers that an element consists of.
pub(super) fn numbers<const N: usize>(node: Node<'_, '_>) -> Result<[f64; N], Fault> {
    // The line is looked for from the beginning of the text, so only where it is needed.
    numbers_at(node, 0).or_else(|_| numbers_at(node, line(node)))
}

fn numbers_at<const N: usize>(node: Node<'_, '_>, line: u64) -> Result<[f64; N], Fault> {
    let name = node.tag_name().name();
    let what = format!("a number of <{name}>");
    let mut fields = Fields::new(line, text(node), EXPORT);
    let mut all = [0.0; N];
    for number in &mut all {
        *number = fields.number(&what)?;
    }
    if fields.rest().is_empty() {
        return Ok(all);
    }
    let rest = shown(fields.rest());
    Err(fields.fault(format!("<{name}> has {N} numbers, then '{rest}'")))
}

/// The number in an element of a name directly inside another, if there is one.
pub(super) fn number(node: Node<'_, '_>, name: &'static str) -> Result<Option<f64>, Fault> {
    let Some(child) = child(node, name) else {
        return Ok(None);
    };
    let [number] = numbers(child)?;
    Ok(Some(number))
}

/// The number in an attribute; `None` where it is not there or no finite number.
pub(super) fn attribute(node: Node<'_, '_>, name: &str) -> Option<f64> {
    let number = node.attribute(name)?.trim().parse::<f64>().ok()?;
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_found_behind_declaration_and_comments() {
        for (start, root) in [
            (
                "<?xml version=\"1.0\"?>\n<document version",
                Some("document"),
            ),
            ("\u{feff} <!-- <a> -->\r\n<chunk>", Some("chunk")),
            ("<calibration/>", Some("calibration")),
            ("<docum", None),
            ("<?xml ", None),
            ("< a>", None),
            ("ply\n", None),
            ("", None),
        ] {
            assert_eq!(root_element(start.as_bytes()), root, "{start}");
        }
        assert_eq!(root_element(b"<chunk label=\"\xc3"), Some("chunk"));
    }

    #[test]
    fn bombs_are_refused_at_once() {
        let many: String = (0..2000).map(|i| format!("a{i}='' ")).collect();
        let fault = parse(&format!("<document>\n<a {many}/></document>")).unwrap_err();
        assert_eq!(fault.line, Some(2));
        assert!(fault.what.starts_with("a tag that Agisoft"), "{fault}");
        let spaces: String = (0..1000).map(|i| format!("<a xmlns:n{i}='x'>")).collect();
        assert!(parse(&spaces).is_err());
        let laughs = "<!DOCTYPE l [<!ENTITY a \"a\">]><document>&a;</document>";
        assert!(parse(laughs).unwrap_err().what.contains("document type"));
        assert!(parse(&"<a>".repeat(100_000)).is_err());
        assert!(parse("").is_err() && parse("<").is_err());
        // What is long in a comment is none.
        assert!(parse(&format!("<!--{}--><a/>", "=".repeat(1000))).is_ok());
    }

    #[test]
    fn numbers_are_counted_and_placed() {
        let document = parse("<a>\n<b> 1 2\t3\n</b><c>1 x</c><d>1 nan</d></a>").unwrap();
        let at = |name| child(document.root_element(), name).unwrap();
        assert_eq!(numbers(at("b")), Ok([1.0, 2.0, 3.0]));
        let few = numbers::<4>(at("b")).unwrap_err();
        assert_eq!(few.line, Some(2));
        assert!(numbers::<2>(at("b")).unwrap_err().what.contains("then '3'"));
        assert!(numbers::<2>(at("c")).unwrap_err().what.contains("'x'"));
        assert!(numbers::<2>(at("d")).is_err());
    }
}
