//! README and `docs/`: links lead somewhere, every command is in README's table, and what stands in their boxes is
//! understood by the program.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::stdout_of;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// README and the chapters, with their texts.
fn pages() -> Vec<(PathBuf, String)> {
    let chapters = std::fs::read_dir(root().join("docs")).unwrap();
    let mut pages: Vec<PathBuf> = chapters.map(|entry| entry.unwrap().path()).collect();
    pages.push(root().join("README.md"));
    let read = |page: PathBuf| {
        let text = std::fs::read_to_string(&page).unwrap();
        (page, text)
    };
    pages.into_iter().map(read).collect()
}

/// The anchor that a heading has on GitHub and in other readers of Markdown.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase().replace(' ', "-");
    kept.chars()
        .filter(|letter| letter.is_alphanumeric() || matches!(letter, '-' | '_'))
        .collect()
}

#[test]
fn links_lead_somewhere() {
    let mut links = 0;
    for (page, text) in pages() {
        for link in text.split("](").skip(1) {
            let link = link.split(')').next().unwrap();
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let target = page.parent().unwrap().join(file);
            let target = if file.is_empty() {
                page.clone()
            } else {
                target
            };
            assert!(target.is_file(), "{}: {link}", page.display());
            if !place.is_empty() {
                let there = std::fs::read_to_string(&target).unwrap();
                let headings = there.lines().filter(|line| line.starts_with('#'));
                let mut anchors = headings.map(|line| anchor(line.trim_start_matches('#')));
                assert!(
                    anchors.any(|anchor| anchor == place),
                    "{}: {link}",
                    page.display()
                );
            }
            links += 1;
        }
    }
    assert!(links > 25, "{links}");
}

fn help(arguments: &[&str]) -> String {
    stdout_of(&[arguments, &["--help"]].concat())
}

/// The names of all commands, as `fragscale --help` lists them.
fn commands() -> BTreeSet<String> {
    let text = help(&[]);
    let list = text.split("Commands:").nth(1).unwrap();
    let list = list.split("\n\n").next().unwrap().lines();
    let names = list.filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
    names
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_command_is_in_readme() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    let commands = commands();
    assert!(commands.len() > 15, "{commands:?}");
    for command in commands {
        let named = [format!("`{command}`"), format!("fragscale {command} ")];
        assert!(
            named.iter().any(|name| readme.contains(name)),
            "README has no word of {command}"
        );
    }
}

/// Each `fragscale COMMAND ...` of a box names a command and options that there are.
#[test]
fn boxes_are_understood() {
    let commands = commands();
    let mut boxes = 0;
    for (page, text) in pages() {
        for line in text.split("```").skip(1).step_by(2).flat_map(str::lines) {
            let Some(line) = line.strip_prefix("fragscale ") else {
                continue;
            };
            let line = line.split(" # ").next().unwrap();
            let command = line.split_whitespace().next().unwrap();
            let known = commands.contains(command);
            // A file alone opens the window.
            assert!(known || command.contains('.'), "{}: {line}", page.display());
            // `psd` alone has commands of its own.
            let depth = usize::from(known) + usize::from(command == "psd");
            let path: Vec<&str> = line.split_whitespace().take(depth).collect();
            let help = help(&path);
            for option in line
                .split_whitespace()
                .filter(|word| word.starts_with("--"))
            {
                assert!(
                    help.contains(&format!("{option} ")) || help.contains(&format!("{option}\n")),
                    "{}: {line}: {option}",
                    page.display()
                );
            }
            boxes += 1;
        }
    }
    assert!(boxes > 25, "{boxes}");
}
