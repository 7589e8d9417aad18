//! Memory that a machine has not: told before it is asked for, with what is needed and what is
//! free.

use super::near;
use ancf::run::{RunError, inspect, measure};
use ancf::{Analysis, Beam, Discretization, Model, Section, Static};

const NODES: f64 = 1e13;

fn endless() -> Model {
    let discretization = Discretization::ancf(NODES as usize - 1);
    let section = Section::new(1e4, 1.0);
    Model {
        beams: vec![Beam::line("arm", [0.0, 0.0], [1.0, 0.0], section, discretization)],
        ..Model::default()
    }
}

/// Four coordinates of eight bytes a node: shape functions at five points of four functions, two
/// band matrices of eight entries a row, forty vectors.
#[test]
fn needs_of_an_endless_mesh_are_counted() {
    let (model, analysis) = (endless(), Analysis::Static(Static::default()));
    let errors = [
        inspect(&model, &analysis).expect_err("no machine has this"),
        measure(&model, &analysis).expect_err("no machine has this"),
        model.solve(&analysis).expect_err("no machine has this"),
    ];
    for error in errors {
        let RunError::Memory { needed, free } = error else { panic!("{error}") };
        near(needed / NODES, 5.0 * 4.0 * 8.0 + 2.0 * 4.0 * 2.0 * 4.0 * 8.0 + 40.0 * 4.0 * 8.0, 1e-6, "bytes");
        assert!(free > 0.0 && free < needed, "{free} of {needed}");
    }
}

/// The least of what the kernel says: memory with swap, or the bound of a control group.
#[cfg(target_os = "linux")]
#[test]
fn free_memory_is_what_the_kernel_says() {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let kilobytes = |name: &str| {
        let text = read("/proc/meminfo");
        let line = text.lines().find(|line| line.starts_with(name)).unwrap_or_default().to_owned();
        line.split_whitespace().nth(1).and_then(|number| number.parse::<f64>().ok()).unwrap_or(0.0)
    };
    let machine = 1024.0 * (kilobytes("MemAvailable:") + kilobytes("SwapFree:"));
    let group = |name: &str| read(&format!("/sys/fs/cgroup/memory.{name}")).trim().parse::<f64>();
    let bound = match (group("max"), group("current")) {
        (Ok(most), Ok(taken)) => most - taken,
        _ => f64::INFINITY,
    };
    let limits = read("/proc/self/limits");
    let unlimited =
        limits.lines().any(|line| line.starts_with("Max address space") && line.contains("unlimited"));
    let error = endless().solve(&Static::default()).expect_err("no machine has this");
    let RunError::Memory { free, .. } = error else { panic!("{error}") };
    let expected = machine.min(bound);
    // Other programs take and give back meanwhile.
    let near = (0.7..1.4).contains(&(free / expected));
    assert!(near || !unlimited && free < expected, "{free} bytes are free, of {expected}");
}
