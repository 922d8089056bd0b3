//! What is read off a run to answer the findings: numbers that hold although single trajectories are chaotic (peaks,
//! medians over joints, counts, works), never values at an instant.
//!
//! Frames are the only history used, because they hold every block; a wall file of `examples/report` keeps one frame
//! per 0.1 ms. Faster changes than that are counted once.

use concio::moment::Moment;
use concio::store::{StoredRun, residual_relative, top_force_rms};
use concio::wall::End;
use serde::{Deserialize, Serialize};

/// δ_v [m/s] of section 4.2, for joints that have none of their own: a frictionless wall is measured by the same yard.
const SLIP_VELOCITY: f64 = 1e-3;
/// A joint sticks below this fraction of δ_v, where (6) still rises, and slips above δ_v, where it has fallen. In
/// between it keeps the state that it had.
const STICKS_BELOW: f64 = 0.1;
/// The start of a run, as a fraction of it, that counts and rms values leave out as transient.
const TRANSIENT: f64 = 0.1;

/// Numbers of one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// Hash of the run's inputs.
    pub inputs_hash: String,
    /// Work of the top beam and of the base [J].
    pub input: f64,
    /// Dissipated by friction [J].
    pub friction: f64,
    /// Dissipated by viscous damping [J].
    pub damping: f64,
    /// Taken out by friction whose action differs from its reaction [J].
    pub nonreciprocal: f64,
    /// Largest residual of the energy account over the largest work.
    pub residual: f64,
    /// Root mean square of the force of the top beam [N].
    pub top_force_rms: f64,
    /// Largest |displacement| of a block relative to the base [m].
    pub peak_displacement: f64,
    /// Root mean square displacement of the blocks relative to the base [m].
    pub rms_displacement: f64,
    /// Root mean square velocity of the blocks relative to the base [m/s].
    pub rms_velocity: f64,
    /// Widest gap of a head joint [m].
    pub widest_opening: f64,
    /// Median over the head joints of the widest gap of each [m].
    pub typical_opening: f64,
    /// Deepest closure of a head joint [m].
    pub deepest_closure: f64,
    /// Largest |relative displacement| of a bed or support joint [m].
    pub widest_slip: f64,
    /// Median over bed and support joints of the largest |relative displacement| [m].
    pub typical_slip: f64,
    /// Largest |relative velocity| of a bed or support joint [m/s].
    pub peak_slip_velocity: f64,
    /// Changes from stick to slip of the bed or support joint that has most of them.
    pub most_onsets: f64,
    /// Median over bed and support joints of their changes from stick to slip.
    pub typical_onsets: f64,
    /// Changes from stick to slip per second of the median bed or support joint [Hz].
    pub onset_rate: f64,
    /// Median over the blocks of the number of jumps of their velocity: changes by δ_v or more from frame to frame.
    pub typical_jumps: f64,
    /// The same of the block that has most.
    pub most_jumps: f64,
    /// Of the jumps of the relative velocity of bed and support joints, the share at which the joint goes from stick
    /// to slip or back, in the same frame or the next to either side. 0 without jumps.
    pub linked_jumps: f64,
    /// The share of all frames for which that holds: what chance would give.
    pub linked_by_chance: f64,
    /// Bed and support joints by name, with their peak |relative acceleration| [m/s²].
    pub accelerations: Vec<(String, f64)>,
    /// Overlap of the same joints [m].
    pub overlaps: Vec<f64>,
    /// Mass of the lighter block at the same joints [kg].
    pub lighter_masses: Vec<f64>,
    /// Of the same joints at the frame at which one of them has the largest |relative acceleration| of all frames: that
    /// over the median joint's.
    pub uneven_at_instant: f64,
}

