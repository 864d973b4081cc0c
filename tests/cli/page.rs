//! `simulate --report`: one page that needs nothing beside it.

use super::program::{Folder, free};

/// Every element that is opened is closed, in the right order.
#[track_caller]
fn balanced(page: &str) {
    let mut open = Vec::new();
    for part in page.split('<').skip(1) {
        let tag = part.split('>').next().expect("the end of a tag");
        let name = tag.split([' ', '\n', '/']).find(|word| !word.is_empty());
        let name = name.unwrap_or_default();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "closed in another order");
        } else if !tag.ends_with('/') && !["!DOCTYPE", "meta"].contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn the_page_shows_summary_figure_terms_events_and_rows() {
    let folder = Folder::with(&format!("title = \"A pump\"\n{}", free("revolutions = 3")));
    let arguments = ["simulate", "scene.toml", "--report", "page.html"];
    let shown = folder.run(&arguments).done().stdout;
    let page = folder.read("page.html");
    assert!(page.starts_with("<!DOCTYPE html>"));
    balanced(&page);
    let (facts, rows) = shown.split_once("\n\n").expect("facts, then rows");
    assert!(page.contains(rows), "no rows on the page");
    for line in facts.lines() {
        let value = line[18..].trim();
        assert!(page.contains(value), "`{value}` is not on the page");
    }
    for wanted in [
        "<title>A pump</title>",
        "<svg",
        "slider acceleration",
        "What is modelled",
        "slider inertia",
        "Coulomb friction",
        "dead-centre",
        "Some rows",
    ] {
        assert!(page.contains(wanted), "no `{wanted}` on the page");
    }
    for elsewhere in ["src=", "href=", "<script", "@import", "url(http"] {
        assert!(!page.contains(elsewhere), "`{elsewhere}` on the page");
    }
    assert_eq!(folder.names(), ["page.html", "scene.toml"]);
}

#[test]
fn texts_of_the_scene_mean_themselves() {
    let title = "title = 'r < l & \"e\" > 0 <script>alert(1)</script>'\n";
    let folder = Folder::with(&format!("{title}{}", free("revolutions = 1")));
    folder
        .run(&["simulate", "scene.toml", "--json", "--report", "page.html"])
        .done();
    let page = folder.read("page.html");
    balanced(&page);
    assert!(page.contains(
        "<h1>r &lt; l &amp; &quot;e&quot; &gt; 0 &lt;script&gt;alert(1)&lt;/script&gt;</h1>"
    ));
    assert!(!page.contains("<script"));
}

#[test]
fn the_page_of_a_run_that_ends_early_says_so() {
    let folder = Folder::with(&free("duration = \"10 s\""));
    let limited = ["--method", "time", "--max-evaluations", "500"];
    let arguments = [
        &["simulate", "scene.toml", "--report", "page.html"],
        &limited[..],
    ]
    .concat();
    assert_eq!(folder.run(&arguments).code, Some(1));
    let page = folder.read("page.html");
    balanced(&page);
    assert!(page.contains("<tr class=\"warning\"><th>stopped early</th>"));
}

#[test]
fn the_page_goes_to_a_file_of_its_own() {
    let folder = Folder::with(&free("revolutions = 1"));
    let run = |more: &[&str]| folder.run(&[&["simulate", "scene.toml"], more].concat());
    run(&["--report", "-"]).fails(2, &["standard output"]);
    run(&["--report", "scene.toml"]).fails(2, &["overwritten"]);
    run(&["--report", "a", "--plot", "a"]).fails(2, &["two results"]);
    run(&["--report", "none/page.html"]).fails(1, &["none"]);
    assert_eq!(folder.names(), ["scene.toml"]);
}
