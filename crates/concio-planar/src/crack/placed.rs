//! Where the contact points of a joint stand, and what each stands for.

use super::{
    CRUSHED, CRUSHING, Crack, DRY, HELD, NEARLY, NODES, NOTHING, PLACED, POINTS, PRESSED, Spot, THIN, WELL_BELOW,
    WHOLE, ZONES, between, is_open, place,
};
use crate::joint::{Law, Normal, Part, Point};
use crate::zone::{self, Moments, Zone};

impl Spot {
    /// At a place, with a share of the joint's law.
    fn of(point: usize, part: Part, [at, share]: [f64; 2]) -> Self {
        Spot { point, part, at, share, weight: share, rubbing: 0.0, damps: 1.0, crushed: 0.0, edge: 0.0 }
    }
}

/// Two points with the stiffness of what is left of the bond.
fn place_held(zones: &[Zone; ZONES], spots: &mut Vec<Spot>) {
    let damaged = |k: usize| zones.iter().map(|zone| zone.cracked[k]).sum::<f64>();
    let [whole, first, second]: Moments = std::array::from_fn(|k| WHOLE[k] - damaged(k));
    if whole > NOTHING {
        let centre = first / whole;
        let away = (second / whole - centre * centre).max(0.0).sqrt();
        let held = |point: usize, at: f64| Spot::of(point, Part::Held, [at, 0.5 * whole]);
        spots.extend([held(0, centre - away), held(1, centre + away)]);
    }
}

/// What is left of the slope of a line through an uneven zone, 0 … 1, so that no point leaves the limits of such a zone about the mean [m].
fn turned(points: impl Iterator<Item = [f64; 2]>, gap: &impl Fn(f64) -> f64, mean: f64, limits: [f64; 2]) -> f64 {
    let turned = points.fold(1.0, |turned: f64, [at, _]| {
        let limit = if gap(at) < mean { limits[0] } else { limits[1] };
        if (gap(at) - mean).abs() > (limit - mean).abs() {
            turned.min((limit - mean) / (gap(at) - mean))
        } else {
            turned
        }
    });
    turned.max(0.0)
}

impl Crack {
    /// Gives the points what follows from its state: stretch of what is held, and what part of friction acts.
    pub(crate) fn set(&self, points: &mut [Point]) {
        for spot in &self.spots {
            let point = &mut points[spot.point];
            (point.rubbing, point.damps) = (spot.rubbing, spot.damps);
            if spot.part == Part::Held {
                [point.gap, point.slide] = self.stretched(spot.at);
            }
        }
    }

    /// Takes the points from its zones, its ends being as far apart as `line` says; without inertia (`still`) what opens and closes is found by steps that follow.
    pub(super) fn place(&mut self, law: &Law, line: &[[f64; 2]; 2], zones: &[Zone; ZONES], still: bool) {
        let mut spots = std::mem::take(&mut self.spots);
        spots.clear();
        match law.normal {
            Normal::Rigid { .. } => self.place_rigid(&mut spots),
            Normal::Springs { .. } => self.place_springs(law, (line, zones), still, &mut spots),
        }
        self.spots = spots;
    }

    fn place_rigid(&self, spots: &mut Vec<Spot>) {
        let [first, last] = self.held;
        let dry = |end: usize, weight: f64| {
            let spot = Spot::of(HELD + end * (DRY - 1), Part::Dry, [end as f64, 0.5]);
            Spot { weight, rubbing: 1.0, ..spot }
        };
        if self.is_gone() {
            spots.extend([dry(0, 0.5), dry(1, 0.5)]);
            return;
        }
        // Against turning it holds as all of what is held would.
        let (length, centre) = (place(last) - place(first), 0.5 * (place(first) + place(last)));
        let held = |point: usize, side: f64| {
            let spot = Spot::of(point, Part::Held, [centre + side * length / 12f64.sqrt(), 0.5 * length]);
            Spot { weight: 0.5, rubbing: 1.0, ..spot }
        };
        if first > 0 {
            spots.push(dry(0, 0.0));
        }
        spots.extend([held(0, -1.0), held(1, 1.0)]);
        if last < NODES - 1 {
            spots.push(dry(1, 0.0));
        }
    }

