//! What bonds become at the end of a step. Steps end where a brittle one cracks ([`events`](crate::integrate::events)).

use crate::integrate::events::reaches;
use crate::law::Bonded;
use crate::state::State;
use crate::system::System;
use concio_law::account::{Event, EventKind};
use concio_law::bond::BondState;

/// How far below its strength a bond cracks with one that reaches it, as a fraction: joints that are equal but for rounding
/// crack together.
const TOGETHER: f64 = 1e-9;

/// Brings the bonds to the end of a step of `h` to `z`, `v`, before `state` is moved there, books what cracking took and
/// tells what happened. True when forces jump with it.
pub fn grow(system: &System, state: &mut State, z: &[f64], v: &[f64], h: f64, mut tell: impl FnMut(Event)) -> bool {
    let mut jumps = false;
    for (b, bond) in system.bonds.iter().enumerate() {
        let (law, mut held) = (&bond.law, state.bonds[b]);
        let [i, k] = system.sides[bond.joint as usize].map(|s| s as usize);
        let d = z[i] - z[k];
        let (reach, limit) = (law.stretch(d), law.limit());
        let least = if law.is_brittle() { limit * (1.0 - TOGETHER) } else { limit };
        if held.broken.is_finite() || reach <= held.reach || reach < least {
            continue;
        }
        let (start, end) = (state.t, state.t + h);
        let mut happened = |kind, time, value| tell(Event { time, joint: bond.joint, kind, value });
        if held.damage == 0.0 {
            let sign = d.signum();
            let stretched = [sign * (state.z[i] - state.z[k]), reach];
            let stretching = [sign * (state.v[i] - state.v[k]), sign * (v[i] - v[k])];
            held.cracked = if law.is_brittle() { end } else { start + reaches(stretched, stretching, h, limit) };
            happened(EventKind::Crack, held.cracked, if law.is_brittle() { reach } else { limit });
        }
        if law.is_brittle() || law.is_broken(reach) {
            held.broken = end;
            happened(EventKind::Break, end, reach);
            jumps = true;
        }
        // The largest force comes just before it is gone.
        let before = law.damage_at(held.damage, d);
        held.peak = held.peak.max(bond.force(&system.elastic[bond.joint as usize], before, d).abs());
        held.reach = reach;
        held.damage = if held.broken.is_finite() { 1.0 } else { law.damage(reach) };
        let spent = law.spent(reach, held.damage);
        state.energies.bond += spent - held.spent;
        state.envelopes.joint_dissipation[bond.joint as usize] += spent - held.spent;
        held.spent = spent;
        state.bonds[b] = held;
    }
    jumps
}

/// What softening takes on the way from the bonds `held` to displacements `z` [J], brittle bonds left out.
pub fn spending(system: &System, held: &[BondState], z: &[f64]) -> f64 {
    let softens = |(bond, held): &(&Bonded, &BondState)| !bond.law.is_brittle() && !held.broken.is_finite();
    let spent = |(bond, held): (&Bonded, &BondState)| {
        let [a, b] = system.sides[bond.joint as usize].map(|s| s as usize);
        let reach = bond.law.stretch(z[a] - z[b]);
        let grows = reach > held.reach && reach >= bond.law.limit();
        if grows { bond.law.spent(reach, bond.law.damage(reach)) - held.spent } else { 0.0 }
    };
    system.bonds.iter().zip(held).filter(softens).map(spent).sum()
}
