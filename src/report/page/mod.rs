//! A result as one HTML page that opens offline: the mechanism in motion, linked plots, key figures, plan and scene.

use minijinja::{AutoEscape, Environment, Value, context};
use serde::Serialize;

use super::key_values::Facts;
use super::sketch::Drawing;
use super::table::{Shown, Table};
use crate::error::Error;
use crate::scene::Scene;
use crate::simulate::{Event, Summary};

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("style.css");
const SCRIPTS: [&str; 5] = [
    include_str!("data.js"),
    include_str!("mechanism.js"),
    include_str!("plots.js"),
    include_str!("player.js"),
    include_str!("scatter.js"),
];
/// uPlot 1.6.32, MIT licence, as its package has it.
const PLOTS: [&str; 2] = [
    include_str!("uPlot.min.css"),
    include_str!("uPlot.iife.min.js"),
];

/// Where a result comes from: the scene file and the command that repeats it.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Text of the scene file; none of one that was read from a pipe.
    pub scene: Option<String>,
    /// The command line.
    pub command: String,
}

/// A page in the making.
pub struct Page<'a> {
    origin: &'a Origin,
    title: String,
    facts: Vec<Fact>,
    terms: Vec<[String; 3]>,
    table: Option<&'a Table>,
    drawing: Option<Drawing>,
    events: &'a [Event],
    band: f64,
    has_poles: bool,
    scatter: Option<Scatter>,
    notes: Vec<String>,
    figures: Vec<String>,
}

/// A fact for the template.
#[derive(Serialize)]
struct Fact {
    name: String,
    value: String,
    /// Belongs to the one before.
    is_part: bool,
    is_warning: bool,
}

/// What the scripts of the page read.
#[derive(Serialize)]
struct Data<'a> {
    columns: Vec<Shown<'a>>,
    drawing: &'a Option<Drawing>,
    events: Vec<Mark>,
    /// Half the width of a band in standard errors.
    band: f64,
    /// Whether curves grow without bound towards dead centres.
    poles: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    scatter: &'a Option<Scatter>,
}

/// What is shown at first of rows that are no motion.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Scatter {
    pub x: String,
    pub y: String,
    /// Column of the colour, or empty.
    pub colour: String,
    /// Whether both axes are logarithmic.
    pub log: bool,
    /// Whether rows of a kind are joined.
    pub lines: bool,
    /// Column of the kinds that are told apart.
    pub kind: &'static str,
    /// Column of what is shown one at a time.
    pub within: &'static str,
}

/// An event as the scripts read it.
#[derive(Serialize)]
struct Mark {
    kind: &'static str,
    t: f64,
    theta: f64,
    omega: Option<f64>,
}

impl<'a> Page<'a> {
    /// The page of a result with these facts.
    pub(super) fn new(origin: &'a Origin, facts: &Facts) -> Page<'a> {
        let mut title = "A slider-crank".to_owned();
        let mut shown = Vec::new();
        for (name, value) in facts.iter() {
            if name == "scene" {
                value.clone_into(&mut title);
                continue;
            }
            shown.push(Fact {
                name: name.trim().to_owned(),
                value: value.to_owned(),
                is_part: name.starts_with(' '),
                is_warning: matches!(name, "warning" | "stopped early"),
            });
        }
        Page {
            origin,
            title,
            facts: shown,
            terms: Vec::new(),
            table: None,
            drawing: None,
            events: &[],
            band: 0.0,
            has_poles: false,
            scatter: None,
            notes: Vec::new(),
            figures: Vec::new(),
        }
    }

    /// With rows.
    pub fn table(mut self, table: &'a Table) -> Page<'a> {
        if table.stride > 1 {
            let stride = table.stride;
            self.notes.push(format!("One in {stride} rows is shown."));
        }
        self.table = Some(table);
        self
    }

    /// With the mechanism of a scene.
    pub fn mechanism(mut self, scene: &Scene) -> Page<'a> {
        self.drawing = Some(Drawing::of(scene));
        self
    }

    /// With what was modelled and left out.
    pub fn terms(mut self, summary: &Summary) -> Page<'a> {
        let plan = &summary.plan;
        for (what, terms) in [("kept", &plan.kept), ("left out", &plan.left_out)] {
            self.terms.extend(terms.iter().map(|term| {
                let (name, reason) = (term.name.to_string(), term.reason.to_string());
                [name, what.to_owned(), reason]
            }));
        }
        self
    }

