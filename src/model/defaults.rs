//! Default settings, for every way of making a model, with the measurements by which they were
//! chosen.

use super::{
    Beam, Centreline, Discretization, GaussPoints, Kernel, Nodes, Section, SideCondition, StepControl,
    StrainMeasure,
};

/// Default quadrature of ANCF elements: three Lobatto points for stretching, of which neighbours
/// share those at the nodes, and two Gauss points for bending.
///
/// The table lists the error of the tip's position, per length, at EA L²/EI = 6e5, for the beam of
/// [`RPIM_KERNEL`]'s table; and the limit load of the deep arch at 1e8 (exact: 8.973), computed by
/// `ancf run verification/cases/deep-arch/scene.toml --set beam.arch.axial_stiffness=7.1e6 --set
/// 'beam.arch.basis={ ancf = { elements = 20 } }'`:
///
/// | stretch/bend | M = πEI/L, n = 6 | 10 | 20 | dead load PL²/EI = 10, n = 6 | 10 | 20 | deep arch, n = 20 | 40 |
/// |---|---|---|---|---|---|---|---|---|
/// | Gauss 5/3, exact for Green's strain | 1e-3 | 6e-5 | 3e-6 | 5e-3 | 1e-3 | 7e-5 | 10.29 | 9.02 |
/// | Gauss 4/2 | 8e-4 | 1e-4 | 6e-6 | 5e-3 | 1e-3 | 8e-5 | 9.28 | |
/// | **Lobatto 3, Gauss 2** | 7e-4 | 1e-4 | 6e-6 | 6e-4 | 9e-5 | 6e-6 | 9.02 | 8.98 |
pub const ANCF_GAUSS_POINTS: GaussPoints = GaussPoints { stretch: 3, bend: 2, lobatto: true };
/// Default quadrature of ANCF elements of a string, or of a beam that keeps its length. Neither of
/// them locks, so more points do no harm: only its stretch keeps a cell of a string from folding,
/// and a third point for bending makes the error of an inextensible beam four times smaller.
pub const STRING_GAUSS_POINTS: GaussPoints = GaussPoints { stretch: 5, bend: 3, lobatto: false };
/// Default radial function of RPIM.
///
/// The table lists the error of the tip's position, per length, of a cantilever at EA L²/EI = 6e5
/// with uniform nodes; unless the row says otherwise, q = 1.03, m = 2, two neighbours, and four
/// Gauss points per cell. `ancf cost SCENE` makes such a table for any scene:
///
/// | shape, sign | M = πEI/L, n = 6 | 10 | 20 | dead load PL²/EI = 10, n = 6 | 10 | 20 |
/// |---|---|---|---|---|---|---|
/// | 3.3, + | 1e-6 | 2e-6 | 4e-7 | 7e-5 | 8e-6 | 9e-7 |
/// | **5, +** | 7e-7 | 2e-8 | 4e-9 | 6e-6 | 4e-7 | 3e-8 |
/// | 6, − | 1e-7 | 1e-8 | 2e-9 | 6e-6 | 1e-7 | 7e-9 |
/// | 10, + | 1e-9 | 2e-10 | 2e-11 | 1e-5 | 5e-8 | 2e-10 |
/// | one neighbour | 2e-6 | 2e-7 | 1e-7 | 1e-4 | 9e-6 | 5e-7 |
/// | three | 1e-8 | 1e-9 | 1e-9 | 6e-6 | 4e-8 | 3e-9 |
/// | m = 4 | 5e-8 | 1e-9 | 5e-10 | 8e-6 | 2e-8 | 3e-10 |
/// | Gauss 3/3 (stretch/bend) | 3e-6 | 4e-7 | 2e-7 | 2e-5 | 4e-7 | 6e-7 |
/// | Gauss 3/4 | 2e-7 | 6e-9 | 5e-9 | 6e-6 | 9e-8 | 8e-9 |
/// | Gauss 5/5, 8/8 | 2e-6 | 4e-8 | 8e-9 | 1e-5 | 4e-7 | 3e-8 |
///
/// Flatter functions are more accurate in statics, but not in motion: with 14 nodes, the error of
/// the curvature at shape 20 is twice that at 3.3. Besides, up to a shape of about 6 the moment
/// matrices can be solved in double-double arithmetic, ten times faster than beyond.
pub const RPIM_KERNEL: Kernel = Kernel::Multiquadric { q: 1.03, shape: 5.0 };
/// Default number of polynomial terms of RPIM.
pub const RPIM_POLYNOMIAL_TERMS: usize = 2;
/// Default side condition of RPIM.
pub const RPIM_SIDE_CONDITION: SideCondition = SideCondition::Plus;
/// Default number of neighbours on each side of a cell in a support of RPIM.
pub const RPIM_NEIGHBOURS: usize = 2;
/// Default number of Gauss points of RPIM cells; alternatives are compared in the table of
/// [`RPIM_KERNEL`].
pub const RPIM_GAUSS_POINTS: GaussPoints = GaussPoints { stretch: 4, bend: 4, lobatto: false };

