//! docs/symbols.md: one table of the symbols, held against the sources, the schema and the equations that it names.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::equations;

/// A symbol and where it is met.
struct Symbol {
    symbol: &'static str,
    meaning: &'static str,
    unit: &'static str,
    /// Keys of the wall file, parted by blanks; none when it is computed.
    keys: &'static str,
    /// `file word …`: a source of the engine and words that stand in it; empty where the code has no name for it.
    code: &'static str,
    /// Equations of docs/theory.md, or a section of it.
    source: &'static str,
}

const fn row(
    symbol: &'static str,
    meaning: &'static str,
    unit: &'static str,
    keys: &'static str,
    code: &'static str,
    source: &'static str,
) -> Symbol {
    Symbol { symbol, meaning, unit, keys, code, source }
}

#[rustfmt::skip]
const SYMBOLS: [Symbol; 61] = [
    row("L, H, B", "length, height and thickness of the brick", "m", "panel.brick.length panel.brick.height panel.brick.thickness", "case.rs length height thickness", "section 1"),
    row("γ", "specific weight", "N/m³", "panel.brick.specific_weight panel.block.specific_weight", "wall.rs specific_weight", "section 1"),
    row("t_b, t_h", "thickness of bed and head joints", "m", "panel.mortar.bed panel.mortar.head", "wall.rs mortar", "section 1"),
    row("g", "gravity, 9.81", "m/s²", "", "lib.rs G", "section 1"),
    row("m_i", "mass of block i", "kg", "", "wall.rs mass", "(1)"),
    row("M_ref, L_ref", "mass and length of the panel's reference brick", "kg, m", "panel.brick", "wall.rs reference_mass reference_length", "(4)"),
    row("ℓ", "overlap: contact length of a joint", "m", "", "wall.rs overlap", "section 1"),
    row("w", "overlap weight, 2 ℓ/L_ref", "1", "", "wall.rs weight", "(2) (4)"),
    row("x_i", "absolute displacement of block i", "m", "", "", "(1)"),
    row("z_i", "displacement of block i relative to the base", "m", "", "law/account.rs block_displacement", "section 2"),
    row("δ", "head joint: x_right − x_left, positive when it opens", "m", "", "law/account.rs joint_opening", "(3)"),
    row("U₀, U₁", "motion of the base and of a driven top beam", "m", "motion.base motion.top", "excitation.rs base top", "section 2"),
    row("K_H", "stiffness of the bed joint of a half-brick contact", "N/m", "joint.bed.stiffness joint.base.stiffness joint.top.stiffness", "case.rs stiffness", "(2)"),
    row("K_V", "stiffness of a head joint", "N/m", "joint.head.stiffness joint.connection.stiffness", "case.rs stiffness", "(3)"),
    row("κ", "how much stiffer a closed no-tension joint is", "1", "joint.head.rigidity", "case.rs rigidity", "(3)"),
    row("ζ", "damping ratio of an interface", "1", "joint.damping_ratio joint.bed.damping_ratio", "case.rs damping_ratio", "(4)"),
    row("C", "damping constant, 2 ζ √(K M_ref)", "N s/m", "", "shear/law.rs damping", "(4)"),
    row("F^el", "elastic force of a joint", "N", "", "shear/law.rs spring_force", "(2) (3)"),
    row("F^v", "viscous force of a joint", "N", "", "shear/dynamics.rs damping", "(4)"),
    row("F^fr", "friction force of a joint", "N", "", "shear/dynamics.rs friction", "(5)"),
    row("N", "normal force of a joint", "N", "joint.friction.normal_force", "graph.rs load", "(5)"),
    row("μ", "coefficient of friction at a slip velocity", "1", "joint.friction.law", "law/friction.rs at", "(6)"),
    row("μ_s, μ_d", "static and dynamic coefficient of friction", "1", "joint.friction.static joint.friction.dynamic", "law/friction.rs static_ dynamic", "(6)"),
    row("δ_v", "slip velocity: beyond it a joint slips", "m/s", "joint.friction.slip_velocity", "law/friction.rs slip_velocity", "(6)"),
    row("β", "steepness of friction at rest", "1", "joint.friction.beta", "law/friction.rs beta", "(6)"),
    row("α", "growth of friction with the square of the velocity", "s²/m²", "joint.friction.alpha", "law/friction.rs alpha", "(6)"),
    row("f_t", "tensile strength of head joints and connections", "Pa", "joint.bond.tensile_strength", "case.rs tensile_strength", "(B2)"),
    row("c", "cohesion of bed and support joints", "Pa", "joint.bond.cohesion", "case.rs cohesion", "(B2)"),
    row("φ", "friction angle of the bond", "rad", "joint.bond.friction_angle", "case.rs friction_angle", "(B2)"),
    row("G_f^I, G_f^II", "fracture energies of opening and of shear", "N/m", "joint.bond.mode_1_energy joint.bond.mode_2_energy", "case.rs mode_2_energy", "(B4)"),
    row("η", "fraction of the stiffness that a cracked joint keeps", "1", "joint.bond.residual_stiffness", "case.rs residual_stiffness", "(B1)"),
    row("A", "area of a joint, overlap times thickness", "m²", "", "bond.rs area", "(B2)"),
    row("F_0", "strength of a bonded joint", "N", "", "law/bond.rs strength", "(B2)"),
    row("D", "damage: fraction of the stiffness that a bonded joint has lost", "1", "", "law/bond.rs damage", "(B1) (B3)"),
    row("χ", "fraction of a bonded joint that rubs", "1", "", "law/bond.rs rubbing", "(B1) (B3) (B5)"),
    row("δ_m", "largest relative displacement or gap of a bonded joint so far", "m", "", "law/bond.rs reach", "(B3)"),
    row("δ_0, δ_c", "relative displacement at the strength; length over which the strength falls", "m", "", "law/bond.rs decay", "(B3) (B4)"),
    row("c", "constant of a device's dashpot", "N s/m", "joint.change.device.damping", "case/devices.rs damping", "(I1) (I2)"),
    row("α, v_0", "exponent of a dashpot; its reference velocity", "1, m/s", "joint.change.device.exponent joint.change.device.reference_velocity", "device.rs exponent", "(I1)"),
    row("k, k_1", "stiffness of a spring; of a re-centring device at rest", "N/m", "joint.change.device.stiffness", "case/devices.rs stiffness", "(I2) (I6)"),
    row("F_s", "force at which a friction damper slips", "N", "joint.change.device.slip_force", "case/devices.rs slip_force", "(I3)"),
    row("F_y, d_y", "yield force and displacement of a hysteretic device", "N, m", "joint.change.device.yield_force joint.change.device.yield_displacement", "case/devices.rs yield_force", "(I4)"),
    row("a", "fraction of the stiffness beyond yielding", "1", "joint.change.device.hardening", "case/devices.rs hardening", "(I4)"),
    row("A, β, γ, n", "shape of the hysteresis", "1", "joint.change.device.amplitude joint.change.device.beta joint.change.device.gamma joint.change.device.sharpness", "device.rs BoucWen", "(I5)"),
    row("ζ", "hysteretic variable", "1", "", "shear/state.rs internal", "(I5)"),
    row("F_a, k_2", "activation force and stiffness beyond it of a re-centring device", "N, N/m", "joint.change.device.activation_force joint.change.device.post_stiffness", "case/devices.rs activation_force", "(I6)"),
    row("β_f", "height of the flag over F_a", "1", "joint.change.device.flag", "device.rs flag", "(I7)"),
    row("s", "slip inside a re-centring device", "m", "", "shear/state.rs internal", "(I7)"),
    row("λ", "contact force of a rigid joint", "N", "", "shear/state.rs reaction", "(R2)"),
    row("p_j", "impulse of an impact in a rigid joint", "N s", "", "shear/integrate/impact.rs impulse", "(R3) (R4)"),
    row("e_j", "restitution of a rigid joint", "1", "joint.head.restitution joint.connection.restitution", "case.rs restitution", "(R4)"),
    row("q", "vertical load at the top, per length of brick", "N/m", "load.top", "case.rs top", "section 3"),
    row("P0_i", "load above block i in the research report", "N", "", "graph.rs overburden", "section 3"),
    row("M_b", "mass of the top beam", "kg", "load.beam.mass", "case.rs Mass", "section 2"),
    row("E_kin, E_el, E_0", "kinetic energy relative to the base; elastic energy of the joints; energy at t = 0", "J", "", "law/account.rs kinetic elastic initial", "(7)"),
    row("D_damping, …", "dissipated by damping, friction, breaking bonds, hysteretic devices, impacts of rigid joints, and friction whose action differs from its reaction", "J", "", "law/account.rs damping friction bond device impact nonreciprocal", "(7)"),
    row("W_base, W_top", "work of the base motion on the relative motion, and of the driven top beam", "J", "", "law/account.rs input_base input_top", "(7)"),
    row("R", "residual of the energy account", "J", "", "law/account.rs peak_residual", "(7)"),
    row("h", "length of a step", "s", "solver.max_step", "shear/integrate/step.rs h", "(S1)"),
    row("τ", "γ h of the scheme, length of a stage", "s", "", "shear/integrate/stage.rs τ", "(T1)"),
    row("e", "estimated local error", "m, m/s", "solver.tolerance solver.floor", "shear/integrate/step.rs error", "(P1)"),
];

