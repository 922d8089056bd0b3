//! Devices: which keys a law takes, and their bounds.

use std::fmt::Display;

use super::{Bound, Findings};
use crate::case::{Device, DeviceLaw};
use crate::quantity::{Dimension, Quantity, shown};

/// How a law takes a key.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Needed,
    Allowed,
}
use DeviceLaw::{BoucWen, Elastic, FrictionDamper, ReCentring, Viscous};
use Use::{Allowed, Needed};

/// The keys with the laws that take them.
const KEYS: [(&str, &[(DeviceLaw, Use)]); 17] = [
    ("damping", &[(Viscous, Needed), (Elastic, Allowed), (BoucWen, Allowed), (ReCentring, Allowed)]),
    ("exponent", &[(Viscous, Allowed)]),
    ("reference_velocity", &[(Viscous, Allowed)]),
    ("stiffness", &[(Elastic, Needed), (ReCentring, Needed)]),
    ("slip_force", &[(FrictionDamper, Needed)]),
    ("slip_velocity", &[(FrictionDamper, Allowed)]),
    ("sticks", &[(FrictionDamper, Allowed)]),
    ("yield_force", &[(BoucWen, Needed)]),
    ("yield_displacement", &[(BoucWen, Needed)]),
    ("hardening", &[(BoucWen, Allowed)]),
    ("amplitude", &[(BoucWen, Allowed)]),
    ("beta", &[(BoucWen, Allowed)]),
    ("gamma", &[(BoucWen, Allowed)]),
    ("sharpness", &[(BoucWen, Allowed)]),
    ("activation_force", &[(ReCentring, Needed)]),
    ("post_stiffness", &[(ReCentring, Allowed)]),
    ("flag", &[(ReCentring, Needed)]),
];

/// The device at `key` of the wall file.
pub(super) fn check(f: &mut Findings, key: &str, d: &Device) {
    takes(f, key, d);
    let dashpot = if d.law == Viscous { Bound::Above0 } else { Bound::From0 };
    quantity(f, key, "damping", d.damping, dashpot);
    number(f, key, "exponent", d.exponent, Bound::Between(0.2, 1.0));
    quantity(f, key, "reference_velocity", d.reference_velocity, Bound::Above0);
    let spring = if d.law == ReCentring { Bound::Above0 } else { Bound::From0 };
    quantity(f, key, "stiffness", d.stiffness, spring);
    quantity(f, key, "slip_force", d.slip_force, Bound::Above0);
    quantity(f, key, "slip_velocity", d.slip_velocity, Bound::Above0);
    quantity(f, key, "yield_force", d.yield_force, Bound::Above0);
    quantity(f, key, "yield_displacement", d.yield_displacement, Bound::Above0);
    number(f, key, "hardening", d.hardening, Bound::Between(0.0, 1.0));
    number(f, key, "amplitude", d.amplitude, Bound::Above0);
    number(f, key, "beta", d.beta, Bound::Above0);
    number(f, key, "sharpness", d.sharpness, Bound::Between(1.0, 100.0));
    quantity(f, key, "activation_force", d.activation_force, Bound::Above0);
    quantity(f, key, "post_stiffness", d.post_stiffness, Bound::From0);
    number(f, key, "flag", d.flag, Bound::Between(0.0, 1.0));
    gamma(f, key, d);
    softer(f, key, d);
}

fn quantity<D: Dimension>(f: &mut Findings, key: &str, name: &str, value: Option<Quantity<D>>, bound: Bound) {
    if let Some(v) = value {
        f.quantity(format_args!("{key}.{name}"), v, bound);
    }
}

fn number(f: &mut Findings, key: &str, name: &str, value: Option<f64>, bound: Bound) {
    if let Some(v) = value {
        f.number(format_args!("{key}.{name}"), v, bound);
    }
}

/// Says which keys of the law are missing, and which are those of another law.
fn takes(f: &mut Findings, key: &str, d: &Device) {
    for (name, laws) in KEYS {
        let of_law = laws.iter().find(|(law, _)| *law == d.law).map(|(_, how)| *how);
        match (of_law, given(d, name)) {
            (None, true) => {
                let names = laws.iter().map(|(law, _)| format!("`{}`", law.name())).collect::<Vec<_>>().join(", ");
                let what = format!("law `{}` has no such key: it is for {names}", d.law.name());
                f.push(format_args!("{key}.{name}"), what, keys_of(d.law));
            }
            (Some(Needed), false) => {
                let what = format!("the key is missing: law `{}` needs it", d.law.name());
                f.push(format_args!("{key}.{name}"), what, if name == "flag" { "0 … 1" } else { "above 0" });
            }
            _ => {}
        }
    }
}

/// The keys that a law takes.
pub fn keys_of(law: DeviceLaw) -> String {
    let own = KEYS.iter().filter(|(_, laws)| laws.iter().any(|(of, _)| *of == law));
    own.map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Whether a key of [`KEYS`] is given.
fn given(d: &Device, name: &str) -> bool {
    match name {
        "damping" => d.damping.is_some(),
        "exponent" => d.exponent.is_some(),
        "reference_velocity" => d.reference_velocity.is_some(),
        "stiffness" => d.stiffness.is_some(),
        "slip_force" => d.slip_force.is_some(),
        "slip_velocity" => d.slip_velocity.is_some(),
        "sticks" => d.sticks.is_some(),
        "yield_force" => d.yield_force.is_some(),
        "yield_displacement" => d.yield_displacement.is_some(),
        "hardening" => d.hardening.is_some(),
        "amplitude" => d.amplitude.is_some(),
        "beta" => d.beta.is_some(),
        "gamma" => d.gamma.is_some(),
        "sharpness" => d.sharpness.is_some(),
        "activation_force" => d.activation_force.is_some(),
        "post_stiffness" => d.post_stiffness.is_some(),
        _ => d.flag.is_some(),
    }
}

/// Outside of −β … β the law would give back more than it took; at −β it would never yield.
fn gamma(f: &mut Findings, key: &str, d: &Device) {
    let beta = d.beta.unwrap_or(crate::case::BETA);
    let Some(gamma) = d.gamma.or((d.beta.is_some() && d.law == BoucWen).then_some(crate::case::GAMMA)) else {
        return;
    };
    if beta > 0.0 && !(gamma > -beta && gamma <= beta) {
        let from = if d.gamma.is_some() { "" } else { " (its default)" };
        let allowed = format!("above −β and up to β: above {}, up to {}", shown(-beta), shown(beta));
        f.push(format_args!("{key}.gamma"), format!("{}{from} is out of range", shown(gamma)), allowed);
    }
}

fn softer(f: &mut Findings, key: &str, d: &Device) {
    if let (Some(first), Some(second)) = (d.stiffness, d.post_stiffness)
        && d.law == ReCentring
        && second >= first
    {
        let key: &dyn Display = &format_args!("{key}.post_stiffness");
        f.push(key, format!("{second} is not below `stiffness`"), format!("from 0 to below {first}"));
    }
}
