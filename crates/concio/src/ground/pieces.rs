//! Smooth pieces of a motion in closed form, and how acceleration pieces are joined to a motion from rest.

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
    pub(super) form: Form,
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

/// Closed forms, in τ = t − origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Form {
    /// u + v τ + a τ²/2 + j τ³/6
    Cubic { origin: f64, u: f64, v: f64, a: f64, jerk: f64 },
    /// c₀ + c₁ τ + (s₀ + s₁ τ) sin ωτ + (k₀ + k₁ τ) cos ωτ
    Wave { origin: f64, omega: f64, line: [f64; 2], sine: [f64; 2], cosine: [f64; 2] },
    /// c₀ + c₁ τ − p/(2b) e^{−b τ²}, so that a = p (1 − 2 b τ²) e^{−b τ²} (Ricker 1953), b = π² f²
    Ricker { origin: f64, line: [f64; 2], peak: f64, b: f64 },
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

/// Pieces in a row, the first at rest up to its start.
#[derive(Debug, Clone, PartialEq)]
pub struct Pieces {
    segments: Vec<Segment>,
    /// Times that differ by less are one [s].
    slack: f64,
    /// After this time the acceleration is zero; none when it never ends.
    pub(super) end: Option<f64>,
    /// Longest step that resolves the motion [s].
    pub(super) longest_step: f64,
}

impl Pieces {
    /// At rest, from which pieces go on.
    pub(super) fn new(longest_step: f64) -> Self {
        let rest = Segment { start: f64::NEG_INFINITY, end: f64::INFINITY, form: Form::rest(0.0) };
        Pieces { segments: vec![rest], slack: 0.0, end: None, longest_step }
    }

    /// Goes on with a displacement from `start`.
    pub(super) fn displacement(&mut self, start: f64, form: Form) -> &mut Self {
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
    pub(super) fn acceleration(&mut self, start: f64, form: Form) -> &mut Self {
        let state = self.segment(start - 2.0 * self.slack).at(start);
        self.displacement(start, form.joined(start, state))
    }

    /// Goes on without acceleration from `start`, and ends so.
    pub(super) fn coast(&mut self, start: f64) -> &mut Self {
        self.end = Some(start);
        self.acceleration(start, Form::Cubic { origin: start, u: 0.0, v: 0.0, a: 0.0, jerk: 0.0 })
    }

    /// Stands still from `start`, where it is then, and ends so.
    pub(super) fn hold(&mut self, start: f64) -> &mut Self {
        self.rest(start, self.segment(start - 2.0 * self.slack).at(start).u)
    }

    /// Stands still at `place` from `start`, and ends so.
    pub(super) fn rest(&mut self, start: f64, place: f64) -> &mut Self {
        self.end = Some(start);
        self.displacement(start, Form::rest(place))
    }

    #[inline]
    pub(super) fn segment(&self, t: f64) -> Segment {
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

    pub(super) fn slack(&self) -> f64 {
        self.slack
    }
}