const HEAD: &str = "\
# Symbols

<!-- Made by `cargo xtask docs` from the table in xtask/src/symbols.rs. -->

Sources are equations and sections of [theory.md](theory.md), keys those of the [wall file](wall-file.md). Code is a file of
`crates/concio/src/` and names in it, after `law/` and `shear/` of `crates/concio-law/src/` and `crates/concio-shear/src/`.

| symbol | meaning | wall file | code | source |
|---|---|---|---|---|
";

/// The page, from what the table names; fails where it names what is not there.
pub fn page(root: &Path, schema: &str) -> Result<String, String> {
    let schema: Value = serde_json::from_str(schema).map_err(|e| format!("schema: {e}"))?;
    let theory = fs::read_to_string(root.join(equations::THEORY)).map_err(|e| format!("{}: {e}", equations::THEORY))?;
    let mut page = HEAD.to_string();
    for s in &SYMBOLS {
        let found = keys(&schema, s).and_then(|()| code(root, s)).and_then(|()| source(&theory, s));
        found.map_err(|why| format!("docs/symbols.md, {}: {why}", s.symbol))?;
        let keys: Vec<String> = s.keys.split_whitespace().map(|k| format!("`{k}`")).collect();
        let keys = if keys.is_empty() { "–".into() } else { keys.join(", ") };
        let code: Vec<String> = s.code.split_whitespace().map(|word| format!("`{word}`")).collect();
        let code = if code.is_empty() { "–".into() } else { code.join(" ") };
        let unit = if s.unit == "1" { String::new() } else { format!(" [{}]", s.unit) };
        page += &format!("| {} | {}{unit} | {keys} | {code} | {} |\n", s.symbol, s.meaning, s.source);
    }
    Ok(page)
}

