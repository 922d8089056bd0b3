//! Every number of a mechanism with its formula and source.

use concio_mechanisms::checks::{ByDisplacement, Linear, Missing};
use concio_mechanisms::pushover::Kinematics;
use concio_mechanisms::setback::Crushing;
use concio_mechanisms::survey::{Found, Kind};
use concio_mechanisms::wall::Wall;
use concio_study::table::Table;

use super::rows::tangent;
use crate::format::significant;

/// A line of the table.
struct Line {
    quantity: String,
    value: String,
    formula: &'static str,
    source: &'static str,
}

const DERIVED: &str = "derived from (OP1), docs/mechanisms.md";
const CODE: &str = "Circolare 21.1.2019 n. 7";

/// The numbers of a mechanism.
pub fn table(wall: &Wall, found: &Found) -> Table {
    let lines = lines(wall, found);
    let mut table = Table::default();
    table.texts("quantity", lines.iter().map(|l| Some(l.quantity.clone())).collect());
    table.texts("value", lines.iter().map(|l| Some(l.value.clone())).collect());
    table.texts("formula", lines.iter().map(|l| Some(l.formula.into())).collect());
    table.texts("source", lines.iter().map(|l| Some(l.source.into())).collect());
    table
}

fn with(v: f64, unit: &str) -> String {
    format!("{} {unit}", significant(v, 5)).trim_end().into()
}

fn lines(wall: &Wall, found: &Found) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut add = |quantity: &str, value: String, formula: &'static str, source: &'static str| {
        lines.push(Line { quantity: quantity.into(), value, formula, source });
    };
    let pushover = &found.pushover;
    add(
        "hinge z_0",
        with(found.hinge, "m"),
        "the bed joint of this mechanism; the least over all counts",
        "Circolare, C8.7.1.2.1.1",
    );
    if wall.crushing != Crushing::Rigid && found.kind.is_set_back() {
        let formula = match wall.crushing {
            Crushing::Triangular(_) => "a = 2N/(3 f_h L)",
            _ => "a = N/(2 f_h L)",
        };
        add("setback a", with(found.setback, "m"), formula, "(OP2), derived");
    }
    for (i, slope) in found.slopes.iter().enumerate() {
        let name = match found.kind {
            Kind::Flap | Kind::GableFlaps => "tan ϑ of the hinge".into(),
            _ => format!("tan β of crack {}", i + 1),
        };
        let formula = match found.kind {
            Kind::Flap | Kind::GableFlaps => "the slope that makes α0 least, no steeper than the texture's own l/h_b",
            _ => "the slope that makes α0 least, up to the texture's own l/h_b or the first opening",
        };
        add(&name, tangent(*slope).map_or("none, ϑ = 90°".into(), |tan| with(tan, "")), formula, DERIVED);
    }
    if let Kinematics::Body(body, _) = &pushover.kinematics {
        let sum = |of: &dyn Fn(&concio_mechanisms::body::Weight) -> f64| body.weights.iter().map(of).sum::<f64>();
        let own = body.weights.first().copied().unwrap_or_default();
        add(
            "own weight W",
            with(1e-3 * own.carried, "kN"),
            "Σ γ t A of what lies above the hinge, less openings",
            "wall file",
        );
        add("its centroid over the hinge", with(own.height, "m"), "Σ z dA/A", "wall file");
        add(
            "Σ P",
            with(1e-3 * sum(&|w| w.carried), "kN"),
            "own weight, floors, roof, wedges of side walls",
            "wall file",
        );
        let ties: f64 = body.holds.iter().map(|h| h.force * h.height).sum();
        if ties > 0.0 {
            add(
                "moment of ties and friction",
                with(1e-3 * ties, "kN m"),
                "Σ T (z − z_0) + Σ μ_f P (z − z_0) + side walls",
                "(OP3), (OP4)",
            );
        }
    }
    if let Some([needed, borne]) = found.reaction {
        add(
            "reaction R at the top",
            with(1e-3 * needed.unwrap_or(0.0), "kN"),
            "R = [α0 Σ W z − Σ W x − N (t − d)]/h",
            "(OP6), derived",
        );
        let known = borne.map_or("not given: assumed to be enough".into(), |b| with(1e-3 * b, "kN"));
        add("what bears R", known, "connection + ties + μ_f P", "wall file");
    }
    add(
        "α0",
        with(found.multiplier(), ""),
        formula(found.kind),
        if found.kind == Kind::Overturning {
            "(OP3) of docs/mechanisms.md, from Circolare (C8.7.1.1)"
        } else {
            DERIVED
        },
    );
    add("e*", with(pushover.participation, ""), "e* = [Σ(P+Q)δ]²/(Σ(P+Q) Σ(P+Q)δ²)", "Circolare, (C8.7.1.5)");
    add(
        "FC",
        with(found.confidence, ""),
        "confidence factor; that of LC1 where crushing is left out",
        "Circolare, C8.7.1.2.1.4",
    );
    add("a*", with(found.checks.acceleration, "m/s²"), "a* = α0 g/(e* FC), g = 9.81 m/s²", "Circolare, (C8.7.1.3)");
    add("θ0", with(pushover.last_turn, "rad"), "α = 0 of weights and thrusts, exact kinematics", DERIVED);
    add("d/d_C", with(pushover.part, ""), "Σ(P+Q)δ²/(δ_C Σ(P+Q)δ)", "Circolare, (C8.7.1.4)");
    add("d0", with(pushover.last, "m"), "d at θ0", "Circolare, (C8.7.1.4)");
    if let Some(drop) = pushover.drop {
        add("d where ties or friction end", with(drop, "m"), "α drops by more than half", "Circolare, C8.7.1.2.1.6");
    }
    checks(&mut lines, found, wall);
    lines
}

