//! The page around the figures.

use std::fmt::Write as _;

use concio::record::StopReason;
use serde_json::Value;

use super::{Content, doubts, figures};
use crate::digest;
use crate::draw::escape;
use crate::format::seconds;

/// Largest input that the page quotes [bytes]; it is in result.h5 in any case.
const LARGEST_INPUT: usize = 200_000;

const STYLE: &str = "\
body{font:15px/1.5 'DejaVu Sans',Arial,sans-serif;color:#111;max-width:960px;margin:2em auto;padding:0 1em}
h1{font-size:1.5em;margin-bottom:0}h2{font-size:1.15em;margin-top:2em;border-bottom:1px solid #bbb}
svg{max-width:100%;height:auto}table{border-collapse:collapse}td{padding:.15em 1.2em .15em 0;vertical-align:top}
td:first-child{white-space:pre}td+td{font-variant-numeric:tabular-nums}
.note{border-left:5px solid #999;padding:.2em 1em;background:#f4f4f4}.bad{border-color:#b00;background:#fdecea}
pre{background:#f4f4f4;padding:1em;overflow:auto;font-size:13px}.small{color:#555;font-size:.9em;overflow-wrap:anywhere}
.views>input{position:absolute;opacity:0}.views>label{display:inline-block;padding:.2em .8em;border:1px solid #999;cursor:pointer}
.views>input:checked+label{background:#333;color:#fff}.views>input:focus-visible+label{outline:2px solid #06c}
.views>div{display:none}@media print{details{display:block}}";

/// The report as HTML.
pub fn html(content: &Content) -> String {
    let title = if content.case.title.is_empty() { &content.name } else { &content.case.title };
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n<style>\n{STYLE}\n{1}</style>\n</head>\n<body>\n\
         <h1>{0}</h1>\n",
        escape(title),
        view_rules()
    );
    head(&mut page, content);
    wall(&mut page, content);
    section(&mut page, "Summary", &table(&digest::rows(content.outcome, content.summary)));
    section(&mut page, "Histories", &figures::histories(content).concat());
    asked(&mut page, content);
    section(&mut page, "Energy", &figures::energies(content).concat());
    let list: String = doubts::list(content).iter().map(|d| format!("<li>{}</li>\n", escape(d))).collect();
    section(&mut page, "When not to believe this result", &format!("<ul>\n{list}</ul>\n"));
    input(&mut page, content);
    page.push_str("</body>\n</html>\n");
    page
}

/// The blocks and joints of `output.blocks` and `output.joints`.
fn asked(page: &mut String, content: &Content) {
    let (figures, left_out) = figures::asked(content);
    if figures.is_empty() {
        return;
    }
    let mut body = figures.concat();
    if left_out > 0 {
        let _ = writeln!(body, "<p class=\"small\">{left_out} more blocks and joints are in result.h5.</p>");
    }
    section(page, "Blocks and joints asked for", &body);
}

fn section(page: &mut String, title: &str, body: &str) {
    let _ = writeln!(page, "<h2>{title}</h2>\n{body}");
}

fn table(rows: &[(&str, String)]) -> String {
    let row =
        |(name, value): &(&str, String)| format!("<tr><td>{}</td><td>{}</td></tr>\n", escape(name), escape(value));
    format!("<table>\n{}</table>\n", rows.iter().map(row).collect::<String>())
}

/// What the run is, whether it reached its end, and what the user was warned of.
fn head(page: &mut String, content: &Content) {
    let outcome = content.outcome;
    let duration = content.summary.get("duration").and_then(Value::as_f64).unwrap_or(outcome.time_reached);
    let _ = writeln!(
        page,
        "<p>{} blocks, {} joints, {} of motion.</p>",
        content.wall.blocks.len(),
        content.joints.len(),
        seconds(outcome.time_reached)
    );
    if outcome.stop_reason != StopReason::Completed {
        let [at, duration] = [outcome.time_reached, duration].map(seconds);
        let why = escape(digest::why(outcome.stop_reason));
        let _ = writeln!(page, "<p class=\"note bad\"><b>Stopped early at t = {at} of {duration}:</b> {why}.</p>");
    }
    for warning in digest::warnings(content.summary) {
        let _ = writeln!(page, "<p class=\"note\"><b>Warning:</b> {}</p>", escape(warning));
    }
}

const VIEWS: usize = 5;

/// Shows the view whose button is chosen, without a script.
fn view_rules() -> String {
    (0..VIEWS)
        .map(|k| format!("#v{k}:checked~#w{k}{}", if k + 1 < VIEWS { "," } else { "{display:block}\n" }))
        .collect()
}

fn wall(page: &mut String, content: &Content) {
    let (mut buttons, mut drawings) = (String::new(), String::new());
    for (k, (name, drawing)) in figures::walls(content).iter().enumerate() {
        let checked = if k == 0 { " checked" } else { "" };
        let _ = write!(
            buttons,
            "<input type=\"radio\" name=\"view\" id=\"v{k}\"{checked}><label for=\"v{k}\">{name}</label>"
        );
        let _ = writeln!(drawings, "<div id=\"w{k}\">{drawing}</div>");
    }
    section(page, "The wall: peaks over the whole run", &format!("<div class=\"views\">{buttons}\n{drawings}</div>\n"));
}

fn input(page: &mut String, content: &Content) {
    let resolved = serde_json::to_string_pretty(&content.case).unwrap_or_default();
    let mut body = String::new();
    if let Some(text) = content.text {
        quote(&mut body, "Wall file", text, true);
    }
    quote(&mut body, "Resolved input, defaults and units in it (SI)", &resolved, content.text.is_none());
    let of = |key: &str| escape(content.summary.get(key).and_then(Value::as_str).unwrap_or("–"));
    let _ = writeln!(body, "<p class=\"small\">Concio {}, inputs {}</p>", of("version"), of("inputs_hash"));
    section(page, "Input", &body);
}

fn quote(body: &mut String, title: &str, text: &str, open: bool) {
    let open = if open { " open" } else { "" };
    let text = if text.len() > LARGEST_INPUT { "Too long to be quoted here: it is in result.h5." } else { text };
    let _ = writeln!(body, "<details{open}><summary>{title}</summary><pre>{}</pre></details>", escape(text));
}
