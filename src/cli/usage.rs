//! A command line that nobody understands, said in one line: what is wrong, and what it could have meant.

use std::ffi::OsString;
use std::path::Path;

use clap::CommandFactory;

use super::Arguments;
use crate::fault::one_line;

/// Where the first word is neither a command nor a file that is there, what it could have meant:
/// clap takes it for a flight and stumbles over the second word.
pub(super) fn unknown_command() -> Option<String> {
    let word = std::env::args_os().nth(1)?;
    let text = word.to_string_lossy();
    let arguments = Arguments::command();
    let names: Vec<&str> = arguments.get_subcommands().map(|c| c.get_name()).collect();
    if text.starts_with('-') || names.contains(&text.as_ref()) || Path::new(&word).exists() {
        return None;
    }
    let likeness = |name: &&str| strsim::jaro_winkler(&text, name);
    let nearest = names
        .into_iter()
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
        .filter(|name| likeness(name) > 0.8);
    let tip = nearest.map_or_else(String::new, |name| format!(" (perhaps '{name}')"));
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
