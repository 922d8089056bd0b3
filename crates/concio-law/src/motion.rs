//! Smooth pieces of a motion in closed form, how acceleration pieces are joined to a motion from rest, and what drives a wall as the equations
//! see it: in coordinates relative to the base (theory, section 2).

/// A motion at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Kinematics {
    /// Displacement [m].
    pub u: f64,
    /// Velocity [m/s].
    pub v: f64,
    /// Acceleration [m/s²].
    pub a: f64,
}

/// A smooth piece of a motion, valid on the closed interval from `start` to `end`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// First instant [s]; −∞ before t = 0.
    pub start: f64,
    /// Last instant [s]; +∞ for the last piece.
    pub end: f64,
    /// What it is there.
    pub form: Form,
}

impl Segment {
    /// The motion at `t`; outside start … end the piece is continued.
    #[inline]
    pub fn at(&self, t: f64) -> Kinematics {
        self.form.at(t)
    }
    /// The acceleration at `t` [m/s²].
    #[inline]
    pub fn acceleration(&self, t: f64) -> f64 {
        self.form.at(t).a
    }
}

/// The motion inside one smooth piece.
#[derive(Debug, Clone, Copy)]
pub struct Drive {
    /// Absolute motion of the base.
    pub base: Segment,
    /// Absolute motion of the top support, where it is driven.
    pub top: Option<Segment>,
    /// Absolute vertical motion of the base, positive upwards.
    pub vertical: Segment,
    /// Last instant of the piece [s].
    pub end: f64,
}

impl Drive {
    /// Base acceleration at `t` [m/s²].
    #[inline]
    pub fn base_acceleration(&self, t: f64) -> f64 {
        self.base.acceleration(t)
    }
    /// Absolute motion of the base.
    pub fn base(&self, t: f64) -> Kinematics {
        self.base.at(t)
    }
    /// Absolute vertical motion of the base, positive upwards.
    pub fn vertical(&self, t: f64) -> Kinematics {
        self.vertical.at(t)
    }
    /// Motion of the top support relative to the base.
    #[inline]
    pub fn top(&self, t: f64) -> Kinematics {
        match self.top {
            None => Kinematics::default(),
            Some(top) => {
                let (top, base) = (top.at(t), self.base.at(t));
                Kinematics { u: top.u - base.u, v: top.v - base.v, a: top.a - base.a }
            }
        }
    }
}

/// Closed forms, in τ = t − origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// u + v τ + a τ²/2 + j τ³/6
    Cubic {
        /// [s]
        origin: f64,
        /// u [m].
        u: f64,
        /// v [m/s].
        v: f64,
        /// a [m/s²].
        a: f64,
        /// j [m/s³].
        jerk: f64,
    },
    /// c₀ + c₁ τ + (s₀ + s₁ τ) sin ωτ + (k₀ + k₁ τ) cos ωτ
    Wave {
        /// [s]
        origin: f64,
        /// ω [rad/s].
        omega: f64,
        /// c₀ [m] and c₁ [m/s].
        line: [f64; 2],
        /// s₀ [m] and s₁ [m/s].
        sine: [f64; 2],
        /// k₀ [m] and k₁ [m/s].
        cosine: [f64; 2],
    },
    /// c₀ + c₁ τ − p/(2b) e^{−b τ²}, so that a = p (1 − 2 b τ²) e^{−b τ²} (Ricker 1953), b = π² f²
    Ricker {
        /// [s]
        origin: f64,
        /// c₀ [m] and c₁ [m/s].
        line: [f64; 2],
        /// p [m/s²].
        peak: f64,
        /// b [1/s²].
        b: f64,
    },
}

impl Form {
    /// At rest at a place.
    pub const fn rest(u: f64) -> Form {
        Form::Cubic { origin: 0.0, u, v: 0.0, a: 0.0, jerk: 0.0 }
    }

    /// Acceleration (p + q τ) sin ωτ, by its double integral without the linear part:
    /// −(p + q τ)/ω² sin ωτ − 2q/ω³ cos ωτ.
    pub fn sine_acceleration(origin: f64, omega: f64, p: f64, q: f64) -> Form {
        let square = omega * omega;
        let (sine, cosine) = ([-p / square, -q / square], [-2.0 * q / (square * omega), 0.0]);
        Form::Wave { origin, omega, line: [0.0; 2], sine, cosine }
    }

    /// The motion at `t`.
    #[inline]
    pub fn at(&self, t: f64) -> Kinematics {
        match *self {
            Form::Cubic { origin, u, v, a, jerk } => {
                let s = t - origin;
                Kinematics {
                    u: u + s * (v + s * (a / 2.0 + s * jerk / 6.0)),
                    v: v + s * (a + s * jerk / 2.0),
                    a: a + s * jerk,
                }
            }
            Form::Wave { origin, omega, line, sine, cosine } => {
                let s = t - origin;
                let (sin, cos) = (omega * s).sin_cos();
                let (p, q) = (sine[0] + sine[1] * s, cosine[0] + cosine[1] * s);
                Kinematics {
                    u: line[0] + line[1] * s + p * sin + q * cos,
                    v: line[1] + (sine[1] - omega * q) * sin + (cosine[1] + omega * p) * cos,
                    a: omega * ((2.0 * sine[1] - omega * q) * cos - (2.0 * cosine[1] + omega * p) * sin),
                }
            }
            Form::Ricker { origin, line, peak, b } => {
                let s = t - origin;
                let bell = peak * (-b * s * s).exp();
                Kinematics {
                    u: line[0] + line[1] * s - bell / (2.0 * b),
                    v: line[1] + s * bell,
                    a: (1.0 - 2.0 * b * s * s) * bell,
                }
            }
        }
    }

