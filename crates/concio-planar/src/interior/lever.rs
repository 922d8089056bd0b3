//! Where the bodies of contacts that are taken together are pushed, and what contacts of one pair add up to.

use std::array::from_fn;

use pulp::Simd;

use super::Sums;
use super::lanes::{Lanes, PACK, Pack, Real};
use crate::blocks::{Slot, Triple};
use crate::contact::{BASE, Rows};

/// Numbers of two pushes, and with them those of what resists.
pub(super) const PUSHES: usize = 8;
pub(super) const ALL: usize = PUSHES + 16;

/// The bodies of contacts that are taken together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bodies {
    first: [u32; PACK],
    second: [u32; PACK],
}

/// The normal on the second body, and the arms of normal and tangent on the first and on the second: the tangent is the normal turned, and
/// the first body is pushed as the second, the other way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arms<T> {
    n: [T; 2],
    across: [T; 2],
    along: [T; 2],
}

impl Bodies {
    /// Of rows that have levers, with their arms.
    pub fn of(rows: [&Rows; PACK]) -> (Self, Arms<Pack>) {
        let each = rows.map(|rows| rows.levers().expect("rows that have levers"));
        let [first, second] = [0, 1].map(|i| each.map(|lever| lever.bodies[i]));
        let arms = Arms {
            n: from_fn(|i| each.map(|lever| lever.normal[i])),
            across: from_fn(|i| each.map(|lever| lever.across[i])),
            along: from_fn(|i| each.map(|lever| lever.along[i])),
        };
        (Bodies { first, second }, arms)
    }

    #[inline(always)]
    pub fn each(&self, k: usize) -> [u32; 2] {
        [self.first[k], self.second[k]]
    }

    /// By how much the second body of each moves away from the first, and how both turn.
    #[inline(always)]
    pub fn gather(&self, v: &[Triple]) -> [Pack; 4] {
        let mut all = [[0.0; PACK]; 4];
        for k in 0..PACK {
            let [mut x, mut y, turn] = v[self.second[k] as usize];
            let mut before = 0.0;
            if self.first[k] != BASE {
                let first = &v[self.first[k] as usize];
                x -= first[0];
                y -= first[1];
                before = first[2];
            }
            (all[0][k], all[1][k], all[2][k], all[3][k]) = (x, y, before, turn);
        }
        all
    }
}

impl Arms<Pack> {
    #[inline(always)]
    pub fn part<S: Simd>(&self, simd: S, part: usize) -> Arms<Lanes<S>> {
        let Arms { n, across, along } = self;
        Arms {
            n: [Lanes::of(simd, &n[0], part), Lanes::of(simd, &n[1], part)],
            across: [Lanes::of(simd, &across[0], part), Lanes::of(simd, &across[1], part)],
            along: [Lanes::of(simd, &along[0], part), Lanes::of(simd, &along[1], part)],
        }
    }
}

impl<T: Real> Arms<T> {
    /// By how much the parting and the sliding velocity change, by [`Bodies::gather`].
    #[inline(always)]
    pub fn change(&self, [x, y, first, second]: [T; 4]) -> [T; 2] {
        let ([n_x, n_y], across, along) = (self.n, self.across, self.along);
        [
            n_x * x + n_y * y + across[1] * second + across[0] * first,
            n_x * y - n_y * x + along[1] * second + along[0] * first,
        ]
    }

    /// What impulses do: to the second body along x and y, the other way to the first, and how they turn the first and the second.
    #[inline(always)]
    pub fn thrust(&self, p: [T; 2]) -> [T; 4] {
        let ([n_x, n_y], across, along) = (self.n, self.across, self.along);
        [
            n_x * p[0] - n_y * p[1],
            n_y * p[0] + n_x * p[1],
            across[0] * p[0] + along[0] * p[1],
            across[1] * p[0] + along[1] * p[1],
        ]
    }

