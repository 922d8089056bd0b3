//! Rigid bodies.

/// A rigid block.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Unique name.
    pub name: String,
    /// Centre of gravity [m].
    pub centre: [f64; 2],
    /// Corners from the centre, counterclockwise [m].
    pub corners: Vec<[f64; 2]>,
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia about the centre [kg m²]. What a rocking block keeps of its angular velocity in an impact follows
    /// from it and from the shape, and is no parameter.
    pub inertia: f64,
}

impl Body {
    /// A homogeneous rectangle between these edges [m]: m (L² + H²)/12.
    pub fn rectangle(name: &str, x: [f64; 2], y: [f64; 2], mass: f64) -> Self {
        let (l, h) = (0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0]));
        Body {
            name: name.into(),
            centre: [0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])],
            corners: vec![[-l, -h], [l, -h], [l, h], [-l, h]],
            mass,
            inertia: mass * (l * l + h * h) / 3.0,
        }
    }

    /// From its lowest to its highest corner [m].
    pub fn height(&self) -> f64 {
        let y = || self.corners.iter().map(|c| c[1]);
        y().fold(f64::NEG_INFINITY, f64::max) - y().fold(f64::INFINITY, f64::min)
    }
}
