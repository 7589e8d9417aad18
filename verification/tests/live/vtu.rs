//! The files for ParaView as VTK itself reads them, against the tables of the same run and against
//! geometry.

use std::collections::BTreeMap;
use std::path::Path;

use ancf::output::{OutputOptions, write};
use ancf_verification::bridge::Script;
use serde::{Deserialize, Serialize};

use crate::ours;

#[derive(Serialize)]
struct Question {
    index: String,
    files: Vec<String>,
}

#[derive(Deserialize)]
struct Answer {
    series: Vec<(f64, String)>,
    grids: Vec<Grid>,
}

#[derive(Deserialize)]
struct Grid {
    name: String,
    points: Vec<[f64; 3]>,
    types: Vec<String>,
    cells: Vec<Vec<usize>>,
    point_data: BTreeMap<String, serde_json::Value>,
    cell_data: BTreeMap<String, Vec<usize>>,
}

impl Grid {
    fn values<T: serde::de::DeserializeOwned>(&self, name: &str) -> Vec<T> {
        let values =
            self.point_data.get(name).unwrap_or_else(|| panic!("no {name}: {:?}", self.point_data.keys()));
        serde_json::from_value(values.clone()).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// One polyline a beam, through its own points in their order, and its number.
    fn holds_beams(&self, points: [usize; 2]) {
        let [first, second] = points;
        assert_eq!(self.name, "position [m]");
        assert_eq!(self.types, ["vtkPolyLine"; 2]);
        assert_eq!(self.cells, [(0..first).collect::<Vec<_>>(), (first..first + second).collect()]);
        assert_eq!(self.cell_data.get("beam"), Some(&vec![0, 1]));
    }
}

/// A column of a table, and the beam of each row.
fn column(folder: &Path, file: &str, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(folder.join(file)).expect("a table");
    let at = reader.headers().expect("a header").iter().position(|n| n == name).expect("a column");
    reader.records().map(|row| row.expect("a row")[at].parse().expect("a number")).collect()
}

/// Two beams of other lengths, places and directions, hinged to each other, fall. VTK reads them
/// where `states.csv` and `shape.csv` have them, with displacements from where the scene puts them.
///
/// Would catch x for y, offsets, connectivity or types of cells that are another, times by number,
/// and fields under another's name.
#[test]
fn vtk_reads_what_the_tables_say() {
    let trajectory = "[beam.arm]\nstart = [1, 2]\nend = [2, 2]\nyoungs_modulus = 1e8\nsection.circle = { diameter = 0.02 }\nmass_per_length = 1.0\n\
        basis.ancf.elements = 4\n\
        [beam.rod]\nstart = [2, 2]\nend = [2.3, 1.6]\nyoungs_modulus = 1e8\nsection.rectangle = { width = 0.01, height = 0.01 }\nmass_per_length = 1.0\n\
        basis.ancf.elements = 2\n\
        [[support]]\nbeam = \"arm\"\nat = \"start\"\nfix = [\"x\", \"y\"]\n\
        [[joint]]\ntype = \"hinge\"\nfirst = { beam = \"arm\", at = \"end\" }\nsecond = { beam = \"rod\", at = \"start\" }\n\
        [[effect.force]]\nbeam = \"arm\"\nat = 0.301\nvalue = [0, -1]\n\
        [effect.gravity]\nacceleration = [1, -9.81]\n\
        [output]\nvtu = true\nstates = true\nsection_forces = true\n\
        [analysis.dynamic]\nduration = 0.5\noutput_every = 0.125\nradau.tolerance = 1e-6\n";
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let options = OutputOptions { states: true, vtu: true };
    write(folder, &mut ours(trajectory), &options).expect("files");

    static VTK: Script = Script::new("vtk_files");
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let mut files: Vec<String> = (0..5).map(|i| path(&format!("vtu/state_{i:05}.vtu"))).collect();
    files.push(path("vtu/last.vtu"));
    let answer: Answer =
        VTK.ask(&Question { index: path("states.pvd"), files }).unwrap_or_else(|error| panic!("{error}"));

    let [time, s, x, y] = ["time", "s", "x", "y"].map(|name| column(folder, "states.csv", name));
    assert_eq!((answer.series.len(), time.len()), (5, 5 * 202));
    for (i, (at, file)) in answer.series.iter().enumerate() {
        let grid = &answer.grids[i];
        assert_eq!((*at, file.as_str()), (0.125 * i as f64, format!("vtu/state_{i:05}.vtu").as_str()));
        grid.holds_beams([101, 101]);
        let (arc, moved) =
            (grid.values::<f64>("arc length [m]"), grid.values::<[f64; 3]>("displacement [m]"));
        assert_eq!((grid.points.len(), arc.len(), moved.len()), (202, 202, 202));
        for (k, point) in grid.points.iter().enumerate() {
            let row = 202 * i + k;
            assert_eq!((time[row], arc[k]), (*at, s[row]));
            assert_eq!(*point, [x[row], y[row], 0.0], "frame {i}, point {k}");
            let rest = if k < 101 { [1.0 + s[row], 2.0] } else { [2.0 + 0.6 * s[row], 2.0 - 0.8 * s[row]] };
            for axis in 0..2 {
                let exact = point[axis] - rest[axis];
                assert!((moved[k][axis] - exact).abs() < 1e-12, "frame {i}, point {k}: {:?}", moved[k]);
            }
            assert_eq!(moved[k][2], 0.0);
        }
    }
    for (name, column_name) in [
        ("angle [rad]", "angle"),
        ("axial strain", "strain"),
        ("curvature [1/m]", "curvature"),
        ("axial force [N]", "axial_force"),
        ("shear force [N]", "shear_force"),
        ("bending moment [N m]", "bending_moment"),
        ("velocity x [m/s]", "vx"),
        ("velocity y [m/s]", "vy"),
        ("stress bottom [Pa]", "stress_bottom"),
        ("stress top [Pa]", "stress_top"),
    ] {
        let all = column(folder, "states.csv", column_name);
        for (i, grid) in answer.grids[..5].iter().enumerate() {
            assert_eq!(grid.values::<f64>(name), all[202 * i..202 * (i + 1)], "frame {i}, {name}");
        }
    }
    let far = answer.grids[4].values::<[f64; 3]>("displacement [m]")[201];
    assert!(far[0] < -0.1 && far[1] < -0.5, "it has fallen, and swung to the left: {far:?}");

    let last = &answer.grids[5];
    let [x, y, s, angle, strain, curvature] =
        ["x", "y", "s", "angle", "strain", "curvature"].map(|name| column(folder, "shape.csv", name));
    // The force is between two of the even places: there are two rows more.
    assert_eq!((last.points.len(), x.len()), (201 + 2 + 201, 404));
    last.holds_beams([203, 201]);
    for (k, point) in last.points.iter().enumerate() {
        assert_eq!(*point, [x[k], y[k], 0.0], "point {k}");
    }
    for (name, values) in [
        ("arc length [m]", s),
        ("angle [rad]", angle),
        ("axial strain", strain),
        ("curvature [1/m]", curvature),
        ("axial force [N]", column(folder, "shape.csv", "axial_force")),
        ("shear force [N]", column(folder, "shape.csv", "shear_force")),
        ("bending moment [N m]", column(folder, "shape.csv", "bending_moment")),
        ("stress bottom [Pa]", column(folder, "shape.csv", "stress_bottom")),
        ("stress top [Pa]", column(folder, "shape.csv", "stress_top")),
    ] {
        assert_eq!(last.values::<f64>(name), values, "{name}");
    }
}

/// The modes of two hinged beams under a load: VTK reads them where `modes.csv` has them, on the beams of `shape.csv`.
///
/// Would catch the modes of another number, x for y, and points of the state at rest.
#[test]
fn vtk_reads_modes_as_the_tables_say() {
    let vibrations = "[beam.arm]\nstart = [1, 2]\nend = [2, 2]\naxial_stiffness = 1e3\nbending_stiffness = 1\nmass_per_length = 1\n\
        basis.ancf.elements = 4\n\
        [beam.rod]\nstart = [2, 2]\nend = [2.3, 1.6]\naxial_stiffness = 1e3\nbending_stiffness = 1\nmass_per_length = 1\n\
        basis.ancf.elements = 2\n\
        [[support]]\nbeam = \"arm\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n\
        [[joint]]\ntype = \"hinge\"\nfirst = { beam = \"arm\", at = \"end\" }\nsecond = { beam = \"rod\", at = \"start\" }\n\
        [effect.gravity]\nacceleration = [0, -1]\n\
        [output]\nvtu = true\nstates = true\n\
        [analysis.modal]\ncount = 3\nabout = \"equilibrium\"\n";
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let options = OutputOptions { states: true, vtu: true };
    write(folder, &mut ours(vibrations), &options).expect("files");

    static VTK: Script = Script::new("vtk_files");
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let files = (1..=3).map(|i| path(&format!("vtu/mode_{i:05}.vtu"))).collect();
    let answer: Answer =
        VTK.ask(&Question { index: path("modes.pvd"), files }).unwrap_or_else(|error| panic!("{error}"));
    let [x, y, s] = ["x", "y", "s"].map(|name| column(folder, "shape.csv", name));
    let [mode, arc, ux, uy] = ["mode", "s", "ux", "uy"].map(|name| column(folder, "modes.csv", name));
    let points = x.len();
    assert_eq!((answer.series.len(), mode.len()), (3, 3 * points));
    assert!(y.iter().any(|y| *y < 1.5), "the rod hangs");
    for (i, (at, file)) in answer.series.iter().enumerate() {
        let grid = &answer.grids[i];
        assert_eq!((*at, file.as_str()), (mode[points * i], format!("vtu/mode_{:05}.vtu", i + 1).as_str()));
        grid.holds_beams([201, 201]);
        let moved = grid.values::<[f64; 3]>("displacement [m]");
        assert_eq!((grid.points.len(), moved.len()), (points, points));
        for (k, (point, moved)) in grid.points.iter().zip(&moved).enumerate() {
            let row = points * i + k;
            assert_eq!(*point, [x[k], y[k], 0.0], "mode {i}, point {k}");
            assert_eq!((arc[row], *moved), (s[k], [ux[row], uy[row], 0.0]), "mode {i}, point {k}");
        }
        for (name, column_name) in [
            ("arc length [m]", "s"),
            ("rotation [rad]", "rotation"),
            ("axial strain", "strain"),
            ("curvature [1/m]", "curvature"),
        ] {
            let all = column(folder, "modes.csv", column_name);
            assert_eq!(grid.values::<f64>(name), all[points * i..points * (i + 1)], "mode {i}, {name}");
        }
    }
}
