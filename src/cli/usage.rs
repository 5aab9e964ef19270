//! A command line that nobody understands, said in one line: what is wrong, and what it could have meant.

use std::ffi::OsString;
use std::path::Path;

use clap::CommandFactory;

use super::Arguments;
use crate::fault::one_line;

/// What people call what a command does, and that command: words that are not like its name.
const CALLED: [(&str, &str); 8] = [
    ("season", "batch"),
    ("seasons", "batch"),
    ("blasts", "batch"),
    ("fragments", "delineate"),
    ("segment", "delineate"),
    ("sizes", "psd"),
    ("simulate", "sample"),
    ("draw", "render"),
];

/// How alike two words are, 0 to 1, of which one may be meant by the other.
const ALIKE: f64 = 0.8;

/// The command that is meant by a word that is none.
fn meant<'a>(word: &str, names: &[&'a str]) -> Option<&'a str> {
    let word = word.to_ascii_lowercase();
    let called = CALLED.iter().find(|(called, _)| *called == word);
    if let Some((_, command)) = called {
        return names.iter().copied().find(|name| name == command);
    }
    let likeness = |name: &&str| strsim::jaro_winkler(&word, name);
    let nearest = names
        .iter()
        .copied()
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    nearest.filter(|name| likeness(name) > ALIKE)
}

/// The same as [`unknown_command`] of a word without a path or an ending: who asks for help with that means a command.
pub(super) fn unknown_word() -> Option<String> {
    let word = std::env::args_os().nth(1)?;
    let is_of_name = |letter: char| letter.is_alphanumeric() || matches!(letter, '-' | '_');
    let is_word = word.to_string_lossy().chars().all(is_of_name);
    is_word.then(unknown_command).flatten()
}

/// Where the first word is neither a command nor a file that is there, what it could have meant:
/// clap takes it for a flight and stumbles over the second word.
pub(super) fn unknown_command() -> Option<String> {
    let word = std::env::args_os().nth(1)?;
    let text = word.to_string_lossy();
    let arguments = Arguments::command();
    let mut names: Vec<&str> = arguments.get_subcommands().map(|c| c.get_name()).collect();
    // clap's own.
    names.push("help");
    if text.starts_with('-') || names.contains(&text.as_ref()) || Path::new(&word).exists() {
        return None;
    }
    let tip = meant(&text, &names).map_or_else(String::new, |name| format!(" (perhaps '{name}')"));
    Some(one_line(&format!(
        "'{text}' is neither a command{tip} nor a file or folder; see 'fragscale --help'"
    )))
}

/// Where the first word is a command and a file or folder of that name is there: how that is opened.
pub(super) fn folder_called_like_a_command() -> Option<String> {
    let name = named_command()?;
    let kind = match std::fs::metadata(&name).ok()?.is_dir() {
        true => "folder",
        false => "file",
    };
    let is_alone = std::env::args_os().len() == 2;
    let there = Path::new(".").join(&name);
    (is_alone && cfg!(feature = "app")).then(|| {
        format!(
            "'{name}' is a command; to open the {kind} of that name type 'fragscale {}'",
            there.display()
        )
    })
}

/// What Rust says of a text that is no number, and what we do.
const NO_NUMBERS: [(&str, &str); 6] = [
    ("invalid float literal", "not a number"),
    ("cannot parse float from empty string", "no number"),
    (
        "invalid digit found in string",
        "not a whole number from 0 on",
    ),
    ("cannot parse integer from empty string", "no number"),
    ("number too large to fit in target type", "too large"),
    ("number too small to fit in target type", "too small"),
];

/// clap explains over several lines; here the first, with its tip, and where to read more.
pub(super) fn in_one_line(text: &str) -> String {
    let lines: Vec<&str> = text
        .lines()
        .map(str::trim)
        .take_while(|line| !line.starts_with("Usage:"))
        // Said once, behind it.
        .filter(|line| !line.is_empty() && !line.starts_with("For more information"))
        .collect();
    let mut what = lines.join(", ").replace(":, ", ": ");
    for (of_rust, plain) in NO_NUMBERS {
        if let Some(before) = what.strip_suffix(of_rust) {
            what = format!("{before}{plain}");
        }
    }
    let what = what.strip_prefix("error: ").unwrap_or(&what).to_owned();
    let name: OsString = std::env::args_os().next().unwrap_or_default();
    let name = Path::new(&name).file_name().map_or_else(
        || "fragscale".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    );
    let command = named_command().map_or_else(String::new, |command| format!(" {command}"));
    format!("{what}; see '{name}{command} --help'")
}

/// The command that the first word is.
fn named_command() -> Option<String> {
    let word = std::env::args_os().nth(1)?;
    let command = Arguments::command();
    let found = command.get_subcommands().find(|c| word == c.get_name());
    found.map(|command| command.get_name().to_owned())
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    /// Every word that stands for a command does so, and is none itself.
    #[test]
    fn what_a_command_is_called_otherwise_is_understood() {
        let arguments = Arguments::command();
        let mut names: Vec<&str> = arguments.get_subcommands().map(|c| c.get_name()).collect();
        // The command line without a window draws no pictures.
        if !names.contains(&"render") {
            names.push("render");
        }
        for (called, command) in CALLED {
            assert!(!names.contains(&called), "{called}");
            assert_eq!(meant(called, &names), Some(command));
        }
        assert_eq!(meant("Fragments", &names), Some("delineate"));
        assert_eq!(meant("PSD", &names), Some("psd"));
        assert_eq!(meant("scails", &names), Some("scales"));
        assert_eq!(meant("quarry", &names), None);
    }

    #[test]
    fn usage_errors_are_one_line() {
        let error = Arguments::try_parse_from(["fragscale", "scales", "a", "--unit", "km"]);
        let line = in_one_line(&error.unwrap_err().to_string());
        assert!(!line.contains('\n'));
        assert!(line.contains("'km'"), "{line}");
        assert_eq!(line.matches("--help").count(), 1, "{line}");
        let refused = |option: [&str; 2]| {
            let words = ["fragscale", "sample", "a"].into_iter().chain(option);
            in_one_line(&Arguments::try_parse_from(words).unwrap_err().to_string())
        };
        let line = refused(["--seed", "abc"]);
        assert!(
            line.starts_with(
                "invalid value 'abc' for '--seed <SEED>': not a whole number from 0 on; see"
            ),
            "{line}"
        );
        let line = refused(["--seed", "99999999999999999999"]);
        assert!(line.contains(": too large; see"), "{line}");
    }
}
