//! `ancf-mutants`: do the tests catch faults that are put into the sources? Writes
//! `verification/mutants.toml`.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::ExitCode;

use ancf_mutants::Failure;
use ancf_mutants::build::{self, Built, Program};
use ancf_mutants::copy::{Workshop, sources, spliced};
use ancf_mutants::find::{Mutant, find};
use ancf_mutants::record::{Again, Record, head, text_at};
use ancf_mutants::sample::parts;
use ancf_mutants::trial;
use clap::Parser;

/// More mutants are put in than are wanted, by this factor, because some do not compile.
const SPARE: f64 = 1.25;

/// Put small faults into the sources of ancf, one at a time, and see whether a test fails
#[derive(Parser)]
#[command(version, about)]
struct Arguments {
    /// How many mutants that compile to try, spread over all sources
    #[arg(long, default_value_t = 300)]
    sample: usize,
    /// At least so many in each folder of src, if there are any
    #[arg(long, default_value_t = 15)]
    least: usize,
    /// Another sample for another number
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// Try the survivors of the record again, and record which are caught now
    #[arg(long, conflicts_with_all = ["sample", "least", "seed", "only"])]
    again: bool,
    /// Take the sample of those only whose names hold one of these texts, and record nothing
    #[arg(long, value_name = "TEXT")]
    only: Vec<String>,
    /// How many to try at a time
    #[arg(short, long, default_value_t = 1)]
    jobs: usize,
    /// Print all mutants that there are
    #[arg(long)]
    list: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Whether all were caught.
fn run(arguments: &Arguments) -> Result<bool, Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    let sources = sources(&root)?;
    let mut all: Vec<Mutant> = Vec::new();
    for (file, text) in &sources {
        all.extend(find(file, text)?);
    }
    if arguments.list {
        all.iter().for_each(|mutant| println!("{}", mutant.name()));
        return Ok(true);
    }
    let path = Record::path(&root);
    let recorded = Record::read(&path)?;
    let before = recorded.as_ref().map_or_else(Vec::new, |record| record.survivor.clone());
    let survivors: Vec<Vec<usize>> = match &recorded {
        Some(record) if arguments.again => {
            let files: BTreeSet<&str> = all.iter().map(|mutant| mutant.file.as_str()).collect();
            let mut then: Vec<Mutant> = Vec::new();
            for file in files.into_iter().filter(|file| before.iter().any(|s| s.mutant.starts_with(file))) {
                then.extend(
                    text_at(&root, &record.commit, file).map_or(Ok(Vec::new()), |text| find(file, &text))?,
                );
            }
            record.survivors_among(&then, &all)
        }
        _ => Vec::new(),
    };
    // Folder by folder: how many are wanted of which candidates.
    let wanted: Vec<(usize, Vec<usize>)> = if arguments.again {
        let each_once: BTreeSet<usize> = survivors.iter().flatten().copied().collect();
        vec![(all.len(), each_once.into_iter().collect())]
    } else {
        let candidates = |wanted: usize| (SPARE * wanted as f64).ceil() as usize + 2;
        let only = &arguments.only;
        let meant = |mutant: &Mutant| only.is_empty() || only.iter().any(|o| mutant.name().contains(o));
        parts(&all, meant, arguments.sample, arguments.least, arguments.seed)
            .into_values()
            .map(|part| (part.wanted, part.order.into_iter().take(candidates(part.wanted)).collect()))
            .collect()
    };
    let workshop = Workshop::new(&root)?;
    let commit = head(&root)?;
    let mut inside: BTreeSet<usize> = wanted.iter().flat_map(|(_, order)| order).copied().collect();
    eprintln!("{} mutants, {} of them put into {}", all.len(), inside.len(), workshop.copy.display());
    let (programs, fingerprint) = viable(&workshop, &sources, &all, &mut inside)?;
    let mut chosen: Vec<(f64, usize)> = Vec::new();
    let mut unviable: BTreeSet<usize> = BTreeSet::new();
    for (number, order) in &wanted {
        let own: Vec<usize> = order.iter().copied().filter(|i| inside.contains(i)).take(*number).collect();
        // Mutants beyond the last that is tried were not needed.
        let all_of_them = own.len() < *number;
        let needed = |i: &&usize| all_of_them || own.last() != Some(i);
        unviable.extend(order.iter().take_while(needed).filter(|i| !inside.contains(i)));
        let turn = |k: usize| k as f64 / own.len() as f64;
        chosen.extend(own.iter().enumerate().map(|(k, &i)| (turn(k), i)));
    }
    // All folders side by side, so that what is known after a part of the time is of all.
    chosen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let chosen: Vec<(usize, String)> = chosen.into_iter().map(|(_, i)| (i, all[i].name())).collect();
    eprintln!("{} mutants to try, {} do not compile", chosen.len(), unviable.len());
    let tests = trial::tests(&workshop, &programs, &all, fingerprint)?;
    let outcomes = trial::outcomes(&workshop, &tests, &chosen, fingerprint, arguments.jobs)?;
    let date = jiff::Timestamp::now().strftime("%F").to_string();
    let mut record = match recorded {
        Some(mut record) if arguments.again => {
            record.try_again(&survivors, &outcomes, Again { date, commit });
            record.store(&path, &before)?;
            record.tell();
            return Ok(record.total.missed == record.equivalent(None));
        }
        _ => Record::of(&all, &unviable, &outcomes, &before),
    };
    if arguments.only.is_empty() {
        (record.date, record.commit) = (date, commit);
        let (sample, least, seed) = (arguments.sample, arguments.least, arguments.seed);
        record.command = format!(".ci/mutants --sample {sample} --least {least} --seed {seed}");
        record.store(&path, &before)?;
    }
    record.tell();
    Ok(record.total.missed == record.equivalent(None))
}

/// Builds the copy, leaving out mutants that do not compile until all others do.
fn viable(
    workshop: &Workshop,
    sources: &[(String, String)],
    all: &[Mutant],
    inside: &mut BTreeSet<usize>,
) -> Result<(Vec<Program>, u64), Failure> {
    let mut checked = false;
    loop {
        let mutants: Vec<(usize, &Mutant)> = inside.iter().map(|&i| (i, &all[i])).collect();
        let files = spliced(sources, &mutants);
        let fingerprint = workshop.fill(&files, all.len())?;
        let built = if checked { build::tests(workshop, &files)? } else { build::check(workshop, &files)? };
        match built {
            Built::Programs(programs) if checked => return Ok((programs, fingerprint)),
            Built::Programs(_) => checked = true,
            Built::Unviable(unviable) => {
                eprintln!("{} do not compile, and are left out", unviable.len());
                inside.retain(|i| !unviable.contains(i));
            }
        }
    }
}
