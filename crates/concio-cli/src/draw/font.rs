//! The one font of the figures, shipped with the program so that they look the same on every machine.

use ttf_parser::Face;

/// DejaVu Sans, cut down to Latin, Greek, Cyrillic and mathematical letters; licence beside it.
pub const FONT: &[u8] = include_bytes!("../../assets/DejaVuSans.ttf");
/// Its family name.
pub const FAMILY: &str = "DejaVu Sans";
/// Width of a letter that the font does not have, over its size.
const UNKNOWN: f64 = 0.6;

/// Width of a text of that size, in the unit of the size; kerning is left out.
pub fn width(text: &str, size: f64) -> f64 {
    let Ok(face) = Face::parse(FONT, 0) else { return UNKNOWN * size * text.chars().count() as f64 };
    let em = f64::from(face.units_per_em());
    let advance = |c| face.glyph_index(c).and_then(|g| face.glyph_hor_advance(g)).map(f64::from);
    size * text.chars().map(|c| advance(c).map_or(UNKNOWN, |a| a / em)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every letter that figures write of themselves is in the font.
    #[test]
    fn the_font_has_the_letters_of_the_figures() {
        let face = Face::parse(FONT, 0).expect("the font");
        for c in "abcXYZ0123456789 [m/s²] µ−×·–…()|%.,:=Ääßéčšœłıżñπζδ".chars() {
            assert!(face.glyph_index(c).is_some(), "{c}");
        }
    }

    /// DejaVu Sans: advances of `0` 1303, `m` 1995, of an em of 2048.
    #[test]
    fn widths_are_those_of_the_font() {
        assert!((width("0m", 10.0) - 10.0 * (1303.0 + 1995.0) / 2048.0).abs() < 1e-9);
    }
}
