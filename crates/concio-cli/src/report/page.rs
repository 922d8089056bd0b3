//! The page: text that needs no script, the interactive part's program and data, and figures for readers without
//! scripts.

use std::fmt::Write as _;

use concio::record::StopReason;
use serde_json::Value;

use super::{Content, data, doubts, figures};
use crate::digest::{self, Answer};
use crate::draw::escape;
use crate::format::{counted, exponent, seconds, si};

/// Largest input that the page quotes [bytes]; it is in result.h5 in any case.
const LARGEST_INPUT: usize = 1_000_000;
/// Bytes that a page may take: it is sent by mail; and those that its data have in any case.
const LARGEST: usize = 7_900_000;
const LEAST_DATA: usize = 2_000_000;
/// The program of the page, built from `report-ui/`.
const PROGRAM: &str = include_str!("app/app.js");
const STYLE: &str = include_str!("app/app.css");
/// Puts on the colours that the reader has chosen before anything is drawn (`report-ui/src/theme.ts`).
const THEME: &str = "try{const t=localStorage.getItem(\"concio-theme\");\
     if(t===\"dark\"||t===\"light\")document.documentElement.dataset.theme=t}catch{}";
/// A browser that obeys it fetches nothing, whatever a name in a wall file may contain.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

/// The report as HTML.
pub fn html(content: &Content) -> String {
    let title = escape(if content.case.title.is_empty() { &content.name } else { &content.case.title });
    let mut page = String::with_capacity(1 << 20);
    let _ = write!(
        page,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n<title>{title}</title>\n\
         <script>{THEME}</script>\n<style>\n{STYLE}\n</style>\n<noscript><style>\n{}</style></noscript>\n</head>\n<body>\n\
         <header>\n<h1>{title}</h1>\n",
        view_rules(figures::views(content))
    );
    head(&mut page, content);
    page.push_str("</header>\n<main>\n");
    answers(&mut page, content);
    warnings(&mut page, content);
    tiles(&mut page, content);
    page.push_str("<div id=\"app\"></div>\n");
    without_script(&mut page, content);
    section(
        &mut page,
        "summary",
        "Summary",
        &table(&digest::rows(content.wall, content.joints, content.outcome, content.summary)),
    );
    let list: String = doubts::list(content).iter().map(|d| format!("<li>{}</li>\n", escape(d))).collect();
    section(&mut page, "doubts", "When not to believe this result", &format!("<ul>\n{list}</ul>\n"));
    reproduction(&mut page, content);
    input(&mut page, content);
    page.push_str("</main>\n<script type=\"text/plain\" id=\"concio-data\">");
    let end = format!("</script>\n<script>\n{PROGRAM}</script>\n</body>\n</html>\n");
    let room = LARGEST.saturating_sub(page.len() + end.len()).max(LEAST_DATA);
    page + &data::payload(content, room) + &end
}

fn section(page: &mut String, id: &str, title: &str, body: &str) {
    let _ = writeln!(page, "<section id=\"{id}\">\n<h2>{title}</h2>\n{body}</section>");
}

fn table(rows: &[(&str, String)]) -> String {
    let row = |(name, value): &(&str, String)| {
        let class = if name.starts_with(' ') { " class=\"part\"" } else { "" };
        format!("<tr{class}><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(name.trim()), escape(value))
    };
    format!("<table class=\"facts\">\n{}</table>\n", rows.iter().map(row).collect::<String>())
}

/// What the run is, and whether it reached its end.
fn head(page: &mut String, content: &Content) {
    let outcome = content.outcome;
    let duration = content.summary.get("duration").and_then(Value::as_f64).unwrap_or(outcome.time_reached);
    let _ = writeln!(
        page,
        "<p class=\"lead\">{}, {}, {} of motion · Concio {}</p>",
        counted(content.wall.blocks.len(), "block"),
        counted(content.joints.len(), "joint"),
        seconds(outcome.time_reached),
        escape(text(content, "version"))
    );
    if outcome.stop_reason != StopReason::Completed {
        let [at, duration] = [outcome.time_reached, duration].map(seconds);
        let why = escape(digest::why(outcome.stop_reason, outcome.rocking.is_some()));
        let (class, early) = match outcome.stop_reason.is_end() {
            true => ("note", "Ended"),
            false => ("note bad", "Stopped early"),
        };
        let _ = writeln!(page, "<p class=\"{class}\"><b>{early} at t = {at} of {duration}:</b> {why}.</p>");
    }
}

/// What is asked first.
fn answers(page: &mut String, content: &Content) {
    page.push_str("<dl class=\"answers\">\n");
    for Answer { name, value, note, grave } in digest::head(content.joints, content.outcome, content.summary) {
        let class = if grave { " class=\"grave\"" } else { "" };
        let [value, note] = [value, note].map(|text| unbroken(&escape(&text)));
        let _ = writeln!(page, "<div{class}><dt>{name}</dt><dd><b>{value}</b><span>{note}</span></dd></div>");
    }
    page.push_str("</dl>\n");
}

/// With numbers that keep their units on their line.
fn unbroken(text: &str) -> String {
    let mut whole = String::with_capacity(text.len());
    let mut before = ' ';
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let holds = before.is_ascii_digit() || matches!(before, '=' | '±') || rest.peek() == Some(&'=');
        whole.push(if c == ' ' && holds { '\u{a0}' } else { c });
        before = c;
    }
    whole
}

