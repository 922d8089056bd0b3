//! The runs: five cases of the research report, each under several settings that the research report does not print, and each again
//! with a change too small to mean anything, because its trajectories are chaotic.

use concio::case::{self, Beam, CaseFile, FrictionOn, NormalForce, Signal, Sine, Syntax};
use concio::quantity::{Acceleration, Frequency, Length, Mass, Time};

/// A case of section 4.2, or the control to case 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Which {
    /// Regular, all parameters.
    One,
    /// Irregular, all parameters.
    Two,
    /// Undamped.
    Three,
    /// Frictionless.
    Four,
    /// No bed stiffness.
    Five,
    /// Case 1 with μ_d = μ_s: friction of the same strength that cannot stick and slip.
    Control,
}

impl Which {
    /// All of them.
    pub const ALL: [Which; 6] = [Which::One, Which::Two, Which::Three, Which::Four, Which::Five, Which::Control];

    /// Name of the wall file without its ending, and of the folder of its results.
    pub fn name(self) -> &'static str {
        match self {
            Which::One => "case-1-regular",
            Which::Two => "case-2-irregular",
            Which::Three => "case-3-undamped",
            Which::Four => "case-4-frictionless",
            Which::Five => "case-5-no-bed-stiffness",
            Which::Control => "control",
        }
    }

    /// The wall file in `examples/report`.
    pub fn text(self) -> &'static str {
        match self {
            Which::One | Which::Control => include_str!("../../../../examples/report/case-1-regular.toml"),
            Which::Two => include_str!("../../../../examples/report/case-2-irregular.toml"),
            Which::Three => include_str!("../../../../examples/report/case-3-undamped.toml"),
            Which::Four => include_str!("../../../../examples/report/case-4-frictionless.toml"),
            Which::Five => include_str!("../../../../examples/report/case-5-no-bed-stiffness.toml"),
        }
    }
}

/// What the research report leaves open, set one way or another. The first is that of the wall files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Setting {
    /// The wall files as they are.
    Files,
    /// Equation 3.1 of the research report: every joint rubs, under the overburden of the blocks.
    ReportFriction,
    /// The same under a third of the load.
    ReportFrictionLightLoad,
    /// A third of the load.
    LightLoad,
    /// 5 mm at 2 Hz instead of 2 mm at 5 Hz: the same velocity, 2.5 times the displacement.
    LargeDrive,
    /// The lower ends of the printed ranges, μ_s = 0.4, μ_d = 0.28.
    LowFriction,
    /// The upper ends, μ_s = 0.8, μ_d = 0.56.
    HighFriction,
    /// The base moves too, 2 mm at 3 Hz.
    BaseToo,
    /// The base alone shakes, 0.8 g at 5 Hz, under a load and no beam.
    GroundAlone,
}

impl Setting {
    /// All of them.
    pub const ALL: [Setting; 9] = [
        Setting::Files,
        Setting::ReportFriction,
        Setting::ReportFrictionLightLoad,
        Setting::LightLoad,
        Setting::LargeDrive,
        Setting::LowFriction,
        Setting::HighFriction,
        Setting::BaseToo,
        Setting::GroundAlone,
    ];

    /// As tables name it.
    pub fn name(self) -> &'static str {
        match self {
            Setting::Files => "as in the wall files",
            Setting::ReportFriction => "the research report's friction",
            Setting::ReportFrictionLightLoad => "the research report's friction, q = 10 kN/m",
            Setting::LightLoad => "q = 10 kN/m",
            Setting::LargeDrive => "top 5 mm at 2 Hz",
            Setting::LowFriction => "μ_s = 0.4, μ_d = 0.28",
            Setting::HighFriction => "μ_s = 0.8, μ_d = 0.56",
            Setting::BaseToo => "base 2 mm at 3 Hz beside the top",
            Setting::GroundAlone => "base 0.8 g at 5 Hz alone, no beam",
        }
    }
}

/// Runs of each case under [`Setting::Files`]: the files as they are and members that differ by next to nothing.
pub const MEMBERS: usize = 5;

/// A wall file with `setting`, changed by next to nothing for `member` above 0: the top load by some 1e-9, the last
/// member by half the tolerance instead.
///
/// # Errors
/// None in a released version: a test reads all of them.
pub fn file(which: Which, setting: Setting, member: usize) -> concio::Result<CaseFile> {
    let mut file = case::from_str(which.text(), Syntax::Toml, None)?;
    let case = &mut file.case;
    let friction = &mut case.joint.friction;
    if which == Which::Control {
        friction.dynamic = friction.static_;
    }
    let load = case.load.top.per_length(1.0);
    let rubs = friction.static_ > 0.0;
    if setting != Setting::Files {
        // Findings are read off the frames; without a beam some of these joints are not there.
        case.output.joints.clear();
    }
    match setting {
        Setting::Files => {}
        Setting::ReportFriction => overburden(friction),
        Setting::ReportFrictionLightLoad => {
            overburden(friction);
            case.load.top = (load / 3.0).into();
        }
        Setting::LightLoad => case.load.top = (load / 3.0).into(),
        Setting::LargeDrive => {
            case.motion.top = sine(Some(5e-3), None, 2.0, 0.5);
            case.motion.duration = Some(Time::from_si(0.5));
        }
        Setting::LowFriction if rubs => scale(friction, 0.4 / 0.6),
        Setting::HighFriction if rubs => scale(friction, 0.8 / 0.6),
        Setting::LowFriction | Setting::HighFriction => {}
        Setting::BaseToo => case.motion.base = sine(Some(2e-3), None, 3.0, 0.2),
        Setting::GroundAlone => {
            case.load.beam = Beam::Free;
            // What presses is the test rig's.
            case.load.mass = Some(Mass::from_si(0.0));
            case.motion.top = Signal::None;
            case.motion.base = sine(None, Some(0.8 * concio::G), 5.0, 0.2);
        }
    }
    if member + 1 == MEMBERS {
        case.solver.tolerance *= 0.5;
    } else {
        case.load.top = (case.load.top.per_length(1.0) * (1.0 + 1e-9 * member as f64)).into();
    }
    Ok(file)
}

fn overburden(friction: &mut case::Friction) {
    friction.on = FrictionOn::All;
    friction.normal_force = NormalForce::Overburden;
}

fn scale(friction: &mut case::Friction, factor: f64) {
    friction.static_ *= factor;
    friction.dynamic *= factor;
}

fn sine(amplitude: Option<f64>, acceleration: Option<f64>, frequency: f64, ramp: f64) -> Signal {
    Signal::Sine(Sine {
        amplitude: amplitude.map(Length::from_si),
        acceleration: acceleration.map(Acceleration::from_si),
        frequency: Frequency::from_si(frequency),
        ramp: Time::from_si(ramp),
        cycles: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_is_a_valid_wall_and_no_two_are_the_same_but_for_coefficients_without_friction() {
        let mut hashes = std::collections::BTreeSet::new();
        for setting in Setting::ALL {
            for which in Which::ALL {
                for member in 0..MEMBERS {
                    let file = file(which, setting, member).expect("a wall file");
                    assert_eq!(file.findings(), [], "{} {}", which.name(), setting.name());
                    let prepared = concio::run::prepare_case(file.case, file_folder()).expect("a wall");
                    hashes.insert(prepared.inputs_hash);
                }
            }
        }
        // Without friction its coefficients make no difference: case 4 is the same wall with the lower and the upper ones.
        assert_eq!(hashes.len(), (Which::ALL.len() * Setting::ALL.len() - 1) * MEMBERS);
    }

    fn file_folder() -> &'static std::path::Path {
        std::path::Path::new(".")
    }
}
