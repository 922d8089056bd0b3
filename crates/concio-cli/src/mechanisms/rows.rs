//! Tables and JSON of mechanisms.

use concio_mechanisms::checks::{ByDisplacement, Linear, Missing};
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::{Found, Kind};
use concio_study::table::Table;
use serde_json::{Value, json};

use super::Subject;

/// All mechanisms, one line each.
pub fn table(subject: &Subject) -> Table {
    let found = &subject.survey.found;
    let mut table = Table::default();
    let texts = |of: &dyn Fn(&Found) -> String| found.iter().map(|f| Some(of(f))).collect();
    let numbers = |of: &dyn Fn(&Found) -> Option<f64>| found.iter().map(of).collect();
    table.texts("mechanism", texts(&|f| f.kind.name().into()));
    table.texts("equation", texts(&|f| f.kind.equation().into()));
    table.texts("counts", texts(&|f| if f.counts { "yes" } else { "no" }.into()));
    table.numbers("hinge", "m", numbers(&|f| Some(f.hinge)));
    table.numbers("tan_crack", "", numbers(&|f| f.slopes.first().copied().and_then(tangent)));
    table.numbers("setback", "m", numbers(&|f| Some(f.setback)));
    table.numbers("alpha_0", "", numbers(&|f| Some(f.multiplier())));
    table.numbers("participation", "", numbers(&|f| Some(f.pushover.participation)));
    table.numbers("a_star", "m/s2", numbers(&|f| Some(f.checks.acceleration)));
    table.numbers("d_0", "m", numbers(&|f| Some(f.pushover.last)));
    table.numbers("level_of_check", "m", numbers(&|f| Some(f.level)));
    table.numbers("sld_ratio", "", numbers(&|f| f.checks.damage.ok().map(|c| c.ratio())));
    table.numbers("slv_linear_ratio", "", numbers(&|f| f.checks.life.ok().map(|c| c.ratio())));
    table.numbers("slv_displacement_ratio", "", numbers(&|f| f.checks.life_displacement.ok().map(|c| c.ratio)));
    table.numbers("slc_displacement_ratio", "", numbers(&|f| f.checks.collapse.ok().map(|c| c.ratio)));
    table.texts("governed_by", texts(&governed));
    table.texts("notes", texts(&|f| f.notes.join("; ")));
    table
}

/// What makes up α0, largest first; of arches the place of the hinge says it.
pub fn governed(found: &Found) -> String {
    let Some(shares) = found.shares else { return "thrust line between the hinges".into() };
    let mut parts = vec![
        ("own weight", shares.wall),
        ("floors, roof, wedges", shares.loads),
        ("thrust", shares.thrusts),
        ("ties", shares.ties),
        ("friction", shares.friction),
        ("thrust on the crack", shares.presses),
    ];
    parts.retain(|(_, v)| v.abs() > 1e-9);
    parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let told = |(name, v): &(&str, f64)| format!("{name} {}{:.4}", if *v < 0.0 { "−" } else { "+" }, v.abs());
    parts.iter().map(told).collect::<Vec<_>>().join(", ")
}

/// Everything, in SI.
pub fn json(subject: &Subject) -> Value {
    let Subject { title, wall, survey, overlaps, trilinear } = subject;
    let one = |f: &Found| short(f);
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "title": title,
        "overlaps": match overlaps { Overlaps::Summed => "summed", _ => "code" },
        "wall": {
            "thickness": wall.masonry.thickness, "length": wall.length(), "height": wall.top,
            "weight": wall.masonry.above(0.0).weight, "levels": wall.levels,
            "course_height": wall.texture[0], "overlap": wall.texture[1],
            "confidence_factor": wall.confidence, "behaviour_factor": wall.behaviour,
        },
        "least": survey.least().map(one),
        "worst_check": survey.worst().map(one),
        "mechanisms": survey.found.iter().map(|f| mechanism(f, *trilinear)).collect::<Vec<_>>(),
        "without": survey.without.iter().map(|(kind, why)| json!({ "kind": kind.name(), "why": why })).collect::<Vec<_>>(),
        "assumed": wall.assumed.iter().map(|a| json!({ "key": a.key, "what": a.what })).collect::<Vec<_>>(),
        "limits": super::LIMITS,
    })
}

fn short(found: &Found) -> Value {
    json!({ "kind": found.kind.name(), "hinge": found.hinge, "multiplier": found.multiplier(), "ratio": found.checks.ratio() })
}

fn mechanism(found: &Found, trilinear: Option<[f64; 2]>) -> Value {
    let pushover = &found.pushover;
    let curve: Vec<Value> = pushover
        .curve()
        .iter()
        .map(|p| json!({ "turn": p.turn, "control": p.control, "displacement": p.displacement, "multiplier": p.multiplier, "sure": p.sure }))
        .collect();
    let shares = found.shares.map(|s| {
        json!({
            "wall": s.wall, "loads": s.loads, "thrusts": s.thrusts, "ties": s.ties, "friction": s.friction, "cracks": s.presses,
        })
    });
    let c = &found.checks;
    json!({
        "kind": found.kind.name(),
        "equation": found.kind.equation(),
        "counts": found.counts,
        "hinge": found.hinge,
        "cracks": found.slopes.iter().copied().map(tangent).collect::<Vec<_>>(),
        "setback": found.setback,
        "multiplier": found.multiplier(),
        "shares": shares,
        "participation": pushover.participation,
        "acceleration": c.acceleration,
        "last_turn": pushover.last_turn,
        "last_displacement": pushover.last,
        "drop": pushover.drop,
        "reaction": found.reaction.map(|[needed, borne]| json!({ "needed": needed, "borne": borne })),
        "level": found.level,
        "checks": {
            "damage": linear(c.damage), "life_safety": linear(c.life),
            "life_safety_by_displacement": by_displacement(c.life_displacement),
            "collapse_by_displacement": by_displacement(c.collapse),
            "ratio": c.ratio(),
        },
        "curve": curve,
        "trilinear": trilinear.and_then(|parts| pushover.trilinear(parts)).map(|t| json!({
            "displacements": t.ends, "multiplier": t.plateau,
            "acceleration": pushover.acceleration(t.plateau, found.confidence),
        })),
        "notes": found.notes,
    })
}

/// tan ϑ above which a hinge is level: what rounding leaves of that of 90°.
const LEVEL_HINGE: f64 = 1e9;

/// tan β or tan ϑ; none of a level hinge.
pub(super) fn tangent(value: f64) -> Option<f64> {
    Some(value).filter(|tan| *tan <= LEVEL_HINGE)
}

fn linear(check: Result<Linear, Missing>) -> Value {
    match check {
        Ok(c) => json!({ "capacity": c.capacity, "demand": c.demand, "ratio": c.ratio() }),
        Err(why) => json!({ "not_made": why.to_string() }),
    }
}

fn by_displacement(check: Result<ByDisplacement, Missing>) -> Value {
    match check {
        Ok(c) => json!({
            "capacity": c.capacity, "acceleration": c.acceleration, "period": c.period, "demand": c.demand,
            "ratio": c.ratio, "by_damage_check": c.by_damage,
        }),
        Err(why) => json!({ "not_made": why.to_string() }),
    }
}

/// How a kind is called beside its hinge.
pub fn label(found: &Found) -> String {
    match found.kind {
        Kind::Gable => "gable about its base".into(),
        kind => format!("{}, {:.2} m", kind.what(), found.hinge),
    }
}
