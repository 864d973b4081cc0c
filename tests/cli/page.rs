//! `--report`: one self-contained page, for every command with rows.

use std::process::Command;

use super::program::{Folder, free};

/// Commands with a page, run in a folder with `scene.toml`.
const COMMANDS: [&[&str]; 6] = [
    &["simulate", "scene.toml", "--reactions"],
    &["kinematics", "scene.toml", "--forces"],
    &["statics", "scene.toml", "--torque", "1 N m"],
    &["inverse"],
    &[
        "precision",
        "scene.toml",
        "--repeats",
        "1",
        "--tolerances",
        "1e-6,1e-9",
    ],
    &[
        "sweep",
        "scene.toml",
        "--vary",
        "geometry.offset=0 mm:10 mm:5",
    ],
];

/// Returns a page without its scripts.
fn outside_scripts(page: &str) -> String {
    let mut parts = page.split("<script");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        text + part.split("</script>").nth(1).unwrap_or_default()
    })
}

#[test]
fn the_page_shows_key_figures_terms_events_scene_and_command() {
    let text = format!("title = \"A pump\"\n{}", free("revolutions = 3"));
    let folder = Folder::with(&text);
    let arguments = ["simulate", "scene.toml", "--report", "page.html"];
    let shown = folder.run(&arguments).done().stdout;
    // A slash may be escaped as a character reference.
    let page = outside_scripts(&folder.read("page.html")).replace("&#x2f;", "/");
    assert!(page.starts_with("<!DOCTYPE html>"));
    let (facts, _) = shown.split_once("\n\n").expect("facts, then rows");
    for line in facts.lines() {
        let value = line[18..].trim();
        assert!(page.contains(value), "`{value}` is not on the page");
    }
    for wanted in [
        "<title>A pump</title>",
        "What is modelled",
        "slider inertia",
        "Coulomb friction",
        "dead-centre",
        "[geometry]",
        "slider-crank simulate scene.toml --report page.html",
    ] {
        assert!(page.contains(wanted), "no `{wanted}` on the page");
    }
    assert_eq!(folder.names(), ["page.html", "scene.toml"]);
}

#[test]
fn every_command_with_rows_has_a_page_and_nothing_is_loaded() {
    let folder = Folder::with(&free("revolutions = 3"));
    for command in COMMANDS {
        let arguments = [command, &["--report", "page.html"]].concat();
        folder.run(&arguments).done();
        let page = folder.read("page.html");
        assert!(page.contains("slider-crank "), "{command:?}");
        for elsewhere in ["src=", "@import", "url(", "<script src", "fetch("] {
            let outside = outside_scripts(&page);
            assert!(!outside.contains(elsewhere), "{command:?}: `{elsewhere}`");
        }
    }
}

#[test]
fn texts_of_the_scene_mean_themselves() {
    let script = "<script>alert(1)</script>";
    let title = format!("title = 'r < l & \"e\" > 0 {script}'\n");
    let folder = Folder::with(&format!("{title}{}", free("revolutions = 1")));
    for command in COMMANDS.iter().filter(|command| command.len() > 1) {
        folder
            .run(&[command, &["--report", "page.html"][..]].concat())
            .done();
        let page = folder.read("page.html");
        assert!(!page.contains(script), "{command:?}");
        assert!(page.contains("<h1>r &lt; l &amp; &quot;e&quot; &gt; 0 &lt;script&gt;"));
    }
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
    assert!(page.contains("role=\"note\"><strong>stopped early</strong>"));
}

#[test]
fn the_page_goes_to_a_file_of_its_own() {
    let folder = Folder::with(&free("revolutions = 1"));
    let run = |more: &[&str]| folder.run(&[&["simulate", "scene.toml"], more].concat());
    run(&["--report", "-"]).fails(2, &["standard output"]);
    run(&["--report", "scene.toml"]).fails(2, &["overwritten"]);
    run(&["--report", "a", "--plot", "a"]).fails(2, &["two results"]);
    run(&["--report", "a.pdf"]).fails(2, &["a.html"]);
    run(&["--report", "none/page.html"]).fails(1, &["none"]);
    assert_eq!(folder.names(), ["scene.toml"]);
}

/// Returns a browser that can run headless, if this machine has one.
fn browser() -> Option<&'static str> {
    let found = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(found)
}

