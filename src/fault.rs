//! What is wrong with an input, as one line for people: the place, the matter, the remedy.

use std::collections::HashMap;
use std::fmt;

/// Bad input, said so that the engineer can mend it.
///
/// Whoever knows the file puts its name in front (`formats::FileError`); a fault itself knows only
/// the place inside. It prints as `what; remedy`, always on one line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Line in a text file, counted from 1.
    pub line: Option<u64>,
    /// What is wrong, naming the value and the limit.
    pub what: String,
    /// What to do about it.
    pub remedy: String,
    /// What there is too little of, where adding it mends the fault: so that a window can ask for it.
    pub lacks: Option<Lacking>,
}

/// What an input can lack that stands in other files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lacking {
    /// A cloud or mesh.
    Surface,
    /// The image files.
    Photos,
}

impl Fault {
    /// A fault of the whole input.
    pub fn new(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            line: None,
            what: one_line(&what.into()),
            remedy: one_line(&remedy.into()),
            lacks: None,
        }
    }

    /// The same, for want of something that can be added.
    pub fn for_want_of(self, lacking: Lacking) -> Self {
        Self {
            lacks: Some(lacking),
            ..self
        }
    }

    /// A fault at a line of a text, counted from 1.
    pub fn at(line: u64, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::new(what, remedy)
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.what, self.remedy)
    }
}

impl std::error::Error for Fault {}

/// The longest a sentence gets, in characters: messages quote broken files, whose lines may have
/// millions.
const LONGEST: usize = 700;

/// Folds every run of white space and control characters into one space and cuts what is too long:
/// messages quote bytes of broken files, and an error is one line whatever they hold.
pub fn one_line(text: &str) -> String {
    let mut line = String::new();
    for word in text.split(|c: char| c.is_whitespace() || c.is_control()) {
        if !word.is_empty() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        if let Some((end, _)) = line.char_indices().nth(LONGEST) {
            line.truncate(end);
            line.push('…');
            break;
        }
    }
    line
}

/// How many of many names a sentence has at most, and from how many characters on it has fewer.
const NAMED: usize = 12;
const LONG_NAMES: usize = 180;

/// How many it has however long they are.
const A_FEW: usize = 3;

/// The first names, and how many more there are: what a sentence says of things that may be hundreds.
pub fn first_names(names: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let mut said = String::new();
    let (mut named, mut more) = (0, 0);
    for name in names {
        let name = name.as_ref();
        let length = |text: &str| text.chars().count();
        let fits = || named < NAMED && length(&said) + length(name) <= LONG_NAMES;
        if more > 0 || named >= A_FEW && !fits() {
            more += 1;
            continue;
        }
        if named > 0 {
            said.push_str(", ");
        }
        said.push_str(name);
        named += 1;
    }
    match more {
        0 => said,
        more => format!("{said} and {more} more"),
    }
}

/// What is to be said of many things by their names, one sentence for each cause in the order of its first: the name and the
/// text, or, where several have the same, how many `of_kind` ("photos") they are and the first few. Texts that differ by the
/// number alone with which they begin ("12 outlines are too small") are one cause, and its numbers are added.
pub fn by_cause<'a>(
    said: impl IntoIterator<Item = (&'a str, String)>,
    of_kind: &str,
) -> Vec<String> {
    struct Cause<'a> {
        text: String,
        count: Option<u64>,
        names: Vec<&'a str>,
    }
    let mut causes: Vec<Cause<'_>> = Vec::new();
    let mut places: HashMap<(bool, String), usize> = HashMap::new();
    for (name, text) in said {
        let counted = text.split_once(' ');
        let counted = counted.and_then(|(count, rest)| Some((count.parse::<u64>().ok()?, rest)));
        let (count, text) = match counted {
            Some((count, rest)) => (Some(count), rest.to_owned()),
            None => (None, text),
        };
        let key = (count.is_some(), text.clone());
        let place = *places.entry(key).or_insert(causes.len());
        match causes.get_mut(place) {
            Some(cause) => {
                cause.names.push(name);
                let both = cause.count.zip(count);
                cause.count = both.map(|(one, other)| one.saturating_add(other));
            }
            None => causes.push(Cause {
                text,
                count,
                names: vec![name],
            }),
        }
    }
    let sentences = causes.iter().map(|Cause { text, count, names }| {
        let count = count.map_or_else(String::new, |count| format!("{count} "));
        match names.as_slice() {
            [name] => format!("{name}: {count}{text}"),
            names => {
                let (many, first) = (names.len(), first_names(names));
                format!("{many} {of_kind} ({first}): {count}{text}")
            }
        }
    });
    sentences.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_cause_is_one_sentence() {
        let said = [
            ("a", "dark"),
            ("b", "gone"),
            ("c", "dark"),
            ("d", "dark"),
            ("e", "dark"),
        ];
        let said = said.map(|(name, text)| (name, text.to_owned()));
        assert_eq!(
            by_cause(said, "photos"),
            ["4 photos (a, c, d, e): dark", "b: gone"]
        );
        assert!(by_cause([], "photos").is_empty());
        let said = ["7 are small", "12 are small", "are small", "7 are large"];
        let said = ["a", "b", "c", "d"]
            .into_iter()
            .zip(said.map(str::to_owned));
        assert_eq!(
            by_cause(said, "photos"),
            [
                "2 photos (a, b): 19 are small",
                "c: are small",
                "d: 7 are large"
            ]
        );
    }

    /// Which photos are meant can be read, unless they are very many.
    #[test]
    fn names_are_said_until_they_are_many() {
        let names = |count: usize| (1..=count).map(|number| format!("IMG_{number:04}.jpg"));
        assert_eq!(first_names(names(0)), "");
        assert_eq!(first_names(names(2)), "IMG_0001.jpg, IMG_0002.jpg");
        let twelve = names(12).collect::<Vec<_>>().join(", ");
        assert_eq!(first_names(names(12)), twelve);
        assert_eq!(first_names(names(20)), format!("{twelve} and 8 more"));
        // Three of 100 characters, and no more.
        let long = ["x"; 3].map(|letter| letter.repeat(100));
        let more = [&long[..], &["y".to_owned()]].concat();
        assert_eq!(
            first_names(&more),
            format!("{} and 1 more", long.join(", "))
        );
        // Four of 40 characters with their commas are 166 long; a fifth would be 206.
        let longer = ["a", "b", "c", "d", "e"].map(|letter| letter.repeat(40));
        let said = format!("{} and 1 more", longer[..4].join(", "));
        assert_eq!(first_names(&longer), said);
    }

    #[test]
    fn prints_on_one_line() {
        let fault = Fault::at(3, "found\n\t'\u{0}a\u{1b}[31m'", "mend it");
        assert_eq!(fault.to_string(), "found ' a [31m'; mend it");
        assert_eq!(fault.line, Some(3));
        let long = Fault::new("ü".repeat(1_000_000), "");
        assert_eq!(long.what.chars().count(), LONGEST + 1);
    }
}
