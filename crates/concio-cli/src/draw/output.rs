//! A drawing as a file: SVG with its letters as outlines, PNG, PDF with text that can be selected. No font of the
//! system takes part.

use std::sync::Arc;

use krilla::Document;
use krilla::geom::Size;
use krilla::metadata::Metadata;
use krilla::page::PageSettings;
use krilla_svg::{SurfaceExt, SvgSettings};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, WriteOptions, fontdb};

use super::escape;
use super::font::{FAMILY, FONT};

/// Points in a millimetre.
pub const POINTS: f64 = 72.0 / 25.4;
/// Most pixels of a PNG: 16 times those of a double column at 600 dpi.
const MOST_PIXELS: f64 = 3e8;

/// A drawing in points of 1/72 inch, its letters still text in [`FAMILY`].
#[derive(Debug, Clone)]
pub struct Drawing {
    /// What stands between `<svg …>` and `</svg>`.
    pub body: String,
    /// Width and height [pt].
    pub size: [f64; 2],
    /// What it shows, for those who cannot see it and for the properties of a PDF.
    pub title: String,
    /// What to know before it is believed; empty for nothing.
    pub note: String,
}

impl Drawing {
    /// As SVG that a page can hold, letters as text.
    pub fn svg(&self) -> String {
        let [w, h] = self.size;
        let [wide, high] = self.size.map(|v| v / POINTS);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide:.3}mm\" height=\"{high:.3}mm\" \
             viewBox=\"0 0 {w:.4} {h:.4}\" role=\"img\" aria-label=\"{}\" font-family=\"{FAMILY}\">\n\
             <rect width=\"{w:.4}\" height=\"{h:.4}\" fill=\"#fff\"/>\n{}</svg>\n",
            escape(&self.title),
            self.body
        )
    }

    /// As SVG for a file: letters as outlines, since few programs read a font out of an SVG file; its words stand in
    /// the description.
    ///
    /// # Errors
    /// What the library says.
    pub fn outlined(&self) -> Result<String, String> {
        let tree = self.tree()?;
        let options = WriteOptions { preserve_text: false, coordinates_precision: 2, ..WriteOptions::default() };
        let text = tree.to_string(&options);
        let (_, rest) = text.split_once('>').ok_or("the drawing is empty")?;
        let [wide, high] = self.size.map(|v| v / POINTS);
        let (w, h) = (tree.size().width(), tree.size().height());
        Ok(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide:.3}mm\" height=\"{high:.3}mm\" \
             viewBox=\"0 0 {w} {h}\">\n    <title>{}</title>\n    <desc>{}</desc>{rest}",
            escape(&self.title),
            self.words().join(" | ")
        ))
    }

    /// As PNG.
    ///
    /// # Errors
    /// What the library says; a resolution with more pixels than memory is wise to give.
    pub fn png(&self, dpi: f64) -> Result<Vec<u8>, String> {
        let tree = self.tree()?;
        let pixels = self.size.map(|v| (v / 72.0 * dpi).round().max(1.0));
        if pixels[0] * pixels[1] > MOST_PIXELS {
            return Err(format!("{} × {} pixels are too many", pixels[0], pixels[1]));
        }
        let mut map = Pixmap::new(pixels[0] as u32, pixels[1] as u32).ok_or("there is no memory for the pixels")?;
        let scale = |k: usize, size: f32| pixels[k] as f32 / size;
        let transform = Transform::from_scale(scale(0, tree.size().width()), scale(1, tree.size().height()));
        resvg::render(&tree, transform, &mut map.as_mut());
        let png = map.encode_png().map_err(|e| e.to_string())?;
        Ok(with_resolution(&png, dpi))
    }

    /// As PDF of one page.
    ///
    /// # Errors
    /// What the library says.
    pub fn pdf(&self) -> Result<Vec<u8>, String> {
        let tree = self.tree()?;
        let [w, h] = self.size.map(|v| v as f32);
        let mut document = Document::new();
        let mut page = document.start_page_with(PageSettings::from_wh(w, h).ok_or("the page has no size")?);
        let mut surface = page.surface();
        let size = Size::from_wh(w, h).ok_or("the page has no size")?;
        surface.draw_svg(&tree, size, SvgSettings::default()).ok_or("the drawing is empty")?;
        surface.finish();
        page.finish();
        document.set_metadata(Metadata::new().title(self.title.clone()).creator("Concio".into()));
        document.finish().map_err(|e| format!("{e:?}"))
    }

    fn tree(&self) -> Result<Tree, String> {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(FONT.to_vec());
        let options = Options { font_family: FAMILY.into(), fontdb: Arc::new(fonts), ..Options::default() };
        Tree::from_str(&self.svg(), &options).map_err(|e| e.to_string())
    }

    /// The texts of the drawing as they stand in it, escaped.
    fn words(&self) -> Vec<&str> {
        let texts = self.body.split("<text ").skip(1).filter_map(|rest| {
            let (_, rest) = rest.split_once('>')?;
            rest.split_once("</text>").map(|(text, _)| text.trim())
        });
        texts.filter(|t| !t.is_empty()).collect()
    }
}

