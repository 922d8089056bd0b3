//! Friction of one joint with the others held: the velocity w and the coefficient μ for which
//!
//!   w + s μ(w) = c,
//!
//! c being the velocity without friction and s what a coefficient of 1 takes off it.

use peer_system::Friction;

/// (6), or with `sharp` its limit for β → ∞, which is set-valued at rest. Of several solutions, which there may be
/// where friction falls with the velocity faster than s allows, rest wins, then a slow slip.
pub fn meet(law: &Friction, sharp: bool, s: f64, c: f64) -> (f64, f64) {
    let (sign, c) = (if c < 0.0 { -1.0 } else { 1.0 }, c.abs());
    if sharp && c <= s * law.fixed {
        return (0.0, sign * c / s);
    }
    let at = |w: f64| if sharp { in_slip(law, w) } else { law.at(w) };
    let (mut low, mut high, mut w) = (0.0, c, start(law, sharp, s, c));
    for _ in 0..100 {
        let (mu, slope) = at(w);
        let f = w + s * mu - c;
        if f < 0.0 {
            low = w
        } else {
            high = w
        }
        if f.abs() <= 1e-15 * c || high - low <= 1e-15 * c {
            break;
        }
        let next = w - f / (1.0 + s * slope);
        // The middle in the geometric mean: (6) lives on scales from δ_v/β to metres per second.
        w = if next > low && next < high { next } else { (low.max(1e-9 * high) * high).sqrt() };
    }
    // From the balance, not the law: with it impulse and velocity agree to the last bit.
    (sign * w, if s > 0.0 { sign * (c - w) / s } else { sign * at(w).0 })
}

/// A first guess: far up the branch of slip, or on the steep branch.
fn start(law: &Friction, sharp: bool, s: f64, c: f64) -> f64 {
    let slipping = c - s * law.dynamic;
    if slipping > 0.0 {
        return slipping;
    }
    if sharp { 0.5 * c } else { (law.slip_velocity / law.beta).min(0.5 * c) }
}

/// |μ| in slip and its slope, the limit of (6) for β → ∞.
fn in_slip(law: &Friction, w: f64) -> (f64, f64) {
    let decay = (law.fixed - law.dynamic) * (-w / law.slip_velocity).exp();
    (decay + law.dynamic + law.alpha * w * w, 2.0 * law.alpha * w - decay / law.slip_velocity)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Friction = Friction { fixed: 0.6, dynamic: 0.42, slip_velocity: 1e-3, beta: 100.0, alpha: 0.0 };

    #[test]
    fn the_balance_and_the_law_hold() {
        for s in [1e-6, 1e-4, 1e-2, 1.0] {
            for c in [1e-9, 1e-5, 2e-3, -0.05, 3.0] {
                for sharp in [false, true] {
                    let (w, mu) = meet(&LAW, sharp, s, c);
                    assert!((w + s * mu - c).abs() <= 1e-14 * c.abs(), "{s} {c}");
                    let law = if !sharp {
                        LAW.at(w).0
                    } else if w == 0.0 {
                        mu.clamp(-0.6, 0.6)
                    } else {
                        in_slip(&LAW, w.abs()).0.copysign(w)
                    };
                    assert!((mu - law).abs() < 1e-6 * (1.0 + 1e-8 * c.abs() / s), "{s} {c} {sharp}: {mu} {law}");
                }
            }
        }
    }
}
