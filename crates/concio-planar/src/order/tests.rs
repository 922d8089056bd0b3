//! Orders of walls in running bond, and of what is no wall.

use super::*;

/// Half bricks at both ends of every second course; each touches its neighbours and those above and below.
fn wall(courses: usize, bricks: usize) -> (Vec<(usize, usize)>, Vec<[f64; 2]>) {
    let (mut pairs, mut at, mut below): (_, _, Vec<([f64; 2], usize)>) = (Vec::new(), Vec::new(), Vec::new());
    for course in 0..courses {
        let shift = 0.5 * (course % 2) as f64;
        let mut cuts: Vec<f64> = (0..=bricks).map(|k| k as f64 + shift).collect();
        if course % 2 == 1 {
            cuts.insert(0, 0.0);
            cuts[bricks + 1] = bricks as f64;
        }
        let first = at.len();
        let mut row = Vec::new();
        for cut in cuts.windows(2) {
            let own = at.len();
            at.push([0.5 * (cut[0] + cut[1]), course as f64]);
            if own > first {
                pairs.push((own - 1, own));
            }
            let touches = |x: &[f64; 2]| x[1].min(cut[1]) - x[0].max(cut[0]) > 1e-9;
            pairs.extend(below.iter().filter(|(x, _)| touches(x)).map(|(_, under)| (*under, own)));
            row.push(([cut[0], cut[1]], own));
        }
        below = row;
    }
    (pairs, at)
}

fn scratch(n: usize) -> Scratch {
    Scratch { mark: vec![0; n], stamp: 0, local: vec![0; n] }
}

fn elimination(n: usize, pairs: &[(usize, usize)], at: &[[f64; 2]]) -> Elimination {
    Orders { at: at.to_vec(), ..Orders::anywhere() }.elimination(n, pairs)
}

/// Every unknown once; every pair in the pattern; an eliminated unknown's neighbours are each other's; and those that are eliminated into an
/// unknown right before it, so that each subtree is a range.
fn is_elimination(n: usize, pairs: &[(usize, usize)], elimination: &Elimination) {
    let places = elimination.places();
    let mut sorted = elimination.order.clone();
    sorted.sort_unstable();
    assert!(sorted.iter().copied().eq(0..n as u32));
    for &(a, b) in pairs {
        let (row, column) = (places[a].min(places[b]), places[a].max(places[b]));
        assert!(elimination.rows[row as usize].binary_search(&column).is_ok());
    }
    let mut first = vec![u32::MAX; n];
    for (own, row) in elimination.rows.iter().enumerate() {
        assert!(row.windows(2).all(|two| two[0] < two[1]) && row.first().is_none_or(|k| *k > own as u32));
        first[own] = first[own].min(own as u32);
        let Some((&into, others)) = row.split_first() else { continue };
        assert!(others.iter().all(|k| elimination.rows[into as usize].binary_search(k).is_ok()));
        first[into as usize] = first[into as usize].min(first[own]);
    }
    for (own, row) in elimination.rows.iter().enumerate() {
        if let Some(&into) = row.first() {
            let below = own as u32 + 1..into;
            assert!(below.clone().all(|k| first[k as usize] > own as u32), "{own} and what follows");
        }
    }
}

