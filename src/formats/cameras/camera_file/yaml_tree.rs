//! YAML as a small tree in which every node knows its line and its tag.
//!
//! Written from YAML 1.2.2 (yaml.org/spec) as `saphyr-parser` turns it into events, with the limits
//! that a camera file keeps and a hostile one breaks:
//!
//! - Only the first document of a stream is read: `rostopic echo` goes on for ever.
//! - Aliases (`*name`) are refused: no camera file has them, and a chain of them doubles at every
//!   link.
//! - Nesting ends at [`MAX_DEPTH`], values at [`MAX_NODES`]. Building takes no recursion.
//! - A key that stands twice in a mapping is an error, as the specification (3.2.1.1) has it.
//! - OpenCV begins its files with `%YAML:1.0`, which is no directive of YAML's (that would be
//!   `%YAML 1.0`); OpenCV 2 then leaves the `---` out. The line counts, but is not read.
//!
//! Scalars stay text: whether `1.` or `yes` is a number or a word, who asks for it says.

use std::borrow::Cow;
use std::collections::HashSet;

use saphyr_parser::{Event, Parser, Tag};

use crate::fault::Fault;

/// How deep sequences and mappings may lie in each other.
pub(super) const MAX_DEPTH: usize = 64;
/// How many values a file may hold; OpenCV's list of all corners of 1000 boards has 200 000.
pub(super) const MAX_NODES: usize = 1_000_000;

/// What the name of YAML's own tags, written `!!name`, begins with.
const CORE_TAG: &str = "tag:yaml.org,2002:";

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    /// Where it begins, counted from 1.
    pub(super) line: u64,
    /// `opencv-matrix` for `!!opencv-matrix`, `!name` for `!name`.
    pub(super) tag: Option<String>,
    /// What it is.
    pub(super) value: Value,
}

/// What a node is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    /// A text without its quotes.
    Scalar(String),
    /// A list.
    Sequence(Vec<Node>),
    /// Keys and values in the file's order; no key stands twice.
    Mapping(Vec<Entry>),
}

/// A key and its value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    /// The key without its quotes.
    pub(super) key: String,
    /// Where the key is, counted from 1.
    pub(super) line: u64,
    /// Its value.
    pub(super) node: Node,
}

/// Whether a text begins as OpenCV begins its YAML files.
pub(super) fn has_opencv_directive(text: &str) -> bool {
    text.starts_with("%YAML:")
}

/// The first document of a YAML stream.
///
/// # Errors
/// Where it is no YAML, or breaks one of the limits above.
pub(super) fn first_document(text: &str) -> Result<Node, Fault> {
    let yaml = if has_opencv_directive(text) {
        // From the end of the line on, so that the lines still count from the same place.
        let end = text.find(['\n', '\r']).unwrap_or(text.len());
        text.get(end..).unwrap_or_default()
    } else {
        text
    };
    let mut open: Vec<Open> = Vec::new();
    let mut root = None;
    let mut nodes = 0;
    let mut ended = false;
    for event in Parser::new_from_str(yaml) {
        let (event, span) = event.map_err(|e| {
            let what = format!("it is not valid YAML ({})", e.info());
            Fault::at(e.marker().line() as u64, what, "mend the file there")
        })?;
        // One event beyond the end: it shows whether the next document begins as one.
        if ended {
            break;
        }
        let line = span.start.line() as u64;
        let finished = match event {
            Event::Nothing
            | Event::StreamStart
            | Event::DocumentStart(_)
            | Event::DocumentEnd
            | Event::StreamEnd => {
                ended = root.is_some();
                continue;
            }
            Event::Alias(_) => {
                let remedy = "write the value itself in its place";
                return Err(Fault::at(line, "a YAML alias (*name)", remedy));
            }
            Event::Scalar(text, _, _, tag) => {
                Node::new(line, tag, Value::Scalar(text.into_owned()))
            }
            Event::SequenceStart(_, tag) => {
                let node = Node::new(line, tag, Value::Sequence(Vec::new()));
                Open::push(&mut open, node)?;
                continue;
            }
            Event::MappingStart(_, tag) => {
                let node = Node::new(line, tag, Value::Mapping(Vec::new()));
                Open::push(&mut open, node)?;
                continue;
            }
            Event::SequenceEnd | Event::MappingEnd => match open.pop() {
                Some(closed) => closed.node,
                None => continue,
            },
        };
        nodes += 1;
        if nodes > MAX_NODES {
            return Err(Fault::at(
                line,
                format!("more than {MAX_NODES} values: this is no camera file"),
                "give the file of the camera alone",
            ));
        }
        match open.last_mut() {
            Some(parent) => parent.add(finished)?,
            None => root = Some(finished),
        }
    }
    root.ok_or_else(|| Fault::new("the file is empty", "check that it is the right one"))
}