    /// The same acceleration with the linear part that makes displacement and velocity at `t` those of `state`.
    fn joined(self, t: f64, state: Kinematics) -> Form {
        let now = self.at(t);
        let velocity = state.v - now.v;
        match self {
            Form::Cubic { origin, u, v, a, jerk } => {
                let s = t - origin;
                Form::Cubic { origin, u: u + state.u - now.u - velocity * s, v: v + velocity, a, jerk }
            }
            Form::Wave { origin, omega, line, sine, cosine } => {
                let line = shifted(line, t - origin, state.u - now.u, velocity);
                Form::Wave { origin, omega, line, sine, cosine }
            }
            Form::Ricker { origin, line, peak, b } => {
                let line = shifted(line, t - origin, state.u - now.u, velocity);
                Form::Ricker { origin, line, peak, b }
            }
        }
    }
}

/// The line c₀ + c₁ τ raised by `du` at τ = s and made steeper by `dv`.
fn shifted(line: [f64; 2], s: f64, du: f64, dv: f64) -> [f64; 2] {
    [line[0] + du - dv * s, line[1] + dv]
}

/// One component of the motion of the ground.
pub trait Component: std::fmt::Debug + Sync {
    /// The smooth piece that is active just after `t` [s].
    fn segment(&self, t: f64) -> Segment;
    /// Jump of the velocity at `t` [m/s].
    fn velocity_jump(&self, t: f64) -> f64;
    /// Longest step that resolves it [s]; +∞ at rest.
    fn longest_step(&self) -> f64;
    /// When its acceleration ends for good [s]; none where it goes on.
    fn end(&self) -> Option<f64>;
}

/// Ground that does not move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AtRest;

impl Component for AtRest {
    fn segment(&self, _: f64) -> Segment {
        Segment { start: f64::NEG_INFINITY, end: f64::INFINITY, form: Form::rest(0.0) }
    }
    fn velocity_jump(&self, _: f64) -> f64 {
        0.0
    }
    fn longest_step(&self) -> f64 {
        f64::INFINITY
    }
    fn end(&self) -> Option<f64> {
        Some(0.0)
    }
}

/// What moves a wall.
pub trait Excitation: std::fmt::Debug + Sync {
    /// The motion just after `t` [s].
    fn drive(&self, t: f64) -> Drive;
    /// Jump of the base's velocity at `t` [m/s].
    fn base_velocity_jump(&self, t: f64) -> f64;
    /// End of the run [s].
    fn duration(&self) -> f64;
    /// Longest step that resolves the motion [s].
    fn longest_step(&self) -> f64;
}

/// Pieces in a row, the first at rest up to its start.
#[derive(Debug, Clone, PartialEq)]
pub struct Pieces {
    segments: Vec<Segment>,
    /// Times that differ by less are one [s].
    slack: f64,
    /// After this time the acceleration is zero; none when it never ends.
    pub end: Option<f64>,
    /// Longest step that resolves the motion [s].
    pub longest_step: f64,
}

impl Pieces {
    /// At rest, from which pieces go on.
    pub fn new(longest_step: f64) -> Self {
        let rest = Segment { start: f64::NEG_INFINITY, end: f64::INFINITY, form: Form::rest(0.0) };
        Pieces { segments: vec![rest], slack: 0.0, end: None, longest_step }
    }

    /// Goes on with a displacement from `start`.
    pub fn displacement(&mut self, start: f64, form: Form) -> &mut Self {
        // Nothing lies before t = 0 but rest, and a piece of no length would be a break between two equal instants.
        let start = start.max(0.0);
        while self.segments.len() > 1 && self.segments.last().is_some_and(|last| last.start >= start) {
            self.segments.pop();
        }
        if let Some(last) = self.segments.last_mut() {
            last.end = start;
        }
        self.segments.push(Segment { start, end: f64::INFINITY, form });
        let lengths = self.segments.iter().map(|s| s.end - s.start).filter(|length| length.is_finite());
        self.slack = 1e-9 * lengths.fold(f64::INFINITY, f64::min).min(1.0);
        self
    }

    /// Goes on with an acceleration from `start`: displacement and velocity are carried over.
    pub fn acceleration(&mut self, start: f64, form: Form) -> &mut Self {
        let state = self.segment(start - 2.0 * self.slack).at(start);
        self.displacement(start, form.joined(start, state))
    }

    /// Goes on without acceleration from `start`, and ends so.
    pub fn coast(&mut self, start: f64) -> &mut Self {
        self.end = Some(start);
        self.acceleration(start, Form::Cubic { origin: start, u: 0.0, v: 0.0, a: 0.0, jerk: 0.0 })
    }

    /// Stands still from `start`, where it is then, and ends so.
    pub fn hold(&mut self, start: f64) -> &mut Self {
        self.rest(start, self.segment(start - 2.0 * self.slack).at(start).u)
    }

    /// Stands still at `place` from `start`, and ends so.
    pub fn rest(&mut self, start: f64, place: f64) -> &mut Self {
        self.end = Some(start);
        self.displacement(start, Form::rest(place))
    }

    /// The piece that is active just after `t`.
    #[inline]
    pub fn segment(&self, t: f64) -> Segment {
        let t = t + self.slack;
        let mut found = self.segments[0];
        for segment in &self.segments[1..] {
            if segment.start > t {
                break;
            }
            found = *segment;
        }
        found
    }

    /// Times that differ by less are one [s].
    pub fn slack(&self) -> f64 {
        self.slack
    }
}
