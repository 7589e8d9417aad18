//! Some mutants of each folder, spread over its sources.

use indexmap::IndexMap;

use crate::find::Mutant;

/// The golden ratio less one: its multiples are spread evenly over the unit interval, however many
/// there are (J. F. Koksma; L. Kuipers, H. Niederreiter, *Uniform Distribution of Sequences*, 1974,
/// p. 7).
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// For each folder, how many mutants are wanted and all of its own, in the order in which to take
/// them.
pub struct Part {
    /// So many viable ones.
    pub wanted: usize,
    /// Numbers in the list of all.
    pub order: Vec<usize>,
}

/// Divides a number of mutants, of those that are meant, among folders by size, but with at least
/// so many in each as long as there are any.
pub fn parts(
    mutants: &[Mutant],
    meant: impl Fn(&Mutant) -> bool,
    number: usize,
    least: usize,
    seed: u32,
) -> IndexMap<String, Part> {
    let mut folders: IndexMap<String, Vec<usize>> = IndexMap::new();
    for (i, mutant) in mutants.iter().enumerate().filter(|(_, mutant)| meant(mutant)) {
        folders.entry(mutant.folder()).or_default().push(i);
    }
    folders.sort_unstable_keys();
    let sure: usize = folders.values().map(|own| own.len().min(least)).sum();
    let beyond: usize = folders.values().map(|own| own.len().saturating_sub(least)).sum();
    let share = number.saturating_sub(sure) as f64 / beyond.max(1) as f64;
    folders
        .into_iter()
        .map(|(name, own)| {
            let more = (share * own.len().saturating_sub(least) as f64).ceil() as usize;
            let wanted = (own.len().min(least) + more).min(own.len());
            (name, Part { wanted, order: spread(own, seed) })
        })
        .collect()
}

/// A list in another order, of which any first members are spread evenly over it.
fn spread(list: Vec<usize>, seed: u32) -> Vec<usize> {
    let place = |i: usize| ((i as f64 + 0.5 + f64::from(seed) * 0.754_877_666) * GOLDEN).fract();
    let mut left: Vec<Option<usize>> = list.into_iter().map(Some).collect();
    let n = left.len();
    (0..n)
        .filter_map(|i| {
            let start = (place(i) * n as f64) as usize;
            let free = (0..n).map(|step| (start + step) % n).find(|&at| left[at].is_some())?;
            left[free].take()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find::Edit;

    fn mutants(file: &str, number: usize) -> Vec<Mutant> {
        let edit = Edit::Body { at: 0, value: None };
        let one = |line| Mutant {
            file: file.to_owned(),
            line,
            column: 1,
            change: String::new(),
            edit: edit.clone(),
        };
        (1..=number).map(one).collect()
    }

    /// Would catch folders left out, and samples larger than what there is.
    #[test]
    fn small_folders_are_tried_whole_and_large_ones_in_proportion() {
        let all = [mutants("src/a/b.rs", 1000), mutants("src/c.rs", 7), mutants("src/d/e.rs", 500)].concat();
        let parts = |meant: fn(&Mutant) -> bool| parts(&all, meant, 100, 10, 1);
        let only = parts(|mutant| mutant.file.starts_with("src/c"));
        assert_eq!(
            only.into_iter().map(|(name, part)| (name, part.wanted)).collect::<Vec<_>>(),
            [("src/c".to_owned(), 7)]
        );
        let parts = parts(|_| true);
        let wanted: Vec<usize> = parts.values().map(|part| part.wanted).collect();
        assert_eq!(parts.keys().collect::<Vec<_>>(), ["src/a", "src/c", "src/d"]);
        // 27 are sure; 73 more are 990 to 490.
        assert_eq!(wanted, [10 + 49, 7, 10 + 25]);
        assert!(parts["src/c"].order.iter().all(|&i| all[i].file == "src/c.rs"));
    }

    /// Would catch a sample of one file only, and one that differs from time to time.
    #[test]
    fn the_first_of_the_order_are_spread_and_every_one_comes_once() {
        let all = mutants("src/a/b.rs", 200);
        let order = |seed| {
            parts(&all, |_| true, 20, 10, seed).swap_remove("src/a").map(|p| p.order).expect("a folder")
        };
        let mut tenths: Vec<usize> = order(1).iter().take(20).map(|i| i / 20).collect();
        tenths.sort_unstable();
        tenths.dedup();
        assert_eq!(tenths.len(), 10);
        let mut every = order(1);
        every.sort_unstable();
        assert_eq!(every, (0..200).collect::<Vec<_>>());
        assert_eq!(order(3), order(3));
        assert_ne!(order(1), order(2));
    }
}
