//! The comma-separated files. Numbers have 17 significant digits, so that reading them back gives
//! the same bits.

use std::borrow::Cow;
use std::io::{self, Write};

use crate::results::{
    AnalysisKind, BeamSections, Frame, ModeShape, ProbeErrors, ProbeSample, SectionForces, Trajectory,
};

/// Name of the first column, by which the records are ordered.
pub(super) fn parameter_name(analysis: AnalysisKind) -> &'static str {
    match analysis {
        // Vibrations have one record, the equilibrium about which they are small.
        AnalysisKind::Static | AnalysisKind::Modal => "load",
        AnalysisKind::Dynamic => "time",
        AnalysisKind::Buckling => "mode",
    }
}

/// 17 significant digits.
pub(crate) fn exact(value: f64) -> String {
    format!("{value:.16e}")
}

/// A text as a cell of a table. A text that a spreadsheet would take for a formula has an
/// apostrophe before it, which makes it text there. Numbers are as they are.
pub(crate) fn cell(text: &str) -> Cow<'_, str> {
    let signed = text.starts_with(['+', '-']) && text.parse::<f64>().is_err();
    if signed || text.starts_with(['=', '@', '\t', '\r']) { format!("'{text}").into() } else { text.into() }
}

/// The text of a cell that [`cell`] made.
pub(crate) fn text_of_cell(cell: &str) -> &str {
    let text = cell.strip_prefix('\'').filter(|text| text.starts_with(['+', '-', '=', '@', '\t', '\r']));
    text.filter(|text| !text.ends_with('\'')).unwrap_or(cell)
}

struct CsvTable<'a>(csv::Writer<&'a mut dyn Write>);

impl<'a> CsvTable<'a> {
    fn new(out: &'a mut dyn Write, header: &[String]) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_record(header.iter().map(|name| cell(name).into_owned()))?;
        Ok(Self(writer))
    }

    fn row(&mut self, words: &[&str], numbers: impl IntoIterator<Item = f64>) -> io::Result<()> {
        for word in words {
            self.0.write_field(cell(word).as_bytes())?;
        }
        for number in numbers {
            self.0.write_field(exact(number))?;
        }
        self.0.write_record(None::<&[u8]>)?;
        Ok(())
    }

    fn finish(mut self) -> io::Result<()> {
        self.0.flush()
    }
}

fn words(names: &[&str]) -> Vec<String> {
    names.iter().map(|&n| n.to_owned()).collect()
}

/// `probes.csv`: the parameter, then per probe `x, y, angle, curvature, strain`, in dynamics also
/// `vx, vy`.
pub(super) fn probes(t: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let moving = t.probes.iter().flat_map(|p| &p.samples).any(|s| s.vx.is_some() || s.vy.is_some());
    let mut quantities = vec!["x", "y", "angle", "curvature", "strain"];
    if moving {
        quantities.extend(["vx", "vy"]);
    }
    let stressed = t.sections.iter().flat_map(|series| &series.samples).any(|s| s.stress_top.is_some());
    if !t.sections.is_empty() {
        quantities.extend(["axial_force", "shear_force", "bending_moment"]);
    }
    if stressed {
        quantities.extend(["stress_bottom", "stress_top"]);
    }
    let errors = t.run.error.as_ref().map(|error| &error.probes[..]).unwrap_or_default();
    if !errors.is_empty() {
        quantities.push("error");
    }
    let mut header = words(&[parameter_name(t.run.analysis)]);
    header.extend(t.probes.iter().flat_map(|p| quantities.iter().map(move |q| format!("{}.{q}", p.name))));
    let values = |sample: &ProbeSample, probe: usize, error: Option<&ProbeErrors>, i: usize| {
        let mut values = vec![sample.x, sample.y, sample.angle, sample.curvature, sample.strain];
        if moving {
            values.extend([sample.vx.unwrap_or(f64::NAN), sample.vy.unwrap_or(f64::NAN)]);
        }
        if let Some(series) = t.sections.get(probe) {
            let forces = series.samples.get(i).unwrap_or(&SectionForces::UNKNOWN);
            values.extend([forces.axial_force, forces.shear_force, forces.bending_moment]);
            if stressed {
                values.extend([forces.stress_bottom, forces.stress_top].map(|s| s.unwrap_or(f64::NAN)));
            }
        }
        values.extend(error.map(|error| error.samples.get(i).map_or(f64::NAN, |error| error.x)));
        values
    };
    let mut table = CsvTable::new(out, &header)?;
    for (i, &parameter) in t.parameter.iter().enumerate() {
        let samples =
            t.probes.iter().enumerate().filter_map(|(k, p)| Some((p.samples.get(i)?, k, errors.get(k))));
        let values = samples.flat_map(|(sample, k, error)| values(sample, k, error, i));
        table.row(&[], std::iter::once(parameter).chain(values))?;
    }
    table.finish()
}

