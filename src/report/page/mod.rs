//! A run as one HTML page that needs nothing beside it.

use std::fmt::Write;

use super::motion::PlotRows;
use super::text::{facts, table};
use crate::error::Error;
use crate::simulate::{Event, Row, Summary};

/// Most events that are listed.
const EVENTS: usize = 200;

const STYLE: &str = "body { font: 16px/1.45 system-ui, sans-serif; color: #1a1a1a; background: #fff; \
max-width: 62rem; margin: 2rem auto; padding: 0 1rem }\n\
h1 { font-size: 1.6rem } h2 { font-size: 1.2rem; margin-top: 2rem }\n\
table { border-collapse: collapse } td, th { padding: .15rem 1rem .15rem 0; text-align: left; vertical-align: top }\n\
th { font-weight: 600; white-space: nowrap } th.part { font-weight: 400; padding-left: 1rem }\n\
td.number { text-align: right; font-variant-numeric: tabular-nums }\n\
tr.warning { background: #fff3cd } svg { max-width: 100%; height: auto }\n\
pre { overflow-x: auto } footer { margin-top: 3rem; color: #555; font-size: .85rem }\n";

/// The summary of a run, its figure, what was modelled, its events and a few of its rows as one HTML page:
/// no scripts, and nothing is loaded from elsewhere.
///
/// # Errors
/// [`Error::Refused`] if there is nothing to draw.
pub fn page(summary: &Summary, rows: &[Row], plot: &PlotRows) -> Result<String, Error> {
    let title = match summary.scene.as_str() {
        "" => "A slider-crank",
        title => title,
    };
    let title = escape(title);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
    );
    summed_up(&mut page, summary);
    section(&mut page, "Motion", &plot.to_svg(summary)?);
    section(&mut page, "What is modelled", &terms(summary));
    if !summary.events.is_empty() {
        section(&mut page, "Events", &events(&summary.events));
    }
    if !rows.is_empty() {
        let rows = format!("<pre>{}</pre>\n", escape(&table(rows)));
        section(&mut page, "Some rows", &rows);
    }
    let version = env!("CARGO_PKG_VERSION");
    let _ = write!(
        page,
        "<footer>slider-crank {version}; theta counter-clockwise from +x, x and forces along +x</footer>\n\
         </body>\n</html>\n"
    );
    Ok(page)
}

fn section(page: &mut String, title: &str, content: &str) {
    let _ = write!(page, "<section>\n<h2>{title}</h2>\n{content}</section>\n");
}

fn summed_up(page: &mut String, summary: &Summary) {
    page.push_str("<table>\n");
    for (name, value) in facts(summary).iter().filter(|(name, _)| *name != "scene") {
        let part = if name.starts_with(' ') {
            " class=\"part\""
        } else {
            ""
        };
        let row = match name {
            "warning" | "stopped early" => " class=\"warning\"",
            _ => "",
        };
        let (name, value) = (escape(name.trim()), escape(value));
        let _ = writeln!(page, "<tr{row}><th{part}>{name}</th><td>{value}</td></tr>");
    }
    page.push_str("</table>\n");
}

fn terms(summary: &Summary) -> String {
    let mut text = String::from("<table>\n");
    let (kept, left_out) = (&summary.plan.kept, &summary.plan.left_out);
    let all = kept.iter().map(|term| ("kept", term));
    for (what, term) in all.chain(left_out.iter().map(|term| ("left out", term))) {
        let (name, reason) = (escape(&term.name), escape(&term.reason));
        let _ = writeln!(
            text,
            "<tr><th>{name}</th><td>{what}</td><td>{reason}</td></tr>"
        );
    }
    text.push_str("</table>\n");
    text
}

fn events(events: &[Event]) -> String {
    let mut text = String::from(
        "<table>\n<tr><th>event</th><th>t [s]</th><th>theta [rad]</th><th>omega [rad/s]</th></tr>\n",
    );
    for event in events.iter().take(EVENTS) {
        let _ = write!(text, "<tr><td>{}</td>", event.kind);
        for value in [event.t_s, event.theta_rad, event.omega_rad_per_s] {
            let shown = match value.is_finite() {
                true => format!("{value:.9}"),
                false => "no bound".to_owned(),
            };
            let _ = write!(text, "<td class=\"number\">{shown}</td>");
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</table>\n");
    if events.len() > EVENTS {
        let _ = writeln!(text, "<p>The first {EVENTS}.</p>");
    }
    text
}

/// A text that means itself in HTML.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // HTML has no control characters but these.
            c if c.is_control() && !matches!(c, '\n' | '\t') => escaped.extend(c.escape_default()),
            c => escaped.push(c),
        }
    }
    escaped
}
