//! What runs must have in common to advance side by side, and the lists that follow from it.

use crate::integrate::linear::{Factoring, MOST_LISTED, Matrix};
use crate::system::Scheme;
use crate::system::System;

/// Stands for no entry in the matrix, and for no friction on a joint.
pub const NONE: u32 = u32::MAX;

/// Which joints there are, of what kind, and how a step is taken: equal for all runs of a group.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Kind {
    sides: Vec<[u32; 2]>,
    one_sided: Vec<bool>,
    upright: Vec<bool>,
    rubbing: Vec<u32>,
    unknowns: usize,
    blocks: usize,
    fourth_order: bool,
}

impl Kind {
    /// None for systems that lanes do not take: set-valued laws, bonds, devices with laws of their own, action that
    /// differs from reaction, and walls so large that a single run factorises in another way and vectors are full
    /// without lanes.
    pub fn of(system: &System, scheme: Scheme) -> Option<Self> {
        let plain = !system.set_valued() && system.bonds.is_empty() && system.nonlinear.is_empty() && system.reciprocal;
        if !plain || system.unknowns() > MOST_LISTED {
            return None;
        }
        Some(Kind {
            sides: system.sides.clone(),
            one_sided: system.elastic.iter().map(|law| law.unilateral).collect(),
            upright: system.upright.clone(),
            rubbing: system.rubs.iter().map(|rub| rub.joint).collect(),
            unknowns: system.unknowns(),
            blocks: system.blocks,
            fourth_order: scheme == Scheme::Esdirk4,
        })
    }
}

/// A joint. Sides are places in the elimination order, base and top follow as n and n + 1.
#[derive(Debug, Clone, Copy)]
pub struct JointAt {
    pub sides: [u32; 2],
    /// Entry of the matrix that couples both sides.
    pub slot: u32,
    /// Place among the joints that rub.
    pub rub: u32,
    /// Place among the one-sided joints.
    pub one_sided: u32,
    pub upright: bool,
    /// Whether its other side is the beam whose force is recorded, and whether that beam is driven or tied.
    pub to_beam: bool,
    pub to_top: bool,
    /// Whether its other side is the base.
    pub to_base: bool,
}

/// A joint that rubs.
#[derive(Debug, Clone, Copy)]
pub struct RubAt {
    pub sides: [u32; 2],
    pub slot: u32,
}

/// A joint whose stiffness acts in compression only.
#[derive(Debug, Clone, Copy)]
pub struct OneSidedAt {
    pub sides: [u32; 2],
    pub joint: u32,
}

/// What each unknown gathers from joints. A joint has [`SHARES`] rows: what it adds to the diagonal of both sides, to
/// the right side of b and, the same with the other sign, to that of a.
#[derive(Debug, Clone)]
pub struct Incidence {
    /// How many joints each unknown has.
    pub counts: Vec<u32>,
    /// Row of the diagonal's share and of the right side's, joints ascending.
    pub rows: Vec<[u32; 2]>,
}

/// Rows of the shares of a joint.
pub const SHARES: usize = 3;
pub const TO_DIAGONAL: usize = 0;
pub const TO_B: usize = 1;
pub const TO_A: usize = 2;

impl Incidence {
    fn new(unknowns: usize, sides: impl Iterator<Item = [u32; 2]>) -> Self {
        let mut of_unknown: Vec<Vec<[u32; 2]>> = vec![Vec::new(); unknowns];
        for (e, [a, b]) in sides.enumerate() {
            let row = |row: usize| (e * SHARES + row) as u32;
            of_unknown[a as usize].push([row(TO_DIAGONAL), row(TO_A)]);
            if let Some(of_b) = of_unknown.get_mut(b as usize) {
                of_b.push([row(TO_DIAGONAL), row(TO_B)]);
            }
        }
        Incidence { counts: of_unknown.iter().map(|list| list.len() as u32).collect(), rows: of_unknown.concat() }
    }
}

/// Lists over one wall.
#[derive(Debug)]
pub struct Topology {
    pub unknowns: u32,
    /// Unknowns that are blocks; a beam with mass is not.
    pub blocks: u32,
    /// Place of every unknown, base and top in the elimination order.
    pub place: Vec<u32>,
    pub joints: Vec<JointAt>,
    pub rubs: Vec<RubAt>,
    pub one_sided: Vec<OneSidedAt>,
    /// Places in `rubs` of those at the beam, at the driven or tied top and at the base.
    pub rubs_of_beam: Vec<u32>,
    pub rubs_of_top: Vec<u32>,
    pub rubs_of_base: Vec<u32>,
    /// What every unknown, by place, gathers from the joints and from those that rub.
    pub of_joints: Incidence,
    pub of_rubs: Incidence,
    pub fill: u32,
    /// Per row of L: how many entries, and all entries as [column, where it stands].
    pub row_counts: Vec<u32>,
    pub row_entries: Vec<[u32; 2]>,
    /// Rows of all entries of L by columns.
    pub entry_row: Vec<u32>,
    /// Per column of L: how many entries; per entry, how many products of two entries are taken from it
    /// before it is divided by the pivot.
    pub column_counts: Vec<u32>,
    pub product_counts: Vec<u32>,
    /// Those products as [entry of L, entry of L D].
    pub products: Vec<[u32; 2]>,
}

