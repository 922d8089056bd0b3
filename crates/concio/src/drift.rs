//! Where the tops of a wall are whose drifts a run tells; how far they go is in `concio_law`.

use concio_law::drift::Top;
pub use concio_law::drift::{BEAM, DriftRow, Tops, settles};

use crate::wall::{End, Joint, Wall};

/// Of a wall whose top beam, if it moves, has the place `beam` among displacements.
pub fn tops(wall: &Wall, joints: &[Joint], beam: Option<usize>) -> Tops {
    let (mut courses, mut tops) = (Vec::new(), Vec::new());
    let mut panels: Vec<Top> = wall.panels.iter().map(|p| Top { name: p.name.clone(), ..Top::default() }).collect();
    for (i, block) in wall.blocks.iter().enumerate() {
        if block.course + 1 == wall.panels[block.panel].courses {
            let top = &mut panels[block.panel];
            courses.push(i as u32);
            top.unknowns.push(i as u32);
            top.height += block.centre()[1];
        }
    }
    panels.iter_mut().for_each(|top| top.height /= top.unknowns.len().max(1) as f64);
    let under: Vec<usize> = joints.iter().filter(|j| j.b == End::Top).map(|j| wall.blocks[j.a].panel).collect();
    let Some(beam) = beam.filter(|_| !under.is_empty()) else {
        return Tops::new(courses.clone(), courses, panels);
    };
    let height = wall.blocks.iter().filter(|b| under.contains(&b.panel)).map(|b| b.y[1]).fold(0.0, f64::max);
    tops.push(Top { name: BEAM.into(), unknowns: vec![beam as u32], height });
    tops.extend(panels.into_iter().enumerate().filter(|(k, _)| !under.contains(k)).map(|(_, top)| top));
    Tops::new(courses, vec![beam as u32], tops)
}