/// What the user was warned of, directly beneath.
fn warnings(page: &mut String, content: &Content) {
    for warning in digest::warnings(content.summary) {
        let _ = writeln!(page, "<p class=\"note\"><b>Warning:</b> {}</p>", escape(warning));
    }
}

/// Numbers that are looked for next.
fn tiles(page: &mut String, content: &Content) {
    let (totals, energies) = (&content.outcome.totals, &content.outcome.energies);
    let residual = digest::residual(content.summary);
    let closes = residual <= doubts::LARGEST_RESIDUAL;
    let mut tiles = vec![
        ("peak displacement", si(totals.peak_relative_displacement, "m"), "of a block, relative to the base"),
        ("peak slip velocity", si(totals.peak_slip_velocity, "m/s"), "of bed and support joints"),
        ("work done on the wall", si(energies.input(), "J"), "by base, top and weight, over the whole run"),
        (
            "energy residual",
            exponent(residual, 1),
            if closes { "of the largest work: the account closes" } else { "of the largest work: too much" },
        ),
    ];
    // Hinges do not slide.
    if content.outcome.rocking.is_some() {
        tiles.remove(1);
    }
    if totals.top_force_peak > 0.0 {
        tiles.insert(2, ("peak top force", si(totals.top_force_peak, "N"), "of the top beam on the wall"));
    }
    page.push_str("<dl class=\"tiles\">\n");
    for (name, value, note) in tiles {
        let class = if name == "energy residual" && !closes { " class=\"bad\"" } else { "" };
        let _ = writeln!(page, "<div{class}><dt>{name}</dt><dd><b>{value}</b><span>{note}</span></dd></div>");
    }
    page.push_str("</dl>\n");
}

/// For readers whose browser runs no scripts: peaks and histories as drawings.
fn without_script(page: &mut String, content: &Content) {
    page.push_str(
        "<noscript>\n<p class=\"note\">The animated wall and the histories of its blocks and joints need JavaScript, which \
         is switched off or not there. Nothing is loaded from elsewhere. What follows are drawings of the same run.</p>\n",
    );
    let (mut buttons, mut drawings) = (String::new(), String::new());
    for (k, (name, drawing)) in figures::walls(content).iter().enumerate() {
        let checked = if k == 0 { " checked" } else { "" };
        let _ = write!(
            buttons,
            "<input type=\"radio\" name=\"view\" id=\"v{k}\"{checked}><label for=\"v{k}\">{name}</label>"
        );
        let _ = writeln!(drawings, "<div id=\"w{k}\">{drawing}</div>");
    }
    let views = format!("<div class=\"views\">{buttons}\n{drawings}</div>\n");
    let when = match content.outcome.recording.collapse() {
        Some(event) => format!("until its collapse at t = {}", seconds(event.time)),
        None => "over the whole run".into(),
    };
    section(page, "walls", &format!("The wall: peaks {when}"), &views);
    section(page, "histories", "Histories", &figures::histories(content).concat());
    asked(page, content);
    section(page, "energies", "Energy", &figures::energies(content).concat());
    page.push_str("</noscript>\n");
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
    section(page, "asked", "Blocks and joints asked for", &body);
}

/// Shows the view whose button is chosen, of so many, without a script.
fn view_rules(views: usize) -> String {
    let shown: Vec<String> = (0..views).map(|k| format!("#v{k}:checked~#w{k}")).collect();
    format!(".views>div{{display:none}}\n{}{{display:block}}\n", shown.join(","))
}

/// How to get this result again, and how to know that it is this one.
fn reproduction(page: &mut String, content: &Content) {
    let mut body = String::new();
    match &content.command {
        Some(command) => {
            let _ = writeln!(
                body,
                "<p>This command made it, in the folder where it was typed:</p>\n<pre class=\"copy\">{}</pre>",
                escape(command)
            );
        }
        None => body.push_str(
            "<p>Save the resolved input below as <code>case.json</code>, beside the records that it names, and run it:</p>\n\
             <pre class=\"copy\">concio run case.json --out again</pre>\n",
        ),
    }
    let _ = writeln!(
        body,
        "<p>Version and hash tell whether two results come of equal inputs, records included: Concio {}, \
         <code>inputs_hash</code></p>\n<pre class=\"copy\">{}</pre>",
        escape(text(content, "version")),
        escape(text(content, "inputs_hash"))
    );
    section(page, "reproduce", "To reproduce it", &body);
}

fn text<'a>(content: &'a Content, key: &str) -> &'a str {
    content.summary.get(key).and_then(Value::as_str).unwrap_or("–")
}

fn input(page: &mut String, content: &Content) {
    let resolved = serde_json::to_string_pretty(&content.case).unwrap_or_default();
    let mut body = String::new();
    match content.text {
        Some(text) => quote(&mut body, "wall-file", "Wall file, as it was given", text, true),
        None => body.push_str("<p class=\"small\">The wall file itself is not kept with a result.</p>\n"),
    }
    let title = "Resolved input: defaults filled in, SI units";
    quote(&mut body, "resolved", title, &resolved, content.text.is_none());
    section(page, "input", "Input", &body);
}

fn quote(body: &mut String, id: &str, title: &str, text: &str, open: bool) {
    let open = if open { " open" } else { "" };
    let text = if text.len() > LARGEST_INPUT { "Too long to be quoted here: it is in result.h5." } else { text };
    let text = escape(text);
    let _ = writeln!(
        body,
        "<details{open}><summary>{title}</summary><pre id=\"{id}\" class=\"copy long\" tabindex=\"0\">{text}</pre></details>"
    );
}
