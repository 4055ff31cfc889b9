//! Sources of instances that are computed for each element: rules that draw or count, and random L-systems.

use std::fmt::Debug;

use crate::draws::Path;
use crate::expression::Interval;
use crate::geometry::{Frame, Point as _};
use crate::rule::{ElementContext, Extent, Part, Rule, RuleFrame};

use super::{Alternative, CompileError, Instance, Successor};

/// Source of instances that are computed for each element.
pub(crate) trait Source<F: Frame>: Debug + Send + Sync {
    /// Computes the successor that the draws of a path select among alternatives, and overwrites
    /// `successor`.
    fn evaluate(
        &self,
        alternatives: &[Alternative],
        path: Path,
        context: &ElementContext,
        buffers: &mut Buffers<F>,
        successor: &mut Successor<F>,
    ) -> Result<(), CompileError>;

    /// Returns the parts of a generator; empty if all of its elements stay.
    fn parts(&self, generator: usize) -> &[Part];

    /// Returns bounds of each element of a generator by position, or upper bounds of their power means for a
    /// finite power (see `Generator::means`). Distances are those from a point of the unit frame, its middle in graphs of
    /// rules.
    fn extents(
        &self,
        generator: usize,
        power: f64,
        moments: &[Interval; 4],
        middle: F::Point,
    ) -> Vec<Extent>;

    /// Visits the instances of a generator that are wanted, by their numbers, at the nodes of a quadrature over its draws, with
    /// their weights. Returns the reason why they are not known, or that of the visitor.
    fn visit_draws(
        &self,
        _generator: usize,
        _is_wanted: &dyn Fn(usize) -> bool,
        _visit: &mut DrawVisitor<'_, F>,
    ) -> Result<(), String> {
        Err("productions are drawn whose effects are not alike".into())
    }

    /// Returns the number of conditions, weights and generators that may be looked at to replace an element.
    fn choices(&self) -> u64 {
        1
    }

    /// Returns the weight of a generator, 1 if it is not drawn.
    fn weight(&self, _generator: usize) -> f64 {
        1.0
    }

    /// Returns the rule, if a rule is the source.
    fn rule(&self) -> Option<&Rule<F>>
    where
        F: RuleFrame,
    {
        None
    }
}

/// Visitor of the instances of a generator, by number, with a weight.
pub(crate) type DrawVisitor<'v, F> = dyn FnMut(usize, &Instance<F>, f64) -> Result<(), String> + 'v;

/// Buffers that evaluations reuse.
#[derive(Debug, Default)]
pub(crate) struct Buffers<F: Frame> {
    pub(crate) slots: Vec<f64>,
    pub(crate) points: Vec<F::Point>,
}

impl<F: RuleFrame> Source<F> for Rule<F> {
    fn evaluate(
        &self,
        alternatives: &[Alternative],
        path: Path,
        context: &ElementContext,
        Buffers { slots, points }: &mut Buffers<F>,
        successor: &mut Successor<F>,
    ) -> Result<(), CompileError> {
        let alternative = if let [only] = alternatives {
            only
        } else {
            let generator = self.selection().select(context, path);
            alternatives
                .iter()
                .find(|alternative| alternative.generator == generator)
                .unwrap_or_else(|| unreachable!("every candidate has its alternative"))
        };
        let generator = &self.generators()[alternative.generator];
        generator.evaluate(context, path, slots, points);
        if !points.iter().all(|point| point.is_finite()) {
            return Err(CompileError::not_finite(generator.name(), context));
        }
        successor.set(generator.parts(), points, &alternative.objects);
        Ok(())
    }

    fn parts(&self, generator: usize) -> &[Part] {
        self.generators()[generator].parts()
    }

    fn extents(
        &self,
        generator: usize,
        power: f64,
        moments: &[Interval; 4],
        _: F::Point,
    ) -> Vec<Extent> {
        self.generators()[generator].extents(power, moments)
    }

    fn choices(&self) -> u64 {
        self.selection().choices() as u64
    }

    fn rule(&self) -> Option<&Rule<F>> {
        Some(self)
    }
}
