//! Self-contained HTML page of a result: animated mechanism, linked plots, key figures, plan and scene.

use minijinja::{AutoEscape, Environment, Value, context};
use serde::Serialize;

use super::default_view::{DefaultView, Scatter};
use super::dimensions::Dimensions;
use super::key_values::Facts;
use super::table::{Shown, Table};
use crate::error::Error;
use crate::simulate::Event;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("style.css");
const SCRIPTS: [&str; 5] = [
    include_str!("data.js"),
    include_str!("mechanism.js"),
    include_str!("plots.js"),
    include_str!("player.js"),
    include_str!("scatter.js"),
];
/// uPlot 1.6.32, MIT licence, unchanged.
const PLOTS: [&str; 2] = [
    include_str!("uPlot.min.css"),
    include_str!("uPlot.iife.min.js"),
];

/// Origin of a result: scene file, and command that repeats it.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Text of the scene file; none if read from a pipe.
    pub scene: Option<String>,
    /// Command line.
    pub command: String,
}

/// Data that the scripts of the page read.
#[derive(Serialize)]
struct Data<'a> {
    columns: Vec<Shown<'a>>,
    drawing: Option<Dimensions>,
    events: &'a [Event],
    /// Half-width of a band, in standard errors.
    band: f64,
    /// Whether curves have poles at dead centres.
    poles: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    scatter: &'a Option<Scatter>,
}

/// Returns the cells of an event in the list.
fn listed(event: &Event) -> [String; 4] {
    let shown = |value: f64| match value.is_finite() {
        true => format!("{value:.9}"),
        false => "no bound".to_owned(),
    };
    let [t, theta, omega] = [event.t_s, event.theta_rad, event.omega_rad_per_s].map(shown);
    [event.kind.to_owned(), t, theta, omega]
}

/// Renders the page. It loads nothing from elsewhere, and escapes all texts of the scene.
pub(super) fn html(
    origin: &Origin,
    facts: &Facts,
    table: &Table,
    default: &DefaultView<'_>,
) -> Result<String, Error> {
    let (titles, facts): (Vec<_>, Vec<_>) = facts.0.iter().partition(|(name, _)| name == "scene");
    let mut notes = Vec::new();
    if table.stride > 1 {
        notes.push(format!("One in {} rows is shown.", table.stride));
    }
    let mut terms: Vec<[String; 3]> = Vec::new();
    let mut events: &[Event] = &[];
    if let Some(run) = default.run {
        let plan = &run.plan;
        for (what, of) in [("kept", &plan.kept), ("left out", &plan.left_out)] {
            for term in of {
                let (name, reason) = (term.name.to_string(), term.reason.to_string());
                terms.push([name, what.to_owned(), reason]);
            }
        }
        events = &run.events;
        let (listed, total) = (events.len(), run.events_total);
        if total > listed as u64 {
            notes.push(format!("The first {listed} of {total} events are listed."));
        }
    }
    let data = Data {
        columns: table.shown(),
        drawing: default.scene.map(Dimensions::of),
        events,
        band: default.band,
        poles: default.has_poles,
        scatter: &default.scatter,
    };
    // Only the end tag has a meaning inside a script element; JSON can escape it.
    let failed = Error::write("page");
    let data = serde_json::to_string(&data).map_err(|error| failed(error.into()))?;
    let data = data.replace('<', "\\u003c");
    // The scripts have all events.
    let most_listed = 1000;
    let (first, others) = events.split_at(events.len().min(most_listed));
    let listed: Vec<_> = first.iter().map(listed).collect();
    let [plot_style, plot_script] = PLOTS.map(|text| Value::from_safe_string(text.to_owned()));
    let page = context! {
        title => titles.first().map_or("A slider-crank", |(_, title)| title),
        version => env!("CARGO_PKG_VERSION"),
        facts,
        terms,
        notes,
        scene => &origin.scene,
        command => &origin.command,
        events => listed,
        events_left => others.len(),
        figures => default.figures,
        has_scatter => default.scatter.is_some(),
        has_motion => default.scene.is_some(),
        style => Value::from_safe_string(STYLE.to_owned()),
        scripts => Value::from_safe_string(SCRIPTS.join("\n")),
        plot_style,
        plot_script,
        data => Value::from_safe_string(data),
    };
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    let page = environment.render_str(TEMPLATE, page);
    page.map_err(|error| failed(std::io::Error::other(error)))
}
