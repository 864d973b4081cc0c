//! Summary of a sweep: ranges, percentiles and Pareto front of the key figures, as text and page.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::error::Error;
use crate::report::default_view::{DefaultView, Scatter};
use crate::report::key_values::{Facts, fact, six, text_table};
use crate::report::page::{self, Origin};
use crate::report::table::Table;

/// Summary of a sweep.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SweepSummary {
    /// Title of the scene.
    pub scene: String,
    /// Number of designs of the whole sweep.
    pub designs: usize,
    /// First and last design of the computed part, from 1; the whole sweep without parts.
    pub part: [usize; 2],
    /// Number of designs by status.
    pub status: BTreeMap<String, usize>,
    /// Number of rows taken over from an interrupted sweep.
    pub taken_up: usize,
    /// Varied keys.
    pub varied: Vec<VariedKey>,
    /// Ranges of the key figures.
    pub figures: Vec<SweepRange>,
    /// Non-dominated designs in the goals; empty without goals.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pareto_front: Vec<FrontDesign>,
    /// Wall time of the designs, s.
    pub wall_s: f64,
}

/// Varied key, with its first and last value.
#[derive(Clone, Debug, Serialize)]
pub struct VariedKey {
    /// Key as in scene files.
    pub key: String,
    /// Values of the key as asked for.
    pub values: String,
    /// Number of listed values; 1 for a distribution.
    pub count: usize,
    /// First value, as in scene files; median of a distribution.
    pub first: String,
    /// Last value, as in scene files; median of a distribution.
    pub last: String,
}

/// Range of one key figure.
#[derive(Clone, Debug, Serialize)]
pub struct SweepRange {
    /// Name of the column.
    pub column: String,
    /// Least value.
    pub min: SweepExtreme,
    /// Largest value.
    pub max: SweepExtreme,
    /// Distribution over a sample, or if percentiles are asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<Spread>,
}

/// Distribution of a key figure over the designs, in the unit of its column.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation (divisor n - 1).
    pub standard_deviation: f64,
    /// 2.5 % quantile, interpolated linearly between order statistics (Hyndman and Fan, type 7).
    pub p2_5: f64,
    /// Median.
    pub p50: f64,
    /// 97.5 % quantile.
    pub p97_5: f64,
}

impl Spread {
    /// Computes the distribution of at least one value.
    pub(super) fn of(mut values: Vec<f64>) -> Spread {
        values.sort_unstable_by(f64::total_cmp);
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let quantile = |p: f64| {
            let at = p * (count - 1.0);
            let (below, above) = (values[at.floor() as usize], values[at.ceil() as usize]);
            below + (at - at.floor()) * (above - below)
        };
        Spread {
            mean,
            standard_deviation: (squares / (count - 1.0).max(1.0)).sqrt(),
            p2_5: quantile(0.025),
            p50: quantile(0.5),
            p97_5: quantile(0.975),
        }
    }
}

/// Design on the Pareto front.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrontDesign {
    /// Number of the design, from 1.
    pub design: usize,
    /// Column and value of each goal.
    pub figures: BTreeMap<String, f64>,
}

/// Extreme value of a key figure, and the first design that has it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepExtreme {
    /// Value, in the unit of the column.
    pub value: f64,
    /// Number of the design, from 1.
    pub design: usize,
}

/// Returns a sweep as one page: scatter plots of any column over any other.
pub fn sweep_page(summary: &SweepSummary, table: &Table, origin: &Origin) -> Result<String, Error> {
    let mut facts = facts(summary);
    for range in &summary.figures {
        let of = |end: &SweepExtreme| format!("{} (design {})", six(end.value), end.design);
        let (low, high) = (of(&range.min), of(&range.max));
        fact!(facts, &range.column => "{low} to {high}");
    }
    let keys = summary.varied.len();
    let column = |place: usize| table.names().nth(place).unwrap_or_default().to_owned();
    let mut figures = table.names().skip(keys + 2);
    let first = figures.find(|name| table.numbers(name).is_some());
    let first = first.unwrap_or_default().to_owned();
    // Two keys span the plane of a map, coloured by the first key figure.
    let (y, colour) = match keys {
        2 => (column(2), first),
        _ => (first, String::new()),
    };
    let default = DefaultView {
        scatter: Some(Scatter {
            x: column(1),
            y,
            colour,
            kind: "status",
            ..Scatter::default()
        }),
        ..DefaultView::default()
    };
    page::html(origin, &facts, table, &default)
}

fn facts(summary: &SweepSummary) -> Facts {
    let mut facts = Facts::of(&summary.scene);
    for varied in &summary.varied {
        let (key, first, last) = (&varied.key, &varied.first, &varied.last);
        match varied.count {
            1 => fact!(facts, "varied" => "{key}: {}", varied.values),
            count => fact!(facts, "varied" => "{key}: {first} to {last}, {count} values"),
        }
    }
    let [from, to] = summary.part;
    let part = match to - (from - 1) {
        0 => ", none of these".to_owned(),
        count if count == summary.designs => String::new(),
        _ => format!(", of these {from} to {to}"),
    };
    fact!(facts, "designs" => "{}{part}", summary.designs);
    for (status, count) in &summary.status {
        facts.add(format_args!("  {status}"), count);
    }
    if summary.taken_up > 0 {
        facts.add("  there already", summary.taken_up);
    }
    fact!(facts, "time" => "{:.3} s", summary.wall_s);
    facts
}

/// Returns a sweep as text: facts, ranges, percentiles and Pareto front.
pub fn sweep_text(summary: &SweepSummary) -> String {
    let ranges = summary.figures.iter().map(|range| {
        let of = |end: &SweepExtreme| [six(end.value), end.design.to_string()];
        let ends = [&range.min, &range.max].into_iter().flat_map(of);
        [range.column.clone()].into_iter().chain(ends)
    });
    let header = ",least,in design,largest,in design";
    let mut text = facts(summary).lines(17) + "\n";
    text += &text_table(&[-26, 12, 10, 12, 10], header, ranges);
    let spreads = summary.figures.iter().filter_map(|one| {
        let of = one.spread?;
        let values = [of.mean, of.standard_deviation, of.p2_5, of.p50, of.p97_5].map(six);
        Some([one.column.clone()].into_iter().chain(values))
    });
    let mut spreads = spreads.peekable();
    if spreads.peek().is_some() {
        let header = ",mean,deviation,2.5 %,median,97.5 %";
        text += "\n";
        text += &text_table(&[-26, 12, 12, 12, 12, 12], header, spreads);
    }
    text + &front(&summary.pareto_front)
}

fn front(front: &[FrontDesign]) -> String {
    /// Maximum number of listed designs, to fit a screen.
    const DESIGNS_SHOWN: usize = 20;
    let Some(first) = front.first() else {
        return String::new();
    };
    let title = match first.figures.len() {
        1 => "best design",
        _ => "Pareto front",
    };
    let mut widths = vec![26; 1 + first.figures.len()];
    widths[0] = -15;
    let names = first.figures.keys().map(|name| format!(",{name}"));
    let header = title.to_owned() + &names.collect::<String>();
    let rows = front.iter().take(DESIGNS_SHOWN).map(|one| {
        let values = one.figures.values().map(|value| six(*value));
        [format!("  design {}", one.design)]
            .into_iter()
            .chain(values)
    });
    let mut text = "\n".to_owned() + &text_table(&widths, &header, rows);
    if front.len() > DESIGNS_SHOWN {
        text += &format!("  and {} more\n", front.len() - DESIGNS_SHOWN);
    }
    text
}
