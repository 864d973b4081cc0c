//! Figures as SVG, PNG or PDF, as the name of the file says.

use std::path::Path;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};

use super::Output;
use crate::error::Error;

/// Endings of the files of pictures.
pub const ENDINGS: [&str; 3] = ["svg", "png", "pdf"];

/// Pixels of a PNG for each of the figure: sharp on paper and on fine screens.
const SCALE: f32 = 2.0;

/// Pixels of a figure to the inch.
const DPI: f32 = 96.0;

/// A file that a figure is drawn to.
#[derive(Debug)]
pub struct Picture {
    output: Output,
    format: Format,
}

#[derive(Clone, Copy, Debug)]
enum Format {
    Svg,
    Png,
    Pdf,
}

impl Picture {
    /// Opens the file, whose ending says the format; without one, and on standard output, it is SVG.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn create(path: &Path) -> Result<Picture, Error> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let format = match ending.to_str() {
            Some("png") => Format::Png,
            Some("pdf") => Format::Pdf,
            _ => Format::Svg,
        };
        let output = Output::create(path)?;
        Ok(Picture { output, format })
    }

    /// Draws a figure that is given as SVG.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn draw(mut self, svg: &str) -> Result<(), Error> {
        let bytes = match self.format {
            Format::Svg => return self.output.text(svg),
            Format::Png => png(svg),
            Format::Pdf => pdf(svg),
        };
        self.output.write(&bytes.map_err(failed)?)?;
        self.output.finish()
    }
}

fn tree(svg: &str) -> Result<Tree, String> {
    let mut fonts = Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let options = Options {
        fontdb: Arc::new(fonts),
        font_family: "Ubuntu".to_owned(),
        ..Options::default()
    };
    Tree::from_str(svg, &options).map_err(|error| error.to_string())
}

/// A figure as pixels, so many for each of the figure.
pub(super) fn pixels(svg: &str, scale: f32) -> Result<Pixmap, String> {
    let tree = tree(svg)?;
    let size = tree.size().to_int_size();
    let size = size.scale_by(scale).ok_or("a figure without extent")?;
    let mut pixels =
        Pixmap::new(size.width(), size.height()).ok_or("a figure too large for pixels")?;
    let scaled = Transform::from_scale(scale, scale);
    resvg::render(&tree, scaled, &mut pixels.as_mut());
    Ok(pixels)
}

fn png(svg: &str) -> Result<Vec<u8>, String> {
    let pixels = pixels(svg, SCALE)?;
    pixels.encode_png().map_err(|error| error.to_string())
}

/// A figure that could not be written.
pub(super) fn failed(reason: String) -> Error {
    Error::Write {
        target: "figure".to_owned(),
        source: std::io::Error::other(reason),
    }
}

fn pdf(svg: &str) -> Result<Vec<u8>, String> {
    let page = svg2pdf::PageOptions { dpi: DPI };
    svg2pdf::to_pdf(&tree(svg)?, svg2pdf::ConversionOptions::default(), page)
        .map_err(|error| error.to_string())
}
