//! The order of the rooms: no import runs against it, and no files import each other in a circle, in any crate of the
//! workspace.
//!
//! Imports are the `use` declarations and qualified paths of the code without its tests, followed through re-exports to the
//! file that defines a name. A module that only re-exports names of its children does not import them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

/// Modules at the root of the crate `airlight`, each importing only from those before it. Files of one room may import each
/// other, but not in a circle.
const ROOMS: [&str; 16] = [
    "axes",
    "control",
    "names",
    "math",
    "spectrum",
    "optics",
    "sun",
    "night",
    "atmosphere",
    "transfer",
    "sky",
    "fog",
    "monte_carlo",
    "scene",
    "models",
    "prelude",
];

#[test]
fn rooms_import_only_from_rooms_before_them() {
    let house = House::read(&crates().join("airlight/src/lib.rs"));
    let room_of = |file: usize| house.modules[file].path.first().map(String::as_str);
    let place = |room: &str| ROOMS.iter().position(|known| *known == room);
    let mut wrong = BTreeSet::new();
    for (&(from, to), names) in &house.imports() {
        // The root of the crate re-exports from every room.
        let (Some(a), Some(b)) = (room_of(from), room_of(to)) else {
            continue;
        };
        let (Some(at), Some(target)) = (place(a), place(b)) else {
            wrong.insert(format!("the rooms {a} and {b} need a place in ROOMS"));
            continue;
        };
        if target > at {
            wrong.insert(house.arrow(from, to, names));
        }
    }
    assert!(wrong.is_empty(), "{}", list(&wrong));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut wrong = BTreeSet::new();
    for name in ["lib.rs", "main.rs"] {
        for entry in fs::read_dir(crates()).expect("the folder of the crates") {
            let root = entry.expect("a crate").path().join("src").join(name);
            if root.is_file() {
                let house = House::read(&root);
                wrong.extend(house.circles());
            }
        }
    }
    assert!(wrong.is_empty(), "{}", list(&wrong));
}

/// Unit tests of such a crate would never run.
#[test]
fn crates_without_unit_tests_have_none() {
    for entry in fs::read_dir(crates()).expect("the folder of the crates") {
        let folder = entry.expect("a crate").path();
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        let library = manifest
            .split("\n[")
            .find(|table| table.starts_with("lib]"));
        if library.is_some_and(|table| table.contains("test = false")) {
            let house = House::read(&folder.join("src/lib.rs"));
            for module in &house.modules {
                let text = fs::read_to_string(&module.file).expect("a module");
                let none = !text.contains("#[test]") && !text.contains("cfg(test)");
                assert!(none, "{}", module.file.display());
            }
        }
    }
}

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn list(lines: &BTreeSet<String>) -> String {
    let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
    format!("\n{}", lines.join("\n"))
}

/// The modules of a crate.
struct House {
    modules: Vec<Module>,
}

/// A module with a file of its own; modules inside a file belong to it.
struct Module {
    file: PathBuf,
    /// From the root of the crate.
    path: Vec<String>,
    parent: Option<usize>,
    children: HashMap<String, usize>,
    tokens: Vec<String>,
    uses: Vec<Use>,
}

/// One name of a `use` declaration.
struct Use {
    path: Vec<String>,
    /// The name it goes by here; `*` for all names of a module.
    name: String,
    is_public: bool,
}

impl House {
    fn read(root: &Path) -> Self {
        let mut house = Self {
            modules: Vec::new(),
        };
        house.add(root.to_owned(), Vec::new(), None);
        assert!(house.modules[0].tokens.len() > 2, "{root:?} is read");
        house
    }

    /// Reads a module and those declared in it, other than for tests.
    fn add(&mut self, file: PathBuf, path: Vec<String>, parent: Option<usize>) -> usize {
        let text = fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let tokens = without_tests(tokens(&text));
        let declared: Vec<String> = tokens
            .windows(3)
            .filter(|w| w[0] == "mod" && w[2] == ";")
            .map(|w| w[1].clone())
            .collect();
        let (tokens, uses) = split_uses(tokens);
        let index = self.modules.len();
        self.modules.push(Module {
            file: file.clone(),
            path: path.clone(),
            parent,
            children: HashMap::new(),
            tokens,
            uses,
        });
        let folder = match file.file_stem().and_then(|s| s.to_str()) {
            Some("lib" | "main" | "mod") => file.parent().expect("a folder").to_owned(),
            _ => file.with_extension(""),
        };
        for name in declared {
            let flat = folder.join(format!("{name}.rs"));
            let child = if flat.is_file() {
                flat
            } else {
                folder.join(&name).join("mod.rs")
            };
            let path = path.iter().cloned().chain([name.clone()]).collect();
            let child = self.add(child, path, Some(index));
            self.modules[index].children.insert(name, child);
        }
        index
    }