impl Topology {
    /// The lists for a system of the group.
    pub fn new(system: &System) -> Self {
        let n = system.unknowns();
        let coupled = |s: &&[u32; 2]| (s[1] as usize) < n;
        let pairs: Vec<(usize, usize)> =
            system.sides.iter().filter(coupled).map(|s| (s[0] as usize, s[1] as usize)).collect();
        let (matrix, slots) = Matrix::new(n, &pairs, &system.centres, Factoring::Symmetric);
        let mut place = matrix.places().to_vec();
        place.extend([n as u32, n as u32 + 1]);
        let mut slots = slots.into_iter();
        let rub_of_joint = system.rub_of_joint();
        let beam = system.floating_beam().unwrap_or(system.top()) as u32;
        let mut one_sided = Vec::new();
        let mut joints = Vec::with_capacity(system.sides.len());
        for (e, s) in system.sides.iter().enumerate() {
            let sides = s.map(|i| place[i as usize]);
            let slot = if (s[1] as usize) < n { slots.next() } else { None };
            let mut joint = JointAt {
                sides,
                slot: slot.unwrap_or(NONE),
                rub: rub_of_joint[e].map_or(NONE, |r| r as u32),
                one_sided: NONE,
                upright: system.upright[e],
                to_beam: s[1] == beam,
                to_top: s[1] as usize == system.top(),
                to_base: s[1] as usize == system.base(),
            };
            if system.elastic[e].unilateral {
                joint.one_sided = one_sided.len() as u32;
                one_sided.push(OneSidedAt { sides, joint: e as u32 });
            }
            joints.push(joint);
        }
        let rub = |r: &crate::law::Rub| {
            let joint = &joints[r.joint as usize];
            RubAt { sides: joint.sides, slot: joint.slot }
        };
        let rubs = system.rubs.iter().map(rub).collect();
        let rubs_at = |chosen: fn(&JointAt) -> bool| {
            let at = |(r, _): (usize, &crate::law::Rub)| r as u32;
            let rubs = system.rubs.iter().enumerate();
            rubs.filter(|(_, rub)| chosen(&joints[rub.joint as usize])).map(at).collect::<Vec<u32>>()
        };
        let (rubs_of_beam, rubs_of_top) = (rubs_at(|j| j.to_beam), rubs_at(|j| j.to_top));
        let rubs_of_base = rubs_at(|j| j.to_base);
        let (start, rows) = matrix.pattern();
        let (row_counts, row_entries) = by_rows(start, rows);
        let (product_counts, products) = products(start, rows);
        Topology {
            unknowns: n as u32,
            blocks: system.blocks as u32,
            place,
            rubs,
            one_sided,
            rubs_of_beam,
            rubs_of_top,
            rubs_of_base,
            of_joints: Incidence::new(n, joints.iter().map(|j| j.sides)),
            of_rubs: Incidence::new(n, system.rubs.iter().map(|r| joints[r.joint as usize].sides)),
            joints,
            fill: rows.len() as u32,
            row_counts,
            row_entries,
            column_counts: start.windows(2).map(|w| w[1] - w[0]).collect(),
            entry_row: rows.to_vec(),
            product_counts,
            products,
        }
    }
}

/// The entries of L row by row, columns ascending.
fn by_rows(start: &[u32], rows: &[u32]) -> (Vec<u32>, Vec<[u32; 2]>) {
    let n = start.len() - 1;
    let mut entries: Vec<Vec<[u32; 2]>> = vec![Vec::new(); n];
    for k in 0..n {
        for at in start[k]..start[k + 1] {
            entries[rows[at as usize] as usize].push([k as u32, at]);
        }
    }
    (entries.iter().map(|row| row.len() as u32).collect(), entries.concat())
}

/// For every entry (r, c) of L, over the columns k < c in which both r and c have an entry: those two. In the order of
/// the columns, so that the sums are those of [`Matrix::factorise`] to the bit.
fn products(start: &[u32], rows: &[u32]) -> (Vec<u32>, Vec<[u32; 2]>) {
    let entry = |r: u32, c: u32| {
        let (from, to) = (start[c as usize] as usize, start[c as usize + 1] as usize);
        from + rows[from..to].partition_point(|&x| x < r)
    };
    let mut of_entry: Vec<Vec<[u32; 2]>> = vec![Vec::new(); rows.len()];
    for k in 0..start.len() - 1 {
        for p in start[k]..start[k + 1] {
            for q in start[k]..p {
                of_entry[entry(rows[p as usize], rows[q as usize])].push([p, q]);
            }
        }
    }
    (of_entry.iter().map(|list| list.len() as u32).collect(), of_entry.concat())
}
