//! What a joint bears along where it has no bond: what its points take over from its fibres, and what friction takes.

use super::{BETWEEN_FIBRES, Crack, DRY, Ended, POINTS, Worn, between};
use crate::fibres::{FIBRES, HALF, Lines, Sheared, Stands, above, parts};
use crate::joint::{Law, Part, Point};

/// Friction at the points of what has cracked, as each slides.
struct Frictions {
    /// Where each is, 0 … 1 along the joint, and its μ; no numbers beyond the last.
    own: [[f64; 2]; DRY],
    least: f64,
    largest: f64,
}

impl Frictions {
    /// Of points and their μ.
    fn of(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut found = Frictions { own: [[f64::NAN; 2]; DRY], least: f64::INFINITY, largest: 0.0 };
        for (own, point) in found.own.iter_mut().zip(points) {
            *own = point;
            (found.least, found.largest) = (found.least.min(point[1]), found.largest.max(point[1]));
        }
        found
    }

    /// The one μ of all of them, if it is one.
    fn alike(&self) -> Option<f64> {
        (self.least == self.largest).then_some(self.least)
    }

    /// That of the nearest point.
    fn at(&self, x: f64) -> f64 {
        let near = |mu: &&[f64; 2]| (mu[0] - x).abs();
        let nearest = || self.own.iter().filter(|mu| !mu[0].is_nan()).min_by(|a, b| near(a).total_cmp(&near(b)));
        self.alike().unwrap_or_else(|| nearest().map_or(0.0, |mu| mu[1]))
    }
}

/// A number on the way from one end of the joint to the other.
fn on_way([from, to]: [f64; 2], x: f64) -> f64 {
    from + x * (to - from)
}

/// What presses a part of a joint by its springs, `sprung` [N], less its dashpot of `damping` [N s/m] as it parts at `speed` [m/s], from 0 to `most`. What friction
/// bore against the dashpots' pressure too would be lost at each step, however short.
fn less_dashpots(sprung: f64, damping: f64, speed: f64, most: f64) -> f64 {
    if speed == 0.0 || !(sprung > 0.0) { sprung } else { (sprung - damping * speed).clamp(0.0, most) }
}

impl Crack {
    /// Takes note of what friction took of one of its points in the step [J].
    pub(crate) fn rubs(&mut self, taken: f64) {
        if self.is_gone() && self.fibres.are_there() {
            self.fibres.rubbed += taken;
        }
    }

    /// Lets what its friction does not hold slide where its points stand as they did; what that takes.
    pub(super) fn rub(&mut self, law: &Law, points: &mut [Point], ended: &Ended) -> Worn {
        if !(self.fibres.are_there() && self.is_gone()) {
            return Worn::default();
        }
        let [_, stored] = self.friction_borne(law, points);
        Worn { friction: self.follow_fibres(law, points, ended, stored), ..Worn::default() }
    }

    /// Friction at rest is overcome where all that is pressed slides, and comes back where all of it rests: a joint slides as one.
    fn start_and_stop(&mut self, points: &mut [Point]) {
        let Crack { fibres, spots, .. } = self;
        let dry = || spots.iter().filter(|spot| spot.part == Part::Dry && spot.rubbing > 0.0).map(|spot| spot.point);
        let speeds = || dry().map(|k| &points[k]).filter(|p| p.gap + p.crushed < 0.0).map(|p| p.speed);
        let fastest = speeds().fold(0.0, f64::max);
        fibres.sliding &= fastest > 0.0;
        fibres.sliding |= fastest > 0.0 && speeds().all(|speed| speed > 0.0);
        for k in dry() {
            points[k].speed = match fibres.sliding {
                true if points[k].speed == 0.0 => fastest,
                true => points[k].speed,
                false => 0.0,
            };
        }
    }

