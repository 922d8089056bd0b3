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

/// Springs as stiff as a comparison with rigid joints needs, of one stiffness in all directions.
pub const STIFF: &str = r#"law = "no-tension", stiffness = "500 N/mm3", rigidity = 1, normal_to_shear = 1"#;
/// Joints without springs.
pub const RIGID: &str = r#"law = "rigid""#;

/// A running bond of bricks of 0.4 m × 0.2 m × 0.3 m whose bed and head joints have one `law`: what else its `panel`, friction and bond have, and the `rest` of the file.
pub fn running(panel: &str, law: &str, friction: &str, bond: &str, rest: &str) -> String {
    format!(
        r#"model = "planar"
[[panel]]
bond = "running"
brick = {{ length = 0.4, height = 0.2, thickness = 0.3, specific_weight = 22e3 }}
mortar = {{ bed = 0, head = 0 }}
{panel}
[joint]
bed = {{ {law} }}
head = {{ {law} }}
friction = {{ law = "coulomb", {friction}, on = "all" }}
bond = {{ {bond} }}
{rest}
"#
    )
}