    /// With events; `total` of them in all.
    pub fn events(mut self, events: &'a [Event], total: u64) -> Page<'a> {
        if total > events.len() as u64 {
            let listed = events.len();
            self.notes
                .push(format!("The first {listed} of {total} events are listed."));
        }
        self.events = events;
        self
    }

    /// With figures, given as SVG, that stand as they are.
    pub(super) fn figures(mut self, figures: Vec<String>) -> Page<'a> {
        self.figures = figures;
        self
    }

    /// With bands of so many standard errors to both sides.
    pub fn band(mut self, factor: f64) -> Page<'a> {
        self.band = factor;
        self
    }

    /// With curves that grow without bound towards dead centres: their bulk is shown.
    pub fn with_poles(mut self) -> Page<'a> {
        self.has_poles = true;
        self
    }

    /// With rows that are no motion: one column over another.
    pub(super) fn scatter(mut self, scatter: Scatter) -> Page<'a> {
        self.scatter = Some(scatter);
        self
    }

    /// The page. Nothing is loaded from elsewhere; all texts of the scene are shown as text.
    ///
    /// # Errors
    /// [`Error::Write`] if the template fails, which would be a defect.
    pub fn html(&self) -> Result<String, Error> {
        let data = Data {
            columns: self.table.map_or_else(Vec::new, Table::shown),
            drawing: &self.drawing,
            events: self.events.iter().map(mark).collect(),
            band: self.band,
            poles: self.has_poles,
            scatter: &self.scatter,
        };
        // Inside of a script element only its end tag means anything, and JSON may write it otherwise.
        let data = serde_json::to_string(&data)
            .map_err(|error| failed(error.into()))?
            .replace('<', "\\u003c");
        let listed: Vec<_> = self.events.iter().take(LISTED).map(listed).collect();
        let [plot_style, plot_script] = PLOTS.map(|text| Value::from_safe_string(text.to_owned()));
        let page = context! {
            title => &self.title,
            version => env!("CARGO_PKG_VERSION"),
            facts => Value::from_serialize(&self.facts),
            terms => Value::from_serialize(&self.terms),
            notes => Value::from_serialize(&self.notes),
            scene => &self.origin.scene,
            command => &self.origin.command,
            events => Value::from_serialize(&listed),
            events_left => self.events.len().saturating_sub(LISTED),
            figures => Value::from_serialize(&self.figures),
            has_scatter => self.scatter.is_some(),
            has_motion => self.drawing.is_some() && self.table.is_some(),
            style => Value::from_safe_string(STYLE.to_owned()),
            scripts => Value::from_safe_string(SCRIPTS.join("\n")),
            plot_style,
            plot_script,
            data => Value::from_safe_string(data),
        };
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment
            .render_str(TEMPLATE, page)
            .map_err(|error| failed(error.into()))
    }
}

/// Most events in the list; the scripts have all.
const LISTED: usize = 1000;

fn mark(event: &Event) -> Mark {
    Mark {
        kind: event.kind,
        t: event.t_s,
        theta: event.theta_rad,
        omega: Some(event.omega_rad_per_s).filter(|omega| omega.is_finite()),
    }
}

fn listed(event: &Event) -> [String; 4] {
    let shown = |value: f64| match value.is_finite() {
        true => format!("{value:.9}"),
        false => "no bound".to_owned(),
    };
    let [t, theta, omega] = [event.t_s, event.theta_rad, event.omega_rad_per_s].map(shown);
    [event.kind.to_owned(), t, theta, omega]
}

fn failed(source: Box<dyn std::error::Error + Send + Sync>) -> Error {
    Error::Write {
        target: "page".to_owned(),
        source: std::io::Error::other(source),
    }
}
