//! Laws of joints as functions of relative displacement and velocity (theory, section 3), and what joints of the shear model are made of.

pub use concio_law::friction::Stribeck;
pub use concio_shear::law::{Bonded, Contact, Elastic, Nonlinear, Rub, Support, spring_force};