/// Adds the chunk `pHYs`, which tells programs the size in print, behind the header of a PNG.
fn with_resolution(png: &[u8], dpi: f64) -> Vec<u8> {
    /// Signature and chunk `IHDR`.
    const HEADER: usize = 8 + 25;
    let Some((header, rest)) = png.split_at_checked(HEADER) else { return png.to_vec() };
    let per_metre = ((dpi / 0.0254).round() as u32).to_be_bytes();
    let mut chunk = b"pHYs".to_vec();
    chunk.extend([per_metre, per_metre].concat());
    chunk.push(1);
    [header, &9u32.to_be_bytes(), &chunk, &crc(&chunk).to_be_bytes(), rest].concat()
}

/// CRC-32 of PNG.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawing() -> Drawing {
        let body =
            "<text x=\"10\" y=\"20\" font-size=\"8\">time [s] &amp; µm</text><path d=\"M0 0L50 25\" stroke=\"#000\"/>";
        Drawing { body: body.into(), size: [85.0 * POINTS, 40.0 * POINTS], title: "A < B".into(), note: String::new() }
    }

    #[test]
    fn files_have_their_size_in_print() {
        let svg = drawing().outlined().expect("SVG");
        assert!(svg.contains("width=\"85.000mm\" height=\"40.000mm\""), "{svg}");
        let png = drawing().png(300.0).expect("PNG");
        // 85 mm and 40 mm at 300 dpi; 300 dpi are 11811 pixels in a metre.
        assert_eq!(png[16..24], [1004u32.to_be_bytes(), 472u32.to_be_bytes()].concat());
        assert_eq!(png[37..45], [b"pHYs".as_slice(), &11811u32.to_be_bytes()].concat());
        let pdf = drawing().pdf().expect("PDF");
        assert!(pdf.starts_with(b"%PDF-"));
        assert!(pdf.windows(27).any(|w| w.starts_with(b"/MediaBox [0 0 240.94")), "85 mm are 240.94 pt");
    }

    /// Letters are outlines; the words stand in the description.
    #[test]
    fn no_font_is_left_in_svg() {
        let svg = drawing().outlined().expect("SVG");
        assert!(!svg.contains("<text") && !svg.contains("font-family"), "{svg}");
        assert!(svg.contains("<title>A &lt; B</title>") && svg.contains("<desc>time [s] &amp; µm</desc>"), "{svg}");
        // A glyph is a filled path: without the font there would be none beside the line and the ground.
        assert!(svg.matches("<path").count() >= 3, "{svg}");
    }

    /// The check value of CRC-32 (ISO 3309).
    #[test]
    fn checksums_are_those_of_png() {
        assert_eq!(crc(b"123456789"), 0xcbf4_3926);
    }
}
