//! Import cycles between files. A re-exported name counts for the file that defines it.

use std::collections::{BTreeMap, BTreeSet};

use super::{Source, after_word, name, sources};

/// Largest number of files in a cycle, small enough to be read as one.
const MOST_IN_CIRCLE: usize = 4;

/// Returns the paths of an import tree, `a/b` and `a/c` of `a::{b, c as d}`, and the text after it.
fn tree(text: &str) -> (Vec<String>, &str) {
    let mut paths = Vec::new();
    if let Some(mut rest) = text.strip_prefix('{') {
        loop {
            rest = rest.trim_start_matches([',', ' ', '\n']);
            if rest.is_empty() || rest.starts_with('}') {
                return (paths, rest.get(1..).unwrap_or_default());
            }
            let (more, after) = tree(rest);
            paths.extend(more);
            rest = &after[after.find([',', '}']).unwrap_or(after.len())..];
        }
    }
    let first = name(text);
    let after = &text[first.len()..];
    let Some((below, after)) = after.strip_prefix("::").map(tree) else {
        return (vec![first], after);
    };
    paths.extend(below.iter().map(|path| format!("{first}/{path}")));
    (paths, after)
}

/// Returns a path written in a module, from the root on.
fn from_root(module: &str, path: &str) -> String {
    let mut parts: Vec<&str> = module.split('/').collect();
    for name in path.split('/') {
        match name {
            "crate" => parts.clear(),
            "super" => drop(parts.pop()),
            "self" => {}
            _ => parts.push(name),
        }
    }
    parts.join("/")
}

/// Files by their paths from the root, with the paths that each imports, and the origins of re-exported names.
#[derive(Default)]
struct Imports {
    named: BTreeMap<String, Vec<String>>,
    given_on: BTreeMap<String, String>,
}

impl Imports {
    fn of(sources: &[Source]) -> Imports {
        let mut imports = Imports::default();
        for source in sources {
            let module = source.modules().join("/");
            // Unit tests inside a file import what they test.
            let code = source.code.split("#[cfg(test)]\nmod").next();
            let code = code.unwrap_or_default();
            let mut named = Vec::new();
            let children = after_word(code, "mod ").map(name);
            for start in children.chain(["crate", "super", "self"].map(String::from)) {
                for rest in after_word(code, &format!("{start}::")) {
                    let (before, path) = code.split_at(code.len() - rest.len() - start.len() - 2);
                    if before.ends_with("pub(in ") {
                        continue;
                    }
                    let statement = before.rsplit([';', '{', '}']).next().unwrap_or_default();
                    let paths = tree(path).0;
                    let paths: Vec<_> = paths.iter().map(|path| from_root(&module, path)).collect();
                    if statement.contains("pub") && statement.ends_with("use ") {
                        let here = |path: &str| {
                            path.rsplit('/')
                                .next()
                                .map(|name| format!("{module}/{name}"))
                        };
                        let given_on = paths
                            .iter()
                            .filter_map(|path| Some((here(path)?, path.clone())));
                        imports.given_on.extend(given_on);
                    }
                    named.extend(paths);
                }
            }
            imports.named.insert(module, named);
        }
        imports
    }

    /// Returns the file that defines the target of a path; the root for other crates.
    fn file_of(&self, path: &str) -> String {
        let ends = path.match_indices('/').map(|(end, _)| end);
        let mut file = "";
        for end in ends.chain([path.len()]) {
            if self.named.contains_key(&path[..end]) {
                file = &path[..end];
            } else if let Some(from) = self.given_on.get(&path[..end]) {
                return self.file_of(&format!("{from}{}", &path[end..]));
            }
        }
        file.to_owned()
    }

    /// Returns the files that each file imports.
    fn of_files(&self) -> Graph {
        let files = |paths: &Vec<String>| paths.iter().map(|path| self.file_of(path)).collect();
        let named = self.named.iter();
        named
            .map(|(file, paths)| (file.clone(), files(paths)))
            .collect()
    }

    /// Returns the folders from which each sibling folder imports.
    fn of_folders(&self) -> Graph {
        let is_folder = |place: &String| {
            self.named
                .keys()
                .any(|file| file.starts_with(&format!("{place}/")))
        };
        let mut graph = Graph::new();
        for (one, others) in self.of_files() {
            for other in others {
                let pairs = one.split('/').zip(other.split('/'));
                let depth = 1 + pairs.take_while(|(one, other)| one == other).count();
                let beside = [&one, &other]
                    .map(|file| file.split('/').take(depth).collect::<Vec<_>>().join("/"));
                if beside.iter().all(is_folder) {
                    let [one, other] = beside;
                    graph.entry(one).or_default().insert(other);
                }
            }
        }
        graph
    }
}

/// Imports of each place.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Returns the places reachable from one.
fn reached<'a>(graph: &'a Graph, from: &'a String) -> BTreeSet<&'a String> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(place) = open.pop() {
        let next = graph.get(place).into_iter().flatten();
        open.extend(next.filter(|next| found.insert(*next)));
    }
    found
}

/// Returns the cycles of a graph, each with its places.
fn circles(graph: &Graph) -> BTreeSet<Vec<&String>> {
    let reached: BTreeMap<&String, BTreeSet<&String>> = graph
        .keys()
        .map(|place| (place, reached(graph, place)))
        .collect();
    let circle = |(place, to): (&&String, &BTreeSet<&String>)| {
        let back = |other: &&&String| to.contains(**other) && reached[*other].contains(*place);
        reached.keys().filter(back).copied().collect()
    };
    let circles = reached.iter().map(circle);
    circles.filter(|circle: &Vec<_>| circle.len() > 1).collect()
}

#[test]
fn files_import_in_one_direction() {
    let imports = Imports::of(&sources()).of_files();
    let mut wrong = circles(&imports);
    wrong.retain(|circle| circle.len() > MOST_IN_CIRCLE);
    assert!(wrong.is_empty(), "circles of files: {wrong:#?}");
}

#[test]
fn folders_import_in_one_direction() {
    let imports = Imports::of(&sources()).of_folders();
    assert_eq!(circles(&imports), BTreeSet::new());
    assert!(imports.len() > 15, "{imports:?}");
}

#[test]
fn a_name_that_is_given_on_counts_for_its_file() {
    let found = |of_c: &str| {
        let of_a = "mod b;\nmod c;\n\npub use b::B;\npub use c::{C, D};";
        let of_b = "use super::{C, D as Other};";
        let sources = [("a/mod.rs", of_a), ("a/b.rs", of_b), ("a/c.rs", of_c)];
        let sources = sources.map(|(place, code)| Source::new(place, code));
        format!("{:?}", circles(&Imports::of(&sources).of_files()))
    };
    assert_eq!(found("pub struct C;"), "{}");
    assert_eq!(found("use crate::a::B;"), r#"{["a/b", "a/c"]}"#);
    assert_eq!(found("fn f() { super::g() }"), r#"{["a", "a/b", "a/c"]}"#);
}
