//! XML (1.0, namespaces) as a tree, guarded: `roxmltree` refuses document types with their entities,
//! and takes time in the square of a tag's attributes and of nested namespaces, so long tags and
//! deep nesting are refused before it sees them.

use roxmltree::Document;

use crate::fault::Fault;

/// How long a tag may be, in bytes.
const MAX_TAG: usize = 20_000;

/// How deep elements may nest.
const MAX_DEPTH: usize = 64;

/// The tree of an XML text.
///
/// # Errors
/// Where it is no XML, has a document type, or tags that are too deep or too long.
pub(crate) fn parse(text: &str) -> Result<Document<'_>, Fault> {
    guard(text)?;
    Document::parse(text).map_err(|error| match error {
        roxmltree::Error::DtdDetected => Fault::new(
            "it has a document type (<!DOCTYPE>), which files of this kind have not",
            "remove it",
        ),
        error => Fault::at(
            u64::from(error.pos().row),
            format!("it is not valid XML ({error})"),
            "the file is cut off or damaged: export it again",
        ),
    })
}

/// The line, from 1, on which a node begins.
pub(crate) fn line_of(node: roxmltree::Node<'_, '_>) -> u64 {
    u64::from(node.document().text_pos_at(node.range().start).row)
}

/// Looks at the tags alone, before anything is built.
fn guard(text: &str) -> Result<(), Fault> {
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
        if skipped.is_none() {
            if head.len() > MAX_TAG {
                let what = format!("a tag of {} bytes", head.len());
                return Err(Fault::at(
                    line(tag),
                    what,
                    "check that it is the right file",
                ));
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
pub(crate) fn end_of_tag(tag: &str) -> Option<usize> {
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