/// Runs a script on a page in virtual time, with animation frames on the same clock; returns the page's errors, the
/// number of resources it loaded, and the values that the script reports.
fn probed(browser: &str, folder: &Folder, page: &str, script: &str) -> Vec<String> {
    let watch = "<script>window.failed = []; addEventListener('error', (e) => failed.push(e.message)); \
                 console.error = (...all) => failed.push(all.join(' ')); \
                 window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);</script>";
    let ask = format!(
        "<script>(async () => {{
            const wait = (ms) => new Promise((done) => setTimeout(done, ms));
            const key = (name) => document.body.dispatchEvent(new KeyboardEvent('keydown', {{ key: name, bubbles: true }}));
            const get = (id) => document.getElementById(id);
            const said = [];
            await wait(200);
            {script}
            said.unshift(failed.join('; '), performance.getEntriesByType('resource').length);
            const note = document.createElement('pre');
            note.id = 'probe';
            note.textContent = said.join('|');
            document.body.append(note);
        }})();</script></body>"
    );
    let page = page
        .replacen("<head>", &format!("<head>{watch}"), 1)
        .replacen("</body>", &ask, 1);
    let file = folder.path("probe.html");
    std::fs::write(&file, page).expect("a page to probe");
    let output = Command::new(browser)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--virtual-time-budget=8000",
        ])
        .arg(format!(
            "--user-data-dir={}",
            folder.path("profile").display()
        ))
        .arg("--dump-dom")
        .arg(format!("file://{}", file.display()))
        .output()
        .expect("the browser");
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = dom.split("<pre id=\"probe\">").nth(1).expect("an answer");
    let said = said.split("</pre>").next().unwrap_or_default();
    said.split('|').map(str::to_owned).collect()
}

#[test]
fn pages_run_in_a_browser() {
    let Some(browser) = browser() else {
        eprintln!("no Chromium here: the pages are not opened");
        return;
    };
    let folder = Folder::with(&free("revolutions = 3"));
    for command in COMMANDS {
        let more = ["--report", "page.html"];
        folder.run(&[command, &more[..]].concat()).done();
        let page = folder.read("page.html");
        let script = "said.push(document.querySelectorAll('canvas').length);";
        let said = probed(browser, &folder, &page, script);
        assert_eq!(said[..2], ["", "0"], "{command:?}");
        assert!(
            said[2].parse::<u32>().is_ok_and(|plots| plots > 0),
            "{said:?}"
        );
    }
}

/// Logarithmic axes have ticks on every range: those of the plotting library never end on this one.
#[test]
fn logarithmic_axes_have_ticks_on_every_range() {
    let Some(browser) = browser() else {
        eprintln!("no Chromium here: the page is not opened");
        return;
    };
    let folder = Folder::with(&free("revolutions = 3"));
    let masses = "slider.mass=0.00014881439483446118kg,0.0008681066868469929kg";
    let arguments = ["sweep", "scene.toml", "--vary", masses];
    let more = ["--report", "page.html", "--out", "rows.csv"];
    folder.run(&[&arguments[..], &more[..]].concat()).done();
    let script = "
        get('log').checked = true;
        get('log').onchange();
        await wait(100);
        said.push(get('x').value, document.querySelectorAll('canvas').length);";
    let said = probed(browser, &folder, &folder.read("page.html"), script);
    assert_eq!(said, ["", "0", "slider_mass_kg", "1"]);
}

/// The animation moves, the keys step through it, and the cursor shows the values of the CSV file.
#[test]
fn the_cursor_has_the_values_of_the_rows() {
    let Some(browser) = browser() else {
        eprintln!("no Chromium here: the page is not opened");
        return;
    };
    let folder = Folder::with(&free("revolutions = 3"));
    let files = ["--report", "page.html", "--out", "rows.csv"];
    folder
        .run(&[&["simulate", "scene.toml"], &files[..]].concat())
        .done();
    let script = "
        const moving = () => document.querySelector('#mechanism').innerHTML;
        const before = moving();
        key(' ');
        await wait(1000);
        said.push([moving() !== before, get('play').textContent, get('time').textContent]);
        key(' ');
        key('Home');
        for (let i = 0; i < 5; i++) key('ArrowRight');
        get('row').open = true;
        await wait(100);
        said.push([...document.querySelectorAll('#row td')].slice(0, 8).map((cell) => cell.textContent).join(','));
        key('n');
        said.push(get('event').textContent);
        const plot = document.querySelector('.u-over').getBoundingClientRect();
        document.querySelector('.u-over').dispatchEvent(
            new MouseEvent('mousemove', { clientX: plot.left + plot.width / 2, clientY: plot.top + 9, bubbles: true }));
        await wait(100);
        said.push(get('place').value);
        get('over').selectedIndex = 2;
        get('over').onchange();
        await wait(100);
        said.push(document.querySelectorAll('.panel canvas').length);";
    let said = probed(browser, &folder, &folder.read("page.html"), script);
    let rows = folder.read("rows.csv");
    let lines: Vec<&str> = rows.lines().collect();
    assert_eq!(said[..2], ["", "0"], "{said:?}");
    assert!(said[2].starts_with("true,Pause"), "{said:?}");
    assert_eq!(said[3], lines[6]);
    assert_eq!(said[4], "dead-centre");
    let middle = (lines.len() - 1) / 2;
    let row: usize = said[5].parse().expect("a row");
    assert!(row.abs_diff(middle) < 3, "{row} of {}", lines.len());
    assert!(said[6].parse::<u32>().is_ok_and(|plots| plots > 5));
}
