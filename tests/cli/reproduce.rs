//! `reproduce`: table, files and exit code.

use super::program::Folder;

#[test]
fn a_paper_writes_its_table_and_its_figures() {
    let folder = Folder::new();
    let outcome = folder.run(&["reproduce", "ng", "--out", "made/here"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(
        outcome.stdout.contains("reproduces only if") && outcome.stdout.contains("0 unexpected")
    );
    let numbers = folder.read("made/here/numbers.csv");
    assert!(numbers.starts_with(
        "paper,place,what,unit,printed,ours,conditional,condition,verdict,expected\n"
    ));
    assert!(numbers.lines().count() > 60, "{numbers}");
    for figure in ["ng-figure-07", "ng-figure-08"] {
        assert!(
            folder
                .read(&format!("made/here/{figure}.svg"))
                .starts_with("<svg")
        );
        let data = folder.read(&format!("made/here/{figure}.csv"));
        assert!(data.starts_with("x_axis,y_axis,series,x,y\n") && data.lines().count() > 10);
        assert!(!data.contains("NaN") && !data.contains("inf"));
    }
}

#[test]
fn everything_as_json() {
    let result = Folder::new().run(&["reproduce", "--json"]).done().json();
    assert_eq!(result["unexpected"], 0);
    let entries = result["entries"].as_array().unwrap();
    let counted: u64 = ["reproduces", "reproduces_only_if", "cannot_be_reproduced"]
        .iter()
        .map(|key| result[key].as_u64().unwrap())
        .sum();
    assert_eq!(counted, entries.len() as u64);
    for entry in entries {
        assert_eq!(entry["verdict"], entry["expected"], "{entry}");
    }
}

#[test]
fn an_unknown_paper_is_refused() {
    Folder::new()
        .run(&["reproduce", "euler"])
        .fails(2, &["euler", "obaseki-alfred", "duarte"]);
}
