//! Planar walls of a few blocks.

/// One block of 0.5 m × 0.5 m × 1 m and 5 kN.
pub fn block(rest: &str) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.5, height = 0.5, thickness = 1, specific_weight = 20e3 }}
{rest}"#
    )
}

/// Bricks of 0.5 m × 0.2 m × 1 m, 2 kN each, one on the other.
pub fn stack(courses: usize, rest: &str) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "stack"
courses = {courses}
bricks = 1
brick = {{ length = 0.5, height = 0.2, thickness = 1, specific_weight = 20e3 }}
{rest}"#
    )
}
