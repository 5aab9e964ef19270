//! OpenCV's XML as the tree that its YAML makes.
//!
//! Written from OpenCV's `persistence_xml.cpp`:
//!
//! - The root is `<opencv_storage>`; an element with elements inside is a mapping, one whose
//!   elements are called `_` a list; the attribute `type_id` is the tag.
//! - Text is one value, or a list of values with white space between them; `"..."` is one value.
//!
//! Depth, namespaces and long tags, which OpenCV writes none of, are refused before it is parsed.

use std::collections::HashSet;

use crate::fault::Fault;
use crate::text::xml_document::{Writer, parse_of};

use super::yaml_tree::{Entry, Node, Value, quoted, twice};

/// What to do about XML of others.
const OPENCV_ONLY: &str = "give the XML that OpenCV's calibration wrote";

/// OpenCV's tags have one attribute.
const OPENCV: Writer = Writer {
    name: Some("OpenCV"),
    if_damaged: "mend the file there",
    if_foreign: OPENCV_ONLY,
    longest_tag: 1000,
    most_attributes: usize::MAX,
    has_namespaces: false,
    most_nodes: 1_000_000,
};

/// The tree of an OpenCV XML.
///
/// # Errors
/// Where the text is no XML, or not OpenCV's.
pub(super) fn tree(text: &str) -> Result<Node, Fault> {
    let document = parse_of(text, &OPENCV)?;
    let root = document.root_element();
    if root.tag_name().name() != "opencv_storage" {
        let name = quoted(root.tag_name().name());
        return Err(Fault::new(
            format!("the XML is of {name}, not of 'opencv_storage'"),
            OPENCV_ONLY,
        ));
    }
    let mut lines = Lines {
        text,
        offset: 0,
        line: 1,
    };
    element(root, &mut lines)
}

/// One element; recursion ends where [`parse_of`] refuses to go deeper.
fn element(xml: roxmltree::Node<'_, '_>, lines: &mut Lines<'_>) -> Result<Node, Fault> {
    let line = lines.at(xml.range().start);
    let tag = xml.attribute("type_id").map(ToOwned::to_owned);
    let mut elements = xml
        .children()
        .filter(roxmltree::Node::is_element)
        .peekable();
    let value = match elements.peek().map(|first| first.tag_name().name()) {
        Some("_") => {
            let items: Result<_, Fault> = elements.map(|item| element(item, lines)).collect();
            Value::Sequence(items?)
        }
        Some(_) => {
            let mut entries = Vec::new();
            let mut keys = HashSet::new();
            for child in elements {
                let node = element(child, lines)?;
                let (key, line) = (child.tag_name().name(), node.line);
                if !keys.insert(key) {
                    return Err(twice(line, key));
                }
                let key = key.to_owned();
                entries.push(Entry { key, line, node });
            }
            Value::Mapping(entries)
        }
        None => {
            let parts = xml
                .children()
                .filter_map(|part| part.text().filter(|_| part.is_text()));
            words(&parts.collect::<Vec<_>>().join(" "), line)
        }
    };
    Ok(Node { line, tag, value })
}

/// The value or values of a text.
fn words(text: &str, line: u64) -> Value {
    let text = text.trim();
    if let Some(inside) = text.strip_prefix('"') {
        return Value::Scalar(inside.strip_suffix('"').unwrap_or(inside).to_owned());
    }
    if !text.contains(char::is_whitespace) {
        return Value::Scalar(text.to_owned());
    }
    let scalar = |word: &str| Node {
        line,
        tag: None,
        value: Value::Scalar(word.to_owned()),
    };
    Value::Sequence(text.split_whitespace().map(scalar).collect())
}

/// Counts lines along with offsets that only grow.
struct Lines<'a> {
    text: &'a str,
    offset: usize,
    line: u64,
}