/// Every key is in the schema.
fn keys(schema: &Value, s: &Symbol) -> Result<(), String> {
    for key in s.keys.split_whitespace() {
        let mut places = vec![schema];
        for part in key.split('.') {
            places = places.into_iter().flat_map(|p| tables(schema, p)).filter_map(|t| t.get(part)).collect();
        }
        if places.is_empty() {
            return Err(format!("the wall file has no key `{key}`"));
        }
    }
    Ok(())
}

/// Properties of a schema: its own, and those of what it refers to, lists or chooses among.
fn tables<'a>(schema: &'a Value, part: &'a Value) -> Vec<&'a Value> {
    let mut found: Vec<&Value> = part.get("properties").into_iter().collect();
    if let Some(name) = part.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix("#/$defs/")) {
        found.extend(schema.pointer(&format!("/$defs/{name}")).into_iter().flat_map(|d| tables(schema, d)));
    }
    found.extend(part.get("items").into_iter().flat_map(|i| tables(schema, i)));
    for choice in ["anyOf", "oneOf", "allOf"] {
        let choices = part.get(choice).and_then(Value::as_array).into_iter().flatten();
        found.extend(choices.flat_map(|c| tables(schema, c)));
    }
    found
}

/// The file is there and holds the words.
fn code(root: &Path, s: &Symbol) -> Result<(), String> {
    if s.code.is_empty() {
        return Ok(());
    }
    let (file, words) = s.code.split_once(' ').ok_or_else(|| format!("`{}` names no word", s.code))?;
    let (package, own) = match file.split_once('/') {
        Some((package @ ("law" | "shear"), own)) => (format!("concio-{package}"), own),
        _ => ("concio".to_string(), file),
    };
    let path = root.join("crates").join(package).join("src").join(own);
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let parts = || text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    match words.split(' ').find(|word| parts().all(|part| part != *word)) {
        Some(word) => Err(format!("`{word}` does not stand in {file}")),
        None => Ok(()),
    }
}

/// Equations and sections are in the theory.
fn source(theory: &str, s: &Symbol) -> Result<(), String> {
    let known = equations::defined(theory);
    let found = match s.source.strip_prefix("section ") {
        Some(number) => theory.lines().any(|l| l.starts_with(&format!("## {number}. "))),
        None => s.source.split(' ').all(|n| known.contains(n.trim_matches(['(', ')']))),
    };
    if found { Ok(()) } else { Err(format!("{} is not in {}", s.source, equations::THEORY)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: Symbol = row("K", "stiffness", "N/m", "joint.bed.stiffness", "law.rs at", "(2)");

    #[test]
    fn keys_are_followed_through_references_lists_and_choices() {
        let schema = serde_json::json!({
            "properties": { "joint": { "anyOf": [{ "$ref": "#/$defs/J" }] } },
            "$defs": { "J": { "properties": { "bed": { "items": { "properties": { "stiffness": {} } } } } } },
        });
        assert_eq!(keys(&schema, &ROW), Ok(()));
        let wrong = Symbol { keys: "joint.bed.stifness", ..ROW };
        assert!(keys(&schema, &wrong).is_err());
    }

    #[test]
    fn sources_are_equations_or_sections() {
        let theory = "## 1. Wall\n\n    (2) F\n    (3) F\n";
        assert!(source(theory, &ROW).is_ok());
        assert!(source(theory, &Symbol { source: "(2) (3)", ..ROW }).is_ok());
        assert!(source(theory, &Symbol { source: "(4)", ..ROW }).is_err());
        assert!(source(theory, &Symbol { source: "section 1", ..ROW }).is_ok());
        assert!(source(theory, &Symbol { source: "section 2", ..ROW }).is_err());
    }
}
