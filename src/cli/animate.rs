//! Command `animate`: draws the mechanism to scale, in motion (GIF) or at one crank angle (DXF, SVG, PNG, PDF).

use std::path::PathBuf;

use clap::Args;

use super::streams::{Streams, check_extension};
use super::values::angle;
use super::watch::{print, say};
use crate::error::Error;
use crate::report::{Output, Pose, Sketch, animation, extension};
use crate::scene::Scene;
use crate::simulate::{Options, Row, simulate_rows};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    /// Draws to this file: the motion as GIF, or the mechanism at an angle as DXF (mm, a layer for each body), SVG, PNG or
    /// PDF, as its name ends
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Crank angle of a drawing; without it that at which the scene starts
    #[arg(long, value_name = "ANGLE", value_parser = angle, allow_hyphen_values = true)]
    at: Option<f64>,
    /// Number of frames, evenly spread over the rows of the run
    #[arg(long, value_name = "COUNT", default_value_t = 120, value_parser = clap::value_parser!(u16).range(2..=5000))]
    frames: u16,
    /// How long the animation of the whole run lasts, s
    #[arg(long, value_name = "SECONDS", default_value_t = 6.0, value_parser = seconds)]
    seconds: f64,
}

fn seconds(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok();
    let value = value.filter(|seconds| (0.1..=600.0).contains(seconds));
    value.ok_or_else(|| "write seconds from 0.1 to 600".to_owned())
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    check_extension(Some(&arguments.out), &["gif", "dxf", "svg", "png", "pdf"])?;
    let read = arguments.scene.as_ref();
    let scene = Streams::new(&[read], Some(&arguments.out), &[], false)?.scene(read)?;
    match &*extension(&arguments.out) {
        "gif" => animate(arguments, &scene),
        ending => draw(arguments, &scene, ending == "dxf"),
    }
}

fn animate(arguments: &Arguments, scene: &Scene) -> Result<(), Error> {
    if arguments.at.is_some() {
        return Err(Error::refused(
            "a motion has no one angle",
            "leave out --at, or draw to a file like linkage.svg",
        ));
    }
    let options = Options {
        estimate: false,
        events_kept: 0,
        ..Options::default()
    };
    let output = Output::create(&arguments.out)?;
    let mut rows: Vec<Row> = Vec::new();
    let run = simulate_rows(scene, &options, &mut rows)?;
    let count = usize::from(arguments.frames).min(rows.len());
    let last = rows.len().saturating_sub(1);
    let frame = |k: usize| {
        let row = &rows[k * last / (count - 1).max(1)];
        let Row { t, theta, x, .. } = *row;
        let degrees = theta.to_degrees();
        let note = format!("t = {t:.4} s, theta = {degrees:.1} deg");
        (Pose { theta, x }, note)
    };
    let frames: Vec<_> = (0..count).map(frame).collect();
    // Browsers show a frame for at least 0.02 s.
    let hundredths = 100.0 * arguments.seconds / count.max(1) as f64;
    let hundredths = hundredths.round().max(2.0) as u16;
    animation(&Sketch::of(scene), &frames, hundredths, output)?;
    let end = rows.last().map_or(0.0, |row| row.t);
    let lasts = f64::from(hundredths) * count as f64 / 100.0;
    print(&format!(
        "frames  {count}\nmotion  {end} s\nlasts   {lasts} s\n"
    ))?;
    for warning in &run.summary.warnings {
        say(&format!("warning: {warning}"));
    }
    match run.summary.stopped {
        Some(stopped) => Err(Error::Incomplete(stopped.to_string())),
        None => Ok(()),
    }
}

fn draw(arguments: &Arguments, scene: &Scene, as_dxf: bool) -> Result<(), Error> {
    let theta = arguments.at.unwrap_or(scene.motion.angle);
    let row = crate::kinematics::kinematics(scene)?.row(theta).pose;
    let degrees = theta.to_degrees();
    if !row.x.is_finite() {
        return Err(Error::refused(
            format!("the mechanism cannot be closed at {degrees} deg"),
            "choose an angle that the crank can reach: see `kinematics`",
        ));
    }
    let (sketch, pose) = (Sketch::of(scene), Pose { theta, x: row.x });
    let output = Output::create(&arguments.out)?;
    match as_dxf {
        true => output.text(&sketch.dxf(pose))?,
        false => output.draw(&sketch.svg(pose))?,
    }
    print(&format!("theta  {degrees} deg\nx      {} m\n", row.x))
}
