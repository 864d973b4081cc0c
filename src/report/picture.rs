//! Picture files: writes a figure, given as SVG, as SVG, PNG or PDF by the extension of the file.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, WriteOptions, fontdb::Database};

use super::Output;
use crate::error::Error;
use crate::figure::PIXELS_PER_INCH;

/// Extensions of picture files.
pub const EXTENSIONS: [&str; 3] = ["svg", "png", "pdf"];

impl Output {
    /// Draws a figure given as SVG; extension `png` or `pdf` selects the format, which is SVG otherwise and on standard
    /// output.
    pub fn draw(mut self, svg: &str) -> Result<(), Error> {
        let bytes = match self.extension().as_str() {
            // Two pixels per pixel of the figure are sharp in print and on high-resolution screens.
            "png" => pixels(svg, 2.0)?.encode_png().map_err(failed)?,
            "pdf" => {
                let page = svg2pdf::PageOptions {
                    dpi: PIXELS_PER_INCH as f32,
                };
                let options = svg2pdf::ConversionOptions::default();
                svg2pdf::to_pdf(&outlines(svg)?, options, page).map_err(failed)?
            }
            _ => return self.text(svg),
        };
        self.write(&bytes)?;
        self.finish()
    }
}

fn tree(svg: &str) -> Result<Tree, Error> {
    let mut fonts = Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let options = Options {
        fontdb: Arc::new(fonts),
        font_family: "Ubuntu".to_owned(),
        ..Options::default()
    };
    Tree::from_str(svg, &options).map_err(failed)
}

/// Returns the tree of a figure with its text as outlines: a PDF needs no fonts then.
fn outlines(svg: &str) -> Result<Tree, Error> {
    let svg = tree(svg)?.to_string(&WriteOptions::default());
    Tree::from_str(&svg, &Options::default()).map_err(failed)
}

/// Renders a figure at `scale` pixels per pixel of the figure.
pub(super) fn pixels(svg: &str, scale: f32) -> Result<Pixmap, Error> {
    let tree = tree(svg)?;
    let size = tree.size().to_int_size().scale_by(scale);
    let pixels = size.and_then(|size| Pixmap::new(size.width(), size.height()));
    let mut pixels =
        pixels.ok_or_else(|| failed("it has no extent, or is too large for pixels"))?;
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut pixels.as_mut(),
    );
    Ok(pixels)
}

/// Returns the error of a figure that could not be written.
pub(super) fn failed(reason: impl ToString) -> Error {
    Error::write("figure")(std::io::Error::other(reason.to_string()))
}

#[cfg(test)]
mod tests {
    use super::{WriteOptions, outlines};

    #[test]
    fn text_becomes_outlines() {
        let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="20"><text y="15" font-family="sans-serif">θ [°]</text></svg>"#;
        let kept = WriteOptions {
            preserve_text: true,
            ..WriteOptions::default()
        };
        let drawn = outlines(svg).expect("a figure").to_string(&kept);
        assert!(
            drawn.contains("<path") && !drawn.contains("<text"),
            "{drawn}"
        );
    }
}