/// A sequence or mapping whose end has not come yet.
struct Open {
    node: Node,
    /// The key that waits for its value.
    key: Option<(String, u64)>,
    /// The keys so far.
    keys: HashSet<String>,
}

impl Open {
    fn push(open: &mut Vec<Self>, node: Node) -> Result<(), Fault> {
        if open.len() >= MAX_DEPTH {
            return Err(too_deep(node.line));
        }
        open.push(Self {
            node,
            key: None,
            keys: HashSet::new(),
        });
        Ok(())
    }

    fn add(&mut self, node: Node) -> Result<(), Fault> {
        match (&mut self.node.value, self.key.take()) {
            (Value::Mapping(entries), Some((key, line))) => entries.push(Entry { key, line, node }),
            (Value::Mapping(_), None) => {
                let Value::Scalar(key) = node.value else {
                    let remedy = "give the file of the camera alone";
                    return Err(Fault::at(node.line, "a key that is no single word", remedy));
                };
                if !self.keys.insert(key.clone()) {
                    return Err(twice(node.line, &key));
                }
                self.key = Some((key, node.line));
            }
            (Value::Sequence(items), _) => items.push(node),
            (Value::Scalar(_), _) => {}
        }
        Ok(())
    }
}

/// The fault of a file nested beyond [`MAX_DEPTH`].
pub(super) fn too_deep(line: u64) -> Fault {
    let what = format!("nested deeper than {MAX_DEPTH} levels: this is no camera file");
    Fault::at(line, what, "check that it is the right one")
}

/// The fault of a key that stands twice.
pub(super) fn twice(line: u64, key: &str) -> Fault {
    let what = format!("the key {} stands twice", quoted(key));
    Fault::at(line, what, "remove the wrong one")
}

/// A value as a message shows it: in quotes, cut where it is long.
pub(super) fn quoted(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("'{}...'", text.get(..end).unwrap_or_default()),
        None => format!("'{text}'"),
    }
}

impl Node {
    fn new(line: u64, tag: Option<Cow<'_, Tag>>, value: Value) -> Self {
        let tag = tag.map(|tag| {
            let full = format!("{}{}", tag.handle, tag.suffix);
            full.strip_prefix(CORE_TAG).map_or(full.clone(), Into::into)
        });
        Self { line, tag, value }
    }

    /// The entry of a key, `None` where there is none or this is no mapping.
    pub(super) fn get(&self, key: &str) -> Option<&Entry> {
        let Value::Mapping(entries) = &self.value else {
            return None;
        };
        entries.iter().find(|entry| entry.key == key)
    }

    /// The entries of a mapping that is called `name` in the message.
    ///
    /// # Errors
    /// Where it is none.
    pub(super) fn entries(&self, name: &str, remedy: &str) -> Result<&[Entry], Fault> {
        match &self.value {
            Value::Mapping(entries) => Ok(entries),
            _ => {
                let what = format!("{name} is {}, not keys with values", self.kind());
                Err(Fault::at(self.line, what, remedy))
            }
        }
    }

