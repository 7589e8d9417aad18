//! The runs of a sweep: the product of its axes, computed run by run and never stored.

use super::{Axis, SweepError};

/// Most runs of one sweep.
pub const MAX_RUNS: usize = 10_000_000;

/// The product of axes; the last one changes fastest. Runs are numbered from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    axes: Vec<Axis>,
    runs: usize,
}

impl Grid {
    /// # Errors
    /// [`SweepError::Grid`] where there is nothing to vary, a path appears twice, or there are more
    /// runs than [`MAX_RUNS`].
    pub fn new(axes: Vec<Axis>) -> Result<Self, SweepError> {
        let wrong = |reason: String| Err(SweepError::Grid { reason });
        let mut paths: Vec<&str> = axes.iter().flat_map(|axis| &axis.paths).map(String::as_str).collect();
        if paths.is_empty() {
            return wrong("nothing varies".into());
        }
        paths.sort_unstable();
        if let Some(twice) = paths.windows(2).find(|pair| pair[0] == pair[1]) {
            return wrong(format!("`{}` is varied twice", twice[0]));
        }
        let product = axes.iter().try_fold(1_usize, |runs, axis| runs.checked_mul(axis.values.len()));
        match product.filter(|runs| *runs <= MAX_RUNS) {
            Some(runs) => Ok(Self { axes, runs }),
            None => wrong(format!("there are more than {MAX_RUNS} combinations")),
        }
    }

    /// The axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.runs
    }

    /// All paths, in the order of the axes.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().flat_map(|axis| &axis.paths).map(String::as_str)
    }

    /// Every axis with the number of its value in `run` (from 1).
    fn chosen(&self, run: usize) -> Vec<(&Axis, usize)> {
        let mut rest = run - 1;
        let mut chosen = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            chosen.push((axis, rest % axis.values.len()));
            rest /= axis.values.len();
        }
        chosen.reverse();
        chosen
    }

    /// The texts to which the paths are set in `run` (from 1), in their order.
    pub fn values(&self, run: usize) -> Vec<&str> {
        self.chosen(run)
            .into_iter()
            .flat_map(|(axis, value)| &axis.values[value])
            .map(String::as_str)
            .collect()
    }

    /// The lines of files from which `run` (from 1) takes its values, as `FILE:LINE`.
    pub fn lines(&self, run: usize) -> Vec<String> {
        self.chosen(run).into_iter().filter_map(|(axis, value)| axis.lines.place(value)).collect()
    }

    /// The overrides `PATH=VALUE` of `run` (from 1).
    pub fn overrides(&self, run: usize) -> Vec<String> {
        self.paths().zip(self.values(run)).map(|(path, value)| format!("{path}={value}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_axis_changes_fastest() {
        let grid = Grid::new(vec![Axis::parse("a=1,2").unwrap(), Axis::parse("b=x,y,z").unwrap()]).unwrap();
        assert_eq!(grid.runs(), 6);
        assert_eq!(grid.overrides(1), ["a=1", "b=x"]);
        assert_eq!(grid.overrides(2), ["a=1", "b=y"]);
        assert_eq!(grid.overrides(6), ["a=2", "b=z"]);
        let twice = Grid::new(vec![Axis::parse("a=1,2").unwrap(), Axis::parse("a=3").unwrap()]);
        assert!(twice.unwrap_err().to_string().contains("`a` is varied twice"));
        assert!(Grid::new(vec![]).is_err());
        let large = ["a=0:1:1000000", "b=0:1:1000000"].map(|option| Axis::parse(option).unwrap());
        assert!(Grid::new(large.to_vec()).unwrap_err().to_string().contains("more than"));
    }

    #[test]
    fn there_are_at_most_ten_million_runs() {
        let grid = |first: &str| {
            let options = [first, "b=1:1000:1000", "c=1:1000:1000"];
            Grid::new(options.map(|option| Axis::parse(option).unwrap()).to_vec())
        };
        assert_eq!(grid("a=1:10:10").unwrap().runs(), 10_000_000);
        assert!(grid("a=1:11:11").is_err());
    }

    #[test]
    fn runs_know_the_lines_of_their_lists() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs.csv");
        std::fs::write(&path, "a,b\n1,2\n3,4\n").unwrap();
        let axes = vec![Axis::list(&path).unwrap(), Axis::parse("c=x,y").unwrap()];
        let grid = Grid::new(axes).unwrap();
        assert_eq!(grid.paths().collect::<Vec<_>>(), ["a", "b", "c"]);
        assert_eq!(grid.values(3), ["3", "4", "x"]);
        assert_eq!(grid.lines(2), [format!("{}:2", path.display())]);
        assert_eq!(grid.lines(3), [format!("{}:3", path.display())]);
    }
}