    /// What resists: [`Arms::thrust`] of the impulses that answer, across and along to the same, and along to across, to x, to y, and to turns of the
    /// first and of the second body.
    #[inline(always)]
    pub fn couple(&self, [nn, tt, tn]: [T; 3]) -> [T; 16] {
        let ([n_x, n_y], across, along) = (self.n, self.across, self.along);
        let x = self.thrust([nn * n_x, tn * n_x - tt * n_y]);
        let y = self.thrust([nn * n_y, tn * n_y + tt * n_x]);
        let first = self.thrust([nn * across[0], tn * across[0] + tt * along[0]]);
        let second = self.thrust([nn * across[1], tn * across[1] + tt * along[1]]);
        [
            x[0], x[1], x[2], x[3], y[0], y[1], y[2], y[3], first[0], first[1], first[2], first[3], second[0],
            second[1], second[2], second[3],
        ]
    }
}

/// What contacts of one pair that follow each other add to its bodies, and to the matrix: each is gone to once for all.
pub(super) struct Joined<const NUMBERS: usize> {
    pub bodies: [u32; 2],
    slot: Option<Slot>,
    sums: [f64; NUMBERS],
    resists: bool,
}

impl<const NUMBERS: usize> Joined<NUMBERS> {
    pub fn none() -> Self {
        Joined { bodies: [BASE; 2], slot: None, sums: [0.0; NUMBERS], resists: false }
    }

    #[inline(always)]
    pub fn begin(&mut self, bodies: [u32; 2], slot: Option<Slot>) {
        *self = Joined { bodies, slot, ..Joined::none() };
    }

    /// The first so many numbers of a contact.
    #[inline(always)]
    pub fn add(&mut self, numbers: &[Pack; NUMBERS], k: usize, many: usize) {
        for (sum, pack) in self.sums[..PUSHES].iter_mut().zip(numbers) {
            *sum += pack[k];
        }
        if many > PUSHES {
            self.resists = true;
            for (sum, pack) in self.sums[PUSHES..].iter_mut().zip(&numbers[PUSHES..]) {
                *sum += pack[k];
            }
        }
    }

    /// Four numbers of [`Arms::thrust`] to the bodies.
    #[inline(always)]
    pub fn push(&self, from: usize, balance: &mut [Triple]) {
        let [first, second] = self.bodies;
        if second == BASE {
            return;
        }
        let push: [f64; 4] = from_fn(|k| self.sums[from + k]);
        let body = &mut balance[second as usize];
        *body = [body[0] + push[0], body[1] + push[1], body[2] + push[3]];
        if first != BASE {
            let body = &mut balance[first as usize];
            *body = [body[0] - push[0], body[1] - push[1], body[2] + push[2]];
        }
    }
}

impl Joined<ALL> {
    /// All to where it belongs.
    #[inline(always)]
    pub fn end_look(&self, sums: &mut Sums) {
        self.push(0, sums.residual);
        self.push(4, sums.step);
        if !self.resists {
            return;
        }
        // By what moves and what that pushes: x, y, turns of the first and of the second.
        let at = |by: usize, on: usize| self.sums[PUSHES + 4 * by + on];
        let [xx, xy, yx, yy] = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        let own = |k: usize, sign: f64| {
            [
                [xx, xy, sign * at(k, 0), 0.0],
                [yx, yy, sign * at(k, 1), 0.0],
                [sign * at(0, k), sign * at(1, k), at(k, k), 0.0],
            ]
        };
        sums.matrix.add_block(self.bodies[1] as usize, own(3, 1.0));
        if let Some(slot) = self.slot {
            sums.matrix.add_block(self.bodies[0] as usize, own(2, -1.0));
            sums.matrix.add_pair_of_blocks(
                slot,
                [
                    [-xx, -xy, -at(3, 0), 0.0, -xx, -yx, -at(0, 3), 0.0],
                    [-yx, -yy, -at(3, 1), 0.0, -xy, -yy, -at(1, 3), 0.0],
                    [at(0, 2), at(1, 2), at(3, 2), 0.0, at(2, 0), at(2, 1), at(2, 3), 0.0],
                ],
            );
        }
    }
}
