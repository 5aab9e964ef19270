//! An XMP packet (ISO 16684-1) as a flat table of its simple values.
//!
//! Inside `rdf:RDF`, every `rdf:Description` holds properties, as attributes or as child elements,
//! and there may be several of them. A property is a text, a list (`rdf:Seq`, `rdf:Bag`, `rdf:Alt`,
//! whose items are joined by commas here), or a structure: fields as the element's own attributes,
//! as its children (`rdf:parseType="Resource"`), or in an `rdf:Description` inside. A structure's
//! field is called "property/field".
//!
//! Namespaces are told apart by their URI alone, because writers choose prefixes as they like: Autel
//! writes DJI's namespace under the prefix "drone", and four makers "Camera" for three namespaces.
//! The URIs that are known, in every form that real files have them in, are listed at
//! [`Vocabulary::of`]. Of all others only the angles are noted ([`Xmp::strange_angles`]), so that a
//! photo whose angles nobody understands is said to have some.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use roxmltree::{Document, Node, ParsingOptions};

const RDF: &str = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";

/// The most elements and attributes that a packet may have; cameras write a hundred.
const MOST_NODES: u32 = 100_000;

/// Whose field a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Vocabulary {
    /// DJI's, which Autel's newer firmware writes too.
    Dji,
    /// Pix4D's, which many makers write.
    Pix4dCamera,
    /// senseFly's.
    SenseFlyCamera,
    /// `Camera/`, which is nobody's: what Exiv2 makes of the name "Camera" where a maker registered
    /// no URI. senseFly's eBee and Parrot's Bebop 2 and Disco write it, and mean different things.
    NamelessCamera,
    /// Parrot's.
    Parrot,
    /// Skydio's.
    Skydio,
    /// Adobe's, of TIFF's fields.
    Tiff,
}

/// The known namespaces, in every form that is known of files. Exiv2 adds the slash at the end to
/// those that lack it (`XmpProperties::registerNs`).
const NAMESPACES: [(&str, Vocabulary); 16] = [
    ("http://www.dji.com/drone-dji/1.0/", Vocabulary::Dji),
    ("http://www.dji.com/drone-dji/1.0", Vocabulary::Dji),
    ("https://www.dji.com/drone-dji/1.0/", Vocabulary::Dji),
    ("http://www.dji.com/drone-dji/", Vocabulary::Dji),
    ("http://pix4d.com/camera/1.0/", Vocabulary::Pix4dCamera),
    ("http://pix4d.com/camera/1.0", Vocabulary::Pix4dCamera),
    ("https://pix4d.com/camera/1.0/", Vocabulary::Pix4dCamera),
    ("https://pix4d.com/camera/1.0", Vocabulary::Pix4dCamera),
    (
        "http://ns.sensefly.com/Camera/1.0/",
        Vocabulary::SenseFlyCamera,
    ),
    (
        "http://ns.sensefly.com/Camera/1.0",
        Vocabulary::SenseFlyCamera,
    ),
    ("Camera/", Vocabulary::NamelessCamera),
    (
        "http://www.parrot.com/drone-parrot/1.0/",
        Vocabulary::Parrot,
    ),
    ("http://www.parrot.com/drone-parrot/1.0", Vocabulary::Parrot),
    (
        "https://www.skydio.com/drone-skydio/1.0/",
        Vocabulary::Skydio,
    ),
    (
        "http://www.skydio.com/drone-skydio/1.0/",
        Vocabulary::Skydio,
    ),
    ("http://ns.adobe.com/tiff/1.0/", Vocabulary::Tiff),
];

impl Vocabulary {
    fn of(uri: &str) -> Option<Self> {
        let known = NAMESPACES.iter().find(|(known, _)| *known == uri);
        known.map(|(_, vocabulary)| *vocabulary)
    }

    /// The namespace, in the form that its maker documents or writes.
    pub(super) fn uri(self) -> &'static str {
        let form = NAMESPACES.iter().find(|(_, of)| *of == self);
        form.map_or("", |(uri, _)| uri)
    }
}

/// The values of a photo's packets.
#[derive(Debug, Default)]
pub(super) struct Xmp {
    values: HashMap<(Vocabulary, String), String>,
    /// The angles' axes by the URI of a namespace that is not known.
    strange: BTreeMap<String, BTreeSet<&'static str>>,
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