/// `energy.csv`: the parameter, `stretch, bend, kinetic, potential, work, total` \[J\], and where
/// they are not zero throughout `stored` and `lost`.
pub(super) fn energy(t: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let mut header =
        vec![parameter_name(t.run.analysis), "stretch", "bend", "kinetic", "potential", "work", "total"];
    let stored = t.energy.iter().any(|e| e.stored != 0.0);
    let lost = t.energy.iter().any(|e| e.lost != 0.0);
    header.extend(
        [(stored, "stored"), (lost, "lost")].into_iter().filter_map(|(there, name)| there.then_some(name)),
    );
    let mut table = CsvTable::new(out, &words(&header))?;
    for (&parameter, e) in t.parameter.iter().zip(&t.energy) {
        let values = [parameter, e.stretch, e.bend, e.kinetic, e.potential, e.work, e.total()];
        let more =
            [(stored, e.stored), (lost, e.lost)].into_iter().filter_map(|(there, e)| there.then_some(e));
        table.row(&[], values.into_iter().chain(more))?;
    }
    table.finish()
}

/// `reactions.csv`: the parameter, then per support and joint `fx, fy` \[N\] and `moment` \[N m\]
/// on the beam.
pub(super) fn reactions(t: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let mut header = words(&[parameter_name(t.run.analysis)]);
    let quantities = ["fx", "fy", "moment"];
    header.extend(t.reactions.iter().flat_map(|r| quantities.map(|q| format!("{}.{q}", r.name))));
    let mut table = CsvTable::new(out, &header)?;
    for (i, &parameter) in t.parameter.iter().enumerate() {
        let samples = t.reactions.iter().filter_map(|r| r.samples.get(i));
        table.row(&[], std::iter::once(parameter).chain(samples.flat_map(|r| [r.fx, r.fy, r.moment])))?;
    }
    table.finish()
}

/// `effects.csv`: the parameter, then per effect `energy` \[J\] where it has one, and the resultant
/// `fx, fy` \[N\] of its forces on the beam: zero of inertia, whose force would need accelerations.
pub(super) fn effects(t: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let mut header = words(&[parameter_name(t.run.analysis)]);
    for effect in &t.effects {
        let quantities = ["energy", "fx", "fy"].into_iter().skip(usize::from(!effect.has_energy));
        header.extend(quantities.map(|q| format!("{}.{q}", effect.name)));
    }
    let mut table = CsvTable::new(out, &header)?;
    for (i, &parameter) in t.parameter.iter().enumerate() {
        let values = t.effects.iter().filter_map(|effect| {
            Some(effect.samples.get(i)?.iter().copied().skip(usize::from(!effect.has_energy)))
        });
        table.row(&[], std::iter::once(parameter).chain(values.flatten()))?;
    }
    table.finish()
}

/// One row for each arc length, which is the first of the columns; every row begins with the same
/// words.
fn rows(table: &mut CsvTable<'_>, words: &[&str], columns: &[&[f64]]) -> io::Result<()> {
    let count = columns.first().map_or(0, |s| s.len());
    (0..count).try_for_each(|i| {
        table.row(words, columns.iter().map(|column| column.get(i).copied().unwrap_or(f64::NAN)))
    })
}

/// `shape.csv`: the last state,
/// `beam, s, x, y, angle, strain, curvature, axial_force, shear_force, bending_moment`, and
/// `stress_bottom, stress_top` where the shape of a section is known.
pub(super) fn shape(t: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let mut header = vec![
        "beam",
        "s",
        "x",
        "y",
        "angle",
        "strain",
        "curvature",
        "axial_force",
        "shear_force",
        "bending_moment",
    ];
    let stressed = t.last.iter().any(|shape| !shape.stress.is_empty());
    if stressed {
        header.extend(["stress_bottom", "stress_top"]);
    }
    let mut table = CsvTable::new(out, &words(&header))?;
    for shape in &t.last {
        let state = [&shape.s, &shape.x, &shape.y, &shape.angle, &shape.strain, &shape.curvature];
        let forces = [&shape.axial_force, &shape.shear_force, &shape.bending_moment];
        let mut columns: Vec<&[f64]> = state.into_iter().chain(forces).map(Vec::as_slice).collect();
        if stressed {
            columns.extend(shape.face_stresses().unwrap_or_default());
        }
        rows(&mut table, &[&shape.beam], &columns)?;
    }
    table.finish()
}

/// `layers.csv`: stresses \[Pa\] in the last state of beams with several layers;
/// `beam, layer, s, stress_bottom, stress_top`.
pub(super) fn layers(t: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let mut table = CsvTable::new(out, &words(&["beam", "layer", "s", "stress_bottom", "stress_top"]))?;
    for shape in t.last.iter().filter(|shape| shape.stress.len() > 1) {
        for (layer, number) in shape.stress.iter().zip(1..) {
            let number = format!("{number}");
            rows(&mut table, &[&shape.beam, &number], &[&shape.s, &layer.bottom, &layer.top])?;
        }
    }
    table.finish()
}