    /// Takes the fibres to where a step has `ended`, and has its points bear what they do; what friction takes of `stored` of the points and what fibres stored
    /// beyond [J].
    pub(super) fn follow_fibres(&mut self, law: &Law, points: &mut [Point], ended: &Ended, stored: f64) -> f64 {
        let before = stored + self.fibres.uneven;
        self.start_and_stop(points);
        // What acts without inertia acts at the end of the step, else in its middle.
        let (line, was, still) = (ended.line, &self.was, ended.still);
        let open = [0, 1].map(|end| if still { line[end][0] } else { 0.5 * (line[end][0] + was[end][0]) });
        let even = self.is_even();
        if even && !open.iter().any(|gap| *gap < 0.0) {
            self.fibres.hang(0..FIBRES);
            (self.fibres.uneven, self.fibres.rubbed) = (0.0, 0.0);
            let dry = self.spots.iter().filter(|spot| spot.part == Part::Dry);
            dry.for_each(|spot| points[spot.point].bearing = 0.0);
            return before;
        }
        let Sheared { mut whole, mut energy } = self.shear_fibres(law, points, ended, (open, even));
        // Friction took this of points that were pressed less in the step than at its end.
        let rubbed = std::mem::take(&mut self.fibres.rubbed);
        let most = (before + if still { rubbed } else { 0.0 }).max(0.0);
        if energy > most {
            let part = (most / energy).sqrt();
            self.fibres.weaken(part, |x| between(line, x)[1]);
            (whole, energy) = (part * whole, most);
        }
        // Without inertia nothing swings, whatever the points store.
        let limits = self.limits(law, points, ended);
        self.spread(law, points, &limits, [whole, if still { f64::INFINITY } else { energy }]);
        let [_, keeps] = self.friction_borne(law, points);
        self.fibres.uneven = energy - keeps;
        before - energy
    }

    /// What the fibres bear and store where a step has `ended`, in which the ends of the joint were `open` by so much as forces acted [m]. Of an `even`
    /// one nothing is crushed.
    fn shear_fibres(&mut self, law: &Law, points: &[Point], ended: &Ended, (open, even): ([f64; 2], bool)) -> Sheared {
        let Ended { line, still, parting, shallower } = *ended;
        let dry = self.spots.iter().filter(|spot| spot.part == Part::Dry);
        let mu =
            Frictions::of(dry.map(|spot| {
                [spot.at, law.friction.map_or(0.0, |friction| friction.of(points[spot.point].speed, still))]
            }));
        let (along, stiffness, damping) = (law.breaking_stiffness(), law.normal_stiffness(), law.normal_damping());
        let last = self.crushed.len().saturating_sub(1) as f64;
        // What is pressed in beyond that is crushed.
        let most_sunk = law.crushing / stiffness;
        let Crack { fibres, crushed, .. } = self;
        let crushed_at = |x: f64| crushed.get((x * last).round() as usize).copied().unwrap_or(0.0);
        let around = |x: f64| {
            let ends = [(x - HALF).max(0.0), (x + HALF).min(1.0)];
            // In the middle of a step not all is crushed yet that is by its end.
            let [pressed, sprung] = above(ends.map(|x| {
                let before =
                    shallower.and_then(|depths| depths.get((x * (BETWEEN_FIBRES - 1) as f64).round() as usize));
                let sunk = -on_way(open, x);
                if still { sunk - crushed_at(x) } else { (sunk - before.unwrap_or(&0.0)).min(most_sunk) }
            }));
            let most = pressed * law.crushing;
            let force = less_dashpots(stiffness * sprung, pressed * damping, on_way(parting, x), most);
            Stands { slide: between(line, x)[1], most: mu.at(x) * force.min(most), pressed }
        };
        let [closed, begins, hangs] = parts(open.map(|gap| -gap));
        let Some(mu) = mu.alike().filter(|_| even) else { return fibres.follow(along, 0..FIBRES, around) };
        fibres.hang(hangs);
        let [first, end] = [0.0, 1.0].map(|x| -stiffness * on_way(open, x) - damping * on_way(parting, x));
        let slide = [line[0][1], line[1][1] - line[0][1]];
        let lines = Lines { slide, press: [first, end - first], limit: law.crushing, mu };
        let pressed = fibres.follow_pressed(along, closed, &lines);
        pressed.and(fibres.follow(along, begins, around))
    }

    /// What has cracked bears along the joint, and what its springs along store [N, J].
    pub(super) fn friction_borne(&self, law: &Law, points: &[Point]) -> [f64; 2] {
        let along = law.breaking_stiffness();
        let dry = self.spots.iter().filter(|spot| spot.part == Part::Dry && along > 0.0);
        dry.fold([0.0; 2], |[whole, energy], spot| {
            let bearing = points[spot.point].bearing;
            [whole + bearing, energy + 0.5 * bearing * bearing / (spot.share * along)]
        })
    }