    /// The module whose file defines what a path names; none for names of other crates.
    fn resolve(&self, from: usize, path: &[String], depth: usize) -> Option<usize> {
        let (first, rest) = path.split_first()?;
        let module = &self.modules[from];
        match first.as_str() {
            _ if depth > 40 => None,
            "crate" => self.descend(0, rest, depth),
            "self" => self.descend(from, rest, depth),
            "super" => self.descend(module.parent?, rest, depth),
            name if module.children.contains_key(name) => self.descend(from, path, depth),
            name => {
                let bound = module.uses.iter().find(|u| u.name == name)?;
                // Not `use rayon;` and the like, which lead back to themselves.
                (bound.path != path[..1]).then(|| {
                    let whole: Vec<String> = bound.path.iter().chain(rest).cloned().collect();
                    self.resolve(from, &whole, depth + 1)
                })?
            }
        }
    }

    /// The same for a path inside a module.
    fn descend(&self, at: usize, path: &[String], depth: usize) -> Option<usize> {
        let Some((first, rest)) = path.split_first() else {
            return Some(at);
        };
        if matches!(first.as_str(), "super" | "self") {
            return self.resolve(at, path, depth + 1);
        }
        let module = &self.modules[at];
        if let Some(&child) = module.children.get(first) {
            return self.descend(child, rest, depth);
        }
        if module.defines(first) {
            return Some(at);
        }
        if module.uses.iter().any(|u| u.name == *first) {
            return self.resolve(at, path, depth + 1);
        }
        module
            .uses
            .iter()
            .filter(|u| u.name == "*")
            .filter_map(|all| self.resolve(at, &all.path, depth + 1))
            .find(|&target| target != at && self.modules[target].defines(first))
            .or(Some(at))
    }

    /// Which file imports which, and the names that it takes from there.
    fn imports(&self) -> BTreeMap<(usize, usize), BTreeSet<String>> {
        let mut found: BTreeMap<(usize, usize), BTreeSet<String>> = BTreeMap::new();
        for (from, module) in self.modules.iter().enumerate() {
            let handed_on = |u: &&Use| u.is_public && !module.names(&u.name);
            let used = module.uses.iter().filter(|u| !handed_on(u));
            let paths = used.map(|u| u.path.clone()).chain(module.paths());
            for path in paths {
                if let Some(to) = self.resolve(from, &path, 0)
                    && to != from
                {
                    let name = path.last().cloned().unwrap_or_default();
                    found.entry((from, to)).or_default().insert(name);
                }
            }
        }
        found
    }

    fn arrow(&self, from: usize, to: usize, names: &BTreeSet<String>) -> String {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let file = |index: usize| {
            let file = &self.modules[index].file;
            file.strip_prefix(crates())
                .unwrap_or(file)
                .display()
                .to_string()
        };
        format!(
            "{} imports {} from {}",
            file(from),
            names.join(", "),
            file(to)
        )
    }

    /// The arrows between files from which a way leads back to where they start.
    fn circles(&self) -> BTreeSet<String> {
        let imports = self.imports();
        let mut targets = vec![Vec::new(); self.modules.len()];
        for &(from, to) in imports.keys() {
            targets[from].push(to);
        }
        let leads_back = |(from, to): (usize, usize)| {
            let (mut seen, mut open) = (vec![false; targets.len()], vec![to]);
            while let Some(at) = open.pop() {
                if !std::mem::replace(&mut seen[at], true) {
                    open.extend(&targets[at]);
                }
            }
            seen[from]
        };
        imports
            .iter()
            .filter(|(arrow, _)| leads_back(**arrow))
            .map(|(&(from, to), names)| self.arrow(from, to, names))
            .collect()
    }
}

impl Module {
    /// Whether an item of this name is defined here.
    fn defines(&self, name: &str) -> bool {
        const KEYWORDS: [&str; 9] = [
            "struct", "enum", "trait", "fn", "const", "static", "type", "union", "mod",
        ];
        self.tokens
            .windows(2)
            .any(|w| KEYWORDS.contains(&w[0].as_str()) && w[1] == name)
    }

    /// Whether code beside the declarations of use says a name.
    fn names(&self, name: &str) -> bool {
        self.tokens.iter().any(|token| token == name)
    }