/// Reads them off a run that keeps frames. Lists are never empty: a wall has support joints and blocks.
pub fn of(run: &StoredRun) -> Measures {
    let (outcome, env) = (&run.outcome, &run.outcome.envelopes);
    let upright = |e: &usize| run.joints[*e].joint.kind.is_upright();
    let (heads, beds): (Vec<usize>, Vec<usize>) = (0..run.joints.len()).partition(upright);
    let pick = |values: &[f64], of: &[usize]| of.iter().map(|&e| values[e]).collect::<Vec<f64>>();
    let openings = pick(&env.joint_opening, &heads);
    let slips = pick(&env.joint_displacement, &beds);
    let watched = watch_joints(run, &beds);
    let jumps = block_jumps(run);
    let time = outcome.time_reached * (1.0 - TRANSIENT);
    let typical_onsets = median(&watched.onsets);
    let [rms_displacement, rms_velocity] = rms(run);
    Measures {
        inputs_hash: run.provenance.inputs_hash.clone(),
        input: outcome.energies.input(),
        friction: outcome.energies.friction,
        damping: outcome.energies.damping,
        nonreciprocal: outcome.energies.nonreciprocal,
        residual: residual_relative(outcome),
        top_force_rms: top_force_rms(outcome),
        peak_displacement: outcome.totals.peak_relative_displacement,
        rms_displacement,
        rms_velocity,
        widest_opening: largest(&openings),
        typical_opening: median(&openings),
        deepest_closure: -outcome.totals.minimum_gap,
        widest_slip: largest(&slips),
        typical_slip: median(&slips),
        peak_slip_velocity: outcome.totals.peak_slip_velocity,
        most_onsets: largest(&watched.onsets),
        typical_onsets,
        onset_rate: typical_onsets / time,
        typical_jumps: median(&jumps),
        most_jumps: largest(&jumps),
        linked_jumps: watched.linked,
        linked_by_chance: watched.chance,
        accelerations: beds.iter().map(|&e| (run.joints[e].name.clone(), env.joint_acceleration[e])).collect(),
        overlaps: beds.iter().map(|&e| run.joints[e].joint.overlap).collect(),
        lighter_masses: beds.iter().map(|&e| lighter_mass(run, e)).collect(),
        uneven_at_instant: uneven_at_instant(run, &beds),
    }
}

/// Frames after the transient.
fn frames(run: &StoredRun) -> std::ops::Range<usize> {
    let count = run.outcome.recording.frame_time.len();
    (TRANSIENT * count as f64) as usize..count
}

struct Watched {
    /// Per joint.
    onsets: Vec<f64>,
    linked: f64,
    chance: f64,
}

fn watch_joints(run: &StoredRun, joints: &[usize]) -> Watched {
    let moments: Vec<Moment> = frames(run).filter_map(|f| Moment::of(run, f)).collect();
    let (mut onsets, mut jumps, mut linked, mut near, mut all) = (Vec::new(), 0usize, 0usize, 0usize, 0usize);
    for &joint in joints {
        let limit = run.joints[joint].friction.as_ref().map_or(SLIP_VELOCITY, |f| f.slip_velocity);
        let velocity: Vec<f64> = moments.iter().map(|m| m.joint(joint).velocity).collect();
        let slips = states(&velocity, limit);
        onsets.push(slips.windows(2).filter(|s| !s[0] && s[1]).count() as f64);
        let changes: Vec<bool> = slips.windows(2).map(|s| s[0] != s[1]).collect();
        for k in 0..changes.len() {
            let by = changes[k.saturating_sub(1)..(k + 2).min(changes.len())].contains(&true);
            let jump = (velocity[k + 1] - velocity[k]).abs() >= limit;
            all += 1;
            near += usize::from(by);
            jumps += usize::from(jump);
            linked += usize::from(jump && by);
        }
    }
    let share = |part: usize, whole: usize| if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
    Watched { onsets, linked: share(linked, jumps), chance: share(near, all) }
}

/// Whether a joint slips, frame by frame.
fn states(velocity: &[f64], limit: f64) -> Vec<bool> {
    let mut slips = false;
    let next = |v: &f64| {
        slips = v.abs() > limit || (slips && v.abs() >= STICKS_BELOW * limit);
        slips
    };
    velocity.iter().map(next).collect()
}

