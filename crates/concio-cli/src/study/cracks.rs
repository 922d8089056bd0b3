//! Crack lines of a study: tables, maps, words.

use std::path::Path;

use concio::case::Case;
use concio::model::Model;
use concio_study::Plan;
use concio_study::crack_lines::{Group, count};
use concio_study::limits::Criterion;
use concio_study::measures::Row;
use concio_study::table::{self, Table};

use super::crack_map::maps;
use super::page::{Figure, Section};
use crate::failure::Failure;
use crate::format::{counted, si, significant};

/// Groups that are drawn.
const MOST_MAPS: usize = 6;

/// Counts the cracks of a study that asks for them, writes `cracks.csv` and `crack-lines.csv`; its part of the report.
pub fn section(plan: &Plan, case: &Case, rows: &[Option<&Row>], out: &Path) -> Result<Option<Section>, Failure> {
    let Some(input) = &plan.file.study.cracks else { return Ok(None) };
    let model = concio::run::prepare_case(case.clone(), Path::new(""))?.model;
    let groups = count(input, plan, &model, rows);
    let (joints, lines) = (of_joints(&model, &groups), of_lines(&model, &groups));
    table::write_csv(&joints, &out.join("cracks.csv"))?;
    table::write_csv(&lines, &out.join("crack-lines.csv"))?;
    let threshold =
        format!("{} %", significant(100.0 * input.threshold, 3).trim_end_matches('0').trim_end_matches('.'));
    let limit = match (input.criterion, input.rule().limit) {
        (Criterion::Opening, Some(limit)) => {
            format!("a head joint counts as cracked when it opened by {}", si(limit, "m"))
        }
        (Criterion::Slip, Some(limit)) => {
            format!(
                "a bed joint counts as cracked when its sides were displaced by {} against each other",
                si(limit, "m")
            )
        }
        _ => "a joint is cracked when its mortar reached its strength".into(),
    };
    let mut text = vec![format!(
        "Share of the runs in which each joint cracks ({limit}). Joints that crack in at least {threshold} of them and meet at \
         the corner of a block form a line."
    )];
    text.extend(groups.iter().map(|g| words(&model, g)));
    let figure = Figure {
        name: "crack-lines".into(),
        caption: format!(
            "Joints by the share of runs in which they crack, by width and shade; lines of joints that crack in at least \
             {threshold} of the runs have a dark edge and a number."
        ),
        drawing: maps(&model, drawn(&groups)),
    };
    let tables = vec![("Lines".to_string(), lines), ("Joints".to_string(), joints)];
    Ok(Some(Section { title: "Crack lines".into(), text, figures: vec![figure], tables, ..Section::default() }))
}

/// Each scale on its own, where there are several.
fn drawn(groups: &[Group]) -> &[Group] {
    let some = if groups.len() > 1 { &groups[1..] } else { groups };
    &some[..some.len().min(MOST_MAPS)]
}

