//! Parts of a sweep for several processes.

/// One of several parts of a sweep: the runs `index`, `index + count`, `index + 2 count`, …
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// All runs.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Which part, from 1.
    pub fn index(self) -> usize {
        self.index
    }

    /// Number of parts.
    pub fn count(self) -> usize {
        self.count
    }

    /// Its runs out of `runs`, ascending.
    pub fn runs(self, runs: usize) -> impl Iterator<Item = usize> {
        (self.index..=runs).step_by(self.count)
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split_once('/')
            .and_then(|(index, count)| Some(Self { index: index.parse().ok()?, count: count.parse().ok()? }))
            .filter(|shard| (1..=shard.count).contains(&shard.index))
            .ok_or_else(|| "expected I/N with 1 ≤ I ≤ N, such as 2/8".into())
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_runs_out() {
        let mut runs: Vec<usize> =
            ["1/3", "2/3", "3/3"].iter().flat_map(|text| text.parse::<Shard>().unwrap().runs(7)).collect();
        assert_eq!(runs, [1, 4, 7, 2, 5, 3, 6]);
        runs.sort_unstable();
        assert!(runs.into_iter().eq(Shard::WHOLE.runs(7)));
        assert_eq!("5/9".parse::<Shard>().unwrap().runs(4).count(), 0);
        let shard: Shard = "2/3".parse().unwrap();
        assert_eq!((shard.index(), shard.count(), shard.to_string().as_str()), (2, 3, "2/3"));
        for text in ["0/3", "4/3", "1", "1/0", "a/b", "-1/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
