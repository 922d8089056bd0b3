//! The section about critical joints.

use std::path::Path;

use concio::case::{Beam, Case};
use concio::{graph, pattern};
use concio_study::Plan;
use concio_study::measures::Row;
use concio_study::ranking::{self, Ranks, name, ranks, spearman};
use concio_study::table;

use super::page::{Figure, Section};
use super::wall_map::{self, Map};
use crate::failure::Failure;
use crate::format::{columns, counted, short, significant};

/// The joints in order, if the study asks for it and the runs are of one wall; its table goes into the folder as well.
///
/// # Errors
/// A table that cannot be written.
pub fn section(plan: &Plan, case: &Case, rows: &[Option<&Row>], out: &Path) -> Result<Option<Section>, Failure> {
    let Some(asked) = &plan.file.study.ranking else { return Ok(None) };
    let rows: Vec<&Row> = rows.iter().flatten().copied().collect();
    let all: Vec<Ranks> = asked.by.iter().filter_map(|by| ranks(&rows, *by)).collect();
    let wall = pattern::lay(case)?;
    let joints = graph::joints(&wall, case.load.beam != Beam::Free);
    let names: Vec<String> = joints.iter().map(|j| graph::name(&wall, j)).collect();
    let mut section = Section { title: "Critical joints".into(), ..Section::default() };
    if all.is_empty() || all.iter().any(|r| r.order.len() != names.len()) {
        section.text.push("The runs are of different walls: their joints cannot be ranked together.".into());
        return Ok(Some(section));
    }
    let lines = ranking::table(&all, &names);
    table::write_csv(&lines, &out.join("ranking.csv"))?;
    section.brief = brief(&all, &names, asked.listed);
    section.text = all.iter().map(|r| said(r, &names, asked.listed)).collect();
    section.text.extend(compared(&all));
    if plan.file.study.motions.iter().any(|m| m.held_out) {
        section.text.push("Held-out motions are among these runs; greedy placements are ranked without them.".into());
    }
    let map = |r: &Ranks| {
        let most = r.ratio.iter().fold(0.0f64, |m, v| m.max(*v)).max(f64::MIN_POSITIVE);
        Map {
            heading: format!("by {}", name(r.by)),
            values: r.ratio.iter().map(|v| v / most).collect(),
            marked: r.order.iter().filter(|&&e| r.ratio[e] > 0.0).take(asked.listed).copied().collect(),
        }
    };
    let maps: Vec<Map> = all.iter().map(map).collect();
    let label = "mean ratio to the largest of a run, over the largest";
    let caption = format!(
        "Every joint's share in the largest value of any joint, mean over the runs; the {} highest marked.",
        asked.listed
    );
    let drawing = wall_map::draw(&wall, &joints, &names, &maps, "Critical joints", label);
    section.figures.push(Figure { name: "critical-joints".into(), caption, drawing });
    section.tables.push(("All joints".into(), lines));
    Ok(Some(section))
}

/// The first joints by each ranking side by side, mean ratio in brackets.
fn brief(all: &[Ranks], names: &[String], listed: usize) -> String {
    let heading = ["critical joints".to_string()].into_iter().chain(all.iter().map(|r| format!("by {}", name(r.by))));
    let mut lines: Vec<Vec<String>> = vec![heading.collect()];
    for place in 0..listed.min(names.len()) {
        let of = |r: &Ranks| {
            let e = r.order[place];
            if r.ratio[e] > 0.0 { format!("{} ({})", names[e], significant(r.ratio[e], 2)) } else { "–".into() }
        };
        lines.push([(place + 1).to_string()].into_iter().chain(all.iter().map(of)).collect());
    }
    columns(&lines)
}

fn said(ranks: &Ranks, names: &[String], listed: usize) -> String {
    if ranks.runs == 0 {
        return format!("By {}: it is zero in every joint of every run, so none is critical.", name(ranks.by));
    }
    let one = |&e: &usize| format!("{} ({})", names[e], significant(ranks.ratio[e], 2));
    let first: Vec<String> = ranks.order.iter().filter(|&&e| ranks.ratio[e] > 0.0).take(listed).map(one).collect();
    let most = ranks.largest.iter().fold(0.0f64, |m, v| m.max(*v));
    let agree = match ranks.agreement {
        Some(rho) => {
            format!(" The order in one run tells that in another with a rank correlation of {}.", significant(rho, 2))
        }
        None => String::new(),
    };
    format!(
        "By {}, over {}, mean ratio in brackets: {}. The largest value of any run is {}.{agree}",
        name(ranks.by),
        counted(ranks.runs, "run"),
        first.join(", "),
        match ranks.by.unit() {
            "m/s²" => format!("{} m/s²", significant(most, 4)),
            unit => short(most, unit).trim_end().to_string(),
        },
    )
}

/// How far the rankings agree.
fn compared(all: &[Ranks]) -> Option<String> {
    let mut said = Vec::new();
    for (i, a) in all.iter().enumerate() {
        for b in &all[..i] {
            if let Some(rho) = spearman(&a.ratio, &b.ratio) {
                said.push(format!("{} and {}: {}", name(b.by), name(a.by), significant(rho, 2)));
            }
        }
    }
    (!said.is_empty()).then(|| format!("Rank correlation of the orders. {}.", said.join("; ")))
}
