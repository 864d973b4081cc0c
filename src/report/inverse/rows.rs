//! Rows of `inverse` as CSV, made for millions of them.

use crate::error::Error;
use crate::report::Output;
use crate::study::{AsPrinted, Inverse, InverseRow};

const COLUMNS: &str = "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,slider_force_n,slider_force_se_n,crank_torque_nm,near_dead_centre";

const PRINTED: &str = "spin_only_force_n,duarte_9_force_n";

/// Rows that one piece of text holds.
const PIECE: usize = 1 << 14;

/// Writes the rows, with joint forces if they were asked for, and with the forces as Duarte et al. print them.
///
/// # Errors
/// [`Error::Write`].
pub fn inverse_rows(
    result: &Inverse,
    printed: Option<&AsPrinted>,
    mut output: Output,
) -> Result<(), Error> {
    let reactions = result.with_reactions();
    output.write(COLUMNS.as_bytes())?;
    if reactions {
        output.write(b",")?;
        output.write(crate::report::rows::REACTIONS.as_bytes())?;
    }
    if printed.is_some() {
        output.write(b",")?;
        output.write(PRINTED.as_bytes())?;
    }
    output.write(b"\n")?;
    in_pieces(&result.rows, &mut output, |row, text| {
        line(row, text);
        if reactions {
            match result.reactions(row) {
                Some(forces) => {
                    crate::report::rows::reactions(&forces).for_each(|value| cell(value, text))
                }
                None => text.extend(std::iter::repeat_n(b',', 10)),
            }
        }
        if let Some(printed) = printed {
            for force in printed.forces(row).unwrap_or([f64::NAN; 2]) {
                cell(force, text);
            }
        }
    })?;
    output.finish()
}

/// Writes what was measured, what the fit gives, and the difference.
///
/// # Errors
/// [`Error::Write`].
pub fn residuals(result: &Inverse, mut output: Output) -> Result<(), Error> {
    let data = &result.summary.data;
    let (name, unit) = (data.column, data.unit);
    let header = format!("t_s,{name}_{unit},fitted_{name}_{unit},residual_{unit}\n");
    output.write(header.as_bytes())?;
    in_pieces(&result.residuals, &mut output, |row, text| {
        number(row.t, text);
        cell(row.measured, text);
        cell(row.measured - row.residual, text);
        cell(row.residual, text);
    })?;
    output.finish()
}

/// Writes rows, their texts made on all cores.
fn in_pieces<Row: Sync>(
    rows: &[Row],
    output: &mut Output,
    write: impl Fn(&Row, &mut Vec<u8>) + Sync,
) -> Result<(), Error> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let text = |piece: &[Row]| {
        let mut text = Vec::with_capacity(160 * piece.len());
        for row in piece {
            write(row, &mut text);
            text.push(b'\n');
        }
        text
    };
    for pieces in rows.chunks(PIECE * cores) {
        let texts: Vec<Vec<u8>> = std::thread::scope(|scope| {
            let (first, others) = pieces.split_at(PIECE.min(pieces.len()));
            let text = &text;
            let others: Vec<_> = others
                .chunks(PIECE)
                .map(|piece| scope.spawn(move || text(piece)))
                .collect();
            let first = text(first);
            let others = others
                .into_iter()
                .map(|thread| thread.join().unwrap_or_default());
            std::iter::once(first).chain(others).collect()
        });
        for text in texts {
            output.write(&text)?;
        }
    }
    Ok(())
}

fn line(row: &InverseRow, text: &mut Vec<u8>) {
    number(row.t, text);
    for value in [row.theta, row.omega, row.alpha] {
        cell(value, text);
    }
    for value in [row.slider_force, row.slider_force_se] {
        cell(value.unwrap_or(f64::NAN), text);
    }
    cell(row.crank_torque, text);
    text.extend(if row.near_dead_centre { b",1" } else { b",0" });
}

fn cell(value: f64, text: &mut Vec<u8>) {
    text.push(b',');
    number(value, text);
}

/// The shortest text that reads back as the same number; nothing for what is not finite.
fn number(value: f64, text: &mut Vec<u8>) {
    if !value.is_finite() {
        return;
    }
    let mut buffer = zmij::Buffer::new();
    let shortest = buffer.format_finite(value + 0.0);
    text.extend(shortest.strip_suffix(".0").unwrap_or(shortest).as_bytes());
}
