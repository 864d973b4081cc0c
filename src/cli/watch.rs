//! Terminal output of a running command: messages, progress bar, and interruption by Ctrl-C.

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

/// Time after which the progress of a computation is shown.
const PATIENCE: Duration = Duration::from_secs(1);

/// State of the progress display.
static SHOWN: Mutex<Shown> = Mutex::new(Shown {
    is_over: false,
    designs: None,
    bar: None,
});

struct Shown {
    /// Whether the display has ended.
    is_over: bool,
    /// Number of designs of a sweep; none for other computations.
    designs: Option<u64>,
    bar: Option<ProgressBar>,
}

/// Starts the progress display and the handler of interrupts, and returns the request to stop that an interrupt sets.
/// A second interrupt, or any if the command takes no requests, ends the process.
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
    // If the handler cannot be set, an interrupt ends the process without results.
    let _ = ctrlc::set_handler(interrupted);
    if std::io::stderr().is_terminal() {
        let stop = stop.clone();
        let between_looks = Duration::from_millis(100);
        thread::spawn(move || {
            thread::sleep(PATIENCE);
            while show(&stop) {
                thread::sleep(between_looks);
            }
        });
    }
    stop
}

/// Sets the number of designs of which progress is shown.
pub(super) fn of_designs(count: usize) {
    shown(|shown| shown.designs = Some(count as u64));
}

/// Ends the progress display, before a result.
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

/// Shows the progress; false if the display has ended.
fn show(stop: &Stop) -> bool {
    let steps_of_run = 1000;
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
            None if done > 0.0 => (steps_of_run, "{bar:30} {percent} %, {elapsed}, {eta} left"),
            None => (steps_of_run, "{spinner} {elapsed}"),
        };
        let new = || ProgressBar::new(length).with_elapsed(PATIENCE);
        let bar = shown.bar.get_or_insert_with(new);
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

/// Prints a message to standard error.
pub(super) fn say(message: &str) {
    say_styled(&printable(message));
}

/// Prints a coloured text, already printable, to standard error.
pub(super) fn say_styled(message: &str) {
    clear();
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Writes a text to standard output.
pub(super) fn print(text: &str) -> Result<(), Error> {
    clear();
    Output::standard().text(&printable(text))
}
