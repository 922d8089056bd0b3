//! What a response is: peaks, events, energies, histories.

use serde::{Deserialize, Serialize};

/// Why a run went no further.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    /// The shaking is over and the wall rests.
    AtRest {
        /// When [s].
        time: f64,
    },
    /// The wall lies on the ground: θ = π/2, or the upper body of a chain lies.
    Fallen {
        /// When [s].
        time: f64,
        /// From when on it stayed beyond the turn at which its weight holds no longer [s].
        beyond: f64,
    },
    /// The tail is over and the wall still moves.
    Moving,
    /// The ground falls faster than the wall would: nothing presses on its hinge, and (OP10) says nothing of what follows.
    Airborne {
        /// When [s].
        time: f64,
    },
    /// A number that is none: steps that were far too long.
    NotFinite {
        /// When [s].
        time: f64,
    },
    /// Steps without end.
    StepsSpent,
}

impl Stop {
    /// Whether the wall fell.
    pub fn fell(&self) -> bool {
        matches!(self, Stop::Fallen { .. })
    }
}

/// Residual of the account over the largest energy in play from which a run is doubted.
const DOUBTED: f64 = 1e-3;

/// What happens at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// It leaves its position at rest.
    LiftOff,
    /// It comes back to it.
    Impact,
    /// It turns beyond the rotation at which its weight holds no longer.
    BeyondD0,
    /// It comes back from there.
    BackFromD0,
    /// A tie begins to yield.
    TieYields(usize),
    /// A tie breaks.
    TieBreaks(usize),
    /// A floor loses its seat.
    SeatLost(usize),
    /// A force of friction is gone.
    RubLost(usize),
    /// It falls to the ground.
    Fall,
}

/// An event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When [s].
    pub time: f64,
    /// What.
    pub what: What,
    /// Rotation, positive outwards [rad].
    pub rotation: f64,
    /// Velocity before it [rad/s].
    pub velocity: f64,
    /// By how much an impact changes the momentum of the wall [N s]; 0 of all else.
    pub impulse: f64,
}

/// How often what happened, and the work of the run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Times that it left its position at rest; those after a bounce do not count.
    pub lift_offs: u64,
    /// Impacts.
    pub impacts: u64,
    /// Times that it went beyond d0.
    pub beyond_d0: u64,
    /// Steps.
    pub steps: u64,
    /// Evaluations of (OP10).
    pub evaluations: u64,
}

/// The farthest that the wall turned to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Rotation, from 0 [rad].
    pub rotation: f64,
    /// When [s].
    pub time: f64,
    /// Displacement of the control point to that side [m].
    pub displacement: f64,
    /// Rotation over that at which the weights hold no longer, θ/α_s of a block without loads; none where they do not hold at rest.
    pub over_d0: Option<f64>,
}

/// d0 of one side: where its weights hold no longer, without ties and friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capacity {
    /// Rotation [rad].
    pub rotation: f64,
    /// Displacement of the control point [m].
    pub displacement: f64,
}

/// Energies [J]. All but `input` are on its other side: kinetic + place + elastic + what is lost = start + input.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energies {
    /// Of the motion.
    pub kinetic: f64,
    /// Of weights and thrusts, 0 at rest.
    pub place: f64,
    /// In ties, given back.
    pub elastic: f64,
    /// Lost in impacts.
    pub impact: f64,
    /// Lost by friction.
    pub friction: f64,
    /// Lost in ties that yielded or broke.
    pub ties: f64,
    /// Gone with floors that lost their seat.
    pub floors: f64,
    /// Brought in by the ground.
    pub input: f64,
    /// At t = 0.
    pub start: f64,
}

impl Energies {
    /// What the account lacks.
    pub fn residual(&self) -> f64 {
        self.kinetic + self.place + self.elastic + self.impact + self.friction + self.ties + self.floors
            - self.input
            - self.start
    }
}

/// What became of a tie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TieOutcome {
    /// Largest pull [N].
    pub peak: f64,
    /// Permanent set [m].
    pub set: f64,
    /// When it broke [s].
    pub broke: Option<f64>,
}