/// `modes.csv`: what each mode changes along the beams;
/// `mode, beam, s, ux, uy, rotation, strain, curvature`.
pub(super) fn modes(modes: &[&[ModeShape]], out: &mut dyn Write) -> io::Result<()> {
    let header = ["mode", "beam", "s", "ux", "uy", "rotation", "strain", "curvature"];
    let mut table = CsvTable::new(out, &words(&header))?;
    for (i, mode) in modes.iter().enumerate() {
        for beam in *mode {
            let columns =
                [&beam.s, &beam.x, &beam.y, &beam.angle, &beam.strain, &beam.curvature].map(Vec::as_slice);
            rows(&mut table, &[&(i + 1).to_string(), &beam.beam], &columns)?;
        }
    }
    table.finish()
}

/// `frequencies.csv` or `load_factors.csv`: the mode's number and its eigenvalue.
pub(super) fn eigenvalues(name: &str, values: &[f64], out: &mut dyn Write) -> io::Result<()> {
    let mut table = CsvTable::new(out, &words(&["mode", name]))?;
    for (i, &value) in values.iter().enumerate() {
        table.row(&[&(i + 1).to_string()], [value])?;
    }
    table.finish()
}

/// `states.csv`: every beam at every recorded frame; the parameter, `beam, s, x, y`. Where section
/// forces were asked for, what the sections carry follows.
pub(super) fn states(t: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let header = vec![parameter_name(t.run.analysis), "beam", "s", "x", "y"];
    if !t.along.is_empty() {
        return sections(t, header, out);
    }
    let mut table = CsvTable::new(out, &words(&header))?;
    for frame in &t.frames {
        let parameter = exact(frame.parameter);
        for (beam, points) in frame.beams.iter().enumerate() {
            let name = t.run.undeformed.get(beam).map_or("", |shape| &shape.beam);
            for (s, [x, y]) in frame_arc_lengths(t, frame, beam).into_iter().zip(points) {
                table.row(&[&parameter, name], [s, *x, *y])?;
            }
        }
    }
    table.finish()
}

/// The columns of a beam with what its sections carry: name in tables, name with unit in files for
/// ParaView, values. Stresses and velocities are there where they are known.
pub(super) fn section_columns(beam: &BeamSections) -> Vec<(&'static str, &'static str, Vec<f64>)> {
    let shape = &beam.shape;
    let mut columns: Vec<(&str, &str, Vec<f64>)> = vec![
        ("angle", "angle [rad]", shape.angle.clone()),
        ("strain", "axial strain", shape.strain.clone()),
        ("curvature", "curvature [1/m]", shape.curvature.clone()),
        ("axial_force", "axial force [N]", shape.axial_force.clone()),
        ("shear_force", "shear force [N]", shape.shear_force.clone()),
        ("bending_moment", "bending moment [N m]", shape.bending_moment.clone()),
    ];
    if !beam.velocity.is_empty() {
        let axis = |axis: usize| beam.velocity.iter().map(|v| v[axis]).collect();
        columns.extend([("vx", "velocity x [m/s]", axis(0)), ("vy", "velocity y [m/s]", axis(1))]);
    }
    if let Some([bottom, top]) = shape.face_stresses() {
        columns.push(("stress_bottom", "stress bottom [Pa]", bottom.to_vec()));
        columns.push(("stress_top", "stress top [Pa]", top.to_vec()));
    }
    columns
}

/// `states.csv` with what the sections carry.
fn sections(t: &Trajectory, mut header: Vec<&str>, out: &mut dyn Write) -> io::Result<()> {
    let mut names: Vec<&str> = Vec::new();
    for (name, ..) in t.along.iter().flatten().flat_map(section_columns) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    header.extend(&names);
    let mut table = CsvTable::new(out, &words(&header))?;
    for (frame, beams) in t.frames.iter().zip(&t.along) {
        let parameter = exact(frame.parameter);
        for beam in beams {
            let (shape, columns) = (&beam.shape, section_columns(beam));
            for i in 0..shape.s.len() {
                let of = |name: &&str| {
                    let column = columns.iter().find(|(other, ..)| other == name);
                    column.and_then(|(_, _, values)| values.get(i)).copied().unwrap_or(f64::NAN)
                };
                let place = [shape.s[i], shape.x[i], shape.y[i]];
                table.row(&[&parameter, &shape.beam], place.into_iter().chain(names.iter().map(of)))?;
            }
        }
    }
    table.finish()
}

/// The arc lengths \[m\] of a frame's points: even, from one end of the beam to the other.
pub(super) fn frame_arc_lengths(t: &Trajectory, frame: &Frame, beam: usize) -> Vec<f64> {
    let count = frame.beams.get(beam).map_or(0, Vec::len);
    let s = t.run.undeformed.get(beam).map_or(&[][..], |shape| &shape.s);
    let (first, last) = (s.first().copied().unwrap_or(0.0), s.last().copied().unwrap_or(1.0));
    let parts = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|i| first + (last - first) * i as f64 / parts).collect()
}