impl Lines<'_> {
    fn at(&mut self, offset: usize) -> u64 {
        let passed = self.text.as_bytes().get(self.offset..offset);
        let breaks = passed.unwrap_or_default().iter().filter(|b| **b == b'\n');
        self.line += breaks.count() as u64;
        self.offset = offset;
        self.line
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::text::xml_document::MAX_DEPTH;

    fn fault(text: &str) -> (Option<u64>, String) {
        let fault = tree(text).unwrap_err();
        (fault.line, fault.what)
    }

    #[test]
    fn the_tree_is_that_of_the_yaml() {
        let text = "<?xml version=\"1.0\"?>\n<!-- <a> -->\n<opencv_storage>\n<a>1.</a>\n\
            <m type_id=\"opencv-matrix\">\n  <rows>3</rows></m>\n<list>\n 1 2\n <!-- x --> 3</list>\n\
            <seq><_>x</_>\n<_><y>\"a &lt; b\"</y></_></seq>\n<empty></empty></opencv_storage>";
        let tree = tree(text).unwrap();
        assert_eq!(tree.line, 3);
        let node = |key| &tree.get(key).unwrap().node;
        assert_eq!(node("a").number("a"), Ok(1.0));
        assert_eq!(
            (node("m").line, node("m").tag.as_deref()),
            (5, Some("opencv-matrix"))
        );
        assert_eq!(node("m").get("rows").unwrap().line, 6);
        assert_eq!(node("list").numbers("list"), Ok(vec![1.0, 2.0, 3.0]));
        let Value::Sequence(items) = &node("seq").value else {
            panic!("{:?}", node("seq"));
        };
        assert_eq!(items[0].text("x"), Ok("x"));
        assert_eq!(items[1].line, 11);
        assert_eq!(items[1].get("y").unwrap().node.text("y"), Ok("a < b"));
        assert_eq!(node("empty").text("empty"), Ok(""));
    }

    #[test]
    fn bombs_are_refused_at_once() {
        let laughs = "<?xml version=\"1.0\"?>\n<!DOCTYPE lolz [<!ENTITY lol \"lol\">]>\n\
            <opencv_storage>&lol;</opencv_storage>";
        assert!(fault(laughs).1.starts_with("it has a document type"));
        for unit in [
            "<a>",
            "<_>",
            "<a b='/>'>",
            "<a b=\"</a>\">",
            "<a><!--</a>-->",
        ] {
            let (line, what) = fault(&unit.repeat(100_000));
            assert_eq!(line, Some(1), "{unit} {what}");
            assert!(
                what.starts_with("elements nested deeper than 64"),
                "{unit} {what}"
            );
        }
        let spaces: String = (0..60_000)
            .map(|i| format!("<a xmlns:n{i}='x'>\n"))
            .collect();
        assert!(
            fault(&spaces)
                .1
                .starts_with("a tag that OpenCV does not write: '<a xmlns:n0=")
        );
        let attributes: String = (0..1000).map(|i| format!("a{i}='' ")).collect();
        let (line, what) = fault(&format!("<opencv_storage>\n<a {attributes}/>"));
        assert!(
            line == Some(2) && what.starts_with("a tag that OpenCV"),
            "{what}"
        );
        // Not deep, only long.
        let flat = format!("<opencv_storage>{}</opencv_storage>", "<a/>".repeat(1000));
        assert_eq!(fault(&flat).1, "the key 'a' stands twice");
        let wide = format!(
            "<opencv_storage>{}</opencv_storage>",
            "<_/>".repeat(1_000_000)
        );
        assert!(fault(&wide).1.contains("nodes limit reached"));
    }

    #[test]
    fn the_deepest_that_is_read() {
        let depth = MAX_DEPTH - 1;
        let nest = |depth| format!("{}{}", "<a>".repeat(depth), "</a>".repeat(depth));
        let text = format!("<opencv_storage>{}</opencv_storage>", nest(depth));
        assert!(tree(&text).is_ok());
        let text = format!("<opencv_storage>{}</opencv_storage>", nest(depth + 1));
        assert!(tree(&text).is_err());
    }

    #[test]
    fn what_is_not_opencv_is_named() {
        assert_eq!(
            fault("<document><a/></document>").1,
            "the XML is of 'document', not of 'opencv_storage'"
        );
        let (line, what) = fault("<opencv_storage>\n<a>\n</b></opencv_storage>");
        assert_eq!(line, Some(3));
        assert!(
            what.starts_with("it is not valid XML (expected 'a' tag"),
            "{what}"
        );
        assert!(tree("").is_err() && tree("<").is_err() && tree("a < b").is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,80}") {
            let _ = tree(&text);
        }

        #[test]
        fn any_heap_of_tags_is_read_or_refused(
            text in "<opencv_storage>(<[ab_]>|</[ab_]>|<a/>|<!--|-->|&lt;|&x;|\"|é|<!\\[CDATA\\[|\\]\\]>| b='|1 )\
                {0,20}</opencv_storage>"
        ) {
            let _ = tree(&text);
        }
    }
}
