//! Planar walls: every block has a horizontal, a vertical and an angular unknown, so that it slides, opens and rocks.
//!
//! Main path: the engine lays the wall and finds its joints; [`assembly`] makes bodies and contact points of them;
//! [`motion`] shakes them, with the contact points of [`shape`], the contact solver of [`contact`] and the sparse matrix
//! of [`blocks`]; [`limit`] asks for the load under which they become a mechanism.

pub mod assembly;
pub mod blocks;
pub mod contact;
pub mod limit;
pub mod motion;
pub mod shape;