/// Default accuracy of a motion.
pub const STEP_CONTROL: StepControl = StepControl::Tolerance(1e-6);
/// Default spectral radius of the generalised-α method.
pub const SPECTRAL_RADIUS: f64 = 0.9;

impl Discretization {
    /// Evenly spaced cable elements.
    pub fn ancf(elements: usize) -> Self {
        Self::Ancf { nodes: Nodes::Uniform(elements + 1) }
    }

    /// Radial point interpolation over evenly spaced nodes.
    pub fn rpim(nodes: usize) -> Self {
        Self::Rpim {
            nodes: Nodes::Uniform(nodes),
            kernel: RPIM_KERNEL,
            polynomial_terms: RPIM_POLYNOMIAL_TERMS,
            side_condition: RPIM_SIDE_CONDITION,
            neighbours: RPIM_NEIGHBOURS,
        }
    }
}

impl GaussPoints {
    /// The default quadrature of a discretisation for a beam with such a section.
    pub fn usual(discretization: &Discretization, section: &Section) -> Self {
        let locks = section.axial_stiffness.is_some() && section.bending_stiffness.is_some();
        match discretization {
            Discretization::Rpim { .. } => RPIM_GAUSS_POINTS,
            Discretization::Ancf { .. } | Discretization::Open if locks => ANCF_GAUSS_POINTS,
            Discretization::Ancf { .. } | Discretization::Open => STRING_GAUSS_POINTS,
        }
    }
}

impl Beam {
    /// A beam along `centreline` with the default strain measure and quadrature.
    pub fn new(name: &str, centreline: Centreline, section: Section, discretization: Discretization) -> Self {
        let gauss_points = GaussPoints::usual(&discretization, &section);
        let strain = StrainMeasure::default();
        Self { name: name.to_owned(), centreline, section, strain, discretization, gauss_points }
    }

    /// A straight beam from `start` to `end` \[m\].
    pub fn line(
        name: &str,
        start: [f64; 2],
        end: [f64; 2],
        section: Section,
        discretization: Discretization,
    ) -> Self {
        Self::new(name, Centreline::Line { start, end }, section, discretization)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Membrane locking is of elements with both stiffnesses.
    #[test]
    fn only_beams_that_may_lock_have_fewer_points() {
        let full = Section::new(1.0, 1.0);
        let string = Section { bending_stiffness: None, ..full.clone() };
        let rod = Section { axial_stiffness: None, ..full.clone() };
        let ancf = Discretization::ancf(3);
        let usual = |section: &Section| GaussPoints::usual(&ancf, section);
        let [few, many] = [ANCF_GAUSS_POINTS, STRING_GAUSS_POINTS];
        assert_eq!([usual(&full), usual(&string), usual(&rod)], [few, many, many]);
        let open = [&full, &string].map(|section| GaussPoints::usual(&Discretization::Open, section));
        assert_eq!(open, [few, many]);
        let meshfree = Discretization::rpim(7);
        let found = [&full, &string].map(|section| GaussPoints::usual(&meshfree, section));
        assert_eq!(found, [RPIM_GAUSS_POINTS; 2]);
        assert_eq!((ancf.nodes().count(), meshfree.nodes().count()), (4, 7));
    }
}
