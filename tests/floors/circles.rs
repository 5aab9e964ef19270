//! No files use each other in a circle: whoever changes one of a circle has to read all of it. A module may use its own ancestors, which declare it.
//!
//! The paths in `use` and in code are followed to the file that defines the name, through the names
//! that a module hands on. What tests use does not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A module: its crate (the folder of a member, "core" or "root") and its path in it.
type Module = (String, Vec<String>);

/// A path of names.
type Names = Vec<String>;

struct Source {
    file: PathBuf,
    /// Paths that are brought in by `use`, by the name that they have here.
    named: BTreeMap<String, Names>,
    /// All paths that are used.
    paths: BTreeSet<Names>,
}

fn module_of(src: &Path, file: &Path, members: &[String]) -> Module {
    let inside = file
        .strip_prefix(src)
        .expect("below src")
        .with_extension("");
    let mut names: Names = inside
        .iter()
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    let member = members.iter().find(|member| **member == names[0]);
    let member = match (member, names[0].as_str()) {
        (Some(member), _) => {
            names.remove(0);
            member.clone()
        }
        (None, "cli" | "lib" | "main") => "root".to_owned(),
        (None, _) => "core".to_owned(),
    };
    if let Some("mod" | "lib" | "core" | "main") = names.last().map(String::as_str) {
        names.pop();
    }
    (member, names)
}

/// The code without comments and tests.
fn code(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod tests {").next();
    let lines = code.unwrap_or_default().lines();
    let bare = lines.map(|line| line.split("//").next().unwrap_or_default());
    bare.collect::<Vec<_>>().join("\n")
}

/// The single paths of a tree such as `a::{b, c::{d, e}}`.
fn expanded(tree: &str, before: &[String], found: &mut Vec<Names>) {
    let tree = tree.split(" as ").next().unwrap_or_default().trim();
    let (head, branches) = match tree.split_once('{') {
        Some((head, rest)) => (
            head,
            Some(rest.trim_end().strip_suffix('}').unwrap_or(rest)),
        ),
        None => (tree, None),
    };
    let mut path = before.to_vec();
    path.extend(
        head.split("::")
            .map(|name| name.trim().to_owned())
            .filter(|name| !name.is_empty()),
    );
    let Some(branches) = branches else {
        found.push(path);
        return;
    };
    let (mut depth, mut start) = (0, 0);
    for (at, c) in branches.char_indices().chain([(branches.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                let branch = &branches[start..at];
                if !branch.trim().is_empty() {
                    expanded(branch, &path, found);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

fn source(file: PathBuf) -> Source {
    let text = code(&fs::read_to_string(&file).expect("a source"));
    let (mut named, mut paths) = (BTreeMap::new(), BTreeSet::new());
    for statement in text.split(';') {
        let Some((_, tree)) = statement.rsplit_once("use ") else {
            continue;
        };
        let mut found = Vec::new();
        expanded(tree, &[], &mut found);
        for path in found {
            if let Some(name) = path.last() {
                named.insert(name.clone(), path.clone());
            }
            paths.insert(path);
        }
    }
    // In code, from `crate` or from a module beside; what begins with anything else leads nowhere.
    let is_of_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    for path in text.split(|c| !is_of_path(c)) {
        if path.contains("::") {
            let names = path.split("::").filter(|name| !name.is_empty());
            paths.insert(names.map(str::to_owned).collect());
        }
    }
    Source { file, named, paths }
}

/// The module that defines what `path` means in `module`, as far as it lies in the same crate.
fn defining(
    sources: &BTreeMap<Module, Source>,
    module: &Module,
    path: &[String],
    depth: usize,
) -> Option<Module> {
    // Names that are handed on in a circle.
    if depth > 8 {
        return None;
    }
    let (member, own) = module;
    let is_module = |names: &[String]| sources.contains_key(&(member.clone(), names.to_vec()));
    let (first, mut rest) = path.split_first()?;
    let mut at = match first.as_str() {
        "crate" => Vec::new(),
        "super" => own[..own.len().saturating_sub(1)].to_vec(),
        "self" => own.clone(),
        name => {
            let child = [own.as_slice(), &[name.to_owned()]].concat();
            if !is_module(&child) {
                return None;
            }
            child
        }
    };
    while let Some((name, after)) = rest.split_first() {
        let child = [at.as_slice(), std::slice::from_ref(name)].concat();
        if !is_module(&child) {
            break;
        }
        (at, rest) = (child, after);
    }
    let there = (member.clone(), at);
    let defined = sources.get(&there)?;
    if let Some((name, after)) = rest.split_first()
        && there != *module
        && let Some(handed_on) = defined.named.get(name)
    {
        let whole = [handed_on.as_slice(), after].concat();
        let begins = handed_on.first().map(String::as_str);
        // What another member defines is no edge here.
        if begins.is_some_and(|name| name.starts_with("fragscale_")) {
            return None;
        }
        if let Some(found) = defining(sources, &there, &whole, depth + 1) {
            return Some(found);
        }
    }
    Some(there)
}

/// Tarjan's strongly connected components, those of more than one.
struct Components<'a> {
    edges: &'a BTreeMap<Module, BTreeSet<Module>>,
    order: BTreeMap<Module, usize>,
    low: BTreeMap<Module, usize>,
    stack: Vec<Module>,
    found: Vec<Vec<Module>>,
}

impl Components<'_> {
    fn visit(&mut self, module: &Module) {
        let number = self.order.len();
        self.order.insert(module.clone(), number);
        self.low.insert(module.clone(), number);
        self.stack.push(module.clone());
        for next in self.edges.get(module).into_iter().flatten() {
            if !self.order.contains_key(next) {
                self.visit(next);
            }
            // On the stack: part of the component that is being built.
            if self.stack.contains(next) {
                let low = self.low[next].min(self.low[module]);
                self.low.insert(module.clone(), low);
            }
        }
        if self.low[module] == number {
            let at = self.stack.iter().position(|m| m == module);
            let component = self.stack.split_off(at.expect("it was pushed"));
            if component.len() > 1 {
                self.found.push(component);
            }
        }
    }
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    super::sources(&src, &mut files);
    let members: Vec<String> = super::MEMBERS
        .iter()
        .map(|(member, _)| (*member).to_owned())
        .filter(|member| member != "core")
        .collect();
    let sources: BTreeMap<Module, Source> = files
        .into_iter()
        .filter(|file| {
            let inside = file.strip_prefix(&src).expect("below src");
            !inside.to_string_lossy().contains("tests")
        })
        .map(|file| (module_of(&src, &file, &members), source(file)))
        .collect();
    let mut edges: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
    let mut count = 0;
    for (module, source) in &sources {
        for path in &source.paths {
            let Some(used) = defining(&sources, module, path, 0) else {
                continue;
            };
            let is_ancestor = module.1.starts_with(&used.1);
            if !is_ancestor {
                count += 1;
                edges.entry(module.clone()).or_default().insert(used);
            }
        }
    }
    assert!(count > 1000, "only {count} imports were understood");
    let mut components = Components {
        edges: &edges,
        order: BTreeMap::new(),
        low: BTreeMap::new(),
        stack: Vec::new(),
        found: Vec::new(),
    };
    for module in sources.keys() {
        if !components.order.contains_key(module) {
            components.visit(module);
        }
    }
    let circles: Vec<Vec<&Path>> = components
        .found
        .iter()
        .map(|circle| circle.iter().map(|m| sources[m].file.as_path()).collect())
        .collect();
    assert!(circles.is_empty(), "{circles:#?}");
}
