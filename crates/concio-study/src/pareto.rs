//! The order of designs by one objective, or by several at once: K. Deb et al., IEEE Trans. Evol. Comput. 6 (2002)
//! 182–197. All objectives are to be small.

/// Whether `a` is nowhere worse than `b` and somewhere better.
pub fn dominates(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| a <= b) && a.iter().zip(b).any(|(a, b)| a < b)
}

/// Places from the best to the worst: front by front, in a front those first that have most room around them, equal
/// ones as they come.
pub fn order(values: &[Vec<f64>]) -> Vec<usize> {
    fronts(values).into_iter().flat_map(|front| roomiest_first(values, front)).collect()
}

/// Places of those that none dominates, as they come; of equal ones the first.
pub fn front(values: &[Vec<f64>]) -> Vec<usize> {
    let first = fronts(values).into_iter().next().unwrap_or_default();
    let new = |(i, &k): (usize, &usize)| !first[..i].iter().any(|&j| values[j] == values[k]);
    first.iter().enumerate().filter(|&f| new(f)).map(|(_, &k)| k).collect()
}

fn fronts(values: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = (0..values.len()).collect();
    let mut fronts = Vec::new();
    while !left.is_empty() {
        let free = |&k: &usize| !left.iter().any(|&j| dominates(&values[j], &values[k]));
        // Where something is no number nothing dominates, and the front is never empty.
        let (front, rest): (Vec<usize>, Vec<usize>) = left.iter().partition(|k| free(k));
        fronts.push(front);
        left = rest;
    }
    fronts
}

fn roomiest_first(values: &[Vec<f64>], front: Vec<usize>) -> Vec<usize> {
    let mut room = vec![0.0f64; front.len()];
    let objectives = values.first().map_or(0, Vec::len);
    for m in 0..objectives {
        let mut along: Vec<usize> = (0..front.len()).collect();
        along.sort_by(|&a, &b| values[front[a]][m].total_cmp(&values[front[b]][m]));
        let at = |k: usize| values[front[along[k]]][m];
        let last = along.len() - 1;
        let span = at(last) - at(0);
        (room[along[0]], room[along[last]]) = (f64::INFINITY, f64::INFINITY);
        for k in 1..last {
            room[along[k]] += if span > 0.0 { (at(k + 1) - at(k - 1)) / span } else { 0.0 };
        }
    }
    let mut places: Vec<usize> = (0..front.len()).collect();
    places.sort_by(|&a, &b| room[b].total_cmp(&room[a]));
    places.into_iter().map(|k| front[k]).collect()
}

/// The place in a front that comes nearest to the best of every objective, each measured from 0 at its best to 1 at its
/// worst in the front; 0 of one objective is the best.
pub fn knee(values: &[Vec<f64>]) -> Option<usize> {
    let objectives = values.first()?.len();
    let ends = |m: usize| {
        let finite = values.iter().map(|v| v[m]).filter(|v| v.is_finite());
        finite.fold([f64::INFINITY, f64::NEG_INFINITY], |e, v| [e[0].min(v), e[1].max(v)])
    };
    let ends: Vec<[f64; 2]> = (0..objectives).map(ends).collect();
    let share = |v: f64, [low, high]: [f64; 2]| match v.is_finite() {
        true if high > low => (v - low) / (high - low),
        true => 0.0,
        false => f64::INFINITY,
    };
    let distance = |v: &[f64]| v.iter().zip(&ends).map(|(v, e)| share(*v, *e).powi(2)).sum::<f64>();
    (0..values.len()).min_by(|&a, &b| distance(&values[a]).total_cmp(&distance(&values[b])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(pairs: &[[f64; 2]]) -> Vec<Vec<f64>> {
        pairs.iter().map(|p| p.to_vec()).collect()
    }

    #[test]
    fn fronts_come_one_after_the_other() {
        let values = of(&[[3.0, 3.0], [1.0, 4.0], [2.0, 2.0], [4.0, 1.0], [5.0, 5.0], [2.0, 2.0]]);
        assert_eq!(front(&values), [1, 2, 3]);
        let order = order(&values);
        assert_eq!(order[4..], [0, 4]);
        // The ends of the front have most room.
        assert_eq!(order[..2], [1, 3]);
        assert_eq!(knee(&of(&[[1.0, 4.0], [2.0, 2.0], [4.0, 1.0]])), Some(1));
    }

    #[test]
    fn one_objective_is_sorted_and_what_failed_is_last() {
        let values: Vec<Vec<f64>> = [3.0, 1.0, f64::INFINITY, 2.0].iter().map(|v| vec![*v]).collect();
        assert_eq!(order(&values), [1, 3, 0, 2]);
        assert_eq!((front(&values), knee(&values)), (vec![1], Some(1)));
        assert_eq!((order(&[]), front(&[]), knee(&[])), (vec![], vec![], None));
    }
}
