//! XML (1.0, namespaces) as a tree, guarded: `roxmltree` refuses document types with their entities,
//! and takes time in the square of a tag's attributes and of nested namespaces, so long tags and
//! deep nesting are refused before it sees them, and of a writer that is known, whatever it does not
//! write.

use roxmltree::{Document, ParsingOptions};

use crate::fault::Fault;
use crate::text::fields::shown;

/// How deep elements may nest.
pub(crate) const MAX_DEPTH: usize = 64;

/// What is known of those who write a kind of file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Writer {
    /// Their name; `None` where there are several.
    pub(crate) name: Option<&'static str>,
    /// What to do about XML that is damaged.
    pub(crate) if_damaged: &'static str,
    /// What to do about tags that they do not write.
    pub(crate) if_foreign: &'static str,
    /// How long a tag may be, in bytes.
    pub(crate) longest_tag: usize,
    /// How many equals signs a tag may have.
    pub(crate) most_attributes: usize,
    /// Whether they write namespaces.
    pub(crate) has_namespaces: bool,
    /// How many nodes a document may have.
    pub(crate) most_nodes: u32,
}

/// Anybody.
const ANYBODY: Writer = Writer {
    name: None,
    if_damaged: "the file is cut off or damaged: export it again",
    if_foreign: "check that it is the right file",
    longest_tag: 20_000,
    most_attributes: usize::MAX,
    has_namespaces: true,
    most_nodes: u32::MAX,
};

/// The tree of an XML text.
///
/// # Errors
/// Where it is no XML, has a document type, or tags that are too deep or too long.
pub(crate) fn parse(text: &str) -> Result<Document<'_>, Fault> {
    parse_of(text, &ANYBODY)
}

/// The tree of an XML text of this writer.
///
/// # Errors
/// As [`parse`], and where it holds tags that the writer does not write.
pub(crate) fn parse_of<'a>(text: &'a str, writer: &Writer) -> Result<Document<'a>, Fault> {
    guard(text, writer)?;
    let options = ParsingOptions {
        nodes_limit: writer.most_nodes,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| match error {
        roxmltree::Error::DtdDetected => {
            let whose = match writer.name {
                Some(name) => format!("no file of {name}'s has"),
                None => "files of this kind have not".to_owned(),
            };
            let what = format!("it has a document type (<!DOCTYPE>), which {whose}");
            Fault::new(what, "remove it")
        }
        error => Fault::at(
            u64::from(error.pos().row),
            format!("it is not valid XML ({error})"),
            writer.if_damaged,
        ),
    })
}

/// The line, from 1, on which a node begins.
pub(crate) fn line_of(node: roxmltree::Node<'_, '_>) -> u64 {
    u64::from(node.document().text_pos_at(node.range().start).row)
}

/// The elements of a name directly inside another, whatever their namespace.
pub(crate) fn children<'a, 'd, 'n>(
    node: roxmltree::Node<'a, 'd>,
    name: &'n str,
) -> impl Iterator<Item = roxmltree::Node<'a, 'd>> + use<'a, 'd, 'n> {
    node.children()
        .filter(move |child| child.has_tag_name(name))
}

/// The first element of a name directly inside another.
pub(crate) fn child<'a, 'd>(
    node: roxmltree::Node<'a, 'd>,
    name: &str,
) -> Option<roxmltree::Node<'a, 'd>> {
    children(node, name).next()
}

/// The text of an element, without white space at its ends.
pub(crate) fn text<'a>(node: roxmltree::Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// Looks at the tags alone, before anything is built.
fn guard(text: &str, writer: &Writer) -> Result<(), Fault> {
    let mut depth = 0_usize;
    let mut rest = text;
    let line = |rest: &str| {
        let read = text.get(..text.len() - rest.len()).unwrap_or_default();
        1 + read.bytes().filter(|byte| *byte == b'\n').count() as u64
    };
    while let Some(start) = rest.find('<') {
        let tag = rest.get(start..).unwrap_or_default();
        let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")]
            .into_iter()
            .find(|(begin, _)| tag.starts_with(begin));
        let end = match skipped {
            Some((begin, end)) => {
                let inside = tag.get(begin.len()..).unwrap_or_default();
                inside.find(end).map(|at| begin.len() + at + end.len())
            }
            None => end_of_tag(tag),
        };
        // What has no end is no XML, which the parser says with its place.
        let Some((head, after)) = end.and_then(|end| tag.split_at_checked(end)) else {
            return Ok(());
        };
        if skipped.is_none() && !head.starts_with("<!") {
            let attributes = head.bytes().filter(|&byte| byte == b'=').count();
            let is_foreign = head.len() > writer.longest_tag
                || attributes > writer.most_attributes
                || (!writer.has_namespaces && head.contains("xmlns"));
            if is_foreign {
                let what = match writer.name {
                    Some(name) => {
                        format!("a tag that {name} does not write: '{}'", shown(head))
                    }
                    None => format!("a tag of {} bytes", head.len()),
                };
                return Err(Fault::at(line(tag), what, writer.if_foreign));
            }
            if head.starts_with("</") {
                depth = depth.saturating_sub(1);
            } else if !head.ends_with("/>") {
                depth += 1;
            }
            if depth > MAX_DEPTH {
                let what = format!("elements nested deeper than {MAX_DEPTH}");
                return Err(Fault::at(
                    line(tag),
                    what,
                    "check that it is the right file",
                ));
            }
        }
        rest = after;
    }
    Ok(())
}

/// The offset behind the `>` of a tag, quoted ones left out.
fn end_of_tag(tag: &str) -> Option<usize> {
    let mut quote = None;
    for (at, byte) in tag.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Some(at + 1),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bombs_are_refused_at_once() {
        for unit in ["<a>", "<a b='/>'>", "<a b=\"</a>\">", "<a><!--</a>-->"] {
            let fault = parse(&unit.repeat(100_000)).unwrap_err();
            assert!(
                fault.what.starts_with("elements nested deeper than 64"),
                "{unit} {fault}"
            );
        }
        let laughs = "<!DOCTYPE l [<!ENTITY l \"lol\">]><a>&l;</a>";
        assert!(parse(laughs).unwrap_err().what.contains("document type"));
        let attributes: String = (0..10_000).map(|i| format!("a{i}='' ")).collect();
        let fault = parse(&format!("<a>\n<b {attributes}/></a>")).unwrap_err();
        assert_eq!(fault.line, Some(2));
        assert!(fault.what.starts_with("a tag of"), "{fault}");
    }

    #[test]
    fn faults_have_their_line() {
        let fault = parse("<a>\n<b>\n</a>").unwrap_err();
        assert_eq!(fault.line, Some(3));
        assert!(parse("").is_err() && parse("<").is_err());
        let document = parse("<a>\n<b/></a>").unwrap();
        let b = document
            .descendants()
            .find(|node| node.has_tag_name("b"))
            .unwrap();
        assert_eq!(line_of(b), 2);
    }
}
