//! Output on standard error: progress, a table of results, warnings, errors.

use std::borrow::Cow;
use std::cell::Cell;
use std::error::Error;
use std::fmt::Write as _;
use std::io::{self, IsTerminal, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};

use crate::cost;
use crate::model::Analysis;
use crate::output::plot::human;
use crate::output::{EventText, with_error};
use crate::results::{AnalysisKind, ErrorEstimate, ProbeSample, Results, Run, Tension};
use crate::run::Progress;
use crate::sweep;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};

use super::failure::Failure;

/// Prints lines on standard error, without characters that control the terminal. A failure to write
/// them is ignored, because the command itself has not failed.
pub fn note(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", visible(text));
}

/// The text with control characters, other than ends of lines and tabs, escaped as in a scene: in a
/// title or a name they could move the cursor, or worse.
pub fn visible(text: &str) -> Cow<'_, str> {
    let commands = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    if !text.contains(commands) {
        return text.into();
    }
    let shown = |c: char| if commands(c) { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(shown).collect::<String>().into()
}

/// Prints a failure: with the lines of the scene on a terminal, else as plain text with everything
/// in it.
pub fn report(failure: &Failure) {
    if io::stderr().is_terminal() {
        let colourless = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        if let Some(text) = drawn(failure, colourless) {
            let _ = writeln!(io::stderr().lock(), "{text}");
            return;
        }
    }
    note(&format!("error: {}", plain(failure)));
}

/// A failure with the lines of the scene that it is about; none where these would control the
/// terminal.
fn drawn(failure: &Failure, colourless: bool) -> Option<String> {
    let rendered = |theme| {
        let mut text = String::new();
        let handler = GraphicalReportHandler::new_themed(theme).with_context_lines(2);
        handler.render_report(&mut text, failure).is_ok().then_some(text)
    };
    // Colours are control characters, too; there must be no others.
    let text = rendered(GraphicalTheme::unicode_nocolor())?;
    if matches!(visible(&text), Cow::Owned(_)) {
        return None;
    }
    if colourless { Some(text) } else { rendered(GraphicalTheme::unicode()) }
}

/// The message of a failure with its causes and its help.
fn plain(failure: &Failure) -> String {
    if let Failure::Scene(error) = failure
        && error.place().is_some()
    {
        return error.to_string();
    }
    let mut text = failure.to_string();
    let mut source = failure.source();
    while let Some(cause) = source {
        let _ = write!(text, ": {cause}");
        source = cause.source();
    }
    if let Some(help) = failure.help() {
        for line in help.to_string().lines() {
            let _ = write!(text, "\n    {line}");
        }
    }
    text
}

/// The progress of a run; silent where standard error is no terminal.
pub struct ProgressLine {
    bar: ProgressBar,
    unit: &'static str,
    name: &'static str,
    /// When the line was last brought up to date: a step may take less time than printing it.
    shown: Cell<Instant>,
}

/// Least time between two updates of the line.
const TICK: Duration = Duration::from_millis(50);

/// Parts of the bar.
const PARTS: u64 = 1000;

impl ProgressLine {
    /// A line for this analysis.
    pub fn new(analysis: &Analysis, quiet: bool) -> Self {
        let bar = bar(PARTS, quiet);
        let (name, unit) = match analysis {
            Analysis::Dynamic(_) => ("t", " s"),
            _ => ("load", ""),
        };
        Self { bar, unit, name, shown: Cell::new(Instant::now()) }
    }

    /// Brings the line up to date.
    pub fn show(&self, now: &Progress) {
        if self.bar.is_hidden() || self.shown.get().elapsed() < TICK {
            return;
        }
        self.shown.set(Instant::now());
        let done = (now.parameter / now.target).clamp(0.0, 1.0);
        // A path may turn back, and a target may be zero: then the bar stays where it was.
        if done.is_finite() {
            self.bar.set_position((done * PARTS as f64) as u64);
        }
        let Self { unit, name, .. } = self;
        self.bar.set_message(format!(
            "{name} = {:.4}{unit} of {:.4}{unit}, step {:.2e}{unit}, {} Newton iterations",
            now.parameter, now.target, now.step, now.newton_iterations
        ));
    }

