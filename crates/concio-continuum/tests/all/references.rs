//! The walls of the reference table: S1, S2, S3 and S1m.

use concio_continuum::{Cell, Laying, RunningBond, Stiffness};

pub struct Reference {
    pub name: &'static str,
    /// Brick length, height, thickness [m].
    pub brick: [f64; 3],
    /// Mortar in bed and head joints [m].
    pub mortar: [f64; 2],
    pub bed: Stiffness,
    pub head: Stiffness,
}

const BRICKS: Stiffness = Stiffness { normal: 86.4e9, tangential: 36e9, transverse: 36e9 };

pub const S1: Reference =
    Reference { name: "S1", brick: [0.26, 0.065, 0.12], mortar: [0.0; 2], bed: BRICKS, head: BRICKS };
pub const S2: Reference = Reference {
    name: "S2",
    brick: [0.4, 0.2, 0.3],
    mortar: [0.0; 2],
    bed: Stiffness { normal: 5e9, tangential: 2e9, transverse: 2e9 },
    head: Stiffness { normal: 1e9, tangential: 0.4e9, transverse: 0.4e9 },
};
pub const S3: Reference =
    Reference { name: "S3", head: Stiffness { normal: 0.0, tangential: 0.0, transverse: 0.0 }, ..S1 };
pub const S1M: Reference = Reference { name: "S1m", brick: [0.25, 0.055, 0.12], mortar: [0.01; 2], ..S1 };

impl Reference {
    pub fn bond(&self) -> RunningBond {
        RunningBond::new(self.brick, self.mortar, self.bed, self.head).expect("a bond")
    }

    pub fn laying(&self) -> Laying {
        Laying { thickness: self.brick[2], mortar: self.mortar, bed: self.bed, head: self.head }
    }

    pub fn cell(&self) -> Cell {
        Cell::shifted(self.brick[0], self.brick[1], 0.5, &self.laying()).expect("a cell")
    }
}
