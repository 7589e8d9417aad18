//! Loops over the nodes of long chains, on several threads.
//!
//! A chain of [`LONG`] nodes or more is cut into blocks of [`BLOCK`] nodes, whatever the number of
//! threads, so that results do not depend on it. A shorter one is left to the thread that asks: to
//! call others takes some ten microseconds, as long as a loop over a thousand nodes.

use std::ops::Range;

/// Chains of so many nodes are worked on by several threads.
pub const LONG: usize = 20_000;
/// Nodes of a block; a multiple of the four cells that are summed together.
pub const BLOCK: usize = 4096;

/// What belongs to the nodes of a chain, from the first to the last.
pub trait ByNodes: Sized + Send {
    /// Number of nodes.
    fn nodes(&self) -> usize;

    /// Cuts it before node number `node`.
    fn cut(self, node: usize) -> (Self, Self);
}

/// Several slices with one entry per node.
impl<T: Send, const K: usize> ByNodes for [&mut [T]; K] {
    fn nodes(&self) -> usize {
        self.first().map_or(0, |slice| slice.len())
    }

    fn cut(mut self, node: usize) -> (Self, Self) {
        let mut behind = [(); K].map(|()| <&mut [T]>::default());
        for (slice, behind) in self.iter_mut().zip(&mut behind) {
            (*slice, *behind) = std::mem::take(slice).split_at_mut(node);
        }
        (self, behind)
    }
}

/// Several slices that are only read.
impl<T: Sync, const K: usize> ByNodes for [&[T]; K] {
    fn nodes(&self) -> usize {
        self.first().map_or(0, |slice| slice.len())
    }

    fn cut(self, node: usize) -> (Self, Self) {
        (self.map(|slice| &slice[..node]), self.map(|slice| &slice[node..]))
    }
}

impl<A: ByNodes, B: ByNodes> ByNodes for (A, B) {
    fn nodes(&self) -> usize {
        self.0.nodes()
    }

    fn cut(self, node: usize) -> (Self, Self) {
        let ((a, behind_a), (b, behind_b)) = (self.0.cut(node), self.1.cut(node));
        ((a, b), (behind_a, behind_b))
    }
}

/// Calls `work` with the numbers of the nodes of each block and with what belongs to them, and merges
/// what it returns.
#[inline(always)]
pub fn over<N: ByNodes, R: Send>(
    nodes: N,
    work: &(impl Fn(Range<usize>, N) -> R + Sync),
    merge: &(impl Fn(R, R) -> R + Sync),
) -> R {
    let range = 0..nodes.nodes();
    if range.len() < LONG { work(range, nodes) } else { halves(range, nodes, work, merge) }
}

/// [`over`] where nothing is returned.
#[inline(always)]
pub fn each<N: ByNodes>(nodes: N, work: &(impl Fn(Range<usize>, N) + Sync)) {
    over(nodes, work, &|(), ()| ());
}

/// Calls `work`, which has loops over chains of so many nodes: from one of the threads that work on long
/// ones, so that its loops need not wake them one after the other.
pub fn within<R: Send>(nodes: usize, work: impl FnOnce() -> R + Send) -> R {
    if nodes < LONG { work() } else { rayon::join(work, || ()).0 }
}

/// Cuts between blocks until one is left.
fn halves<N: ByNodes, R: Send>(
    range: Range<usize>,
    nodes: N,
    work: &(impl Fn(Range<usize>, N) -> R + Sync),
    merge: &(impl Fn(R, R) -> R + Sync),
) -> R {
    let blocks = range.len().div_ceil(BLOCK);
    if blocks < 2 {
        return work(range, nodes);
    }
    let middle = blocks / 2 * BLOCK;
    let (cut, (first, second)) = (range.start + middle, nodes.cut(middle));
    let (mut before, mut behind) = (Half::Nodes(first), Half::Nodes(second));
    both(&mut || before.work(|nodes| halves(range.start..cut, nodes, work, merge)), &mut || {
        behind.work(|nodes| halves(cut..range.end, nodes, work, merge))
    });
    merge(before.result(), behind.result())
}

/// Calls both, on two threads where two are free. It is compiled once, whereas the code of rayon for
/// every pair of closures would be a tenth of the crate.
fn both(one: &mut (dyn FnMut() + Send), other: &mut (dyn FnMut() + Send)) {
    rayon::join(one, other);
}

/// Nodes to work on, then what the work returned.
enum Half<N, R> {
    Nodes(N),
    InWork,
    Result(R),
}

impl<N, R> Half<N, R> {
    fn work(&mut self, work: impl FnOnce(N) -> R) {
        if let Self::Nodes(nodes) = std::mem::replace(self, Self::InWork) {
            *self = Self::Result(work(nodes));
        }
    }

    fn result(self) -> R {
        match self {
            Self::Result(result) => result,
            Self::Nodes(_) | Self::InWork => unreachable!("both halves are worked on"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_is_seen_once_in_its_place() {
        for count in [0, 7, LONG - 1, LONG, 5 * BLOCK, 5 * BLOCK + 3] {
            let (mut a, mut b) = (vec![0; count], vec![0; count]);
            let last = over(
                ([&mut a[..]], [&mut b[..]]),
                &|range, ([a], [b])| {
                    assert_eq!((range.len(), range.len()), (a.len(), b.len()));
                    if count >= LONG {
                        assert!(range.start % BLOCK == 0 && range.len() <= BLOCK);
                    }
                    for (i, (a, b)) in range.clone().zip(a.iter_mut().zip(b)) {
                        *a += i;
                        *b += 2 * i;
                    }
                    range.end
                },
                &|first, second| {
                    assert!(first <= second);
                    second
                },
            );
            assert_eq!(last, count);
            assert!(a.iter().zip(&b).enumerate().all(|(i, (a, b))| *a == i && *b == 2 * i));
        }
    }
}
