//! The drawing in motion as GIF.

use ::gif::{Encoder, Frame, Repeat};

use super::{Pose, Sketch};
use crate::error::Error;
use crate::report::Output;
use crate::report::picture::{failed, pixels};

/// Coarseness of the choice of colours, 1 to 30: a drawing has few.
const COARSENESS: i32 = 20;

/// Writes the mechanism in motion: a frame for each pose with what is written below it, shown for so many hundredths of a
/// second, again and again.
///
/// # Errors
/// [`Error::Write`].
pub fn animation(
    sketch: &Sketch,
    frames: &[(Pose, String)],
    hundredths: u16,
    mut output: Output,
) -> Result<(), Error> {
    let poses: Vec<Pose> = frames.iter().map(|(pose, _)| *pose).collect();
    let extent = sketch.extent(&poses);
    let mut bytes = Vec::new();
    let mut encoder: Option<Encoder<&mut Vec<u8>>> = None;
    let mut target = Some(&mut bytes);
    for (pose, note) in frames {
        let drawn = pixels(&sketch.frame(*pose, extent, note), 1.0).map_err(failed)?;
        let [width, height] = [drawn.width(), drawn.height()].map(|side| side.min(65_535) as u16);
        let mut rgba = drawn.take();
        let mut frame = Frame::from_rgba_speed(width, height, &mut rgba, COARSENESS);
        frame.delay = hundredths;
        if let Some(target) = target.take() {
            let mut made = Encoder::new(target, width, height, &[])
                .map_err(|error| failed(error.to_string()))?;
            made.set_repeat(Repeat::Infinite)
                .map_err(|error| failed(error.to_string()))?;
            encoder = Some(made);
        }
        if let Some(encoder) = &mut encoder {
            encoder
                .write_frame(&frame)
                .map_err(|error| failed(error.to_string()))?;
        }
    }
    drop(encoder);
    output.write(&bytes)?;
    output.finish()
}