/// Per block.
fn block_jumps(run: &StoredRun) -> Vec<f64> {
    let (n, velocity) = (run.outcome.layout.unknowns, &run.outcome.recording.frame_velocity);
    let of_block = |block: usize| {
        let at = |f: usize| velocity[f * n + block];
        frames(run).skip(1).filter(|&f| (at(f) - at(f - 1)).abs() >= SLIP_VELOCITY).count() as f64
    };
    (0..run.wall.blocks.len()).map(of_block).collect()
}

/// Over all blocks and frames after the transient: of the displacement and of the velocity.
fn rms(run: &StoredRun) -> [f64; 2] {
    let (n, blocks, recording) = (run.outcome.layout.unknowns, run.wall.blocks.len(), &run.outcome.recording);
    let frames = frames(run);
    let count = (frames.len() * blocks).max(1) as f64;
    [&recording.frame_displacement, &recording.frame_velocity].map(|values| {
        let rows = frames.clone().map(|f| &values[f * n..f * n + blocks]);
        (rows.flatten().map(|v| v * v).sum::<f64>() / count).sqrt()
    })
}

/// Of a support, that of its block.
fn lighter_mass(run: &StoredRun, joint: usize) -> f64 {
    let (joint, mass) = (&run.joints[joint].joint, |b: usize| run.wall.blocks[b].mass());
    match joint.b {
        End::Block(b) => mass(joint.a).min(mass(b)),
        End::Base | End::Top => mass(joint.a),
    }
}

/// 0 when nothing moves at all.
fn uneven_at_instant(run: &StoredRun, joints: &[usize]) -> f64 {
    let at = |m: Moment| joints.iter().map(|&e| m.joint(e).acceleration.abs()).collect::<Vec<f64>>();
    let rows = frames(run).filter_map(|f| Moment::of(run, f)).map(at);
    let peak = rows.max_by(|a, b| largest(a).total_cmp(&largest(b))).unwrap_or_default();
    if median(&peak) > 0.0 { largest(&peak) / median(&peak) } else { 0.0 }
}

/// Largest value; 0 of an empty list.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Median; 0 of an empty list.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[half],
        _ => 0.5 * (sorted[half - 1] + sorted[half]),
    }
}

/// Spearman's rank correlation of two lists of equal length; 0 when one of them is constant.
pub fn rank_correlation(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (ranks(a), ranks(b));
    let mean = (a.len() as f64 - 1.0) / 2.0;
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum::<f64>();
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    if scale > 0.0 { product(&a, &b) / scale } else { 0.0 }
}

/// Ranks from 0; equal values share the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let rank = |v: &f64| {
        let below = values.iter().filter(|w| *w < v).count() as f64;
        let equal = values.iter().filter(|w| *w == v).count() as f64;
        below + (equal - 1.0) / 2.0
    };
    values.iter().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_keeps_its_state_between_the_limits() {
        let velocity = [0.0, 0.5, 1.5, 0.5, 0.05, 0.5, -2.0, -0.2];
        let slips = [false, false, true, true, false, false, true, true];
        assert_eq!(states(&velocity, 1.0), slips);
    }

    #[test]
    fn medians_and_ranks() {
        assert_eq!((median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0, 2.0, 3.0]), median(&[])), (2.0, 2.5, 0.0));
        assert_eq!(ranks(&[5.0, 1.0, 5.0]), [1.5, 0.0, 1.5]);
        assert!((rank_correlation(&[1.0, 2.0, 3.0], &[10.0, 20.0, 90.0]) - 1.0).abs() < 1e-12);
        assert!((rank_correlation(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]) + 1.0).abs() < 1e-12);
        assert_eq!(rank_correlation(&[1.0, 1.0], &[1.0, 2.0]), 0.0);
    }
}
