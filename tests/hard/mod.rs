//! What happens when it gets hard: branches, degenerate scenes, scales, numbers at the edge of
//! floating point, the end of the process or the disk.

mod branch;
mod degenerate;
mod floating;
mod jumps;
#[cfg(unix)]
mod killed;
mod motions;
mod scale;
mod soft;
mod turns;
