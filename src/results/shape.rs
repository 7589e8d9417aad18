//! Beams as they lie in a state.

use serde::Serialize;

/// Stresses \[Pa\] in one layer of a beam's section, which is the whole section where that has no
/// others. Between the faces they are linear.
#[derive(Clone, Debug, Default, Serialize)]
pub struct LayerStress {
    /// On its face on the right, seen along the beam, at the arc lengths of the [`Shape`].
    pub bottom: Vec<f64>,
    /// On its face on the left.
    pub top: Vec<f64>,
}

/// The largest stress, by magnitude, along a beam.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestStress {
    /// The stress \[Pa\], positive in tension.
    pub value: f64,
    /// Name of the beam.
    pub beam: String,
    /// Arc length \[m\].
    pub s: f64,
    /// Number of the layer, from 1.
    pub layer: usize,
    /// `bottom` or `top`.
    pub face: &'static str,
}

impl Shape {
    /// The place \[m\] beside point number `point`, at a distance to the left of the beam \[m\].
    pub fn beside(&self, point: usize, distance: f64) -> [f64; 2] {
        let (sine, cosine) = self.angle[point].sin_cos();
        [self.x[point] - distance * sine, self.y[point] + distance * cosine]
    }

    /// Stresses \[Pa\] on the outer faces: those of the first layer's face on the right, and of the
    /// last layer's face on the left.
    pub fn face_stresses(&self) -> Option<[&[f64]; 2]> {
        Some([&self.stress.first()?.bottom, &self.stress.last()?.top])
    }

    /// The largest stress along the beam, where stresses are known.
    pub fn largest_stress(&self) -> Option<LargestStress> {
        let layers = self.stress.iter().zip(1..);
        let faces = layers
            .flat_map(|(layer, number)| [(number, "bottom", &layer.bottom), (number, "top", &layer.top)]);
        let all = faces.flat_map(|(layer, face, values)| {
            values.iter().zip(&self.s).map(move |(value, s)| (*value, *s, layer, face))
        });
        let (value, s, layer, face) = all.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
        Some(LargestStress { value, beam: self.beam.clone(), s, layer, face })
    }
}

/// The centrelines of all beams at one record.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Frame {
    /// Load factor or time.
    pub parameter: f64,
    /// Per beam: positions \[m\] at evenly spaced arc lengths.
    pub beams: Vec<Vec<[f64; 2]>>,
}

/// One beam sampled at 201 arc lengths or more. In the last state a point where a force or a couple
/// acts is there twice: before and behind it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Shape {
    /// Name of the beam.
    pub beam: String,
    /// Arc lengths \[m\].
    pub s: Vec<f64>,
    /// Positions along x \[m\].
    pub x: Vec<f64>,
    /// Positions along y \[m\].
    pub y: Vec<f64>,
    /// Direction of r' \[rad\], continuous along s.
    pub angle: Vec<f64>,
    /// ε, zero in the stress-free state.
    pub strain: Vec<f64>,
    /// κ \[1/m\].
    pub curvature: Vec<f64>,
    /// N \[N\], positive in tension; given for the last state alone, like Q and M. All three
    /// balance the forces that act on the beam before the cut.
    pub axial_force: Vec<f64>,
    /// Q \[N\], along the normal J r' on the side of the cut that looks to the beam's end.
    pub shear_force: Vec<f64>,
    /// M \[N m\], of the sign of EI κ.
    pub bending_moment: Vec<f64>,
    /// Stresses \[Pa\] in the layers of the section; empty where the scene does not tell its shape and
    /// its modulus, and given for the last state alone.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stress: Vec<LayerStress>,
    /// Distances of the outer faces from the centreline \[m\], to the right (negative) and to the left;
    /// empty where the scene does not tell the shape of the section.
    #[serde(skip)]
    pub faces: Vec<[f64; 2]>,
    /// The lines of the tendons that run beside it \[m\]; given for the last state alone.
    #[serde(skip)]
    pub tendons: Vec<Vec<[f64; 2]>>,
    /// Positions of the nodes \[m\].
    pub nodes: Vec<[f64; 2]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On the left of a beam that goes up is the side of smaller x.
    #[test]
    fn places_beside_a_beam_are_at_right_angles_to_it() {
        let (up, x, y) = (std::f64::consts::FRAC_PI_2, vec![7.0, 3.0, 1.0], vec![7.0, 4.0, 2.0]);
        let shape = Shape { angle: vec![0.3, up, 0.0], x, y, ..Shape::default() };
        for (point, distance, expected) in
            [(1, 0.5, [2.5, 4.0]), (1, -0.5, [3.5, 4.0]), (2, 0.5, [1.0, 2.5]), (2, -2.0, [1.0, 0.0])]
        {
            let [x, y] = shape.beside(point, distance);
            assert!((x - expected[0]).hypot(y - expected[1]) < 1e-15, "{x} {y} {expected:?}");
        }
        let slope = Shape { angle: vec![0.8_f64.atan2(0.6)], x: vec![1.0], y: vec![2.0], ..Shape::default() };
        let [x, y] = slope.beside(0, 10.0);
        assert!((x + 7.0).hypot(y - 8.0) < 1e-14, "{x} {y}");
    }

    #[test]
    fn the_largest_stress_is_found_in_any_layer_on_any_face() {
        let layer = |bottom: [f64; 2], top: [f64; 2]| LayerStress { bottom: bottom.into(), top: top.into() };
        let stress = vec![layer([1.0, -2.0], [3.0, 4.0]), layer([5.0, -9.0], [6.0, 8.0])];
        let shape = Shape { beam: "arm".into(), s: vec![0.0, 0.5], stress, ..Shape::default() };
        let largest = LargestStress { value: -9.0, beam: "arm".into(), s: 0.5, layer: 2, face: "bottom" };
        assert_eq!(shape.largest_stress(), Some(largest));
        assert_eq!(shape.face_stresses(), Some([&[1.0, -2.0][..], &[6.0, 8.0][..]]));
        assert_eq!((Shape::default().largest_stress(), Shape::default().face_stresses()), (None, None));
    }
}
