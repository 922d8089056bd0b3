//! Running bond of overlap ½ in closed form, bricks rigid:
//!
//! (H1) A1111 = t [k_n′ h_c b/a + k_t c b/(2a)], A2222 = 2 t k_n c a/b, A1122 = 0
//! (H2) p = 2 k_t c a/b, q = k_t′ h_c b/a + k_n c b/(2a), A1212 = t p q/(p + q)
//! (H3) D1111 = (t³/12) [k_n′ h_c b/a + k_t c b/(2a)] + k_s t c³ b/(24 a), D2222 = (t³/12) 2 k_n c a/b, D1122 = 0,
//!      4 D1212 = (t³/12) [k_n c b/(2a) + 2 k_t c a/b + k_t′ h_c b/a] + k_s t c³ a/(6b) + k_s′ t h_c³ b/(12 a)
//! (H4) F11 = t [k_s′ h_c b/a + k_s c b/(2a)], F22 = 2 t k_s c a/b
//!
//! Bricks are all alike: under a uniform strain their centres follow the field and one rotation common to all is free. Each
//! lattice step d gives a jump E d + ω (d₂, −d₁); the energy per b·a is least in ω. Under a curvature bricks turn with its
//! gradient, and only what neighbours turn against each other works.
//! Same results in other notation: A. Cecchi and K. Sab, European Journal of Mechanics A 21 (2002) 249 and International
//! Journal of Solids and Structures 41 (2004) 2259.

use concio::{InputError, Result};

use crate::joint::Stiffness;
use crate::moduli::{Couple, Moduli};

/// A running bond of overlap ½.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunningBond {
    /// b: length of a brick and a head joint, above 0 [m].
    pub pitch: f64,
    /// a: height of a brick and a bed joint, above 0 [m].
    pub rise: f64,
    /// c: length of the bed joint on either half of a brick, above 0, to b/2 [m].
    pub contact: f64,
    /// h_c: height of a head joint, above 0, to a [m].
    pub head_height: f64,
    /// t: thickness of the wall, above 0 [m].
    pub thickness: f64,
    /// k_n, k_t, k_s of bed joints.
    pub bed: Stiffness,
    /// k_n′, k_t′, k_s′ of head joints.
    pub head: Stiffness,
}

impl RunningBond {
    /// Of bricks `length` × `height` × `thickness` with mortar in bed and head joints [m].
    ///
    /// # Errors
    /// Sizes that are not above 0; bed joints without stiffness; head mortar as long as a brick.
    pub fn new(
        [length, height, thickness]: [f64; 3],
        [bed_mortar, head_mortar]: [f64; 2],
        bed: Stiffness,
        head: Stiffness,
    ) -> Result<RunningBond> {
        for (name, size) in [("length", length), ("height", height), ("thickness", thickness)] {
            if !(size > 0.0 && size.is_finite()) {
                return Err(InputError::new(format!("a brick of {name} {size} m")).allowed("above 0").into());
            }
        }
        if !(bed_mortar >= 0.0 && head_mortar >= 0.0 && head_mortar < length && bed_mortar.is_finite()) {
            let what = format!("mortar of {bed_mortar} m in beds and {head_mortar} m in head joints");
            return Err(InputError::new(what).allowed("from 0, in head joints less than the brick's length").into());
        }
        if !(bed.normal > 0.0 && bed.tangential > 0.0) {
            return Err(InputError::new("bed joints without stiffness").allowed("above 0 in both directions").into());
        }
        Ok(RunningBond {
            pitch: length + head_mortar,
            rise: height + bed_mortar,
            contact: 0.5 * (length - head_mortar),
            head_height: height,
            thickness,
            bed,
            head,
        })
    }

    /// Whether bricks touch all along, without mortar between them: what (H5) to (H7) hold for.
    pub fn is_closed(&self) -> bool {
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b;
        same(self.contact, 0.5 * self.pitch) && same(self.head_height, self.rise)
    }

    /// (H1) to (H4), p and q of (H2), and the couple stiffnesses.
    pub fn moduli(&self) -> Moduli {
        let RunningBond { pitch: b, rise: a, contact: c, head_height: h, thickness: t, bed, head } = *self;
        // (H1)
        let along = head.normal * h * b / a + bed.tangential * c * b / (2.0 * a);
        let across = 2.0 * bed.normal * c * a / b;
        // (H2)
        let p = 2.0 * bed.tangential * c * a / b;
        let q = head.tangential * h * b / a + bed.normal * c * b / (2.0 * a);
        // (H3)
        let cubed = t.powi(3) / 12.0;
        let bent = cubed * along + bed.transverse * t * c.powi(3) * b / (24.0 * a);
        let twisted = cubed * (p + q)
            + bed.transverse * t * c.powi(3) * a / (6.0 * b)
            + head.transverse * t * h.powi(3) * b / (12.0 * a);
        // (H4)
        let sheared = [
            t * (head.transverse * h * b / a + bed.transverse * c * b / (2.0 * a)),
            2.0 * t * bed.transverse * c * a / b,
        ];
        let diagonal = |v: [f64; 3]| [[v[0], 0.0, 0.0], [0.0, v[1], 0.0], [0.0, 0.0, v[2]]];
        Moduli {
            membrane: diagonal([t * along, t * across, t * p * q / (p + q)]),
            plate: diagonal([bent, cubed * across, 0.25 * twisted]),
            shear: [[sheared[0], 0.0], [0.0, sheared[1]]],
            polar: [[t * p, 0.0], [0.0, t * q]],
            couple: Some(Couple {
                c1: t * (bed.normal * c.powi(3) * b / (24.0 * a) + head.normal * h.powi(3) * b / (12.0 * a)),
                c2: t * bed.normal * c.powi(3) * a / (6.0 * b),
            }),
            thickness: t,
        }
    }
}
