//! Other codes, asked about the very scenes that ours solves.
//!
//! [`describe`](mod@describe) says a scene in plain words; `verification/peers/exudyn_scene.py`
//! says these to Exudyn, whose ANCFCable2D is the element of our ANCF with engineering strain: same
//! coordinates, same strain and curvature, same Gauss points. Where mesh, Gauss points and (in
//! dynamics) method and step are the same, so are the numbers. `scikit_fem_scene.py` makes of the
//! same words the linear beam, which ours becomes as deflections become small.

pub mod describe;
mod table;

use std::path::PathBuf;

use ancf::scene::Scene;
use ancf_check::Suite;
use ancf_check::case::Peer;
use serde::Deserialize;

use crate::Failure;
use crate::bridge::Script;

pub use table::{scenes, table};

/// The results of a peer.
#[derive(Clone, Debug, Deserialize)]
pub struct Answer {
    /// Load factors or times \[s\] of the records; empty in a modal analysis.
    pub parameter: Vec<f64>,
    /// Per probe of the scene its places.
    pub probes: Vec<Track>,
    /// Per record, computed from the coordinates; none from scikit-fem.
    pub energy: Vec<Energy>,
    /// Per beam and node of the last record: \[x, y, x', y'\]; none from scikit-fem.
    pub nodes: Vec<Vec<[f64; 4]>>,
    /// Natural frequencies \[Hz\], ascending.
    pub frequencies: Vec<f64>,
}

/// The places of a probe, one per record.
#[derive(Clone, Debug, Deserialize)]
pub struct Track {
    /// Name of the probe.
    pub name: String,
    /// Positions along x \[m\].
    pub x: Vec<f64>,
    /// Positions along y \[m\].
    pub y: Vec<f64>,
}

/// Energies \[J\].
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Energy {
    /// ½∫ EA ε² ds.
    pub stretch: f64,
    /// ½∫ EI κ² ds.
    pub bend: f64,
    /// ½∫ ρA ṙ·ṙ ds; 0 in statics.
    pub kinetic: f64,
    /// −∫ ρA g·(r − r₀) ds.
    pub weight: f64,
}

/// A peer's name for the reader, its package, and its script.
fn about(peer: Peer) -> (&'static str, &'static str, &'static Script) {
    static EXUDYN: Script = Script::new("exudyn_scene");
    static SCIKIT_FEM: Script = Script::new("scikit_fem_scene");
    match peer {
        Peer::Exudyn => ("Exudyn", "exudyn", &EXUDYN),
        Peer::ScikitFem => ("scikit-fem", "scikit-fem", &SCIKIT_FEM),
    }
}

/// The answer of a peer to a scene.
///
/// # Errors
/// What of the scene has no counterpart, a Python that cannot be had, and what the peer raises.
pub fn ask(peer: Peer, scene: &Scene) -> Result<Answer, Failure> {
    let (name, _, script) = about(peer);
    let description = describe::describe(scene.model(), scene.analysis())
        .map_err(|message| format!("{}: {name} has {message}", scene.name()))?;
    script.ask(&description).map_err(|error| format!("{}: {name}: {error}", scene.name()).into())
}

/// The script that tells a peer about scenes.
pub fn script(suite: &Suite, peer: Peer) -> PathBuf {
    about(peer).2.path(suite)
}

/// The Python package that a peer is.
pub fn package(peer: Peer) -> &'static str {
    about(peer).1
}
