//! Blocks and joints of a wall as columns, each a list of Python's.

use concio::record::Event;
use concio::store::JointRow;
use concio::wall::{End, Wall};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;

use crate::json;

/// Columns of blocks, SI.
pub fn blocks<'py>(py: Python<'py>, wall: &Wall) -> PyResult<Bound<'py, PyDict>> {
    let blocks = &wall.blocks;
    let table = PyDict::new(py);
    table.set_item("name", blocks.iter().map(|b| b.name.as_str()).collect::<Vec<_>>())?;
    table.set_item("panel", blocks.iter().map(|b| wall.panels[b.panel].name.as_str()).collect::<Vec<_>>())?;
    table.set_item("course", blocks.iter().map(|b| b.course + 1).collect::<Vec<_>>())?;
    for (name, of) in [
        ("x", &(|b: &concio::wall::Block| b.centre()[0]) as &dyn Fn(&concio::wall::Block) -> f64),
        ("y", &|b| b.centre()[1]),
        ("length", &|b| b.length()),
        ("height", &|b| b.height()),
        ("thickness", &|b| b.thickness),
        ("mass", &|b| b.mass()),
    ] {
        table.set_item(name, blocks.iter().map(of).collect::<Vec<_>>())?;
    }
    table.set_item("corners", blocks.iter().map(|b| b.corners()).collect::<Vec<_>>())?;
    Ok(table)
}

/// Columns of joints, SI.
pub fn joints<'py>(py: Python<'py>, wall: &Wall, joints: &[JointRow]) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    let word = |value: serde_json::Value| value.as_str().unwrap_or_default().to_string();
    let block = |end: usize| wall.blocks[end].name.as_str();
    table.set_item("name", joints.iter().map(|j| j.name.as_str()).collect::<Vec<_>>())?;
    table.set_item("kind", joints.iter().map(|j| word(json!(j.joint.kind))).collect::<Vec<_>>())?;
    table.set_item("a", joints.iter().map(|j| block(j.joint.a)).collect::<Vec<_>>())?;
    let other = |end: End| match end {
        End::Block(b) => block(b),
        End::Base => "base",
        End::Top => "top",
    };
    table.set_item("b", joints.iter().map(|j| other(j.joint.b)).collect::<Vec<_>>())?;
    table.set_item("law", joints.iter().map(|j| word(json!(j.law))).collect::<Vec<_>>())?;
    for (name, of) in [
        ("stiffness", &(|j: &JointRow| j.stiffness) as &dyn Fn(&JointRow) -> f64),
        ("normal_stiffness", &|j| j.normal_stiffness),
        ("damping", &|j| j.damping),
        ("normal_force", &|j| j.normal_force[0]),
        ("friction_static", &|j| j.friction.map_or(f64::NAN, |f| f.static_)),
        ("friction_dynamic", &|j| j.friction.map_or(f64::NAN, |f| f.dynamic)),
    ] {
        table.set_item(name, joints.iter().map(of).collect::<Vec<_>>())?;
    }
    Ok(table)
}

/// Columns of what happened at one instant.
pub fn events<'py>(py: Python<'py>, joints: &[JointRow], events: &[Event]) -> PyResult<Bound<'py, PyAny>> {
    let name = |event: &Event| joints.get(event.joint as usize).map(|row| row.name.as_str());
    let columns = json!({
        "time": events.iter().map(|e| e.time).collect::<Vec<_>>(),
        "joint": events.iter().map(name).collect::<Vec<_>>(),
        "kind": events.iter().map(|e| e.kind).collect::<Vec<_>>(),
        "value": events.iter().map(|e| e.value).collect::<Vec<_>>(),
        "unit": events.iter().map(|e| e.kind.unit()).collect::<Vec<_>>(),
    });
    json::to_python(py, &columns)
}