    /// What friction lets each point bear [N].
    pub(super) fn limits(&self, law: &Law, points: &[Point], ended: &Ended) -> [f64; POINTS] {
        let mut limits = [0.0; POINTS];
        let Some(friction) = law.friction else { return limits };
        let (stiffness, damping) = (law.normal_stiffness(), law.normal_damping());
        for spot in self.spots.iter().filter(|spot| spot.part == Part::Dry) {
            let point = &points[spot.point];
            let sprung = spot.share * stiffness * (-point.gap - point.crushed).max(0.0);
            let most = (spot.share + spot.edge) * law.crushing;
            let pressed = less_dashpots(sprung, spot.share * damping, on_way(ended.parting, spot.at), most);
            limits[spot.point] = spot.rubbing * friction.of(point.speed, ended.still) * pressed;
        }
        limits
    }

    /// Has its points bear `whole` along the joint [N], or what stores no more than `energy` [J]: each as near as that goes to the same part of what friction lets it, so
    /// that none slides before the joint does.
    fn spread(&self, law: &Law, points: &mut [Point], limits: &[f64; POINTS], [whole, energy]: [f64; 2]) {
        let along = law.breaking_stiffness();
        let dry = || self.spots.iter().filter(|spot| spot.part == Part::Dry);
        // What is open bears nothing.
        if whole == 0.0 || energy == 0.0 {
            return dry().for_each(|spot| points[spot.point].bearing = 0.0);
        }
        self.share_friction(law, points, limits, [whole, energy]);
        let all: f64 = dry().map(|spot| limits[spot.point]).sum();
        let borne: f64 = dry().map(|spot| points[spot.point].bearing).sum();
        let part = if all > 0.0 { (borne / all).clamp(-1.0, 1.0) } else { 0.0 };
        let mut ways = [0.0; POINTS];
        let mut sums = [0.0; 3];
        for spot in dry() {
            let (from, k) = (points[spot.point].bearing, spot.share * along);
            let way = part * limits[spot.point] - from;
            ways[spot.point] = way;
            sums = [sums[0] + way * way / k, sums[1] + from * way / k, sums[2] + from * from / k];
        }
        let [square, middle, rest] = sums;
        // (rest + 2 middle x + square x²)/2 = energy.
        let room = 2.0 * energy - rest;
        let most = if square + 2.0 * middle <= room {
            1.0
        } else if room > 0.0 && square > 0.0 {
            ((middle * middle + square * room).sqrt() - middle) / square
        } else {
            0.0
        };
        for spot in dry() {
            points[spot.point].bearing += most * ways[spot.point];
        }
    }

    /// Has what has cracked bear `whole` along the joint [N], or what stores no more than `energy` [J]: all its points stretched alike, those that
    /// friction lets.
    pub(super) fn share_friction(
        &self,
        law: &Law,
        points: &mut [Point],
        limits: &[f64; POINTS],
        [whole, energy]: [f64; 2],
    ) {
        let along = law.breaking_stiffness();
        let dry = || self.spots.iter().filter(|spot| spot.part == Part::Dry && along > 0.0);
        let (mut rest, mut held, mut slides) =
            (whole, dry().map(|spot| spot.share * along).sum::<f64>(), [false; POINTS]);
        loop {
            let stretch = if held > 0.0 { rest / held } else { 0.0 };
            let mut settled = true;
            for spot in dry() {
                if slides[spot.point] {
                    continue;
                }
                let (point, most) = (&mut points[spot.point], limits[spot.point]);
                point.bearing = stretch * spot.share * along;
                if point.bearing.abs() > most {
                    point.bearing = most.copysign(stretch);
                    (rest, held) = (rest - point.bearing, held - spot.share * along);
                    (slides[spot.point], settled) = (true, false);
                }
            }
            if settled {
                break;
            }
        }
        let [_, stored] = self.friction_borne(law, points);
        if stored > energy.max(0.0) {
            let part = (energy.max(0.0) / stored).sqrt();
            dry().for_each(|spot| points[spot.point].bearing *= part);
        }
    }
}
