//! What must hold at every state: derivatives, invariances, exactness.

mod basis;
mod derivatives;
mod dynamics;
mod generators;
mod invariance;
mod linear;
mod scene;
mod supports;
