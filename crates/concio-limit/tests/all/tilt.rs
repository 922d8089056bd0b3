//! Dry walls tilted slowly until they move, against the multipliers of limit analysis: friction without dilation gives less than the
//! associative λ, and more than walls whose head joints do not rub at all.

use crate::limit_walls::{DryWall, FRICTIONLESS, certified, tilted};

#[test]
fn tilted_walls_move_between_their_bounds() {
    let brick = [0.25, 0.12];
    let halves = |mu| DryWall::running(4, 8, brick, mu, false);
    let opening = vec![
        vec![1.0, 1.0, 1.0, 1.0],
        vec![0.5, 1.0, 1.0, 1.0, 0.5],
        vec![1.0, 0.5, -1.0, 0.5, 1.0],
        vec![0.5, 1.0, -1.0, 1.0, 0.5],
        vec![1.0, 1.0, 1.0, 1.0],
        vec![0.5, 1.0, 1.0, 1.0, 0.5],
    ];
    let walls = [
        ("W1, μ = 0.3", halves(0.3)),
        ("W1, μ = 0.65", halves(0.65)),
        ("W2, μ = 0.65", DryWall::running(6, 6, brick, 0.65, false)),
        ("with an opening", DryWall::pattern(&opening, [0.4, 0.175], 0.65)),
        ("stack", DryWall::stack(5, [0.4, 0.25], 0.7)),
    ];
    for (name, wall) in walls {
        let associative = wall.multiplier();
        let frictionless = certified(&wall.limit(FRICTIONLESS));
        let found = tilted(&wall, 1.2 * associative);
        println!("{name}: {frictionless:.4} … {found:.4} … {associative:.4}");
        assert!(found >= 0.97 * frictionless && found <= 1.01 * associative, "{name}");
    }
}
