use std::ops::Range;

use crate::instancing::Coat;
use crate::rule::draw::Path;

use super::Chain;

/// What a graph begins with that is no beginning but a part of something that has been grown for a
/// while.
#[derive(Clone, Debug, Default)]
pub(crate) struct Roots {
    /// What the elements of the initiator and of [sown](Self::sown) chains descend from, by position.
    pub(crate) elements: Vec<Root>,
    /// Fractals that have been seeded before, in the order of those that they have been seeded by, each
    /// after that one; those that are seeded by one fractal in the order of their births, and of the
    /// elements that seed them.
    pub(crate) sown: Vec<Sown>,
}

/// What an element descends from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Root {
    /// The step of its birth.
    pub(crate) level: u32,
    pub(crate) path: Path,
    /// Its length relative to the initiator element's that it descends from.
    pub(crate) length: f64,
    /// What it and all that it descends from are tinted with.
    pub(crate) coat: Coat,
}

/// A fractal that has been seeded before.
#[derive(Clone, Debug)]
pub(crate) struct Sown {
    /// The fractal that has seeded it: 0 for the initiator, or else its number in the list, from 1.
    pub(crate) by: usize,
    /// What comes of roots from this position on comes after the element that has seeded it.
    pub(crate) before: u32,
    /// The step of its birth.
    pub(crate) born: u32,
    /// The roots in it.
    pub(crate) chain: Chain,
}

impl Roots {
    /// The fractals that one has seeded before.
    pub(crate) fn sown_by(&self, fractal: usize) -> Range<usize> {
        let from = self.sown.partition_point(|sown| sown.by < fractal);
        let to = self.sown.partition_point(|sown| sown.by <= fractal);
        from..to
    }
}
