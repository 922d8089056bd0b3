//! The findings of the research report and by what each is decided. A criterion holds for every setting alike; docs/report-cases.md
//! says what came of each, and where a measure replaced one that had been tried before.

use super::measures::{Measures, largest, median, rank_correlation};

/// The six runs under one setting.
#[derive(Debug, Clone, Copy)]
pub struct Set<'a> {
    /// Regular, all parameters.
    pub one: &'a Measures,
    /// Irregular.
    pub two: &'a Measures,
    /// Undamped.
    pub three: &'a Measures,
    /// Frictionless.
    pub four: &'a Measures,
    /// No bed stiffness.
    pub five: &'a Measures,
    /// Case 1 with μ_d = μ_s.
    pub control: &'a Measures,
}

/// A number that bears on a finding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// What it is.
    pub name: &'static str,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// The value.
    pub value: f64,
}

/// A finding of the research report.
#[derive(Debug, Clone, Copy)]
pub struct Finding {
    /// Short name.
    pub id: &'static str,
    /// Where the research report shows it.
    pub figure: &'static str,
    /// What the research report finds, in our words.
    pub claim: &'static str,
    /// What has to hold for a yes.
    pub criterion: &'static str,
    /// The numbers, in the order that `holds` takes them.
    pub numbers: fn(&Set) -> Vec<Number>,
    /// The criterion.
    pub holds: fn(&[f64]) -> bool,
}

