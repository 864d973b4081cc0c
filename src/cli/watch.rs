//! Whoever waits for a computation: what is said, its progress on a terminal, and Ctrl-C.

use std::io::{IsTerminal, Write};
use std::process;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::error::Error;
use crate::report::Output;
use crate::scene::printable;
use crate::simulate::Stop;

/// A computation is said to be under way after this time, s.
const PATIENCE: Duration = Duration::from_secs(1);
const BETWEEN_LOOKS: Duration = Duration::from_millis(100);

/// What is on the terminal.
static SHOWN: Mutex<Shown> = Mutex::new(Shown {
    is_over: false,
    designs: None,
    bar: None,
});

struct Shown {
    /// Whether nothing is to be shown any more.
    is_over: bool,
    /// Number of designs of a sweep.
    designs: Option<u64>,
    bar: Option<ProgressBar>,
}

/// Watches the command of this process: shows how far it is, and hands it a request to stop when the user interrupts it.
/// A command that does not take such requests, or a user who repeats it, ends the process.
pub(super) fn start(takes_requests: bool) -> Stop {
    let stop = Stop::default();
    let request = stop.clone();
    let interrupted = move || {
        if !takes_requests || request.is_requested() {
            clear();
            say("error: interrupted: nothing more is written");
            process::exit(1);
        }
        request.request();
    };
    // Without a handler the system ends the process, which loses what it has.
    let _ = ctrlc::set_handler(interrupted);
    if std::io::stderr().is_terminal() {
        let stop = stop.clone();
        thread::spawn(move || {
            thread::sleep(PATIENCE);
            while show(&stop) {
                thread::sleep(BETWEEN_LOOKS);
            }
        });
    }
    stop
}

/// Says that the progress is that of so many designs.
pub(super) fn of_designs(count: usize) {
    shown(|shown| shown.designs = Some(count as u64));
}

/// Takes the progress off the terminal for good: a result follows.
pub(super) fn clear() {
    shown(|shown| {
        shown.is_over = true;
        if let Some(bar) = shown.bar.take() {
            bar.finish_and_clear();
        }
    });
}

fn shown<T>(with: impl FnOnce(&mut Shown) -> T) -> T {
    with(&mut SHOWN.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Shows how far it is; false if nothing is to be shown any more.
fn show(stop: &Stop) -> bool {
    /// Parts of a run that are told apart.
    const PARTS: u64 = 1000;
    shown(|shown| {
        if shown.is_over {
            return false;
        }
        let done = stop.done();
        let (length, style) = match shown.designs {
            Some(count) => (
                count,
                "{bar:30} design {pos} of {len}, {per_sec}, {eta} left",
            ),
            None if done > 0.0 => (PARTS, "{bar:30} {percent} %, {elapsed}, {eta} left"),
            None => (PARTS, "{spinner} {elapsed}"),
        };
        let bar = shown
            .bar
            .get_or_insert_with(|| ProgressBar::new(length).with_elapsed(PATIENCE));
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        let position = (done.clamp(0.0, 1.0) * length as f64) as u64;
        if position < bar.position() {
            bar.reset();
        }
        bar.set_position(position);
        bar.tick();
        true
    })
}

/// The one place that talks to the user beside the results.
pub(super) fn say(message: &str) {
    say_styled(&printable(message));
}

/// Prints a text with colours, whose parts are printable.
pub(super) fn say_styled(message: &str) {
    clear();
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Writes a text to standard output.
pub(super) fn print(text: &str) -> Result<(), Error> {
    clear();
    Output::standard().text(&printable(text))
}
