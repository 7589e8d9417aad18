//! The series of files for ParaView: `states.pvd` names one `vtu/state_….vtu` per frame, `modes.pvd`
//! one `vtu/mode_….vtu` per mode, each an unstructured grid with one polyline a beam, in the XML
//! formats of the Visualization Toolkit (ASCII data, f64 to the last bit).

use std::fmt::Write as _;

use super::tables::{frame_arc_lengths, section_columns};
use crate::results::{BeamSections, ModeShape, Shape, Trajectory};

/// Type number of a polyline in the format.
const POLY_LINE: u8 = 4;

/// One field given at the points.
struct PointData {
    name: &'static str,
    components: usize,
    values: Vec<f64>,
}

/// The file of a frame, relative to the directory of the results.
pub(super) fn frame_name(index: usize) -> String {
    format!("vtu/state_{index:05}.vtu")
}

/// The file of a mode, counted from 0, relative to the directory of the results; its number counts from 1.
pub(super) fn mode_name(index: usize) -> String {
    format!("vtu/mode_{:05}.vtu", index + 1)
}

/// The files of all frames, if there are any, and of the last state: name relative to the directory of the
/// results, text.
pub(super) fn states(t: &Trajectory) -> Vec<(String, String)> {
    let mut files = Vec::with_capacity(t.frames.len() + 2);
    for (i, frame) in t.frames.iter().enumerate() {
        let mut s = PointData { name: "arc length [m]", components: 1, values: Vec::new() };
        let mut displacement = PointData { name: "displacement [m]", components: 3, values: Vec::new() };
        for (beam, points) in frame.beams.iter().enumerate() {
            let arc = frame_arc_lengths(t, frame, beam);
            if let Some(rest) = t.run.undeformed.get(beam) {
                for (s, [x, y]) in arc.iter().zip(points) {
                    let [x0, y0] = position(rest, *s);
                    displacement.values.extend([x - x0, y - y0, 0.0]);
                }
            }
            s.values.extend(arc);
        }
        let mut fields = vec![s, displacement];
        fields.extend(t.along.get(i).into_iter().flat_map(|beams| sections(beams)));
        files.push((frame_name(i), grid(&frame.beams, &fields)));
    }
    if !files.is_empty() {
        let index = index(t.frames.iter().map(|frame| frame.parameter).zip(&files));
        files.push(("states.pvd".into(), index));
    }
    files.push(("vtu/last.vtu".into(), last(&t.last)));
    files
}

/// The files of all modes, if there are any, on the beams of the state that vibrates or buckles; in the index they are
/// told apart by their numbers.
pub(super) fn modes(state: &[Shape], modes: &[&[ModeShape]]) -> Vec<(String, String)> {
    let beams = lines(state);
    let mut files = Vec::with_capacity(modes.len() + 1);
    for (i, mode) in modes.iter().enumerate() {
        let field = |name, values: fn(&ModeShape) -> &Vec<f64>| PointData {
            name,
            components: 1,
            values: mode.iter().flat_map(|beam| values(beam).iter().copied()).collect(),
        };
        let of_beam = |beam: &ModeShape| {
            beam.x.iter().zip(&beam.y).flat_map(|(&x, &y)| [x, y, 0.0]).collect::<Vec<_>>()
        };
        let displacement = PointData {
            name: "displacement [m]",
            components: 3,
            values: mode.iter().flat_map(of_beam).collect(),
        };
        let fields = [
            field("arc length [m]", |beam| &beam.s),
            displacement,
            field("rotation [rad]", |beam| &beam.angle),
            field("axial strain", |beam| &beam.strain),
            field("curvature [1/m]", |beam| &beam.curvature),
        ];
        files.push((mode_name(i), grid(&beams, &fields)));
    }
    if !files.is_empty() {
        let index = index((1..).map(f64::from).zip(&files));
        files.push(("modes.pvd".into(), index));
    }
    files
}

/// The file that names those of a series, each with its time, load factor or number.
fn index<'f>(files: impl Iterator<Item = (f64, &'f (String, String))>) -> String {
    let mut index = String::from(concat!(
        "<?xml version=\"1.0\"?>\n",
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n"
    ));
    for (at, (name, _)) in files {
        // Writing to a string cannot fail.
        let _ = writeln!(index, "<DataSet timestep=\"{at:e}\" part=\"0\" file=\"{name}\"/>");
    }
    index.push_str("</Collection>\n</VTKFile>\n");
    index
}

/// The centrelines of these beams.
fn lines(shapes: &[Shape]) -> Vec<Vec<[f64; 2]>> {
    shapes.iter().map(|beam| beam.x.iter().zip(&beam.y).map(|(&x, &y)| [x, y]).collect()).collect()
}