/// All of them, in the order of the research report.
pub const FINDINGS: [Finding; 11] = [
    Finding {
        id: "jumps-from-stick-slip",
        figure: "22 b",
        claim: "jumps in the phase portrait come from stick-slip",
        criterion: "The median block jumps, and at least ten times as often as without friction and as with friction \
                    that cannot stick-slip (μ_d = μ_s); the median joint starts to slip at least ten times as often as \
                    without friction; jumps fall together with changes between stick and slip more often than by chance.",
        numbers: |s| {
            vec![
                number("jumps of the median block, case 1", "", s.one.typical_jumps),
                number("jumps of the median block without friction, case 4", "", s.four.typical_jumps),
                number("jumps of the median block with μ_d = μ_s", "", s.control.typical_jumps),
                number("slip starts of the median joint, case 1", "", s.one.typical_onsets),
                number("slip starts of the median joint without friction, case 4", "", s.four.typical_onsets),
                number("jumps of joints at a change between stick and slip", "", s.one.linked_jumps),
                number("frames within reach of such a change", "", s.one.linked_by_chance),
            ]
        },
        holds: |n| n[0] > 0.0 && n[0] >= 10.0 * n[1].max(n[2]) && n[3] > 0.0 && n[3] >= 10.0 * n[4] && n[5] > n[6],
    },
    Finding {
        id: "no-interpenetration",
        figure: "22 c",
        claim: "blocks never interpenetrate",
        criterion: "The deepest closure of a head joint is at most a twentieth of the widest opening.",
        numbers: |s| {
            vec![
                number("deepest closure, case 1", "m", s.one.deepest_closure),
                number("widest opening, case 1", "m", s.one.widest_opening),
            ]
        },
        holds: |n| n[0] <= 0.05 * n[1],
    },
    Finding {
        id: "irregular-alike",
        figure: "23",
        claim: "an irregular texture responds qualitatively alike",
        criterion: "Shares of friction in the dissipation within 0.1 of each other; slip starts per second and median \
                    openings within a factor of three; velocities jump in both.",
        numbers: |s| {
            vec![
                number("share of friction in the dissipation, case 1", "", share(s.one)),
                number("share of friction in the dissipation, case 2", "", share(s.two)),
                number("slip starts of the median joint, case 1", "Hz", s.one.onset_rate),
                number("slip starts of the median joint, case 2", "Hz", s.two.onset_rate),
                number("opening of the median head joint, case 1", "m", s.one.typical_opening),
                number("opening of the median head joint, case 2", "m", s.two.typical_opening),
                number("jumps of the median block, case 1", "", s.one.typical_jumps),
                number("jumps of the median block, case 2", "", s.two.typical_jumps),
            ]
        },
        holds: |n| {
            let alike = |a: f64, b: f64| a > 0.0 && b > 0.0 && a <= 3.0 * b && b <= 3.0 * a;
            (n[0] - n[1]).abs() <= 0.1 && alike(n[2], n[3]) && alike(n[4], n[5]) && n[6] > 0.0 && n[7] > 0.0
        },
    },
    Finding {
        id: "undamped-slightly-larger",
        figure: "24",
        claim: "without damping displacements are slightly larger",
        criterion: "The opening of the median head joint is larger than in case 1, by 2 % to 50 %.",
        numbers: |s| {
            vec![
                number(
                    "opening of the median head joint, case 3 over 1",
                    "",
                    s.three.typical_opening / s.one.typical_opening,
                ),
                number("widest opening, case 3 over 1", "", s.three.widest_opening / s.one.widest_opening),
                number(
                    "largest displacement of a block, case 3 over 1",
                    "",
                    s.three.peak_displacement / s.one.peak_displacement,
                ),
                number("rms velocity of the blocks, case 3 over 1", "", s.three.rms_velocity / s.one.rms_velocity),
                number(
                    "largest slip velocity, case 3 over 1",
                    "",
                    s.three.peak_slip_velocity / s.one.peak_slip_velocity,
                ),
            ]
        },
        holds: |n| n[0] >= 1.02 && n[0] <= 1.5,
    },
    Finding {
        id: "frictionless-no-jumps",
        figure: "25 b",
        claim: "without friction there are no jumps",
        criterion: "Jumps of the median block are at most a tenth of those in case 1, which has some.",
        numbers: |s| {
            vec![
                number("jumps of the median block, case 4", "", s.four.typical_jumps),
                number("jumps of the median block, case 1", "", s.one.typical_jumps),
            ]
        },
        holds: |n| n[1] > 0.0 && 10.0 * n[0] <= n[1],
    },
    Finding {
        id: "frictionless-smaller",
        figure: "25 c",
        claim: "without friction relative displacements are markedly smaller",
        criterion: "The opening of the median head joint and the widest opening are smaller by a third or more.",
        numbers: |s| {
            vec![
                number(
                    "opening of the median head joint, case 4 over 1",
                    "",
                    s.four.typical_opening / s.one.typical_opening,
                ),
                number("widest opening, case 4 over 1", "", s.four.widest_opening / s.one.widest_opening),
                number("widest opening, μ_d = μ_s over case 1", "", s.control.widest_opening / s.one.widest_opening),
                number(
                    "displacement of the median bed joint, case 4 over 1",
                    "",
                    s.four.typical_slip / s.one.typical_slip,
                ),
            ]
        },
        holds: |n| n[0] <= 2.0 / 3.0 && n[1] <= 2.0 / 3.0,
    },
    Finding {
        id: "no-bed-stiffness-histories",
        figure: "26",
        claim: "without bed stiffness displacements and velocities change strongly",
        criterion: "Rms displacement and rms velocity of the blocks both change by a factor of two or more.",
        numbers: |s| {
            vec![
                number(
                    "rms displacement of the blocks, case 5 over 1",
                    "",
                    s.five.rms_displacement / s.one.rms_displacement,
                ),
                number("rms velocity of the blocks, case 5 over 1", "", s.five.rms_velocity / s.one.rms_velocity),
                number(
                    "largest displacement of a block, case 5 over 1",
                    "",
                    s.five.peak_displacement / s.one.peak_displacement,
                ),
            ]
        },
        holds: |n| strongly(n[0]) && strongly(n[1]),
    },
    Finding {
        id: "no-bed-stiffness-no-stick-slip",
        figure: "26 b",
        claim: "without bed stiffness stick-slip does not occur",
        criterion: "No joint starts to slip more than twice as often as one does without friction, where only the drive's \
                    reversals do it; jumps of the median block are at most a tenth of those in case 1, which has some.",
        numbers: |s| {
            vec![
                number("slip starts of the joint with most of them, case 5", "", s.five.most_onsets),
                number("slip starts of the joint with most of them, case 4", "", s.four.most_onsets),
                number("slip starts of the joint with most of them, case 1", "", s.one.most_onsets),
                number("jumps of the median block, case 5", "", s.five.typical_jumps),
                number("jumps of the median block, case 1", "", s.one.typical_jumps),
            ]
        },
        holds: |n| n[0] <= 2.0 * n[1] && n[4] > 0.0 && 10.0 * n[3] <= n[4],
    },
    Finding {
        id: "uneven-accelerations",
        figure: "27",
        claim: "relative accelerations are uneven over the joints",
        criterion: "At the instant of the largest relative acceleration it is at least twice the median joint's, in both textures.",
        numbers: |s| {
            vec![
                number("largest over median at that instant, case 1", "", s.one.uneven_at_instant),
                number("largest over median at that instant, case 2", "", s.two.uneven_at_instant),
                number("largest over median of the peaks of the whole run, case 1", "", unevenness(s.one)),
                number("largest over median of the peaks of the whole run, case 2", "", unevenness(s.two)),
                number("largest, case 1", "m/s²", largest(&values(s.one))),
                number("largest, case 2", "m/s²", largest(&values(s.two))),
            ]
        },
        holds: |n| n[0] >= 2.0 && n[1] >= 2.0,
    },
    Finding {
        id: "accelerations-follow-sizes",
        figure: "27",
        claim: "relative accelerations depend on the texture and on the sizes of joints and bricks",
        criterion: "The peaks of the joints go with the mass of the lighter of their two blocks in both textures: rank \
                    correlation of 0.5 or more, of either sign.",
        numbers: |s| {
            vec![
                number("rank correlation with the lighter block's mass, case 1", "", with_mass(s.one)),
                number("rank correlation with the lighter block's mass, case 2", "", with_mass(s.two)),
                number("rank correlation with the contact length, case 1", "", with_overlap(s.one)),
                number("rank correlation with the contact length, case 2", "", with_overlap(s.two)),
            ]
        },
        holds: |n| n[0].abs() >= 0.5 && n[1].abs() >= 0.5,
    },
    Finding {
        id: "stiffness-and-friction-govern",
        figure: "conclusions",
        claim: "both stiffness and friction govern the response",
        criterion: "Without friction the work done on the wall, and without bed stiffness the force of the beam (rms), changes \
                    by a factor of two or more.",
        numbers: |s| {
            vec![
                number("work, case 4 over 1", "", s.four.input / s.one.input),
                number("rms force of the beam, case 5 over 1", "", s.five.top_force_rms / s.one.top_force_rms),
                number("rms force of the beam, case 4 over 1", "", s.four.top_force_rms / s.one.top_force_rms),
                number("work, case 5 over 1", "", s.five.input / s.one.input),
            ]
        },
        holds: |n| strongly(n[0]) && strongly(n[1]),
    },
];