    /// Qualified paths in the code: all chains of names with `::` between them.
    fn paths(&self) -> impl Iterator<Item = Vec<String>> + '_ {
        let tokens = &self.tokens;
        let begins = |&i: &usize| tokens[i + 1] == "::" && (i == 0 || tokens[i - 1] != "::");
        (0..tokens.len().saturating_sub(2))
            .filter(begins)
            .map(move |i| {
                let links = tokens[i + 1..].chunks_exact(2);
                let links = links.take_while(|w| w[0] == "::" && is_name(&w[1]));
                let rest = links.map(|w| w[1].clone());
                [tokens[i].clone()].into_iter().chain(rest).collect()
            })
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Names, `::` and single signs of a text, without comments, strings, characters and lifetimes.
fn tokens(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    let mut all = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        let c = chars[i];
        if c == '/' && at(i + 1) == '/' {
            while i < chars.len() && chars[i] != '\n' {
                i += 1;
            }
        } else if c == '/' && at(i + 1) == '*' {
            while i < chars.len() && !(chars[i] == '*' && at(i + 1) == '/') {
                i += 1;
            }
            i += 2;
        } else if c == 'r' && (at(i + 1) == '"' || (at(i + 1) == '#' && "#\"".contains(at(i + 2))))
        {
            let hashes = chars[i + 1..].iter().take_while(|c| **c == '#').count();
            let end = [vec!['"'], vec!['#'; hashes]].concat();
            i += hashes + 2;
            while i < chars.len() && !chars[i..].starts_with(&end) {
                i += 1;
            }
            i += end.len();
        } else if c == '"' {
            i += 1;
            while i < chars.len() && chars[i] != '"' {
                i += if chars[i] == '\\' { 2 } else { 1 };
            }
            i += 1;
        } else if c == '\'' && (at(i + 2) == '\'' || at(i + 1) == '\\') {
            i += 2;
            while i < chars.len() && chars[i] != '\'' {
                i += 1;
            }
            i += 1;
        } else if c == '\'' {
            i += 1;
            while at(i).is_alphanumeric() || at(i) == '_' {
                i += 1;
            }
        } else if c.is_alphanumeric() || c == '_' {
            let start = i;
            while at(i).is_alphanumeric() || at(i) == '_' {
                i += 1;
            }
            all.push(chars[start..i].iter().collect());
        } else if c == ':' && at(i + 1) == ':' {
            all.push("::".to_owned());
            i += 2;
        } else {
            if !c.is_whitespace() {
                all.push(c.to_string());
            }
            i += 1;
        }
    }
    all
}

/// Without the items that stand under `#[cfg(test)]`.
fn without_tests(tokens: Vec<String>) -> Vec<String> {
    const MARK: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut all = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if tokens[i..].len() < MARK.len() || tokens[i..i + MARK.len()] != MARK {
            all.push(tokens[i].clone());
            i += 1;
            continue;
        }
        // To the semicolon or the closing brace of the item.
        i += MARK.len();
        let mut depth = 0;
        while i < tokens.len() {
            match tokens[i].as_str() {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth -= 1,
                _ => {}
            }
            i += 1;
            if depth == 0 && matches!(tokens[i - 1].as_str(), ";" | "}") {
                break;
            }
        }
    }
    all
}

/// The code without its `use` declarations, and these.
fn split_uses(tokens: Vec<String>) -> (Vec<String>, Vec<Use>) {
    let (mut rest, mut uses) = (Vec::new(), Vec::new());
    let mut i = 0;
    while i < tokens.len() {
        // Not the captures of `impl Trait + use<>`.
        if tokens[i] != "use" || tokens.get(i + 1).is_none_or(|next| next == "<") {
            rest.push(tokens[i].clone());
            i += 1;
            continue;
        }
        let is_public = matches!(rest.last().map(String::as_str), Some("pub" | ")"));
        let end = tokens[i..].iter().position(|token| token == ";");
        let end = i + end.expect("a semicolon after use");
        let mut position = i + 1;
        while position < end {
            tree(&tokens, &mut position, &[], is_public, &mut uses);
            position += 1;
        }
        i = end + 1;
    }
    (rest, uses)
}

/// One branch of a `use` declaration, up to a comma, a closing brace or the semicolon.
fn tree(
    tokens: &[String],
    at: &mut usize,
    before: &[String],
    is_public: bool,
    uses: &mut Vec<Use>,
) {
    let mut path = before.to_vec();
    let mut name = None;
    loop {
        match tokens[*at].as_str() {
            "{" => {
                while tokens[*at] != "}" {
                    *at += 1;
                    if tokens[*at] != "}" {
                        tree(tokens, at, &path, is_public, uses);
                    }
                }
                *at += 1;
                return;
            }
            "," | "}" | ";" => break,
            "::" => {}
            "as" => {
                name = Some(tokens[*at + 1].clone());
                *at += 1;
            }
            "self" if !path.is_empty() => {}
            token => path.push(token.to_owned()),
        }
        *at += 1;
    }
    let last = path.last().cloned().unwrap_or_default();
    if last == "*" {
        path.pop();
    }
    uses.push(Use {
        name: name.unwrap_or(last),
        path,
        is_public,
    });
}
