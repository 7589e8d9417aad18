//! The values that vary in a sweep, as the command line and lists write them.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::SweepError;
use crate::output::text_of_cell;
use crate::scene::split_number;

/// Most values of one axis.
pub const MAX_VALUES: usize = 1_000_000;

/// Paths of the scene that change together, with the texts that they take one after the other.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Axis {
    /// Dotted paths, as overrides write them.
    pub paths: Vec<String>,
    /// Per value of the axis, one text per path: a TOML value, or else text.
    pub values: Vec<Vec<String>>,
    /// Per value where it was read from, if that was a file.
    #[serde(skip)]
    pub lines: Lines,
}

/// A file, and a line of it for each value; comparisons ignore it.
#[derive(Clone, Debug, Default)]
pub struct Lines(Option<(PathBuf, Vec<u64>)>);

impl PartialEq for Lines {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for Lines {}

impl Lines {
    /// `FILE:LINE` of the value with this number.
    pub fn place(&self, value: usize) -> Option<String> {
        let (path, lines) = self.0.as_ref()?;
        Some(format!("{}:{}", path.display(), lines.get(value)?))
    }
}

impl Axis {
    /// Reads `PATH=START:STOP:COUNT`, `PATH=START:STOP:COUNT:log` or `PATH=a,b,c`.
    ///
    /// START and STOP are numbers, both without a unit or both with the same one; COUNT values are
    /// spread evenly between them, both ends included, in the value or with `log` in its logarithm.
    /// Values in between are rounded to 15 significant digits, so that they are those that people
    /// would write (0.3, not 0.30000000000000004). In a list, commas and colons within brackets,
    /// braces or quotation marks belong to the value.
    ///
    /// # Errors
    /// [`SweepError::Vary`]: what was found and what is legal.
    pub fn parse(option: &str) -> Result<Self, SweepError> {
        let wrong = |reason: String| SweepError::Vary { option: option.to_owned(), reason };
        let (path, values) = option.split_once('=').ok_or_else(|| wrong("found no `=`".into()))?;
        let path = path.trim();
        if path.is_empty() {
            return Err(wrong("found no path before `=`".into()));
        }
        let texts = match split(values, ':').as_slice() {
            [_] => split(values, ',').into_iter().map(str::to_owned).collect(),
            [start, stop, count] => range(start, stop, count, false).map_err(wrong)?,
            [start, stop, count, "log"] => range(start, stop, count, true).map_err(wrong)?,
            _ => return Err(wrong(format!("`{values}` is neither START:STOP:COUNT nor a list"))),
        };
        if texts.iter().any(String::is_empty) {
            return Err(wrong("a value is empty".into()));
        }
        let values = texts.into_iter().map(|text| vec![text]).collect();
        Ok(Self { paths: vec![path.to_owned()], values, lines: Lines::default() })
    }

    /// Reads a CSV file: the header names paths, every line is one value of the axis.
    ///
    /// # Errors
    /// [`SweepError::List`] where the file cannot be read, is no table, or has no line.
    pub fn list(path: &Path) -> Result<Self, SweepError> {
        let wrong = |reason: String| SweepError::List { path: path.to_owned(), reason };
        let at = |line: u64, reason: String| SweepError::List {
            path: format!("{}:{line}", path.display()).into(),
            reason,
        };
        let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
        // The reader counts empty lines before a record to it.
        let line = |position: Option<&csv::Position>| {
            let (line, byte) = position.map_or((1, 0), |at| (at.line(), at.byte() as usize));
            let empty = text.bytes().skip(byte).take_while(|byte| matches!(byte, b'\n' | b'\r'));
            line + empty.filter(|byte| *byte == b'\n').count() as u64
        };
        let read = |error: &csv::Error| match error.kind() {
            csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
                let values = if *len == 1 { "value" } else { "values" };
                at(line(pos.as_ref()), format!("found {len} {values}, and the header names {expected_len}"))
            }
            _ => wrong(error.to_string()),
        };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let paths = reader.headers().map_err(|error| read(&error))?.iter().map(str::to_owned).collect();
        let (mut values, mut lines) = (Vec::new(), Vec::new());
        for record in reader.records().take(MAX_VALUES + 1) {
            let record = record.map_err(|error| read(&error))?;
            values.push(record.iter().map(|cell| text_of_cell(cell).to_owned()).collect());
            lines.push(line(record.position()));
        }
        let axis = Self { paths, values, lines: Lines(Some((path.to_owned(), lines))) };
        if axis.values.is_empty() {
            return Err(wrong("found no line below the header".into()));
        }
        if axis.values.len() > MAX_VALUES {
            return Err(wrong(format!("found more than {MAX_VALUES} lines")));
        }
        Ok(axis)
    }
}