    /// A text, white space around it left out.
    ///
    /// # Errors
    /// Where it is a list or a mapping.
    pub(super) fn text(&self, name: &str) -> Result<&str, Fault> {
        match &self.value {
            Value::Scalar(text) => Ok(text.trim()),
            _ => {
                let what = format!("{name} is {}, not a single value", self.kind());
                Err(Fault::at(self.line, what, "write one value there"))
            }
        }
    }

    /// A finite number.
    ///
    /// # Errors
    /// Where it is none.
    pub(super) fn number(&self, name: &str) -> Result<f64, Fault> {
        let text = self.text(name)?;
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| {
            let what = format!("{name} is {}, not a finite number", quoted(text));
            Fault::at(self.line, what, "write a number there")
        })
    }

    /// A whole number from 0 on.
    ///
    /// # Errors
    /// Where it is none.
    pub(super) fn whole(&self, name: &str) -> Result<u32, Fault> {
        let text = self.text(name)?;
        text.parse().map_err(|_| {
            let what = format!("{name} is {}, not a whole number from 0 on", quoted(text));
            Fault::at(self.line, what, "write a whole number there")
        })
    }

    /// A list of finite numbers.
    ///
    /// # Errors
    /// Where it is none, or one of its members is no finite number.
    pub(super) fn numbers(&self, name: &str) -> Result<Vec<f64>, Fault> {
        let Value::Sequence(items) = &self.value else {
            let what = format!("{name} is {}, not a list of numbers", self.kind());
            let remedy = "write the numbers as text, in brackets and without base64";
            return Err(Fault::at(self.line, what, remedy));
        };
        let named = |(index, item): (usize, &Self)| item.number(&format!("{name}[{index}]"));
        items.iter().enumerate().map(named).collect()
    }

    /// What the node is, for messages.
    fn kind(&self) -> String {
        match &self.value {
            Value::Scalar(text) if text.is_empty() => "empty".to_owned(),
            Value::Scalar(text) => quoted(text),
            Value::Sequence(_) => "a list".to_owned(),
            Value::Mapping(_) => "a mapping".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn fault(text: &str) -> (Option<u64>, String) {
        let fault = first_document(text).map(drop).unwrap_err();
        (fault.line, fault.what)
    }

    #[test]
    fn the_tree_of_both_styles() {
        let text =
            "a: 1.\nb:\n- x\n- \"y z\"\nc: !!opencv-matrix\n   rows: 3\nd: !mine {e: [2, 3]}\n";
        let tree = first_document(text).unwrap();
        assert_eq!(tree.line, 1);
        assert_eq!(tree.get("a").unwrap().node.number("a"), Ok(1.0));
        let b = tree.get("b").unwrap();
        assert_eq!((b.line, b.node.line), (2, 3));
        let Value::Sequence(items) = &b.node.value else {
            panic!("{b:?}");
        };
        assert_eq!(items[1].text("b[1]"), Ok("y z"));
        assert_eq!(items[1].line, 4);
        let c = &tree.get("c").unwrap().node;
        assert_eq!((c.line, c.tag.as_deref()), (5, Some("opencv-matrix")));
        assert_eq!(c.get("rows").unwrap().node.whole("rows"), Ok(3));
        let d = &tree.get("d").unwrap().node;
        assert_eq!((d.line, d.tag.as_deref()), (7, Some("!mine")));
        let e = &d.get("e").unwrap().node;
        assert_eq!(e.numbers("e"), Ok(vec![2.0, 3.0]));
        assert_eq!(tree.get("f"), None);
        assert_eq!(items[0].get("x"), None);
    }

    #[test]
    fn opencv_begins_with_a_line_that_is_no_yaml() {
        for text in [
            "%YAML:1.0\n---\na: 1\n",
            "%YAML:1.0\na: 1",
            "%YAML:1.0\r\n---\r\na: 1\r\n",
        ] {
            let tree = first_document(text).unwrap();
            assert_eq!(tree.get("a").unwrap().node.text("a"), Ok("1"), "{text:?}");
        }
        let tree = first_document("%YAML:1.0\r\n---\r\na: 1\r\n").unwrap();
        assert_eq!(tree.get("a").unwrap().line, 3);
        assert_eq!(fault("%YAML:1.0").1, "the file is empty");
        assert_eq!(fault("").1, "the file is empty");
    }

    #[test]
    fn only_the_first_document() {
        let tree = first_document("a: 1\n---\nb: [unfinished").unwrap();
        assert!(tree.get("a").is_some() && tree.get("b").is_none());
        assert_eq!(fault("{a: 1} left over").0, Some(1));
    }

    #[test]
    fn bombs_are_refused_at_once() {
        let laughs = "a: &a [x, x]\nb: &b [*a, *a]\nc: &c [*b, *b]\n";
        assert_eq!(fault(laughs), (Some(2), "a YAML alias (*name)".into()));
        for (unit, line) in [("[", 1), ("{a: ", 1), ("- ", 1), ("? ", 1)] {
            let (at, what) = fault(&unit.repeat(100_000));
            assert_eq!(at, Some(line), "{unit:?} {what}");
            // Of unclosed brackets the scanner reads ahead, up to a limit of its own.
            let limits = [
                "nested deeper than 64",
                "it is not valid YAML (recursion limit",
            ];
            assert!(limits.iter().any(|limit| what.starts_with(limit)), "{what}");
        }
        let stairs: String = (0..1000)
            .map(|i| format!("{}a:\n", " ".repeat(i)))
            .collect();
        assert_eq!(fault(&stairs).0, Some(65));
        let (_, what) = fault(&format!("{}{}", "[".repeat(65), "]".repeat(65)));
        assert!(what.starts_with("nested deeper than 64"), "{what}");
        let deepest = format!("{}{}", "[".repeat(64), "]".repeat(64));
        assert!(first_document(&deepest).is_ok());
        let (_, what) = fault(&format!("[{}]", "1,".repeat(1_000_001)));
        assert!(what.starts_with("more than 1000000 values"), "{what}");
    }

    #[test]
    fn a_key_stands_once_and_is_a_word() {
        assert_eq!(
            fault("a: 1\nb:\n  x: 1\na: 2\n"),
            (Some(4), "the key 'a' stands twice".into())
        );
        assert_eq!(fault("? [1]\n: 2").1, "a key that is no single word");
    }

    #[test]
    fn what_is_no_number_is_named() {
        let tree = first_document("a: [1, .nan]\nb: 1e999\nc: -1\nd: {}\ne:\nf: [[1]]").unwrap();
        let node = |key| &tree.get(key).unwrap().node;
        let what = |result: Result<_, Fault>| result.unwrap_err().what;
        assert_eq!(
            what(node("a").numbers("A").map(drop)),
            "A[1] is '.nan', not a finite number"
        );
        assert_eq!(
            what(node("b").number("B").map(drop)),
            "B is '1e999', not a finite number"
        );
        assert_eq!(
            what(node("c").whole("C").map(drop)),
            "C is '-1', not a whole number from 0 on"
        );
        assert_eq!(
            what(node("d").text("D").map(drop)),
            "D is a mapping, not a single value"
        );
        assert_eq!(
            what(node("e").numbers("E").map(drop)),
            "E is empty, not a list of numbers"
        );
        assert_eq!(
            what(node("f").numbers("F").map(drop)),
            "F[0] is a list, not a single value"
        );
        assert_eq!(
            what(node("a").entries("A", "mend it").map(drop)),
            "A is a list, not keys with values"
        );
        let long = quoted(&"é".repeat(1000));
        assert_eq!(long.chars().count(), 45);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,80}") {
            let _ = first_document(&text);
        }

        #[test]
        fn any_heap_of_indicators_is_read_or_refused(
            text in "([-?:,\\[\\]{}#&*!|>'\"%@` \t\r\nab1]|---|\\.\\.\\.|: |- |\u{feff}){0,60}"
        ) {
            let _ = first_document(&text);
        }
    }
}
