//! Outlines of the blocks as files hold them: the corners of all blocks one after the other, and where those of each begin.

use crate::error::Result;
use crate::polygon;
use crate::store::h5::Source;
use crate::wall::{Block, Shape};

/// Where the corners of a block begin in [`CORNERS`]; one entry more than blocks.
pub(super) const START: &str = "wall/blocks/corner_start";
/// Corners, x and y.
pub(super) const CORNERS: &str = "wall/blocks/corners";
/// Courses that a block takes up.
pub(super) const SPAN: &str = "wall/blocks/span";

/// Part of a block's size by which its corners may miss its edges: panels that stand in series are moved in other ways.
const ROUGH: f64 = 1e-9;

/// The outlines of some blocks.
pub(super) struct Outlines {
    /// Index of the first corner of each block, and at the end the number of corners.
    pub start: Vec<usize>,
    /// Corners [m], counterclockwise, of rectangles from the bottom left.
    pub corners: Vec<[f64; 2]>,
    /// Centres of gravity [m].
    pub centres: Vec<[f64; 2]>,
}

impl Outlines {
    pub fn of(blocks: &[Block]) -> Self {
        let mut found = Outlines { start: vec![0], corners: Vec::new(), centres: Vec::new() };
        for block in blocks {
            found.corners.extend(block.corners());
            found.start.push(found.corners.len());
            found.centres.push(block.centre());
        }
        found
    }

    /// [`START`] as it is stored.
    pub fn starts(&self) -> Vec<i64> {
        self.start.iter().map(|&k| k as i64).collect()
    }

    /// Block by block its centre [m] and the numbers of its corners.
    pub fn each(&self) -> impl Iterator<Item = ([f64; 2], std::ops::Range<usize>)> + '_ {
        self.start.windows(2).map(|w| w[0]..w[1]).zip(&self.centres).map(|(corners, centre)| (*centre, corners))
    }
}

/// Gives blocks, whose edges are known, the shapes that a file holds. Files of before there were shapes hold rectangles.
pub(super) fn read(source: &Source, blocks: &mut [Block]) -> Result<()> {
    if !source.has(START) {
        return Ok(());
    }
    let start: Vec<i64> = source.list(START, blocks.len() + 1)?;
    let values: Vec<f64> = source.array(CORNERS, &[None, Some(2)])?;
    let span: Vec<i64> = source.list(SPAN, blocks.len())?;
    let corners = values.as_chunks::<2>().0;
    for (i, block) in blocks.iter_mut().enumerate() {
        let wrong = |name: &str, what: String| source.wrong(name, format!("{what} of block {i}"));
        let range = || Some(usize::try_from(start[i]).ok()?..usize::try_from(start[i + 1]).ok()?);
        let of_block = range().and_then(|range| corners.get(range)).filter(|c| c.len() >= 3);
        let Some(of_block) = of_block else {
            return Err(wrong(START, "does not name three corners or more".into()));
        };
        let agree = |found: f64, edge: f64| (found - edge).abs() <= ROUGH * (block.length() + block.height());
        let edges = polygon::bounds(of_block).into_iter().flatten().zip(block.x.into_iter().chain(block.y));
        let finite = of_block.iter().flatten().all(|v| v.is_finite());
        if !finite || !edges.into_iter().all(|(found, edge)| agree(found, edge)) {
            return Err(wrong(CORNERS, "does not agree with the edges".into()));
        }
        let span = usize::try_from(span[i]).ok().filter(|s| *s >= 1);
        let Some(span) = span else { return Err(wrong(SPAN, "is below 1".into())) };
        block.shape = Shape::of(span, of_block.to_vec(), block.x, block.y);
    }
    Ok(())
}