/// Parts of `text` between the separators that are not within brackets, braces or quotation marks;
/// trimmed.
fn split(text: &str, separator: char) -> Vec<&str> {
    let (mut depth, mut quote, mut escaped) = (0_usize, None, false);
    text.split(|c: char| {
        match (quote, c) {
            (Some('"'), '\\') if !escaped => {
                escaped = true;
                return false;
            }
            (Some(open), _) if c == open && !escaped => quote = None,
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth = depth.saturating_sub(1),
            _ => {}
        }
        escaped = false;
        c == separator && depth == 0 && quote.is_none()
    })
    .map(str::trim)
    .collect()
}

fn range(start: &str, stop: &str, count: &str, logarithmic: bool) -> Result<Vec<String>, String> {
    let number = |text: &str| -> Result<(f64, String), String> {
        let (number, unit) = split_number(text).map_err(|reason| format!("`{text}`: {reason}"))?;
        Ok((number, unit.trim().to_owned()))
    };
    let ((from, unit), (to, other)) = (number(start)?, number(stop)?);
    if unit != other {
        return Err(format!("`{start}` and `{stop}` must carry the same unit"));
    }
    if logarithmic && (from == 0.0 || to == 0.0 || (from < 0.0) != (to < 0.0)) {
        return Err(format!(
            "`{start}` and `{stop}` must have the same sign, and not be zero, to be spaced by `log`"
        ));
    }
    let count = match count.parse::<usize>() {
        Ok(count) if (2..=MAX_VALUES).contains(&count) => count,
        _ => return Err(format!("COUNT is `{count}`, expected a whole number from 2 to {MAX_VALUES}")),
    };
    let value = |i: usize| {
        let t = i as f64 / (count - 1) as f64;
        if i == 0 {
            from
        } else if i == count - 1 {
            to
        } else if logarithmic {
            // The ratio of numbers that are too far apart overflows or underflows.
            match (to / from).powf(t) {
                power if power.is_normal() => from * power,
                _ => from.signum() * from.abs().powf(1.0 - t) * to.abs().powf(t),
            }
        } else {
            // Not `from + t (to − from)`, whose difference may overflow.
            from * (1.0 - t) + to * t
        }
    };
    Ok((0..count)
        .map(|i| if unit.is_empty() { text(value(i)) } else { text(value(i)) + " " + &unit })
        .collect())
}