    /// The URIs of the namespaces that are not known and hold angles: numbers called by two at
    /// least of yaw, pitch and roll.
    pub(super) fn strange_angles(&self) -> impl Iterator<Item = &str> {
        let axes_of = self.strange.iter();
        let angles = axes_of.filter(|(_, axes)| axes.len() >= 2);
        angles.map(|(uri, _)| uri.as_str())
    }

    fn properties(&mut self, description: Node<'_, '_>) {
        self.attributes(description, None);
        for property in description.children().filter(Node::is_element) {
            self.property(property);
        }
    }

    fn property(&mut self, property: Node<'_, '_>) {
        self.attributes(property, Some(property));
        let list = property.children().find(|child| {
            ["Seq", "Bag", "Alt"]
                .iter()
                .any(|kind| child.has_tag_name((RDF, *kind)))
        });
        if let Some(list) = list {
            let items = list.children().filter(Node::is_element);
            let items: Vec<&str> = items.filter_map(|item| item.text()).collect();
            self.insert(property, None, items.join(","));
            // Structures in a list are not told apart: the first that has a field counts.
            for item in list.children().filter(Node::is_element) {
                self.attributes(item, Some(property));
                self.fields(item, property);
            }
        } else if property.children().any(|child| child.is_element()) {
            self.fields(property, property);
        } else {
            let text = property.text().unwrap_or_default().to_owned();
            self.insert(property, None, text);
        }
    }

    /// The fields in an element of a structure, or in the rdf:Description that it holds.
    fn fields(&mut self, element: Node<'_, '_>, structure: Node<'_, '_>) {
        let field = |xmp: &mut Self, child: Node<'_, '_>| {
            let text = child.text().unwrap_or_default().to_owned();
            xmp.insert(child, Some(structure), text);
        };
        for child in element.children().filter(Node::is_element) {
            if child.has_tag_name((RDF, "Description")) {
                self.attributes(child, Some(structure));
                for inner in child.children().filter(Node::is_element) {
                    field(self, inner);
                }
            } else {
                field(self, child);
            }
        }
    }

    fn attributes(&mut self, node: Node<'_, '_>, structure: Option<Node<'_, '_>>) {
        for attribute in node.attributes() {
            if let Some(uri) = attribute.namespace() {
                let value = attribute.value().to_owned();
                self.keep(uri, attribute.name(), structure, value);
            }
        }
    }

    fn insert(&mut self, node: Node<'_, '_>, structure: Option<Node<'_, '_>>, value: String) {
        if let Some(uri) = node.tag_name().namespace() {
            self.keep(uri, node.tag_name().name(), structure, value);
        }
    }

    /// Keeps a value under its namespace and name, as a field of a structure of the same namespace.
    fn keep(&mut self, uri: &str, name: &str, structure: Option<Node<'_, '_>>, value: String) {
        let value = value.trim();
        if uri == RDF || value.is_empty() {
            return;
        }
        let Some(vocabulary) = Vocabulary::of(uri) else {
            if let Some(axis) = axis_of(name)
                && number(value).is_some()
            {
                self.strange.entry(uri.to_owned()).or_default().insert(axis);
            }
            return;
        };
        let name = match structure.map(|structure| structure.tag_name()) {
            None => name.to_owned(),
            Some(of) if of.namespace().and_then(Vocabulary::of) == Some(vocabulary) => {
                format!("{}/{name}", of.name())
            }
            // A field in somebody else's structure: nothing says what it is of.
            Some(_) => return,
        };
        let entry = self.values.entry((vocabulary, name));
        entry.or_insert_with(|| value.to_owned());
    }
}

/// Which of the three angles a name is of: "Yaw", "GimbalYawDegree", "PoseHeadingDegrees".
fn axis_of(name: &str) -> Option<&'static str> {
    let name = name.to_ascii_lowercase();
    let ends = ["degrees", "degree", "deg", "angle"];
    let name = ends
        .iter()
        .find_map(|end| name.strip_suffix(end))
        .unwrap_or(&name);
    let axes = [
        ("yaw", "yaw"),
        ("heading", "yaw"),
        ("pitch", "pitch"),
        ("roll", "roll"),
    ];
    let of = axes.into_iter().find(|(end, _)| name.ends_with(end));
    of.map(|(_, axis)| axis)
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
