//! A panel of the continuum by finite elements: a rectangle of elements with 8 nodes, as any program has them.

use crate::ContinuumError;
use crate::springs::Matrix;

/// Places and weights of three Gauss points.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
/// Nodes of an element: corners, then middles of the sides, counterclockwise.
const NODES: [[i32; 2]; 8] = [[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]];

/// Horizontal stiffness [N/m] of a panel `width` × `height` [m], fixed along its base, under a beam that stays level and neither
/// rises nor falls; `membrane` is A [N/m]. 32 elements a side come within 10⁻⁴ of any number of them.
///
/// # Errors
/// Sizes that are not above 0, no elements, a system that was not solved.
pub fn membrane_stiffness(
    membrane: &[[f64; 3]; 3],
    [width, height]: [f64; 2],
    elements: usize,
) -> Result<f64, ContinuumError> {
    if !(width > 0.0 && height > 0.0 && elements > 0) {
        let what = format!("a panel of {width} m × {height} m in {elements} × {elements} elements");
        return Err(concio::InputError::new(what).allowed("above 0").into());
    }
    let [dx, dy] = [width / elements as f64, height / elements as f64];
    let element = element(membrane, dx, dy);
    let side = 2 * elements + 1;
    // Middles of elements bear no node.
    let mut number = vec![usize::MAX; side * side];
    let mut nodes = 0;
    for j in 0..side {
        for i in (0..side).filter(|i| i % 2 == 0 || j % 2 == 0) {
            number[j * side + i] = nodes;
            nodes += 1;
        }
    }
    let mut prescribed = vec![None; 2 * nodes];
    for i in 0..side {
        for (j, moved) in [(0, 0.0), (side - 1, 1.0)] {
            let node = number[j * side + i];
            prescribed[2 * node] = Some(vec![moved]);
            prescribed[2 * node + 1] = Some(vec![0.0]);
        }
    }
    let mut matrix = Matrix::default();
    let mut places = Vec::with_capacity(elements * elements);
    for ey in 0..elements {
        for ex in 0..elements {
            let node = |k: usize| {
                let [i, j] = NODES[k];
                let [i, j] = [(2 * ex + 1) as i32 + i, (2 * ey + 1) as i32 + j];
                number[j as usize * side + i as usize]
            };
            let unknowns: [usize; 16] = std::array::from_fn(|u| 2 * node(u / 2) + u % 2);
            for (r, i) in unknowns.iter().enumerate() {
                for (c, j) in unknowns.iter().enumerate() {
                    matrix.add(*i, *j, element[r][c]);
                }
            }
            places.push(unknowns);
        }
    }
    let x = &matrix.solve(2 * nodes, &[vec![0.0; 2 * nodes]], &prescribed)?[0];
    let energy = |unknowns: &[usize; 16]| -> f64 {
        let of = |r: usize| (0..16).map(|c| element[r][c] * x[unknowns[c]]).sum::<f64>();
        (0..16).map(|r| x[unknowns[r]] * of(r)).sum()
    };
    Ok(places.iter().map(energy).sum())
}

fn element(membrane: &[[f64; 3]; 3], dx: f64, dy: f64) -> [[f64; 16]; 16] {
    let mut matrix = [[0.0; 16]; 16];
    for (x, wx) in GAUSS {
        for (y, wy) in GAUSS {
            let weight = wx * wy * 0.25 * dx * dy;
            let mut strain = [[0.0; 16]; 3];
            for k in 0..8 {
                let [sx, sy] = slopes(k, x, y);
                let [sx, sy] = [sx * 2.0 / dx, sy * 2.0 / dy];
                strain[0][2 * k] = sx;
                strain[1][2 * k + 1] = sy;
                strain[2][2 * k] = sy;
                strain[2][2 * k + 1] = sx;
            }
            for r in 0..16 {
                for c in 0..16 {
                    for i in 0..3 {
                        for j in 0..3 {
                            matrix[r][c] += weight * strain[i][r] * membrane[i][j] * strain[j][c];
                        }
                    }
                }
            }
        }
    }
    matrix
}

/// Derivatives of a shape function.
fn slopes(node: usize, x: f64, y: f64) -> [f64; 2] {
    let [a, b] = NODES[node].map(f64::from);
    match (a == 0.0, b == 0.0) {
        // ¼ (1 + a x)(1 + b y)(a x + b y − 1)
        (false, false) => {
            [0.25 * a * (1.0 + b * y) * (2.0 * a * x + b * y), 0.25 * b * (1.0 + a * x) * (2.0 * b * y + a * x)]
        }
        // ½ (1 − x²)(1 + b y)
        (true, _) => [-x * (1.0 + b * y), 0.5 * b * (1.0 - x * x)],
        (_, true) => [0.5 * a * (1.0 - y * y), -y * (1.0 + a * x)],
    }
}
