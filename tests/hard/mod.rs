//! What happens when it gets hard: branches, degenerate scenes, scales, numbers at the edge of floating point.

mod branch;
mod degenerate;
mod scale;