    fn place_springs(
        &mut self,
        law: &Law,
        (line, zones): (&[[f64; 2]; 2], &[Zone; ZONES]),
        still: bool,
        spots: &mut Vec<Spot>,
    ) {
        let Normal::Springs { both, press, .. } = law.normal else { return };
        let stiffness = both + press;
        if !self.is_gone() {
            place_held(zones, spots);
        }
        self.placed = zones.map(|zone| [zone.acts[0], zone.acts[1]]);
        self.hidden = 0.0;
        let crushed = self.depth() > 0.0;
        // What is pressed beside what crushes is as wide as its end moves where it is pressed in by its depth: a spring without limits of its stiffness
        // bears what that end moves by, however thin it is.
        let crushes = zones[CRUSHING].acts[0];
        let edge = |kind: usize, zone: &Zone| {
            (kind == PRESSED || kind == CRUSHED) && zone.acts[0] < THIN * crushes && zone.acts[0] > 10.0 * NOTHING
        };
        let there = |kind: usize, zone: &Zone| zone.is_there() || edge(kind, zone);
        // Such a spring may pull in a step, and what crushes rubs for it: what rubs of its pressure, over that of what crushes.
        let rubbed = |zone: &Zone| zone.gap[0] * zone.rubs[0] / zone.acts[0];
        let thin = zones.iter().enumerate().filter(|(kind, zone)| edge(*kind, zone)).map(|(_, zone)| rubbed(zone));
        let own = rubbed(&zones[CRUSHING]);
        let also = if own < 0.0 { thin.sum::<f64>() / own } else { 0.0 };
        let ends = zones
            .iter()
            .filter(|zone| zone.is_there())
            .fold([1.0f64, 0.0f64], |[near, far], zone| [near.min(zone.between[0]), far.max(zone.between[1])]);
        let alone = zones.iter().filter(|zone| zone.is_there()).count() == 1;
        let mut point = HELD;
        for (kind, zone) in zones.iter().enumerate().filter(|(kind, zone)| there(*kind, zone)) {
            let (gap, cracked, rubs) =
                (zone.line(zone.gap), zone.line([zone.cracked[0], zone.cracked[1]]), zone.line(zone.rubs));
            let edge = if edge(kind, zone) { 0.5 * crushes } else { 0.0 };
            // A point in a corner that is near its strength would hold back all it stands for.
            let corners = zone.between.iter().all(|at| -gap(*at) < WELL_BELOW * law.crushing / stiffness);
            let points = match (corners, alone) {
                (true, true) => zone::padded(zone.three(ends)),
                // Without inertia nothing is gained: what follows a step puts it right.
                _ if is_open(kind) && !still && law.crushing.is_finite() => {
                    let apart = |at: f64| between(line, at)[0] + self.deep(at);
                    zone.closing(&apart, law.crushing / stiffness)
                }
                _ if is_open(kind) && !still => zone::padded(zone.ends()),
                (true, false) => zone::padded(zone.two(Some(ends))),
                (false, _) => zone::padded(zone.two(None)),
            };
            let points = || points.into_iter().filter(|[_, share]| *share > NOTHING);
            let mean = zone.gap[0] / zone.acts[0];
            let limits = if is_open(kind) { [0.0, f64::INFINITY] } else { [-law.crushing / stiffness, 0.0] };
            let turned = turned(points(), &gap, mean, limits);
            for [at, share] in points() {
                let mut spot = Spot::of(point, Part::Dry, [at, share]);
                // The part χ of all pressure rubs, of which what has cracked bears its share.
                (spot.weight, spot.rubbing) = ((share * cracked(at)).max(0.0), rubs(at).clamp(0.0, 1.0));
                if is_open(kind) && !still && law.crushing.is_finite() {
                    spot.damps = 0.0;
                }
                if edge > 0.0 {
                    (spot.edge, spot.rubbing) = (edge, 0.0);
                } else if kind == CRUSHING {
                    spot.rubbing *= 1.0 + also;
                }
                if crushed {
                    // What closes does so as it is there: with a line through all of it an end would bear that is open still.
                    let gap = match is_open(kind) && !still {
                        true => (between(line, at)[0] + self.deep(at)).max(0.0),
                        false => mean + turned * (gap(at) - mean),
                    };
                    spot.crushed = gap - between(line, at)[0];
                    self.hidden -= if is_open(kind) { 0.0 } else { 0.5 * stiffness * share * gap * gap };
                }
                spots.push(spot);
                point += 1;
            }
            if crushed && !is_open(kind) {
                self.hidden += 0.5 * stiffness * zone.square;
            }
        }
        if law.bond.is_some_and(|bond| bond.residual > 0.0) {
            spots.push(Spot { weight: 0.0, ..Spot::of(POINTS - 1, Part::Stays, [0.5, 1.0]) });
        }
    }

    /// Whether its points stand for these zones still.
    pub(super) fn stand(&self, zones: &[Zone; ZONES], still: bool) -> bool {
        let nearly = if still { NEARLY } else { PLACED };
        let there = |part: f64| part > zone::LEAST;
        let parts = self.placed.iter().map(|placed| placed[0]);
        let least = parts.filter(|part| there(*part)).fold(f64::INFINITY, f64::min);
        zones.iter().zip(self.placed).all(|(zone, placed)| {
            there(zone.acts[0]) == there(placed[0])
                && (0..2).all(|k| (zone.acts[k] - placed[k]).abs() <= nearly * least)
        })
    }
}
