//! Promise: the library can be read from one end to the other. No file imports another one that
//! imports the first, in however many steps. A `pub use` is an import, too, unless it passes on a
//! name of the module's own children: that is the table of contents of what follows.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The library's files by the paths of their modules, but for those that are compiled for tests
/// only.
fn files() -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    read(
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")),
        "",
        &mut files,
    );
    // Comments, and tests beside the code.
    for text in files.values_mut() {
        let code: Vec<&str> = text
            .lines()
            .map(|line| line.split("//").next().unwrap())
            .collect();
        *text = code.join("\n");
    }
    let all: Vec<(String, String)> = files.clone().into_iter().collect();
    for (module, text) in &all {
        for (_, rest) in text
            .match_indices("#[cfg(test)]\nmod ")
            .map(|(at, head)| text.split_at(at + head.len()))
        {
            let name: String = rest
                .chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .collect();
            let of_tests = join(module, &name);
            files.retain(|module, _| {
                *module != of_tests && !module.starts_with(&format!("{of_tests}::"))
            });
        }
    }
    for text in files.values_mut() {
        if let Some(at) = text
            .find("#[cfg(test)]\n#[allow")
            .or_else(|| text.find("#[cfg(test)]\nmod tests {"))
        {
            text.truncate(at);
        }
    }
    files
}

fn read(folder: &Path, module: &str, files: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        // The program is no part of the library.
        if module.is_empty() && ["main", "command", "exit", "build"].contains(&name) {
            continue;
        }
        if path.is_dir() {
            read(&path, &join(module, name), files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = if name == "lib" {
                String::new()
            } else {
                join(module, name)
            };
            files.insert(name, fs::read_to_string(&path).unwrap());
        }
    }
}

fn join(module: &str, name: &str) -> String {
    if module.is_empty() {
        name.to_owned()
    } else {
        format!("{module}::{name}")
    }
}

/// The paths that `tree`, as in `a::{b, c::{self, d}}`, stands for.
fn paths(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((head, rest)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap().trim().to_owned()];
    };
    let inner = &rest[..rest.rfind('}').unwrap()];
    let (mut depth, mut parts) = (0, vec![String::new()]);
    for c in inner.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        parts.last_mut().unwrap().push(c);
    }
    let parts = parts.iter().filter(|part| !part.trim().is_empty());
    parts
        .flat_map(|part| paths(part))
        .map(|path| format!("{head}{path}").replace("::self", ""))
        .collect()
}

/// The module that a path in `module` leads to, and the rest of the path; `None` for other crates.
fn resolve(module: &str, path: &str, files: &BTreeMap<String, String>) -> Option<(String, String)> {
    let mut base: Vec<&str> = module.split("::").filter(|part| !part.is_empty()).collect();
    let mut parts = path.split("::").peekable();
    match *parts.peek()? {
        "crate" => {
            base.clear();
            parts.next();
        }
        "self" => drop(parts.next()),
        "super" => {
            while parts.next_if_eq(&"super").is_some() {
                base.pop()?;
            }
        }
        child if files.contains_key(&join(module, child)) => {}
        _ => return None,
    }
    base.extend(parts);
    (0..=base.len()).rev().find_map(|length| {
        let module = base[..length].join("::");
        let name = base.get(length).copied().unwrap_or_default();
        files
            .contains_key(&module)
            .then(|| (module, name.to_owned()))
    })
}

/// For each module the modules in which the names that it imports are defined.
fn graph(files: &BTreeMap<String, String>) -> BTreeMap<String, BTreeSet<String>> {
    let mut imported: Vec<(String, String, String)> = Vec::new();
    let mut passed_on: BTreeMap<(String, String), (String, String)> = BTreeMap::new();
    for (module, text) in files {
        // What lies in a module within a file belongs to the file.
        let text = text.replace("\n    use super::", "\n    use self::");
        for statement in text.split(';') {
            // The last line that begins so: what comes before belongs to another item.
            let starts = |line: &&str| {
                let line = line.trim_start();
                line.starts_with("use ") || line.starts_with("pub") && line.contains(" use ")
            };
            let Some(line) = statement.lines().rfind(starts) else {
                continue;
            };
            let is_passed_on = line.trim_start().starts_with("pub");
            let at = statement.rfind(line).unwrap();
            let tree = statement[at..].split_once("use ").unwrap().1;
            for path in paths(tree) {
                let Some((from, name)) =
                    resolve(module, &path.replace(char::is_whitespace, ""), files)
                else {
                    continue;
                };
                let is_child = module.is_empty() || from.starts_with(&format!("{module}::"));
                if !(is_passed_on && is_child) {
                    imported.push((module.clone(), from.clone(), name.clone()));
                }
                if is_passed_on {
                    passed_on.insert((module.clone(), name.clone()), (from, name));
                }
            }
        }
    }
    let mut graph: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (module, mut from, mut name) in imported {
        while let Some(next) = passed_on.get(&(from.clone(), name.clone())) {
            (from, name) = next.clone();
        }
        if from != module {
            graph.entry(module).or_default().insert(from);
        }
    }
    graph
}

/// Whether a path along imports, continued from `module`, comes back to itself; if so, `path` ends
/// with the circle.
fn circle(
    module: &str,
    graph: &BTreeMap<String, BTreeSet<String>>,
    path: &mut Vec<String>,
    done: &mut BTreeSet<String>,
) -> bool {
    if path.iter().any(|on_path| on_path == module) {
        path.push(module.to_owned());
        return true;
    }
    if done.contains(module) {
        return false;
    }
    path.push(module.to_owned());
    let next = graph.get(module).into_iter().flatten();
    if next.into_iter().any(|next| circle(next, graph, path, done)) {
        return true;
    }
    path.pop();
    done.insert(module.to_owned());
    false
}

#[test]
fn no_import_leads_back() {
    let files = files();
    let graph = graph(&files);
    // Else nothing was read.
    assert!(
        graph.values().map(BTreeSet::len).sum::<usize>() > 300,
        "{graph:?}"
    );
    let mut done = BTreeSet::new();
    for module in graph.keys() {
        let mut path = Vec::new();
        assert!(
            !circle(module, &graph, &mut path, &mut done),
            "{}",
            path.join(" → ")
        );
    }
}
