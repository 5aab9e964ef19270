//! An XMP packet (ISO 16684-1) as a flat table of its simple values.
//!
//! Inside `rdf:RDF`, every `rdf:Description` holds properties, as attributes or as child elements,
//! and there may be several of them. A property is a text, a list (`rdf:Seq`, `rdf:Bag`, `rdf:Alt`,
//! whose items are joined by commas here), or a structure: fields as the element's own attributes,
//! as its children (`rdf:parseType="Resource"`), or in an `rdf:Description` inside. A structure's
//! field is called "property/field".
//!
//! Namespaces are told apart by their URI, because writers choose prefixes as they like: Pix4D's
//! ends with and without a slash, Autel's differs between firmwares.

use std::collections::HashMap;

use roxmltree::{Document, Node, ParsingOptions};

const RDF: &str = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";

/// The most elements and attributes that a packet may have; cameras write a hundred.
const MOST_NODES: u32 = 100_000;

/// Whose field a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Vocabulary {
    /// <http://www.dji.com/drone-dji/1.0/>
    Dji,
    /// Autel's, which has the names of DJI's fields and the prefix "drone".
    Autel,
    /// <http://pix4d.com/camera/1.0/>, which many makers write.
    Pix4dCamera,
    /// <http://ns.sensefly.com/Camera/1.0/>
    SenseFlyCamera,
    /// <http://www.parrot.com/drone-parrot/1.0/>
    Parrot,
    /// Skydio's.
    Skydio,
    /// <http://ns.adobe.com/tiff/1.0/>
    Tiff,
}

impl Vocabulary {
    fn of(uri: &str, prefix: Option<&str>) -> Option<Self> {
        let uri = uri.to_ascii_lowercase();
        let has = |part: &str| uri.contains(part);
        Some(if has("dji.com") {
            Self::Dji
        } else if has("pix4d.com/camera") {
            Self::Pix4dCamera
        } else if has("sensefly.com/camera") {
            Self::SenseFlyCamera
        } else if has("parrot.com") {
            Self::Parrot
        } else if has("skydio") {
            Self::Skydio
        } else if has("ns.adobe.com/tiff") {
            Self::Tiff
        } else if has("autel") || matches!(prefix, Some("drone" | "drone-autel")) {
            Self::Autel
        } else if matches!(prefix, Some("Camera" | "camera")) {
            Self::Pix4dCamera
        } else {
            return None;
        })
    }
}

/// The values of a photo's packets.
#[derive(Debug, Default)]
pub(super) struct Xmp {
    values: HashMap<(Vocabulary, String), String>,
}

impl Xmp {
    /// Adds the values of a packet; those that are known already stay.
    ///
    /// # Errors
    /// In words, where it is no XML.
    pub(super) fn add(&mut self, packet: &[u8]) -> Result<(), String> {
        let text = String::from_utf8_lossy(packet);
        let text = element(&text).ok_or("it has no rdf:RDF")?;
        let options = ParsingOptions {
            nodes_limit: MOST_NODES,
            ..ParsingOptions::default()
        };
        let document = Document::parse_with_options(text, options).map_err(|e| e.to_string())?;
        let is_rdf = |node: &Node<'_, '_>| node.has_tag_name((RDF, "RDF"));
        for rdf in document.descendants().filter(is_rdf) {
            for description in rdf.children().filter(Node::is_element) {
                self.properties(description);
            }
        }
        Ok(())
    }

    /// The text of a value.
    pub(super) fn text(&self, vocabulary: Vocabulary, name: &str) -> Option<&str> {
        let value = self.values.get(&(vocabulary, name.to_owned()))?;
        Some(value.as_str())
    }

    /// A value as a finite number: signed, with a fraction ("361/100"), before a unit.
    pub(super) fn number(&self, vocabulary: Vocabulary, name: &str) -> Option<f64> {
        number(self.text(vocabulary, name)?)
    }

    fn properties(&mut self, description: Node<'_, '_>) {
        self.attributes(description, "");
        for property in description.children().filter(Node::is_element) {
            let name = property.tag_name().name();
            let fields_of = format!("{name}/");
            self.attributes(property, &fields_of);
            let list = property.children().find(|child| {
                ["Seq", "Bag", "Alt"]
                    .iter()
                    .any(|kind| child.has_tag_name((RDF, *kind)))
            });
            if let Some(list) = list {
                let items = list.children().filter(Node::is_element);
                let items: Vec<&str> = items.filter_map(|item| item.text()).collect();
                self.insert(property, String::new(), name, items.join(","));
                continue;
            }
            let mut is_structure = false;
            for child in property.children().filter(Node::is_element) {
                is_structure = true;
                if child.has_tag_name((RDF, "Description")) {
                    self.attributes(child, &fields_of);
                    for field in child.children().filter(Node::is_element) {
                        self.field(field, &fields_of);
                    }
                } else {
                    self.field(child, &fields_of);
                }
            }
            if !is_structure {
                let text = property.text().unwrap_or_default().to_owned();
                self.insert(property, String::new(), name, text);
            }
        }
    }

    fn field(&mut self, field: Node<'_, '_>, path: &str) {
        let text = field.text().unwrap_or_default().to_owned();
        self.insert(field, path.to_owned(), field.tag_name().name(), text);
    }

    fn attributes(&mut self, node: Node<'_, '_>, path: &str) {
        for attribute in node.attributes() {
            let Some(uri) = attribute.namespace().filter(|uri| *uri != RDF) else {
                continue;
            };
            if let Some(vocabulary) = Vocabulary::of(uri, node.lookup_prefix(uri)) {
                let name = format!("{path}{}", attribute.name());
                let value = attribute.value().trim().to_owned();
                self.values.entry((vocabulary, name)).or_insert(value);
            }
        }
    }

    fn insert(&mut self, node: Node<'_, '_>, path: String, name: &str, value: String) {
        let Some(uri) = node.tag_name().namespace() else {
            return;
        };
        if let Some(vocabulary) = Vocabulary::of(uri, node.lookup_prefix(uri))
            && !value.trim().is_empty()
        {
            let name = path + name;
            let value = value.trim().to_owned();
            self.values.entry((vocabulary, name)).or_insert(value);
        }
    }
}

/// The packet's element, without the padding and the processing instructions around it.
fn element(text: &str) -> Option<&str> {
    for (open, close) in [("<x:xmpmeta", "</x:xmpmeta>"), ("<rdf:RDF", "</rdf:RDF>")] {
        if let Some(begin) = text.find(open) {
            let rest = text.get(begin..)?;
            let end = rest.rfind(close).map_or(rest.len(), |at| at + close.len());
            return rest.get(..end);
        }
    }
    // Whatever prefixes it has chosen.
    text.contains("RDF")
        .then(|| text.trim_matches(['\0', '\u{feff}', ' ', '\n', '\r']))
}

/// A finite number: signed, with a fraction ("361/100"), before a unit.
pub(super) fn number(text: &str) -> Option<f64> {
    let word = text.split_whitespace().next()?;
    let number = match word.split_once('/') {
        Some((above, below)) => above.parse::<f64>().ok()? / below.parse::<f64>().ok()?,
        None => word.parse::<f64>().ok()?,
    };
    number.is_finite().then_some(number)
}
