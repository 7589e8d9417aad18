//! Planar flexible beams with large rotations and deformations, by two discretisations of the
//! absolute nodal coordinate formulation: the gradient-deficient **ANCF** cable element, and its
//! meshfree variant with Hermite radial point interpolation (**RPIM**; Chen, Zhang, Li, *J.
//! Vibration Engineering* 31(2), 2018, 245–254), which needs far fewer nodes for the same accuracy.
//!
//! Physics is given by densities at a point of the beam, and a discretisation by a table of shape
//! functions. The system sums the former over the latter, and every solver uses the system through
//! the same few functions.
//!
//! ```text
//! scene.toml ─parse─► Scene ─► Model ─build─► System ─solve─► Results ─► csv·json·vtu·svg·html
//!   text           checked,   continuous,   tables, effects,   states at
//!                  spans      SI            constraints        chosen loads, times
//! ```
//!
//! # A cantilever rolled up into a circle
//! ```
//! use ancf::effect::Moment;
//! use ancf::{Beam, Discretization, Model, Place, Probe, Section, Static, Support};
//!
//! let section = Section::new(1e4, 2.0);
//! let beam = Beam::line("cantilever", [0.0, 0.0], [1.0, 0.0], section, Discretization::rpim(12));
//! let (clamp, tip) = (Place::new(0, 0.0), Place::new(0, 1.0));
//! let mut model = Model {
//!     beams: vec![beam],
//!     supports: vec![Support::clamp(clamp)],
//!     probes: vec![Probe::new("tip", tip)],
//!     ..Model::default()
//! };
//! model.add(Moment::new(tip, std::f64::consts::TAU * 2.0));
//! let trajectory = model.solve(&Static::default())?;
//! let end = trajectory.probes[0].samples.last().expect("an equilibrium");
//! assert!(end.x.hypot(end.y) < 1e-4);
//! # Ok::<(), ancf::RunError>(())
//! ```
//! A scene file describes the same model as text: [`Scene::load`], then
//! `scene.model().solve(scene.analysis())`. [`Options`] add a starting state, an observer and
//! checkpoints.
//!
//! The [`handbook`] explains how to choose settings, what to do with difficult models, and all that
//! a scene can contain.
//!
//! # Where things are
//! | module | subject | imports |
//! |---|---|---|
//! | `lanes` | four numbers side by side, multiply–add | – |
//! | `threads` | loops over the nodes of long chains, on several threads | – |
//! | `linear` | block-banded LDLᵀ, real and complex, also with rows of neighbouring nodes; banded LU, also with constraint rows; bordered sparse LDLᵀ and LU; inertia | `lanes`, `threads` |
//! | `numeric` | Gauss' rules with few points, cubic splines, formulas, numbers in messages, places at which to look | – |
//! | [`centreline`] | stress-free curves | `numeric` |
//! | [`basis`] | shape functions of either discretisation, tabulated at points; extended precision | – |
//! | [`law`] | laws of time | `numeric` |
//! | [`beam`] | a beam with its section and discretisation, and places along it | [`centreline`], [`basis`] |
//! | [`assembly`] | densities, their sums over tables, and the assembly of a model's parts into terms of the equations | `lanes`, `threads`, `linear`, `numeric`, [`centreline`], [`basis`], [`law`], [`beam`] |
//! | [`effect`] | one file per physical effect: a density of a few local fields with its derivatives, and the part by which a model contains it | `lanes`, `linear`, `numeric`, [`basis`], [`law`], [`beam`], [`assembly`] |
//! | [`model`] | the continuous problem: beams, supports, joints, parts, probes, analyses | [`centreline`], [`basis`], [`law`], [`beam`], [`assembly`] |
//! | [`system`] | coordinates, supports, joints, sums over effects, inventory | `lanes`, `threads`, `linear`, `numeric`, [`centreline`], [`basis`], [`law`], [`assembly`], [`effect`], [`model`] |
//! | `solve` | Newton, path following, buckling, vibrations, motion | `lanes`, `threads`, `linear`, [`assembly`], `numeric`, [`model`], [`system`] |
//! | [`restart`] | a saved state from which another analysis can go on | [`assembly`], [`model`], [`system`], `solve` |
//! | [`results`] | the results of an analysis | [`system`], `solve`, [`restart`] |
//! | [`run`](mod@run) | one model, one analysis; or several one after the other | `linear`, `numeric`, [`centreline`], [`basis`], [`law`], [`assembly`], [`effect`], [`model`], [`system`], `solve`, [`restart`], [`results`] |
//! | [`output`] | files, plots, the report page | [`model`], [`restart`], [`results`] |
//! | [`scene`] | text → checked description: units, rules, messages with line and column, JSON schema | [`centreline`], [`assembly`], [`effect`], [`model`] |
//! | [`accuracy`] | everything that a scene leaves open chosen for an accuracy, and the errors of results | `numeric`, [`centreline`], [`basis`], [`effect`], [`model`], [`results`], [`restart`], [`run`](mod@run), [`scene`] |
//! | [`sweep`] | many runs of a scene over a grid of values: threads, journals, one table | [`basis`], [`scene`], [`run`](mod@run), [`output`], [`accuracy`] |
//! | [`cost`] | computing time for a given accuracy: settings of all kinds compared with a reference | [`centreline`], [`model`], [`results`], [`scene`], [`run`](mod@run), [`output`], [`accuracy`] |
//! | `cli` | the program's commands: arguments, progress, messages | [`model`], [`results`], [`restart`], [`run`](mod@run), [`output`], [`scene`], [`accuracy`], [`sweep`], [`cost`] |
//!
//! `lanes`, `linear`, `solve` and `cli` are internal to the crate and may change with any version;
//! everything a user needs from them is available through other modules. A module imports only
//! modules above it in the table, and only those in its row; a test compares the table with all
//! sources.
//!
//! # Without the program
//! The features `cli` and `report`, both enabled by default, provide the program `ancf` and its
//! plots and pages. A program that only solves and reads numbers can use
//! `ancf = { …, default-features = false }`; statics, motions, sweeps and tables need neither
//! feature.
//!
//! # The beam
//! | symbol | formula | unit |
//! |---|---|---|
//! | r(s), s ∈ [0, L] | centreline over the reference arc length | m |
//! | ε, Green | ½ (r'·r' − 1) | – |
//! | ε, engineering | \|r'\| − 1 | – |
//! | κ | (r' × r'')/\|r'\|² | 1/m |
//! | U | ½∫ EA (ε − ε₀)² ds + ½∫ EI (κ − κ₀)² ds + ∫ EB (ε − ε₀)(κ − κ₀) ds | J |
//! | EB | −∫ E y dA, where the centreline is not the neutral line ([`beam::Section`]) | N m |
//! | R | dissipation function: forces ∂R/∂q̇ | W |
//! | T | ½∫ ρA ṙ·ṙ ds | J |
//! | M on the section at s | δW = M δθ, θ = atan2(y', x') | N m |
//! | q | nodal coordinates \[x, y, x', y'\] | m, – |
//! | N, Q, M | axial force, shear force and bending moment, from the balance of one side of a cut ([`system::Balanced`]) | N, N, N m |
//! | λ | load factor: loads and prescribed displacements grow with it from 0 to 1 | – |
//!
//! There is no shear deformation, and rotary inertia only if it is named. ε₀ and κ₀ are those of
//! the stress-free shape as the discretisation interpolates it, so that a curved beam starts
//! without stress.
//!
//! # Invariants
//! - `scene` never imports `system`.
//! - An effect does not know nodes, step sizes or other effects.
//! - No solver matches on a discretisation or on an effect.
//! - Shape functions are evaluated only while a system is built or a state is examined.
//! - Only the command line prints. Only [`sweep`] and [`cost`] start threads, and they compute each
//!   run on a single thread. The crate does not link Python.
//! - For an effect that a model does not name, the system contains no object, table or matrix and
//!   executes no instruction; [`system::System::inventory`] lists what was built.
//!
//! # Parts and their names in a scene
//! | scene | part | formula |
//! |---|---|---|
//! | `[[joint]]` `hinge`, `weld`, `slider` | [`system::joint`] | constraint rows between two points |
//! | `move` of a `[[support]]`, `in_time` of a load | [`law::Law`] | ramps, steps, sines, polynomials, tables, spin-up, their sums and products |
//! | `section` of a beam, `table`, `polynomial`, `pieces` of its properties | [`beam::Section`], [`beam::Along`] | EA(s), EI(s), EB(s), ρA(s), ρI(s) |
//! | `[[effect.damping]]` | [`effect::BeamDamping`] | −α ρA ṙ; EA (ε + η ε̇), EI (κ + η κ̇) |
//! | `[[effect.spring]]`, `[[effect.torsion_spring]]` | [`effect::Spring`], [`effect::TorsionSpring`] | ½ k (ℓ − ℓ₀)², ½ k (θ − θ₀)², dashpots beside them |
//! | `[[effect.point_mass]]`, `[[effect.rotary_inertia]]` | [`effect::PointMass`], [`effect::SectionInertia`] | ½ m ṙ·ṙ + ½ J θ̇² |
//! | `[[effect.foundation]]` | [`effect::Foundation`] | ½ ∫ k u² ds |
//! | `[[effect.actuation]]` | [`effect::Actuation`] | ½ EA (ε − ε₀)², ½ EI (κ − κ₀)² |
//! | `[[effect.tendon]]` | [`effect::Tendon`] | T ∫ \|p'\| ds, p = r + e n |
//! | `[[effect.drag]]`, `[[effect.buoyancy]]` | [`effect::Drag`], [`effect::Buoyancy`] | −(c + C \|u\|) u along and across; −m g |
//! | `[[effect.force_field]]` | [`effect::ForceField`] | U(x, y, t), or F(x, y, t) by itself |
//! | `[[effect.moving_force]]` | [`effect::MovingForce`] | −N(s₀ + v t) F |
//! | `[[effect.contact]]` | [`effect::Contact`] | ½ ∫ k ⟨−g⟩² ds with circles, half-planes, boxes; friction ½ ∫ k_t e² ds, k_t \|e\| ≤ μ p |
//!
//! A beam without a bending stiffness is a string: its curvature is not computed. A beam without an
//! axial stiffness keeps its length ([`system::inextensible`]): ∫ N ½ (r'·r' − |r'₀|²) ds with the
//! axial force N as an unknown.
//!
//! # An effect of one's own
//! Everything that acts is a [`Part`](assembly::Part) of the model: a beam's own elasticity and
//! inertia, a load, a spring, a contact. It consists of densities of a few local fields, and
//! defines where they are summed. In this crate an effect is one file in `src/effect` and one line
//! in the scene's list (`src/scene/to_parts.rs`); in another crate it looks like this:
//! ```
//! use ancf::Place;
//! use ancf::assembly::{Assembly, BuildError, Density, Extent, Gradient, Hessian, Kind, Part};
//! use nalgebra::{Matrix2, Vector2};
//!
//! /// W = ½ k y²: a point is pulled towards the x axis.
//! struct Pull(f64);
//!
//! impl Density<1> for Pull {
//!     const ORDERS: [usize; 1] = [0];
//!     fn energy(&self, _: usize, [r]: &Gradient<1>) -> f64 {
//!         0.5 * self.0 * r.y * r.y
//!     }
//!     fn gradient(&self, _: usize, [r]: &Gradient<1>) -> Gradient<1> {
//!         [Vector2::new(0.0, self.0 * r.y)]
//!     }
//!     fn gradient_and_hessian(&self, i: usize, z: &Gradient<1>, _: &Gradient<1>, _: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
//!         (self.gradient(i, z), [[Matrix2::new(0.0, 0.0, 0.0, self.0)]])
//!     }
//! }
//!
//! #[derive(Debug)]
//! struct Rail {
//!     at: Place,
//!     stiffness: f64,
//! }
//!
//! impl Part for Rail {
//!     fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
//!         assembly.elastic(Kind::Other("rail"), Extent::Point(self.at), |_| Pull(self.stiffness))
//!     }
//! }
//!
//! // A cantilever of unit length and stiffness whose tip is pulled back while a small force pushes it away.
//! let scene = ancf::scene::parse("rail.toml", r#"
//!     beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1.0, basis.ancf.elements = 2 }
//!     support = [{ beam = "arm", at = "start", fix = ["x", "y", "angle"] }]
//!     effect.force = [{ beam = "arm", at = "end", value = [0, 1e-4] }]
//!     probe = [{ name = "tip", beam = "arm", at = "end" }]
//!     analysis.static = {}
//! "#)?;
//! let mut model = scene.model().clone();
//! model.add(Rail { at: Place { beam: 0, s: 1.0 }, stiffness: 7.0 });
//! let results = model.solve(scene.analysis())?;
//! let tip = results.states().probes[0].samples.last().expect("an equilibrium");
//! assert!((tip.y - 1e-4 / (3.0 + 7.0)).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![warn(missing_docs)]

/// Runs the code blocks of README.md as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub mod accuracy;
pub mod assembly;
pub mod basis;
pub mod beam;
pub mod centreline;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
pub mod cost;
pub mod effect;
pub mod handbook;
#[doc(hidden)]
pub mod lanes;
pub mod law;
#[doc(hidden)]
pub mod linear;
pub mod model;
mod numeric;
pub mod output;
pub mod restart;
pub mod results;
pub mod run;
pub mod scene;
#[doc(hidden)]
pub mod solve;
pub mod sweep;
pub mod system;
mod threads;

pub use model::{
    About, Analysis, Beam, Buckling, Centreline, Discretization, Dynamic, Fixed, GaussPoints, Integrator,
    Joint, Law, Modal, Model, Place, Probe, Section, Static, StepControl, StrainMeasure, Support,
};
pub use results::{CriticalLoads, Results, Trajectory, Vibrations};
pub use run::{Control, Options, RunError, Solve};
pub use scene::{Scene, SceneError};