fn formula(kind: Kind) -> &'static str {
    match kind {
        Kind::Overturning | Kind::Leaf => {
            "[W (t/2 − a) + Σ P (x − a) + Σ (T + μ_f P − H)(z − z_0)] / [W z_G + Σ (P + Q)(z − z_0)]"
        }
        Kind::WithSideWalls => {
            "as (OP3), with Σ [W_w (t + h_w tan β/3) + (1 − tan β/tan β_b) F z_F] above and Σ W_w 2 h_w/3 below the line"
        }
        Kind::VerticalArch => "[Σ W δ_y + N δ_Ny] / Σ W δ_x; uniform: (2t/h) [1 + n (1 + (d/t) x/(1−x))]/x",
        Kind::HorizontalArch => "2 H_r t/(w L_1 L_2) + μ (1 + N/W)",
        Kind::Corner => "[∫γ s dV + P s_P − H h + Σ (1 − tan β/tan β_b) F z_F] / [∫γ z dV + (P + Q) h]",
        Kind::Flap | Kind::GableFlaps => {
            "[W (t/2) sin ϑ + Σ P c sin ϑ + H t cos ϑ] / [W e_G + Σ (P + Q) e], ties and thrusts as in (OP3)"
        }
        Kind::Gable => "[W t/2 + P c − H h_g] / [W h_g/3 + (P + Q) h_g]",
    }
}

fn checks(lines: &mut Vec<Line>, found: &Found, wall: &Wall) {
    let aloft = found.level > 0.0;
    let c = &found.checks;
    let demand =
        if aloft { "a_Z = S_e(T_1, ξ_1) |γ_1 ψ_1| √(1 + 0.0004 ξ_1²), no less than a_g S" } else { "a_g S" };
    let source = if aloft { "Circolare, (C7.2.5)" } else { "NTC 2018, 3.2.3.2" };
    if aloft {
        let at = with(found.level, "m");
        lines.push(Line {
            quantity: "level of the check z".into(),
            value: at,
            formula: "of the hinge; the mean of two supports",
            source: CODE,
        });
    }
    let mut linear = |name: &str, check: Result<Linear, Missing>, capacity: &'static str| match check {
        Ok(l) => {
            for (quantity, value, formula, source) in [
                ("capacity", with(l.capacity, "m/s²"), capacity, "Circolare, C8.7.1.2.1.5 and .7"),
                ("demand", with(l.demand, "m/s²"), demand, source),
                ("capacity/demand", with(l.ratio(), ""), "satisfied from 1 on", CODE),
            ] {
                lines.push(Line { quantity: format!("{name}: {quantity}"), value, formula, source });
            }
        }
        Err(why) => {
            lines.push(Line { quantity: name.into(), value: format!("not made: {why}"), formula: "", source: "" })
        }
    };
    linear("SLD", c.damage, "a*");
    linear("SLV, linear", c.life, if wall.behaviour == 2.0 { "q a*, q = 2" } else { "q a*, q as given" });
    let mut by = |name: &str, check: Result<ByDisplacement, Missing>, texts: [&'static str; 3]| match check {
        Ok(d) => {
            let ratio =
                if d.by_damage { "that of the linear damage check, which bears more" } else { "satisfied from 1 on" };
            for (quantity, value, formula) in [
                ("d", with(d.capacity, "m"), texts[0]),
                ("a(d)", with(d.acceleration, "m/s²"), "α(d) g/(e* FC), ties and friction by their laws"),
                ("T", with(d.period, "s"), texts[1]),
                ("demand S_De(T, ξ)", with(d.demand, "m"), texts[2]),
                ("capacity/demand", with(d.ratio, ""), ratio),
            ] {
                let quantity = format!("{name}: {quantity}");
                lines.push(Line { quantity, value, formula, source: "Circolare, C8.7.1.2.1.6 and .8" });
            }
        }
        Err(why) => {
            lines.push(Line { quantity: name.into(), value: format!("not made: {why}"), formula: "", source: "" })
        }
    };
    by("SLV", c.life_displacement, ["least of 0.4 d0 and where α drops by more than half", "1.68 π √(d/a)", "ξ = 8 %"]);
    by("SLC", c.collapse, ["least of 0.6 d0 and where beams lose their seat", "1.56 π √(d/a)", "ξ = 10 %"]);
}