#[test]
fn orders_are_eliminations() {
    for (courses, bricks) in [(1, 1), (1, 9), (6, 4), (12, 12), (5, 60), (40, 3)] {
        let (pairs, at) = wall(courses, bricks);
        for at in [&at[..], &[]] {
            is_elimination(
                courses * bricks + courses / 2,
                &pairs,
                &elimination(courses * bricks + courses / 2, &pairs, at),
            );
        }
    }
    is_elimination(0, &[], &elimination(0, &[], &[]));
    // All joined to all in one place; nothing joined to anything; a beam on everything; two walls that are not joined, and some pairs twice.
    let all: Vec<(usize, usize)> = (0..70).flat_map(|i| (0..i).map(move |j| (j, i))).collect();
    is_elimination(70, &all, &elimination(70, &all, &[[0.0; 2]; 70]));
    is_elimination(70, &[], &elimination(70, &[], &[[0.0; 2]; 70]));
    let (mut pairs, mut at) = wall(10, 10);
    let n = at.len();
    at.push([5.0, 10.0]);
    pairs.extend((0..n).map(|i| (i, n)));
    is_elimination(n + 1, &pairs, &elimination(n + 1, &pairs, &at));
    let (mut pairs, mut at) = wall(10, 10);
    pairs.extend(pairs.clone().iter().flat_map(|(i, j)| [(i + n, j + n), (j + n, i + n)]));
    at.extend(at.clone());
    is_elimination(2 * n, &pairs, &elimination(2 * n, &pairs, &at));
}

/// Products per block that walls take, a hundredth above "products of elimination per block" of decision 0011.
#[test]
fn walls_take_no_more_products_than_they_did() {
    for (courses, bricks, most) in
        [(16, 16, 66.0), (32, 32, 204.0), (48, 48, 347.0), (70, 70, 543.0), (16, 64, 106.0), (16, 300, 114.0)]
    {
        let (pairs, at) = wall(courses, bricks);
        let n = at.len();
        let found = elimination(n, &pairs, &at).products() as f64 / n as f64;
        assert!(found <= most, "{courses} × {bricks}: {found} instead of {most}");
    }
}

/// The façade of `examples/large` so many times as long, 33 bricks and a door and five windows each time, without its lintels.
fn facade(times: usize) -> (Vec<(usize, usize)>, Vec<[f64; 2]>) {
    let openings = [
        [14.5, 18.5, -0.5, 12.0],
        [4.5, 8.0, 5.0, 12.0],
        [25.0, 28.5, 5.0, 12.0],
        [4.5, 8.0, 21.0, 29.0],
        [14.75, 18.25, 21.0, 29.0],
        [25.0, 28.5, 21.0, 29.0],
    ];
    let (pairs, at) = wall(36, 33 * times);
    let is_wall = |[x, y]: &[f64; 2]| {
        !openings.iter().any(|[x0, x1, y0, y1]| (*x0..*x1).contains(&(x % 33.0)) && (*y0..*y1).contains(y))
    };
    let mut kept = vec![None; at.len()];
    let mut number = 0;
    for (own, at) in kept.iter_mut().zip(&at) {
        if is_wall(at) {
            *own = Some(number);
            number += 1;
        }
    }
    let pairs = pairs.iter().filter_map(|(a, b)| Some((kept[*a]?, kept[*b]?))).collect();
    (pairs, at.into_iter().filter(is_wall).collect())
}

/// Every length that a façade is made longer by takes as many products and factors as the one before: what elimination costs is linear in the
/// number of blocks. Only near the ends of a wall does a block take less, and the shortest is nothing but ends.
#[test]
fn longer_facades_take_as_much_more_as_they_are_longer() {
    let (mut blocks, mut work) = (Vec::new(), Vec::new());
    for times in (2..=10).step_by(2) {
        let (pairs, at) = facade(times);
        let found = elimination(at.len(), &pairs, &at);
        blocks.push(at.len());
        work.push([found.products(), found.rows.iter().map(|row| row.len() as u64).sum()]);
    }
    assert!((2_000..2_100).contains(&blocks[0]) && blocks[4] > 10_000);
    for kind in 0..2 {
        let more: Vec<f64> = work.windows(2).map(|two| (two[1][kind] - two[0][kind]) as f64).collect();
        assert!(more.iter().all(|more_of| (more_of / more[0] - 1.0).abs() < 0.01), "{more:?}");
    }
}