    /// Removes the line.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

fn bar(length: u64, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(10) };
    let bar = ProgressBar::with_draw_target(Some(length), target);
    if let Ok(style) = ProgressStyle::with_template("[{bar:30}] {msg} · {elapsed_precise}, {eta} left") {
        bar.set_style(style.progress_chars("█▌ "));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// The progress of a sweep; silent where standard error is no terminal.
pub struct SweepLine(ProgressBar);

impl SweepLine {
    /// A line for a sweep.
    pub fn new(quiet: bool) -> Self {
        Self(bar(0, quiet))
    }

    /// Brings the line up to date. The first call tells how many runs were finished before.
    pub fn show(&self, now: &sweep::SweepProgress) {
        let Self(bar) = self;
        if bar.length() == Some(0) {
            bar.set_length(now.runs as u64);
            bar.set_position(now.finished as u64);
            // The time left follows from the runs of this call alone.
            bar.reset_eta();
        }
        bar.set_position(now.finished as u64);
        let unsolved =
            if now.unsolved > 0 { format!(", {} not solved", now.unsolved) } else { String::new() };
        bar.set_message(format!("{} of {} runs{unsolved}", now.finished, now.runs));
    }

    /// Removes the line.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// The progress of a study of costs; silent where standard error is no terminal.
pub struct CostLine(ProgressBar);

impl CostLine {
    /// A line for a study.
    pub fn new(quiet: bool) -> Self {
        Self(bar(PARTS, quiet))
    }

    /// Brings the line up to date. The bar is the budget, of which a study may leave some.
    pub fn show(&self, now: &cost::StudyProgress<'_>) {
        let Self(bar) = self;
        if !bar.is_hidden() {
            bar.set_position((now.spent / now.budget * PARTS as f64) as u64);
            bar.set_message(format!("{}, budget {} s", now.doing, human(now.budget, 3)));
        }
    }

    /// Removes the line.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// Prints the warnings of a run.
pub fn warnings(run: &Run) {
    for warning in &run.warnings {
        note(&format!("warning: {warning}"));
    }
    for remark in run.error.iter().flat_map(|error| &error.notes) {
        note(&format!("note: {remark}"));
    }
}

/// Prints the warnings of a stage.
pub fn stage_warnings(stage: &str, run: &Run) {
    for warning in &run.warnings {
        note(&format!("warning: stage `{stage}`: {warning}"));
    }
}

/// Prints the table at the end of a run.
pub fn results(results: &Results, directory: &Path) {
    note(&table(results, directory));
}

fn table(results: &Results, directory: &Path) -> String {
    let (trajectory, run) = (results.states(), results.run());
    let mut rows: Vec<(String, String)> = Vec::new();
    let mut row = |name: &str, text: String| rows.push((name.to_owned(), text));
    if !run.complete {
        row("complete", "no, the run ended before it was done".into());
    }
    if let Some(last) = trajectory.parameter.last() {
        match run.analysis {
            AnalysisKind::Static | AnalysisKind::Modal => row("load factor", number(*last)),
            AnalysisKind::Dynamic => row("time", format!("{} s", number(*last))),
            AnalysisKind::Buckling => {}
        }
    }
    for probe in &trajectory.probes {
        if let Some(sample) = probe.samples.last() {
            let error = run.error.as_ref().and_then(|error| error.last_of(&probe.name));
            row(&probe.name, sample_text(sample, error));
        }
    }
    let errors = run.error.as_ref().map(|error| &error.eigenvalues[..]).unwrap_or_default();
    let lost = results.round_off();
    for (value, mode) in results.eigenvalues().into_iter().zip(1..) {
        let number = |value: f64| known(value, errors.get(mode - 1).map(|error| error * value.abs()));
        let free = match lost.get(mode - 1) {
            _ if value != 0.0 => "",
            Some(lost) if *lost > 0.0 => " (hidden by round-off)",
            _ => " (nothing resists)",
        };
        match results {
            Results::CriticalLoads(_) => {
                row(&format!("critical load {mode}"), format!("{} × the load", number(value)))
            }
            _ => row(&format!("frequency {mode}"), format!("{} Hz{free}", number(value))),
        }
    }
    for Tension { beam, tension } in &run.tensions {
        row("tendon", format!("of beam {beam}: tension {} N", number(*tension)));
    }
    if let Some(energy) = trajectory.energy.last() {
        let parts = [
            ("stretch", energy.stretch),
            ("bend", energy.bend),
            ("springs and contacts", energy.stored),
            ("kinetic", energy.kinetic),
            ("potential", energy.potential),
            ("put in", energy.work),
            ("lost", energy.lost),
        ];
        let there = |(name, value): &(&str, f64)| {
            let always = matches!(*name, "stretch" | "bend" | "kinetic" | "potential");
            (always || *value != 0.0).then(|| format!("{name} {} J", number(*value)))
        };
        let mut words: Vec<String> = parts.iter().filter_map(there).collect();
        words.push(format!("total {} J", number(energy.total())));
        row("energy", words.join(", "));
    }
    for (i, event) in trajectory.events.iter().enumerate() {
        let errors = run.error.as_ref().and_then(|error| error.events.get(i)).copied();
        let EventText { name, when, what } = EventText::new(event, errors, known);
        row(&name, if what.is_empty() { when } else { format!("{when}: {what}") });
    }
    let counts = &run.statistics;
    let mut work = Vec::new();
    for (count, one, many) in [
        (counts.steps, "step", "steps"),
        (counts.rejected_steps, "rejected", "rejected"),
        (counts.newton_iterations, "Newton iteration", "Newton iterations"),
        (counts.factorizations, "factorisation", "factorisations"),
    ] {
        if count > 0 {
            work.push(format!("{count} {}", if count == 1 { one } else { many }));
        }
    }
    let unknown = || "not estimated (`--error` does)".to_owned();
    row("error", run.error.as_ref().map_or_else(unknown, |error| error_text(error, run.analysis)));
    row("unknowns", run.degrees_of_freedom.to_string());
    if !work.is_empty() {
        row("work", work.join(", "));
    }
    let seconds = &run.seconds;
    row(
        "seconds",
        format!("build {:.3}, solve {:.3}, write {:.3}", seconds.build, seconds.solve, seconds.write),
    );
    row("report", directory.join("report.html").display().to_string());

    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let mut text = run.title.clone();
    for (name, value) in rows {
        let gap = " ".repeat(width - name.chars().count());
        let _ = write!(text, "{}  {name}{gap}  {value}", if text.is_empty() { "" } else { "\n" });
    }
    text
}

/// The largest errors, what was wanted of them, and what it took.
fn error_text(error: &ErrorEstimate, analysis: AnalysisKind) -> String {
    let unit = match analysis {
        AnalysisKind::Static | AnalysisKind::Dynamic => " of a beam length",
        AnalysisKind::Modal | AnalysisKind::Buckling => ", relative",
    };
    let mut text = match error.estimated.result.is_finite() {
        true => format!("{:.0e}{unit}", error.estimated.result),
        false => format!("unknown: {}", error.reason.as_deref().unwrap_or("no run to compare with")),
    };
    if let Some(wanted) = error.wanted {
        let usual = if error.usual { ", as usual" } else { "" };
        let _ = write!(text, " ({:e} wanted{usual})", wanted.result);
        let forces = match analysis {
            AnalysisKind::Dynamic => "section forces at the end",
            _ => "section forces",
        };
        for (what, wanted, found) in [
            ("curvature", wanted.curvature, error.estimated.curvature),
            (forces, wanted.section_force, error.estimated.section_force),
        ] {
            if let (Some(wanted), Some(found)) = (wanted, found) {
                let _ = write!(text, ", {what} {found:.0e} ({wanted:e} wanted)");
            }
        }
    }
    let (seconds, runs) = (error.runs.iter().map(|run| run.seconds).sum::<f64>(), error.runs.len());
    let _ = write!(text, "; {runs} {} in {seconds:.3} s", if runs == 1 { "run" } else { "runs" });
    text
}

fn sample_text(sample: &ProbeSample, error: Option<&ProbeSample>) -> String {
    let of = |value: f64, error_of: fn(&ProbeSample) -> f64| known(value, error.map(error_of));
    let mut text = format!(
        "x = {} m, y = {} m, angle = {}°, curvature = {} /m, strain = {}",
        of(sample.x, |e| e.x),
        of(sample.y, |e| e.y),
        of(sample.angle.to_degrees(), |e| e.angle.to_degrees()),
        of(sample.curvature, |e| e.curvature),
        of(sample.strain, |e| e.strain)
    );
    if let (Some(vx), Some(vy)) = (sample.vx, sample.vy) {
        let (x, y) = (of(vx, |e| e.vx.unwrap_or(0.0)), of(vy, |e| e.vy.unwrap_or(0.0)));
        let _ = write!(text, ", vx = {x} m/s, vy = {y} m/s");
    }
    text
}

/// A value with no digit beyond its error, where that is known.
fn known(value: f64, error: Option<f64>) -> String {
    error.and_then(|error| with_error(value, error)).unwrap_or_else(|| number(value))
}

/// Seven significant digits, as short as they allow.
fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if (1e-3..1e7).contains(&size) {
        let decimals = (6 - size.log10().floor() as i32).max(0) as usize;
        let text = format!("{value:.decimals$}");
        match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        }
    } else {
        format!("{value:.6e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Dynamic, Integrator, STEP_CONTROL, Static};
    use crate::output::OutputError;
    use crate::results::{
        BucklingMode, ContactImpulse, CriticalLoads, Energy, Event, EventErrors, ProbeSeries, Seconds,
        Statistics, Trajectory, Vibration, Vibrations,
    };
    use crate::scene::{self, SceneError};
    use indicatif::TermLike;
    use std::sync::{Arc, Mutex};

    /// A terminal that keeps what is written on it.
    #[derive(Clone, Debug, Default)]
    struct Screen(Arc<Mutex<String>>);

    impl Screen {
        /// A screen on which `bar` is drawn from now on.
        fn of(bar: &ProgressBar) -> Self {
            let screen = Self::default();
            bar.set_draw_target(ProgressDrawTarget::term_like(Box::new(screen.clone())));
            screen
        }

        /// All that was written.
        fn text(&self) -> String {
            self.0.lock().expect("a screen").clone()
        }
    }

    impl TermLike for Screen {
        fn width(&self) -> u16 {
            200
        }

        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn write_line(&self, text: &str) -> io::Result<()> {
            TermLike::write_str(self, text)
        }

        fn write_str(&self, text: &str) -> io::Result<()> {
            self.0.lock().expect("a screen").push_str(text);
            Ok(())
        }

        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }

        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    /// The test sets the time of the last update, so that nothing waits for the clock.
    #[test]
    fn the_line_of_a_run_says_where_it_is() {
        let integrator = Integrator::usual(STEP_CONTROL);
        let motion = Dynamic { duration: 2.0, output_every: 0.1, integrator, events: vec![] };
        let at =
            |parameter: f64, target: f64| Progress { parameter, target, step: 1e-3, newton_iterations: 7 };
        for (analysis, expected) in [
            (Analysis::Dynamic(motion), "t = 0.2500 s of 2.0000 s, step 1.00e-3 s, 7 Newton iterations"),
            (
                Analysis::Static(Static::default()),
                "load = 0.2500 of 2.0000, step 1.00e-3, 7 Newton iterations",
            ),
        ] {
            let line = ProgressLine::new(&analysis, true);
            let (long_ago, later) = (Instant::now() - 2 * TICK, Instant::now() + Duration::from_secs(3600));
            // There is no terminal.
            line.shown.set(long_ago);
            line.show(&at(0.25, 2.0));
            assert_eq!(line.bar.message(), "");
            let screen = Screen::of(&line.bar);
            // It was shown a moment ago.
            line.shown.set(later);
            line.show(&at(0.25, 2.0));
            assert_eq!(line.bar.message(), "");
            line.shown.set(long_ago);
            line.show(&at(0.25, 2.0));
            assert_eq!((line.bar.message().as_str(), line.bar.position()), (expected, 125));
            line.bar.force_draw();
            assert!(screen.text().contains(&format!("] {expected} · ")), "{}", screen.text());
            // Beyond either end; and with a target of zero the bar stays.
            for (parameter, target, position) in
                [(3.0, 2.0, 1000), (-1.0, 2.0, 0), (1.0, 2.0, 500), (0.0, 0.0, 500)]
            {
                line.shown.set(long_ago);
                line.show(&at(parameter, target));
                assert_eq!(line.bar.position(), position, "{parameter} of {target}");
            }
            line.clear();
            assert!(line.bar.is_finished());
        }
    }

    #[test]
    fn the_line_of_a_sweep_counts_runs() {
        let line = SweepLine::new(true);
        let screen = Screen::of(&line.0);
        line.show(&sweep::SweepProgress { finished: 2, runs: 8, unsolved: 0 });
        assert_eq!((line.0.length(), line.0.position()), (Some(8), 2));
        assert_eq!(line.0.message(), "2 of 8 runs");
        line.show(&sweep::SweepProgress { finished: 5, runs: 8, unsolved: 1 });
        assert_eq!((line.0.length(), line.0.position()), (Some(8), 5));
        assert_eq!(line.0.message(), "5 of 8 runs, 1 not solved");
        line.0.force_draw();
        assert!(screen.text().contains("] 5 of 8 runs, 1 not solved · "), "{}", screen.text());
        line.clear();
        assert!(line.0.is_finished());
    }

    /// A quarter of the budget is spent.
    #[test]
    fn the_line_of_a_study_is_its_budget() {
        let now = cost::StudyProgress { doing: "setting 3", spent: 3.09375, budget: 12.375 };
        let line = CostLine::new(true);
        line.show(&now);
        assert_eq!((line.0.message().as_str(), line.0.position()), ("", 0), "there is no terminal");
        let screen = Screen::of(&line.0);
        line.show(&now);
        let expected = "setting 3, budget 12.4 s";
        assert_eq!((line.0.message().as_str(), line.0.position()), (expected, 250));
        line.0.force_draw();
        assert!(screen.text().contains(&format!("] {expected} · ")), "{}", screen.text());
        line.clear();
        assert!(line.0.is_finished());
    }

    #[test]
    fn control_characters_are_seen() {
        let harmless = "90° — é\tü\n";
        assert!(matches!(visible(harmless), Cow::Borrowed(text) if text == harmless));
        assert_eq!(visible("é\u{1b}[2J\r\u{9b}\n"), "é\\u{1b}[2J\\r\\u{9b}\n");
    }

    fn wrong(text: &str) -> Failure {
        Failure::Scene(scene::parse("arm.toml", text).expect_err("no scene"))
    }

    const WRONG: &str = "title = \"Arm\"\n# two\n# three\nnonsense = 1\n# five\n# six\n# seven\n";

    /// Two lines on either side of the place.
    #[test]
    fn a_failure_is_drawn_with_the_lines_around_it() {
        let failure = wrong(WRONG);
        let text = drawn(&failure, true).expect("a drawing");
        for part in [
            "unknown key `nonsense`",
            "[arm.toml:4:1]",
            " 2 │ # two\n",
            " 4 │ nonsense = 1\n",
            "╰── here",
            " 6 │ # six\n",
            "help: legal keys: title, beam",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(!text.contains("title = ") && !text.contains("# seven"), "{text}");
        assert!(!text.contains('\u{1b}'), "{text}");
        assert!(drawn(&failure, false).is_some_and(|text| text.contains("\u{1b}[")));
    }

    #[test]
    fn lines_that_command_the_terminal_are_not_drawn() {
        let failure = wrong("nonsense = 1 # \u{1b}[2J\n");
        assert_eq!((drawn(&failure, true), drawn(&failure, false)), (None, None));
        assert!(plain(&failure).starts_with("arm.toml:1:16: "), "{}", plain(&failure));
    }

    /// The text has the place, the causes and the help.
    #[test]
    fn a_failure_in_plain_text_says_all_of_it() {
        let text = plain(&wrong(WRONG));
        assert!(text.starts_with("arm.toml:4:1: unknown key `nonsense`"), "{text}");
        assert_eq!(text.matches("legal keys").count(), 1, "{text}");
        let absent = SceneError::Unreadable { path: "a.toml".into(), reason: "it is gone".into() };
        assert_eq!(
            plain(&Failure::Scene(absent)),
            "a.toml: cannot read the scene: it is gone\n    \
             give the path of a scene file, a text file in the TOML format"
        );
        let source = io::Error::other("the disk is full");
        let full = OutputError::Write { path: "out/energy.csv".into(), source };
        assert_eq!(
            plain(&Failure::Output(full)),
            "cannot write `out/energy.csv`: the disk is full\n    \
             make the directory writable and free space on its disk, or name another one with `-o DIR`"
        );
    }

    #[test]
    fn numbers_keep_seven_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (1e-3, "0.001"),
            (9.99e-4, "9.990000e-4"),
            (-0.316_634_321, "-0.3166343"),
            (360.0, "360"),
            (1_234_567.0, "1234567"),
            (1_234_567.4, "1234567"),
            (1e7, "1.000000e7"),
            (12_345_678.0, "1.234568e7"),
            (1e-9, "1.000000e-9"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn the_table_names_what_was_computed() {
        let trajectory = Trajectory {
            run: Run { title: "Arm".into(), complete: true, ..Run::default() },
            parameter: vec![1.0],
            probes: vec![ProbeSeries { name: "tip".into(), samples: vec![ProbeSample::default()] }],
            energy: vec![Energy { bend: 0.5, ..Energy::default() }],
            ..Trajectory::default()
        };
        let text = table(&trajectory.clone().into(), Path::new("out/arm"));
        for part in ["Arm\n", "load factor  1", "tip          x = 0 m", "bend 0.5 J", "out/arm/report.html"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(!text.contains("complete"), "{text}");
        let ended = Trajectory { run: Run { complete: false, ..trajectory.run }, ..trajectory };
        let text = table(&ended.into(), Path::new("out/arm"));
        assert!(text.contains("complete     no, the run ended"), "{text}");
    }

    /// Counts of one are in the singular; energies that few models have are left out where they are
    /// zero.
    #[test]
    fn the_table_is_no_longer_than_it_must_be() {
        let statistics =
            Statistics { steps: 1, newton_iterations: 1, factorizations: 1, ..Statistics::default() };
        let trajectory = Trajectory {
            run: Run { complete: true, statistics, ..Run::default() },
            energy: vec![Energy { bend: 0.5, ..Energy::default() }],
            ..Trajectory::default()
        };
        let expected = "  energy    stretch 0 J, bend 0.5 J, kinetic 0 J, potential 0 J, total 0.5 J
  error     not estimated (`--error` does)
  unknowns  0
  work      1 step, 1 Newton iteration, 1 factorisation
  seconds   build 0.000, solve 0.000, write 0.000
  report    a/report.html";
        assert_eq!(table(&trajectory.clone().into(), Path::new("a")), expected);
        let idle =
            Trajectory { run: Run { statistics: Statistics::default(), ..trajectory.run }, ..trajectory };
        assert!(!table(&idle.into(), Path::new("a")).contains("work"));
    }

    /// All rows that there are, word for word.
    #[test]
    fn the_table_reads_as_reviewed() {
        let sample = ProbeSample {
            x: 0.25,
            y: -1.5e-4,
            angle: 0.5,
            curvature: 3.0,
            strain: 2e-6,
            vx: Some(1.5),
            vy: Some(-0.25),
        };
        let trajectory = Trajectory {
            run: Run {
                title: "Arm".into(),
                analysis: AnalysisKind::Dynamic,
                complete: true,
                degrees_of_freedom: 44,
                statistics: Statistics {
                    steps: 12,
                    rejected_steps: 1,
                    newton_iterations: 24,
                    factorizations: 0,
                    ..Statistics::default()
                },
                seconds: Seconds { build: 0.125, solve: 1.5, write: 0.0625 },
                ..Run::default()
            },
            parameter: vec![0.0, 0.75],
            probes: vec![ProbeSeries { name: "tip".into(), samples: vec![ProbeSample::default(), sample] }],
            energy: vec![
                Energy::default(),
                Energy {
                    stretch: 0.125,
                    bend: 0.5,
                    stored: 0.25,
                    kinetic: 2.0,
                    potential: -4.0,
                    work: 8.0,
                    lost: 16.0,
                },
            ],
            events: vec![
                Event::Probe {
                    time: 0.5,
                    probe: "tip".into(),
                    quantity: "y",
                    value: -0.125,
                    turns: None,
                    rates: [0.0; 2],
                },
                Event::Probe {
                    time: 0.5625,
                    probe: "tip".into(),
                    quantity: "angle",
                    value: 0.75,
                    turns: Some("maximum"),
                    rates: [0.0; 2],
                },
                Event::Contact { time: 0.625, contact: "arm.1".into(), touches: true, impulse: None },
                Event::Contact {
                    time: 0.6875,
                    contact: "arm.1".into(),
                    touches: false,
                    impulse: Some(ContactImpulse { impulse: [0.5, -0.25], largest_force: 32.0 }),
                },
            ],
            ..Trajectory::default()
        };
        let expected = "\
Arm
  time           0.75 s
  tip            x = 0.25 m, y = -1.500000e-4 m, angle = 28.64789°, curvature = 3 /m, strain = 2.000000e-6, vx = 1.5 m/s, vy = -0.25 m/s
  energy         stretch 0.125 J, bend 0.5 J, springs and contacts 0.25 J, kinetic 2 J, potential -4 J, put in 8 J, lost 16 J, total 6.875 J
  event at tip   0.5 s: y = -0.125 m
  event at tip   0.5625 s: angle = 0.75 rad, a maximum
  contact arm.1  0.625 s: begins
  contact arm.1  0.6875 s: ends, impulse (0.5, -0.25) N s, up to 32 N
  error          not estimated (`--error` does)
  unknowns       44
  work           12 steps, 1 rejected, 24 Newton iterations
  seconds        build 0.125, solve 1.500, write 0.062
  report         out/arm/report.html";
        assert_eq!(table(&trajectory.into(), Path::new("out/arm")), expected);
    }

    /// Digits end where the errors are; of an event that no other run has, or whose quantity tells nothing, none is known.
    #[test]
    fn events_have_the_digits_that_are_known() {
        let probe = |time: f64, turns: Option<&'static str>| Event::Probe {
            time,
            probe: "tip".into(),
            quantity: "y",
            value: -0.125,
            turns,
            rates: [0.0; 2],
        };
        let impulse = Some(ContactImpulse { impulse: [0.5, -0.25], largest_force: 32.0 });
        let lost = |load_factor: f64, unstable_directions: Option<[usize; 2]>| Event::Stability {
            load_factor,
            stability: "lost",
            unstable_directions,
            resolution: 0.0,
        };
        let events = vec![
            probe(0.5, None),
            probe(0.5625, Some("minimum")),
            probe(0.75, Some("minimum")),
            Event::Contact { time: 0.6875, contact: "arm.1".into(), touches: false, impulse },
            lost(0.8125, Some([0, 1])),
            lost(-0.25, None),
        ];
        let errors = vec![
            EventErrors { parameter: 2e-4, ..EventErrors::default() },
            EventErrors { parameter: 0.03, value: Some(2e-3), ..EventErrors::default() },
            EventErrors { value: Some(f64::INFINITY), ..EventErrors::UNKNOWN },
            EventErrors { parameter: 1e-3, value: None, impulse: Some(0.01), largest_force: Some(2.0) },
            EventErrors { parameter: 3e-5, ..EventErrors::default() },
            EventErrors::UNKNOWN,
        ];
        let error = Some(Box::new(ErrorEstimate { events: errors, ..ErrorEstimate::default() }));
        let run = Run { analysis: AnalysisKind::Dynamic, error, ..Run::default() };
        let text = table(&Trajectory { run, events, ..Trajectory::default() }.into(), Path::new("arm"));
        let rows: Vec<&str> = text.lines().filter(|line| line.contains("  ")).map(str::trim).collect();
        let expected = [
            "event at tip    0.5000(2) s: y = -0.125 m",
            "event at tip    0.56(3) s: y = -0.125(2) m, a minimum",
            "event at tip    0.75 s (error unknown): y = -0.125 m, a minimum",
            "contact arm.1   0.688(1) s: ends, impulse (0.50(1), -0.25(1)) N s, up to 32(2) N",
            "stability lost  load factor 0.81250(3): unstable directions 0 before, 1 after",
            "stability lost  load factor -0.25 (error unknown)",
        ];
        assert_eq!(&rows[1..7], expected);
    }

    #[test]
    fn frequencies_and_critical_loads_are_numbered() {
        let states = |analysis| Trajectory {
            run: Run { title: "Arm".into(), analysis, complete: true, ..Run::default() },
            ..Trajectory::default()
        };
        let vibration = |frequency| Vibration { frequency, round_off: 0.0, shape: Vec::new() };
        let modal = Vibrations {
            equilibrium: states(AnalysisKind::Modal),
            modes: vec![vibration(0.0), vibration(12.5)],
        };
        let expected = "\
Arm
  frequency 1  0 Hz (nothing resists)
  frequency 2  12.5 Hz
  error        not estimated (`--error` does)
  unknowns     0
  seconds      build 0.000, solve 0.000, write 0.000
  report       a/report.html";
        assert_eq!(table(&modal.into(), Path::new("a")), expected);
        let mode = BucklingMode { load_factor: 2.467, round_off: 0.0, shape: Vec::new() };
        let buckling = CriticalLoads { unloaded: states(AnalysisKind::Buckling), modes: vec![mode] };
        let expected = "\
Arm
  critical load 1  2.467 × the load
  error            not estimated (`--error` does)
  unknowns         0
  seconds          build 0.000, solve 0.000, write 0.000
  report           a/report.html";
        assert_eq!(table(&buckling.into(), Path::new("a")), expected);
    }
}
