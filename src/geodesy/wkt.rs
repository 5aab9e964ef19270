//! Well-known text (WKT) as a tree: versions 1 (OGC 01-009, with ESRI's and GDAL's habits) and 2
//! (ISO 19162), brackets square or round. What the words mean is told in `definition/of_wkt.rs`.

use crate::fault::Fault;

/// Deeper than any system is nested; a hostile file must not exhaust the stack.
const DEEPEST: usize = 24;

/// A keyword with what stands in its brackets.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node<'a> {
    /// In capitals.
    pub(super) keyword: String,
    values: Vec<Value<'a>>,
}

#[derive(Debug, Clone, PartialEq)]
enum Value<'a> {
    /// Between quotes, as written.
    Quoted(&'a str),
    /// A number, or a word such as EAST.
    Bare(&'a str),
    Node(Node<'a>),
}

impl<'a> Node<'a> {
    /// Reads the tree, or the trees that commas separate (ESRI appends the vertical system so).
    pub(super) fn parse(text: &'a str) -> Result<Vec<Self>, Fault> {
        let mut reader = Reader { rest: text };
        let mut roots = Vec::new();
        loop {
            match reader.value(0)? {
                Value::Node(node) => roots.push(node),
                _ => return Err(cut()),
            }
            reader.skip_space();
            if reader.rest.is_empty() {
                return Ok(roots);
            }
            if !reader.take(',') {
                return Err(cut());
            }
        }
    }

    /// The nodes directly inside.
    pub(super) fn nodes(&self) -> impl Iterator<Item = &Node<'a>> {
        self.values.iter().filter_map(|value| match value {
            Value::Node(node) => Some(node),
            _ => None,
        })
    }

    /// The first node inside that has one of the keywords.
    pub(super) fn child(&self, keywords: &[&str]) -> Option<&Node<'a>> {
        self.nodes()
            .find(|node| keywords.contains(&node.keyword.as_str()))
    }

    /// What stands at a place between the brackets, unless it is a node.
    pub(super) fn word(&self, index: usize) -> Option<&'a str> {
        match self.values.get(index)? {
            Value::Quoted(word) | Value::Bare(word) => Some(word),
            Value::Node(_) => None,
        }
    }

    pub(super) fn number(&self, index: usize) -> Option<f64> {
        self.word(index)?.parse().ok()
    }

    /// Its own code of EPSG, not that of its parts.
    pub(super) fn epsg_code(&self) -> Option<u32> {
        let own = self.nodes().find(|node| {
            ["AUTHORITY", "ID"].contains(&node.keyword.as_str())
                && node
                    .word(0)
                    .is_some_and(|name| name.eq_ignore_ascii_case("EPSG"))
        });
        own?.word(1)?.trim().parse().ok()
    }

    /// The text again: keywords in capitals, square brackets, no white space between.
    pub(super) fn to_text(&self) -> String {
        let values: Vec<String> = (self.values.iter())
            .map(|value| match value {
                Value::Quoted(word) => format!("\"{word}\""),
                Value::Bare(word) => (*word).to_owned(),
                Value::Node(node) => node.to_text(),
            })
            .collect();
        format!("{}[{}]", self.keyword, values.join(","))
    }
}

struct Reader<'a> {
    rest: &'a str,
}

impl<'a> Reader<'a> {
    fn skip_space(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn take(&mut self, wanted: char) -> bool {
        self.skip_space();
        match self.rest.strip_prefix(wanted) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    /// The text up to where `ends` says; the rest stays.
    fn until(&mut self, ends: impl Fn(char) -> bool) -> &'a str {
        let end = self.rest.find(ends).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        word
    }

    fn quoted(&mut self) -> Result<&'a str, Fault> {
        let start = self.rest;
        let mut length = 0;
        loop {
            length += self.until(|c| c == '"').len();
            self.rest = self.rest.strip_prefix('"').ok_or_else(cut)?;
            match self.rest.strip_prefix('"') {
                // A doubled quote is one quote in the text.
                Some(rest) => {
                    self.rest = rest;
                    length += 2;
                }
                None => return Ok(start.get(..length).unwrap_or_default()),
            }
        }
    }

    fn value(&mut self, depth: usize) -> Result<Value<'a>, Fault> {
        if depth > DEEPEST {
            return Err(Fault::new(
                format!("the well-known text is nested deeper than {DEEPEST} brackets"),
                REMEDY,
            ));
        }
        if self.take('"') {
            return Ok(Value::Quoted(self.quoted()?));
        }
        let word = self.until(|c| "[](),\"".contains(c)).trim_end();
        if word.is_empty() {
            return Err(cut());
        }
        if !self.rest.starts_with(['[', '(']) {
            return Ok(Value::Bare(word));
        }
        self.rest = self.rest.get(1..).unwrap_or_default();
        let mut values = Vec::new();
        loop {
            values.push(self.value(depth + 1)?);
            if self.take(']') || self.take(')') {
                break;
            }
            if !self.take(',') {
                return Err(cut());
            }
        }
        Ok(Value::Node(Node {
            keyword: word.to_ascii_uppercase(),
            values,
        }))
    }
}

pub(super) const REMEDY: &str = "give the coordinate system as \"EPSG:n\"";

fn cut() -> Fault {
    Fault::new(
        "the well-known text of the coordinate system is broken off or malformed",
        REMEDY,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_reads_back() {
        let text = r#"PROJCS["a ""b"", [c]",GEOGCS["g",UNIT["degree",0.0174]],AXIS["X",EAST],AUTHORITY["EPSG","7"]]"#;
        let roots = Node::parse(text).unwrap();
        assert_eq!(roots[0].to_text(), text);
        assert_eq!(roots[0].epsg_code(), Some(7));
        let round = "projcs ( \"g\" ,\n UNIT(\"m\", 1) ) , VERTCS[\"h\",UNIT[\"m\",1.0]] \r\n";
        let roots = Node::parse(round).unwrap();
        assert_eq!(roots.len(), 2);
        assert_eq!(roots[0].to_text(), "PROJCS[\"g\",UNIT[\"m\",1]]");
        assert_eq!(roots[0].child(&["UNIT"]).unwrap().number(1), Some(1.0));
    }

    #[test]
    fn what_is_cut_is_refused() {
        let text = r#"PROJCS["a",GEOGCS["g",UNIT["degree",0.0174]],AXIS["X",EAST]]"#;
        for end in 0..text.len() {
            assert!(Node::parse(&text[..end]).is_err(), "{end}");
        }
        assert!(Node::parse(&format!("{text} and more")).is_err());
        assert!(Node::parse(&"A[".repeat(1_000_000)).is_err());
        assert!(Node::parse("A[]").is_err());
    }
}