/// By a factor of two or more, either way.
fn strongly(ratio: f64) -> bool {
    ratio >= 2.0 || ratio <= 0.5
}

fn number(name: &'static str, unit: &'static str, value: f64) -> Number {
    Number { name, unit, value }
}

/// Of friction in what is dissipated.
fn share(m: &Measures) -> f64 {
    m.friction / (m.friction + m.damping)
}

fn values(m: &Measures) -> Vec<f64> {
    m.accelerations.iter().map(|(_, a)| *a).collect()
}

fn unevenness(m: &Measures) -> f64 {
    let values = values(m);
    largest(&values) / median(&values)
}

fn with_overlap(m: &Measures) -> f64 {
    rank_correlation(&values(m), &m.overlaps)
}

fn with_mass(m: &Measures) -> f64 {
    rank_correlation(&values(m), &m.lighter_masses)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blank() -> Measures {
        let zeros: serde_json::Value = serde_json::json!({
            "inputs_hash": "", "input": 1.0, "friction": 1.0, "damping": 1.0, "nonreciprocal": 0.0, "residual": 0.0,
            "top_force_rms": 1.0, "peak_displacement": 1.0, "rms_displacement": 1.0, "rms_velocity": 1.0,
            "widest_opening": 1.0, "typical_opening": 1.0, "deepest_closure": 0.0,
            "widest_slip": 1.0, "typical_slip": 1.0, "peak_slip_velocity": 1.0, "most_onsets": 1.0,
            "typical_onsets": 1.0, "onset_rate": 1.0, "typical_jumps": 0.0, "most_jumps": 0.0, "linked_jumps": 0.0,
            "linked_by_chance": 0.0, "accelerations": [["a", 1.0], ["b", 2.0]], "overlaps": [1.0, 2.0],
            "lighter_masses": [1.0, 1.0], "uneven_at_instant": 1.0
        });
        serde_json::from_value(zeros).expect("measures")
    }

    #[test]
    fn a_wall_in_which_nothing_changes_confirms_nothing_but_what_is_true_of_rest() {
        let m = blank();
        let set = Set { one: &m, two: &m, three: &m, four: &m, five: &m, control: &m };
        let yes = FINDINGS.iter().filter(|f| {
            let values: Vec<f64> = (f.numbers)(&set).iter().map(|n| n.value).collect();
            (f.holds)(&values)
        });
        assert_eq!(yes.map(|f| f.id).collect::<Vec<_>>(), ["no-interpenetration"]);
    }

    #[test]
    fn numbers_of_a_finding_have_names_of_their_own() {
        let m = blank();
        let set = Set { one: &m, two: &m, three: &m, four: &m, five: &m, control: &m };
        for finding in &FINDINGS {
            let names: std::collections::BTreeSet<&str> = (finding.numbers)(&set).iter().map(|n| n.name).collect();
            assert_eq!(names.len(), (finding.numbers)(&set).len(), "{}", finding.id);
        }
    }
}