/// Histories at equal intervals from t = 0 to the end of the run; of a wall that rests, at least to the end of the shaking.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// [s]
    pub time: Vec<f64>,
    /// θ, positive outwards [rad].
    pub rotation: Vec<f64>,
    /// θ̇ [rad/s].
    pub velocity: Vec<f64>,
    /// θ̈, 0 at rest [rad/s²].
    pub acceleration: Vec<f64>,
    /// Of the control point, positive outwards [m].
    pub displacement: Vec<f64>,
    /// Acceleration of the ground inwards [m/s²].
    pub ground: Vec<f64>,
    /// Horizontal force of hinges and side walls on the wall, positive outwards: its masses times their absolute accelerations, less thrusts and
    /// pulls; impulses of impacts are not in it [N].
    pub shear: Vec<f64>,
    /// Pull of every tie, one after the other at each time [N].
    pub ties: Vec<f64>,
    /// The account.
    pub energies: Vec<Energies>,
}

impl History {
    /// Empties it, keeping its memory.
    pub(super) fn clear(&mut self) {
        let History { time, rotation, velocity, acceleration, displacement, ground, shear, ties, energies } = self;
        for numbers in [time, rotation, velocity, acceleration, displacement, ground, shear, ties] {
            numbers.clear();
        }
        energies.clear();
    }

    /// With room for so many samples.
    pub(super) fn with_room(samples: usize, ties: usize) -> Self {
        let numbers = || Vec::with_capacity(samples);
        History {
            time: numbers(),
            rotation: numbers(),
            velocity: numbers(),
            acceleration: numbers(),
            displacement: numbers(),
            ground: numbers(),
            shear: numbers(),
            ties: Vec::with_capacity(samples * ties),
            energies: Vec::with_capacity(samples),
        }
    }
}

/// Response of a mechanism.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// How it ended.
    pub stop: Stop,
    /// Farthest turn outwards; at its end that of a wall that fell.
    pub peak: Peak,
    /// Farthest turn inwards, where the wall rocks to both sides.
    pub inwards: Option<Peak>,
    /// d0 outwards; none where the weights hold at any turn.
    pub d0: Option<Capacity>,
    /// When the wall first left its position at rest [s].
    pub first_lift_off: Option<f64>,
    /// How often what happened.
    pub counts: Counts,
    /// Ties, in their order.
    pub ties: Vec<TieOutcome>,
    /// Account at the end.
    pub energies: Energies,
    /// Largest residual of the account after any step, and largest energy in play, at the start or brought in [J].
    pub residual: f64,
    /// See `residual`.
    pub scale: f64,
    /// The first events; bounces of small height may be many.
    pub events: Vec<Event>,
    /// Events that found no room.
    pub more_events: u64,
    /// Histories, where the setting asks for them.
    pub history: Option<History>,
}

impl Response {
    /// Largest residual of the account over the largest energy in play; 0 where there was none.
    pub fn relative_residual(&self) -> f64 {
        if self.scale > 0.0 { self.residual / self.scale } else { 0.0 }
    }

    /// What a reader of the response should know before believing it, in words; nothing of most runs.
    pub fn doubts(&self) -> Vec<String> {
        let of_stop = match self.stop {
            Stop::AtRest { .. } | Stop::Fallen { .. } => None,
            Stop::Moving => Some("the wall still moves at the end of the run: larger turns may follow".into()),
            Stop::Airborne { time } => Some(format!(
                "the ground falls faster than the wall would at {time:.3} s: the run ends there, without an answer"
            )),
            Stop::NotFinite { time } => Some(format!("the steps are too long: no number is left at {time:.3} s")),
            Stop::StepsSpent => Some("the run took more steps than are allowed: its step is too short".into()),
        };
        let residual = self.relative_residual();
        let of_account = (residual > DOUBTED)
            .then(|| format!("the energy account is off by {residual:.1e} of the largest energy: shorten the step"));
        let passed = self.counts.beyond_d0;
        let of_d0 = (passed > 0 && !self.stop.fell()).then(|| {
            format!(
                "the wall passed d0 {passed} time(s) and came back: the code does not count on that, nor should you"
            )
        });
        [of_stop, of_account, of_d0].into_iter().flatten().collect()
    }
}