fn words(model: &Model, group: &Group) -> String {
    let mut said = format!(
        "{}: {}, cracks in {} of them, {} joints in the mean of all",
        capital(&group.name),
        counted(group.runs, "run"),
        group.cracked,
        significant(group.mean, 3)
    );
    if let Some(often) = group
        .joints
        .iter()
        .filter(|j| j.cracked > 0)
        .max_by(|a, b| a.frequency.total_cmp(&b.frequency).then(b.joint.cmp(&a.joint)))
    {
        let name = concio::graph::name(&model.wall, &model.joints[often.joint]);
        said.push_str(&format!("; most often {name} ({} of the runs)", percent(often.frequency)));
        let first = group.joints.iter().max_by(|a, b| a.first.cmp(&b.first).then(b.joint.cmp(&a.joint)));
        if let Some(first) = first.filter(|j| j.first > 0) {
            let name = concio::graph::name(&model.wall, &model.joints[first.joint]);
            said.push_str(&format!(", first of all most often {name} (in {})", counted(first.first, "run")));
        }
    }
    match group.lines.first() {
        None => said.push_str("; no line."),
        Some(line) => {
            let across = match line.through {
                [true, true] => ", across the wall and from bottom to top",
                [true, false] => ", from one end of the wall to the other",
                [false, true] => ", from bottom to top",
                _ => "",
            };
            said.push_str(&format!(
                "; {}, the largest of {} ({} upright){across}, all of which crack in {} of the runs.",
                counted(group.lines.len(), "line"),
                counted(line.joints.len(), "joint"),
                line.heads,
                percent(line.whole)
            ));
        }
    }
    said
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |c| c.to_uppercase().collect::<String>() + letters.as_str())
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn of_joints(model: &Model, groups: &[Group]) -> Table {
    let all: Vec<_> = groups.iter().flat_map(|g| g.joints.iter().map(move |j| (g, j))).collect();
    let joint = |e: usize| &model.joints[e];
    let kind = |e: usize| crate::draw::wall::kind_name(joint(e).kind).to_string();
    let mut table = Table::default();
    table.texts("runs counted", all.iter().map(|(g, _)| Some(g.name.clone())).collect());
    table.texts("joint", all.iter().map(|(_, j)| Some(concio::graph::name(&model.wall, joint(j.joint)))).collect());
    table.texts("kind", all.iter().map(|(_, j)| Some(kind(j.joint))).collect());
    table.numbers("runs", "", all.iter().map(|(g, _)| Some(g.runs as f64)).collect());
    table.numbers("cracked", "", all.iter().map(|(_, j)| Some(j.cracked as f64)).collect());
    table.numbers("frequency", "", all.iter().map(|(_, j)| Some(j.frequency)).collect());
    table.numbers("frequency_low", "", all.iter().map(|(_, j)| Some(j.interval[0])).collect());
    table.numbers("frequency_high", "", all.iter().map(|(_, j)| Some(j.interval[1])).collect());
    table.numbers("mean_order", "", all.iter().map(|(_, j)| j.order).collect());
    table.numbers("first", "", all.iter().map(|(_, j)| Some(j.first as f64)).collect());
    let line = |g: &Group, e: usize| g.lines.iter().position(|l| l.joints.contains(&e)).map(|k| format!("L{}", k + 1));
    table.texts("line", all.iter().map(|(g, j)| line(g, j.joint)).collect());
    table
}

fn of_lines(model: &Model, groups: &[Group]) -> Table {
    let all: Vec<_> = groups.iter().flat_map(|g| g.lines.iter().enumerate().map(move |(k, l)| (g, k, l))).collect();
    let names = |joints: &[usize]| {
        joints.iter().map(|e| concio::graph::name(&model.wall, &model.joints[*e])).collect::<Vec<_>>().join(" ")
    };
    let yes = |yes: bool| Some(if yes { "yes" } else { "no" }.to_string());
    let mut table = Table::default();
    table.texts("runs counted", all.iter().map(|(g, ..)| Some(g.name.clone())).collect());
    table.texts("line", all.iter().map(|(_, k, _)| Some(format!("L{}", k + 1))).collect());
    table.numbers("joints", "", all.iter().map(|(.., l)| Some(l.joints.len() as f64)).collect());
    table.numbers("upright", "", all.iter().map(|(.., l)| Some(l.heads as f64)).collect());
    table.numbers("length", "m", all.iter().map(|(.., l)| Some(l.length)).collect());
    table.numbers("mean_frequency", "", all.iter().map(|(.., l)| Some(l.frequency)).collect());
    table.numbers("frequency_of_all", "", all.iter().map(|(.., l)| Some(l.whole)).collect());
    table.texts("end to end", all.iter().map(|(.., l)| yes(l.through[0])).collect());
    table.texts("bottom to top", all.iter().map(|(.., l)| yes(l.through[1])).collect());
    table.texts("members", all.iter().map(|(.., l)| Some(names(&l.joints))).collect());
    table
}
