//! The report of a study: one HTML file that fetches nothing, its tables sorted by a click on a heading, its figures
//! also as SVG and PDF in `figures/`.

use std::borrow::Borrow;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use concio::Error;
use concio_study::table::{Cells, Column, Table};

use crate::draw::escape;
use crate::draw::output::Drawing;
use crate::failure::Failure;
use crate::files;
use crate::format::{exponent, plain, significant};

/// A browser that obeys it fetches nothing.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";
const STYLE: &str = include_str!("page.css");
/// Sorts a table by the column whose heading is clicked.
const SCRIPT: &str = include_str!("page.js");
/// Letters from which a cell of a table is broken into lines: sentences.
const LONG: usize = 60;
/// Lines of a table that the page shows; the files have all.
const MOST_LINES: usize = 2000;

/// A part of the report.
#[derive(Debug, Default)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// Paragraphs of plain text.
    pub text: Vec<String>,
    /// Figures.
    pub figures: Vec<Figure>,
    /// Tables, each under a line that says what it is.
    pub tables: Vec<(String, Table)>,
    /// The answer in short, for the terminal: lines, or nothing.
    pub brief: String,
}

/// A figure.
#[derive(Debug)]
pub struct Figure {
    /// Name of its files, without an ending.
    pub name: String,
    /// Line below it.
    pub caption: String,
    /// The figure.
    pub drawing: Drawing,
}

/// Writes `report.html` and the figures into the folder of a study; the path of the page.
///
/// # Errors
/// A file that cannot be written.
pub fn write<S: Borrow<Section>>(
    out: &Path,
    title: &str,
    facts: &[(&str, String)],
    sections: &[S],
) -> Result<PathBuf, Failure> {
    let folder = out.join("figures");
    for figure in sections.iter().flat_map(|s| &s.borrow().figures) {
        fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, e))?;
        let lost = |what: String| Failure::Other(format!("figure {}: {what}", figure.name), None);
        let [svg, pdf] = ["svg", "pdf"].map(|ending| folder.join(format!("{}.{ending}", figure.name)));
        files::write(&svg, &figure.drawing.outlined().map_err(lost)?)?;
        files::write(&pdf, &figure.drawing.pdf().map_err(lost)?)?;
    }
    let path = out.join("report.html");
    files::write(&path, &html(title, facts, sections)?)?;
    Ok(path)
}

fn html<S: Borrow<Section>>(title: &str, facts: &[(&str, String)], sections: &[S]) -> Result<String, Failure> {
    let mut page = String::new();
    let title = escape(title);
    let _ = write!(
        page,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n<table class=\"facts\">\n"
    );
    for (name, value) in facts {
        let _ = writeln!(page, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escape(name), escape(value));
    }
    page.push_str("</table>\n</header>\n<main>\n");
    for section in sections.iter().map(Borrow::borrow) {
        let _ = writeln!(page, "<section>\n<h2>{}</h2>", escape(&section.title));
        for text in &section.text {
            let _ = writeln!(page, "<p>{}</p>", escape(text));
        }
        for figure in &section.figures {
            let lost = |what: String| Failure::Other(format!("figure {}: {what}", figure.name), None);
            let svg = figure.drawing.outlined().map_err(lost)?;
            let caption = escape(&figure.caption);
            let _ = writeln!(page, "<figure>\n{}<figcaption>{caption}</figcaption>\n</figure>", element(&svg));
        }
        for (caption, table) in &section.tables {
            lines(&mut page, caption, table);
        }
        page.push_str("</section>\n");
    }
    let _ = write!(page, "</main>\n<footer>Concio {}</footer>\n", env!("CARGO_PKG_VERSION"));
    let _ = write!(page, "<script>\n{SCRIPT}</script>\n</body>\n</html>\n");
    Ok(page)
}

/// An SVG file without what stands before its element.
fn element(svg: &str) -> &str {
    svg.find("<svg").map_or(svg, |start| &svg[start..])
}

fn lines(page: &mut String, caption: &str, table: &Table) {
    let _ = writeln!(
        page,
        "<div class=\"scroll\"><table class=\"sortable\">\n<caption>{}</caption>\n<thead><tr>",
        escape(caption)
    );
    for column in &table.columns {
        let unit = if column.unit.is_empty() { String::new() } else { format!(" [{}]", column.unit) };
        let _ = write!(
            page,
            "<th scope=\"col\"><button type=\"button\">{}{}</button></th>",
            escape(&column.name),
            escape(&unit)
        );
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for line in 0..table.len().min(MOST_LINES) {
        page.push_str("<tr>");
        table.columns.iter().for_each(|column| cell(page, column, line));
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table></div>\n");
    if table.len() > MOST_LINES {
        let _ = writeln!(
            page,
            "<p class=\"note\">The first {MOST_LINES} of {} lines; the tables in the folder have all.</p>",
            table.len()
        );
    }
}

fn cell(page: &mut String, column: &Column, line: usize) {
    let _ = match &column.cells {
        Cells::Numbers(cells) => match cells[line] {
            // The whole number is what is sorted by.
            Some(v) => write!(page, "<td class=\"number\" data-value=\"{v}\">{}</td>", shown(v)),
            None => write!(page, "<td class=\"number\"></td>"),
        },
        Cells::Texts(cells) => {
            let text = cells[line].as_deref().unwrap_or_default();
            let class = if text.chars().count() > LONG { " class=\"long\"" } else { "" };
            write!(page, "<td{class}>{}</td>", escape(text))
        }
    };
}

/// Four digits; whole numbers as they are, others with an exponent where it is shorter.
pub fn shown(v: f64) -> String {
    match v.abs() {
        a if v.fract() == 0.0 && a < 1e6 => plain(v),
        a if (1e-3..1e6).contains(&a) => significant(v, 4),
        _ => exponent(v, 3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_holds_what_it_is_given_and_nothing_can_break_out() -> Result<(), String> {
        let mut table = Table::default();
        table.numbers("a", "m", vec![Some(0.5), None]);
        table.texts("b", vec![Some("<script>".into()), Some("a sentence ".repeat(9))]);
        let section = Section {
            title: "T & U".into(),
            text: vec!["less < more".into()],
            figures: Vec::new(),
            tables: vec![("both".into(), table)],
            ..Section::default()
        };
        let page = html("x", &[("runs", "2".into())], &[section]).map_err(|_| "no page".to_string())?;
        assert!(page.contains("T &amp; U") && page.contains("less &lt; more") && page.contains("&lt;script&gt;"));
        assert!(page.contains("data-value=\"0.5\">0.5000<") && page.contains("<td class=\"long\">a sentence a "));
        assert_eq!(page.matches("<script>").count(), 1);
        assert!(!page.contains("http://") && !page.contains("https://"));
        Ok(())
    }

    #[test]
    fn numbers_are_short() {
        for (v, text) in [
            (12.0, "12"),
            (0.123456, "0.1235"),
            (1.5e-7, "1.500e−7"),
            (-2.5, "−2.500"),
            (1e-23, "0"),
            (2e9, "2.000e9"),
            (0.0, "0"),
        ] {
            assert_eq!(shown(v), text);
        }
    }
}
