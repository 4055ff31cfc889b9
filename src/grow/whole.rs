//! A single visitor of a whole walk, in the place of one for each span.

use std::ops::RangeInclusive;

use crate::geometry::Frame;

use super::colony::{Colony, Taken};
use super::spans::Seam;
use super::{Element, Enter, FractalInfo, Run, Subtree, Visitor};

/// Number of elements after which a visitor of the whole walk is taken.
const WHOLE: u64 = 1 << 12;

/// Visitor of a whole walk that passes its visitor to `take` repeatedly.
pub(super) struct Whole<V, T> {
    pub(super) visitor: V,
    pub(super) take: T,
    pub(super) since: u64,
}

impl<V, T> Whole<V, T> {
    pub(super) fn hand_over<E>(&mut self) -> Result<(), E>
    where
        T: FnMut(&mut V, Seam) -> Result<(), E>,
    {
        self.since = 0;
        (self.take)(&mut self.visitor, Seam::NONE)
    }

    #[inline]
    fn count<E>(&mut self, elements: u64) -> Result<(), E>
    where
        T: FnMut(&mut V, Seam) -> Result<(), E>,
    {
        self.since += elements;
        if self.since < WHOLE {
            return Ok(());
        }
        self.hand_over()
    }
}

impl<F: Frame, V: Visitor<F>, T> Visitor<F> for Whole<V, T>
where
    T: FnMut(&mut V, Seam) -> Result<(), V::Error>,
{
    type Error = V::Error;

    fn takes_runs(&self) -> bool {
        self.visitor.takes_runs()
    }

    fn longest_run(&self) -> u64 {
        self.visitor.longest_run()
    }

    fn cuts(&self) -> Option<f64> {
        self.visitor.cuts()
    }

    fn ages(&self) -> RangeInclusive<u32> {
        self.visitor.ages()
    }

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), V::Error> {
        self.visitor.begin(fractal)?;
        self.count(1)
    }

    #[inline]
    fn enter(&mut self, subtree: &Subtree<F>) -> Enter {
        self.visitor.enter(subtree)
    }

    #[inline]
    fn element(&mut self, element: &Element<F>) -> Result<(), V::Error> {
        self.visitor.element(element)?;
        self.count(1)
    }

    fn run(&mut self, run: &Run<'_, F>) -> Result<(), V::Error> {
        self.visitor.run(run)?;
        self.count(run.count())
    }

    fn takes(&self, colony: &Colony<'_, F>) -> Taken {
        self.visitor.takes(colony)
    }

    fn colony(&mut self, colony: &Colony<'_, F>, taken: Taken) -> Result<(), V::Error> {
        self.visitor.colony(colony, taken)?;
        self.count(1)
    }

    fn end(&mut self, joined: bool) -> Result<(), V::Error> {
        self.visitor.end(joined)
    }
}
