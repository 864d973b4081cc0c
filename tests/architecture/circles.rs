//! Circles of files that import each other. A re-exported name counts for the file that defines it.

use std::collections::{BTreeMap, BTreeSet};

use super::{Source, after_word, name, sources};

/// The modules that lead to a file, or the names of a path.
type Path = Vec<String>;

/// Files of a circle that are read as one.
const MOST_IN_CIRCLE: usize = 4;

/// Larger circles that are still there, by folder and number of files. The list may only shrink.
const STILL_LARGER: &[(&str, usize)] = &[
    ("engine/energy", 14),
    ("inverse", 14),
    ("inverse/identify", 7),
    ("simulate", 14),
];

/// The paths of a tree of imports, `a::b` and `a::c` of `a::{b, c as d}`, and what follows it.
fn tree(text: &str) -> (Vec<Path>, &str) {
    let mut paths = Vec::new();
    if let Some(group) = text.strip_prefix('{') {
        let mut rest = group.trim_start();
        while !rest.is_empty() && !rest.starts_with('}') {
            let (more, after) = tree(rest);
            paths.extend(more);
            let end = after.find([',', '}']).unwrap_or(after.len());
            rest = after[end..].trim_start_matches(',').trim_start();
        }
        return (paths, rest.strip_prefix('}').unwrap_or(rest));
    }
    let first = name(text);
    let after = &text[first.len()..];
    let Some(below) = after.strip_prefix("::") else {
        return (vec![vec![first]], after);
    };
    let (below, after) = tree(below);
    paths.extend(
        below
            .into_iter()
            .map(|path| [vec![first.clone()], path].concat()),
    );
    (paths, after)
}

/// What the files name, and what they give on.
#[derive(Default)]
struct Imports {
    /// Paths from the root that each file names.
    named: BTreeMap<Path, Vec<Path>>,
    /// The path from the root of each name that a file re-exports.
    given_on: BTreeMap<(Path, String), Path>,
}

impl Imports {
    fn of(sources: &[Source]) -> Imports {
        let module =
            |source: &Source| -> Path { source.modules().into_iter().map(str::to_owned).collect() };
        let files: BTreeSet<Path> = sources.iter().map(module).collect();
        let mut imports = Imports::default();
        for source in sources {
            let module = module(source);
            // Tests inside of a file import what they test.
            let code = source
                .code
                .split("#[cfg(test)]\nmod")
                .next()
                .unwrap_or_default();
            let children = files.iter().filter(|file| {
                file.split_last()
                    .is_some_and(|(_, parent)| parent == module)
            });
            let mut starts: Vec<&str> = children
                .filter_map(|file| file.last())
                .map(String::as_str)
                .collect();
            starts.extend(["crate", "super", "self"]);
            let mut named = Vec::new();
            for start in starts {
                for rest in after_word(code, &format!("{start}::")) {
                    let before = &code[..code.len() - rest.len() - start.len() - 2];
                    if before.ends_with("pub(in ") {
                        continue;
                    }
                    let statement = before.rsplit([';', '{', '}']).next().unwrap_or_default();
                    let is_public =
                        statement.contains("pub") && statement.trim_end().ends_with("use");
                    for path in tree(rest).0 {
                        let path = from_root(&module, start, path);
                        if let (true, Some(name)) = (is_public, path.last()) {
                            imports
                                .given_on
                                .insert((module.clone(), name.clone()), path.clone());
                        }
                        named.push(path);
                    }
                }
            }
            imports.named.insert(module, named);
        }
        imports
    }

    /// The file that defines what a path names.
    fn file_of(&self, path: &[String]) -> Path {
        let mut file = Path::new();
        for (k, name) in path.iter().enumerate() {
            let child = [&file[..], &[name.clone()]].concat();
            if self.named.contains_key(&child) {
                file = child;
            } else if let Some(path_of) = self.given_on.get(&(file.clone(), name.clone())) {
                return self.file_of(&[path_of, &path[k + 1..]].concat());
            } else {
                break;
            }
        }
        file
    }

    /// All files that a file depends on, by way of others too.
    fn reached(&self) -> BTreeMap<&Path, BTreeSet<Path>> {
        let direct = |file: &Path| {
            self.named[file]
                .iter()
                .map(|path| self.file_of(path))
                .collect()
        };
        let direct: BTreeMap<&Path, BTreeSet<Path>> =
            self.named.keys().map(|file| (file, direct(file))).collect();
        let all = |file: &Path| {
            let mut found = BTreeSet::new();
            let mut open = vec![file];
            while let Some(file) = open.pop() {
                open.extend(
                    direct[file]
                        .iter()
                        .filter(|next| found.insert((*next).clone())),
                );
            }
            found
        };
        self.named.keys().map(|file| (file, all(file))).collect()
    }

    /// The circles, each with its files.
    fn circles(&self) -> BTreeSet<Vec<&Path>> {
        let reached = self.reached();
        let circle = |file: &Path| -> Vec<&Path> {
            let back =
                |other: &&&Path| reached[file].contains(**other) && reached[**other].contains(file);
            reached.keys().filter(back).copied().collect()
        };
        let circles = reached.keys().map(|file| circle(file));
        circles.filter(|circle| circle.len() > 1).collect()
    }
}

/// A path as it is written in a module, from the root on.
fn from_root(module: &[String], start: &str, rest: Path) -> Path {
    let mut path = match start {
        "crate" => Path::new(),
        "super" => module[..module.len() - 1].to_vec(),
        "self" => module.to_vec(),
        child => [module, &[child.to_owned()]].concat(),
    };
    for name in rest {
        match name.as_str() {
            "super" => drop(path.pop()),
            "self" => {}
            _ => path.push(name),
        }
    }
    path
}

/// The folder that all files of a circle are in.
fn folder(circle: &[&Path]) -> String {
    let depth = (0..).take_while(|k| {
        let name = circle[0].get(*k);
        name.is_some() && circle.iter().all(|file| file.get(*k) == name)
    });
    circle[0][..depth.count()].join("/")
}

#[test]
fn files_import_in_one_direction() {
    let imports = Imports::of(&sources());
    let mut wrong = Vec::new();
    let mut seen = BTreeSet::new();
    for circle in imports.circles() {
        let folder = folder(&circle);
        let known = STILL_LARGER.iter().find(|(known, _)| *known == folder);
        let most = known.map_or(MOST_IN_CIRCLE, |(_, files)| *files);
        if circle.len() > most || folder.is_empty() {
            let files: Vec<String> = circle.iter().map(|file| file.join("/")).collect();
            wrong.push(format!(
                "{} files in {folder}: {}",
                files.len(),
                files.join(", ")
            ));
        } else if circle.len() > MOST_IN_CIRCLE {
            seen.insert(folder);
        }
    }
    assert!(wrong.is_empty(), "circles of imports: {wrong:#?}");
    let gone = STILL_LARGER
        .iter()
        .filter(|(folder, _)| !seen.contains(*folder));
    assert_eq!(
        gone.count(),
        0,
        "an exception that is no longer needed; seen: {seen:?}"
    );
}