/// Square walls are cut, and a quarter is gained by that at least; long ones are not.
#[test]
fn what_is_better_is_kept() {
    let of = |courses, bricks| {
        let (pairs, at) = wall(courses, bricks);
        let n = at.len();
        let graph = Graph::new(n, &pairs);
        let set: Vec<u32> = (0..n as u32).collect();
        let whole = least_fill::order(&graph, &set, &mut scratch(n)).products;
        let cut = cut::best(&graph, &at, &set, &mut scratch(n)).expect("a cut");
        assert!(cut.through.len() <= courses.min(bricks) + 1, "{}", cut.through.len());
        let parts = in_parts(&graph, &at, cut, &mut scratch(n)).products;
        let kept = elimination(n, &pairs, &at).products();
        assert_eq!(kept, whole.min(parts));
        (whole, parts)
    };
    let (whole, parts) = of(48, 48);
    assert!(4 * parts < 3 * whole + whole / 2, "{parts} {whole}");
    let (whole, parts) = of(16, 64);
    assert!(4 * whole < 3 * parts, "{parts} {whole}");
}

/// Pairs of two sides, drawn by a seed, and the fewest that all of them end at, by trying every set.
#[test]
fn cuts_go_through_the_fewest() {
    let mut seed = 7u64;
    for _ in 0..200 {
        let mut draw = |below: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) % below
        };
        let pairs: Vec<(usize, usize)> = (0..draw(14)).map(|_| (draw(5) as usize, 5 + draw(5) as usize)).collect();
        let covers = |set: u32| pairs.iter().all(|(a, b)| set >> a & 1 == 1 || set >> b & 1 == 1);
        let fewest = (0..1 << 10).filter(|set| covers(*set)).map(u32::count_ones).min().expect("all of them do");
        let set: Vec<u32> = (0..10).collect();
        let cut = cut::between(&Graph::new(10, &pairs), &set, 5, &mut scratch(10));
        assert_eq!(cut.through.len() as u32, fewest);
        assert!(covers(cut.through.iter().map(|k| 1 << k).sum()));
    }
}

/// A part that is eliminated while its neighbours stay takes as many products as in the whole, where it comes first.
#[test]
fn parts_are_counted_with_what_is_around_them() {
    let (pairs, at) = wall(12, 12);
    let n = at.len();
    let graph = Graph::new(n, &pairs);
    let set: Vec<u32> = (0..n as u32).filter(|&i| at[i as usize][0] < 6.0).collect();
    let part = least_fill::order(&graph, &set, &mut scratch(n));
    assert_eq!(part.products, tree::products_of(&graph, &part.order, &mut scratch(n)));
    let rest: Vec<u32> = (0..n as u32).filter(|i| !set.contains(i)).collect();
    let whole = tree::products_of(&graph, &[&part.order[..], &rest].concat(), &mut scratch(n));
    let later = least_fill::order(&graph, &rest, &mut scratch(n)).products;
    assert!(whole > part.products + later, "what was eliminated joined its neighbours");
    assert_eq!(tree::postordered(&graph, &[part.order, rest].concat()).products(), whole);
}

/// The order of the laid wall serves for a few more that touch, and for all that do a better one is found; either is an elimination.
#[test]
fn the_order_of_the_laid_wall_serves_on() {
    let (mut pairs, at) = wall(30, 12);
    let n = at.len();
    let orders = Orders::new(at, &pairs);
    let laid = orders.elimination(n, &pairs);
    assert_eq!(laid.products(), orders.products);
    pairs.push((0, 2));
    let few = orders.elimination(n, &pairs);
    is_elimination(n, &pairs, &few);
    assert_eq!(few.order, laid.order);
    // What fell lies beside the wall's other end.
    pairs.extend((0..40).map(|k| (k, n - 1 - k)));
    let many = orders.elimination(n, &pairs);
    is_elimination(n, &pairs, &many);
    let kept = tree::postordered(&Graph::new(n, &pairs), &orders.laid);
    assert!(10 * many.products() < 9 * kept.products(), "{} {}", many.products(), kept.products());
}