/// 15 significant digits at most, and whole numbers without a point, so that they may count things.
fn text(value: f64) -> String {
    let rounded = format!("{value:.14e}").parse().unwrap_or(value);
    let size = f64::abs(rounded);
    if rounded == 0.0 {
        "0".into()
    } else if (1e-4..1e15).contains(&size) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(option: &str) -> Vec<String> {
        Axis::parse(option).unwrap().values.concat()
    }

    #[test]
    fn ranges_are_what_people_would_write() {
        assert_eq!(values("a.b=0:1:11")[3], "0.3");
        assert_eq!(values("a=4:16:4"), ["4", "8", "12", "16"]);
        assert_eq!(values("a=1:1000:4:log"), ["1", "10", "100", "1000"]);
        assert_eq!(values("a=-1e-6:-1e-4:3:log"), ["-1e-6", "-1e-5", "-0.0001"]);
        assert_eq!(values("a = 0 N m : 300 N m : 4"), ["0 N m", "100 N m", "200 N m", "300 N m"]);
        assert_eq!(values("a=1e300:-1e300:3"), ["1e300", "0", "-1e300"]);
        assert_eq!(values("a=-1.7e308:1.7e308:2"), ["-1.7e308", "1.7e308"]);
    }

    /// Ranges have exactly the given ends, however far apart, written as short as possible.
    #[test]
    fn ranges_end_where_they_are_told_to() {
        assert_eq!(values("a=0.1:10:3:log"), ["0.1", "1", "10"]);
        assert_eq!(values("a=10:0.1:3:log"), ["10", "1", "0.1"]);
        assert_eq!(values("a=1e-300:1e300:3:log"), ["1e-300", "1", "1e300"]);
        assert_eq!(values("a=-1e200:-1e-200:3:log"), ["-1e200", "-1", "-1e-200"]);
        assert_eq!(values("a=9e-5:1e-4:2"), ["9e-5", "0.0001"]);
        assert_eq!(values("a=999999999999999:1e15:2"), ["999999999999999", "1e15"]);
        assert_eq!(values("a=3 m:3 m:2"), ["3 m", "3 m"]);
        // 1 − (−1e16) is rounded.
        assert_eq!(values("a=-1e16:1:2"), ["-1e16", "1"]);
    }

    #[test]
    fn lists_know_their_lines() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs.csv");
        std::fs::write(&path, "a.b , c\n\n\n1, x\n 2,y \n").unwrap();
        let axis = Axis::list(&path).unwrap();
        assert_eq!(axis.paths, ["a.b", "c"]);
        assert_eq!(axis.values, [["1", "x"], ["2", "y"]]);
        let places = [0, 1, 2].map(|value| axis.lines.place(value));
        let line = |line: usize| Some(format!("{}:{line}", path.display()));
        assert_eq!(places, [line(4), line(5), None]);
        assert_eq!(Axis::parse("a=1,2").unwrap().lines.place(0), None);
        // A sweep is the same wherever its values come from.
        assert_eq!(axis, Axis { lines: Lines::default(), ..axis.clone() });
        // As `sweep.csv` has them, so that it can be a list again.
        std::fs::write(&path, "a,b,c\n'-3 N,-4,'-x'\n").unwrap();
        assert_eq!(Axis::list(&path).unwrap().values, [["-3 N", "-4", "'-x'"]]);
        std::fs::write(&path, "a.b,c\n").unwrap();
        let empty = Axis::list(&path).unwrap_err().to_string();
        assert_eq!(empty, format!("{}: found no line below the header", path.display()));
    }

    #[test]
    fn lists_keep_what_brackets_and_quotes_hold() {
        assert_eq!(values("a=3 kN m, 4 kN m"), ["3 kN m", "4 kN m"]);
        assert_eq!(values(r#"a="x,y:z",[0, "1:2"],'q'"#), [r#""x,y:z""#, r#"[0, "1:2"]"#, "'q'"]);
        assert_eq!(values(r#"a="\"," , {b = [1, 2]}"#), [r#""\",""#, "{b = [1, 2]}"]);
        assert_eq!(values("a=7"), ["7"]);
        // A backslash stands for itself behind another one, and between single quotes.
        assert_eq!(values(r#"a="\\",b"#), [r#""\\""#, "b"]);
        assert_eq!(values(r"a='x\',y"), [r"'x\'", "y"]);
    }

    #[test]
    fn what_is_no_axis_is_refused() {
        for (option, part) in [
            ("a", "no `=`"),
            ("=1:2:3", "no path"),
            ("a=1:2", "neither"),
            ("a=1:2:3:lin", "neither"),
            ("a=1:2:1", "COUNT"),
            ("a=1:2:1e9", "COUNT"),
            ("a=1:2:99999999999", "COUNT"),
            ("a=1 m:2:3", "same unit"),
            ("a=x:2:3", "decimal number"),
            ("a=0:2:3:log", "same sign"),
            ("a=2:0:3:log", "same sign"),
            ("a=2:-1:3:log", "same sign"),
            ("a=-1:2:3:log", "same sign"),
            ("a=1,,2", "empty"),
            ("a=", "empty"),
        ] {
            let message = Axis::parse(option).unwrap_err().to_string();
            assert!(message.contains(part), "{option}: {message}");
        }
    }
}
