//! Rows of `inverse` as CSV, made for millions of them.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use crate::error::Error;
use crate::inverse::{AsPrinted, Inverse, InverseRow};
use crate::report::Output;

const COLUMNS: &str = "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,slider_force_n,slider_force_se_n,crank_torque_nm,near_dead_centre,crank_torque_se_nm";

const PRINTED: &str = "spin_only_force_n,duarte_9_force_n";

/// Rows that one piece of text holds.
const PIECE: usize = 1 << 12;

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

/// Where the texts of the pieces go, one after the other.
struct Turn<'a> {
    output: &'a mut Output,
    /// The piece that is written next.
    piece: usize,
    result: Result<(), Error>,
}

/// Writes rows, their texts made on all cores.
fn in_pieces<Row: Sync>(
    rows: &[Row],
    output: &mut Output,
    write: impl Fn(&Row, &mut Vec<u8>) + Sync,
) -> Result<(), Error> {
    let turn = Mutex::new(Turn {
        output,
        piece: 0,
        result: Ok(()),
    });
    let written = Condvar::new();
    let pieces = Mutex::new(rows.chunks(PIECE).enumerate());
    let worker = || {
        while let Some((piece, rows)) = { lock(&pieces).next() } {
            let mut text = Vec::with_capacity(160 * rows.len());
            for row in rows {
                write(row, &mut text);
                text.push(b'\n');
            }
            let mine = written.wait_while(lock(&turn), |turn| turn.piece != piece);
            let mut turn = mine.unwrap_or_else(PoisonError::into_inner);
            if turn.result.is_ok() {
                turn.result = turn.output.write(&text);
            }
            turn.piece += 1;
            written.notify_all();
        }
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let others = cores.min(rows.len().div_ceil(PIECE)).saturating_sub(1);
    thread::scope(|scope| {
        for _ in 0..others {
            scope.spawn(worker);
        }
        worker();
    });
    let turn = turn.into_inner();
    turn.unwrap_or_else(PoisonError::into_inner).result
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn line(row: &InverseRow, text: &mut Vec<u8>) {
    number(row.t, text);
    for value in [row.theta, row.omega, row.alpha] {
        cell(value, text);
    }
    for value in [row.slider_force, row.slider_force_se] {
        cell(value.unwrap_or(f64::NAN), text);
    }
    cell(row.crank_torque.unwrap_or(f64::NAN), text);
    text.extend(if row.near_dead_centre { b",1" } else { b",0" });
    cell(row.crank_torque_se.unwrap_or(f64::NAN), text);
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
