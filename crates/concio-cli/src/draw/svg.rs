//! The little SVG that the wall drawing needs.

use std::fmt::Write as _;

/// Text that may stand in an element or attribute of XML and HTML.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c => safe.push(if is_xml(c) { c } else { '\u{fffd}' }),
        }
    }
    safe
}

/// Whether XML may have a character (XML 1.0, 2.2, without the control characters of C1): names may come from any file.
fn is_xml(c: char) -> bool {
    matches!(c, '\n' | '\t') || !(c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}'))
}

/// A drawing by a library that escapes what is markup and nothing else.
pub fn mended(svg: String) -> String {
    match svg.chars().all(is_xml) {
        true => svg,
        false => svg.chars().map(|c| if is_xml(c) { c } else { '\u{fffd}' }).collect(),
    }
}

/// A coordinate in pixels, to a hundredth.
pub fn px(v: f64) -> String {
    let text = format!("{v:.2}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}

/// From the middle of a line of text down to its baseline, over the size of the font. Renderers do not agree on
/// `dominant-baseline`.
const MIDDLE: f64 = 0.35;

/// Where a text stands with respect to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// It starts there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// A drawing that grows element by element.
#[derive(Debug, Default)]
pub struct Canvas {
    body: String,
}

impl Canvas {
    /// Adds elements as they are.
    pub fn raw(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// A path with presentation attributes; `title` is shown under the mouse.
    pub fn path(&mut self, d: &str, attributes: &str, title: Option<&str>) {
        match title {
            Some(title) => {
                let _ = writeln!(self.body, r#"<path d="{d}" {attributes}><title>{}</title></path>"#, escape(title));
            }
            None => {
                let _ = writeln!(self.body, r#"<path d="{d}" {attributes}/>"#);
            }
        }
    }

    /// Letters that follow have an edge in the colour of mortar, to be read over lines; to be closed with `</g>`.
    pub fn open_halo(&mut self) {
        self.raw(r##"<g stroke="#f3f1ed" stroke-width="1.6" paint-order="stroke">"##);
    }

    /// A text of that size; `upright` turns it by a quarter to the left.
    pub fn text(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, upright: bool, fill: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = if upright { format!(r#" transform="rotate(-90 {} {})""#, px(x), px(y)) } else { String::new() };
        let _ = writeln!(
            self.body,
            r#"<text x="{}" y="{}" font-size="{}" text-anchor="{anchor}" dy="{}" fill="{fill}"{turn}>{}</text>"#,
            px(x),
            px(y),
            px(size),
            px(MIDDLE * size),
            escape(text)
        );
    }

    /// The elements alone.
    pub fn into_body(self) -> String {
        self.body
    }

    /// The whole drawing.
    pub fn finish(self, [width, height]: [f64; 2], label: &str) -> String {
        let (w, h) = (px(width), px(height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" role=\"img\" \
             aria-label=\"{}\" font-family=\"DejaVu Sans, Arial, sans-serif\">\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n{}</svg>\n",
            escape(label),
            self.body
        )
    }
}

/// A closed rectangle as path data.
pub fn rectangle([x0, y0, x1, y1]: [f64; 4]) -> String {
    format!("M{} {}H{}V{}H{}z", px(x0), px(y0), px(x1), px(y1), px(x0))
}

/// A closed outline over its corners as path data; an upright rectangle, counterclockwise on paper from the bottom left, in
/// the short form.
pub fn closed(corners: &[[f64; 2]]) -> String {
    if let [a, b, c, d] = *corners
        && a[1] == b[1]
        && b[0] == c[0]
        && c[1] == d[1]
        && d[0] == a[0]
    {
        return rectangle([d[0], d[1], b[0], b[1]]);
    }
    polygon(corners)
}

/// A closed outline over its corners as path data.
pub fn polygon(corners: &[[f64; 2]]) -> String {
    let points: Vec<String> = corners.iter().map(|p| p.map(px).join(" ")).collect();
    format!("M{}z", points.join("L"))
}

/// A straight line as path data.
pub fn line([x0, y0, x1, y1]: [f64; 4]) -> String {
    format!("M{} {}L{} {}", px(x0), px(y0), px(x1), px(y1))
}