/// What the sections of all beams carry, field by field; those that some beam does not know are left
/// out by [`grid`].
fn sections(beams: &[BeamSections]) -> Vec<PointData> {
    let mut fields: Vec<PointData> = Vec::new();
    for (_, name, values) in beams.iter().flat_map(section_columns) {
        match fields.iter_mut().find(|field| field.name == name) {
            Some(field) => field.values.extend(values),
            None => fields.push(PointData { name, components: 1, values }),
        }
    }
    fields
}

/// The last state with everything that is known along the beams.
fn last(shapes: &[Shape]) -> String {
    let field = |name, values: fn(&Shape) -> &Vec<f64>| PointData {
        name,
        components: 1,
        values: shapes.iter().flat_map(|shape| values(shape).iter().copied()).collect(),
    };
    let mut fields = vec![
        field("arc length [m]", |b| &b.s),
        field("angle [rad]", |b| &b.angle),
        field("axial strain", |b| &b.strain),
        field("curvature [1/m]", |b| &b.curvature),
        field("axial force [N]", |b| &b.axial_force),
        field("shear force [N]", |b| &b.shear_force),
        field("bending moment [N m]", |b| &b.bending_moment),
    ];
    for (name, face) in [("stress bottom [Pa]", 0), ("stress top [Pa]", 1)] {
        // Known of all beams or left out: VTK reads no text for "not a number".
        let of_beams: Option<Vec<&[f64]>> =
            shapes.iter().map(|shape| shape.face_stresses().map(|faces| faces[face])).collect();
        if let Some(values) = of_beams {
            fields.push(PointData { name, components: 1, values: values.concat() });
        }
    }
    grid(&lines(shapes), &fields)
}

/// The position of `shape` at arc length `s`, linear between its samples.
fn position(shape: &Shape, s: f64) -> [f64; 2] {
    let at =
        |i: usize| [shape.x.get(i).copied().unwrap_or(f64::NAN), shape.y.get(i).copied().unwrap_or(f64::NAN)];
    let after = shape.s.partition_point(|&t| t < s).min(shape.s.len().saturating_sub(1));
    let before = after.saturating_sub(1);
    let (Some(&s0), Some(&s1)) = (shape.s.get(before), shape.s.get(after)) else { return [f64::NAN; 2] };
    let part = if s1 > s0 { ((s - s0) / (s1 - s0)).clamp(0.0, 1.0) } else { 0.0 };
    let ([x0, y0], [x1, y1]) = (at(before), at(after));
    // Not x0 + part (x1 − x0): at a sample the sample itself must come out.
    [(1.0 - part) * x0 + part * x1, (1.0 - part) * y0 + part * y1]
}

fn grid(beams: &[Vec<[f64; 2]>], fields: &[PointData]) -> String {
    let points: usize = beams.iter().map(Vec::len).sum();
    let mut text = String::new();
    let _ = writeln!(
        text,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{}\">",
        beams.len()
    );
    text.push_str("<Points>\n");
    let positions: Vec<f64> = beams.iter().flatten().flat_map(|&[x, y]| [x, y, 0.0]).collect();
    array(&mut text, "Float64", "position [m]", 3, positions.iter().map(|v| format!("{v:e}")));
    text.push_str("</Points>\n<Cells>\n");
    let mut end = 0;
    let offsets: Vec<usize> = beams
        .iter()
        .map(|beam| {
            end += beam.len();
            end
        })
        .collect();
    array(&mut text, "Int64", "connectivity", 1, (0..points).map(|i| i.to_string()));
    array(&mut text, "Int64", "offsets", 1, offsets.iter().map(usize::to_string));
    array(&mut text, "UInt8", "types", 1, beams.iter().map(|_| POLY_LINE.to_string()));
    text.push_str("</Cells>\n<PointData>\n");
    // A field that does not cover every point would make the file unreadable.
    for field in fields.iter().filter(|f| f.values.len() == points * f.components) {
        array(
            &mut text,
            "Float64",
            field.name,
            field.components,
            field.values.iter().map(|v| format!("{v:e}")),
        );
    }
    text.push_str("</PointData>\n<CellData>\n");
    array(&mut text, "Int64", "beam", 1, (0..beams.len()).map(|i| i.to_string()));
    text.push_str("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    text
}

fn array(text: &mut String, kind: &str, name: &str, components: usize, values: impl Iterator<Item = String>) {
    let _ = write!(
        text,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for (i, value) in values.enumerate() {
        text.push(if i % components == 0 { '\n' } else { ' ' });
        text.push_str(&value);
    }
    text.push_str("\n</DataArray>\n");
}
